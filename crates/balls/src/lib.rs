//! Unions of balls in space, with a bound on the error of every number: volume, area and curvatures, the part of each
//! ball, contacts, components, voids and pockets, derivatives by centres and radii, and curves over α. Its boundary as a mesh of triangles.
//!
//! A point with weight ω is a ball of squared radius α + ω. The α-complex of the points is the dual complex of the union of these balls, and it
//! is exact. What is measured is a sum over its simplices, in arithmetic that keeps a bound on its error. `docs/balls.md` in the repository has the
//! formulas, and proves the bounds.
//!
//! ```
//! use walpha_balls::BallUnion;
//! use walpha_shape::{Alpha, ShapeOptions, WeightedPoints, alpha_shape};
//!
//! // The corners of a cube, as balls that leave a void in its middle.
//! let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|c| c as f64);
//! let points = WeightedPoints::new((0..8).map(corner).collect(), vec![0.7; 8])?;
//! let shape = alpha_shape(points, &ShapeOptions::new(Alpha::ZERO).exterior(true))?;
//! let union = BallUnion::new(&shape)?;
//! assert!(union.volume().is_within(1e-12) && union.area().is_within(1e-12));
//!
//! let [void] = &union.voids()?[..] else { panic!("one void") };
//! assert_eq!((void.lining.len(), void.cells), (8, 6));
//! assert!(void.volume.value < 0.01 && void.area.value < union.area().value);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![warn(missing_debug_implementations, unreachable_pub)]

mod cavities;
mod components;
mod curve;
mod discs;
mod error;
mod gradient;
mod points;
mod pores;
mod quick;
mod real;
mod scatter;
mod simplex;
mod surface;
mod union;

pub use cavities::{Cavity, Pocket};
pub use components::BallComponent;
pub use curve::{UnionLevel, union_curve};
pub use discs::DiscUnion;
pub use error::BallsError;
pub use gradient::{Gradient, Gradients};
pub use points::with_probe;
pub use pores::{BallPores, FreeSphere, PeriodicBalls, ProbedPores};
pub use real::Bounded;
pub use surface::BallSurface;
pub use union::{BallUnion, Contacts, Measured};

/// Compiles and runs the example in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
