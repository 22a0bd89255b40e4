//! Results as figures.

mod ladder;
mod rate;

pub use ladder::ladder_figure;
pub use rate::{RateCurve, rate_figure};
