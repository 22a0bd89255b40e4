//! Parallel work on many items, under a monitor.

use std::ops::Range;
use std::sync::Mutex;

use walpha_base::parallel::prelude::*;
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
    let mut results = vec![unknown; count];
    let batches: Vec<_> = results.chunks_mut(BATCH).map(Mutex::new).collect();
    each_batch(count, monitor, &|batch, indices| {
        let mut results = batches[batch].lock().expect("no other work has this batch");
        for (i, result) in indices.zip(&mut **results) {
            *result = work(i);
        }
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
    let batches: Vec<_> = (0..count.div_ceil(BATCH)).map(|_| Mutex::new(Vec::new())).collect();
    each_batch(count, monitor, &|batch, indices| {
        let yielded = indices.flat_map(&work).collect();
        *batches[batch].lock().expect("no other work has this batch") = yielded;
    })?;
    let batches: Vec<Vec<_>> =
        batches.into_iter().map(|batch| batch.into_inner().expect("all work ended")).collect();
    let mut all = Vec::with_capacity(batches.iter().map(Vec::len).sum());
    batches.into_iter().for_each(|batch| all.extend(batch));
    Ok(all)
}

/// Gives `work` the number and the indices of each batch of indices below `count`.
///
/// Not generic, so it is compiled once: compiled for each work, it was a ninth of what this crate makes the compiler optimise.
fn each_batch(
    count: usize,
    monitor: &Monitor,
    work: &(dyn Fn(usize, Range<usize>) + Sync),
) -> Result<(), Cancelled> {
    let units = monitor.units(count as u64);
    (0..count.div_ceil(BATCH)).into_par_iter().try_for_each(|batch| {
        let indices = batch * BATCH..count.min((batch + 1) * BATCH);
        let done = indices.len() as u64;
        work(batch, indices);
        units.add(done)
    })
}
