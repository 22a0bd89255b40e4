use rayon::prelude::*;

/// Values counted into one histogram. Fixed, so that sums are the same on any number of threads.
const CHUNK: usize = 1 << 18;
/// Position and number of the bits of a magnitude that each pass sorts by, 31 in all.
const DIGITS: [(u32, u32); 3] = [(19, 12), (10, 9), (0, 10)];

/// What may be dropped, smallest magnitudes first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Budget {
    /// This many values.
    Count(u64),
    /// Values whose squares sum to no more than this.
    Energy(f64),
}

/// Where values in order of decreasing magnitude, equal ones in order of their index, are cut into
/// those that stay and those that are dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cut {
    /// The bits of the magnitude at the cut: larger ones stay, smaller ones are dropped.
    magnitude: u32,
    /// Values of just this magnitude stay below this index.
    ties_end: usize,
}

impl Cut {
    /// Cuts `n` values so that as many are dropped as the budget allows.
    ///
    /// `key` gives the bits of a value's magnitude, or `None` if it takes no part. Non-negative
    /// `f32` are ordered as their bits are, so this is a radix selection: three passes, each a
    /// histogram of counts and energies, and no value moves. O(n).
    pub fn new(n: usize, key: impl Fn(usize) -> Option<u32> + Sync, mut budget: Budget) -> Self {
        let (mut magnitude, mut ties) = (0, 0);
        for (shift, width) in DIGITS {
            let bins = histogram(n, &key, magnitude, shift, width);
            let Some(digit) = bins.iter().position(|bin| !budget.take(bin)) else {
                // All values, or (sums of parts are rounded otherwise than the sum of all) all of
                // the last digit: the cut is above them.
                let below = (1 << (shift + width)) - 1;
                return Self { magnitude: magnitude | below, ties_end: 0 };
            };
            magnitude |= (digit as u32) << shift;
            ties = bins[digit].count;
        }
        let stay = ties - budget.equal(f64::from(f32::from_bits(magnitude)).powi(2), ties);
        let ties_end = match stay {
            0 => 0,
            _ if stay == ties => n,
            _ => place_after(stay, n, |i| key(i) == Some(magnitude)),
        };
        Self { magnitude, ties_end }
    }

    /// Whether the value of these bits at this index stays.
    #[inline]
    pub fn keeps(self, bits: u32, index: usize) -> bool {
        bits > self.magnitude || (bits == self.magnitude && index < self.ties_end)
    }
}

#[derive(Clone, Copy, Default)]
struct Bin {
    count: u64,
    energy: f64,
}

/// Sorts values that agree with `prefix` above the digit at `shift` by this digit.
fn histogram(
    n: usize,
    key: &(impl Fn(usize) -> Option<u32> + Sync),
    prefix: u32,
    shift: u32,
    width: u32,
) -> Vec<Bin> {
    let (above, mask) = (shift + width, (1 << width) - 1);
    let of_chunk = |chunk: usize| {
        let mut bins = vec![Bin::default(); 1 << width];
        for i in chunk * CHUNK..n.min((chunk + 1) * CHUNK) {
            if let Some(bits) = key(i).filter(|bits| bits >> above == prefix >> above) {
                let bin = &mut bins[(bits >> shift & mask) as usize];
                bin.count += 1;
                let value = f64::from(f32::from_bits(bits));
                bin.energy += value * value;
            }
        }
        bins
    };
    let chunks: Vec<Vec<Bin>> = (0..n.div_ceil(CHUNK)).into_par_iter().map(of_chunk).collect();
    let mut total = vec![Bin::default(); 1 << width];
    for chunk in chunks {
        for (total, bin) in total.iter_mut().zip(chunk) {
            total.count += bin.count;
            total.energy += bin.energy;
        }
    }
    total
}

/// The index after the `nth` (from 1) of those that are `wanted`, of which there are as many.
fn place_after(nth: u64, n: usize, wanted: impl Fn(usize) -> bool + Sync) -> usize {
    let chunk_range = |chunk: usize| chunk * CHUNK..n.min((chunk + 1) * CHUNK);
    let counts: Vec<u64> = (0..n.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| chunk_range(chunk).filter(|&i| wanted(i)).count() as u64)
        .collect();
    let mut left = nth;
    for (chunk, count) in counts.into_iter().enumerate() {
        if left <= count {
            let mut places = chunk_range(chunk).filter(|&i| wanted(i));
            return places.nth(left as usize - 1).map_or(n, |i| i + 1);
        }
        left -= count;
    }
    n
}

impl Budget {
    /// Drops a whole bin, if the budget allows.
    fn take(&mut self, bin: &Bin) -> bool {
        match self {
            Self::Count(left) if bin.count <= *left => *left -= bin.count,
            Self::Energy(left) if bin.energy <= *left => *left -= bin.energy,
            _ => return false,
        }
        true
    }

    /// How many of `count` values, all of this square, the budget allows to drop.
    fn equal(self, square: f64, count: u64) -> u64 {
        match self {
            Self::Count(left) => left.min(count),
            Self::Energy(_) if square == 0.0 => count,
            // The quotient is rounded, so the answer is it or a neighbour.
            Self::Energy(left) => {
                let quotient = ((left / square) as u64).min(count);
                let fits = |drop: &u64| *drop as f64 * square <= left;
                let around = quotient.saturating_sub(1)..=count.min(quotient + 1);
                around.rev().find(fits).unwrap_or(0)
            }
        }
    }
}
