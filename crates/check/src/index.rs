//! An index of rows by their vertices.

use std::cmp::Ordering;
use std::ops::Range;

use walpha_base::parallel::prelude::*;
use walpha_complex::canonical::sorted;

/// Stands for a missing row.
pub(crate) const NONE: u32 = u32::MAX;

/// For entries sorted by a number below `count`, such as a vertex: the start of the entries of each number, and the end of the
/// last ones.
fn starts(numbers: impl Iterator<Item = u32>, count: usize) -> Vec<u32> {
    let mut starts = vec![0; count + 1];
    numbers.for_each(|number| starts[number as usize + 1] += 1);
    for i in 0..count {
        starts[i + 1] += starts[i];
    }
    starts
}

/// The entries of a number.
pub(crate) fn of_bucket(starts: &[u32], number: u32) -> Range<usize> {
    starts[number as usize] as usize..starts[number as usize + 1] as usize
}

/// Sorts all entries, given with their numbers below `count`, by number, and returns the [starts] of each number, too. Entries of
/// the same number stay in their order. Each of `threads` threads visits all entries, and keeps those of its share of the
/// numbers.
pub(crate) fn in_buckets<T: Copy + Send, I: Iterator<Item = (u32, T)>>(
    count: usize,
    threads: usize,
    entries: &(impl Fn() -> I + Sync),
) -> (Vec<u32>, Vec<T>) {
    let starts = starts(entries().map(|(number, _)| number), count);
    let Some((_, any)) = entries().next() else { return (starts, Vec::new()) };
    let mut sorted = vec![any; starts[count] as usize];
    fill(&mut sorted, &starts, 0, entries, threads);
    (starts, sorted)
}

/// Copies the entries of successive numbers, from `first` on, to where these start.
fn fill<T: Copy + Send, I: Iterator<Item = (u32, T)>>(
    sorted: &mut [T],
    starts: &[u32],
    first: u32,
    entries: &(impl Fn() -> I + Sync),
    threads: usize,
) {
    let count = starts.len() - 1;
    if threads > 1 && count > 1 {
        let share = starts[0] + (sorted.len() / threads * (threads / 2)) as u32;
        let middle = starts.partition_point(|&start| start < share).clamp(1, count - 1);
        let (left, right) = sorted.split_at_mut((starts[middle] - starts[0]) as usize);
        let (before, after) = (&starts[..=middle], &starts[middle..]);
        rayon::join(
            || fill(left, before, first, entries, threads / 2),
            || fill(right, after, first + middle as u32, entries, threads.div_ceil(2)),
        );
        return;
    }
    let mut next: Vec<u32> = starts[..count].iter().map(|start| start - starts[0]).collect();
    for (number, entry) in entries() {
        if let Some(place) = next.get_mut(number.wrapping_sub(first) as usize) {
            sorted[*place as usize] = entry;
            *place += 1;
        }
    }
}

/// The number of buckets that one thread processes at a time.
const BUCKETS: usize = 1 << 12;

/// Calls `work` with each bucket of entries sorted by a number, given where these [start](starts), in parallel.
pub(crate) fn for_each_bucket<T: Send>(
    mut entries: &mut [T],
    starts: &[u32],
    work: &(impl Fn(&mut [T]) + Sync),
) {
    let count = starts.len() - 1;
    let length = |from: usize, to: usize| (starts[to] - starts[from]) as usize;
    if count > BUCKETS {
        let (left, right) = entries.split_at_mut(length(0, count / 2));
        rayon::join(
            || for_each_bucket(left, &starts[..=count / 2], work),
            || for_each_bucket(right, &starts[count / 2..], work),
        );
        return;
    }
    for i in 0..count {
        let bucket;
        (bucket, entries) = entries.split_at_mut(length(i, i + 1));
        work(bucket);
    }
}

/// Finds rows by their vertices (up to four), given in any order.
pub(crate) struct Index<'a, const N: usize> {
    rows: &'a [[u32; N]],
    /// The numbers of the rows, in the lexicographic order of their sorted vertices; empty if the rows are in that order.
    order: Vec<u32>,
    /// The start of the rows with each smallest vertex in that order.
    starts: Vec<u32>,
}

/// The sorted vertices of a row as the digits of one number.
#[inline]
fn key<const N: usize>(row: [u32; N]) -> u128 {
    sorted(row).into_iter().fold(0, |key, v| key << 32 | u128::from(v))
}

impl<'a, const N: usize> Index<'a, N> {
    /// Indexes rows of vertices below `points`. O(n) if rows are in canonical order up to windings, otherwise O(n log n).
    pub(crate) fn new(rows: &'a [[u32; N]], points: usize) -> Self {
        let smallest = |row: &[u32; N]| sorted(*row)[0];
        let starts = starts(rows.iter().map(smallest), points);
        let numbers = || (0..rows.len() as u32).collect::<Vec<_>>();
        let by_vertices = |&number: &u32| (key(rows[number as usize]), number);
        let pairs = rows.par_windows(2);
        let order = if pairs.clone().all(|pair| key(pair[0]) <= key(pair[1])) {
            Vec::new()
        } else if pairs.clone().all(|pair| smallest(&pair[0]) <= smallest(&pair[1])) {
            // Windings change only the order of rows with the same smallest vertex.
            let mut order = numbers();
            for_each_bucket(&mut order, &starts, &|bucket| {
                bucket.sort_unstable_by_key(by_vertices);
            });
            order
        } else {
            let mut order = numbers();
            order.par_sort_unstable_by_key(by_vertices);
            order
        };
        Self { rows, order, starts }
    }

    /// The vertices that more than one row has, once for each repetition; ascending.
    pub(crate) fn repeated(&self) -> Vec<[u32; N]> {
        let row = |place: usize| sorted(self.rows[self.number(place) as usize]);
        let places = (1..self.rows.len()).into_par_iter();
        places.filter(|&place| row(place - 1) == row(place)).map(row).collect()
    }

    /// Whether there is a row with these vertices.
    pub(crate) fn contains(&self, vertices: [u32; N]) -> bool {
        self.row(vertices) != NONE
    }

    /// The row with these vertices, or one of several, or [`NONE`].
    pub(crate) fn row(&self, vertices: [u32; N]) -> u32 {
        let vertices = sorted(vertices);
        let Range { mut start, mut end } = of_bucket(&self.starts, vertices[0]);
        let wanted = key(vertices);
        while start < end {
            let middle = usize::midpoint(start, end);
            let number = self.number(middle);
            match key(self.rows[number as usize]).cmp(&wanted) {
                Ordering::Less => start = middle + 1,
                Ordering::Equal => return number,
                Ordering::Greater => end = middle,
            }
        }
        NONE
    }

    /// The rows with this smallest vertex, in the lexicographic order of their sorted vertices.
    pub(crate) fn with_smallest(&self, vertex: u32) -> impl Iterator<Item = [u32; N]> {
        of_bucket(&self.starts, vertex).map(|place| self.rows[self.number(place) as usize])
    }

    /// The number of the row at a place of the order.
    fn number(&self, place: usize) -> u32 {
        if self.order.is_empty() { place as u32 } else { self.order[place] }
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;
    use walpha_complex::canonical::smallest_even;

    use super::*;

    /// Rows in canonical order, with windings; the same rows in any order; and in the order of their vertices. Some occur twice.
    #[test]
    fn rows_are_found_in_any_order() {
        const POINTS: usize = 3 * BUCKETS;
        let mut random = Random::new(4);
        let mut rows: Vec<[u32; 4]> = Vec::new();
        while rows.len() < 20_000 {
            let first = random.below(POINTS - 9) as u32;
            let mut row = [0, 1, 2, 3].map(|k| first + 2 * k + random.below(2) as u32);
            random.shuffle(&mut row);
            rows.push(row);
        }
        let mut twice: Vec<[u32; 4]> = rows.iter().map(|row| sorted(*row)).collect();
        twice.sort_unstable();
        let twice: Vec<_> =
            twice.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
        assert!(twice.len() > 100);
        let mut canonical: Vec<[u32; 4]> = rows.iter().map(|row| smallest_even(*row)).collect();
        canonical.sort_unstable();
        let mut by_vertices = rows.clone();
        by_vertices.sort_by_key(|row| sorted(*row));
        for (rows, in_order) in [(rows, false), (canonical, false), (by_vertices, true)] {
            let index = Index::new(&rows, POINTS);
            assert_eq!(index.order.is_empty(), in_order);
            assert_eq!(index.repeated(), twice);
            for (number, row) in rows.iter().enumerate() {
                let [a, b, c, d] = *row;
                let found = index.row([d, b, a, c]);
                assert_eq!(sorted(rows[found as usize]), sorted(*row), "{number}");
                assert!(!index.contains([a, b, c, POINTS as u32 - 1]));
            }
        }
    }

    #[test]
    fn each_bucket_is_seen_once() {
        let mut random = Random::new(5);
        let lengths: Vec<u32> = (0..5 * BUCKETS).map(|_| random.below(4) as u32).collect();
        let numbers = || (0..).zip(&lengths).flat_map(|(i, &n)| std::iter::repeat_n(i, n as usize));
        let starts = starts(numbers(), lengths.len());
        let mut entries: Vec<(u32, u32)> = numbers().map(|i| (i, 0)).collect();
        for_each_bucket(&mut entries, &starts, &|bucket: &mut [(u32, u32)]| {
            assert!(bucket.iter().all(|(i, _)| *i == bucket[0].0));
            let count = bucket.len() as u32;
            bucket.iter_mut().for_each(|(_, seen)| *seen += count);
        });
        assert!(entries.iter().all(|(i, seen)| *seen == lengths[*i as usize]));
    }
}
