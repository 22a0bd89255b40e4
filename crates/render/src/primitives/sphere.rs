use walpha_base::vector::{V3, add, along, dot, scale, sub, unit};

use crate::light::Stage;
use crate::pixels::{Patch, PixelBox, SAMPLES, Size, sample_position};
use crate::scene::{Ball, Lens, Projection};

/// A ball on the pixel grid, with the exact outline and depth of a sphere.
pub(crate) struct Sphere {
    pub bounds: PixelBox,
    ball: u32,
    /// The centre in the axes of the eye.
    centre: V3,
    radius: f64,
}

impl Sphere {
    /// `None` when it is out of the picture, or reaches the eye.
    pub(super) fn new(ball: &Ball, index: usize, lens: &Lens, size: Size) -> Option<Self> {
        let centre = lens.view(ball.centre);
        if ball.radius <= 0.0 || centre[2] - ball.radius < lens.near {
            return None;
        }
        let [low, high] = outline(centre, ball.radius, lens);
        let bounds = PixelBox::around(low, high, size);
        (!bounds.is_empty()).then_some(Self {
            bounds,
            ball: index as u32,
            centre,
            radius: ball.radius,
        })
    }

    pub(super) fn cover(&self, lens: &Lens, within: PixelBox, mut visit: impl FnMut(&Patch)) {
        let within = self.bounds.meet(within);
        let mut patch = Patch { x: 0, y: 0, mask: 0, nearness: [0.0; SAMPLES] };
        for y in within.y0..within.y1 {
            for x in within.x0..within.x1 {
                patch.mask = 0;
                for k in 0..SAMPLES {
                    let [x, y] = sample_position(x, y, k);
                    let (origin, direction) = lens.ray(x, y);
                    if let Some(t) = entry(origin, direction, self.centre, self.radius) {
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
        let t = entry(origin, direction, self.centre, self.radius);
        let p = along(origin, t.unwrap_or(self.centre[2]), direction);
        let normal = unit(sub(p, self.centre)).unwrap_or([0.0, 0.0, -1.0]);
        let normal = lens.world_direction(normal[0], normal[1], -normal[2]);
        let ball = &stage.scene.balls[self.ball as usize];
        let light = &stage.exposure.balls[self.ball as usize];
        let to_eye = stage.studio.towards_eye(add(ball.centre, scale(normal, self.radius)));
        let sky = light.mean + 2.0 * dot(light.toward, normal);
        stage.studio.shade(ball.colour.light(), normal, to_eye, sky, light.key)
    }
}

/// The corners of a sphere's box in pixels, by its tangent planes through the eye, which must be
/// outside.
pub(super) fn outline(centre: V3, radius: f64, lens: &Lens) -> [[f64; 2]; 2] {
    let ends = |x: f64| match lens.projection {
        Projection::Orthographic => [x - radius, x + radius],
        Projection::Perspective => {
            let z = centre[2];
            let square = z * z - radius * radius;
            let root = (x * x + square).sqrt() * radius;
            [(x * z - root) / square, (x * z + root) / square]
        }
    };
    let ([left, right], [bottom, top]) = (ends(centre[0]), ends(centre[1]));
    let [cx, cy] = lens.centre;
    [
        [cx + left * lens.focal, cy - top * lens.focal],
        [cx + right * lens.focal, cy - bottom * lens.focal],
    ]
}

/// The point where a line of sight enters a sphere.
pub(super) fn entry(origin: V3, direction: V3, centre: V3, radius: f64) -> Option<f64> {
    let to_centre = sub(centre, origin);
    let a = dot(direction, direction);
    let b = dot(direction, to_centre);
    let c = dot(to_centre, to_centre) - radius * radius;
    let root = b * b - a * c;
    (root >= 0.0).then(|| (b - root.sqrt()) / a)
}
