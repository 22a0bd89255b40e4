use serde::{Deserialize, Serialize};

/// What a simplex of the regular triangulation is to the shape, as in CGAL's
/// `Fixed_alpha_shape_3::Classification_type`. Cells are only [`Class::Interior`] or
/// [`Class::Exterior`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[repr(u8)]
pub enum Class {
    /// Not in the shape.
    Exterior = 0,
    /// In the shape, and not on its boundary.
    Interior = 1,
    /// On the boundary of the shape, and a face of a higher simplex of the shape.
    Regular = 2,
    /// In the shape, and a face of no other simplex of the shape.
    Singular = 3,
}

impl Class {
    /// All classes, in the order of their numbers.
    pub const ALL: [Self; 4] = [Self::Exterior, Self::Interior, Self::Regular, Self::Singular];
}

/// Simplices of one dimension: `N` vertices each, by input index, and their classes.
///
/// A facet over the input points 7, 2 and 5 is the row `[2, 5, 7]` when its winding means
/// nothing; a regular facet that must be seen as 7 → 5 → 2 from outside is `[2, 7, 5]`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Simplices<const N: usize> {
    /// Input indices of the vertices, a row each.
    pub vertices: Vec<[u32; N]>,
    /// The class of each row.
    pub classes: Vec<Class>,
}

impl<const N: usize> Simplices<N> {
    /// The number of simplices.
    pub fn len(&self) -> usize {
        self.vertices.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }

    /// Each simplex with its class.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&[u32; N], Class)> + '_ {
        self.vertices.iter().zip(self.classes.iter().copied())
    }

    /// The simplices of one class.
    pub fn of(&self, class: Class) -> impl Iterator<Item = &[u32; N]> + '_ {
        self.iter().filter(move |&(_, c)| c == class).map(|(row, _)| row)
    }

    /// How many simplices there are of each class, indexed by the class's number.
    pub fn counts(&self) -> [usize; 4] {
        let mut counts = [0; 4];
        for &class in &self.classes {
            counts[class as usize] += 1;
        }
        counts
    }

    /// How many of these are in the shape, by class.
    pub fn by_class(&self) -> ByClass {
        let counts = self.counts();
        let [interior, regular, singular] =
            [Class::Interior, Class::Regular, Class::Singular].map(|class| counts[class as usize]);
        ByClass { interior, regular, singular }
    }

    fn retain_shape(&mut self) {
        let mut classes = self.classes.iter();
        self.vertices.retain(|_| classes.next() != Some(&Class::Exterior));
        self.classes.retain(|&class| class != Class::Exterior);
    }
}

/// How many simplices of one dimension a shape has, by class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ByClass {
    /// Inside.
    pub interior: usize,
    /// On the boundary of something higher.
    pub regular: usize,
    /// On their own.
    pub singular: usize,
}

impl ByClass {
    /// All of them.
    pub fn total(&self) -> usize {
        self.interior + self.regular + self.singular
    }
}

/// A classified simplicial complex over indexed points: the plain result type, which engines
/// return, writers write and the checker judges.
///
/// **Canonical order.** Cells are positively oriented (a, b, c turn counter-clockwise seen
/// from d: det(b−a, c−a, d−a) > 0) and regular
/// facets turn counter-clockwise seen from outside; each is written as the lexicographically
/// smallest even permutation of its vertices. All other simplices are sorted. Rows are in
/// lexicographic order. So equal complexes are equal byte by byte.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Complex {
    /// Tetrahedra.
    pub cells: Simplices<4>,
    /// Triangles.
    pub facets: Simplices<3>,
    /// Edges.
    pub edges: Simplices<2>,
    /// Vertices of the triangulation; points that are hidden or duplicates are none.
    pub vertices: Simplices<1>,
}

impl Complex {
    /// Drops exterior simplices.
    pub(super) fn retain_shape(&mut self) {
        self.cells.retain_shape();
        self.facets.retain_shape();
        self.edges.retain_shape();
        self.vertices.retain_shape();
    }
}
