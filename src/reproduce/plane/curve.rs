//! Areas and closed curves of outlines made of segments and arcs.

use std::f64::consts::TAU;

/// A piece of an outline, from start to end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutlinePiece {
    /// Part of a circle.
    Arc(Arc),
    /// A segment, from the first to the second point.
    Segment([[f64; 2]; 2]),
}

/// Part of a circle, from start to end; the whole circle if these are equal. Coordinates are rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Centre (x, y).
    pub centre: [f64; 2],
    /// Radius, a length.
    pub radius: f64,
    /// Start (x, y).
    pub start: [f64; 2],
    /// End (x, y).
    pub end: [f64; 2],
    /// Whether the arc runs counter-clockwise (x to the right, y upwards), so that the centre is on its
    /// left.
    pub counter_clockwise: bool,
}

impl Arc {
    /// The whole circle, counter-clockwise.
    pub(super) fn circle(centre: [f64; 2], radius: f64) -> Self {
        let start = at(centre, radius, 0.0);
        Self { centre, radius, start, end: start, counter_clockwise: true }
    }

    /// Whether it is the whole circle.
    pub fn is_circle(&self) -> bool {
        self.start == self.end
    }

    /// The angle of the start seen from the centre, in radians.
    pub fn start_angle(&self) -> f64 {
        angle(self.centre, self.start)
    }

    /// The angle from start to end, in radians: positive counter-clockwise, at most 2π in magnitude.
    pub fn sweep(&self) -> f64 {
        let (from, to) =
            if self.counter_clockwise { (self.start, self.end) } else { (self.end, self.start) };
        let angle = match (angle(self.centre, to) - angle(self.centre, from)).rem_euclid(TAU) {
            _ if self.is_circle() => TAU,
            angle => angle,
        };
        if self.counter_clockwise { angle } else { -angle }
    }

    /// The point at a share, 0 to 1, of the arc from its start.
    pub fn at(&self, share: f64) -> [f64; 2] {
        at(self.centre, self.radius, self.start_angle() + share * self.sweep())
    }
}

impl OutlinePiece {
    /// Start and end.
    pub fn ends(&self) -> [[f64; 2]; 2] {
        match *self {
            Self::Arc(Arc { start, end, .. }) => [start, end],
            Self::Segment(ends) => ends,
        }
    }

    /// The point halfway along the piece.
    pub fn middle(&self) -> [f64; 2] {
        match self {
            Self::Arc(arc) => arc.at(0.5),
            Self::Segment([[ax, ay], [bx, by]]) => [(ax + bx) / 2.0, (ay + by) / 2.0],
        }
    }
}

/// The point on a circle at an angle.
pub(super) fn at(centre: [f64; 2], radius: f64, angle: f64) -> [f64; 2] {
    [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()]
}

/// The direction from one point to another, in radians.
pub(super) fn angle(from: [f64; 2], to: [f64; 2]) -> f64 {
    (to[1] - from[1]).atan2(to[0] - from[0])
}

/// The distance of two points.
pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// The area on the left of closed curves (Green's theorem). Rounded.
pub(in crate::reproduce) fn area(pieces: &[OutlinePiece]) -> f64 {
    let double = pieces.iter().map(|piece| match piece {
        OutlinePiece::Segment([[ax, ay], [bx, by]]) => ax * by - bx * ay,
        OutlinePiece::Arc(arc) => {
            let [dx, dy] = [arc.end[0] - arc.start[0], arc.end[1] - arc.start[1]];
            arc.radius * arc.radius * arc.sweep() + arc.centre[0] * dy - arc.centre[1] * dx
        }
    });
    double.sum::<f64>() / 2.0
}

/// Number of closed curves that the pieces form, each beginning where another ends, up to rounding. O(n²).
pub(in crate::reproduce) fn loops(pieces: &[OutlinePiece]) -> usize {
    let follows = |piece: &OutlinePiece, next: &OutlinePiece| {
        let ([_, end], [start, _]) = (piece.ends(), next.ends());
        (end[0] - start[0]).hypot(end[1] - start[1]) < 1e-9
    };
    let mut walked = vec![false; pieces.len()];
    let mut loops = 0;
    for first in 0..pieces.len() {
        if walked[first] {
            continue;
        }
        loops += 1;
        let mut at = Some(first);
        while let Some(k) = at {
            walked[k] = true;
            let next = (0..pieces.len()).find(|&n| !walked[n] && follows(&pieces[k], &pieces[n]));
            at = next;
        }
    }
    loops
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::plane::Arc;

    /// The two halves of a circle, turning left or right.
    fn ring(centre: [f64; 2], radius: f64, counter_clockwise: bool) -> Vec<OutlinePiece> {
        let [x, y] = centre;
        let [left, right] = [[x - radius, y], [x + radius, y]];
        let arc =
            |start, end| OutlinePiece::Arc(Arc { centre, radius, start, end, counter_clockwise });
        vec![arc(left, right), arc(right, left)]
    }

    #[test]
    fn a_ring_has_two_curves_and_the_area_between_them() {
        let pieces = [ring([1.0, 2.0], 3.0, true), ring([1.5, 2.0], 1.0, false)].concat();
        assert_eq!(loops(&pieces), 2);
        assert!((area(&pieces) - 8.0 * std::f64::consts::PI).abs() < 1e-12);
    }

    #[test]
    fn a_square_is_one_curve() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let pieces: Vec<OutlinePiece> =
            (0..4).map(|k| OutlinePiece::Segment([corners[k], corners[(k + 1) % 4]])).collect();
        assert_eq!((loops(&pieces), area(&pieces)), (1, 4.0));
    }
}
