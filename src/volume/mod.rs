//! Floor 0: a grid of samples, where it comes from, and how its values become gray levels.

mod error;
mod gray;
mod grid;
mod volume;

pub use error::VolumeError;
pub use gray::{Gray, GrayRange};
pub use grid::{Dims, Frame};
pub use volume::Volume;
