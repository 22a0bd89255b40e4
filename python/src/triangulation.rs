//! The regular triangulation itself, as arrays, and the cells that hold places.

use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use rayon::prelude::*;
use walpha::Points;
use walpha::progress::Monitor;
use walpha::triangulation::internals::along_curve;
use walpha::triangulation::{self, TriangulationError, triangulate};

use crate::arrays::{column, lend, rows};
use crate::shape::weighted;
use crate::work::{Task, run};

/// The number of a cell that is not there: what is outside the hull has none.
const OUTSIDE: i64 = -1;
/// The number of places that one thread locates, each from where the last was found.
const CHUNK: usize = 1 << 10;

/// The regular triangulation of weighted points, which is never changed. Points have their input indices, of 64 bits as
/// numpy indexes.
#[pyclass(frozen, module = "walpha._walpha")]
pub struct Triangulation(Arc<Arrays>);

struct Arrays {
    made: triangulation::Triangulation,
    weights: Vec<f64>,
    /// For each cell of `made`, its row among the simplices, or [`OUTSIDE`].
    row: Vec<i64>,
    /// Finite cells, positively oriented.
    simplices: Vec<[i64; 4]>,
    /// The cell across the facet opposite each corner, or [`OUTSIDE`].
    neighbors: Vec<[i64; 4]>,
    /// The facets of the hull, counter-clockwise seen from outside.
    hull: Vec<[i64; 3]>,
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
        let Points { positions, weights, .. } = weighted(points, weights, None)?;
        let weights = weights.unwrap_or_else(|| vec![0.0; positions.len()]);
        let task = task.of(positions.len());
        let arrays = run(py, &task, move || Arrays::of(positions, weights))?;
        Ok(Self(Arc::new(arrays)))
    }

    #[getter]
    fn points<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        // SAFETY: the triangulation is frozen.
        unsafe { lend(slf.get().0.made.positions(), slf.as_any()) }
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
        column(py, self.0.made.hidden().iter().map(|&v| i64::from(v)))
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
        let (arrays, places) = (Arc::clone(&self.0), rows("places", places)?);
        let found = run(py, &task, move || arrays.find(&places))?;
        column(py, found.into_iter())
    }

    fn power_diagram(&self, py: Python<'_>, task: Task<'_>) -> PyResult<PowerDiagram> {
        let arrays = Arc::clone(&self.0);
        let made = run(py, &task, move || {
            Monitor::current().stage("power diagram")?;
            let weights = Some(arrays.weights.as_slice());
            triangulation::PowerDiagram::of(&arrays.made, weights)
        })?;
        Ok(PowerDiagram(made))
    }
}

/// The power diagram dual to a triangulation. Points have their input indices, as there.
#[pyclass(frozen, module = "walpha._walpha")]
pub struct PowerDiagram(triangulation::PowerDiagram);

#[pymethods]
impl PowerDiagram {
    #[getter]
    fn vertices<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        // SAFETY: the diagram is frozen.
        unsafe { lend(slf.get().0.vertices(), slf.as_any()) }
    }

    #[getter]
    fn same_sphere<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        column(py, self.0.same_sphere().iter().map(|&vertex| i64::from(vertex)))
    }

    #[getter]
    fn volumes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        column(py, self.0.volumes().iter().copied())
    }

    #[getter]
    fn facets<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the diagram is frozen.
        unsafe { lend(slf.get().0.facets(), slf.as_any()) }
    }

    #[getter]
    fn areas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        column(py, self.0.areas().iter().copied())
    }
}

impl Arrays {
    fn of(positions: Vec<[f64; 3]>, weights: Vec<f64>) -> Result<Self, TriangulationError> {
        Monitor::current().stage("triangulation")?;
        let made = triangulate(&positions, Some(&weights))?;
        drop(positions);
        let mut count = 0..;
        let mut row = vec![OUTSIDE; made.cells().len()];
        for (cell, _) in made.finite_cells() {
            row[cell as usize] = count.next().unwrap_or(OUTSIDE);
        }
        let simplices = made.finite_cells().map(|(_, corners)| corners.map(i64::from)).collect();
        let across = |(cell, _): (u32, _)| {
            made.adjacency()[cell as usize].map(|facet| row[(facet / 4) as usize])
        };
        let neighbors = made.finite_cells().map(across).collect();
        let mut hull: Vec<_> = made.hull_facets().map(|facet| facet.map(i64::from)).collect();
        hull.sort_unstable();
        let duplicates = made.duplicates().iter().map(|pair| pair.map(i64::from)).collect();
        Ok(Self { made, weights, row, simplices, neighbors, hull, duplicates })
    }

    fn find(&self, places: &[[f64; 3]]) -> Result<Vec<i64>, TriangulationError> {
        let monitor = &*Monitor::current();
        monitor.stage("location")?;
        let is_finite = |&k: &usize| places[k].iter().all(|x| x.is_finite());
        let numbers: Vec<usize> = (0..places.len()).filter(is_finite).collect();
        // Near places come after each other, so that walks are short.
        let along = along_curve(&numbers.iter().map(|&k| places[k]).collect::<Vec<_>>());
        let done = monitor.units(along.len() as u64);
        let located = along.par_chunks(CHUNK).map(|chunk| {
            let mut last = None;
            let walk = |&number: &u32| {
                let number = numbers[number as usize];
                let found = match last {
                    Some(cell) => self.made.locate_from(places[number], cell),
                    None => self.made.locate(places[number]),
                };
                last = found.map(|place| place.cell()).or(last);
                (number, found.map_or(OUTSIDE, |place| self.row[place.cell() as usize]))
            };
            let cells: Vec<(usize, i64)> = chunk.iter().map(walk).collect();
            done.add(chunk.len() as u64)?;
            Ok(cells)
        });
        let located = located.collect::<Result<Vec<_>, TriangulationError>>()?;
        let mut found = vec![OUTSIDE; places.len()];
        for (place, row) in located.into_iter().flatten() {
            found[place] = row;
        }
        Ok(found)
    }
}
