//! Rules on points that are not vertices: duplicates and hidden points.

use std::collections::BTreeMap;

use rayon::prelude::*;
use walpha_complex::canonical::outward_facets;

use super::emptiness::Emptiness;
use super::near::Grid;
use super::structure::{Half, Structure};
use super::{Claim, Finding, Points};
use crate::Complex;
use crate::exact::{in_conflict, orientation, power_value, radius, radius_value, six_volume};

/// For each point, the one that stays at its place by the rule: the heaviest, of equal weights the first.
fn by_rule(points: Points) -> Vec<u32> {
    let place = |i: u32| points.positions[i as usize];
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let by_place = |a: u32, b: u32| place(a).partial_cmp(&place(b)).expect("no coordinate is NaN");
    let weight = |i: u32| points.weights[i as usize];
    order.par_sort_unstable_by(|&a, &b| {
        // Not `total_cmp`, to which −0 is less than 0.
        let heavier = weight(b).partial_cmp(&weight(a)).expect("no weight is NaN");
        by_place(a, b).then(heavier).then(a.cmp(&b))
    });
    let mut stays = vec![0; order.len()];
    for same_place in order.chunk_by(|&a, &b| place(a) == place(b)) {
        for &i in same_place {
            stays[i as usize] = same_place[0];
        }
    }
    stays
}

/// For each point, the one that stays at its place, and where that is another than the rule names.
///
/// Of points with equal places and weights any may stay: the one that is a vertex does, or else the one
/// that the list of duplicates names.
pub(super) fn staying(
    points: Points,
    complex: &Complex,
    listed: Option<&[[u32; 2]]>,
) -> (Vec<u32>, Vec<Finding>) {
    let by_rule = by_rule(points);
    let weight = |i: u32| points.weights[i as usize];
    let mut is_vertex = vec![false; by_rule.len()];
    complex.vertices.rows().iter().for_each(|[v]| is_vertex[*v as usize] = true);
    let vertices = complex.vertices.rows().iter().map(|&[v]| v);
    let named = listed.unwrap_or_default().iter().map(|&[_, stayed]| stayed);
    let mut instead = BTreeMap::new();
    for point in vertices.chain(named) {
        let Some(&first) = by_rule.get(point as usize) else { continue };
        if first != point && weight(first) == weight(point) && !is_vertex[first as usize] {
            instead.entry(first).or_insert(point);
        }
    }
    let stays = by_rule.into_iter().map(|first| *instead.get(&first).unwrap_or(&first)).collect();
    let equal = |(first, point)| Finding::EqualPoint { point, first };
    (stays, instead.into_iter().map(equal).collect())
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

/// What a complex says of each point that is not a vertex.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Standing {
    /// Nothing yet.
    Unknown,
    /// A vertex, or listed as hidden.
    Known,
    /// Another one stays at its place.
    Duplicate,
}

/// Which points are neither vertices nor duplicates.
pub(super) fn hidden(structure: &Structure, stays: &[u32]) -> Vec<u32> {
    let standings = standings(structure, stays);
    (0..).zip(standings).filter(|(_, known)| *known == Standing::Unknown).map(|(i, _)| i).collect()
}

fn standings(structure: &Structure, stays: &[u32]) -> Vec<Standing> {
    let of = |(i, &stayed): (u32, &u32)| {
        if stayed == i { Standing::Unknown } else { Standing::Duplicate }
    };
    let mut standings: Vec<_> = (0..).zip(stays).map(of).collect();
    for [v] in structure.complex.vertices.rows() {
        standings[*v as usize] = Standing::Known;
    }
    standings
}

/// The list of hidden points, if there is one, names none that is anything else. It may name duplicates
/// where these have no list of their own.
fn listed_hidden(standings: &mut [Standing], claim: &Claim) -> Vec<Finding> {
    let mut findings = Vec::new();
    for &point in claim.hidden.unwrap_or_default() {
        match standings.get_mut(point as usize) {
            Some(standing @ Standing::Unknown) => *standing = Standing::Known,
            Some(standing @ Standing::Duplicate) if claim.duplicates.is_none() => {
                *standing = Standing::Known;
            }
            _ => findings.push(Finding::NotOnlyHidden { point }),
        }
    }
    findings
}

/// In a whole triangulation: the list of hidden points, if there is one, has just those that are neither
/// vertices nor duplicates.
pub(super) fn of_whole(structure: &Structure, stays: &[u32], claim: &Claim) -> Vec<Finding> {
    let mut standings = standings(structure, stays);
    let mut findings = listed_hidden(&mut standings, claim);
    if claim.hidden.is_some() {
        let unknown = (0..).zip(&standings).filter(|(_, known)| **known == Standing::Unknown);
        findings.extend(unknown.map(|(point, _)| Finding::Unaccounted { point }));
    }
    findings
}

/// In a shape alone: points listed as hidden are not vertices, and points that are in the shape by
/// themselves are.
///
/// A point whose sphere of squared radius −ω has all others strictly outside is below them all
/// once it is lifted, so it is a vertex of the regular triangulation; a tie may hide it.
pub(super) fn of_shape(
    structure: &Structure,
    emptiness: &Emptiness,
    stays: &[u32],
    claim: &Claim,
) -> Vec<Finding> {
    let points = Points::of(claim.placed);
    let mut standings = standings(structure, stays);
    let missing = |&point: &u32| {
        let site = points.get(point);
        standings[point as usize] == Standing::Unknown
            && radius([&site], claim.placed.alpha).is_le()
            && emptiness.alone(point)
    };
    let all = (0..points.len() as u32).into_par_iter();
    let finding = |point| {
        let radius_squared = radius_value([&points.get(point)]);
        Finding::MissingVertex { point, radius_squared }
    };
    let mut findings: Vec<_> = all.filter(missing).map(finding).collect();
    findings.extend(listed_hidden(&mut standings, claim));
    findings
}

/// Each hidden point is hidden: it does not refute the cell it lies in.
///
/// The lifted cells are a convex function, so a point above it where it lies is above it for good.
/// The cell is found by a walk from a vertex nearby, which ends in a regular triangulation because its
/// cells have no cycle in front of any point (Edelsbrunner, Combinatorica 10, 1990,
/// doi:10.1007/BF02122779). The triangulation must have been found regular, but for ties, and its hull convex.
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

/// The cell that contains a place, or a facet of the hull that it is outside of.
///
/// Among cells on one sphere a walk may go round for ever, as any choice among ties need not be the
/// projection of a convex surface: then all cells are looked at.
fn walk(
    structure: &Structure,
    points: Points,
    start: usize,
    place: [f64; 3],
) -> Result<usize, [u32; 3]> {
    let cells = structure.complex.cells.rows();
    let beyond = |facet: &[u32; 3]| {
        let [a, b, c] = points.places(*facet);
        orientation(a, b, c, place).is_gt()
    };
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
    let holds = |cell: &[u32; 4]| !outward_facets(*cell).iter().any(beyond);
    match cells.iter().position(holds) {
        Some(cell) => Ok(cell),
        None => Err(*structure.hull().iter().find(|facet| beyond(facet)).expect("a convex hull")),
    }
}
