//! The share of the sky and of the main lamp that reaches each vertex, ball and tube: small depth maps are made from
//! 64 directions of the sky and 16 around the lamp, and whatever is hidden in a map gets no light from its direction.
//! This darkens hollows by what surrounds them, visible or not, and is free of noise.

use rayon::prelude::*;
use walpha_base::vector::{V3, along, dot, scale, unit};

use super::depth_map::{DepthMap, Receiver, Space};
use super::directions::{cone_directions, sphere_directions};
use super::studio::Studio;
use crate::normals::vertex_normals;
use crate::scene::{Mesh, Scene, Shading};

/// The light that reaches one position.
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

/// Which side of a mesh is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Front,
    Back,
}

/// Normals and light at the vertices of a mesh.
pub(crate) struct LitMesh {
    pub normals: Vec<V3>,
    front: Vec<Light>,
    /// Empty when the mesh has no visible back.
    back: Vec<Light>,
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
/// Depth maps made before any is used: bounds memory, and does not depend on the thread count.
const MAPS_AT_ONCE: usize = 8;

impl Exposure {
    pub(crate) fn new(scene: &Scene, studio: &Studio) -> Self {
        let normals: Vec<Vec<V3>> = scene.meshes.par_iter().map(mesh_normals).collect();
        let mut receivers = Vec::new();
        for (mesh, normals) in scene.meshes.iter().zip(&normals) {
            let sides: &[f64] = if mesh.two_sided { &[1.0, -1.0] } else { &[1.0] };
            for &side in sides {
                let pairs = mesh.positions.iter().zip(normals);
                receivers.extend(pairs.map(|(&place, &normal)| Receiver {
                    place,
                    normal: scale(normal, side),
                    radius: 0.0,
                }));
            }
        }
        let round = |place, radius| Receiver { place, normal: [0.0; 3], radius };
        receivers.extend(scene.balls.iter().map(|b| round(b.centre, b.radius)));
        receivers.extend(scene.tubes.iter().flat_map(|t| t.ends.map(|p| round(p, t.radius))));

        let mut light = measure(scene, studio, &receivers).into_iter();
        let mut take = |count: usize| light.by_ref().take(count).collect::<Vec<_>>();
        let meshes = scene
            .meshes
            .iter()
            .zip(normals)
            .map(|(mesh, normals)| {
                let count = mesh.positions.len();
                let front = take(count);
                let back = take(if mesh.two_sided { count } else { 0 });
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
    let mut light = vec![Light { mean: 0.0, toward: [0.0; 3], key: 0.0 }; receivers.len()];
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
