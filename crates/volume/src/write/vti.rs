use std::io::{self, Write};

use super::raw;
use crate::stated::field_data;
use crate::{Coordinates, Space, Volume};

/// Writes a volume as VTI, VTK's image data: point data `value`, appended raw. A known space is LPS; the
/// the field data `SPACE` and `UNIT` say so.
///
/// # Errors
/// Whatever `out` returns.
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
