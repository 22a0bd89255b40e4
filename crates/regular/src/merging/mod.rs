//! The triangulation of many points on all threads, by dividing and merging.
//!
//! Points along a Hilbert curve are divided into halves repeatedly, each by a plane, until they are few enough: these leaves are
//! triangulated in parallel. Two halves are merged as follows.
//!
//! 1. A cell of one half is *open* if a point of the other may be in conflict with it ([`open`]). The other cells,
//!    the closed ones, are cells of the whole.
//! 2. A vertex without an open cell keeps its star. So the other cells of the whole have corners of open cells only,
//!    and are among the cells of the triangulation of these corners, which is computed.
//! 3. Of its cells those are taken that fill what the closed cells leave free: they are found by flooding from the
//!    facets between closed and open cells ([`glue`]).
//!
//! This requires no general position: ties are broken only by the positions of points, so a cell of the whole is a cell of every
//! subset that has its corners. Hidden points of a half are hidden in the whole.

mod glue;
mod numbering;
mod open;
mod slots;

use std::ops::Range;

use walpha_base::Cancelled;
use walpha_base::parallel::prelude::*;

use crate::incremental::{Built, insert_cells};
use crate::order::Curve;
use crate::{CellArrays, TriangulationError};
use open::Extent;
use slots::Mesh;

/// With fewer points than this in total, one thread is as fast.
const MIN_POINTS: usize = 1 << 16;
/// Approximate number of leaves per thread: threads that finish early find work, and more leaves would require more merging.
const LEAVES_PER_THREAD: usize = 2;
/// Halves are not equal: a leaf may have a quarter more points than its share before it is divided.
const MAX_SHARE: f64 = 1.25;
/// A leaf with at most this many points is not divided.
const MIN_LEAF: usize = 1 << 12;
/// If more than this part of the points of two small leaves are corners of open cells, as on a sphere or a smooth surface (1),
/// merging costs more than threads gain. The part is 0.2 for random points, 0.3 for lattices, 0.5 for noisy surfaces.
const MAX_OPEN: f64 = 0.7;
/// Number of places along the curve where this is tested.
const TRIALS: usize = 3;
/// Points of a small leaf, at most.
const TRIAL_LEAF: usize = 1 << 11;

/// The regular triangulation of points, which satisfy the conditions of [`Sites`](crate::Sites), on all threads if they follow
/// the Hilbert curve through them, otherwise on one. `inserted` is called from time to time with the number of points inserted
/// since the last call. The result does not depend on the number of threads. Expected O(n log n) for evenly distributed points.
///
/// # Errors
/// Points that span no volume; too many cells; out of memory; what `inserted` returns.
pub fn triangulate_along(
    positions: &[[f64; 3]],
    weights: &[f64],
    inserted: impl Fn(usize) -> Result<(), Cancelled> + Sync,
) -> Result<CellArrays, TriangulationError> {
    let (count, threads) = (positions.len(), rayon::current_num_threads());
    if threads > 1 && count >= MIN_POINTS {
        let share = count as f64 / (threads * LEAVES_PER_THREAD) as f64;
        let leaf = ((MAX_SHARE * share) as usize).max(MIN_LEAF);
        if let Some(curve) = Along::new(positions, weights)
            && curve.merging_pays()?
            && let Some(mesh) = curve.divide_and_merge(leaf, &inserted)?
        {
            return numbering::number(mesh.slots, count as u32);
        }
    }
    let Built { cells, at_infinity, .. } = insert_cells(positions, weights, &inserted)?;
    CellArrays::of_cells(cells, at_infinity)
}

/// Points along the Hilbert curve through them.
struct Along<'a> {
    points: Points<'a>,
    /// The index of each on the curve, ascending.
    indices: Vec<u64>,
}

impl<'a> Along<'a> {
    /// `None` for points in another order.
    fn new(positions: &'a [[f64; 3]], weights: &'a [f64]) -> Option<Self> {
        let curve = Curve::through(positions);
        let indices: Vec<u64> = positions.par_iter().map(|place| curve.index(place)).collect();
        let points = Points { positions, weights, at_infinity: positions.len() as u32 };
        indices.is_sorted().then_some(Self { points, indices })
    }

    /// Tests whether merging is worth its cost, with small leaves at some places along the curve.
    fn merging_pays(&self) -> Result<bool, TriangulationError> {
        let count = self.indices.len();
        let pays = |trial: usize| {
            let middle = count * (2 * trial + 1) / (2 * TRIALS);
            let around =
                middle.saturating_sub(2 * TRIAL_LEAF)..(middle + 2 * TRIAL_LEAF).min(count);
            let mut leaves = 0;
            let tree = Tree::of(around, TRIAL_LEAF, &self.indices, &mut leaves);
            let work =
                Work { points: self.points, leaves, max_open: MAX_OPEN, inserted: &|_| Ok(()) };
            Ok(work.triangulate(tree.two_leaves())?.is_some())
        };
        let pay: Vec<bool> =
            (0..TRIALS).into_par_iter().map(pays).collect::<Result<_, TriangulationError>>()?;
        Ok(2 * pay.into_iter().filter(|&pays| pays).count() > TRIALS)
    }

    /// The mesh of the points, divided into leaves of at most `leaf` points where the curve divides these; `None` if a leaf has
    /// no slots left, or the points span no volume.
    fn divide_and_merge(
        self,
        leaf: usize,
        inserted: &(impl Fn(usize) -> Result<(), Cancelled> + Sync),
    ) -> Result<Option<Mesh>, TriangulationError> {
        let Self { points, indices } = self;
        let mut leaves = 0;
        let tree = Tree::of(0..indices.len(), leaf, &indices, &mut leaves);
        drop(indices);
        let half = Work { points, leaves, max_open: 1.0, inserted }.triangulate(&tree)?;
        Ok(half.map(|half| half.mesh).filter(Mesh::spans))
    }
}

/// The division of points into leaves.
struct Tree {
    points: Range<usize>,
    /// The number of its first leaf, in the order of the curve.
    leaf: usize,
    halves: Option<Box<[Tree; 2]>>,
}

impl Tree {
    /// Divides a range of points repeatedly at the first bit in which their indices differ.
    fn of(points: Range<usize>, leaf: usize, indices: &[u64], leaves: &mut usize) -> Self {
        let first = *leaves;
        let halves = middle(&points, indices).filter(|_| points.len() > leaf).map(|middle| {
            let mut half = |points| Self::of(points, leaf, indices, leaves);
            Box::new([half(points.start..middle), half(middle..points.end)])
        });
        if halves.is_none() {
            *leaves += 1;
        }
        Self { points, leaf: first, halves }
    }

    /// The first part of two leaves, or the only leaf.
    fn two_leaves(&self) -> &Self {
        let larger = |halves: &[Self; 2]| halves.iter().position(|half| half.halves.is_some());
        match &self.halves {
            Some(halves) => larger(halves).map_or(self, |half| halves[half].two_leaves()),
            None => self,
        }
    }
}

/// The position where the first bit in which indices differ becomes 1.
fn middle(range: &Range<usize>, indices: &[u64]) -> Option<usize> {
    let indices = &indices[range.clone()];
    let bit = (indices.first()? ^ indices.last()?).checked_ilog2()?;
    Some(range.start + indices.partition_point(|index| index >> bit & 1 == 0))
}

/// All points, by their numbers along the curve.
#[derive(Clone, Copy)]
struct Points<'a> {
    positions: &'a [[f64; 3]],
    weights: &'a [f64],
    at_infinity: u32,
}

/// Points and their triangulation.
struct Half {
    points: Range<usize>,
    extent: Extent,
    mesh: Mesh,
}

/// The data that all calls share.
struct Work<'a, I> {
    points: Points<'a>,
    /// Number of leaves.
    leaves: usize,
    /// Two halves with more open corners than this part of their points are not merged.
    max_open: f64,
    inserted: &'a I,
}

impl<I: Fn(usize) -> Result<(), Cancelled> + Sync> Work<'_, I> {
    /// Triangulates the points of a tree; `None` if halves are not merged, or a leaf has no slots left.
    fn triangulate(&self, tree: &Tree) -> Result<Option<Half>, TriangulationError> {
        let Some(halves) = &tree.halves else { return self.triangulate_leaf(tree) };
        let [a, b] = &**halves;
        let (a, b) = rayon::join(|| self.triangulate(a), || self.triangulate(b));
        let (Some(a), Some(b)) = (a?, b?) else { return Ok(None) };
        debug_assert!(a.extent.is_apart(&b.extent), "a plane divides two halves");
        glue::merge(a, b, &self.points, self.max_open, |_| (self.inserted)(0))
    }

    fn triangulate_leaf(&self, leaf: &Tree) -> Result<Option<Half>, TriangulationError> {
        let points = leaf.points.clone();
        let positions = &self.points.positions[points.clone()];
        let weights = &self.points.weights[points.clone()];
        let extent = Extent::of(positions, weights);
        let (leaf, leaves) = (leaf.leaf, self.leaves);
        let mesh = match insert_cells(positions, weights, self.inserted) {
            Ok(built) => Mesh::of_leaf(built, leaf, leaves, points.start, self.points.at_infinity),
            Err(TriangulationError::Sites(_)) => Some(Mesh::of_flat_leaf(leaf, leaves)),
            Err(other) => return Err(other),
        };
        Ok(mesh.map(|mesh| Half { points, extent, mesh }))
    }
}

#[cfg(test)]
mod tests;
