//! A small file format for complexes, so that any program's can be judged and compared.
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
//! - `points` are needed, unless they come in a file of their own (`--points`); `alpha` is needed: a
//!   squared length, a number or `"inf"` or `"-inf"`.
//! - `weights` are power weights, 0 where missing. An unweighted complex whose radii are called
//!   r has α = r².
//! - Simplices are rows of point numbers from 0, in any order and winding. A dimension that is
//!   missing is made of the faces of the one above it.
//! - `classes` (`exterior`, `interior`, `regular`, `singular`) belong to the rows of a dimension.
//!   Where they are missing, all listed simplices are taken to be in the shape, and have the
//!   classes that follow from that: a facet between two cells is interior, beside one regular,
//!   beside none singular, and so on down.
//! - `hidden` lists points that are no vertices, `duplicates` pairs (went, stayed) of points at one
//!   place; both may be missing.
//! - `info` is free for whatever the writer wants to say.
//!
//! In NPZ the same names are arrays: `points` n×3, `weights` n, `alpha` a scalar, `cells` m×4,
//! `facets` m×3, `edges` m×2, `vertices` m, `hidden` m, `duplicates` m×2, of any integer or
//! floating type; classes are arrays `cell_classes`, `facet_classes`, `edge_classes` and
//! `vertex_classes` of the numbers 0 exterior, 1 interior, 2 regular, 3 singular. Write it with
//! `numpy.savez` or `numpy.savez_compressed`.

mod build;
mod filtration;
mod npz;
mod number;

use std::io::{Read, Write};

use serde::{Deserialize, Serialize};

use crate::shape::{Class, Complex, Simplices};

pub use filtration::{Below, Extended, FiltrationFile, PairsFile, Values};

/// A complex as a file holds it; see the [module](self) for the meaning of the fields.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ComplexFile {
    /// x, y, z of each point.
    #[serde(default)]
    pub points: Vec<[f64; 3]>,
    /// Power weights, squared lengths; all 0 if missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<f64>>,
    /// α, a squared length, or ±∞.
    #[serde(with = "number")]
    pub alpha: f64,
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
    /// Points that are no vertices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hidden: Option<Vec<u32>>,
    /// Pairs (went, stayed) of points at one place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duplicates: Option<Vec<[u32; 2]>>,
    /// Whatever the writer wants to say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub info: Option<serde_json::Value>,
}

/// Classes by dimension, as many as simplices where present.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Classes {
    /// Of the cells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cells: Option<Vec<Class>>,
    /// Of the facets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub facets: Option<Vec<Class>>,
    /// Of the edges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub edges: Option<Vec<Class>>,
    /// Of the vertices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vertices: Option<Vec<Class>>,
}

impl Classes {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Why a file is no complex.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SchemaError {
    /// Not JSON, or not of this form.
    #[error("the complex cannot be read as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// No archive.
    #[error("the complex cannot be read as NPZ: {0}; write it with numpy.savez")]
    Zip(String),
    /// An array of the archive cannot be read; its name stands for the path of a file.
    #[error("the complex cannot be read as NPZ: {0}")]
    Npz(#[from] crate::volume::VolumeError),
    /// A needed array is missing.
    #[error("the NPZ file has no array `{0}`, which is needed")]
    Missing(&'static str),
    /// An array has the wrong shape or type.
    #[error("array `{name}` has {got}, expected {expected}")]
    Array {
        /// Its name.
        name: &'static str,
        /// What it has.
        got: String,
        /// What it must have.
        expected: String,
    },
    /// A number is none that the field can hold.
    #[error("`{name}` holds {value}, which is no {expected}")]
    Value {
        /// The field.
        name: &'static str,
        /// The number.
        value: String,
        /// What it should be.
        expected: &'static str,
    },
    /// Two fields do not pair up.
    #[error("`{name}` has {got} entries, but {expected} are needed, one each of `{of}`")]
    Lengths {
        /// The field.
        name: &'static str,
        /// Its length.
        got: usize,
        /// The other's.
        expected: usize,
        /// The other field.
        of: &'static str,
    },
    /// A row names a point that does not exist.
    #[error("`{name}` names point {index}, but there are only {points}, numbered from 0")]
    Index {
        /// The field.
        name: &'static str,
        /// The number.
        index: u32,
        /// How many points there are.
        points: usize,
    },
    /// No points at all.
    #[error(
        "the file lists no points: add `points`, or give them in a file of their own with --points"
    )]
    NoPoints,
    /// No simplices at all.
    #[error("the file lists no simplices: give at least one of cells, facets, edges, vertices")]
    NoSimplices,
}

/// A complex with its points, in canonical order, ready to be judged.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedComplex {
    /// x, y, z of each point.
    pub positions: Vec<[f64; 3]>,
    /// Power weights.
    pub weights: Vec<f64>,
    /// α, a squared length, or ±∞.
    pub alpha: f64,
    /// The complex.
    pub complex: Complex,
    /// Points listed as hidden, if they are listed.
    pub hidden: Option<Vec<u32>>,
    /// Duplicates, if they are listed.
    pub duplicates: Option<Vec<[u32; 2]>>,
}

impl ComplexFile {
    /// Reads JSON.
    ///
    /// # Errors
    /// [`SchemaError::Json`], with line and column.
    pub fn read_json(reader: impl Read) -> Result<Self, SchemaError> {
        Ok(serde_json::from_reader(std::io::BufReader::new(reader))?)
    }

    /// Writes JSON, in one line.
    ///
    /// # Errors
    /// [`SchemaError::Json`] if `writer` fails.
    pub fn write_json(&self, writer: impl Write) -> Result<(), SchemaError> {
        Ok(serde_json::to_writer(writer, self)?)
    }

    /// The file of a complex over points.
    pub fn new(
        positions: &[[f64; 3]],
        weights: &[f64],
        alpha: f64,
        complex: &Complex,
        hidden: Option<&[u32]>,
        duplicates: Option<&[[u32; 2]]>,
    ) -> Self {
        fn classes<const N: usize>(simplices: &Simplices<N>) -> Option<Vec<Class>> {
            Some(simplices.classes.clone())
        }
        Self {
            points: positions.to_vec(),
            weights: Some(weights.to_vec()),
            alpha,
            cells: Some(complex.cells.vertices.clone()),
            facets: Some(complex.facets.vertices.clone()),
            edges: Some(complex.edges.vertices.clone()),
            vertices: Some(complex.vertices.vertices.iter().map(|v| v[0]).collect()),
            classes: Classes {
                cells: classes(&complex.cells),
                facets: classes(&complex.facets),
                edges: classes(&complex.edges),
                vertices: classes(&complex.vertices),
            },
            hidden: hidden.map(<[_]>::to_vec),
            duplicates: duplicates.map(<[_]>::to_vec),
            info: None,
        }
    }
}
