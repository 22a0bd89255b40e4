//! Betti numbers of a shape.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use walpha_base::UnionFind;
use walpha_complex::canonical::sorted;
use walpha_regular::Torus;

use super::parts::connected;
use super::winding::{Winding, WindingSets, minus};
use super::{Class, Complex, Sheets};

/// The Betti numbers of a shape: components, tunnels, voids. Written `[b0, b1, b2]`, of a torus
/// `[b0, b1, b2, b3]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "Vec<u64>", try_from = "Vec<u64>")]
pub struct Betti {
    /// Connected components.
    pub b0: u64,
    /// Tunnels: independent loops that bound nothing. On a torus those that go round it, too.
    pub b1: u64,
    /// Voids: bounded components of the complement. On a torus independent closed surfaces that bound
    /// nothing: of a shape that leaves something out, those around the parts of the complement, one less than
    /// there are, and one for each direction in which the complement does not go round.
    pub b2: u64,
    /// On a torus: 1 for the whole of it, else 0. `None` in space, where it is always 0.
    pub b3: Option<u64>,
}

impl Betti {
    /// The Betti numbers of a shape in space.
    pub fn in_space(b0: u64, b1: u64, b2: u64) -> Self {
        Self { b0, b1, b2, b3: None }
    }

    /// The Betti numbers, with b1 from the Euler characteristic: b1 = b0 + b2 − b3 − χ.
    pub(crate) fn with_euler(b0: u64, b2: u64, b3: Option<u64>, euler: i64) -> Self {
        let b1 = (b0 + b2) as i64 - b3.unwrap_or(0) as i64 - euler;
        Self { b0, b1: u64::try_from(b1).expect("b1 counts something"), b2, b3 }
    }
}

impl From<Betti> for [u64; 3] {
    fn from(betti: Betti) -> Self {
        [betti.b0, betti.b1, betti.b2]
    }
}

impl From<Betti> for Vec<u64> {
    fn from(Betti { b0, b1, b2, b3 }: Betti) -> Self {
        [b0, b1, b2].into_iter().chain(b3).collect()
    }
}

impl TryFrom<Vec<u64>> for Betti {
    type Error = &'static str;

    fn try_from(numbers: Vec<u64>) -> Result<Self, Self::Error> {
        match numbers[..] {
            [b0, b1, b2] => Ok(Self::in_space(b0, b1, b2)),
            [b0, b1, b2, b3] => Ok(Self { b0, b1, b2, b3: Some(b3) }),
            _ => Err("three Betti numbers, or four of a torus"),
        }
    }
}

/// The Betti numbers of a shape within its *whole* regular triangulation, exterior simplices
/// included, by direct count: b0 is the number of components; b2 the number of components of the
/// complement less one, counted over exterior cells joined through exterior facets, the outside
/// of the convex hull being one more cell; b1 follows from the Euler characteristic.
///
/// An empty shape has no component, and its complement is one. O(n log n).
pub fn direct_betti(whole: &Complex) -> Betti {
    let b0 = components(whole);
    let b2 = Complement::of(whole).components - 1;
    Betti::with_euler(b0, b2, None, whole.euler_characteristic())
}

/// The Betti numbers of a shape by its sheets, the components of the boundary of a thin neighbourhood of it. A
/// component with k voids of its own has k + 1
/// sheets (Alexander duality), so sheets = b0 + b2, and b1 follows from the Euler characteristic.
/// Every isolated vertex has a sheet of its own. O(n).
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
    let mut sets = connected(complex);
    let of_shape = complex.vertices.iter().filter(|&(_, class)| class != Class::Exterior);
    of_shape.filter(|&(&[v], _)| sets.find(v) == v).count() as u64
}

/// The facets of the cells of some classes as sorted rows, each with its cell; ascending, so that the two
/// cells of a facet are consecutive.
pub(super) fn sides(whole: &Complex, of: impl Fn(Class) -> bool + Sync) -> Vec<([u32; 3], u32)> {
    let mut sides: Vec<([u32; 3], u32)> = whole
        .cells
        .rows()
        .par_iter()
        .zip(whole.cells.classes())
        .enumerate()
        .filter(|(_, (_, class))| of(**class))
        .flat_map_iter(|(id, (&[a, b, c, d], _))| {
            [[b, c, d], [a, c, d], [a, b, d], [a, b, c]].map(|facet| (sorted(facet), id as u32))
        })
        .collect();
    sides.par_sort_unstable();
    sides
}

/// The complement of a shape within the *whole* triangulation of a torus: exterior cells joined through
/// exterior facets. Each cell is where its first vertex is in the box. O(n log n).
pub(super) fn complement_on(torus: Torus, whole: &Complex, positions: &[[f64; 3]]) -> WindingSets {
    let cells = whole.cells.rows();
    let mut sets = WindingSets::new(cells.len());
    let sides = sides(whole, |class| class == Class::Exterior);
    let mut pairs = sides.chunk_by(|a, b| a.0 == b.0);
    // Exterior facets are sorted rows in ascending order, so both lists run side by side.
    for facet in whole.facets.of(Class::Exterior) {
        let pair = pairs.find(|pair| pair[0].0 == *facet);
        let Some(&[(_, a), (_, b)]) = pair else {
            unreachable!("an exterior facet of a torus has exterior cells on both sides")
        };
        let beside = [cells[a as usize], cells[b as usize]];
        sets.unite(a, b, between(torus, beside, facet[0], positions));
    }
    sets
}

/// The multiples of the sides by which the second of two cells must be moved so that a common vertex coincides, where
/// each cell is the copy whose first vertex is in the box.
pub fn between(torus: Torus, cells: [[u32; 4]; 2], vertex: u32, positions: &[[f64; 3]]) -> Winding {
    let way =
        |cell: [u32; 4]| torus.windings(positions[cell[0] as usize], positions[vertex as usize]);
    minus(way(cells[0]), way(cells[1]))
}

/// The complement of a shape within its *whole* triangulation: exterior cells and the outside of the
/// convex hull, joined through exterior facets.
pub(super) struct Complement {
    sets: UnionFind,
    outside: u32,
    /// The number of components, that of the outside included.
    components: u64,
}

impl Complement {
    /// The unbounded component.
    pub(super) fn outside(&mut self) -> u32 {
        self.sets.find(self.outside)
    }

    /// The component of an exterior cell, by its smallest cell.
    pub(super) fn component(&mut self, cell: u32) -> u32 {
        self.sets.find(cell)
    }

    /// Finds the components. O(n log n).
    pub(super) fn of(whole: &Complex) -> Self {
        let sides = sides(whole, |class| class == Class::Exterior);
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
