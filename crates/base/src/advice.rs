//! Advice on how to resolve errors: text, and the settings of the library that it mentions.

use std::borrow::Cow;
use std::fmt;

/// How to resolve an error. Settings have their names in the library; a program with other names
/// for them, such as options of a command, substitutes these ([`with_names`](Self::with_names)).
///
/// ```
/// use walpha_base::advice::{Setting, advice};
///
/// let advice = advice!["lower ", Setting::Alpha];
/// assert_eq!(advice.to_string(), "lower `alpha`");
/// assert_eq!(advice.with_names(|setting| format!("--{}", setting.name())), "lower --alpha");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Advice(Vec<Part>);

/// A part of an advice: text, or a setting.
#[derive(Clone, Debug, PartialEq, Eq)]
#[doc(hidden)]
pub enum Part {
    Text(Cow<'static, str>),
    Setting(Setting),
}

/// A setting that advice mentions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[allow(missing_docs, reason = "documented at the fields of the options")]
pub enum Setting {
    Alpha,
    AlphaRadius,
    AlphaRef,
    Array,
    Balls,
    Blocks,
    /// Which classes of points are read.
    Class,
    Coefficients,
    Columns,
    Count,
    Dims,
    Downsample,
    Dtype,
    Engine,
    Epsilon,
    Exchange,
    Exterior,
    Format,
    Frame,
    Gray,
    GrayMin,
    Hidden,
    InPlace,
    Level,
    MaxError,
    Memory,
    Nan,
    NoResample,
    Offset,
    Periodic,
    Ratio,
    Refit,
    Region,
    Rms,
    Select,
    Series,
    SkipDamaged,
    Solid,
    Space,
    TargetRmse,
    Threshold,
    ValueMin,
    /// Whether points that are withheld are read.
    Withheld,
}

impl Setting {
    /// Its name, in lower case, with underscores.
    pub fn name(self) -> &'static str {
        match self {
            Self::Alpha => "alpha",
            Self::AlphaRadius => "alpha_radius",
            Self::AlphaRef => "alpha_ref",
            Self::Array => "array",
            Self::Balls => "balls",
            Self::Blocks => "blocks",
            Self::Class => "class",
            Self::Coefficients => "coefficients",
            Self::Columns => "columns",
            Self::Count => "count",
            Self::Dims => "dims",
            Self::Downsample => "downsample",
            Self::Dtype => "dtype",
            Self::Engine => "engine",
            Self::Epsilon => "epsilon",
            Self::Exchange => "exchange",
            Self::Exterior => "exterior",
            Self::Format => "format",
            Self::Frame => "frame",
            Self::Gray => "gray",
            Self::GrayMin => "gray_min",
            Self::Hidden => "hidden",
            Self::InPlace => "in_place",
            Self::Level => "level",
            Self::MaxError => "max_error",
            Self::Memory => "memory",
            Self::Nan => "nan",
            Self::NoResample => "no_resample",
            Self::Offset => "offset",
            Self::Periodic => "periodic",
            Self::Ratio => "ratio",
            Self::Refit => "refit",
            Self::Region => "region",
            Self::Rms => "rms",
            Self::Select => "select",
            Self::Series => "series",
            Self::SkipDamaged => "skip_damaged",
            Self::Solid => "solid",
            Self::Space => "space",
            Self::TargetRmse => "target_rmse",
            Self::Threshold => "threshold",
            Self::ValueMin => "value_min",
            Self::Withheld => "withheld",
        }
    }
}

impl Advice {
    #[doc(hidden)]
    pub fn new(parts: impl IntoIterator<Item = Part>) -> Self {
        Self(parts.into_iter().collect())
    }

    /// This advice and another one after it.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    /// The text, with each setting under the name that `name` returns.
    pub fn with_names(&self, name: impl Fn(Setting) -> String) -> String {
        let part = |part: &Part| match part {
            Part::Text(text) => text.to_string(),
            Part::Setting(setting) => name(*setting),
        };
        self.0.iter().map(part).collect()
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.with_names(|setting| format!("`{}`", setting.name())))
    }
}

impl From<&'static str> for Advice {
    fn from(text: &'static str) -> Self {
        Self::new([text.into()])
    }
}

impl From<String> for Advice {
    fn from(text: String) -> Self {
        Self::new([text.into()])
    }
}

impl From<&'static str> for Part {
    fn from(text: &'static str) -> Self {
        Self::Text(text.into())
    }
}

impl From<String> for Part {
    fn from(text: String) -> Self {
        Self::Text(text.into())
    }
}

impl From<Setting> for Part {
    fn from(setting: Setting) -> Self {
        Self::Setting(setting)
    }
}

/// An [`Advice`] made of texts and settings: `advice!["omit ", Setting::Frame]`.
#[doc(hidden)]
#[macro_export]
macro_rules! __advice {
    [$($part:expr),+ $(,)?] => {
        $crate::advice::Advice::new([$($crate::advice::Part::from($part)),+])
    };
}
#[doc(inline)]
pub use __advice as advice;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_have_the_names_of_the_program() {
        let advice = advice!["omit ", Setting::GrayMin, format!(", or give {}", 3)];
        assert_eq!(advice.to_string(), "omit `gray_min`, or give 3");
        let flag = |setting: Setting| format!("--{}", setting.name().replace('_', "-"));
        assert_eq!(advice.with_names(flag), "omit --gray-min, or give 3");
    }
}
