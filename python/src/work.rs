//! Runs long work outside of the interpreter.

use std::num::NonZeroUsize;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use walpha::advice::Advise;
use walpha::threads;

use crate::allocator::starting;
use crate::call::Call;
use crate::errors::told;

/// The period at which the interpreter is asked for an interrupt and progress is passed on.
const TICK: Duration = Duration::from_millis(50);
/// The time that work which ran out of memory may take to end before the call returns without it.
const GRACE: Duration = Duration::from_secs(2);
/// The size of the stack of a main thread; rayon's default is a quarter of it.
const STACK: usize = 8 << 20;

/// Options for the work of a call: the number of threads, all available ones if `None`; and a function that is called as
/// `progress(stage, done, total)`.
#[derive(FromPyObject, Default)]
pub struct Task<'py>(Option<NonZeroUsize>, Option<Bound<'py, PyAny>>);

impl Task<'_> {
    /// The task with one thread, unless another number was asked for, if it works on so few points that more threads would take
    /// longer to start than the work.
    #[must_use]
    pub fn of(self, points: usize) -> Self {
        /// They take some milliseconds.
        const FEW: usize = 2000;
        let Self(threads, progress) = self;
        Self(threads.or_else(|| (points <= FEW).then_some(NonZeroUsize::MIN)), progress)
    }
}

/// Does work in separate threads while other threads of Python run, and returns its result.
///
/// This thread waits; it asks Python for interrupts and calls the task's `progress`. After an
/// interrupt, or an exception of `progress`, it returns at once, and with `MemoryError` soon after memory ran out. The work is
/// cancelled then; it owns all that it works on, and ends when it next asks its monitor.
pub fn run<T, E>(
    py: Python<'_>,
    Task(threads, progress): &Task<'_>,
    work: impl FnOnce() -> Result<T, E> + Send + 'static,
) -> PyResult<T>
where
    T: Send + 'static,
    E: Advise + Send + 'static,
{
    let call = Arc::new(Call::new());
    let wanted = Wanted(Arc::clone(&call));
    let threads = starting(|| pool(&call, *threads))?;
    call.reserve();
    let (sender, mut receiver) = sync_channel(1);
    let mut starved = None;
    let waiting = thread::Builder::new().name("walpha".into());
    let started = waiting.spawn(move || {
        let outcome =
            catch_unwind(AssertUnwindSafe(|| threads.install(|| call.monitor().watch(work))));
        // After an interrupt there is no receiver.
        let _ = sender.send(outcome);
    });
    started.map_err(|_| no_threads())?;
    loop {
        // A receiver may be sent to where Python is not, but not lent.
        let (back, received) = py.detach(move || {
            let received = receiver.recv_timeout(TICK);
            (receiver, received)
        });
        receiver = back;
        if let Some(progress) = progress {
            for step in wanted.0.take() {
                progress.call1((step.stage, step.done, step.total))?;
            }
        }
        match received {
            Ok(Ok(Err(_)) | Err(_)) if wanted.0.is_starved() => return Err(no_memory()),
            Ok(Ok(result)) => return result.map_err(told),
            Ok(Err(panic)) => resume_unwind(panic),
            Err(RecvTimeoutError::Timeout) => {
                py.check_signals()?;
                if wanted.0.is_starved()
                    && starved.get_or_insert_with(Instant::now).elapsed() > GRACE
                {
                    return Err(no_memory());
                }
            }
            Err(RecvTimeoutError::Disconnected) => unreachable!("an outcome is always sent"),
        }
    }
}

/// Memory ran out where no estimate had foreseen it. What the work holds comes free when it ends, which it may have to
/// wait for memory to do.
fn no_memory() -> PyErr {
    PyMemoryError::new_err(
        "memory ran out in the middle of the work; give it more, or make the input smaller",
    )
}

/// Threads that work for one call: their progress reports belong to it. If the call does not state their number,
/// `RAYON_NUM_THREADS` or the number of cores does; if so many are not available, there are fewer.
fn pool(call: &Arc<Call>, asked: Option<NonZeroUsize>) -> PyResult<ThreadPool> {
    let call = Arc::clone(call);
    // The last is for the thread that waits for them.
    let available = threads::available(threads::wanted(asked.map(NonZeroUsize::get)) + 1, STACK)
        .saturating_sub(1);
    if available == 0 {
        return Err(no_threads());
    }
    let pool = ThreadPoolBuilder::new()
        .num_threads(available)
        .thread_name(|i| format!("walpha {i}"))
        .stack_size(STACK)
        .start_handler(move |_| Arc::clone(&call).enter())
        .build()
        .map_err(|_| no_threads())?;
    // A thread that finds no memory when it starts ends the process, so no work begins before all have started.
    pool.broadcast(|_| ());
    Ok(pool)
}

/// The memory that was free when threads were counted may be gone when they start.
fn no_threads() -> PyErr {
    PyMemoryError::new_err(
        "no threads to work in: memory, or the number of processes, is limited too much",
    )
}

/// Stops the work of a call when its result is no longer needed.
struct Wanted(Arc<Call>);

impl Drop for Wanted {
    fn drop(&mut self) {
        self.0.stop();
    }
}
