//! `walpha shape` in blocks, computed by one process or by all that MPI started.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use walpha_base::memory;
use walpha_base::shown::shown;
use walpha_files::Lock;

use crate::Recipe;
use crate::cli::commands::blocks::{Outputs, job};
use crate::cli::commands::folder;
use crate::cli::options::InputArgs;
use crate::cli::options::global::Global;
use crate::cli::process::errors::{Result, fail};
use crate::cli::process::progress::Progress;
use crate::cli::process::threads;
use crate::cli::report::Report;
use crate::cli::report::offsets::FileOffset;
use crate::export::{NewFolder, Target};
use crate::outofcore::{BlockwiseFormat, Cutting, Job, Merged, Plan, Team, merge, run_missing};
use crate::progress::Stage;

/// The work of a team. The first process reads the command line and sends it to the others.
#[derive(Serialize, Deserialize)]
pub(crate) struct SharedWork {
    job: Job,
    cutting: Cutting,
    /// The folder for unfinished work.
    folder: PathBuf,
    /// The destinations of the outputs with a file for each block.
    pieces: Vec<(BlockwiseFormat, PathBuf)>,
    /// The number of threads of each process.
    threads: u16,
}

impl SharedWork {
    /// The work that the options request, in a [working folder](working_folder).
    pub(crate) fn new(
        input: &InputArgs,
        recipe: Recipe,
        pieces: Vec<(BlockwiseFormat, PathBuf)>,
        folder: PathBuf,
        global: Global,
    ) -> Result<Self> {
        let threads = global.threads.unwrap_or(1);
        let cutting = Cutting::of(&recipe);
        Ok(Self { job: job(input, recipe)?, cutting, folder, pieces, threads })
    }

    /// Does the work as the first process, which also writes the outputs in one file.
    pub(crate) fn lead(
        self,
        outputs: Outputs,
        progress: &mut Progress,
        team: &dyn Team,
    ) -> Result<Report> {
        let working = AtWork::in_folder(&self.folder)?;
        if team.size() > 1 {
            order(team, Some(serde_json::to_string(&self).map_err(io::Error::from)?));
        }
        let Shared { plan, merged, offsets, working } =
            self.share(Some(working), outputs, progress, team)?;
        let mut report = Report::of_blocks(&plan, &merged.expect("the first process merges"));
        report.offsets = offsets;
        working.expect("the first process has it").end()?;
        plan.remove()?;
        Ok(report)
    }

    /// Does the share of this process.
    fn share(
        &self,
        working: Option<AtWork>,
        outputs: Outputs,
        progress: &mut Progress,
        team: &dyn Team,
    ) -> Result<Shared> {
        let plan = progress.stage(Stage::Points, || {
            Plan::resume(self.job.clone(), self.cutting, &self.folder, team)
        });
        if plan.is_err() && working.as_ref().is_some_and(|working| working.new.is_some()) {
            // The error of the plan says more.
            let _ = Plan::remove_unfinished(&self.folder);
        }
        let plan = plan?;
        let working = working.map(AtWork::kept);
        progress.stage(Stage::Shape, || run_missing(&plan, team))?;
        let merge = || team.is_first().then(|| merge(&plan)).transpose();
        let merged = progress.stage(Stage::Shape, merge)?;
        let write = || outputs.write(&plan, merged.as_ref(), team);
        let offsets = progress.stage(Stage::Write, write)?;
        Ok(Shared { plan, merged, offsets, working })
    }
}

/// A working folder that this command created, now or before it was interrupted, while it works there.
struct AtWork {
    lock: Lock,
    new: Option<NewFolder>,
}

impl AtWork {
    /// The file that marks a working folder, and is locked while a process works there.
    const FILE: &str = "shape.lock";

    /// Creates the folder, or resumes work in an existing one. A folder without the mark is refused, as its files could be
    /// replaced.
    fn in_folder(folder: &Path) -> Result<Self> {
        const INSTEAD: &str = "by naming another output";
        let new = folder::make(folder, INSTEAD)?;
        let path = folder.join(Self::FILE);
        let lock = if new.is_some() {
            Lock::make(&path).map(Some)
        } else {
            match Lock::take(&path) {
                // Interrupted planning loses the mark.
                Err(error)
                    if error.kind() == ErrorKind::NotFound && Plan::is_unfinished(folder)? =>
                {
                    Lock::make(&path).map(Some)
                }
                taken => taken,
            }
        };
        let folder = shown(folder);
        match lock {
            Ok(Some(lock)) => Ok(Self { lock, new }),
            Ok(None) => {
                fail!("another walpha shape is at work in {folder}" => "wait for it, or name another output")
            }
            Err(error) if error.kind() == ErrorKind::NotFound => {
                fail!("blocks would be kept in {folder}, a folder that this command did not make" => "name another output, or remove the folder")
            }
            Err(error) => {
                fail!("cannot lock the folder {folder}: {error}" => "choose another {INSTEAD}")
            }
        }
    }

    /// Keeps the folder, so that an interrupted command can resume from it.
    fn kept(mut self) -> Self {
        self.lock.keep();
        if let Some(new) = self.new.take() {
            new.keep();
        }
        self
    }

    /// Leaves the folder and removes the lock.
    fn end(self) -> io::Result<()> {
        self.lock.remove()
    }
}

/// The result of a process.
struct Shared {
    plan: Plan,
    /// The shape, in the first process.
    merged: Option<Merged>,
    /// The offsets that its files in single precision have subtracted.
    offsets: Vec<FileOffset>,
    /// The working folder, in the first process.
    working: Option<AtWork>,
}

fn order(team: &dyn Team, work: Option<String>) {
    team.broadcast(Some(work));
}

/// Does the work that the first process sends, until it [dismisses](dismiss) this process.
pub(crate) fn serve(team: &dyn Team) -> Result<()> {
    while let Some(work) = team.broadcast::<Option<String>>(None) {
        let work: SharedWork = serde_json::from_str(&work).map_err(io::Error::from)?;
        threads::start(Some(work.threads))?;
        let quiet = Global { quiet: true, ..Global::default() };
        let outputs = Outputs { pieces: work.pieces.clone(), whole: Vec::new() };
        work.share(None, outputs, &mut Progress::new(quiet), team)?;
        peak(team);
    }
    Ok(())
}

/// Tells all other processes to end.
pub(crate) fn dismiss(team: &dyn Team) {
    order(team, None);
}

/// The largest peak memory of a process, in bytes. Every process must call this at the end of its work.
pub(crate) fn peak(team: &dyn Team) -> Option<u64> {
    team.reduce(memory::peak_bytes(), |most, other| *most = (*most).max(other))
}

/// The folder for unfinished work. It is next to the first output with a file for each block, `bone.blocks` for `bone.pvtp`, or
/// else next to the first file; without files, it is in the current folder and named after the input. It is removed at the end;
/// after an interruption the same command resumes from it.
pub(crate) fn working_folder(outputs: &[PathBuf], input: &str) -> PathBuf {
    let pieces = outputs.iter().find(|path| BlockwiseFormat::of(path).is_some());
    let file = || outputs.iter().find(|path| *path != Path::new(Target::STDOUT));
    if let Some(first) = pieces.or_else(file) {
        return first.with_extension("blocks");
    }
    let name = Path::new(input.trim_start_matches("sample:")).file_name().unwrap_or_default();
    Path::new(name).with_extension("blocks")
}
