//! Outputs that never are in memory as a whole: VTK's parallel formats, a file for each block and one that names
//! them; and arrays of Zarr.

mod vtk;
#[cfg(feature = "zarr")]
mod zarr;

use std::path::Path;

use serde::{Deserialize, Serialize};
use walpha_base::Monitor;

use super::file::BlockFile;
use super::merge::Numbers;
use super::rows::read_rows;
use super::{Alone, BlocksError, Merged, Plan, Team};
use crate::export::{Filled, NewFolder, Target, put_all};
use crate::shape::{Complex, NO_COMPONENT, Sheets};

use vtk::Kind;

/// A format that blocks are written to one after the other. VTK's programs open theirs by the file that names the
/// others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Pieces {
    /// `.pvtu`: all simplices, as [`Vtu`](crate::export::Vtu) has them.
    Grid,
    /// `.pvtp`: boundary, singular edges and vertices, as [`Vtp`](crate::export::Vtp) has them.
    Surface,
    /// `.zarr`: a folder of arrays with all simplices (`docs/clusters.md`).
    #[cfg(feature = "zarr")]
    Arrays,
}

impl Pieces {
    /// The formats, and the extensions of what they are opened by.
    pub const ALL: &[(Self, &str)] = &[
        (Self::Grid, "pvtu"),
        (Self::Surface, "pvtp"),
        #[cfg(feature = "zarr")]
        (Self::Arrays, "zarr"),
    ];

    /// Refuses a place where this cannot be written, before the work.
    ///
    /// # Errors
    /// A folder of arrays is there already, or what is there is an input.
    pub fn check(self, path: &Path) -> Result<(), BlocksError> {
        match self {
            Self::Grid | Self::Surface => {
                Target::check(path)?;
                Target::check(&Kind::folder(path))?;
            }
            #[cfg(feature = "zarr")]
            Self::Arrays => {
                if path.exists() {
                    let source = std::io::ErrorKind::AlreadyExists.into();
                    return Err(BlocksError::Written { path: path.into(), source });
                }
                Target::check(path)?;
            }
        }
        Ok(())
    }

    /// What the extension of a path asks for.
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        Self::ALL.iter().find(|(_, known)| extension == *known).map(|(pieces, _)| *pieces)
    }

    /// Writes the shape of merged blocks, several blocks at a time in memory, one for each thread. Points are
    /// named by their index in the volume, `voxel`. Of VTK's formats there is a file for each block that
    /// has simplices, in a folder beside `path` of its name without the extension.
    ///
    /// # Errors
    /// A block cannot be read, a file not written.
    pub fn write(self, plan: &Plan, merged: &Merged, path: &Path) -> Result<(), BlocksError> {
        self.write_with(plan, Some(merged), path, &Alone)
    }

    /// The same as one of a team. Of VTK's formats each process writes some of the pieces, and the first, which
    /// has what was merged, the file that names them; arrays are written by the first alone.
    ///
    /// # Errors
    /// As [`Pieces::write`]. The others of the team would wait for a process that ends with an error.
    pub fn write_with(
        self,
        plan: &Plan,
        merged: Option<&Merged>,
        path: &Path,
        team: &dyn Team,
    ) -> Result<(), BlocksError> {
        let Written { new, files } = self.fill(plan, merged, path, team, &Monitor::noop())?;
        // The first process has the file that names the others.
        team.barrier();
        let put = || -> Result<(), BlocksError> {
            put_all(files)?;
            if let Some(new) = new {
                new.keep();
            }
            Ok(())
        };
        if team.is_first() {
            team.barrier();
            put()
        } else {
            put()?;
            team.barrier();
            Ok(())
        }
    }

    /// Writes all that a process of a team has to write, but puts nothing in its place yet.
    pub(crate) fn fill(
        self,
        plan: &Plan,
        merged: Option<&Merged>,
        path: &Path,
        team: &dyn Team,
        monitor: &Monitor,
    ) -> Result<Written, BlocksError> {
        match self {
            Self::Grid => Kind::Grid.fill(plan, merged, path, team, monitor),
            Self::Surface => Kind::Surface.fill(plan, merged, path, team, monitor),
            #[cfg(feature = "zarr")]
            Self::Arrays => {
                let arrays =
                    merged.map(|merged| zarr::write(plan, merged, path, monitor)).transpose()?;
                Ok(Written { files: arrays.into_iter().collect(), new: None })
            }
        }
    }
}

/// Pieces that are complete, and wait to be put in their places; dropped, they go.
#[derive(Debug)]
pub(crate) struct Written {
    /// The one that names the others is the last.
    pub files: Vec<Filled>,
    /// The folder of the pieces, if it was made for them. After the files: it goes when it is empty.
    pub new: Option<NewFolder>,
}

/// What a block has of the shape, with common numbers.
struct Piece {
    complex: Complex,
    voxels: Vec<u64>,
    positions: Vec<[f64; 3]>,
    weights: Vec<f64>,
    values: Vec<f64>,
    components: Vec<u32>,
    sheets: Sheets,
}

impl Piece {
    fn read(plan: &Plan, block: usize, numbers: &Numbers) -> Result<Self, BlocksError> {
        let file = BlockFile::open(plan, block)?;
        let job = &plan.job;
        let voxels = file.voxels()?;
        let place = |&voxel: &u64| job.units.place(&job.frame, job.dims, voxel);
        let common = |component: u32| {
            numbers.components.get(component as usize).copied().unwrap_or(NO_COMPONENT)
        };
        let (complex, sheets) = read_rows(&file, voxels.len(), &numbers.sheets)?;
        Ok(Self {
            positions: voxels.iter().map(place).collect(),
            weights: file.read("weights")?,
            values: file.read("values")?,
            components: file.read::<u32>("components")?.into_iter().map(common).collect(),
            complex,
            voxels,
            sheets,
        })
    }
}
