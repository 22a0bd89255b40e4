//! The data from which a shape is made again, with its points: the content of a pickle.

use std::cell::Cell;

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use serde_json::Value;
use walpha::pipeline::{AlphaRule, PeriodicBox};
use walpha::shape::{Coordinates, LengthsError, Voxels, alpha_shape, voxel_shape};
use walpha::{AlphaShape, Recipe, WeightedPoints};

use super::{Shape, json};
use crate::arrays::{numbers, rows};
use crate::errors::wrong;
use crate::work::{Task, run};

/// The options as those of a recipe, the coordinates, and the facts of [`Shape`]: all as JSON.
pub type State = (String, String, String);

/// The fact that the solid of labels fills these voxels.
const VOXELS: &str = "voxels";

/// The data from which a shape is made again. Hidden points are requested again if they are known. For the solid of labels, the
/// facts also have its voxels.
pub fn state(shape: &AlphaShape, facts: &str) -> State {
    let facts = match shape.voxels() {
        None => facts.to_owned(),
        Some(voxels) => {
            let mut facts: Value = serde_json::from_str(facts).expect("facts are JSON");
            facts[VOXELS] = serde_json::to_value(voxels).expect("voxels are numbers");
            facts.to_string()
        }
    };
    let options = shape.options();
    let recipe = Recipe::new()
        .alpha(AlphaRule::Given(options.alpha))
        .balls(options.balls)
        .engine(options.engine)
        .exterior(options.exterior)
        .hidden(options.hidden || shape.hidden().is_some())
        .periodic(options.periodic.map(PeriodicBox::Given));
    (recipe.to_json(), json(&shape.coordinates()), facts)
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
    let (points, weights) = (rows("points", points)?, numbers(weights)?);
    let lengths = |error: LengthsError| wrong(error.to_string());
    let mut points = WeightedPoints::new(points, weights).map_err(lengths)?;
    if let Some(values) = values {
        points = points.with_values(numbers(values)?).map_err(lengths)?;
    }
    let mut facts: Value = serde_json::from_str(&facts).map_err(broken)?;
    let voxels = facts.as_object_mut().and_then(|facts| facts.remove(VOXELS));
    let voxels: Option<Voxels> = voxels.map(serde_json::from_value).transpose().map_err(broken)?;
    let shape = run(py, &Task::default(), move || match voxels {
        None => alpha_shape(points, &recipe.shape_at(alpha)),
        Some(voxels) => {
            // Corners come in the order of the points.
            let values = points.values().unwrap_or_default();
            let next = Cell::new(0);
            let value = |_| values.get(next.replace(next.get() + 1)).copied().unwrap_or_default();
            voxel_shape(voxels, value)
        }
    })?;
    Ok(Shape { shape: shape.with_coordinates(coordinates).into(), facts: facts.to_string() })
}
