//! Rules on points that are not vertices: duplicates and hidden points.

use std::cell::RefCell;
use std::collections::BTreeMap;

use walpha_base::parallel::prelude::*;
use walpha_base::{Cancelled, Monitor};
use walpha_complex::canonical::outward_facets;

use super::claim::Claim;
use super::finding::Finding;
use super::grid::Grid;
use super::structure::{Half, Points, Structure};
use crate::Complex;
use crate::exact::{in_conflict, orientation, power_value, six_volume};
use crate::parallel::of_each;

/// For each point, the one that the rule keeps at its position: the heaviest, and of equal weights the first.
fn by_rule(points: Points) -> Vec<u32> {
    let position = |i: u32| points.position(i);
    let weight = |i: u32| points.weight(i);
    // Equal positions have equal keys, and others hardly ever.
    let key = |i: u32| {
        // −0 + 0 is 0.
        let digits = position(i).map(|x| (x + 0.0).to_bits());
        digits.into_iter().fold(0u64, |key, digits| {
            (key.rotate_left(23) ^ digits).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        })
    };
    let mut order: Vec<(u64, u32)> =
        (0..points.len() as u32).into_par_iter().map(|i| (key(i), i)).collect();
    order.par_sort_unstable();
    let mut kept: Vec<u32> = (0..points.len() as u32).collect();
    for alike in order.chunk_by_mut(|one, other| one.0 == other.0).filter(|alike| alike.len() > 1) {
        alike.sort_unstable_by(|&(_, a), &(_, b)| {
            let by_position = position(a).partial_cmp(&position(b)).expect("no coordinate is NaN");
            // `total_cmp` is unsuitable because it puts −0 before 0.
            let heavier = weight(b).partial_cmp(&weight(a)).expect("no weight is NaN");
            by_position.then(heavier).then(a.cmp(&b))
        });
        for coincident in alike.chunk_by(|one, other| position(one.1) == position(other.1)) {
            for &(_, i) in coincident {
                kept[i as usize] = coincident[0].1;
            }
        }
    }
    kept
}

/// For each point, the one kept at its position, and findings if it is not the one that the rule selects.
///
/// Of points with equal positions and weights, any one may be kept: the one that is a vertex, or otherwise the one that the list
/// of duplicates names.
pub(super) fn kept_points(
    points: Points,
    complex: &Complex,
    listed: Option<&[[u32; 2]]>,
) -> (Vec<u32>, Vec<Finding>) {
    let by_rule = by_rule(points);
    let weight = |i: u32| points.weight(i);
    let mut is_vertex = vec![false; by_rule.len()];
    complex.vertices.rows().iter().for_each(|[v]| is_vertex[*v as usize] = true);
    let vertices = complex.vertices.rows().iter().map(|&[v]| v);
    let named = listed.unwrap_or_default().iter().map(|&[_, kept]| kept);
    let mut instead = BTreeMap::new();
    for point in vertices.chain(named) {
        let Some(&first) = by_rule.get(point as usize) else { continue };
        if first != point && weight(first) == weight(point) && !is_vertex[first as usize] {
            instead.entry(first).or_insert(point);
        }
    }
    let kept = by_rule.into_iter().map(|first| *instead.get(&first).unwrap_or(&first)).collect();
    let equal = |(first, point)| Finding::EqualPoint { point, first };
    (kept, instead.into_iter().map(equal).collect())
}

/// The points that are kept at their positions.
pub(super) fn distinct(kept: &[u32]) -> impl Iterator<Item = u32> {
    (0..).zip(kept).filter(|(i, kept)| *i == **kept).map(|(i, _)| i)
}

/// Judges that duplicates are not vertices, and that their list, if there is one, is right.
pub(super) fn duplicates(
    structure: &Structure,
    kept: &[u32],
    listed: Option<&[[u32; 2]]>,
) -> Vec<Finding> {
    let vertices = structure.complex.vertices.rows().iter();
    let mut findings: Vec<_> = vertices
        .filter(|[v]| kept[*v as usize] != *v)
        .map(|&[point]| Finding::DuplicateVertex { point, kept: kept[point as usize] })
        .collect();
    let Some(listed) = listed else { return findings };
    let mut given = vec![None; kept.len()];
    for &[removed, kept] in listed {
        match given.get_mut(removed as usize) {
            Some(slot @ None) => *slot = Some(kept),
            // A point that does not exist, or is listed twice.
            _ => findings.push(Finding::Duplicate {
                point: removed,
                given: Some(kept),
                expected: None,
            }),
        }
    }
    for (point, given) in given.into_iter().enumerate() {
        let expected = Some(kept[point]).filter(|&kept| kept != point as u32);
        if given != expected {
            findings.push(Finding::Duplicate { point: point as u32, given, expected });
        }
    }
    findings
}

/// The status of a point in a claim.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Status {
    /// The claim does not contain it so far.
    Unaccounted,
    /// It is a vertex, or a listed hidden point.
    Accounted,
    /// Another point is kept at its position.
    Duplicate,
}

/// The points that are neither vertices nor duplicates.
pub(super) fn hidden(structure: &Structure, kept: &[u32]) -> Vec<u32> {
    let statuses = statuses(structure, kept);
    (0..)
        .zip(statuses)
        .filter(|(_, status)| *status == Status::Unaccounted)
        .map(|(i, _)| i)
        .collect()
}

fn statuses(structure: &Structure, kept: &[u32]) -> Vec<Status> {
    let of = |(i, &kept): (u32, &u32)| {
        if kept == i { Status::Unaccounted } else { Status::Duplicate }
    };
    let mut statuses: Vec<_> = (0..).zip(kept).map(of).collect();
    for [v] in structure.complex.vertices.rows() {
        statuses[*v as usize] = Status::Accounted;
    }
    statuses
}

/// Judges that the list of hidden points, if there is one, names only hidden points. Without a list of duplicates it may name
/// those, too.
fn listed_hidden(statuses: &mut [Status], claim: &Claim) -> Vec<Finding> {
    let mut findings = Vec::new();
    for &point in claim.hidden.unwrap_or_default() {
        match statuses.get_mut(point as usize) {
            Some(status @ Status::Unaccounted) => *status = Status::Accounted,
            Some(status @ Status::Duplicate) if claim.duplicates.is_none() => {
                *status = Status::Accounted;
            }
            _ => findings.push(Finding::NotOnlyHidden { point }),
        }
    }
    findings
}

/// Judges a whole triangulation: the list of hidden points, if there is one, has exactly the points that are neither vertices nor
/// duplicates.
pub(super) fn of_whole(structure: &Structure, kept: &[u32], claim: &Claim) -> Vec<Finding> {
    let mut statuses = statuses(structure, kept);
    let mut findings = listed_hidden(&mut statuses, claim);
    if claim.hidden.is_some() {
        let unaccounted =
            (0..).zip(&statuses).filter(|(_, status)| **status == Status::Unaccounted);
        findings.extend(unaccounted.map(|(point, _)| Finding::Unaccounted { point }));
    }
    findings
}

/// Judges a shape alone: points listed as hidden are not vertices.
pub(super) fn of_shape(structure: &Structure, kept: &[u32], claim: &Claim) -> Vec<Finding> {
    listed_hidden(&mut statuses(structure, kept), claim)
}

/// Judges that each hidden point is hidden: it does not refute the cell that contains it.
///
/// The lifted cells are a convex function, so a point that lies above it in its own cell lies above the whole lower hull.
/// The cell is found by a walk from a vertex nearby, which ends in a regular triangulation because its
/// cells have no cycle in front of any point (Edelsbrunner, Combinatorica 10, 1990,
/// doi:10.1007/BF02122779). The triangulation must have been found regular up to ties, and its hull convex.
pub(super) fn hiddenness(
    structure: &Structure,
    points: Points,
    hidden: &[u32],
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    if hidden.is_empty() {
        return Ok(Vec::new());
    }
    let cells = structure.complex.cells.rows();
    let mut cell_of = vec![0; points.len()];
    let mut is_vertex = vec![false; points.len()];
    for (i, cell) in cells.iter().enumerate() {
        for &v in cell {
            cell_of[v as usize] = i;
            is_vertex[v as usize] = true;
        }
    }
    let vertices = (0..points.len() as u32).filter(|&i| is_vertex[i as usize]).collect();
    let grid = Grid::new(points, vertices);
    of_each(hidden.len(), monitor, |i| {
        let point = hidden[i];
        let q = points.get(point);
        let start = grid.some_near(q.position).map_or(0, |v| cell_of[v as usize]);
        match walk(structure, points, start, q.position) {
            Ok(cell) => not_hidden(points, cells[cell], point),
            Err(facet) => {
                let [a, b, c] = points.corners(facet);
                let six_volumes = six_volume([&a, &b, &c, &q]);
                Some(Finding::OutsideHull { point, facet: facet.into(), six_volumes })
            }
        }
    })
}

/// Like [`hiddenness`], for hidden points in cells that fill all of space around a box: each cell tests the points in it.
pub(super) fn hiddenness_in_cells(
    structure: &Structure,
    points: Points,
    hidden: &[u32],
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    if hidden.is_empty() {
        return Ok(Vec::new());
    }
    let cells = structure.complex.cells.rows();
    let grid = Grid::new(points, hidden.to_vec());
    of_each(cells.len(), monitor, |i| {
        let found = RefCell::new(Vec::new());
        in_cell(&grid, points, cells[i], |point| {
            found.borrow_mut().extend(not_hidden(points, cells[i], point));
            None::<()>
        });
        found.take()
    })
}

/// Calls `visit` with every point of the grid that lies in a cell, including its surface, and is not a corner of it, until it
/// returns a value.
pub(super) fn in_cell<T>(
    grid: &Grid,
    points: Points,
    cell: [u32; 4],
    visit: impl Fn(u32) -> Option<T>,
) -> Option<T> {
    let corners = points.positions_of(cell);
    let low = [0, 1, 2].map(|k| corners.iter().fold(f64::INFINITY, |low, p| low.min(p[k])));
    let high = [0, 1, 2].map(|k| corners.iter().fold(f64::NEG_INFINITY, |high, p| high.max(p[k])));
    grid.between(low, high, |point| {
        let position = points.position(point);
        let near = (0..3).all(|k| low[k] <= position[k] && position[k] <= high[k]);
        let held = near && !cell.contains(&point) && holds(points, cell, position);
        if held { visit(point) } else { None }
    })
}

/// The finding for a point that refutes the cell that contains it.
fn not_hidden(points: Points, cell: [u32; 4], point: u32) -> Option<Finding> {
    let (corners, q) = (points.corners(cell), points.get(point));
    in_conflict(corners.each_ref(), &q).then(|| Finding::NotHidden {
        point,
        cell: cell.into(),
        power: power_value(corners.each_ref(), &q),
    })
}

/// Whether a position is in a cell, including its surface.
fn holds(points: Points, cell: [u32; 4], position: [f64; 3]) -> bool {
    !outward_facets(cell).iter().any(|facet| beyond(points, *facet, position))
}

/// Whether a position is on the outer side of a facet.
fn beyond(points: Points, facet: [u32; 3], position: [f64; 3]) -> bool {
    let [a, b, c] = points.positions_of(facet);
    orientation(a, b, c, position).is_gt()
}

/// The cell that contains a position, or a facet of the hull beyond which the position lies.
///
/// Among cells on one sphere a walk may cycle, because an arbitrary choice among ties need not be the projection of a convex
/// surface: then all cells are searched.
fn walk(
    structure: &Structure,
    points: Points,
    start: usize,
    position: [f64; 3],
) -> Result<usize, [u32; 3]> {
    let cells = structure.complex.cells.rows();
    let beyond = |facet: &[u32; 3]| beyond(points, *facet, position);
    let mut cell = start;
    for _ in 0..cells.len() {
        let facets = outward_facets(cells[cell]);
        let Some(exit) = facets.iter().position(beyond) else { return Ok(cell) };
        let row = structure.cell_facets[cell][exit] as usize;
        match structure.halves(row).find(|half: &Half| half.cell != cell) {
            Some(next) => cell = next.cell,
            None => return Err(facets[exit]),
        }
    }
    match cells.iter().position(|&cell| holds(points, cell, position)) {
        Some(cell) => Ok(cell),
        None => Err(*structure.hull().iter().find(|facet| beyond(facet)).expect("a convex hull")),
    }
}
