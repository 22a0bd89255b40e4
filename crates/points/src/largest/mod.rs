//! Finds the largest of many values, as few or as many as a budget allows, for values in memory at once ([`Cut::new`]) or piece
//! by piece ([`Search`]). Energies are summed exactly, so both give the same result.

mod cut;
mod search;

pub(crate) use cut::Dropped;
pub use cut::{Budget, Cut};
pub use search::{Counts, Search};
