use std::io::{self, Write};

use super::raw;
use crate::{Coordinates, Frame, Volume};

/// Writes a volume as `MetaImage` (`.mha`), ITK's own format, with raw samples after the header. A
/// known space is LPS there, in millimetres. A volume in voxels has no place.
///
/// # Errors
/// Whatever `out` returns.
pub(crate) fn metaimage(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    let [x, y, z] = volume.dims().xyz();
    write!(
        out,
        "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n\
         CompressedData = False\n{}DimSize = {x} {y} {z}\nElementType = MET_FLOAT\n\
         ElementDataFile = LOCAL\n",
        place(volume.frame())
    )?;
    raw(volume, out)
}

fn place(frame: &Frame) -> String {
    if *frame == Frame::VOXEL {
        return String::new();
    }
    let frame = frame.to(Coordinates::PATIENT);
    let numbers = |numbers: &[f64]| {
        let numbers: Vec<String> = numbers.iter().map(f64::to_string).collect();
        numbers.join(" ")
    };
    // The rows of the matrix are the grid's axes.
    let axes = [0, 1, 2].map(|c| frame.direction.map(|row| row[c]));
    let unit = frame.coordinates.unit;
    let unit =
        if unit.is_known() { format!("DistanceUnits = {}\n", unit.ascii()) } else { String::new() };
    format!(
        "TransformMatrix = {}\nOffset = {}\n{unit}ElementSpacing = {}\n",
        numbers(axes.as_flattened()),
        numbers(&frame.origin),
        numbers(&frame.spacing)
    )
}
