//! Standard output, and the warnings of a run, which JSON reports repeat.

use std::fmt::{self, Debug, Display};
use std::io::{self, ErrorKind, Write};
use std::sync::{Mutex, PoisonError};

use serde::Serialize;
use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::Layer;
use tracing_subscriber::fmt::format::Writer;
use tracing_subscriber::fmt::{FmtContext, FormatEvent, FormatFields};
use tracing_subscriber::layer::Context;
use tracing_subscriber::registry::LookupSpan;
use walpha_base::advice::Category;
use walpha_base::shown::escaped;
use walpha_base::standard_output;

use crate::cli::options::global::Global;
use crate::cli::process::errors::{CommandError, Result, command_error};
use crate::settings::Settings;

/// Prints facts in the form that the options request: as JSON, as text (with `--verbose` in its alternate form, which is longer),
/// or not at all. They go to standard error if a file goes
/// to standard output (`-o -`).
pub(crate) fn print_summary<T: Serialize + Display>(global: Global, facts: &T) -> Result<()> {
    if global.json {
        let warnings = warnings();
        let text =
            if warnings.is_empty() { json(facts) } else { json(&WithWarnings { facts, warnings }) };
        write_text(global, &text?)?;
    } else if !global.quiet {
        let text = if global.verbose { format!("{facts:#}") } else { facts.to_string() };
        write_text(global, &escaped(&text, |c| c == '\n'))?;
    }
    Ok(())
}

/// Facts together with the warnings of the run.
#[derive(Serialize)]
struct WithWarnings<'a, T> {
    #[serde(flatten)]
    facts: &'a T,
    warnings: Vec<String>,
}

/// A name escaped for use within a line of text.
pub(crate) fn name(name: &str) -> String {
    escaped(name, |_| false)
}

fn write_text(global: Global, text: &str) -> Result<()> {
    if global.piped {
        io::stderr().lock().write_all(text.as_bytes())?;
    } else {
        print(text)?;
    }
    Ok(())
}

/// The error for a standard output that is closed, full, or no longer read: the output is lost.
fn unprinted(error: &io::Error) -> CommandError {
    let next = match error.kind() {
        ErrorKind::BrokenPipe => "let the reading program read to the end, if all is needed",
        _ => "check where standard output goes, or give --quiet to print nothing",
    };
    let said = command_error!("cannot write to standard output: {error}" => "{next}");
    CommandError { category: Category::System(error.kind()), unprinted: true, ..said }
}

/// Prints text; a failure is an error, not a panic as in `println!`.
pub(crate) fn print(text: &str) -> Result<()> {
    print_with(|out| out.write_all(text.as_bytes()))
}

/// Prints the output of `write`, and flushes it.
pub(crate) fn print_with(
    write: impl FnOnce(&mut io::StdoutLock<'static>) -> io::Result<()>,
) -> Result<()> {
    write_with(write).map_err(|error| unprinted(&error))
}

/// Writes text to standard output, and flushes it.
pub(super) fn write_all(text: &str) -> io::Result<()> {
    write_with(|out| out.write_all(text.as_bytes()))
}

fn write_with(
    write: impl FnOnce(&mut io::StdoutLock<'static>) -> io::Result<()>,
) -> io::Result<()> {
    standard_output::check()?;
    let mut out = io::stdout().lock();
    write(&mut out)?;
    out.flush()
}

/// Prints a remark to standard error. A failure is ignored, where `eprintln!` would panic.
pub(crate) fn remark(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

pub(crate) fn json(value: &impl Serialize) -> io::Result<String> {
    Ok(serde_json::to_string_pretty(value)? + "\n")
}

/// Prints warnings and notes of the run as `warning: …` and `note: …`, which errors resemble.
pub(crate) struct Labelled;

impl<S, N> FormatEvent<S, N> for Labelled
where
    S: Subscriber + for<'a> LookupSpan<'a>,
    N: for<'a> FormatFields<'a> + 'static,
{
    fn format_event(
        &self,
        context: &FmtContext<'_, S, N>,
        mut out: Writer<'_>,
        event: &Event<'_>,
    ) -> fmt::Result {
        let (label, colour) = match *event.metadata().level() {
            Level::ERROR => ("error", "\x1b[1;31m"),
            Level::WARN => ("warning", "\x1b[1;33m"),
            Level::INFO => ("note", "\x1b[1m"),
            Level::DEBUG | Level::TRACE => ("debug", "\x1b[2m"),
        };
        if out.has_ansi_escapes() {
            write!(out, "{colour}{label}:\x1b[0m ")?;
        } else {
            write!(out, "{label}: ")?;
        }
        let mut text = String::new();
        context.format_fields(Writer::new(&mut text), event)?;
        writeln!(out, "{}", with_options(&text))
    }
}

/// A message whose settings, which are in backticks, are named as options.
fn with_options(text: &str) -> String {
    let named = |text: String, (name, _): &(&str, _)| {
        text.replace(&format!("`{name}`"), &format!("--{}", name.replace('_', "-")))
    };
    if text.contains('`') {
        Settings::NAMES.iter().fold(text.to_owned(), named)
    } else {
        text.to_owned()
    }
}

/// The target of notes on outputs, which reports do not repeat: they say nothing of the input or the result.
pub(crate) const OF_OUTPUTS: &str = "walpha::outputs";

/// The distinct warnings and notes so far.
static WARNINGS: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Collects warnings and notes, and passes each on once: a file that is examined before it is read would otherwise cause them twice.
pub(crate) struct WarningCollector;

impl<S: Subscriber> Layer<S> for WarningCollector {
    fn event_enabled(&self, event: &Event<'_>, _: Context<'_, S>) -> bool {
        let metadata = event.metadata();
        let is_kept = matches!(*metadata.level(), Level::WARN | Level::INFO);
        if !is_kept || metadata.target() == OF_OUTPUTS {
            return true;
        }
        let mut message = Message::default();
        event.record(&mut message);
        let mut warnings = WARNINGS.lock().unwrap_or_else(PoisonError::into_inner);
        let message = with_options(&message.0);
        let is_new = !warnings.contains(&message);
        if is_new {
            warnings.push(message);
        }
        is_new
    }
}

/// The text of an event.
#[derive(Default)]
struct Message(String);

impl Visit for Message {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        if field.name() == "message" {
            fmt::write(&mut self.0, format_args!("{value:?}"))
                .expect("writing to a string cannot fail");
        }
    }
}

/// The warnings and notes so far.
pub(crate) fn warnings() -> Vec<String> {
    WARNINGS.lock().unwrap_or_else(PoisonError::into_inner).clone()
}
