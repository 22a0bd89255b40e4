//! Arithmetic of formulas that are written once for doubles and for integers of any length, and the mantissa and exponent of
//! doubles.

use dashu_int::IBig;

/// A number type of formulas. Operations are exact on integers, and on doubles if none rounds.
pub trait Number {
    /// The sum.
    #[must_use]
    fn plus(&self, other: &Self) -> Self;
    /// The difference.
    #[must_use]
    fn minus(&self, other: &Self) -> Self;
    /// The product.
    #[must_use]
    fn times(&self, other: &Self) -> Self;
}

macro_rules! number {
    ($($number:ty)*) => {$(
        impl Number for $number {
            #[inline(always)]
            fn plus(&self, other: &Self) -> Self {
                self + other
            }
            #[inline(always)]
            fn minus(&self, other: &Self) -> Self {
                self - other
            }
            #[inline(always)]
            fn times(&self, other: &Self) -> Self {
                self * other
            }
        }
    )*};
}

number!(f64 i64 i128 IBig);

/// Multiplication by a number of another, simpler type.
pub trait Scale<V>: Number {
    /// The product with `factor`.
    #[must_use]
    fn scaled(&self, factor: &V) -> Self;
}

impl<T: Number> Scale<T> for T {
    #[inline(always)]
    fn scaled(&self, factor: &T) -> T {
        self.times(factor)
    }
}

/// Integers that doubles are converted to: `i128` if 128 bits suffice, otherwise [`IBig`].
pub trait Integer: Number + Ord {
    /// 0.
    const ZERO: Self;
    /// A double in units of 2^`unit`; its lowest bit must be at least one unit.
    fn of(value: f64, unit: i32) -> Self;
    /// The product with 2^`bits`.
    #[must_use]
    fn shifted(self, bits: usize) -> Self;
}

impl Integer for i128 {
    const ZERO: Self = 0;
    fn of(value: f64, unit: i32) -> Self {
        let (mantissa, exponent) = decode(value);
        if mantissa == 0 { 0 } else { Self::from(mantissa) << (exponent - unit) }
    }
    fn shifted(self, bits: usize) -> Self {
        self << bits
    }
}

impl Integer for IBig {
    const ZERO: Self = Self::ZERO;
    fn of(value: f64, unit: i32) -> Self {
        integer(value, unit)
    }
    fn shifted(self, bits: usize) -> Self {
        self << bits
    }
}

/// The scalar product.
#[inline(always)]
pub fn dot<T: Number>(u: &[T; 3], v: &[T; 3]) -> T {
    u[0].times(&v[0]).plus(&u[1].times(&v[1])).plus(&u[2].times(&v[2]))
}

/// The vector product.
#[inline(always)]
pub fn cross<T: Number>(u: &[T; 3], v: &[T; 3]) -> [T; 3] {
    let minor = |i: usize, j: usize| u[i].times(&v[j]).minus(&u[j].times(&v[i]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// Bits of the fraction of a double; its mantissa has one more, which is implicit.
const FRACTION_BITS: u32 = f64::MANTISSA_DIGITS - 1;
/// Bias of the exponent of a double whose mantissa counts as an integer: 1023 + 52.
const BIAS: i32 = f64::MAX_EXP - 1 + FRACTION_BITS as i32;

/// Mantissa and exponent of a finite double. The mantissa is odd, or 0 with the exponent 0.
pub fn decode(value: f64) -> (i64, i32) {
    let bits = value.to_bits();
    let biased = (bits >> FRACTION_BITS & 0x7ff) as i32;
    let fraction = (bits & ((1 << FRACTION_BITS) - 1)) as i64;
    let magnitude = if biased == 0 { fraction } else { fraction | 1 << FRACTION_BITS };
    if magnitude == 0 {
        return (0, 0);
    }
    let zeros = magnitude.trailing_zeros();
    let odd = magnitude >> zeros;
    (if value < 0.0 { -odd } else { odd }, biased.max(1) - BIAS + zeros as i32)
}

/// The least exponent e with |value| < 2ᵉ, one above the highest bit set; `None` for 0.
pub fn highest_bit(value: f64) -> Option<i32> {
    let (mantissa, exponent) = decode(value);
    (mantissa != 0).then(|| exponent + (i64::BITS - mantissa.unsigned_abs().leading_zeros()) as i32)
}

/// The exponent of the lowest bit set in a finite double; `None` for 0.
pub fn lowest_bit(value: f64) -> Option<i32> {
    let (mantissa, exponent) = decode(value);
    (mantissa != 0).then_some(exponent)
}

/// A double in units of 2^`unit`; its lowest bit must be at least one unit.
pub fn integer(value: f64, unit: i32) -> IBig {
    let (mantissa, exponent) = decode(value);
    debug_assert!(mantissa == 0 || exponent >= unit, "{value} is not a multiple of 2^{unit}");
    if mantissa == 0 { IBig::ZERO } else { IBig::from(mantissa) << (exponent - unit) as usize }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubles_are_taken_apart() {
        assert_eq!(decode(-12.0), (-3, 2));
        assert_eq!(decode(f64::from_bits(3)), (3, -1074));
        assert_eq!((decode(-0.0), lowest_bit(0.0)), ((0, 0), None));
        assert_eq!(lowest_bit(f64::from_bits(1)), Some(-1074));
        assert_eq!([0.5, -3.0, 4.0, 0.0].map(highest_bit), [Some(0), Some(2), Some(3), None]);
        assert_eq!(<i128 as Integer>::of(-0.75, -4), -12);
        assert_eq!(integer(0.75, -4), IBig::from(12));
        assert_eq!(integer(0.0, 5), IBig::ZERO);
    }
}
