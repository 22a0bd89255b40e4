//! CGAL's triangulations and alpha shapes of points in space: plain slices in, plain arrays out. To check other programs
//! against, this one among them.
//!
//! | function | CGAL's class | feature |
//! |---|---|---|
//! | [`fixed_alpha_shape`] | `Fixed_alpha_shape_3` | `cgal` |
//! | [`regular_triangulation_2`], [`farthest_point_triangulation_2`] | `Regular_triangulation_2` | `paper` or `cgal-oracles` |
//! | [`regular_triangulation_3`] | `Regular_triangulation_3` | `cgal-oracles` |
//! | [`AlphaShape3`] | `Alpha_shape_3<Dt, Tag_true>`, `GENERAL` or `REGULARIZED` | `cgal-oracles` |
//! | [`periodic_regular_triangulation_3`] | `Periodic_3_regular_triangulation_3` | `cgal-oracles` |
//!
//! All over `Exact_predicates_inexact_constructions_kernel`, with CGAL 5.3 or later. CGAL's code is under the GPL, and so is what links it.
//!
//! Points are (x, y, z), and results name them by index. Weights and α are **squared lengths**; without weights all are 0, and
//! regular triangulations are Delaunay triangulations. Every combinatorial answer is exact.
//!
//! CGAL does not see what it does not stand: numbers that are not finite or too large ([`MAX_COORDINATE`](walpha_regular::MAX_COORDINATE),
//! [`MAX_WEIGHT`](walpha_regular::MAX_WEIGHT)) and too few points are an [`Error`], and of points at one position the heaviest takes
//! part, of equally heavy ones the first. What CGAL throws is an error, too. CGAL works on the calling thread, and cannot be interrupted.
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

// Rules of the bridge: one call per stage; flat slices in, and out either an opaque result that lends flat slices or a copy into
// slices that Rust made; input indices come back everywhere; every entry that computes returns `Result`, and C++ catches whatever is
// thrown there. Rust refuses what CGAL cannot stand (NaN, infinities, duplicates, fewer than four points) before the call, in `Sites`.
// C++ never calls back into Rust, because CGAL changes the rounding mode while it works.

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

/// What C++ threw in a stage.
fn thrown(stage: &'static str) -> impl Fn(cxx::Exception) -> CgalError {
    move |exception| match exception.what() {
        // Said by cpp/bridge.h for std::bad_alloc.
        "out of memory" => CgalError::Memory { stage },
        text => CgalError::Thrown { stage, text: text.into() },
    }
}

/// Weights 0 where none are given.
fn or_zeros(weights: Option<&[f64]>, points: usize) -> Cow<'_, [f64]> {
    weights.map_or_else(|| vec![0.0; points].into(), Cow::Borrowed)
}

/// Whether sites span a volume, by the dimension that CGAL found.
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

    /// Sites refuse an infinity, because CGAL throws where its exact numbers meet one.
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
