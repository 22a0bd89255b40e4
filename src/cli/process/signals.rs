//! Handles interrupts and aborts, so that the command leaves no unfinished files.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use walpha_files::abandon;

use crate::cli::options::global::INTERRUPTED;
use crate::cli::process::progress;

/// The time that cancelled work may take to end.
const GRACE: Duration = Duration::from_secs(1);

/// Removes unfinished files, and ends the process.
fn leave() -> ! {
    progress::clear();
    abandon(INTERRUPTED)
}

/// Prepares for Ctrl-C, for a limit on file sizes, and for a lack of memory.
///
/// The large allocations of the library return errors. If any other allocation fails, stable Rust cannot recover: it prints the
/// number of bytes and aborts, and so does C++ if it cannot throw. A custom allocator could not distinguish these from the
/// allocations that return errors, so the abort itself is caught.
pub(crate) fn prepare() {
    // If the handler cannot be set, the default one of the system remains.
    let _ = ctrlc::set_handler(|| {
        // Cancelled work ends soon, and the command with it. Work that does not check for cancellation (CGAL) is abandoned. If no
        // work is running, and on the second Ctrl-C, the process ends at once.
        static AGAIN: AtomicBool = AtomicBool::new(false);
        if progress::cancel() && !AGAIN.swap(true, Ordering::Relaxed) {
            thread::spawn(|| {
                thread::sleep(GRACE);
                leave();
            });
        } else {
            leave();
        }
    });
    #[cfg(unix)]
    unix::prepare();
}

#[cfg(unix)]
mod unix {
    use crate::export::sweep;
    use nix::libc::{_exit, c_int};
    use nix::sys::signal::{SigHandler, Signal, signal};

    const ABORTED: &str = "\
error: walpha stopped in the middle of its work
  why: the line above says what failed, memory most likely; no unfinished file was left
 next: give it more memory, or a smaller input; if that was not it, please report this with the input
";

    pub(crate) fn prepare() {
        // SAFETY: `aborted` does only what a signal handler may do.
        let _ = unsafe { signal(Signal::SIGABRT, SigHandler::Handler(aborted)) };
        // This makes writing beyond the limit (`ulimit -f`) an error like that of a full disk.
        // SAFETY: no code of ours runs on this signal.
        let _ = unsafe { signal(Signal::SIGXFSZ, SigHandler::SigIgn) };
    }

    /// This allocates nothing, waits for no lock, and does not return.
    extern "C" fn aborted(_: c_int) {
        sweep();
        // A failure cannot be reported here.
        let _ = nix::unistd::write(std::io::stderr(), ABORTED.as_bytes());
        // SAFETY: this ends the process without running anything else in it, as a handler may.
        unsafe { _exit(1) }
    }
}
