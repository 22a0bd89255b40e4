//! Handles a lack of memory in the threads of this module, so that the interpreter survives.

use std::alloc::{GlobalAlloc, Layout, System};
use std::ptr;
use std::sync::atomic::{AtomicPtr, AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use crate::workers::starve;

/// The system's allocator, with patience.
///
/// Large requests are made in ways that can be refused, and what the library can estimate is refused before it begins. If any
/// other allocation fails, Rust has no way back: the process ends, and the interpreter with it. An allocator may not unwind, but
/// it may wait. So the call's [`Reserve`] is given up, and a thread that works for the call waits here until there is memory
/// again, while the call raises `MemoryError` ([`crate::work::run`]). The call's other threads stop, which frees their memory, as
/// does everything that the caller gives up. Then this thread continues to the point where it learns that its work is no longer
/// needed. Only then do its threads work for another call ([`crate::workers`]).
struct Patient;

#[global_allocator]
static MEMORY: Patient = Patient;

/// Between two attempts.
const PAUSE: Duration = Duration::from_millis(20);
/// After how many pauses a thread no longer lets those that start go first: one of them may wait for it.
const PATIENCE: usize = 250;

/// The number of calls that are starting threads.
static STARTING: AtomicUsize = AtomicUsize::new(0);

/// Starts threads, and meanwhile leaves all memory to them. A thread that starts takes memory for what is its own, and where there is none,
/// the C library ends the process; so no thread that waits for memory may take what they were promised.
pub fn starting<T>(start: impl FnOnce() -> T) -> T {
    STARTING.fetch_add(1, Ordering::SeqCst);
    let started = start();
    STARTING.fetch_sub(1, Ordering::SeqCst);
    started
}

/// Memory that is kept for the end of a call that runs out of it: enough for all its threads to go on to where they
/// learn that the call has ended.
#[derive(Debug)]
pub struct Reserve(AtomicPtr<u8>);

/// Its pages are never written, so it takes address space but hardly any memory.
const RESERVE: Layout = Layout::new::<[u8; 8 << 20]>();

impl Reserve {
    /// Keeps memory; `None` if there is not enough.
    pub fn new() -> Option<Self> {
        // SAFETY: the layout is not empty.
        let block = unsafe { System.alloc(RESERVE) };
        (!block.is_null()).then_some(Self(AtomicPtr::new(block)))
    }

    /// Gives it back; the second call has no effect.
    pub fn give_up(&self) {
        let block = self.0.swap(ptr::null_mut(), Ordering::Relaxed);
        if !block.is_null() {
            // SAFETY: it came from there with this layout, and nothing else uses it.
            unsafe { System.dealloc(block, RESERVE) };
        }
    }
}

impl Drop for Reserve {
    fn drop(&mut self) {
        self.give_up();
    }
}

// SAFETY: everything is the system's allocator; what it refuses is requested again with the same arguments, or refused.
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
    if walpha::is_asking() || !starve() {
        return ptr::null_mut();
    }
    let mut pauses = 0;
    loop {
        if pauses > 0 {
            thread::sleep(PAUSE);
        }
        pauses += 1;
        if pauses < PATIENCE && STARTING.load(Ordering::SeqCst) > 0 {
            continue;
        }
        let block = ask();
        if !block.is_null() {
            return block;
        }
    }
}
