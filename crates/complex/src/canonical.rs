//! The canonical order of rows, as documented for `Complex`.

use crate::{Complex, Simplices};

/// The vertices in ascending order.
#[inline]
pub fn sorted<const N: usize>(mut row: [u32; N]) -> [u32; N] {
    // This has no branches, for rows of two to four.
    for end in (1..N).rev() {
        for i in 0..end {
            let (one, other) = (row[i], row[i + 1]);
            (row[i], row[i + 1]) = (one.min(other), one.max(other));
        }
    }
    row
}

/// The faces of a positively oriented cell, each counter-clockwise as seen from outside; the i-th is opposite to the i-th vertex.
pub fn outward_facets([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 4] {
    [[b, c, d], [a, d, c], [a, b, d], [a, c, b]]
}

/// The lexicographically smallest even permutation of a row.
pub fn smallest_even<const N: usize>(row: [u32; N]) -> [u32; N] {
    let mut smallest = sorted(row);
    let inversions = |i: usize| (i + 1..N).filter(|&j| row[j] < row[i]).count();
    if (0..N).map(inversions).sum::<usize>() % 2 == 1 {
        smallest.swap(N - 2, N - 1);
    }
    smallest
}

/// Puts rows into lexicographic order.
pub fn sort(complex: &mut Complex) {
    sort_rows(&mut complex.cells);
    sort_rows(&mut complex.facets);
    sort_rows(&mut complex.edges);
    sort_rows(&mut complex.vertices);
}

fn sort_rows<const N: usize>(simplices: &mut Simplices<N>) {
    if simplices.rows().is_sorted_by(|row, next| row < next) {
        return;
    }
    let mut rows: Vec<_> = std::mem::take(simplices).into_iter().collect();
    rows.sort_unstable();
    *simplices = rows.into_iter().collect();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_are_sorted() {
        for (row, ascending) in [
            ([3, 1, 2, 0], [0, 1, 2, 3]),
            ([2, 3, 0, 1], [0, 1, 2, 3]),
            ([9, 9, 4, 4], [4, 4, 9, 9]),
            ([u32::MAX, 0, 1, u32::MAX - 1], [0, 1, u32::MAX - 1, u32::MAX]),
        ] {
            assert_eq!(sorted(row), ascending);
        }
        assert_eq!((sorted([2, 1, 0]), sorted([1, 0]), sorted([5])), ([0, 1, 2], [0, 1], [5]));
    }

    #[test]
    fn permutations_keep_their_parity() {
        assert_eq!(smallest_even([3, 1, 2, 0]), [0, 1, 3, 2]);
        assert_eq!(smallest_even([1, 0, 3, 2]), [0, 1, 2, 3]);
        assert_eq!(smallest_even([7, 2, 5]), [2, 5, 7]);
        assert_eq!(smallest_even([7, 5, 2]), [2, 7, 5]);
    }
}
