//! Errors of the command, and the printing of all errors: what failed, why, and what to do next.

use std::error::Error;
use std::io::{self, IsTerminal};

use clap::error::ErrorKind;
use walpha_base::advice::{Advise, Category, Setting, told};
use walpha_base::shown::escaped;

use crate::cli::options::global::{DIFFERENT, FAILURE, UNREAD, USAGE};
use crate::cli::process::output::remark;
use crate::cli::process::progress;

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
        let (why, next) = told(&error, option);
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

/// An error, printed as three lines on standard error.
struct ErrorMessage {
    what: String,
    why: String,
    next: String,
}

/// Prints why a command failed. The stage that failed is the last one announced.
pub(crate) fn print_error(command: &str, error: &CommandError) {
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
    ErrorMessage { what: format!("{command} {what}"), why, next }.print();
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

/// Prints what is wrong with a command line; `configured` means that some of it comes from a file.
pub(crate) fn print_usage_error(command: &str, error: &clap::Error, configured: bool) {
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
    // The form is "invalid value 'x' for '--option <X>': message of its parser".
    if rest.is_empty()
        && let Some((head, tail)) = what.split_once("': ")
    {
        (what, rest) = (format!("{head}'"), tail.to_owned());
    }
    if what.ends_with(':') {
        what = format!("{what} {rest}");
        rest = String::new();
    }
    // Parsers of values return errors of the command, which clap wraps in a trait object.
    let next = || error.source()?.downcast_ref::<CommandError>()?.next.clone();
    let (why, next) = match rest.strip_prefix("[possible values: ") {
        Some(values) => (format!("it is one of {}", values.trim_end_matches(']')), None),
        None => (rest, next()),
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
        // These contain names of files and arguments, which may contain control characters.
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
