use std::cmp::Ordering;

use walpha_base::parallel::in_pool;
use walpha_base::{Monitor, memory};
use walpha_regular::Torus;
use walpha_regular::internals::Predicates;

use super::build::{Incidence, Radii, Radius};
use super::whole;
use crate::along::Along;
use crate::make::in_large_box;
use crate::winding::{Winding, WindingSets};
use crate::{
    Alpha, AlphaShape, Complex, Engine, ShapeError, ShapeOptions, WeightedPoints, between,
};

/// All alpha shapes of a set of points: the regular triangulation, and for each simplex the α at which it enters.
///
/// Weights are the same for every α; with weights that depend on α, shapes would not be nested. A simplex enters at the squared
/// radius of its smallest orthogonal sphere if no point lies strictly inside (it is *Gabriel*), otherwise with the first simplex
/// of which it is a face (Edelsbrunner and Mücke 1994, doi:10.1145/174462.156635; CGAL's `Alpha_shape_3` keeps the same
/// intervals, in rounded numbers). Here a radius is the nearest double, and if an α is equally near to the exact number, exact
/// arithmetic decides: a shape taken from a filtration equals that of [`alpha_shape`](crate::alpha_shape()).
#[derive(Debug)]
pub struct Filtration {
    pub(super) whole: AlphaShape,
    pub(super) incidence: Incidence,
    pub(super) radii: Radii,
}

impl Filtration {
    /// Triangulates points and computes when each simplex enters. Takes about twice the time of one shape of the whole
    /// triangulation; expected O(n log n). Borrowed points are copied, as for a shape.
    ///
    /// Points in one plane, on one line or at one place have the filtration that they have there: there are no
    /// cells, triangles (edges, the vertex) enter by their own spheres, and none is ever interior.
    ///
    /// # Errors
    /// See [`alpha_shape`](crate::alpha_shape()).
    pub fn new(points: impl Into<WeightedPoints>) -> Result<Self, ShapeError> {
        Self::on(None, points)
    }

    /// Like [`Self::new`], for points of a torus if one is given: shapes are then those of
    /// [`ShapeOptions::periodic`].
    ///
    /// # Errors
    /// See [`alpha_shape`](crate::alpha_shape()), at α = ∞.
    pub fn on(torus: Option<Torus>, points: impl Into<WeightedPoints>) -> Result<Self, ShapeError> {
        let points = points.into();
        let (count, monitor) = (points.len(), &*Monitor::current());
        let find = || {
            let Some(torus) = torus else { return Self::of_large_box(None, points) };
            // Points are few where edges are long.
            match Self::of_large_box(Some(torus), points.clone()) {
                Err(ShapeError::Wraps { .. }) => Self::of_small_box(torus, points),
                found => found,
            }
        };
        in_pool(count, || monitor.watch(find))
    }

    /// The filtration in space, or in a box in which no edge spans half of a vector.
    pub(super) fn of_large_box(
        torus: Option<Torus>,
        points: WeightedPoints,
    ) -> Result<Self, ShapeError> {
        let monitor = &*Monitor::current();
        let options = ShapeOptions {
            engine: Engine::Native,
            exterior: true,
            periodic: torus,
            ..ShapeOptions::new(Alpha::INFINITE)
        };
        let (whole, listed) = match torus {
            None => whole::in_space(points, &options, &monitor.part(0, 4, 8))?,
            Some(_) => (in_large_box(points, &options, &monitor.part(0, 4, 8))?, None),
        };
        let complex = whole.complex();
        let rest = monitor.part(4, 8, 8);
        let WeightedPoints { positions, weights, .. } = whole.points();
        let spheres = Predicates::on_torus(positions, weights, whole.options().periodic);
        let (incidence, along) = if let Some(listed) = listed {
            listed
        } else {
            let Complex { cells, facets, edges, vertices } = complex;
            let bytes = Self::bytes([cells.len(), facets.len(), edges.len(), vertices.len()]);
            memory::afford(bytes, || format!("the filtration of {} cells", cells.len()))?;
            let along = Along::new(complex, positions);
            (Incidence::new(complex, positions.len(), &along), along)
        };
        rest.report(1, 4)?;
        let done = |passes| rest.report(1 + passes, 4);
        let radii = Radii::new(complex, &incidence, &along, &spheres, done)?;
        Ok(Self { whole, incidence, radii })
    }

    /// The way from a facet to the corner of a cell, by row, that is opposite; `None` if there is no cell.
    fn apex_of(&self, cell: u32, facet: usize) -> Option<[f64; 3]> {
        let facets = self.incidence.cell_facets.get(cell as usize)?;
        let apex = facets.iter().position(|&of| of as usize == facet)?;
        let corners = self.whole.corners(self.whole.complex().cells.rows()[cell as usize]);
        let [to, from] = [apex, (apex + 1) % 4].map(|at| corners[at]);
        Some([0, 1, 2].map(|axis| to[axis] - from[axis]))
    }

    /// The bytes of a filtration of so many cells, facets, edges and vertices, without the simplices and levels.
    pub(super) fn bytes(counts: [usize; 4]) -> usize {
        let radius = size_of::<Radius>();
        let cell = radius + size_of::<[u32; 4]>();
        let facet = radius + 2 * size_of::<[u32; 3]>() + size_of::<[u32; 2]>();
        let bytes = counts.into_iter().zip([cell, facet, radius, radius]);
        bytes.map(|(count, of_each)| of_each.saturating_mul(count)).fold(0, usize::saturating_add)
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
        self.shape_with(alpha, false)
    }

    /// The shape at α, with exterior simplices if they are wanted.
    pub(crate) fn shape_with(&self, alpha: Alpha, exterior: bool) -> AlphaShape {
        let levels = self.levels(&[alpha]);
        let [betti] = levels.betti()[..] else { unreachable!("one level") };
        levels.shape(0, exterior, betti)
    }

    pub(super) fn spheres(&self) -> Predicates<'_> {
        let WeightedPoints { positions, weights, .. } = self.points();
        Predicates::on_torus(positions, weights, self.whole.nearest())
    }

    /// The sets of a union-find over cells on a torus, and over what is [outside](WindingSets::with_outside), whose number follows that of the
    /// last cell.
    pub(super) fn complement_sets(&self, torus: Torus) -> WindingSets {
        WindingSets::with_outside(self.whole.complex().cells.len(), torus)
    }

    /// What is on both sides of a facet: the rows of cells, and the number that follows that of the last cell for what is outside.
    pub(super) fn sides(&self, facet: usize) -> [u32; 2] {
        let outside = self.whole.complex().cells.len() as u32;
        let sides = self.incidence.facet_cells[facet];
        sides.map(|side| if side == Incidence::OUTSIDE { outside } else { side })
    }

    /// The multiples of the vectors by which what is on the second side of a facet of a torus is to be moved so that the facet coincides in both.
    /// What is outside of a slab, below and above, is one: below is what is above, moved down by one of the vectors of a torus in which the slab
    /// would lie.
    pub(super) fn way_across(&self, torus: Torus, facet: usize) -> Winding {
        let out = torus.repeats().iter().position(|repeats| !repeats);
        if let (Some(out), [side, Incidence::OUTSIDE]) = (out, self.incidence.facet_cells[facet]) {
            let mut way = [0; 3];
            if torus.dimension() == 2 {
                way[out] = match self.apex_of(side, facet) {
                    None => 1,
                    Some(apex) => -i32::from(torus.across(apex) == Some(Ordering::Greater)),
                };
            }
            return way;
        }
        if let Some(&way) = self.incidence.ways.get(facet) {
            return way;
        }
        let rows = self.whole.complex().cells.rows();
        let cells = self.incidence.facet_cells[facet].map(|cell| rows[cell as usize]);
        let vertex = self.incidence.facets[facet][0];
        between(torus, cells, vertex, self.points().positions())
    }
}

/// Two maximal simplices with a common face of one dimension less. Maximal simplices are cells or, where points span no volume,
/// triangles, edges, or one vertex.
type AdjacentPair = [u32; 2];

impl Filtration {
    /// The dimension of the affine hull of the points.
    pub(super) fn dimension(&self) -> usize {
        let complex = self.whole.complex();
        let counts = [complex.edges.len(), complex.facets.len(), complex.cells.len()];
        counts.iter().rposition(|&count| count > 0).map_or(0, |below| below + 1)
    }

    /// The vertices of a maximal simplex.
    pub(super) fn maximal_simplex(&self, row: usize) -> &[u32] {
        let complex = self.whole.complex();
        match self.dimension() {
            3 => &complex.cells.rows()[row],
            2 => &self.incidence.facets[row],
            1 => &complex.edges.rows()[row],
            _ => &complex.vertices.rows()[row],
        }
    }

    /// All pairs of maximal simplices with a common face of one dimension less. O(n).
    pub(super) fn adjacent_pairs(&self) -> Vec<AdjacentPair> {
        let complex = self.whole.complex();
        let incidence = &self.incidence;
        let mut sides = match self.dimension() {
            3 => incidence.facet_cells.clone(),
            2 => cofaces(complex.edges.len(), incidence.facet_edges.iter().map(|edges| &edges[..])),
            1 => {
                let ends: Vec<[u32; 2]> = (complex.edges.rows().iter())
                    .map(|edge| edge.map(|v| incidence.vertex_rows[v as usize]))
                    .collect();
                cofaces(complex.vertices.len(), ends.iter().map(|ends| &ends[..]))
            }
            _ => Vec::new(),
        };
        sides.retain(|sides| sides[1] != Incidence::OUTSIDE);
        sides
    }
}

/// The two cofaces of each face, by row; [`Incidence::OUTSIDE`] for missing ones.
fn cofaces<'a>(faces: usize, of: impl Iterator<Item = &'a [u32]>) -> Vec<AdjacentPair> {
    let mut sides = vec![[Incidence::OUTSIDE; 2]; faces];
    for (row, its) in (0..).zip(of) {
        for &face in its {
            let [first, second] = &mut sides[face as usize];
            *(if *first == Incidence::OUTSIDE { first } else { second }) = row;
        }
    }
    sides
}
