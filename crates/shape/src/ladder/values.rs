//! The critical values of a filtration, distinguished exactly.

use std::collections::HashMap;

use walpha_base::parallel::prelude::*;
use walpha_base::sort::sort_handful_by;
use walpha_regular::Torus;
use walpha_regular::internals::number::lowest_bit;
use walpha_regular::internals::{Interval, Predicates};

use super::Filtration;
use super::build::{Radii, Radius};
use crate::Alpha;
use crate::WeightedPoints;

/// A critical value of α, as precisely as needed.
#[derive(Clone, Copy, Debug)]
pub(super) enum Value {
    /// The smallest double that is not below it.
    First(f64),
    /// The value of a simplex whose interval overlaps no other, and the upper end of the interval.
    Of(Row, f64),
}

/// A simplex of the whole triangulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Row {
    Cell(u32),
    Facet(u32),
    Edge(u32),
    Vertex(u32),
}

impl Value {
    /// A double at or above the value, and below the next.
    pub(super) fn above(self) -> f64 {
        match self {
            Self::First(alpha) | Self::Of(_, alpha) => alpha,
        }
    }
}

impl Filtration {
    /// All critical values, ascending; values between the same two doubles are one. Radii whose intervals overlap no other are
    /// sorted by interval, all others by exact arithmetic.
    pub(super) fn values(&self) -> Vec<Value> {
        let radii = self.sorted_radii();
        let spheres = self.spheres();
        let exact = is_small_lattice(self.points(), self.torus());
        let firsts = Firsts { filtration: self, spheres: &spheres, exact };
        let split = |known: &mut HashMap<Key, f64>, cluster: &&[(f64, Row)]| match cluster {
            [(radius, row)] => vec![Value::Of(*row, Interval::around(*radius).high)],
            several => {
                let first = |(_, row): &(f64, Row)| firsts.of(*row, known);
                let mut alphas: Vec<f64> = several.iter().map(first).collect();
                alphas.sort_by(f64::total_cmp);
                alphas.dedup();
                alphas.into_iter().map(Value::First).collect()
            }
        };
        clusters(&radii, |(radius, _)| *radius)
            .par_iter()
            .coarse()
            .map_init(HashMap::new, split)
            .flatten_iter()
            .collect()
    }

    /// About `most` of the critical values, with ranks as even as possible, without exact arithmetic: for values that rounded
    /// radii do not distinguish, a double just above the last one.
    pub(super) fn some_values(&self, most: usize) -> Vec<Value> {
        let Radii { cells, facets, edges, vertices } = &self.radii;
        let lower = [facets, edges, vertices].into_par_iter().flatten().filter_map(|r| r.known());
        let mut radii: Vec<f64> = cells.par_iter().copied().chain(lower).collect();
        // Numbers alone are sorted in a fraction of the time that intervals with their simplices take.
        radii.par_sort_unstable_by(f64::total_cmp);
        radii.dedup();
        let clusters = clusters(&radii, |&radius| radius);
        let ranks = even_ranks(clusters.len() - 1, most);
        let above = |rank: usize| {
            let highs = clusters[rank].iter().map(|&radius| Interval::around(radius).high);
            Value::First(highs.fold(f64::NEG_INFINITY, f64::max))
        };
        ranks.into_iter().map(above).collect()
    }

    /// The squared radii of all spheres that are empty, ascending.
    fn sorted_radii(&self) -> Vec<(f64, Row)> {
        let own = |radii: &[Radius], row: fn(u32) -> Row| -> Vec<(f64, Row)> {
            let known = radii.par_iter().coarse().enumerate();
            known.filter_map(|(i, radius)| Some((radius.known()?, row(i as u32)))).collect()
        };
        let mut radii = own(&self.radii.facets, Row::Facet);
        radii.extend(own(&self.radii.edges, Row::Edge));
        radii.extend(own(&self.radii.vertices, Row::Vertex));
        radii.extend((0..).zip(&self.radii.cells).map(|(i, &radius)| (radius, Row::Cell(i))));
        radii.par_sort_unstable_by(|(a, i), (b, j)| a.total_cmp(b).then(i.cmp(j)));
        radii
    }

    /// The smallest double that is not below a value.
    pub(super) fn first_alpha(&self, value: Value) -> Alpha {
        let first = match value {
            Value::First(alpha) => alpha,
            Value::Of(row, _) => {
                let spheres = self.spheres();
                Firsts { filtration: self, spheres: &spheres, exact: false }
                    .of(row, &mut HashMap::new())
            }
        };
        Alpha::from_squared(first).expect("radii are numbers")
    }
}

/// About `most` ranks from 0 to the last, as even as possible.
fn even_ranks(last: usize, most: usize) -> Vec<usize> {
    // The product may exceed 32 bits.
    let rank = |k: usize| (k as u64 * last as u64 / (most as u64 - 1)) as usize;
    let mut ranks: Vec<usize> = (0..most).map(rank).collect();
    ranks.dedup();
    ranks
}

/// Runs of elements, with ascending radii, whose intervals overlap.
fn clusters<T>(sorted: &[T], radius: impl Fn(&T) -> f64) -> Vec<&[T]> {
    let mut high = f64::NEG_INFINITY;
    let mut starts: Vec<usize> = Vec::new();
    for (at, radius) in sorted.iter().map(radius).map(Interval::around).enumerate() {
        if starts.is_empty() || radius.low > high {
            starts.push(at);
        }
        high = high.max(radius.high);
    }
    let ends = starts.iter().copied().skip(1).chain([sorted.len()]);
    starts.iter().zip(ends).map(|(&from, to)| &sorted[from..to]).collect()
}

/// Bits of the weights of up to four corners and their up to six squared distances, which determine the radius.
pub(super) type Key = [u64; 10];

struct Firsts<'a> {
    filtration: &'a Filtration,
    spheres: &'a Predicates<'a>,
    /// Whether squared distances are exact in doubles.
    exact: bool,
}

impl Firsts<'_> {
    /// The smallest double that is not below the squared radius of a simplex. On a lattice, most simplices are congruent to an
    /// earlier one.
    fn of(&self, row: Row, known: &mut HashMap<Key, f64>) -> f64 {
        let Filtration { whole, incidence, .. } = self.filtration;
        let complex = whole.complex();
        match row {
            Row::Cell(i) => self.first(complex.cells.rows()[i as usize], known),
            Row::Facet(i) => self.first(incidence.facets[i as usize], known),
            Row::Edge(i) => self.first(complex.edges.rows()[i as usize], known),
            Row::Vertex(i) => self.first(complex.vertices.rows()[i as usize], known),
        }
    }

    fn first<const N: usize>(&self, simplex: [u32; N], known: &mut HashMap<Key, f64>) -> f64 {
        // Adding 0.0 turns −0 into 0.
        let exactly = || self.spheres.first_alpha(simplex) + 0.0;
        if !self.exact || N == 1 {
            return exactly();
        }
        *known.entry(key(self.filtration, simplex)).or_insert_with(exactly)
    }
}

/// The numbers that determine the squared radius of a simplex. Exact on a small lattice only.
pub(super) fn key<const N: usize>(filtration: &Filtration, mut simplex: [u32; N]) -> Key {
    let weights = &filtration.points().weights;
    // Sort by weight, because congruent simplices may have their vertices in another order.
    sort_handful_by(&mut simplex, |&a, &b| weights[a as usize].total_cmp(&weights[b as usize]));
    let corners = filtration.whole.corners(simplex);
    let pairs = (0..N).flat_map(|i| (0..i).map(move |j| (i, j)));
    let distances =
        pairs.map(|(i, j)| (0..3).map(|k| (corners[i][k] - corners[j][k]).powi(2)).sum::<f64>());
    let mut key: Key = [u64::MAX; 10];
    let numbers = simplex.iter().map(|&v| weights[v as usize]).chain(distances);
    key.iter_mut().zip(numbers).for_each(|(slot, number)| *slot = number.to_bits());
    key
}

/// The largest number of bits of a coordinate in units of the lattice. Differences have one more at most, so that the
/// sum of three squares is below 3·2⁵⁰, which doubles hold exactly.
const SMALL_BITS: i32 = 24;
/// Squares of units stay above the smallest double.
const LOWEST_UNIT: i32 = -500;

/// Whether coordinates are multiples of a power of two, by integers below 2²⁴, so that squared distances are integers below 2⁵³
/// in units of its square.
pub(super) fn is_small_lattice(points: &WeightedPoints, torus: Option<Torus>) -> bool {
    let vectors = torus.map(|torus| torus.vectors());
    let vectors = vectors.as_slice().as_flattened().as_flattened();
    let coordinates =
        || points.positions.as_flattened().par_iter().chain(vectors).coarse().copied();
    let lowest = coordinates().filter_map(lowest_bit).min().unwrap_or(0);
    let largest = coordinates().map(f64::abs).reduce(|| 0.0, f64::max);
    lowest > LOWEST_UNIT && largest < 2f64.powi(lowest.saturating_add(SMALL_BITS))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ranks are even also if a product of ranks exceeds 32 bits.
    #[test]
    fn ranks_are_even() {
        assert_eq!(even_ranks(6, 3), [0, 3, 6]);
        assert_eq!(even_ranks(2, 1024), [0, 1, 2]);
        let many = even_ranks(400_000_000, 1024);
        assert_eq!((many.len(), many[0], many[1023]), (1024, 0, 400_000_000));
        assert!(many.windows(2).all(|pair| (391_006..=391_007).contains(&(pair[1] - pair[0]))));
    }

    /// Two squared lengths that differ by 1 beyond 2⁵³ would be the same double, and their simplices would be considered
    /// congruent.
    #[test]
    fn squared_distances_on_a_small_lattice_are_exact() {
        let corners = |half: f64| WeightedPoints::unweighted(vec![[-half; 3], [half; 3]]);
        let (inside, beyond) = (2f64.powi(24) - 1.0, 2f64.powi(24) + 1.0);
        assert!(is_small_lattice(&corners(inside), None));
        assert!(3.0 * (2.0 * inside).powi(2) < 2f64.powi(53));
        assert!(!is_small_lattice(&corners(beyond), None));
        let largest = 2f64.powi(25) - 1.0;
        assert!(3.0 * (2.0 * largest).powi(2) > 2f64.powi(53));
        assert!(!is_small_lattice(&corners(largest), None));
    }
}
