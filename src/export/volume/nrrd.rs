use std::io::{self, Write};

use super::write_volume_raw;
use crate::volume::Volume;

/// Writes a volume as NRRD with its samples raw behind the header. The space of its directions is
/// not named, because a volume does not know it.
///
/// # Errors
/// Whatever `out` returns.
pub fn write_volume_nrrd(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    let [x, y, z] = volume.dims().xyz();
    let vector = |[a, b, c]: [f64; 3]| format!("({a},{b},{c})");
    let axes = volume.frame().axes().map(vector).join(" ");
    write!(
        out,
        "NRRD0005\n# Complete NRRD file format specification at:\n\
         # http://teem.sourceforge.net/nrrd/format.html\n\
         type: float\ndimension: 3\nspace dimension: 3\nsizes: {x} {y} {z}\n\
         space directions: {axes}\nkinds: domain domain domain\nendian: little\nencoding: raw\n\
         space origin: {}\n\n",
        vector(volume.frame().origin)
    )?;
    write_volume_raw(volume, out)
}
