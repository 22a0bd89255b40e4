//! Work on all threads where it is worth waking them. That takes some ten microseconds, in which one thread does a thousand simple
//! steps.

use rayon::iter::{IndexedParallelIterator, MinLen};
use rayon::slice::ParallelSliceMut;

/// The number of items, each of which takes some ten nanoseconds, that one thread does alone.
pub const FEW: usize = 1 << 11;

/// Parallel iterators over many small items.
pub trait Coarse: IndexedParallelIterator {
    /// Leaves parts of [`FEW`] items to one thread. Fewer than twice as many items are done by the calling thread, and no other is
    /// woken.
    fn coarse(self) -> MinLen<Self> {
        self.with_min_len(FEW)
    }
}

impl<I: IndexedParallelIterator> Coarse for I {}

/// Sorts items, on all threads if they are many.
pub fn sort_unstable<T: Ord + Send>(items: &mut [T]) {
    if items.len() <= 4 * FEW { items.sort_unstable() } else { items.par_sort_unstable() }
}

/// Does work on points in a thread of the pool, where its parallel steps share their items with other threads. From any other thread
/// each step alone would be handed over and waited for, which takes some ten microseconds. Work on few points has no such step.
pub fn in_pool<T: Send>(points: usize, work: impl FnOnce() -> T + Send) -> T {
    // The simplices of a point, and their faces.
    const ITEMS: usize = 27;
    if ITEMS * points > FEW && rayon::current_thread_index().is_none() {
        rayon::scope(|_| work())
    } else {
        work()
    }
}

/// Calls two functions, at the same time if they work on more than [`FEW`] items.
pub fn join<A: Send, B: Send>(
    items: usize,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    if items > FEW { rayon::join(a, b) } else { (a(), b()) }
}
