//! The canonical order of rows, as documented for `Complex`.

use walpha_base::parallel::prelude::*;

use crate::{Class, Complex, Simplices};

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

/// Rows of numbers of vertices, and the number of each row's class.
pub type NumberedRows<'a, const N: usize> = (&'a [[u32; N]], &'a [u8]);

/// The complex of simplices that are listed in any order, by numbers of their vertices: the vertex `v` is the point `input[v]`. Cells are
/// positively oriented, and regular facets turn counter-clockwise seen from outside. O(n log n).
///
/// # Panics
/// If a number has no class or no point, or a row has no class.
pub fn in_order(
    cells: NumberedRows<'_, 4>,
    facets: NumberedRows<'_, 3>,
    edges: NumberedRows<'_, 2>,
    vertices: NumberedRows<'_, 1>,
    input: &[u32],
) -> Complex {
    Complex {
        cells: simplices(cells, input, |row, _| smallest_even(row)),
        facets: simplices(facets, input, |row, class| {
            if class == Class::Regular { smallest_even(row) } else { sorted(row) }
        }),
        edges: simplices(edges, input, |row, _| sorted(row)),
        vertices: simplices(vertices, input, |row, _| row),
    }
}

/// Simplices with their classes, which are sorted by code that is compiled once.
pub trait ByRow {
    /// Puts simplices into the order of their rows, which are distinct. O(n log n), on all threads.
    fn sort_by_row(&mut self);
}

macro_rules! by_row {
    ($($vertices:literal),*) => {$(
        impl ByRow for [([u32; $vertices], Class)] {
            fn sort_by_row(&mut self) {
                // Rows are distinct, so an unstable sort has a unique result.
                self.par_sort_unstable_by_key(|pair| pair.0);
            }
        }
    )*};
}

by_row!(1, 2, 3, 4);

fn simplices<const N: usize>(
    (rows, classes): NumberedRows<'_, N>,
    input: &[u32],
    order: impl Fn([u32; N], Class) -> [u32; N] + Sync,
) -> Simplices<N>
where
    [([u32; N], Class)]: ByRow,
{
    assert_eq!(rows.len(), classes.len(), "each row has a class");
    let mut pairs: Vec<([u32; N], Class)> = rows
        .par_iter()
        .zip(classes)
        .map(|(row, &number)| {
            let class = Class::from_number(number).expect("there are four classes");
            (order(row.map(|v| input[v as usize]), class), class)
        })
        .collect();
    pairs.sort_by_row();
    pairs.into_iter().collect()
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
    fn listed_simplices_are_named_and_ordered() {
        let complex = in_order(
            (&[[0, 1, 2, 3], [3, 2, 0, 1]], &[1, 0]),
            (&[[2, 1, 0], [3, 1, 2]], &[2, 0]),
            (&[[3, 1], [0, 2]], &[3, 2]),
            (&[[1], [0]], &[2, 3]),
            &[7, 5, 6, 4],
        );
        assert_eq!(complex.cells.rows(), [[4, 5, 6, 7], [4, 5, 7, 6]]);
        assert_eq!(complex.cells.classes(), [Class::Exterior, Class::Interior]);
        // A regular facet keeps its orientation; any other is in ascending order.
        assert_eq!(complex.facets.rows(), [[4, 5, 6], [5, 7, 6]]);
        assert_eq!(complex.facets.classes(), [Class::Exterior, Class::Regular]);
        assert_eq!(complex.edges.rows(), [[4, 5], [6, 7]]);
        assert_eq!(complex.edges.classes(), [Class::Singular, Class::Regular]);
        assert_eq!(complex.vertices.rows(), [[5], [7]]);
        assert_eq!(complex.vertices.classes(), [Class::Regular, Class::Singular]);
    }

    #[test]
    fn permutations_keep_their_parity() {
        assert_eq!(smallest_even([3, 1, 2, 0]), [0, 1, 3, 2]);
        assert_eq!(smallest_even([1, 0, 3, 2]), [0, 1, 2, 3]);
        assert_eq!(smallest_even([7, 2, 5]), [2, 5, 7]);
        assert_eq!(smallest_even([7, 5, 2]), [2, 7, 5]);
    }
}
