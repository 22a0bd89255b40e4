//! The largest of many values, as few or as many as a budget allows; of values in memory at once
//! ([`Cut::new`]), or piece by piece ([`Search`]). Energies are summed exactly, so both find the same.

mod cut;
mod search;

pub(crate) use cut::Dropped;
pub use cut::{Budget, Cut};
pub use search::{Counts, Search};
