use std::f64::consts::TAU;

/// A piece of a drawn line, from start to end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// Part of a circle.
    Arc(Arc),
    /// Straight, from the first to the second place.
    Segment([[f64; 2]; 2]),
}

/// Part of a circle, walked from start to end; if these are the same place, all of it. Rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Centre (x, y).
    pub centre: [f64; 2],
    /// Radius, a length.
    pub radius: f64,
    /// Where the walk begins.
    pub start: [f64; 2],
    /// Where it ends.
    pub end: [f64; 2],
    /// Whether the walk goes counter-clockwise (x to the right, y upwards), so that the centre is
    /// on its left.
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

    /// The angle walked, in radians: positive counter-clockwise, at most 2π in magnitude.
    pub fn sweep(&self) -> f64 {
        let (from, to) =
            if self.counter_clockwise { (self.start, self.end) } else { (self.end, self.start) };
        let angle = match (angle(self.centre, to) - angle(self.centre, from)).rem_euclid(TAU) {
            _ if self.is_circle() => TAU,
            angle => angle,
        };
        if self.counter_clockwise { angle } else { -angle }
    }

    /// The place reached after a share, 0 to 1, of the walk.
    pub fn at(&self, share: f64) -> [f64; 2] {
        at(self.centre, self.radius, self.start_angle() + share * self.sweep())
    }
}

impl Piece {
    /// Where the piece begins and ends.
    pub fn ends(&self) -> [[f64; 2]; 2] {
        match *self {
            Self::Arc(Arc { start, end, .. }) => [start, end],
            Self::Segment(ends) => ends,
        }
    }

    /// The place halfway.
    pub fn middle(&self) -> [f64; 2] {
        match self {
            Self::Arc(arc) => arc.at(0.5),
            Self::Segment([[ax, ay], [bx, by]]) => [(ax + bx) / 2.0, (ay + by) / 2.0],
        }
    }
}

/// The place on a circle at an angle.
pub(super) fn at(centre: [f64; 2], radius: f64, angle: f64) -> [f64; 2] {
    [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()]
}

/// The direction from one place to another, in radians.
pub(super) fn angle(from: [f64; 2], to: [f64; 2]) -> f64 {
    (to[1] - from[1]).atan2(to[0] - from[0])
}

/// The distance of two places.
pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}
