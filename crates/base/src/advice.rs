//! What all errors of the library have in common: advice on how to resolve them, and a category.

use std::borrow::Cow;
use std::error::Error;
use std::{fmt, io};

use crate::memory::NoMemory;

/// An error of the library. `Display` says what is wrong, the advice says what to do, and the category tells a program how to
/// pass the error on: as which exception, or with which exit code.
///
/// An error that wraps another has the advice and category of the wrapped one: such a type defines [`wrapped`](Self::wrapped),
/// and the other methods only where it differs.
pub trait Advise: Error {
    /// The wrapped error, if it is an error of the library or the system.
    fn wrapped(&self) -> Option<&dyn Advise> {
        None
    }

    /// What is wrong, as `Display` says, with the settings that the text names.
    fn message(&self) -> Advice {
        self.to_string().into()
    }

    /// How to resolve the error, if there is a way.
    fn advice(&self) -> Option<Advice> {
        self.wrapped()?.advice()
    }

    /// What the error is about.
    fn category(&self) -> Category {
        self.wrapped().map_or(Category::Input, Advise::category)
    }
}

/// Describes an error in the words of a program that has other names for settings. Returns one line, with its message and those
/// of its causes, each once; and its advice.
pub fn told(error: &dyn Advise, name: &dyn Fn(Setting) -> String) -> (String, Option<String>) {
    let one_line = |text: String| text.replace('\n', " ");
    let mut why = one_line(error.message().with_names(name));
    let mut cause = error.source();
    while let Some(error) = cause {
        let text = one_line(error.to_string());
        if !why.contains(&text) {
            why = format!("{why}: {text}");
        }
        cause = error.source();
    }
    (why, error.advice().map(|advice| advice.with_names(name)))
}

/// What an error is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Category {
    /// The input or an option: a value, or the content of a file.
    Input,
    /// The call itself, whatever the input contains, such as the name of an output that no format has.
    Usage,
    /// Memory: there is not enough.
    Memory,
    /// Nothing is wrong: the caller cancelled the work.
    Cancelled,
    /// A file, folder or stream that the operating system refuses.
    System(io::ErrorKind),
    /// Two results that must be equal but differ.
    Different,
    /// The program: the error is a fault of walpha or of a library that it uses.
    Program,
}

impl<E: Advise> Advise for Box<E> {
    fn wrapped(&self) -> Option<&dyn Advise> {
        Some(&**self)
    }
}

/// An error of the operating system, or for lack of memory while a file is written.
impl Advise for io::Error {
    fn wrapped(&self) -> Option<&dyn Advise> {
        Some(self.get_ref()?.downcast_ref::<NoMemory>()?)
    }

    fn category(&self) -> Category {
        self.wrapped().map_or(Category::System(self.kind()), Advise::category)
    }
}

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
    Chains,
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
    Hetero,
    Hidden,
    Hydrogens,
    InPlace,
    Keep,
    Level,
    MaxError,
    Memory,
    MinVolume,
    Models,
    Nan,
    NoResample,
    Offset,
    Periodic,
    Radii,
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
    Thin,
    Threshold,
    ValueMin,
    Waters,
    /// Whether points that are withheld are read.
    Withheld,
}

impl Setting {
    /// The name of the setting, in lower case, with underscores.
    pub fn name(self) -> &'static str {
        match self {
            Self::Alpha => "alpha",
            Self::AlphaRadius => "alpha_radius",
            Self::AlphaRef => "alpha_ref",
            Self::Array => "array",
            Self::Balls => "balls",
            Self::Blocks => "blocks",
            Self::Chains => "chains",
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
            Self::Hetero => "hetero",
            Self::Hidden => "hidden",
            Self::Hydrogens => "hydrogens",
            Self::InPlace => "in_place",
            Self::Keep => "keep",
            Self::Level => "level",
            Self::MaxError => "max_error",
            Self::Memory => "memory",
            Self::MinVolume => "min_volume",
            Self::Models => "models",
            Self::Nan => "nan",
            Self::NoResample => "no_resample",
            Self::Offset => "offset",
            Self::Periodic => "periodic",
            Self::Radii => "radii",
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
            Self::Thin => "thin",
            Self::Threshold => "threshold",
            Self::ValueMin => "value_min",
            Self::Waters => "waters",
            Self::Withheld => "withheld",
        }
    }
}

impl Advice {
    #[doc(hidden)]
    pub fn new(parts: impl IntoIterator<Item = Part>) -> Self {
        Self(parts.into_iter().collect())
    }

    /// This advice, followed by another one.
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

/// Implements [`Advise::wrapped`] for an enum. It takes the variants that hold an error alone and, after a semicolon, those that
/// hold one in a field: `wrapped!(Memory, Volume; Io { source })`.
#[doc(hidden)]
#[macro_export]
macro_rules! __wrapped {
    ($($variant:ident),* $(; $($with:ident { $field:ident }),+)?) => {
        fn wrapped(&self) -> Option<&dyn $crate::advice::Advise> {
            #[allow(unreachable_patterns, reason = "all variants may be named")]
            match self {
                $(Self::$variant(error) => Some(error),)*
                $($(Self::$with { $field: error, .. } => Some(error),)+)?
                _ => None,
            }
        }
    };
}
#[doc(inline)]
pub use __wrapped as wrapped;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::{NoMemory, try_with_capacity};

    #[test]
    fn settings_have_the_names_of_the_program() {
        let advice = advice!["omit ", Setting::GrayMin, format!(", or give {}", 3)];
        assert_eq!(advice.to_string(), "omit `gray_min`, or give 3");
        let flag = |setting: Setting| format!("--{}", setting.name().replace('_', "-"));
        assert_eq!(advice.with_names(flag), "omit --gray-min, or give 3");
    }

    #[derive(Debug, thiserror::Error)]
    #[error("outer")]
    enum Outer {
        File { source: io::Error },
        Memory(NoMemory),
        Other,
    }

    impl Advise for Outer {
        wrapped!(Memory; File { source });
    }

    #[test]
    fn an_error_has_the_advice_and_category_of_what_it_wraps() {
        let lack = try_with_capacity::<u64>(usize::MAX, String::new).unwrap_err();
        let advice = lack.advice();
        let error = Outer::Memory(lack);
        assert_eq!((error.advice(), error.category()), (advice, Category::Memory));
        let error = Outer::File { source: io::ErrorKind::NotFound.into() };
        assert_eq!(error.category(), Category::System(io::ErrorKind::NotFound));
        assert_eq!((Outer::Other.advice(), Outer::Other.category()), (None, Category::Input));
    }
}
