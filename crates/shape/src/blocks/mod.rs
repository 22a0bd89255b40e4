//! The α-complex, block by block.
//!
//! The α-complex is local. A simplex of the shape has an orthogonal sphere of squared radius at most α, so each
//! of its vertices v lies within √(α + ω(v)) of the sphere's centre, and a point q that could refute
//! it, by lying inside, within √(α + ω(q)). The points of a block and those within
//! √(α + ω(q)) + √(α + max ω of the block) of its box, its *halo*, therefore decide every simplex that
//! has a vertex in the block. Ties too: a face of the lower hull of all lifted points is one of any
//! subset that has its vertices, and ties are broken by raising lifted points in an order of their
//! coordinates, which does not depend on what other points there are.
//!
//! With `Balls::Radius` the weights are (α + ω)² and α is 0; the same bound is then the sum of the two
//! radii.
//!
//! A block owns the simplices whose smallest vertex (by input index) lies in it. [`partition`] cuts sites into blocks,
//! [`plan`] decides into how many, [`classify`] finds the simplices that a block owns, and [`merge`] merges them.

mod block_shape;
mod classify;
mod merge;
mod partition;
mod plan;
mod spanning;
mod torus;

use rayon::prelude::*;
use walpha_base::Monitor;
use walpha_base::monitor::Units;
use walpha_regular::Lattice;
use walpha_regular::{Sites, Torus, Triangulation, TriangulationError, check_span, insert_all};

use super::{Complex, ShapeError};

pub use block_shape::{BlockShape, Own, Side, block_shape};
use classify::{Buckets, Owned, classify};
use merge::merge;
pub(super) use partition::Partition;
pub(crate) use partition::Reach;
pub use plan::AT_WORK;
pub use plan::PlanError;
pub(super) use plan::{Limits, Plan};
use spanning::spanning;
use torus::{on_torus, too_long};

/// The parameters of the shape, the same for all blocks.
#[derive(Clone, Copy)]
pub(super) struct Question {
    /// A squared length or +∞.
    pub alpha: f64,
    /// The lattice of the whole set.
    pub lattice: Lattice,
    /// Whether exterior simplices are wanted, too. They are defined by the triangulation of all points only.
    pub exterior: bool,
}

/// The merged result of all blocks.
pub(super) struct Answer {
    pub complex: Complex,
    /// Number of components.
    pub b0: u64,
    /// One sheet for each regular facet and two for each singular one, in the order of the facets.
    pub facet_sheets: Vec<u32>,
    /// The sheet of each singular edge, in their order.
    pub edge_sheets: Vec<u32>,
    /// Input indices of hidden sites, where the whole triangulation was made.
    pub hidden: Option<Vec<u32>>,
    /// Number of independent directions in which loops on the sheets wind round a torus.
    pub sheet_windings: usize,
}

/// The sites of a block and those of its halo, each along the curve.
pub(super) struct Block {
    /// The block's own points, then its halo.
    pub positions: Vec<[f64; 3]>,
    /// Power weights.
    pub weights: Vec<f64>,
    /// Input indices.
    pub input: Vec<u32>,
    /// Number of the block's own points.
    pub own: u32,
    /// On a torus: how the points of the halo were moved.
    pub copies: Option<Copies>,
}

/// The copies that a halo consists of, on a torus.
pub(super) struct Copies {
    pub torus: Torus,
    /// The multiples of the sides by which each is moved.
    pub windings: Vec<[i32; 3]>,
}

impl Block {
    /// The multiples of the sides by which a point is moved; 0 for the block's own.
    pub(super) fn windings(&self, v: u32) -> [i32; 3] {
        let beyond = v.checked_sub(self.own).zip(self.copies.as_ref());
        beyond.map_or([0; 3], |(at, copies)| copies.windings[at as usize])
    }
}

/// The α-complex of sites; with exterior simplices, which need one block, the whole triangulation.
pub(super) fn run(
    sites: &Sites<'_>,
    plan: &Plan,
    question: &Question,
    monitor: &Monitor,
) -> Result<Answer, ShapeError> {
    let partition = &plan.partition;
    if sites.torus().is_none() {
        check_span(sites).map_err(TriangulationError::from)?;
    }
    tracing::debug!(blocks = partition.len(), at_once = plan.at_once, "cut");
    // A batch of blocks frees its working memory before the next one starts.
    let buckets = Buckets::new(sites.input(), plan.buckets());
    let blocks: Vec<usize> = (0..partition.len()).collect();
    let mut owned: Vec<Owned> = Vec::with_capacity(blocks.len());
    let (mut bytes, mut points) = (0, 0);
    let work = monitor.units(WORK * sites.input().len() as u64);
    for batch in blocks.chunks(plan.at_once) {
        let done: Result<Vec<_>, ShapeError> = batch
            .par_iter()
            .map(|&block| decide(sites, partition, block, question, buckets, &work))
            .collect();
        for done in done? {
            bytes += done.merged_bytes();
            points += done.points();
            owned.push(done);
        }
        plan.keeps(bytes, points, sites.input().len())?;
        plan.give_back();
    }
    Ok(merge(sites, plan, owned, question, buckets))
}

/// Classifies the simplices that a block owns.
fn decide(
    sites: &Sites<'_>,
    partition: &Partition,
    block: usize,
    question: &Question,
    buckets: Buckets,
    work: &Units<'_>,
) -> Result<Owned, ShapeError> {
    let (points, made, lattice) = match sites.torus() {
        None => in_space(sites, partition, block, question, work)?,
        Some(torus) => on_torus(sites, torus, partition, block, question, work)?,
    };
    let owned = classify(&points, made, &Question { lattice, ..*question }, buckets);
    work.add((WORK - TRIANGULATION) * u64::from(points.own))?;
    match (owned.long, sites.torus()) {
        (Some(edge), Some(torus)) => Err(too_long(torus, edge)),
        _ => Ok(owned),
    }
}

/// A block with its halo, its triangulation, and the lattice of its points.
fn in_space(
    sites: &Sites<'_>,
    partition: &Partition,
    block: usize,
    question: &Question,
    work: &Units<'_>,
) -> Result<(Block, Triangulation, Lattice), ShapeError> {
    let mut points = partition.block(sites, Reach::Balls(question.alpha), block);
    let (inside, next) = (points.input.len(), sites.input().last().map_or(0, |last| last + 1));
    let made = spanning(&mut points, question.alpha, next, work)?;
    // Auxiliary points need not be on the lattice of the set.
    let lattice = if points.input.len() > inside {
        Lattice::of(&points.positions, &points.weights)
    } else {
        question.lattice
    };
    Ok((points, made, lattice))
}

/// Units of progress of a point, and how many of them its triangulation counts.
const WORK: u64 = 3;
const TRIANGULATION: u64 = 2;

/// Triangulates a block, and reports progress for its own points.
fn triangulate(points: &Block, work: &Units<'_>) -> Result<Triangulation, TriangulationError> {
    let (own, all) = (TRIANGULATION * u64::from(points.own), points.input.len() as u64);
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
