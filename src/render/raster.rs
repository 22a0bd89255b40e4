//! From a scene to pixels: primitives are sorted into tiles, each tile keeps for each of 16
//! samples a pixel the nearest primitive, and each primitive seen in a pixel is shaded once, in
//! the middle of its samples. A tile is the work of one thread and reads nothing that another
//! writes, so the picture does not depend on how many there are.

use rayon::prelude::*;

use super::camera::Lens;
use super::capsule::Capsule;
use super::light::Studio;
use super::occlusion::Exposure;
use super::sphere::Sphere;
use super::tile::draw;
use super::tiles::Tiles;
use super::triangle::Triangle;
use super::{Background, Camera, Picture, RenderError, Scene, Size};
use crate::memory::room;

/// Samples in a pixel.
pub(super) const SAMPLES: usize = 16;

/// Fixed-point steps in a pixel: sample positions and snapped corners are multiples of 1/256.
pub(super) const STEPS: i64 = 256;

/// Sample k of a pixel, (x, y) in 1/256 from its upper left corner. Cell (a, b) of the 4×4 grid
/// holds its sample moved by (b, a)/16, so that no two share a row or a column, and upright and
/// level edges are as smooth as slanted ones: 16 steps from white to black.
pub(super) const SAMPLE: [[i64; 2]; SAMPLES] = {
    let mut all = [[0; 2]; SAMPLES];
    let mut k = 0;
    while k < SAMPLES {
        let (a, b) = ((k / 4) as i64, (k % 4) as i64);
        all[k] = [16 * (4 * a + b) + 8, 16 * (4 * b + a) + 8];
        k += 1;
    }
    all
};

/// The position of sample k of a pixel, in pixels.
pub(super) fn sample_position(x: i32, y: i32, k: usize) -> [f64; 2] {
    let [dx, dy] = SAMPLE[k];
    [f64::from(x) + dx as f64 / STEPS as f64, f64::from(y) + dy as f64 / STEPS as f64]
}

/// Pixels x0 ≤ x < x1 and y0 ≤ y < y1.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelBox {
    pub x0: i32,
    pub y0: i32,
    pub x1: i32,
    pub y1: i32,
}

impl PixelBox {
    /// The pixels that touch the rectangle between two positions, inside a picture of this size.
    pub(super) fn around(low: [f64; 2], high: [f64; 2], size: Size) -> Self {
        // `as` saturates, and NaN becomes 0.
        let (width, height) = (size.width() as i32, size.height() as i32);
        Self {
            x0: (low[0].floor() as i32).clamp(0, width),
            y0: (low[1].floor() as i32).clamp(0, height),
            x1: (high[0].ceil() as i32).clamp(0, width),
            y1: (high[1].ceil() as i32).clamp(0, height),
        }
    }

    pub(super) fn meet(self, other: Self) -> Self {
        Self {
            x0: self.x0.max(other.x0),
            y0: self.y0.max(other.y0),
            x1: self.x1.min(other.x1),
            y1: self.y1.min(other.y1),
        }
    }

    pub(super) fn is_empty(self) -> bool {
        self.x0 >= self.x1 || self.y0 >= self.y1
    }
}

/// What one primitive covers of one pixel: its samples as bits, and how near each is.
pub(super) struct Patch {
    pub x: i32,
    pub y: i32,
    pub mask: u16,
    pub nearness: [f32; SAMPLES],
}

/// One thing that can be nearest in a sample.
pub(super) enum Primitive {
    Triangle(Triangle),
    Sphere(Sphere),
    Capsule(Capsule),
}

impl Primitive {
    pub(super) fn bounds(&self) -> PixelBox {
        match self {
            Self::Triangle(t) => t.bounds,
            Self::Sphere(s) => s.bounds,
            Self::Capsule(c) => c.bounds,
        }
    }

    pub(super) fn cover(&self, lens: &Lens, within: PixelBox, visit: impl FnMut(&Patch)) {
        match self {
            Self::Triangle(t) => t.cover(within, visit),
            Self::Sphere(s) => s.cover(lens, within, visit),
            Self::Capsule(c) => c.cover(lens, within, visit),
        }
    }

    /// The light that comes to the eye from what is seen at a pixel position.
    pub(super) fn shade(&self, stage: &Stage, x: f64, y: f64) -> [f32; 3] {
        match self {
            Self::Triangle(t) => t.shade(stage, x, y),
            Self::Sphere(s) => s.shade(stage, x, y),
            Self::Capsule(c) => c.shade(stage, x, y),
        }
    }

    pub(super) fn opacity(&self, scene: &Scene) -> f64 {
        match self {
            Self::Triangle(t) => scene.meshes[t.mesh as usize].opacity,
            Self::Sphere(_) | Self::Capsule(_) => 1.0,
        }
    }
}

/// All that shading needs to know.
pub(super) struct Stage<'a> {
    pub scene: &'a Scene,
    pub lens: Lens,
    pub studio: Studio,
    pub exposure: Exposure,
}

pub(super) fn render(
    scene: &Scene,
    camera: &Camera,
    size: Size,
    background: Background,
) -> Result<Picture, RenderError> {
    let lens = Lens::new(camera, size)?;
    // Before the work.
    let (width, height) = (size.width() as usize, size.height() as usize);
    let mut pixels = room(width * height, || format!("a picture of {width}×{height} pixels"))?;
    pixels.resize(width * height, [0; 4]);
    let studio = Studio::new(&lens);
    let exposure = Exposure::new(scene, &studio);
    let stage = Stage { scene, lens, studio, exposure };
    let primitives = primitives(scene, &lens, size);
    let tiles = Tiles::new(&primitives, size);
    let rows: Vec<Vec<[u8; 4]>> = (0..tiles.count())
        .into_par_iter()
        .map(|tile| draw(&stage, &primitives, tiles.members(tile), tiles.area(tile), background))
        .collect();
    for (tile, drawn) in rows.iter().enumerate() {
        let area = tiles.area(tile);
        let width = (area.x1 - area.x0) as usize;
        for (row, y) in drawn.chunks_exact(width).zip(area.y0..) {
            let start = y as usize * size.width() as usize + area.x0 as usize;
            pixels[start..start + width].copy_from_slice(row);
        }
    }
    Ok(Picture::new(size, pixels))
}

fn primitives(scene: &Scene, lens: &Lens, size: Size) -> Vec<Primitive> {
    let mut all = Vec::new();
    for (mesh, layer) in scene.meshes.iter().enumerate() {
        if layer.opacity > 0.0 {
            let pieces: Vec<Vec<Triangle>> = (0..layer.triangles.len())
                .into_par_iter()
                .map(|triangle| Triangle::pieces(layer, mesh, triangle, lens, size))
                .collect();
            all.extend(pieces.into_iter().flatten().map(Primitive::Triangle));
        }
    }
    let spheres = scene.balls.iter().enumerate();
    all.extend(spheres.filter_map(|(k, b)| Sphere::new(b, k, lens, size)).map(Primitive::Sphere));
    let tubes = scene.tubes.iter().enumerate();
    all.extend(tubes.filter_map(|(k, t)| Capsule::new(t, k, lens, size)).map(Primitive::Capsule));
    all
}
