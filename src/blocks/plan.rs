use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::cut::Boxes;
use super::field::Truncated;
use super::file::{numbers, read_file};
use super::survey::{Survey, Surveyed, survey};
use super::{Alone, BlocksError, Field, Job, Part, Team};
use crate::Weighting;
use crate::export::Target;
use crate::points::{PointsError, Shares};
use crate::setters::setters;
use crate::shape::{Alpha, Balls};
use crate::volume::{Dims, Dtype, RawLayout, ReadOptions, Source};

/// How a job is cut into blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Cutting {
    /// Into so many blocks; fewer where there are fewer bricks with points.
    pub blocks: Option<usize>,
    /// Bytes of memory that all blocks at work keep to, as many as there are threads.
    pub memory: Option<u64>,
}

impl Cutting {
    setters! { blocks: Option<usize>, memory: Option<u64> }
}

/// All that a block needs to know of the others: the job, the numbers of the whole volume, and where the
/// blocks are. It is kept in a folder, to which the blocks are written, too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Plan {
    /// What made it.
    version: String,
    /// What is to be computed.
    pub job: Job,
    /// How it was to be cut.
    pub cutting: Cutting,
    /// The numbers of the whole volume.
    pub survey: Survey,
    /// The blocks.
    pub blocks: Vec<BlockPlan>,
    #[serde(skip)]
    pub(super) folder: PathBuf,
    #[serde(skip)]
    pub(super) digest: String,
}

/// A block: a box of the volume, whose points are its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BlockPlan {
    /// Its samples.
    pub part: Part,
    /// Its points.
    pub points: u64,
    /// The points around it that it may need, counted by bricks.
    pub halo: u64,
}

impl Plan {
    pub(super) const FILE: &str = "plan.json";
    pub(super) const SUMS: &str = "sums.f64";
    /// The truncated volume, of the standard decomposition.
    pub(super) const SMOOTHED: &str = "truncated.f32";

    /// Surveys the volume of a job, cuts it, and writes the plan into a folder, which is there. Reads
    /// the volume five or six times, a tile for each thread in memory.
    ///
    /// # Errors
    /// What a stage refuses; what is not local ([`Job::check`]); a folder that cannot be written to.
    pub fn make(job: Job, cutting: Cutting, folder: &Path) -> Result<Self, BlocksError> {
        Self::make_with(job, cutting, folder, &Alone)
    }

    /// The same as one of a team: each process surveys its share of the volume, the first writes the plan, and
    /// all get it. Memory that blocks keep to is that of one process.
    ///
    /// # Errors
    /// As [`Plan::make`]. The others of the team would wait for a process that ends with an error.
    pub fn make_with(
        job: Job,
        cutting: Cutting,
        folder: &Path,
        team: &dyn Team,
    ) -> Result<Self, BlocksError> {
        job.check()?;
        let mut field = Field::open(&job)?;
        let surveyed = survey(&job, &mut field, folder, team)?;
        let plan = if team.is_first() {
            Some(Self::cut(job, cutting, folder, &field, surveyed, team.size())?)
        } else {
            None
        };
        Self::told(plan, folder, team)
    }

    /// Gives to all what the first process has.
    pub(super) fn told(
        first: Option<Self>,
        folder: &Path,
        team: &dyn Team,
    ) -> Result<Self, BlocksError> {
        if team.size() == 1 {
            return Ok(first.expect("the first process has it"));
        }
        let text = first.map(|plan| serde_json::to_vec(&plan).expect("it has no maps"));
        Self::of_text(&team.told(text), folder)
    }

    /// Cuts a surveyed volume, and writes the plan.
    fn cut(
        job: Job,
        cutting: Cutting,
        folder: &Path,
        field: &Field,
        Surveyed { survey, truncated, counts }: Surveyed,
        processes: usize,
    ) -> Result<Self, BlocksError> {
        let boxes = Boxes { counts: &counts, bricks: field.bricks.count() };
        let side = field.bricks.side();
        let tile = field.tile().iter().product::<usize>() as u64;
        let mut plan = Self {
            version: env!("CARGO_PKG_VERSION").into(),
            job,
            cutting,
            survey,
            blocks: Vec::new(),
            folder: folder.into(),
            digest: String::new(),
        };
        let margin = plan.margin()?.map(|samples| samples.div_ceil(side));
        let cut = boxes.planned(cutting, &plan.job, margin, tile, processes)?;
        let of_bricks = |(part, halo): (Part, u64)| {
            let points = boxes.points(&part);
            let whole = Part::whole(field.dims);
            let part =
                Part { first: part.first.map(|i| i * side), size: part.size.map(|n| n * side) };
            BlockPlan { part: part.common(&whole), points, halo: halo - points }
        };
        plan.blocks = cut.into_iter().map(of_bricks).collect();
        plan.digest = plan.computed_digest();
        plan.write(&truncated)?;
        Ok(plan)
    }

    fn write(&self, truncated: &Truncated) -> Result<(), BlocksError> {
        let put = |name: &str, bytes: &[u8]| {
            Target::open(&self.folder.join(name))?.write(|out| out.write_all(bytes))
        };
        if let Truncated::Bricks { sums, .. } = truncated {
            let bytes: Vec<u8> = sums.iter().flat_map(|sum| sum.to_le_bytes()).collect();
            put(Self::SUMS, &bytes)?;
        }
        let text = serde_json::to_string_pretty(self).expect("it has no maps");
        put(Self::FILE, text.as_bytes())?;
        Ok(())
    }

    /// Opens the plan in a folder.
    ///
    /// # Errors
    /// There is none, or it cannot be read.
    pub fn open(folder: &Path) -> Result<Self, BlocksError> {
        Self::of_text(&read_file(&folder.join(Self::FILE))?, folder)
    }

    fn of_text(text: &[u8], folder: &Path) -> Result<Self, BlocksError> {
        let read: Result<Self, _> = serde_json::from_slice(text);
        let damaged = |error: serde_json::Error| BlocksError::Damaged {
            path: folder.join(Self::FILE),
            what: format!("is not a plan of this version of walpha ({error})"),
        };
        let plan = Self { folder: folder.into(), ..read.map_err(damaged)? };
        Ok(Self { digest: plan.computed_digest(), ..plan })
    }

    /// The folder it is in.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Identifies this plan.
    pub fn digest(&self) -> &str {
        &self.digest
    }

    /// FNV-1a of its text (Fowler, Noll and Vo, RFC 9923), 64 bits.
    fn computed_digest(&self) -> String {
        let text = serde_json::to_vec(self).expect("it has no maps");
        let hash = text.iter().fold(0xcbf2_9ce4_8422_2325u64, |hash, &byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        format!("{hash:016x}")
    }

    /// The file of a block.
    pub fn block_file(&self, block: usize) -> PathBuf {
        self.folder.join(format!("block-{block:05}.walpha"))
    }

    /// The truncated volume.
    pub(super) fn truncated(&self) -> Result<Truncated, BlocksError> {
        if let Some(cut) = self.survey.cut {
            let path = self.folder.join(Self::SUMS);
            let sums = numbers(&read_file(&path)?);
            let sums = sums.ok_or(BlocksError::Damaged { path, what: "is cut off".into() })?;
            Ok(Truncated::Bricks { cut, sums })
        } else if self.survey.truncation.epsilon > 0.0 {
            Ok(Truncated::File(Self::smoothed(&self.folder, self.job.dims)?))
        } else {
            Ok(Truncated::Same)
        }
    }

    /// The truncated volume that a plan of the standard decomposition left in its folder.
    pub(super) fn smoothed(folder: &Path, dims: Dims) -> Result<Source, BlocksError> {
        let path = folder.join(Self::SMOOTHED);
        let raw = Some(RawLayout::new(dims, Dtype::F32));
        Ok(Source::open(&path.to_string_lossy(), &ReadOptions { raw, ..ReadOptions::default() })?)
    }

    /// How weights come from differences, where they do.
    pub(super) fn shares(&self) -> Result<Option<Shares>, PointsError> {
        let weighting = self.job.weighting;
        if !weighting.needs_differences() {
            return Ok(None);
        }
        weighting.shares(&self.survey.differences, self.job.squared()).map(Some)
    }

    /// The weight ω of a point.
    pub(super) fn weight(&self, shares: Option<Shares>, difference: f64) -> f64 {
        match (shares, self.job.weighting) {
            (Some(shares), _) => shares.of(difference),
            (None, Weighting::Common(weight)) => weight,
            (None, _) => 0.0,
        }
    }

    /// How far, in samples along x, y and z, what decides a simplex is from its vertices.
    pub(super) fn margin(&self) -> Result<[usize; 3], BlocksError> {
        let (shares, differences) = (self.shares()?, &self.survey.differences);
        let weights = [differences.min, differences.max].map(|l| self.weight(shares, l));
        let radius = |weight: f64| match self.job.balls {
            Balls::Power => (self.job.alpha + weight).max(0.0).sqrt(),
            Balls::Radius => (self.job.alpha + weight).abs(),
        };
        let largest = weights.map(radius).into_iter().fold(0.0, f64::max);
        // Rounded up by more than all roundings on the way.
        Ok(self.job.reach(2.0 * largest * (1.0 + 1e-9)).map(|samples| samples + 1))
    }

    /// α, for weights and reports.
    pub fn alpha(&self) -> Alpha {
        self.job.squared()
    }

    /// The blocks that are not there, or belong to another plan.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn missing(&self) -> Result<Vec<usize>, BlocksError> {
        let mut missing = Vec::new();
        for block in 0..self.blocks.len() {
            match super::file::BlockFile::open(self, block) {
                Ok(_) => {}
                Err(BlocksError::OtherPlan { .. } | BlocksError::Damaged { .. }) => {
                    missing.push(block);
                }
                Err(BlocksError::Io { source, .. })
                    if source.kind() == std::io::ErrorKind::NotFound =>
                {
                    missing.push(block);
                }
                Err(error) => return Err(error),
            }
        }
        Ok(missing)
    }
}
