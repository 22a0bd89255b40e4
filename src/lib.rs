//! Volume modelling of scattered data with wavelet-weighted alpha shapes, on CGAL.

pub use ndarray;

pub mod cgal;
pub mod export;
pub mod points;
pub mod shape;
pub mod volume;

pub use points::WeightedPoints;
pub use shape::{Alpha, AlphaShape, Balls, Class, Complex, Simplices, alpha_shape};
pub use volume::{Dims, Frame, Gray, GrayRange, Volume, VolumeError};
