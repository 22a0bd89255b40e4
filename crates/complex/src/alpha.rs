use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use walpha_base::advice::{Advice, Advise};
use walpha_base::shown::number;

/// The parameter α of a shape: a **squared** length, as in CGAL and in Edelsbrunner 1992.
///
/// α = ∞ gives the convex hull; with weights a negative α is allowed. It is never NaN, so any two can be compared; −0 is 0.
///
/// In text, and in JSON, it is a number, `inf` or `-inf`:
///
/// ```
/// use walpha_complex::Alpha;
///
/// let alpha: Alpha = "0.75".parse()?;
/// assert_eq!(alpha, Alpha::from_squared(0.75)?);
/// assert_eq!("inf".parse(), Ok(Alpha::INFINITE));
/// assert_eq!(Alpha::INFINITE.to_string(), "inf");
/// # Ok::<(), walpha_complex::AlphaError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alpha(f64);

impl Alpha {
    /// α = ∞: every cell of the regular triangulation, whose union is the convex hull.
    pub const INFINITE: Self = Self(f64::INFINITY);

    /// α = 0: spheres no larger than the weights make them.
    pub const ZERO: Self = Self(0.0);

    /// α given as a squared length.
    ///
    /// # Errors
    /// [`AlphaError::NaN`].
    pub fn from_squared(squared: f64) -> Result<Self, AlphaError> {
        // Adding 0.0 turns −0.0 into 0.0, so that equal α have equal bits.
        if squared.is_nan() { Err(AlphaError::NaN) } else { Ok(Self(squared + 0.0)) }
    }

    /// α given by its square root, a radius, and rounded once.
    ///
    /// # Errors
    /// [`AlphaError`] for NaN, for a negative radius, and for a radius whose square is too large or too small for a double.
    pub fn from_radius(radius: f64) -> Result<Self, AlphaError> {
        match radius {
            _ if radius.is_nan() => Err(AlphaError::NaN),
            _ if radius < 0.0 => Err(AlphaError::Radius(radius)),
            _ if radius == 0.0 || radius.is_infinite() || (radius * radius).is_normal() => {
                Ok(Self(radius * radius))
            }
            _ => Err(AlphaError::Square(radius)),
        }
    }

    /// α as a squared length.
    pub fn squared(self) -> f64 {
        self.0
    }

    /// √α, a length; `None` when α is negative.
    pub fn radius(self) -> Option<f64> {
        (self.0 >= 0.0).then(|| self.0.sqrt())
    }
}

impl Eq for Alpha {}

impl Ord for Alpha {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Alpha {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Hash for Alpha {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.to_bits().hash(state);
    }
}

/// The reason why a number or a text is not an α.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AlphaError {
    /// NaN.
    #[error("α cannot be NaN")]
    NaN,
    /// A negative radius.
    #[error("a radius must not be negative, and {} is", number(*.0))]
    Radius(f64),
    /// A radius whose square is beyond the range of doubles.
    #[error("a double does not hold the square of the radius {0:e}")]
    Square(f64),
    /// Text that is not a number.
    #[error("{0:?} is not a number")]
    Text(String),
}

impl Advise for AlphaError {
    fn advice(&self) -> Option<Advice> {
        let advice = match self {
            Self::NaN => "give a number (a squared length), or `inf` for the convex hull",
            Self::Radius(_) => "give a length from 0 up, or α itself",
            Self::Square(_) => "rescale the input, or give `inf` for the convex hull",
            Self::Text(_) => "give a squared length, as in 10, or `inf` for the convex hull",
        };
        Some(advice.into())
    }
}

/// The number alone, as `f64` prints it; reading it back gives the same α.
impl fmt::Display for Alpha {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl FromStr for Alpha {
    type Err = AlphaError;

    fn from_str(text: &str) -> Result<Self, AlphaError> {
        let squared = text.parse().map_err(|_| AlphaError::Text(text.to_owned()))?;
        Self::from_squared(squared)
    }
}

/// A number, or the string "inf" or "-inf", for which JSON has no number.
impl Serialize for Alpha {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0.is_finite() {
            serializer.serialize_f64(self.0)
        } else {
            serializer.collect_str(self)
        }
    }
}

impl<'de> Deserialize<'de> for Alpha {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;

        impl de::Visitor<'_> for Visitor {
            type Value = Alpha;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("alpha as a number, \"inf\" or \"-inf\"")
            }

            fn visit_f64<E: de::Error>(self, number: f64) -> Result<Alpha, E> {
                Alpha::from_squared(number).map_err(E::custom)
            }

            fn visit_i64<E: de::Error>(self, number: i64) -> Result<Alpha, E> {
                self.visit_f64(number as f64)
            }

            fn visit_u64<E: de::Error>(self, number: u64) -> Result<Alpha, E> {
                self.visit_f64(number as f64)
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Alpha, E> {
                match text {
                    "inf" => Ok(Alpha::INFINITE),
                    "-inf" => Ok(Alpha(f64::NEG_INFINITY)),
                    _ => Err(E::invalid_value(de::Unexpected::Str(text), &self)),
                }
            }
        }

        deserializer.deserialize_any(Visitor)
    }
}
