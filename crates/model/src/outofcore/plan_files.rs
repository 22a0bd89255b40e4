//! The files of a plan: verifying, restoring, resuming and removing them.

use std::io;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;
use walpha_base::Monitor;

use super::block_file::BlockFile;
use super::brick_digests::ReadDigests;
use super::bytes::{numbers, read_file};
use super::field::{Field, Passes, Truncated};
use super::job::Stamp;
use super::truncate::{DigestedFile, SMOOTHED, SUMS, smoothed, truncated};
use super::{Alone, BlocksError, Cutting, Finding, Job, Plan, SampleBox, Team};

/// Result of verifying the files of a plan.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Checked {
    /// Blocks that are not there yet.
    pub missing: Vec<usize>,
    /// Files that do not verify.
    pub findings: Vec<Finding>,
}

impl Checked {
    /// Whether all is there, as it was written.
    pub fn is_whole(&self) -> bool {
        self.missing.is_empty() && self.findings.is_empty()
    }
}

impl Plan {
    /// Reads all files of the plan, and looks whether they are what was written: their digests, to which
    /// plan and block they belong, and the version of the program. O(bytes on disk), several blocks at a time.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn check(&self) -> Result<Checked, BlocksError> {
        let mut checked = self.check_blocks()?;
        for kept in &self.kept {
            checked.findings.extend(finding(kept.verify(&self.folder))?);
        }
        Ok(checked)
    }

    /// Like [`check`](Self::check), for the blocks alone, which are all that merging needs.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn check_blocks(&self) -> Result<Checked, BlocksError> {
        let verify = |block| BlockFile::open(self, block).and_then(|file| file.verify());
        let found: Vec<Result<(), BlocksError>> =
            (0..self.blocks.len()).into_par_iter().map(verify).collect();
        let mut checked = Checked::default();
        for (block, found) in found.into_iter().enumerate() {
            match found {
                Err(BlocksError::Io { source, .. }) if source.kind() == io::ErrorKind::NotFound => {
                    checked.missing.push(block);
                }
                other => checked.findings.extend(finding(other)?),
            }
        }
        Ok(checked)
    }

    /// Refuses blocks that are missing or do not verify, and names all of them. Reads all blocks.
    ///
    /// # Errors
    /// There are some; a file cannot be read.
    pub fn verify_blocks(&self) -> Result<(), BlocksError> {
        let Checked { missing, findings } = self.check_blocks()?;
        if !findings.is_empty() {
            return Err(BlocksError::Unsound { folder: self.folder.clone(), findings });
        }
        if !missing.is_empty() {
            return Err(BlocksError::Missing { missing, all: self.blocks.len() });
        }
        Ok(())
    }

    /// The blocks that are to be computed: those that are not there, and those that do not verify. Reads all
    /// that are there.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn missing(&self) -> Result<Vec<usize>, BlocksError> {
        let Checked { mut missing, findings } = self.check_blocks()?;
        let unsound = |block: &usize| {
            let path = self.block_file(*block);
            findings.iter().any(|finding| finding.path == path)
        };
        if !findings.is_empty() {
            missing.extend((0..self.blocks.len()).filter(unsound));
            missing.sort_unstable();
        }
        Ok(missing)
    }
}

/// The problem of a file that does not verify; other errors are passed on.
fn finding(found: Result<(), BlocksError>) -> Result<Option<Finding>, BlocksError> {
    match found {
        Ok(()) => Ok(None),
        Err(BlocksError::Damaged { path, what }) => Ok(Some(Finding { path, what })),
        Err(BlocksError::OtherPlan { path }) => {
            Ok(Some(Finding { path, what: "belongs to another plan".into() }))
        }
        Err(error) => Err(error),
    }
}

impl Plan {
    /// The truncated volume, of which a part will be read.
    ///
    /// # Errors
    /// Its file is not there or does not verify. Of the samples in a file it is known when they were read.
    pub(super) fn truncated(&self, part: &SampleBox) -> Result<Truncated, BlocksError> {
        if let Some(cut) = self.survey.cut {
            let path = self.folder.join(SUMS);
            let damaged =
                || BlocksError::Damaged { path: path.clone(), what: DigestedFile::DAMAGED.into() };
            let bytes = match read_file(&path) {
                Err(BlocksError::Io { source, .. }) if source.kind() == io::ErrorKind::NotFound => {
                    let what = "is not there".into();
                    return Err(BlocksError::Damaged { path, what });
                }
                other => other?,
            };
            let sound = self.kept.iter().any(|kept| kept.digest.is_of(&bytes));
            let bricks = Field::bricks_of(self.job.dims.xyz()).count().iter().product::<usize>();
            let sums = numbers(&bytes).filter(|sums: &Vec<f64>| sound && sums.len() == bricks);
            Ok(Truncated::Bricks { cut, sums: sums.ok_or_else(damaged)? })
        } else if self.survey.truncation.epsilon > 0.0 {
            let source = smoothed(&self.folder, self.job.dims);
            let (source, _) = source.map_err(|error| BlocksError::Damaged {
                path: self.folder.join(SMOOTHED),
                what: format!("cannot be read: {error}"),
            })?;
            let dims = self.job.dims.xyz();
            let digests = ReadDigests::none_of(part, Field::bricks_of(dims).side(), dims);
            Ok(Truncated::File(source, digests))
        } else {
            Ok(Truncated::Same)
        }
    }

    /// Reads the files beside the plan, and looks whether they are what was written.
    ///
    /// # Errors
    /// One is not.
    pub(super) fn verify_kept(&self) -> Result<(), BlocksError> {
        self.kept.iter().try_for_each(|kept| kept.verify(&self.folder))
    }

    /// Makes again what does not verify of the files beside the plan: sums, or the truncated volume. Reads these, and
    /// the volume a few times where that is so.
    ///
    /// # Errors
    /// The errors of planning; the input has changed.
    pub fn restore(&self) -> Result<(), BlocksError> {
        // Of several threads that miss it, one makes it.
        static ONE: Mutex<()> = Mutex::new(());
        let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
        if self.verify_kept().is_ok() {
            return Ok(());
        }
        let mut field = Field::open(&self.job, None)?;
        (field.range, field.least) = (self.survey.range, self.survey.least);
        let tiles = SampleBox::whole(field.dims).tiles(field.tile());
        let monitor = Monitor::noop();
        let mut passes = Passes::new(&Alone, &tiles, &monitor);
        let (_, truncated, mut made) = truncated(&self.job, &field, &self.folder, &mut passes)?;
        if let Truncated::Bricks { sums, .. } = &truncated {
            made.push(DigestedFile::write_sums(sums, &self.folder)?);
        }
        if made != self.kept {
            let what = "its truncated volume is another".to_owned();
            return Err(BlocksError::changed(&self.job.input, what));
        }
        self.verify_kept()
    }
}

impl Plan {
    /// The plan of a job in a folder, if it is there; else makes one. So work that was interrupted goes on
    /// where it was.
    ///
    /// # Errors
    /// The errors of [`Plan::make`].
    pub fn resume(
        job: Job,
        cutting: Cutting,
        folder: impl AsRef<Path>,
    ) -> Result<Self, BlocksError> {
        let folder = folder.as_ref();
        Self::resume_with(job, cutting, folder, &Alone)
    }

    /// [`Plan::resume`] as one of a team, which may be of another size than the one that was interrupted.
    ///
    /// # Errors
    /// As [`Plan::make_with`].
    pub fn resume_with(
        job: Job,
        cutting: Cutting,
        folder: &Path,
        team: &dyn Team,
    ) -> Result<Self, BlocksError> {
        // An input whose files look otherwise is planned again. Where it is what it was, that is the same plan,
        // and the blocks that are there are its.
        let is_same = |plan: &Self| {
            plan.job == job && plan.cutting == cutting && plan.stamp == Stamp::of(&job)
        };
        let there = team.is_first().then(|| Self::open(folder).ok().filter(is_same));
        if team.broadcast(there.as_ref().map(Option::is_some)) {
            Self::broadcast(there.flatten(), folder, team)
        } else {
            Self::make_with(job, cutting, folder, team)
        }
    }

    /// Removes the plan and its blocks, and the folder if nothing else is in it.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn remove(self) -> Result<(), BlocksError> {
        let blocks = (0..self.blocks.len()).map(|block| self.block_file(block));
        let names = [SUMS, SMOOTHED, Self::FILE].map(|name| self.folder.join(name));
        for path in blocks.chain(names) {
            match std::fs::remove_file(&path) {
                Err(source) if source.kind() != io::ErrorKind::NotFound => {
                    return Err(BlocksError::Io { path, source });
                }
                _ => {}
            }
        }
        // It stays if somebody put something there.
        let _ = std::fs::remove_dir(&self.folder);
        Ok(())
    }
}
