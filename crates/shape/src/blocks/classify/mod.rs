//! The simplices that a block owns, classified from its triangulation, on all threads: the cells in chunks, then the
//! points in ranges along the curve.
//!
//! 1. [`cells`]: which cells are inside, then the class of each facet, by its two cells or, where both are
//!    outside, by its own sphere.
//! 2. [`sheets`]: while facets are classified, the corners of exterior cells are united into sheets.
//! 3. [`stars`]: the cells around the points of each range.
//! 4. [`around`]: one pass over the star of each of the block's points gives edges, the point's class, and the
//!    rows of the simplices whose smallest vertex it is, which are recorded by point ([`records`]).

mod around;
mod cells;
mod local;
mod records;
mod sheets;
mod stars;
mod state;

use std::sync::Mutex;

use walpha_base::monitor::Units;
use walpha_base::parallel::prelude::*;
use walpha_base::{Cancelled, UnionFind};
use walpha_regular::internals::{CellArrays, Predicates};

use super::block::{Block, BlockParams, TRIANGULATION, WORK};
use around::{Walker, Worker};
use local::Local;
pub(crate) use records::Long;
pub use records::Side;
pub(super) use records::{Buckets, Classes, Owned, PointRows, Records};
use sheets::Sheets;
pub(super) use stars::RANGE;
use stars::Stars;

/// Cells that one thread classifies at a time.
const CELLS: usize = 1 << 10;

/// Classifies the simplices whose smallest vertex is the block's own. O(cells). Reports progress for own points.
///
/// # Errors
/// Cancelled.
pub(super) fn classify(
    block: &Block,
    mesh: CellArrays,
    params: &BlockParams,
    buckets: Buckets,
    work: &Units<'_>,
) -> Result<Owned, Cancelled> {
    let (cells, neighbors, at_infinity) = mesh.into_parts();
    let local = Local {
        block,
        cells: &cells,
        at_infinity,
        predicates: Predicates::on(params.lattice, &block.positions, &block.weights),
        alpha: params.alpha,
        exterior: params.exterior,
    };
    let kinds = local.classify_cells();
    let sheets = Sheets::new(&kinds);
    let (states, boundary, mut shared) = local.classify_facets(&neighbors, kinds, &sheets);
    drop(neighbors);
    let stars = Stars::new(&cells, block.own, &states);
    let components = UnionFind::new(block.input.len());
    let walker = Walker {
        local: &local,
        states: &states,
        boundary: &boundary,
        sheets: &sheets,
        components: &components,
        buckets,
    };
    // Idle workers. There are as many workers as threads at work.
    let idle: Mutex<Vec<Worker>> = Mutex::default();
    let lock = || idle.lock().expect("no thread panics while it holds the lock");
    let walked = (0..stars.ranges()).into_par_iter().map(|range| {
        let mut worker = lock().pop().unwrap_or_else(|| Worker::new(block.input.len(), buckets));
        let walked = walker.walk(&stars, range, &mut worker);
        lock().push(worker);
        work.add((WORK - TRIANGULATION) * walked.points() as u64)?;
        Ok(walked)
    });
    let walked: Vec<_> = walked.collect::<Result<_, Cancelled>>()?;
    drop((idle, stars, boundary));
    let mut owned = Owned { buckets: vec![Vec::new(); buckets.count], ..Owned::default() };
    for part in walked {
        for (bucket, records) in owned.buckets.iter_mut().zip(part.records) {
            bucket.push(records);
        }
        shared.extend(part.shared);
        owned.border.extend(part.border);
        owned.long = owned.long.into_iter().chain(part.long).min_by_key(|long| long.edge);
    }
    owned.shared = shared;
    owned.components = component_pairs(&components, &block.input);
    sheets.number(&mut owned);
    Ok(owned)
}

/// Each point that is not the representative of its component, with the representative, by input index.
fn component_pairs(components: &UnionFind, input: &[u32]) -> Vec<[u32; 2]> {
    let pair = |v: u32| {
        let root = components.find(v);
        (root != v).then(|| [input[v as usize], input[root as usize]])
    };
    (0..input.len() as u32).into_par_iter().coarse().filter_map(pair).collect()
}
