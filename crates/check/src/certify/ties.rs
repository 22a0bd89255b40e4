//! In a shape alone: whether the simplices that are listed on tied spheres fit together.
//!
//! If more points lie on one empty sphere than a simplex has corners, their polytope may be cut in several ways. For a whole
//! triangulation, hull and volume prove that it is cut in one of these ways. In a shape alone, each polytope is judged by itself,
//! as a whole triangulation of the points on its sphere. On each of its flat faces, which the polytope on the other side may also
//! cut, all facets must have cells on the same sides. No vertex may lie within an edge, which other polytopes may also cut.

use std::collections::{BTreeMap, BTreeSet};

use walpha_base::parallel::prelude::*;
use walpha_base::{Cancelled, Monitor};
use walpha_complex::canonical::{outward_facets, sorted};

use super::emptiness::Emptiness;
use super::finding::Finding;
use super::flat::{Cone, closed};
use super::geometry::triangulation_findings;
use super::structure::{Points, Structure};
use crate::exact::{collinear, orientation};
use crate::flat::auxiliary_positions;
use crate::parallel::of_each;
use crate::{Class, Complex, Simplices};

/// Singular facets on tied circles: the points of each circle, and the rows.
pub(super) type Circles = BTreeMap<Vec<u32>, Vec<u32>>;

/// Judges singular simplices with further points on their spheres: they must be those of a triangulation of these points, by the
/// rule or by another choice.
pub(super) fn singular(
    structure: &Structure,
    points: Points,
    emptiness: &Emptiness,
    monitor: &Monitor,
) -> Result<(Circles, Vec<Finding>), Cancelled> {
    let complex = structure.complex;
    let mut findings = Vec::new();
    for (_, vertex, on) in tied(&complex.vertices, emptiness, &monitor.part(0, 1, 4))? {
        findings.push(spanned(vertex, &on));
    }
    let mut lines = BTreeMap::<Vec<u32>, Vec<u32>>::new();
    for (row, edge, on) in tied(&complex.edges, emptiness, &monitor.part(1, 2, 4))? {
        let [a, b] = points.positions_of(edge);
        match on.iter().find(|&&q| !collinear(a, b, points.get(q).position)) {
            Some(_) => findings.push(spanned(edge, &on)),
            None => lines.entry(on).or_default().push(row),
        }
    }
    let mut circles = Circles::new();
    for (row, facet, on) in tied(&complex.facets, emptiness, &monitor.part(2, 3, 4))? {
        let [a, b, c] = points.positions_of(facet);
        match on.iter().find(|&&q| orientation(a, b, c, points.get(q).position).is_ne()) {
            Some(_) => findings.push(spanned(facet, &on)),
            None => circles.entry(on).or_default().push(row),
        }
    }
    let on_spheres = monitor.unreported();
    for (on, rows) in &lines {
        // All edges between these points, because some may be faces of facets.
        let listed = edges_between(structure, on);
        let edges = listed.map(|pair| (local(pair, on), Class::Exterior)).collect();
        let first = complex.edges.rows()[rows[0] as usize];
        let edges = Complex { edges, ..Complex::default() };
        findings.extend(flat_findings(on, &edges, first.into(), points, &on_spheres)?);
    }
    for (on, rows) in &circles {
        let facets = rows.iter().map(|&row| complex.facets.rows()[row as usize]);
        let facets = facets.map(|facet| (sorted(local(facet, on)), Class::Exterior)).collect();
        let first = complex.facets.rows()[rows[0] as usize];
        let facets = Complex { facets, ..Complex::default() };
        findings.extend(flat_findings(on, &facets, first.into(), points, &on_spheres)?);
    }
    Ok((circles, findings))
}

/// Judges cells with further points on their spheres, and the facets and edges that are listed on the faces between them.
pub(super) fn cells(
    structure: &Structure,
    points: Points,
    emptiness: &Emptiness,
    singular: &Circles,
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    let cells = structure.complex.cells.rows();
    let facets = structure.complex.facets.rows();
    let tied = of_each(cells.len(), &monitor.part(0, 1, 2), |row| {
        let on = emptiness.on_sphere(cells[row]);
        (on.len() > 4).then_some((on, row))
    })?;
    let mut spheres = BTreeMap::<Vec<u32>, Vec<usize>>::new();
    for (on, cell) in tied {
        spheres.entry(on).or_default().push(cell);
    }
    let spheres: Vec<_> = spheres.into_iter().collect();
    let (rest, on_spheres) = (monitor.part(1, 2, 2), monitor.unreported());
    let judged = rest.units(spheres.len() as u64);
    let judge = |(on, rows): &(Vec<u32>, Vec<usize>)| -> Result<Option<Finding>, Cancelled> {
        let own: Vec<_> = rows.iter().map(|&row| local(cells[row], on)).collect();
        let sites = points.of(on);
        let of_sphere = Points { sites: &sites };
        let wrong = triangulation_findings(&closed(&own), of_sphere, &on_spheres)?;
        judged.add(1)?;
        Ok(wrong.iter().any(|finding| !finding.is_tie()).then(|| Finding::TiedSphere {
            simplex: cells[rows[0]].into(),
            points: on.clone(),
            listed: rows.len(),
        }))
    };
    let found: Vec<_> = spheres.par_iter().map(judge).collect::<Result<_, Cancelled>>()?;
    let mut findings: Vec<Finding> = found.into_iter().flatten().collect();

    // The facets that are listed on each flat face with more than three corners.
    let mut faces = BTreeMap::<Vec<u32>, Vec<u32>>::new();
    let mut cut = BTreeSet::new();
    for (on, rows) in &spheres {
        for &row in rows {
            for (k, facet) in outward_facets(cells[row]).into_iter().enumerate() {
                let [a, b, c] = points.positions_of(facet);
                let flat = |&&q: &&u32| orientation(a, b, c, points.get(q).position).is_eq();
                let face: Vec<u32> = on.iter().filter(flat).copied().collect();
                if face.len() > 3 {
                    faces.entry(face).or_default().push(structure.cell_facets[row][k]);
                }
                cut.extend(cut_edges(structure, points, facet, on));
            }
        }
    }
    for (on, rows) in singular {
        for &row in rows {
            faces.entry(on.clone()).or_default().push(row);
            cut.extend(cut_edges(structure, points, facets[row as usize], on));
        }
    }
    let of_line = |[a, b]: [u32; 2]| {
        let [p, q] = points.positions_of([a, b]);
        let on_line = |&v: &u32| collinear(p, q, points.get(v).position);
        let on: Vec<u32> = emptiness.on_sphere([a, b]).into_iter().filter(on_line).collect();
        let listed = edges_between(structure, &on).count();
        Finding::TiedSphere { simplex: [a, b].into(), points: on, listed }
    };
    findings.extend(cut.into_iter().map(of_line));
    let mut crossing = BTreeMap::<u32, u32>::new();
    for (face, rows) in &faces {
        // Of copies on a torus, the one with a point of the box, if any has one.
        let first = rows.iter().copied().min_by_key(|&row| facets[row as usize].into_iter().min());
        let first = first.expect("a face has facets");
        let known = sides(structure, points, face, first);
        let crosses = |&&row: &&u32| sides(structure, points, face, row) != known;
        crossing.extend(rows.iter().filter(crosses).map(|&row| (row, first)));
    }
    let of = |row: u32| facets[row as usize].into();
    let crossing = crossing.into_iter();
    findings.extend(crossing.map(|(a, b)| Finding::TiedFacets { facet: of(a), other: of(b) }));
    Ok(findings)
}

/// The edges of a facet that have, between their ends, a vertex of those `on` its sphere.
fn cut_edges(
    structure: &Structure,
    points: Points,
    [a, b, c]: [u32; 3],
    on: &[u32],
) -> impl Iterator<Item = [u32; 2]> {
    [[a, b], [b, c], [a, c]].map(sorted).into_iter().filter(move |&edge| {
        let [p, q] = points.positions_of(edge);
        on.iter().any(|&v| {
            let x = points.get(v).position;
            // Comparing coordinates is cheap, and excludes nearly all.
            let between = (0..3).all(|k| p[k].min(q[k]) <= x[k] && x[k] <= p[k].max(q[k]));
            between && !edge.contains(&v) && structure.vertices.contains([v]) && collinear(p, q, x)
        })
    })
}

/// The edges that are listed between some points, which are ascending.
fn edges_between(structure: &Structure, on: &[u32]) -> impl Iterator<Item = [u32; 2]> {
    let pairs = on.iter().enumerate().flat_map(|(i, &a)| on[i + 1..].iter().map(move |&b| [a, b]));
    pairs.filter(|&pair| structure.edges.contains(pair))
}

/// The sides of a flat face on which a facet of it has cells.
fn sides(structure: &Structure, points: Points, face: &[u32], facet: u32) -> [bool; 2] {
    let [a, b] = [face[0], face[1]].map(|v| points.get(v).position);
    let others = face[2..].iter().map(|&v| points.get(v).position);
    let c = others.into_iter().find(|&c| !collinear(a, b, c)).expect("a face spans a plane");
    let mut sides = [false; 2];
    for half in structure.halves(facet as usize) {
        let apex = points.get(structure.apex(half)).position;
        sides[usize::from(orientation(a, b, c, apex).is_gt())] = true;
    }
    sides
}

/// A simplex with further points on its sphere: its row, its vertices, and all points on the sphere.
type Tied<const N: usize> = (u32, [u32; N], Vec<u32>);

/// The singular simplices with further points on their spheres.
fn tied<const N: usize>(
    simplices: &Simplices<N>,
    emptiness: &Emptiness,
    monitor: &Monitor,
) -> Result<Vec<Tied<N>>, Cancelled> {
    of_each(simplices.len(), monitor, |i| {
        let row = simplices.rows()[i];
        let singular = simplices.classes()[i] == Class::Singular;
        let on = singular.then(|| emptiness.on_sphere(row))?;
        (on.len() > N).then_some((i as u32, row, on))
    })
}

fn spanned<const N: usize>(simplex: [u32; N], on: &[u32]) -> Finding {
    let point = on.iter().copied().find(|v| !simplex.contains(v)).expect("a further point");
    Finding::SpannedSphere { simplex: simplex.into(), point }
}

/// Findings for flat simplices as a whole triangulation of the points `on` a sphere: each other choice among ties, or a single
/// finding if they are not a triangulation. `simplex` is the first of them.
fn flat_findings(
    on: &[u32],
    complex: &Complex,
    simplex: super::Simplex,
    points: Points,
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    let listed = complex.facets.len() + complex.edges.len();
    let sites = points.of(on);
    let of_sphere = Points { sites: &sites };
    let apexes = auxiliary_positions(of_sphere.positions()).unwrap_or_default();
    let found = match Cone::over(complex, of_sphere, &apexes) {
        Some(cone) => {
            let found = triangulation_findings(&cone.complex, cone.points(), monitor)?;
            Some(cone.at_base(found))
        }
        None => None,
    };
    Ok(match found {
        Some(found) if found.iter().all(Finding::is_tie) => {
            found.into_iter().map(|finding| finding.renumbered(on)).collect()
        }
        _ => vec![Finding::TiedSphere { simplex, points: on.to_vec(), listed }],
    })
}

/// A row as indices into an ascending list of points that contains all of its vertices.
fn local<const N: usize>(row: [u32; N], on: &[u32]) -> [u32; N] {
    row.map(|v| on.binary_search(&v).expect("corners are on their sphere") as u32)
}
