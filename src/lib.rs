//! Volume modelling of scattered data with wavelet-weighted alpha shapes, on CGAL.

pub use ndarray;

pub mod cgal;
pub mod export;
pub mod haar;
pub mod memory;
pub mod points;
pub mod render;
pub mod reproduce;
pub mod shape;
pub mod volume;

pub use haar::{Coefficients, Decomposition, HaarOptions, Tolerance, Truncation};
pub use points::{Points, PointsError, Selection, SelectionRule, Units, WeightedPoints, Weighting};
pub use shape::{Alpha, AlphaShape, Balls, Class, Complex, Simplices, alpha_shape};
pub use volume::{Dims, Frame, Gray, GrayRange, Volume, VolumeError};
