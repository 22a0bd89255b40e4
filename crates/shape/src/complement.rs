//! The complement of a shape within the whole triangulation.

use std::collections::BTreeMap;

use walpha_base::UnionFind;
use walpha_base::parallel::prelude::*;
use walpha_complex::canonical::sorted;
use walpha_regular::Torus;

use super::copies::{Key, faces, key};
use super::winding::{Winding, WindingSets, minus};
use super::{AlphaShape, Class, Complex};

/// The facets of the cells of some classes as sorted rows, each with its cell; ascending, so that the two cells of a facet are
/// consecutive.
pub(super) fn sides(whole: &Complex, of: impl Fn(Class) -> bool + Sync) -> Vec<([u32; 3], u32)> {
    let mut sides: Vec<([u32; 3], u32)> = whole
        .cells
        .rows()
        .par_iter()
        .zip(whole.cells.classes())
        .coarse()
        .enumerate()
        .filter(|(_, (_, class))| of(**class))
        .flat_map_iter(|(id, (&[a, b, c, d], _))| {
            [[b, c, d], [a, c, d], [a, b, d], [a, b, c]].map(|facet| (sorted(facet), id as u32))
        })
        .collect();
    sides.par_sort_unstable();
    sides
}

/// The complement of a shape within the *whole* triangulation of a torus: exterior cells, and what is
/// [outside](WindingSets::with_outside), joined through exterior facets. Each cell stands for the copy whose first vertex is in the box. What is
/// outside winds round, so that no way to it matters. O(n log n).
pub(super) fn complement_on(torus: Torus, shape: &AlphaShape) -> WindingSets {
    if shape.nearest().is_none() {
        return complement_by_copies(torus, shape);
    }
    let (whole, positions) = (shape.complex(), &shape.points().positions);
    let cells = whole.cells.rows();
    let outside = cells.len() as u32;
    let mut sets = WindingSets::with_outside(cells.len(), torus);
    let sides = sides(whole, |class| class == Class::Exterior);
    let mut pairs = sides.chunk_by(|a, b| a.0 == b.0);
    // Exterior facets are sorted rows in ascending order, so both lists run side by side.
    for facet in whole.facets.of(Class::Exterior) {
        let sides = pairs.find(|sides| sides[0].0 == *facet);
        match sides {
            Some(&[(_, a), (_, b)]) => {
                let pair = [cells[a as usize], cells[b as usize]];
                sets.unite(a, b, between(torus, pair, facet[0], positions));
            }
            Some(&[(_, a)]) => _ = sets.unite(a, outside, [0; 3]),
            _ => unreachable!("an exterior facet has exterior cells beside it"),
        }
    }
    sets
}

/// The complement where rows name copies of points.
fn complement_by_copies(torus: Torus, shape: &AlphaShape) -> WindingSets {
    let whole = shape.complex();
    let outside = whole.cells.len() as u32;
    let mut sets = WindingSets::with_outside(whole.cells.len(), torus);
    let mut sides = BTreeMap::<Key<3>, Vec<(u32, Winding)>>::new();
    for (cell, (&row, class)) in (0..).zip(whole.cells.iter()) {
        if class == Class::Exterior {
            for corners in faces(shape.shifted(row)) {
                let (facet, shift) = key(corners);
                sides.entry(facet).or_default().push((cell, shift));
            }
        }
    }
    for &facet in whole.facets.of(Class::Exterior) {
        match sides.get(&key(shape.shifted(facet)).0).map(|sides| &sides[..]) {
            Some(&[(a, of_a), (b, of_b)]) => _ = sets.unite(a, b, minus(of_a, of_b)),
            Some(&[(a, _)]) => _ = sets.unite(a, outside, [0; 3]),
            _ => unreachable!("an exterior facet has exterior cells beside it"),
        }
    }
    sets
}

/// The translation, in multiples of the vectors, that makes the shared vertex of two cells coincide. Each cell is represented
/// by its copy whose first vertex lies in the box.
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
    /// The number of components, including the outside.
    components: u64,
}

impl Complement {
    /// The number of components, including the outside.
    pub(super) fn components(&self) -> u64 {
        self.components
    }

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
        let sets = UnionFind::new(whole.cells.len() + 1);
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
