use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

use super::EksShape;
use super::curve::{Arc, OutlinePiece, angle, at, distance};

/// The outline of an α-hull: the intersection of all generalised discs of radius 1/α that contain
/// the points. Rounded.
#[derive(Clone, Debug, PartialEq)]
pub struct AlphaHull {
    /// Pieces with the hull on their left; each is an arc of radius 1/|α|, bulging out of the hull
    /// (counter-clockwise) for α > 0 and into it for α < 0, or straight for α = 0. For α > 0 they
    /// follow each other around the hull. If the hull at α = 0 is only a segment, it is listed once.
    pub outline: Vec<OutlinePiece>,
    /// Input indices of points that are parts of the hull on their own, ascending.
    pub points: Vec<u32>,
}

/// Numbers this close, as a share of the radius, count as equal in the search for pieces.
const TOLERANCE: f64 = 1e-9;

impl EksShape {
    /// The outline of the α-hull. Empty where the shape is.
    ///
    /// For α < 0 the hull is what no empty disc covers, and its outline may have corners that are
    /// no points of the set, where two discs meet from opposite sides; it is cut out in doubles,
    /// features below 1e-9 of the radius aside. O(k² + kn²) at worst for k arcs and n points, and
    /// near O(k²) when few points lie within one radius; O(n log n) for α ≥ 0.
    pub fn hull(&self) -> AlphaHull {
        let alpha = self.alpha().value();
        let outline: Vec<OutlinePiece> = if alpha > 0.0 {
            self.chain().map(|way| OutlinePiece::Arc(self.arc(way))).collect()
        } else if alpha < 0.0 {
            self.uncovered().into_iter().map(OutlinePiece::Arc).collect()
        } else {
            let place = |v: u32| self.positions[v as usize];
            self.arcs.iter().map(|&way| OutlinePiece::Segment(way.map(place))).collect()
        };
        let touched: BTreeSet<[u64; 2]> = outline
            .iter()
            .flat_map(OutlinePiece::ends)
            .map(|place| place.map(f64::to_bits))
            .collect();
        let alone = |v: &u32| !touched.contains(&self.positions[*v as usize].map(f64::to_bits));
        AlphaHull { points: self.extreme().iter().copied().filter(alone).collect(), outline }
    }

    /// The arcs of a convex hull one after the other.
    fn chain(&self) -> impl Iterator<Item = [u32; 2]> {
        let next: BTreeMap<u32, u32> = self.arcs.iter().map(|&[p, q]| (p, q)).collect();
        let first = next.keys().next().copied();
        let mut at = first;
        std::iter::from_fn(move || {
            let p = at?;
            let q = next[&p];
            at = (Some(q) != first).then_some(q);
            Some([p, q])
        })
    }

    /// The arc from p counter-clockwise to q, at most a half circle: its centre is on the left.
    fn arc(&self, [p, q]: [u32; 2]) -> Arc {
        let [start, end] = [p, q].map(|v| self.positions[v as usize]);
        let radius = self.alpha().radius();
        let length = distance(start, end);
        let half = length / 2.0;
        // A half distance above the radius is rounding: exactly, it is not.
        let height = (radius - half).max(0.0).sqrt() * (radius + half).sqrt();
        let (x, y) = ((end[0] - start[0]) / length, (end[1] - start[1]) / length);
        let centre = [start[0] + x * half - y * height, start[1] + y * half + x * height];
        Arc { centre, radius, start, end, counter_clockwise: true }
    }

    /// The parts of the arcs of empty discs that no other empty disc covers.
    fn uncovered(&self) -> Vec<Arc> {
        let arcs: Vec<Arc> = self.arcs.iter().map(|&way| self.arc(way)).collect();
        let cover = Cover {
            sites: &self.positions,
            centres: self.touching_centres(),
            radius: self.alpha().radius(),
        };
        arcs.iter().flat_map(|arc| cover.cut(arc)).collect()
    }

    /// The centres of empty discs that touch two points or more, found again in doubles: some of
    /// them touch more than two, and which of the two sides of a pair is empty was not kept.
    fn touching_centres(&self) -> Vec<[f64; 2]> {
        self.edges()
            .iter()
            .flat_map(|&[p, q]| [[p, q], [q, p]])
            .map(|way| self.arc(way).centre)
            .filter(|&centre| {
                let reach = self.alpha().radius() * (1.0 - TOLERANCE);
                self.positions.iter().all(|&site| distance(centre, site) >= reach)
            })
            .collect()
    }
}

/// The union of all open discs of one radius that contain no site.
struct Cover<'a> {
    sites: &'a [[f64; 2]],
    /// The corners of the region of their centres.
    centres: Vec<[f64; 2]>,
    radius: f64,
}

impl Cover<'_> {
    /// The parts of an arc that are not covered, in the opposite direction: the discs are outside.
    fn cut(&self, arc: &Arc) -> Vec<Arc> {
        let mut shares = vec![0.0, 1.0];
        shares.extend(self.centres.iter().flat_map(|&centre| self.crossings(arc, centre)));
        shares.retain(|share| (0.0..=1.0).contains(share));
        shares.sort_unstable_by(f64::total_cmp);
        shares.dedup_by(|b, a| *b - *a < TOLERANCE);
        // The end may have been dropped for a share just before it.
        if let Some(last) = shares.last_mut() {
            *last = 1.0;
        }
        let mut free: Vec<[f64; 2]> = Vec::new();
        for pair in shares.windows(2) {
            if self.covers(arc.at(f64::midpoint(pair[0], pair[1]))) {
                continue;
            }
            match free.last_mut() {
                Some(last) if last[1] == pair[0] => last[1] = pair[1],
                _ => free.push([pair[0], pair[1]]),
            }
        }
        let place = |share: f64| match share {
            0.0 => arc.start,
            1.0 => arc.end,
            share => arc.at(share),
        };
        free.into_iter()
            .map(|[from, to]| Arc {
                start: place(to),
                end: place(from),
                counter_clockwise: false,
                ..*arc
            })
            .collect()
    }

    /// The places where the circle around `centre` crosses the arc, as shares of it.
    fn crossings(&self, arc: &Arc, centre: [f64; 2]) -> impl Iterator<Item = f64> {
        let apart = distance(arc.centre, centre);
        let meet = apart > TOLERANCE * self.radius && apart < 2.0 * self.radius;
        let towards = angle(arc.centre, centre);
        let spread = (apart / (2.0 * self.radius)).min(1.0).acos();
        let (start, sweep) = (arc.start_angle(), arc.sweep());
        [towards - spread, towards + spread]
            .into_iter()
            .filter(move |_| meet)
            .map(move |angle| (angle - start).rem_euclid(TAU) / sweep)
    }

    /// Whether an open empty disc contains a point: whether a centre is nearer than the radius.
    /// The nearest centre is the point itself, or a corner of the region of centres, or on the
    /// circle that bounds the region around some site, beyond the point as seen from the site.
    fn covers(&self, place: [f64; 2]) -> bool {
        let reach = self.radius * (1.0 - TOLERANCE);
        let near = |&centre: &[f64; 2]| distance(centre, place) < reach;
        let empty = |centre| self.sites.iter().all(|&site| distance(centre, site) >= reach);
        self.centres.iter().any(near)
            || empty(place)
            || self.sites.iter().any(|&site| {
                let apart = distance(site, place);
                apart > TOLERANCE * self.radius
                    && apart < self.radius
                    && empty(at(site, self.radius, angle(site, place)))
            })
    }
}
