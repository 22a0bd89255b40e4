//! The triangulation of many points on all threads, by dividing and merging.
//!
//! Points along a Hilbert curve are divided into halves again and again, each by a plane, until they are few enough:
//! these leaves are triangulated side by side. Two halves are merged as follows.
//!
//! 1. A cell of one half is *open* if a point of the other may be in conflict with it ([`open`]). The other cells,
//!    the closed ones, are cells of the whole.
//! 2. A vertex without an open cell keeps its star. So the other cells of the whole have corners of open cells only,
//!    and are among the cells of the triangulation of these corners, which is computed.
//! 3. Of its cells those are taken that fill what the closed cells leave free: they are found by flooding from the
//!    facets between closed and open cells ([`glue`]).
//!
//! This needs no general position: ties are broken by the positions of points alone, so a cell of the whole is one of
//! every subset that has its corners. Hidden points of a half are hidden in the whole.

mod glue;
mod numbering;
mod open;
mod slots;

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use walpha_base::Cancelled;

use crate::incremental::{Built, insert_cells};
use crate::order::Curve;
use crate::{Triangulation, TriangulationError};
use open::Extent;
use slots::Mesh;

/// With fewer points than this in all, one thread is as fast.
const MIN_POINTS: usize = 1 << 16;
/// Number of leaves per thread, about: small ones fit the cache, and threads that finish early find work.
const LEAVES_PER_THREAD: usize = 8;
/// No leaf is divided that has at most this many points.
const MIN_LEAF: usize = 1 << 12;
/// Where more than this part of the points of two leaves are corners of open cells, as on a sphere, merging costs more
/// than threads gain.
const MAX_OPEN: f64 = 0.35;

/// The regular triangulation of points, which satisfy the conditions of [`Sites`](crate::Sites), on all threads where
/// they follow the Hilbert curve through them, else on one. `inserted` is called now and then with the number of points inserted since. The result does
/// not depend on the number of threads. Expected O(n log n) for evenly distributed points.
///
/// # Errors
/// Points that span no volume; too many cells; out of memory; what `inserted` returns.
pub fn triangulate_along(
    positions: &[[f64; 3]],
    weights: &[f64],
    inserted: impl Fn(usize) -> Result<(), Cancelled> + Sync,
) -> Result<Triangulation, TriangulationError> {
    let threads = rayon::current_num_threads();
    if threads > 1 && positions.len() >= MIN_POINTS {
        let leaf = (positions.len() / (threads * LEAVES_PER_THREAD)).max(MIN_LEAF);
        if let Some(mesh) = divide_and_merge(positions, weights, leaf, MAX_OPEN, &inserted)? {
            return numbering::number(mesh.slots, positions.len() as u32);
        }
    }
    let Built { cells, ghost, .. } = insert_cells(positions, weights, &inserted)?;
    Triangulation::of_cells(cells, ghost)
}

/// The mesh of points, divided into leaves of at most `leaf` points where the curve divides these; `None` where
/// merging would not pay, or the points span no volume.
fn divide_and_merge(
    positions: &[[f64; 3]],
    weights: &[f64],
    leaf: usize,
    max_open: f64,
    inserted: &(impl Fn(usize) -> Result<(), Cancelled> + Sync),
) -> Result<Option<Mesh>, TriangulationError> {
    let curve = Curve::through(positions);
    let index = |v: usize| curve.index(&positions[v]);
    if !(1..positions.len()).into_par_iter().all(|v| index(v - 1) <= index(v)) {
        return Ok(None);
    }
    let mut leaves = 0;
    let tree = Tree::of(0..positions.len(), leaf, &index, &mut leaves);
    let points = Points { positions, weights, ghost: positions.len() as u32 };
    let given_up = AtomicBool::new(false);
    let work = Work { points, leaf, leaves, max_open, inserted, given_up: &given_up };
    let half = work.triangulate(&tree)?;
    Ok(half.map(|half| half.mesh).filter(Mesh::spans))
}

/// How points are divided.
struct Tree {
    points: Range<usize>,
    /// The number of its first leaf, in the order of the curve.
    leaf: usize,
    halves: Option<Box<[Tree; 2]>>,
}

impl Tree {
    /// Divides a range of points at the first bit in which their indices differ, again and again.
    fn of(
        points: Range<usize>,
        leaf: usize,
        index: &impl Fn(usize) -> u64,
        leaves: &mut usize,
    ) -> Self {
        let first = *leaves;
        let halves = middle(&points, index).filter(|_| points.len() > leaf).map(|middle| {
            let mut half = |points| Self::of(points, leaf, index, leaves);
            Box::new([half(points.start..middle), half(middle..points.end)])
        });
        if halves.is_none() {
            *leaves += 1;
        }
        Self { points, leaf: first, halves }
    }
}

/// Where the first bit in which indices differ becomes 1.
fn middle(range: &Range<usize>, index: &impl Fn(usize) -> u64) -> Option<usize> {
    let (first, last) = (index(range.start), index(range.end - 1));
    let bit = (first ^ last).checked_ilog2()?;
    let (mut low, mut high) = (range.start, range.end - 1);
    // index(low) has 0 there, and index(high) 1.
    while high - low > 1 {
        let at = usize::midpoint(low, high);
        *(if index(at) >> bit & 1 == 0 { &mut low } else { &mut high }) = at;
    }
    Some(high)
}

/// All points, by their numbers along the curve.
#[derive(Clone, Copy)]
struct Points<'a> {
    positions: &'a [[f64; 3]],
    weights: &'a [f64],
    ghost: u32,
}

/// Points and their triangulation.
struct Half {
    points: Range<usize>,
    extent: Extent,
    mesh: Mesh,
}

/// What all calls have in common.
struct Work<'a, I> {
    points: Points<'a>,
    /// Points of a leaf, at most.
    leaf: usize,
    /// Number of leaves.
    leaves: usize,
    max_open: f64,
    inserted: &'a I,
    /// Set where merging would not pay.
    given_up: &'a AtomicBool,
}

impl<I: Fn(usize) -> Result<(), Cancelled> + Sync> Work<'_, I> {
    /// Triangulates the points of a tree; `None` where this was given up.
    fn triangulate(&self, tree: &Tree) -> Result<Option<Half>, TriangulationError> {
        if self.given_up.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let Some(halves) = &tree.halves else { return self.triangulate_leaf(tree) };
        let [a, b] = &**halves;
        let (a, b) = rayon::join(|| self.triangulate(a), || self.triangulate(b));
        let (Some(a), Some(b)) = (a?, b?) else { return Ok(None) };
        debug_assert!(a.extent.is_apart(&b.extent), "a plane divides two halves");
        // Larger halves have fewer open cells, so the first merges tell.
        let is_small = tree.points.len() <= 2 * self.leaf;
        let max_open = if is_small { self.max_open } else { 1.0 };
        let merged = glue::merge(a, b, &self.points, max_open, |_| (self.inserted)(0))?;
        if merged.is_none() {
            self.given_up.store(true, Ordering::Relaxed);
        }
        Ok(merged)
    }

    fn triangulate_leaf(&self, leaf: &Tree) -> Result<Option<Half>, TriangulationError> {
        let points = leaf.points.clone();
        let positions = &self.points.positions[points.clone()];
        let weights = &self.points.weights[points.clone()];
        let extent = Extent::of(positions, weights);
        let (leaf, leaves) = (leaf.leaf, self.leaves);
        let mesh = match insert_cells(positions, weights, self.inserted) {
            Ok(built) => Mesh::of_leaf(built, leaf, leaves, points.start, self.points.ghost),
            Err(TriangulationError::Sites(_)) => Some(Mesh::of_flat_leaf(leaf, leaves)),
            Err(other) => return Err(other),
        };
        Ok(mesh.map(|mesh| Half { points, extent, mesh }))
    }
}

#[cfg(test)]
mod tests;
