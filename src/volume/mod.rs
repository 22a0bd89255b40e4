//! Floor 0: a grid of samples, where it comes from, and how its values become gray levels.
//!
//! ```
//! use walpha::Gray;
//! use walpha::volume::{ReadOptions, open};
//!
//! // A sample by its name; a file or folder by its path.
//! let volume = open("sample:phantom@16", &ReadOptions::default())?;
//! assert_eq!(volume.dims().xyz(), [16, 16, 16]);
//! let (volume, range) = volume.into_gray(Gray::Automatic)?;
//! assert!(volume.value_range().1 <= 255.0 && range.low < range.high);
//! # Ok::<(), walpha::VolumeError>(())
//! ```

mod coordinates;
mod dtype;
mod error;
mod extent;
mod formats;
mod gray;
mod grid;
mod part;
mod read;
mod reason;
mod sample;
mod source;
pub(crate) mod stated;
#[expect(clippy::module_inception, reason = "the type gives the floor its name")]
mod volume;
mod write;

pub use coordinates::{Conversion, Coordinates, LengthUnit, Space};
pub use dtype::{Dtype, Endian, UnknownName};
pub use error::VolumeError;
pub use extent::Extent;
pub use formats::{
    FORMATS, Keeps, UnknownFormat, VolumeFormat, VolumeWriter, data_files, format_name, read,
    series,
};
pub(crate) use formats::{begins_as_volume, built, files_of, is_vtk, is_vtk_xml, start_of};
pub use gray::{Gray, GrayRange};
pub use grid::{Dims, Frame};
pub(crate) use grid::{any_size, inverse};
pub use part::{Region, downsample};
pub(crate) use read::NpyFile;
#[cfg(any(feature = "formats", feature = "las"))]
pub(crate) use read::io_error;
#[cfg(feature = "formats")]
pub(crate) use read::{Element, Lines, VtkPoints, VtkXml};
pub use read::{RawLayout, ReadOptions, Series};
pub use reason::Reason;
pub use sample::{SAMPLES, open, phantom, sample};
pub use source::Source;
#[cfg(feature = "zarr")]
pub use source::convert;
pub use volume::{Nan, Volume};
