//! Draws a scene as pixels. Primitives are sorted into tiles. A tile keeps the nearest primitive of each of 16 samples per pixel.
//! Light is measured where something is seen. Then each primitive that is visible in a pixel is shaded once, at the centre of its
//! samples. A tile is drawn by one thread, which reads nothing that another thread writes, so the picture does not depend on the
//! number of threads.

use walpha_base::memory::try_with_capacity;
use walpha_base::parallel::prelude::*;

use crate::error::RenderError;
use crate::light::{Exposure, Seen, Stage, Studio};
use crate::pixels::{Patch, Picture, PixelBox, SAMPLES, Size, middle};
use crate::primitives::Primitive;
use crate::scene::{Background, Camera, Lens, Scene};

impl Scene {
    /// Draws the scene: 16 samples for each pixel, key, fill and rim light fixed to the camera, and sky light that reaches into
    /// hollows only as far as they are open. Solid surfaces of zero area are invisible. 33 000 triangles and 20 000 balls at
    /// 1600×1200 take about a second on two cores.
    ///
    /// # Errors
    /// [`RenderError::Camera`] for a camera without a direction; [`RenderError::Index`],
    /// [`RenderError::Attribute`] and [`RenderError::OutOfRange`] for a scene that contradicts
    /// itself.
    pub fn render(
        &self,
        camera: &Camera,
        size: Size,
        background: Background,
    ) -> Result<Picture, RenderError> {
        self.check()?;
        if let Some(factor) = camera.rescaling() {
            return self.scaled(factor).render(&camera.scaled(factor), size, background);
        }
        let lens = Lens::new(camera, size)?;
        // Allocate before the work, so that a failure is reported immediately.
        let (width, height) = (size.width() as usize, size.height() as usize);
        let mut pixels =
            try_with_capacity(width * height, || format!("a picture of {width}×{height} pixels"))?;
        pixels.resize(width * height, [0; 4]);
        let primitives = Primitive::all(self, &lens, size);
        let tiles = Tiles::new(&primitives, size);
        let visible: Vec<Vec<Fragment>> = (0..tiles.count())
            .into_par_iter()
            .map(|tile| cover(self, &lens, &primitives, tiles.members(tile), tiles.area(tile)))
            .collect();
        let mut seen = Seen::nothing(self);
        for fragment in visible.iter().flatten() {
            primitives[fragment.name as usize].note(self, &mut seen);
        }
        let studio = Studio::new(&lens);
        let exposure = Exposure::new(self, &studio, &seen);
        let stage = Stage { scene: self, lens, studio, exposure };
        let rows: Vec<Vec<[u8; 4]>> = visible
            .par_iter()
            .enumerate()
            .map(|(tile, fragments)| {
                draw(&stage, &primitives, fragments, tiles.area(tile), background)
            })
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
}

/// The primitives that may touch each tile, one tile after the other in one array.
struct Tiles {
    size: Size,
    across: usize,
    down: usize,
    starts: Vec<usize>,
    members: Vec<u32>,
}

impl Tiles {
    /// 32×32 pixels: nearness and names of all samples fit into a second-level cache.
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

    fn count(&self) -> usize {
        self.across * self.down
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

/// A primitive that is visible in some samples of a pixel of a tile.
struct Fragment {
    pixel: u16,
    mask: u16,
    name: u32,
}

/// What is visible in the pixels of `area`, row by row: in each pixel, opaque primitives, and then translucent ones from far to near.
#[expect(
    clippy::needless_bitwise_bool,
    reason = "several samples are done at a time where there is no branch"
)]
fn cover(
    scene: &Scene,
    lens: &Lens,
    primitives: &[Primitive],
    members: &[u32],
    area: PixelBox,
) -> Vec<Fragment> {
    let width = (area.x1 - area.x0) as usize;
    let count = width * (area.y1 - area.y0) as usize;
    let mut nearest = vec![([f32::NEG_INFINITY; SAMPLES], [NOTHING; SAMPLES]); count];
    let index = |p: &Patch| (p.y - area.y0) as usize * width + (p.x - area.x0) as usize;
    let solid = |name: u32| primitives[name as usize].opacity(scene) >= 1.0;
    for &name in members.iter().filter(|&&name| solid(name)) {
        primitives[name as usize].cover(lens, area, |patch| {
            let (depths, names) = &mut nearest[index(patch)];
            for k in 0..SAMPLES {
                // Strictly greater: of equally near primitives, the first in the scene is kept.
                let is_nearer = (patch.mask >> k & 1 == 1) & (patch.nearness[k] > depths[k]);
                depths[k] = if is_nearer { patch.nearness[k] } else { depths[k] };
                names[k] = if is_nearer { name } else { names[k] };
            }
        });
    }
    let mut veils = Vec::new();
    for &name in members.iter().filter(|&&name| !solid(name)) {
        primitives[name as usize].cover(lens, area, |patch| {
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
                veils.push((nearness, Fragment { pixel: pixel as u16, mask, name }));
            }
        });
    }
    // Sort from far to near in each pixel; the order of the scene decides between equal ones.
    veils.sort_by(|(near, a), (nearer, b)| {
        let order = a.pixel.cmp(&b.pixel).then(near.total_cmp(nearer));
        order.then(a.name.cmp(&b.name))
    });
    let mut veils = veils.into_iter().map(|(_, veil)| veil).peekable();
    let mut fragments = Vec::new();
    for (pixel, (_, names)) in (0_u16..).zip(&nearest) {
        let mut left = (0..SAMPLES).filter(|&k| names[k] != NOTHING).fold(0_u16, |m, k| m | 1 << k);
        while left != 0 {
            let name = names[left.trailing_zeros() as usize];
            let mask = (0..SAMPLES).filter(|&k| names[k] == name).fold(0_u16, |m, k| m | 1 << k);
            fragments.push(Fragment { pixel, mask, name });
            left &= !mask;
        }
        fragments.extend(std::iter::from_fn(|| veils.next_if(|veil| veil.pixel == pixel)));
    }
    fragments
}

/// Stands for a missing primitive.
const NOTHING: u32 = u32::MAX;

/// The pixels of `area`, row by row.
fn draw(
    stage: &Stage,
    primitives: &[Primitive],
    mut fragments: &[Fragment],
    area: PixelBox,
    background: Background,
) -> Vec<[u8; 4]> {
    let mut pixels = Vec::new();
    let places = (area.y0..area.y1).flat_map(|y| (area.x0..area.x1).map(move |x| (x, y)));
    for (pixel, place) in (0_u16..).zip(places) {
        let here = fragments.iter().take_while(|fragment| fragment.pixel == pixel).count();
        pixels.push(resolve(stage, primitives, place, &fragments[..here], background));
        fragments = &fragments[here..];
    }
    pixels
}

/// The colour of a pixel: opaque primitives by their share of samples, and translucent ones over them.
fn resolve(
    stage: &Stage,
    primitives: &[Primitive],
    (x, y): (i32, i32),
    fragments: &[Fragment],
    background: Background,
) -> [u8; 4] {
    // Light and opacity of each sample, light premultiplied.
    let empty = match background {
        Background::White => [1.0_f32; 4],
        Background::Transparent => [0.0; 4],
    };
    if fragments.is_empty() {
        return encode(&[empty]);
    }
    let mut samples = [empty; SAMPLES];
    for &Fragment { mask, name, .. } in fragments {
        let primitive = &primitives[name as usize];
        let covered = || (0..SAMPLES).filter(|k| mask >> k & 1 == 1);
        let [px, py] = middle(x, y, mask);
        let [r, g, b] = primitive.shade(stage, px, py);
        let over = [r, g, b, 1.0];
        let opacity = primitive.opacity(stage.scene) as f32;
        for k in covered() {
            if opacity >= 1.0 {
                samples[k] = over;
            } else {
                for c in 0..4 {
                    samples[k][c] += (over[c] - samples[k][c]) * opacity;
                }
            }
        }
    }
    encode(&samples)
}

/// The mean of samples as bytes.
fn encode<const N: usize>(samples: &[[f32; 4]; N]) -> [u8; 4] {
    let mean = [0, 1, 2, 3].map(|c| samples.iter().map(|s| s[c]).sum::<f32>() / N as f32);
    let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    if mean[3] <= 0.0 {
        return [0; 4];
    }
    let [r, g, b] = [0, 1, 2].map(|c| byte((mean[c] / mean[3]).sqrt()));
    [r, g, b, byte(mean[3])]
}

#[cfg(test)]
mod tests;
