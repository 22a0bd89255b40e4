use std::io::{self, Write};

use super::raw;
use crate::{Coordinates, Frame, Space, Volume};

/// Writes a volume as NRRD with raw samples after the header. The grid is written in the volume's own
/// space, which is named; that of a patient in millimetres, as ITK and Slicer expect. A volume in
/// voxels has no place.
///
/// # Errors
/// Whatever `out` returns.
pub(crate) fn nrrd(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    let [x, y, z] = volume.dims().xyz();
    write!(
        out,
        "NRRD0005\n# Complete NRRD file format specification at:\n\
         # http://teem.sourceforge.net/nrrd/format.html\n\
         type: float\ndimension: 3\n{}sizes: {x} {y} {z}\n{}\
         kinds: domain domain domain\nendian: little\nencoding: raw\n\n",
        space(volume.frame()),
        place(volume.frame()),
    )?;
    raw(volume, out)
}

/// The frame as it is written.
fn converted(frame: &Frame) -> Frame {
    let space = frame.coordinates.space;
    let patient = Coordinates { space, ..Coordinates::PATIENT };
    if space.is_known() { frame.to(patient) } else { *frame }
}

/// NRRD wants the space before the vectors in it.
fn space(frame: &Frame) -> String {
    let Coordinates { space, unit } = converted(frame).coordinates;
    let space = match space {
        Space::Lps => "space: left-posterior-superior",
        Space::Ras => "space: right-anterior-superior",
        Space::Las => "space: left-anterior-superior",
        Space::Unknown if *frame == Frame::VOXEL => return String::new(),
        Space::Unknown => "space dimension: 3",
    };
    let unit = if frame.coordinates == Coordinates::default() { "" } else { unit.ascii() };
    format!("{space}\nspace units: \"{unit}\" \"{unit}\" \"{unit}\"\n")
}

fn place(frame: &Frame) -> String {
    if *frame == Frame::VOXEL {
        return String::new();
    }
    let vector = |[a, b, c]: [f64; 3]| format!("({a},{b},{c})");
    let frame = converted(frame);
    let axes = frame.axes().map(vector).join(" ");
    format!("space directions: {axes}\nspace origin: {}\n", vector(frame.origin))
}
