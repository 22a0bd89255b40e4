//! LAS and LAZ, the formats of laser scanners.

use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use super::{Points, PointsError, format};
use crate::volume::{OpenFile, Reason};

/// Bytes of points read at once: a header may claim records of up to 64 KiB, and more than the file has.
const BATCH: u64 = 1 << 22;

/// Reads the positions of the points, of these classes (ASPRS codes) or of all, and their intensities as values.
/// Coordinates are doubles, computed with the file's scales and offsets.
pub(crate) fn read(file: &OpenFile, classes: Option<&[u8]>) -> Result<Points, PointsError> {
    let path = file.path();
    check(file)?;
    let fail = |error| unreadable(path, &error);
    let mut reader = las::Reader::new(file.owned_reader()?).map_err(fail)?;
    let mut points = Points { values: Some(Vec::new()), ..Points::default() };
    let record = u64::from(reader.header().point_format().len()).max(1);
    let at_once = (BATCH / record).max(1);
    let mut batch = las::PointDataBuilder::new().for_header(reader.header()).build();
    let mut found = 0;
    while reader.fill_points(at_once, &mut batch).map_err(fail)? > 0 {
        let places = batch.x().zip(batch.y()).zip(batch.z()).map(|((x, y), z)| [x, y, z]);
        let rows = places.zip(batch.intensity()).zip(batch.classification());
        for ((place, intensity), class) in rows {
            found += 1;
            if classes.is_none_or(|classes| classes.contains(&class)) {
                points.positions.push(place);
                points.values.get_or_insert_default().push(f64::from(intensity));
            }
        }
    }
    let claimed = reader.header().number_of_points();
    if found != claimed {
        let reason =
            Reason::truncated(format!("claims {claimed} points, but has {found}: it is truncated"));
        return Err(format(path, reason));
    }
    Ok(points)
}

/// Refuses claims that the library would trust: more bytes of points than 64 bits can count, and an extended
/// record longer than the file, for which it would allocate memory.
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
    // The length follows 2 reserved bytes, a user id of 16 and a record id of 2. If it is missing, the library
    // reports that.
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
    format(path, Reason::other(format!("is not a readable LAS file: {error}")))
}
