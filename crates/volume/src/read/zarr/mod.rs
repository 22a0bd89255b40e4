//! Zarr arrays, and pyramids of them as OME-Zarr lays them out.

mod open;
mod samples;
mod shards;

use std::path::Path;

use walpha_base::Monitor;
use zarrs::array::Array;
use zarrs::filesystem::FilesystemStore;

use super::described::{Described, Encoding};
use super::format_error;
use super::frames::Frames;
use crate::source::Source;
use crate::{Dims, Endian, Frame, Reason, Volume, VolumeError};

use open::open;
use samples::{ZarrBoxes, check_chunk, dtype, samples};

/// Reads a Zarr array of version 2 or 3 in a folder, or a level of an OME-Zarr pyramid (0, the finest,
/// unless `level` says otherwise).
///
/// The last three axes are z, y and x; those before them count volumes, of which
/// the one numbered `frame_index` is read. Scale and translation
/// of a pyramid give the frame. Memory for the samples and some rows of chunks at a time.
pub(crate) fn read(
    path: &Path,
    level: Option<u32>,
    frame_index: Option<u64>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let Stored { array, leading, dims, frame } = open(path, level, frame_index)?;
    let (dtype, samples) = samples(path, &array, dims.bounded()?, &leading, monitor)?;
    let (endian, encoding) = (Endian::Little, Encoding::Raw);
    Described { dims, dtype, endian, frame, encoding, frames: Frames::ONE }.volume(samples)
}

/// The same, to be read part by part.
pub(crate) fn source(
    path: &Path,
    level: Option<u32>,
    frame_index: Option<u64>,
) -> Result<Source, VolumeError> {
    let Stored { array, leading, dims, frame } = open(path, level, frame_index)?;
    let dtype = dtype(path, array.data_type())?;
    let axes = array.dimensionality();
    let chunk = array.chunk_shape(&vec![0; axes]).map_err(|error| damaged(path, &error))?;
    let grain = [1, 2, 3].map(|axis| chunk[axes - axis].get() as usize);
    check_chunk(path, &chunk, dims)?;
    let parts = ZarrBoxes { path: path.into(), array, leading };
    Ok(Source::new(dims, frame, dtype, grain, Box::new(parts)))
}

/// An array of a store, and where the volume in it is.
struct Stored {
    array: Array<FilesystemStore>,
    /// Indices along the axes before the last three.
    leading: Vec<u64>,
    dims: Dims,
    frame: Frame,
}

fn damaged(path: &Path, error: &dyn std::fmt::Display) -> VolumeError {
    let what = format!("is a Zarr store that cannot be read ({error})");
    format_error(path, Reason::damaged(what))
}
