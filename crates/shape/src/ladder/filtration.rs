use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use walpha_base::{Monitor, memory};
use walpha_regular::{Predicates, Torus};

use super::incidence::Incidence;
use crate::WeightedPoints;
use crate::{Alpha, AlphaShape, Complex, Engine, ShapeError, ShapeOptions, alpha_shape_monitored};

/// All alpha shapes of a set of points: the regular triangulation, and for each simplex the α at which it enters.
///
/// Weights are the same for every α; with weights that depend on α, shapes would not be nested. A simplex enters
/// at the squared radius of its smallest orthogonal sphere if no point
/// lies strictly inside (it is *Gabriel*), else with the first simplex it is a face of
/// (Edelsbrunner and Mücke 1994, doi:10.1145/174462.156635; CGAL's `Alpha_shape_3` keeps the same
/// intervals, in rounded numbers). Here a radius is the nearest double, and where an α is as near to the
/// exact number, exact arithmetic decides: a shape taken from a filtration equals that of
/// [`alpha_shape`](crate::alpha_shape()).
pub struct Filtration {
    pub(super) whole: AlphaShape,
    pub(super) incidence: Incidence,
    /// Squared radii of the smallest orthogonal spheres, each the nearest double, by row; of all cells, …
    pub(super) cells: Vec<f64>,
    /// … and of what is Gabriel among lower simplices.
    pub(super) facets: Vec<Radius>,
    pub(super) edges: Vec<Radius>,
    pub(super) vertices: Vec<Radius>,
}

/// The double nearest to the squared radius of the smallest orthogonal sphere of a simplex, if that is
/// empty; otherwise no number.
#[derive(Clone, Copy)]
pub(super) struct Radius(f64);

impl Radius {
    fn of(nearest: Option<f64>) -> Self {
        Self(nearest.unwrap_or(f64::NAN))
    }

    pub(super) fn known(self) -> Option<f64> {
        (!self.0.is_nan()).then_some(self.0)
    }
}

impl Filtration {
    /// Triangulates points and computes when each simplex enters. Takes a little less than twice the time of one shape
    /// of the whole triangulation; expected O(n log n).
    ///
    /// Points in one plane, on one line or at one place have the filtration that they have there: there are no
    /// cells, triangles (edges, the vertex) enter by their own spheres, and none is ever interior.
    ///
    /// # Errors
    /// As [`alpha_shape`](crate::alpha_shape()).
    pub fn new(points: WeightedPoints) -> Result<Self, ShapeError> {
        Self::on(None, points)
    }

    /// Like [`Self::new`], for points of a torus if one is given: shapes are then those of
    /// [`ShapeOptions::periodic`].
    ///
    /// # Errors
    /// As [`alpha_shape`](crate::alpha_shape()) at α = ∞; so no edge of the whole triangulation may span half of the box.
    pub fn on(torus: Option<Torus>, points: WeightedPoints) -> Result<Self, ShapeError> {
        Self::monitored(torus, points, &Monitor::noop())
    }

    /// The same, which reports its progress and can be cancelled.
    ///
    /// # Errors
    /// Those of [`on`](Self::on), and [`ShapeError::Cancelled`].
    pub fn monitored(
        torus: Option<Torus>,
        points: WeightedPoints,
        monitor: &Monitor,
    ) -> Result<Self, ShapeError> {
        let options = ShapeOptions {
            engine: Engine::Native,
            exterior: true,
            periodic: torus,
            ..ShapeOptions::new(Alpha::INFINITE)
        };
        let whole = alpha_shape_monitored(points, &options, &monitor.part(0, 4, 8))?;
        let complex = whole.complex();
        memory::afford(Self::bytes(complex), || {
            format!("the filtration of {} cells", complex.cells.len())
        })?;
        let rest = monitor.part(4, 8, 8);
        let done = |parts| rest.report(parts, 4);
        let WeightedPoints { positions, weights, .. } = whole.points();
        let spheres = Predicates::on_torus(positions, weights, torus);
        let (incidence, cells) = rayon::join(
            || Incidence::of(complex, positions.len()),
            || complex.cells.rows().par_iter().map(|&cell| spheres.nearest_radius(cell)).collect(),
        );
        done(2)?;
        let facets = gabriel_facets(complex, &incidence, &spheres);
        done(3)?;
        let edges = gabriel_edges(complex, &incidence, &spheres);
        let vertices = gabriel_vertices(complex, &incidence, &spheres);
        done(4)?;
        Ok(Self { whole, incidence, cells, facets, edges, vertices })
    }

    /// Bytes of a filtration of these simplices, besides them and without levels.
    fn bytes(whole: &Complex) -> usize {
        let radius = size_of::<Radius>();
        let cell = radius + size_of::<[u32; 4]>();
        let facet = radius + 2 * size_of::<[u32; 3]>() + size_of::<[u32; 2]>();
        cell * whole.cells.len()
            + facet * whole.facets.len()
            + radius * (whole.edges.len() + whole.vertices.len())
    }

    /// The points and their frozen weights.
    pub fn points(&self) -> &WeightedPoints {
        self.whole.points()
    }

    /// The periodic box, if there is one.
    pub fn torus(&self) -> Option<Torus> {
        self.whole.options().periodic
    }

    /// The shape at α = ∞: all simplices of the triangulation.
    pub fn whole(&self) -> &AlphaShape {
        &self.whole
    }

    /// The shape at α, equal to that of [`alpha_shape`](crate::alpha_shape()). O(n log n).
    pub fn shape(&self, alpha: Alpha) -> AlphaShape {
        let levels = self.levels(&[alpha]);
        let [betti] = levels.betti()[..] else { unreachable!("one level") };
        levels.shape(0, false, betti)
    }

    pub(super) fn spheres(&self) -> Predicates<'_> {
        let WeightedPoints { positions, weights, .. } = self.points();
        Predicates::on_torus(positions, weights, self.torus())
    }
}

fn gabriel_facets(whole: &Complex, incidence: &Incidence, spheres: &Predicates<'_>) -> Vec<Radius> {
    let facets = incidence.facets.par_iter().zip(&incidence.facet_cells);
    // In a regular triangulation, a smallest orthogonal sphere of a facet that contains any point contains one of the
    // two vertices opposite the facet.
    let radius = |(&facet, sides): (&[u32; 3], &[u32; 2])| {
        let held = sides.iter().filter(|&&cell| cell != Incidence::OUTSIDE).any(|&cell| {
            let cell = whole.cells.rows()[cell as usize];
            let apex = cell.into_iter().find(|v| !facet.contains(v)).expect("a fourth corner");
            spheres.inside(facet, apex)
        });
        Radius::of((!held).then(|| spheres.nearest_radius(facet)))
    };
    facets.map(radius).collect()
}

fn gabriel_edges(whole: &Complex, incidence: &Incidence, spheres: &Predicates<'_>) -> Vec<Radius> {
    let held = flags(whole.edges.len());
    incidence.facets.par_iter().zip(&incidence.facet_edges).for_each(|(facet, edges)| {
        for (&apex, &edge) in facet.iter().zip(edges) {
            let row = whole.edges.rows()[edge as usize];
            raise(&held[edge as usize], || spheres.inside(row, apex));
        }
    });
    radii(whole.edges.rows(), &held, spheres)
}

fn gabriel_vertices(
    whole: &Complex,
    incidence: &Incidence,
    spheres: &Predicates<'_>,
) -> Vec<Radius> {
    let held = flags(whole.vertices.len());
    whole.edges.rows().par_iter().for_each(|&[a, b]| {
        for (v, neighbour) in [(a, b), (b, a)] {
            let row = incidence.vertex_rows[v as usize];
            raise(&held[row as usize], || spheres.inside([v], neighbour));
        }
    });
    radii(whole.vertices.rows(), &held, spheres)
}

/// Flags only ever go up, so their final state does not depend on the order of threads.
fn flags(count: usize) -> Vec<AtomicBool> {
    (0..count).map(|_| AtomicBool::new(false)).collect()
}

fn raise(flag: &AtomicBool, wanted: impl FnOnce() -> bool) {
    if !flag.load(Ordering::Relaxed) && wanted() {
        flag.store(true, Ordering::Relaxed);
    }
}

fn radii<const N: usize>(
    rows: &[[u32; N]],
    held: &[AtomicBool],
    spheres: &Predicates<'_>,
) -> Vec<Radius> {
    let radius = |(&row, held): (&[u32; N], &AtomicBool)| {
        Radius::of((!held.load(Ordering::Relaxed)).then(|| spheres.nearest_radius(row)))
    };
    rows.par_iter().zip(held).map(radius).collect()
}
