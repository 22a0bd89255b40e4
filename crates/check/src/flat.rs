//! The regular triangulation of points in one plane, on one line, or of a single point, from the
//! definition.

use std::cmp::Ordering;

use walpha_complex::canonical::sorted;

use crate::exact::{WeightedPoint, collinear, in_conflict, orientation};

/// The largest simplices of points that span no volume; all of one kind.
#[derive(Default)]
pub(crate) struct Flat {
    pub facets: Vec<[u32; 3]>,
    pub edges: Vec<[u32; 2]>,
    pub vertices: Vec<[u32; 1]>,
}

/// All triples (pairs, single points) that are not refuted by another site.
///
/// The points of a plane that lie inside a circle are the same for every sphere through that circle. So an auxiliary apex outside
/// the plane makes each triple a cell, and the power test of space with its perturbation decides. The apex has no influence on
/// the perturbation: its coefficient there is zero.
pub(crate) fn flat_simplices(points: &[WeightedPoint], sites: &[u32]) -> Flat {
    let Some(cones) = Cones::of(points, sites) else { return Flat::default() };
    let n = sites.len();
    let mut flat = Flat::default();
    match &cones.apexes[..] {
        [v] => {
            let triples = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
            let triples = triples.flat_map(|(i, j)| (j + 1..n).map(move |k| [i, j, k]));
            let triples = triples.map(|triple| sorted(triple.map(|k| sites[k])));
            flat.facets.extend(triples.filter(|&[a, b, c]| cones.is_regular([a, b, c], &[*v])));
        }
        [_, _] => {
            let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| sorted([sites[i], sites[j]])));
            flat.edges.extend(pairs.filter(|&pair| cones.is_regular(pair, &cones.apexes)));
        }
        _ => flat.vertices.extend(sites.first().map(|&v| [v])),
    }
    flat
}

/// Sites, and auxiliary apexes that span a volume together with them.
struct Cones<'a> {
    points: &'a [WeightedPoint],
    sites: &'a [u32],
    apexes: Vec<[f64; 3]>,
}

impl<'a> Cones<'a> {
    fn of(points: &'a [WeightedPoint], sites: &'a [u32]) -> Option<Self> {
        let apexes = auxiliary_positions(sites.iter().map(|&i| points[i as usize].position))?;
        Some(Self { points, sites, apexes })
    }

    /// Whether a simplex and the apexes make a cell that no other site refutes.
    fn is_regular<const N: usize>(&self, row: [u32; N], apexes: &[[f64; 3]]) -> bool {
        let mut corners: Vec<WeightedPoint> =
            row.iter().map(|&i| self.points[i as usize]).collect();
        corners.extend(apexes.iter().map(|&position| WeightedPoint { position, weight: 0.0 }));
        let [a, b, c, d] = corners[..] else { unreachable!("four corners in all") };
        let [p, q, r, s] = [a, b, c, d].map(|corner| corner.position);
        let cell = match orientation(p, q, r, s) {
            Ordering::Greater => [&a, &b, &c, &d],
            Ordering::Less => [&b, &a, &c, &d],
            Ordering::Equal => return false,
        };
        let others = self.sites.iter().filter(|i| !row.contains(i));
        others.map(|&i| &self.points[i as usize]).all(|q| !in_conflict(cell, q))
    }
}

/// Positions, at most three, that span a volume together with given ones: one for a plane, two for a line, three for a single
/// position, and none if the given ones span a volume. `None` if no positions are given.
pub(crate) fn auxiliary_positions(
    positions: impl Iterator<Item = [f64; 3]> + Clone,
) -> Option<Vec<[f64; 3]>> {
    let first = positions.clone().next()?;
    let mut basis = vec![first];
    for position in positions.clone() {
        if is_independent(&basis, position) {
            basis.push(position);
        }
    }
    let spanned = basis.len();
    let far = positions.flatten().fold(1e-100f64, |most, x| most.max(x.abs()));
    for axis in 0..3 {
        let mut outside = first;
        // Moves towards the origin and beyond, so that the coordinate remains finite.
        outside[axis] = if outside[axis] > 0.0 { -far } else { far };
        if is_independent(&basis, outside) {
            basis.push(outside);
        }
    }
    Some(basis.split_off(spanned))
}

/// Whether a position is outside the affine hull of others.
fn is_independent(basis: &[[f64; 3]], position: [f64; 3]) -> bool {
    match *basis {
        [a] => a != position,
        [a, b] => !collinear(a, b, position),
        [a, b, c] => orientation(a, b, c, position).is_ne(),
        _ => false,
    }
}
