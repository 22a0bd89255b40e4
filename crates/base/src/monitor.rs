//! Progress and cancellation of long work.

use std::cell::RefCell;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Deref;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use crate::advice::{Advise, Category};

/// Receives the progress of long work, and can cancel it.
///
/// Every long function of walpha reports to the monitor that [watches](Self::watch) its call, and ends with [`Cancelled`] once
/// that monitor is cancelled. Without such a monitor, nothing is reported and nothing can be cancelled. Clones and
/// [parts](Self::part) of a monitor belong to the same work: cancelling one cancels all.
///
/// ```
/// use walpha_base::{Cancelled, Monitor};
///
/// fn long_work() -> Result<u32, Cancelled> {
///     let monitor = &*Monitor::current();
///     for done in 1..=3 {
///         monitor.report(done, 3)?;
///     }
///     Ok(3)
/// }
///
/// let monitor = Monitor::new(|done, total| eprintln!("{done} of {total}"));
/// assert_eq!(monitor.watch(long_work), Ok(3));
/// monitor.clone().cancel();
/// assert_eq!(monitor.watch(long_work), Err(Cancelled));
/// assert_eq!(long_work(), Ok(3));
/// ```
#[derive(Clone, Default)]
pub struct Monitor {
    shared: Option<Arc<Shared>>,
    scale: Scale,
}

/// What the clones of a monitor share.
struct Shared {
    cancelled: AtomicBool,
    listener: Box<dyn Listener>,
}

/// Receives the progress of work, from any of its threads.
pub trait Listener: Send + Sync + 'static {
    /// Called when a stage with this name begins.
    fn stage(&self, name: &'static str) {
        let _ = name;
    }

    /// Called when `done` of `total` equal parts of the stage are done. Threads may report out of order.
    fn progress(&self, done: u64, total: u64);
}

impl<F: Fn(u64, u64) + Send + Sync + 'static> Listener for F {
    fn progress(&self, done: u64, total: u64) {
        self(done, total);
    }
}

/// The error of work that was cancelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

impl Advise for Cancelled {
    fn category(&self) -> Category {
        Category::Cancelled
    }
}

/// Implements `From` for the errors that another one wraps. Each becomes its variant, except that [`Cancelled`] stays
/// [`Cancelled`] at every depth. Every named type must have a variant `Cancelled`.
#[doc(hidden)]
#[macro_export]
macro_rules! __wraps {
    ($outer:ident: $($variant:ident($inner:ident)),+ $(,)?) => { $(
        impl From<$inner> for $outer {
            fn from(error: $inner) -> Self {
                match error {
                    $inner::Cancelled(cancelled) => Self::Cancelled(cancelled),
                    other => Self::$variant(other),
                }
            }
        }
    )+ };
}

#[doc(inline)]
pub use __wraps as wraps;

/// The scale of the reports of a monitor.
#[derive(Clone, Copy, Default)]
enum Scale {
    /// Reports count parts of the stage.
    #[default]
    Stage,
    /// Reports count parts of a section of the stage, from one step to another, of [`STEPS`].
    Part { from: u64, to: u64 },
    /// Progress is not reported.
    Unreported,
}

/// The number of steps of a stage that is reported in sections.
const STEPS: u64 = 1_000_000;

impl Monitor {
    /// Creates a monitor that passes progress to a listener: a [`Listener`], or a function of the number of equal parts of a
    /// stage that are done and the number of all parts.
    pub fn new(listener: impl Listener) -> Self {
        let shared = Shared { cancelled: AtomicBool::new(false), listener: Box::new(listener) };
        Self { shared: Some(Arc::new(shared)), scale: Scale::Stage }
    }

    /// A monitor that has no listener and is never cancelled. It costs nothing.
    pub const fn noop() -> Self {
        Self { shared: None, scale: Scale::Stage }
    }

    /// Watches the long functions that `work` calls on this thread, one after another. A function that `work` starts on another
    /// thread is watched only if that thread calls `watch` with a clone.
    pub fn watch<T>(&self, work: impl FnOnce() -> T) -> T {
        let _before = Current::replacing(self.clone());
        work()
    }

    /// Takes the monitor that watches this call. A long function begins with this. Until the returned value is dropped, the
    /// thread has no monitor, so that other work which rayon gives to it meanwhile is not counted as part of this work.
    pub fn current() -> Current {
        Current::replacing(Self::noop())
    }

    /// Ends the work with [`Cancelled`] at its next check. This has no effect on a no-op monitor.
    pub fn cancel(&self) {
        if let Some(shared) = &self.shared {
            shared.cancelled.store(true, Ordering::Relaxed);
        }
    }

    /// Checks whether the work was cancelled.
    ///
    /// # Errors
    /// The work was cancelled.
    pub fn check(&self) -> Result<(), Cancelled> {
        match &self.shared {
            Some(shared) if shared.cancelled.load(Ordering::Relaxed) => Err(Cancelled),
            _ => Ok(()),
        }
    }

    /// Reports that a stage begins.
    ///
    /// # Errors
    /// The work was cancelled.
    pub fn stage(&self, name: &'static str) -> Result<(), Cancelled> {
        if let (Some(shared), Scale::Stage) = (&self.shared, self.scale) {
            shared.listener.stage(name);
        }
        self.check()
    }

    /// Reports that `done` of `total` equal parts are done. Nothing is reported if there is only one part.
    ///
    /// # Errors
    /// The work was cancelled.
    pub fn report(&self, done: u64, total: u64) -> Result<(), Cancelled> {
        let Some(shared) = &self.shared else { return Ok(()) };
        match self.scale {
            Scale::Stage if total > 1 => shared.listener.progress(done, total),
            Scale::Part { from, to } => {
                let steps = u128::from(to - from) * u128::from(done) / u128::from(total.max(1));
                shared.listener.progress(from + steps as u64, STEPS);
            }
            Scale::Stage | Scale::Unreported => {}
        }
        self.check()
    }

    /// A monitor for a section of this monitor's work: from part `from` to part `to` of `of` equal parts.
    #[must_use]
    pub fn part(&self, from: u64, to: u64, of: u64) -> Self {
        let (low, high) = match self.scale {
            Scale::Stage => (0, STEPS),
            Scale::Part { from, to } => (from, to),
            Scale::Unreported => return self.clone(),
        };
        let at = |place: u64| {
            low + (u128::from(high - low) * u128::from(place.min(of)) / u128::from(of.max(1)))
                as u64
        };
        Self { shared: self.shared.clone(), scale: Scale::Part { from: at(from), to: at(to) } }
    }

    /// A monitor for work whose progress is not reported, but which is cancelled with this monitor's work.
    #[must_use]
    pub fn unreported(&self) -> Self {
        Self { shared: self.shared.clone(), scale: Scale::Unreported }
    }

    /// A counter for units of work that several threads do together.
    pub fn units(&self, total: u64) -> Units<'_> {
        Units { monitor: self, total, done: Mutex::default() }
    }
}

thread_local! {
    /// The monitor of the next long function that this thread calls.
    static CURRENT: RefCell<Monitor> = const { RefCell::new(Monitor::noop()) };
}

/// A monitor that was taken from its thread ([`Monitor::current`]). The thread gets it back when this is dropped.
#[derive(Debug)]
pub struct Current {
    monitor: Monitor,
    /// Keeps this on the thread that the monitor was taken from.
    of_thread: PhantomData<*const ()>,
}

impl Current {
    fn replacing(monitor: Monitor) -> Self {
        Self { monitor: CURRENT.replace(monitor), of_thread: PhantomData }
    }
}

impl Deref for Current {
    type Target = Monitor;

    fn deref(&self) -> &Monitor {
        &self.monitor
    }
}

impl Drop for Current {
    fn drop(&mut self) {
        CURRENT.replace(std::mem::take(&mut self.monitor));
    }
}

impl fmt::Debug for Monitor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let cancelled = self.check().is_err();
        f.debug_struct("Monitor").field("cancelled", &cancelled).finish_non_exhaustive()
    }
}

/// Units of work that several threads do together ([`Monitor::units`]).
#[derive(Debug)]
pub struct Units<'a> {
    monitor: &'a Monitor,
    total: u64,
    /// The number of units that are done, and the number of thousandths that have been reported.
    done: Mutex<[u64; 2]>,
}

impl Units<'_> {
    /// Counts units that are done. Progress is reported at most a thousand times.
    ///
    /// # Errors
    /// The work was cancelled.
    pub fn add(&self, units: u64) -> Result<(), Cancelled> {
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        let [all, reported] = &mut *done;
        *all = self.total.min(*all + units);
        let thousandth = (1000 * u128::from(*all) / u128::from(self.total.max(1))) as u64;
        if thousandth > *reported {
            *reported = thousandth;
            // The lock is still held, so that reports come in order.
            self.monitor.report(*all, self.total)
        } else {
            self.monitor.check()
        }
    }
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use super::*;

    /// A monitor, and the list of its reports.
    fn heard() -> (Monitor, Arc<Mutex<Vec<[u64; 2]>>>) {
        let heard = Arc::new(Mutex::new(Vec::new()));
        let list = Arc::clone(&heard);
        (Monitor::new(move |done, total| list.lock().unwrap().push([done, total])), heard)
    }

    #[test]
    fn parts_of_parts_are_on_one_scale() {
        let (monitor, heard) = heard();
        monitor.report(1, 3).unwrap();
        monitor.report(1, 1).unwrap();
        let second = monitor.part(1, 2, 2);
        second.report(0, 7).unwrap();
        second.part(1, 2, 4).report(1, 2).unwrap();
        second.unreported().part(0, 1, 2).report(1, 2).unwrap();
        second.report(7, 7).unwrap();
        assert_eq!(
            *heard.lock().unwrap(),
            [[1, 3], [500_000, STEPS], [687_500, STEPS], [STEPS; 2]]
        );
    }

    /// A long function that reports once.
    fn work(part: u64) -> Result<(), Cancelled> {
        Monitor::current().report(part, 9)
    }

    #[test]
    fn calls_are_watched_by_the_innermost_monitor() {
        let ((outer, by_outer), (inner, by_inner)) = (heard(), heard());
        outer.watch(|| {
            work(1).unwrap();
            inner.watch(|| work(2)).unwrap();
            work(3).unwrap();
            // While a long function runs, neither other work on its thread nor other threads are watched.
            let running = Monitor::current();
            work(4).unwrap();
            drop(running);
            std::thread::scope(|scope| scope.spawn(|| work(5)).join().unwrap()).unwrap();
            let panicked = catch_unwind(AssertUnwindSafe(|| inner.watch(|| panic!("inside"))));
            assert!(panicked.is_err());
            work(6).unwrap();
        });
        work(7).unwrap();
        assert_eq!(*by_outer.lock().unwrap(), [[1, 9], [3, 9], [6, 9]]);
        assert_eq!(*by_inner.lock().unwrap(), [[2, 9]]);
        inner.cancel();
        assert_eq!(outer.watch(|| inner.watch(|| work(8))), Err(Cancelled));
    }

    #[test]
    fn units_are_reported_a_thousand_times_at_most() {
        let (monitor, heard) = heard();
        let units = monitor.units(10_000);
        (0..10_000).for_each(|_| units.add(1).unwrap());
        let heard = heard.lock().unwrap();
        assert_eq!((heard.len(), heard[0], heard[999]), (1000, [10, 10_000], [10_000; 2]));
    }

    #[test]
    fn cancelling_one_part_cancels_all() {
        let (monitor, _) = heard();
        let part = monitor.part(0, 1, 2).unreported();
        part.units(3).add(1).unwrap();
        monitor.clone().cancel();
        assert_eq!(part.units(3).add(1), Err(Cancelled));
        assert_eq!((monitor.check(), monitor.stage("shape")), (Err(Cancelled), Err(Cancelled)));
        let noop = Monitor::noop();
        noop.cancel();
        assert_eq!((noop.check(), noop.report(1, 2)), (Ok(()), Ok(())));
    }
}
