//! The regular triangulation of points in one plane, on one line, or of one alone, from the
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

/// All triples (pairs, single points) that no other site refutes.
///
/// Which points are within a circle of a plane is the same for every sphere through it; so places
/// beside the plane make a cell of each triple, and the power test of space with its perturbation
/// decides. The one beside is on no side of the plane's points: in the perturbation its part is zero.
pub(crate) fn flat_simplices(points: &[WeightedPoint], sites: &[u32]) -> Flat {
    let Some(beside) = Beside::of(points, sites) else { return Flat::default() };
    let n = sites.len();
    let mut flat = Flat::default();
    match &beside.places[..] {
        [v] => {
            let triples = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
            let triples = triples.flat_map(|(i, j)| (j + 1..n).map(move |k| [i, j, k]));
            let triples = triples.map(|triple| sorted(triple.map(|k| sites[k])));
            flat.facets.extend(triples.filter(|&[a, b, c]| beside.stands([a, b, c], &[*v])));
        }
        [_, _] => {
            let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| sorted([sites[i], sites[j]])));
            flat.edges.extend(pairs.filter(|&pair| beside.stands(pair, &beside.places)));
        }
        _ => flat.vertices.extend(sites.first().map(|&v| [v])),
    }
    flat
}

/// Sites, and auxiliary places that span a volume together with them.
struct Beside<'a> {
    points: &'a [WeightedPoint],
    sites: &'a [u32],
    places: Vec<[f64; 3]>,
}

impl<'a> Beside<'a> {
    fn of(points: &'a [WeightedPoint], sites: &'a [u32]) -> Option<Self> {
        let places = auxiliary(sites.iter().map(|&i| points[i as usize].position))?;
        Some(Self { points, sites, places })
    }

    /// Whether a simplex makes a cell with places beside it, and no other site refutes it.
    fn stands<const N: usize>(&self, row: [u32; N], beside: &[[f64; 3]]) -> bool {
        let mut corners: Vec<WeightedPoint> =
            row.iter().map(|&i| self.points[i as usize]).collect();
        corners.extend(beside.iter().map(|&position| WeightedPoint { position, weight: 0.0 }));
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

/// The places, at most three, that span a volume together with given ones: one beside a plane, two beside a
/// line, three beside a single place, and none where these span a volume themselves. None if there are no places.
pub(crate) fn auxiliary(places: impl Iterator<Item = [f64; 3]> + Clone) -> Option<Vec<[f64; 3]>> {
    let first = places.clone().next()?;
    let mut basis = vec![first];
    for place in places.clone() {
        if is_free(&basis, place) {
            basis.push(place);
        }
    }
    let spanned = basis.len();
    let far = places.flatten().fold(1e-100f64, |most, x| most.max(x.abs()));
    for axis in 0..3 {
        let mut beside = first;
        // Towards the origin and beyond, so that it stays a number.
        beside[axis] = if beside[axis] > 0.0 { -far } else { far };
        if is_free(&basis, beside) {
            basis.push(beside);
        }
    }
    Some(basis.split_off(spanned))
}

/// Whether a place is not in what others span.
fn is_free(basis: &[[f64; 3]], place: [f64; 3]) -> bool {
    match *basis {
        [a] => a != place,
        [a, b] => !collinear(a, b, place),
        [a, b, c] => orientation(a, b, c, place).is_ne(),
        _ => false,
    }
}
