//! The light in a scene: lamps, and how much of them and of the sky reaches each position.

mod depth_map;
mod directions;
mod exposure;
mod studio;

pub(crate) use exposure::{Exposure, Side};
pub(crate) use studio::Studio;
