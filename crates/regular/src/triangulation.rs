//! The triangulation of points, and its queries.

use std::collections::HashSet;

use walpha_base::Monitor;
use walpha_base::parallel::in_pool;
use walpha_base::parallel::prelude::*;

use crate::merging::triangulate_along;
use crate::{CellArrays, Scaled, Sites, TriangulationError, facets, filled, with_capacity};

/// The regular triangulation of points in space.
///
/// Without weights it is the Delaunay triangulation. Weights are those of the power distance, squared lengths: a point p of
/// weight ω is at |x − p|² − ω from x. Points are named by their indices everywhere. The result depends neither on the number of
/// threads, which are all of the current rayon pool, nor on the order of the points, except for these indices.
///
/// Of points at one position, the heaviest takes part, and the first of equally heavy ones
/// ([`duplicates`](Triangulation::duplicates)). A point that heavier ones hide is not a vertex
/// ([`hidden`](Triangulation::hidden)). The triangulation keeps a copy of the points, 24 bytes each.
///
/// ```
/// use walpha_regular::triangulate;
///
/// let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let tetrahedron = triangulate(&points, None)?;
/// assert_eq!(tetrahedron.finite_cells().count(), 1);
/// assert_eq!(tetrahedron.hull_facets().count(), 4);
/// # Ok::<(), walpha_regular::TriangulationError>(())
/// ```
///
/// Expected O(n log n) for evenly distributed points.
///
/// # Errors
/// [`TriangulationError::Sites`]: other numbers of weights than of points; a number that is not finite or is too large
/// ([`MAX_COORDINATE`](crate::MAX_COORDINATE), [`MAX_WEIGHT`](crate::MAX_WEIGHT)); fewer than four distinct points; all
/// points in one plane. Out of memory; more than [`Triangulation::MAX_CELLS`] cells;
/// cancelled by a [`Monitor`] that watches.
pub fn triangulate(
    points: &[[f64; 3]],
    weights: Option<&[f64]>,
) -> Result<Triangulation, TriangulationError> {
    let monitor = &*Monitor::current();
    in_pool(points.len(), || triangulate_watched(points, weights, monitor))
}

fn triangulate_watched(
    points: &[[f64; 3]],
    weights: Option<&[f64]>,
    monitor: &Monitor,
) -> Result<Triangulation, TriangulationError> {
    let zeros = if weights.is_none() { filled(points.len(), 0.0)? } else { Vec::new() };
    let sites = Sites::new(points, weights.unwrap_or(&zeros))?;
    let along = sites.curve();
    let mut places: Vec<_> =
        along.par_iter().coarse().map(|&i| sites.positions()[i as usize]).collect();
    let mut heights: Vec<_> =
        along.par_iter().coarse().map(|&i| sites.weights()[i as usize]).collect();
    if let Some(scaled) = Scaled::of(&places, &heights) {
        (places, heights) = (scaled.positions, scaled.weights);
    }
    let work = monitor.units(along.len() as u64);
    let mut arrays = triangulate_along(&places, &heights, |more| work.add(more as u64))?;
    work.add(along.len() as u64)?;
    drop((places, heights));
    let index = |v: u32| along.get(v as usize).map(|&site| sites.input()[site as usize]);
    let at_infinity = points.len() as u32;
    arrays.cells.par_iter_mut().coarse().for_each(|cell| {
        *cell = cell.map(|v| index(v).unwrap_or(at_infinity));
    });
    arrays.at_infinity = at_infinity;
    let duplicates = sites.duplicates().to_vec();
    drop(sites);
    let mut positions = with_capacity(points.len())?;
    positions.extend_from_slice(points);
    Triangulation::new(positions, arrays, duplicates)
}

/// A regular triangulation of points; [`triangulate`] makes it.
///
/// Points are named by their indices. The outside of the convex hull is divided into infinite cells, one for each
/// facet of the hull. Their fourth corner is the *infinite vertex*, as in CGAL: its number is the number of
/// points, one past the last index. Cells are positively oriented: a, b, c turn counter-clockwise seen from d, where the
/// infinite vertex counts as a point far outside the hull.
///
/// Example: four points have the cell `[0, 1, 2, 3]` and four infinite cells, among them
/// `[0, 2, 1, 4]` with the infinite vertex 4 as its corner 3. If that cell has number 2, `adjacency()[0][3]` is
/// 4·2 + 3: the facet opposite corner 3 of cell 0 is also the facet opposite corner 3 of cell 2.
#[derive(Clone, Debug)]
pub struct Triangulation {
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) arrays: CellArrays,
    duplicates: Vec<[u32; 2]>,
    hidden: Vec<u32>,
    /// A cell at each vertex, a finite one, and an infinite one at the infinite vertex; [`NO_CELL`] for other points.
    pub(crate) cell_at: Vec<u32>,
}

/// Stands for the absence of a cell.
pub(crate) const NO_CELL: u32 = u32::MAX;

impl Triangulation {
    /// The largest number of cells: 4·cell + corner fits 32 bits.
    pub const MAX_CELLS: usize = 1 << 30;

    pub(crate) fn new(
        positions: Vec<[f64; 3]>,
        arrays: CellArrays,
        duplicates: Vec<[u32; 2]>,
    ) -> Result<Self, TriangulationError> {
        let mut cell_at = filled(positions.len() + 1, NO_CELL)?;
        for (cell, corners) in (0..).zip(&arrays.cells) {
            if corners.contains(&arrays.at_infinity) {
                cell_at[arrays.at_infinity as usize] = cell;
            } else {
                corners.iter().for_each(|&v| cell_at[v as usize] = cell);
            }
        }
        let mut hidden: Vec<u32> =
            (0..arrays.at_infinity).filter(|&v| cell_at[v as usize] == NO_CELL).collect();
        let is_duplicate =
            |v: &u32| duplicates.binary_search_by_key(v, |&[removed, _]| removed).is_ok();
        hidden.retain(|v| !is_duplicate(v));
        Ok(Self { positions, arrays, duplicates, hidden, cell_at })
    }

    /// The points, as they were given.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// The corners of each cell, infinite cells included. Cells that are close in space are close here.
    pub fn cells(&self) -> &[[u32; 4]] {
        &self.arrays.cells
    }

    /// For each corner of each cell, the neighbour across the facet opposite that corner, as 4·cell + corner:
    /// the neighbouring cell, and its own corner opposite the same facet.
    pub fn adjacency(&self) -> &[[u32; 4]] {
        &self.arrays.adjacency
    }

    /// The infinite vertex, a corner of every infinite cell. Its number is the number of points.
    pub fn infinite_vertex(&self) -> u32 {
        self.arrays.at_infinity
    }

    /// The number and the corners of each finite cell, a tetrahedron; ascending numbers.
    pub fn finite_cells(&self) -> impl Iterator<Item = (u32, [u32; 4])> + '_ {
        let cells = (0..).zip(self.cells().iter().copied());
        cells.filter(|(_, corners)| !corners.contains(&self.infinite_vertex()))
    }

    /// Whether there is a finite cell of this number.
    pub fn is_finite(&self, cell: u32) -> bool {
        self.cells()
            .get(cell as usize)
            .is_some_and(|corners| !corners.contains(&self.infinite_vertex()))
    }

    /// The neighbours of a cell across the facets opposite its corners; some may be infinite. `None` where there is no
    /// cell of this number.
    pub fn neighbors(&self, cell: u32) -> Option<[u32; 4]> {
        self.adjacency().get(cell as usize).map(|sides| sides.map(|side| side / 4))
    }

    /// The points that are vertices, ascending: those that are neither hidden nor duplicates.
    pub fn vertices(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.infinite_vertex()).filter(|&v| self.is_vertex(v))
    }

    /// Whether a point is a vertex; `false` past the last point.
    pub fn is_vertex(&self, point: u32) -> bool {
        point < self.infinite_vertex() && self.cell_at[point as usize] != NO_CELL
    }

    /// The points that heavier points hide, ascending. There are none without weights.
    pub fn hidden(&self) -> &[u32] {
        &self.hidden
    }

    /// Pairs of points at one position, the one left out and the one that takes part; ascending.
    pub fn duplicates(&self) -> &[[u32; 2]] {
        &self.duplicates
    }

    /// The facets of the convex hull, each counter-clockwise seen from outside. A face of the hull that has more than
    /// three vertices is divided. O(cells).
    pub fn hull_facets(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.cells().iter().filter_map(|&corners| {
            let beyond = corners.iter().position(|&v| v == self.infinite_vertex())?;
            Some(facets(corners)[beyond])
        })
    }

    /// The cells at a vertex, infinite ones included, in no particular order; of the infinite vertex, all infinite cells. Empty for
    /// points that are not vertices. Linear in their number.
    pub fn star(&self, vertex: u32) -> Vec<u32> {
        let mut star = match self.cell_at.get(vertex as usize) {
            None | Some(&NO_CELL) => return Vec::new(),
            Some(&cell) => vec![cell],
        };
        let mut seen = HashSet::from([star[0]]);
        let mut at = 0;
        while let Some(&cell) = star.get(at) {
            at += 1;
            let (corners, sides) = (self.cells()[cell as usize], self.adjacency()[cell as usize]);
            for (corner, side) in corners.into_iter().zip(sides) {
                if corner != vertex && seen.insert(side / 4) {
                    star.push(side / 4);
                }
            }
        }
        star
    }
}

#[cfg(test)]
pub(crate) mod tests;
