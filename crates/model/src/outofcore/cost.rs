use serde::Serialize;

use walpha_points::SelectionRule;
use walpha_points::Weighting;
use walpha_points::haar::Decomposition;
use walpha_shape::{AT_WORK, PlanError, ShapeError};
use walpha_volume::{GrayRange, Source};

use super::field::Field;
use super::plan::{DEFAULT_MEMORY, TILE_SAMPLE};
use super::{BlocksError, Cutting, Job};

/// What a job will cost, by a model: as if its blocks were cubes, three tenths of the volume were filled evenly with
/// points, and the cores were those of the machine in `docs/clusters.md`, which has what was measured. Nothing of the volume is read.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct CostEstimate {
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
    /// Bytes of files that the plan works with; blocks need a third of them, for the standard decomposition.
    pub bytes_of_plan: u64,
    /// Seconds of one core for the plan, for all blocks, and for merging without writing pieces.
    pub core_seconds: [f64; 3],
}

/// Passes over the volume that a plan takes: where values are gray levels, and where these are to be found first.
const PASSES: [f64; 2] = [5.0, 6.0];
/// The share of the volume where the points are.
const FILLED: f64 = 0.3;
/// Nanoseconds of a core for a sample in a pass of the plan, and in a block.
const SAMPLE: f64 = 60.0;
/// Nanoseconds of a core for a point of a block at work, and for its rows.
const POINT: f64 = 6900.0;
/// Bytes that a block writes for a point of its own.
const ROWS: f64 = 335.0;
/// Bytes of keys for a point next to a face between blocks, and nanoseconds of merging them.
const KEYS: f64 = 23.0;
const MERGE: f64 = 250.0;
/// Bytes of the sum of a brick.
const SUM: u64 = 8;
/// Bytes for a sample of the coefficients of the standard decomposition, and of the truncated volume, in files.
const IN_FILE: u64 = 8 + 4;
/// How many times the mean the largest difference is taken to be.
const PEAK: f64 = 8.0;

/// Estimates the cost of a job.
///
/// # Errors
/// The errors of [`Job::check`]; a selection whose count is known only after reading the volume.
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
    // Two layers of points at each face between blocks.
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

/// Cubes of equally many samples, of which some are filled with points.
struct Model {
    samples: f64,
    points: f64,
    /// How far, in samples, what is looked at around a block reaches from it: points, and samples.
    width: f64,
    margin: f64,
    /// Bytes for the sums of all bricks, for these and the samples at work, and for each point.
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
        // All weights but a common one are small as a rule.
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

    /// How many times as large a block of so many samples is with what is around it. Blocks at the sides of
    /// the volume have nothing beyond these.
    fn grown(blocks: u64, samples: f64, by: f64) -> f64 {
        let blocks = blocks as f64;
        let edge = (samples / blocks).cbrt();
        (1.0 + 2.0 * by * (1.0 - 1.0 / blocks.cbrt()) / edge).powi(3)
    }

    /// Samples in and around blocks, for each sample.
    fn around(&self, blocks: u64) -> f64 {
        Self::grown(blocks, self.samples, self.margin)
    }

    /// Points around blocks, for each point.
    fn halo(&self, blocks: u64) -> f64 {
        Self::grown(blocks, FILLED * self.samples, self.width) - 1.0
    }

    /// Bytes for a block at work.
    fn memory(&self, blocks: u64) -> u64 {
        let points = self.points / blocks as f64 * (1.0 + self.halo(blocks));
        self.samples_at_work + (self.point as f64 * points) as u64
    }

    /// The fewest blocks that keep to `asked` bytes, with one block at work per thread.
    fn blocks(&self, asked: u64) -> Result<u64, ShapeError> {
        /// Powers of two that are tried.
        const POWERS: u32 = 32;
        let threads = rayon::current_num_threads() as u64;
        let needed = |blocks: u64| threads * self.memory(blocks);
        let mut powers = (0..POWERS).map(|power| threads << power);
        let most = 1 << (POWERS - 1);
        let none = PlanError::new(asked, needed(threads * most), most as usize);
        powers.find(|&blocks| needed(blocks) <= asked).ok_or(ShapeError::Plan(none))
    }
}
