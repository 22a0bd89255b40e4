//! The union of the balls of a shape, as arrays.

use std::sync::Arc;

use numpy::{Element, IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::prelude::*;
use self_cell::self_cell;
use walpha::AlphaShape;
use walpha::balls::{BallUnion, BallsError, Bounded, Cavity, Measured, Pocket};

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
pub type Parts<'py> = (
    [Number; 4],
    i64,
    Option<Number>,
    Column<'py>,
    Column<'py>,
    Bound<'py, PyArray2<u32>>,
    Column<'py>,
);
/// Vertices, triangles, and the ball of each triangle.
pub type Mesh<'py> =
    (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<u32>>, Bound<'py, PyArray1<u32>>);

self_cell!(
    /// The union of the balls of a shape, which it measures once.
    struct Measures {
        owner: Arc<AlphaShape>,
        #[covariant]
        dependent: BallUnion,
    }
);

/// The union of the balls of a shape.
#[pyclass(frozen, module = "walpha._walpha")]
pub struct Union(Arc<Measures>);

/// Measures the union of the balls.
pub fn union(py: Python<'_>, shape: Arc<AlphaShape>) -> PyResult<Union> {
    let measure = move || Measures::try_new(shape, |shape| BallUnion::new(shape));
    Ok(Union(Arc::new(run(py, &Task::default(), measure)?)))
}

fn number(bounded: Bounded) -> Number {
    (bounded.value, bounded.bound)
}

fn column(py: Python<'_>, measured: Measured) -> Column<'_> {
    (measured.values.into_pyarray(py), measured.bounds.into_pyarray(py))
}

fn rows<T: Element, const N: usize>(py: Python<'_>, rows: Vec<[T; N]>) -> Bound<'_, PyArray2<T>> {
    let shape = (rows.len(), N);
    let rows = numpy::ndarray::Array2::from_shape_vec(shape, rows.into_flattened());
    rows.expect("rows of equal length").into_pyarray(py)
}

fn hollow(py: Python<'_>, cavity: Cavity) -> Hollow<'_> {
    let Cavity { cells, volume, area, lining, filling_alpha, .. } = cavity;
    (number(volume), number(area), cells, lining.into_pyarray(py), filling_alpha.squared())
}

impl Union {
    /// Runs work on the union without the interpreter.
    fn run<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&BallUnion<'_>) -> Result<T, BallsError> + Send + 'static,
    ) -> PyResult<T> {
        let measures = Arc::clone(&self.0);
        run(py, &Task::default(), move || work(measures.borrow_dependent()))
    }
}

#[pymethods]
impl Union {
    /// Its measures.
    fn parts<'py>(&self, py: Python<'py>) -> Parts<'py> {
        let union = self.0.borrow_dependent();
        let totals =
            [union.volume(), union.area(), union.mean_curvature(), union.gaussian_curvature()];
        let contacts = union.contacts();
        (
            totals.map(number),
            union.euler_characteristic(),
            union.box_fraction().map(number),
            column(py, union.volumes().clone()),
            column(py, union.areas().clone()),
            rows(py, contacts.pairs.to_vec()),
            column(py, contacts.sizes.clone()),
        )
    }

    /// Its voids.
    fn voids<'py>(&self, py: Python<'py>) -> PyResult<Vec<Hollow<'py>>> {
        let voids = self.run(py, |union| union.voids())?;
        Ok(voids.into_iter().map(|void| hollow(py, void)).collect())
    }

    /// Its pockets, voids among them.
    fn pockets<'py>(&self, py: Python<'py>) -> PyResult<Vec<Open<'py>>> {
        let open = |pocket: Pocket| {
            let closing = pocket.closing_alpha.map_or(f64::NAN, walpha::Alpha::squared);
            (hollow(py, pocket.cavity), pocket.mouths, closing)
        };
        Ok(self.run(py, |union| union.pockets())?.into_iter().map(open).collect())
    }

    /// The derivatives of volume and area, each by the coordinates of the centres (three for each ball) and by the radii.
    fn gradients<'py>(
        &self,
        py: Python<'py>,
        weights: Option<PyReadonlyArray1<'_, f64>>,
    ) -> PyResult<[Column<'py>; 4]> {
        let weights = weights.map(numbers).transpose()?;
        let made = self.run(py, move |union| union.gradients(weights.as_deref()))?;
        Ok([made.volume.by_centers, made.volume.by_radii, made.area.by_centers, made.area.by_radii]
            .map(|measured| column(py, measured)))
    }

    /// Its boundary as triangles.
    fn surface<'py>(&self, py: Python<'py>, tolerance: f64) -> PyResult<Mesh<'py>> {
        let made = self.run(py, move |union| union.surface(tolerance))?;
        Ok((rows(py, made.positions), rows(py, made.triangles), made.balls.into_pyarray(py)))
    }
}
