//! What happens in the threads of this module when memory runs out: the interpreter lives on.

use std::alloc::{GlobalAlloc, Layout, System};
use std::thread;
use std::time::Duration;

use crate::call::Call;

/// The system's allocator, with patience.
///
/// What is large is asked for in ways that can be refused, and what the library can estimate is refused before it
/// begins. Where any other allocation fails, Rust has no way back: the process ends, and with it the interpreter. An
/// allocator may not unwind, but it may wait. So a thread that works for a call waits here until there is memory again,
/// while the call raises `MemoryError` ([`crate::work::run`]); the call's other threads stop, what they held comes free, and
/// so does what the caller gives up. Then this thread goes on to where it learns that nobody wants its work.
struct Patient;

#[global_allocator]
static MEMORY: Patient = Patient;

/// Between two attempts.
const PAUSE: Duration = Duration::from_millis(20);

// SAFETY: all is the system's allocator; what it refuses is asked for again with the same arguments, or refused.
unsafe impl GlobalAlloc for Patient {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise is passed on.
        patiently(|| unsafe { System.alloc(layout) })
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise is passed on.
        patiently(|| unsafe { System.alloc_zeroed(layout) })
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller's promise is passed on; a refusal leaves the block as it was.
        patiently(|| unsafe { System.realloc(block, layout, size) })
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(block, layout) }
    }
}

#[inline]
fn patiently(ask: impl Fn() -> *mut u8) -> *mut u8 {
    let block = ask();
    if block.is_null() { wait(&ask) } else { block }
}

/// Asks until there is memory; not for what may be refused, nor in threads of others. Allocates nothing.
#[cold]
fn wait(ask: &dyn Fn() -> *mut u8) -> *mut u8 {
    if walpha::is_asking() || !Call::starve() {
        return std::ptr::null_mut();
    }
    loop {
        thread::sleep(PAUSE);
        let block = ask();
        if !block.is_null() {
            return block;
        }
    }
}
