use serde::{Deserialize, Serialize};
use walpha_base::vector::{cross, dot, length, sub};
use walpha_regular::Torus;

/// Volume and areas of a shape in the units of its points, summed exactly and rounded once. This struct is not
/// `#[non_exhaustive]` because it consists of plain numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measures {
    /// Volume of the interior cells.
    pub volume: f64,
    /// Area of the shape's surface: of its regular and singular facets. In a plane, where all facets are singular, the area of the shape.
    pub area: f64,
    /// Area of the regular facets: the boundary of the solid part.
    pub regular_area: f64,
    /// Area of the singular facets, one side of each.
    pub singular_area: f64,
}

/// The corners of a simplex; on a torus, the copies nearest to the first one.
#[inline]
pub(crate) fn together<const N: usize>(
    torus: Option<Torus>,
    corners: [[f64; 3]; N],
) -> [[f64; 3]; N] {
    torus.map_or(corners, |torus| torus.together(corners))
}

/// The area of a triangle.
pub fn facet_area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    length(cross(sub(b, a), sub(c, a))) / 2.0
}

/// Six times the volume of a positively oriented cell: a determinant, an integer on an integer lattice.
pub fn six_volumes([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
    dot(cross(sub(b, a), sub(c, a)), sub(d, a))
}
