//! Triangulations under the names that other programs give their arrays.

/// The names of points and cells in a file.
pub(super) type Names = [&'static str; 2];

/// The names of points in other programs, as n×3 numbers: `SciPy`, distmesh and scikit-fem, trimesh.
const POINTS: [&str; 3] = ["points", "p", "vertices"];
/// The names of tetrahedra in other programs: `SciPy`, meshio, distmesh and scikit-fem.
const CELLS: [&str; 3] = ["simplices", "tetra", "t"];
/// Our own name, which names the cells of a triangulation only together with these other names.
const OUR_CELLS: &str = "cells";
const BESIDE: [&str; 5] = ["points", "p", "vertices", "weights", OUR_CELLS];

/// The names of points and cells among the names in a file: those of other programs, or ours if there are only these two and
/// weights. `None` for other names.
pub(super) fn names_of(names: &[String]) -> Option<Names> {
    let first_of = |known: &[&'static str]| {
        known.iter().copied().find(|known| names.iter().any(|name| name == known))
    };
    let is_bare = names.iter().all(|name| BESIDE.contains(&&name[..]));
    let cells = first_of(&CELLS).or_else(|| first_of(&[OUR_CELLS]).filter(|_| is_bare));
    Some([first_of(&POINTS)?, cells?])
}
