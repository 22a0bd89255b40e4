//! A regular triangulation that changes.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::collections::hash_map::{Entry, HashMap};
use std::ops::Range;

use crate::incremental::Growing;
use crate::order::position_bits;
use crate::sites::check;
use crate::{
    Cell, CellArrays, DELETED, Sites, SitesError, Triangulation, TriangulationError, filled,
    with_capacity,
};

/// A regular triangulation that points can be inserted in and removed from; without weights, a Delaunay triangulation.
///
/// It is that of [`triangulate`](crate::triangulate()) for the points in it, ties included, whatever the order of insertions and
/// removals. Points are numbered from 0 in the order in which they are given; a removed point keeps its number. Points that
/// others hide, and lighter ones at the position of another, are in it and no vertices: they become vertices where those leave.
///
/// ```
/// use walpha_regular::DynamicTriangulation;
///
/// let corners = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];
/// let mut dynamic = DynamicTriangulation::new(&corners, None)?;
/// assert_eq!(dynamic.insert(&[[1.0; 3], [0.5; 3]], Some(&[9.0, 0.0]))?, 4..6);
/// // The weight of 4 hides 5, until 4 leaves.
/// assert!(dynamic.is_vertex(4) && !dynamic.is_vertex(5));
/// assert_eq!(dynamic.remove(&[4])?, 1);
/// assert!(dynamic.is_vertex(5));
/// assert_eq!(dynamic.finite_cells().count(), 4);
/// # Ok::<(), walpha_regular::TriangulationError>(())
/// ```
#[derive(Debug)]
pub struct DynamicTriangulation {
    growing: Growing,
    /// Of the points at each position the heaviest, of equal weights the first, by the number in `growing`.
    at: HashMap<[u64; 3], u32>,
    /// The others, which are not inserted.
    duplicates: BTreeSet<u32>,
    /// Whether weights differ, so that points may hide others.
    is_weighted: bool,
}

impl DynamicTriangulation {
    /// The regular triangulation of points, or their Delaunay triangulation without weights. Expected O(n log n), on one
    /// thread.
    ///
    /// # Errors
    /// Those of [`triangulate`](crate::triangulate()).
    pub fn new(points: &[[f64; 3]], weights: Option<&[f64]>) -> Result<Self, TriangulationError> {
        let weights = or_zeros(points, weights)?;
        let sites = Sites::new(points, &weights)?;
        let number = |v: u32| v + Growing::FIRST;
        let at = sites.input().iter().map(|&v| (position_bits(points[v as usize]), number(v)));
        let mut dynamic = Self {
            growing: Growing::empty(points, &weights)?,
            at: at.collect(),
            duplicates: sites.duplicates().iter().map(|&[lighter, _]| number(lighter)).collect(),
            is_weighted: weights.iter().any(|&weight| weight != weights[0]),
        };
        let all: Vec<u32> = sites.input().iter().map(|&v| number(v)).collect();
        dynamic.growing.start_again(&all)?;
        dynamic.settle();
        Ok(dynamic)
    }

    /// Inserts points, and returns their numbers.
    ///
    /// Each call looks at all points once, and at all cells where there are weights, besides the expected O(log n) for each
    /// point inserted: many points are better inserted by one call.
    ///
    /// # Errors
    /// [`TriangulationError::Sites`]: a number that is not finite or is too large, by the index in `points`, lengths that
    /// differ, or more points than 32 bits can number; nothing has changed then. Out of memory, or too many cells: what is
    /// in it is then not known.
    pub fn insert(
        &mut self,
        points: &[[f64; 3]],
        weights: Option<&[f64]>,
    ) -> Result<Range<u32>, TriangulationError> {
        let weights = or_zeros(points, weights)?;
        check(points, &weights)?;
        let count = self.positions().len() + points.len();
        if count >= u32::MAX as usize {
            return Err(SitesError::TooMany(count).into());
        }
        let first_weight = self.growing.weights()[Growing::FIRST as usize];
        self.is_weighted |= weights.iter().any(|&weight| weight != first_weight);
        let new = self.growing.register(points, &weights);
        let mut outweighed = Vec::new();
        for v in new.clone() {
            let weight = |v: u32| self.growing.weights()[v as usize];
            match self.at.entry(position_bits(self.growing.positions()[v as usize])) {
                Entry::Vacant(place) => {
                    place.insert(v);
                }
                Entry::Occupied(mut place) if weight(v) > weight(*place.get()) => {
                    outweighed.push(place.insert(v));
                }
                Entry::Occupied(_) => {
                    self.duplicates.insert(v);
                }
            }
        }
        self.duplicates.extend(&outweighed);
        let stuck = self.change(&outweighed, new.clone().collect())?;
        debug_assert_eq!(stuck, 0, "there is another point at the same position");
        Ok(new.start - Growing::FIRST..new.end - Growing::FIRST)
    }

    /// Removes points, and returns how many. Points that are not in it are passed over, and so are vertices without which
    /// all others would span no volume.
    ///
    /// Each call looks at all points once, and tries all hidden points again, besides the time to triangulate the neighbours of
    /// each vertex that leaves.
    ///
    /// # Errors
    /// Out of memory, or too many cells: what is in it is then not known.
    pub fn remove(&mut self, points: &[u32]) -> Result<usize, TriangulationError> {
        let mut asked: Vec<u32> =
            points.iter().filter_map(|v| v.checked_add(Growing::FIRST)).collect();
        asked.retain(|&v| (v as usize) < self.growing.positions().len());
        asked.sort_unstable();
        asked.dedup();
        let mut removed = asked.len();
        asked.retain(|v| !self.duplicates.remove(v));
        let place = |v: u32| position_bits(self.growing.positions()[v as usize]);
        let is_in = asked.len();
        asked.retain(|&v| self.at.get(&place(v)) == Some(&v));
        removed -= is_in - asked.len();
        for v in &asked {
            self.at.remove(&place(*v));
        }
        // The next at each position; the heaviest comes last, of equal weights the first.
        let mut next = Vec::new();
        if !self.duplicates.is_empty() {
            let free = |v: &u32| !self.at.contains_key(&place(*v));
            next = self.duplicates.iter().copied().filter(free).collect();
            // −0 is 0.
            let weight = |v: u32| self.growing.weights()[v as usize] + 0.0;
            next.sort_by(|&a, &b| weight(a).total_cmp(&weight(b)).then(b.cmp(&a)));
            self.at.extend(next.iter().map(|&v| (place(v), v)));
            next.retain(|v| self.at[&place(*v)] == *v);
            next.iter().for_each(|v| {
                self.duplicates.remove(v);
            });
        }
        Ok(removed - self.change(&asked, next)?)
    }

    /// Takes points out of the triangulation, and inserts others, and the hidden ones that may come back. Returns how many of
    /// the former stay, because all others span no volume.
    fn change(&mut self, leave: &[u32], mut enter: Vec<u32>) -> Result<usize, TriangulationError> {
        let vertices = |growing: &Growing| -> Vec<u32> {
            leave.iter().copied().filter(|&v| growing.is_vertex(v)).collect()
        };
        self.growing.remove(&vertices(&self.growing))?;
        let mut stuck = vertices(&self.growing);
        if !stuck.is_empty() {
            // What enters may span a volume with the others.
            let mut all: Vec<u32> = self.at.values().copied().collect();
            all.sort_unstable();
            match self.growing.start_again(&all) {
                Ok(()) => stuck.clear(),
                Err(TriangulationError::Sites(_)) => {
                    for &v in &stuck {
                        let place = position_bits(self.growing.positions()[v as usize]);
                        self.duplicates.extend(self.at.insert(place, v));
                    }
                }
                Err(error) => return Err(error),
            }
            self.settle();
        }
        let place = |v: &u32| position_bits(self.growing.positions()[*v as usize]);
        if self.is_weighted && !leave.is_empty() {
            enter = self.at.values().copied().collect();
            enter.sort_unstable();
        }
        enter.retain(|v| self.at[&place(v)] == *v && !self.growing.is_vertex(*v));
        self.growing.insert(&enter)?;
        self.settle();
        Ok(stuck.len())
    }

    fn settle(&mut self) {
        if self.is_weighted {
            self.growing.settle();
        }
    }

    /// The points by their numbers, removed ones included.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.growing.positions()[Growing::FIRST as usize..]
    }

    /// The weights by the numbers of the points.
    pub fn weights(&self) -> &[f64] {
        &self.growing.weights()[Growing::FIRST as usize..]
    }

    /// Whether a point is a vertex: it has not been removed, is not hidden, and no other at its position stands for it.
    pub fn is_vertex(&self, point: u32) -> bool {
        (point as usize) < self.positions().len() && self.growing.is_vertex(point + Growing::FIRST)
    }

    /// The vertices, ascending.
    pub fn vertices(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.positions().len() as u32).filter(|&v| self.is_vertex(v))
    }

    /// The corners of the finite cells, positively oriented, in no particular order.
    pub fn finite_cells(&self) -> impl Iterator<Item = [u32; 4]> + '_ {
        let all = (0..).zip(self.growing.cells());
        let finite = all.filter(|&(cell, _)| self.growing.is_cell(cell));
        finite.map(|(_, cell)| cell.corners.map(|v| v - Growing::FIRST))
    }

    /// The triangulation as it is now, which answers more. Points have the same numbers; removed ones count as hidden.
    /// O(n log n).
    ///
    /// # Errors
    /// Out of memory.
    pub fn triangulation(&self) -> Result<Triangulation, TriangulationError> {
        let ghost = self.positions().len() as u32;
        let mut cells: Vec<Cell> = with_capacity(self.growing.cells().len())?;
        cells.extend(self.growing.cells().iter().map(|cell| match cell.corners[0] {
            DELETED => *cell,
            // The ghost, which is vertex 0, becomes the last.
            _ => Cell {
                corners: cell.corners.map(|v| v.checked_sub(Growing::FIRST).unwrap_or(ghost)),
                ..*cell
            },
        }));
        let mut positions = with_capacity(ghost as usize)?;
        positions.extend_from_slice(self.positions());
        let stands = |v: u32| self.at[&position_bits(self.growing.positions()[v as usize])];
        let duplicates = self.duplicates.iter();
        let duplicates = duplicates.map(|&v| [v, stands(v)].map(|v| v - Growing::FIRST)).collect();
        Triangulation::new(positions, CellArrays::of_cells(cells, ghost)?, duplicates)
    }
}

/// Weights, one for each point.
fn or_zeros<'a>(
    points: &[[f64; 3]],
    weights: Option<&'a [f64]>,
) -> Result<Cow<'a, [f64]>, TriangulationError> {
    Ok(match weights {
        Some(weights) => weights.into(),
        None => filled(points.len(), 0.0)?.into(),
    })
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;
    use crate::locate::tests::{Place, doubles};
    use crate::triangulate;

    /// Of many sets of integer points, some at one position, without weights, with few and with many different ones: what is
    /// left after insertions and removals is the triangulation of what is left.
    #[test]
    fn it_is_the_triangulation_of_its_points() {
        let mut random = Random::new(4);
        let (mut stayed, mut removed, mut hidden) = (0, 0, 0);
        for case in 0..600 {
            let (side, heaviest) = (2 + case % 4, [1, 3, 12][case / 4 % 3]);
            let mut some = |count| -> Vec<Place> {
                (0..count).map(|_| [0; 3].map(|_| random.below(side) as i64)).collect()
            };
            let (first, more) = (doubles(&some(12)), doubles(&some(20)));
            let mut weights =
                |count| -> Vec<f64> { (0..count).map(|_| random.below(heaviest) as f64).collect() };
            let (of_first, of_more) = (weights(12), weights(20));
            let (all, weights) = ([&first[..], &more].concat(), [&of_first[..], &of_more].concat());
            // Weights of 0 may be left out.
            let given = |from, to| (heaviest > 1).then_some(&weights[from..to]);
            let Ok(mut dynamic) = DynamicTriangulation::new(&first, given(0, 12)) else {
                continue;
            };
            assert_eq!(dynamic.insert(&more, given(12, 32)).unwrap(), 12..32);
            assert_eq!((dynamic.positions(), dynamic.weights()), (&all[..], &weights[..]));
            let mut there: Vec<u32> = (0..32).collect();
            hidden += agree(&dynamic, &there);
            let leave: Vec<u32> = (0..32).filter(|_| random.below(3) > 0).collect();
            let gone = dynamic.remove(&leave).unwrap();
            there.retain(|v| !leave.contains(v) || dynamic.is_vertex(*v));
            assert_eq!(there.len(), 32 - gone);
            (removed, stayed) = (removed + gone, stayed + leave.len() - gone);
            agree(&dynamic, &there);
            assert_eq!(dynamic.remove(&[32, u32::MAX]).unwrap(), 0);
            dynamic.insert(&all, given(0, 32)).unwrap();
            there.extend(32..64);
            agree(&dynamic, &there);
        }
        assert!(stayed > 10 && removed > 5000 && hidden > 500, "{stayed} {removed} {hidden}");
    }

    /// That `dynamic` is the triangulation of these points. Returns how many are hidden.
    fn agree(dynamic: &DynamicTriangulation, there: &[u32]) -> usize {
        let places: Vec<_> = there.iter().map(|&v| dynamic.positions()[v as usize]).collect();
        let weights: Vec<_> = there.iter().map(|&v| dynamic.weights()[v as usize]).collect();
        let expected = triangulate(&places, Some(&weights)).unwrap();
        let number = |v: u32| there[v as usize];
        assert!(dynamic.vertices().eq(expected.vertices().map(number)));
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
        let cells =
            sorted(expected.finite_cells().map(|(_, corners)| corners.map(number)).collect());
        assert_eq!(sorted(dynamic.finite_cells().collect()), cells);
        let frozen = dynamic.triangulation().unwrap();
        assert_eq!(sorted(frozen.finite_cells().map(|(_, corners)| corners).collect()), cells);
        let duplicates: Vec<_> =
            expected.duplicates().iter().map(|pair| pair.map(number)).collect();
        assert_eq!(frozen.duplicates(), duplicates);
        // Those that have been removed count as hidden.
        let hidden: Vec<_> = expected.hidden().iter().map(|&v| number(v)).collect();
        assert!(hidden.iter().all(|v| frozen.hidden().contains(v)));
        assert!(frozen.hull_facets().flatten().all(|v| frozen.is_vertex(v)));
        hidden.len()
    }

    /// The neighbours of a peak are in one plane, which others are beneath.
    #[test]
    fn a_peak_over_a_plane_leaves() {
        let base = (0..18).map(|i| [i % 3, i / 3 % 3, -i / 9].map(f64::from));
        let points: Vec<[f64; 3]> = base.chain([[1.0, 1.0, 5.0]]).collect();
        let mut dynamic = DynamicTriangulation::new(&points, None).unwrap();
        assert_eq!(dynamic.remove(&[18]).unwrap(), 1);
        agree(&dynamic, &(0..18).collect::<Vec<_>>());
        // Without any of these the rest is flat.
        let mut tetrahedron = DynamicTriangulation::new(
            &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            None,
        )
        .unwrap();
        assert_eq!(tetrahedron.remove(&[0, 1, 2, 3]).unwrap(), 0);
        agree(&tetrahedron, &[0, 1, 2, 3]);
    }

    /// The others are flat, but what a corner hides, or stands at its place, is not.
    #[test]
    fn what_comes_back_spans_the_volume() {
        let mut points = vec![[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];
        points.extend([[0.0, 0.0, 1.0], [0.0, 0.0, 4.0]]);
        let weights = [0.0, 0.0, 0.0, 9.0, -20.0, 0.0];
        let mut dynamic = DynamicTriangulation::new(&points, Some(&weights)).unwrap();
        assert!(dynamic.vertices().eq(0..4));
        assert_eq!(dynamic.remove(&[3]).unwrap(), 1);
        agree(&dynamic, &[0, 1, 2, 4, 5]);
        assert_eq!(dynamic.remove(&[5]).unwrap(), 1);
        assert!(dynamic.vertices().eq([0, 1, 2, 4]));
        agree(&dynamic, &[0, 1, 2, 4]);
        assert_eq!(dynamic.remove(&[4]).unwrap(), 0);
        agree(&dynamic, &[0, 1, 2, 4]);
    }

    #[test]
    fn bad_numbers_change_nothing() {
        let corners = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];
        let mut dynamic = DynamicTriangulation::new(&corners, None).unwrap();
        let error = dynamic.insert(&[[1.0; 3], [0.0, f64::NAN, 0.0]], None).unwrap_err();
        assert!(matches!(
            error,
            TriangulationError::Sites(SitesError::Value { index: 1, what: "y", .. })
        ));
        assert_eq!(dynamic.positions(), corners);
        assert!(DynamicTriangulation::new(&corners[..3], None).is_err());
    }
}
