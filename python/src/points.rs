//! Files of points.

use std::path::PathBuf;

use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use walpha::export::Target;
use walpha::points::{Columns, ModelMetadata, Packing, PointOptions, PointWriter, read_model};
use walpha::progress::Stage;
use walpha::{Alpha, WeightedPoints};

use crate::errors::{told, wrong};
use crate::shape::{json, weighted};
use crate::work::{Task, run};

/// Places, weights, values, samples along (x, y, z), α, and the unit of lengths as JSON.
type Read<'py> = (
    Bound<'py, PyArray2<f64>>,
    Option<Bound<'py, PyArray1<f64>>>,
    Option<Bound<'py, PyArray1<f64>>>,
    Option<[usize; 3]>,
    Option<f64>,
    String,
);

/// A file of points: without this number of its last layers, with these columns of a table, one frame of several, of these
/// classes, with the withheld ones, and thinned to one point in each cube of this side.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "they have names in Python")]
pub fn read_points<'py>(
    py: Python<'py>,
    path: PathBuf,
    level: Option<u32>,
    columns: Option<&str>,
    frame: Option<u64>,
    classes: Option<Vec<u8>>,
    withheld: bool,
    thin: Option<f64>,
) -> PyResult<Read<'py>> {
    let columns = columns.map(str::parse::<Columns>).transpose().map_err(told)?;
    let options = PointOptions::default()
        .level(level)
        .columns(columns)
        .frame(frame)
        .classes(classes)
        .withheld(withheld)
        .thin(thin);
    let (points, facts) = run(py, &Task::default(), move || {
        let _ = Stage::Read.begin();
        read_model(&path, &options)
    })?;
    let rows = points.positions.len();
    let places = points.positions.into_flattened().into_pyarray(py).reshape([rows, 3])?;
    Ok((
        places,
        points.weights.map(|weights| weights.into_pyarray(py)),
        points.values.map(|values| values.into_pyarray(py)),
        facts.grid.map(|grid| grid.dims.xyz()),
        facts.alpha.map(Alpha::squared),
        json(&facts.coordinates),
    ))
}

/// The meaning of each column of a table by its name: x, y, z, weight, value, radius, or nothing that is read.
#[pyfunction]
pub fn columns(names: Vec<String>) -> PyResult<Vec<Option<String>>> {
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let columns = String::from(Columns::named(&names).map_err(told)?);
    Ok(columns.split(',').map(|name| (name != "-").then(|| name.to_owned())).collect())
}

/// Writes points under an extension of points.
#[pyfunction]
pub fn write_points(
    py: Python<'_>,
    path: PathBuf,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    values: Option<PyReadonlyArray1<'_, f64>>,
    alpha: Option<f64>,
    value_error: f64,
) -> PyResult<()> {
    let writer = PointWriter::of(&path).map_err(told)?;
    if !writer.packs && (alpha.is_some() || value_error != 0.0) {
        return Err(wrong("alpha and value_error are for .wvm; omit them"));
    }
    if value_error.is_nan() || value_error < 0.0 {
        return Err(wrong("value_error must be a number from 0 up"));
    }
    let alpha = alpha.map(Alpha::from_squared).transpose().map_err(told)?;
    let points = weighted(points, weights, values)?;
    let facts = ModelMetadata::default().alpha(alpha);
    let packing = Packing::default().value_error(value_error);
    let target = Target::open(&path).map_err(told)?;
    run(py, &Task::default(), move || {
        let weights = points.weights.unwrap_or_else(|| vec![0.0; points.positions.len()]);
        let weighted = WeightedPoints::new(points.positions, weights)
            .and_then(|weighted| weighted.with_values(points.values))
            .expect("columns of one length");
        target.write(|out| writer.write_model(&weighted, &facts, &packing, out))
    })
}
