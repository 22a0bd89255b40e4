//! Runs long work outside of the interpreter.

use std::num::NonZeroUsize;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use walpha::advice::Advise;

use crate::call::Call;
use crate::errors::told;
use crate::workers::Workers;

/// The period at which the interpreter is asked for an interrupt and progress is passed on.
const TICK: Duration = Duration::from_millis(50);
/// The time that work which ran out of memory may take to end before the call returns without it.
const GRACE: Duration = Duration::from_secs(2);

/// Options for the work of a call: the number of threads, all available ones if `None`; and a function that is called as
/// `progress(stage, done, total)`.
#[derive(FromPyObject, Default)]
pub struct Task<'py>(Option<NonZeroUsize>, Option<Bound<'py, PyAny>>);

impl Task<'_> {
    /// The task with one thread, unless another number was asked for, if it works on so few points that more threads would not
    /// shorten it.
    #[must_use]
    pub fn of(self, points: usize) -> Self {
        /// As measured with a filtration.
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
    let workers = Workers::take(*threads)?;
    let call = Call::new().map(Arc::new).ok_or_else(no_memory_to_begin)?;
    let monitor = call.monitor().clone();
    let wanted = Wanted(call);
    let (sender, mut receiver) = sync_channel(1);
    let mut starved = None;
    workers.begin(&wanted.0, move |workers| {
        let outcome = catch_unwind(AssertUnwindSafe(|| monitor.watch(work)));
        // After an interrupt there is no receiver, and the outcome is dropped before the threads are free for another call.
        let _ = sender.send((outcome, workers));
    });
    loop {
        // A receiver may be sent to where Python is not, but not lent.
        let (back, received) = py.detach(move || {
            let received = receiver.recv_timeout(TICK);
            (receiver, received.map(|(outcome, _)| outcome))
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

/// Memory has run out before the work began.
fn no_memory_to_begin() -> PyErr {
    PyMemoryError::new_err("not enough memory to begin the work; give it more")
}

/// Memory ran out where no estimate had foreseen it. What the work holds comes free when it ends, which it may have to
/// wait for memory to do.
fn no_memory() -> PyErr {
    PyMemoryError::new_err(
        "memory ran out in the middle of the work; give it more, or make the input smaller",
    )
}

/// Stops the work of a call when its result is no longer needed.
struct Wanted(Arc<Call>);

impl Drop for Wanted {
    fn drop(&mut self) {
        self.0.stop();
    }
}
