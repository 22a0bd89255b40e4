//! Rules on cells, on pairs of neighbours, and on the hull, which is the surface of the facets with one cell.

use dashu_int::IBig;
use walpha_base::parallel::prelude::*;
use walpha_base::{Cancelled, Monitor};

use super::finding::Finding;
use super::non_vertices;
use super::structure::{Half, Points, Structure};
use crate::Complex;
use crate::exact::{Exact, Lattice, Star, in_conflict, orientation, power_value, six_volume};
use crate::parallel::of_each;

/// What the facets with only one cell form.
#[derive(Clone, Copy)]
pub(super) enum Boundary {
    /// The facets of a whole triangulation in space, which form a convex surface.
    Hull,
    /// The facets of a whole triangulation of a torus: none has a vertex below this number.
    NoneAt { box_points: u32 },
    /// The facets of a shape alone, which are arbitrary.
    Any,
}

/// A complex with its simplices linked, and the rules of structure and geometry that it breaks.
pub(super) struct Linked<'a> {
    pub structure: Structure<'a>,
    /// Broken rules on which the others depend.
    pub broken: Vec<Finding>,
    /// Findings for neighbours and boundary, which are judged if `broken` is empty.
    pub irregular: Vec<Finding>,
}

impl<'a> Linked<'a> {
    pub(super) fn new(
        complex: &'a Complex,
        points: Points,
        boundary: Boundary,
        monitor: &Monitor,
    ) -> Result<Self, Cancelled> {
        let (structure, mut broken) = Structure::new(complex, points, &monitor.part(0, 4, 10))?;
        let cells = complex.cells.rows();
        broken.extend(orientations(cells, points, &monitor.part(4, 5, 10))?);
        let mut irregular = Vec::new();
        if broken.is_empty() {
            irregular.extend(neighbours(&structure, points, &monitor.part(5, 10, 10))?);
            irregular.extend(match boundary {
                Boundary::Hull => convexity(&structure, points),
                Boundary::NoneAt { box_points } => open_facets(&structure, box_points),
                Boundary::Any => Vec::new(),
            });
        }
        Ok(Self { structure, broken, irregular })
    }

    /// Whether no vertex is inside the sphere of a neighbouring cell, and the boundary of a whole triangulation is correct: then
    /// it is regular, up to the choice among ties.
    pub(super) fn is_regular(&self) -> bool {
        self.broken.is_empty() && self.irregular.iter().all(Finding::is_tie)
    }
}

/// All findings for cells as a whole triangulation of some points, such as those on one sphere.
pub(super) fn triangulation_findings(
    cells: &Complex,
    points: Points,
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    let linked = Linked::new(cells, points, Boundary::Hull, monitor)?;
    let regular = linked.is_regular();
    let mut found = linked.broken;
    let unreported = monitor.unreported();
    let cells_together = six_volumes(cells.cells.rows(), points, &unreported)?;
    found.extend(volume(&linked.structure, points, cells_together, &unreported)?);
    found.extend(linked.irregular);
    if regular {
        let own: Vec<u32> = (0..points.len() as u32).collect();
        let hidden = non_vertices::hidden(&linked.structure, &own);
        found.extend(non_vertices::hiddenness(&linked.structure, points, &hidden, monitor)?);
    }
    Ok(found)
}

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
/// Over a convex domain this proves that the whole triangulation is regular: the lifted cells then form a function that is convex
/// across every facet, and therefore convex.
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
    // As seen from its two sides, a facet turns in opposite directions.
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

/// Six times the volume of all cells.
pub(super) fn six_volumes(
    cells: &[[u32; 4]],
    points: Points,
    monitor: &Monitor,
) -> Result<(IBig, i64), Cancelled> {
    let lattice = Lattice::through(points.positions());
    let sum = lattice.six_volumes(cells.len(), monitor, |i| points.positions_of(cells[i]))?;
    Ok((sum, 3 * i64::from(lattice.exponent())))
}

/// Six times the volume of all cells after they are linked: the volume that their outer facets enclose, if cells are on different
/// sides of each facet, because inner facets cancel. Outer facets are few.
pub(super) fn six_volumes_linked(
    linked: &Linked,
    points: Points,
    monitor: &Monitor,
) -> Result<(IBig, i64), Cancelled> {
    let overlaps =
        linked.irregular.iter().any(|finding| matches!(finding, Finding::Overlap { .. }));
    if linked.broken.is_empty() && !overlaps {
        six_volumes_enclosed(&linked.structure, points, monitor)
    } else {
        six_volumes(linked.structure.complex.cells.rows(), points, monitor)
    }
}

/// Six times the volume that the facets with one cell enclose.
fn six_volumes_enclosed(
    structure: &Structure,
    points: Points,
    monitor: &Monitor,
) -> Result<(IBig, i64), Cancelled> {
    let hull = structure.hull();
    let lattice = Lattice::through(points.positions());
    let cone = |i: usize| {
        let [a, b, c] = points.positions_of(hull[i]);
        [points.position(hull[0][0]), a, b, c]
    };
    let sum = lattice.six_volumes(hull.len(), monitor, cone)?;
    Ok((sum, 3 * i64::from(lattice.exponent())))
}

/// Judges that the cells, of which [six times the volume](six_volumes) is given, fill the volume that the hull encloses.
pub(super) fn volume(
    structure: &Structure,
    points: Points,
    (cells, exponent): (IBig, i64),
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    let (enclosed, _) = six_volumes_enclosed(structure, points, monitor)?;
    if cells == enclosed {
        return Ok(Vec::new());
    }
    let exact = |value| Exact::integer(value, exponent);
    Ok(vec![Finding::Volume { cells: exact(cells), hull: exact(enclosed) }])
}

/// Judges that the hull is a convex surface that goes around the first cell once.
///
/// The method is that of Mehlhorn et al., "Checking geometric programs or verification of geometric structures", Comput. Geom.
/// 12, 1999, doi:10.1016/S0925-7721(98)00036-4: a closed surface is the boundary of a convex polytope if it is convex across each
/// edge, has a point strictly inside all its facets, and one ray from that point through the interior of a facet meets no other
/// facet.
pub(super) fn convexity(structure: &Structure, points: Points) -> Vec<Finding> {
    let hull = structure.hull();
    let mut findings = edges(&hull, points);
    if findings.is_empty() && !hull.is_empty() {
        findings = wraps(structure, &hull, points);
    }
    findings
}

/// Findings on facets with one cell and a vertex below a number.
fn open_facets(structure: &Structure, box_points: u32) -> Vec<Finding> {
    let open = structure.hull().into_iter().filter(|row| row.iter().any(|&v| v < box_points));
    open.map(|facet| Finding::OpenFacet { facet: facet.into() }).collect()
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
    let lattice = Lattice::through(points.positions());
    let star = Star::new(lattice, points.positions_of(structure.complex.cells.rows()[0]));
    let first = points.positions_of(hull[0]);
    let judge = |(i, facet): (usize, &[u32; 3])| {
        let triangle = points.positions_of(*facet);
        let wrong = !star.inside(triangle) || i > 0 && star.ray_meets(first, triangle);
        wrong.then(|| Finding::HullWraps { first: hull[0].into(), facet: (*facet).into() })
    };
    hull.par_iter().enumerate().filter_map(judge).collect()
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;
    use crate::certify::flat::closed;
    use crate::exact::WeightedPoint;
    use crate::{Alpha, enumerate};

    /// Cells with gaps, apart, or on one side of a facet.
    #[test]
    fn volumes_of_linked_cells_are_those_of_all() {
        let mut random = Random::new(12);
        let (mut apart, mut overlapping) = (0, 0);
        for round in 0..500 {
            let positions: Vec<[f64; 3]> =
                (0..9).map(|_| [0; 3].map(|_| random.whole(-3, 3))).collect();
            let Ok(made) = enumerate(&positions, &[0.0; 9], Alpha::INFINITE) else { continue };
            let all = made.complex.cells.rows();
            let mut cells: Vec<_> = all.iter().filter(|_| random.below(3) > 0).copied().collect();
            let position = |v: u32| positions[v as usize];
            for _ in 0..round % 2 {
                let [a, b, c, _] = random.pick(all);
                let e = random.below(9) as u32;
                let order = orientation(position(a), position(b), position(c), position(e));
                cells.extend(order.is_gt().then_some([a, b, c, e]));
            }
            let sites: Vec<_> = (positions.iter())
                .map(|&position| WeightedPoint { position, weight: 0.0 })
                .collect();
            let (complex, points) = (closed(&cells), Points { sites: &sites });
            let noop = Monitor::noop();
            let linked = Linked::new(&complex, points, Boundary::Any, &noop).unwrap();
            let overlap = |finding: &Finding| matches!(finding, Finding::Overlap { .. });
            overlapping += usize::from(linked.irregular.iter().any(overlap));
            apart += usize::from(linked.irregular.is_empty() && cells.len() < all.len());
            let sum = six_volumes(complex.cells.rows(), points, &noop).unwrap();
            assert_eq!(six_volumes_linked(&linked, points, &noop).unwrap(), sum, "{cells:?}");
        }
        assert!(apart > 100 && overlapping > 20, "{apart} {overlapping}");
    }
}
