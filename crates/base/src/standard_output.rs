//! Whether the process was given a standard output.
//!
//! Without a standard output, the first file opened would become it. So Rust opens the null device in its place before
//! `main`, and the output of a command is lost without an error. Commands call [`check`] before they print.

use std::io;

/// Checks that there was a standard output when the process began. Only on Linux can this be known.
///
/// # Errors
/// Standard output is closed.
pub fn check() -> io::Result<()> {
    if began_without() { Err(io::Error::other("standard output is closed")) } else { Ok(()) }
}

#[cfg(not(target_os = "linux"))]
fn began_without() -> bool {
    false
}

#[cfg(target_os = "linux")]
fn began_without() -> bool {
    linux::CLOSED.load(std::sync::atomic::Ordering::Relaxed)
}

#[cfg(target_os = "linux")]
mod linux {
    use std::sync::atomic::{AtomicBool, Ordering};

    pub(super) static CLOSED: AtomicBool = AtomicBool::new(false);

    #[used]
    #[expect(unsafe_code, reason = "nothing else runs before the null device is opened")]
    // SAFETY: this is the linker's list of functions to call before `main`, and the function needs nothing of Rust's runtime.
    #[unsafe(link_section = ".init_array")]
    static AT_START: extern "C" fn() = at_start;

    extern "C" fn at_start() {
        let flags = rustix::io::fcntl_getfd(rustix::stdio::stdout());
        CLOSED.store(flags.is_err(), Ordering::Relaxed);
    }
}
