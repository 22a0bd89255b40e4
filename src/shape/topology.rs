//! Betti numbers of a shape.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::parts::connected;
use super::union_find::UnionFind;
use super::{Class, Complex, Sheets};

/// The Betti numbers of a shape: components, tunnels, voids. Written `[b0, b1, b2]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "[u64; 3]", from = "[u64; 3]")]
pub struct Betti {
    /// Connected components.
    pub b0: u64,
    /// Tunnels (independent loops that bound nothing).
    pub b1: u64,
    /// Voids (bounded components of the complement).
    pub b2: u64,
}

impl From<Betti> for [u64; 3] {
    fn from(betti: Betti) -> Self {
        [betti.b0, betti.b1, betti.b2]
    }
}

impl From<[u64; 3]> for Betti {
    fn from([b0, b1, b2]: [u64; 3]) -> Self {
        Self { b0, b1, b2 }
    }
}

/// The Betti numbers of a shape within its *whole* regular triangulation, exterior simplices
/// included, by direct count: b0 is the number of components; b2 the number of components of the
/// complement less one, counted over exterior cells joined through exterior facets, the outside
/// of the convex hull being one more cell; b1 follows from the Euler characteristic.
///
/// An empty shape has no component, and its complement is one. O(n log n).
#[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
pub fn direct_betti(whole: &Complex) -> Betti {
    let b0 = components(whole);
    let b2 = Complement::of(whole).components - 1;
    let b1 = (b0 + b2) as i64 - whole.euler_characteristic();
    Betti { b0, b1: u64::try_from(b1).expect("b1 counts something"), b2 }
}

/// The Betti numbers of a shape by its sheets: the connected pieces of its outside seen closely, or
/// of the boundary of a thin neighbourhood of it. A component with k voids of its own has k + 1
/// sheets (Alexander duality), so sheets = b0 + b2, and b1 follows from the Euler characteristic.
/// Every isolated vertex has a sheet of its own. O(n).
pub(super) fn sheet_betti(complex: &Complex, b0: u64, sheets: &Sheets) -> Betti {
    let lone = complex.vertices.counts().singular;
    let b2 = (sheets.count as usize + lone) as u64 - b0;
    let b1 = (b0 + b2) as i64 - complex.euler_characteristic();
    Betti { b0, b1: u64::try_from(b1).expect("b1 counts something"), b2 }
}

/// The Betti numbers of a shape in a plane or on a line, which has no voids.
pub(super) fn flat_betti(complex: &Complex) -> Betti {
    let b0 = components(complex);
    let b1 = b0 as i64 - complex.euler_characteristic();
    Betti { b0, b1: u64::try_from(b1).expect("b1 counts something"), b2: 0 }
}

/// Components of the shape, by its edges.
fn components(complex: &Complex) -> u64 {
    let mut sets = connected(complex);
    let of_shape = complex.vertices.iter().filter(|&(_, class)| class != Class::Exterior);
    of_shape.filter(|&(&[v], _)| sets.find(v) == v).count() as u64
}

/// The complement of a shape within its *whole* triangulation: exterior cells and the outside of the
/// convex hull, joined through exterior facets.
pub(super) struct Complement {
    sets: UnionFind,
    outside: u32,
    /// How many there are, the outside's own among them.
    components: u64,
}

impl Complement {
    /// The component that is not bounded.
    pub(super) fn outside(&mut self) -> u32 {
        self.sets.find(self.outside)
    }

    /// The component of an exterior cell, named by its first cell.
    pub(super) fn component(&mut self, cell: u32) -> u32 {
        self.sets.find(cell)
    }

    /// Finds the components. O(n log n).
    pub(super) fn of(whole: &Complex) -> Self {
        // Each facet of each exterior cell, so that the cells at one facet stand side by side.
        let mut sides: Vec<([u32; 3], u32)> = whole
            .cells
            .rows()
            .par_iter()
            .zip(whole.cells.classes())
            .enumerate()
            .filter(|(_, (_, class))| **class == Class::Exterior)
            .flat_map_iter(|(id, (&cell, _))| {
                (0..4).map(move |skip| {
                    let mut facet = [1, 2, 3].map(|step| cell[(skip + step) % 4]);
                    facet.sort_unstable();
                    (facet, id as u32)
                })
            })
            .collect();
        sides.par_sort_unstable();

        let outside = whole.cells.len() as u32;
        let mut sets = UnionFind::new(whole.cells.len() + 1);
        let exterior_cells = whole.cells.counts().exterior;
        let mut united = 0;
        let mut at = 0;
        // Exterior facets are sorted rows in ascending order, so both lists run side by side.
        for facet in whole.facets.of(Class::Exterior) {
            while at < sides.len() && sides[at].0 < *facet {
                at += 1;
            }
            let cells: Vec<u32> =
                sides[at..].iter().take_while(|side| side.0 == *facet).map(|side| side.1).collect();
            let (a, b) = match cells[..] {
                [a, b] => (a, b),
                [a] => (a, outside),
                _ => unreachable!(
                    "an exterior facet has exterior cells on both sides, or the outside"
                ),
            };
            united += u64::from(sets.unite(a, b));
        }
        Self { sets, outside, components: exterior_cells as u64 + 1 - united }
    }
}
