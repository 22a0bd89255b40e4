//! Betti numbers of a shape.

use walpha_base::UnionFind;
use walpha_base::parallel::prelude::*;

use super::complement::Complement;
use super::copies::Copied;
use super::winding::WindingSets;
use super::{Betti, Class, Complex, Sheets};

/// The Betti numbers of a shape within its *whole* regular triangulation, including exterior simplices, by direct count: b0 is
/// the number of components; b2 is the number of components of the complement less one, counted over exterior cells joined
/// through exterior facets, with the outside of the convex hull as one more cell; b1 follows from the Euler characteristic.
///
/// An empty shape has no component, and its complement is one. O(n log n).
pub fn direct_betti(whole: &Complex) -> Betti {
    let b0 = components(whole);
    let b2 = Complement::of(whole).components() - 1;
    Betti::with_euler(b0, b2, None, whole.euler_characteristic())
}

/// The Betti numbers of a shape from its sheets, the components of the boundary of a thin neighbourhood of it. A component with k
/// voids has k + 1 sheets (Alexander duality), so sheets = b0 + b2, and b1 follows from the Euler characteristic. Every isolated
/// vertex has one more sheet. O(n).
pub(super) fn sheet_betti(complex: &Complex, b0: u64, sheets: &Sheets) -> Betti {
    let lone = complex.vertices.counts().singular;
    let b2 = (sheets.count as usize + lone) as u64 - b0;
    Betti::with_euler(b0, b2, None, complex.euler_characteristic())
}

/// The Betti numbers of a shape of a torus, by its sheets and by the numbers of independent directions in
/// which loops of the shape, and loops on its sheets, wind round. O(n).
///
/// Let N be a thin neighbourhood of the shape K, S its boundary. H₂(N) is H¹(N, S), and in the exact
/// sequence H⁰(N, S) → H⁰(N) → H⁰(S) → H¹(N, S) → H¹(N) → H¹(S) the first is H₃(N): so b2 is
/// sheets − b0 + b3 and the dimension of the kernel of the last map. What is in that kernel comes from
/// a class of the torus that is 0 on S (Mayer and Vietoris: with 0 on the complement it is a class of the
/// whole), and two such classes are one on N if they agree on the loops of K. The classes that are 0 on S
/// have 3 − (directions of S) dimensions, and those of them that are 0 on K, 3 − (directions of K).
pub(super) fn torus_betti(
    complex: &Complex,
    directions: usize,
    sheets: &Sheets,
    sheet_directions: usize,
) -> Betti {
    let b0 = components(complex);
    let whole = complex.cells.counts().in_shape() > 0 && complex.facets.counts().regular == 0;
    let b3 = u64::from(whole);
    let lone = complex.vertices.counts().singular;
    let more = sheets.count as usize + lone + directions;
    let b2 = more as u64 + b3 - b0 - sheet_directions as u64;
    Betti::with_euler(b0, b2, Some(b3), complex.euler_characteristic())
}

/// The Betti numbers of a shape in a plane or on a line, which has no voids.
pub(super) fn flat_betti(complex: &Complex) -> Betti {
    let b0 = components(complex);
    Betti::with_euler(b0, 0, None, complex.euler_characteristic())
}

/// The number of components of the shape, counted by its edges.
pub(super) fn components(complex: &Complex) -> u64 {
    let sets = connected(complex, points(complex));
    let of_shape = complex.vertices.iter().filter(|&(_, class)| class != Class::Exterior);
    of_shape.filter(|&(&[v], _)| sets.find(v) == v).count() as u64
}

/// The vertices of a shape of a torus, united along its edges, each of which is given by its ends and by the multiples of the vectors by which
/// the second is moved.
pub(super) fn connected_on_torus(
    complex: &Complex,
    shifted: impl Fn([u32; 2]) -> [Copied; 2],
) -> WindingSets {
    let mut sets = WindingSets::new(points(complex));
    for (&edge, class) in complex.edges.iter() {
        if class != Class::Exterior {
            let [(a, _), (b, shift)] = shifted(edge);
            sets.unite(a, b, shift);
        }
    }
    sets
}

/// A bound of the indices of vertices.
fn points(complex: &Complex) -> usize {
    complex.vertices.rows().last().map_or(0, |&[v]| v as usize + 1)
}

/// The vertices of a shape of this many points, united along its edges.
pub(super) fn connected(complex: &Complex, points: usize) -> UnionFind {
    let sets = UnionFind::new(points);
    complex.edges.rows().par_iter().zip(complex.edges.classes()).coarse().for_each(
        |(&[a, b], class)| {
            if *class != Class::Exterior {
                sets.unite(a, b);
            }
        },
    );
    sets
}
