//! Sums over the faces of simplices, on all threads, with the same result on any number of them.

use std::ops::Range;

use walpha_base::parallel::prelude::*;

/// Numbers, each with the index of the sum that it belongs to.
pub(crate) type Records<R> = Vec<(u32, R)>;

/// Adds records to their sums, each sum in the order of the records, which come in several lists.
///
/// Each thread has a range of the sums, and passes over all records for those in it.
pub(crate) fn scatter<L: Sync, R, S: Send>(
    lists: &[L],
    records: impl Fn(&L) -> &Records<R> + Sync,
    sums: &mut [S],
    add: impl Fn(&mut S, &R) + Sync,
) {
    if rayon::current_num_threads() == 1 {
        for (to, record) in lists.iter().flat_map(records) {
            add(&mut sums[*to as usize], record);
        }
        return;
    }
    let part = sums.len().div_ceil(rayon::current_num_threads()).max(1);
    sums.par_chunks_mut(part).enumerate().for_each(|(index, sums)| {
        let first = index * part;
        for list in lists {
            for (to, record) in records(list) {
                if let Some(sum) = sums.get_mut((*to as usize).wrapping_sub(first)) {
                    add(sum, record);
                }
            }
        }
    });
}

/// The ranges of so many that a range is cut into, in order; the last may be shorter.
pub(crate) fn ranges(all: Range<usize>, of: usize) -> impl Iterator<Item = Range<usize>> + Clone {
    let end = all.end;
    all.step_by(of).map(move |first| first..end.min(first + of))
}
