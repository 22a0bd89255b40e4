use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use walpha_base::Sum;
use walpha_base::vector::{cross, dot, length, sub};
use walpha_regular::Torus;

use super::{Class, Complex};

/// Volume and areas of a shape in the units of its points, summed exactly and rounded once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measures {
    /// Volume of the interior cells.
    pub volume: f64,
    /// Area of the regular facets: the boundary of the solid part, once.
    pub area: f64,
    /// Area of the singular facets, one side of each.
    pub singular_area: f64,
}

impl Measures {
    /// Measures a shape, in space or on a torus. Terms are rounded, their sums exact: they do not depend on the
    /// number of threads or blocks. O(n).
    pub fn of(complex: &Complex, positions: &[[f64; 3]], torus: Option<Torus>) -> Self {
        let at = |v: u32| positions[v as usize];
        let area = |class| {
            sum(complex.facets.rows(), |i, facet| {
                if complex.facets.classes()[i] != class {
                    return 0.0;
                }
                facet_area(together(torus, facet.map(at)))
            })
        };
        // Divided last: on a lattice, determinants and their sums are integers.
        let volume = sum(complex.cells.rows(), |i, cell| {
            if complex.cells.classes()[i] != Class::Interior {
                return 0.0;
            }
            six_volumes(together(torus, cell.map(at)))
        }) / 6.0;
        Self { volume, area: area(Class::Regular), singular_area: area(Class::Singular) }
    }
}

/// The corners of a simplex; on a torus, the copies nearest to the first one.
#[inline]
pub(crate) fn together<const N: usize>(
    torus: Option<Torus>,
    corners: [[f64; 3]; N],
) -> [[f64; 3]; N] {
    torus.map_or(corners, |torus| torus.together(corners))
}

/// The area of a triangle.
pub fn facet_area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    length(cross(sub(b, a), sub(c, a))) / 2.0
}

/// Six times the volume of a positively oriented cell: a determinant, an integer on an integer lattice.
pub fn six_volumes([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
    dot(cross(sub(b, a), sub(c, a)), sub(d, a))
}

/// Σ `term(i, row)`, exact and rounded once.
fn sum<const N: usize>(rows: &[[u32; N]], term: impl Fn(usize, [u32; N]) -> f64 + Sync) -> f64 {
    // Rows summed by one thread at a time.
    const CHUNK: usize = 1 << 14;
    let of_chunk = |(chunk, rows): (usize, &[[u32; N]])| {
        (chunk * CHUNK..).zip(rows).map(|(i, &row)| term(i, row)).collect::<Sum>()
    };
    let join = |mut a: Sum, b: Sum| {
        a.join(&b);
        a
    };
    rows.par_chunks(CHUNK).enumerate().map(of_chunk).reduce(Sum::default, join).value()
}
