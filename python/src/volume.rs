//! Volumes of Python: arrays `[z, y, x]`.

use std::path::PathBuf;

use numpy::ndarray::Array3;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyReadonlyArray1, PyReadonlyArray3};
use pyo3::prelude::*;
use walpha::haar::smooth;
use walpha::points::{self, PointsError, Weighting};
use walpha::progress::Stage;
use walpha::volume::{
    Coordinates, Frame, Hounsfield, Nan, ReadOptions, Space, Volume, VolumeError, open,
};
use walpha::{Alpha, LabelChoice, Points, Recipe, Selection, Units};

use crate::arrays::{numbers, samples as owned};
use crate::errors::{told, wrong};
use crate::shape::{Shape, Written, json, recipe_from, settings_of};
use crate::work::{Task, run};

/// A file or sample, read with options as JSON: its samples, whether they are gray levels, and its frame as JSON, in LPS
/// where it says in which space it is. Samples that the options mask are NaN.
#[pyfunction]
pub fn read<'py>(
    py: Python<'py>,
    input: PathBuf,
    options: &str,
    task: Task<'_>,
) -> PyResult<(Bound<'py, PyArray3<f32>>, bool, String)> {
    let options: ReadOptions =
        serde_json::from_str(options).map_err(|error| wrong(format!("the options: {error}")))?;
    let path = input.clone();
    let volume = run(py, &task, move || {
        Stage::Read.begin()?;
        open(&input, &options)
    })
    .map_err(|error| match points::is_point_file(&path) {
        Ok(true) => wrong(format!(
            "{} is not a volume; read_points reads tables and other files of points",
            path.display()
        )),
        _ => error,
    })?;
    let mut frame = *volume.frame();
    if frame.coordinates.space.is_known() {
        frame = frame.to(Coordinates { space: Space::Lps, ..frame.coordinates });
    }
    let gray = volume.has_gray_levels();
    let missing = volume.missing().map(|missing| missing.to_owned());
    let mut samples = volume.into_samples();
    if let Some(missing) = missing {
        samples.zip_mut_with(&missing, |sample, &missing| {
            if missing {
                *sample = f32::NAN;
            }
        });
    }
    Ok((samples.into_pyarray(py), gray, json(&frame)))
}

/// A volume of these samples. NaN are masked if `masked`.
fn volume(samples: Array3<f32>, frame: Frame, masked: bool) -> Result<Volume, VolumeError> {
    Volume::of_file(samples, frame)?.resolve_nan(masked.then_some(Nan::Mask))
}

/// The truncated volume, and what truncation did as JSON.
#[pyfunction]
pub fn haar<'py>(
    py: Python<'py>,
    samples: PyReadonlyArray3<'_, f32>,
    masked: bool,
    settings: Written,
    task: Task<'_>,
) -> PyResult<(Bound<'py, PyArray3<f32>>, String)> {
    let options = settings_of(settings)?.transform();
    let samples = owned(samples)?;
    let (smoothed, truncation) = run(py, &task, move || {
        Stage::Haar.begin()?;
        smooth(&volume(samples, Frame::VOXEL, masked)?, &options)
    })?;
    Ok((smoothed.into_samples().into_pyarray(py), json(&truncation)))
}

/// The difference L of each voxel.
#[pyfunction]
pub fn difference<'py>(
    py: Python<'py>,
    samples: PyReadonlyArray3<'_, f32>,
    masked: bool,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let samples = owned(samples)?;
    let found = run(py, &Task::default(), move || {
        Ok::<_, PointsError>(points::difference(&volume(samples, Frame::VOXEL, masked)?))
    })?;
    Ok(found.into_pyarray(py))
}

/// Selected voxels: positions, values, differences.
type Selected<'py> =
    (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// Voxels of the largest differences.
#[pyfunction]
pub fn select<'py>(
    py: Python<'py>,
    samples: PyReadonlyArray3<'_, f32>,
    masked: bool,
    smoothed: PyReadonlyArray3<'_, f32>,
    frame: Option<&str>,
    settings: Written,
) -> PyResult<Selected<'py>> {
    let (given, other) = (samples.as_array(), smoothed.as_array());
    if given.dim() != other.dim() {
        let (given, other) = (given.shape(), other.shape());
        return Err(wrong(format!(
            "smoothed has shape {other:?}, the volume {given:?}: give one of its shape"
        )));
    }
    let (samples, smoothed) = (owned(samples)?, owned(smoothed)?);
    let (frame, units) = place(frame)?;
    let settings = settings_of(settings)?;
    let selection =
        Selection::default().rule(settings.rule()).gray_min(settings.gray_min().copied());
    let found = run(py, &Task::default(), move || {
        let _ = Stage::Points.begin();
        let (volume, smoothed) =
            (volume(samples, frame, masked)?, volume(smoothed, frame, masked)?);
        // Arrays do not say what they hold.
        let smoothed = smoothed.with_gray_levels();
        let differences = points::difference(&smoothed);
        points::select(&volume, &smoothed, &differences, &selection, units)
    })?;
    let Points { positions, values, differences, .. } = found;
    let n = positions.len();
    let positions = numpy::ndarray::Array2::from_shape_vec((n, 3), positions.into_flattened());
    let column = |column: Option<Vec<f64>>| column.expect("voxels have it").into_pyarray(py);
    let positions = positions.expect("rows of three").into_pyarray(py);
    Ok((positions, column(values), column(differences)))
}

/// Weights of points with these differences, at α.
#[pyfunction]
pub fn weigh<'py>(
    py: Python<'py>,
    differences: PyReadonlyArray1<'_, f64>,
    weighting: &str,
    alpha: f64,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let weighting: Weighting = weighting.parse().map_err(told)?;
    let differences = numbers(differences)?;
    if let Some(at) = differences.iter().position(|x| !x.is_finite()) {
        return Err(wrong(format!(
            "differences[{at}] is {}: give finite numbers",
            differences[at]
        )));
    }
    let alpha = Alpha::from_squared(alpha).map_err(told)?;
    let weights = run(py, &Task::default(), move || {
        // Places do not count here.
        let positions = vec![[0.0; 3]; differences.len()];
        let points = Points::new(positions).with_differences(differences)?;
        points::weights(&points, weighting, alpha)
    })?;
    Ok(weights.into_pyarray(py))
}

/// Computes all stages. `frame` is JSON; without it, coordinates are indices.
#[pyfunction]
pub fn pipeline(
    py: Python<'_>,
    samples: PyReadonlyArray3<'_, f32>,
    is_gray: bool,
    frame: Option<&str>,
    settings: Written,
    task: Task<'_>,
) -> PyResult<Shape> {
    let (frame, units) = place(frame)?;
    let settings = settings_of(settings)?;
    let recipe = recipe_from(&settings)?
        .units(units)
        // Coordinates stay in the space that the frame is in.
        .space(Some(frame.coordinates.space).filter(|space| space.is_known()));
    let nan = recipe.read.nan;
    let samples = owned(samples)?;
    let model = run(py, &task, move || {
        let volume = Volume::of_file(samples, frame).and_then(|volume| volume.resolve_nan(nan));
        let volume = volume.map_err(PointsError::from)?;
        let volume = if is_gray { volume.with_gray_levels() } else { volume };
        let bone = settings.for_ct(&recipe);
        let bone = bone.and_then(|bone| Some((bone, Hounsfield::of_volume(&volume)?)));
        let (recipe, found) = bone.map_or((recipe, None), |(bone, found)| (bone, Some(found)));
        recipe.run(volume).map(|model| (model, found))
    })?;
    let (model, found) = model;
    Ok(Shape::of(model).with_ct(found))
}

/// The solid of labels: of all that are not 0, or of these. `frame` is JSON; without one, coordinates are indices. Samples that are NaN have
/// no label.
#[pyfunction]
pub fn label_shape(
    py: Python<'_>,
    samples: PyReadonlyArray3<'_, f32>,
    frame: Option<&str>,
    labels: Option<Vec<i32>>,
    task: Task<'_>,
) -> PyResult<Shape> {
    let (frame, units) = place(frame)?;
    let recipe = Recipe::new()
        .classifier(walpha::shape::CGAL)
        .labels(Some(labels.map_or(LabelChoice::All, LabelChoice::These)))
        .units(units)
        // Coordinates stay in the space that the frame is in.
        .space(Some(frame.coordinates.space).filter(|space| space.is_known()));
    let samples = owned(samples)?;
    let model = run(py, &task, move || {
        let volume =
            Volume::of_file(samples, frame).and_then(|volume| volume.resolve_nan(Some(Nan::Mask)));
        recipe.solid(&volume.map_err(PointsError::from)?)
    })?;
    Ok(Shape::of(model))
}

/// The location of a grid, and the units of the coordinates of its points.
fn place(frame: Option<&str>) -> PyResult<(Frame, Units)> {
    let Some(frame) = frame else { return Ok((Frame::VOXEL, Units::Voxel)) };
    let frame: Frame =
        serde_json::from_str(frame).map_err(|error| wrong(format!("the frame: {error}")))?;
    let positive = frame.spacing.iter().all(|length| *length > 0.0 && length.is_finite());
    if !positive || frame.origin.iter().any(|x| !x.is_finite()) {
        return Err(wrong(
            "spacing must be three lengths above 0, and origin three finite numbers",
        ));
    }
    Ok((frame, Units::World))
}
