//! Verifies, restores, resumes and removes the files of a plan.

use std::io;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use walpha_base::Monitor;
use walpha_base::parallel::prelude::*;
use walpha_files::remove_parts;

use super::block_file::BlockFile;
use super::brick_digests::ReadDigests;
use super::bytes::{numbers, read_file};
use super::field::{Field, Passes, Truncated};
use super::job::Stamp;
use super::truncate::{DigestedFile, SMOOTHED, SUMS, smoothed, truncated};
use super::{Alone, BlocksError, Cutting, Finding, Job, Plan, SampleBox, Team};

/// The result of verifying the files of a plan.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Checked {
    /// The blocks that have not been computed yet.
    pub missing: Vec<usize>,
    /// The files that do not verify.
    pub findings: Vec<Finding>,
}

impl Checked {
    /// Whether all files exist and verify.
    pub fn is_whole(&self) -> bool {
        self.missing.is_empty() && self.findings.is_empty()
    }
}

impl Plan {
    /// Reads all files of the plan, and verifies them: their digests, the plan and block that they belong to, and the version of
    /// the program. O(bytes on disk), several blocks at a time.
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

    /// Refuses missing blocks and those that do not verify, and names all of them. Reads all blocks.
    ///
    /// # Errors
    /// There are such blocks, or a file cannot be read.
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

    /// The blocks that must be computed: those that are missing, and those that do not verify. Reads all existing blocks.
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

fn remove_if_there(path: &Path) -> io::Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// The finding for a file that does not verify; other errors are passed on.
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
    /// Opens the truncated volume, of which a part will be read.
    ///
    /// # Errors
    /// The file does not exist or does not verify. Samples in a file can be verified only after they are read.
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

    /// Reads the files beside the plan, and verifies them.
    ///
    /// # Errors
    /// One does not verify.
    pub(super) fn verify_kept(&self) -> Result<(), BlocksError> {
        self.kept.iter().try_for_each(|kept| kept.verify(&self.folder))
    }

    /// Recreates the files beside the plan that do not verify: the sums, or the truncated volume. Reads these files, and the
    /// volume a few times if necessary.
    ///
    /// # Errors
    /// The errors of planning; the input has changed.
    pub fn restore(&self) -> Result<(), BlocksError> {
        // If several threads miss it, only one recreates it.
        static ONE: Mutex<()> = Mutex::new(());
        let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
        if self.verify_kept().is_ok() {
            return Ok(());
        }
        let mut field = Field::open(&self.job, None)?;
        (field.range, field.least) = (self.survey.range, self.survey.least);
        let tiles = SampleBox::whole(field.dims).tiles(field.tile());
        let monitor = &*Monitor::current();
        let mut passes = Passes::new(&Alone, &tiles, monitor);
        let (_, truncated, mut made) = truncated(&self.job, &field, &self.folder, &mut passes)?;
        if let Truncated::Bricks { sums, .. } = &truncated {
            made.push(DigestedFile::write_sums(sums, &self.folder)?);
        }
        if made != self.kept {
            let what = "its truncated volume is different".to_owned();
            return Err(BlocksError::changed(&self.job.input, what));
        }
        self.verify_kept()
    }
}

impl Plan {
    /// Opens the plan of a job in a folder, or makes one if it does not exist. Interrupted work is resumed in this way, also by a
    /// team of another size.
    ///
    /// # Errors
    /// See [`Plan::make`].
    pub fn resume(
        job: Job,
        cutting: Cutting,
        folder: impl AsRef<Path>,
        team: &dyn Team,
    ) -> Result<Self, BlocksError> {
        let folder = folder.as_ref();
        // If the files of the input look different, it is planned again. If its content is unchanged, the new plan is equal, and
        // the existing blocks belong to it.
        let is_same = |plan: &Self| {
            plan.job == job && plan.cutting == cutting && plan.stamp == Stamp::of(&job)
        };
        let there = team.is_first().then(|| Self::open(folder).ok().filter(is_same));
        if team.broadcast(there.as_ref().map(Option::is_some)) {
            Self::broadcast(there.flatten(), folder, team)
        } else {
            Self::make(job, cutting, folder, team)
        }
    }

    /// Whether a folder holds what interrupted planning leaves, and nothing else.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn is_unfinished(folder: &Path) -> io::Result<bool> {
        let mut names = Vec::new();
        for entry in std::fs::read_dir(folder)? {
            names.push(entry?.file_name());
        }
        Ok(!names.is_empty() && names.iter().all(|name| name == SUMS || name == SMOOTHED))
    }

    /// Removes what interrupted planning leaves.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn remove_unfinished(folder: &Path) -> io::Result<()> {
        [SUMS, SMOOTHED].iter().try_for_each(|name| remove_if_there(&folder.join(name)))
    }

    /// Removes the plan, its blocks and what killed processes left of these, and the folder if it is then empty.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn remove(self) -> Result<(), BlocksError> {
        let blocks = (0..self.blocks.len()).map(|block| self.block_file(block));
        let names = [SUMS, SMOOTHED, Self::FILE].map(|name| self.folder.join(name));
        for path in blocks.chain(names) {
            remove_if_there(&path).map_err(|source| BlocksError::Io { path, source })?;
        }
        let io = |source| BlocksError::Io { path: self.folder.clone(), source };
        remove_parts(&self.folder).map_err(io)?;
        // The folder stays if it contains other files.
        let _ = std::fs::remove_dir(&self.folder);
        Ok(())
    }
}
