//! Floor 2: the private bridge to CGAL and its safe wrapper.
//!
//! Rules of the bridge: one call per stage; flat slices in, and out either an opaque result that lends
//! flat slices or a copy into slices that Rust made; input indices come back everywhere; every entry
//! returns `Result`, and C++ catches whatever is thrown there. Rust refuses what CGAL cannot stand
//! (NaN, infinities, duplicates, fewer than four points) before the call, in
//! [`Sites`](crate::triangulation::Sites). C++ never calls back into Rust, because CGAL changes the
//! rounding mode while it works.

#[allow(unused_qualifications, reason = "in what the macro writes")]
#[expect(unreachable_pub, reason = "cxx writes `pub`")]
mod ffi;
#[cfg(feature = "paper")]
#[expect(unreachable_pub, reason = "cxx writes `pub`")]
mod plane;
mod reference;
mod regular;

pub(crate) use ffi::bridge::give_back;
#[cfg(feature = "paper")]
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

#[cfg(test)]
mod tests {
    use super::ffi::bridge;
    use super::*;

    /// Sites refuse an infinity, because CGAL throws where its exact numbers meet one.
    const INFINITE: [f64; 15] =
        [0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., f64::INFINITY, 0., 0.];

    fn told(error: cxx::Exception) -> (&'static str, String) {
        match thrown("tried")(error) {
            TriangulationError::Thrown { stage, text } => (stage, text),
            other => panic!("{other}"),
        }
    }

    #[test]
    fn what_cgal_throws_is_an_error() {
        let space = [0.0; 5];
        let thrown = [
            bridge::regular(&INFINITE, &space, &[0, 1, 2, 3, 4]).err(),
            bridge::reference(&INFINITE, &space, 1.0).err(),
        ];
        for (entry, error) in thrown.into_iter().enumerate() {
            let (stage, text) = told(error.unwrap_or_else(|| panic!("entry {entry} took ∞")));
            assert_eq!(stage, "tried");
            assert!(text.starts_with("CGAL ERROR: assertion violation!"), "{entry}: {text}");
        }
    }

    #[test]
    fn what_the_bridge_throws_is_an_error() {
        let made = bridge::regular(&INFINITE[..12], &[0.0; 4], &[0, 1, 2, 3]).unwrap();
        let mut corners = vec![0; 4 * made.cells()];
        let mut beside = corners.clone();
        assert!(made.copy(&mut corners, &mut beside).is_ok());
        let (_, text) = told(made.copy(&mut corners[1..], &mut beside).unwrap_err());
        assert_eq!(text, "four vertices and four neighbours are copied for each cell");
    }
}
