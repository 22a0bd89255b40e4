//! The light in a scene: lamps, and how much of them and of the sky reaches each position.
//!
//! The exposure is measured with small depth maps from 64 directions of the sky, in opposite pairs, and 16 around the main lamp: a
//! position that is hidden in a map receives no light from its direction. This darkens hollows, even if their surroundings are not visible, and is
//! free of noise.

use walpha_base::parallel::prelude::*;
use walpha_base::vector::{V3, add, along, cross, dot, scale, sub, unit};

use crate::depth::{DepthMap, Directions, Occluders, Receiver, Space};
use crate::normals::vertex_normals;
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

    /// Adds what comes from directions that are open to these shares.
    fn add(&mut self, directions: Directions, open: [f64; 2], up: V3) {
        match directions {
            Directions::Opposite(direction) => {
                let brighter = 0.35 * dot(direction, up);
                let share = 0.5 / SKY_DIRECTIONS as f64;
                let [sky, opposite] =
                    [open[0] * (1.0 + brighter), open[1] * (1.0 - brighter)].map(|sky| sky * share);
                self.mean += sky + opposite;
                self.toward = along(self.toward, sky - opposite, direction);
            }
            Directions::One(_) => self.key += open[0] / KEY_DIRECTIONS as f64,
        }
    }
}

/// The side of a mesh that is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Front,
    Back,
}

/// Normals and light at the vertices of a mesh: dark where that side is not seen.
pub(crate) struct LitMesh {
    pub normals: Vec<V3>,
    front: Vec<Light>,
    /// Empty when the mesh has no visible back.
    back: Vec<Light>,
}

/// The vertices of each mesh whose light is needed: those of triangles that are in the picture, by the side that is seen.
pub(crate) struct Seen(Vec<[Vec<bool>; 2]>);

impl Seen {
    /// None yet.
    pub(crate) fn nothing(scene: &Scene) -> Self {
        let none = |mesh: &Mesh| vec![false; mesh.positions.len()];
        Self(scene.meshes.iter().map(|mesh| [none(mesh), none(mesh)]).collect())
    }

    pub(crate) fn add(&mut self, mesh: usize, corners: [u32; 3], side: Side) {
        corners.iter().for_each(|&c| self.0[mesh][side as usize][c as usize] = true);
    }
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

/// Half of the directions of the sky; the others are opposite to them.
const SKY_DIRECTIONS: usize = 32;
const KEY_DIRECTIONS: usize = 16;
/// The number of depth maps that are made before any is used: bounds memory, and does not depend on the thread count.
const MAPS_AT_ONCE: usize = 16;
/// Receivers that look up one map after the other.
const NEAR: usize = 1024;

impl Exposure {
    pub(crate) fn new(scene: &Scene, studio: &Studio, seen: &Seen) -> Self {
        let normals: Vec<Vec<V3>> = scene.meshes.par_iter().map(mesh_normals).collect();
        let mut receivers = Vec::new();
        let mut lit = Vec::new();
        for ((mesh, normals), seen) in scene.meshes.iter().zip(&normals).zip(&seen.0) {
            let mut of = |vertices: &[u32], sign: f64| {
                receivers.extend(vertices.iter().map(|&vertex| Receiver {
                    place: mesh.positions[vertex as usize],
                    normal: scale(normals[vertex as usize], sign),
                    radius: 0.0,
                }));
            };
            let [front, back] = seen.each_ref().map(|side| -> Vec<u32> {
                (0..).zip(side).filter_map(|(v, &is_seen)| is_seen.then_some(v)).collect()
            });
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
    let sky = hemisphere_directions(SKY_DIRECTIONS).map(Directions::Opposite);
    let lamp = cone_directions(studio.key, KEY_DIRECTIONS).map(Directions::One);
    let lights: Vec<Directions> = sky.chain(lamp).collect();
    let mut light = vec![Light::NONE; receivers.len()];
    let space = Space::around(scene);
    let occluders = space.as_ref().map(|space| Occluders::new(scene, space));
    for some in lights.chunks(MAPS_AT_ONCE) {
        let map = |&light: &Directions| occluders.as_ref().map(|occluders| occluders.map(light));
        let maps: Vec<Option<DepthMap>> = some.par_iter().map(map).collect();
        // Receivers that follow each other are near each other, so that a thread reads a small part of a map at a time.
        let parts = light.par_chunks_mut(NEAR).zip(receivers.par_chunks(NEAR));
        parts.for_each(|(light, receivers)| {
            for (&directions, map) in some.iter().zip(&maps) {
                for (light, receiver) in light.iter_mut().zip(receivers) {
                    let open = map.as_ref().map_or([1.0; 2], |map| map.openness(receiver));
                    light.add(directions, open, studio.up);
                }
            }
        });
    }
    light
}

/// cos and sin of the golden angle π(3 − √5). Turning by it again and again, by complex
/// multiplication, spreads directions evenly without a sine at run time.
const GOLDEN: [f64; 2] = [-0.737_368_878_078_319_7, 0.675_490_294_261_523_8];

/// Directions spread evenly over half the sphere (Fibonacci lattice).
fn hemisphere_directions(count: usize) -> impl Iterator<Item = V3> {
    spiral(count).map(|(share, turn)| {
        let z = 1.0 - share;
        let r = (1.0 - z * z).sqrt();
        [r * turn[0], r * turn[1], z]
    })
}

/// Directions spread evenly over a cone of 11° around an axis: a lamp with soft shadows.
fn cone_directions(axis: V3, count: usize) -> impl Iterator<Item = V3> {
    let (u, v) = across(axis);
    spiral(count).filter_map(move |(share, turn)| {
        let r = 0.2 * share.sqrt();
        unit(along(along(axis, r * turn[0], u), r * turn[1], v))
    })
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
pub(crate) fn across(axis: V3) -> (V3, V3) {
    let smallest = (0..3).fold(0, |s, k| if axis[k].abs() < axis[s].abs() { k } else { s });
    let mut other = [0.0; 3];
    other[smallest] = 1.0;
    let u = unit(cross(axis, other)).expect("the smallest component is not the only one");
    (u, cross(axis, u))
}
