//! Complexes: the plain data type that engines return, writers write and the checker judges.

use crate::{Alpha, Class, Simplices};

/// A classified simplicial complex over indexed points.
///
/// **Canonical order.** Cells are positively oriented (a, b, c turn counter-clockwise, as seen from d: det(b−a, c−a, d−a) > 0)
/// and regular facets turn counter-clockwise, as seen from outside; each is written as the lexicographically smallest even
/// permutation of its vertices. All other simplices are sorted. Rows are in lexicographic order. So equal complexes are equal
/// byte by byte.
///
/// The fields are public, so that any program can make a complex; [`canonical`](crate::canonical) puts it in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Complex {
    /// Tetrahedra.
    pub cells: Simplices<4>,
    /// Triangles.
    pub facets: Simplices<3>,
    /// Edges.
    pub edges: Simplices<2>,
    /// Vertices of the triangulation, without the points that are hidden or duplicates.
    pub vertices: Simplices<1>,
}

impl Complex {
    /// Drops exterior simplices.
    pub fn retain_shape(&mut self) {
        self.cells.retain_shape();
        self.facets.retain_shape();
        self.edges.retain_shape();
        self.vertices.retain_shape();
    }

    /// The Euler characteristic of the shape: vertices − edges + facets − cells, without exterior
    /// simplices.
    pub fn euler_characteristic(&self) -> i64 {
        fn inside<const N: usize>(simplices: &Simplices<N>) -> i64 {
            simplices.counts().in_shape() as i64
        }
        inside(&self.vertices) - inside(&self.edges) + inside(&self.facets) - inside(&self.cells)
    }

    /// Whether any simplex is exterior: the complex then claims to be a whole triangulation.
    pub fn lists_exterior(&self) -> bool {
        self.cells.classes().contains(&Class::Exterior)
            || self.facets.classes().contains(&Class::Exterior)
            || self.edges.classes().contains(&Class::Exterior)
            || self.vertices.classes().contains(&Class::Exterior)
    }
}

/// A complex with its weighted points and α, to be judged or compared. The fields are public because these four determine it.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// x, y, z of each input point.
    pub positions: &'a [[f64; 3]],
    /// The power weight of each, a squared length.
    pub weights: &'a [f64],
    /// α.
    pub alpha: Alpha,
    /// The complex, by input indices.
    pub complex: &'a Complex,
}

impl<'a> Placed<'a> {
    /// A complex over points with these weights, at α. Consistency is not checked here, but by the functions that judge or
    /// compare it.
    pub fn new(
        positions: &'a [[f64; 3]],
        weights: &'a [f64],
        alpha: Alpha,
        complex: &'a Complex,
    ) -> Self {
        Self { positions, weights, alpha, complex }
    }

    /// Another complex over the same points, at the same α.
    #[must_use]
    pub fn with_complex(self, complex: &'a Complex) -> Self {
        Self { complex, ..self }
    }
}
