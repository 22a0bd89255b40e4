//! The number of threads, and whether the system can start them.

use std::sync::mpsc;
use std::thread;

use crate::memory::{afford, share_heaps};

/// The largest number of threads for each processor; more would only wait for each other.
pub const MOST_EACH: usize = 4;

/// The largest number of threads that are started.
pub fn most() -> usize {
    MOST_EACH * processors()
}

/// The number of processors available to this process.
pub fn processors() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// The number of threads to start: the number asked for, or else that in `RAYON_NUM_THREADS`, or else one for each processor; but
/// no more than [`most`].
pub fn wanted(asked: Option<usize>) -> usize {
    let stated = || std::env::var("RAYON_NUM_THREADS").ok()?.parse().ok();
    // As in rayon, 0 means no preference.
    match asked.or_else(stated).filter(|&count| count > 0) {
        // Never too many. The system takes a tenth of a millisecond to count the processors.
        Some(count) if count <= MOST_EACH => count,
        stated => {
            let processors = processors();
            stated.unwrap_or(processors).min(MOST_EACH * processors)
        }
    }
}

/// How many of `wanted` threads, with stacks of `stack` bytes, the system can start at once: fewer where processes or memory are
/// limited. The threads have ended when this returns.
///
/// If one of its threads does not start, rayon fails or waits forever. A thread that has started allocates its own data; if there
/// is no memory for it, the C library ends the process. So each start is preceded by a check for that memory.
pub fn available(wanted: usize, stack: usize) -> usize {
    share_heaps();
    let (ready, started) = mpsc::channel();
    thread::scope(|scope| {
        let mut gates = Vec::new();
        for _ in 0..wanted {
            let (gate, wait) = mpsc::channel::<()>();
            let ready = ready.clone();
            let work = move || {
                // The caller drops the gates after the last thread has started.
                let _ = ready.send(());
                let _ = wait.recv();
            };
            let room = afford(stack.saturating_add(ROOM), || "a thread".into());
            let thread = thread::Builder::new().stack_size(stack);
            if room.is_err() || thread.spawn_scoped(scope, work).is_err() || started.recv().is_err()
            {
                break;
            }
            gates.push(gate);
        }
        gates.len()
    })
}

/// Much more than a thread's own data besides its stack. So large a block comes from the system each time, as a thread's blocks
/// do; the GNU C library would take one of up to 32 MiB from its own reserve (`M_MMAP_THRESHOLD` in mallopt(3)).
const ROOM: usize = 33 << 20;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_are_counted_and_bounded() {
        assert_eq!(available(3, 1 << 16), 3);
        // No system has the address space for such stacks.
        assert_eq!(available(2, 1 << 60), 0);
        assert_eq!(wanted(Some(3)), 3.min(most()));
        assert_eq!(wanted(Some(100_000)), most());
    }
}
