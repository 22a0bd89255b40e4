//! LAS and LAZ, with all columns.

use std::borrow::Cow;
use std::io::{self, Cursor, Write};

use las::point::Format;
use las::{Builder, PointDataBuilder, Transform, Vector, Version, Vlr, Writer};

use super::Content;
use crate::attributes::is_same;
use crate::colours::COLOUR_COLUMNS;
use crate::read::las::{EXTRA_BYTES, described, is_of};
use crate::read::las_fields::{
    DESCRIPTION, Field, GPS_TIME, INTENSITY, description, extra, fields, of_numbers, stored_name,
};
use crate::{Crs, WeightedPoints};

/// The number of points that are written at once.
const BATCH: usize = 1 << 16;
/// The number of a return, and how many there are: from 1 on.
const RETURNS: [&str; 2] = ["return_number", "number_of_returns"];
/// What is stated to have written a file.
const SOFTWARE: &str = concat!("walpha ", env!("CARGO_PKG_VERSION"));
/// The user of records about the file, and the user and number of the coordinate system as well-known text.
const SPECIFICATION: &str = "LASF_Spec";
const WKT: (&str, u16) = ("LASF_Projection", 2112);
/// The bit of the header that says that the coordinate system is well-known text, and its byte.
const IS_WKT: u8 = 1 << 4;
const ENCODING: usize = 6;
/// The byte of the header from which on it has the largest and the least x, y and z.
const EXTENT: usize = 179;

/// A column to write: its name, numbers, and the type that its file has.
struct Source<'a> {
    name: &'a str,
    kind: &'a str,
    numbers: Cow<'a, [f64]>,
}

/// Writes points as LAS, compressed or not. The version, format, scales, offsets and records are those of the LAS file that the
/// points come from; otherwise it is version 1.4 with a format from 6 on, and scales are the coarsest powers of ten that move no
/// point, or else the finest that 32 bits allow. A column is stored in the field of its name, or as extra bytes: of the type that
/// is stated for it, or as doubles. So are weights, unless all are 0, and values, unless a column has them.
///
/// # Errors
/// Errors of the writer; a number that its field cannot hold, and a coordinate beyond the scale that is kept.
pub(crate) fn write(
    content: &Content<'_>,
    is_compressed: bool,
    out: &mut dyn Write,
) -> io::Result<()> {
    let sources = sources(content);
    check_names(&sources)?;
    let kept = content.metadata.las.as_ref().map(crate::LasHeader::header);
    let mut builder = match kept {
        Some(header) => Builder::from(header.clone()),
        None => new_builder(content),
    };
    let described = kept.map_or(&[][..], described);
    let nameless = kept.map_or(0, |header| nameless(header, described));
    if nameless > 0 {
        tracing::warn!(
            "{nameless} bytes of each point are not described as numbers, and are not written"
        );
    }
    let (described, fields) = layout(&mut builder, described, &sources);
    builder.point_format.is_compressed = is_compressed;
    if kept.is_none() {
        builder.transforms = transforms(content.points.positions());
    }
    let records = std::mem::take(&mut builder.vlrs);
    builder.vlrs = records.into_iter().filter(is_carried).collect();
    builder.evlrs.retain(is_carried);
    if !described.is_empty() {
        builder.vlrs.push(Vlr {
            user_id: SPECIFICATION.to_owned(),
            record_id: EXTRA_BYTES,
            description: "extra bytes".to_owned(),
            data: described,
        });
    }
    (builder.vlr_padding, builder.point_padding) = (Vec::new(), Vec::new());
    builder.generating_software = SOFTWARE.into();
    let is_wkt =
        builder.vlrs.iter().chain(&builder.evlrs).any(|record| is_of(record, WKT.0, WKT.1));
    let is_extended = builder.point_format.is_extended;
    let header = builder.into_header().map_err(other)?;
    let file = packed(content.points, &header, &sources, &fields)?;
    let mut bytes = file.into_inner();
    // The library rounds the box of the points outwards, although they are multiples of the scale.
    let ends = extent(content.points.positions(), header.transforms());
    for (place, end) in bytes[EXTENT..].chunks_mut(8).zip(ends.as_flattened()) {
        place.copy_from_slice(&end.to_le_bytes());
    }
    if is_extended && !is_wkt {
        // The library states well-known text for these formats, even where keys of GeoTIFF or nothing state a system.
        bytes[ENCODING] &= !IS_WKT;
    }
    out.write_all(&bytes)?;
    out.flush()
}

/// The columns to write.
fn sources<'a>(content: &Content<'a>) -> Vec<Source<'a>> {
    const DOUBLE: &str = "float64";
    let Content { points, columns, metadata, .. } = *content;
    let kind = |name: &str| {
        let stated = metadata.columns.iter().find(|summary| summary.name == name);
        stated.map_or(DOUBLE, |summary| summary.kind)
    };
    let source = |column: &'a crate::Column| Source {
        name: &column.name,
        kind: kind(&column.name),
        numbers: Cow::Borrowed(&column.values),
    };
    let mut sources: Vec<_> = columns.iter().map(source).collect();
    if metadata.las.is_none() {
        widen_colours(&mut sources);
    }
    if points.weights().iter().any(|&weight| weight != 0.0) {
        sources.push(Source { name: "weight", kind: DOUBLE, numbers: points.weights().into() });
    }
    let known = |values: &[f64]| {
        let place = |axis: usize| points.positions().iter().map(move |place| place[axis]);
        columns.iter().any(|column| column.values == values)
            || (0..3).any(|axis| place(axis).eq(values.iter().copied()))
    };
    if let Some(values) = points.values().filter(|values| !known(values)) {
        let fits = |&value: &f64| value.fract() == 0.0 && (0.0..=65_535.0).contains(&value);
        let is_intensity = !sources.iter().any(|source| is_same(source.name, INTENSITY))
            && values.iter().all(fits);
        let name = if is_intensity { INTENSITY } else { "value" };
        sources.push(Source { name, kind: DOUBLE, numbers: values.into() });
    }
    sources
}

/// Makes colours of 8 bits ones of 16 bits, which LAS has (LAS 1.4 R15, table 10).
fn widen_colours(sources: &mut [Source<'_>]) {
    let is_colour =
        |source: &&mut Source<'_>| COLOUR_COLUMNS.iter().any(|name| is_same(source.name, name));
    let is_byte = |&number: &f64| number.fract() == 0.0 && (0.0..=255.0).contains(&number);
    let mut colours: Vec<_> = sources.iter_mut().filter(is_colour).collect();
    if colours.iter().all(|colour| colour.numbers.iter().all(is_byte)) {
        for colour in &mut colours {
            // 255 becomes 65 535.
            colour.numbers.to_mut().iter_mut().for_each(|number| *number *= 257.0);
        }
    }
}

/// The header of a file whose points do not come from LAS.
fn new_builder(content: &Content<'_>) -> Builder {
    let mut builder = Builder::from((1, 4));
    builder.date = None;
    builder.point_format = Format::new(6).expect("it is known");
    let crs = content.metadata.crs.as_ref();
    if let Some(text) = crs.and_then(Crs::well_known_text) {
        builder.vlrs.push(Vlr {
            user_id: WKT.0.to_owned(),
            record_id: WKT.1,
            description: "WKT".to_owned(),
            // It ends with a zero.
            data: text.bytes().chain([0]).collect(),
        });
    }
    builder
}

/// Whether a record of a file is written again. Those are not that describe how it is packed, waveforms, and extra bytes, which
/// are described anew.
fn is_carried(record: &Vlr) -> bool {
    const WAVEFORMS: std::ops::Range<u16> = 100..355;
    const PACKETS: u16 = 65_535;
    let number = record.record_id;
    let is_own = number == EXTRA_BYTES || WAVEFORMS.contains(&number) || number == PACKETS;
    !(["laszip encoded", "copc"].contains(&record.user_id.as_str())
        || record.user_id == SPECIFICATION && is_own)
}

/// How many extra bytes of each point no description makes numbers.
fn nameless(header: &las::Header, described: &[u8]) -> usize {
    let (_, known) = of_numbers(described);
    usize::from(header.point_format().extra_bytes).saturating_sub(known)
}

/// Refuses columns of which the stored names are equal, and warns of names that are cut.
fn check_names(sources: &[Source<'_>]) -> io::Result<()> {
    for (k, Source { name, .. }) in sources.iter().enumerate() {
        let stored = stored_name(name);
        let agrees = |other: &&Source<'_>| other.name != *name && stored_name(other.name) == stored;
        if let Some(other) = sources[..k].iter().find(agrees) {
            let what = format!(
                "the columns {:?} and {name:?} agree in the first 32 bytes of their names, which are all that LAS holds: rename one",
                other.name
            );
            return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
        }
        if stored != *name {
            tracing::warn!(
                "the column {name:?} is written as {stored:?}: LAS holds 32 bytes of a name"
            );
        }
    }
    Ok(())
}

/// Makes the point format hold the columns. Returns the descriptions of extra bytes, and all fields, each with its source.
fn layout(
    builder: &mut Builder,
    kept: &[u8],
    sources: &[Source<'_>],
) -> (Vec<u8>, Vec<(Field, Option<usize>)>) {
    let has = |name: &str| sources.iter().any(|source| is_same(source.name, name));
    let format = &mut builder.point_format;
    (format.has_waveform, format.extra_bytes) = (false, 0);
    format.has_gps_time |= has(GPS_TIME);
    format.has_color |= COLOUR_COLUMNS.into_iter().all(has);
    format.has_nir |= format.is_extended && format.has_color && has("nir");
    let (kept, _) = of_numbers(kept);
    let mut described = Vec::new();
    for one in kept.chunks(DESCRIPTION) {
        let (_, size) = of_numbers(one);
        if extra(0, one).iter().any(|field| has(&field.name)) {
            described.extend(one);
            format.extra_bytes += size as u16;
        }
    }
    let known = fields(*format, &described);
    for source in sources {
        if !known.iter().any(|field| is_same(&field.name, source.name)) {
            let is_there = source.numbers.iter().all(|number| !number.is_nan());
            // Of doubles, NaN stands for none.
            let (one, size) = description(source.name, if is_there { source.kind } else { "" });
            described.extend(one);
            format.extra_bytes += size as u16;
        }
    }
    // Before 1.4 the header counts points by five returns only, and the library refuses, with a panic, points of others.
    let returns = sources.iter().find(|source| is_same(source.name, RETURNS[0]));
    let beyond = returns.is_some_and(|source| source.numbers.iter().any(|&number| number > 5.0));
    let version = Version::new(1, 4);
    if !builder.version.supports_point_format(*format) || beyond && builder.version < version {
        builder.version = version;
    }
    let mut free: Vec<usize> = (0..sources.len()).collect();
    let mut take = |field: &Field| {
        let place = free.iter().position(|&k| is_same(sources[k].name, &field.name))?;
        Some(free.remove(place))
    };
    let all = fields(*format, &described).into_iter();
    let all = all.map(|field| {
        let source = take(&field);
        (field, source)
    });
    let all = all.collect();
    (described, all)
}

/// The largest and the least stored x, y and z.
fn extent(places: &[[f64; 3]], transforms: &Vector<Transform>) -> [[f64; 2]; 3] {
    let transforms = [transforms.x, transforms.y, transforms.z];
    [0, 1, 2].map(|axis| {
        let end = |of: fn(f64, f64) -> f64| {
            let end = places.iter().map(|place| place[axis]).reduce(of).unwrap_or_default();
            let stored = transforms[axis].inverse(end);
            stored.map_or(end, |stored| transforms[axis].direct(stored))
        };
        [end(f64::max), end(f64::min)]
    })
}

/// The whole file in memory.
fn packed(
    points: &WeightedPoints,
    header: &las::Header,
    sources: &[Source<'_>],
    fields: &[(Field, Option<usize>)],
) -> io::Result<Cursor<Vec<u8>>> {
    let refused = |index: usize, what: String| {
        io::Error::new(io::ErrorKind::InvalidInput, format!("point {index}: {what}"))
    };
    let transforms = *header.transforms();
    let axes = [transforms.x, transforms.y, transforms.z];
    let length = usize::from(header.point_format().len());
    let has_returns =
        fields.iter().any(|(field, source)| field.name == RETURNS[0] && source.is_some());
    let mut writer = Writer::new(Cursor::new(Vec::new()), header.clone()).map_err(other)?;
    let mut moved = [0.0f64; 3];
    for first in (0..points.len()).step_by(BATCH) {
        let places = &points.positions()[first..points.len().min(first + BATCH)];
        let mut bytes = vec![0; places.len() * length];
        for ((k, place), record) in places.iter().enumerate().zip(bytes.chunks_mut(length)) {
            let index = first + k;
            for axis in 0..3 {
                let stored = axes[axis].inverse(place[axis]).map_err(|_| {
                    let (name, Transform { scale, offset }) = (["x", "y", "z"][axis], axes[axis]);
                    let why = format!(
                        "{name} = {} does not fit scale {scale} and offset {offset}",
                        place[axis]
                    );
                    refused(index, why)
                })?;
                record[4 * axis..4 * axis + 4].copy_from_slice(&stored.to_le_bytes());
                let distance = (axes[axis].direct(stored) - place[axis]).abs();
                moved[axis] = moved[axis].max(distance);
            }
            for (field, source) in fields {
                let number = match source {
                    Some(source) => sources[*source].numbers[index],
                    // A point that is no return is one that readers take for damaged.
                    None if !has_returns && RETURNS.contains(&field.name.as_str()) => 1.0,
                    None => continue,
                };
                field.store(number, record).map_err(|what| refused(index, what))?;
            }
        }
        let batch = PointDataBuilder::new().for_header(header).build_from_bytes(bytes);
        writer.write_points(&batch.map_err(other)?).map_err(other)?;
    }
    if let most @ 1e-300.. = moved.into_iter().fold(0.0, f64::max) {
        tracing::warn!(
            "coordinates are stored as multiples of {}, which moves points by {most:.1e} at most",
            axes.map(|axis| axis.scale.to_string()).join(", ")
        );
    }
    writer.into_inner().map_err(other)
}

/// The scales and offsets for points without any.
fn transforms(places: &[[f64; 3]]) -> Vector<Transform> {
    let axis = |axis: usize| transform(places.iter().map(|place| place[axis]));
    Vector { x: axis(0), y: axis(1), z: axis(2) }
}

/// The coarsest power of ten, at most 1, of which these numbers are multiples from an offset on; otherwise the finest for which
/// they fit in 32 bits. The offset is a multiple of it, or 0.
fn transform(numbers: impl Iterator<Item = f64> + Clone) -> Transform {
    /// The least power that is tried.
    const LEAST: i32 = -12;
    let (low, high) = numbers
        .clone()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let mut known = None;
    for power in (LEAST..=308).rev() {
        let scale: f64 = format!("1e{power}").parse().expect("a number");
        let transform = Transform { scale, offset: offset(low, high, scale) };
        let fits = [low, high].iter().all(|&end| transform.inverse(end).is_ok());
        if !fits {
            break;
        }
        known = Some(transform);
        let is_exact =
            |x: f64| transform.inverse(x).is_ok_and(|stored| transform.direct(stored) == x);
        if power <= 0 && numbers.clone().all(is_exact) {
            break;
        }
    }
    known.unwrap_or(Transform { scale: 1.0, offset: 0.0 })
}

/// 0, if numbers in a range are multiples of the scale that fit in 32 bits; otherwise a multiple of it in the middle.
fn offset(low: f64, high: f64, scale: f64) -> f64 {
    let most = f64::from(i32::MAX) * scale;
    if low >= -most && high <= most {
        return 0.0;
    }
    let whole = f64::midpoint(low, high).round();
    if scale > 1.0 { (whole / scale).round() * scale } else { whole }
}

fn other(error: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> io::Error {
    io::Error::other(error)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(numbers: &[f64]) -> (f64, f64) {
        let Transform { scale, offset } = transform(numbers.iter().copied());
        (scale, offset)
    }

    #[test]
    fn names_that_are_cut_to_one_are_refused() {
        let names = |names: [&str; 2]| {
            check_names(&names.map(|name| Source {
                name,
                kind: "float64",
                numbers: Cow::Borrowed(&[]),
            }))
        };
        let [whole, long] = ["a".repeat(32), "a".repeat(33)];
        for pair in [[&whole, &long], [&long, &whole]] {
            let error = names(pair.map(String::as_str)).unwrap_err().to_string();
            assert!(error.contains("agree in the first 32 bytes"), "{error}");
        }
        names(["a", &long]).unwrap();
    }

    #[test]
    fn bytes_without_a_description_are_counted() {
        let nameless = |extra: u16, described: &[u8]| {
            let mut builder = Builder::from((1, 4));
            builder.point_format = Format::new(6).unwrap();
            builder.point_format.extra_bytes = extra;
            nameless(&builder.into_header().unwrap(), described)
        };
        let (tree, _) = description("treeID", "uint32");
        assert_eq!((nameless(4, &tree), nameless(7, &tree), nameless(7, &[])), (0, 3, 7));
        assert_eq!(nameless(0, &[]), 0);
    }

    #[test]
    fn scales_move_no_point_where_they_can() {
        assert_eq!(of(&[0.0, 7.0, -3.0]), (1.0, 0.0));
        assert_eq!(of(&[691_000.12, 5.5]), (0.01, 0.0));
        // 32 bits do not reach so far from 0 in millimetres.
        assert_eq!(of(&[5_334_000.001, 5_334_060.25]), (0.001, 5_334_030.0));
        let third = [0.0, 1.0 / 3.0];
        let (scale, offset) = of(&third);
        assert_eq!((scale, offset), (1e-9, 0.0));
        let (scale, _) = of(&[-1e300, 1e300]);
        assert!((1e290..1e292).contains(&scale), "{scale}");
        assert_eq!(of(&[5.0]), (1.0, 0.0));
    }
}
