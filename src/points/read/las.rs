//! LAS and LAZ, what laser scanners write.

use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use super::{Points, PointsError, format};
use crate::volume::{OpenFile, Reason};

/// Bytes of points read at once. A header may claim records of 64 KiB each, and more than there are.
const BATCH: u64 = 1 << 22;

/// Reads the places of the points, and their intensity as values. Numbers are those that the file's
/// scales and offsets make, in doubles.
pub(crate) fn read(file: &OpenFile) -> Result<Points, PointsError> {
    let path = file.path();
    check(file)?;
    let fail = |error| unreadable(path, &error);
    let mut reader = las::Reader::new(file.owned_reader()?).map_err(fail)?;
    let mut points = Points { values: Some(Vec::new()), ..Points::default() };
    let record = u64::from(reader.header().point_format().len()).max(1);
    let at_once = (BATCH / record).max(1);
    let mut batch = las::PointDataBuilder::new().for_header(reader.header()).build();
    while reader.fill_points(at_once, &mut batch).map_err(fail)? > 0 {
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

/// Refuses what the library that reads points would believe: so many of them that their bytes are no number of
/// 64 bits, and an extended record that is longer than the file, for which it would take the memory.
fn check(file: &OpenFile) -> Result<(), PointsError> {
    let (path, length) = (file.path(), file.length());
    let mut reader = file.reader()?;
    let header =
        las::raw::Header::read_from(&mut reader).map_err(|error| unreadable(path, &error))?;
    let count = header.large_file.map_or(0, |large| large.number_of_point_records);
    let bytes = count.checked_mul(header.point_data_record_length.into());
    if bytes.and_then(|bytes| bytes.checked_add(header.offset_to_point_data.into())).is_none() {
        let what = "claims more bytes of points than a number can count: its header is damaged";
        return Err(format(path, Reason::damaged(what)));
    }
    let Some(records) = header.evlr else { return Ok(()) };
    // Its length comes after 2 bytes, a name of 16 and a number of 2. If it is not there, the library says so.
    let mut claimed = [0; 8];
    let place = SeekFrom::Start(records.start_of_first_evlr.saturating_add(20));
    if reader.seek(place).and_then(|_| reader.read_exact(&mut claimed)).is_err() {
        return Ok(());
    }
    let claimed = u64::from_le_bytes(claimed);
    if claimed > length {
        let what =
            format!("claims a record of {claimed} bytes in a file of {length}: it is damaged");
        return Err(format(path, Reason::damaged(what)));
    }
    Ok(())
}

fn unreadable(path: &Path, error: &las::Error) -> PointsError {
    format(path, Reason::other(format!("is no LAS file that can be read: {error}")))
}
