//! All alpha shapes of a set of points, in Python.

use std::num::NonZeroU64;
use std::sync::{Arc, OnceLock};

use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use rayon::prelude::*;
use self_cell::self_cell;
use walpha::check::schema::BoxVectors;
use walpha::ladder::{self, Ordered};
use walpha::progress::Stage;
use walpha::render::persistence_figure;
use walpha::shape::ShapeError;
use walpha::{Alpha, NoMemory, WeightedPoints, try_with_capacity};

use crate::arrays::{array2, column, lend, numbers};
use crate::errors::{told, wrong};
use crate::shape::{Shape, json, numbers_of_box, torus, weighted};
use crate::work::{Task, run};

/// A filtration, which is never changed.
#[pyclass(frozen, module = "walpha._walpha")]
pub struct Filtration(pub Arc<ladder::Filtration>);

/// The columns of a curve: just above each critical value α, b0, b1, b2, solid components, and of a torus b3.
type Columns<'py> = (Bound<'py, PyArray1<f64>>, Vec<Bound<'py, PyArray1<u64>>>);

#[pymethods]
impl Filtration {
    #[new]
    fn new(
        py: Python<'_>,
        points: PyReadonlyArray2<'_, f64>,
        weights: Option<PyReadonlyArray1<'_, f64>>,
        periodic: Option<Vec<f64>>,
        task: Task<'_>,
    ) -> PyResult<Self> {
        let torus = torus(periodic.as_deref())?;
        let points = weighted(points, weights, None)?;
        let made = run(py, &task.of(points.positions.len()), move || {
            Stage::Filtration.begin()?;
            let positions = points.positions;
            let weights = points.weights.unwrap_or_else(|| vec![0.0; positions.len()]);
            let points =
                WeightedPoints::new(positions, weights).expect("as many weights as points");
            ladder::Filtration::on(torus, points)
        })?;
        Ok(Self(Arc::new(made)))
    }

    /// The whole triangulation, as a shape.
    fn whole(&self, py: Python<'_>) -> PyResult<Shape> {
        let filtration = Arc::clone(&self.0);
        let whole =
            run(py, &Task::default(), move || Ok::<_, ShapeError>(filtration.whole().clone()))?;
        Ok(Shape::at_level(whole))
    }

    /// The shape at an α.
    fn shape(&self, py: Python<'_>, alpha: f64, exterior: bool, task: Task<'_>) -> PyResult<Shape> {
        let alpha = Alpha::from_squared(alpha).map_err(told)?;
        let filtration = Arc::clone(&self.0);
        let shape = run(py, &task.of(self.0.points().len()), move || {
            Stage::Ladder.begin()?;
            let levels = filtration.levels(&[alpha]);
            Ok::<_, ShapeError>(levels.shape(0, exterior, levels.betti()[0]))
        })?;
        Ok(Shape::at_level(shape))
    }

    /// The measurements at each of several α, ascending and distinct, as JSON. Coverage is a share of the hull.
    fn ladder(
        &self,
        py: Python<'_>,
        alphas: PyReadonlyArray1<'_, f64>,
        task: Task<'_>,
    ) -> PyResult<String> {
        let alphas = numbers(alphas)?.into_iter().map(Alpha::from_squared);
        let alphas: Vec<Alpha> = alphas.collect::<Result<_, _>>().map_err(told)?;
        let filtration = Arc::clone(&self.0);
        run(py, &task.of(self.0.points().len()), move || {
            Stage::Ladder.begin()?;
            let hull = filtration.whole().measures().volume;
            Ok::<_, ShapeError>(json(&filtration.ladder(&alphas, hull).levels))
        })
    }

    /// The topology at every critical value.
    fn curve<'py>(&self, py: Python<'py>, task: Task<'_>) -> PyResult<Columns<'py>> {
        let filtration = Arc::clone(&self.0);
        let (alphas, columns) = run(py, &task.of(self.0.points().len()), move || {
            Stage::Curve.begin()?;
            let curve = filtration.curve();
            let alphas: Vec<f64> = curve.alphas().collect();
            let column = |k: usize| curve.betti.iter().map(|&b| <[u64; 3]>::from(b)[k]).collect();
            let mut columns: Vec<Vec<u64>> =
                vec![column(0), column(1), column(2), curve.solid_components.clone()];
            if filtration.torus().is_some() {
                columns.push(curve.betti.iter().filter_map(|betti| betti.b3).collect());
            }
            Ok::<_, ShapeError>((alphas, columns))
        })?;
        let columns = columns.into_iter().map(|column| column.into_pyarray(py));
        Ok((alphas.into_pyarray(py), columns.collect()))
    }

    #[getter]
    fn copies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u32>>> {
        column(py, self.0.whole().copies().iter().copied())
    }

    #[getter]
    fn shifts<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<i32>>> {
        // SAFETY: the filtration is frozen.
        unsafe { lend(slf.get().0.whole().shifts(), slf.as_any()) }
    }

    #[getter]
    fn points<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        // SAFETY: the filtration is frozen.
        unsafe { lend(slf.get().0.whole().points().positions(), slf.as_any()) }
    }

    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        column(py, self.0.whole().points().weights().iter().copied())
    }

    /// The sides of the periodic box, or the components of its vectors.
    #[getter]
    fn periodic(&self) -> Option<Vec<f64>> {
        self.0.torus().map(|torus| numbers_of_box(BoxVectors(torus.vectors())))
    }

    /// All simplices in order.
    fn simplices(&self, py: Python<'_>, task: Task<'_>) -> PyResult<Simplices> {
        let filtration = Arc::clone(&self.0);
        run(py, &task.of(self.0.points().len()), move || {
            Stage::Order.begin()?;
            let ordered = Owned::try_new(filtration, |own| own.simplices())?;
            Ok::<_, ShapeError>(Simplices { ordered: Arc::new(ordered), entries: OnceLock::new() })
        })
    }

    /// The derivatives of the squared radii of simplices with respect to their points, which are given one after the other: x, y,
    /// z and weight of each.
    fn derivatives<'py>(
        &self,
        py: Python<'py>,
        vertices: PyReadonlyArray1<'_, u32>,
        corners: usize,
        task: Task<'_>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let vertices = numbers(vertices)?;
        let filtration = Arc::clone(&self.0);
        let found = run(py, &task.of(self.0.points().len()), move || {
            let mut found = Vec::with_capacity(4 * vertices.len());
            for simplex in vertices.chunks_exact(corners) {
                for ladder::Derivative { position: [x, y, z], weight, .. } in
                    filtration.derivatives(simplex)
                {
                    found.extend([x, y, z, weight]);
                }
            }
            Ok::<_, ShapeError>(found)
        })?;
        Ok(found.into_pyarray(py))
    }

    /// Values of α to try, as JSON.
    fn suggestions(&self, py: Python<'_>, task: Task<'_>) -> PyResult<String> {
        let filtration = Arc::clone(&self.0);
        run(py, &task.of(self.0.points().len()), move || {
            Stage::Curve.begin()?;
            Ok::<_, ShapeError>(json(&filtration.suggest(&filtration.curve())))
        })
    }

    /// The smallest α at which all points are in at most this many solid components.
    fn optimal_alpha(&self, py: Python<'_>, components: u64, task: Task<'_>) -> PyResult<f64> {
        let components = NonZeroU64::new(components)
            .ok_or_else(|| wrong("components=0 is not valid: give a number from 1 up"))?;
        let filtration = Arc::clone(&self.0);
        run(py, &task.of(self.0.points().len()), move || {
            Stage::Alpha.begin()?;
            Ok::<_, ShapeError>(filtration.optimal_alpha(components).squared())
        })
    }
}

self_cell! {
    /// A filtration with its simplices in order.
    struct Owned {
        owner: Arc<ladder::Filtration>,
        #[covariant]
        dependent: Ordered,
    }
}

/// The arrays of a loop.
type PyLoop<'py> = (
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray1<i32>>,
);

/// The arrays of a void.
type PyVoid<'py> =
    (Bound<'py, PyArray1<u32>>, Bound<'py, PyArray2<u32>>, Bound<'py, PyArray2<f64>>);

/// All simplices of a filtration by their numbers, which never change. Results that take time are computed when they are first
/// requested.
#[pyclass(frozen, module = "walpha._walpha")]
pub struct Simplices {
    ordered: Arc<Owned>,
    entries: OnceLock<Entries>,
}

/// When each simplex enters.
struct Entries {
    /// The α from which on each simplex is present, on the boundary of another, and inside: one row for each.
    intervals: Vec<[f64; 3]>,
    /// The rank of each simplex, and whether it is a Gabriel simplex.
    kinds: Vec<(u32, bool)>,
}

impl Entries {
    fn of(ordered: &Ordered<'_>) -> Result<Self, NoMemory> {
        let entry = |number: u32| {
            let ladder::Entry { value, rank, gabriel, regular, interior, .. } =
                ordered.simplex(number);
            ([value, regular, interior], (rank, gabriel))
        };
        let mut intervals = try_with_capacity(ordered.len(), || "intervals of simplices".into())?;
        let mut kinds = try_with_capacity(ordered.len(), || "ranks of simplices".into())?;
        let entries = (0..ordered.len() as u32).into_par_iter().map(entry);
        entries.unzip_into_vecs(&mut intervals, &mut kinds);
        Ok(Self { intervals, kinds })
    }
}

impl Simplices {
    fn ordered(&self) -> &Ordered<'_> {
        self.ordered.borrow_dependent()
    }

    fn entries(&self, py: Python<'_>) -> PyResult<&Entries> {
        if let Some(entries) = self.entries.get() {
            return Ok(entries);
        }
        let entries = self.work(py, |ordered| Ok(Entries::of(ordered)?))?;
        Ok(self.entries.get_or_init(|| entries))
    }

    /// The persistence pairs of dimensions 0 and 2.
    fn pairs(&self, py: Python<'_>) -> PyResult<&ladder::Pairs> {
        // Found once, by the first who asks.
        self.work(py, |ordered| {
            ordered.pairs();
            Ok(())
        })?;
        Ok(self.ordered().pairs())
    }

    /// The persistence pairs of dimension 1.
    fn loops(&self, py: Python<'_>) -> PyResult<&ladder::Loops> {
        self.work(py, |ordered| ordered.loops().map(|_| ()))?;
        self.ordered().loops().map_err(told)
    }

    /// Does long work on the simplices.
    fn work<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Ordered<'_>) -> Result<T, ShapeError> + Send + 'static,
    ) -> PyResult<T> {
        let ordered = Arc::clone(&self.ordered);
        let points = self.ordered().filtration().points().len();
        run(py, &Task::default().of(points), move || {
            Stage::Pairs.begin()?;
            work(ordered.borrow_dependent())
        })
    }
}

#[pymethods]
impl Simplices {
    #[getter]
    fn vertices<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the simplices are frozen.
        unsafe { lend(slf.get().ordered().vertices(), slf.as_any()) }
    }

    #[getter]
    fn edges<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the simplices are frozen.
        unsafe { lend(slf.get().ordered().edges(), slf.as_any()) }
    }

    #[getter]
    fn facets<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the simplices are frozen.
        unsafe { lend(slf.get().ordered().facets(), slf.as_any()) }
    }

    #[getter]
    fn cells<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the simplices are frozen.
        unsafe { lend(slf.get().ordered().cells(), slf.as_any()) }
    }

    #[getter]
    fn intervals<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        // SAFETY: the simplices are frozen, and what was found once stays.
        unsafe { lend(&slf.get().entries(slf.py())?.intervals, slf.as_any()) }
    }

    #[getter]
    fn ranks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u32>>> {
        column(py, self.entries(py)?.kinds.iter().map(|&(rank, _)| rank))
    }

    #[getter]
    fn gabriel<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<bool>>> {
        column(py, self.entries(py)?.kinds.iter().map(|&(_, gabriel)| gabriel))
    }

    #[getter]
    fn gabriel_simplices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u32>>> {
        Ok(self.work(py, |ordered| Ok(ordered.gabriel_simplices()))?.into_pyarray(py))
    }

    #[getter]
    fn cech_values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(self.work(py, |ordered| Ok(ordered.cech_values()))?.into_pyarray(py))
    }

    #[getter]
    fn order<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u32>>> {
        column(py, self.ordered().order().iter().copied())
    }

    #[getter]
    fn component_pairs<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the simplices are frozen, and what was found once stays.
        unsafe { lend(&slf.get().pairs(slf.py())?.components, slf.as_any()) }
    }

    #[getter]
    fn loop_pairs<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the simplices are frozen, and what was found once stays.
        unsafe { lend(&slf.get().loops(slf.py())?.pairs, slf.as_any()) }
    }

    #[getter]
    fn void_pairs<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        // SAFETY: the simplices are frozen, and what was found once stays.
        unsafe { lend(&slf.get().pairs(slf.py())?.voids, slf.as_any()) }
    }

    /// Of the loop that each of these edges creates, if it does: the vertices of a walk and their positions, and the edges and coefficients of a cycle.
    fn loop_cycles<'py>(
        &self,
        py: Python<'py>,
        edges: PyReadonlyArray1<'py, u32>,
    ) -> PyResult<Vec<Option<PyLoop<'py>>>> {
        let edges = numbers(edges)?;
        let found = self.work(py, move |ordered| {
            let cycles = ordered.cycles();
            edges.into_iter().map(|edge| cycles.of_loop(edge)).collect::<Result<Vec<_>, _>>()
        })?;
        let array = |cycle: ladder::LoopCycle| {
            let (edges, coefficients): (Vec<u32>, Vec<i32>) = cycle.chain.into_iter().unzip();
            let path = PyArray2::from_owned_array(py, array2(cycle.path));
            let edges = edges.into_pyarray(py);
            (cycle.walk.into_pyarray(py), path, edges, coefficients.into_pyarray(py))
        };
        Ok(found.into_iter().map(|cycle| cycle.map(array)).collect())
    }

    /// Of the void that each of these cells ends, if it does: its cells, and the facets around it with the positions of their corners, nine numbers each.
    fn void_cycles<'py>(
        &self,
        py: Python<'py>,
        cells: PyReadonlyArray1<'py, u32>,
    ) -> PyResult<Vec<Option<PyVoid<'py>>>> {
        let cells = numbers(cells)?;
        let found = self.work(py, move |ordered| {
            let cycles = ordered.cycles();
            Ok(cells.into_iter().map(|cell| cycles.of_void(cell)).collect::<Vec<_>>())
        })?;
        let array = |cycle: ladder::VoidCycle| {
            let corners: Vec<[f64; 3]> = cycle.corners.into_iter().flatten().collect();
            let facets = PyArray2::from_owned_array(py, array2(cycle.facets));
            let corners = PyArray2::from_owned_array(py, array2(corners));
            (cycle.cells.into_pyarray(py), facets, corners)
        };
        Ok(found.into_iter().map(|cycle| cycle.map(array)).collect())
    }

    /// Simplices that begin something of this dimension, from 0 to 3, which never ends.
    fn lasting<'py>(&self, py: Python<'py>, dimension: u32) -> PyResult<Bound<'py, PyArray1<u32>>> {
        let ladder::Pairs { lasting, lasting_voids, last, .. } = self.pairs(py)?;
        let numbers = match dimension {
            0 => lasting,
            1 => &self.loops(py)?.lasting,
            2 => lasting_voids,
            _ => last.as_slice(),
        };
        column(py, numbers.iter().copied())
    }
}

/// A persistence diagram as SVG: births and deaths of components, loops and voids.
#[pyfunction]
pub fn persistence_svg(
    components: PyReadonlyArray2<'_, f64>,
    loops: PyReadonlyArray2<'_, f64>,
    voids: PyReadonlyArray2<'_, f64>,
) -> PyResult<String> {
    let [components, loops, voids] = [components, loops, voids].map(|intervals| {
        let intervals = intervals.as_array();
        intervals.outer_iter().map(|row| [row[0], row[1]]).collect::<Vec<_>>()
    });
    persistence_figure("Persistence", [&components, &loops, &voids]).to_svg().map_err(told)
}
