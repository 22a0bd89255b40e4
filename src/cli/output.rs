//! What goes to standard output.

use std::fmt::Display;
use std::io::{self, Write};

use serde::Serialize;

use super::Global;

/// Prints facts as the user wants them: as JSON, as text, or not at all.
pub fn tell<T: Serialize + Display>(global: Global, facts: &T) -> anyhow::Result<()> {
    if global.json {
        print_json(facts)?;
    } else if !global.quiet {
        print(&facts.to_string())?;
    }
    Ok(())
}

/// Prints text without the panic of `println!` when nobody reads on.
pub fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// Prints one JSON object.
pub fn print_json(value: &impl Serialize) -> anyhow::Result<()> {
    Ok(print(&(serde_json::to_string_pretty(value)? + "\n"))?)
}

/// Whether an error means that our reader has gone.
pub fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let broken = |cause: &(dyn std::error::Error + 'static)| {
        cause.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe)
    };
    error.chain().any(broken)
}
