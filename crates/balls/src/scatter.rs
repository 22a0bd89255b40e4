//! Sums over the faces of simplices, on all threads, with the same result on any number of them.

use std::ops::Range;

use rayon::prelude::*;

/// Adds records to the sums that they name, each sum in the order of the records.
///
/// Each thread has a range of the sums, and passes over all records for those in it.
pub(crate) fn scatter<'a, R, S>(
    records: impl Iterator<Item = &'a (u32, R)> + Clone + Sync + Send,
    sums: &mut [S],
    add: impl Fn(&mut S, &R) + Sync,
) where
    R: 'a,
    S: Send,
{
    let part = sums.len().div_ceil(rayon::current_num_threads()).max(1);
    sums.par_chunks_mut(part).enumerate().for_each(|(index, sums)| {
        let first = index * part;
        for (to, record) in records.clone() {
            if let Some(sum) = (*to as usize).checked_sub(first).and_then(|at| sums.get_mut(at)) {
                add(sum, record);
            }
        }
    });
}

/// The ranges of so many that a range is cut into, in order; the last may be shorter.
pub(crate) fn ranges(all: Range<usize>, of: usize) -> impl Iterator<Item = Range<usize>> + Clone {
    let end = all.end;
    all.step_by(of).map(move |first| first..end.min(first + of))
}
