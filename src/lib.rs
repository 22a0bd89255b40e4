//! Volume modelling of scattered data with wavelet-weighted alpha shapes, on CGAL.

pub use ndarray;

pub mod cgal;
pub mod check;
pub mod shape;
pub mod volume;

pub use shape::{Alpha, Balls, Class, Complex, Simplices};
pub use volume::{Dims, Frame, Gray, GrayRange, Volume, VolumeError};
