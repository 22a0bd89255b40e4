use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use walpha_base::advice::{Advice, Advise};

/// How a file stores one sample.
///
/// Samples become `f32`. 8-bit and 16-bit integers and `f32` keep their exact value. `u32`, `i32`, `u64`, `i64` and `f64` are
/// rounded to the nearest `f32` (24 significant bits); readers warn if that changes whole numbers, or if an `f64` is beyond the range
/// and becomes infinite, which [`Volume::new`](super::Volume::new) refuses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs, reason = "the names say all")]
#[non_exhaustive]
pub enum Dtype {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F32,
    F64,
}

/// The order of the bytes of a sample in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Endian {
    /// Least significant byte first, as x86 and ARM machines write.
    #[default]
    Little,
    /// Most significant byte first.
    Big,
}

/// The error for an unknown name of a sample type or byte order.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{given:?} is no {kind}")]
pub struct UnknownName {
    given: String,
    kind: &'static str,
    known: String,
}

impl Advise for UnknownName {
    fn advice(&self) -> Option<Advice> {
        Some(format!("give one of {}", self.known).into())
    }
}

impl Dtype {
    /// All sample types.
    pub const ALL: [Self; 10] = [
        Self::U8,
        Self::I8,
        Self::U16,
        Self::I16,
        Self::U32,
        Self::I32,
        Self::U64,
        Self::I64,
        Self::F32,
        Self::F64,
    ];

    /// The size of one sample in bytes.
    pub fn size(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::U64 | Self::I64 | Self::F64 => 8,
        }
    }

    /// Whether a number read from text is a value of this type.
    pub fn holds(self, value: f64) -> bool {
        let (low, high) = match self {
            Self::U8 => (0.0, f64::from(u8::MAX)),
            Self::I8 => (f64::from(i8::MIN), f64::from(i8::MAX)),
            Self::U16 => (0.0, f64::from(u16::MAX)),
            Self::I16 => (f64::from(i16::MIN), f64::from(i16::MAX)),
            Self::U32 => (0.0, f64::from(u32::MAX)),
            Self::I32 => (f64::from(i32::MIN), f64::from(i32::MAX)),
            // The limits of 64-bit types are rounded up to a power of two, like the number from the text.
            Self::U64 => (0.0, u64::MAX as f64),
            Self::I64 => (i64::MIN as f64, i64::MAX as f64),
            Self::F32 | Self::F64 => return true,
        };
        (low..=high).contains(&value) && value.fract() == 0.0
    }

    /// The short name, such as `u8`.
    pub fn name(self) -> &'static str {
        match self {
            Self::U8 => "u8",
            Self::I8 => "i8",
            Self::U16 => "u16",
            Self::I16 => "i16",
            Self::U32 => "u32",
            Self::I32 => "i32",
            Self::U64 => "u64",
            Self::I64 => "i64",
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }
}

/// A type of numbers that [`Volume::of_samples`](super::Volume::of_samples) takes: one of [`Dtype`].
pub trait Sample: Copy + Send + Sync + sealed::Sealed {
    /// The sample type.
    const DTYPE: Dtype;
    /// Converts the number, which is rounded as [`Dtype`] says.
    fn to_f32(self) -> f32;
    /// Whether the number is a whole number that `f32` cannot hold, so that it is rounded; or is beyond its range, so that it becomes
    /// infinite.
    fn is_rounded(self) -> bool;
}

mod sealed {
    pub trait Sealed {}
}

/// The largest number up to which `f32` holds every whole number.
pub(crate) const HELD: f64 = 16777216.0;
/// The number from which on all `f64` are whole numbers.
const ALL_WHOLE: f64 = 9007199254740992.0;

macro_rules! samples {
    ($($number:ty: $dtype:ident),*) => {$(
        impl sealed::Sealed for $number {}
        impl Sample for $number {
            const DTYPE: Dtype = Dtype::$dtype;
            #[allow(clippy::cast_lossless, trivial_numeric_casts, reason = "from any number to f32")]
            fn to_f32(self) -> f32 {
                self as f32
            }
            #[allow(clippy::cast_lossless, trivial_numeric_casts, reason = "from any number to f64")]
            fn is_rounded(self) -> bool {
                let exact = self as f64;
                let is_beyond = exact.is_finite() && !(self as f32).is_finite();
                is_beyond
                    || size_of::<Self>() > 2
                    && exact.abs() > HELD
                    // Doubles from 2⁵³ on are whole only because they have no bits for fractions.
                    && (Self::DTYPE != Dtype::F64
                        || exact.fract() == 0.0 && exact.abs() < ALL_WHOLE)
                    && self as f32 as i128 != self as i128
            }
        }
    )*};
}

samples! { u8: U8, i8: I8, u16: U16, i16: I16, u32: U32, i32: I32, u64: U64, i64: I64, f32: F32, f64: F64 }

impl fmt::Display for Dtype {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Dtype {
    type Err = UnknownName;

    fn from_str(text: &str) -> Result<Self, UnknownName> {
        Self::ALL.into_iter().find(|dtype| dtype.name() == text).ok_or_else(|| UnknownName {
            given: text.into(),
            kind: "sample type",
            known: Self::ALL.map(Self::name).join(", "),
        })
    }
}

impl fmt::Display for Endian {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Little => "little",
            Self::Big => "big",
        })
    }
}

impl FromStr for Endian {
    type Err = UnknownName;

    fn from_str(text: &str) -> Result<Self, UnknownName> {
        match text {
            "little" => Ok(Self::Little),
            "big" => Ok(Self::Big),
            _ => Err(UnknownName {
                given: text.into(),
                kind: "byte order",
                known: "little, big".into(),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back() {
        for dtype in Dtype::ALL {
            assert_eq!(dtype.to_string().parse(), Ok(dtype));
        }
        for endian in [Endian::Little, Endian::Big] {
            assert_eq!(endian.to_string().parse(), Ok(endian));
        }
        let error = "f16".parse::<Dtype>().unwrap_err();
        assert!(error.to_string().contains("f16"), "{error}");
        assert!(error.advice().unwrap().to_string().contains("u8, i8"));
        assert!("middle".parse::<Endian>().is_err());
    }
}
