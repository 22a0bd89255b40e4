//! From rows as C++ lends them to the canonical order documented on [`Complex`].

use rayon::prelude::*;
use walpha_complex::canonical::{smallest_even, sorted};

use super::shape::RawComplex;
use crate::shape::{Class, Complex, Simplices};

/// Translates site indices to input indices and puts everything in canonical order.
pub(super) fn canonical(raw: &RawComplex, input: &[u32]) -> Complex {
    Complex {
        cells: simplices(raw.cells(), input, |row, _| smallest_even(row)),
        facets: simplices(raw.facets(), input, |row, class| {
            if class == Class::Regular { smallest_even(row) } else { sorted(row) }
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
