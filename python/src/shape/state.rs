//! How a shape was made, to be made again from its points: what a pickle holds.

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use walpha::pipeline::AlphaRule;
use walpha::shape::{Coordinates, LengthsError, alpha_shape_monitored};
use walpha::{AlphaShape, Recipe, WeightedPoints};

use super::{Shape, json};
use crate::arrays::{numbers, rows};
use crate::errors::wrong;
use crate::work::{Task, run};

/// The options as those of a recipe, the coordinates, and the facts of [`Shape`]: all as JSON.
pub type State = (String, String, String);

/// How a shape was made. Hidden points are asked for again if they are known.
pub fn state(shape: &AlphaShape, facts: &str) -> State {
    let options = shape.options();
    let recipe = Recipe::new()
        .alpha(AlphaRule::Given(options.alpha))
        .balls(options.balls)
        .engine(options.engine)
        .exterior(options.exterior)
        .hidden(options.hidden || shape.hidden().is_some())
        .periodic(options.periodic);
    (recipe.to_json(), json(&shape.coordinates()), facts.into())
}

/// The shape of these points that was made like this.
#[pyfunction]
pub fn restored(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: PyReadonlyArray1<'_, f64>,
    values: Option<PyReadonlyArray1<'_, f64>>,
    state: State,
) -> PyResult<Shape> {
    let (recipe, coordinates, facts) = state;
    let broken = |error| wrong(format!("the state of a shape: {error}"));
    let recipe: Recipe = serde_json::from_str(&recipe).map_err(broken)?;
    let coordinates: Coordinates = serde_json::from_str(&coordinates).map_err(broken)?;
    let AlphaRule::Given(alpha) = recipe.alpha else {
        return Err(wrong("the state of a shape has no alpha"));
    };
    let (points, weights) = (rows("points", &points)?, numbers(&weights)?);
    let lengths = |error: LengthsError| wrong(error.to_string());
    let mut points = WeightedPoints::new(points, weights).map_err(lengths)?;
    if let Some(values) = values {
        points = points.with_values(numbers(&values)?).map_err(lengths)?;
    }
    let shape = run(py, &Task::default(), move |monitor| {
        alpha_shape_monitored(points, &recipe.shape_at(alpha), monitor)
    })?;
    Ok(Shape { shape: shape.with_coordinates(coordinates).into(), facts })
}
