//! Many clouds of points at once: the interpreter is unlocked once, and threads take cloud after cloud.

use std::iter::from_fn;
use std::sync::{Arc, Mutex, PoisonError};

use numpy::{PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use walpha::advice::Advise;
use walpha::ladder;
use walpha::pipeline::PipelineError;
use walpha::progress::{Monitor, Stage};
use walpha::shape::Torus;
use walpha::{Points, WeightedPoints};

use crate::arrays::{array2, numbers, rows};
use crate::filtration::Filtration;
use crate::shape::{Shape, Written, recipe_of, torus};
use crate::work::{Task, run};

/// Points, weights and values as Python has them.
type Given<'py> = (
    PyReadonlyArray2<'py, f64>,
    Option<PyReadonlyArray1<'py, f64>>,
    Option<PyReadonlyArray1<'py, f64>>,
);

/// The same, copied.
struct Cloud {
    positions: Vec<[f64; 3]>,
    weights: Option<Vec<f64>>,
    values: Option<Vec<f64>>,
}

impl Cloud {
    fn of((points, weights, values): Given<'_>) -> PyResult<Self> {
        Ok(Self {
            positions: rows("points", points)?,
            weights: weights.map(numbers).transpose()?,
            values: values.map(numbers).transpose()?,
        })
    }

    fn points(self) -> Result<Points, PipelineError> {
        let mut points = Points::new(self.positions);
        if let Some(weights) = self.weights {
            points = points.with_weights(weights)?;
        }
        if let Some(values) = self.values {
            points = points.with_values(values)?;
        }
        Ok(points)
    }
}

/// What is wrong with one of the clouds.
#[derive(Debug, thiserror::Error)]
#[error("cloud {cloud}: {error}")]
struct InCloud {
    cloud: usize,
    error: Box<PipelineError>,
}

impl Advise for InCloud {
    fn wrapped(&self) -> Option<&dyn Advise> {
        Some(&*self.error)
    }
}

/// Does the same for each cloud. Of several clouds that fail, the first is told.
fn each<T: Send + 'static>(
    py: Python<'_>,
    clouds: Vec<Given<'_>>,
    stage: Stage,
    task: Task<'_>,
    work: impl Fn(Points) -> Result<T, PipelineError> + Send + Sync + 'static,
) -> PyResult<Vec<T>> {
    let clouds = clouds.into_iter().map(Cloud::of).collect::<PyResult<Vec<_>>>()?;
    let points = clouds.iter().map(|cloud| cloud.positions.len()).sum();
    run(py, &task.of(points), move || {
        let monitor = &*Monitor::current();
        let in_cloud = |cloud| move |error: PipelineError| InCloud { cloud, error: error.into() };
        monitor.stage(stage.name()).map_err(PipelineError::from).map_err(in_cloud(0))?;
        let units = monitor.units(clouds.len() as u64);
        let one = |cloud: Cloud| {
            let made = monitor.unreported().watch(|| work(cloud.points()?))?;
            units.add(1)?;
            Ok(made)
        };
        // Each thread is at one cloud at a time: a parallel iterator would begin others wherever a thread waits for its parts.
        let waiting = Mutex::new(clouds.into_iter().enumerate());
        let waiting = || waiting.lock().unwrap_or_else(PoisonError::into_inner);
        let made = rayon::broadcast(|_| {
            let some = from_fn(|| waiting().next()).map(|(cloud, given)| {
                let made = one(given).map_err(in_cloud(cloud));
                if made.is_err() {
                    // Clouds before this one have begun, so that the first error does not depend on threads.
                    waiting().by_ref().for_each(drop);
                }
                (cloud, made)
            });
            some.collect::<Vec<_>>()
        });
        let mut made: Vec<_> = made.into_iter().flatten().collect();
        made.sort_unstable_by_key(|&(cloud, _)| cloud);
        made.into_iter().map(|(_, made)| made).collect()
    })
}

/// A filtration of points that may have weights.
fn filtration_on(
    torus: Option<Torus>,
    points: Points,
) -> Result<ladder::Filtration, PipelineError> {
    let weights = points.weights.unwrap_or_else(|| vec![0.0; points.positions.len()]);
    let points = WeightedPoints::new(points.positions, weights).expect("as many weights as points");
    Ok(ladder::Filtration::on(torus, points)?)
}

/// The filtration of each cloud.
#[pyfunction]
pub fn filtrations(
    py: Python<'_>,
    clouds: Vec<Given<'_>>,
    periodic: Option<Vec<f64>>,
    task: Task<'_>,
) -> PyResult<Vec<Filtration>> {
    let torus = torus(periodic.as_deref())?;
    let made = each(py, clouds, Stage::Filtration, task, move |points| {
        filtration_on(torus, points).map(Arc::new)
    })?;
    Ok(made.into_iter().map(Filtration).collect())
}

/// The persistence diagrams of each cloud: births and deaths for each of these dimensions.
#[pyfunction]
pub fn diagrams<'py>(
    py: Python<'py>,
    clouds: Vec<Given<'py>>,
    dimensions: Vec<usize>,
    periodic: Option<Vec<f64>>,
    task: Task<'_>,
) -> PyResult<Vec<Vec<Bound<'py, PyArray2<f64>>>>> {
    let torus = torus(periodic.as_deref())?;
    let made = each(py, clouds, Stage::Pairs, task, move |points| {
        let filtration = filtration_on(torus, points)?;
        let simplices = filtration.simplices()?;
        let of = |&dimension: &usize| {
            let intervals = simplices.persistence(dimension)?;
            Ok(intervals.iter().map(|interval| [interval.birth, interval.death]).collect())
        };
        dimensions.iter().map(of).collect::<Result<Vec<Vec<_>>, PipelineError>>()
    })?;
    let array = |rows| PyArray2::from_owned_array(py, array2(rows));
    Ok(made.into_iter().map(|diagrams| diagrams.into_iter().map(array).collect()).collect())
}

/// The shape of each cloud.
#[pyfunction]
pub fn alpha_shapes(
    py: Python<'_>,
    clouds: Vec<Given<'_>>,
    settings: Written,
    task: Task<'_>,
) -> PyResult<Vec<Shape>> {
    let recipe = recipe_of(settings)?;
    let made = each(py, clouds, Stage::Shape, task, move |points| recipe.run_points(points))?;
    Ok(made.into_iter().map(Shape::of).collect())
}
