//! LAS and LAZ, the formats of laser scanners.

use std::collections::HashSet;
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

use walpha_base::advice::{Setting, advice};
use walpha_base::memory::try_reserve;
use walpha_base::shown::shown;

use super::columns::{RADIUS, VALUE, WEIGHT, places};
use super::crs::ReferenceSystem;
use super::las_fields::{Field, GPS_TIME, INTENSITY, described_bytes, fields};
use super::laz::{Claims, Records};
use super::{COLUMNS, Points, PointsError, format, take_radii};
use crate::sets::Cubes;
use crate::{
    Column, ColumnSummary, Crs, Flags, LasHeader, ModelMetadata, PointOptions, Region, ScanSummary,
};
use walpha_volume::{Coordinates, OpenFile, Reason, io_error};

/// The number of bytes of points read at once: a header may claim records of up to 64 KiB, and more of them than the file has.
const BATCH: u64 = 1 << 24;

/// Reads the positions of the points, of some classes (ASPRS codes) or of all, and their intensities as values, or what columns
/// `weight` (or `radius`) and `value` have. Withheld points are left out unless they are requested. Coordinates are doubles, computed with the
/// file's scales and offsets. Points outside a region, and all but the first in each cube, are left out while they are read; of
/// COPC, cells outside the region are not even decompressed.
pub(crate) fn read(
    file: &OpenFile,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = file.path();
    let mut source = Source::open(file)?;
    let system = ReferenceSystem::of(path, &source.header);
    if !options.describe {
        system.check().map_err(|reason| format(path, reason))?;
    }
    if let Some(region) = &options.region {
        source.leave_out(region);
    }
    let mut cubes = None;
    if let Some(side) = options.thin {
        Cubes::check(side)?;
        // The cubes start at the least coordinates of the points that are taken without them.
        let mut first = Taken::new(&source.header, options, None);
        let mut least = [f64::INFINITY; 3];
        source.each(false, |record| {
            if first.takes(record) {
                least = [0, 1, 2].map(|axis| least[axis].min(record.place[axis]));
            }
            Ok(())
        })?;
        cubes = Some(Cubes::new(least, side));
    }
    let mut taken = Taken::new(&source.header, options, cubes);
    if options.classes.is_none() && options.region.is_none() && options.thin.is_none() {
        taken.reserve(path, source.count().min(source.most()))?;
    }
    let whole = options.describe || taken.needs_fields();
    source.each(whole, |record| taken.take(path, record))?;
    if source.header.point_format().has_waveform {
        tracing::warn!("{}: waveforms of its points are passed over", shown(path));
    }
    taken.finish(path, system.crs(), source.header)
}

/// The least number of points for which room is made at once.
const ROOM: u64 = 1 << 16;

/// A record of a point.
struct Record<'a> {
    place: [f64; 3],
    intensity: u16,
    class: u8,
    bytes: &'a [u8],
}

impl Record<'_> {
    /// The flags of the point. In formats 0 to 5 they are above the class, in the others in the byte before it (LAS 1.4 R15,
    /// tables 8 and 16).
    fn flags(&self, is_extended: bool) -> u8 {
        if is_extended { self.bytes[15] & 15 } else { self.bytes[15] >> 5 }
    }
}

/// A file whose claims have been checked, which can be read several times.
struct Source<'a> {
    file: &'a OpenFile,
    header: las::Header,
    /// Whether the two numbers of points differ.
    counts_twice: bool,
    /// The number of points that the file claims.
    claimed: u64,
    claims: Option<Claims>,
}

impl<'a> Source<'a> {
    fn open(file: &'a OpenFile) -> Result<Self, PointsError> {
        if !file.is_ordinary() {
            let what = "is not an ordinary file, and LAS and LAZ are read in several passes";
            return Err(format(file.path(), Reason::unsupported(what, "copy it into one")));
        }
        let (raw, claims) = check(file)?;
        let claimed = count(&raw);
        let counts_twice = claimed != u64::from(raw.number_of_point_records);
        let header = las::Header::default();
        let mut source = Self { file, header, counts_twice, claimed, claims };
        source.header = source.reader()?.header().clone();
        let known = described_bytes(described(&source.header));
        let there = usize::from(source.header.point_format().extra_bytes);
        if known > there {
            let what =
                format!("describes {known} extra bytes of each point, but a point has {there}");
            let next = "write it again, with a description of the extra bytes that it has";
            return Err(format(file.path(), Reason::content(what, next)));
        }
        Ok(source)
    }

    fn reader(&self) -> Result<las::Reader, PointsError> {
        let reader = self.file.owned_reader()?;
        let reader = if self.counts_twice {
            las::Reader::new(WithoutOldCount { reader, at: 0 })
        } else {
            las::Reader::new(reader)
        };
        reader.map_err(|error| unreadable(self.file.path(), error))
    }

    /// The number of points that are read.
    fn count(&self) -> u64 {
        match &self.claims {
            Some(claims) if !claims.chunks.is_empty() => {
                claims.chunks.iter().map(|chunk| chunk.points).sum()
            }
            _ => self.claimed,
        }
    }

    /// The number of points for which room may be made at once: compressed points may take less than a byte, and their number may be damaged.
    fn most(&self) -> u64 {
        self.claims.as_ref().map_or(u64::MAX, |claims| claims.length.saturating_mul(16))
    }

    /// Leaves out the chunks whose cells of a COPC octree are outside a region. An index that is damaged is of no use.
    fn leave_out(&mut self, region: &Region) {
        let Some(claims) = &mut self.claims else { return };
        let (Some(info), Some(index)) =
            (self.header.copc_info_vlr(), self.header.copc_hierarchy_evlr())
        else {
            return;
        };
        let mut outside = HashSet::new();
        for entry in index.iter_entries() {
            let Ok(entry) = entry else { return };
            if !(0..=MOST_LEVELS).contains(&entry.key.l) {
                return;
            }
            let cell = entry.key.bounds(&info);
            let pairs =
                [(cell.min.x, cell.max.x), (cell.min.y, cell.max.y), (cell.min.z, cell.max.z)];
            // Coordinates are rounded, and so are the sides of cells.
            let margin = info.halfsize * 1e-6;
            let apart = |axis: usize| {
                let (low, high) = pairs[axis];
                low - margin > region.high[axis] || high + margin < region.low[axis]
            };
            if entry.point_count > 0 && (0..3).any(apart) {
                outside.insert(entry.offset);
            }
        }
        let kept = claims.chunks.iter().filter(|chunk| !outside.contains(&chunk.start));
        let kept: Vec<_> = kept.copied().collect();
        // Without a chunk there would be nothing that says which points there are.
        if !kept.is_empty() {
            claims.chunks = kept;
        }
    }

    /// Calls `take` for each point in turn. Without `whole`, only coordinates, intensities, classes and flags are read of layers.
    fn each(
        &self,
        whole: bool,
        mut take: impl FnMut(&Record<'_>) -> Result<(), PointsError>,
    ) -> Result<(), PointsError> {
        let path = self.file.path();
        let fail = |error| unreadable(path, error);
        let mut reader = self.reader()?;
        let record = u64::from(self.header.point_format().len()).max(1);
        let at_once = (BATCH / record).max(1);
        let mut batch = las::PointDataBuilder::new().for_header(&self.header).build();
        let mut packed = match &self.claims {
            None => None,
            Some(claims) => {
                let description = self.header.laz_vlr().map_err(fail)?;
                let records = Records::new(self.file.owned_reader()?, claims, description, whole);
                Some(records.map_err(|error| fail(error.into()))?)
            }
        };
        let (mut found, count) = (0, self.count());
        while found < count {
            match &mut packed {
                None => {
                    if reader.fill_points(at_once, &mut batch).map_err(fail)? == 0 {
                        break;
                    }
                }
                Some(records) => {
                    let room = batch.resize_for(at_once.min(count - found) as usize);
                    records.fill(room).map_err(|error| fail(error.into()))?;
                }
            }
            let places = batch.x().zip(batch.y()).zip(batch.z()).map(|((x, y), z)| [x, y, z]);
            let records = batch.raw_bytes().chunks_exact(batch.record_len());
            let rows = places.zip(batch.intensity()).zip(batch.classification()).zip(records);
            for (((place, intensity), class), bytes) in rows {
                found += 1;
                take(&Record { place, intensity, class, bytes })?;
            }
        }
        if found == count {
            return Ok(());
        }
        let what = format!("claims {count} points, but has {found}: it is truncated");
        Err(format(path, Reason::truncated(what)))
    }
}

/// The number of levels of an octree from which on cells are smaller than any scan resolves.
const MOST_LEVELS: i32 = 30;

/// The points that were read, and what is counted of all.
struct Taken<'a> {
    options: &'a PointOptions,
    is_extended: bool,
    fields: Vec<Field>,
    /// The indices of the fields whose columns are kept.
    kept: Vec<usize>,
    /// The indices of the fields that are weights, radii and values.
    weight: Option<usize>,
    radius: Option<usize>,
    value: Option<usize>,
    /// The cubes of which one point each is taken.
    cubes: Option<Cubes>,
    summaries: Vec<ColumnSummary>,
    scan: ScanSummary,
    withheld: u64,
    kinds: Kinds,
    points: Points,
    radii: Option<Vec<f64>>,
}

impl<'a> Taken<'a> {
    fn new(header: &las::Header, options: &'a PointOptions, cubes: Option<Cubes>) -> Self {
        let format = *header.point_format();
        let fields = fields(format, described(header));
        let names: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
        let meanings = places(&names);
        let named = |column| meanings.iter().position(|&meaning| meaning == Some(column));
        let [weight, radius, value] = [WEIGHT, RADIUS, VALUE].map(named);
        // Intensities are columns, too.
        let value = value.filter(|&index| fields[index].name != INTENSITY);
        let is_kept = |&index: &usize| {
            ![weight, radius, value].contains(&Some(index))
                && options.attributes.keeps(&fields[index].name)
        };
        let kept: Vec<usize> = (0..fields.len()).filter(is_kept).collect();
        let column =
            |&index: &usize| Column { name: fields[index].name.clone(), values: Vec::new() };
        Self {
            options,
            is_extended: format.is_extended,
            points: Points {
                values: Some(Vec::new()),
                weights: weight.map(|_| Vec::new()),
                columns: kept.iter().map(column).collect(),
                ..Points::default()
            },
            radii: radius.map(|_| Vec::new()),
            kept,
            weight,
            radius,
            value,
            cubes,
            summaries: fields.iter().map(Field::summary).collect(),
            fields,
            scan: scan(header),
            withheld: 0,
            kinds: Kinds::default(),
        }
    }

    /// Whether fields are read beside those that every record has here.
    fn needs_fields(&self) -> bool {
        let meant = [self.weight, self.radius, self.value];
        !self.kept.is_empty() || meant.iter().any(Option::is_some)
    }

    /// Makes room for so many points more.
    fn reserve(&mut self, path: &Path, count: u64) -> Result<(), PointsError> {
        let Points { positions, values, weights, columns, .. } = &mut self.points;
        let points = positions.len() as u64 + count;
        let radii = &mut self.radii;
        let found = [&*values, &*weights, &*radii];
        let numbers = 3 + found.iter().filter(|column| column.is_some()).count();
        let bytes = 8 * (numbers + columns.len()) as u64;
        let columns = columns.iter_mut().map(|column| &mut column.values);
        let mut columns = values.iter_mut().chain(weights).chain(radii).chain(columns);
        let more = usize::try_from(count).unwrap_or(usize::MAX);
        let room = try_reserve(positions, more, String::new);
        room.and_then(|()| columns.try_for_each(|column| try_reserve(column, more, String::new)))
            .map_err(|_| PointsError::Room {
                path: path.into(),
                points,
                bytes: points.saturating_mul(bytes),
            })
    }

    /// Counts a point. Returns whether it is taken, as far as cubes do not decide.
    fn takes(&mut self, record: &Record<'_>) -> bool {
        let Self { options, scan, .. } = self;
        if options.region.as_ref().is_some_and(|region| !region.contains(record.place)) {
            return false;
        }
        let (bytes, class) = (record.bytes, record.class);
        let flags = record.flags(self.is_extended);
        let number = if self.is_extended { bytes[14] & 15 } else { bytes[14] & 7 };
        *scan.classes.entry(class).or_default() += 1;
        *scan.returns.entry(number).or_default() += 1;
        count_flags(&mut scan.flags, flags);
        if options.classes.as_ref().is_some_and(|classes| !classes.contains(&class)) {
            return false;
        }
        self.withheld += u64::from(flags & WITHHELD != 0);
        flags & WITHHELD == 0 || options.withheld
    }

    /// Counts a point, and takes it unless the options leave it out.
    fn take(&mut self, path: &Path, record: &Record<'_>) -> Result<(), PointsError> {
        if self.points.positions.len() == self.points.positions.capacity() {
            self.reserve(path, ROOM)?;
        }
        let is_taken = self.takes(record);
        let Self { options, points, fields, .. } = self;
        let is_described =
            options.region.as_ref().is_none_or(|region| region.contains(record.place));
        if options.describe && is_described {
            for (summary, field) in self.summaries.iter_mut().zip(&*fields) {
                summary.add(field.value(record.bytes));
            }
        }
        if !is_taken {
            return Ok(());
        }
        self.kinds.count(record.flags(self.is_extended), record.class);
        if self.cubes.as_mut().is_some_and(|cubes| !cubes.takes(record.place)) {
            return Ok(());
        }
        let number = |index: usize| fields[index].value(record.bytes);
        points.positions.push(record.place);
        let value = self.value.map_or(f64::from(record.intensity), number);
        points.values.get_or_insert_default().push(value);
        if let (Some(weights), Some(weight)) = (&mut points.weights, self.weight) {
            weights.push(number(weight));
        }
        if let (Some(radii), Some(radius)) = (&mut self.radii, self.radius) {
            radii.push(number(radius));
        }
        for (column, &index) in points.columns.iter_mut().zip(&self.kept) {
            column.values.push(number(index));
        }
        Ok(())
    }

    /// The points and their metadata. Says how many are withheld, and refuses a file without any of those that are asked for.
    fn finish(
        self,
        path: &Path,
        crs: Option<Crs>,
        header: las::Header,
    ) -> Result<(Points, ModelMetadata), PointsError> {
        let Self { options, mut points, radii, mut scan, withheld, .. } = self;
        if let (true, Some(region)) = (scan.returns.is_empty(), &options.region) {
            let bounds = header.bounds();
            let [low, high] = [bounds.min, bounds.max].map(|corner| [corner.x, corner.y, corner.z]);
            return Err(region.without_points(path, [low, high]));
        }
        if withheld > 0 && !options.withheld {
            if points.is_empty() {
                let reason = Reason::choice(
                    Setting::Withheld,
                    format!("holds {withheld} points, all of them withheld"),
                    advice!["give ", Setting::Withheld, " to take them"],
                );
                return Err(format(path, reason));
            }
            tracing::warn!(
                "{}: {withheld} points are flagged as withheld, which are not to be processed: they are left out \
                 unless `withheld` asks for them",
                shown(path)
            );
        }
        if let (true, Some(classes)) = (points.is_empty(), &options.classes) {
            let asked = listed(classes.iter().copied());
            let there = listed(scan.classes.keys().copied());
            let what = format!("has no points of class {asked}; it has points of {there}");
            return Err(format(path, Reason::content(what, "choose among these, or read all")));
        }
        take_radii(path, &mut points, radii)?;
        let time = self.summaries.iter().find(|summary| summary.name == GPS_TIME);
        scan.time = time.and_then(|time| Some([time.min?, time.max?]));
        let unit = crs.as_ref().map(|crs| crs.length).unwrap_or_default();
        let metadata = ModelMetadata::default()
            .coordinates(Coordinates { unit, ..Coordinates::default() })
            .crs(crs)
            .scan(Some(scan))
            .las(Some(LasHeader::of(header)))
            .columns(self.summaries)
            .notes(self.kinds.notes());
        Ok((points, metadata))
    }
}

/// What a file states beside its points.
///
/// # Errors
/// The errors of [`read`], as far as they are not about points.
pub(crate) fn header(file: &OpenFile) -> Result<las::Header, PointsError> {
    if !file.start().starts_with(b"LASF") {
        return Err(format(file.path(), Reason::other("is not a LAS file")));
    }
    Ok(Source::open(file)?.header)
}

/// The descriptions of extra bytes of a file.
pub(crate) fn described(header: &las::Header) -> &[u8] {
    let mut records = header.vlrs().iter().chain(header.evlrs());
    let found = records.find(|record| is_of(record, "LASF_Spec", EXTRA_BYTES));
    found.map_or(&[], |record| &record.data)
}

/// Whether a record has this user and number.
pub(crate) fn is_of(record: &las::Vlr, user: &str, number: u16) -> bool {
    (record.user_id.as_str(), record.record_id) == (user, number)
}

/// The id of the record that describes extra bytes.
pub(crate) const EXTRA_BYTES: u16 = 4;

/// What the header states of a scan, before its points are counted.
fn scan(header: &las::Header) -> ScanSummary {
    let version = header.version();
    let format = header.point_format();
    ScanSummary {
        version: format!("{}.{}", version.major, version.minor),
        point_format: format.to_u8().unwrap_or_default() & 63,
        compressed: format.is_compressed,
        time_of: match header.gps_time_type() {
            las::GpsTimeType::Week => "GPS week",
            las::GpsTimeType::Standard => "GPS, less 10⁹ s",
        },
        ..ScanSummary::default()
    }
}

fn count_flags(counts: &mut Flags, flags: u8) {
    let Flags { withheld, overlap, synthetic, key_point } = counts;
    for (count, flag) in [(synthetic, 1), (key_point, 2), (withheld, WITHHELD), (overlap, 8)] {
        *count += u64::from(flags & flag != 0);
    }
}

/// Classes with their names, as in `2 (ground), 5 (high vegetation)`.
fn listed(classes: impl Iterator<Item = u8>) -> String {
    let one = |class: u8| format!("{class} ({})", ScanSummary::class_name(class));
    classes.map(one).collect::<Vec<_>>().join(", ")
}

/// The flag of points that must not be processed.
const WITHHELD: u8 = 4;
/// The other flags, and the classes of points that a user may want to leave out, with their names.
const FLAGS: [(u8, &str); 3] =
    [(1, "synthetic"), (2, "key points"), (8, "in an overlap of swaths")];
const CLASSES: [(u8, &str); 3] =
    [(7, "noise (class 7)"), (12, "in an overlap (class 12)"), (18, "high noise (class 18)")];

/// The numbers of points of each kind that a user may want to leave out.
#[derive(Default)]
struct Kinds {
    flags: [u64; FLAGS.len()],
    classes: [u64; CLASSES.len()],
}

impl Kinds {
    fn count(&mut self, flags: u8, class: u8) {
        for (count, (flag, _)) in self.flags.iter_mut().zip(FLAGS) {
            *count += u64::from(flags & flag != 0);
        }
        for (count, (known, _)) in self.classes.iter_mut().zip(CLASSES) {
            *count += u64::from(class == known);
        }
    }

    fn notes(&self) -> Vec<String> {
        let names = FLAGS.iter().chain(&CLASSES).map(|(_, name)| name);
        let counts = self.flags.iter().chain(&self.classes).zip(names);
        counts
            .filter(|(count, _)| **count > 0)
            .map(|(count, name)| format!("{count} {name}"))
            .collect()
    }
}

/// The number of points. Version 1.4 counts them in 64 bits, and perhaps also in the field of older versions. If the two differ,
/// PDAL, laspy and `LAStools` use the former, and so do we (LAS 1.4 R15 requires the latter, with an error).
pub(super) fn count(header: &las::raw::Header) -> u64 {
    let large = header.large_file.map_or(0, |large| large.number_of_point_records);
    if large > 0 { large } else { header.number_of_point_records.into() }
}

/// Warns if the two numbers of points differ.
fn say_counts(path: &Path, header: &las::raw::Header) {
    let old = u64::from(header.number_of_point_records);
    let Some(large) = header.large_file.map(|large| large.number_of_point_records) else { return };
    if old > 0 && old != large {
        tracing::warn!(
            "{}: counts {old} points for programs that do not know LAS 1.4, and {large} in its own field: {} are read",
            shown(path),
            count(header)
        );
    }
}

/// A LAS file without the number of points in the field of older versions, which the library would prefer.
struct WithoutOldCount<R> {
    reader: R,
    at: u64,
}

impl<R: Read> Read for WithoutOldCount<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        const FIELD: Range<u64> = 107..111;
        let found = self.reader.read(bytes)?;
        if self.at < FIELD.end {
            let places = (self.at..).zip(&mut bytes[..found]);
            places.filter(|(at, _)| FIELD.contains(at)).for_each(|(_, byte)| *byte = 0);
        }
        self.at += found as u64;
        Ok(found)
    }
}

impl<R: Seek> Seek for WithoutOldCount<R> {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        self.at = self.reader.seek(place)?;
        Ok(self.at)
    }

    // Seeking by 0 would empty the buffer of the reader.
    fn stream_position(&mut self) -> io::Result<u64> {
        Ok(self.at)
    }
}

/// Refuses a compressed file whose claims about its compression do not match its content. Returns the claims, if the file is
/// compressed.
fn check_compression(
    path: &Path,
    reader: &mut (impl Read + Seek),
    header: &las::raw::Header,
    length: u64,
) -> Result<Option<Claims>, PointsError> {
    let io = |error: io::Error| match error.kind() {
        io::ErrorKind::UnexpectedEof => {
            format(path, Reason::truncated("ends inside its compressed points: it is truncated"))
        }
        _ => io_error(path)(error).into(),
    };
    let Some(claims) = Claims::of(reader, header, length).map_err(io)? else { return Ok(None) };
    let mut claims = claims.map_err(|reason| format(path, reason))?;
    claims.check(reader).map_err(io)?.map_err(|reason| format(path, reason))?;
    Ok(Some(claims))
}

/// Refuses a file that has fewer points than it claims, or that has points but claims none; scales that are 0 or not numbers; and
/// claims that the library would trust: more bytes of points than 64 bits can count, and an extended record longer than the file,
/// for which it would allocate memory. Returns the header, and the claims about its compression.
fn check(file: &OpenFile) -> Result<(las::raw::Header, Option<Claims>), PointsError> {
    let (path, length) = (file.path(), file.length());
    let mut reader = file.reader()?;
    let header =
        las::raw::Header::read_from(&mut reader).map_err(|error| unreadable(path, error))?;
    let scales = [header.x_scale_factor, header.y_scale_factor, header.z_scale_factor];
    let offsets = [header.x_offset, header.y_offset, header.z_offset];
    for (name, scale, offset) in [0, 1, 2].map(|k| (COLUMNS[k], scales[k], offsets[k])) {
        if !scale.is_finite() || scale == 0.0 || !offset.is_finite() {
            let what =
                format!("has scale {scale} and offset {offset} for {name}, which place nothing");
            return Err(format(
                path,
                Reason::content(what, "correct its header, or write it again"),
            ));
        }
    }
    let record = u64::from(header.point_data_record_length).max(1);
    let count = count(&header);
    let bytes = count.checked_mul(record);
    if bytes.and_then(|bytes| bytes.checked_add(header.offset_to_point_data.into())).is_none() {
        let what = "claims more bytes of points than a number can count";
        return Err(format(path, Reason::content(what, "correct its header, or write it again")));
    }
    say_counts(path, &header);
    let claims = check_compression(path, &mut reader, &header, length)?;
    // Some writers give the position of such records, and their number as 0.
    let behind = header.evlr.filter(|records| records.number_of_evlrs > 0);
    let behind = behind.map(|records| records.start_of_first_evlr);
    let waves = header.start_of_waveform_data_packet_record.filter(|&start| start > 0);
    let end = behind.into_iter().chain(waves).fold(length, u64::min);
    let stored = end.saturating_sub(header.offset_to_point_data.into()) / record;
    if claims.is_none() && stored < count {
        let what = format!("claims {count} points, but has {stored}: it is truncated");
        return Err(format(path, Reason::truncated(what)));
    }
    if claims.is_none() && stored > count {
        let claim = format!("counts {count} points in its header, but has {stored}");
        if count == 0 {
            let what = format!("{claim}: the writer was not closed");
            return Err(format(
                path,
                Reason::content(what, "write it again, with the right count"),
            ));
        }
        tracing::warn!("{}: {claim}; those behind are passed over", shown(path));
    }
    let Some(records) = header.evlr else { return Ok((header, claims)) };
    // The length follows 2 reserved bytes, a user id of 16 and a record id of 2. If it is missing, the library
    // reports that.
    let mut claimed = [0; 8];
    let place = SeekFrom::Start(records.start_of_first_evlr.saturating_add(20));
    if reader.seek(place).and_then(|_| reader.read_exact(&mut claimed)).is_err() {
        return Ok((header, claims));
    }
    let claimed = u64::from_le_bytes(claimed);
    if claimed > length {
        let what =
            format!("claims a record of {claimed} bytes in a file of {length}: it is truncated");
        return Err(format(path, Reason::truncated(what)));
    }
    Ok((header, claims))
}

fn unreadable(path: &Path, error: las::Error) -> PointsError {
    let cut = |error: &io::Error| error.kind() == io::ErrorKind::UnexpectedEof;
    let what = format!("is not a readable LAS file: {error}");
    format(
        path,
        match error {
            las::Error::Io(error) if cut(&error) => {
                Reason::truncated("ends inside its records: it is truncated")
            }
            _ => Reason::other(what),
        },
    )
}
