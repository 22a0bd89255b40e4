use serde::Serialize;

use super::cut::{SILENT, TILE_SAMPLE};
use super::{BlocksError, Cutting, Field, Job};
use crate::points::SelectionRule;
use crate::shape::{Balls, at_work};
use crate::triangulation::Maker;
use crate::volume::Source;
use crate::{Weighting, shape::PlanError};

/// What a job will cost, by a model: as if its points were spread evenly, and with the speed of one core of
/// the machine that `docs/clusters.md` names. Nothing of the volume is read.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Price {
    /// Samples of the volume.
    pub samples: u64,
    /// Points that will be selected.
    pub points: u64,
    /// Blocks.
    pub blocks: u64,
    /// Points that are looked at again, around blocks, as a share of all.
    pub halo_share: f64,
    /// Bytes of memory of a process that works on one block at a time.
    pub memory_per_block: u64,
    /// Bytes of samples that are read by the plan, and by all blocks together.
    pub bytes_read: [u64; 2],
    /// Bytes that blocks write, and of these what merging reads.
    pub bytes_written: [u64; 2],
    /// Seconds of one core for the plan, for all blocks, and for merging without writing pieces.
    pub core_seconds: [f64; 3],
}

/// Passes over the volume that a plan takes where values are not gray levels.
const PASSES: f64 = 6.0;
/// Nanoseconds of a core for a sample in a pass of the plan, and in a block.
const SAMPLE: f64 = 60.0;
/// Nanoseconds of a core for a point of a block at work, by maker, and for its rows.
const NATIVE: f64 = 6000.0;
const CGAL: f64 = 11_000.0;
/// Bytes that a block writes for a point of its own.
const ROWS: f64 = 420.0;
/// Bytes of keys for a point at a face of a block, and nanoseconds of merging them.
const KEYS: f64 = 150.0;
const MERGE: f64 = 3000.0;
/// How many times the mean the largest difference is taken to be.
const PEAK: f64 = 8.0;

/// The price of a job.
///
/// # Errors
/// As [`Job::check`]; a selection whose count is known only when the volume was read.
pub fn price(job: &Job, cutting: Cutting) -> Result<Price, BlocksError> {
    job.check()?;
    let source = Source::open(&job.input, &job.read)?;
    let samples = job.dims.samples() as u64;
    let points = match job.selection.rule {
        SelectionRule::Count(count) => count,
        SelectionRule::Ratio(ratio) => (ratio * samples as f64).round() as u64,
        SelectionRule::Threshold(_) => {
            let next = "give --ratio or --count for the price";
            return Err(BlocksError::not_local("the number of points above a threshold", next));
        }
    };
    let weight = match job.weighting {
        Weighting::Common(weight) => weight,
        Weighting::MinMax => job.alpha,
        Weighting::BarycentricN => PEAK * job.alpha,
        _ => 0.0,
    };
    let radius = match job.balls {
        Balls::Power => (job.alpha + weight).max(0.0).sqrt(),
        Balls::Radius => (job.alpha + weight).abs(),
    };
    let margin = job.reach(2.0 * radius).into_iter().max().unwrap_or(0) as f64 + 1.0;
    let tile = Field::tile_of(&source).iter().product::<usize>() as u64;
    let of = |blocks: u64| {
        let edge = (samples as f64 / blocks as f64).cbrt();
        let halo = if blocks == 1 { 0.0 } else { ((edge + 2.0 * margin) / edge).powi(3) - 1.0 };
        // A block has no more around it than there is.
        let halo = halo.min(blocks as f64 - 1.0);
        let largest = points as f64 / blocks as f64 * (1.0 + halo);
        let memory = TILE_SAMPLE * tile + (at_work(job.maker()) as f64 * largest) as u64;
        (edge, halo, memory)
    };
    let blocks = if let Some(blocks) = cutting.blocks {
        blocks as u64
    } else {
        let threads = rayon::current_num_threads() as u64;
        let asked = cutting.memory.unwrap_or(SILENT);
        let fits = |blocks: &u64| threads * of(*blocks).2 <= asked;
        let mut powers = (0..32).map(|power| threads << power);
        let needed = threads * of(threads << 31).2;
        let none = PlanError { asked, needed, blocks: 1 << 31 };
        powers.find(fits).ok_or(crate::shape::ShapeError::Plan(none))?
    };
    let (edge, halo, memory_per_block) = of(blocks);
    let size = source.dtype().size() as f64;
    let (n, p) = (samples as f64, points as f64);
    // Points within an edge's length of the faces between blocks.
    let faces = if blocks == 1 { 0.0 } else { 3.0 * n / edge * 2.0 * radius * p / n };
    let each = if job.maker() == Maker::Native { NATIVE } else { CGAL };
    let around = n * (1.0 + halo);
    Ok(Price {
        samples,
        points,
        blocks,
        halo_share: halo,
        memory_per_block,
        bytes_read: [PASSES * n * size, around * size].map(|bytes| bytes as u64),
        bytes_written: [ROWS * p + KEYS * faces, KEYS * faces].map(|bytes| bytes as u64),
        core_seconds: [
            PASSES * n * SAMPLE * 1e-9,
            (around * SAMPLE + p * (1.0 + halo) * each) * 1e-9,
            faces * MERGE * 1e-9,
        ],
    })
}
