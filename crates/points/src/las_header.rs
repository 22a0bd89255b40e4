//! What a LAS file states beside its points, to be written again.

use std::path::Path;

use super::PointsError;
use walpha_volume::OpenFile;

/// What a LAS file states beside its points and their columns: its version and point format, scales and offsets of coordinates, and
/// its records, such as the coordinate reference system and descriptions of extra bytes. A LAS file that is written with it has the
/// same.
#[derive(Clone, Debug, PartialEq)]
pub struct LasHeader {
    #[cfg(feature = "las")]
    header: std::sync::Arc<las::Header>,
}

impl LasHeader {
    /// Reads that of a file.
    ///
    /// # Errors
    /// The file cannot be read, or is not LAS or LAZ; the feature `las` is not built in.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, PointsError> {
        let file = OpenFile::open(path.as_ref())?;
        #[cfg(feature = "las")]
        return Ok(Self::of(super::read::las::header(&file)?));
        #[cfg(not(feature = "las"))]
        {
            let reason = walpha_volume::Reason::Without { what: "LAS, LAZ", feature: "las" };
            Err(super::read::format(file.path(), reason))
        }
    }

    #[cfg(feature = "las")]
    pub(crate) fn of(header: las::Header) -> Self {
        Self { header: header.into() }
    }

    #[cfg(feature = "las")]
    pub(crate) fn header(&self) -> &las::Header {
        &self.header
    }
}
