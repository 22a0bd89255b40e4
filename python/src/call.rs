//! A call from Python: its progress, and whether its result is still needed.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use walpha::progress::{Listener, Monitor};

use crate::allocator::Reserve;

/// The progress of a call from Python, and whether its result is still needed.
#[derive(Debug)]
pub struct Call {
    steps: Arc<Steps>,
    monitor: Monitor,
    starved: AtomicBool,
    reserve: Reserve,
}

/// The reports that Python does not know of yet.
#[derive(Debug, Default)]
struct Steps(Mutex<Vec<Step>>);

/// The number of finished parts of a stage, and their total number; nothing is known if the total is 0.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    pub stage: &'static str,
    pub done: u64,
    pub total: u64,
    /// Whether Python knows.
    told: bool,
}

impl Call {
    /// A call that nothing was heard of. It keeps memory for its end, should it run out; `None` if there is not even that.
    pub fn new() -> Option<Self> {
        let reserve = Reserve::new()?;
        let steps = Arc::<Steps>::default();
        let monitor = Monitor::new(Heard(Arc::clone(&steps)));
        Some(Self { steps, monitor, starved: AtomicBool::new(false), reserve })
    }

    /// The monitor of the work.
    pub fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    /// Ends the work the next time it asks.
    pub fn stop(&self) {
        self.monitor.cancel();
    }

    /// Says that memory has run out, and ends the work. Allocates nothing.
    pub fn starve(&self) {
        self.starved.store(true, Ordering::Relaxed);
        self.stop();
        self.reserve.give_up();
    }

    /// Whether memory has run out.
    pub fn is_starved(&self) -> bool {
        self.starved.load(Ordering::Relaxed)
    }

    /// The reports since the last time: the last of each stage.
    pub fn take(&self) -> Vec<Step> {
        let mut steps = self.steps.lock();
        let Some(&last) = steps.last() else { return Vec::new() };
        // The stage goes on.
        let taken = std::mem::replace(&mut *steps, vec![Step { told: true, ..last }]);
        taken.into_iter().filter(|step| !step.told).collect()
    }
}

impl Steps {
    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<Step>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Keeps what the work reports.
struct Heard(Arc<Steps>);

impl Listener for Heard {
    fn stage(&self, name: &'static str) {
        self.0.lock().push(Step { stage: name, done: 0, total: 0, told: false });
    }

    fn progress(&self, done: u64, total: u64) {
        if let Some(last) = self.0.lock().last_mut() {
            // Threads may report their parts out of order.
            let further = u128::from(done) * u128::from(last.total)
                >= u128::from(last.done) * u128::from(total);
            if further {
                *last = Step { done, total, told: false, ..*last };
            }
        }
    }
}
