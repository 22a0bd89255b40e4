//! Volumes as files.

mod metaimage;
mod nifti;
mod npy;
mod nrrd;
mod raw;
mod tiff;
mod vti;

use std::io::{self, Write};
use std::path::Path;

pub use metaimage::write_volume_metaimage;
pub use nifti::write_volume_nifti;
pub use npy::write_volume_npy;
pub use nrrd::write_volume_nrrd;
pub use raw::write_volume_raw;
pub use tiff::write_volume_tiff;
pub use vti::write_volume_vti;

use super::UnknownFormat;
use crate::volume::Volume;

/// The formats volumes are written in, chosen by file name extension. Samples are `f32`,
/// little-endian; the frame is written where the format has one, in the space and unit that are its
/// convention.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VolumeFormat {
    /// NRRD, samples raw behind the header.
    Nrrd,
    /// NIfTI-1, or NIfTI-2 where an axis is longer than 32767.
    Nifti,
    /// NIfTI compressed with gzip.
    NiftiGzip,
    /// MetaImage, samples raw behind the header.
    MetaImage,
    /// VTK image data, samples appended raw.
    Vti,
    /// TIFF pages, with spacing as ImageJ has it; no origin and no directions.
    Tiff,
    /// A NumPy array, axes z, y, x; no frame.
    Npy,
    /// Bare samples, x fastest; no header.
    Raw,
}

impl VolumeFormat {
    /// Every format with its extension.
    pub const ALL: [(Self, &str); 9] = [
        (Self::Nrrd, "nrrd"),
        (Self::Nifti, "nii"),
        (Self::NiftiGzip, "nii.gz"),
        (Self::MetaImage, "mha"),
        (Self::Vti, "vti"),
        (Self::Tiff, "tif"),
        (Self::Tiff, "tiff"),
        (Self::Npy, "npy"),
        (Self::Raw, "raw"),
    ];

    /// The format a path asks for.
    ///
    /// # Errors
    /// [`UnknownFormat`] names the ones there are.
    pub fn of(path: &Path) -> Result<Self, UnknownFormat> {
        UnknownFormat::find(path, "a volume", &Self::ALL)
    }

    /// Writes the whole file. The same volume gives the same bytes.
    ///
    /// # Errors
    /// Whatever `out` returns.
    pub fn write(self, volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
        match self {
            Self::Nrrd => write_volume_nrrd(volume, out),
            Self::Nifti => write_volume_nifti(volume, out),
            Self::NiftiGzip => {
                let mut packed = flate2::write::GzEncoder::new(out, flate2::Compression::default());
                write_volume_nifti(volume, &mut packed)?;
                packed.finish().map(drop)
            }
            Self::MetaImage => write_volume_metaimage(volume, out),
            Self::Vti => write_volume_vti(volume, out),
            Self::Tiff => write_volume_tiff(volume, out),
            Self::Npy => write_volume_npy(volume, out),
            Self::Raw => write_volume_raw(volume, out),
        }
    }
}
