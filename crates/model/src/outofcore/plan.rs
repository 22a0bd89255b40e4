//! Plans: the boxes into which a volume is cut.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use walpha_base::{Monitor, memory, setters};

use super::bytes::{Digest, read_file};
use super::field::{Field, Truncated};
use super::job::Stamp;
use super::survey::{Survey, Surveyed, survey};
use super::truncate::{DigestedFile, SMOOTHED, SUMS};
use super::{BlocksError, Job, SampleBox, Team};
use crate::export::Target;
use walpha_points::PointsError;
use walpha_points::Weighting;
use walpha_points::internal::Shares;
use walpha_shape::{AT_WORK, Alpha, PlanError, ShapeError};

use crate::Recipe;

/// The rule for cutting a job into blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Cutting {
    /// The number of blocks; there are fewer if fewer bricks have points.
    pub blocks: Option<usize>,
    /// The memory in bytes for all blocks at work, of which there are as many as threads.
    pub memory: Option<u64>,
}

impl Cutting {
    /// The cutting of a recipe.
    pub fn of(recipe: &Recipe) -> Self {
        Self { blocks: recipe.blocks.map(usize::from), memory: recipe.memory }
    }

    setters! { blocks: Option<usize>, memory: Option<u64> }
}

/// Everything that a block needs to know about the others: the job, the numbers of the whole volume, and the boxes of the blocks.
/// It is stored in a folder, to which the blocks are written, too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Plan {
    /// The version of the program that made the plan.
    version: String,
    /// The job.
    pub job: Job,
    /// The rule by which it was cut.
    pub cutting: Cutting,
    /// The numbers of the whole volume.
    pub survey: Survey,
    /// The blocks.
    pub blocks: Vec<BlockPlan>,
    /// The files beside the plan.
    pub(super) kept: Vec<DigestedFile>,
    /// The stamp of the input files.
    pub(super) stamp: Stamp,
    #[serde(skip)]
    pub(super) folder: PathBuf,
    #[serde(skip)]
    pub(super) digest: Digest,
}

/// A block: a box of the volume, whose points are its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BlockPlan {
    /// The box of its samples.
    pub part: SampleBox,
    /// The number of its points.
    pub points: u64,
    /// The number of points around it that it may need, counted by bricks.
    pub halo: u64,
    /// The digests of the bricks that it reads.
    pub(super) reads: Reads,
}

/// The digests of the samples that a block reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Reads {
    pub input: Digest,
    /// The digest of the truncated volume, if that is in a file.
    pub truncated: Option<Digest>,
}

impl Plan {
    pub(super) const FILE: &str = "plan.json";
    /// The version of this program. A plan and its blocks must have the same version.
    pub(super) const VERSION: &str = env!("CARGO_PKG_VERSION");

    /// Surveys the volume of a job, cuts it, and writes the plan into an existing folder. Reads the volume five or six times,
    /// with a tile for each thread in memory.
    ///
    /// A single process is [`Alone`](super::Alone). In a team each process surveys its share of the volume, the first writes the
    /// plan, and all get it. The memory limit of blocks applies to one process.
    ///
    /// # Errors
    /// The errors of the stages, an option that is not local ([`Job::check`]), or a folder that cannot be written to. A process that
    /// returns an error leaves the rest of the team waiting.
    pub fn make(
        job: Job,
        cutting: Cutting,
        folder: impl AsRef<Path>,
        team: &dyn Team,
    ) -> Result<Self, BlocksError> {
        let (folder, monitor) = (folder.as_ref(), &*Monitor::current());
        job.check()?;
        // The stamp is taken before reading, so that a change during reading is detected.
        let stamp = Stamp::of(&job);
        let mut field = Field::open(&job, None)?;
        let surveyed = survey(&job, &mut field, folder, team, monitor)?;
        let plan = if team.is_first() {
            let plan = Self::cut(job, cutting, stamp, folder, &field, surveyed, team.size())?;
            plan.write()?;
            Some(plan)
        } else {
            None
        };
        Self::broadcast(plan, folder, team)
    }

    /// Gives the plan of the first process to all.
    pub(super) fn broadcast(
        first: Option<Self>,
        folder: &Path,
        team: &dyn Team,
    ) -> Result<Self, BlocksError> {
        if team.size() == 1 {
            return Ok(first.expect("the first process has it"));
        }
        let text = first.map(|plan| plan.text());
        Self::of_text(&team.broadcast(text), folder)
    }

    /// Cuts a surveyed volume, and writes the files that the plan keeps.
    fn cut(
        job: Job,
        cutting: Cutting,
        stamp: Stamp,
        folder: &Path,
        field: &Field,
        Surveyed { survey, truncated, counts, mut kept }: Surveyed,
        processes: usize,
    ) -> Result<Self, BlocksError> {
        let boxes = Boxes { counts: &counts, bricks: field.bricks.count() };
        let side = field.bricks.side();
        let tile = field.tile().iter().product::<usize>() as u64;
        let mut plan = Self {
            version: Self::VERSION.into(),
            job,
            cutting,
            survey,
            blocks: Vec::new(),
            kept: Vec::new(),
            stamp,
            folder: folder.into(),
            digest: Digest::default(),
        };
        if let Truncated::Bricks { sums, .. } = &truncated {
            kept.push(DigestedFile::write_sums(sums, folder)?);
        }
        plan.kept = kept;
        let margin = plan.margin()?;
        let bricks = margin.map(|samples| samples.div_ceil(side));
        let cut = boxes.planned(cutting, bricks, tile, processes)?;
        let of_bricks = |(part, halo): (SampleBox, u64)| {
            let points = boxes.points(&part);
            let whole = SampleBox::whole(field.dims);
            let part = SampleBox {
                first: part.first.map(|i| i * side),
                size: part.size.map(|n| n * side),
            };
            let part = part.common(&whole);
            let read = Self::read_around(&part, margin, field.dims);
            let input = field.digests.digest(&read);
            let truncated = if let Truncated::File(_, digests) = &truncated {
                Some(digests.digest(&read))
            } else {
                None
            };
            BlockPlan { part, points, halo: halo - points, reads: Reads { input, truncated } }
        };
        plan.blocks = cut.into_iter().map(of_bricks).collect();
        plan.digest = plan.computed_digest();
        Ok(plan)
    }

    /// The samples to be read for a part if points within a margin around it are needed: differences need one more sample.
    pub(super) fn read_around(part: &SampleBox, margin: [usize; 3], dims: [usize; 3]) -> SampleBox {
        part.grown(margin, dims).grown([1; 3], dims)
    }

    fn write(&self) -> Result<(), BlocksError> {
        let target = Target::replacing(self.folder.join(Self::FILE))?;
        Ok(target.write(|out| out.write_all(&self.text()))?)
    }

    /// The text before and after the digest of a plan.
    const CHECKSUM: [&[u8]; 2] = [b",\n  \"checksum\": \"", b"\"\n}\n"];

    /// The text of the plan: JSON, with the digest of all bytes before it as the last field.
    fn text(&self) -> Vec<u8> {
        let mut text = serde_json::to_vec_pretty(self).expect("it has no maps");
        // This removes the closing brace and the line end before it.
        text.truncate(text.len() - 2);
        let [before, behind] = Self::CHECKSUM;
        let digest = Digest::of(&text).to_string();
        [&text, before, digest.as_bytes(), behind].concat()
    }

    /// Opens the plan in a folder.
    ///
    /// # Errors
    /// There is no plan, it cannot be read, or it does not verify.
    pub fn open(folder: impl AsRef<Path>) -> Result<Self, BlocksError> {
        let folder = folder.as_ref();
        let text = read_file(&folder.join(Self::FILE)).map_err(|error| match error {
            BlocksError::Damaged { path, what } => BlocksError::NoPlan { path, what },
            other => other,
        });
        Self::of_text(&text?, folder)
    }

    fn of_text(text: &[u8], folder: &Path) -> Result<Self, BlocksError> {
        let none = |what: String| BlocksError::NoPlan { path: folder.join(Self::FILE), what };
        let damaged = || none("is damaged, cut off, or not a plan of this version".into());
        let sealed = || {
            let [before, behind] = Self::CHECKSUM;
            let text = text.strip_suffix(behind)?;
            let (text, digest) = text.split_at_checked(text.len().checked_sub(32)?)?;
            let digest = String::from_utf8(digest.to_vec()).ok()?;
            let text = text.strip_suffix(before)?;
            let digest = Digest::try_from(digest).ok()?;
            digest.is_of(text).then_some(text)
        };
        let text = sealed().ok_or_else(damaged)?;
        let read: Result<Self, _> = serde_json::from_slice(&[text, b"}"].concat());
        let plan = Self {
            folder: folder.into(),
            ..read.map_err(|error| none(format!("is not a plan of this version ({error})")))?
        };
        if plan.version != Self::VERSION {
            let (theirs, ours) = (&plan.version, Self::VERSION);
            return Err(none(format!("was made by walpha {theirs}, and this is {ours}")));
        }
        if !plan.fits() {
            return Err(none("contradicts itself".into()));
        }
        Ok(Self { digest: plan.computed_digest(), ..plan })
    }

    /// Whether the job can be done in blocks, and the blocks are in the volume.
    fn fits(&self) -> bool {
        let dims = self.job.dims.xyz();
        let is_inside = |BlockPlan { part: SampleBox { first, size }, .. }: &BlockPlan| {
            (0..3).all(|k| {
                size[k] > 0 && first[k].checked_add(size[k]).is_some_and(|end| end <= dims[k])
            })
        };
        self.job.check().is_ok()
            && (1..=MAX_BLOCKS).contains(&self.blocks.len())
            && self.blocks.iter().all(is_inside)
            && self.survey.first < self.job.dims.samples() as u64
            && self.kept.iter().all(|kept| [SUMS, SMOOTHED].contains(&&*kept.name))
    }

    /// The folder of the plan.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// A text that identifies the plan. It depends neither on its folder nor on the times of the input files.
    pub fn digest(&self) -> String {
        self.digest.to_string()
    }

    fn computed_digest(&self) -> Digest {
        let timeless = Self { stamp: Stamp::default(), ..self.clone() };
        Digest::of(&serde_json::to_vec(&timeless).expect("it has no maps"))
    }

    /// The file of a block.
    pub fn block_file(&self, block: usize) -> PathBuf {
        self.folder.join(format!("block-{block:05}.walpha"))
    }

    /// The formula that computes weights from differences, if they depend on these.
    pub(super) fn shares(&self) -> Result<Option<Shares>, PointsError> {
        let weighting = self.job.weighting();
        if !weighting.needs_differences() {
            return Ok(None);
        }
        weighting.shares(&self.survey.differences, self.job.alpha()).map(Some)
    }

    /// The weight ω of a point.
    pub(super) fn weight(&self, shares: Option<Shares>, difference: f64) -> f64 {
        match (shares, self.job.weighting()) {
            (Some(shares), _) => shares.of(difference),
            (None, Weighting::Common(weight)) => weight,
            (None, _) => 0.0,
        }
    }

    /// The largest distance, in samples along x, y and z, between a simplex and the points that decide on it.
    pub(super) fn margin(&self) -> Result<[usize; 3], BlocksError> {
        let (shares, differences) = (self.shares()?, &self.survey.differences);
        let weights = [differences.min, differences.max].map(|l| self.weight(shares, l));
        let radius = |weight: f64| self.job.recipe.balls.radius(self.job.alpha(), weight);
        let largest = weights.map(radius).into_iter().fold(0.0, f64::max);
        // This is rounded up by more than all rounding errors before it.
        Ok(self.job.reach(2.0 * largest * (1.0 + 1e-9)).map(|samples| samples.saturating_add(1)))
    }

    /// The α of the shape and its weights.
    pub fn alpha(&self) -> Alpha {
        self.job.alpha()
    }
}

/// The default memory limit of blocks, in bytes.
pub(super) const DEFAULT_MEMORY: u64 = 2 << 30;
/// The number of bytes for each sample of a tile, of which each thread has one.
pub(super) const TILE_SAMPLE: u64 = 48;
/// The largest number of blocks of a plan.
pub(super) const MAX_BLOCKS: usize = 1 << 16;

/// Boxes of bricks with the numbers of their points.
pub(super) struct Boxes<'a> {
    pub counts: &'a [u32],
    pub bricks: [usize; 3],
}

impl Boxes<'_> {
    /// The number of points of a box.
    pub(super) fn points(&self, part: &SampleBox) -> u64 {
        let mut points = 0;
        self.rows(part, |_, row| points += row.iter().map(|&n| u64::from(n)).sum::<u64>());
        points
    }

    fn rows(&self, part: &SampleBox, mut visit: impl FnMut([usize; 2], &[u32])) {
        let [cx, cy, _] = self.bricks;
        for z in part.first[2]..part.first[2] + part.size[2] {
            for y in part.first[1]..part.first[1] + part.size[1] {
                let from = (z * cy + y) * cx + part.first[0];
                visit([y - part.first[1], z - part.first[2]], &self.counts[from..][..part.size[0]]);
            }
        }
    }

    /// Cuts all bricks into `blocks` boxes with about equal numbers of points, each across its longest side. There are fewer if a
    /// box is a single brick. O(bricks log boxes).
    fn cut(&self, blocks: usize) -> Vec<SampleBox> {
        let mut pending = vec![(SampleBox::whole(self.bricks), blocks)];
        let mut cut = Vec::new();
        while let Some((part, blocks)) = pending.pop() {
            // Of equal sides the last is taken, which is the slowest in memory.
            let axis = (0..3).max_by_key(|&k| part.size[k]).unwrap_or(2);
            if blocks <= 1 || part.size[axis] == 1 {
                cut.push(part);
                continue;
            }
            let mut planes = vec![0u64; part.size[axis]];
            self.rows(&part, |[y, z], row| match axis {
                0 => planes.iter_mut().zip(row).for_each(|(plane, &n)| *plane += u64::from(n)),
                _ => planes[[0, y, z][axis]] += row.iter().map(|&n| u64::from(n)).sum::<u64>(),
            });
            let left = blocks / 2;
            let wanted = planes.iter().sum::<u64>() * left as u64 / blocks as u64;
            let mut so_far = 0;
            let over = planes.iter().position(|&n| {
                so_far += n;
                so_far > wanted
            });
            let at = over.unwrap_or(0).clamp(1, part.size[axis] - 1);
            let (mut low, mut high) = (part, part);
            low.size[axis] = at;
            high.first[axis] += at;
            high.size[axis] -= at;
            // The high part is pushed first, so that blocks are numbered from low to high.
            pending.extend([(high, blocks - left), (low, left)]);
        }
        cut
    }

    /// The requested number of boxes, or the smallest number that respects the memory limit of each process and gives each of its
    /// threads a box; with the numbers of points in and around each.
    pub(super) fn planned(
        &self,
        cutting: Cutting,
        margin: [usize; 3],
        tile: u64,
        processes: usize,
    ) -> Result<Vec<(SampleBox, u64)>, ShapeError> {
        let with_halo = |blocks: usize| -> Vec<(SampleBox, u64)> {
            let around = |part: &SampleBox| self.points(&part.grown(margin, self.bricks));
            self.cut(blocks).into_iter().map(|part| (part, around(&part))).collect()
        };
        if let Some(blocks) = cutting.blocks {
            return Ok(with_halo(blocks.max(1)));
        }
        let threads = rayon::current_num_threads() as u64;
        let asked = cutting.memory.unwrap_or(DEFAULT_MEMORY);
        let needs = |largest: u64| {
            let tiles = TILE_SAMPLE * tile;
            memory::resident_bytes().unwrap_or(0) + threads * (tiles + AT_WORK * largest)
        };
        let mut least = PlanError::new(asked, u64::MAX, 1);
        let mut blocks = processes * threads as usize;
        while blocks <= MAX_BLOCKS {
            let cut = with_halo(blocks);
            let needed = needs(cut.iter().map(|(_, points)| *points).max().unwrap_or(0));
            if needed <= asked {
                return Ok(cut);
            }
            if needed < least.needed {
                least = PlanError::new(asked, needed, blocks);
            } else if cut.len() < blocks / 2 {
                break;
            }
            blocks *= 2;
        }
        Err(ShapeError::Plan(least))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Alone;
    use super::*;
    use crate::pipeline::AlphaRule;

    /// A plan whose digest is correct is still checked for its content.
    #[test]
    fn plans_that_verify_are_looked_at_still() {
        let folder = tempfile::tempdir().unwrap();
        let job = Job::new("sample:phantom@12", Recipe::new()).unwrap();
        let plan = Plan::make(job, Cutting::default().blocks(2), folder.path(), &Alone).unwrap();
        let read = Plan::of_text(&plan.text(), folder.path()).unwrap();
        assert_eq!((&read, read.digest()), (&plan, plan.digest()));
        let refused = |change: fn(&mut Plan), why: &str| {
            let mut other = plan.clone();
            change(&mut other);
            let error = Plan::of_text(&other.text(), folder.path()).unwrap_err();
            assert!(matches!(error, BlocksError::NoPlan { .. }), "{error}");
            assert!(error.to_string().contains(why), "{error}");
        };
        refused(|plan| plan.version = "0.1.0".into(), "was made by walpha 0.1.0, and this is");
        refused(|plan| plan.blocks[1].part.size[0] += 1, "contradicts itself");
        refused(|plan| plan.blocks[0].part.first[2] = usize::MAX, "contradicts itself");
        refused(|plan| plan.blocks.clear(), "contradicts itself");
        refused(|plan| plan.job.recipe.alpha = AlphaRule::Auto, "contradicts itself");
        refused(|plan| plan.survey.first = 12 * 12 * 12, "contradicts itself");
    }

    #[test]
    fn boxes_share_the_points() {
        let bricks = [5, 4, 7];
        let counts: Vec<u32> = (0..140).map(|i| if i % 3 == 0 { i % 50 } else { 0 }).collect();
        let boxes = Boxes { counts: &counts, bricks };
        for blocks in [1, 2, 5, 64, 1000] {
            let cut = boxes.cut(blocks);
            assert!(cut.len() <= blocks && (blocks > 64 || cut.len() * 2 > blocks), "{blocks}");
            assert_eq!(cut.iter().map(SampleBox::samples).sum::<usize>(), 140);
            let points: u64 = cut.iter().map(|part| boxes.points(part)).sum();
            assert_eq!(points, counts.iter().map(|&n| u64::from(n)).sum::<u64>());
        }
    }
}
