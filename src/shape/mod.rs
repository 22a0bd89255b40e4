//! Floor 3: the alpha shape of weighted points, its topology and its measures.

mod alpha;
mod alpha_shape;
mod canonical;
mod complex;
mod manifold;
mod measure;
mod slabs;
mod sphere;
mod surface;
mod topology;
mod union_find;
mod voids;

pub use alpha::{Alpha, Balls, NotAnAlpha};
pub use alpha_shape::{AlphaShape, Engine, ShapeError, ShapeOptions, alpha_shape};
pub use complex::{ByClass, Class, Complex, Simplices};
pub use manifold::ManifoldDefects;
pub use measure::Measures;
pub(crate) use measure::{facet_area, six_volumes};
pub use slabs::PlanError;
pub(crate) use sphere::{Interval, Spheres};
pub use surface::Surface;
pub use topology::{Betti, direct_betti};
pub(crate) use union_find::UnionFind;
pub(crate) use voids::Hollow;
pub use voids::Void;
