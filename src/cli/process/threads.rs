//! The thread pool of a command.

use crate::threads;

use crate::cli::options::global::STACK;
use crate::cli::process::errors::{Result, command_error};

/// Starts the requested number of threads, or the default number; fewer if the system does not allow so many.
pub(crate) fn start(asked: Option<u16>) -> Result<()> {
    let asked = asked.map(usize::from);
    let (wanted, most) = (threads::wanted(asked), threads::most());
    if let Some(count) = asked.filter(|&count| count > most) {
        let processors = threads::processors();
        tracing::warn!(
            "--threads {count} is more than {processors} processors can use: {most} start"
        );
    }
    let count = threads::available(wanted, STACK);
    if count < wanted {
        tracing::warn!(
            "memory or the number of processes is limited: only {} of {wanted} threads start",
            count.max(1)
        );
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count.max(1));
    // If no thread can be started, this one does the work.
    let pool = if count == 0 { pool.use_current_thread() } else { pool };
    pool.build_global().map_err(
        |error| command_error!("threads cannot be started: {error}" => "give fewer with --threads"),
    )
}
