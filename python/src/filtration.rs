//! All alpha shapes of a set of points, in Python.

use std::num::NonZeroU64;
use std::sync::Arc;

use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use walpha::progress::Stage;
use walpha::shape::ShapeError;
use walpha::{Alpha, WeightedPoints, ladder};

use crate::arrays::numbers;
use crate::errors::{Told, wrong};
use crate::shape::{Shape, json, weighted};
use crate::work::run;

/// A filtration, which is never changed.
#[pyclass(frozen, module = "walpha._walpha")]
pub struct Filtration(Arc<ladder::Filtration>);

/// The columns of a curve: just above each critical value α, b0, b1, b2, solid components.
type Columns<'py> = (Bound<'py, PyArray1<f64>>, [Bound<'py, PyArray1<u64>>; 4]);

#[pymethods]
impl Filtration {
    #[new]
    fn new(
        py: Python<'_>,
        points: PyReadonlyArray2<'_, f64>,
        weights: Option<PyReadonlyArray1<'_, f64>>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let points = weighted(&points, weights.as_ref(), None)?;
        let positions = points.positions;
        let weights = points.weights.unwrap_or_else(|| vec![0.0; positions.len()]);
        let points = WeightedPoints { positions, weights, values: None };
        let made = run(py, progress.as_ref(), move |call| {
            call.begin(Stage::Filtration);
            ladder::Filtration::new(points)
        })?;
        Ok(Self(Arc::new(made)))
    }

    /// The whole triangulation, as a shape.
    fn whole(&self, py: Python<'_>) -> PyResult<Shape> {
        let filtration = Arc::clone(&self.0);
        let whole = run(py, None, move |_| Ok::<_, ShapeError>(filtration.whole().clone()))?;
        Ok(Shape::at_level(whole))
    }

    /// The shape at an α.
    fn shape(
        &self,
        py: Python<'_>,
        alpha: f64,
        exterior: bool,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Shape> {
        let alpha = Alpha::from_squared(alpha).map_err(Told::told)?;
        let filtration = Arc::clone(&self.0);
        let shape = run(py, progress.as_ref(), move |call| {
            call.begin(Stage::Ladder);
            let levels = filtration.levels(&[alpha]);
            Ok::<_, ShapeError>(levels.shape(0, exterior, levels.betti()[0]))
        })?;
        Ok(Shape::at_level(shape))
    }

    /// What is measured at each of several α, ascending and distinct, as JSON; coverage is a share of the hull.
    fn ladder(
        &self,
        py: Python<'_>,
        alphas: PyReadonlyArray1<'_, f64>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<String> {
        let alphas = numbers(&alphas).into_iter().map(Alpha::from_squared);
        let alphas: Vec<Alpha> = alphas.collect::<Result<_, _>>().map_err(Told::told)?;
        let filtration = Arc::clone(&self.0);
        run(py, progress.as_ref(), move |call| {
            call.begin(Stage::Ladder);
            let hull = filtration.whole().measures().volume;
            Ok::<_, ShapeError>(json(&filtration.ladder(&alphas, hull).levels))
        })
    }

    /// The topology at every critical value.
    fn curve<'py>(
        &self,
        py: Python<'py>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Columns<'py>> {
        let filtration = Arc::clone(&self.0);
        let (alphas, columns) = run(py, progress.as_ref(), move |call| {
            call.begin(Stage::Curve);
            let curve = filtration.curve();
            let alphas: Vec<f64> = curve.alphas().collect();
            let column = |k: usize| curve.betti.iter().map(|&b| <[u64; 3]>::from(b)[k]).collect();
            let columns: [Vec<u64>; 4] =
                [column(0), column(1), column(2), curve.solid_components.clone()];
            Ok::<_, ShapeError>((alphas, columns))
        })?;
        Ok((alphas.into_pyarray(py), columns.map(|column| column.into_pyarray(py))))
    }

    /// Values of α to try, as JSON.
    fn suggestions(&self, py: Python<'_>, progress: Option<Bound<'_, PyAny>>) -> PyResult<String> {
        let filtration = Arc::clone(&self.0);
        run(py, progress.as_ref(), move |call| {
            call.begin(Stage::Curve);
            Ok::<_, ShapeError>(json(&filtration.suggest(&filtration.curve())))
        })
    }

    /// The smallest α at which all points are in at most so many solid components.
    fn optimal_alpha(
        &self,
        py: Python<'_>,
        components: u64,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<f64> {
        let components = NonZeroU64::new(components)
            .ok_or_else(|| wrong("components=0 makes no sense: give a number from 1 up"))?;
        let filtration = Arc::clone(&self.0);
        run(py, progress.as_ref(), move |call| {
            call.begin(Stage::Alpha);
            Ok::<_, ShapeError>(filtration.optimal_alpha(components).squared())
        })
    }
}
