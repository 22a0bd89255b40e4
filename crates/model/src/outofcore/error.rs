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
    /// What is wrong, in words that follow the name of the file.
    pub what: String,
}

impl Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.path.file_name().map_or(self.path.as_path(), |name| name.as_ref());
        write!(f, "{} {}", shown(name), self.what)
    }
}

/// An error of work in blocks.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BlocksError {
    /// The volume cannot be read.
    #[error(transparent)]
    Volume(#[from] VolumeError),
    /// An error of the wavelet stage.
    #[error(transparent)]
    Haar(#[from] HaarError),
    /// An error of the selection of points or of their weights.
    #[error(transparent)]
    Points(#[from] PointsError),
    /// An error of α.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// An error of the computation of the shape.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// A file cannot be written.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// There is not enough memory.
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
    /// There is no usable plan.
    #[error("{}: {what}", shown(path))]
    NoPlan {
        /// The file of the plan.
        path: PathBuf,
        /// The problem.
        what: String,
    },
    /// A block was made by another plan.
    #[error("{} belongs to another plan", shown(path))]
    OtherPlan {
        /// The file of the block.
        path: PathBuf,
    },
    /// Some blocks have not been computed yet.
    #[error("{} of {all} blocks are missing: {}", missing.len(), first(missing))]
    Missing {
        /// The missing blocks.
        missing: Vec<usize>,
        /// The number of blocks of the plan.
        all: usize,
    },
    /// There is no such block.
    #[error("there is no block {index}: the plan has {count}, from 0 to {}", count - 1)]
    NoBlock {
        /// The number of the block asked for.
        index: usize,
        /// The number of blocks.
        count: usize,
    },
    /// Files do not verify.
    #[error("{} in {}: {}", number(findings.len(), "file does", "files do"), shown(folder), listed(findings))]
    Unsound {
        /// The folder of the plan.
        folder: PathBuf,
        /// The files that do not verify, and why.
        findings: Vec<Finding>,
    },
    /// The input has changed since the plan was made.
    #[error("{input} has changed since it was planned: {what}")]
    Changed {
        /// The input of the plan.
        input: String,
        /// The difference.
        what: String,
    },
    /// An option or method needs the whole volume or all points at once.
    #[error("{what} is not possible in blocks")]
    NotLocal {
        /// The option or method.
        what: String,
        /// The advice.
        next: &'static str,
    },
    /// The shape is too large for a single file.
    #[error("{what} exceed 32-bit indices, so they do not fit in a single file")]
    TooLarge {
        /// The items that are too many.
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

/// States that a number of files do not verify.
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
