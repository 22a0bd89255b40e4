//! From rows as C++ lends them to the canonical order documented on [`Complex`].

use rayon::prelude::*;

use super::{Class, Complex, Simplices};
use crate::cgal::RawComplex;

/// Translates site indices to input indices and puts everything in canonical order.
pub(super) fn canonical(raw: &RawComplex, input: &[u32]) -> Complex {
    Complex {
        cells: simplices(raw.cells(), input, |row, _| smallest_even_permutation(row)),
        facets: simplices(raw.facets(), input, |row, class| {
            if class == Class::Regular { smallest_rotation(row) } else { sorted(row) }
        }),
        edges: simplices(raw.edges(), input, |row, _| sorted(row)),
        vertices: simplices(raw.vertices(), input, |row, _| row),
    }
}

fn simplices<const N: usize>(
    (rows, classes): (&[[u32; N]], &[u8]),
    input: &[u32],
    order: impl Fn([u32; N], Class) -> [u32; N] + Sync,
) -> Simplices<N> {
    let mut pairs: Vec<([u32; N], Class)> = rows
        .par_iter()
        .zip(classes)
        .map(|(row, &number)| {
            let class = Class::from_number(number).expect("CGAL has four classes");
            (order(row.map(|site| input[site as usize]), class), class)
        })
        .collect();
    // Rows are distinct, so an unstable sort has one answer.
    pairs.par_sort_unstable_by_key(|pair| pair.0);
    pairs.into_iter().collect()
}

fn sorted<const N: usize>(mut row: [u32; N]) -> [u32; N] {
    row.sort_unstable();
    row
}

/// The even permutation of four distinct indices that comes first: ascending, or ascending with
/// the last two exchanged.
pub(crate) fn smallest_even_permutation(row: [u32; 4]) -> [u32; 4] {
    let inversions =
        (0..4).flat_map(|j| (0..j).map(move |i| (i, j))).filter(|&(i, j)| row[i] > row[j]).count();
    let [a, b, c, d] = sorted(row);
    if inversions % 2 == 0 { [a, b, c, d] } else { [a, b, d, c] }
}

/// The even permutation of three distinct indices that comes first: the rotation that starts with
/// the smallest.
fn smallest_rotation(mut row: [u32; 3]) -> [u32; 3] {
    let first = (0..3).min_by_key(|&i| row[i]).unwrap_or(0);
    row.rotate_left(first);
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn permutations_keep_their_parity() {
        assert_eq!(smallest_even_permutation([3, 1, 2, 0]), [0, 1, 3, 2]);
        assert_eq!(smallest_even_permutation([1, 0, 3, 2]), [0, 1, 2, 3]);
        assert_eq!(smallest_rotation([7, 2, 5]), [2, 5, 7]);
        assert_eq!(smallest_rotation([7, 5, 2]), [2, 7, 5]);
    }
}
