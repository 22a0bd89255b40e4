//! Errors of the command, and how all errors are printed: what could not be done, why, and what to do next.

use std::error::Error;
use std::io::IsTerminal;

use clap::error::ErrorKind;
use walpha_base::advice::{Advice, Setting};
use walpha_base::memory::NoMemory;
use walpha_base::shown::escaped;
use walpha_regular::{SitesError, TriangulationError};

use super::global::{FAILURE, UNREAD, USAGE};
use super::output::{OutputError, is_broken_pipe, remark};
use super::progress;
use crate::check::schema::SchemaError;
use crate::check::{CertifyError, CertifyFiltrationError, CompareError, CompareFiltrationsError};
use crate::export::{EmptyShape, TargetError};
use crate::haar::HaarError;
use crate::interpolate::InterpolateError;
use crate::outofcore::BlocksError;
use crate::pipeline::PipelineError;
use crate::points::{UnknownColumns, UnknownWeighting};
#[cfg(feature = "paper")]
use crate::reproduce::ReproduceError;
use crate::shape::{AlphaError, OutlineError, PlanError, ShapeError, TorusError};
use crate::volume::{UnknownFormat, UnknownName};
use crate::{CgalError, PointsError, VolumeError};

/// Why a command cannot do something, and what to do next.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{why}")]
pub(crate) struct CommandError {
    pub why: String,
    pub next: Option<String>,
    /// Whether the command line itself is wrong, whatever the files contain: exit code 2.
    pub usage: bool,
}

impl CommandError {
    /// An error of the library that the command line caused.
    pub(super) fn usage_of(error: &(impl Error + 'static)) -> Self {
        Self { why: error.to_string(), next: advice(error), usage: true }
    }
}

/// A [`CommandError`]: why, and after `=>` what to do next.
macro_rules! command_error {
    ($why:literal $(, $of_why:expr)* $(=> $next:literal $(, $of_next:expr)*)?) => {
        $crate::cli::errors::CommandError {
            why: format!($why $(, $of_why)*),
            next: [$(format!($next $(, $of_next)*))?].into_iter().next(),
            usage: false,
        }
    };
}

/// Returns a [`CommandError`].
macro_rules! fail {
    ($($text:tt)*) => {
        return Err($crate::cli::errors::command_error!($($text)*).into())
    };
}

/// Returns a [`CommandError`] about the command line itself.
macro_rules! fail_usage {
    ($($text:tt)*) => {
        return Err($crate::cli::errors::CommandError {
            usage: true,
            ..$crate::cli::errors::command_error!($($text)*)
        }
        .into())
    };
}

pub(crate) use {command_error, fail, fail_usage};

/// Lists the errors of the library that have advice.
macro_rules! advising {
    ($($(#[$condition:meta])? $error:ty),* $(,)?) => {
        /// Advice of an error of the library.
        fn of_library(error: &(dyn Error + 'static)) -> Option<Advice> {
            $($(#[$condition])? {
                if let Some(error) = error.downcast_ref::<$error>() {
                    return error.advice().into();
                }
            })*
            None
        }

        $($(#[$condition])? impl From<$error> for CommandError {
            fn from(error: $error) -> Self {
                Self { usage: false, ..Self::usage_of(&error) }
            }
        })*
    };
}
advising![
    BlocksError,
    CgalError,
    EmptyShape,
    HaarError,
    InterpolateError,
    NoMemory,
    OutlineError,
    PipelineError,
    PlanError,
    PointsError,
    #[cfg(feature = "paper")]
    ReproduceError,
    ShapeError,
    SitesError,
    TargetError,
    TorusError,
    TriangulationError,
    UnknownColumns,
    UnknownFormat,
    UnknownName,
    UnknownWeighting,
    OutputError,
    VolumeError,
];

impl From<AlphaError> for CommandError {
    fn from(error: AlphaError) -> Self {
        Self { why: error.to_string(), next: Some(error.advice().into()), usage: false }
    }
}

/// Advice of an error of the checker.
fn of_checker(error: &(dyn Error + 'static)) -> Option<&'static str> {
    if let Some(error) = error.downcast_ref::<AlphaError>() {
        return Some(error.advice());
    }
    if let Some(error) = error.downcast_ref::<SchemaError>() {
        return error.advice();
    }
    if let Some(error) = error.downcast_ref::<CertifyError>() {
        return error.advice();
    }
    if let Some(error) = error.downcast_ref::<CertifyFiltrationError>() {
        return error.advice();
    }
    if let Some(error) = error.downcast_ref::<CompareFiltrationsError>() {
        return error.advice();
    }
    error.downcast_ref::<CompareError>()?.advice()
}

/// Advice of any error, with settings named as options.
pub(super) fn advice(error: &(dyn Error + 'static)) -> Option<String> {
    match error.downcast_ref::<CommandError>() {
        Some(error) => error.next.clone(),
        None => of_checker(error)
            .map(Into::into)
            .or_else(|| of_library(error).map(|advice| advice.with_names(option))),
    }
}

/// The option for a setting.
pub(super) fn option(setting: Setting) -> String {
    match setting {
        Setting::Format => "--input-format".into(),
        Setting::Region => "--roi".into(),
        other => format!("--{}", other.name().replace('_', "-")),
    }
}

/// Whether standard error takes colours: a terminal, and `NO_COLOR` is not set (<https://no-color.org>).
pub(super) fn coloured() -> bool {
    let forbidden = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    std::io::stderr().is_terminal() && !forbidden
}

/// An error as three lines on standard error.
struct ErrorMessage {
    what: String,
    why: String,
    next: String,
}

/// Prints why a command failed. The stage that failed is the one announced last.
pub(super) fn print_error(command: &str, error: &anyhow::Error) {
    let what = match progress::current().as_str() {
        _ if is_usage(error) => "cannot do this".to_owned(),
        _ if error.is::<OutputError>() => "could not print its result".into(),
        "" => "could not start".into(),
        "read" => "could not read its input".into(),
        "haar" => "could not transform the volume".into(),
        "points" => "could not make weighted points".into(),
        "alpha" | "shape" => "could not compute the shape".into(),
        "write" => "could not write its result".into(),
        other => format!("could not finish: {other}"),
    };
    let (why, next) = reasons(error);
    let next = next.unwrap_or_else(|| help(command));
    ErrorMessage { what: format!("{command} {what}"), why, next }.print();
}

/// Whether the command line itself is wrong, whatever the files contain.
pub(super) fn is_usage(error: &anyhow::Error) -> bool {
    error.is::<UnknownFormat>()
        || error.downcast_ref::<CommandError>().is_some_and(|error| error.usage)
}

/// The exit code after an error.
pub(super) fn exit_code(error: &anyhow::Error) -> u8 {
    match error {
        _ if is_usage(error) => USAGE,
        _ if is_broken_pipe(error) => UNREAD,
        _ => FAILURE,
    }
}

/// Prints what is wrong with a command line; `configured` if some of it comes from a file.
pub(super) fn print_usage_error(command: &str, error: &clap::Error, configured: bool) {
    if matches!(error.kind(), ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand) {
        let _ = error.print();
        return;
    }
    let text = error.render().to_string();
    let (mut said, mut tips, mut usage) = (Vec::new(), Vec::new(), None);
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
        if let Some(tip) = line.strip_prefix("tip: ") {
            tips.push(tip.to_owned());
        } else if let Some(line) = line.strip_prefix("Usage: ") {
            usage = Some(line.to_owned());
        } else if !line.starts_with("For more information") && usage.is_none() {
            said.push(line);
        }
    }
    let mut what = said.first().map_or("", |line| line.trim_start_matches("error: ")).to_owned();
    let mut rest = said.get(1..).unwrap_or_default().join(" ");
    // "invalid value 'x' for '--option <X>': what its parser says".
    if rest.is_empty()
        && let Some((head, tail)) = what.split_once("': ")
    {
        (what, rest) = (format!("{head}'"), tail.to_owned());
    }
    if what.ends_with(':') {
        what = format!("{what} {rest}");
        rest = String::new();
    }
    let (why, next) = match rest.strip_prefix("[possible values: ") {
        Some(values) => (format!("it is one of {}", values.trim_end_matches(']')), None),
        None => (rest, error.source().and_then(advice)),
    };
    let why = if why.is_empty() {
        usage.map_or_else(|| format!("{command} does not take it"), |u| format!("the usage is {u}"))
    } else {
        why
    };
    tips.extend(next);
    if configured {
        tips.push("note that --config sets options, too".into());
    }
    let next = if tips.is_empty() { help(command) } else { tips.join("; ") };
    ErrorMessage { what, why, next }.print();
}

impl ErrorMessage {
    fn print(&self) {
        let (red, bold, plain) =
            if coloured() { ("\x1b[1;31m", "\x1b[1m", "\x1b[0m") } else { ("", "", "") };
        // They contain names of files and arguments, which may hold control characters.
        let [what, why, next] =
            [&self.what, &self.why, &self.next].map(|text| escaped(text, |_| false));
        remark(&format!("{red}error:{plain} {what}"));
        remark(&format!("{bold}  why:{plain} {why}"));
        remark(&format!("{bold} next:{plain} {next}"));
    }
}

fn help(command: &str) -> String {
    format!("`{command} --help` lists its options")
}

/// The messages of an error and its causes, each once, and the advice of the innermost one that has some.
pub(super) fn reasons(error: &anyhow::Error) -> (String, Option<String>) {
    let (mut why, mut next) = (String::new(), None);
    for cause in error.chain() {
        let text = cause.to_string().replace('\n', " ");
        if why.is_empty() {
            why = text;
        } else if !why.contains(&text) {
            why = format!("{why}: {text}");
        }
        next = advice(cause).or(next);
    }
    (why, next)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn causes_are_told_once_and_before_advice() {
        let error = anyhow::anyhow!("no room").context("cannot write a: no room").context("shape");
        assert_eq!(reasons(&error), ("shape: cannot write a: no room".into(), None));
        let error =
            anyhow::Error::from(command_error!("b; or c: it is a folder" => "check the path"));
        let error = error.context("cannot read a");
        let expected =
            ("cannot read a: b; or c: it is a folder".into(), Some("check the path".into()));
        assert_eq!(reasons(&error), expected);
    }

    #[test]
    fn the_library_speaks_in_options() {
        let error = ShapeError::Divided { by: crate::shape::Whole::Exterior, blocks: 3 };
        let (why, next) = reasons(&error.into());
        assert!(why.contains("3 blocks") && !why.contains("--"), "{why}");
        assert_eq!(next.as_deref(), Some("give --blocks 1, or omit --exterior"));
    }
}
