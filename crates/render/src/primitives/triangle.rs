use walpha_base::vector::{V3, add, along, cross, dot, scale, sub, unit};

use crate::light::{Seen, Side, Stage};
use crate::pixels::{Patch, PixelBox, SAMPLE, SAMPLES, STEPS, Size, sample_position};
use crate::scene::{Colours, Lens, Mesh, Projection, Scene, Shading};

/// A triangle on the pixel grid, or a part of one that extends beyond the picture.
///
/// Corners are snapped to 1/256 pixel and edges decided in integers, so triangles that share an
/// edge neither leave a gap nor cover a sample twice.
pub(crate) struct Triangle {
    pub mesh: u32,
    pub bounds: PixelBox,
    triangle: u32,
    /// The corners in 1/256 pixel, ordered so that the area is positive.
    corners: [[i64; 2]; 3],
    /// Nearness is a·x + b·y + c at pixel position (x, y), and is kept within `range`.
    plane: [f64; 3],
    range: [f64; 2],
    front: bool,
}

/// Corners further than this from the middle of the picture, in pixels, are cut off first: edges
/// then take 50 bits.
const GUARD: f64 = 32768.0;

impl Triangle {
    pub(super) fn pieces(
        mesh: &Mesh,
        layer: usize,
        triangle: usize,
        lens: &Lens,
        size: Size,
    ) -> Vec<Self> {
        let v = mesh.triangles[triangle].map(|c| lens.view(mesh.positions[c as usize]));
        let Facing { front, normal, divisor, constant } = Facing::of(&v, lens);
        if !(front || mesh.two_sided) {
            return Vec::new();
        }
        let [cx, cy] = lens.centre;
        let (a, b) = (normal[0] / lens.focal, -normal[1] / lens.focal);
        let plane = [a, b, constant - a * cx - b * cy].map(|p| p / divisor);
        let polygon = clip(&v, lens);
        let Some(&first) = polygon.first() else { return Vec::new() };
        let near = polygon.iter().map(|v| lens.nearness(v[2]));
        let range = near.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], n| [l.min(n), h.max(n)]);
        let snap = |v: V3| lens.pixel(v).map(|p| (p * STEPS as f64 + 0.5).floor() as i64);
        polygon[1..]
            .windows(2)
            .filter_map(|pair| {
                let corners = turned([snap(first), snap(pair[0]), snap(pair[1])])?;
                let end = |k: usize, pick: fn(i64, i64) -> i64| {
                    let all = corners.map(|c| c[k]);
                    pick(pick(all[0], all[1]), all[2]) as f64 / STEPS as f64
                };
                let low = [end(0, i64::min), end(1, i64::min)];
                let high = [end(0, i64::max), end(1, i64::max)];
                let bounds = PixelBox::around(low, high, size);
                (!bounds.is_empty()).then_some(Self {
                    mesh: layer as u32,
                    bounds,
                    triangle: triangle as u32,
                    corners,
                    plane,
                    range,
                    front,
                })
            })
            .collect()
    }

    pub(super) fn cover(&self, within: PixelBox, mut visit: impl FnMut(&Patch)) {
        let within = self.bounds.meet(within);
        let edges = [0, 1, 2].map(|k| Edge::new(self.corners[k], self.corners[(k + 1) % 3]));
        let mut patch = Patch { x: 0, y: 0, mask: 0, nearness: [0.0; SAMPLES] };
        for y in within.y0..within.y1 {
            for x in within.x0..within.x1 {
                let at = edges.each_ref().map(|e| e.at(x, y));
                if (0..3).any(|k| at[k] + edges[k].most < 0) {
                    continue;
                }
                patch.mask = 0;
                for k in 0..SAMPLES {
                    let outside = (at[0] + edges[0].step[k])
                        | (at[1] + edges[1].step[k])
                        | (at[2] + edges[2].step[k]);
                    patch.mask |= u16::from(outside >= 0) << k;
                }
                if patch.mask != 0 {
                    (patch.x, patch.y) = (x, y);
                    let [a, b, c] = self.plane;
                    for (k, nearness) in patch.nearness.iter_mut().enumerate() {
                        let [x, y] = sample_position(x, y, k);
                        // This order turns the NaN of a plane seen edge-on into a number.
                        let n = (a * x + b * y + c).max(self.range[0]).min(self.range[1]);
                        *nearness = n as f32;
                    }
                    visit(&patch);
                }
            }
        }
    }

    pub(super) fn note(&self, scene: &Scene, seen: &mut Seen) {
        let mesh = self.mesh as usize;
        seen.add(mesh, scene.meshes[mesh].triangles[self.triangle as usize], self.side());
    }

    fn side(&self) -> Side {
        if self.front { Side::Front } else { Side::Back }
    }

    pub(super) fn shade(&self, stage: &Stage, x: f64, y: f64) -> [f32; 3] {
        let mesh = &stage.scene.meshes[self.mesh as usize];
        let corners = mesh.triangles[self.triangle as usize];
        let places = corners.map(|c| mesh.positions[c as usize]);
        let flat = cross(sub(places[1], places[0]), sub(places[2], places[0]));
        let weights = weights(stage, &places, flat, x, y);
        let blend = |each: [V3; 3]| {
            let sum = add(scale(each[0], weights[0]), scale(each[1], weights[1]));
            along(sum, weights[2], each[2])
        };
        let lit = &stage.exposure.meshes[self.mesh as usize];
        let toward = if self.front { 1.0 } else { -1.0 };
        let normal = match mesh.shading {
            Shading::Flat => flat,
            Shading::Smooth => blend(corners.map(|c| lit.normals[c as usize])),
        };
        let normal = scale(unit(normal).or(unit(flat)).unwrap_or([0.0; 3]), toward);
        let light = corners.map(|c| lit.light(c, self.side()));
        let albedo = match &mesh.colours {
            Colours::Uniform(colour) => colour.light(),
            Colours::Vertex(each) => {
                let light = corners.map(|c| each[c as usize].light().map(f64::from));
                blend(light).map(|c| c as f32)
            }
        };
        let place = blend(places);
        let to_eye = stage.studio.towards_eye(place);
        // Blended normals of facets near the outline may point away: bring them to the outline.
        let away = dot(normal, to_eye).min(0.0);
        let normal = unit(along(normal, -away, to_eye)).unwrap_or(normal);
        let sky = blend(light.map(|l| l.toward));
        let [mean, key, _] = blend(light.map(|l| [l.mean, l.key, 0.0]));
        stage.studio.shade(albedo, normal, to_eye, mean + 2.0 * dot(sky, normal), key)
    }
}

/// Which side of a triangle is seen, and the numbers of its plane.
struct Facing {
    front: bool,
    normal: V3,
    divisor: f64,
    constant: f64,
}

impl Facing {
    /// Of corners in the eye's axes. These are left-handed, so that the normal points away from the outside.
    fn of(v: &[V3; 3], lens: &Lens) -> Self {
        let normal = cross(sub(v[1], v[0]), sub(v[2], v[0]));
        let offset = dot(normal, v[0]);
        match lens.projection {
            Projection::Perspective => {
                Self { front: offset > 0.0, normal, divisor: offset, constant: normal[2] }
            }
            Projection::Orthographic => {
                Self { front: normal[2] > 0.0, normal, divisor: normal[2], constant: -offset }
            }
        }
    }
}

/// Barycentric coordinates of the point seen at a pixel position.
fn weights(stage: &Stage, places: &[V3; 3], flat: V3, x: f64, y: f64) -> [f64; 3] {
    let lens = &stage.lens;
    let (origin, direction) = lens.ray(x, y);
    let world = |v: V3| lens.world_direction(v[0], v[1], -v[2]);
    let (origin, direction) = (add(lens.eye, world(origin)), world(direction));
    let t = dot(flat, sub(places[0], origin)) / dot(flat, direction);
    let p = along(origin, t, direction);
    let part = |a: V3, b: V3| dot(flat, cross(sub(a, p), sub(b, p))).max(0.0);
    let w = [part(places[1], places[2]), part(places[2], places[0]), part(places[0], places[1])];
    let sum = w[0] + w[1] + w[2];
    if sum > 0.0 && sum.is_finite() { w.map(|w| w / sum) } else { [1.0 / 3.0; 3] }
}

/// One side of a triangle: a function of the position that is not negative inside.
struct Edge {
    from: [i64; 2],
    delta: [i64; 2],
    /// −1 where samples exactly on the edge belong to the neighbour.
    bias: i64,
    /// The number that each sample of a pixel adds to the value at the pixel's corner, and the largest of these.
    step: [i64; SAMPLES],
    most: i64,
}

impl Edge {
    fn new(from: [i64; 2], to: [i64; 2]) -> Self {
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let step = SAMPLE.map(|[x, y]| dx * y - dy * x);
        // Moves every sample a little to the right and, far less, down: then none is on an edge, and exactly one of the two
        // directions of an edge owns it.
        let bias = if dy < 0 || (dy == 0 && dx > 0) { 0 } else { -1 };
        let most = step.into_iter().fold(i64::MIN, i64::max);
        Self { from, delta: [dx, dy], bias, step, most }
    }

    /// The value at the upper left corner of a pixel.
    fn at(&self, x: i32, y: i32) -> i64 {
        let [dx, dy] = self.delta;
        let (x, y) = (i64::from(x) * STEPS - self.from[0], i64::from(y) * STEPS - self.from[1]);
        dx * y - dy * x + self.bias
    }
}

/// The corners, ordered so that the area is positive; `None` when the area is zero.
fn turned([a, b, c]: [[i64; 2]; 3]) -> Option<[[i64; 2]; 3]> {
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    match area {
        0 => None,
        1.. => Some([a, b, c]),
        _ => Some([a, c, b]),
    }
}

/// The part of a triangle, in the eye's axes, before the near plane and within [`GUARD`].
fn clip(corners: &[V3; 3], lens: &Lens) -> Vec<V3> {
    let perspective = lens.projection == Projection::Perspective;
    let inside = |side: usize, v: V3| {
        let reach = GUARD / lens.focal * if perspective { v[2] } else { 1.0 };
        match side {
            0 => {
                if perspective {
                    v[2] - lens.near
                } else {
                    1.0
                }
            }
            1 => reach - v[0],
            2 => reach + v[0],
            3 => reach - v[1],
            _ => reach + v[1],
        }
    };
    let mut polygon = corners.to_vec();
    for side in 0..5 {
        if polygon.iter().all(|&v| inside(side, v) >= 0.0) {
            continue;
        }
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (k, &to) in polygon.iter().enumerate() {
            let from = polygon[(k + polygon.len() - 1) % polygon.len()];
            let (a, b) = (inside(side, from), inside(side, to));
            if (a < 0.0) != (b < 0.0) {
                kept.push(along(from, a / (a - b), sub(to, from)));
            }
            if b >= 0.0 {
                kept.push(to);
            }
        }
        polygon = kept;
    }
    polygon
}
