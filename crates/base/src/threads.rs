//! The number of threads, and whether the system starts them.

use std::sync::mpsc;
use std::thread;

use crate::memory::{afford, share_heaps};

/// The most threads for each processor; more would only wait for each other.
pub const MOST_EACH: usize = 4;

/// The most threads that are started.
pub fn most() -> usize {
    MOST_EACH * processors()
}

/// The number of processors available to this process.
pub fn processors() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// How many threads to start: as many as asked for, or as `RAYON_NUM_THREADS` says, or one for each
/// processor; no more than [`most`].
pub fn wanted(asked: Option<usize>) -> usize {
    let stated = || std::env::var("RAYON_NUM_THREADS").ok()?.parse().ok();
    // As in rayon, 0 means no preference.
    let stated = asked.or_else(stated).filter(|&count| count > 0);
    stated.unwrap_or_else(processors).min(most())
}

/// How many of `wanted` threads, with stacks of `stack` bytes, the system starts at once: fewer where processes or
/// memory are limited. They end before this returns.
///
/// rayon fails, or waits forever, if one of its threads does not start. And a thread that has started takes memory for what is its own: where
/// there is none, the C library ends the process. So that room is looked for before each start.
pub fn available(wanted: usize, stack: usize) -> usize {
    share_heaps();
    let (ready, started) = mpsc::channel();
    thread::scope(|scope| {
        let mut gates = Vec::new();
        for _ in 0..wanted {
            let (gate, wait) = mpsc::channel::<()>();
            let ready = ready.clone();
            let work = move || {
                // The caller waits until the last thread has started, and then drops the gates.
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

/// Much more than what a thread has of its own beside its stack. So large a block comes from the system each time, as a thread's do, where the GNU C
/// library would take one of up to 32 MiB from what it keeps (`M_MMAP_THRESHOLD` in mallopt(3)).
const ROOM: usize = 33 << 20;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_are_counted_and_bounded() {
        assert_eq!(available(3, 1 << 16), 3);
        // No system has the address space for the stack.
        assert_eq!(available(2, 1 << 60), 0);
        assert_eq!(wanted(Some(3)), 3.min(most()));
        assert_eq!(wanted(Some(100_000)), most());
    }
}
