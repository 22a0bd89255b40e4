//! The private bridge to CGAL and its safe wrapper.
//!
//! Rules of the bridge: one call per stage; flat slices in, and out either an opaque result that lends
//! flat slices or a copy into slices that Rust made; input indices come back everywhere; every entry
//! returns `Result`, and C++ catches whatever is thrown there. Rust refuses what CGAL cannot stand
//! (NaN, infinities, duplicates, fewer than four points) before the call, in
//! [`Sites`](walpha_regular::internals::Sites). C++ never calls back into Rust, because CGAL changes the
//! rounding mode while it works.

#[allow(unused_qualifications, reason = "in what the macro writes")]
#[expect(unreachable_pub, reason = "cxx writes `pub`")]
mod ffi;
#[cfg(feature = "paper")]
#[expect(unreachable_pub, reason = "cxx writes `pub`")]
mod plane;
mod shape;

#[cfg(feature = "paper")]
pub(crate) use plane::{RawTriangulation, farthest_plane, regular_plane};
pub(crate) use shape::complex;

use walpha_shape::CgalError;

/// What C++ threw in a stage.
fn thrown(stage: &'static str) -> impl Fn(cxx::Exception) -> CgalError {
    move |exception| match exception.what() {
        // Said by cpp/bridge.h for std::bad_alloc.
        "out of memory" => CgalError::Memory { stage },
        text => CgalError::Thrown { stage, text: text.into() },
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
