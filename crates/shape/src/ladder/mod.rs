//! Many α from one triangulation, and levels of detail.
//!
//! With frozen weights the alpha shapes of a set of points are nested: one regular triangulation
//! and, for each simplex, the α at which it enters, determine them all.
//!
//! ```
//! use walpha_shape::ladder::Filtration;
//! use walpha_shape::Alpha;
//!
//! // The 26 outer points of a 3×3×3 lattice: a hollow cube.
//! let at = |i: i32| [i % 3, i / 3 % 3, i / 9].map(f64::from);
//! let points: Vec<[f64; 3]> = (0..27).filter(|&i| i != 13).map(at).collect();
//! let filtration = Filtration::new(&points)?;
//!
//! let alphas = [0.25, 0.75, 1.0].map(|alpha| Alpha::from_squared(alpha).unwrap());
//! let ladder = filtration.ladder(&alphas, 8.0);
//! let voids: Vec<_> = ladder.levels.iter().map(|level| level.betti.b2).collect();
//! assert_eq!(voids, [0, 1, 0]);
//! // The hole in the middle, an octahedron, is filled at α = 1.
//! let hole = ladder.levels[1].voids[0];
//! assert_eq!((hole.cells, hole.filling_alpha.squared()), (4, 1.0));
//! assert_eq!(ladder.levels[2].coverage, 1.0);
//! # Ok::<(), walpha_shape::ShapeError>(())
//! ```

mod build;
mod critical;
mod drawn;
mod filtration;
mod levels;
mod ordered;
#[cfg(test)]
mod slabs;
mod small;
mod table;
mod topology;
mod values;
mod whole;

pub use critical::{Curve, Suggestions};
#[doc(hidden)]
pub use drawn::{Drawn, frame_of};
pub use filtration::Filtration;
#[doc(hidden)]
pub use levels::{ByLevel, LevelRows};
pub use levels::{Levels, Span};
pub use ordered::{
    Cycles, Derivative, Entry, Interval, LoopCycle, Loops, Ordered, Pairs, PorePart, PoreSphere,
    Pores, VoidCycle,
};
#[doc(hidden)]
pub use small::Covering;
#[cfg(test)]
pub(crate) use small::tests::random_points;
pub use table::{Ladder, Level};
