//! The simplices that a block owns, classified from its triangulation.
//!
//! 1. [`cells`]: which cells are inside, then the class of each facet, by its two cells or, where both are
//!    outside, by its own sphere.
//! 2. [`sheets`]: while facets are classified, the corners of exterior cells are united into sheets.
//! 3. [`around`]: one pass over the star of each of the block's points gives edges, the point's class, and the
//!    rows of the simplices whose smallest vertex it is.

mod around;
mod cells;
mod rows;
mod sheets;

use walpha_base::UnionFind;
use walpha_regular::{Predicates, Triangulation};

use super::{Block, Question};
use around::{Stars, Walker};
use cells::{Boundary, State};
pub use rows::Side;
pub(super) use rows::{Bucket, Buckets, Dimension, Long, Owned, Rows, Starts};
use sheets::Sheets;

/// Classifies the simplices whose smallest vertex is the block's own. O(cells).
pub(super) fn classify(
    block: &Block,
    mesh: Triangulation,
    question: &Question,
    buckets: Buckets,
) -> Owned {
    let (cells, neighbors, ghost) = mesh.into_parts();
    let local = Local {
        block,
        cells: &cells,
        ghost,
        predicates: Predicates::on(question.lattice, &block.positions, &block.weights),
        alpha: question.alpha,
        exterior: question.exterior,
    };
    let mut states = local.classify_cells();
    let mut sheets = Sheets::new(&states);
    let mut owned = Owned::default();
    let boundary = local.classify_facets(&neighbors, &mut states, &mut sheets, &mut owned);
    drop(neighbors);
    owned.reserve(&states, block.own as usize);
    let stars = Stars::new(&cells, block.own, &states);
    let mut walker = Walker::new(&local, &states, &stars, &boundary, &mut sheets, &mut owned);
    (0..block.own).for_each(|v| walker.visit(v));
    let mut components = walker.finish();
    owned.components = component_pairs(&mut components, &block.input);
    sheets.number(&mut owned);
    drop((cells, states, stars));
    owned.fill_buckets(buckets, &block.input[..block.own as usize]);
    owned
}

/// A block with its triangulation and the parameters of the shape. Vertices are numbers of the block's points.
struct Local<'a> {
    block: &'a Block,
    cells: &'a [[u32; 4]],
    ghost: u32,
    predicates: Predicates<'a>,
    alpha: f64,
    exterior: bool,
}

impl Local<'_> {
    /// Whether a vertex is one of the block's own points; the ghost is nobody's.
    #[inline(always)]
    fn owned(&self, v: u32) -> bool {
        v < self.block.own
    }

    /// The input index of a point, which orders the vertices of simplices.
    #[inline(always)]
    fn input(&self, v: u32) -> u32 {
        self.block.input[v as usize]
    }

    /// Whether the smallest orthogonal sphere has a squared radius of at most α. Exact.
    fn fits<const N: usize>(&self, simplex: [u32; N]) -> bool {
        self.alpha == f64::INFINITY || self.predicates.fits(simplex, self.alpha)
    }
}

impl Local<'_> {
    /// Whether an edge spans half of the box of a torus or more, along one axis at least. Exact.
    fn is_long(&self, [v, u]: [u32; 2]) -> bool {
        self.block.copies.as_ref().is_some_and(|copies| {
            let [p, q] = [v, u].map(|v| self.block.positions[v as usize]);
            (0..3).any(|k| 2.0 * (p[k] - q[k]).abs() >= copies.torus.sides()[k])
        })
    }
}

/// Each point that is not the representative of its component, with that, by input index.
fn component_pairs(components: &mut UnionFind, input: &[u32]) -> Vec<[u32; 2]> {
    let pair = |v: u32| {
        let root = components.find(v);
        (root != v).then(|| [input[v as usize], input[root as usize]])
    };
    (0..input.len() as u32).filter_map(pair).collect()
}

/// Whether the permutation of 0..4 that starts with a, b, c is even.
#[inline(always)]
fn even(a: usize, b: usize, c: usize) -> bool {
    let d = 6 - a - b - c;
    let inversions = u8::from(a > b)
        + u8::from(a > c)
        + u8::from(a > d)
        + u8::from(b > c)
        + u8::from(b > d)
        + u8::from(c > d);
    inversions % 2 == 0
}
