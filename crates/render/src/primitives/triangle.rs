use std::ops::{Add, BitOr, Mul, Sub};

use walpha_base::vector::{V3, add, along, cross, dot, scale, sub, unit};

use super::Primitive;
use crate::light::{Seen, Side, Stage};
use crate::pixels::{Patch, PixelBox, SAMPLE, SAMPLES, STEPS, Size, floor, sample_position};
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
    corners: [[i32; 2]; 3],
    /// Nearness is a·x + b·y + c at pixel position (x, y), and is kept within `range`.
    plane: [f64; 3],
    range: [f64; 2],
    front: bool,
}

/// Corners further than this from the middle of the picture, in pixels, are cut off first: edges
/// then take 50 bits.
const GUARD: f64 = 32768.0;

/// A corner of a triangle, in the eye's axes.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    place: V3,
    /// The place in 1/256 pixel, unless it must be cut off.
    snapped: Option<[i32; 2]>,
}

impl Corner {
    pub(super) fn new(p: V3, lens: &Lens) -> Self {
        let place = lens.view(p);
        let is_inside = (0..SIDES).all(|side| inside(side, place, lens) >= 0.0);
        Self { place, snapped: is_inside.then(|| snap(place, lens)) }
    }
}

impl Triangle {
    /// Adds a triangle, of these numbers of its mesh and in it, as far as it is seen: in several pieces if a part is cut off.
    pub(super) fn add(
        all: &mut Vec<Primitive>,
        mesh: &Mesh,
        [layer, triangle]: [usize; 2],
        corners: [Corner; 3],
        lens: &Lens,
        size: Size,
    ) {
        let v = corners.map(|corner| corner.place);
        let Facing { front, normal, divisor, constant } = Facing::of(&v, lens);
        if !(front || mesh.two_sided) {
            return;
        }
        let mut add = |corners: [[i32; 2]; 3], range: [f64; 2]| {
            let Some(corners) = turned(corners) else { return };
            let end = |k: usize, pick: fn(i32, i32) -> i32| {
                let all = corners.map(|c| c[k]);
                f64::from(pick(pick(all[0], all[1]), all[2])) / f64::from(STEPS)
            };
            let low = [end(0, i32::min), end(1, i32::min)];
            let high = [end(0, i32::max), end(1, i32::max)];
            let bounds = PixelBox::around(low, high, size);
            if bounds.is_empty() {
                return;
            }
            let [cx, cy] = lens.centre;
            let (a, b) = (normal[0] / lens.focal, -normal[1] / lens.focal);
            let plane = [a, b, constant - a * cx - b * cy].map(|p| p / divisor);
            let (mesh, triangle) = (layer as u32, triangle as u32);
            all.push(Primitive::Triangle(Self {
                mesh,
                bounds,
                triangle,
                corners,
                plane,
                range,
                front,
            }));
        };
        let range = |corners: &[V3]| {
            let near = corners.iter().map(|v| lens.nearness(v[2]));
            near.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], n| [l.min(n), h.max(n)])
        };
        if let [Some(a), Some(b), Some(c)] = corners.map(|corner| corner.snapped) {
            add([a, b, c], range(&v));
            return;
        }
        let polygon = clip(&v, lens);
        let Some(&first) = polygon.first() else { return };
        let range = range(&polygon);
        for pair in polygon[1..].windows(2) {
            add([first, pair[0], pair[1]].map(|v| snap(v, lens)), range);
        }
    }

    pub(super) fn cover(&self, within: PixelBox, visit: impl FnMut(&Patch)) {
        let sides = self.sides();
        // Then products of sides take 28 bits, and sums of some of them fewer than 32.
        let is_small = sides.iter().all(|(_, delta)| delta.iter().all(|d| d.abs() < 1 << 14));
        if is_small {
            self.cover_by::<i32>(sides, within, visit);
        } else {
            self.cover_by::<i64>(sides, within, visit);
        }
    }

    /// Where each side begins, and how far it goes.
    fn sides(&self) -> [([i32; 2], [i32; 2]); 3] {
        [0, 1, 2].map(|k| {
            let [from, to] = [self.corners[k], self.corners[(k + 1) % 3]];
            (from, [to[0] - from[0], to[1] - from[1]])
        })
    }

    fn cover_by<I: Whole>(
        &self,
        sides: [([i32; 2], [i32; 2]); 3],
        within: PixelBox,
        mut visit: impl FnMut(&Patch),
    ) {
        let within = self.bounds.meet(within);
        let edges = sides.map(|(from, delta)| Edge::<I>::new(from, delta));
        let mut patch = Patch { x: 0, y: 0, mask: 0, nearness: [0.0; SAMPLES] };
        for y in within.y0..within.y1 {
            for x in within.x0..within.x1 {
                let at = edges.each_ref().map(|e| e.at(x, y));
                if (0..3).any(|k| at[k] + edges[k].most < I::from(0)) {
                    continue;
                }
                patch.mask = 0;
                for k in 0..SAMPLES {
                    let outside = (at[0] + edges[0].step[k])
                        | (at[1] + edges[1].step[k])
                        | (at[2] + edges[2].step[k]);
                    patch.mask |= u16::from(outside >= I::from(0)) << k;
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
        let normal = unit(normal).or_else(|| unit(flat)).unwrap_or([0.0; 3]);
        let normal = scale(normal, toward);
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
        let away = dot(normal, to_eye);
        let outline = (away < 0.0).then(|| unit(along(normal, -away, to_eye))).flatten();
        let normal = outline.unwrap_or(normal);
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

/// Whole numbers that hold products of sides.
trait Whole:
    Copy
    + PartialOrd
    + From<i32>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + BitOr<Output = Self>
{
}
impl Whole for i32 {}
impl Whole for i64 {}

/// One side of a triangle: a function of the position that is not negative inside.
struct Edge<I> {
    from: [i32; 2],
    delta: [I; 2],
    /// −1 where samples exactly on the edge belong to the neighbour.
    bias: I,
    /// The number that each sample of a pixel adds to the value at the pixel's corner, and the largest of these.
    step: [I; SAMPLES],
    most: I,
}

impl<I: Whole> Edge<I> {
    fn new(from: [i32; 2], [dx, dy]: [i32; 2]) -> Self {
        // Moves every sample a little to the right and, far less, down: then none is on an edge, and exactly one of the two
        // directions of an edge owns it.
        let bias = if dy < 0 || (dy == 0 && dx > 0) { 0 } else { -1 };
        let delta = [dx, dy].map(I::from);
        let of = |k: usize| {
            let [x, y] = SAMPLE[k].map(I::from);
            delta[0] * y - delta[1] * x
        };
        // Samples are a grid: rows of four.
        let (first, row, column) = (of(0), of(4) - of(0), of(1) - of(0));
        let mut step = [first; SAMPLES];
        for k in 1..SAMPLES {
            step[k] = if k % 4 == 0 { step[k - 4] + row } else { step[k - 1] + column };
        }
        let most = step.into_iter().fold(first, |most, step| if most < step { step } else { most });
        Self { from, delta, bias: I::from(bias), step, most }
    }

    /// The value at the upper left corner of a pixel.
    fn at(&self, x: i32, y: i32) -> I {
        let [dx, dy] = self.delta;
        let [x, y] = [x * STEPS - self.from[0], y * STEPS - self.from[1]].map(I::from);
        dx * y - dy * x + self.bias
    }
}

/// The corners, ordered so that the area is positive; `None` when the area is zero.
fn turned([a, b, c]: [[i32; 2]; 3]) -> Option<[[i32; 2]; 3]> {
    let side = |p: [i32; 2], k: usize| i64::from(p[k] - a[k]);
    let area = side(b, 0) * side(c, 1) - side(b, 1) * side(c, 0);
    match area {
        0 => None,
        1.. => Some([a, b, c]),
        _ => Some([a, c, b]),
    }
}

/// The place in 1/256 pixel of a corner within [`GUARD`].
fn snap(v: V3, lens: &Lens) -> [i32; 2] {
    lens.pixel(v).map(|p| floor(p * f64::from(STEPS) + 0.5))
}

/// The planes that triangles are cut along: the near one, and four at [`GUARD`].
const SIDES: usize = 5;

/// How far a place in the eye's axes is on the inner side of a plane, below 0 where it is outside.
fn inside(side: usize, v: V3, lens: &Lens) -> f64 {
    let perspective = lens.projection == Projection::Perspective;
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
}

/// The part of a triangle, in the eye's axes, before the near plane and within [`GUARD`].
fn clip(corners: &[V3; 3], lens: &Lens) -> Vec<V3> {
    let mut polygon = corners.to_vec();
    for side in 0..SIDES {
        if polygon.iter().all(|&v| inside(side, v, lens) >= 0.0) {
            continue;
        }
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (k, &to) in polygon.iter().enumerate() {
            let from = polygon[(k + polygon.len() - 1) % polygon.len()];
            let (a, b) = (inside(side, from, lens), inside(side, to, lens));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_to_samples_are_those_of_their_places() {
        for delta in [[3, 5], [-70, 9], [256, -1], [0, 0], [-16_000, -15_000]] {
            let edge = Edge::<i32>::new([0, 0], delta);
            let expected = SAMPLE.map(|[x, y]| delta[0] * y - delta[1] * x);
            assert_eq!(edge.step, expected);
            assert_eq!(Some(&edge.most), expected.iter().max());
        }
    }

    #[test]
    fn small_triangles_cover_the_same_in_fewer_bits() {
        let size = Size::new(200, 150).unwrap();
        let mut random = walpha_base::random::Random::new(1);
        let mut samples = 0;
        for round in 0..300 {
            let most = [300, 16_000, 60_000][round % 3];
            let origin = [0, 1].map(|_| random.below(40_000) as i32 - 4_000);
            let corners = [(); 3].map(|()| origin.map(|x| x + random.below(most) as i32));
            let Some(corners) = turned(corners) else { continue };
            let end = |most: bool| {
                [0, 1].map(|k| {
                    let all = corners.map(|c| f64::from(c[k]) / f64::from(STEPS));
                    all[1..].iter().fold(all[0], |a, &b| if most { a.max(b) } else { a.min(b) })
                })
            };
            let bounds = PixelBox::around(end(false), end(true), size);
            let triangle = Triangle {
                mesh: 0,
                bounds,
                triangle: 0,
                corners,
                plane: [0.0; 3],
                range: [0.0; 2],
                front: true,
            };
            let sides = triangle.sides();
            let mut wide = Vec::new();
            triangle
                .cover_by::<i64>(sides, bounds, |patch| wide.push((patch.x, patch.y, patch.mask)));
            let mut narrow = Vec::new();
            triangle.cover(bounds, |patch| narrow.push((patch.x, patch.y, patch.mask)));
            assert_eq!(wide, narrow, "{corners:?}");
            samples += wide.iter().map(|(_, _, mask)| mask.count_ones()).sum::<u32>();
        }
        assert!(samples > 100_000, "{samples}");
    }
}
