use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use walpha_base::Sum;
use walpha_base::vector::{cross, dot, length, sub};
use walpha_regular::Torus;

use super::{Class, Complex, Simplices};

/// Volume and areas of a shape in the units of its points, summed exactly and rounded once. Open, as they are plain
/// numbers.
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
        let measured = |class, facet: [u32; 3]| {
            let area = || facet_area(together(torus, facet.map(at)));
            match class {
                Class::Regular => [area(), 0.0],
                Class::Singular => [0.0, area()],
                Class::Exterior | Class::Interior => [0.0; 2],
            }
        };
        let [area, singular_area] = sums(&complex.facets, measured);
        // Divided last: on a lattice, determinants and their sums are integers.
        let [six_volumes] = sums(&complex.cells, |class, cell| {
            [if class == Class::Interior {
                six_volumes(together(torus, cell.map(at)))
            } else {
                0.0
            }]
        });
        Self { volume: six_volumes / 6.0, area, singular_area }
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

/// Sums of terms of each simplex, exact and rounded once.
fn sums<const N: usize, const K: usize>(
    simplices: &Simplices<N>,
    terms: impl Fn(Class, [u32; N]) -> [f64; K] + Sync,
) -> [f64; K] {
    // Rows summed by one thread at a time.
    const CHUNK: usize = 1 << 14;
    let of_chunk = |(rows, classes): (&[[u32; N]], &[Class])| {
        let mut sums: [Sum; K] = std::array::from_fn(|_| Sum::default());
        for (&row, &class) in rows.iter().zip(classes) {
            sums.iter_mut().zip(terms(class, row)).for_each(|(sum, term)| sum.add(term));
        }
        sums
    };
    let join = |mut sums: [Sum; K], others: [Sum; K]| {
        sums.iter_mut().zip(&others).for_each(|(sum, other)| sum.join(other));
        sums
    };
    let chunks = simplices.rows().par_chunks(CHUNK).zip(simplices.classes().par_chunks(CHUNK));
    let sums = chunks.map(of_chunk).reduce(|| std::array::from_fn(|_| Sum::default()), join);
    sums.map(|sum| sum.value())
}
