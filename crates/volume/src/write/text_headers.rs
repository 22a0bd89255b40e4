//! Formats with a header in text and raw samples behind it: NRRD, `MetaImage` and VTI.

use std::io::{self, Write};

use super::plain::raw;
use crate::annotation::field_data;
use crate::{Coordinates, Frame, Space, Volume};

/// Writes a volume as NRRD with raw samples after the header. The grid is written in the volume's own space, which is named; a
/// known space is in millimetres, as ITK and Slicer expect. A volume in voxels has no place.
///
/// # Errors
/// Errors of `out`.
pub(crate) fn nrrd(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    let [x, y, z] = volume.dims().xyz();
    write!(
        out,
        "NRRD0005\n# Complete NRRD file format specification at:\n\
         # http://teem.sourceforge.net/nrrd/format.html\n\
         type: float\ndimension: 3\n{}sizes: {x} {y} {z}\n{}\
         kinds: domain domain domain\nendian: little\nencoding: raw\n\n",
        nrrd_space(volume.frame()),
        nrrd_place(volume.frame()),
    )?;
    raw(volume, out)
}

/// The frame in the coordinates in which it is written.
fn converted(frame: &Frame) -> Frame {
    let space = frame.coordinates.space;
    let patient = Coordinates { space, ..Coordinates::PATIENT };
    if space.is_known() { frame.to(patient) } else { *frame }
}

/// The fields of the space and its unit. NRRD requires them before the vectors in that space.
fn nrrd_space(frame: &Frame) -> String {
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

fn nrrd_place(frame: &Frame) -> String {
    if *frame == Frame::VOXEL {
        return String::new();
    }
    let vector = |[a, b, c]: [f64; 3]| format!("({a},{b},{c})");
    let frame = converted(frame);
    let axes = frame.axes().map(vector).join(" ");
    format!("space directions: {axes}\nspace origin: {}\n", vector(frame.origin))
}

/// Writes a volume as `MetaImage` (`.mha`), ITK's own format, with raw samples after the header. A known space is converted to
/// LPS in millimetres. A volume in voxels has no place.
///
/// # Errors
/// Errors of `out`.
pub(crate) fn metaimage(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    let [x, y, z] = volume.dims().xyz();
    write!(
        out,
        "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n\
         CompressedData = False\n{}DimSize = {x} {y} {z}\nElementType = MET_FLOAT\n\
         ElementDataFile = LOCAL\n",
        metaimage_place(volume.frame())
    )?;
    raw(volume, out)
}

fn metaimage_place(frame: &Frame) -> String {
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

/// Writes a volume as VTI, VTK's image data: point data `value`, appended raw. A known space is converted to LPS; the field data
/// `SPACE` and `UNIT` state the coordinates.
///
/// # Errors
/// Errors of `out`.
pub(crate) fn vti(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    let [x, y, z] = volume.dims().xyz().map(|size| size - 1);
    let extent = format!("0 {x} 0 {y} 0 {z}");
    let lps = Coordinates { space: Space::Lps, unit: volume.frame().coordinates.unit };
    let frame = volume.frame().to(lps);
    let numbers =
        |numbers: &[f64]| numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    write!(
        out,
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         <ImageData WholeExtent=\"{extent}\" Origin=\"{}\" Spacing=\"{}\" Direction=\"{}\">\n{}\
         <Piece Extent=\"{extent}\">\n<PointData Scalars=\"value\">\n\
         <DataArray type=\"Float32\" Name=\"value\" format=\"appended\" offset=\"0\"/>\n\
         </PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_",
        numbers(&frame.origin),
        numbers(&frame.spacing),
        numbers(frame.direction.as_flattened()),
        field_data(frame.coordinates),
    )?;
    out.write_all(&(volume.dims().samples() as u64 * 4).to_le_bytes())?;
    raw(volume, out)?;
    write!(out, "\n</AppendedData>\n</VTKFile>\n")
}
