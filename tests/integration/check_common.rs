//! Point sets, and what the engines make of them.

#[allow(dead_code, reason = "the tests of walpha-check use the rest")]
#[path = "../../crates/check/tests/integration/common.rs"]
mod common;

use walpha::shape::{Engine, ShapeError, ShapeOptions};
use walpha::{WeightedPoints, alpha_shape};

pub use common::{Answer, Case, definition, grid, shape_of};

/// CGAL's own answer: the whole triangulation.
pub fn engine(case: &Case) -> Result<Answer, ShapeError> {
    engine_of(case, Engine::Cgal)
}

/// An engine's answer: the whole triangulation.
pub fn engine_of(case: &Case, engine: Engine) -> Result<Answer, ShapeError> {
    let options = ShapeOptions::new(case.alpha()).exterior(true).engine(engine);
    let Case { positions, weights, .. } = case.clone();
    let shape = alpha_shape(WeightedPoints::new(positions, weights).unwrap(), &options)?;
    Ok(Answer {
        complex: shape.complex().clone(),
        hidden: shape.hidden().expect("the whole triangulation was seen").to_vec(),
        duplicates: shape.duplicates().to_vec(),
    })
}
