//! Results as figures.

mod error;
mod ladder;

pub use error::error_figure;
pub use ladder::ladder_figure;
