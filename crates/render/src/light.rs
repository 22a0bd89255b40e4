//! The light in a scene: lamps, and how much of them and of the sky reaches each position.
//!
//! The exposure is measured with small depth maps from 64 directions of the sky and 16 around the main lamp: a position that is
//! hidden in a map receives no light from its direction. This darkens hollows, even if their surroundings are not visible, and is
//! free of noise.

use rayon::prelude::*;
use walpha_base::vector::{V3, add, along, cross, dot, length, scale, sub, unit};

use crate::normals::vertex_normals;
use crate::primitives::Facing;
use crate::scene::{Lens, Mesh, Projection, Scene, Shading};

/// The lamps, fixed to the camera as in a photographer's studio, so that every panel of a figure has the same light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Studio {
    /// Towards the main lamp: upper left, before the subject.
    pub key: V3,
    /// Towards the weak lamp that keeps the shadow side readable.
    fill: V3,
    /// The direction up in the picture, where the sky is brighter.
    pub up: V3,
    eye: V3,
    back: V3,
    projection: Projection,
}

/// Shares of light. White that is lit by key and sky is close to 1.
const SKY: f64 = 0.42;
const KEY: f64 = 0.66;
const FILL: f64 = 0.09;
const RIM: f64 = 0.10;
const GLOSS: f64 = 0.035;
/// The share of the key that reaches its own shadow, by reflections.
const SHADOW: f64 = 0.05;

impl Studio {
    pub(crate) fn new(lens: &Lens) -> Self {
        let lamp = |right, up, back| {
            unit(lens.world_direction(right, up, back)).expect("lamps have a direction")
        };
        Self {
            key: lamp(-0.70, 0.72, 0.50),
            fill: lamp(0.80, 0.05, 0.60),
            up: lens.up,
            eye: lens.eye,
            back: scale(lens.forward, -1.0),
            projection: lens.projection,
        }
    }

    /// The unit vector from a place to the eye.
    pub(crate) fn towards_eye(&self, place: V3) -> V3 {
        match self.projection {
            Projection::Perspective => unit(sub(self.eye, place)).unwrap_or(self.back),
            Projection::Orthographic => self.back,
        }
    }

    /// The light that a matt, slightly glossy surface reflects to the eye.
    ///
    /// `sky` is the sky light that reaches the surface, `key` the share of the main lamp; both are 1 in the
    /// open.
    pub(crate) fn shade(
        &self,
        albedo: [f32; 3],
        normal: V3,
        to_eye: V3,
        sky: f64,
        key: f64,
    ) -> [f32; 3] {
        let sky = sky.max(0.0);
        let open = sky.min(1.0);
        let lit = SHADOW + (1.0 - SHADOW) * key;
        let key_light = KEY * lit * dot(normal, self.key).max(0.0);
        let fill_light = FILL * (0.3 + 0.7 * open) * dot(normal, self.fill).max(0.0);
        // Light that enters a hollow is also lost between its walls.
        let matt = SKY * sky * (0.4 + 0.6 * open) + key_light + fill_light;
        let graze = 1.0 - dot(normal, to_eye).clamp(0.0, 1.0);
        let rim = RIM * open * graze * graze * graze * graze;
        let half = unit(add(self.key, to_eye)).unwrap_or(to_eye);
        let gloss = [(); 5].iter().fold(dot(normal, half).max(0.0), |g, ()| g * g);
        let extra = rim + GLOSS * lit * gloss;
        albedo.map(|a| (f64::from(a) * (matt + rim) + extra * 0.5) as f32)
    }
}

/// The inputs of shading.
pub(crate) struct Stage<'a> {
    pub scene: &'a Scene,
    pub lens: Lens,
    pub studio: Studio,
    pub exposure: Exposure,
}

/// The light at a position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Light {
    /// The mean of the sky over all directions.
    pub mean: f64,
    /// The mean of sky times direction. A surface of normal n receives mean + 2·(toward·n): the
    /// first two terms of the light in spherical harmonics (Ramamoorthi and Hanrahan 2001,
    /// doi:10.1145/383259.383317).
    pub toward: V3,
    /// The share of the main lamp that is not hidden.
    pub key: f64,
}

impl Light {
    const NONE: Self = Self { mean: 0.0, toward: [0.0; 3], key: 0.0 };
}

/// The side of a mesh that is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Front,
    Back,
}

/// Normals and light at the vertices of a mesh: dark where no triangle shows the eye that side.
pub(crate) struct LitMesh {
    pub normals: Vec<V3>,
    front: Vec<Light>,
    /// Empty when the mesh has no visible back.
    back: Vec<Light>,
}

/// The vertices of the triangles that show the eye their front, and of those that show it their back.
fn seen(mesh: &Mesh, lens: &Lens) -> [Vec<u32>; 2] {
    let places: Vec<V3> = mesh.positions.par_iter().map(|&place| lens.view(place)).collect();
    let mut is_seen = [vec![false; places.len()], vec![false; places.len()]];
    for corners in &mesh.triangles {
        let facing = Facing::of(&corners.map(|c| places[c as usize]), lens);
        let side = &mut is_seen[usize::from(!facing.front)];
        corners.iter().for_each(|&c| side[c as usize] = true);
    }
    is_seen.map(|side| (0..).zip(side).filter_map(|(v, is_seen)| is_seen.then_some(v)).collect())
}

impl LitMesh {
    pub(crate) fn light(&self, vertex: u32, side: Side) -> Light {
        match side {
            Side::Front => self.front[vertex as usize],
            Side::Back => self.back[vertex as usize],
        }
    }
}

/// Light everywhere in the scene.
pub(crate) struct Exposure {
    pub meshes: Vec<LitMesh>,
    pub balls: Vec<Light>,
    pub tubes: Vec<[Light; 2]>,
}

const SKY_DIRECTIONS: usize = 64;
const KEY_DIRECTIONS: usize = 16;
/// The number of depth maps that are made before any is used: bounds memory, and does not depend on the thread count.
const MAPS_AT_ONCE: usize = 8;

impl Exposure {
    pub(crate) fn new(scene: &Scene, studio: &Studio, lens: &Lens) -> Self {
        let normals: Vec<Vec<V3>> = scene.meshes.par_iter().map(mesh_normals).collect();
        let mut receivers = Vec::new();
        let mut lit = Vec::new();
        for (mesh, normals) in scene.meshes.iter().zip(&normals) {
            let mut of = |vertices: &[u32], sign: f64| {
                receivers.extend(vertices.iter().map(|&vertex| Receiver {
                    place: mesh.positions[vertex as usize],
                    normal: scale(normals[vertex as usize], sign),
                    radius: 0.0,
                }));
            };
            let [front, back] = seen(mesh, lens);
            of(&front, 1.0);
            if mesh.two_sided {
                of(&back, -1.0);
            }
            lit.push((front, mesh.two_sided.then_some(back)));
        }
        let round = |place, radius| Receiver { place, normal: [0.0; 3], radius };
        receivers.extend(scene.balls.iter().map(|b| round(b.centre, b.radius)));
        receivers.extend(scene.tubes.iter().flat_map(|t| t.ends.map(|p| round(p, t.radius))));

        let mut light = measure(scene, studio, &receivers).into_iter();
        let mut take = |count: usize| light.by_ref().take(count).collect::<Vec<_>>();
        let meshes = lit
            .into_iter()
            .zip(normals)
            .map(|((front, back), normals)| {
                let mut all = |vertices: Vec<u32>| {
                    let mut all = vec![Light::NONE; normals.len()];
                    let light = take(vertices.len());
                    vertices.iter().zip(light).for_each(|(&v, light)| all[v as usize] = light);
                    all
                };
                let front = all(front);
                let back = back.map_or_else(Vec::new, all);
                LitMesh { normals, front, back }
            })
            .collect();
        let balls = take(scene.balls.len());
        let tubes = (0..scene.tubes.len()).map(|_| take(2).try_into().expect("two ends")).collect();
        Self { meshes, balls, tubes }
    }
}

fn mesh_normals(mesh: &Mesh) -> Vec<V3> {
    match (&mesh.normals, mesh.shading) {
        (Some(given), Shading::Smooth) => {
            given.iter().map(|&n| unit(n).unwrap_or([0.0; 3])).collect()
        }
        _ => vertex_normals(&mesh.positions, &mesh.triangles),
    }
}

fn measure(scene: &Scene, studio: &Studio, receivers: &[Receiver]) -> Vec<Light> {
    let sky = sphere_directions(SKY_DIRECTIONS);
    let lamp = cone_directions(studio.key, KEY_DIRECTIONS);
    let directions: Vec<V3> = sky.into_iter().chain(lamp).collect();
    let mut light = vec![Light::NONE; receivers.len()];
    let space = Space::around(scene);
    for (chunk, some) in directions.chunks(MAPS_AT_ONCE).enumerate() {
        let maps: Option<Vec<DepthMap>> = space
            .as_ref()
            .map(|space| some.par_iter().map(|&d| DepthMap::new(scene, space, d)).collect());
        light.par_iter_mut().zip(receivers).for_each(|(light, receiver)| {
            for (k, &direction) in some.iter().enumerate() {
                let open = maps.as_ref().map_or(1.0, |maps| maps[k].openness(receiver));
                if chunk * MAPS_AT_ONCE + k < SKY_DIRECTIONS {
                    let sky = open * (1.0 + 0.35 * dot(direction, studio.up));
                    let sky = sky / SKY_DIRECTIONS as f64;
                    light.mean += sky;
                    light.toward = along(light.toward, sky, direction);
                } else {
                    light.key += open / KEY_DIRECTIONS as f64;
                }
            }
        });
    }
    light
}

/// cos and sin of the golden angle π(3 − √5). Turning by it again and again, by complex
/// multiplication, spreads directions evenly without a sine at run time.
const GOLDEN: [f64; 2] = [-0.737_368_878_078_319_7, 0.675_490_294_261_523_8];

/// Directions spread evenly over the sphere (Fibonacci lattice).
fn sphere_directions(count: usize) -> Vec<V3> {
    spiral(count)
        .map(|(share, turn)| {
            let z = 1.0 - 2.0 * share;
            let r = (1.0 - z * z).sqrt();
            [r * turn[0], r * turn[1], z]
        })
        .collect()
}

/// Directions spread evenly over a cone of 11° around an axis: a lamp with soft shadows.
fn cone_directions(axis: V3, count: usize) -> Vec<V3> {
    let (u, v) = across(axis);
    spiral(count)
        .filter_map(|(share, turn)| {
            let r = 0.2 * share.sqrt();
            unit(along(along(axis, r * turn[0], u), r * turn[1], v))
        })
        .collect()
}

/// The midpoints of `count` equal parts of 0..1, each with a unit vector that the golden angle turns further.
fn spiral(count: usize) -> impl Iterator<Item = (f64, [f64; 2])> {
    let mut turn = [1.0, 0.0];
    (0..count).map(move |k| {
        let [x, y] = turn;
        turn = [x * GOLDEN[0] - y * GOLDEN[1], x * GOLDEN[1] + y * GOLDEN[0]];
        ((k as f64 + 0.5) / count as f64, [x, y])
    })
}

/// Two unit vectors that are orthogonal to this one and to each other.
fn across(axis: V3) -> (V3, V3) {
    let smallest = (0..3).fold(0, |s, k| if axis[k].abs() < axis[s].abs() { k } else { s });
    let mut other = [0.0; 3];
    other[smallest] = 1.0;
    let u = unit(cross(axis, other)).expect("the smallest component is not the only one");
    (u, cross(axis, u))
}

/// A position whose light is measured. It is raised a little along `normal`, so that neither its own surface nor anything within
/// `radius` of it hides it.
struct Receiver {
    pub place: V3,
    pub normal: V3,
    pub radius: f64,
}

/// A ball around the scene.
struct Space {
    centre: V3,
    radius: f64,
}

impl Space {
    /// `None` if the scene has no extent, so that nothing hides anything.
    fn around(scene: &Scene) -> Option<Self> {
        let [low, high] = scene.bounds()?;
        let radius = length(sub(high, low)) / 2.0;
        let centre = scale(add(low, high), 0.5);
        (radius > 0.0 && radius.is_finite()).then_some(Self { centre, radius })
    }
}

/// The outermost surface seen from far away in one direction, in parallel projection.
struct DepthMap {
    /// Two axes in texels, and one towards the viewer in the units of the scene.
    axes: [V3; 3],
    origin: V3,
    texel: f64,
    heights: Vec<f32>,
}

impl DepthMap {
    /// Texels along each side.
    const SIDE: usize = 512;

    fn new(scene: &Scene, space: &Space, direction: V3) -> Self {
        let (u, v) = across(direction);
        let texel = 2.0 * space.radius / (Self::SIDE - 4) as f64;
        let axes = [scale(u, 1.0 / texel), scale(v, 1.0 / texel), direction];
        let heights = vec![f32::NEG_INFINITY; Self::SIDE * Self::SIDE];
        let mut map = Self { axes, origin: space.centre, texel, heights };
        for mesh in scene.meshes.iter().filter(|m| m.opacity >= 1.0) {
            let places: Vec<V3> = mesh.positions.iter().map(|&p| map.place(p)).collect();
            for corners in &mesh.triangles {
                let [a, b, c] = corners.map(|c| places[c as usize]);
                // The outermost surface of a solid faces the light.
                let up = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                if up > 0.0 || mesh.two_sided {
                    map.draw_triangle([a, b, c]);
                }
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

    #[expect(
        clippy::needless_bitwise_bool,
        reason = "several texels are done at a time where there is no branch"
    )]
    fn draw_triangle(&mut self, [a, b, c]: [V3; 3]) {
        // Most triangles of a large mesh lie between the centres of texels.
        let (x0, x1) = texels(a[0].min(b[0]).min(c[0]), a[0].max(b[0]).max(c[0]));
        let (y0, y1) = texels(a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1]));
        if x0 >= x1 || y0 >= y1 {
            return;
        }
        let (ab, ac) = (sub(b, a), sub(c, a));
        let area = ab[0] * ac[1] - ab[1] * ac[0];
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let inverse = 1.0 / area;
        for y in y0..y1 {
            let py = y as f64 + 0.5 - a[1];
            let (sy, ty) = (py * ac[0], py * ab[0]);
            let row = &mut self.heights[y * Self::SIDE..][x0..x1];
            for (x, texel) in (x0 as i32..).zip(row) {
                let px = f64::from(x) + 0.5 - a[0];
                let s = (px * ac[1] - sy) * inverse;
                let t = (ty - px * ab[1]) * inverse;
                let is_inside = (s >= 0.0) & (t >= 0.0) & (s + t <= 1.0);
                let height = (a[2] + s * ab[2] + t * ac[2]) as f32;
                *texel = if is_inside & (height > *texel) { height } else { *texel };
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

    /// The share of a receiver that is visible from this direction, 0 to 1, interpolated between the four texels around it.
    fn openness(&self, receiver: &Receiver) -> f64 {
        let [x, y, height] = self.place(along(receiver.place, 1.5 * self.texel, receiver.normal));
        let height = height + receiver.radius + 1.5 * self.texel;
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (floor(x), floor(y));
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

/// Texels whose centre may lie between two positions.
fn texels(low: f64, high: f64) -> (usize, usize) {
    let low = (low - 0.5).max(0.0);
    let whole = low as u32;
    let first = whole + u32::from(f64::from(whole) < low);
    (first as usize, ((high + 0.5).max(0.0) as u32 as usize).min(DepthMap::SIDE))
}

/// The largest whole number not above one that is far smaller than 2³¹: faster than a call of the library of the system.
fn floor(x: f64) -> f64 {
    let whole = f64::from(x as i32);
    if whole > x { whole - 1.0 } else { whole }
}
