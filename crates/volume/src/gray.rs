use serde::{Deserialize, Serialize};

/// The values of a file that become gray 0 and gray 255. The mapping between them is linear; values outside are not clamped, and
/// nothing is rounded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GrayRange {
    /// The value that becomes gray 0.
    pub low: f64,
    /// The value that becomes gray 255.
    pub high: f64,
}

/// The mapping that turns the values of a file into gray levels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Gray {
    /// Keeps unsigned 8-bit samples, and maps all others from their minimum to their maximum.
    #[default]
    Automatic,
    /// A range given by the user.
    Range(GrayRange),
}

impl GrayRange {
    /// The range that leaves values as they are.
    pub const IDENTITY: Self = Self { low: 0.0, high: 255.0 };

    /// Whether the mapping leaves values unchanged.
    pub fn is_identity(&self) -> bool {
        *self == Self::IDENTITY
    }

    /// The difference of values that corresponds to one gray level.
    pub fn step(&self) -> f64 {
        (self.high - self.low) / 255.0
    }

    /// The value that a gray level represents. Gray levels are `f32`: a value within their rounding error of a whole number
    /// becomes that number, so that whole values of a file survive the round trip.
    pub fn value(&self, gray: f64) -> f64 {
        if self.is_identity() {
            return gray;
        }
        let width = self.high - self.low;
        let value = self.low + gray * width / 255.0;
        let whole = value.round();
        let unsure = width * f64::from(f32::EPSILON);
        if (value - whole).abs() <= unsure { whole } else { value }
    }

    /// The gray level of a value. An empty range (constant volume) maps everything to 0.
    pub fn gray(&self, value: f64) -> f64 {
        if self.is_identity() {
            value
        } else if self.high == self.low {
            0.0
        } else {
            255.0 * (value - self.low) / (self.high - self.low)
        }
    }
}
