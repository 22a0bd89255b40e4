//! What goes to standard output.

use std::fmt::Display;
use std::io::{self, Write};

use serde::Serialize;

use crate::shown::escaped;

use super::Global;

/// Prints facts as the user wants them: as JSON, as text, or not at all; to standard error when
/// standard output has a file (`-o -`).
pub(super) fn tell<T: Serialize + Display>(global: Global, facts: &T) -> anyhow::Result<()> {
    if global.json {
        say(global, &json(facts)?)?;
    } else if !global.quiet {
        say(global, &escaped(&facts.to_string(), |c| c == '\n'))?;
    }
    Ok(())
}

/// A name within a text, where it must not begin a line.
pub(super) fn name(name: &str) -> String {
    escaped(name, |_| false)
}

fn say(global: Global, text: &str) -> io::Result<()> {
    if global.piped { io::stderr().lock().write_all(text.as_bytes()) } else { print(text) }
}

/// Prints text without the panic of `println!` when nobody reads on.
pub(super) fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}

fn json(value: &impl Serialize) -> serde_json::Result<String> {
    Ok(serde_json::to_string_pretty(value)? + "\n")
}

/// Whether an error means that our reader has gone.
pub(super) fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let broken = |cause: &(dyn std::error::Error + 'static)| {
        cause.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe)
    };
    error.chain().any(broken)
}
