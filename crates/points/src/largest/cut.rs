use serde::{Deserialize, Serialize};
use walpha_base::Sum;
use walpha_base::parallel::prelude::*;

/// The number of values counted into one histogram. It is fixed, so that sums do not depend on the number of threads.
const CHUNK: usize = 1 << 17;
/// The position and the number of the bits of a magnitude that each pass sorts by, 63 in all: the exponent and a bit of the
/// mantissa come first.
const DIGITS: [(u32, u32); 6] = [(51, 12), (41, 10), (31, 10), (21, 10), (11, 10), (0, 11)];

/// The threshold between kept and dropped values. They are ordered by decreasing magnitude, and equal ones by increasing index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cut {
    /// The bits of the magnitude at the cut: larger ones stay, smaller ones are dropped.
    pub(super) magnitude: u64,
    /// Values of exactly this magnitude stay if their index is below this one.
    pub(super) ties_end: u64,
}

impl Cut {
    /// Cuts values so that as many are dropped as the budget allows, and returns what is dropped. NaN is ignored and does not
    /// stay; infinities must not occur.
    ///
    /// Magnitudes are ordered like their bits, so this is a radix selection: a histogram of counts and energies by the leading
    /// digit, then by the next digit of the values that agree with it, and so on. O(n).
    pub fn new(values: &[f64], budget: Budget) -> (Self, Dropped) {
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
    pub fn keeps(self, value: f64, index: u64) -> bool {
        let bits = magnitude(value);
        let above = bits > self.magnitude && bits < INFINITY;
        above || (bits == self.magnitude && index < self.ties_end)
    }
}

/// The bits of an infinite magnitude. Those of NaN are larger.
pub(super) const INFINITY: u64 = f64::INFINITY.to_bits();
/// The number of bits of a magnitude below its exponent.
pub(super) const EXPONENT: u32 = 52;

#[inline(always)]
pub(super) fn magnitude(value: f64) -> u64 {
    value.to_bits() & (u64::MAX >> 1)
}

/// Sorts the values that agree with `prefix` above the digit at `shift` into bins by this digit.
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

/// Makes a histogram in which every value counts. Neighbours go to two tables alternately: runs of equal values (mostly zeros)
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

/// Makes a histogram in which few values count. Blocks without such values are skipped, which the compiler vectorises.
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

/// The index after the `nth` value (from 1) of this magnitude; there must be at least so many.
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

/// How much may be dropped, smallest magnitudes first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Budget {
    /// At most this number of values.
    Count(u64),
    /// Values whose squares sum to at most this.
    Energy(f64),
}

/// The values that a cut drops.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dropped {
    /// The number of values.
    pub count: u64,
    /// The sum of their squares. Each square is rounded; the sum is exact and rounded once.
    pub energy: f64,
}

/// The values whose magnitudes have the same exponent: their number, and the exact sum of their squares, in units of the last
/// place of squares with this exponent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Bin {
    pub(super) count: u64,
    pub(super) units: u128,
}

impl Bin {
    #[inline(always)]
    pub(super) fn add(&mut self, bits: u64) {
        self.count += 1;
        self.units += u128::from(units(bits));
    }

    pub(super) fn join(&mut self, other: &Self) {
        self.count += other.count;
        self.units += other.units;
    }
}

const FRACTION: u64 = (1 << EXPONENT) - 1;

/// The biased exponent of the least square of magnitudes with a biased exponent.
#[inline(always)]
fn least(exponent: u64) -> u64 {
    // Magnitudes from 2⁵¹¹ on, whose squares exceed the range of doubles, count as if their squares were at its end.
    (2 * exponent).saturating_sub(1023).clamp(1, 2046)
}

/// The rounded square of a magnitude, in units of its exponent: below 2⁵⁴.
#[inline(always)]
fn units(bits: u64) -> u64 {
    let value = f64::from_bits(bits);
    let square = (value * value).to_bits();
    let exponent = square >> EXPONENT;
    let hidden = u64::from(exponent != 0) << EXPONENT;
    (square & FRACTION | hidden) << (exponent.max(1) - least(bits >> EXPONENT))
}

/// The number and energy of the values dropped so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Spent {
    budget: Budget,
    count: u64,
    energy: Sum,
}

impl Spent {
    pub(super) fn of(budget: Budget) -> Self {
        Self { budget, count: 0, energy: Sum::default() }
    }

    /// Drops a whole bin of values with an exponent, if the budget allows.
    pub(super) fn take(&mut self, bin: &Bin, exponent: u64) -> bool {
        if bin.count == 0 {
            return true;
        }
        let energy = self.with(bin.units, exponent);
        let allowed = match self.budget {
            Budget::Count(most) => self.count + bin.count <= most,
            Budget::Energy(most) => energy.is_at_most(most),
        };
        if allowed {
            (self.count, self.energy) = (self.count + bin.count, energy);
        }
        allowed
    }

    /// Drops as many of `count` values of one magnitude as the budget allows, and returns their number.
    pub(super) fn equal(&mut self, magnitude: u64, count: u64) -> u64 {
        let (each, exponent) = (u128::from(units(magnitude)), magnitude >> EXPONENT);
        let with = |drop: u64| self.with(each * u128::from(drop), exponent);
        let dropped = match self.budget {
            Budget::Count(most) => count.min(most - self.count),
            Budget::Energy(most) => {
                let (mut fit, mut too_many) = (0, count + 1);
                while too_many - fit > 1 {
                    let middle = fit + (too_many - fit) / 2;
                    let allowed = with(middle).is_at_most(most);
                    *(if allowed { &mut fit } else { &mut too_many }) = middle;
                }
                fit
            }
        };
        (self.count, self.energy) = (self.count + dropped, with(dropped));
        dropped
    }

    pub(super) fn dropped(&self) -> Dropped {
        Dropped { count: self.count, energy: self.energy.value() }
    }

    /// The energy so far plus these units.
    fn with(&self, units: u128, exponent: u64) -> Sum {
        /// A number of bits that a double holds safely.
        const PIECE: u32 = 48;
        let mut energy = self.energy.clone();
        let mut unit = last_place(least(exponent));
        let mut left = units;
        while left != 0 {
            energy.add((left & ((1 << PIECE) - 1)) as f64 * unit);
            (left, unit) = (left >> PIECE, unit * (1u64 << PIECE) as f64);
        }
        energy
    }
}

/// The unit of the last place of doubles with a biased exponent.
fn last_place(exponent: u64) -> f64 {
    match exponent {
        0..=52 => f64::from_bits(1 << (exponent.max(1) - 1)),
        _ => f64::from_bits((exponent - 52) << EXPONENT),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_are_whole_numbers_of_units() {
        for value in [0.0, 1.0, 1.5, 3.7, 1e-200, 5e-324, 1e100, 2.2e-162, 1e-154, 1.3e154] {
            let bits = f64::to_bits(value);
            let mut spent = Spent::of(Budget::Energy(f64::INFINITY));
            let mut bin = Bin::default();
            (0..3).for_each(|_| bin.add(bits));
            assert!(spent.take(&bin, bits >> EXPONENT));
            let expected: Sum = (0..3).map(|_| value * value).collect();
            assert_eq!(spent.dropped(), Dropped { count: 3, energy: expected.value() }, "{value}");
            assert_eq!(spent.equal(bits, 2), 2);
            let expected: Sum = (0..5).map(|_| value * value).collect();
            assert_eq!(spent.dropped().energy, expected.value(), "{value}");
        }
    }

    #[test]
    fn the_budget_is_kept_to_the_last_bit() {
        let square: f64 = 0.1 * 0.1;
        let mut spent = Spent::of(Budget::Energy((0..7).map(|_| square).collect::<Sum>().value()));
        // The sum of seven squares is not a double: whether seven fit depends on the rounding.
        let dropped = spent.equal(0.1f64.to_bits(), 100);
        let exact: Sum = (0..7).map(|_| square).collect();
        assert_eq!(dropped, if exact.is_at_most(exact.value()) { 7 } else { 6 });
        let mut spent = Spent::of(Budget::Count(3));
        assert_eq!(spent.equal(0.1f64.to_bits(), 100), 3);
        assert!(!spent.take(&Bin { count: 1, units: 0 }, 1));
    }
}
