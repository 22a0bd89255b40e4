//! The boundary of a shape, as arrays.

use std::sync::Arc;

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use walpha::AlphaShape;
use walpha::interpolate::InterpolateError;
use walpha::shape::{Cuts, Surface};

use crate::work::{Task, run};

/// Places, triangles over them, and the input index of each; then edges cut, vertices doubled, midpoints, vertices
/// moved, the largest move, vertices that are still together.
pub type Boundary<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<u32>>,
    Bound<'py, PyArray1<u32>>,
    (usize, usize, usize, usize, f64, usize),
);

/// The boundary without changes, or as [`AlphaShape::solid`] makes it.
pub fn boundary<'py>(
    py: Python<'py>,
    shape: Arc<AlphaShape>,
    solid: bool,
) -> PyResult<Boundary<'py>> {
    let (places, triangles, indices, cuts) = run(py, &Task::default(), move || {
        let (surface, cuts) = match solid {
            true => {
                let (surface, cuts) = shape.solid();
                (surface.clone(), cuts)
            }
            false => (Surface::of(&shape), Default::default()),
        };
        let places: Vec<[f64; 3]> = surface.positions(shape.points().positions()).collect();
        let indices: Vec<u32> = surface.indices().collect();
        let Cuts { edges, vertices, midpoints, moved, largest_move, together, .. } = cuts;
        let cuts = (edges, vertices, midpoints, moved, largest_move, together);
        Ok::<_, InterpolateError>((places, surface.regular, indices, cuts))
    })?;
    let table = |n: usize| (n, 3);
    let (n, m) = (places.len(), triangles.len());
    let places = numpy::ndarray::Array2::from_shape_vec(table(n), places.into_flattened());
    let triangles = numpy::ndarray::Array2::from_shape_vec(table(m), triangles.into_flattened());
    let (places, triangles) = (places.expect("rows of three"), triangles.expect("rows of three"));
    Ok((places.into_pyarray(py), triangles.into_pyarray(py), indices.into_pyarray(py), cuts))
}
