//! LAS and LAZ, the formats of laser scanners.

use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

use walpha_base::advice::{Setting, advice};
use walpha_base::shown::shown;

use super::crs::ReferenceSystem;
use super::las_fields::{Field, GPS_TIME, fields};
use super::laz::{Claims, Records};
use super::{COLUMNS, Points, PointsError, format};
use crate::{Column, ColumnSummary, Crs, Flags, ModelMetadata, PointOptions, ScanSummary};
use walpha_volume::{Coordinates, OpenFile, Reason, io_error};

/// The number of bytes of points read at once: a header may claim records of up to 64 KiB, and more of them than the file has.
const BATCH: u64 = 1 << 22;

/// Reads the positions of the points, of some classes (ASPRS codes) or of all, and their intensities as values. Withheld points
/// are left out unless they are requested. Coordinates are doubles, computed with the file's scales and offsets.
pub(crate) fn read(
    file: &OpenFile,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = file.path();
    let (header, claims) = check(file)?;
    let claimed = count(&header);
    let fail = |error| unreadable(path, error);
    let reader = file.owned_reader()?;
    let reader = if claimed == u64::from(header.number_of_point_records) {
        las::Reader::new(reader)
    } else {
        las::Reader::new(WithoutOldCount { reader, at: 0 })
    };
    let mut reader = reader.map_err(fail)?;
    let records = || reader.header().vlrs().iter().chain(reader.header().evlrs());
    let system = ReferenceSystem::of(records());
    if !options.describe {
        system.check().map_err(|reason| format(path, reason))?;
    }
    let described = records()
        .find(|record| (record.user_id.as_str(), record.record_id) == ("LASF_Spec", EXTRA_BYTES));
    let described = described.map_or(&[][..], |record| &record.data);
    let mut taken = Taken::new(reader.header(), described, options);
    let record = u64::from(reader.header().point_format().len()).max(1);
    let at_once = (BATCH / record).max(1);
    let mut batch = las::PointDataBuilder::new().for_header(reader.header()).build();
    let mut found = 0;
    let whole = options.describe || !taken.kept.is_empty();
    let mut packed = match claims {
        None => None,
        Some(claims) => {
            let description = reader.header().laz_vlr().map_err(fail)?;
            let records = Records::new(
                file.owned_reader()?,
                claims.data,
                claims.compressor,
                description,
                whole,
            );
            Some(records.map_err(|error| fail(error.into()))?)
        }
    };
    while found < claimed {
        match &mut packed {
            None => {
                if reader.fill_points(at_once, &mut batch).map_err(fail)? == 0 {
                    break;
                }
            }
            Some(records) => {
                let records = records.fill(batch.resize_for(at_once.min(claimed - found) as usize));
                records.map_err(|error| fail(error.into()))?;
            }
        }
        let places = batch.x().zip(batch.y()).zip(batch.z()).map(|((x, y), z)| [x, y, z]);
        let records = batch.raw_bytes().chunks_exact(batch.record_len());
        let rows = places.zip(batch.intensity()).zip(batch.classification()).zip(records);
        for (((place, intensity), class), record) in rows {
            found += 1;
            taken.take(place, intensity, class, record);
        }
    }
    if found != claimed {
        let reason =
            Reason::truncated(format!("claims {claimed} points, but has {found}: it is truncated"));
        return Err(format(path, reason));
    }
    if reader.header().point_format().has_waveform {
        tracing::warn!("{}: waveforms of its points are passed over", shown(path));
    }
    taken.finish(path, system.crs())
}

/// The points that were read, and what is counted of all.
struct Taken<'a> {
    options: &'a PointOptions,
    is_extended: bool,
    fields: Vec<Field>,
    /// The indices of the fields whose columns are kept.
    kept: Vec<usize>,
    summaries: Vec<ColumnSummary>,
    scan: ScanSummary,
    withheld: u64,
    kinds: Kinds,
    points: Points,
}

impl<'a> Taken<'a> {
    fn new(header: &las::Header, described: &[u8], options: &'a PointOptions) -> Self {
        let format = *header.point_format();
        let fields = fields(format, described);
        let is_kept = |&index: &usize| options.attributes.keeps(&fields[index].name);
        let kept: Vec<usize> = (0..fields.len()).filter(is_kept).collect();
        let column =
            |&index: &usize| Column { name: fields[index].name.clone(), values: Vec::new() };
        Self {
            options,
            is_extended: format.is_extended,
            points: Points {
                values: Some(Vec::new()),
                columns: kept.iter().map(column).collect(),
                ..Points::default()
            },
            kept,
            summaries: fields.iter().map(Field::summary).collect(),
            fields,
            scan: scan(header),
            withheld: 0,
            kinds: Kinds::default(),
        }
    }

    /// Counts a point, and takes it unless the options leave it out.
    fn take(&mut self, place: [f64; 3], intensity: u16, class: u8, record: &[u8]) {
        let Self { options, scan, points, .. } = self;
        // In formats 0 to 5 the flags are above the class, in the others in the byte before it (LAS 1.4 R15, tables 8 and 16).
        let flags = if self.is_extended { record[15] & 15 } else { record[15] >> 5 };
        let number = if self.is_extended { record[14] & 15 } else { record[14] & 7 };
        *scan.classes.entry(class).or_default() += 1;
        *scan.returns.entry(number).or_default() += 1;
        count_flags(&mut scan.flags, flags);
        if options.describe {
            for (summary, field) in self.summaries.iter_mut().zip(&self.fields) {
                summary.add(field.value(record));
            }
        }
        if options.classes.as_ref().is_some_and(|classes| !classes.contains(&class)) {
            return;
        }
        self.withheld += u64::from(flags & WITHHELD != 0);
        if flags & WITHHELD == 0 || options.withheld {
            self.kinds.count(flags, class);
            points.positions.push(place);
            points.values.get_or_insert_default().push(f64::from(intensity));
            for (column, &index) in points.columns.iter_mut().zip(&self.kept) {
                column.values.push(self.fields[index].value(record));
            }
        }
    }

    /// The points and their metadata. Says how many are withheld, and refuses a file without any of those that are asked for.
    fn finish(self, path: &Path, crs: Option<Crs>) -> Result<(Points, ModelMetadata), PointsError> {
        let Self { options, points, mut scan, withheld, .. } = self;
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
            let what = format!("has no point of class {asked}, but of {there}");
            return Err(format(path, Reason::content(what, "choose among these, or read all")));
        }
        let time = self.summaries.iter().find(|summary| summary.name == GPS_TIME);
        scan.time = time.and_then(|time| Some([time.min?, time.max?]));
        let unit = crs.as_ref().map(|crs| crs.length).unwrap_or_default();
        let metadata = ModelMetadata::default()
            .coordinates(Coordinates { unit, ..Coordinates::default() })
            .crs(crs)
            .scan(Some(scan))
            .columns(self.summaries)
            .notes(self.kinds.notes());
        Ok((points, metadata))
    }
}

/// The id of the record that describes extra bytes.
const EXTRA_BYTES: u16 = 4;

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
    let claims = claims.map_err(|reason| format(path, reason))?;
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
