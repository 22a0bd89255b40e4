//! The values of a filtration, distinguished exactly and sorted.
//!
//! Rounding is monotonic: where the nearest doubles of two squared radii differ, they are in the order of the exact
//! numbers. So only simplices with the same nearest double are compared as exact numbers; on a lattice nearly all of them
//! are equal as ratios of small integers.

use std::collections::BTreeMap;

use walpha_base::memory::{self, NoMemory};
use walpha_base::parallel::prelude::*;
use walpha_base::parallel::{FEW, sort_unstable};
use walpha_regular::internals::{Predicates, Ratio, SmallRadius};

use super::numbers::Numbers;
use crate::along::Table;
use crate::ladder::Filtration;
use crate::ladder::build::Radii;
use crate::ladder::values::{Key, is_small_lattice, key};

/// Stands for the rank of a simplex whose sphere is not empty.
pub(super) const NONE: u32 = u32::MAX;

/// The ranks of the squared radii of empty smallest orthogonal spheres, from 0.
pub(super) struct Ranks {
    /// The nearest double of each, ascending; several may have the same.
    pub values: Vec<f64>,
    /// The rank of each simplex by its number; [`NONE`] if its sphere is not empty.
    pub of: Vec<u32>,
}

/// Radii that one thread numbers at a time.
const CHUNK: usize = 1 << 12;

/// A squared radius as an integer in the order of doubles, and the number of its simplex.
type Radius = (u64, u32);

impl Ranks {
    /// The number of bytes that are needed at the same time.
    pub(super) fn bytes(simplices: usize) -> usize {
        simplices.saturating_mul(size_of::<Radius>() + size_of::<u32>() + size_of::<f64>())
    }

    pub(super) fn of(filtration: &Filtration, numbers: Numbers) -> Result<Self, NoMemory> {
        let spheres = filtration.spheres();
        let mut radii = memory::try_with_capacity(numbers.all(), || {
            format!("the order of {} simplices", numbers.all())
        })?;
        collect(filtration, numbers, &mut radii);
        sort_unstable(&mut radii);
        let radii_count = radii.len();
        let lattice = is_small_lattice(filtration.points(), filtration.torus());
        let exact = ExactOrder { filtration, numbers, spheres, lattice };
        let several: Vec<_> =
            radii.chunk_by_mut(|a, b| a.0 == b.0).filter(|run| run.len() > 1).collect();
        // Simplices whose values differ from those before them, though the nearest doubles are equal.
        let least = if radii_count <= FEW { FEW } else { 1 };
        let mut steps: Vec<u32> = (several.into_par_iter().with_min_len(least))
            .flat_map_iter(|run| exact.split_ties(run))
            .collect();
        sort_unstable(&mut steps);
        let is_first = |at: usize| {
            let (key, simplex) = radii[at];
            at == 0 || radii[at - 1].0 != key || steps.binary_search(&simplex).is_ok()
        };
        // Values are counted by chunks, then numbered.
        let chunks = || (0..radii.len()).into_par_iter().step_by(CHUNK);
        let chunk = |from: usize| from..radii.len().min(from + CHUNK);
        let counts: Vec<usize> =
            chunks().map(|from| chunk(from).filter(|&at| is_first(at)).count()).collect();
        let mut values = vec![0.0; counts.iter().sum()];
        let mut rest = &mut values[..];
        let mut before = 0;
        let parts: Vec<_> = (counts.iter())
            .map(|&count| {
                let part = rest.split_off_mut(..count).expect("as many as were counted");
                before += count;
                (before - count, part)
            })
            .collect();
        let of: Table<1> = Table::new(numbers.all(), NONE);
        chunks().zip(parts).for_each(|(from, (mut rank, values))| {
            let mut values = values.iter_mut();
            for at in chunk(from) {
                if is_first(at) {
                    *values.next().expect("a place for each value") = from_bits(radii[at].0);
                    rank += 1;
                }
                of.write_at(radii[at].1 as usize, 0, rank as u32 - 1);
            }
        });
        let of = of.finished().into_flattened();
        Ok(Self { values, of })
    }
}

/// The nearest doubles of all radii, by number of the simplex.
fn collect(filtration: &Filtration, numbers: Numbers, radii: &mut Vec<Radius>) {
    let Radii { cells, facets, edges, vertices } = &filtration.radii;
    for (from, lower) in numbers.first.into_iter().zip([vertices, edges, facets]) {
        let known = (from..).zip(lower);
        radii.extend(known.filter_map(|(simplex, own)| Some((to_bits(own.known()?), simplex))));
    }
    let cells = (numbers.first[3]..).zip(cells);
    radii.extend(cells.map(|(simplex, &radius)| (to_bits(radius), simplex)));
}

/// An integer in the order of doubles; not for −0.
fn to_bits(value: f64) -> u64 {
    let bits = value.to_bits();
    if value < 0.0 { !bits } else { bits | 1 << 63 }
}

fn from_bits(key: u64) -> f64 {
    f64::from_bits(if key >> 63 == 1 { key & !(1 << 63) } else { !key })
}

/// Distinguishes radii with the same nearest double.
struct ExactOrder<'a> {
    filtration: &'a Filtration,
    numbers: Numbers,
    spheres: Predicates<'a>,
    /// Whether squared distances are exact in doubles.
    lattice: bool,
}

impl ExactOrder<'_> {
    /// Sorts a run of equal doubles by exact value, and returns the first simplex of each value but the smallest.
    fn split_ties(&self, run: &mut [Radius]) -> Vec<u32> {
        if let Some(first) = self.small(run[0].1)
            && run
                .par_iter()
                .coarse()
                .all(|&(_, s)| self.small(s).is_some_and(|small| small.equals(first)))
        {
            return Vec::new();
        }
        if self.lattice && run.iter().all(|radius| self.key(radius.1) == self.key(run[0].1)) {
            return Vec::new();
        }
        let mut values = BTreeMap::<Ratio, Vec<u32>>::new();
        for &(_, simplex) in &*run {
            values.entry(self.ratio(simplex)).or_default().push(simplex);
        }
        let firsts = values.values().skip(1).map(|simplices| simplices[0]).collect();
        let simplices = values.into_values().flatten();
        run.iter_mut().zip(simplices).for_each(|(radius, simplex)| radius.1 = simplex);
        firsts
    }

    fn small(&self, simplex: u32) -> Option<SmallRadius> {
        let complex = self.filtration.whole.complex();
        match self.numbers.row(simplex) {
            (0, row) => self.spheres.small_radius(complex.vertices.rows()[row]),
            (1, row) => self.spheres.small_radius(complex.edges.rows()[row]),
            (2, row) => self.spheres.small_radius(self.filtration.incidence.facets[row]),
            (_, row) => self.spheres.small_radius(complex.cells.rows()[row]),
        }
    }

    fn key(&self, simplex: u32) -> Key {
        let (complex, of) = (self.filtration.whole.complex(), self.filtration);
        match self.numbers.row(simplex) {
            (0, row) => key(of, complex.vertices.rows()[row]),
            (1, row) => key(of, complex.edges.rows()[row]),
            (2, row) => key(of, self.filtration.incidence.facets[row]),
            (_, row) => key(of, complex.cells.rows()[row]),
        }
    }

    fn ratio(&self, simplex: u32) -> Ratio {
        let complex = self.filtration.whole.complex();
        match self.numbers.row(simplex) {
            (0, row) => self.spheres.exact_radius(complex.vertices.rows()[row]),
            (1, row) => self.spheres.exact_radius(complex.edges.rows()[row]),
            (2, row) => self.spheres.exact_radius(self.filtration.incidence.facets[row]),
            (_, row) => self.spheres.exact_radius(complex.cells.rows()[row]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_in_the_order_of_doubles() {
        let values = [f64::NEG_INFINITY, -1.5, -1.0, -5e-324, 0.0, 5e-324, 1.0, 2.0, f64::INFINITY];
        let keys = values.map(to_bits);
        assert!(keys.is_sorted() && keys.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(keys.map(from_bits), values);
    }
}
