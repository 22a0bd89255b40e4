//! The simplices that a block owns, classified from its triangulation.
//!
//! 1. [`cells`]: which cells are inside, then the class of each facet, by its two cells or, where both are
//!    outside, by its own sphere.
//! 2. [`sheets`]: while facets are classified, the corners of exterior cells are united into sheets.
//! 3. [`around`]: one pass over the star of each of the block's points gives edges, the point's class, and the
//!    rows of the simplices whose smallest vertex it is.

mod around;
mod cells;
mod local;
mod rows;
mod sheets;
mod state;

use walpha_base::UnionFind;
use walpha_regular::{Predicates, Triangulation};

use super::block::{Block, Question};
use around::{Stars, Walker};
use local::Local;
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

/// Each point that is not the representative of its component, with that, by input index.
fn component_pairs(components: &mut UnionFind, input: &[u32]) -> Vec<[u32; 2]> {
    let pair = |v: u32| {
        let root = components.find(v);
        (root != v).then(|| [input[v as usize], input[root as usize]])
    };
    (0..input.len() as u32).filter_map(pair).collect()
}
