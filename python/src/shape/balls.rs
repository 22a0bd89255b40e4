//! The union of the balls of a shape, as arrays.

use std::sync::Arc;

use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::prelude::*;
use walpha::AlphaShape;
use walpha::balls::{BallUnion, BallsError, Bounded, Cavity, Measured};

use crate::arrays::numbers;
use crate::work::{Task, run};

/// A value and the bound on its error.
pub type Number = (f64, f64);
/// Values and the bounds on their errors.
pub type Column<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);
/// Volume, area, number of cells, balls at it, α that fills it.
pub type Hollow<'py> = (Number, Number, usize, Bound<'py, PyArray1<u32>>, f64);
/// A pocket: what a void has, its mouths as facets, and the α that closes it; NaN for a void.
pub type Open<'py> = (Hollow<'py>, Vec<Vec<[u32; 3]>>, f64);

/// Volume, area, mean and Gaussian curvature; Euler characteristic; share of the periodic box; volumes and areas of balls; pairs of
/// balls that meet, and the area of each contact.
pub type Union<'py> = (
    [Number; 4],
    i64,
    Option<Number>,
    Column<'py>,
    Column<'py>,
    Bound<'py, PyArray2<u32>>,
    Column<'py>,
);

fn number(bounded: Bounded) -> Number {
    (bounded.value, bounded.bound)
}

fn column(py: Python<'_>, measured: Measured) -> Column<'_> {
    (measured.values.into_pyarray(py), measured.bounds.into_pyarray(py))
}

/// The union of the balls.
pub fn union<'py>(py: Python<'py>, shape: Arc<AlphaShape>) -> PyResult<Union<'py>> {
    let made = run(py, &Task::default(), move || {
        let union = BallUnion::new(&shape)?;
        let totals =
            [union.volume(), union.area(), union.mean_curvature(), union.gaussian_curvature()];
        let contacts = union.contacts();
        Ok::<_, BallsError>((
            totals.map(number),
            union.euler_characteristic(),
            union.box_fraction().map(number),
            union.volumes().clone(),
            union.areas().clone(),
            contacts.pairs.to_vec(),
            contacts.sizes.clone(),
        ))
    })?;
    let (totals, euler, share, volumes, areas, pairs, sizes) = made;
    let rows = (pairs.len(), 2);
    let pairs = numpy::ndarray::Array2::from_shape_vec(rows, pairs.into_flattened());
    let pairs = pairs.expect("rows of two").into_pyarray(py);
    Ok((totals, euler, share, column(py, volumes), column(py, areas), pairs, column(py, sizes)))
}

fn hollow(py: Python<'_>, cavity: Cavity) -> Hollow<'_> {
    let Cavity { cells, volume, area, lining, filling_alpha, .. } = cavity;
    (number(volume), number(area), cells, lining.into_pyarray(py), filling_alpha.squared())
}

/// The voids of the union.
pub fn voids(py: Python<'_>, shape: Arc<AlphaShape>) -> PyResult<Vec<Hollow<'_>>> {
    let voids = run(py, &Task::default(), move || BallUnion::new(&shape)?.voids())?;
    Ok(voids.into_iter().map(|void| hollow(py, void)).collect())
}

/// The pockets of the union, voids among them.
pub fn pockets(py: Python<'_>, shape: Arc<AlphaShape>) -> PyResult<Vec<Open<'_>>> {
    let pockets = run(py, &Task::default(), move || BallUnion::new(&shape)?.pockets())?;
    let open = |pocket: walpha::balls::Pocket| {
        let closing = pocket.closing_alpha.map_or(f64::NAN, walpha::Alpha::squared);
        (hollow(py, pocket.cavity), pocket.mouths, closing)
    };
    Ok(pockets.into_iter().map(open).collect())
}

/// The derivatives of volume and area, each by the coordinates of the centres (three for each ball) and by the radii.
pub fn gradients<'py>(
    py: Python<'py>,
    shape: Arc<AlphaShape>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
) -> PyResult<[Column<'py>; 4]> {
    let weights = weights.map(numbers).transpose()?;
    let made =
        run(py, &Task::default(), move || BallUnion::new(&shape)?.gradients(weights.as_deref()))?;
    Ok([made.volume.by_centers, made.volume.by_radii, made.area.by_centers, made.area.by_radii]
        .map(|measured| column(py, measured)))
}
