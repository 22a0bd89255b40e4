//! VTK's parallel formats: a file for each block, and one that names them.

use std::io::Write;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::file::BlockFile;
use super::merge::Numbers;
use super::{Alone, BlocksError, Merged, Plan, Team};
use crate::export::{Corners, Made, Parts, Target, write_grid, write_surface};
use crate::shape::{Class, Complex, NO_COMPONENT, Sheets, Simplices, Surface};

/// A format of a file for each block, which VTK's programs open by the file that names them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Pieces {
    /// `.pvtu`: all simplices, as [`Vtu`](crate::export::Vtu) has them.
    Grid,
    /// `.pvtp`: boundary, singular edges and vertices, as [`Vtp`](crate::export::Vtp) has them.
    Surface,
}

impl Pieces {
    /// The formats, and the extensions of the files that name the others.
    pub const ALL: [(Self, &str); 2] = [(Self::Grid, "pvtu"), (Self::Surface, "pvtp")];

    /// What the extension of a path asks for.
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        Self::ALL.iter().find(|(_, known)| extension == *known).map(|(pieces, _)| *pieces)
    }

    /// The extension of the file of a block.
    fn extension(self) -> &'static str {
        match self {
            Self::Grid => "vtu",
            Self::Surface => "vtp",
        }
    }

    /// Writes the shape of merged blocks: beside `path`, in a folder of its name without the
    /// extension, a file for each block that has simplices, then `path`. Points are named by
    /// their index in the volume, as `voxel`. Several blocks at a time are in memory, one for each thread.
    ///
    /// # Errors
    /// A block cannot be read, a file not written.
    pub fn write(self, plan: &Plan, merged: &Merged, path: &Path) -> Result<(), BlocksError> {
        self.write_with(plan, Some(merged), path, &Alone)
    }

    /// The same as one of a team: each process writes some of the pieces, and the first, which has what was
    /// merged, the file that names them.
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
        let index = if team.is_first() { Some(Target::open(path)?) } else { None };
        let told;
        let numbers = if let (1, Some(merged)) = (team.size(), merged) {
            &merged.numbers
        } else {
            told = team.told(merged.map(|merged| merged.numbers.clone()));
            &told
        };
        let folder = path.with_extension("");
        let stem = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        std::fs::create_dir_all(&folder)
            .map_err(|source| BlocksError::Io { path: folder.clone(), source })?;
        let name = |block: usize| format!("{stem}_{block}.{}", self.extension());
        let write = |block: usize| -> Result<Option<usize>, BlocksError> {
            let piece = Piece::read(plan, block, &numbers[block])?;
            if piece.complex.vertices.is_empty() && piece.complex.edges.is_empty() {
                return Ok(None);
            }
            let file: PathBuf = folder.join(name(block));
            Target::open(&file)?.write(|out| piece.write(self, plan, out))?;
            Ok(Some(block))
        };
        let own: Vec<usize> = team.own(plan.blocks.len()).collect();
        let written: Result<Vec<_>, _> = own.into_par_iter().map(write).collect();
        let written: Vec<usize> = written?.into_iter().flatten().collect();
        let mut written = team.joined(written, Extend::extend);
        written.sort_unstable();
        if let Some(index) = index {
            let names: Vec<String> =
                written.into_iter().map(|block| format!("{stem}/{}", name(block))).collect();
            index.write(|out| self.write_index(&names, out))?;
        }
        Ok(())
    }

    fn write_index(self, names: &[String], out: &mut dyn Write) -> std::io::Result<()> {
        let kind = match self {
            Self::Grid => "PUnstructuredGrid",
            Self::Surface => "PPolyData",
        };
        let of_cells: &[(&str, &str)] = match self {
            Self::Grid => &[("UInt8", "class")],
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

/// A text as an attribute of XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
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
        let voxels = file.read::<u64>("voxels")?;
        let place = |&voxel: &u64| job.units.place(&job.frame, job.dims, voxel);
        let common = |component: u32| {
            numbers.components.get(component as usize).copied().unwrap_or(NO_COMPONENT)
        };
        let cells = file.read::<[u32; 4]>("cells")?;
        let complex = Complex {
            cells: rows(cells.iter().map(|_| Class::Interior as u8).collect(), cells),
            facets: rows(file.read("facet_classes")?, file.read("facets")?),
            edges: rows(file.read("edge_classes")?, file.read("edges")?),
            vertices: rows(file.read("vertex_classes")?, file.read("vertices")?),
        };
        let sheet = |name: u32| numbers.sheets[name as usize];
        let mut names = file.read::<u32>("facet_sheets")?.into_iter().map(sheet);
        let mut next = || names.next().unwrap_or_default();
        let mut sheets = Sheets::default();
        for class in complex.facets.classes() {
            match class {
                Class::Regular => sheets.regular.push(next()),
                Class::Singular => sheets.singular.push([next(), next()]),
                _ => {}
            }
        }
        sheets.edges = file.read::<u32>("edge_sheets")?.into_iter().map(sheet).collect();
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

    fn write(&self, pieces: Pieces, plan: &Plan, out: &mut dyn Write) -> std::io::Result<()> {
        let job = &plan.job;
        let corners = Corners {
            positions: &self.positions,
            weights: &self.weights,
            values: Some(&self.values),
            voxels: Some(&self.voxels),
        };
        let coordinates = job.units.coordinates_of(&job.frame);
        let made = Made { alpha: plan.alpha(), coordinates, input: Some(&job.input) };
        match pieces {
            Pieces::Grid => write_grid(&self.complex, &self.corners(), &corners, &made, out),
            Pieces::Surface => {
                let surface = Surface::of_complex(&self.complex);
                let parts = Parts { components: &self.components, sheets: Some(&self.sheets) };
                write_surface(&surface, &corners, &parts, &made, out)
            }
        }
    }

    /// The points that simplices have as corners, ascending.
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

/// Simplices with the numbers of their classes.
fn rows<const N: usize>(classes: Vec<u8>, rows: Vec<[u32; N]>) -> Simplices<N> {
    let class = |number: u8| Class::from_number(number).unwrap_or(Class::Exterior);
    let mut simplices = Simplices::default();
    rows.into_iter().zip(classes).for_each(|(row, number)| simplices.push(row, class(number)));
    simplices
}
