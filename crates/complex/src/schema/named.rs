//! Triangulations under the names that other programs give their arrays.

/// What a file calls its points and its cells.
pub(super) type Names = [&'static str; 2];

/// What others call points, as n×3 numbers: `SciPy`, distmesh and scikit-fem, trimesh.
const POINTS: [&str; 3] = ["points", "p", "vertices"];
/// What others call tetrahedra: `SciPy`, meshio, distmesh and scikit-fem.
const CELLS: [&str; 3] = ["simplices", "tetra", "t"];
/// Our own name, which is one of a triangulation only beside these.
const OUR_CELLS: &str = "cells";
const BESIDE: [&str; 5] = ["points", "p", "vertices", "weights", OUR_CELLS];

/// The names of points and cells among those of a file: such as others use, or no more than these two and weights. `None`
/// for other names.
pub(super) fn names_of(names: &[String]) -> Option<Names> {
    let first_of = |known: &[&'static str]| {
        known.iter().copied().find(|known| names.iter().any(|name| name == known))
    };
    let is_bare = names.iter().all(|name| BESIDE.contains(&&name[..]));
    let cells = first_of(&CELLS).or_else(|| first_of(&[OUR_CELLS]).filter(|_| is_bare));
    Some([first_of(&POINTS)?, cells?])
}
