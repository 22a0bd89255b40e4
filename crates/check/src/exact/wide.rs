//! Integers of 256 bits, for sums of millions of volumes that `i128` does not hold.

use dashu_int::{IBig, Sign, UBig};

use super::number::Number;

/// An integer modulo 2²⁵⁶, in two's complement. Results are exact if they have at most 255 bits, for any intermediate values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Wide([u64; 4]);

impl Wide {
    /// 0.
    pub(super) const ZERO: Self = Self([0; 4]);
    /// The digits that one holds in both signs.
    pub(super) const BITS: u32 = 255;

    /// Its value, if it has at most [`BITS`](Self::BITS) bits.
    pub(super) fn value(self) -> IBig {
        let negative = self.0[3] >> 63 == 1;
        let magnitude = if negative { Self::ZERO.minus(&self) } else { self };
        let bytes = magnitude.0.map(u64::to_le_bytes);
        let sign = if negative { Sign::Negative } else { Sign::Positive };
        IBig::from_parts(sign, UBig::from_le_bytes(bytes.as_flattened()))
    }

    /// The complement of each bit.
    fn complement(&self) -> Self {
        Self(self.0.map(|word| !word))
    }

    fn sum(&self, other: &Self, mut carry: bool) -> Self {
        let mut words = [0; 4];
        for (k, word) in words.iter_mut().enumerate() {
            let (sum, first) = self.0[k].overflowing_add(other.0[k]);
            let (sum, second) = sum.overflowing_add(u64::from(carry));
            (*word, carry) = (sum, first || second);
        }
        Self(words)
    }
}

impl From<i128> for Wide {
    fn from(value: i128) -> Self {
        let sign = (value >> 127) as u64;
        Self([value as u64, (value >> 64) as u64, sign, sign])
    }
}

impl Number for Wide {
    fn plus(&self, other: &Self) -> Self {
        self.sum(other, false)
    }

    fn minus(&self, other: &Self) -> Self {
        self.sum(&other.complement(), true)
    }

    fn times(&self, other: &Self) -> Self {
        let mut words = [0u64; 4];
        for i in 0..4 {
            let mut carry = 0u64;
            for j in 0..4 - i {
                let product = u128::from(self.0[i]) * u128::from(other.0[j]);
                let sum = product + u128::from(words[i + j]) + u128::from(carry);
                words[i + j] = sum as u64;
                carry = (sum >> 64) as u64;
            }
        }
        Self(words)
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;

    #[test]
    fn the_same_as_integers_of_any_length() {
        let mut random = Random::new(4);
        let number = |random: &mut Random| {
            // Numbers of any length up to 126 bits, also with long runs of ones and zeros.
            let high = i128::from(random.below(1 << 31) as u32) << 96;
            let low = i128::from(random.below(1 << 31) as u32) * 0x1_0000_0001_0000_0001;
            (high | low | (1 << random.below(90))) >> random.below(126)
        };
        for case in 0..20_000 {
            let [mut a, mut b] = [number(&mut random), number(&mut random)];
            a *= if case & 1 == 0 { -1 } else { 1 };
            b *= if case & 2 == 0 { -1 } else { 1 };
            let (wide, big) = ([a, b].map(Wide::from), [a, b].map(IBig::from));
            let all = [Wide::plus, Wide::minus, Wide::times].map(|f| f(&wide[0], &wide[1]).value());
            let expected = [&big[0] + &big[1], &big[0] - &big[1], &big[0] * &big[1]];
            assert_eq!(all, expected, "{a} {b}");
            // Intermediate values may wrap.
            let half = Wide([0, 0, 0, 1 << 62]);
            let wrapped = wide[0].plus(&half).plus(&half).plus(&wide[1]);
            assert_eq!(wrapped.minus(&half).minus(&half).value(), expected[0]);
        }
    }
}
