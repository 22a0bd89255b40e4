//! The largest of many values, as few or as many as a budget allows; of values in memory at once
//! ([`Cut::new`]), or piece by piece ([`Search`]). Energies are summed exactly, so both find the same.

mod budget;
mod search;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use budget::Spent;
pub(crate) use budget::{Bin, Budget, Dropped};
pub(crate) use search::{Counts, Search};

/// Values counted into one histogram. Fixed, so that sums are the same on any number of threads.
const CHUNK: usize = 1 << 17;
/// Position and number of the bits of a magnitude that each pass sorts by, 63 in all: the exponent
/// and a bit of the mantissa first.
const DIGITS: [(u32, u32); 6] = [(51, 12), (41, 10), (31, 10), (21, 10), (11, 10), (0, 11)];

/// Where values in order of decreasing magnitude, equal ones in order of their index, are cut into
/// those that stay and those that are dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Cut {
    /// The bits of the magnitude at the cut: larger ones stay, smaller ones are dropped.
    magnitude: u64,
    /// Values of just this magnitude stay below this index.
    ties_end: u64,
}

impl Cut {
    /// Cuts values so that as many are dropped as the budget allows; says what is dropped. NaN takes no part,
    /// and does not stay; infinities must not occur.
    ///
    /// Magnitudes are ordered as their bits are, so this is a radix selection: a histogram of
    /// counts and energies by the leading digit, then of what agrees with it by the next. O(n).
    pub(crate) fn new(values: &[f64], budget: Budget) -> (Self, Dropped) {
        let mut spent = Spent::of(budget);
        let (mut magnitude, mut ties) = (0, 0);
        for (shift, width) in DIGITS {
            let bins = histogram(values, magnitude, shift, width);
            let exponent = |digit: usize| (magnitude | (digit as u64) << shift) >> EXPONENT;
            let found = bins.iter().enumerate().position(|(i, bin)| !spent.take(bin, exponent(i)));
            let Some(digit) = found else {
                let below = (1 << (shift + width)) - 1;
                return (Self { magnitude: magnitude | below, ties_end: 0 }, spent.dropped());
            };
            magnitude |= (digit as u64) << shift;
            ties = bins[digit].count;
        }
        let stay = ties - spent.equal(magnitude, ties);
        let ties_end = match stay {
            0 => 0,
            _ if stay == ties => u64::MAX,
            _ => place_after(stay, values, magnitude) as u64,
        };
        (Self { magnitude, ties_end }, spent.dropped())
    }

    /// Whether the value at this index stays.
    #[inline]
    pub(crate) fn keeps(self, value: f64, index: u64) -> bool {
        let bits = magnitude(value);
        let above = bits > self.magnitude && bits < INFINITY;
        above || (bits == self.magnitude && index < self.ties_end)
    }
}

/// The bits of an infinite magnitude. Those of NaN are larger.
const INFINITY: u64 = f64::INFINITY.to_bits();
/// Bits of a magnitude below its exponent.
const EXPONENT: u32 = 52;

#[inline(always)]
fn magnitude(value: f64) -> u64 {
    value.to_bits() & (u64::MAX >> 1)
}

/// Sorts values that agree with `prefix` above the digit at `shift` by this digit.
fn histogram(values: &[f64], prefix: u64, shift: u32, width: u32) -> Vec<Bin> {
    let above = shift + width;
    let sort = |chunk| match above {
        63 => leading_digits(chunk, shift, width),
        _ => inner_digits(chunk, prefix, shift, width),
    };
    let chunks: Vec<Vec<Bin>> = values.par_chunks(CHUNK).map(sort).collect();
    let mut total = vec![Bin::default(); 1 << width];
    for chunk in chunks {
        total.iter_mut().zip(&chunk).for_each(|(total, bin)| total.join(bin));
    }
    if above == 63 {
        total.truncate((INFINITY >> shift) as usize);
    }
    total
}

/// Every value counts. Neighbours go to two tables in turn: runs of equal values (zeros, mostly)
/// would make each addition wait for the one before.
fn leading_digits(chunk: &[f64], shift: u32, width: u32) -> Vec<Bin> {
    let mut bins = vec![Bin::default(); 1 << width];
    let mut others = bins.clone();
    let (pairs, rest) = chunk.as_chunks::<2>();
    for pair in pairs {
        let [bits, other] = pair.map(magnitude);
        bins[(bits >> shift) as usize].add(bits);
        others[(other >> shift) as usize].add(other);
    }
    for bits in rest.iter().copied().map(magnitude) {
        bins[(bits >> shift) as usize].add(bits);
    }
    bins.iter_mut().zip(&others).for_each(|(bin, other)| bin.join(other));
    bins
}

/// Few values count: blocks without one are passed over, which the compiler vectorises.
fn inner_digits(chunk: &[f64], prefix: u64, shift: u32, width: u32) -> Vec<Bin> {
    let (above, mask) = (shift + width, (1 << width) - 1);
    let mut bins = vec![Bin::default(); 1 << width];
    for block in chunk.chunks(32) {
        let agrees = |&value: &f64| (magnitude(value) ^ prefix) >> above == 0;
        if block.iter().fold(false, |any, value| any | agrees(value)) {
            for bits in block.iter().filter(|&value| agrees(value)).copied().map(magnitude) {
                bins[(bits >> shift & mask) as usize].add(bits);
            }
        }
    }
    bins
}

/// The index after the `nth` (from 1) value of this magnitude, of which there are as many.
fn place_after(nth: u64, values: &[f64], wanted: u64) -> usize {
    let is_wanted = |value: &f64| magnitude(*value) == wanted;
    let count = |chunk: &[f64]| chunk.iter().filter(|&value| is_wanted(value)).count() as u64;
    let counts: Vec<u64> = values.par_chunks(CHUNK).map(count).collect();
    let mut left = nth;
    for (chunk, count) in counts.into_iter().enumerate() {
        if left <= count {
            let start = chunk * CHUNK;
            let mut places = (start..values.len()).filter(|&i| is_wanted(&values[i]));
            return places.nth(left as usize - 1).map_or(values.len(), |i| i + 1);
        }
        left -= count;
    }
    values.len()
}
