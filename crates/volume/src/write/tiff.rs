use std::io::{self, Cursor, Write};

use tiff::TiffError;
use tiff::encoder::{Rational, TiffEncoder, TiffKind, TiffKindBig, TiffKindStandard};
use tiff::tags::{CompressionMethod, PhotometricInterpretation, ResolutionUnit, SampleFormat, Tag};

use crate::{LengthUnit, Volume};

/// Writes a volume as TIFF with a page for each slice, or as `BigTIFF` if it has more than 4 GB. Spacing and its unit are stored
/// where `ImageJ` looks for them; TIFF has no origin and no directions. The file is first built in memory.
///
/// # Errors
/// Errors of `out`.
pub(crate) fn tiff(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    /// The space reserved for the directories of the pages.
    const BESIDE: usize = 1 << 29;
    let mut bytes = Cursor::new(Vec::new());
    let large = volume.dims().samples() > (u32::MAX as usize - BESIDE) / size_of::<f32>();
    let written = if large {
        TiffEncoder::<_, TiffKindBig>::new_big(&mut bytes)
            .and_then(|file| pages(volume, file, large))
    } else {
        TiffEncoder::<_, TiffKindStandard>::new(&mut bytes)
            .and_then(|file| pages(volume, file, large))
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
    large: bool,
) -> Result<(), TiffError> {
    let [nx, ny, nz] = volume.dims().xyz();
    let [x, y, z] = volume.frame().spacing;
    let unit = match volume.frame().coordinates.unit {
        LengthUnit::Voxel => "pixel",
        known => known.ascii(),
    };
    let about = format!("ImageJ=1.53t\nimages={nz}\nslices={nz}\nunit={unit}\nspacing={z}\n");
    let bytes = (nx * ny * size_of::<f32>()) as u64;
    let mut start = 0;
    for slice in 0..nz as u64 {
        let mut page = file.image_directory()?;
        if slice == 0 {
            // All samples are in one piece, as in ImageJ's files and as their readers expect.
            start = page.write_data(volume.as_slice())?;
        }
        page.write_tag(Tag::ImageWidth, nx as u32)?;
        page.write_tag(Tag::ImageLength, ny as u32)?;
        page.write_tag(Tag::BitsPerSample, 32u16)?;
        page.write_tag(Tag::SampleFormat, [SampleFormat::IEEEFP].as_slice())?;
        page.write_tag(Tag::Compression, CompressionMethod::None)?;
        page.write_tag(Tag::PhotometricInterpretation, PhotometricInterpretation::BlackIsZero)?;
        page.write_tag(Tag::SamplesPerPixel, 1u16)?;
        page.write_tag(Tag::RowsPerStrip, ny as u32)?;
        let offset = start + slice * bytes;
        if large {
            page.write_tag(Tag::StripOffsets, offset)?;
            page.write_tag(Tag::StripByteCounts, bytes)?;
        } else {
            page.write_tag(Tag::StripOffsets, offset as u32)?;
            page.write_tag(Tag::StripByteCounts, bytes as u32)?;
        }
        page.write_tag(Tag::XResolution, pixels_a_unit(x))?;
        page.write_tag(Tag::YResolution, pixels_a_unit(y))?;
        page.write_tag(Tag::ResolutionUnit, ResolutionUnit::None)?;
        page.write_tag(Tag::ImageDescription, about.as_str())?;
        page.finish()?;
    }
    Ok(())
}

/// 1/spacing, as nearly as the ratio of two 32-bit numbers can express it.
fn pixels_a_unit(spacing: f64) -> Rational {
    let scale = f64::from(u32::MAX) / spacing.max(1.0);
    // Whole millionths are used if they fit, because most spacings are such.
    let scale = if scale > 1e6 { 1e6 } else { scale };
    Rational { n: scale.round() as u32, d: (spacing * scale).round().max(1.0) as u32 }
}
