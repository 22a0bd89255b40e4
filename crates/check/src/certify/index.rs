use rayon::prelude::*;
use walpha_complex::canonical::sorted;

use super::Finding;

/// Stands for the absence of a simplex or cell.
pub(super) const NONE: u32 = u32::MAX;

/// Finds listed simplices by their vertices, in any order.
pub(super) struct Index<const N: usize> {
    /// Sorted vertices and row number, in lexicographic order.
    entries: Vec<([u32; N], u32)>,
    /// Where the entries of each first vertex start.
    starts: Vec<u32>,
}

impl<const N: usize> Index<N> {
    /// Indexes rows of valid vertices, with findings on those that are listed twice.
    pub(super) fn new(rows: &[[u32; N]], points: usize) -> (Self, Vec<Finding>) {
        let mut entries: Vec<_> =
            rows.par_iter().enumerate().map(|(i, row)| (sorted(*row), i as u32)).collect();
        entries.par_sort_unstable();
        let twice = entries.windows(2).filter(|pair| pair[0].0 == pair[1].0);
        let findings =
            twice.map(|pair| Finding::RepeatedSimplex { simplex: pair[0].0.into() }).collect();
        let mut starts = vec![0; points + 1];
        for (row, _) in &entries {
            starts[row[0] as usize + 1] += 1;
        }
        for i in 0..points {
            starts[i + 1] += starts[i];
        }
        (Self { entries, starts }, findings)
    }

    /// Whether a simplex is listed.
    pub(super) fn contains(&self, simplex: [u32; N]) -> bool {
        self.row(simplex) != NONE
    }

    /// The row of a simplex, or [`NONE`].
    pub(super) fn row(&self, simplex: [u32; N]) -> u32 {
        let key = sorted(simplex);
        let first = key[0] as usize;
        let bucket = &self.entries[self.starts[first] as usize..self.starts[first + 1] as usize];
        match bucket.binary_search_by(|(row, _)| row.cmp(&key)) {
            Ok(at) => bucket[at].1,
            Err(_) => NONE,
        }
    }
}
