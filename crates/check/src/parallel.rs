//! Parallel work on many items, under a monitor.

use rayon::prelude::*;
use walpha_base::{Cancelled, Monitor};

/// Items between two checks of the monitor.
const BATCH: usize = 1 << 8;

/// The result of `work` for each index below `count`. Until it is known, `unknown` takes its place.
///
/// # Errors
/// The work was cancelled.
pub(crate) fn one_for_each<T: Copy + Send + Sync>(
    count: usize,
    unknown: T,
    monitor: &Monitor,
    work: impl Fn(usize) -> T + Sync,
) -> Result<Vec<T>, Cancelled> {
    let units = monitor.units(count as u64);
    let mut results = vec![unknown; count];
    results.par_chunks_mut(BATCH).enumerate().try_for_each(|(batch, results)| {
        for (i, result) in (batch * BATCH..).zip(&mut *results) {
            *result = work(i);
        }
        units.add(results.len() as u64)
    })?;
    Ok(results)
}

/// The results of `work` for each index below `count`, in the order of the indices.
///
/// # Errors
/// The work was cancelled.
pub(crate) fn of_each<I>(
    count: usize,
    monitor: &Monitor,
    work: impl Fn(usize) -> I + Sync,
) -> Result<Vec<I::Item>, Cancelled>
where
    I: IntoIterator,
    I::Item: Send,
{
    let units = monitor.units(count as u64);
    let batch = |start: usize| {
        let indices = start..count.min(start + BATCH);
        let done = indices.len() as u64;
        let yielded: Vec<_> = indices.flat_map(&work).collect();
        units.add(done).map(|()| yielded)
    };
    let batches = (0..count).into_par_iter().step_by(BATCH).map(batch);
    let batches = batches.collect::<Result<Vec<_>, Cancelled>>()?;
    let mut all = Vec::with_capacity(batches.iter().map(Vec::len).sum());
    batches.into_iter().for_each(|batch| all.extend(batch));
    Ok(all)
}
