//! How far long work is, for whoever shows it.
//!
//! Loops that may take long say now and then how much is done, as `tracing` events of the target
//! [`TARGET`] with the fields `done` and `total` (both `u64`). Where nobody listens this costs a few
//! nanoseconds. The command shows a bar with the rate and the remaining time.

/// The target of these events.
pub const TARGET: &str = "walpha::progress";

/// Says that `done` of `total` equal parts of the running stage are done. That one part alone is done
/// says nothing.
pub(crate) fn report(done: u64, total: u64) {
    if total > 1 {
        tracing::trace!(target: TARGET, done, total);
    }
}
