//! The alpha shape of weighted points, its topology and its measures.
//!
//! ```
//! use walpha::WeightedPoints;
//! use walpha::shape::{Alpha, ShapeOptions, alpha_shape};
//!
//! // The corners of a cube lie on a sphere of squared radius 3/4: at this α, and no less, it is full.
//! let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|c| c as f64);
//! let cube = WeightedPoints::unweighted((0..8).map(corner).collect());
//! let shape = alpha_shape(cube, &ShapeOptions::new(Alpha::from_squared(0.75)?))?;
//! assert_eq!(shape.measures().volume, 1.0);
//! assert_eq!(shape.complex().facets.counts().regular, 12);
//! let betti = shape.betti().expect("counted");
//! assert_eq!((betti.b0, betti.b1, betti.b2), (1, 0, 0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod alpha_shape;
mod balls;
mod blocks;
mod canonical;
mod error;
mod flat;
mod infinite;
mod make;
mod manifold;
mod measure;
mod options;
mod parts;
mod sheets;
mod solid;
mod sums;
mod surface;
mod topology;
mod union_find;
mod unwrapped;
mod voids;
mod winding;

pub use alpha_shape::AlphaShape;
pub(crate) use alpha_shape::Assembled;
pub use balls::Balls;
pub use blocks::PlanError;
pub(crate) use blocks::{AT_WORK, BlockShape, Own, Side, block_shape};
pub use error::{ShapeError, Whole};
pub use infinite::number_or_null_or_name;
pub use make::alpha_shape;
pub use manifold::ManifoldDefects;
pub use measure::Measures;
pub(crate) use measure::{facet_area, six_volumes};
pub use options::{Engine, ShapeOptions};
pub use parts::{Component, Enclosed, NO_COMPONENT};
pub use sheets::Sheets;
pub use solid::Cuts;
pub(crate) use sums::{ComponentSums, SheetSums, told};
pub use surface::Surface;
pub(crate) use topology::between;
pub use topology::{Betti, direct_betti};
pub(crate) use union_find::UnionFind;
pub(crate) use voids::Hollow;
pub use voids::Void;
pub use walpha_complex::{Alpha, AlphaError, ByClass, Class, Complex, Simplices};
pub use walpha_regular::{Torus, TorusError};
pub(crate) use winding::{Directions, United, WindingSets};
