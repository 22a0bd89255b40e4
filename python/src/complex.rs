//! Complexes of any program, to be judged and compared.

use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use walpha::Class;
use walpha::check::schema::{BoxVectors, ComplexFile, PlacedComplex};
use walpha::check::{self, Alpha, CertifyError, CompareError};
use walpha::progress::Stage;
use walpha::shape::placed_complex;

use crate::arrays::{column, lend, numbers, rows};
use crate::errors::{told, wrong};
use crate::shape::{Shape, all_classes, json, numbers_of_box};
use crate::work::{Task, run};

/// A complex with its points, in canonical order.
#[pyclass(frozen, module = "walpha._walpha")]
pub struct Complex(Arc<PlacedComplex>);

/// Simplices of one dimension, and their classes.
type Listed<'py> = (Option<PyReadonlyArray2<'py, u32>>, Option<PyReadonlyArray1<'py, u8>>);

/// The verdict, whether it is right, how many ties and findings there are, of the first findings what they say and their fields
/// as JSON, and what was not judged as JSON.
type Judged = (String, bool, usize, usize, Vec<(String, String)>, String);

#[pymethods]
impl Complex {
    /// Simplices as another program lists them; what is missing is filled in.
    #[new]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn new(
        py: Python<'_>,
        points: PyReadonlyArray2<'_, f64>,
        weights: Option<PyReadonlyArray1<'_, f64>>,
        alpha: f64,
        cells: Listed<'_>,
        facets: Listed<'_>,
        edges: Listed<'_>,
        vertices: Listed<'_>,
        hidden: Option<PyReadonlyArray1<'_, u32>>,
        duplicates: Option<PyReadonlyArray2<'_, u32>>,
        periodic: Option<Vec<f64>>,
        task: Task<'_>,
    ) -> PyResult<Self> {
        let alpha = Alpha::from_squared(alpha).map_err(told)?;
        let mut file = ComplexFile::of_points(rows("points", points)?, alpha);
        file.weights = weights.map(numbers).transpose()?;
        file.cells = table("cells", cells.0)?;
        file.facets = table("facets", facets.0)?;
        file.edges = table("edges", edges.0)?;
        file.vertices = table::<1>("vertices", vertices.0)?.map(|rows| rows.into_flattened());
        file.classes.cells = classes("cell_classes", cells.1)?;
        file.classes.facets = classes("facet_classes", facets.1)?;
        file.classes.edges = classes("edge_classes", edges.1)?;
        file.classes.vertices = classes("vertex_classes", vertices.1)?;
        file.hidden = hidden.map(numbers).transpose()?;
        file.duplicates = duplicates.map(|pairs| rows("duplicates", pairs)).transpose()?;
        file.periodic = periodic.as_deref().and_then(BoxVectors::of_numbers);
        Ok(Self(Arc::new(run(py, &task, move || PlacedComplex::try_from(file))?)))
    }

    /// The complex that a shape claims to be.
    #[staticmethod]
    fn of(py: Python<'_>, shape: &Bound<'_, Shape>) -> PyResult<Self> {
        let shape = Arc::clone(shape.get().shape());
        let placed =
            run(py, &Task::default(), move || Ok::<_, CertifyError>(placed_complex(&shape)))?;
        Ok(Self(Arc::new(placed)))
    }

    #[getter]
    fn points<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        // SAFETY: the complex is frozen.
        unsafe { lend(&slf.get().0.positions, slf.as_any()) }
    }

    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        column(py, self.0.weights.iter().copied())
    }

    #[getter]
    fn alpha(&self) -> f64 {
        self.0.alpha.squared()
    }

    #[getter]
    fn cells<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the complex is frozen.
        unsafe { lend(slf.get().0.complex.cells.rows(), slf.as_any()) }
    }

    #[getter]
    fn facets<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the complex is frozen.
        unsafe { lend(slf.get().0.complex.facets.rows(), slf.as_any()) }
    }

    #[getter]
    fn edges<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the complex is frozen.
        unsafe { lend(slf.get().0.complex.edges.rows(), slf.as_any()) }
    }

    #[getter]
    fn vertices<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the complex is frozen.
        unsafe { lend(slf.get().0.complex.vertices.rows(), slf.as_any()) }
    }

    /// Classes of cells, facets, edges and vertices.
    fn classes<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArray1<u8>>; 4]> {
        all_classes(py, &self.0.complex)
    }

    #[getter]
    fn hidden<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray1<u32>>>> {
        let hidden = self.0.hidden.as_ref();
        hidden.map(|hidden| column(py, hidden.iter().copied())).transpose()
    }

    #[getter]
    fn duplicates<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyArray2<u32>>>> {
        let duplicates = slf.get().0.duplicates.as_ref();
        // SAFETY: the complex is frozen.
        duplicates.map(|pairs| unsafe { lend(pairs, slf.as_any()) }).transpose()
    }

    /// The sides of the periodic box, or the components of its vectors.
    #[getter]
    fn periodic(&self) -> Option<Vec<f64>> {
        self.0.periodic.map(numbers_of_box)
    }

    /// The lowest dimension of which all simplices are listed, and not faces of others alone.
    #[getter]
    fn lowest(&self) -> usize {
        self.0.lowest
    }

    /// Returns this complex with another lowest dimension.
    fn with_lowest(&self, lowest: usize) -> Self {
        Self(Arc::new(PlacedComplex { lowest, ..PlacedComplex::clone(&self.0) }))
    }

    /// The faults of the complex: texts and fields of the first `most` findings. Other choices among ties are findings if
    /// `ties_too`.
    fn check(
        &self,
        py: Python<'_>,
        most: usize,
        ties_too: bool,
        task: Task<'_>,
    ) -> PyResult<Judged> {
        let placed = Arc::clone(&self.0);
        run(py, &task, move || {
            Stage::Certify.begin()?;
            let (mut findings, certificate) = placed.findings()?;
            findings.retain(|finding| ties_too || !finding.is_tie());
            let told =
                findings.iter().take(most).map(|finding| (finding.to_string(), json(finding)));
            let unjudged: Vec<String> =
                certificate.not_judged.iter().map(ToString::to_string).collect();
            let (verdict, ties) = (certificate.verdict, certificate.ties);
            let right = findings.is_empty() && verdict.is_complete();
            let (total, told) = (findings.len(), told.collect());
            Ok::<_, CertifyError>((verdict.to_string(), right, ties, total, told, json(&unjudged)))
        })
    }
}

/// The differences between B and A: whether they are equal, in words, and as JSON.
#[pyfunction]
pub fn compare(
    py: Python<'_>,
    a: &Bound<'_, Complex>,
    b: &Bound<'_, Complex>,
    task: Task<'_>,
) -> PyResult<(bool, String, String)> {
    let (a, b) = (Arc::clone(&a.get().0), Arc::clone(&b.get().0));
    if a.periodic.or(b.periodic).is_some() {
        return Err(wrong(
            "complexes of a periodic box are not compared by places; compare the arrays of rows",
        ));
    }
    run(py, &task, move || {
        Stage::Compare.begin()?;
        let comparison = check::compare(a.placed(), b.placed())?;
        let text = comparison.to_string();
        Ok::<_, CompareError>((comparison.is_equal(), text, json(&comparison)))
    })
}

fn table<const N: usize>(
    name: &str,
    array: Option<PyReadonlyArray2<'_, u32>>,
) -> PyResult<Option<Vec<[u32; N]>>> {
    array.map(|array| rows(name, array)).transpose()
}

fn classes(name: &str, array: Option<PyReadonlyArray1<'_, u8>>) -> PyResult<Option<Vec<Class>>> {
    let class = |number: u8| {
        Class::from_number(number).ok_or_else(|| {
            wrong(format!("{name} holds {number}: classes are numbered from 0 to 3"))
        })
    };
    array.map(|array| numbers(array)?.into_iter().map(class).collect()).transpose()
}
