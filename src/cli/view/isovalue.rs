//! The level of an isosurface, as it is given on the command line.

use std::str::FromStr;

use anyhow::bail;

use crate::GrayRange;
use crate::cli::args;

/// A gray level, or a value of the file: `50` or `300v`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Isovalue {
    /// As the wavelet stage has it.
    Gray(f64),
    /// As the file has it.
    Value(f64),
}

impl Default for Isovalue {
    fn default() -> Self {
        Self::Gray(50.0)
    }
}

impl Isovalue {
    /// The gray level, where values `range` are gray 0..255.
    pub(super) fn gray(self, range: &GrayRange) -> f64 {
        match self {
            Self::Gray(gray) => gray,
            Self::Value(value) => range.gray(value),
        }
    }
}

impl FromStr for Isovalue {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> anyhow::Result<Self> {
        let (number, level): (_, fn(f64) -> Self) = match text.strip_suffix('v') {
            Some(value) => (value, Self::Value),
            None => (text, Self::Gray),
        };
        match args::number(number)? {
            number if number.is_finite() => Ok(level(number)),
            _ => bail!(
                "a finite number is needed; give a gray level as in 50, or a value as in 300v"
            ),
        }
    }
}
