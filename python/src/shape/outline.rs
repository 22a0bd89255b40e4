//! The outline of a shape in a plane, as arrays.

use std::sync::Arc;

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use walpha::AlphaShape;
use walpha::shape::Polygon;

use crate::work::{Task, run};

/// A ring: input indices.
type Ring<'py> = Bound<'py, PyArray1<u32>>;

/// Polygons, each an outer ring and holes; singular edges and vertices; area, perimeter; axes in which the plane is seen.
pub type Outline<'py> = (
    Vec<(Ring<'py>, Vec<Ring<'py>>)>,
    Bound<'py, PyArray2<u32>>,
    Bound<'py, PyArray1<u32>>,
    f64,
    f64,
    [usize; 2],
);

/// The outline that [`AlphaShape::outline`] makes.
pub fn outline<'py>(py: Python<'py>, shape: Arc<AlphaShape>) -> PyResult<Outline<'py>> {
    let outline = run(py, &Task::default(), move || shape.outline().cloned())?;
    let polygon = |Polygon { outer, holes, .. }| {
        let holes = holes.into_iter().map(|hole: Vec<u32>| hole.into_pyarray(py)).collect();
        (Vec::into_pyarray(outer, py), holes)
    };
    let polygons = outline.polygons.into_iter().map(polygon).collect();
    let table = (outline.edges.len(), 2);
    let edges = Array2::from_shape_vec(table, outline.edges.into_flattened());
    let edges = edges.expect("rows of two").into_pyarray(py);
    let points = outline.points.into_pyarray(py);
    Ok((polygons, edges, points, outline.area, outline.perimeter, outline.axes))
}
