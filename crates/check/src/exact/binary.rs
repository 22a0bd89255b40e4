use dashu_int::IBig;

/// A finite double as mantissa · 2^exponent with an odd mantissa (or zero), without loss of information.
#[derive(Clone, Copy, Debug)]
pub(super) struct Binary {
    mantissa: i64,
    exponent: i32,
}

impl Binary {
    pub(super) fn new(value: f64) -> Self {
        debug_assert!(value.is_finite());
        let bits = value.to_bits();
        let biased = (bits >> 52 & 0x7ff) as i32;
        let fraction = (bits & ((1 << 52) - 1)) as i64;
        let (magnitude, exponent) =
            if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
        if magnitude == 0 {
            return Self { mantissa: 0, exponent: 0 };
        }
        let zeros = magnitude.trailing_zeros();
        let odd = magnitude >> zeros;
        let mantissa = if value < 0.0 { -odd } else { odd };
        Self { mantissa, exponent: exponent + zeros as i32 }
    }

    /// The value in units of 2^`exponent`, which must not exceed its own exponent, when
    /// [`Range::bits`] says that it fits.
    pub(super) fn small(self, exponent: i32) -> i128 {
        if self.mantissa == 0 { 0 } else { i128::from(self.mantissa) << (self.exponent - exponent) }
    }

    /// The value in units of 2^`exponent`, which must not exceed its own exponent.
    pub(super) fn big(self, exponent: i32) -> IBig {
        if self.mantissa == 0 {
            IBig::ZERO
        } else {
            IBig::from(self.mantissa) << (self.exponent - exponent) as usize
        }
    }
}

/// The binary digits that a set of numbers spans.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    /// Exponent of the lowest digit set in any of them.
    low: i32,
    /// Exponent just above the highest.
    high: i32,
}

impl Range {
    pub(super) const EMPTY: Self = Self { low: i32::MAX, high: i32::MIN };

    pub(super) fn with(self, number: Binary) -> Self {
        if number.mantissa == 0 {
            return self;
        }
        let length = (64 - number.mantissa.unsigned_abs().leading_zeros()) as i32;
        Self { low: self.low.min(number.exponent), high: self.high.max(number.exponent + length) }
    }

    /// The exponent of the common unit; `None` if all numbers are zero.
    pub(super) fn unit(self) -> Option<i32> {
        (self.low < self.high).then_some(self.low)
    }

    /// The number of binary digits that the numbers need in units of 2^`unit`, without the sign.
    pub(super) fn bits(self, unit: i32) -> u32 {
        if self.low < self.high { (self.high - unit) as u32 } else { 0 }
    }
}
