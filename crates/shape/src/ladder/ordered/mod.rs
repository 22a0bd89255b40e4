//! All simplices of a filtration in the order in which they enter.

mod cech;
mod cycles;
mod gradient;
mod intervals;
mod loops;
mod numbers;
mod pairs;
mod pores;
mod rank;

use std::sync::OnceLock;

use walpha_base::parallel::prelude::*;
use walpha_base::parallel::{FEW, in_pool, join};
use walpha_base::sort::sort_handful_by;
use walpha_base::{Monitor, memory};
use walpha_complex::canonical::sorted;
use walpha_regular::TriangulationError;

use super::build::{Radii, Radius};
use super::levels::OwnLevels;
use super::{Filtration, Levels};
use crate::derived::Derived;
use crate::{Alpha, AlphaShape, Betti, ShapeError};
pub use cycles::{Cycles, LoopCycle, VoidCycle};
pub use gradient::Derivative;
pub use intervals::Interval;
pub use loops::Loops;
use numbers::Numbers;
pub use pores::{PorePart, PoreSphere, Pores};
use rank::{NONE, Ranks};

/// All simplices of a regular triangulation with their values of α: each simplex has the values at which it enters the shape,
/// becomes regular, and becomes interior.
///
/// A *value* is a squared radius, given as the double nearest to the exact number (of two equally near ones, the even one). The
/// order is by the exact number, then by dimension, then by vertices. So faces precede their cofaces, and even simplices whose
/// values differ by less than doubles can resolve are in the right order.
///
/// The double nearest to a value may be below it: the shape at exactly this α, [`Filtration::shape`], may contain the simplex or
/// not. [`Filtration::curve`] has doubles that are not below.
///
/// Simplices have *numbers*: vertices first, then edges, facets, cells; those of one dimension in
/// lexicographic order of their vertices, which ascend in each.
#[derive(Debug)]
pub struct Ordered<'a> {
    /// A level for each value.
    pub(super) levels: Levels<'a>,
    numbers: Numbers,
    cells: Vec<[u32; 4]>,
    /// The row of each of them in the triangulation.
    cell_rows: Vec<u32>,
    order: Vec<u32>,
    pairs: Derived<Pairs>,
    loops: OnceLock<Loops>,
}

/// A simplex and when it enters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Entry<'a> {
    /// Input indices, ascending.
    pub vertices: &'a [u32],
    /// The α, a squared length, from which on it is in the shape, rounded to the nearest double.
    pub value: f64,
    /// The rank of the exact value among all values, from 0; equal for equal numbers only.
    pub rank: u32,
    /// Whether no point lies inside its smallest orthogonal sphere, so that the value is the squared radius of this sphere;
    /// otherwise the simplex enters with a coface, and is *attached*.
    pub gabriel: bool,
    /// The value from which on it is a face of another simplex of the shape; it is singular before. ∞ for cells.
    pub regular: f64,
    /// The value from which on it is not on the boundary; ∞ on the convex hull. For cells, this equals `value`.
    pub interior: f64,
}

/// Persistence pairs by the numbers of simplices: the simplex that creates a component or void, and the one that merges
/// it with an older component, or fills it.
///
/// Pairs of persistence 0, whose simplices have the same value, are included.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Pairs {
    /// Components: a vertex, and the edge that unites its component with an earlier one; in the order of edges. All vertices but
    /// one have such an edge.
    pub components: Vec<[u32; 2]>,
    /// The vertex whose component is essential: one.
    pub lasting: Vec<u32>,
    /// Voids: a facet, and the cell that fills the enclosed void; in the order of facets. All cells have such a facet; on a torus
    /// all but one.
    pub voids: Vec<[u32; 2]>,
    /// On a torus: the facets that create its three essential classes of dimension 2.
    pub lasting_voids: Vec<u32>,
    /// On a torus: the last cell, which creates its class of dimension 3, and is in none of the pairs above.
    pub last: Option<u32>,
}

impl Filtration {
    /// All simplices with their values, in order. O(n log n), plus exact arithmetic for values that are equal or nearly equal.
    ///
    /// # Errors
    /// Out of memory; more simplices than 32-bit numbers.
    pub fn simplices(&self) -> Result<Ordered<'_>, ShapeError> {
        let monitor = &*Monitor::current();
        in_pool(self.points().len(), || self.in_order(monitor))
    }

    fn in_order(&self, monitor: &Monitor) -> Result<Ordered<'_>, ShapeError> {
        let complex = self.whole.complex();
        let numbers = Numbers::of(complex).ok_or(TriangulationError::TooManyCells)?;
        memory::afford(Ordered::bytes(numbers), || {
            format!("the order of {} simplices", numbers.all())
        })?;
        let done = |parts| monitor.report(parts, 4);
        let (levels, (cells, cell_rows)) = join(
            numbers.all(),
            || {
                let Ranks { values, of } = Ranks::of(self, numbers)?;
                done(2)?;
                Ok::<_, ShapeError>(self.levels_by_rank(&values, &of, numbers))
            },
            || sorted_cells(&self.whole),
        );
        let levels = levels?;
        done(3)?;
        let mut ordered = Ordered {
            levels,
            numbers,
            cells,
            cell_rows,
            order: Vec::new(),
            pairs: Derived::default(),
            loops: OnceLock::new(),
        };
        ordered.order =
            by_rank(numbers.all(), ordered.levels.len(), |simplex| ordered.rank(simplex));
        done(4)?;
        Ok(ordered)
    }

    /// A level for each rank.
    fn levels_by_rank(&self, values: &[f64], ranks: &[u32], numbers: Numbers) -> Levels<'_> {
        let of = |from: u32| {
            move |row: usize| Some(ranks[from as usize + row]).filter(|&rank| rank != NONE)
        };
        let [vertices, edges, facets, cells] = numbers.first;
        let cells = ranks[cells as usize..].to_vec();
        let own = OwnLevels { facets: of(facets), edges: of(edges), vertices: of(vertices) };
        let (facets, edges, vertices) = self.spans(values.len() as u32, &cells, own);
        let alpha = |&value: &f64| Alpha::from_squared(value).expect("radii are numbers");
        let alphas = values.iter().map(alpha).collect();
        Levels { filtration: self, alphas, cells, facets, edges, vertices }
    }
}

/// Cells with ascending vertices in lexicographic order, and the row of each. They come in the
/// order of rows whose last two vertices may be exchanged; where rows name copies of points, by point and shift.
fn sorted_cells(whole: &AlphaShape) -> (Vec<[u32; 4]>, Vec<u32>) {
    let rows = whole.complex().cells.rows();
    if !whole.copies().is_empty() {
        let sorted = |&row: &[u32; 4]| {
            let mut row = row;
            sort_handful_by(&mut row, |&v, &w| whole.copied(v).cmp(&whole.copied(w)));
            row
        };
        return (rows.iter().map(sorted).collect(), (0..rows.len() as u32).collect());
    }
    let mut numbered: Vec<_> =
        rows.par_iter().coarse().map(|row| sorted(*row)).zip(0..rows.len() as u32).collect();
    let is_near = |(a, _): &([u32; 4], u32), (b, _): &([u32; 4], u32)| a[..2] == b[..2];
    if numbered.len() > FEW {
        numbered.par_chunk_by_mut(is_near).for_each(<[_]>::sort_unstable);
    } else {
        numbered.chunk_by_mut(is_near).for_each(<[_]>::sort_unstable);
    }
    numbered.into_par_iter().coarse().unzip()
}

impl Ordered<'_> {
    /// The number of bytes that are needed at the same time.
    fn bytes(numbers: Numbers) -> usize {
        let span = 3 * size_of::<u32>();
        let parts = [
            Ranks::bytes(numbers.all()),
            numbers.all().saturating_mul(span + size_of::<u32>()),
            numbers.count(3).saturating_mul(2 * (size_of::<[u32; 4]>() + size_of::<u32>())),
        ];
        parts.into_iter().fold(0, usize::saturating_add)
    }

    /// The filtration.
    pub fn filtration(&self) -> &Filtration {
        self.levels.filtration
    }

    /// The number of simplices.
    pub fn len(&self) -> usize {
        self.numbers.all()
    }

    /// Whether there are no simplices.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of simplices of a dimension.
    ///
    /// # Panics
    /// If it is above 3.
    pub fn count(&self, dimension: usize) -> usize {
        self.numbers.count(dimension)
    }

    /// The number of Gabriel simplices of a dimension.
    ///
    /// # Panics
    /// If it is above 3.
    pub fn gabriel(&self, dimension: usize) -> usize {
        let Radii { vertices, edges, facets, .. } = &self.filtration().radii;
        let own = |radii: &[Radius]| radii.iter().filter(|radius| radius.known().is_some()).count();
        match dimension {
            0 => own(vertices),
            1 => own(edges),
            2 => own(facets),
            _ => self.numbers.count(dimension),
        }
    }

    /// The vertices, a row each.
    pub fn vertices(&self) -> &[[u32; 1]] {
        self.filtration().whole.complex().vertices.rows()
    }

    /// The edges.
    pub fn edges(&self) -> &[[u32; 2]] {
        self.filtration().whole.complex().edges.rows()
    }

    /// The facets.
    pub fn facets(&self) -> &[[u32; 3]] {
        &self.filtration().incidence.facets
    }

    /// The cells.
    pub fn cells(&self) -> &[[u32; 4]] {
        &self.cells
    }

    /// The distinct exact values, ascending, by rank, as nearest doubles: consecutive ones may be equal doubles.
    pub fn values(&self) -> &[Alpha] {
        self.levels.alphas()
    }

    /// The numbers of all simplices in the order in which they enter.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// A simplex by its number.
    ///
    /// # Panics
    /// If no simplex has this number.
    pub fn simplex(&self, number: u32) -> Entry<'_> {
        let value = |rank: u32| {
            self.values().get(rank as usize).map_or(f64::INFINITY, |value| value.squared())
        };
        let (vertices, span) = match self.numbers.row(number) {
            (0, row) => (&self.vertices()[row][..], self.levels.vertices[row]),
            (1, row) => (&self.edges()[row][..], self.levels.edges[row]),
            (2, row) => (&self.facets()[row][..], self.levels.facets[row]),
            (_, row) => {
                let first = self.levels.cells[self.cell_rows[row] as usize];
                let (value, vertices) = (value(first), &self.cells[row]);
                let (regular, interior) = (f64::INFINITY, value);
                return Entry { vertices, value, rank: first, gabriel: true, regular, interior };
            }
        };
        let [value, regular, interior] = [span.first, span.regular, span.interior].map(value);
        let gabriel = self.is_gabriel(number);
        Entry { vertices, value, rank: span.first, gabriel, regular, interior }
    }

    /// All simplices in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Entry<'_>> + '_ {
        self.order.iter().map(|&number| self.simplex(number))
    }

    /// The Betti numbers from each value on, by rank. O(n α(n)).
    pub fn betti_curve(&self) -> Vec<Betti> {
        self.levels.betti()
    }

    fn is_gabriel(&self, number: u32) -> bool {
        let radii = &self.filtration().radii;
        match self.numbers.row(number) {
            (0, row) => radii.vertices[row].known().is_some(),
            (1, row) => radii.edges[row].known().is_some(),
            (2, row) => radii.facets[row].known().is_some(),
            _ => true,
        }
    }

    /// The rank of a simplex's value.
    fn rank(&self, simplex: u32) -> u32 {
        match self.numbers.row(simplex) {
            (0, row) => self.levels.vertices[row].first,
            (1, row) => self.levels.edges[row].first,
            (2, row) => self.levels.facets[row].first,
            (_, row) => self.levels.cells[self.cell_rows[row] as usize],
        }
    }
}

/// Number of ranges of ranks, which are sorted separately. They are few enough to be written to at the same time.
const PARTS: usize = 256;
/// Numbers that one task distributes to the ranges.
const CHUNK: usize = 1 << 20;

/// The numbers 0..`all`, stably sorted by rank; all ranks are below `ranks`.
///
/// Two counting sorts: into ranges of consecutive ranks, and within each range, where counters fit a cache. O(n).
pub(super) fn by_rank(all: usize, ranks: usize, rank: impl Fn(u32) -> u32 + Sync) -> Vec<u32> {
    if all <= 4 * FEW {
        return counted(&(0..all as u32).map(rank).collect::<Vec<_>>(), ranks);
    }
    let shift = ranks.div_ceil(PARTS).next_power_of_two().ilog2();
    let distribute = |from: usize| {
        let to = all.min(from + CHUNK);
        let expected = (to - from) / PARTS;
        let mut parts: Vec<_> = (0..PARTS).map(|_| Vec::with_capacity(expected)).collect();
        for simplex in from as u32..to as u32 {
            let rank = rank(simplex);
            parts[(rank >> shift) as usize].push([rank, simplex]);
        }
        parts
    };
    let chunks: Vec<usize> = (0..all).step_by(CHUNK).collect();
    let chunks: Vec<Vec<Vec<[u32; 2]>>> = chunks.into_par_iter().map(distribute).collect();
    let mut order = vec![0; all];
    let mut rest = &mut order[..];
    let mut parts = Vec::with_capacity(PARTS);
    for part in 0..PARTS {
        let size = chunks.iter().map(|chunk| chunk[part].len()).sum();
        let (here, after) = std::mem::take(&mut rest).split_at_mut(size);
        parts.push(here);
        rest = after;
    }
    parts.into_par_iter().enumerate().for_each(|(part, order)| {
        let members = || chunks.iter().flat_map(|chunk| &chunk[part]);
        let offset = |rank: u32| rank as usize - (part << shift);
        let mut next = vec![0_usize; (1 << shift) + 1];
        members().for_each(|&[rank, _]| next[offset(rank) + 1] += 1);
        for rank in 1..next.len() {
            next[rank] += next[rank - 1];
        }
        for &[rank, simplex] in members() {
            let next = &mut next[offset(rank)];
            order[*next] = simplex;
            *next += 1;
        }
    });
    order
}

/// The same for few, of these ranks, by one counting sort.
fn counted(ranks: &[u32], count: usize) -> Vec<u32> {
    let mut next = vec![0_u32; count + 1];
    ranks.iter().for_each(|&rank| next[rank as usize + 1] += 1);
    for rank in 1..=count {
        next[rank] += next[rank - 1];
    }
    let mut order = vec![0; ranks.len()];
    for (simplex, &rank) in (0..).zip(ranks) {
        let next = &mut next[rank as usize];
        order[*next as usize] = simplex;
        *next += 1;
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_sorted_stably() {
        for (all, ranks) in [
            (0, 0),
            (1, 1),
            (1000, 3),
            (1000, 256),
            (5000, 1000),
            (20_000, 9000),
            (CHUNK + 9, 70_000),
        ] {
            let rank = |simplex: u32| (simplex.wrapping_mul(2_654_435_761) >> 7) % ranks as u32;
            let mut wanted: Vec<u32> = (0..all as u32).collect();
            wanted.sort_by_key(|&simplex| rank(simplex));
            assert!(by_rank(all, ranks, rank) == wanted, "{all} numbers of {ranks} ranks");
        }
    }
}
