//! Pictures and pages of a shape.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use walpha::AlphaShape;
use walpha::export::{Target, TargetError};
use walpha::pictures::{self, Look, PageError};
use walpha::render::{ColourMap, Colouring, Size, View};

use crate::errors::{told, wrong};
use crate::work::{Task, run};

/// A picture as PNG; that of a torus is laid out in space.
pub fn picture<'py>(
    py: Python<'py>,
    shape: Arc<AlphaShape>,
    view: &str,
    colour: &str,
    (width, height): (u32, u32),
) -> PyResult<Bound<'py, PyBytes>> {
    let view = match view {
        "front" => View::Front,
        "back" => View::Back,
        "left" => View::Left,
        "right" => View::Right,
        "top" => View::Top,
        "bottom" => View::Bottom,
        "three-quarter" => View::ThreeQuarter,
        _ => {
            return Err(wrong(format!(
                "view={view:?} is none of front, back, left, right, top, bottom and three-quarter"
            )));
        }
    };
    let by_value = match colour {
        "plain" => None,
        "class" => Some(false),
        "value" if shape.points().values().is_none() => {
            return Err(wrong(
                "the points carry no values to colour by: give colour=\"plain\" or \"class\"",
            ));
        }
        "value" => Some(true),
        _ => return Err(wrong(format!("colour={colour:?} is none of plain, value and class"))),
    };
    let size = Size::new(width, height).map_err(told)?;
    let png = run(py, &Task::default(), move || {
        // A shape in space is returned as it is.
        let shape = shape.unwrapped();
        let colouring = match (by_value, shape.points().values()) {
            (Some(true), Some(values)) => Colouring::Values(values, ColourMap::over(values)),
            (Some(_), _) => Colouring::Classes,
            (None, _) => Colouring::Plain,
        };
        pictures::png(&shape, Look::View(view), colouring, size)
    })?;
    Ok(PyBytes::new(py, &png))
}

/// The interactive page of the points of a shape.
pub fn page(
    py: Python<'_>,
    shape: Arc<AlphaShape>,
    title: String,
    facts: Vec<(String, String)>,
) -> PyResult<String> {
    let make = move || Ok::<_, PageError>(pictures::page(&shape, &title, &facts)?.html);
    run(py, &Task::default(), make)
}

/// Writes a file, which appears under its name only when it is complete.
#[pyfunction]
pub fn write_whole(py: Python<'_>, path: PathBuf, content: Vec<u8>) -> PyResult<()> {
    let target = Target::open(&path).map_err(told)?;
    run(py, &Task::default(), move || {
        target.write(|out| out.write_all(&content))?;
        Ok::<_, TargetError>(())
    })
}
