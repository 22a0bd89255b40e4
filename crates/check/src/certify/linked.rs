use super::structure::Structure;
use super::{Extent, Finding, Points, geometry, hull};
use crate::Complex;

/// A complex with its simplices linked, and which rules of structure and geometry it breaks.
pub(super) struct Linked<'a> {
    pub structure: Structure<'a>,
    /// Rules without which the others mean nothing.
    pub broken: Vec<Finding>,
    /// Neighbours and hull, judged if nothing is broken.
    pub irregular: Vec<Finding>,
}

impl<'a> Linked<'a> {
    pub(super) fn new(complex: &'a Complex, points: Points, extent: Extent) -> Self {
        let (structure, mut broken) = Structure::new(complex, points);
        broken.extend(geometry::orientations(complex.cells.rows(), points));
        let mut irregular = Vec::new();
        if broken.is_empty() {
            irregular.extend(geometry::neighbours(&structure, points));
            if extent == Extent::Whole {
                irregular.extend(hull::convexity(&structure, points));
            }
        }
        Self { structure, broken, irregular }
    }

    /// Whether no point is inside the sphere of a neighbour, and the hull of a whole triangulation is
    /// convex: it is regular then, but for the choice among ties.
    pub(super) fn is_regular(&self) -> bool {
        self.broken.is_empty() && self.irregular.iter().all(Finding::is_tie)
    }
}
