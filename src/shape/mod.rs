//! Floor 3: the alpha shape of weighted points, its topology and its measures.

mod alpha;
mod complex;

pub use alpha::{Alpha, Balls, NotAnAlpha};
pub use complex::{Class, Complex, Simplices};
