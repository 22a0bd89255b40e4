//! Results as figures.

mod error;
mod ladder;
mod rate;

pub use error::error_figure;
pub use ladder::ladder_figure;
pub use rate::{RateCurve, rate_figure};
