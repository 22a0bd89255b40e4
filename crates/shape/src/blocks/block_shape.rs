//! A single block: the simplices that it owns of a shape whose other blocks are computed elsewhere.

use walpha_base::parallel::prelude::*;
use walpha_base::{Monitor, UnionFind};
use walpha_regular::internals::{Lattice, Sites};

use super::block::{Block, BlockParams};
use super::classify::{Buckets, Owned, RANGE, classify};
use super::gather::{Counts, Gathered, Location};
use super::partition::Neighbourhood;
use super::spanning::spanning;
use crate::{Complex, ShapeError};

/// The points of a block and those around it, in the order of their indices in the whole set.
#[derive(Clone, Copy, Debug)]
pub struct Own<'a> {
    /// Coordinates (x, y, z).
    pub positions: &'a [[f64; 3]],
    /// Power weights.
    pub weights: &'a [f64],
    /// Marks the points that are the block's own. The others are a superset of its halo.
    pub own: &'a [bool],
}

/// The simplices that a block owns, in canonical order, and the data for merging it with other blocks. Points are numbered by
/// their index among the given ones, sheets and components from 0 within the block.
#[derive(Debug, Default)]
pub struct BlockShape {
    /// The simplices that the block owns.
    pub complex: Complex,
    /// One sheet for each regular facet and two for each singular one, in the order of the facets.
    pub facet_sheets: Vec<u32>,
    /// The sheet of each singular edge, in the order of the edges.
    pub edge_sheets: Vec<u32>,
    /// Number of sheets.
    pub sheets: u32,
    /// Sides of facets, and singular edges, with vertices in this block and in others.
    pub shared: Vec<Side>,
    /// For each point the smallest point of its component, as far as this block's edges connect it.
    pub components: Vec<u32>,
    /// The ends of the edges between points of this block and of others, ascending.
    pub border: Vec<u32>,
    /// Number of points in the halo.
    pub halo: u64,
}

pub use super::classify::Side;

/// The largest number of auxiliary points: for points at one position.
const MAX_AUXILIARY: usize = 3;

/// Computes the simplices that a block owns of the α-complex, at `alpha` for power weights.
///
/// # Errors
/// Numbers that are not finite or too large; two points at one position; out of memory.
pub fn block_shape(points: Own<'_>, alpha: f64) -> Result<BlockShape, ShapeError> {
    let Own { positions, weights, own } = points;
    if !own.contains(&true) {
        return Ok(BlockShape::default());
    }
    let mut block = block(points, alpha)?;
    let halo = block.input.len() as u64 - u64::from(block.own);
    let largest = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // Below −max ω the shape is empty; this α is finite and below that.
    let alpha = alpha.max(-2.0 * largest.abs() - 1.0);
    let (monitor, next) = (Monitor::noop(), positions.len() as u32);
    let work = monitor.units(1);
    let made = spanning(&mut block, alpha, next, &work)?;
    let lattice = Lattice::of(&block.positions, &block.weights);
    let params = BlockParams { alpha, lattice, exterior: false };
    let owned = classify(&block, made, &params, Buckets::new(&[], 1), &work)?;
    Ok(BlockShape { halo, ..ordered(owned, &block, positions.len()) })
}

/// The block's own points, then its halo, each along the curve.
fn block(points: Own<'_>, alpha: f64) -> Result<Block, ShapeError> {
    let Own { positions, weights, own } = points;
    let at = |i: usize| (positions[i], weights[i]);
    let owned = (0..own.len()).filter(|&i| own[i]).map(at);
    let around = Neighbourhood::of(owned, alpha);
    let is_near =
        |&i: &u32| own[i as usize] || around.holds(positions[i as usize], weights[i as usize]);
    let near: Vec<u32> = (0..positions.len() as u32).filter(is_near).collect();
    let positions: Vec<_> = near.iter().map(|&i| positions[i as usize]).collect();
    let weights: Vec<_> = near.iter().map(|&i| weights[i as usize]).collect();
    let sites = Sites::any(&positions, &weights)?;
    if let Some(&[a, b]) = sites.duplicates().first() {
        let at = sites.positions()[b.min(a) as usize];
        return Err(ShapeError::Coincident { at });
    }
    let is_own = |&&site: &&u32| own[near[site as usize] as usize];
    let (owned, halo): (Vec<u32>, Vec<u32>) = sites.curve().iter().partition(is_own);
    let all = || owned.iter().chain(&halo).map(|&site| site as usize);
    Ok(Block {
        positions: all().map(|site| positions[site]).collect(),
        weights: all().map(|site| weights[site]).collect(),
        input: all().map(|site| near[site]).collect(),
        own: owned.len() as u32,
        copies: None,
    })
}

/// The rows in canonical order; `points` is the number of given points.
fn ordered(owned: Owned, block: &Block, points: usize) -> BlockShape {
    let mut order: Vec<u32> = (0..block.own).collect();
    order.par_sort_unstable_by_key(|&v| block.input[v as usize]);
    let input: Vec<u32> = order.iter().map(|&v| block.input[v as usize]).collect();
    let at = |&v: &u32| Location { records: v / RANGE as u32, point: v % RANGE as u32 };
    let locations: Vec<_> = order.iter().map(at).collect();
    let mut gathered = Gathered::new(Counts::of_all(owned.records(), false));
    gathered.rest().write(&owned.buckets[0], &locations, &input, false);
    // Auxiliary points are numbered after those given.
    let sets = UnionFind::new(points + MAX_AUXILIARY);
    owned.components.into_iter().for_each(|[a, b]| _ = sets.unite(a, b));
    let mut border = owned.border;
    border.sort_unstable();
    border.dedup();
    let (complex, facet_sheets, edge_sheets) = gathered.into_parts();
    BlockShape {
        complex,
        facet_sheets,
        edge_sheets,
        sheets: owned.sheets,
        shared: owned.shared,
        components: (0..points as u32).map(|i| sets.find(i)).collect(),
        border,
        halo: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Squared lengths may be negative; the shape is empty for an α below all weights.
    #[test]
    fn nothing_is_in_the_shape_below_all_weights() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for (alpha, weight, vertices) in [
            (f64::NEG_INFINITY, 0.0, 0),
            (f64::NEG_INFINITY, -3.0, 0),
            (-0.25, 0.0, 0),
            (-0.25, 0.25, 4),
            (3.0, -3.0, 4),
        ] {
            let points = Own { positions: &positions, weights: &[weight; 4], own: &[true; 4] };
            let found = block_shape(points, alpha).unwrap();
            assert_eq!(found.complex.vertices.len(), vertices, "{alpha} {weight}");
            assert!(found.complex.cells.is_empty());
        }
    }
}
