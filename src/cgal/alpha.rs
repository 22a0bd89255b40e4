//! `Alpha_shape_3`: all alpha shapes of a set of points.

use std::fmt;
use std::num::NonZeroUsize;

use walpha_complex::canonical::sorted;
use walpha_regular::internals::Sites;
use walpha_shape::{Alpha, Complex};

use super::shape::{RawComplex, canonical};
use super::{Error, or_zeros, spanning, thrown};

/// The entry points of `cpp/alpha.cc`.
#[allow(unused_qualifications, reason = "in what the macro writes")]
#[cxx::bridge(namespace = "walpha")]
mod bridge {
    unsafe extern "C++" {
        include!("walpha/cpp/bridge.h");
        include!("walpha/cpp/alpha.h");

        /// A complex classified at one α.
        type Complex = crate::cgal::ffi::bridge::Complex;
        /// The alpha shapes for all α.
        type AlphaShape;

        fn dimension(self: &AlphaShape) -> i32;
        fn values(self: &AlphaShape) -> &[f64];
        fn cells(self: &AlphaShape) -> &[u32];
        fn cell_ranks(self: &AlphaShape) -> &[u32];
        fn facets(self: &AlphaShape) -> &[u32];
        fn facet_ranks(self: &AlphaShape) -> &[u32];
        fn edges(self: &AlphaShape) -> &[u32];
        fn edge_ranks(self: &AlphaShape) -> &[u32];
        fn vertices(self: &AlphaShape) -> &[u32];
        fn vertex_ranks(self: &AlphaShape) -> &[u32];

        fn find_optimal_alpha(self: &AlphaShape, components: usize) -> Result<u32>;
        fn solid_components(self: &AlphaShape, alpha: f64) -> Result<usize>;
        fn solid_components_of(self: &AlphaShape, rank: u32) -> Result<usize>;
        fn classify(self: &AlphaShape, alpha: f64) -> Result<UniquePtr<Complex>>;

        fn alpha_shape(
            positions: &[f64],
            weights: &[f64],
            regularized: bool,
        ) -> Result<UniquePtr<AlphaShape>>;
    }
}

/// The kind of shapes that [`AlphaShape3`] contains: CGAL's modes of the same names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The alpha complex: it may contain facets, edges and vertices that are not faces of a cell of the shape, singular or
    /// regular.
    General,
    /// Only cells and their faces.
    Regularized,
}

/// A value of α at which the class of a simplex changes. CGAL represents it as an exact number; values are ordered by `rank`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Critical {
    /// The rank among all distinct values of the shape, in exact order, from 0: the index in [`AlphaShape3::values`].
    pub rank: u32,
    /// The nearest double, or the even one of two equally near ones; a squared length, ±∞ beyond the range of doubles. Different
    /// values may have the same nearest double.
    pub nearest: f64,
}

/// The values of α at which the class of a facet, an edge or a vertex changes: CGAL's `Alpha_status`.
///
/// At α, the simplex is exterior below the first existing value, singular from `min` on, regular from `mid` on, and interior from
/// `max` on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Span {
    /// CGAL's `alpha_min`: the squared radius of the smallest orthogonal sphere of the simplex, if no point lies inside it (the
    /// simplex is *Gabriel*). `None` if a point does, and in [`Mode::Regularized`]: the simplex is never singular.
    pub min: Option<Critical>,
    /// CGAL's `alpha_mid`: from here on the simplex is a face of another one of the shape.
    pub mid: Critical,
    /// CGAL's `alpha_max`: from here on all cells around the simplex are in the shape. `None` on the convex hull (`is_on_chull`):
    /// the simplex is never interior.
    pub max: Option<Critical>,
}

/// Simplices of one dimension and their spans, index for index.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Intervals<const N: usize> {
    /// Indices of points, ascending; rows are in lexicographic order.
    pub rows: Vec<[u32; N]>,
    /// For each row, the values at which its class changes.
    pub spans: Vec<Span>,
}

/// CGAL's `Alpha_shape_3` of weighted points, with exact comparisons (`Tag_true`): all alpha shapes of the points, given by the
/// values of α at which classes change.
///
/// Points are named by their indices. Weights and α are squared lengths. CGAL's numbers contain caches, so a shape must stay on
/// one thread.
///
/// Expected O(n log n) for points of even density, with exact fractions for each value: 1.3 ms and 20 kB a point for random
/// points, 0.1 ms and 15 kB for a grid, which has few values. [`Filtration`](walpha_shape::ladder::Filtration) computes the same
/// values in a hundredth of the time, or a tenth on a grid.
///
/// ```
/// use std::num::NonZeroUsize;
/// use walpha::cgal::{AlphaShape3, Mode};
/// use walpha::{Alpha, Class};
///
/// let points = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [1.0, 1.0, 4.0], [1.0, 1.0, -4.0]];
/// let shapes = AlphaShape3::new(&points, None, Mode::General)?;
/// assert_eq!(shapes.cells().0.len(), 2);
/// // Each vertex is there from α = 0 on, and on the hull.
/// assert!(shapes.vertices().spans.iter().all(|span| span.min.is_some_and(|min| min.nearest == 0.0)));
/// assert!(shapes.vertices().spans.iter().all(|span| span.max.is_none()));
///
/// // Both cells have spheres of one size: from there on they are one solid.
/// let solid = shapes.find_optimal_alpha(NonZeroUsize::MIN)?;
/// assert_eq!(solid, shapes.cells().1[0]);
/// assert_eq!(solid.nearest, 6.75);
/// assert_eq!(shapes.number_of_solid_components(Alpha::from_squared(solid.nearest)?)?, 1);
/// assert_eq!(shapes.complex(Alpha::ZERO)?.vertices.counts()[Class::Singular], 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct AlphaShape3 {
    made: cxx::UniquePtr<bridge::AlphaShape>,
    mode: Mode,
    input: Vec<u32>,
    cells: (Vec<[u32; 4]>, Vec<Critical>),
    facets: Intervals<3>,
    edges: Intervals<2>,
    vertices: Intervals<1>,
}

impl fmt::Debug for AlphaShape3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mode, cells, facets, edges, vertices, .. } = self;
        let mut shown = f.debug_struct("AlphaShape3");
        shown.field("mode", mode).field("cells", cells).field("facets", facets);
        shown.field("edges", edges).field("vertices", vertices).finish_non_exhaustive()
    }
}

impl AlphaShape3 {
    /// Triangulates points, and finds the values of α at which the class of each simplex changes.
    ///
    /// # Errors
    /// [`Error::Sites`]: the numbers of weights and points differ; a number is not finite or is too large; there are fewer than
    /// four distinct points; all points lie in one plane. [`Error::Cgal`]: out of memory, or a bug in the program.
    pub fn new(positions: &[[f64; 3]], weights: Option<&[f64]>, mode: Mode) -> Result<Self, Error> {
        let weights = or_zeros(weights, positions.len());
        let sites = Sites::new(positions, &weights)?;
        let (positions, weights) = (sites.positions().as_flattened(), sites.weights());
        let made = bridge::alpha_shape(positions, weights, mode == Mode::Regularized)
            .map_err(thrown(STAGE))?;
        spanning(&sites, made.dimension())?;
        let input = sites.input();
        let critical = |rank: u32| Critical { rank, nearest: made.values()[rank as usize] };
        let mut cells: Vec<_> = (made.cells().as_chunks().0.iter().zip(made.cell_ranks()))
            .map(|(&row, &rank)| (named(row, input), critical(rank)))
            .collect();
        cells.sort_unstable_by_key(|cell| cell.0);
        Ok(Self {
            mode,
            cells: cells.into_iter().unzip(),
            facets: intervals(made.facets(), made.facet_ranks(), input, critical),
            edges: intervals(made.edges(), made.edge_ranks(), input, critical),
            vertices: intervals(made.vertices(), made.vertex_ranks(), input, critical),
            input: sites.input().to_vec(),
            made,
        })
    }

    /// Returns whether the shapes are general or regularized.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The distinct values of α at which classes change, by rank: ascending as exact numbers, of which these are the nearest
    /// doubles. In [`Mode::Regularized`] only those of cells. This is CGAL's spectrum.
    pub fn values(&self) -> &[f64] {
        self.made.values()
    }

    /// The cells, as ascending indices of points, in lexicographic order; and for each cell the α from which on it is interior.
    /// It is exterior before.
    pub fn cells(&self) -> (&[[u32; 4]], &[Critical]) {
        (&self.cells.0, &self.cells.1)
    }

    /// The facets and their spans.
    pub fn facets(&self) -> &Intervals<3> {
        &self.facets
    }

    /// The edges and their spans.
    pub fn edges(&self) -> &Intervals<2> {
        &self.edges
    }

    /// The vertices and their spans, without hidden points and duplicates.
    pub fn vertices(&self) -> &Intervals<1> {
        &self.vertices
    }

    /// CGAL's `find_optimal_alpha`: an α at which all vertices are in cells of the shape, and the cells form at most `components`
    /// solid components.
    ///
    /// CGAL bisects the values, but the number of components is not monotonic: the α found may not be the least with this
    /// property, and the property may be lost again above it.
    /// [`Filtration::optimal_alpha`](walpha_shape::ladder::Filtration::optimal_alpha) is the least. O(n log n).
    ///
    /// # Errors
    /// [`Error::Cgal`]: out of memory, or a bug in the program.
    pub fn find_optimal_alpha(&self, components: NonZeroUsize) -> Result<Critical, Error> {
        let rank = self.made.find_optimal_alpha(components.get()).map_err(thrown(STAGE))?;
        Ok(self.critical(rank))
    }

    /// CGAL's `number_of_solid_components` at α, which is compared exactly: the components of the cells in the shape, connected
    /// by common facets. O(n).
    ///
    /// # Errors
    /// [`Error::Cgal`]: out of memory, or a bug in the program.
    pub fn number_of_solid_components(&self, alpha: Alpha) -> Result<usize, Error> {
        Ok(self.made.solid_components(alpha.squared()).map_err(thrown(STAGE))?)
    }

    /// Like [`Self::number_of_solid_components`], at one of the [`values`](Self::values), given by its rank: at the exact number,
    /// from which the nearest double may differ.
    ///
    /// # Errors
    /// [`Error::Cgal`]: out of memory, or a bug in the program.
    ///
    /// # Panics
    /// There is no value of this rank.
    pub fn number_of_solid_components_at(&self, rank: u32) -> Result<usize, Error> {
        assert!((rank as usize) < self.values().len(), "no value has the rank {rank}");
        Ok(self.made.solid_components_of(rank).map_err(thrown(STAGE))?)
    }

    /// The class that CGAL gives each simplex at α, which is compared exactly; like
    /// [`fixed_alpha_shape`](super::fixed_alpha_shape), including exterior simplices. O(n log n).
    ///
    /// # Errors
    /// [`Error::Cgal`]: out of memory, or a bug in the program.
    pub fn complex(&self, alpha: Alpha) -> Result<Complex, Error> {
        let found = self.made.classify(alpha.squared()).map_err(thrown(STAGE))?;
        Ok(canonical(&RawComplex(found), &self.input))
    }

    fn critical(&self, rank: u32) -> Critical {
        Critical { rank, nearest: self.values()[rank as usize] }
    }
}

/// The name of the stage in errors.
const STAGE: &str = "alpha shape";

/// The value that C++ lends for a rank that does not exist.
const NONE: u32 = u32::MAX;

fn named<const N: usize>(row: [u32; N], input: &[u32]) -> [u32; N] {
    sorted(row.map(|site| input[site as usize]))
}

/// The rows and their spans, in order.
fn intervals<const N: usize>(
    rows: &[u32],
    ranks: &[u32],
    input: &[u32],
    critical: impl Fn(u32) -> Critical,
) -> Intervals<N> {
    let some = |rank: u32| (rank != NONE).then(|| critical(rank));
    let span =
        |&[min, mid, max]: &[u32; 3]| Span { min: some(min), mid: critical(mid), max: some(max) };
    let rows = rows.as_chunks().0.iter().map(|&row| named(row, input));
    let mut rows: Vec<_> = rows.zip(ranks.as_chunks().0.iter().map(span)).collect();
    rows.sort_unstable_by_key(|row| row.0);
    let (rows, spans) = rows.into_iter().unzip();
    Intervals { rows, spans }
}
