use std::io::{self, Cursor, Write};

use tiff::TiffError;
use tiff::encoder::colortype::Gray32Float;
use tiff::encoder::{Rational, TiffEncoder, TiffKind, TiffKindBig, TiffKindStandard};
use tiff::tags::Tag;

use crate::volume::{LengthUnit, Volume};

/// Writes a volume as TIFF, a page for each slice, or BigTIFF where it has more than 4 GB. Spacing and
/// its unit stand where ImageJ looks for them; TIFF knows no origin and no directions. The file stands
/// in memory first.
///
/// # Errors
/// Whatever `out` returns.
pub fn write_volume_tiff(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    /// For the directories of the pages.
    const BESIDE: usize = 1 << 29;
    let mut bytes = Cursor::new(Vec::new());
    let large = volume.dims().samples() > (u32::MAX as usize - BESIDE) / size_of::<f32>();
    let written = if large {
        TiffEncoder::<_, TiffKindBig>::new_big(&mut bytes).and_then(|file| pages(volume, file))
    } else {
        TiffEncoder::<_, TiffKindStandard>::new(&mut bytes).and_then(|file| pages(volume, file))
    };
    written.map_err(|error| match error {
        TiffError::IoError(error) => error,
        other => io::Error::other(other),
    })?;
    out.write_all(bytes.get_ref())
}

fn pages<K: TiffKind>(
    volume: &Volume,
    mut file: TiffEncoder<&mut Cursor<Vec<u8>>, K>,
) -> Result<(), TiffError> {
    let [nx, ny, nz] = volume.dims().xyz();
    let [x, y, z] = volume.frame().spacing;
    let unit = volume.frame().coordinates.unit;
    let unit = match unit {
        LengthUnit::Voxel => "pixel",
        known => known.ascii(),
    };
    let about = format!("ImageJ=1.53t\nimages={nz}\nslices={nz}\nunit={unit}\nspacing={z}\n");
    for slice in volume.as_slice().chunks(nx * ny) {
        let mut page = file.new_image::<Gray32Float>(nx as u32, ny as u32)?;
        let tags = page.encoder();
        tags.write_tag(Tag::ImageDescription, about.as_str())?;
        tags.write_tag(Tag::XResolution, pixels_a_unit(x))?;
        tags.write_tag(Tag::YResolution, pixels_a_unit(y))?;
        page.write_data(slice)?;
    }
    Ok(())
}

/// 1/spacing, as near as two numbers of 32 bits say it.
fn pixels_a_unit(spacing: f64) -> Rational {
    let scale = f64::from(u32::MAX) / spacing.max(1.0);
    // Whole millionths where they fit, because most spacings are.
    let scale = if scale > 1e6 { 1e6 } else { scale };
    Rational { n: scale.round() as u32, d: (spacing * scale).round().max(1.0) as u32 }
}
