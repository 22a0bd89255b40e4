use crate::advice::Advice;
use serde::{Deserialize, Serialize, Serializer};

use crate::shown::{number, six_digits};

/// The parameter α of a shape: a **squared** length, as in CGAL and in Edelsbrunner 1992.
///
/// α = ∞ gives the convex hull; with weights a negative α is legal. It is never NaN.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Alpha(f64);

impl Alpha {
    /// α = ∞: every cell of the regular triangulation, whose union is the convex hull.
    pub const INFINITE: Self = Self(f64::INFINITY);

    /// α given as a squared length.
    ///
    /// # Errors
    /// [`NotAnAlpha`] for NaN.
    pub fn from_squared(squared: f64) -> Result<Self, NotAnAlpha> {
        if squared.is_nan() { Err(NotAnAlpha::NaN) } else { Ok(Self(squared)) }
    }

    /// α given by the radius it is the square of, rounded once.
    ///
    /// # Errors
    /// [`NotAnAlpha`] for NaN and for a negative radius.
    pub fn from_radius(radius: f64) -> Result<Self, NotAnAlpha> {
        match radius {
            _ if radius.is_nan() => Err(NotAnAlpha::NaN),
            _ if radius < 0.0 => Err(NotAnAlpha::Radius(radius)),
            _ => Ok(Self(radius * radius)),
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

impl std::fmt::Display for Alpha {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.radius() {
            Some(radius) => {
                let (alpha, radius) = (number(self.0), number(six_digits(radius)));
                write!(f, "α = {alpha} (squared length; √α = {radius})")
            }
            None => write!(f, "α = {} (squared length; negative, so no radius)", number(self.0)),
        }
    }
}

/// The number given as α is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NotAnAlpha {
    /// NaN.
    #[error("α cannot be NaN")]
    NaN,
    /// A negative radius.
    #[error("a radius must not be negative, and {0} is")]
    Radius(f64),
}

impl NotAnAlpha {
    /// What to do about it.
    pub fn advice(&self) -> Advice {
        match self {
            Self::NaN => "give a number (a squared length), or `inf` for the convex hull".into(),
            Self::Radius(_) => "give a length from 0 up, or α itself".into(),
        }
    }
}

/// What a point with weight ω is at parameter α.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Balls {
    /// A ball of squared radius α + ω: the usual reading (Edelsbrunner 1992; CGAL), the default.
    #[default]
    Power,
    /// A ball of radius α + ω, as a sentence of the paper's section 4.2 reads: the power weight
    /// (α + ω)² at parameter 0.
    Radius,
}

/// Writes a number that may be infinite, as α is, where there is no number for ∞ (JSON): as the string "inf"
/// or "-inf". For `#[serde(serialize_with)]`.
///
/// # Errors
/// Those of the serializer.
pub fn number_or_name<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if number.is_finite() {
        serializer.serialize_f64(*number)
    } else {
        serializer.serialize_str(&number.to_string())
    }
}

/// The same for two numbers.
pub(crate) fn each_number_or_name<S: Serializer>(
    numbers: &[f64; 2],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Named(#[serde(serialize_with = "number_or_name")] f64);
    numbers.map(Named).serialize(serializer)
}
