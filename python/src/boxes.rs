//! What is asked of points in a periodic box beside shapes: power diagrams and pores.

use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use walpha::Points;
use walpha::balls::{FreeSphere, PeriodicBalls};
use walpha::progress::{Monitor, Stage};
use walpha::shape::{PeriodicPowerDiagram, ShapeError};

use crate::arrays::{array2, column, numbers, rows};
use crate::errors::{told, wrong};
use crate::shape::{torus, weighted};
use crate::work::{Task, run};

/// Volumes, facets, shifts and areas.
type Diagram<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<i64>>,
    Bound<'py, PyArray2<i64>>,
    Bound<'py, PyArray1<f64>>,
);

/// The power diagram of points in a periodic box, the vectors of that box, and with walls the areas of each cell on the lower ones across x, y and z,
/// and on the upper ones.
#[pyfunction]
#[expect(clippy::type_complexity, reason = "a tuple of arrays")]
pub fn periodic_power_diagram<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    periodic: Vec<f64>,
    walls: Option<[[f64; 3]; 2]>,
    task: Task<'_>,
) -> PyResult<(Diagram<'py>, Bound<'py, PyArray2<f64>>, Option<Bound<'py, PyArray2<f64>>>)> {
    let torus = torus(Some(&periodic))?.ok_or_else(|| wrong("the box has no vectors"))?;
    let Points { positions, weights, .. } = weighted(points, weights, None)?;
    let task = task.of(positions.len());
    let made = run(py, &task, move || {
        Monitor::current().stage("power diagram")?;
        match walls {
            None => PeriodicPowerDiagram::of(torus, &positions, weights.as_deref()),
            Some(walls) => {
                PeriodicPowerDiagram::between(torus, walls, &positions, weights.as_deref())
            }
        }
    })?;
    let facets = made.facets().iter().map(|facet| facet.map(i64::from)).collect();
    let shifts = made.shifts().iter().map(|shift| shift.map(i64::from)).collect();
    let diagram = (
        column(py, made.volumes().iter().copied())?,
        array2(facets).into_pyarray(py),
        array2(shifts).into_pyarray(py),
        column(py, made.areas().iter().copied())?,
    );
    let vectors = array2(made.torus().vectors().to_vec()).into_pyarray(py);
    let of_both = |&[[a, b, c], [d, e, f]]: &[[f64; 3]; 2]| [a, b, c, d, e, f];
    let on_walls = |walls: &[[[f64; 3]; 2]]| array2(walls.iter().map(of_both).collect());
    Ok((diagram, vectors, made.walls().map(|walls| on_walls(walls).into_pyarray(py))))
}

/// A diameter and a centre.
type Sphere = (f64, [f64; 3]);

/// Dimensions of channels, pockets, and the void fraction with its bound.
type Probed = (Vec<usize>, usize, (f64, f64));

/// The spheres included, free, free along each vector, and included along the free one's way; and what a probe finds.
#[pyfunction]
pub fn pores(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    radii: PyReadonlyArray1<'_, f64>,
    periodic: Vec<f64>,
    probe: Option<f64>,
    task: Task<'_>,
) -> PyResult<(Vec<Sphere>, Option<Probed>)> {
    let torus = torus(Some(&periodic))?.ok_or_else(|| wrong("the box has no vectors"))?;
    let (positions, radii) = (rows("points", points)?, numbers(radii)?);
    let balls = PeriodicBalls::new(torus, positions, radii).map_err(told)?;
    let (found, probed) = run(py, &task.of(balls.radii().len()), move || {
        Stage::Filtration.begin().map_err(ShapeError::from)?;
        let found = balls.pores()?;
        let probed = probe.map(|radius| balls.probed(radius)).transpose()?;
        Ok::<_, walpha::balls::BallsError>((found, probed))
    })?;
    let [a, b, c] = found.free_along;
    let spheres = [found.included, found.free, a, b, c, found.included_along_free];
    let spheres = spheres.map(|FreeSphere { diameter, center }| (diameter, center)).to_vec();
    let probed = probed.map(|probed| {
        let share = probed.void_fraction;
        (probed.channels, probed.pockets, (share.value, share.bound))
    });
    Ok((spheres, probed))
}
