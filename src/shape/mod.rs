//! Floor 3: the alpha shape of weighted points, its topology and its measures.

mod alpha;
mod alpha_shape;
mod canonical;
mod complex;
mod manifold;
mod measure;
mod parts;
mod slabs;
mod surface;
mod topology;
mod union_find;
mod voids;

pub use alpha::{Alpha, Balls, NotAnAlpha};
pub use alpha_shape::{AlphaShape, Engine, ShapeError, ShapeOptions, alpha_shape};
pub use complex::{Class, Complex, Simplices};
pub use manifold::ManifoldDefects;
pub use measure::Measures;
pub(crate) use measure::{facet_area, six_volumes};
pub use parts::{Component, Enclosed, NO_COMPONENT, Sheets};
pub use slabs::PlanError;
pub use surface::Surface;
pub use topology::{Betti, direct_betti};
pub(crate) use union_find::UnionFind;
pub use voids::Void;
