//! Passes the library's progress reports, from any thread, to the call they belong to.

use std::cell::RefCell;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::subscriber::{Interest, set_global_default};
use tracing::{Event, Metadata, Subscriber};
use walpha::progress::{Stage, TARGET};

thread_local! {
    /// The call that this thread works for.
    static CALL: RefCell<Option<Arc<Call>>> = const { RefCell::new(None) };
}

/// How far one call from Python is, and whether it is still wanted.
#[derive(Debug, Default)]
pub struct Call {
    steps: Mutex<Vec<Step>>,
    stopped: AtomicBool,
    starved: AtomicBool,
}

/// So many of so many equal parts of a stage; of a total of 0 nothing is known.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    pub stage: &'static str,
    pub done: u64,
    pub total: u64,
    /// Whether Python knows.
    told: bool,
}

/// What unwinds a thread whose work is no longer wanted.
struct Stopped;

impl Call {
    /// From now on this thread works for this call.
    pub fn enter(self: Arc<Self>) {
        CALL.set(Some(self));
    }

    /// Says that a stage begins.
    pub fn begin(&self, stage: Stage) {
        let stage = stage.name();
        self.lock().push(Step { stage, done: 0, total: 0, told: false });
    }

    /// Ends the work the next time it says how far it is.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    /// Says that memory has run out for the call that this thread works for, if there is one, and ends it. Allocates
    /// nothing.
    pub fn starve() -> bool {
        let starve = |call: &RefCell<Option<Arc<Self>>>| {
            let call = call.try_borrow().ok()?;
            let call = call.as_ref()?;
            call.starved.store(true, Ordering::Relaxed);
            call.stop();
            Some(())
        };
        CALL.try_with(starve).is_ok_and(|starved| starved.is_some())
    }

    /// Whether memory has run out.
    pub fn is_starved(&self) -> bool {
        self.starved.load(Ordering::Relaxed)
    }

    /// The reports since the last time: the last of each stage.
    pub fn take(&self) -> Vec<Step> {
        let mut steps = self.lock();
        let Some(&last) = steps.last() else { return Vec::new() };
        // The stage goes on.
        let taken = std::mem::replace(&mut *steps, vec![Step { told: true, ..last }]);
        taken.into_iter().filter(|step| !step.told).collect()
    }

    fn report(&self, done: u64, total: u64) {
        if self.stopped.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Stopped));
        }
        if let Some(last) = self.lock().last_mut() {
            // Threads may report their parts out of order.
            let further = u128::from(done) * u128::from(last.total)
                >= u128::from(last.done) * u128::from(total);
            if further {
                *last = Step { done, total, told: false, ..*last };
            }
        }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<Step>> {
        self.steps.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Listens to the library for as long as the process lives.
pub fn listen() {
    // There is one listener already if the module is loaded twice, by two interpreters: it serves both.
    let _ = set_global_default(Listener);
}

/// Hears events of the library's progress, and nothing else.
struct Listener;

impl Subscriber for Listener {
    fn register_callsite(&self, metadata: &'static Metadata<'static>) -> Interest {
        if self.enabled(metadata) { Interest::always() } else { Interest::never() }
    }

    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.target() == TARGET && metadata.is_event()
    }

    fn event(&self, event: &Event<'_>) {
        if let Some(call) = CALL.with_borrow(Option::clone) {
            let mut parts = Parts::default();
            event.record(&mut parts);
            call.report(parts.done, parts.total);
        }
    }

    // Spans are not enabled.
    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }
    fn record(&self, _: &Id, _: &Record<'_>) {}
    fn record_follows_from(&self, _: &Id, _: &Id) {}
    fn enter(&self, _: &Id) {}
    fn exit(&self, _: &Id) {}
}

/// The fields of an event.
#[derive(Default)]
struct Parts {
    done: u64,
    total: u64,
}

impl Visit for Parts {
    fn record_u64(&mut self, field: &Field, value: u64) {
        match field.name() {
            "done" => self.done = value,
            "total" => self.total = value,
            _ => {}
        }
    }

    fn record_debug(&mut self, _: &Field, _: &dyn std::fmt::Debug) {}
}
