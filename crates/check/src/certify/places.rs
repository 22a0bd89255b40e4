//! Rules on points that are not vertices: duplicates and hidden points.

use rayon::prelude::*;

use super::emptiness::Emptiness;
use super::near::Grid;
use super::structure::{Half, Structure};
use super::{Finding, Points};
use crate::Alpha;
use crate::canonical::outward_facets;
use crate::exact::{in_conflict, orientation, power_value, radius, radius_value, six_volume};

/// For each point, the one that stays at its place: the heaviest, of equal weights the first.
pub(super) fn staying(points: Points) -> Vec<u32> {
    let place = |i: u32| points.positions[i as usize];
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let by_place = |a: u32, b: u32| place(a).partial_cmp(&place(b)).expect("no coordinate is NaN");
    let weight = |i: u32| points.weights[i as usize];
    order.par_sort_unstable_by(|&a, &b| {
        by_place(a, b).then(weight(b).total_cmp(&weight(a))).then(a.cmp(&b))
    });
    let mut stays = vec![0; order.len()];
    for same_place in order.chunk_by(|&a, &b| place(a) == place(b)) {
        for &i in same_place {
            stays[i as usize] = same_place[0];
        }
    }
    stays
}

/// Duplicates are not vertices, and the list of them, if there is one, is right.
pub(super) fn duplicates(
    structure: &Structure,
    stays: &[u32],
    listed: Option<&[[u32; 2]]>,
) -> Vec<Finding> {
    let vertices = structure.complex.vertices.rows().iter();
    let mut findings: Vec<_> = vertices
        .filter(|[v]| stays[*v as usize] != *v)
        .map(|&[point]| Finding::DuplicateVertex { point, stays: stays[point as usize] })
        .collect();
    let Some(listed) = listed else { return findings };
    let mut given = vec![None; stays.len()];
    for &[went, stayed] in listed {
        match given.get_mut(went as usize) {
            Some(slot @ None) => *slot = Some(stayed),
            // A point that does not exist, or is listed twice.
            _ => findings.push(Finding::Duplicate {
                point: went,
                given: Some(stayed),
                expected: None,
            }),
        }
    }
    for (point, given) in given.into_iter().enumerate() {
        let expected = Some(stays[point]).filter(|&stayed| stayed != point as u32);
        if given != expected {
            findings.push(Finding::Duplicate { point: point as u32, given, expected });
        }
    }
    findings
}

/// Which points are neither vertices nor duplicates, and whether `listed` lists just these.
pub(super) fn hidden(
    structure: &Structure,
    stays: &[u32],
    listed: Option<&[u32]>,
) -> (Vec<u32>, Vec<Finding>) {
    let mut accounted: Vec<bool> = (0..).zip(stays).map(|(i, &stayed)| stayed != i).collect();
    for [v] in structure.complex.vertices.rows() {
        accounted[*v as usize] = true;
    }
    let hidden = (0..).zip(&accounted).filter(|(_, known)| !**known).map(|(i, _)| i).collect();
    let Some(listed) = listed else { return (hidden, Vec::new()) };
    let mut findings = Vec::new();
    for &point in listed {
        match accounted.get_mut(point as usize) {
            Some(known @ false) => *known = true,
            _ => findings.push(Finding::NotOnlyHidden { point }),
        }
    }
    let unknown = (0..).zip(&accounted).filter(|(_, known)| !**known);
    findings.extend(unknown.map(|(point, _)| Finding::Unaccounted { point }));
    (hidden, findings)
}

/// In a shape alone: points listed as hidden are not vertices, and points that are in the shape by
/// themselves are.
///
/// A point whose sphere of squared radius −ω has all others strictly outside is below them all
/// once it is lifted, so it is a vertex of the regular triangulation; a tie may hide it.
pub(super) fn of_shape(
    structure: &Structure,
    points: Points,
    alpha: Alpha,
    emptiness: &Emptiness,
    stays: &[u32],
    listed: Option<&[u32]>,
) -> Vec<Finding> {
    let mut accounted: Vec<bool> = (0..).zip(stays).map(|(i, &stayed)| stayed != i).collect();
    for [v] in structure.complex.vertices.rows() {
        accounted[*v as usize] = true;
    }
    let missing = |&point: &u32| {
        let site = points.get(point);
        !accounted[point as usize] && radius([&site], alpha).is_le() && emptiness.alone(point)
    };
    let all = (0..points.len() as u32).into_par_iter();
    let finding = |point| {
        let radius_squared = radius_value([&points.get(point)]);
        Finding::MissingVertex { point, radius_squared }
    };
    let mut findings: Vec<_> = all.filter(missing).map(finding).collect();
    for &point in listed.unwrap_or_default() {
        match accounted.get_mut(point as usize) {
            Some(known @ false) => *known = true,
            _ => findings.push(Finding::NotOnlyHidden { point }),
        }
    }
    findings
}

/// Each hidden point is hidden: it does not refute the cell it lies in.
///
/// The lifted cells are a convex function, so a point above it where it lies is above it for good.
/// The cell is found by a walk from a vertex nearby, which ends because the cells of a regular
/// triangulation have no cycle in front of any point (Edelsbrunner, Combinatorica 10, 1990,
/// doi:10.1007/BF02122779). The triangulation must have been found regular and its hull convex.
pub(super) fn hiddenness(structure: &Structure, points: Points, hidden: &[u32]) -> Vec<Finding> {
    if hidden.is_empty() {
        return Vec::new();
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
    let grid = Grid::new(points.positions, vertices);
    let judge = |&point: &u32| {
        let q = points.get(point);
        let start = grid.some_near(q.position).map_or(0, |v| cell_of[v as usize]);
        match walk(structure, points, start, q.position) {
            Ok(cell) => {
                let corners = points.at(cells[cell]);
                in_conflict(corners.each_ref(), &q).then(|| Finding::NotHidden {
                    point,
                    cell: cells[cell].into(),
                    power: power_value(corners.each_ref(), &q),
                })
            }
            Err(facet) => {
                let [a, b, c] = points.at(facet);
                let six_volumes = six_volume([&a, &b, &c, &q]);
                Some(Finding::OutsideHull { point, facet: facet.into(), six_volumes })
            }
        }
    };
    hidden.par_iter().filter_map(judge).collect()
}

/// The cell that contains a place, or the facet of the hull that it is outside of.
fn walk(
    structure: &Structure,
    points: Points,
    start: usize,
    place: [f64; 3],
) -> Result<usize, [u32; 3]> {
    let mut cell = start;
    loop {
        let facets = outward_facets(structure.complex.cells.rows()[cell]);
        let beyond = |facet: &[u32; 3]| {
            let [a, b, c] = points.places(*facet);
            orientation(a, b, c, place).is_gt()
        };
        let Some(exit) = facets.iter().position(beyond) else { return Ok(cell) };
        let row = structure.cell_facets[cell][exit] as usize;
        match structure.halves(row).find(|half: &Half| half.cell != cell) {
            Some(next) => cell = next.cell,
            None => return Err(facets[exit]),
        }
    }
}
