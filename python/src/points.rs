//! Files of points.

use std::path::PathBuf;

use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use walpha::export::Target;
use walpha::points::internal::describe_file;
use walpha::points::{
    Attributes, Column, Columns, LasHeader, ModelMetadata, Packing, PointOptions, PointWriter,
    Region, read_model,
};
use walpha::progress::Stage;
use walpha::volume::OpenFile;
use walpha::{Alpha, WeightedPoints};

use crate::errors::{told, wrong};
use crate::shape::{json, weighted};
use crate::work::{Task, run};

/// Places, weights, values, samples along (x, y, z), α, and as JSON the unit of lengths, the system of coordinates, and the numbers
/// of points of each class.
type Read<'py> = (
    Bound<'py, PyArray2<f64>>,
    Option<Bound<'py, PyArray1<f64>>>,
    Option<Bound<'py, PyArray1<f64>>>,
    Option<[usize; 3]>,
    Option<f64>,
    [String; 3],
);

/// How a file of points is read: without this number of its last layers, with these columns of a table, one frame of several, of these
/// classes, with the withheld ones, in this box, thinned to one point in each cube of this side, and with the values of this column.
#[derive(FromPyObject)]
pub struct Reading {
    #[pyo3(item)]
    level: Option<u32>,
    #[pyo3(item)]
    columns: Option<String>,
    #[pyo3(item)]
    frame: Option<u64>,
    #[pyo3(item)]
    classes: Option<Vec<u8>>,
    #[pyo3(item)]
    withheld: bool,
    #[pyo3(item)]
    roi: Option<[[f64; 2]; 3]>,
    #[pyo3(item)]
    thin: Option<f64>,
    #[pyo3(item)]
    value: Option<String>,
}

impl Reading {
    fn options(self) -> PyResult<PointOptions> {
        let columns = self.columns.as_deref().map(str::parse::<Columns>);
        Ok(PointOptions::default()
            .level(self.level)
            .columns(columns.transpose().map_err(told)?)
            .frame(self.frame)
            .classes(self.classes)
            .withheld(self.withheld)
            .region(self.roi.map(|ends| Region {
                low: ends.map(|[low, _]| low),
                high: ends.map(|[_, high]| high),
            }))
            .thin(self.thin)
            .value(self.value))
    }
}

/// The points of a file.
#[pyfunction]
pub fn read_points(py: Python<'_>, path: PathBuf, reading: Reading) -> PyResult<Read<'_>> {
    let options = reading.options()?;
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
        [json(&facts.coordinates), json(&facts.crs), json(&facts.scan.map(|scan| scan.classes))],
    ))
}

/// The names of the columns that a file has beside coordinates.
#[pyfunction]
pub fn point_columns(py: Python<'_>, path: PathBuf, reading: Reading) -> PyResult<Vec<String>> {
    let options = reading.options()?;
    let (_, facts) = run(py, &Task::default(), move || match options.made(&path)? {
        Some(made) => Ok(made),
        None => describe_file(&OpenFile::open(&path)?, &options),
    })?;
    Ok(facts.columns.into_iter().map(|column| column.name).collect())
}

/// The numbers in a column of a file, NaN where a point has none.
#[pyfunction]
pub fn point_column(
    py: Python<'_>,
    path: PathBuf,
    name: String,
    reading: Reading,
) -> PyResult<Bound<'_, PyArray1<f64>>> {
    let options = reading.options()?.attributes(Attributes::Named(vec![name.clone()]));
    let (points, _) = run(py, &Task::default(), move || read_model(&path, &options))?;
    let column = points.column(&name).expect("the reader refuses a file without it");
    Ok(column.into_owned().into_pyarray(py))
}

/// The meaning of each column of a table by its name: x, y, z, weight, value, radius, or nothing that is read.
#[pyfunction]
pub fn columns(names: Vec<String>) -> PyResult<Vec<Option<String>>> {
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let columns = Columns::named(&names).map_err(told)?;
    Ok(columns.meanings().into_iter().map(|name| name.map(str::to_owned)).collect())
}

/// Writes points under an extension of points, with further columns by name, and as the LAS file `like` where it is given.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "they are keywords")]
pub fn write_points(
    py: Python<'_>,
    path: PathBuf,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    values: Option<PyReadonlyArray1<'_, f64>>,
    columns: Vec<(String, PyReadonlyArray1<'_, f64>)>,
    like: Option<PathBuf>,
    alpha: Option<f64>,
    value_error: f64,
) -> PyResult<()> {
    let writer = PointWriter::of(&path).map_err(told)?;
    if !writer.packs && (alpha.is_some() || value_error != 0.0) {
        return Err(wrong("alpha and value_error are for .wvm; omit them"));
    }
    if !writer.columns && !columns.is_empty() {
        return Err(wrong("columns are for .csv, .npy, .las and .laz; omit them"));
    }
    if !["las", "laz"].contains(&writer.extension) && like.is_some() {
        return Err(wrong("like is for .las and .laz; omit it"));
    }
    if value_error.is_nan() || value_error < 0.0 {
        return Err(wrong("value_error must be a number from 0 up"));
    }
    let alpha = alpha.map(Alpha::from_squared).transpose().map_err(told)?;
    let points = weighted(points, weights, values)?;
    let column = |(name, values): (String, PyReadonlyArray1<'_, f64>)| Column {
        name,
        values: values.as_array().to_vec(),
    };
    let columns: Vec<Column> = columns.into_iter().map(column).collect();
    let packing = Packing::default().value_error(value_error);
    let target = Target::open(&path).map_err(told)?;
    let las = like.map(LasHeader::read).transpose().map_err(told)?;
    let facts = ModelMetadata::default().alpha(alpha).las(las);
    run(py, &Task::default(), move || {
        let weights = points.weights.unwrap_or_else(|| vec![0.0; points.positions.len()]);
        let weighted = WeightedPoints::new(points.positions, weights)
            .and_then(|weighted| weighted.with_values(points.values))
            .expect("columns of one length");
        target.write(|out| writer.write_model(&weighted, &columns, &facts, &packing, out))
    })
}
