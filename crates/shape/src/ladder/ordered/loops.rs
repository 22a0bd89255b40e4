//! Persistence pairs of dimension 1, by reducing a matrix (Edelsbrunner, Letscher and Zomorodian 2002,
//! doi:10.1007/s00454-002-2885-2).
//!
//! The pairs of dimensions 0 and 2, which are known, leave little of the matrix. Only facets that end a loop have a column
//! (clearing, Chen and Kerber 2011), and only edges that begin a loop have a row, because an edge that ends a component is never
//! the last of a reduced column (compression, Bauer, Kerber and Reininghaus 2014, doi:10.1007/978-3-319-04099-8_7). So no column
//! is reduced to nothing, and each is one pair.
//!
//! In space, all fields give the same pairs. On a torus Z/2 would give others: surfaces with one side lie in it, and voids are
//! found by directions of whole numbers. So coefficients are in Z/p, p = 2³¹ − 1, which stands for rational numbers: no torsion
//! of a set of points has that order. The current column has a tree of bits for the numbers that are not 0, whose largest member
//! is found in a few steps (Bauer, Kerber, Reininghaus and Wagner 2017, doi:10.1016/j.jsc.2016.03.008).

use std::ops::Range;

use walpha_base::Monitor;
use walpha_base::memory::{self, NoMemory};

use super::Ordered;
use crate::ShapeError;

/// Persistence pairs of loops, by the numbers of simplices. Coefficients are rational; in space any other field gives the same
/// pairs.
///
/// Pairs of persistence 0, whose simplices have the same value, are included.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Loops {
    /// An edge that closes a loop, and the facet that fills it; in the order of facets.
    pub pairs: Vec<[u32; 2]>,
    /// On a torus: the edges that create its three essential classes of dimension 1.
    pub lasting: Vec<u32>,
}

/// Stands for a row whose edge no column ends with.
const NONE: u32 = u32::MAX;

impl Ordered<'_> {
    /// Persistence pairs of dimension 1. Computed once.
    ///
    /// This takes one thread. No bound below O(n³) is known; for alpha filtrations it takes about as long as
    /// [`Filtration::simplices`](crate::ladder::Filtration::simplices).
    ///
    /// # Errors
    /// Out of memory.
    pub fn loops(&self) -> Result<&Loops, ShapeError> {
        let monitor = &*Monitor::current();
        if let Some(loops) = self.loops.get() {
            return Ok(loops);
        }
        let (loops, _) = self.reduce(monitor)?;
        Ok(self.loops.get_or_init(|| loops))
    }

    /// The pairs, and the reduced matrix.
    pub(super) fn reduce(&self, monitor: &Monitor) -> Result<(Loops, Reduced), ShapeError> {
        let [_, of_edges, of_facets, of_cells] = self.numbers.first;
        let pairs = self.pairs();
        let mut is_paired = vec![false; self.len()];
        for &number in pairs.components.iter().chain(&pairs.voids).flatten() {
            is_paired[number as usize] = true;
        }
        pairs.lasting_voids.iter().for_each(|&facet| is_paired[facet as usize] = true);
        let left = |from: u32, to: u32| {
            let of_dimension = move |number: &&u32| (from..to).contains(*number);
            self.order.iter().filter(of_dimension).copied().filter(|&n| !is_paired[n as usize])
        };

        // Rows are edges in order.
        let edges: Vec<u32> = left(of_edges, of_facets).collect();
        let mut rows = vec![NONE; self.numbers.count(1)];
        edges.iter().zip(0..).for_each(|(&edge, row)| rows[(edge - of_edges) as usize] = row);
        let facets: Vec<u32> = left(of_facets, of_cells).collect();
        let work = monitor.units(facets.len() as u64);

        let mut reduced = Columns::new(edges.len());
        let mut column = Column::new(edges.len());
        let mut found = Vec::with_capacity(facets.len());
        for facet in facets {
            work.add(1)?;
            let boundary = self.filtration().incidence.facet_edges[(facet - of_facets) as usize];
            // Vertices ascend in facets and edges, so the boundary of abc is bc − ac + ab.
            for (edge, sign) in boundary.into_iter().zip([1, PRIME - 1, 1]) {
                match rows[edge as usize] {
                    NONE => {}
                    row => column.add(row, sign),
                }
            }
            let last = loop {
                let last = column.rows.last().expect("this facet ends a loop");
                let Some(members) = reduced.ending_with(last) else { break last };
                let factor = PRIME - column.values[last as usize];
                for &(row, value) in members {
                    column.add(row, times(factor, value));
                }
            };
            found.push([edges[last as usize], facet]);
            reduced.take(last, &mut column)?;
        }
        let lasting = (0..).zip(&edges).filter(|&(row, _)| reduced.ending_with(row).is_none());
        let lasting = lasting.map(|(_, &edge)| edge).collect();
        let reduced = Reduced { columns: reduced, edges, rows, first: of_edges };
        Ok((Loops { pairs: found, lasting }, reduced))
    }
}

/// The reduced boundary matrix of the facets that end loops, on the edges that begin loops.
#[derive(Debug)]
pub(super) struct Reduced {
    columns: Columns,
    /// The edge of each row, by number.
    edges: Vec<u32>,
    /// The row of each edge.
    rows: Vec<u32>,
    /// The number of the first edge.
    first: u32,
}

impl Reduced {
    /// The column whose youngest edge is this one: the edges with their coefficients, 1 of this one; `None` if no facet ends its loop.
    pub(super) fn column(&self, edge: u32) -> Option<Vec<(u32, u32)>> {
        let row = self.rows[(edge - self.first) as usize];
        let members = self.columns.ending_with(Some(row).filter(|&row| row != NONE)?)?;
        Some(members.iter().map(|&(row, value)| (self.edges[row as usize], value)).collect())
    }
}

/// Reduced columns by their last rows.
#[derive(Debug)]
struct Columns {
    /// For each last row, the range of the column among the members; empty if there is none.
    ranges: Vec<Range<usize>>,
    /// The rows of all columns with their coefficients: those of each descending, the first coefficient 1.
    members: Vec<(u32, u32)>,
}

impl Columns {
    fn new(rows: usize) -> Self {
        Self { ranges: vec![0..0; rows], members: Vec::new() }
    }

    /// The rows of the column with this last one.
    fn ending_with(&self, last: u32) -> Option<&[(u32, u32)]> {
        let members = &self.members[self.ranges[last as usize].clone()];
        (!members.is_empty()).then_some(members)
    }

    /// Moves a column here, which is empty afterwards.
    fn take(&mut self, last: u32, column: &mut Column) -> Result<(), NoMemory> {
        let from = self.members.len();
        let scale = inverse(column.values[last as usize]);
        while let Some(row) = column.rows.last() {
            memory::try_reserve(&mut self.members, 1, || {
                "the reduced boundaries of facets".into()
            })?;
            let value = column.values[row as usize];
            self.members.push((row, times(scale, value)));
            column.add(row, PRIME - value);
        }
        self.ranges[last as usize] = from..self.members.len();
        Ok(())
    }
}

/// The order of the field of coefficients.
pub(super) const PRIME: u32 = (1 << 31) - 1;

/// The sum in the field.
pub(super) fn plus_mod(a: u32, b: u32) -> u32 {
    ((u64::from(a) + u64::from(b)) % u64::from(PRIME)) as u32
}

/// The product in the field.
fn times(a: u32, b: u32) -> u32 {
    (u64::from(a) * u64::from(b) % u64::from(PRIME)) as u32
}

/// The inverse in the field: a to the power of p − 2.
pub(super) fn inverse(a: u32) -> u32 {
    // Nearly all are 1 or −1.
    if a == 1 || a == PRIME - 1 {
        return a;
    }
    let (mut power, mut product, mut exponent) = (a, 1, PRIME - 2);
    while exponent > 0 {
        if exponent % 2 == 1 {
            product = times(product, power);
        }
        power = times(power, power);
        exponent /= 2;
    }
    product
}

/// The column that is being reduced.
struct Column {
    /// The rows of the coefficients that are not 0.
    rows: BitTree,
    /// The coefficient of each row.
    values: Vec<u32>,
}

impl Column {
    fn new(rows: usize) -> Self {
        Self { rows: BitTree::new(rows), values: vec![0; rows] }
    }

    fn add(&mut self, row: u32, value: u32) {
        let own = &mut self.values[row as usize];
        let before = *own;
        *own = plus_mod(before, value);
        if (before == 0) != (*own == 0) {
            self.rows.toggle(row);
        }
    }
}

/// A set of numbers. Each bit of a level says whether a word of the level below has bits.
struct BitTree {
    /// The levels of the tree, from the numbers up to a single word.
    levels: Vec<Vec<u64>>,
}

impl BitTree {
    /// An empty set of numbers below a bound.
    fn new(bound: usize) -> Self {
        let mut levels = vec![vec![0; bound.div_ceil(64).max(1)]];
        while let Some(words) = levels.last().map(Vec::len).filter(|&words| words > 1) {
            levels.push(vec![0; words.div_ceil(64)]);
        }
        Self { levels }
    }

    /// Adds a number, or removes it if it is there.
    fn toggle(&mut self, number: u32) {
        let mut at = number as usize;
        for level in &mut self.levels {
            let word = &mut level[at / 64];
            let had = *word != 0;
            *word ^= 1 << (at % 64);
            if had && *word != 0 {
                break;
            }
            at /= 64;
        }
    }

    /// The largest number.
    fn last(&self) -> Option<u32> {
        let mut at = 0;
        for level in self.levels.iter().rev() {
            at = at * 64 + level[at].checked_ilog2()? as usize;
        }
        Some(at as u32)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use walpha_base::random::Random;

    use super::*;

    #[test]
    fn inverses_multiply_to_one() {
        for a in [1, 2, 3, 1 << 16, PRIME / 2, PRIME - 2, PRIME - 1] {
            assert_eq!(times(a, inverse(a)), 1, "{a}");
        }
    }

    #[test]
    fn a_tree_of_bits_is_a_set() {
        let mut random = Random::new(3);
        for bound in [1, 64, 65, 4096, 4097, 300_000] {
            let (mut tree, mut set) = (BitTree::new(bound), BTreeSet::new());
            for _ in 0..2000 {
                // Also use numbers near the last one, so that words become empty.
                let number = match tree.last() {
                    Some(last) if random.below(2) == 0 => last,
                    _ => random.below(bound) as u32,
                };
                tree.toggle(number);
                if !set.remove(&number) {
                    set.insert(number);
                }
                assert_eq!(tree.last(), set.last().copied(), "below {bound}");
            }
        }
    }
}
