//! Files with filtrations.

use serde::{Deserialize, Serialize};

use super::{BoxVectors, PointCopy, SchemaError};
use crate::Alpha;

/// The contents of a file with a filtration: every simplex of a regular triangulation, and the α at which it enters.
///
/// In JSON:
///
/// ```json
/// { "points": [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]],
///   "weights": [0, 0, 0, 0],
///   "vertices": [0, 1, 2, 3],
///   "edges": [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]],
///   "facets": [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]],
///   "cells": [[0, 1, 2, 3]],
///   "values": { "vertices": [0, 0, 0, 0], "edges": [1, 1, 1, 2, 2, 2],
///               "facets": [2, 2, 2, 3], "cells": [3] },
///   "order": [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14] }
/// ```
///
/// - `points` and `weights` are as in a [complex](super), values squared lengths as α is.
/// - Simplices are numbered: vertices first, then edges, facets and cells, each as they are listed.
///   `order` lists these numbers in the order in which simplices enter: by value, equal values by
///   dimension, then by vertices (ascending in each simplex, compared one by one).
/// - `values` are the doubles nearest to the exact values; the order is by the exact values.
/// - `gabriel` says for vertices, edges and facets whether their smallest orthogonal sphere is empty.
/// - `regular` and `interior` say for these from which α on they are a face of another simplex of the
///   shape, and off its boundary; `"inf"` if they never are. All three may be missing.
/// - `pairs` are the persistence pairs, by these numbers, whose simplices have different values:
///   `components` (a vertex, and the edge that ends its component), `lasting` (vertices whose components never
///   end), `loops` (an edge that closes a loop, and the facet that fills it; may be missing), `voids` (a facet that
///   closes a void, and the cell that fills it). For a torus also `lasting_loops` and `lasting_voids`, the edges and
///   facets that close loops and surfaces which are never filled, and `last`, the cell that completes the torus.
/// - `periodic` are the sides or vectors of a periodic box, and `copies` the copies of its points that rows name, as in a complex.
/// - `hidden`, `duplicates` and `info` are as in a complex.
///
/// In NPZ the same names are arrays; those with dimensions are `vertex_values`, `edge_values`,
/// `facet_values`, `cell_values`, `vertex_gabriel` and so on, `component_pairs`, `lasting_components`,
/// `loop_pairs`, `lasting_loops`, `void_pairs`, `lasting_voids` and `last_cell`.
///
/// The fields are public, so that any program can fill them. The others should come from `..FiltrationFile::default()`, because
/// features add some.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FiltrationFile {
    /// x, y, z of each point.
    #[serde(default)]
    pub points: Vec<[f64; 3]>,
    /// Power weights, squared lengths; all 0 if missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<f64>>,
    /// The vertices of the triangulation.
    pub vertices: Vec<u32>,
    /// Its edges.
    pub edges: Vec<[u32; 2]>,
    /// Its triangles.
    pub facets: Vec<[u32; 3]>,
    /// Its tetrahedra.
    pub cells: Vec<[u32; 4]>,
    /// The α from which on each is in the shape.
    pub values: Values,
    /// Whether the sphere of each is empty.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gabriel: Option<Below<bool>>,
    /// The α from which on each is a face of another simplex of the shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub regular: Option<Below<Alpha>>,
    /// The α from which on each is off the boundary.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interior: Option<Below<Alpha>>,
    /// The numbers of all simplices, in order.
    pub order: Vec<u32>,
    /// Persistence pairs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pairs: Option<PairsFile>,
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
    /// Any further data of the writer.
    #[cfg(feature = "json")]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub info: Option<serde_json::Value>,
}

/// The value of each simplex, by dimension. The fields are public because no dimension will be added.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Values {
    /// The values of the vertices.
    pub vertices: Vec<Alpha>,
    /// The values of the edges.
    pub edges: Vec<Alpha>,
    /// The values of the facets.
    pub facets: Vec<Alpha>,
    /// The values of the cells.
    pub cells: Vec<Alpha>,
}

/// A value for each vertex, edge and facet. The fields are public because no dimension will be added.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Below<T> {
    /// The values of the vertices.
    pub vertices: Vec<T>,
    /// The values of the edges.
    pub edges: Vec<T>,
    /// The values of the facets.
    pub facets: Vec<T>,
}

/// Persistence pairs by numbers of simplices. The fields are public because any program may write them.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PairsFile {
    /// A vertex, and the edge that unites its component with an older one.
    pub components: Vec<[u32; 2]>,
    /// Vertices whose components never end.
    pub lasting: Vec<u32>,
    /// An edge that closes a loop, and the facet that fills it; `None` if they were not computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loops: Option<Vec<[u32; 2]>>,
    /// For a torus: edges that close loops which are never filled.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lasting_loops: Vec<u32>,
    /// A facet that closes a void, and the cell that fills it.
    pub voids: Vec<[u32; 2]>,
    /// For a torus: facets that close surfaces which are never filled.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lasting_voids: Vec<u32>,
    /// For a torus: the cell that completes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub last: Option<u32>,
}

impl FiltrationFile {
    /// Checks that fields are consistent: as many values as simplices, and only points that exist.
    ///
    /// # Errors
    /// Fields of different lengths, point numbers out of range, no points.
    pub fn check(&self) -> Result<(), SchemaError> {
        let n = self.points.len();
        if n == 0 {
            return Err(SchemaError::NoPoints);
        }
        SchemaError::paired("weights", self.weights.as_ref().map_or(n, Vec::len), "points", n)?;
        SchemaError::in_range("vertices", self.vertices.iter(), n)?;
        let copies = self.copies.iter().flatten();
        if let Some(copy) = copies.clone().find(|copy| u32::try_from(copy[0]).is_err()) {
            let value = copy[0].to_string();
            return Err(SchemaError::Value { name: "copies", value, expected: "a point number" });
        }
        let points: Vec<u32> = copies.map(|copy| copy[0] as u32).collect();
        SchemaError::in_range("copies", points.iter(), n)?;
        let named = n + self.copies.as_ref().map_or(0, Vec::len);
        SchemaError::in_range("edges", self.edges.iter().flatten(), named)?;
        SchemaError::in_range("facets", self.facets.iter().flatten(), named)?;
        SchemaError::in_range("cells", self.cells.iter().flatten(), named)?;
        let (values, cells) = (&self.values, self.cells.len());
        let of_values = [&values.vertices, &values.edges, &values.facets].map(Vec::len);
        self.paired(["values.vertices", "values.edges", "values.facets"], of_values)?;
        SchemaError::paired("values.cells", values.cells.len(), "cells", cells)?;
        if let Some(gabriel) = &self.gabriel {
            self.paired(["gabriel.vertices", "gabriel.edges", "gabriel.facets"], gabriel.counts())?;
        }
        if let Some(regular) = &self.regular {
            self.paired(["regular.vertices", "regular.edges", "regular.facets"], regular.counts())?;
        }
        if let Some(interior) = &self.interior {
            let names = ["interior.vertices", "interior.edges", "interior.facets"];
            self.paired(names, interior.counts())?;
        }
        Ok(())
    }

    /// Checks that there are as many entries as vertices, edges and facets.
    fn paired(&self, names: [&'static str; 3], counts: [usize; 3]) -> Result<(), SchemaError> {
        SchemaError::paired(names[0], counts[0], "vertices", self.vertices.len())?;
        SchemaError::paired(names[1], counts[1], "edges", self.edges.len())?;
        SchemaError::paired(names[2], counts[2], "facets", self.facets.len())
    }
}

impl<T> Below<T> {
    fn counts(&self) -> [usize; 3] {
        [self.vertices.len(), self.edges.len(), self.facets.len()]
    }
}
