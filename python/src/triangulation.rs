//! The regular triangulation itself, as arrays, and the cells that hold places.

use std::cmp::Ordering;
use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use rayon::prelude::*;
use walpha::Points;
use walpha::progress::Monitor;
use walpha::triangulation::{
    MAX_COORDINATE, Predicates, Sites, TriangulationError, along_curve, triangulate_along,
};

use crate::arrays::{column, lend, rows};
use crate::shape::weighted;
use crate::work::{Task, run};

/// The facets opposite the corners of a positively oriented cell, counter-clockwise seen from the corner.
const FACETS: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [1, 0, 3], [0, 1, 2]];
/// The number of a cell that is not there: what is outside the hull has none.
const OUTSIDE: i64 = -1;
/// So many places are located by one thread, each from where the last was found.
const CHUNK: usize = 1 << 10;

/// The regular triangulation of weighted points, which is never changed. Points have their input indices, of 64 bits as
/// numpy indexes.
#[pyclass(frozen, module = "walpha._walpha")]
pub struct Triangulation(Arc<Arrays>);

struct Arrays {
    positions: Vec<[f64; 3]>,
    weights: Vec<f64>,
    /// Finite cells, positively oriented.
    simplices: Vec<[i64; 4]>,
    /// The cell across the facet opposite each corner, or [`OUTSIDE`].
    neighbors: Vec<[i64; 4]>,
    /// The facets of the hull, counter-clockwise seen from outside.
    hull: Vec<[i64; 3]>,
    hidden: Vec<i64>,
    duplicates: Vec<[i64; 2]>,
}

#[pymethods]
impl Triangulation {
    #[new]
    fn new(
        py: Python<'_>,
        points: PyReadonlyArray2<'_, f64>,
        weights: Option<PyReadonlyArray1<'_, f64>>,
        task: Task<'_>,
    ) -> PyResult<Self> {
        let Points { positions, weights, .. } = weighted(&points, weights.as_ref(), None)?;
        let weights = weights.unwrap_or_else(|| vec![0.0; positions.len()]);
        let arrays = run(py, &task, move |monitor| Arrays::of(positions, weights, monitor))?;
        Ok(Self(Arc::new(arrays)))
    }

    #[getter]
    fn points<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        // SAFETY: the triangulation is frozen.
        unsafe { lend(&slf.get().0.positions, slf.as_any()) }
    }

    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        column(py, self.0.weights.iter().copied())
    }

    #[getter]
    fn simplices<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        // SAFETY: the triangulation is frozen.
        unsafe { lend(&slf.get().0.simplices, slf.as_any()) }
    }

    #[getter]
    fn neighbors<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        // SAFETY: the triangulation is frozen.
        unsafe { lend(&slf.get().0.neighbors, slf.as_any()) }
    }

    #[getter]
    fn convex_hull<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        // SAFETY: the triangulation is frozen.
        unsafe { lend(&slf.get().0.hull, slf.as_any()) }
    }

    #[getter]
    fn hidden<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        column(py, self.0.hidden.iter().copied())
    }

    #[getter]
    fn duplicates<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        // SAFETY: the triangulation is frozen.
        unsafe { lend(&slf.get().0.duplicates, slf.as_any()) }
    }

    /// The number of a cell that holds each place; −1 outside the hull.
    fn find<'py>(
        &self,
        py: Python<'py>,
        places: PyReadonlyArray2<'_, f64>,
        task: Task<'_>,
    ) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let (arrays, places) = (Arc::clone(&self.0), rows("places", &places)?);
        let found = run(py, &task, move |monitor| arrays.find(&places, monitor))?;
        column(py, found.into_iter())
    }
}

impl Arrays {
    fn of(
        positions: Vec<[f64; 3]>,
        weights: Vec<f64>,
        monitor: &Monitor,
    ) -> Result<Self, TriangulationError> {
        monitor.stage("triangulation")?;
        let sites = Sites::new(&positions, &weights)?;
        let along = sites.curve();
        let ordered: Vec<_> = along.par_iter().map(|&i| sites.positions()[i as usize]).collect();
        let their: Vec<_> = along.par_iter().map(|&i| sites.weights()[i as usize]).collect();
        let inserted = monitor.units(along.len() as u64);
        let made = triangulate_along(&ordered, &their, |more| inserted.add(more as u64))?;
        let input = |v: u32| i64::from(sites.input()[along[v as usize] as usize]);
        let mut hidden: Vec<i64> = made.hidden().into_iter().map(input).collect();
        hidden.sort_unstable();
        let (cells, across, ghost) = made.into_parts();
        let is_finite = |cell: &[u32; 4]| !cell.contains(&ghost);
        let mut count = 0..;
        let number: Vec<i64> = cells
            .iter()
            .map(|cell| if is_finite(cell) { count.next().unwrap_or(OUTSIDE) } else { OUTSIDE })
            .collect();
        let finite = || cells.iter().zip(&across).filter(|(cell, _)| is_finite(cell));
        let simplices = finite().map(|(cell, _)| cell.map(input)).collect();
        let neighbors =
            finite().map(|(_, across)| across.map(|facet| number[(facet / 4) as usize])).collect();
        let outward = |cell: &[u32; 4]| {
            let corner = cell.iter().position(|&v| v == ghost)?;
            Some(FACETS[corner].map(|k| input(cell[k])))
        };
        let mut hull: Vec<[i64; 3]> = cells.iter().filter_map(outward).collect();
        hull.sort_unstable();
        let duplicates = sites.duplicates().iter().map(|pair| pair.map(i64::from)).collect();
        Ok(Self { simplices, neighbors, hull, hidden, duplicates, positions, weights })
    }

    /// Walks towards each place, through facets that it lies beyond. In a regular triangulation no such walk comes back to
    /// a cell (Edelsbrunner, An acyclicity theorem for cell complexes in d dimension,
    /// Combinatorica 10, 1990), and signs are exact.
    fn find(&self, places: &[[f64; 3]], monitor: &Monitor) -> Result<Vec<i64>, TriangulationError> {
        monitor.stage("location")?;
        let sane = |place: &[f64; 3]| place.iter().all(|x| x.abs() <= MAX_COORDINATE);
        let numbers: Vec<usize> = (0..places.len()).filter(|&k| sane(&places[k])).collect();
        let inside: Vec<[f64; 3]> = numbers.iter().map(|&k| places[k]).collect();
        // Near places come after each other, so that walks are short.
        let along = along_curve(&inside);
        // A place is a point after all others; orientations do not depend on weights.
        let all: Vec<[f64; 3]> = self.positions.iter().chain(&inside).copied().collect();
        let none = vec![0.0; all.len()];
        let predicates = Predicates::new(&all, &none);
        let first = self.positions.len() as u32;
        let done = monitor.units(along.len() as u64);
        let located = along.par_chunks(CHUNK).map(|chunk| {
            let mut near = 0;
            let walk = |&place: &u32| {
                let (cell, is_inside) = self.walk(&predicates, first + place, near);
                near = cell;
                (place, if is_inside { cell as i64 } else { OUTSIDE })
            };
            let cells: Vec<(u32, i64)> = chunk.iter().map(walk).collect();
            done.add(chunk.len() as u64)?;
            Ok(cells)
        });
        let located = located.collect::<Result<Vec<_>, TriangulationError>>()?;
        let mut found = vec![OUTSIDE; places.len()];
        for (place, cell) in located.into_iter().flatten() {
            found[numbers[place as usize]] = cell;
        }
        Ok(found)
    }

    /// The cell that holds a place, or the last one before it, and whether it holds it.
    fn walk(&self, predicates: &Predicates<'_>, place: u32, from: usize) -> (usize, bool) {
        let mut cell = from;
        'walk: loop {
            let corners = self.simplices[cell].map(|v| v as u32);
            for k in 0..4 {
                let mut seen = corners;
                seen[k] = place;
                if predicates.orientation(seen) == Ordering::Less {
                    match self.neighbors[cell][k] {
                        OUTSIDE => return (cell, false),
                        next => cell = next as usize,
                    }
                    continue 'walk;
                }
            }
            return (cell, true);
        }
    }
}
