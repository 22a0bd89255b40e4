//! Makes a shape from points, with options by the names that Python has.

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use walpha::check::schema::BoxVectors;
use walpha::pipeline::PeriodicBox;
use walpha::shape::Torus;
use walpha::{Points, Recipe, Settings};

use super::Shape;
use crate::arrays::{numbers, rows};
use crate::errors::{name as python_name, told, wrong};
use crate::work::{Task, run};

/// Settings by their names, as text.
pub type Written = Vec<(String, String)>;

/// The settings that were given.
///
/// # Errors
/// The error for a wrong value of a setting.
pub fn settings_of(written: Written) -> PyResult<Settings> {
    let mut settings = Settings::default();
    for (name, text) in written {
        settings.set(&name, &text).map_err(|error| {
            let next = error.next.map(|next| format!("; {}", next.with_names(python_name)));
            wrong(format!("{name}={text}: {}{}", error.why, next.unwrap_or_default()))
        })?;
    }
    Ok(settings)
}

/// The recipe with these settings.
///
/// # Errors
/// Settings that contradict each other, besides.
pub fn recipe_of(written: Written) -> PyResult<Recipe> {
    recipe_from(&settings_of(written)?)
}

/// Like [`recipe_of`], of settings that were read.
pub fn recipe_from(settings: &Settings) -> PyResult<Recipe> {
    Ok(settings.recipe().map_err(told)?.classifier(walpha::shape::CGAL))
}

/// The periodic box by its sides, or by the components of its vectors.
pub fn torus(numbers: Option<&[f64]>) -> PyResult<Option<Torus>> {
    let Some(vectors) = numbers.and_then(BoxVectors::of_numbers) else { return Ok(None) };
    PeriodicBox::try_from(vectors).map(PeriodicBox::given).map_err(told)
}

/// The sides of a box along the axes, or the components of its vectors, by rows.
pub fn numbers_of_box(vectors: BoxVectors) -> Vec<f64> {
    match vectors.sides() {
        Some(sides) => sides.to_vec(),
        None => vectors.0.as_flattened().to_vec(),
    }
}

/// The shape of scattered points.
#[pyfunction]
pub fn alpha_shape(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    values: Option<PyReadonlyArray1<'_, f64>>,
    settings: Written,
    task: Task<'_>,
) -> PyResult<Shape> {
    let recipe = recipe_of(settings)?;
    let points = weighted(points, weights, values)?;
    let task = task.of(points.positions.len());
    let model = run(py, &task, move || recipe.run_points(points))?;
    Ok(Shape::of(model))
}

/// Points with a column of weights, or without; as many of each as points.
pub fn weighted(
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    values: Option<PyReadonlyArray1<'_, f64>>,
) -> PyResult<Points> {
    let mut points = Points::new(rows("points", points)?);
    if let Some(weights) = weights {
        points = points.with_weights(numbers(weights)?).map_err(told)?;
    }
    if let Some(values) = values {
        points = points.with_values(numbers(values)?).map_err(told)?;
    }
    Ok(points)
}
