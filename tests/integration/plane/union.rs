//! The union of discs by itself, without any triangulation.

use std::f64::consts::TAU;

use walpha::reproduce::plane::{Arc, Piece};

/// A disc: centre and radius.
pub type Disc = ([f64; 2], f64);

/// The arcs of each circle that no other disc covers, found from all pairs of discs.
pub fn outline(discs: &[Disc]) -> Vec<Arc> {
    let mut arcs = Vec::new();
    for (i, &(centre, radius)) in discs.iter().enumerate() {
        let at = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            [centre[0] + radius * cos, centre[1] + radius * sin]
        };
        let mut ends = Vec::new();
        for (j, &(other, reach)) in discs.iter().enumerate() {
            let (dx, dy) = (other[0] - centre[0], other[1] - centre[1]);
            let apart = dx.hypot(dy);
            if j != i && apart < radius + reach && apart > (radius - reach).abs() {
                let cos =
                    (apart * apart + radius * radius - reach * reach) / (2.0 * apart * radius);
                let (middle, spread) = (dy.atan2(dx), cos.acos());
                ends.extend([middle - spread, middle + spread].map(|end| end.rem_euclid(TAU)));
            }
        }
        ends.sort_by(f64::total_cmp);
        let free = |angle: f64| {
            let place = at(angle);
            discs.iter().enumerate().all(|(j, &(other, reach))| {
                j == i || (place[0] - other[0]).hypot(place[1] - other[1]) > reach
            })
        };
        let arc = |start, end| Arc { centre, radius, start, end, counter_clockwise: true };
        match ends.first() {
            None if free(0.0) => arcs.push(arc(at(0.0), at(0.0))),
            None => {}
            Some(&first) => {
                let next = ends.iter().copied().skip(1).chain([first + TAU]);
                let pieces = ends.iter().copied().zip(next);
                let free = pieces.filter(|&(from, to)| free(f64::midpoint(from, to)));
                arcs.extend(free.map(|(from, to)| arc(at(from), at(to))));
            }
        }
    }
    arcs
}

/// Components and holes of a region bounded by arcs that have it on their left: loops around it,
/// which enclose a positive area, and loops inside it.
pub fn betti(arcs: &[Arc]) -> [u64; 2] {
    let mut used = vec![false; arcs.len()];
    let mut count = [0, 0];
    for first in 0..arcs.len() {
        if used[first] {
            continue;
        }
        let (mut at, mut area) = (first, 0.0);
        loop {
            used[at] = true;
            area += area_under(&Piece::Arc(arcs[at]));
            let end = arcs[at].end;
            let gap = |k: &usize| (arcs[*k].start[0] - end[0]).hypot(arcs[*k].start[1] - end[1]);
            at = (0..arcs.len()).min_by(|a, b| gap(a).total_cmp(&gap(b))).unwrap();
            assert!(gap(&at) < 1e-6, "the outline is torn: a gap of {}", gap(&at));
            if at == first {
                break;
            }
            assert!(!used[at], "two arcs end in one");
        }
        count[usize::from(area < 0.0)] += 1;
    }
    count
}

/// Half the integral of x dy − y dx along a piece; around a region it sums to the area.
pub fn area_under(piece: &Piece) -> f64 {
    let arc = match piece {
        Piece::Segment([a, b]) => return (a[0] * b[1] - a[1] * b[0]) / 2.0,
        Piece::Arc(arc) => arc,
    };
    let (from, sweep) = (arc.start_angle(), arc.sweep());
    let to = from + sweep;
    let [x, y] = arc.centre;
    let r = arc.radius;
    (r * r * sweep + r * x * (to.sin() - from.sin()) - r * y * (to.cos() - from.cos())) / 2.0
}

/// The sum of lengths.
pub fn length(arcs: &[Arc]) -> f64 {
    arcs.iter().map(|arc| arc.radius * arc.sweep().abs()).sum()
}
