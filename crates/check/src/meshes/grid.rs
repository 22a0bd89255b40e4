//! Cells as VTK lists them in its unstructured grids, in files of either kind.

use super::scan::WRITE_AGAIN;
use super::{Mesh, MeshError, not_tetrahedra};
use crate::schema::{Classes, ComplexFile};
use crate::{Alpha, Class};

/// An unstructured grid of VTK. Arrays are doubles, which hold every index and class.
///
/// A grid that states α is a complex, and has the classes of its simplices or otherwise only the simplices of the shape. Any
/// other grid is the mesh of its tetrahedra, if it has some; triangles in addition to them are its surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grid {
    /// x, y, z of each point.
    pub points: Vec<[f64; 3]>,
    /// Power weights; all 0 if missing.
    pub weights: Option<Vec<f64>>,
    /// VTK's type of each cell.
    pub types: Vec<u8>,
    /// The end of the corners of each cell.
    pub ends: Vec<f64>,
    /// The corners of all cells.
    pub corners: Vec<f64>,
    /// α, if it is stated.
    pub alpha: Option<Alpha>,
    /// The class of each cell, as a number.
    pub classes: Option<Vec<f64>>,
}

const VERTEX: u8 = 1;
const LINE: u8 = 3;
const TRIANGLE: u8 = 5;

impl Grid {
    /// VTK's type of tetrahedra.
    pub const TETRA: u8 = 10;

    /// The name of a type of cells, in the plural (VTK User's Guide, "Linear cell types in VTK").
    pub fn kind_of(cell_type: u8) -> &'static str {
        match cell_type {
            VERTEX => "vertices",
            LINE => "edges",
            TRIANGLE => "triangles",
            Self::TETRA => "tetrahedra",
            2 => "sets of vertices",
            4 => "polylines",
            6 => "strips",
            7 => "polygons",
            8 | 9 => "quadrilaterals",
            11 | 12 => "hexahedra",
            13 => "wedges",
            14 => "pyramids",
            _ => "cells of higher order",
        }
    }

    /// The grid as a mesh.
    ///
    /// # Errors
    /// Cells that are not simplices, arrays that do not fit together, and numbers that are not indices or classes.
    pub fn mesh(self) -> Result<Mesh, MeshError> {
        let Self { points, weights, types, ends, corners, alpha, classes } = self;
        if ends.len() != types.len() {
            let (cells, types) = (ends.len(), types.len());
            let error = MeshError::new(format!("{cells} cells have {types} types"));
            return Err(error.with_advice(WRITE_AGAIN));
        }
        let classes = classes.filter(|_| alpha.is_some());
        let only_cells = alpha.is_none() && types.contains(&Self::TETRA);
        let mut rows = Rows::default();
        let mut ignored: Vec<(&str, u64)> = Vec::new();
        let mut from = 0;
        for (row, (&kind, &end)) in types.iter().zip(&ends).enumerate() {
            let at = |why: String| {
                MeshError::new(why).at(&format!("cell {row}")).with_advice(WRITE_AGAIN)
            };
            let to = end as usize;
            let found = corners.get(from..to).ok_or_else(|| {
                at(format!("its corners are numbers {from} to {end} of {}", corners.len()))
            })?;
            from = to;
            let is_flat = matches!(kind, 1..=9);
            if only_cells && is_flat {
                let name = Self::kind_of(kind);
                match ignored.iter_mut().find(|(other, _)| *other == name) {
                    Some((_, count)) => *count += 1,
                    None => ignored.push((name, 1)),
                }
                continue;
            }
            let size = match kind {
                VERTEX => 1,
                LINE => 2,
                TRIANGLE => 3,
                Self::TETRA => 4,
                _ => return Err(not_tetrahedra(Self::kind_of(kind)).at(&format!("cell {row}"))),
            };
            if found.len() != size {
                return Err(at(format!("it has {} corners, and its type {size}", found.len())));
            }
            let index = |k: usize| {
                let corner = found[k];
                let is_whole =
                    corner.fract() == 0.0 && (0.0..f64::from(u32::MAX)).contains(&corner);
                is_whole
                    .then_some(corner as u32)
                    .ok_or_else(|| at(format!("corner {corner} is not the index of a point")))
            };
            match kind {
                VERTEX => rows.vertices.push(index(0)?),
                LINE => rows.edges.push([index(0)?, index(1)?]),
                TRIANGLE => rows.facets.push([index(0)?, index(1)?, index(2)?]),
                _ => rows.cells.push([index(0)?, index(1)?, index(2)?, index(3)?]),
            }
            if let Some(classes) = &classes {
                let class = class(classes.get(row).copied());
                rows.classes[size - 1]
                    .push(class.ok_or_else(|| at("its class is none of 0 to 3".into()))?);
            }
        }
        let mut complex = ComplexFile::of_points(points, alpha.unwrap_or(Alpha::INFINITE));
        complex.weights = weights;
        rows.put(&mut complex, classes.is_some());
        Ok(Mesh::from(complex).with_ignored(&ignored))
    }
}

fn class(number: Option<f64>) -> Option<Class> {
    let number = number?;
    Class::from_number(number as u8).filter(|class| f64::from(*class as u8) == number)
}

/// Simplices by dimension, and their classes.
#[derive(Default)]
struct Rows {
    vertices: Vec<u32>,
    edges: Vec<[u32; 2]>,
    facets: Vec<[u32; 3]>,
    cells: Vec<[u32; 4]>,
    classes: [Vec<Class>; 4],
}

impl Rows {
    /// With classes, an empty list means that there are no such simplices; without classes, they are derived as faces.
    fn put(self, complex: &mut ComplexFile, all: bool) {
        fn listed<T>(rows: Vec<T>, all: bool) -> Option<Vec<T>> {
            (all || !rows.is_empty()).then_some(rows)
        }
        complex.cells = listed(self.cells, all);
        complex.facets = listed(self.facets, all);
        complex.edges = listed(self.edges, all);
        complex.vertices = listed(self.vertices, all);
        let [vertices, edges, facets, cells] = self.classes.map(|classes| listed(classes, all));
        let mut classes = Classes::default();
        (classes.vertices, classes.edges, classes.facets, classes.cells) =
            (vertices, edges, facets, cells);
        complex.classes = classes;
    }
}
