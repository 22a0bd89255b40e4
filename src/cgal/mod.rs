//! CGAL's triangulations and alpha shapes of points in space: plain slices in, plain arrays out. They serve to check other
//! programs, including this one.
//!
//! | function | CGAL's class | feature |
//! |---|---|---|
//! | [`fixed_alpha_shape`] | `Fixed_alpha_shape_3` | `cgal` |
//! | [`regular_triangulation_2`], [`farthest_point_triangulation_2`] | `Regular_triangulation_2` | `paper` or `cgal-oracles` |
//! | [`regular_triangulation_3`] | `Regular_triangulation_3` | `cgal-oracles` |
//! | [`AlphaShape3`] | `Alpha_shape_3<Dt, Tag_true>`, `GENERAL` or `REGULARIZED` | `cgal-oracles` |
//! | [`periodic_regular_triangulation_3`] | `Periodic_3_regular_triangulation_3` | `cgal-oracles` |
//!
//! All use `Exact_predicates_inexact_constructions_kernel`, with CGAL 5.3 or later. CGAL's code is under the GPL, and so is
//! everything that links it.
//!
//! Points are (x, y, z), and results name them by index. Weights and α are **squared lengths**; without weights all are 0, and
//! regular triangulations are Delaunay triangulations. Every combinatorial result is exact.
//!
//! Input that CGAL cannot process is refused before the call: numbers that are not finite or too large
//! ([`MAX_COORDINATE`](walpha_regular::MAX_COORDINATE), [`MAX_WEIGHT`](walpha_regular::MAX_WEIGHT)) and too few points are an
//! [`Error`]. Of several points at one position only the heaviest is used, or the first of equally heavy ones. Exceptions of CGAL
//! are errors, too. CGAL runs on the calling thread, and cannot be interrupted.
//!
//! ```
//! use walpha::{Alpha, Class, cgal};
//!
//! // A cube and its centre, which is so light that the corners hide it.
//! let corner = |i: u32| [i & 1, i >> 1 & 1, i >> 2].map(f64::from);
//! let points: Vec<[f64; 3]> = (0..8).map(corner).chain([[0.5; 3]]).collect();
//! let weights = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0];
//!
//! let shape = cgal::fixed_alpha_shape(&points, Some(&weights), Alpha::from_squared(0.75)?)?;
//! assert_eq!(shape.cells.counts()[Class::Interior], 6);
//! assert_eq!(shape.facets.counts()[Class::Regular], 12);
//! assert_eq!(shape.vertices.len(), 8);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// Rules of the bridge: there is one call per stage. Flat slices go in; out comes either an opaque result that lends flat slices,
// or a copy into slices that Rust allocated. All results contain input indices. Every function that computes returns `Result`,
// and C++ catches all exceptions there. Rust refuses input that CGAL cannot process (NaN, infinities, duplicates, fewer than four
// points) before the call, in `Sites`. C++ never calls back into Rust, because CGAL changes the rounding mode while it works.

#[cfg(feature = "cgal-oracles")]
#[expect(unreachable_pub, reason = "cxx writes `pub`")]
mod alpha;
mod error;
#[allow(unused_qualifications, reason = "in what the macro writes")]
#[expect(unreachable_pub, reason = "cxx writes `pub`")]
mod ffi;
#[cfg(feature = "cgal-oracles")]
#[expect(unreachable_pub, reason = "cxx writes `pub`")]
mod periodic;
#[cfg(any(feature = "paper", feature = "cgal-oracles"))]
#[expect(unreachable_pub, reason = "cxx writes `pub`")]
mod plane;
#[cfg(feature = "cgal-oracles")]
#[expect(unreachable_pub, reason = "cxx writes `pub`")]
mod regular;
mod shape;

use std::borrow::Cow;

#[cfg(feature = "cgal-oracles")]
pub use alpha::{AlphaShape3, Critical, Intervals, Mode, Span};
pub use error::Error;
#[cfg(feature = "cgal-oracles")]
pub use periodic::periodic_regular_triangulation_3;
#[cfg(any(feature = "paper", feature = "cgal-oracles"))]
pub use plane::{PlaneTriangulation, farthest_point_triangulation_2, regular_triangulation_2};
#[cfg(feature = "cgal-oracles")]
pub use regular::{INFINITE_CELL, RegularTriangulation, regular_triangulation_3};
pub use shape::fixed_alpha_shape;

#[cfg(feature = "paper")]
pub(crate) use plane::{RawTriangulation, farthest_plane, regular_plane};
pub(crate) use shape::complex;

use walpha_regular::SitesError;
use walpha_regular::internals::Sites;
use walpha_shape::CgalError;

/// Allocates the thread-local data of C++ for the calling thread. Otherwise it is allocated on first use, and if memory is exhausted then, the
/// C library ends the process. For programs that must survive that.
pub fn prepare_thread() {
    ffi::bridge::prepare_thread();
}

/// Converts an exception that C++ threw in a stage.
fn thrown(stage: &'static str) -> impl Fn(cxx::Exception) -> CgalError {
    move |exception| match exception.what() {
        // cpp/bridge.h writes this text for std::bad_alloc.
        "out of memory" => CgalError::Memory { stage },
        text => CgalError::Thrown { stage, text: text.into() },
    }
}

/// The weights, or zeros if none are given.
fn or_zeros(weights: Option<&[f64]>, points: usize) -> Cow<'_, [f64]> {
    weights.map_or_else(|| vec![0.0; points].into(), Cow::Borrowed)
}

/// Checks that sites span a volume, by the dimension that CGAL found.
fn spanning(sites: &Sites<'_>, dimension: i32) -> Result<(), SitesError> {
    match dimension {
        3 => Ok(()),
        flat => Err(SitesError::flat(sites.positions().len(), flat)),
    }
}

#[cfg(test)]
mod tests {
    use super::ffi::bridge;
    use super::*;

    /// This contains an infinity, which sites refuse, because CGAL throws if its exact numbers meet one.
    const INFINITE: [f64; 15] =
        [0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., f64::INFINITY, 0., 0.];

    fn stage_and_text(error: cxx::Exception) -> (&'static str, String) {
        match thrown("tried")(error) {
            CgalError::Thrown { stage, text } => (stage, text),
            other => panic!("{other}"),
        }
    }

    #[test]
    fn what_cgal_throws_is_an_error() {
        let space = [0.0; 5];
        let thrown = bridge::shape(&INFINITE, &space, 1.0).err();
        let (stage, text) = stage_and_text(thrown.expect("∞ was taken"));
        assert_eq!(stage, "tried");
        assert!(text.starts_with("CGAL ERROR: assertion violation!"), "{text}");
    }
}
