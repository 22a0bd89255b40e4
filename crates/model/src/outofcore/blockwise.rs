//! Writers of outputs that are written block by block and never complete in memory: VTK's parallel formats (a file for each block
//! and an index), and arrays of Zarr.

use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use walpha_base::Monitor;
use walpha_base::parallel::prelude::*;

use super::whole::MergedBlock;
use super::{BlocksError, Merged, Plan, Team};
use crate::export::{
    Filled, Membership, NewFolder, PointData, Provenance, Target, put_all, write_grid,
    write_surface,
};
use walpha_shape::{Complex, Surface};

/// A format to which blocks are written one after the other. VTK's programs open the index, the file that names the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum BlockwiseFormat {
    /// `.pvtu`: all simplices, as in [`Vtu`](crate::export::Vtu).
    Grid,
    /// `.pvtp`: boundary, singular edges and vertices, as in [`Vtp`](crate::export::Vtp).
    Surface,
    /// `.zarr`: a folder of arrays with all simplices (`docs/clusters.md`).
    #[cfg(feature = "zarr")]
    Arrays,
}

impl BlockwiseFormat {
    /// The formats, with the extensions of the files or folders to open.
    pub const ALL: &[(Self, &str)] = &[
        (Self::Grid, "pvtu"),
        (Self::Surface, "pvtp"),
        #[cfg(feature = "zarr")]
        (Self::Arrays, "zarr"),
    ];

    /// Refuses a path at which the output cannot be written, before the work.
    ///
    /// # Errors
    /// A folder of arrays exists already, or an input would be replaced.
    pub fn check(self, path: &Path) -> Result<(), BlocksError> {
        match self {
            Self::Grid | Self::Surface => {
                Target::check(path)?;
                Target::check(&VtkFormat::folder(path))?;
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

    /// The format for the extension of a path.
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        Self::ALL.iter().find(|(_, known)| extension == *known).map(|(pieces, _)| *pieces)
    }

    /// Writes the shape of merged blocks, with several blocks at a time in memory, one for each thread. Points are named by their
    /// index in the volume, `voxel`. In VTK's formats there is a file for each block that has simplices, in a folder beside
    /// `path` that has its name without the extension.
    ///
    /// The first process of a team has the merged shape. In VTK's formats each process writes some of the pieces, and the first also
    /// writes the index; arrays are written by the first alone.
    ///
    /// # Errors
    /// A block cannot be read, or a file cannot be written. A process that returns an error leaves the rest of the team waiting.
    pub fn write(
        self,
        plan: &Plan,
        merged: Option<&Merged>,
        path: &Path,
        team: &dyn Team,
    ) -> Result<(), BlocksError> {
        let Written { new, files } = self.fill(plan, merged, path, team)?;
        team.first_last(|| put_all(files))?;
        if let Some(new) = new {
            new.keep();
        }
        Ok(())
    }

    /// Writes all files of a process of a team, but does not move them to their destinations yet.
    #[doc(hidden)]
    pub fn fill(
        self,
        plan: &Plan,
        merged: Option<&Merged>,
        path: &Path,
        team: &dyn Team,
    ) -> Result<Written, BlocksError> {
        let monitor = &*Monitor::current();
        match self {
            Self::Grid => VtkFormat::Grid.fill(plan, merged, path, team, monitor),
            Self::Surface => VtkFormat::Surface.fill(plan, merged, path, team, monitor),
            #[cfg(feature = "zarr")]
            Self::Arrays => {
                let arrays = merged
                    .map(|merged| super::zarr::write(plan, merged, path, monitor))
                    .transpose()?;
                Ok(Written { files: arrays.into_iter().collect(), new: None })
            }
        }
    }
}

/// Complete pieces that have not been moved to their destinations yet. If dropped, they are removed.
#[derive(Debug)]
pub struct Written {
    /// The files. The index is the last.
    pub files: Vec<Filled>,
    /// The folder of the pieces, if it was created for them. It is declared after the files, as it is removed if it is empty.
    pub new: Option<NewFolder>,
}

/// The two formats.
#[derive(Clone, Copy)]
pub(super) enum VtkFormat {
    Grid,
    Surface,
}

impl VtkFormat {
    /// The folder for the files of blocks.
    pub(super) fn folder(path: &Path) -> PathBuf {
        path.with_extension("")
    }

    /// The extension of the file of a block.
    fn extension(self) -> &'static str {
        match self {
            Self::Grid => "vtu",
            Self::Surface => "vtp",
        }
    }

    /// Fills the pieces of this process and, if it is the first, the index as the last file.
    pub(super) fn fill(
        self,
        plan: &Plan,
        merged: Option<&Merged>,
        path: &Path,
        team: &dyn Team,
        monitor: &Monitor,
    ) -> Result<Written, BlocksError> {
        let index = if team.is_first() { Some(Target::open(path)?) } else { None };
        let received;
        let (numbers, is_flat) = if let (1, Some(merged)) = (team.size(), merged) {
            (&merged.numbers, merged.is_flat)
        } else {
            received =
                team.broadcast(merged.map(|merged| (merged.numbers.clone(), merged.is_flat)));
            (&received.0, received.1)
        };
        let folder = Self::folder(path);
        let stem = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let new = NewFolder::make(&folder)
            .map_err(|source| BlocksError::Written { path: folder.clone(), source })?;
        let name = |block: usize| format!("{stem}_{block}.{}", self.extension());
        let own: Vec<usize> = team.own(plan.blocks.len()).collect();
        let work = monitor.units(own.len() as u64);
        let fill = |block: usize| -> Result<Option<(usize, Filled)>, BlocksError> {
            work.add(1)?;
            let piece = MergedBlock::read(plan, block, &numbers[block])?;
            if piece.complex.vertices.is_empty() && piece.complex.edges.is_empty() {
                return Ok(None);
            }
            let file: PathBuf = folder.join(name(block));
            let filled = Target::open(&file)?.fill(|out| piece.write(self, plan, is_flat, out))?;
            Ok(Some((block, filled)))
        };
        let filled: Result<Vec<_>, _> = own.into_par_iter().map(fill).collect();
        let (blocks, files): (Vec<usize>, Vec<Filled>) = filled?.into_iter().flatten().unzip();
        let mut written = Written { files, new };
        let mut blocks = team.reduce(blocks, Extend::extend);
        blocks.sort_unstable();
        if let Some(index) = index {
            let names: Vec<String> =
                blocks.into_iter().map(|block| format!("{stem}/{}", name(block))).collect();
            written.files.push(index.fill(|out| self.write_index(&names, is_flat, out))?);
        }
        Ok(written)
    }

    fn write_index(
        self,
        names: &[String],
        is_flat: bool,
        out: &mut dyn Write,
    ) -> std::io::Result<()> {
        let kind = match self {
            Self::Grid => "PUnstructuredGrid",
            Self::Surface => "PPolyData",
        };
        let of_cells: &[(&str, &str)] = match self {
            Self::Grid => &[("UInt8", "class")],
            Self::Surface if is_flat => &[("UInt8", "class"), ("UInt32", "component")],
            Self::Surface => &[
                ("UInt8", "class"),
                ("UInt32", "component"),
                ("Int32", "sheet"),
                ("Int32", "sheet_behind"),
            ],
        };
        let arrays = |arrays: &[(&str, &str)]| -> String {
            let array = |(kind, name): &(&str, &str)| {
                format!("<PDataArray type=\"{kind}\" Name=\"{name}\"/>\n")
            };
            arrays.iter().map(array).collect()
        };
        let of_points = [("Float64", "weight"), ("Float64", "value"), ("Int64", "voxel")];
        write!(
            out,
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
             <{kind} GhostLevel=\"0\">\n<PPointData>\n{}</PPointData>\n<PCellData>\n{}</PCellData>\n\
             <PPoints>\n<PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n</PPoints>\n",
            arrays(&of_points),
            arrays(of_cells),
        )?;
        for name in names {
            writeln!(out, "<Piece Source=\"{}\"/>", escaped(name))?;
        }
        write!(out, "</{kind}>\n</VTKFile>\n")
    }
}

/// Escapes a text for an attribute in XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

impl MergedBlock {
    fn write(
        &self,
        kind: VtkFormat,
        plan: &Plan,
        is_flat: bool,
        out: &mut dyn Write,
    ) -> std::io::Result<()> {
        let (job, balls) = (&plan.job, plan.job.recipe.balls);
        let squared = balls.power_weights(&self.weights, plan.alpha());
        let squared = squared.map_err(std::io::Error::other)?;
        let corners = PointData {
            positions: &self.positions,
            weights: squared.as_deref().unwrap_or(&self.weights),
            values: Some(&self.values),
            voxels: Some(&self.voxels),
            columns: Vec::new(),
        };
        let coordinates = job.units.coordinates_of(&job.frame);
        let input = Some(job.input.as_str());
        let alpha = balls.power_alpha(plan.alpha());
        let made = Provenance { alpha, coordinates, input, solid: None, laid_out: false };
        match kind {
            VtkFormat::Grid => write_grid(&self.complex, &self.corners(), &corners, &made, out),
            VtkFormat::Surface => {
                let surface = Surface::of_complex(&self.complex);
                let sheets = (!is_flat).then_some(&self.sheets);
                let parts = Membership { components: &self.components, sheets };
                write_surface(&surface, &corners, &parts, &made, out)
            }
        }
    }

    /// The points that are corners of simplices, ascending.
    fn corners(&self) -> Vec<u32> {
        let Complex { cells, facets, edges, vertices } = &self.complex;
        let mut used = vec![false; self.voxels.len()];
        let rows = (cells.rows().as_flattened().iter())
            .chain(facets.rows().as_flattened())
            .chain(edges.rows().as_flattened())
            .chain(vertices.rows().as_flattened());
        rows.for_each(|&v| used[v as usize] = true);
        (0..).zip(used).filter(|(_, used)| *used).map(|(v, _)| v).collect()
    }
}
