use std::fmt::{self, Display};
use std::io::ErrorKind;
use std::path::PathBuf;

use walpha_base::Cancelled;
use walpha_base::advice::{Advice, Advise, wrapped};
use walpha_base::memory::NoMemory;
use walpha_base::shown::shown;

use crate::export::TargetError;
use crate::pipeline::PipelineError;
use walpha_points::PointsError;
use walpha_points::haar::HaarError;
use walpha_shape::ShapeError;
use walpha_volume::VolumeError;

/// A file of a plan that does not verify.
#[derive(Clone, Debug, PartialEq, Eq)]
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

/// Why work in blocks cannot be done.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BlocksError {
    /// The volume cannot be read.
    #[error(transparent)]
    Volume(#[from] VolumeError),
    /// The wavelet stage.
    #[error(transparent)]
    Haar(#[from] HaarError),
    /// Selection or weights.
    #[error(transparent)]
    Points(#[from] PointsError),
    /// α.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// The shape.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// A file cannot be written.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Not enough memory.
    #[error(transparent)]
    Memory(#[from] NoMemory),
    /// A file of the plan's folder cannot be read.
    #[error("cannot read {}: {source}", shown(path))]
    Io {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// A folder cannot be written.
    #[error("cannot write {}: {source}", shown(path))]
    Written {
        /// The folder.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// A file of the plan's folder is not what it should be.
    #[error("{}: {what}", shown(path))]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The problem.
        what: String,
    },
    /// There is no plan that can be used.
    #[error("{}: {what}", shown(path))]
    NoPlan {
        /// Its file.
        path: PathBuf,
        /// The problem.
        what: String,
    },
    /// A block was made by another plan.
    #[error("{} belongs to another plan", shown(path))]
    OtherPlan {
        /// Its file.
        path: PathBuf,
    },
    /// Blocks are not there yet.
    #[error("{} of {all} blocks are missing: {}", missing.len(), first(missing))]
    Missing {
        /// The missing blocks.
        missing: Vec<usize>,
        /// Number of blocks of the plan.
        all: usize,
    },
    /// There is no such block.
    #[error("there is no block {index}: the plan has {count}, from 0 to {}", count - 1)]
    NoBlock {
        /// The one asked for.
        index: usize,
        /// Number of blocks.
        count: usize,
    },
    /// Files do not verify.
    #[error("{} in {}: {}", number(findings.len(), "file does", "files do"), shown(folder), listed(findings))]
    Unsound {
        /// The folder of the plan.
        folder: PathBuf,
        /// Which, and why.
        findings: Vec<Finding>,
    },
    /// The input is not what it was when the plan was made.
    #[error("{input} has changed since it was planned: {what}")]
    Changed {
        /// The input of the plan.
        input: String,
        /// The difference.
        what: String,
    },
    /// What takes the whole volume or all points at once.
    #[error("{what} is not local, so that it cannot be computed in blocks")]
    NotLocal {
        /// The option or method.
        what: String,
        /// The advice.
        next: &'static str,
    },
    /// More than one file can hold.
    #[error("{what} pass 32-bit indices, so that they fit no single file")]
    TooLarge {
        /// The things counted.
        what: String,
    },
}

/// The first few of a list.
fn first(numbers: &[usize]) -> String {
    const SHOWN: usize = 20;
    let shown: Vec<String> = numbers.iter().take(SHOWN).map(usize::to_string).collect();
    let more = if numbers.len() > SHOWN { ", …" } else { "" };
    shown.join(", ") + more
}

/// A few findings in one line.
fn listed(findings: &[Finding]) -> String {
    const SHOWN: usize = 5;
    let shown: Vec<String> = findings.iter().take(SHOWN).map(Finding::to_string).collect();
    let more = if findings.len() > SHOWN { ", …" } else { "" };
    shown.join(", ") + more
}

/// A number of files, and that they do not verify.
fn number(count: usize, one: &str, many: &str) -> String {
    format!("{count} {} not verify", if count == 1 { one } else { many })
}

impl BlocksError {
    pub(super) fn changed(input: &str, what: String) -> Self {
        Self::Changed { input: input.to_owned(), what }
    }

    pub(super) fn not_local(what: &str, next: &'static str) -> Self {
        Self::NotLocal { what: what.to_owned(), next }
    }
}

impl Advise for BlocksError {
    wrapped!(Volume, Haar, Points, Pipeline, Shape, Target, Cancelled, Memory; Io { source }, Written { source });

    fn advice(&self) -> Option<Advice> {
        let advice = match self {
            Self::Io { .. } => "name a folder that `walpha blocks plan` made",
            Self::Written { source, .. } if source.kind() == ErrorKind::AlreadyExists => {
                "remove it, or name another"
            }
            Self::NoPlan { .. } => {
                "plan again, by `walpha blocks plan` or the command that was interrupted"
            }
            Self::Damaged { .. } | Self::OtherPlan { .. } | Self::Unsound { .. } => {
                "compute it again by `walpha blocks run`, then merge again"
            }
            Self::Missing { .. } => "run these, then merge again",
            Self::Changed { .. } => {
                "plan again: of `walpha shape`, remove the folder `.blocks` beside the output first"
            }
            Self::NotLocal { next, .. } => next,
            Self::TooLarge { .. } => "write .pvtu or .pvtp",
            _ => return self.wrapped()?.advice(),
        };
        Some(advice.into())
    }
}
