//! LAS and LAZ, what laser scanners write.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use super::{Points, PointsError, format};
use crate::volume::Reason;

/// Bytes of points read at once. A header may claim records of 64 KiB each, and more than there are.
const BATCH: u64 = 1 << 22;

/// Reads the places of the points, and their intensity as values. Numbers are those that the file's
/// scales and offsets make, in doubles.
pub(crate) fn read(path: &Path) -> Result<Points, PointsError> {
    let said = |error: las::Error| {
        format(path, Reason::other(format!("is no LAS file that can be read: {error}")))
    };
    ends(path).map_err(said)?.ok_or_else(|| {
        let reason = "claims more bytes of points than a number can count: its header is damaged";
        format(path, Reason::damaged(reason))
    })?;
    let mut reader = las::Reader::from_path(path).map_err(said)?;
    let mut points = Points { values: Some(Vec::new()), ..Points::default() };
    let record = u64::from(reader.header().point_format().len()).max(1);
    let at_once = (BATCH / record).max(1);
    let mut batch = las::PointDataBuilder::new().for_header(reader.header()).build();
    while reader.fill_points(at_once, &mut batch).map_err(said)? > 0 {
        let places = batch.x().zip(batch.y()).zip(batch.z());
        points.positions.extend(places.map(|((x, y), z)| [x, y, z]));
        points.values.get_or_insert_default().extend(batch.intensity().map(f64::from));
    }
    let claimed = reader.header().number_of_points();
    if points.len() as u64 != claimed {
        let reason = Reason::truncated(format!(
            "claims {claimed} points, but has {}: it is truncated",
            points.len()
        ));
        return Err(format(path, reason));
    }
    Ok(points)
}

/// Where the points end, uncompressed; `None` if that is no number of 64 bits. The library that reads them
/// multiplies without a check.
fn ends(path: &Path) -> las::Result<Option<u64>> {
    let header = las::raw::Header::read_from(BufReader::new(File::open(path)?))?;
    let count = header.large_file.map_or(0, |large| large.number_of_point_records);
    let bytes = count.checked_mul(header.point_data_record_length.into());
    Ok(bytes.and_then(|bytes| bytes.checked_add(header.offset_to_point_data.into())))
}
