//! The process: its threads and ranks, signals, progress, output, and errors.

pub(super) mod errors;
#[cfg(feature = "mpi")]
mod mpi;
pub(super) mod output;
pub(super) mod progress;
pub(super) mod ranks;
pub(super) mod signals;
#[cfg_attr(not(feature = "render"), path = "no_terminal.rs")]
pub(super) mod terminal;
pub(super) mod threads;
pub(super) mod usage;
