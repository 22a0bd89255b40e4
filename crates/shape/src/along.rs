use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use walpha_base::parallel::FEW;
use walpha_base::parallel::prelude::*;
use walpha_regular::internals::along_curve;

use super::Complex;

/// Vertices along a Hilbert curve, and the rows of the simplices of each dimension whose smallest vertex each is.
///
/// Rows are in the order of input indices, which need not be close in space. In visits along the curve, most of the data of a
/// simplex is still in a cache from the simplices before it.
#[derive(Debug)]
pub(crate) struct Along {
    pub order: Vec<u32>,
    /// The first row of each vertex, and the end.
    pub cells: Vec<u32>,
    pub facets: Vec<u32>,
    pub edges: Vec<u32>,
}

/// Vertices that one thread visits at a time.
const CHUNK: usize = 1 << 6;
/// The number of vertices with whose simplices, some twenty-five each, one thread is done before others are awake.
const FEW_VERTICES: usize = FEW / 4;

impl Along {
    /// O(n log n).
    pub(crate) fn new(whole: &Complex, positions: &[[f64; 3]]) -> Self {
        let points = positions.len();
        Self {
            order: along_curve(positions),
            cells: starts(whole.cells.rows(), points, is_before),
            facets: starts(whole.facets.rows(), points, is_before),
            edges: starts(whole.edges.rows(), points, is_before),
        }
    }

    /// Visits all rows of a dimension on all threads, given the first ones of each vertex.
    pub(crate) fn each(&self, starts: &[u32], visit: impl Fn(usize) + Sync) {
        let few = self.order.len() <= FEW_VERTICES;
        let length = if few { FEW_VERTICES } else { CHUNK };
        self.order.par_chunks(length).for_each(|chunk| {
            for &v in chunk {
                rows(starts, v).for_each(&visit);
            }
        });
    }
}

/// Whether the smallest vertex of a simplex comes before a vertex.
pub(crate) fn is_before<const N: usize>(row: &[u32; N], v: usize) -> bool {
    (row[0] as usize) < v
}

/// The rows of a group.
pub(crate) fn rows(starts: &[u32], group: u32) -> Range<usize> {
    starts[group as usize] as usize..starts[group as usize + 1] as usize
}

/// The start of the rows of each group, and the end of the last ones. Groups ascend; `before` says whether a row belongs to a
/// group before this one.
pub(crate) fn starts<T: Sync>(
    rows: &[T],
    groups: usize,
    before: impl Fn(&T, usize) -> bool + Sync,
) -> Vec<u32> {
    const GROUPS: usize = 1 << 14;
    let mut starts = vec![rows.len() as u32; groups + 1];
    starts[..groups].par_chunks_mut(GROUPS).enumerate().for_each(|(chunk, starts)| {
        let first = chunk * GROUPS;
        let mut at = rows.partition_point(|row| before(row, first));
        for (group, start) in (first..).zip(starts) {
            at += rows[at..].iter().take_while(|&row| before(row, group)).count();
            *start = at as u32;
        }
    });
    starts
}

/// A table that threads write in the order in which they visit simplices, each element once.
pub(crate) struct Table<const N: usize>(Vec<[AtomicU32; N]>);

impl<const N: usize> Table<N> {
    pub(crate) fn new(rows: usize, element: u32) -> Self {
        let row = |_| [0; N].map(|_| AtomicU32::new(element));
        Self((0..rows).into_par_iter().coarse().map(row).collect())
    }

    pub(crate) fn write(&self, row: usize, elements: [u32; N]) {
        for (to, element) in self.0[row].iter().zip(elements) {
            to.store(element, Ordering::Relaxed);
        }
    }

    pub(crate) fn write_at(&self, row: usize, place: usize, element: u32) {
        self.0[row][place].store(element, Ordering::Relaxed);
    }

    /// The rows, once all are written; in the same memory.
    pub(crate) fn finished(self) -> Vec<[u32; N]> {
        self.0.into_iter().map(|row| row.map(AtomicU32::into_inner)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_start_where_their_first_row_is() {
        assert_eq!(starts(&[], 3, |&row: &usize, group| row < group), [0; 4]);
        let rows: Vec<usize> = (0..100_000).map(|i| i / 3 * 2 + usize::from(i % 3 == 2)).collect();
        let found = starts(&rows, 70_000, |&row, group| row < group);
        let expected = (0..=70_000).map(|v| rows.partition_point(|&row| row < v) as u32);
        assert!(expected.eq(found));
    }
}
