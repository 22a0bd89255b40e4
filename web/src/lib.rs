//! The part that `walpha.html` computes with: the library, called by the page's worker.
//!
//! The page is built for WASI, so that files are read and written by name as everywhere else; its worker keeps those
//! that the user chose in memory. Calls are JSON texts ([`Request`](request::Request)), answers are JSON and arrays, which
//! the worker copies out of this memory.

mod answer;
mod failure;
mod made;
mod request;
mod session;
mod shell;
mod shown;

use std::sync::{Mutex, PoisonError};

use answer::Answer;
use session::Session;

/// The page's one session, and what it answered last.
static SESSION: Mutex<(Session, Answer)> = Mutex::new((Session::EMPTY, Answer::EMPTY));

/// Memory for a request of `length` bytes. [`call`] takes it back.
#[unsafe(no_mangle)]
pub extern "C" fn reserve(length: usize) -> *mut u8 {
    Box::leak(vec![0; length].into_boxed_slice()).as_mut_ptr()
}

/// Carries out a request, and returns where its answer lies until the next call.
///
/// # Safety
/// `request` and `length` are what [`reserve`] returned and was given, and the bytes there have been written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn call(request: *mut u8, length: usize) -> *const u32 {
    // SAFETY: a slice of this place and length was leaked by `reserve`.
    let request = unsafe { Box::from_raw(std::ptr::slice_from_raw_parts_mut(request, length)) };
    let mut guard = SESSION.lock().unwrap_or_else(PoisonError::into_inner);
    let (session, last) = &mut *guard;
    // The last answer, which may be large, goes before the next one is made.
    *last = Answer::EMPTY;
    *last = match serde_json::from_slice(&request) {
        Ok(request) => session.answer(request),
        Err(error) => Answer::failed(&error.to_string(), None),
    };
    last.place()
}

/// Prepares the session: warnings go to standard error, one a line.
#[unsafe(no_mangle)]
pub extern "C" fn begin() {
    let log = tracing_subscriber::fmt().with_ansi(false).with_target(false).without_time();
    let log =
        log.with_level(false).with_max_level(tracing::Level::WARN).with_writer(std::io::stderr);
    // A second session finds the first one's.
    let _ = log.try_init();
}
