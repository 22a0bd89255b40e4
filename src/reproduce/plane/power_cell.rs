use std::f64::consts::{PI, TAU};

use super::WeightedPlaneShape;
use super::curve::{Arc, OutlinePiece, angle, at};

/// The part of a disc that is nearer, in power, to its own point than to any other. Rounded.
#[derive(Clone, Debug, PartialEq)]
pub struct PowerCell {
    /// Input index of the point.
    pub point: u32,
    /// Its convex boundary, counter-clockwise, each piece beginning where the one before it ends:
    /// segments towards other cells, arcs where the union of all discs ends.
    pub boundary: Vec<OutlinePiece>,
}

/// Pieces shorter than this share of the radius are rounding errors.
const SLIVER: f64 = 1e-12;

/// The half-plane x·normal ≤ offset, around a disc's centre.
#[derive(Clone, Copy)]
struct HalfPlane {
    normal: [f64; 2],
    offset: f64,
}

impl WeightedPlaneShape {
    /// The discs clipped to their power cells, by ascending input index; those with nothing left
    /// are left out. Together they tile the union of the discs. O(Σ d² log d) for points with d
    /// neighbours.
    pub fn cells(&self) -> Vec<PowerCell> {
        let mut walls = vec![Vec::new(); self.positions.len()];
        for &[p, q] in &self.neighbours {
            walls[p as usize].push(self.wall(p, q));
            walls[q as usize].push(self.wall(q, p));
        }
        let radii = self.radii();
        let cells = self.vertices.iter().filter_map(|&point| {
            let radius = radii[point as usize].filter(|&radius| radius > 0.0)?;
            let centre = self.positions[point as usize];
            let boundary = boundary(centre, radius, &walls[point as usize]);
            (!boundary.is_empty()).then_some(PowerCell { point, boundary })
        });
        cells.collect()
    }

    /// The outline of the union of the discs: arcs counter-clockwise, the union on their left.
    pub fn outline(&self) -> Vec<Arc> {
        let pieces = self.cells().into_iter().flat_map(|cell| cell.boundary);
        pieces
            .filter_map(|piece| match piece {
                OutlinePiece::Arc(arc) => Some(arc),
                OutlinePiece::Segment(_) => None,
            })
            .collect()
    }

    /// The half-plane at least as near to p as to q in power: x·a ≤ (a² + ωₚ − `ω_q)/2` with a = q − p.
    fn wall(&self, p: u32, q: u32) -> HalfPlane {
        let (p, q) = (p as usize, q as usize);
        let ([px, py], [qx, qy]) = (self.positions[p], self.positions[q]);
        let (x, y) = (qx - px, qy - py);
        let length = x.hypot(y);
        HalfPlane {
            normal: [x / length, y / length],
            offset: f64::midpoint(length, (self.weights[p] - self.weights[q]) / length),
        }
    }
}

/// The boundary of a disc cut by half-planes.
fn boundary(centre: [f64; 2], radius: f64, walls: &[HalfPlane]) -> Vec<OutlinePiece> {
    if walls.iter().any(|wall| wall.offset <= -radius) {
        return Vec::new();
    }
    let walls: Vec<_> = walls.iter().copied().filter(|wall| wall.offset < radius).collect();
    if walls.is_empty() {
        return vec![OutlinePiece::Arc(Arc::circle(centre, radius))];
    }
    let mut pieces: Vec<OutlinePiece> = (0..walls.len())
        .filter_map(|own| segment(&walls, own, radius))
        .map(|ends| OutlinePiece::Segment(ends.map(|[x, y]| [centre[0] + x, centre[1] + y])))
        .chain(arcs(&walls, radius).into_iter().map(|[from, to]| {
            let (start, end) = (at(centre, radius, from), at(centre, radius, to));
            OutlinePiece::Arc(Arc { centre, radius, start, end, counter_clockwise: true })
        }))
        .collect();
    in_order(&mut pieces);
    pieces
}

/// The part of a wall that is in the disc and in all other half-planes, counter-clockwise around
/// the region.
fn segment(walls: &[HalfPlane], own: usize, radius: f64) -> Option<[[f64; 2]; 2]> {
    let HalfPlane { normal: [nx, ny], offset } = walls[own];
    let reach = (radius - offset).sqrt() * (radius + offset).sqrt();
    let (mut from, mut to) = (-reach, reach);
    for (_, wall) in walls.iter().enumerate().filter(|&(other, _)| other != own) {
        let [mx, my] = wall.normal;
        let (slope, offset_along) = (nx * my - ny * mx, wall.offset - offset * (nx * mx + ny * my));
        if slope > 0.0 {
            to = to.min(offset_along / slope);
        } else if slope < 0.0 {
            from = from.max(offset_along / slope);
        } else if offset_along < 0.0 {
            return None;
        }
    }
    let place = |t: f64| [offset * nx - t * ny, offset * ny + t * nx];
    (to - from > SLIVER * radius).then(|| [place(from), place(to)])
}

/// The parts of the circle in all half-planes, as angles from and to.
fn arcs(walls: &[HalfPlane], radius: f64) -> Vec<[f64; 2]> {
    let mut cut: Vec<[f64; 2]> = walls
        .iter()
        .map(|wall| {
            let middle = angle([0.0; 2], wall.normal);
            let spread = (wall.offset / radius).acos();
            let from = (middle - spread).rem_euclid(TAU);
            [from, from + 2.0 * spread]
        })
        .collect();
    cut.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    // Once around from the first cut; a cut that passes 2π is met again at the end.
    let round = cut[0][0] + TAU;
    let mut free = Vec::new();
    let mut reached = cut.iter().map(|c| c[1] - TAU).fold(cut[0][0], f64::max);
    for [from, to] in cut.into_iter().chain([[round, round]]) {
        if from - reached > SLIVER {
            free.push([reached, from]);
        }
        reached = reached.max(to);
    }
    free
}

/// Sorts the pieces of a convex boundary counter-clockwise and joins their ends, which differ in
/// the last digits.
fn in_order(pieces: &mut [OutlinePiece]) {
    let n = pieces.len() as f64;
    let middles = pieces.iter().map(OutlinePiece::middle);
    let inner = middles.fold([0.0; 2], |sum, [x, y]| [sum[0] + x / n, sum[1] + y / n]);
    pieces.sort_by(|a, b| {
        let turn = |piece: &OutlinePiece| (angle(inner, piece.middle()) + PI).rem_euclid(TAU);
        turn(a).total_cmp(&turn(b))
    });
    for next in 0..pieces.len() {
        let before = (next + pieces.len() - 1) % pieces.len();
        let [_, corner] = pieces[before].ends();
        if before != next {
            match &mut pieces[next] {
                OutlinePiece::Arc(arc) => arc.start = corner,
                OutlinePiece::Segment(ends) => ends[0] = corner,
            }
        }
    }
}
