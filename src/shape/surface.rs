use std::collections::BTreeSet;

use super::{AlphaShape, Class};

/// What can be seen of a shape: boundary facets and everything thinner, with its own compact
/// numbering of vertices.
///
/// If the points 4, 7, 8 and 9 are those on the boundary, `vertices` is `[4, 7, 8, 9]` and a facet
/// over the points 4, 9 and 8 is the row `[0, 3, 2]`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Surface {
    /// Input indices of the vertices used below, ascending.
    pub vertices: Vec<u32>,
    /// Regular facets, counter-clockwise seen from outside.
    pub regular: Vec<[u32; 3]>,
    /// Singular facets: no inside, no orientation.
    pub singular: Vec<[u32; 3]>,
    /// Singular edges.
    pub edges: Vec<[u32; 2]>,
    /// Singular vertices.
    pub points: Vec<u32>,
}

impl Surface {
    /// The surface of a shape. O(n log n).
    pub fn of(shape: &AlphaShape) -> Self {
        let complex = shape.complex();
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
        let number =
            |v: u32| vertices.binary_search(&v).expect("every vertex used was collected") as u32;
        Self {
            regular: regular.into_iter().map(|row| row.map(number)).collect(),
            singular: singular.into_iter().map(|row| row.map(number)).collect(),
            edges: edges.into_iter().map(|row| row.map(number)).collect(),
            points: points.into_iter().map(|[v]| number(v)).collect(),
            vertices,
        }
    }

    /// Regular facets, then singular ones.
    pub fn facets(&self) -> impl Iterator<Item = &[u32; 3]> {
        self.regular.iter().chain(&self.singular)
    }
}
