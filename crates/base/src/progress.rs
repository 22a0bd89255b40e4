//! Progress of long work, for programs that show it.
//!
//! Loops that may take long say now and then how much is done, as `tracing` events of the target
//! [`TARGET`] with the fields `done` and `total` (both `u64`). Without a listener this costs a few
//! nanoseconds.

use std::cell::Cell;
use std::sync::{Mutex, PoisonError};

/// The target of these events.
pub const TARGET: &str = "walpha::progress";

/// Says that `done` of `total` equal parts of the running stage, or of a piece of it that this thread
/// works [within], are done. That one part alone is done says nothing.
pub fn report(done: u64, total: u64) {
    match SHARE.get() {
        None if total > 1 => tracing::trace!(target: TARGET, done, total),
        None => {}
        Some(share) => share.report(done, total),
    }
}

/// What share of a stage a piece of work is: from one place to another on a scale of so many equal parts.
#[derive(Clone, Copy, Debug)]
pub struct Share {
    /// Where it begins.
    pub from: u64,
    /// Where it ends.
    pub to: u64,
    /// How many equal parts the scale has.
    pub of: u64,
}

thread_local! {
    /// The share that this thread works within.
    static SHARE: Cell<Option<Share>> = const { Cell::new(None) };
}

/// So many steps are reported between two places of a scale.
const STEPS: u64 = 1000;

impl Share {
    /// No part of the scale, as what the work is a part of says itself how far it is.
    pub const NONE: Self = Self { from: 0, to: 0, of: 1 };

    fn report(self, done: u64, total: u64) {
        let Self { from, to, of } = self;
        if from < to {
            let steps =
                u128::from(STEPS * (to - from)) * u128::from(done) / u128::from(total.max(1));
            let (done, total) = (STEPS * from + steps as u64, STEPS * of);
            tracing::trace!(target: TARGET, done, total);
        }
    }
}

/// Does work that is a share of a stage. Within this, a share of a share is none.
pub fn within<T>(share: Share, work: impl FnOnce() -> T) -> T {
    let outer = SHARE.get();
    SHARE.set(Some(if outer.is_some() { Share::NONE } else { share }));
    let result = work();
    SHARE.set(outer);
    result
}

/// Work that several threads do together.
#[derive(Debug)]
pub struct Piece {
    share: Share,
    /// How many units of work there are.
    total: u64,
    /// Those that are done, and the part in [`STEPS`] that was reported.
    done: Mutex<[u64; 2]>,
}

impl Piece {
    /// So many units of work, which are the share that this thread works [within].
    pub fn new(total: u64) -> Self {
        let share = SHARE.get().unwrap_or(Share { from: 0, to: 1, of: 1 });
        Self { share, total, done: Mutex::default() }
    }

    /// Counts units that are done.
    pub fn add(&self, units: u64) {
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        let [all, reported] = &mut *done;
        *all = self.total.min(*all + units);
        let step = (u128::from(STEPS) * u128::from(*all) / u128::from(self.total.max(1))) as u64;
        if step > *reported {
            *reported = step;
            self.share.report(*all, self.total);
        }
    }
}
