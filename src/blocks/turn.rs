//! All blocks on one machine, several at a time, from file to file.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::{BlocksError, Cutting, Job, Plan, run};
use crate::progress::{Piece, Share, within};

impl Plan {
    /// The plan of a job in a folder, if it is there; else makes one. So work that was interrupted goes on
    /// where it was.
    ///
    /// # Errors
    /// As [`Plan::make`].
    pub fn resume(job: Job, cutting: Cutting, folder: &Path) -> Result<Self, BlocksError> {
        match Self::open(folder) {
            Ok(plan) if plan.job == job && plan.cutting == cutting => Ok(plan),
            _ => Self::make(job, cutting, folder),
        }
    }

    /// Removes the plan and its blocks, and the folder if nothing else is in it.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn remove(self) -> Result<(), BlocksError> {
        let blocks = (0..self.blocks.len()).map(|block| self.block_file(block));
        for path in blocks.chain([Self::SUMS, Self::FILE].map(|name| self.folder.join(name))) {
            match std::fs::remove_file(&path) {
                Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
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

/// Runs some blocks of a plan, as many at a time as there are threads. Those that are there are left alone.
///
/// # Errors
/// As [`run()`], of the first block that fails; those that are done stay.
pub fn run_all(plan: &Plan, blocks: &[usize]) -> Result<(), BlocksError> {
    let size =
        |&block: &usize| plan.blocks.get(block).map_or(0, |planned| planned.points + planned.halo);
    let work = Piece::new(blocks.iter().map(size).sum());
    let next = AtomicUsize::new(0);
    let failed = Mutex::new(None);
    let is_over = || failed.lock().is_ok_and(|failed| failed.is_some());
    // Threads of their own: one of rayon's that waits within a block might begin with another.
    std::thread::scope(|scope| {
        for _ in 0..rayon::current_num_threads().min(blocks.len()) {
            scope.spawn(|| {
                while let Some(block) = blocks.get(next.fetch_add(1, Ordering::Relaxed)) {
                    match within(Share::NONE, || run(plan, *block)) {
                        Ok(()) => work.add(size(block)),
                        Err(error) => {
                            failed
                                .lock()
                                .unwrap_or_else(std::sync::PoisonError::into_inner)
                                .get_or_insert(error);
                        }
                    }
                    if is_over() {
                        break;
                    }
                }
            });
        }
    });
    failed.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).map_or(Ok(()), Err)
}
