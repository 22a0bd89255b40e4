//! Standard output, and the warnings of a run, which JSON reports repeat.

use std::fmt::{self, Debug, Display};
use std::io::{self, ErrorKind, Write};
use std::sync::{Mutex, PoisonError};

use serde::Serialize;
use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::Layer;
use tracing_subscriber::layer::Context;
use walpha_base::advice::Advice;
use walpha_base::shown::escaped;
use walpha_base::standard_output;

use super::global::Global;

/// Prints facts as the user wants them: as JSON, as text, or not at all; to standard error when
/// standard output has a file (`-o -`).
pub(super) fn print_summary<T: Serialize + Display>(
    global: Global,
    facts: &T,
) -> anyhow::Result<()> {
    if global.json {
        let warnings = heard();
        let text =
            if warnings.is_empty() { json(facts) } else { json(&Warned { facts, warnings }) };
        say(global, &text?)?;
    } else if !global.quiet {
        say(global, &escaped(&facts.to_string(), |c| c == '\n'))?;
    }
    Ok(())
}

/// Facts, with the warnings of the run.
#[derive(Serialize)]
struct Warned<'a, T> {
    #[serde(flatten)]
    facts: &'a T,
    warnings: Vec<String>,
}

/// A name within a text, where it must not begin a line.
pub(super) fn name(name: &str) -> String {
    escaped(name, |_| false)
}

fn say(global: Global, text: &str) -> anyhow::Result<()> {
    if global.piped {
        io::stderr().lock().write_all(text.as_bytes())?;
    } else {
        print(text)?;
    }
    Ok(())
}

/// Standard output is closed, full, or nobody reads it any more: what was to be printed is lost.
#[derive(Debug, thiserror::Error)]
#[error("standard output does not take it: {0}")]
pub(super) struct OutputError(#[from] io::Error);

impl OutputError {
    pub(super) fn advice(&self) -> Advice {
        match self.0.kind() {
            ErrorKind::BrokenPipe => "have its reader read to the end, if all is needed".into(),
            _ => "look at where standard output goes, or give --quiet to go without".into(),
        }
    }
}

/// Prints text, without the panic of `println!` when it cannot be.
pub(super) fn print(text: &str) -> Result<(), OutputError> {
    print_with(|out| out.write_all(text.as_bytes()))
}

/// Prints what is written, to the last byte.
pub(super) fn print_with(
    write: impl FnOnce(&mut io::StdoutLock<'static>) -> io::Result<()>,
) -> Result<(), OutputError> {
    standard_output::check()?;
    let mut out = io::stdout().lock();
    write(&mut out)?;
    Ok(out.flush()?)
}

/// Says something beside the result, on standard error. Where nobody hears it, that is no error, nor a panic
/// as `eprintln!` has it.
pub(super) fn remark(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

fn json(value: &impl Serialize) -> serde_json::Result<String> {
    Ok(serde_json::to_string_pretty(value)? + "\n")
}

/// Whether an error means that our reader has gone.
pub(super) fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let broken = |cause: &(dyn std::error::Error + 'static)| {
        cause.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == ErrorKind::BrokenPipe)
    };
    error.chain().any(broken)
}

/// Warnings so far.
static HEARD: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Collects warnings, once each.
pub(super) struct Listener;

impl<S: Subscriber> Layer<S> for Listener {
    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        if *event.metadata().level() != Level::WARN {
            return;
        }
        let mut message = Message::default();
        event.record(&mut message);
        let mut heard = HEARD.lock().unwrap_or_else(PoisonError::into_inner);
        if !heard.contains(&message.0) {
            heard.push(message.0);
        }
    }
}

/// The text of an event.
#[derive(Default)]
struct Message(String);

impl Visit for Message {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        if field.name() == "message" {
            fmt::write(&mut self.0, format_args!("{value:?}")).expect("strings take all");
        }
    }
}

/// The warnings so far.
pub(super) fn heard() -> Vec<String> {
    HEARD.lock().unwrap_or_else(PoisonError::into_inner).clone()
}
