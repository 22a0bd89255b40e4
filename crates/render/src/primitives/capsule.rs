use walpha_base::vector::{self, V3, along, dot, scale, sub, unit};

use super::sphere;
use crate::light::Stage;
use crate::pixels::{Patch, PixelBox, SAMPLES, Size, sample_position};
use crate::scene::{Lens, Tube};

/// A tube with round ends on the pixel grid.
pub(crate) struct Capsule {
    pub bounds: PixelBox,
    tube: u32,
    /// The ends in the axes of the eye, cut off where the tube would reach the eye.
    ends: [V3; 2],
    radius: f64,
    /// The ends in pixels. No pixel whose centre is further than `reach` from the line between them is
    /// touched.
    line: [[f64; 2]; 2],
    reach: f64,
}

impl Capsule {
    /// `None` when it is out of the picture.
    pub(super) fn new(tube: &Tube, index: usize, lens: &Lens, size: Size) -> Option<Self> {
        let ends = cut(tube.ends.map(|p| lens.view(p)), lens.near + tube.radius)?;
        let radius = tube.radius;
        let boxes = ends.map(|end| sphere::outline(end, radius, lens));
        let low = [0, 1].map(|k| boxes[0][0][k].min(boxes[1][0][k]));
        let high = [0, 1].map(|k| boxes[0][1][k].max(boxes[1][1][k]));
        let bounds = PixelBox::around(low, high, size);
        let widest = boxes.iter().flat_map(|[l, h]| [h[0] - l[0], h[1] - l[1]]).fold(0.0, f64::max);
        let line = ends.map(|end| lens.pixel(end));
        (radius > 0.0 && !bounds.is_empty()).then_some(Self {
            bounds,
            tube: index as u32,
            ends,
            radius,
            line,
            reach: widest + 1.0,
        })
    }

    pub(super) fn cover(&self, lens: &Lens, within: PixelBox, mut visit: impl FnMut(&Patch)) {
        let within = self.bounds.meet(within);
        let mut patch = Patch { x: 0, y: 0, mask: 0, nearness: [0.0; SAMPLES] };
        for y in within.y0..within.y1 {
            for x in within.x0..within.x1 {
                if self.is_far(f64::from(x) + 0.5, f64::from(y) + 0.5) {
                    continue;
                }
                patch.mask = 0;
                for k in 0..SAMPLES {
                    let [x, y] = sample_position(x, y, k);
                    let (origin, direction) = lens.ray(x, y);
                    if let Some(t) = self.entry(origin, direction) {
                        patch.mask |= 1 << k;
                        patch.nearness[k] = lens.nearness(t) as f32;
                    }
                }
                if patch.mask != 0 {
                    (patch.x, patch.y) = (x, y);
                    visit(&patch);
                }
            }
        }
    }

    pub(super) fn shade(&self, stage: &Stage, x: f64, y: f64) -> [f32; 3] {
        let lens = &stage.lens;
        let (origin, direction) = lens.ray(x, y);
        let [a, b] = self.ends;
        let t = self.entry(origin, direction).unwrap_or(f64::midpoint(a[2], b[2]));
        let p = along(origin, t, direction);
        let axis = sub(b, a);
        let share = dot(axis, sub(p, a)) / dot(axis, axis).max(f64::MIN_POSITIVE);
        let share = vector::saturate(share);
        let normal = unit(sub(p, along(a, share, axis))).unwrap_or([0.0, 0.0, -1.0]);
        let world = |v: V3| lens.world_direction(v[0], v[1], -v[2]);
        let (normal, place) = (world(normal), along(lens.eye, 1.0, world(p)));
        let tube = &stage.scene.tubes[self.tube as usize];
        let [from, to] = &stage.exposure.tubes[self.tube as usize];
        let mean = from.mean + (to.mean - from.mean) * share;
        let key = from.key + (to.key - from.key) * share;
        let toward = along(scale(from.toward, 1.0 - share), share, to.toward);
        let to_eye = stage.studio.towards_eye(place);
        let sky = mean + 2.0 * dot(toward, normal);
        stage.studio.shade(tube.colour.light(), normal, to_eye, sky, key)
    }

    fn is_far(&self, x: f64, y: f64) -> bool {
        let [a, b] = self.line;
        let (u, v) = ([b[0] - a[0], b[1] - a[1]], [x - a[0], y - a[1]]);
        let share = (u[0] * v[0] + u[1] * v[1]) / (u[0] * u[0] + u[1] * u[1]);
        let share = vector::saturate(share);
        let off = [v[0] - share * u[0], v[1] - share * u[1]];
        off[0] * off[0] + off[1] * off[1] > self.reach * self.reach
    }

    /// The point where a line of sight enters the tube.
    fn entry(&self, origin: V3, direction: V3) -> Option<f64> {
        let [a, b] = self.ends;
        let (axis, w) = (sub(b, a), sub(origin, a));
        let square = dot(axis, axis);
        let (along_axis, start) = (dot(axis, direction), dot(axis, w));
        let across = dot(direction, direction) * square - along_axis * along_axis;
        if across <= 1e-12 * square {
            // Seen end-on, or both ends at one position: only the nearer cap is visible.
            let nearer = if a[2] <= b[2] { a } else { b };
            return sphere::entry(origin, direction, nearer, self.radius);
        }
        let half = dot(direction, w) * square - along_axis * start;
        let rest = (dot(w, w) - self.radius * self.radius) * square - start * start;
        let root = half * half - across * rest;
        if root < 0.0 {
            return None;
        }
        let t = (-half - root.sqrt()) / across;
        let at = start + t * along_axis;
        // A line that enters the infinite cylinder beyond an end can enter the tube only through that cap.
        if at < 0.0 {
            sphere::entry(origin, direction, a, self.radius)
        } else if at > square {
            sphere::entry(origin, direction, b, self.radius)
        } else {
            Some(t)
        }
    }
}

/// The part of a segment at this depth or beyond.
fn cut([a, b]: [V3; 2], depth: f64) -> Option<[V3; 2]> {
    let moved = |from: V3, to: V3| {
        if from[2] >= depth {
            from
        } else {
            along(from, (depth - from[2]) / (to[2] - from[2]), sub(to, from))
        }
    };
    (a[2] >= depth || b[2] >= depth).then(|| [moved(a, b), moved(b, a)])
}
