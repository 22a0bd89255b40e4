//! Rules on cells and on pairs of neighbours.

use walpha_base::{Cancelled, Monitor};

use super::structure::{Half, Structure};
use super::{Finding, Points};
use crate::exact::{in_conflict, orientation, power_value, six_volume};
use crate::parallel::of_each;

/// Judges that each cell is positively oriented.
pub(super) fn orientations(
    cells: &[[u32; 4]],
    points: Points,
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    of_each(cells.len(), monitor, |i| {
        let corners = points.corners(cells[i]);
        let [a, b, c, d] = corners.map(|p| p.position);
        (!orientation(a, b, c, d).is_gt()).then(|| Finding::Orientation {
            cell: cells[i].into(),
            six_volumes: six_volume(corners.each_ref()),
        })
    })
}

/// Judges that the cells on a facet are on different sides of it, and neither is refuted by the other's
/// vertex. Cells must be positively oriented.
///
/// Over a convex domain this proves that the whole triangulation is regular: the lifted cells
/// then make a function that is convex across every facet, hence convex.
pub(super) fn neighbours(
    structure: &Structure,
    points: Points,
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    of_each(structure.sides.len(), monitor, |facet| {
        let mut halves = structure.halves(facet);
        let (one, other) = (halves.next()?, halves.next()?);
        overlap(structure, one, other).or_else(|| refuted(structure, points, one, other))
    })
}

fn overlap(structure: &Structure, one: Half, other: Half) -> Option<Finding> {
    let [a, b, c] = structure.outward(one);
    // Seen from its two sides, a facet turns in opposite directions.
    let same_turn = [[a, b, c], [b, c, a], [c, a, b]].contains(&structure.outward(other));
    let cell = |half: Half| structure.complex.cells.rows()[half.cell].into();
    same_turn.then(|| Finding::Overlap { facet: [a, b, c].into(), cells: [cell(one), cell(other)] })
}

fn refuted(structure: &Structure, points: Points, one: Half, other: Half) -> Option<Finding> {
    let cell = structure.complex.cells.rows()[one.cell];
    let point = structure.apex(other);
    let (corners, q) = (points.corners(cell), points.get(point));
    in_conflict(corners.each_ref(), &q).then(|| Finding::NotRegular {
        cell: cell.into(),
        point,
        power: power_value(corners.each_ref(), &q),
    })
}
