//! `Regular_triangulation_3`.

use walpha_complex::canonical::smallest_even;
use walpha_regular::internals::Sites;

use super::{Error, or_zeros, spanning, thrown};

/// The entry point of `cpp/regular.cc`.
#[allow(unused_qualifications, reason = "in what the macro writes")]
#[cxx::bridge(namespace = "walpha")]
mod bridge {
    unsafe extern "C++" {
        include!("walpha/cpp/bridge.h");
        include!("walpha/cpp/regular.h");

        /// A regular triangulation as flat arrays of input indices.
        type RegularTriangulation;

        fn dimension(self: &RegularTriangulation) -> i32;
        fn cells(self: &RegularTriangulation) -> &[u32];
        fn neighbours(self: &RegularTriangulation) -> &[u32];
        fn vertices(self: &RegularTriangulation) -> &[u32];

        fn regular_space(
            positions: &[f64],
            weights: &[f64],
        ) -> Result<UniquePtr<RegularTriangulation>>;
    }
}

/// The outside of the convex hull in [`RegularTriangulation::neighbours`]: a facet of the hull has no finite cell beyond it.
pub const INFINITE_CELL: u32 = u32::MAX;

/// A regular triangulation of points in space, by their indices. Equal triangulations are equal byte by byte.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct RegularTriangulation {
    /// The finite cells, tetrahedra: positively oriented (a, b, c turn counter-clockwise seen from d), each the lexicographically
    /// smallest even permutation of its corners, in lexicographic order.
    pub cells: Vec<[u32; 4]>,
    /// For each corner of each cell, the number of the cell across the facet opposite that corner, or [`INFINITE_CELL`].
    pub neighbours: Vec<[u32; 4]>,
    /// The points that heavier ones hide, ascending. There are none without weights.
    pub hidden: Vec<u32>,
    /// Pairs of points at one position, the ignored one and the one that is used; ascending.
    pub duplicates: Vec<[u32; 2]>,
}

/// CGAL's `Regular_triangulation_3` of weighted points, which is the Delaunay triangulation without weights.
///
/// Weights are squared lengths. Ties between cospherical points are broken by CGAL's perturbation in the order of (x, y, z), so
/// that the result depends only on the set of points; [`triangulate`](walpha_regular::triangulate) gives the same result.
///
/// Expected O(n log n) for points of even density: 8 µs and 1.2 kB a point.
///
/// ```
/// use walpha::cgal::{INFINITE_CELL, regular_triangulation_3};
///
/// // Two tetrahedra on one triangle.
/// let points = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [1.0, 1.0, 4.0], [1.0, 1.0, -4.0]];
/// let found = regular_triangulation_3(&points, None)?;
/// assert_eq!(found.cells, [[0, 1, 2, 3], [0, 1, 4, 2]]);
/// assert_eq!(found.neighbours[0], [INFINITE_CELL, INFINITE_CELL, INFINITE_CELL, 1]);
/// assert_eq!(found.neighbours[1], [INFINITE_CELL, INFINITE_CELL, 0, INFINITE_CELL]);
/// # Ok::<(), walpha::cgal::Error>(())
/// ```
///
/// # Errors
/// [`Error::Sites`]: the numbers of weights and points differ; a number is not finite or is too large; there are fewer than four
/// distinct points; all points lie in one plane. [`Error::Cgal`]: out of memory, or a bug in the program.
pub fn regular_triangulation_3(
    positions: &[[f64; 3]],
    weights: Option<&[f64]>,
) -> Result<RegularTriangulation, Error> {
    let weights = or_zeros(weights, positions.len());
    let sites = Sites::new(positions, &weights)?;
    let found = bridge::regular_space(sites.positions().as_flattened(), sites.weights())
        .map_err(thrown("regular triangulation"))?;
    spanning(&sites, found.dimension())?;

    let mut is_vertex = vec![false; sites.input().len()];
    found.vertices().iter().for_each(|&site| is_vertex[site as usize] = true);
    let hidden = sites.input().iter().zip(is_vertex).filter(|&(_, is_vertex)| !is_vertex);
    let hidden = hidden.map(|(&point, _)| point).collect();

    let corners = found.cells().as_chunks().0;
    let neighbours: &[[u32; 4]] = found.neighbours().as_chunks().0;
    let mut cells: Vec<_> = (corners.iter().zip(neighbours).zip(0_u32..))
        .map(|((&corners, &neighbours), number)| {
            let corners = corners.map(|site| sites.input()[site as usize]);
            let row = smallest_even(corners);
            let across = row.map(|v| neighbours[position(corners, v)]);
            (row, across, number)
        })
        .collect();
    cells.sort_unstable();
    let mut renumbered = vec![INFINITE_CELL; cells.len()];
    (0..).zip(&cells).for_each(|(new, &(.., old))| renumbered[old as usize] = new);
    let number = |old: u32| renumbered.get(old as usize).copied().unwrap_or(INFINITE_CELL);
    Ok(RegularTriangulation {
        cells: cells.iter().map(|&(row, ..)| row).collect(),
        neighbours: cells.iter().map(|&(_, across, _)| across.map(number)).collect(),
        hidden,
        duplicates: sites.duplicates().to_vec(),
    })
}

/// The index of a corner in a cell.
fn position(corners: [u32; 4], corner: u32) -> usize {
    corners.iter().position(|&v| v == corner).expect("a corner of the cell")
}
