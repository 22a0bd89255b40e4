//! Rules on the hull, the surface of the facets with one cell.

use dashu_int::IBig;
use rayon::prelude::*;
use walpha_base::{Cancelled, Monitor};

use super::structure::Structure;
use super::{Finding, Points};
use crate::exact::{Exact, Lattice, Star, orientation, six_volume};

/// Six times the volume of all cells.
pub(super) fn six_volumes(
    cells: &[[u32; 4]],
    points: Points,
    monitor: &Monitor,
) -> Result<(IBig, i64), Cancelled> {
    let lattice = Lattice::through(points.positions);
    let sum = lattice.six_volumes(cells.len(), monitor, |i| points.positions_of(cells[i]))?;
    Ok((sum, 3 * i64::from(lattice.exponent())))
}

/// Judges that the cells fill the volume that the hull encloses.
pub(super) fn volume(
    structure: &Structure,
    points: Points,
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    let rows = structure.complex.cells.rows();
    let (cells, exponent) = six_volumes(rows, points, &monitor.part(0, 9, 10))?;
    let hull = structure.hull();
    let top = points.positions[0];
    let lattice = Lattice::through(points.positions);
    let cone = |i: usize| {
        let [a, b, c] = points.positions_of(hull[i]);
        [top, a, b, c]
    };
    let enclosed = lattice.six_volumes(hull.len(), &monitor.part(9, 10, 10), cone)?;
    if cells == enclosed {
        return Ok(Vec::new());
    }
    let exact = |value| Exact::integer(value, exponent);
    Ok(vec![Finding::Volume { cells: exact(cells), hull: exact(enclosed) }])
}

/// Judges that the hull is a convex surface that goes around the first cell once.
///
/// By Mehlhorn et al., "Checking geometric programs or verification of geometric structures",
/// Comput. Geom. 12, 1999, doi:10.1016/S0925-7721(98)00036-4: a closed surface is the boundary of
/// a convex polytope if it is convex across each edge, has a point strictly inside all its
/// facets, and one ray from that point through the interior of a facet meets no other facet.
pub(super) fn convexity(structure: &Structure, points: Points) -> Vec<Finding> {
    let hull = structure.hull();
    let mut findings = edges(&hull, points);
    if findings.is_empty() && !hull.is_empty() {
        findings = wraps(structure, &hull, points);
    }
    findings
}

fn edges(hull: &[[u32; 3]], points: Points) -> Vec<Finding> {
    let mut edges: Vec<([u32; 2], usize, u32)> = hull
        .par_iter()
        .enumerate()
        .flat_map_iter(|(i, &[a, b, c])| {
            [([a, b], i, c), ([b, c], i, a), ([c, a], i, b)]
                .map(|([u, v], i, apex)| ([u.min(v), u.max(v)], i, apex))
        })
        .collect();
    edges.par_sort_unstable();
    let around: Vec<_> = edges.chunk_by(|one, other| one.0 == other.0).collect();
    let judge = |facets: &&[([u32; 2], usize, u32)]| match facets {
        [(_, facet, _), (_, _, apex)] => bend(hull[*facet], *apex, points),
        _ => Some(Finding::HullEdge { edge: facets[0].0.into(), facets: facets.len() }),
    };
    around.par_iter().filter_map(judge).collect()
}

fn bend(facet: [u32; 3], point: u32, points: Points) -> Option<Finding> {
    let [a, b, c] = points.positions_of(facet);
    let q = points.get(point);
    orientation(a, b, c, q.position).is_gt().then(|| {
        let [a, b, c] = points.corners(facet);
        let six_volumes = six_volume([&a, &b, &c, &q]);
        Finding::HullBends { facet: facet.into(), point, six_volumes }
    })
}

fn wraps(structure: &Structure, hull: &[[u32; 3]], points: Points) -> Vec<Finding> {
    let lattice = Lattice::through(points.positions);
    let star = Star::new(lattice, points.positions_of(structure.complex.cells.rows()[0]));
    let first = points.positions_of(hull[0]);
    let judge = |(i, facet): (usize, &[u32; 3])| {
        let triangle = points.positions_of(*facet);
        let wrong = !star.inside(triangle) || i > 0 && star.ray_meets(first, triangle);
        wrong.then(|| Finding::HullWraps { first: hull[0].into(), facet: (*facet).into() })
    };
    hull.par_iter().enumerate().filter_map(judge).collect()
}
