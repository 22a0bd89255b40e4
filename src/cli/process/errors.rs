//! Errors of the command, and the printing of all errors: what failed, why, and what to do next.

use std::io::{self, IsTerminal, Write};

use serde::Serialize;
use walpha_base::advice::{Advise, Category, Setting, told};
use walpha_base::shown::escaped;

use crate::cli::options::global::{DIFFERENT, FAILURE, UNREAD, USAGE};
use crate::cli::process::output::{json, remark, write_all};
use crate::cli::process::progress;
use crate::cli::report::SCHEMA_VERSION;

/// The result of a command or of one of its steps.
pub(crate) type Result<T, E = CommandError> = std::result::Result<T, E>;

/// The reason why a command failed, and what to do next.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{why}")]
pub(crate) struct CommandError {
    pub why: String,
    pub next: Option<String>,
    /// The category, which is [`Category::Usage`] if the command line itself is wrong.
    pub category: Category,
    /// Whether the result was computed but cannot be printed.
    pub unprinted: bool,
}

impl CommandError {
    /// Converts an error of the library that the command line caused.
    pub(crate) fn usage_of(error: impl Advise) -> Self {
        Self { category: Category::Usage, ..error.into() }
    }

    /// Prefixes the error with the item that it concerns.
    pub(crate) fn context(self, text: String) -> Self {
        let why = if text.contains(&self.why) { text } else { format!("{text}: {}", self.why) };
        Self { why, ..self }
    }
}

/// Joins the messages of an error of the library and its causes, each once, and takes its advice with settings named as options.
impl<E: Advise> From<E> for CommandError {
    fn from(error: E) -> Self {
        let (why, next) = told(&error, &option);
        Self { why, next, category: error.category(), unprinted: false }
    }
}

/// Creates a [`CommandError`]: the reason and, after `=>`, what to do next.
macro_rules! command_error {
    ($why:literal $(, $of_why:expr)* $(=> $next:literal $(, $of_next:expr)*)?) => {
        $crate::cli::process::errors::CommandError {
            why: format!($why $(, $of_why)*),
            next: [$(format!($next $(, $of_next)*))?].into_iter().next(),
            category: walpha_base::advice::Category::Input,
            unprinted: false,
        }
    };
}

/// Returns a [`CommandError`].
macro_rules! fail {
    ($($text:tt)*) => {
        return Err($crate::cli::process::errors::command_error!($($text)*))
    };
}

/// Returns a [`CommandError`] about the command line itself.
macro_rules! fail_usage {
    ($($text:tt)*) => {
        return Err($crate::cli::process::errors::CommandError {
            category: walpha_base::advice::Category::Usage,
            ..$crate::cli::process::errors::command_error!($($text)*)
        })
    };
}

pub(crate) use {command_error, fail, fail_usage};

/// The option for a setting.
pub(crate) fn option(setting: Setting) -> String {
    match setting {
        Setting::Format => "--input-format".into(),
        Setting::Region => "--roi".into(),
        other => format!("--{}", other.name().replace('_', "-")),
    }
}

/// Whether standard error supports colours: it is a terminal, and `NO_COLOR` is not set (<https://no-color.org>).
pub(crate) fn coloured() -> bool {
    let forbidden = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    io::stderr().is_terminal() && !forbidden
}

/// An error: what failed, why, and what to do next.
pub(crate) struct ErrorMessage {
    pub(super) what: String,
    pub(super) why: String,
    pub(super) next: String,
}

/// Prints why a command failed. The stage that failed is the last one announced. A reader that went away, as `head` does, is not
/// told of: the exit code is that of a program which the signal PIPE ends.
pub(crate) fn print_error(command: &str, error: &CommandError, form: ErrorForm) {
    let code = exit_code(error);
    if code == UNREAD {
        return;
    }
    let what = match progress::current().as_str() {
        _ if error.category == Category::Usage => "cannot do this".to_owned(),
        _ if error.unprinted => "could not print its result".into(),
        "" => "could not start".into(),
        "read" => "could not read its input".into(),
        "haar" => "could not transform the volume".into(),
        "points" => "could not make weighted points".into(),
        "alpha" | "shape" => "could not compute the shape".into(),
        "write" => "could not write its result".into(),
        other => format!("could not finish: {other}"),
    };
    let CommandError { why, next, .. } = error.clone();
    let next = next.unwrap_or_else(|| help(command));
    // What cannot be printed on standard output is told on standard error.
    let form = if error.unprinted { ErrorForm::Text } else { form };
    ErrorMessage { what: format!("{command} {what}"), why, next }.print(form, code);
}

/// The exit code after an error.
pub(crate) fn exit_code(error: &CommandError) -> u8 {
    match error.category {
        Category::Usage => USAGE,
        Category::Different => DIFFERENT,
        Category::System(io::ErrorKind::BrokenPipe) => UNREAD,
        _ => FAILURE,
    }
}

impl ErrorMessage {
    /// Prints the message: as text on standard error, or as JSON where the report would be.
    pub(crate) fn print(&self, form: ErrorForm, exit_code: u8) {
        if let ErrorForm::Json { piped } = form {
            let Self { what, why, next } = self;
            let error = ErrorReport { what, why, next, exit_code };
            let text = json(&WithError { schema_version: SCHEMA_VERSION, error });
            let print = |text: String| {
                if piped { io::stderr().write_all(text.as_bytes()) } else { write_all(&text) }
            };
            if text.and_then(print).is_ok() {
                return;
            }
        }
        let (red, bold, plain) =
            if coloured() { ("\x1b[1;31m", "\x1b[1m", "\x1b[0m") } else { ("", "", "") };
        // These contain names of files and arguments, which may contain control characters.
        let [what, why, next] =
            [&self.what, &self.why, &self.next].map(|text| escaped(text, |_| false));
        remark(&format!("{red}error:{plain} {what}"));
        remark(&format!("{bold}  why:{plain} {why}"));
        remark(&format!("{bold} next:{plain} {next}"));
    }
}

/// How an error is printed.
#[derive(Clone, Copy)]
pub(crate) enum ErrorForm {
    Text,
    /// One object on standard output, or on standard error if a file goes to standard output.
    Json {
        piped: bool,
    },
}

/// The report of `--json` after a failure.
#[derive(Serialize)]
struct WithError<'a> {
    schema_version: u32,
    error: ErrorReport<'a>,
}

#[derive(Serialize)]
struct ErrorReport<'a> {
    what: &'a str,
    why: &'a str,
    next: &'a str,
    exit_code: u8,
}

/// Where the help of a command is.
pub(super) fn help(command: &str) -> String {
    format!("`{command} --help` lists its options")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::ShapeError;

    #[test]
    fn causes_are_told_once_and_before_advice() {
        let error = command_error!("no room").context("cannot write a: no room".into());
        assert_eq!(error.context("shape".into()).why, "shape: cannot write a: no room");
        let error = command_error!("b; or c: it is a folder" => "check the path");
        let error = error.context("cannot read a".into());
        assert_eq!(error.why, "cannot read a: b; or c: it is a folder");
        assert_eq!(error.next.as_deref(), Some("check the path"));
    }

    #[test]
    fn the_library_speaks_in_options() {
        let error = ShapeError::Divided { by: crate::shape::Whole::Exterior, blocks: 3 };
        let CommandError { why, next, .. } = error.into();
        assert!(why.contains("3 blocks") && !why.contains("--"), "{why}");
        assert_eq!(next.as_deref(), Some("give --blocks 1, or omit --exterior"));
    }
}
