//! Whether the files of a plan are what was written.

use std::fmt::{self, Display};
use std::io;
use std::path::PathBuf;

use rayon::prelude::*;
use walpha_base::shown::shown;

use super::file::BlockFile;
use super::{BlocksError, Plan};

/// A file of a plan that does not verify.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Finding {
    /// The file.
    pub path: PathBuf,
    /// What is wrong, as of "block-00001.walpha …".
    pub what: String,
}

impl Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.path.file_name().map_or(self.path.as_path(), |name| name.as_ref());
        write!(f, "{} {}", shown(name), self.what)
    }
}

/// What was found of the files of a plan.
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

    /// The same of the blocks alone: all that merging needs.
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

/// What is wrong with a file; other errors are errors.
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
