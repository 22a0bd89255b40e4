//! A block, the parameters of its shape, and the merged result of all blocks.

use std::sync::atomic::{AtomicU64, Ordering};

use walpha_base::monitor::Units;
use walpha_regular::internals::{CellArrays, Lattice, insert_all, triangulate_along};
use walpha_regular::{Torus, TriangulationError};

use crate::Complex;

/// The parameters of the shape, the same for all blocks.
#[derive(Clone, Copy)]
pub(crate) struct BlockParams {
    /// A squared length or +∞.
    pub alpha: f64,
    /// The lattice of the whole set.
    pub lattice: Lattice,
    /// Whether exterior simplices are wanted, too. They are defined by the triangulation of all points only.
    pub exterior: bool,
}

/// The merged result of all blocks.
pub(crate) struct MergedComplex {
    pub complex: Complex,
    /// Number of components.
    pub b0: u64,
    /// One sheet for each regular facet and two for each singular one, in the order of the facets.
    pub facet_sheets: Vec<u32>,
    /// The sheet of each singular edge, in the order of the edges.
    pub edge_sheets: Vec<u32>,
    /// Input indices of hidden sites, if the whole triangulation was made.
    pub hidden: Option<Vec<u32>>,
    /// Number of independent directions in which loops on the sheets wind round a torus.
    pub sheet_windings: usize,
}

/// The sites of a block and those of its halo, each along the curve.
pub(crate) struct Block {
    /// The block's own points, then its halo.
    pub positions: Vec<[f64; 3]>,
    /// Power weights.
    pub weights: Vec<f64>,
    /// Input indices.
    pub input: Vec<u32>,
    /// Number of the block's own points.
    pub own: u32,
    /// On a torus: the shifts of the points of the halo.
    pub copies: Option<Copies>,
}

/// The copies that a halo consists of, on a torus.
pub(crate) struct Copies {
    pub torus: Torus,
    /// The multiples of the vectors by which each copy is moved.
    pub windings: Vec<[i32; 3]>,
}

impl Block {
    /// The multiples of the vectors by which a point is moved; 0 for the block's own.
    pub(crate) fn windings(&self, v: u32) -> [i32; 3] {
        let beyond = v.checked_sub(self.own).zip(self.copies.as_ref());
        beyond.map_or([0; 3], |(at, copies)| copies.windings[at as usize])
    }
}

/// Units of progress of a point, and how many of them its triangulation counts.
pub(super) const WORK: u64 = 3;
pub(super) const TRIANGULATION: u64 = 2;

/// Triangulates a block, and reports progress for its own points.
pub(super) fn triangulate(
    points: &Block,
    work: &Units<'_>,
) -> Result<CellArrays, TriangulationError> {
    let (own, all) = (TRIANGULATION * u64::from(points.own), points.input.len() as u64);
    if u64::from(points.own) == all {
        // A single block can use all threads.
        let counted = AtomicU64::new(0);
        let made = triangulate_along(&points.positions, &points.weights, |more| {
            let fresh = TRIANGULATION * more as u64;
            counted.fetch_add(fresh, Ordering::Relaxed);
            work.add(fresh)
        })?;
        work.add(own.saturating_sub(counted.into_inner()))?;
        return Ok(made);
    }
    let (mut inside, mut counted) = (0, 0);
    let made = insert_all(&points.positions, &points.weights, |more| {
        inside += more as u64;
        let units = own * inside / all;
        let fresh = units - counted;
        counted = units;
        work.add(fresh)
    })?;
    work.add(own - counted)?;
    Ok(made)
}
