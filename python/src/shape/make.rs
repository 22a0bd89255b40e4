//! How a shape is made: of points, with options by the names that Python has.

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use walpha::pipeline::AlphaRule;
use walpha::shape::{Balls, Engine, Torus};
use walpha::{Alpha, Points, Recipe};

use super::Shape;
use crate::arrays::{numbers, rows};
use crate::errors::{told, wrong};
use crate::work::{Task, run};

/// Engine and balls by the names that Python has, and whether exterior simplices and hidden points are wanted.
pub type Options = (String, String, bool, bool);

/// A recipe with these options of the shape.
pub fn with_options(
    recipe: Recipe,
    (engine, balls, exterior, hidden): &Options,
) -> PyResult<Recipe> {
    let engine = match &engine[..] {
        "auto" => Engine::Auto,
        "cgal" => Engine::Cgal,
        "native" => Engine::Native,
        _ => return Err(unknown("engine", engine, "'auto', 'cgal' and 'native'")),
    };
    let balls = match &balls[..] {
        "power" => Balls::Power,
        "radius" => Balls::Radius,
        _ => return Err(unknown("balls", balls, "'power' and 'radius'")),
    };
    Ok(recipe.engine(engine).balls(balls).exterior(*exterior).hidden(*hidden))
}

/// The periodic box by its sides.
pub fn torus(sides: Option<[f64; 3]>) -> PyResult<Option<Torus>> {
    sides.map(|sides| Torus::new(sides).map_err(told)).transpose()
}

/// A name that is none of those an option has.
pub fn unknown(option: &str, name: &str, known: &str) -> PyErr {
    wrong(format!("{option}={name:?} is unknown: there are {known}"))
}

/// α as Python has it: a number, or the name of a rule.
#[derive(FromPyObject)]
pub enum AlphaArgument {
    /// A squared length.
    Squared(f64),
    /// `auto` or `auto:connected`.
    Rule(String),
}

/// The rule for α; `None` is the default.
///
/// # Errors
/// NaN, and the name of no rule.
pub fn alpha_rule(alpha: Option<AlphaArgument>) -> PyResult<AlphaRule> {
    let wrong = |alpha: String| {
        wrong(format!("alpha={alpha}: give a squared length, \"auto\" or \"auto:connected\""))
    };
    match alpha {
        None => Ok(AlphaRule::Default),
        Some(AlphaArgument::Squared(alpha)) => {
            Alpha::from_squared(alpha).map(AlphaRule::Given).map_err(|_| wrong(alpha.to_string()))
        }
        Some(AlphaArgument::Rule(name)) => match name.parse() {
            Ok(rule @ (AlphaRule::Auto | AlphaRule::Connected)) => Ok(rule),
            _ => Err(wrong(format!("{name:?}"))),
        },
    }
}

/// The shape of scattered points.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "they have names in Python")]
pub fn alpha_shape(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    values: Option<PyReadonlyArray1<'_, f64>>,
    alpha: Option<AlphaArgument>,
    how: Options,
    periodic: Option<[f64; 3]>,
    task: Task<'_>,
) -> PyResult<Shape> {
    let recipe = with_options(
        Recipe::new().classifier(walpha::shape::CGAL).alpha(alpha_rule(alpha)?),
        &how,
    )?;
    let recipe = recipe.periodic(torus(periodic)?);
    let points = weighted(points, weights, values)?;
    let shape = move || recipe.run_points(points);
    let model = run(py, &task, shape)?;
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
