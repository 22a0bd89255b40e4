//! The view of a plane along an axis of space. It drops a coordinate and rounds nothing, so orientations are decided exactly by
//! the predicates of space.

use walpha_regular::internals::{Predicates, spanning};

use crate::OutlineError;

/// Three points that span the plane of all.
pub(super) fn spanning_plane(positions: &[[f64; 3]]) -> Result<[[f64; 3]; 3], OutlineError> {
    match spanning(positions)[..] {
        [a, b, c] => Ok([a, b, c]),
        [_, _, _, _] => Err(OutlineError::Space),
        _ => Err(OutlineError::Line),
    }
}

/// The seen points of a plane, and an eye above them.
pub(super) struct View {
    /// The coordinates that are seen.
    pub axes: [usize; 2],
    /// The points in these coordinates, at height 0; the last one is the eye.
    places: Vec<[f64; 3]>,
    /// All weights are 0.
    weights: Vec<f64>,
}

/// A view with its predicates.
pub(super) struct Seen<'a> {
    places: &'a [[f64; 3]],
    predicates: Predicates<'a>,
    eye: u32,
}

impl View {
    /// The pairs of coordinates, in the order in which they are tried.
    const PAIRS: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];

    pub(super) fn of(positions: &[[f64; 3]]) -> Result<Self, OutlineError> {
        let plane = spanning_plane(positions)?;
        // Adding 0.0 turns −0 into 0.
        let seen = |[u, v]: [usize; 2]| move |p: [f64; 3]| [p[u] + 0.0, p[v] + 0.0, 0.0];
        let is_edge_on = |axes: [usize; 2]| {
            let corners = plane.map(seen(axes));
            Predicates::new(&corners, &[0.0; 3]).collinear([0, 1, 2])
        };
        let axes = Self::PAIRS.into_iter().find(|&axes| !is_edge_on(axes));
        let axes = axes.expect("a plane contains the directions of two axes at most");
        let mut places: Vec<[f64; 3]> = positions.iter().copied().map(seen(axes)).collect();
        let [u, v, _] = places[0];
        places.push([u, v, height(&places)]);
        let weights = vec![0.0; places.len()];
        Ok(Self { axes, places, weights })
    }

    pub(super) fn seen(&self) -> Seen<'_> {
        let predicates = Predicates::new(&self.places, &self.weights);
        Seen { places: &self.places, predicates, eye: self.places.len() as u32 - 1 }
    }
}

impl Seen<'_> {
    /// Whether three points that are not on one line turn counter-clockwise. Exact.
    pub(super) fn is_counter_clockwise(&self, [a, b, c]: [u32; 3]) -> bool {
        self.predicates.orientation([a, b, c, self.eye]).is_gt()
    }

    /// A triangle turned counter-clockwise, its first corner unchanged.
    pub(super) fn turned(&self, [a, b, c]: [u32; 3]) -> [u32; 3] {
        if self.is_counter_clockwise([a, b, c]) { [a, b, c] } else { [a, c, b] }
    }

    /// Whether a simple ring turns counter-clockwise. Exact: it does at its first vertex in the order of the
    /// coordinates, where the ring has a corner and its inside is the convex side.
    pub(super) fn winds_counter_clockwise(&self, ring: &[u32]) -> bool {
        let place = |i: usize| self.places[ring[i] as usize];
        let before = |&i: &usize, &j: &usize| {
            let ([iu, iv, _], [ju, jv, _]) = (place(i), place(j));
            iu.total_cmp(&ju).then(iv.total_cmp(&jv))
        };
        let first = (0..ring.len()).min_by(before).expect("a ring has vertices");
        let at = |i: usize| ring[i % ring.len()];
        self.is_counter_clockwise([at(first + ring.len() - 1), at(first), at(first + 1)])
    }
}

/// The height of an eye: approximately the extent of the places, so that predicates need no integers if triangles are not far
/// smaller, and a power of two, which keeps places on their lattice.
fn height(places: &[[f64; 3]]) -> f64 {
    // Cubes of shorter lengths leave the range of doubles.
    const SHORTEST: f64 = 1e-100;
    let extent = |k: usize| {
        let ends = places.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], place| {
            [low.min(place[k]), high.max(place[k])]
        });
        ends[1] - ends[0]
    };
    2f64.powi(extent(0).max(extent(1)).max(SHORTEST).log2().floor() as i32)
}
