//! Whether the process was given a standard output.
//!
//! A file opened first could become standard output where there is none. So Rust puts the null device there before
//! `main`, and what a command prints is lost without an error. Commands ask here before they print.

use std::io;

/// An error if there was no standard output when the process began. Only Linux says so.
///
/// # Errors
/// That it is closed.
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
    #[expect(unsafe_code, reason = "nothing else runs before the null device is put there")]
    // SAFETY: the linker's list of functions to call before `main`; this one needs nothing of Rust's runtime.
    #[unsafe(link_section = ".init_array")]
    static LOOK: extern "C" fn() = look;

    extern "C" fn look() {
        let flags = rustix::io::fcntl_getfd(rustix::stdio::stdout());
        CLOSED.store(flags.is_err(), Ordering::Relaxed);
    }
}
