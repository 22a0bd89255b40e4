//! Volume modelling of scattered data with wavelet-weighted alpha shapes, on CGAL.
//!
//! A volume is Haar-transformed, small coefficients are dropped under an L² error, the samples of
//! largest gray difference are kept as points, each gets a weight from that difference, and the
//! weighted alpha shape of these points is computed exactly: tetrahedra, facets, edges, vertices.
//! After "Volume Modeling of Scattered Data based on Weighted Alpha Shapes", which uses CGAL, too.
//!
//! Each stage is a function from one type to the next:
//!
//! ```
//! use walpha::points::{difference, select, weigh};
//! use walpha::shape::ShapeOptions;
//! use walpha::{Alpha, Gray, HaarOptions, Selection, Units, Weighting, alpha_shape, haar, volume};
//!
//! let (volume, _) = volume::sample("sample:phantom@32")?.into_gray(Gray::Automatic)?;
//! let (smoothed, truncation) = haar::smooth(&volume, &HaarOptions::default())?;
//! assert!(truncation.rms <= 1.0);
//!
//! let differences = difference(&smoothed);
//! let points = select(&volume, &smoothed, &differences, &Selection::default(), Units::Voxel)?;
//! let alpha = Alpha::from_squared(10.0)?;
//! let weighted = weigh(&points, Weighting::MinMax, alpha.squared())?;
//!
//! let shape = alpha_shape(weighted, &ShapeOptions::new(alpha))?;
//! let counts = shape.complex().facets.counts();
//! assert!(counts[walpha::Class::Regular as usize] > 0);
//! assert_eq!(shape.betti().map(|betti| betti.b0), Some(1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! α and ω are squared lengths. Points are (x, y, z); volumes are stored `[z, y, x]`. Results are
//! the same on any number of threads.

pub use ndarray;

pub mod advice;
#[cfg_attr(not(feature = "cgal"), path = "cgal/absent.rs")]
mod cgal;
pub mod check;
pub mod export;
pub mod haar;
pub mod interpolate;
pub mod ladder;
pub mod memory;
pub mod near;
mod number;
pub mod plane;
pub mod points;
pub mod progress;
pub mod render;
pub mod reproduce;
pub mod shape;
pub mod shown;
pub mod triangulation;
pub mod volume;

pub use haar::{Coefficients, Decomposition, HaarOptions, Tolerance, Truncation};
pub use interpolate::Interpolant;
pub use points::{Points, PointsError, Selection, SelectionRule, Units, WeightedPoints, Weighting};
pub use shape::{Alpha, AlphaShape, Balls, Class, Complex, Simplices, alpha_shape};
pub use volume::{
    Coordinates, Dims, Frame, Gray, GrayRange, LengthUnit, Space, Volume, VolumeError,
};
