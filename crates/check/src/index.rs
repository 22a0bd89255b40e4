//! An index of rows by their vertices.

use std::ops::Range;

use rayon::prelude::*;
use walpha_complex::canonical::sorted;

/// No row.
pub(crate) const NONE: u32 = u32::MAX;

/// For entries sorted by a number below `count`, such as a vertex: where those of each number start, and where the last ones end.
pub(crate) fn starts(numbers: impl Iterator<Item = u32>, count: usize) -> Vec<u32> {
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

/// Finds rows by their vertices, in any order.
pub(crate) struct Index<'a, const N: usize> {
    rows: &'a [[u32; N]],
    /// The numbers of the rows, in the lexicographic order of their sorted vertices.
    order: Vec<u32>,
    /// Where the rows with each smallest vertex start in that order.
    starts: Vec<u32>,
}

impl<'a, const N: usize> Index<'a, N> {
    /// Indexes rows of vertices below `points`. O(n) if rows are in canonical order up to windings, otherwise O(n log n).
    pub(crate) fn new(rows: &'a [[u32; N]], points: usize) -> Self {
        let key = |&row: &u32| sorted(rows[row as usize]);
        let starts = starts(rows.iter().map(|row| sorted(*row)[0]), points);
        let mut order: Vec<u32> = (0..rows.len() as u32).collect();
        if !order.par_windows(2).all(|pair| key(&pair[0]) <= key(&pair[1])) {
            order.par_sort_unstable_by_key(|row| (key(row), *row));
        }
        Self { rows, order, starts }
    }

    /// The vertices that more than one row has, once for each repetition; ascending.
    pub(crate) fn repeated(&self) -> impl Iterator<Item = [u32; N]> + '_ {
        let keys = self.order.iter().map(|&row| sorted(self.rows[row as usize]));
        keys.clone().zip(keys.skip(1)).filter(|(row, next)| row == next).map(|(row, _)| row)
    }

    /// Whether there is a row of these vertices.
    pub(crate) fn contains(&self, vertices: [u32; N]) -> bool {
        self.row(vertices) != NONE
    }

    /// The row of these vertices, one of several that have them, or [`NONE`].
    pub(crate) fn row(&self, vertices: [u32; N]) -> u32 {
        let key = sorted(vertices);
        let bucket = &self.order[of_bucket(&self.starts, key[0])];
        match bucket.binary_search_by_key(&key, |&row| sorted(self.rows[row as usize])) {
            Ok(at) => bucket[at],
            Err(_) => NONE,
        }
    }
}
