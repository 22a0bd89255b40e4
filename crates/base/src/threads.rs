//! How many threads work, and that they can be had.

use std::sync::mpsc;
use std::thread;

/// More threads than this for a processor only wait for each other.
pub const MOST_EACH: usize = 4;

/// The most threads that are started.
pub fn most() -> usize {
    MOST_EACH * processors()
}

/// The processors of this process.
pub fn processors() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// How many threads to start: as many as asked for, or as `RAYON_NUM_THREADS` says, or one for each
/// processor; no more than [`most`].
pub fn wanted(asked: Option<usize>) -> usize {
    let stated = || std::env::var("RAYON_NUM_THREADS").ok()?.parse().ok();
    // As rayon has it, 0 is as good as nothing.
    let stated = asked.or_else(stated).filter(|&count| count > 0);
    stated.unwrap_or_else(processors).min(most())
}

/// How many of so many threads, with stacks of so many bytes, the system starts at once: where processes or
/// memory are limited, fewer. They end before this returns.
///
/// rayon gives up, or waits for ever, where one of its threads does not come to life.
pub fn available(wanted: usize, stack: usize) -> usize {
    let (ready, started) = mpsc::channel();
    thread::scope(|scope| {
        let mut gates = Vec::new();
        for _ in 0..wanted {
            let (gate, wait) = mpsc::channel::<()>();
            let ready = ready.clone();
            let work = move || {
                // Somebody waits until the last has begun, and then drops the gate.
                let _ = ready.send(());
                let _ = wait.recv();
            };
            if thread::Builder::new().stack_size(stack).spawn_scoped(scope, work).is_err() {
                break;
            }
            gates.push(gate);
        }
        drop(ready);
        gates.iter().take_while(|_| started.recv().is_ok()).count()
    })
}

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
