//! A small file format for complexes, so that the complexes of any program can be judged and compared.
//!
//! In JSON:
//!
//! ```json
//! { "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
//!   "weights": [0, 0, 0, 0],
//!   "alpha": 0.75,
//!   "cells": [[0, 1, 2, 3]],
//!   "facets": [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]],
//!   "edges": [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]],
//!   "vertices": [0, 1, 2, 3],
//!   "classes": { "cells": ["interior"] },
//!   "hidden": [],
//!   "duplicates": [] }
//! ```
//!
//! - `points` and `alpha` are required. `alpha` is a **squared** length: a number, `"inf"` or
//!   `"-inf"`. A program that works with radii r has α = r².
//! - `weights` are power weights, squared lengths; without them all are 0.
//! - Simplices are rows of point numbers from 0, in any order and winding. If a dimension is
//!   missing, it consists of the faces of the next dimension.
//! - `classes` (`exterior`, `interior`, `regular`, `singular`) give the class of each row of a
//!   dimension. Without them, all listed simplices count as in the shape, and their classes follow:
//!   a facet with two cells is interior, with one regular, with none singular, and so on down.
//! - `hidden` lists the points that are not vertices, `duplicates` pairs (removed, kept) of points
//!   at one position. Both are optional.
//! - `periodic` are the sides of a box that repeats along x, y and z, or three vectors, as rows, along which any other box
//!   repeats: the complex is then one of a torus. All points are in the box: the sum of the vectors, each times a part from 0 to
//!   less than 1, is the point. A row means the copies of its vertices nearest to the first one, which must be nearer than
//!   half of each vector, as measured by these parts.
//! - `copies` are rows [point, i, j, k], for a periodic box that is so small that the nearest copies are not meant: with n points, vertex n + r of a
//!   simplex is the copy that row r describes, the point moved by i, j and k times the vectors. All vertices are then meant as they are, and a
//!   simplex that lies in one of its copies in space stands for all of them.
//! - `voxels` says that the complex is no α-shape but the solid of labels: its cells fill these voxels of a grid, and `alpha` is `"inf"`.
//!   `dims` are the voxels of the grid along its x, y and z; `origin` is the position of the first sample, `axes` are the
//!   steps from a sample to the next along x, y and z; a voxel is the box of half a step around its sample. `runs` are rows [first, number]
//!   of the voxels in the region, ascending, voxel (i, j, k) being number i + X·(j + Y·k). The points are corners of voxels.
//! - `isovalue` says that the complex is no α-shape but the solid inside the isosurface of a volume at this value, and `alpha` is `"inf"`. The
//!   samples of the volume, which the file does not hold, decide which cells it has.
//! - `info` is for whatever the writer wants to add.
//!
//! In NPZ (`numpy.savez`, `numpy.savez_compressed`) the same names are arrays of any integer or
//! floating-point type: `points` n×3, `weights` n, `alpha` a scalar, `cells` m×4, `facets` m×3,
//! `edges` m×2, `vertices` m, `hidden` m, `duplicates` m×2, `copies` m×4. Classes are arrays `cell_classes`,
//! `facet_classes`, `edge_classes` and `vertex_classes`, with 0 exterior, 1 interior, 2 regular,
//! 3 singular. `voxels` is two arrays: `voxel_runs` m×2, and `voxel_grid` 5×3, rows of `dims`, `origin` and the three axes. `isovalue` is a scalar.
//!
//! [`AnyFile`] also reads triangulations under the names that other programs use: cells as `simplices`, `tetra` or `t`, points as
//! `points`, `p` or `vertices`, possibly `weights` and `alpha`; it ignores the rest. Without `alpha`, these files, and files of
//! only `points` and `cells`, have α = ∞.
//!
//! A [`FiltrationFile`] is a complex at all values of α; [`AnyFile`] opens both kinds.

mod box_vectors;
mod error;
mod filtration;
#[cfg(feature = "json")]
mod json;
mod named;
#[cfg(feature = "npz")]
mod npz;
mod open;

use serde::{Deserialize, Serialize};

use crate::{Alpha, Class, Placed, Voxels};

pub use box_vectors::BoxVectors;
pub use error::SchemaError;
pub use filtration::{Below, FiltrationFile, PairsFile, Values};
#[cfg(feature = "npz")]
pub use npz::read_npy;
pub use open::AnyFile;

/// A copy of a point of a periodic box: the index of the point, and the multiples of the three vectors by which it is moved.
pub type PointCopy = [i32; 4];

/// The contents of a file with a complex; see the [module](self) for the meaning of the fields.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct ComplexFile {
    /// x, y, z of each point.
    #[serde(default)]
    pub points: Vec<[f64; 3]>,
    /// Power weights, squared lengths; all 0 if missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<f64>>,
    /// α.
    pub alpha: Alpha,
    /// Tetrahedra.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cells: Option<Vec<[u32; 4]>>,
    /// Triangles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub facets: Option<Vec<[u32; 3]>>,
    /// Edges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub edges: Option<Vec<[u32; 2]>>,
    /// Vertices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vertices: Option<Vec<u32>>,
    /// Classes of the simplices listed.
    #[serde(default, skip_serializing_if = "Classes::is_empty")]
    pub classes: Classes,
    /// Points that are not vertices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hidden: Option<Vec<u32>>,
    /// Pairs (removed, kept) of points at one position.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duplicates: Option<Vec<[u32; 2]>>,
    /// The vectors of the periodic box, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub periodic: Option<BoxVectors>,
    /// Copies of points, which rows name by indices after those of the points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub copies: Option<Vec<PointCopy>>,
    /// The voxels that the cells fill, if the complex is of labels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub voxels: Option<Voxels>,
    /// The value at whose isosurface the cells end, if the complex is the solid inside one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub isovalue: Option<f64>,
    /// Any further data of the writer.
    #[cfg(feature = "json")]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub info: Option<serde_json::Value>,
}

/// Classes by dimension; if present, one for each simplex.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Classes {
    /// The classes of the cells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cells: Option<Vec<Class>>,
    /// The classes of the facets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub facets: Option<Vec<Class>>,
    /// The classes of the edges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub edges: Option<Vec<Class>>,
    /// The classes of the vertices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vertices: Option<Vec<Class>>,
}

impl Classes {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl ComplexFile {
    /// The file of a complex with its points.
    pub fn new(placed: Placed<'_>) -> Self {
        let Placed { positions, weights, alpha, complex } = placed;
        Self {
            weights: Some(weights.to_vec()),
            cells: Some(complex.cells.rows().to_vec()),
            facets: Some(complex.facets.rows().to_vec()),
            edges: Some(complex.edges.rows().to_vec()),
            vertices: Some(complex.vertices.rows().as_flattened().to_vec()),
            classes: Classes {
                cells: Some(complex.cells.classes().to_vec()),
                facets: Some(complex.facets.classes().to_vec()),
                edges: Some(complex.edges.classes().to_vec()),
                vertices: Some(complex.vertices.classes().to_vec()),
            },
            ..Self::of_points(positions.to_vec(), alpha)
        }
    }

    /// Whether this may be a triangulation whose file states no α: α is ∞, and no simplex has a class.
    pub fn states_no_alpha(&self) -> bool {
        let is_of_alpha = self.voxels.is_none() && self.isovalue.is_none();
        self.alpha == Alpha::INFINITE && self.classes.is_empty() && is_of_alpha
    }

    /// Whether this is a triangulation of which only the cells are listed.
    pub fn is_cells_alone(&self) -> bool {
        let faces = self.facets.is_some() || self.edges.is_some() || self.vertices.is_some();
        self.states_no_alpha() && self.cells.is_some() && !faces
    }

    /// A file of points and α, without simplices.
    pub fn of_points(points: Vec<[f64; 3]>, alpha: Alpha) -> Self {
        Self {
            points,
            weights: None,
            alpha,
            cells: None,
            facets: None,
            edges: None,
            vertices: None,
            classes: Classes::default(),
            hidden: None,
            duplicates: None,
            periodic: None,
            copies: None,
            voxels: None,
            isovalue: None,
            #[cfg(feature = "json")]
            info: None,
        }
    }
}
