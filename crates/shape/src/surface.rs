use walpha_base::parallel::prelude::*;

use super::{Class, Complex};

/// The side of a facet at an edge: the ends of the edge, the smaller one first, and the corners of the facet there, as 3·row + corner.
pub(super) type Side = ([u32; 2], [u32; 2]);

/// Number of sides that are sorted at the same time, 256 MiB.
const AT_ONCE: usize = 1 << 24;

/// The visible part of a shape: regular facets and all singular simplices, with a compact numbering of their
/// vertices.
///
/// If the boundary has the points 4, 7, 8 and 9, `vertices` is `[4, 7, 8, 9]` and a facet
/// over the points 4, 9 and 8 is the row `[0, 3, 2]`.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Surface {
    /// Input indices of the vertices used below, ascending.
    pub vertices: Vec<u32>,
    /// Further vertices, each the midpoint of two of those; only in a [solid](crate::AlphaShape::solid).
    pub midpoints: Vec<[u32; 2]>,
    /// Vertices that are not at the positions of their input, ascending, with their positions; only in a solid.
    pub moved: Vec<(u32, [f64; 3])>,
    /// Regular facets, counter-clockwise seen from outside.
    pub regular: Vec<[u32; 3]>,
    /// Singular facets, which have no orientation.
    pub singular: Vec<[u32; 3]>,
    /// Singular edges.
    pub edges: Vec<[u32; 2]>,
    /// Singular vertices.
    pub points: Vec<u32>,
}

impl Surface {
    /// The surface of a complex, or of some of its simplices. O(n log n).
    pub fn of_complex(complex: &Complex) -> Self {
        let regular: Vec<_> = complex.facets.of(Class::Regular).copied().collect();
        let singular: Vec<_> = complex.facets.of(Class::Singular).copied().collect();
        let edges: Vec<_> = complex.edges.of(Class::Singular).copied().collect();
        let points: Vec<_> = complex.vertices.of(Class::Singular).copied().collect();
        let mut vertices = [
            regular.as_flattened(),
            singular.as_flattened(),
            edges.as_flattened(),
            points.as_flattened(),
        ]
        .concat();
        vertices.par_sort_unstable();
        vertices.dedup();
        vertices.shrink_to_fit();
        let number = |v: u32| vertices.partition_point(|&used| used < v) as u32;
        Self {
            regular: regular.into_iter().map(|row| row.map(number)).collect(),
            singular: singular.into_iter().map(|row| row.map(number)).collect(),
            edges: edges.into_iter().map(|row| row.map(number)).collect(),
            points: points.into_iter().map(|[v]| number(v)).collect(),
            vertices,
            midpoints: Vec::new(),
            moved: Vec::new(),
        }
    }

    /// Regular facets, then singular ones.
    pub fn facets(&self) -> impl Iterator<Item = &[u32; 3]> {
        self.regular.iter().chain(&self.singular)
    }

    /// The sides of all facets, those of two facets twice, then the singular edges.
    pub fn sides(&self) -> impl Iterator<Item = [u32; 2]> {
        let sides = self.facets().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        sides.chain(self.edges.iter().copied())
    }

    /// The number of vertices, midpoints included.
    pub fn vertex_count(&self) -> usize {
        self.vertices.len() + self.midpoints.len()
    }

    /// Input indices of all vertices; for a midpoint, that of one of its ends.
    pub fn indices(&self) -> impl Iterator<Item = u32> {
        let end = |ends: &[u32; 2]| self.vertices[ends[0] as usize];
        self.vertices.iter().copied().chain(self.midpoints.iter().map(end))
    }

    /// Values (F or weights) of all vertices, from those of the input; a midpoint has the mean of its ends.
    pub fn numbers(&self, of_input: &[f64]) -> impl Iterator<Item = f64> {
        let at = |v: u32| of_input[self.vertices[v as usize] as usize];
        let mean = move |ends: &[u32; 2]| at(ends[0]) / 2.0 + at(ends[1]) / 2.0;
        self.vertices.iter().map(|&v| of_input[v as usize]).chain(self.midpoints.iter().map(mean))
    }

    /// Positions of all vertices, from those of the input.
    pub fn positions(&self, of_input: &[[f64; 3]]) -> impl Iterator<Item = [f64; 3]> {
        let mut moved = self.moved.iter().peekable();
        (0..).zip(self.unmoved(of_input)).map(move |(v, place)| {
            moved.next_if(|moved| moved.0 == v).map_or(place, |moved| moved.1)
        })
    }

    /// Positions of all vertices before any moved.
    pub(super) fn unmoved(&self, of_input: &[[f64; 3]]) -> impl Iterator<Item = [f64; 3]> {
        let at = |v: u32| of_input[self.vertices[v as usize] as usize];
        let mean = move |ends: &[u32; 2]| {
            let (a, b) = (at(ends[0]), at(ends[1]));
            [0, 1, 2].map(|k| a[k] / 2.0 + b[k] / 2.0)
        };
        self.vertices.iter().map(|&v| of_input[v as usize]).chain(self.midpoints.iter().map(mean))
    }

    /// Calls `visit` with the sides of regular facets at each edge, in the order of edges. They are sorted for some edges at a
    /// time, so that large surfaces take little memory. O(n log n).
    pub(super) fn each_edge(&self, mut visit: impl FnMut(&[Side])) {
        let parts = (3 * self.regular.len()).div_ceil(AT_ONCE).max(1);
        let step = self.vertex_count().div_ceil(parts).max(1);
        for first in (0..self.vertex_count()).step_by(step) {
            let range = first as u32..(first + step) as u32;
            let of_facet = |(facet, row): (usize, &[u32; 3])| {
                let (row, range) = (*row, range.clone());
                let sides = [(0, 1), (1, 2), (2, 0)].into_iter().map(move |(i, j)| {
                    let corner = |i: usize| (3 * facet + i) as u32;
                    if row[i] < row[j] {
                        ([row[i], row[j]], [corner(i), corner(j)])
                    } else {
                        ([row[j], row[i]], [corner(j), corner(i)])
                    }
                });
                sides.filter(move |(ends, _)| range.contains(&ends[0]))
            };
            let mut sides: Vec<Side> =
                self.regular.par_iter().coarse().enumerate().flat_map_iter(of_facet).collect();
            sides.par_sort_unstable();
            sides.chunk_by(|a, b| a.0 == b.0).for_each(&mut visit);
        }
    }
}
