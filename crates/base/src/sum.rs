/// A sum of doubles that is rounded once, when it is read: the result is the same double for any order and
/// grouping of the terms.
///
/// The sum is stored as doubles that do not overlap, in ascending order, usually two or three of them (Shewchuk, "Adaptive
/// Precision Floating-Point Arithmetic", 1997, doi:10.1007/PL00009321, section 2.4).
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sum {
    parts: Vec<f64>,
    /// The sum of infinite and undefined terms.
    #[cfg_attr(feature = "serde", serde(skip))]
    beyond: f64,
}

impl Sum {
    /// Adds a term. O(parts).
    pub fn add(&mut self, term: f64) {
        if term == 0.0 {
            return;
        }
        if !term.is_finite() {
            self.beyond += term;
            return;
        }
        let mut carry = term;
        let mut kept = 0;
        for i in 0..self.parts.len() {
            let part = self.parts[i];
            let (large, small) =
                if carry.abs() < part.abs() { (part, carry) } else { (carry, part) };
            carry = large + small;
            if carry.is_infinite() {
                self.beyond += carry;
                self.parts.clear();
                return;
            }
            let rest = small - (carry - large);
            if rest != 0.0 {
                self.parts[kept] = rest;
                kept += 1;
            }
        }
        self.parts.truncate(kept);
        if carry != 0.0 {
            self.parts.push(carry);
        }
    }

    /// Adds another sum.
    pub fn join(&mut self, other: &Self) {
        other.parts.iter().for_each(|&part| self.add(part));
        self.beyond += other.beyond;
    }

    /// The double nearest to the sum; the even one if two are equally near.
    pub fn value(&self) -> f64 {
        if self.beyond != 0.0 {
            return self.beyond;
        }
        let Some((&last, rest)) = self.parts.split_last() else { return 0.0 };
        let (mut high, mut low, mut left) = (last, 0.0, rest.len());
        while left > 0 {
            left -= 1;
            let before = high;
            high = before + rest[left];
            low = rest[left] - (high - before);
            if low != 0.0 {
                break;
            }
        }
        // If the remainder is half of the last digit, the parts after it decide.
        if left > 0 && low != 0.0 && (low < 0.0) == (rest[left - 1] < 0.0) {
            let doubled = 2.0 * low;
            let next = high + doubled;
            if next - high == doubled {
                high = next;
            }
        }
        high
    }

    /// Whether the exact sum is at most `limit`.
    pub fn is_at_most(&self, limit: f64) -> bool {
        if self.beyond != 0.0 || limit.is_infinite() {
            return self.beyond <= limit;
        }
        let mut difference = self.clone();
        difference.add(-limit);
        difference.parts.last().is_none_or(|&largest| largest <= 0.0)
    }
}

impl FromIterator<f64> for Sum {
    fn from_iter<I: IntoIterator<Item = f64>>(terms: I) -> Self {
        let mut sum = Self::default();
        terms.into_iter().for_each(|term| sum.add(term));
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn sums_do_not_depend_on_their_order() {
        let mut random = Random::new(1);
        let mut term = || (random.unit() - 0.5) * 2f64.powi(random.below(64) as i32 - 32);
        let terms: Vec<f64> = (0..1000).map(|_| term()).collect();
        let sum: Sum = terms.iter().copied().collect();
        let back: Sum = terms.iter().rev().copied().collect();
        let mut halves: Sum = terms[..300].iter().copied().collect();
        halves.join(&terms[300..].iter().copied().collect());
        assert_eq!(sum.value().to_bits(), back.value().to_bits());
        assert_eq!(sum.value().to_bits(), halves.value().to_bits());
        let plain: f64 = terms.iter().sum();
        assert!((sum.value() - plain).abs() < 1e-5 * plain.abs().max(1.0));
    }

    #[test]
    fn sums_are_rounded_once() {
        let half = 2f64.powi(-53);
        let of = |terms: &[f64]| terms.iter().copied().collect::<Sum>().value();
        // A value half-way between two doubles is rounded to the even one, unless a smaller term decides.
        assert_eq!(of(&[1.0, half]), 1.0);
        assert_eq!(of(&[1.0, half, 1e-300]), 1.0 + 2.0 * half);
        assert_eq!(of(&[1.0, half, -1e-300]), 1.0);
        assert_eq!(of(&[1e100, 1.0, -1e100]), 1.0);
        assert_eq!(of(&[]), 0.0);
        assert_eq!(of(&[f64::MAX, f64::MAX]), f64::INFINITY);
        let sum: Sum = [1.0, 1e-300].into_iter().collect();
        assert!(!sum.is_at_most(1.0) && sum.is_at_most(1.0f64.next_up()));
        assert!(Sum::default().is_at_most(0.0) && sum.is_at_most(f64::INFINITY));
    }
}
