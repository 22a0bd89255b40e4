use walpha_base::vector::{V3, add, along, dot, length, scale, sub};

use super::directions::across;
use crate::scene::Scene;

/// A position whose light is measured: raised a little along `normal` so that neither its own
/// surface hides it, nor anything within `radius` of it.
pub(super) struct Receiver {
    pub place: V3,
    pub normal: V3,
    pub radius: f64,
}

/// A ball that contains the scene.
pub(super) struct Space {
    centre: V3,
    radius: f64,
}

impl Space {
    /// `None` when the scene has no extent, so that nothing hides anything.
    pub(super) fn around(scene: &Scene) -> Option<Self> {
        let [low, high] = scene.bounds()?;
        let radius = length(sub(high, low)) / 2.0;
        let centre = scale(add(low, high), 0.5);
        (radius > 0.0 && radius.is_finite()).then_some(Self { centre, radius })
    }
}

/// The outermost surface seen from far away in one direction, in parallel projection.
pub(super) struct DepthMap {
    /// Axes in texels, and towards the viewer in the units of the scene.
    axes: [V3; 3],
    origin: V3,
    texel: f64,
    heights: Vec<f32>,
}

impl DepthMap {
    /// Texels along each side.
    const SIDE: usize = 512;

    pub(super) fn new(scene: &Scene, space: &Space, direction: V3) -> Self {
        let (u, v) = across(direction);
        let texel = 2.0 * space.radius / (Self::SIDE - 4) as f64;
        let axes = [scale(u, 1.0 / texel), scale(v, 1.0 / texel), direction];
        let heights = vec![f32::NEG_INFINITY; Self::SIDE * Self::SIDE];
        let mut map = Self { axes, origin: space.centre, texel, heights };
        for mesh in scene.meshes.iter().filter(|m| m.opacity >= 1.0) {
            let places: Vec<V3> = mesh.positions.iter().map(|&p| map.place(p)).collect();
            for corners in &mesh.triangles {
                map.draw_triangle(corners.map(|c| places[c as usize]));
            }
        }
        for ball in &scene.balls {
            map.draw_ball(map.place(ball.centre), ball.radius);
        }
        map
    }

    /// Texel position and height.
    fn place(&self, p: V3) -> V3 {
        let p = sub(p, self.origin);
        let half = Self::SIDE as f64 / 2.0;
        [dot(p, self.axes[0]) + half, dot(p, self.axes[1]) + half, dot(p, self.axes[2])]
    }

    fn raise(&mut self, x: usize, y: usize, height: f64) {
        let texel = &mut self.heights[y * Self::SIDE + x];
        *texel = texel.max(height as f32);
    }

    fn draw_triangle(&mut self, [a, b, c]: [V3; 3]) {
        let (ab, ac) = (sub(b, a), sub(c, a));
        let area = ab[0] * ac[1] - ab[1] * ac[0];
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let (x0, x1) = texels(a[0].min(b[0]).min(c[0]), a[0].max(b[0]).max(c[0]));
        let (y0, y1) = texels(a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1]));
        let inverse = 1.0 / area;
        for y in y0..y1 {
            for x in x0..x1 {
                let (px, py) = (x as f64 + 0.5 - a[0], y as f64 + 0.5 - a[1]);
                let s = (px * ac[1] - py * ac[0]) * inverse;
                let t = (py * ab[0] - px * ab[1]) * inverse;
                if s >= 0.0 && t >= 0.0 && s + t <= 1.0 {
                    self.raise(x, y, a[2] + s * ab[2] + t * ac[2]);
                }
            }
        }
    }

    fn draw_ball(&mut self, centre: V3, radius: f64) {
        let reach = radius / self.texel;
        let (x0, x1) = texels(centre[0] - reach, centre[0] + reach);
        let (y0, y1) = texels(centre[1] - reach, centre[1] + reach);
        for y in y0..y1 {
            for x in x0..x1 {
                let (dx, dy) = (x as f64 + 0.5 - centre[0], y as f64 + 0.5 - centre[1]);
                let left = reach * reach - dx * dx - dy * dy;
                if left >= 0.0 {
                    self.raise(x, y, centre[2] + left.sqrt() * self.texel);
                }
            }
        }
    }

    /// How much of a receiver is not hidden in this direction, 0 to 1: the four texels around it.
    pub(super) fn openness(&self, receiver: &Receiver) -> f64 {
        let [x, y, height] = self.place(along(receiver.place, 1.5 * self.texel, receiver.normal));
        let height = height + receiver.radius + 1.5 * self.texel;
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (u, v) = (x - left, y - top);
        let open = |dx: usize, dy: usize| {
            let (x, y) = (left as usize + dx, top as usize + dy);
            let hidden = x < Self::SIDE
                && y < Self::SIDE
                && f64::from(self.heights[y * Self::SIDE + x]) > height;
            if hidden { 0.0 } else { 1.0 }
        };
        let upper = open(0, 0) * (1.0 - u) + open(1, 0) * u;
        let lower = open(0, 1) * (1.0 - u) + open(1, 1) * u;
        upper * (1.0 - v) + lower * v
    }
}

/// Texels whose middle may lie between two positions.
fn texels(low: f64, high: f64) -> (usize, usize) {
    ((low - 0.5).max(0.0) as usize, ((high + 0.5).max(0.0) as usize).min(DepthMap::SIDE))
}
