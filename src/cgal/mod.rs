//! Floor 2: the private bridge to CGAL and its safe wrapper.
//!
//! Rules of the bridge: one call per stage; flat slices in, and out either an opaque result that lends
//! flat slices or a copy into slices that Rust made; input indices come back everywhere; every entry
//! returns `Result`, and C++ catches whatever is thrown there. Rust refuses what CGAL cannot stand
//! (NaN, infinities, duplicates, fewer than four points) before the call, in
//! [`Sites`](crate::triangulation::Sites). C++ never calls back into Rust, because CGAL changes the
//! rounding mode while it works.

#[allow(unused_qualifications, reason = "in what the macro writes")]
mod ffi;
mod plane;
mod reference;
mod regular;

pub(crate) use ffi::bridge::give_back;
pub(crate) use plane::{RawTriangulation, farthest_plane, regular_plane};
pub(crate) use reference::{RawComplex, reference};
pub(crate) use regular::regular;

use crate::triangulation::TriangulationError;

/// What C++ threw in a stage.
fn thrown(stage: &'static str) -> impl Fn(cxx::Exception) -> TriangulationError {
    move |exception| match exception.what() {
        // Said by cpp/bridge.h for std::bad_alloc.
        "out of memory" => TriangulationError::Memory { stage, needed: None },
        text => TriangulationError::Thrown { stage, text: text.into() },
    }
}
