//! Triangles, balls and tubes on the pixel grid: the samples that each covers, and its colour there.

mod capsule;
mod sphere;
mod triangle;

use walpha_base::parallel::prelude::*;

use crate::light::{Seen, Stage};
use crate::pixels::{Patch, PixelBox, Size};
use crate::scene::{Lens, Scene};
use capsule::Capsule;
use sphere::Sphere;
use triangle::{Corner, Triangle};

/// A triangle, ball or tube.
pub(crate) enum Primitive {
    Triangle(Triangle),
    Sphere(Sphere),
    Capsule(Capsule),
}

/// Triangles that are placed one after the other.
const TOGETHER: usize = 4096;

impl Primitive {
    /// The primitives of a scene that may be in the picture.
    pub(crate) fn all(scene: &Scene, lens: &Lens, size: Size) -> Vec<Self> {
        let mut all = Vec::new();
        for (number, mesh) in scene.meshes.iter().enumerate() {
            if mesh.opacity > 0.0 {
                let corners: Vec<Corner> =
                    mesh.positions.par_iter().map(|&p| Corner::new(p, lens)).collect();
                let some = |(part, triangles): (usize, &[[u32; 3]])| {
                    let mut some = Vec::new();
                    for (triangle, vertices) in (part * TOGETHER..).zip(triangles) {
                        let corners = vertices.map(|v| corners[v as usize]);
                        Triangle::add(&mut some, mesh, [number, triangle], corners, lens, size);
                    }
                    some
                };
                let parts = mesh.triangles.par_chunks(TOGETHER).enumerate();
                all.extend(parts.map(some).collect::<Vec<_>>().into_iter().flatten());
            }
        }
        let spheres = scene.balls.iter().enumerate();
        all.extend(spheres.filter_map(|(k, b)| Sphere::new(b, k, lens, size)).map(Self::Sphere));
        let tubes = scene.tubes.iter().enumerate();
        all.extend(tubes.filter_map(|(k, t)| Capsule::new(t, k, lens, size)).map(Self::Capsule));
        all
    }

    pub(crate) fn bounds(&self) -> PixelBox {
        match self {
            Self::Triangle(t) => t.bounds,
            Self::Sphere(s) => s.bounds,
            Self::Capsule(c) => c.bounds,
        }
    }

    pub(crate) fn cover(&self, lens: &Lens, within: PixelBox, visit: impl FnMut(&Patch)) {
        match self {
            Self::Triangle(t) => t.cover(within, visit),
            Self::Sphere(s) => s.cover(lens, within, visit),
            Self::Capsule(c) => c.cover(lens, within, visit),
        }
    }

    /// Notes whose light its shading needs.
    pub(crate) fn note(&self, scene: &Scene, seen: &mut Seen) {
        if let Self::Triangle(t) = self {
            t.note(scene, seen);
        }
    }

    /// The light that reaches the eye from the surface at a pixel position.
    pub(crate) fn shade(&self, stage: &Stage, x: f64, y: f64) -> [f32; 3] {
        match self {
            Self::Triangle(t) => t.shade(stage, x, y),
            Self::Sphere(s) => s.shade(stage, x, y),
            Self::Capsule(c) => c.shade(stage, x, y),
        }
    }

    pub(crate) fn opacity(&self, scene: &Scene) -> f64 {
        match self {
            Self::Triangle(t) => scene.meshes[t.mesh as usize].opacity,
            Self::Sphere(_) | Self::Capsule(_) => 1.0,
        }
    }
}
