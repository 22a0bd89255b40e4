//! All blocks, several at a time, from file to file: on one machine, or shared by a team.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use walpha_base::Monitor;

use super::stamp::Stamp;
use super::{Alone, BlocksError, Cutting, Job, Plan, Team, run};

impl Plan {
    /// The plan of a job in a folder, if it is there; else makes one. So work that was interrupted goes on
    /// where it was.
    ///
    /// # Errors
    /// As [`Plan::make`].
    pub fn resume(job: Job, cutting: Cutting, folder: &Path) -> Result<Self, BlocksError> {
        Self::resume_with(job, cutting, folder, &Alone, &Monitor::noop())
    }

    /// The same as one of a team, which may be of another size than the one that was interrupted.
    ///
    /// # Errors
    /// As [`Plan::make_with`].
    pub fn resume_with(
        job: Job,
        cutting: Cutting,
        folder: &Path,
        team: &dyn Team,
        monitor: &Monitor,
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
            Self::make_with(job, cutting, folder, team, monitor)
        }
    }

    /// Removes the plan and its blocks, and the folder if nothing else is in it.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn remove(self) -> Result<(), BlocksError> {
        let blocks = (0..self.blocks.len()).map(|block| self.block_file(block));
        let names = [Self::SUMS, Self::SMOOTHED, Self::FILE].map(|name| self.folder.join(name));
        for path in blocks.chain(names) {
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
/// As [`run()`], of the first block that fails; [`BlocksError::Cancelled`]. Those that are done stay.
pub fn run_all(plan: &Plan, blocks: &[usize], monitor: &Monitor) -> Result<(), BlocksError> {
    let size =
        |&block: &usize| plan.blocks.get(block).map_or(0, |planned| planned.points + planned.halo);
    let work = monitor.units(blocks.iter().map(size).sum());
    let next = AtomicUsize::new(0);
    let failed = Mutex::new(None);
    let is_over = || failed.lock().is_ok_and(|failed| failed.is_some());
    // Threads of their own: one of rayon's that waits within a block might begin with another.
    std::thread::scope(|scope| {
        for _ in 0..rayon::current_num_threads().min(blocks.len()) {
            scope.spawn(|| {
                while let Some(block) = blocks.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let done = run(plan, *block).and_then(|()| Ok(work.add(size(block))?));
                    if let Err(error) = done {
                        failed
                            .lock()
                            .unwrap_or_else(std::sync::PoisonError::into_inner)
                            .get_or_insert(error);
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

/// Runs the blocks of a plan that are missing, as one of a team, and waits until all are there. Each process
/// gets blocks with about as many points, in and around them, as the others.
///
/// # Errors
/// As [`run_all`]. The others of the team would wait for a process that ends with an error.
pub fn run_missing(plan: &Plan, team: &dyn Team, monitor: &Monitor) -> Result<(), BlocksError> {
    let missing = if team.is_first() { Some(plan.missing()?) } else { None };
    let missing = team.broadcast(missing);
    let size = |block: usize| plan.blocks[block].points + plan.blocks[block].halo;
    run_all(plan, &shared(missing, size, team.size())[team.rank()], monitor)?;
    team.barrier();
    Ok(())
}

/// Shares blocks among processes: the largest first, each to the one that has least (Graham, "Bounds on
/// multiprocessing timing anomalies", 1969, doi:10.1137/0117039). No share is above 4/3 of what it could be.
fn shared(
    mut blocks: Vec<usize>,
    size: impl Fn(usize) -> u64,
    processes: usize,
) -> Vec<Vec<usize>> {
    blocks.sort_by_key(|&block| Reverse(size(block)));
    let mut shares = vec![Vec::new(); processes];
    let mut least: BinaryHeap<Reverse<(u64, usize)>> =
        (0..processes).map(|process| Reverse((0, process))).collect();
    for block in blocks {
        let Some(Reverse((load, process))) = least.pop() else { break };
        shares[process].push(block);
        least.push(Reverse((load + size(block), process)));
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_about_equal() {
        let sizes = [7, 1, 4, 0, 9, 3, 3];
        let shares = shared((0..7).collect(), |block| sizes[block], 3);
        let loads: Vec<u64> =
            shares.iter().map(|share| share.iter().map(|&block| sizes[block]).sum()).collect();
        assert_eq!(loads, [9, 10, 8], "{shares:?}");
        let mut all = shares.concat();
        all.sort_unstable();
        assert_eq!(all, [0, 1, 2, 3, 4, 5, 6]);
        assert_eq!(shared(vec![2], |_| 0, 3), [vec![2], vec![], vec![]]);
    }
}
