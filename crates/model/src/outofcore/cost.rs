use serde::Serialize;

use walpha_points::SelectionRule;
use walpha_points::Weighting;
use walpha_points::haar::Decomposition;
use walpha_shape::{AT_WORK, PlanError, ShapeError};
use walpha_volume::{GrayRange, Source};

use super::field::Field;
use super::plan::{DEFAULT_MEMORY, TILE_SAMPLE};
use super::{BlocksError, Cutting, Job};

/// The estimated cost of a job. The model assumes that blocks are cubes, that three tenths of the volume are filled evenly with
/// points, and that the cores are those of the machine in `docs/clusters.md`, which has the measurements. No samples of the
/// volume are read.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct CostEstimate {
    /// The number of samples of the volume.
    pub samples: u64,
    /// The number of points that will be selected.
    pub points: u64,
    /// The number of blocks.
    pub blocks: u64,
    /// The number of points around blocks, which are processed again, as a share of all.
    pub halo_share: f64,
    /// The memory in bytes of a process that works on one block at a time.
    pub memory_per_block: u64,
    /// The bytes of samples that are read by the plan, and by all blocks together.
    pub bytes_read: [u64; 2],
    /// The bytes that blocks write, and the part of them that merging reads.
    pub bytes_written: [u64; 2],
    /// The size in bytes of the files that the plan works with; blocks need a third of them, for the standard decomposition.
    pub bytes_of_plan: u64,
    /// The seconds of one core for the plan, for all blocks, and for merging without writing pieces.
    pub core_seconds: [f64; 3],
}

/// The number of passes over the volume that a plan takes: if values are gray levels, and if their range must be found first.
const PASSES: [f64; 2] = [5.0, 6.0];
/// The share of the volume that is filled with points.
const FILLED: f64 = 0.3;
/// The nanoseconds of a core for a sample in a pass of the plan, and in a block.
const SAMPLE: f64 = 60.0;
/// The memory in bytes for a point of a block at work, and its time, including its rows, in nanoseconds of a core.
const POINT: f64 = 6900.0;
/// The number of bytes that a block writes for each of its own points.
const ROWS: f64 = 335.0;
/// The bytes of keys for a point next to a face between blocks, and the nanoseconds of merging them.
const KEYS: f64 = 23.0;
const MERGE: f64 = 250.0;
/// The size in bytes of the sum of a brick.
const SUM: u64 = 8;
/// The size in bytes of a sample in files: of a coefficient of the standard decomposition, and of the truncated volume.
const IN_FILE: u64 = 8 + 4;
/// The assumed ratio of the largest difference and the mean.
const PEAK: f64 = 8.0;

/// Estimates the cost of a job.
///
/// # Errors
/// See [`Job::check`]; or the number of selected points is known only after reading the volume.
pub fn estimate_cost(job: &Job, cutting: Cutting) -> Result<CostEstimate, BlocksError> {
    job.check()?;
    let source = Source::open(&job.input, &job.recipe.read)?;
    let model = Model::new(job, &source)?;
    let blocks = match cutting.blocks {
        Some(blocks) => blocks as u64,
        None => model.blocks(cutting.memory.unwrap_or(DEFAULT_MEMORY))?,
    };
    let Model { samples: n, points: p, .. } = model;
    let size = source.dtype().size() as f64;
    // There are two layers of points at each face between blocks.
    let faces = 6.0 * ((blocks as f64).cbrt() - 1.0) * p.powf(2.0 / 3.0);
    let is_gray = source.has_gray_levels() && job.recipe.gray.is_none();
    let passes = PASSES[usize::from(!is_gray)];
    let bytes_of_plan = match job.recipe.haar.decomposition {
        Decomposition::NonStandard => model.sums,
        Decomposition::Standard => IN_FILE * n as u64,
    };
    let (halo_share, around) = (model.halo(blocks), n * model.around(blocks));
    Ok(CostEstimate {
        samples: n as u64,
        points: p as u64,
        blocks,
        halo_share,
        memory_per_block: model.memory(blocks),
        bytes_read: [passes * n * size, around * size].map(|bytes| bytes as u64),
        bytes_written: [ROWS * p + KEYS * faces, KEYS * faces].map(|bytes| bytes as u64),
        bytes_of_plan,
        core_seconds: [
            passes * n * SAMPLE * 1e-9,
            (around * SAMPLE + p * (1.0 + halo_share) * POINT) * 1e-9,
            faces * MERGE * 1e-9,
        ],
    })
}

/// A model of cubes with equal numbers of samples, some of which are filled with points.
struct Model {
    samples: f64,
    points: f64,
    /// The width in samples of the surroundings of a block that are processed: of points, and of samples.
    width: f64,
    margin: f64,
    /// The bytes for the sums of all bricks, for these and the samples at work, and for each point.
    sums: u64,
    samples_at_work: u64,
    point: u64,
}

impl Model {
    fn new(job: &Job, source: &Source) -> Result<Self, BlocksError> {
        let samples = job.dims.samples() as f64;
        let points = match job.selection(&GrayRange::IDENTITY).rule {
            SelectionRule::Count(count) => count as f64,
            SelectionRule::Ratio(ratio) | SelectionRule::AtMost(ratio) => (ratio * samples).round(),
            SelectionRule::Threshold(_) => {
                let next = "give --ratio or --count for the price";
                return Err(BlocksError::not_local("the number of points above a threshold", next));
            }
        };
        let largest = match job.weighting() {
            Weighting::Common(weight) => weight,
            Weighting::MinMax => job.alpha().squared(),
            Weighting::BarycentricN => PEAK * job.alpha().squared(),
            _ => 0.0,
        };
        // Except for common ones, weights are usually small.
        let usual = if let Weighting::Common(weight) = job.weighting() { weight } else { 0.0 };
        let radius = |weight: f64| job.recipe.balls.radius(job.alpha(), weight);
        let product = |sizes: [usize; 3]| sizes.iter().product::<usize>() as u64;
        let reach = |radius: f64| job.reach(radius).into_iter().max().unwrap_or(0) as f64;
        let sums = SUM * product(Field::bricks_of(job.dims.xyz()).count());
        Ok(Self {
            samples,
            points,
            width: reach(radius(usual) + radius(largest)),
            margin: reach(2.0 * radius(largest)) + 1.0,
            sums,
            samples_at_work: sums + TILE_SAMPLE * product(Field::tile_of(source)),
            point: AT_WORK,
        })
    }

    /// The factor by which a block of samples grows with its surroundings. Blocks at the sides of the volume have none beyond
    /// these.
    fn grown(blocks: u64, samples: f64, by: f64) -> f64 {
        let blocks = blocks as f64;
        let edge = (samples / blocks).cbrt();
        (1.0 + 2.0 * by * (1.0 - 1.0 / blocks.cbrt()) / edge).powi(3)
    }

    /// The number of samples in and around blocks, for each sample.
    fn around(&self, blocks: u64) -> f64 {
        Self::grown(blocks, self.samples, self.margin)
    }

    /// The number of points around blocks, for each point.
    fn halo(&self, blocks: u64) -> f64 {
        Self::grown(blocks, FILLED * self.samples, self.width) - 1.0
    }

    /// The memory in bytes for a block at work.
    fn memory(&self, blocks: u64) -> u64 {
        let points = self.points / blocks as f64 * (1.0 + self.halo(blocks));
        self.samples_at_work + (self.point as f64 * points) as u64
    }

    /// The smallest number of blocks that need at most `asked` bytes, with one block at work per thread.
    fn blocks(&self, asked: u64) -> Result<u64, ShapeError> {
        /// The number of powers of two that are tried.
        const POWERS: u32 = 32;
        let threads = rayon::current_num_threads() as u64;
        let needed = |blocks: u64| threads * self.memory(blocks);
        let mut powers = (0..POWERS).map(|power| threads << power);
        let most = 1 << (POWERS - 1);
        let none = PlanError::new(asked, needed(threads * most), most as usize);
        powers.find(|&blocks| needed(blocks) <= asked).ok_or(ShapeError::Plan(none))
    }
}
