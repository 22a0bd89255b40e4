use std::collections::BTreeSet;

use super::{Class, Complex};

/// The visible part of a shape: regular facets and all singular simplices, with a compact numbering of their
/// vertices.
///
/// If the boundary has the points 4, 7, 8 and 9, `vertices` is `[4, 7, 8, 9]` and a facet
/// over the points 4, 9 and 8 is the row `[0, 3, 2]`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Surface {
    /// Input indices of the vertices used below, ascending.
    pub vertices: Vec<u32>,
    /// Further vertices, each the midpoint of two of those; of a [solid](crate::AlphaShape::solid) only.
    pub midpoints: Vec<[u32; 2]>,
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
        let used: BTreeSet<u32> = (regular.as_flattened().iter())
            .chain(singular.as_flattened())
            .chain(edges.as_flattened())
            .chain(points.as_flattened())
            .copied()
            .collect();
        let vertices: Vec<u32> = used.into_iter().collect();
        let number = |v: u32| vertices.partition_point(|&used| used < v) as u32;
        Self {
            regular: regular.into_iter().map(|row| row.map(number)).collect(),
            singular: singular.into_iter().map(|row| row.map(number)).collect(),
            edges: edges.into_iter().map(|row| row.map(number)).collect(),
            points: points.into_iter().map(|[v]| number(v)).collect(),
            vertices,
            midpoints: Vec::new(),
        }
    }

    /// Regular facets, then singular ones.
    pub fn facets(&self) -> impl Iterator<Item = &[u32; 3]> {
        self.regular.iter().chain(&self.singular)
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
        let at = |v: u32| of_input[self.vertices[v as usize] as usize];
        let mean = move |ends: &[u32; 2]| {
            let (a, b) = (at(ends[0]), at(ends[1]));
            [0, 1, 2].map(|k| a[k] / 2.0 + b[k] / 2.0)
        };
        self.vertices.iter().map(|&v| of_input[v as usize]).chain(self.midpoints.iter().map(mean))
    }

    /// Each edge of each regular facet, smaller end first, with the corners of the facet at its ends
    /// as 3·row + corner. Sorted.
    pub(super) fn sides(&self) -> Vec<([u32; 2], [u32; 2])> {
        let mut sides: Vec<([u32; 2], [u32; 2])> = Vec::with_capacity(3 * self.regular.len());
        for (facet, row) in self.regular.iter().enumerate() {
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                let corner = |i: usize| (3 * facet + i) as u32;
                let (mut ends, mut corners) = ([row[i], row[j]], [corner(i), corner(j)]);
                if ends[0] > ends[1] {
                    ends.reverse();
                    corners.reverse();
                }
                sides.push((ends, corners));
            }
        }
        sides.sort_unstable();
        sides
    }
}
