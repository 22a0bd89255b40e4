//! The function F on a shape, its error with respect to the volume, and the selection of points that reduces this error.
//!
//! F is linear on each simplex of the shape: on interior cells, and on the facets, edges and vertices that are not faces of
//! another simplex, at positions exactly on them. The simplex that contains a position is determined exactly, so F is defined
//! everywhere on the shape and nowhere else, and each sample of a grid belongs to one simplex, whatever the number of threads.
//!
//! `barycentric.rs` computes coordinates in plain doubles if a lattice makes these exact, and otherwise behind an error bound,
//! with big integers to fall back on. `raster.rs` fills grids in parallel over the simplices: each sample keeps the least number
//! written to it. `adaptive.rs` chooses points by the error that they leave, over `sampled.rs`, which keeps F at all samples
//! while points are added and removed; `exchange.rs` computes the gain of adding a point and the loss of removing one, and
//! exchanges the points of least loss for the samples of greatest gain. `refit.rs` fits values by least squares.
//!
//! ```
//! use walpha_model::interpolate::{Deviation, Grid, Interpolant, fill};
//! use walpha_points::{Selection, Units, Weighting, difference, select, weigh};
//! use walpha_shape::{Alpha, ShapeOptions, alpha_shape};
//! use walpha_volume as volume;
//!
//! let volume = volume::sample("sample:phantom@24")?;
//! let points = select(&volume, &volume, &difference(&volume), &Selection::default(), Units::Voxel)?;
//! let weighted = weigh(points, Weighting::Common(0.0), Alpha::from_squared(10.0)?)?;
//! let shape = alpha_shape(weighted, &ShapeOptions::new(Alpha::from_squared(10.0)?))?;
//!
//! let interpolant = Interpolant::new(&shape)?;
//! let points = shape.points();
//! // At a point F is the point's value, bit for bit; outside the shape it has none.
//! let value = interpolant.value_at(points.positions()[0]);
//! assert_eq!(value, points.values().map(|values| values[0]));
//! assert_eq!(interpolant.value_at([-5.0, 0.0, 0.0]), None);
//!
//! let grid = Grid::of(&volume, Units::Voxel);
//! let inside = Deviation::of(&volume, &interpolant.resample(&grid)?);
//! let whole = fill(&shape, Some(&volume), Units::Voxel)?;
//! let filled = Deviation::of(&volume, &Interpolant::new(&whole)?.resample(&grid)?);
//! assert!(inside.covered_share() < 1.0 && filled.covered_share() == 1.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod adaptive;
mod barycentric;
#[cfg(feature = "render")]
mod chart;
mod curve;
mod error;
mod exchange;
mod fill;
mod grid;
mod interpolant;
mod least_squares;
mod raster;
mod refit;
mod resample;
mod sampled;

pub use adaptive::{Adaptive, adaptive_voxels};
#[cfg(feature = "render")]
pub use chart::error_figure;
pub use curve::{CurveOptions, CurvePoint, Method, error_curve, write_curve_csv};
pub use error::InterpolateError;
pub use exchange::exchange;
pub use fill::fill;
pub use grid::Grid;
pub use interpolant::{Interpolant, Location};
pub use refit::{Fit, Refit, Refitted, refit};
pub use resample::Deviation;
pub use resample::Resampled;
