//! Weighted alpha shapes of points in space, exact, in Rust alone: simplices with their classes, topology,
//! measures, parts, and the filtration of all α with its persistence.
//!
//! The weighted alpha shape at α is the part of the regular (weighted Delaunay) triangulation whose simplices
//! have an empty orthogonal sphere of squared radius α or less, with their faces (Edelsbrunner 1992; Edelsbrunner and Mücke
//! 1994, doi:10.1145/174462.156635). Every predicate is evaluated exactly on the input doubles, so degenerate input needs no special
//! treatment. α and weights are squared lengths.
//!
//! ```
//! use walpha_shape::{Alpha, ShapeOptions, alpha_shape};
//!
//! // The corners of a cube lie on a sphere of squared radius 3/4: the least α at which the shape is the whole cube.
//! let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|c| c as f64);
//! let cube: Vec<[f64; 3]> = (0..8).map(corner).collect();
//! let shape = alpha_shape(&cube, &ShapeOptions::new(Alpha::from_squared(0.75)?))?;
//! assert_eq!(shape.measures().volume, 1.0);
//! assert_eq!(shape.complex().facets.counts().regular, 12);
//! assert_eq!(shape.betti().map(|betti| betti.b0), Some(1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![warn(missing_debug_implementations, unreachable_pub)]

mod agreement;
mod along;
mod alpha_shape;
mod arrays;
mod betti;
mod bits;
mod blocks;
mod complement;
mod components;
mod copies;
mod derived;
mod error;
mod flat;
mod groups;
mod incidence;
mod isosurface;
mod keep;
pub mod ladder;
mod make;
mod manifold;
mod measure;
mod options;
mod outline;
mod points;
mod power_diagram;
mod sheets;
mod single;
mod solid;
mod sums;
mod surface;
mod topology;
mod unwrapped;
mod voids;
mod voxels;
mod winding;

pub use agreement::Disagreement;
pub use alpha_shape::AlphaShape;
pub use arrays::ArrayError;
pub use betti::{Betti, BettiError};
pub use components::NO_COMPONENT;
pub use error::{CgalError, OutlineError, PlanError, ShapeError, WallsError, Whole};
pub use isosurface::{Extent, IsosurfaceError, SampleLattice, isosurface_shape};
pub use keep::{Keep, KeepError, Kept, Largest};
pub use make::alpha_shape;
pub use manifold::ManifoldDefects;
pub use measure::Measures;
pub use options::{Balls, Classifier, Engine, ShapeOptions};
pub use outline::{Outline, Polygon};
pub use points::{LengthsError, WeightSummary, WeightedPoints};
pub use power_diagram::PeriodicPowerDiagram;
pub use sheets::Sheets;
pub use single::SinglePrecision;
pub use solid::Cuts;
pub use sums::{Component, Enclosed};
pub use surface::Surface;
pub use voids::Void;
pub use voxels::{VoxelsError, voxel_shape};
pub use walpha_base::advice::Advise;
pub use walpha_base::{Cancelled, Coordinates, LengthUnit, Monitor, Space};
pub use walpha_complex::{Alpha, AlphaError, ByClass, Class, Complex, Placed, Simplices, Voxels};
pub use walpha_regular::{Torus, TorusError};

// For walpha, which computes shapes in blocks from file to file, and for walpha-balls. Not covered by semantic versioning.
#[doc(hidden)]
pub use alpha_shape::Assembled;
#[doc(hidden)]
pub use blocks::{AT_WORK, BlockShape, Own, Side, block_shape};
#[doc(hidden)]
pub use complement::between;
#[doc(hidden)]
pub use incidence::FacetSides;
#[doc(hidden)]
pub use measure::{facet_area, six_volumes};
#[doc(hidden)]
pub use sums::{ComponentSums, SheetSums, components_of_sums};
#[doc(hidden)]
pub use topology::direct_betti;
#[doc(hidden)]
pub use voids::Hollow;
#[doc(hidden)]
pub use winding::{Directions, United, WindingSets};

/// Compiles and runs the example in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
