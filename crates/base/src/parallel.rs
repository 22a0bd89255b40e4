//! Work on all threads where it is worth waking them. That takes some ten microseconds, in which one thread does a thousand simple
//! steps.
//!
//! Parallel iterators are those of rayon, in [`Parts`]: `use walpha_base::parallel::prelude::*` takes the place of rayon's prelude.

use std::cmp::Ordering;

use rayon::iter::plumbing::{
    Consumer, Folder, Producer, ProducerCallback, Reducer, UnindexedConsumer,
};
use rayon::iter::{Copied, Enumerate, IntoParallelIterator, MinLen, StepBy, Zip};
use rayon::iter::{IndexedParallelIterator, ParallelIterator};
use rayon::slice::{ChunkByMut, Chunks, ChunksMut, ParallelSlice, ParallelSliceMut, Windows};

/// What parallel iterators need.
pub mod prelude {
    pub use rayon::iter::{IndexedParallelIterator, ParallelExtend, ParallelIterator};

    pub use super::{Coarse, Items, MutItems, RefItems, Slices};
}

/// The number of items, each of which takes some ten nanoseconds, that one thread does alone.
pub const FEW: usize = 1 << 11;

/// Parallel iterators over many small items.
pub trait Coarse: IndexedParallelIterator {
    /// Leaves parts of [`FEW`] items to one thread. Fewer than twice as many items are done by the calling thread, and no other is
    /// woken.
    fn coarse(self) -> Parts<MinLen<Self>> {
        Parts(self.with_min_len(FEW))
    }
}

impl<I: IndexedParallelIterator> Coarse for I {}

/// What has items that are known by their places: rayon's [`IntoParallelIterator`].
pub trait Items: IntoParallelIterator<Iter: IndexedParallelIterator> {
    /// The items.
    fn into_par_iter(self) -> Parts<Self::Iter>
    where
        Self: Sized,
    {
        Parts(IntoParallelIterator::into_par_iter(self))
    }
}

impl<I: IntoParallelIterator<Iter: IndexedParallelIterator>> Items for I {}

/// What has such items when it is borrowed.
pub trait RefItems<'a> {
    /// The parallel iterator within.
    type Iter;

    /// References to the items.
    fn par_iter(&'a self) -> Parts<Self::Iter>;
}

impl<'a, I: ?Sized + 'a> RefItems<'a> for I
where
    &'a I: Items,
{
    type Iter = <&'a I as IntoParallelIterator>::Iter;

    fn par_iter(&'a self) -> Parts<Self::Iter> {
        Items::into_par_iter(self)
    }
}

/// What has such items when it is borrowed and may change.
pub trait MutItems<'a> {
    /// The parallel iterator within.
    type Iter;

    /// Mutable references to the items.
    fn par_iter_mut(&'a mut self) -> Parts<Self::Iter>;
}

impl<'a, I: ?Sized + 'a> MutItems<'a> for I
where
    &'a mut I: Items,
{
    type Iter = <&'a mut I as IntoParallelIterator>::Iter;

    fn par_iter_mut(&'a mut self) -> Parts<Self::Iter> {
        Items::into_par_iter(self)
    }
}

/// Parts of slices, and sorting.
pub trait Slices<T> {
    /// The slice.
    fn items(&self) -> &[T];

    /// The slice.
    fn items_mut(&mut self) -> &mut [T];

    /// Parts of `size` items; the last may have fewer.
    fn par_chunks(&self, size: usize) -> Parts<Chunks<'_, T>>
    where
        T: Sync,
    {
        Parts(ParallelSlice::par_chunks(self.items(), size))
    }

    /// Parts of `size` items; the last may have fewer.
    fn par_chunks_mut(&mut self, size: usize) -> Parts<ChunksMut<'_, T>>
    where
        T: Send,
    {
        Parts(ParallelSliceMut::par_chunks_mut(self.items_mut(), size))
    }

    /// All runs of `size` items, which overlap.
    fn par_windows(&self, size: usize) -> Parts<Windows<'_, T>>
    where
        T: Sync,
    {
        Parts(ParallelSlice::par_windows(self.items(), size))
    }

    /// Parts of which each item belongs with the one before it.
    fn par_chunk_by_mut<F: Fn(&T, &T) -> bool + Send + Sync>(
        &mut self,
        belong: F,
    ) -> ChunkByMut<'_, T, F>
    where
        T: Send,
    {
        ParallelSliceMut::par_chunk_by_mut(self.items_mut(), belong)
    }

    /// Sorts by a key. Items with equal keys stay in their order.
    fn par_sort_by_key<K: Ord>(&mut self, key: impl Fn(&T) -> K + Sync)
    where
        T: Send,
    {
        ParallelSliceMut::par_sort_by_key(self.items_mut(), key);
    }

    /// Sorts. Equal items may change places.
    fn par_sort_unstable(&mut self)
    where
        T: Ord + Send,
    {
        ParallelSliceMut::par_sort_unstable(self.items_mut());
    }

    /// Sorts by what a comparison says. Equal items may change places.
    fn par_sort_unstable_by(&mut self, compare: impl Fn(&T, &T) -> Ordering + Sync)
    where
        T: Send,
    {
        ParallelSliceMut::par_sort_unstable_by(self.items_mut(), compare);
    }

    /// Sorts by a key. Items with equal keys may change places.
    fn par_sort_unstable_by_key<K: Ord>(&mut self, key: impl Fn(&T) -> K + Sync)
    where
        T: Send,
    {
        ParallelSliceMut::par_sort_unstable_by_key(self.items_mut(), key);
    }
}

impl<T> Slices<T> for [T] {
    fn items(&self) -> &[T] {
        self
    }

    fn items_mut(&mut self) -> &mut [T] {
        self
    }
}

/// A parallel iterator whose parts are handed to other threads by functions behind a pointer.
///
/// It yields the same items as the one within, as fast. But rayon's own way of handing over is compiled for each iterator anew, some two
/// thousand lines of LLVM's code, which was a quarter of all that the compiler had to optimise.
#[derive(Clone)]
pub struct Parts<I>(I);

impl<I: IndexedParallelIterator> Parts<I> {
    /// The items with those at the same places of others.
    pub fn zip<Z: Items>(self, others: Z) -> Parts<Zip<I, Z::Iter>> {
        Parts(self.0.zip(others))
    }

    /// The items with their places.
    pub fn enumerate(self) -> Parts<Enumerate<I>> {
        Parts(self.0.enumerate())
    }

    /// Every so many of the items.
    pub fn step_by(self, step: usize) -> Parts<StepBy<I>> {
        Parts(self.0.step_by(step))
    }

    /// Leaves parts of at least so many items to one thread.
    pub fn with_min_len(self, items: usize) -> Parts<MinLen<I>> {
        Parts(self.0.with_min_len(items))
    }

    /// The items themselves instead of references to them.
    pub fn copied<'a, T: Copy + Send + Sync + 'a>(self) -> Parts<Copied<I>>
    where
        I: ParallelIterator<Item = &'a T>,
    {
        Parts(self.0.copied())
    }
}

impl<I: IndexedParallelIterator> ParallelIterator for Parts<I> {
    type Item = I::Item;

    fn drive_unindexed<C: UnindexedConsumer<I::Item>>(self, consumer: C) -> C::Result {
        self.drive(consumer)
    }

    fn opt_len(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

impl<I: IndexedParallelIterator> IndexedParallelIterator for Parts<I> {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn drive<C: Consumer<I::Item>>(self, consumer: C) -> C::Result {
        let len = self.0.len();
        self.0.with_producer(Drive { len, consumer })
    }

    fn with_producer<C: ProducerCallback<I::Item>>(self, callback: C) -> C::Output {
        self.0.with_producer(callback)
    }
}

/// Gives the items of a producer to a consumer.
struct Drive<C> {
    len: usize,
    consumer: C,
}

impl<T, C: Consumer<T>> ProducerCallback<T> for Drive<C> {
    type Output = C::Result;

    fn callback<P: Producer<Item = T>>(self, producer: P) -> C::Result {
        let splits = Splits::new(self.len, producer.min_len(), producer.max_len());
        drive(self.len, splits, producer, self.consumer)
    }
}

/// Gives the `len` items of a producer to a consumer, in two parts at the same time as long as that pays.
fn drive<P: Producer, C: Consumer<P::Item>>(
    len: usize,
    mut splits: Splits,
    producer: P,
    consumer: C,
) -> C::Result {
    // Folders look whether they are full after an item.
    if consumer.full() {
        return consumer.into_folder().complete();
    }
    if !splits.take(len) {
        return producer.fold_with(consumer.into_folder()).complete();
    }
    let half = len / 2;
    let (producers, consumers) = (producer.split_at(half), consumer.split_at(half));
    let mut parts = [Some((producers.0, consumers.0)), Some((producers.1, consumers.1))];
    let [left, right] = &mut parts;
    let (mut first, mut second) = (None, None);
    let part = |len, part: &mut Option<(P, C)>, moved| {
        let (producer, consumer) = part.take().expect("each part is done once");
        drive(len, splits.of_part(moved), producer, consumer)
    };
    let mut left = |moved| first = Some(part(half, left, moved));
    let mut right = |moved| second = Some(part(len - half, right, moved));
    join_parts(&mut left, &mut right);
    let done = "both parts are done";
    consumers.2.reduce(first.expect(done), second.expect(done))
}

/// Calls two functions, at the same time if a thread is free. Each is told whether another thread took it. Compiled once.
fn join_parts(a: &mut (dyn FnMut(bool) + Send), b: &mut (dyn FnMut(bool) + Send)) {
    rayon::join_context(|thread| a(thread.migrated()), |thread| b(thread.migrated()));
}

/// How often work is still split. There is a part for each thread at first; whatever another thread takes is split for all of them again, as
/// threads that are free show that the parts were uneven.
#[derive(Clone, Copy)]
struct Splits {
    left: usize,
    min_len: usize,
}

impl Splits {
    fn new(len: usize, min_len: usize, max_len: usize) -> Self {
        let left = rayon::current_num_threads().max(len / max_len.max(1));
        Self { left, min_len: min_len.max(1) }
    }

    /// Whether a part of `len` items is split.
    fn take(&mut self, len: usize) -> bool {
        let splits = self.left > 0 && len / 2 >= self.min_len;
        self.left /= 2;
        splits
    }

    /// What remains for one of the two parts, which another thread took if it `moved`.
    fn of_part(self, moved: bool) -> Self {
        let left = if moved { self.left.max(rayon::current_num_threads()) } else { self.left };
        Self { left, ..self }
    }
}

/// Sorts items, on all threads if they are many.
pub fn sort_unstable<T: Ord + Send>(items: &mut [T]) {
    if items.len() <= 4 * FEW { items.sort_unstable() } else { Slices::par_sort_unstable(items) }
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

#[cfg(test)]
mod tests {
    use std::collections::HashSet;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::thread;
    use std::time::Duration;

    use super::FEW;
    use super::prelude::*;

    fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("some threads").install(work)
    }

    #[test]
    fn items_keep_their_order_on_any_number_of_threads() {
        for len in [0, 1, 2, 3, 7, 2 * FEW - 1, 2 * FEW, 9 * FEW + 5] {
            let items: Vec<usize> = (0..len).map(|i| i * 7919 % 1009).collect();
            let is_odd = |(i, (a, b)): (usize, (&usize, usize))| (a % 2 == 1).then_some(i + a + b);
            let expected: Vec<usize> =
                items.iter().zip(1..=len).enumerate().filter_map(is_odd).collect();
            for threads in [1, 2, 5] {
                let (fine, coarse, least, doubled) = on_threads(threads, || {
                    let pairs = || items.par_iter().zip(1..len + 1).enumerate();
                    let mut doubled = items.clone();
                    doubled
                        .par_chunks_mut(3)
                        .for_each(|some| some.iter_mut().for_each(|a| *a *= 2));
                    let fine: Vec<_> = pairs().filter_map(is_odd).collect();
                    let coarse: Vec<_> = pairs().coarse().filter_map(is_odd).collect();
                    (fine, coarse, items.par_iter().copied().min(), doubled)
                });
                assert_eq!(fine, expected, "{len} items, {threads} threads");
                assert_eq!(coarse, expected, "{len} items, {threads} threads");
                assert_eq!(least, items.iter().copied().min());
                assert!(doubled.iter().zip(&items).all(|(doubled, item)| *doubled == 2 * item));
            }
        }
    }

    #[test]
    fn few_items_wake_no_thread_and_uneven_ones_are_shared() {
        let threads = |found: &[Option<usize>]| found.iter().collect::<HashSet<_>>().len();
        on_threads(2, || {
            let few = (0..2 * FEW - 1).into_par_iter().coarse().map(|i| {
                thread::sleep(Duration::from_millis(if i % 1000 == 0 { 5 } else { 0 }));
                rayon::current_thread_index()
            });
            let few: Vec<_> = few.collect();
            assert_eq!(threads(&few), 1);
            // Those that take longest are in one of the first four parts, which is split again, as the other thread took it.
            let nap = |i| {
                let longest = (8..12).contains(&i);
                thread::sleep(Duration::from_millis(if longest { 80 } else { 4 }));
                rayon::current_thread_index()
            };
            let uneven: Vec<_> = (0..16).into_par_iter().map(nap).collect();
            assert_eq!(threads(&uneven[8..12]), 2, "{uneven:?}");
        });
    }

    #[test]
    fn nothing_is_done_once_a_search_has_ended() {
        let looked_at = AtomicUsize::new(0);
        let found = on_threads(1, || {
            (0..100).into_par_iter().any(|i| {
                looked_at.fetch_add(1, Ordering::Relaxed);
                i == 5
            })
        });
        assert_eq!((found, looked_at.into_inner()), (true, 6));
    }
}
