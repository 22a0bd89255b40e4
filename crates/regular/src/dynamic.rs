//! A Delaunay triangulation that changes.

use std::collections::HashMap;
use std::ops::Range;

use crate::incremental::Growing;
use crate::order::position_bits;
use crate::sites::check;
use crate::{
    Cell, CellArrays, DELETED, SitesError, Triangulation, TriangulationError, filled, with_capacity,
};

/// A Delaunay triangulation that points can be inserted in and removed from.
///
/// Ties are broken as by [`triangulate`](crate::triangulate()), so the cells depend on the points in it alone, and not on the
/// order of insertions and removals. Points are numbered from 0 in the order in which they are given; a removed point
/// keeps its number. There are no weights: a point that they hide would have to come back where others leave.
///
/// ```
/// use walpha_regular::DynamicDelaunay;
///
/// let corners = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];
/// let mut delaunay = DynamicDelaunay::new(&corners)?;
/// assert_eq!(delaunay.insert(&[[1.0; 3], [0.5; 3]])?, 4..6);
/// assert_eq!(delaunay.finite_cells().count(), 7);
/// assert_eq!(delaunay.remove(&[4])?, 1);
/// assert_eq!(delaunay.finite_cells().count(), 4);
/// # Ok::<(), walpha_regular::TriangulationError>(())
/// ```
#[derive(Debug)]
pub struct DynamicDelaunay(Growing);

impl DynamicDelaunay {
    /// The Delaunay triangulation of points. Expected O(n log n), on one thread.
    ///
    /// # Errors
    /// Those of [`triangulate`](crate::triangulate()).
    pub fn new(points: &[[f64; 3]]) -> Result<Self, TriangulationError> {
        Growing::new(points).map(Self)
    }

    /// Inserts points, and returns their numbers. A point at the position of a vertex gets a number, but is no vertex.
    ///
    /// Each call looks at all points once, besides the expected O(log n) for each point inserted: many points are better
    /// inserted by one call.
    ///
    /// # Errors
    /// [`TriangulationError::Sites`]: a number that is not finite or is too large, by the index in `points`, or more
    /// points than 32 bits can number; nothing has changed then. Out of memory, or too many cells: some of the points
    /// may be missing.
    pub fn insert(&mut self, points: &[[f64; 3]]) -> Result<Range<u32>, TriangulationError> {
        check(points, &filled(points.len(), 0.0)?)?;
        let count = self.positions().len() + points.len();
        if count >= u32::MAX as usize {
            return Err(SitesError::TooMany(count).into());
        }
        let new = self.0.register(points);
        self.0.insert(&new.clone().collect::<Vec<_>>())?;
        Ok(new.start - Growing::FIRST..new.end - Growing::FIRST)
    }

    /// Removes vertices, and returns how many. Points that are no vertices are passed over, and so are vertices without
    /// which the others would span no volume.
    ///
    /// Each call looks at all points once, besides the time to triangulate the neighbours of each vertex that leaves.
    ///
    /// # Errors
    /// Out of memory, or too many cells: some of the vertices may have been removed.
    pub fn remove(&mut self, vertices: &[u32]) -> Result<usize, TriangulationError> {
        let mut there: Vec<u32> =
            vertices.iter().filter(|&&v| self.is_vertex(v)).map(|v| v + Growing::FIRST).collect();
        there.sort_unstable();
        there.dedup();
        self.0.remove(&there)
    }

    /// The points by their numbers, removed ones included.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.0.positions()[Growing::FIRST as usize..]
    }

    /// Whether a point is a vertex: it has not been removed, nor left out at the position of another.
    pub fn is_vertex(&self, point: u32) -> bool {
        (point as usize) < self.positions().len() && self.0.is_vertex(point + Growing::FIRST)
    }

    /// The vertices, ascending.
    pub fn vertices(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.positions().len() as u32).filter(|&v| self.is_vertex(v))
    }

    /// The corners of the finite cells, positively oriented, in no particular order.
    pub fn finite_cells(&self) -> impl Iterator<Item = [u32; 4]> + '_ {
        let all = (0..).zip(self.0.cells());
        let finite = all.filter(|&(cell, _)| self.0.is_cell(cell));
        finite.map(|(_, cell)| cell.corners.map(|v| v - Growing::FIRST))
    }

    /// The triangulation as it is now, which answers more. Points have the same numbers; removed ones count as hidden.
    /// O(n log n).
    ///
    /// # Errors
    /// Out of memory.
    pub fn triangulation(&self) -> Result<Triangulation, TriangulationError> {
        let ghost = self.positions().len() as u32;
        let mut cells: Vec<Cell> = with_capacity(self.0.cells().len())?;
        cells.extend(self.0.cells().iter().map(|cell| match cell.corners[0] {
            DELETED => *cell,
            // The ghost, which is vertex 0, becomes the last.
            _ => Cell {
                corners: cell.corners.map(|v| v.checked_sub(Growing::FIRST).unwrap_or(ghost)),
                ..*cell
            },
        }));
        let mut positions = with_capacity(ghost as usize)?;
        positions.extend_from_slice(self.positions());
        let at: HashMap<[u64; 3], u32> =
            self.vertices().map(|v| (position_bits(positions[v as usize]), v)).collect();
        let removed = (0..ghost).filter(|&v| !self.is_vertex(v));
        let duplicates =
            removed.filter_map(|v| Some([v, *at.get(&position_bits(positions[v as usize]))?]));
        let duplicates = duplicates.collect();
        Triangulation::new(positions, CellArrays::of_cells(cells, ghost)?, duplicates)
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;
    use crate::locate::tests::{Place, doubles};
    use crate::triangulate;

    /// Of many sets of integer points, some at one position: what is left after insertions and removals is the
    /// triangulation of what is left.
    #[test]
    fn it_is_the_triangulation_of_its_vertices() {
        let mut random = Random::new(4);
        let (mut stayed, mut removed) = (0, 0);
        for case in 0..300 {
            let side = 2 + case % 4;
            let mut some = |count| -> Vec<Place> {
                (0..count).map(|_| [0; 3].map(|_| random.below(side) as i64)).collect()
            };
            let (first, more) = (some(12), some(20));
            let Ok(mut dynamic) = DynamicDelaunay::new(&doubles(&first)) else { continue };
            assert_eq!(dynamic.insert(&doubles(&more)).unwrap(), 12..32);
            let all = doubles(&[first, more].concat());
            assert_eq!(dynamic.positions(), all);
            agree(&dynamic);
            let leave: Vec<u32> = (0..32).filter(|_| random.below(3) > 0).collect();
            let there = leave.iter().filter(|&&v| dynamic.is_vertex(v)).count();
            let gone = dynamic.remove(&leave).unwrap();
            removed += gone;
            stayed += there - gone;
            agree(&dynamic);
            assert_eq!(dynamic.remove(&[32, u32::MAX, leave[0], leave[0]]).unwrap_or(0), 0);
            dynamic.insert(&all).unwrap();
            agree(&dynamic);
        }
        assert!(stayed > 20 && removed > 2000, "{stayed} {removed}");
    }

    fn agree(dynamic: &DynamicDelaunay) {
        let vertices: Vec<u32> = dynamic.vertices().collect();
        let places: Vec<[f64; 3]> =
            vertices.iter().map(|&v| dynamic.positions()[v as usize]).collect();
        let expected = triangulate(&places, None).unwrap();
        assert!(expected.duplicates().is_empty());
        let by_number = |corners: [u32; 4]| corners.map(|v| vertices[v as usize]);
        let sorted = |cells: Vec<[u32; 4]>| {
            let mut cells: Vec<_> = cells
                .into_iter()
                .map(|mut cell| {
                    cell.sort_unstable();
                    cell
                })
                .collect();
            cells.sort_unstable();
            cells
        };
        let expected =
            sorted(expected.finite_cells().map(|(_, corners)| by_number(corners)).collect());
        assert_eq!(sorted(dynamic.finite_cells().collect()), expected);
        let frozen = dynamic.triangulation().unwrap();
        assert_eq!(sorted(frozen.finite_cells().map(|(_, corners)| corners).collect()), expected);
        assert!(frozen.vertices().eq(vertices));
        for &[left_out, kept] in frozen.duplicates() {
            let place = |v: u32| dynamic.positions()[v as usize];
            assert!(place(left_out) == place(kept) && dynamic.is_vertex(kept));
        }
        assert!(frozen.hull_facets().flatten().all(|v| frozen.is_vertex(v)));
        let count = frozen.vertices().count() + frozen.hidden().len() + frozen.duplicates().len();
        assert_eq!(count, dynamic.positions().len());
    }

    /// The neighbours of a peak are in one plane, which others are beneath.
    #[test]
    fn a_peak_over_a_plane_leaves() {
        let base = (0..18).map(|i| [i % 3, i / 3 % 3, -i / 9].map(f64::from));
        let points: Vec<[f64; 3]> = base.chain([[1.0, 1.0, 5.0]]).collect();
        let mut dynamic = DynamicDelaunay::new(&points).unwrap();
        assert_eq!(dynamic.remove(&[18]).unwrap(), 1);
        agree(&dynamic);
        // Without any of these the rest is flat.
        let mut tetrahedron =
            DynamicDelaunay::new(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
                .unwrap();
        assert_eq!(tetrahedron.remove(&[0, 1, 2, 3]).unwrap(), 0);
        agree(&tetrahedron);
    }

    #[test]
    fn bad_numbers_change_nothing() {
        let corners = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];
        let mut dynamic = DynamicDelaunay::new(&corners).unwrap();
        let error = dynamic.insert(&[[1.0; 3], [0.0, f64::NAN, 0.0]]).unwrap_err();
        assert!(matches!(
            error,
            TriangulationError::Sites(SitesError::Value { index: 1, what: "y", .. })
        ));
        assert_eq!(dynamic.positions(), corners);
        assert!(DynamicDelaunay::new(&corners[..3]).is_err());
    }
}
