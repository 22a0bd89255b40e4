use walpha_base::{Cancelled, Monitor};

use super::structure::Structure;
use super::{Extent, Finding, Points, geometry, hull, non_vertices};
use crate::Complex;

/// A complex with its simplices linked, and the rules of structure and geometry that it breaks.
pub(super) struct Linked<'a> {
    pub structure: Structure<'a>,
    /// Broken rules without which the others mean nothing.
    pub broken: Vec<Finding>,
    /// Findings on neighbours and hull, which are judged if `broken` is empty.
    pub irregular: Vec<Finding>,
}

impl<'a> Linked<'a> {
    pub(super) fn new(
        complex: &'a Complex,
        points: Points,
        extent: Extent,
        monitor: &Monitor,
    ) -> Result<Self, Cancelled> {
        let (structure, mut broken) = Structure::new(complex, points, &monitor.part(0, 4, 10))?;
        let cells = complex.cells.rows();
        broken.extend(geometry::orientations(cells, points, &monitor.part(4, 5, 10))?);
        let mut irregular = Vec::new();
        if broken.is_empty() {
            irregular.extend(geometry::neighbours(&structure, points, &monitor.part(5, 10, 10))?);
            if extent == Extent::Whole {
                irregular.extend(hull::convexity(&structure, points));
            }
        }
        Ok(Self { structure, broken, irregular })
    }

    /// Whether no vertex is inside the sphere of a neighbouring cell, and the hull of a whole triangulation is
    /// convex: then it is regular, up to the choice among ties.
    pub(super) fn is_regular(&self) -> bool {
        self.broken.is_empty() && self.irregular.iter().all(Finding::is_tie)
    }
}

/// All findings on cells as a whole triangulation of some points, such as those on one sphere.
pub(super) fn triangulation_findings(
    cells: &Complex,
    points: Points,
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    let linked = Linked::new(cells, points, Extent::Whole, monitor)?;
    let regular = linked.is_regular();
    let mut found = linked.broken;
    found.extend(hull::volume(&linked.structure, points, &monitor.unreported())?);
    found.extend(linked.irregular);
    if regular {
        let own: Vec<u32> = (0..points.len() as u32).collect();
        let hidden = non_vertices::hidden(&linked.structure, &own);
        found.extend(non_vertices::hiddenness(&linked.structure, points, &hidden, monitor)?);
    }
    Ok(found)
}
