//! An alpha shape in Python.

mod balls;
mod boundary;
mod make;
mod outline;
mod pictures;
mod state;

use std::path::PathBuf;
use std::sync::Arc;

use numpy::ndarray::Array3;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::Value;
use walpha::check::schema::BoxVectors;
use walpha::export::{EmptyShape, ExportOptions, Format, Target, TargetError};
use walpha::interpolate::{Grid, Interpolant, InterpolateError};
use walpha::pipeline::Model;
use walpha::progress::Stage;
use walpha::shape::{Engine, Keep, Largest, LengthsError, Measures, OutlineError};
use walpha::volume::{Dims, Hounsfield};
use walpha::{AlphaShape, Complex, PointsError, Simplices, Weighting};

use crate::arrays::{column, copied, lend, numbers, rows};
use crate::errors::{Refused, told, wrong};
use crate::work::{Task, run};
pub use balls::Union;
use boundary::{Boundary, boundary};
pub use make::{
    Written, alpha_shape, numbers_of_box, recipe_from, recipe_of, settings_of, torus, weighted,
};
use outline::{Outline, outline};
pub use pictures::write_whole;
pub use state::restored;
use state::{State, state};

/// A shape, which is never changed.
#[pyclass(frozen, module = "walpha._walpha")]
pub struct Shape {
    shape: Arc<AlphaShape>,
    /// Further facts about it, as JSON: the origin of its α and of its points.
    #[pyo3(get)]
    facts: String,
}

impl Shape {
    pub fn of(model: Model) -> Self {
        let facts = serde_json::json!({
            "alpha_origin": model.parameter.origin,
            "weighting": model.origin.weighting.to_string(),
            "truncation": model.origin.truncation,
        });
        Self { shape: Arc::new(model.shape), facts: facts.to_string() }
    }

    /// The same shape, of a volume whose values look like Hounsfield units, by which bone was selected.
    pub fn with_ct(self, found: Option<Hounsfield>) -> Self {
        let Some(Hounsfield { air, soft_tissue, .. }) = found else { return self };
        let mut facts: Value = serde_json::from_str(&self.facts).expect("facts are JSON");
        facts["hounsfield"] = serde_json::json!({ "air": air, "soft_tissue": soft_tissue });
        Self { facts: facts.to_string(), ..self }
    }

    pub fn at_level(shape: AlphaShape) -> Self {
        let facts = serde_json::json!({
            "alpha_origin": "given",
            "weighting": Weighting::Column.to_string(),
            "truncation": null,
        });
        Self { shape: Arc::new(shape), facts: facts.to_string() }
    }

    pub fn shape(&self) -> &Arc<AlphaShape> {
        &self.shape
    }

    /// Whether the shape has an outline, or why not.
    fn check_outline(&self) -> Result<(), OutlineError> {
        match self.shape.options().periodic {
            Some(_) => Err(OutlineError::Torus),
            None => walpha::shape::Outline::check(self.shape.points().positions()),
        }
    }

    /// The values to interpolate: these, or those of the points.
    fn values(&self, given: Option<PyReadonlyArray1<'_, f64>>) -> PyResult<Vec<f64>> {
        match given {
            Some(given) => {
                let (values, points) = (numbers(given)?, self.shape.points().len());
                LengthsError::unless_equal("values", values.len(), points)
                    .map_err(|error| told(PointsError::from(error)))?;
                Ok(values)
            }
            None => copied(self.shape.points().values().ok_or_else(|| {
                wrong("the points carry no values to interpolate: give values=, one for each point")
            })?),
        }
    }
}

/// Class numbers, as in [`walpha::Class`].
fn class_numbers<'py, const N: usize>(
    py: Python<'py>,
    simplices: &Simplices<N>,
) -> PyResult<Bound<'py, PyArray1<u8>>> {
    column(py, simplices.classes().iter().map(|&class| class as u8))
}

/// Class numbers of cells, facets, edges and vertices.
pub fn all_classes<'py>(
    py: Python<'py>,
    complex: &Complex,
) -> PyResult<[Bound<'py, PyArray1<u8>>; 4]> {
    Ok([
        class_numbers(py, &complex.cells)?,
        class_numbers(py, &complex.facets)?,
        class_numbers(py, &complex.edges)?,
        class_numbers(py, &complex.vertices)?,
    ])
}

#[pymethods]
impl Shape {
    #[getter]
    fn points<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        // SAFETY: the shape is frozen.
        unsafe { lend(slf.get().shape.points().positions(), slf.as_any()) }
    }

    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        column(py, self.shape.points().weights().iter().copied())
    }

    #[getter(values)]
    fn own_values<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        let values = self.shape.points().values();
        values.map(|values| column(py, values.iter().copied())).transpose()
    }

    #[getter]
    fn cells<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the shape is frozen.
        unsafe { lend(slf.get().shape.complex().cells.rows(), slf.as_any()) }
    }

    #[getter]
    fn facets<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the shape is frozen.
        unsafe { lend(slf.get().shape.complex().facets.rows(), slf.as_any()) }
    }

    #[getter]
    fn edges<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the shape is frozen.
        unsafe { lend(slf.get().shape.complex().edges.rows(), slf.as_any()) }
    }

    #[getter]
    fn vertices<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the shape is frozen.
        unsafe { lend(slf.get().shape.complex().vertices.rows(), slf.as_any()) }
    }

    /// Classes of cells, facets, edges and vertices.
    fn classes<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArray1<u8>>; 4]> {
        all_classes(py, self.shape.complex())
    }

    #[getter]
    fn alpha(&self) -> f64 {
        self.shape.options().alpha.squared()
    }

    /// The value at whose isosurface the solid inside one ends.
    #[getter]
    fn isovalue(&self) -> Option<f64> {
        self.shape.isovalue()
    }

    /// The number of voxels that the solid of labels fills.
    #[getter]
    fn voxels(&self) -> Option<u64> {
        self.shape.voxels().map(|voxels| voxels.count())
    }

    #[getter]
    fn engine(&self) -> &'static str {
        match self.shape.options().engine {
            Engine::Cgal => "cgal",
            Engine::Both => "both",
            _ => "native",
        }
    }

    #[getter]
    fn exterior(&self) -> bool {
        self.shape.options().exterior
    }

    /// Volume, area, area of regular facets, area of singular ones.
    #[getter]
    fn measures(&self, py: Python<'_>) -> (f64, f64, f64, f64) {
        // The first call goes over all simplices.
        let measures = py.detach(|| self.shape.measures());
        let Measures { volume, area, regular_area, singular_area } = measures;
        (volume, area, regular_area, singular_area)
    }

    /// The dimension of what the points span.
    #[getter]
    fn dimension(&self) -> usize {
        self.shape.dimension()
    }

    /// The number of components that were kept, and how many there were.
    #[getter]
    fn kept(&self) -> Option<(usize, usize)> {
        self.shape.kept().map(|kept| (kept.components, kept.of))
    }

    /// The shape with some of its components.
    fn keep(
        &self,
        py: Python<'_>,
        largest: Option<&str>,
        min_volume: Option<f64>,
    ) -> PyResult<Self> {
        let largest = largest.map(|text| text.parse::<Largest>().map_err(told)).transpose()?;
        let keep = Keep::default().largest(largest).min_volume(min_volume);
        let shape = Arc::clone(&self.shape);
        let kept = run(py, &Task::default(), move || Ok::<_, InterpolateError>(shape.keep(&keep)))?;
        if kept.betti().is_none() {
            return Err(wrong(
                "the Betti numbers of a part of this shape cannot be counted: make it with exterior=True",
            ));
        }
        Ok(Self { shape: Arc::new(kept), facts: self.facts.clone() })
    }

    #[getter]
    fn betti(&self) -> (u64, u64, u64, Option<u64>) {
        let betti = self.shape.betti().expect("every way to make a shape counts them");
        (betti.b0, betti.b1, betti.b2, betti.b3)
    }

    /// The sides of the periodic box, or the components of its vectors.
    #[getter]
    fn periodic(&self) -> Option<Vec<f64>> {
        let torus = self.shape.options().periodic?;
        Some(numbers_of_box(BoxVectors(torus.vectors())))
    }

    /// The data from which [`restored`] makes it again.
    fn state(&self) -> State {
        state(&self.shape, &self.facts)
    }

    /// The shape laid out in space.
    fn unwrapped(&self, py: Python<'_>) -> PyResult<Self> {
        let shape = Arc::clone(&self.shape);
        let unwrapped =
            run(py, &Task::default(), move || Ok::<_, InterpolateError>(shape.unwrapped()))?;
        Ok(Self { shape: Arc::new(unwrapped), facts: self.facts.clone() })
    }

    /// The points that the last points are copies of.
    #[getter]
    fn copies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u32>>> {
        column(py, self.shape.copies().iter().copied())
    }

    /// The multiples of the vectors of the box by which each of these is moved.
    #[getter]
    fn shifts<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<i32>>> {
        // SAFETY: the shape is frozen.
        unsafe { lend(slf.get().shape.shifts(), slf.as_any()) }
    }

    #[getter]
    fn hidden<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray1<u32>>>> {
        let hidden = self.shape.hidden();
        hidden.map(|hidden| column(py, hidden.iter().copied())).transpose()
    }

    #[getter]
    fn duplicates<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the shape is frozen.
        unsafe { lend(slf.get().shape.duplicates(), slf.as_any()) }
    }

    /// The components, as JSON.
    fn components(&self, py: Python<'_>) -> PyResult<String> {
        let shape = Arc::clone(&self.shape);
        run(py, &Task::default(), move || Ok::<_, InterpolateError>(json(&shape.components())))
    }

    /// The number of the component of each point; −1 outside.
    fn component_numbers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let number = |n: u32| if n == walpha::shape::NO_COMPONENT { -1 } else { i64::from(n) };
        let shape = Arc::clone(&self.shape);
        let numbers = run(py, &Task::default(), move || {
            Ok::<_, InterpolateError>(shape.component_numbers())
        })?;
        column(py, numbers.into_iter().map(number))
    }

    /// The voids, as JSON; `None` without exterior simplices.
    fn voids(&self, py: Python<'_>) -> PyResult<Option<String>> {
        let shape = Arc::clone(&self.shape);
        run(py, &Task::default(), move || {
            Ok::<_, InterpolateError>(shape.voids().as_ref().map(json))
        })
    }

    /// Places, triangles over them, and the input index of each; then edges cut, vertices doubled, midpoints, vertices
    /// moved, the largest move, vertices that are still together.
    fn boundary<'py>(&self, py: Python<'py>, solid: bool) -> PyResult<Boundary<'py>> {
        boundary(py, Arc::clone(&self.shape), solid)
    }

    /// The union of the balls of the points.
    fn union(&self, py: Python<'_>) -> PyResult<Union> {
        balls::union(py, Arc::clone(&self.shape))
    }

    /// Polygons, singular edges and vertices, area, perimeter, and axes of points in a plane.
    fn outline<'py>(&self, py: Python<'py>) -> PyResult<Outline<'py>> {
        outline(py, Arc::clone(&self.shape))
    }

    /// F at places; NaN outside the shape.
    fn at<'py>(
        &self,
        py: Python<'py>,
        places: PyReadonlyArray2<'_, f64>,
        values: Option<PyReadonlyArray1<'_, f64>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (places, values) = (rows("places", places)?, self.values(values)?);
        let shape = Arc::clone(&self.shape);
        let found = run(py, &Task::default(), move || {
            let interpolant = Interpolant::with_values(&shape, &values)?;
            let values = interpolant.values_at(&places).into_iter();
            Ok::<Vec<f64>, InterpolateError>(values.map(|v| v.unwrap_or(f64::NAN)).collect())
        })?;
        Ok(found.into_pyarray(py))
    }

    /// F on a grid over a box, `[z, y, x]`; sizes and corners as (x, y, z). NaN outside the shape.
    fn interpolate<'py>(
        &self,
        py: Python<'py>,
        sizes: [u64; 3],
        low: [f64; 3],
        high: [f64; 3],
        values: Option<PyReadonlyArray1<'_, f64>>,
        task: Task<'_>,
    ) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let [nx, ny, nz] = sizes;
        let dims = Dims::new(nx, ny, nz).map_err(told)?;
        let grid = Grid::spanning(low, high, dims).map_err(told)?;
        let (values, shape) = (self.values(values)?, Arc::clone(&self.shape));
        let samples = run(py, &task, move || {
            Stage::Interpolate.begin()?;
            let found = Interpolant::with_values(&shape, &values)?.resample(&grid)?;
            Ok::<_, InterpolateError>(with_nan(found))
        })?;
        Ok(samples.into_pyarray(py))
    }

    /// Writes a file, by its extension; says what a user of it has to know of its coordinates, if anything.
    fn save(
        &self,
        py: Python<'_>,
        path: PathBuf,
        solid: bool,
        allow_empty: bool,
    ) -> PyResult<Option<String>> {
        let format = Format::of(&path).map_err(told)?;
        if solid && !format.boundary {
            return Err(wrong(
                "solid=True is for formats of boundaries: this one holds all simplices; omit it",
            ));
        }
        if solid && self.shape.options().periodic.is_some() {
            return Err(wrong(
                "solid=True is for shapes in space: the boundary of one of a torus is cut open; omit it",
            ));
        }
        if format.whole && self.shape.kept().is_some() {
            return Err(wrong(format!(
                "{} states the whole shape, so that it can be checked, and this one has some of its components: write \
                 another format, as .vtu",
                format.name
            )));
        }
        if format.outline {
            self.check_outline().map_err(told)?;
        }
        let exporter = move || format.exporter(&ExportOptions::default().solid(solid));
        let shape = Arc::clone(&self.shape);
        if !allow_empty {
            let shape = Arc::clone(&shape);
            let check = move || EmptyShape::check(&shape, exporter().needs()).map_err(Refused);
            run(py, &Task::default(), check)?;
        }
        let target = Target::open(&path).map_err(told)?;
        run(py, &Task::default(), move || {
            let exporter = exporter();
            target.write(|out| exporter.write(&shape, out))?;
            Ok::<_, TargetError>(
                exporter.single_precision(&shape).and_then(|single| single.remark()),
            )
        })
    }

    /// A picture of it, as PNG; the view and the meaning of colours by name, and the size in pixels.
    fn picture<'py>(
        &self,
        py: Python<'py>,
        view: &str,
        colour: &str,
        size: (u32, u32),
    ) -> PyResult<Bound<'py, PyBytes>> {
        pictures::picture(py, Arc::clone(&self.shape), view, colour, size)
    }

    /// The interactive page of its points, as HTML, with a title and facts.
    fn page(
        &self,
        py: Python<'_>,
        title: String,
        facts: Vec<(String, String)>,
    ) -> PyResult<String> {
        pictures::page(py, Arc::clone(&self.shape), title, facts)
    }
}

/// Samples outside the shape made NaN.
fn with_nan(found: walpha::interpolate::Resampled) -> Array3<f32> {
    let inside: Vec<bool> =
        (0..found.volume().dims().samples()).map(|sample| found.is_inside(sample)).collect();
    let mut samples = found.into_volume().into_samples();
    for (sample, inside) in samples.iter_mut().zip(inside) {
        if !inside {
            *sample = f32::NAN;
        }
    }
    samples
}

/// The JSON of small data, for Python to read.
pub fn json(of: &impl serde::Serialize) -> String {
    serde_json::to_string(of).expect("plain numbers and names")
}
