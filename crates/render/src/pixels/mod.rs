//! The elements of a picture: colours, pixels, and the samples within a pixel.

mod colour;
mod grid;
mod picture;

pub use colour::{ColourMap, PALETTE, Rgb};
pub(crate) use grid::{Patch, PixelBox, SAMPLE, SAMPLES, STEPS, sample_position};
pub use picture::{Picture, Size};
