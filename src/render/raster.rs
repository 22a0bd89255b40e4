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
use super::triangle::Triangle;
use super::{Background, Camera, Picture, RenderError, Scene, Size};

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
enum Primitive {
    Triangle(Triangle),
    Sphere(Sphere),
    Capsule(Capsule),
}

impl Primitive {
    fn bounds(&self) -> PixelBox {
        match self {
            Self::Triangle(t) => t.bounds,
            Self::Sphere(s) => s.bounds,
            Self::Capsule(c) => c.bounds,
        }
    }

    fn cover(&self, lens: &Lens, within: PixelBox, visit: impl FnMut(&Patch)) {
        match self {
            Self::Triangle(t) => t.cover(within, visit),
            Self::Sphere(s) => s.cover(lens, within, visit),
            Self::Capsule(c) => c.cover(lens, within, visit),
        }
    }

    fn opacity(&self, scene: &Scene) -> f64 {
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
    let studio = Studio::new(&lens);
    let exposure = Exposure::new(scene, &studio);
    let stage = Stage { scene, lens, studio, exposure };
    let primitives = primitives(scene, &lens, size);
    let tiles = Tiles::new(&primitives, size);
    let mut pixels = vec![[0; 4]; size.width() as usize * size.height() as usize];
    let rows: Vec<Vec<[u8; 4]>> = (0..tiles.across * tiles.down)
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

/// Which primitives may touch which tile, in rows of one array.
struct Tiles {
    size: Size,
    across: usize,
    down: usize,
    starts: Vec<usize>,
    members: Vec<u32>,
}

impl Tiles {
    /// 32×32 pixels: nearness and names of all samples fit in a second-level cache.
    const SIDE: usize = 32;

    fn new(primitives: &[Primitive], size: Size) -> Self {
        let across = (size.width() as usize).div_ceil(Self::SIDE);
        let down = (size.height() as usize).div_ceil(Self::SIDE);
        let touched = |primitive: &Primitive| {
            let b = primitive.bounds();
            let side = Self::SIDE as i32;
            let tiles =
                |low: i32, high: i32| (low / side) as usize..((high + side - 1) / side) as usize;
            let columns = if b.is_empty() { 0..0 } else { tiles(b.x0, b.x1) };
            tiles(b.y0, b.y1).flat_map(move |y| columns.clone().map(move |x| y * across + x))
        };
        let mut starts = vec![0; across * down + 1];
        for tile in primitives.iter().flat_map(touched) {
            starts[tile + 1] += 1;
        }
        for tile in 0..across * down {
            starts[tile + 1] += starts[tile];
        }
        let mut free = starts.clone();
        let mut members = vec![0; starts[across * down]];
        for (name, primitive) in primitives.iter().enumerate() {
            for tile in touched(primitive) {
                members[free[tile]] = name as u32;
                free[tile] += 1;
            }
        }
        Self { size, across, down, starts, members }
    }

    fn members(&self, tile: usize) -> &[u32] {
        &self.members[self.starts[tile]..self.starts[tile + 1]]
    }

    fn area(&self, tile: usize) -> PixelBox {
        let (x, y) = (tile % self.across * Self::SIDE, tile / self.across * Self::SIDE);
        PixelBox {
            x0: x as i32,
            y0: y as i32,
            x1: (x + Self::SIDE).min(self.size.width() as usize) as i32,
            y1: (y + Self::SIDE).min(self.size.height() as usize) as i32,
        }
    }
}

/// No primitive.
const NOTHING: u32 = u32::MAX;

/// A see-through primitive in one pixel.
struct Veil {
    pixel: usize,
    nearness: f32,
    name: u32,
    mask: u16,
}

fn draw(
    stage: &Stage,
    primitives: &[Primitive],
    members: &[u32],
    area: PixelBox,
    background: Background,
) -> Vec<[u8; 4]> {
    let width = (area.x1 - area.x0) as usize;
    let count = width * (area.y1 - area.y0) as usize;
    let mut nearest = vec![([f32::NEG_INFINITY; SAMPLES], [NOTHING; SAMPLES]); count];
    let index = |p: &Patch| (p.y - area.y0) as usize * width + (p.x - area.x0) as usize;
    let solid = |name: u32| primitives[name as usize].opacity(stage.scene) >= 1.0;
    for &name in members.iter().filter(|&&name| solid(name)) {
        primitives[name as usize].cover(&stage.lens, area, |patch| {
            let (depths, names) = &mut nearest[index(patch)];
            for k in 0..SAMPLES {
                // Strictly: among equals the first in the scene stays.
                if patch.mask >> k & 1 == 1 && patch.nearness[k] > depths[k] {
                    depths[k] = patch.nearness[k];
                    names[k] = name;
                }
            }
        });
    }
    let mut veils = Vec::new();
    for &name in members.iter().filter(|&&name| !solid(name)) {
        primitives[name as usize].cover(&stage.lens, area, |patch| {
            let pixel = index(patch);
            let seen =
                |&k: &usize| patch.mask >> k & 1 == 1 && patch.nearness[k] > nearest[pixel].0[k];
            let (mut mask, mut nearness) = (0_u16, 0.0);
            for k in (0..SAMPLES).filter(seen) {
                mask |= 1 << k;
                nearness += patch.nearness[k];
            }
            if mask != 0 {
                let nearness = nearness / mask.count_ones() as f32;
                veils.push(Veil { pixel, nearness, name, mask });
            }
        });
    }
    // From far to near in each pixel; the order of the scene decides between equals.
    veils.sort_by(|a, b| {
        let order = a.pixel.cmp(&b.pixel).then(a.nearness.total_cmp(&b.nearness));
        order.then(a.name.cmp(&b.name))
    });
    let mut veils = veils.as_slice();
    let mut pixels = Vec::with_capacity(count);
    for (pixel, (_, names)) in nearest.iter().enumerate() {
        let over = veils.iter().take_while(|v| v.pixel == pixel).count();
        let place = (area.x0 + (pixel % width) as i32, area.y0 + (pixel / width) as i32);
        pixels.push(resolve(stage, primitives, place, names, &veils[..over], background));
        veils = &veils[over..];
    }
    pixels
}

/// The colour of a pixel: solid primitives by their share of samples, veils over them.
fn resolve(
    stage: &Stage,
    primitives: &[Primitive],
    (x, y): (i32, i32),
    names: &[u32; SAMPLES],
    veils: &[Veil],
    background: Background,
) -> [u8; 4] {
    let shade = |name: u32, mask: u16| {
        let [mut px, mut py] = [0.0; 2];
        for k in (0..SAMPLES).filter(|k| mask >> k & 1 == 1) {
            let [sx, sy] = sample_position(x, y, k);
            (px, py) = (px + sx, py + sy);
        }
        let share = 1.0 / f64::from(mask.count_ones());
        let (px, py) = (px * share, py * share);
        match &primitives[name as usize] {
            Primitive::Triangle(t) => t.shade(stage, px, py),
            Primitive::Sphere(s) => s.shade(stage, px, py),
            Primitive::Capsule(c) => c.shade(stage, px, py),
        }
    };
    // Light and opacity of each sample, light premultiplied.
    let empty = match background {
        Background::White => [1.0_f32; 4],
        Background::Transparent => [0.0; 4],
    };
    let mut samples = [empty; SAMPLES];
    let mut left = (0..SAMPLES).filter(|&k| names[k] != NOTHING).fold(0_u16, |m, k| m | 1 << k);
    while left != 0 {
        let name = names[left.trailing_zeros() as usize];
        let mask = (0..SAMPLES).filter(|&k| names[k] == name).fold(0_u16, |m, k| m | 1 << k);
        let [r, g, b] = shade(name, mask);
        for k in (0..SAMPLES).filter(|k| mask >> k & 1 == 1) {
            samples[k] = [r, g, b, 1.0];
        }
        left &= !mask;
    }
    for veil in veils {
        let opacity = primitives[veil.name as usize].opacity(stage.scene) as f32;
        let [r, g, b] = shade(veil.name, veil.mask);
        for k in (0..SAMPLES).filter(|k| veil.mask >> k & 1 == 1) {
            let over = [r, g, b, 1.0];
            for c in 0..4 {
                samples[k][c] += (over[c] - samples[k][c]) * opacity;
            }
        }
    }
    encode(&samples)
}

/// The mean of samples as bytes.
fn encode(samples: &[[f32; 4]; SAMPLES]) -> [u8; 4] {
    let mean = [0, 1, 2, 3].map(|c| samples.iter().map(|s| s[c]).sum::<f32>() / SAMPLES as f32);
    let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    if mean[3] <= 0.0 {
        return [0; 4];
    }
    let [r, g, b] = [0, 1, 2].map(|c| byte((mean[c] / mean[3]).sqrt()));
    [r, g, b, byte(mean[3])]
}
