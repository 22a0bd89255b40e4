//! Floor 2: the private bridge to CGAL and its safe wrapper.
//!
//! Rules of the bridge: one call per stage; flat slices in, an opaque result that lends flat
//! slices out; input indices come back everywhere; every entry returns `Result`, and C++ catches
//! whatever is thrown there. Rust refuses what CGAL cannot stand (NaN, infinities, duplicates,
//! fewer than four points) before the call, in [`Sites`]. C++ never calls back into Rust, because
//! CGAL changes the rounding mode while it works.

#[allow(unused_qualifications, reason = "in what the macro writes")]
mod ffi;
mod lattice;
mod plane;
mod reference;
mod sites;
mod slab;

pub use lattice::Lattice;
pub use plane::{PlaneSites, RawTriangulation, farthest_plane, regular_plane};
use reference::flat;
pub use reference::{CgalError, RawComplex, reference};
pub use sites::{Sites, SitesError};
pub use slab::{HIDDEN, RawSlab, SlabQuestion, SlabSites, slab};
