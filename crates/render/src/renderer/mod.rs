//! The pixels of one tile: which primitive is nearest in each sample, and what colour that makes.

use crate::pixels::{Patch, PixelBox, SAMPLES, sample_position};
use crate::primitives::{Primitive, Stage};
use crate::scene::Background;

/// Draws the primitives that may touch `area`, row by row.
pub(super) fn draw(
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
                // Strictly greater: of equally near ones the first in the scene is kept.
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

/// Stands for the absence of a primitive.
const NOTHING: u32 = u32::MAX;

/// A see-through primitive in one pixel.
struct Veil {
    pixel: usize,
    nearness: f32,
    name: u32,
    mask: u16,
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
        primitives[name as usize].shade(stage, px, py)
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
