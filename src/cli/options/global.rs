//! Options and exit codes common to all commands.

use clap::Args;

use crate::cli::process::errors::{Result, fail};

/// Options of every command.
#[derive(Args, Clone, Copy, Default)]
#[command(next_help_heading = EVERY_COMMAND)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub(crate) struct Global {
    /// Print one JSON object instead of text.
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Print nothing but errors (and JSON, if asked for).
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
    /// Print all numbers of a report, and log to standard error what is being done.
    #[arg(short, long, global = true, conflicts_with = "quiet")]
    pub(crate) verbose: bool,
    /// Number of threads, at most four per processor; results do not depend on it [default: one per
    /// processor, or one for each process that mpirun starts].
    #[arg(long, global = true, value_name = "N", value_parser = threads)]
    pub(crate) threads: Option<u16>,
    /// Let outputs replace inputs, or what is in the working folder of a plan.
    #[arg(long, global = true)]
    pub(crate) in_place: bool,
    /// Whether a file goes to standard output.
    #[arg(skip)]
    pub(crate) piped: bool,
}

/// The heading of the options that all commands share.
pub(crate) const EVERY_COMMAND: &str = "Every command";
/// The exit code of success.
pub(crate) const SUCCESS: u8 = 0;
/// The exit code of a failure.
pub(crate) const FAILURE: u8 = 1;
/// The exit code of wrong arguments.
pub(crate) const USAGE: u8 = 2;
/// The exit code of a panic, as in Rust.
pub(crate) const PANICKED: u8 = 101;
/// The exit code after a broken pipe, as in shells after SIGPIPE.
pub(crate) const UNREAD: u8 = 141;
/// The exit code of a check or comparison that found differences.
pub(crate) const DIFFERENT: u8 = 3;
/// The exit code of a check that found nothing wrong but could not judge everything.
pub(crate) const UNDECIDED: u8 = 4;
/// The stack size of a thread in bytes, as in rayon.
pub(crate) const STACK: usize = 2 << 20;
/// The exit code after Ctrl-C, as in shells.
pub(crate) const INTERRUPTED: i32 = 130;

/// Parses a number of threads.
fn threads(text: &str) -> Result<u16> {
    match text.parse() {
        Ok(0) | Err(_) => {
            fail!("{text:?} is not a number of threads" => "give a number from 1 to {}", u16::MAX)
        }
        Ok(count) => Ok(count),
    }
}
