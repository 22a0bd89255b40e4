use ndarray::Array3;
use walpha_base::memory::try_with_capacity;
use walpha_base::parallel::prelude::*;

use crate::source::{BoxReader, Source};
use crate::{Dims, Dtype, Frame, Volume, VolumeError};

/// The width over which an edge fades: one voxel of a 64³ phantom. Half the box of the head has the length 1.
const SOFTNESS: f64 = 1.0 / 32.0;

/// Gray levels of the tissues. All soft tissue stays below 50, so that the isosurface at 50 is
/// bone.
const SKIN: f64 = 32.0;
const EYE: f64 = 40.0;
const BRAIN: f64 = 42.0;
const BONE: f64 = 205.0;
const TEETH: f64 = 245.0;

/// A head made of ellipsoids, boxes and rods: cranial vault with brain, orbits with eyes, nasal
/// opening, cheek bones, and a jaw with teeth, in soft tissue and air.
///
/// The face looks towards −y, up is +z. There are `size` samples along each axis with gray levels 0..255 as unrounded `f32`; the
/// spacing is 1. The geometry is the same at any size. Only + − × ÷ and square roots are used, which IEEE 754 rounds identically
/// everywhere, so that the same size gives the same bytes.
///
/// # Errors
/// The size is 0 or above 1625, the largest whose cube is within [`Dims::MAX_SAMPLES`]; or there is not enough memory.
#[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
pub fn phantom(size: u64) -> Result<Volume, VolumeError> {
    let dims = Dims::new(size, size, size)?;
    let n = dims.x();
    let mut samples = try_with_capacity(dims.samples(), || format!("a phantom of {dims} samples"))?;
    samples.resize(dims.samples(), 0f32);
    samples.par_chunks_mut(n).enumerate().for_each(|(row, samples)| {
        fill(n, [0, row % n, row / n], samples);
    });
    let samples = Array3::from_shape_vec(dims.shape(), samples).expect("as many as dims say");
    Ok(Volume::new(samples, Frame::VOXEL)?.with_gray_levels())
}

/// Fills a part of a row, from a voxel on, of the phantom with `n` samples along each axis.
fn fill(n: usize, [x, y, z]: [usize; 3], samples: &mut [f32]) {
    let at = |i: usize| position(i, n);
    let (y, z) = (at(y), at(z));
    for (x, sample) in (x..).zip(samples) {
        *sample = gray([at(x), y, z]) as f32;
    }
}

/// The position of sample i of n along an axis of the box −1..1.
pub(super) fn position(i: usize, n: usize) -> f64 {
    (2 * i + 1) as f64 / n as f64 - 1.0
}

/// The phantom of any size, read part by part.
pub(in super::super) struct PhantomBoxes(usize);

impl PhantomBoxes {
    pub(crate) fn source(size: u64) -> Result<Source, VolumeError> {
        let dims = Dims::unbounded(size, size, size)?;
        let parts = Box::new(Self(dims.x()));
        Ok(Source::new(dims, Frame::VOXEL, Dtype::F32, [1; 3], parts).with_gray_levels(true))
    }
}

impl BoxReader for PhantomBoxes {
    fn read(&self, first: [usize; 3], size: [usize; 3]) -> Result<Vec<f32>, VolumeError> {
        let mut samples = vec![0.0; size.iter().product()];
        samples.par_chunks_mut(size[0]).enumerate().for_each(|(row, samples)| {
            let [x, y, z] = first;
            fill(self.0, [x, y + row % size[1], z + row / size[1]], samples);
        });
        Ok(samples)
    }
}

/// The gray level at a point of the box −1..1 in each axis.
pub(super) fn gray([x, y, z]: Point) -> f64 {
    // The head is symmetric: all parts are laid out for x ≥ 0.
    let p = [x.abs(), y, z];
    let skin = skin(p);
    if skin > SOFTNESS {
        return 0.0;
    }
    let vault = ellipsoid(p, [0.0, 0.12, 0.28], [0.61, 0.73, 0.57]);
    let inside = ellipsoid(p, [0.0, 0.12, 0.28], [0.53, 0.65, 0.49]);
    let orbit = ellipsoid(p, [0.23, -0.68, 0.02], [0.155, 0.34, 0.135]);
    let nose = nose(p);
    let spine = rod(p, [0.0, 0.18, -0.05], [0.0, 0.24, -0.60], 0.11);

    let cranium = vault.max(-inside);
    let face = unite(ellipsoid(p, [0.0, -0.46, -0.22], [0.40, 0.30, 0.36]), brow(p), 0.08);
    let mut skull = unite(cranium, face.max(-inside), 0.06);
    // Behind the face and below the vault, a skull is hollow: throat and nasal cavity.
    skull = skull.max(-ellipsoid(p, [0.0, -0.34, -0.36], [0.26, 0.26, 0.22]));
    skull = skull.max(-orbit).max(-nose).max(-spine);
    skull = skull.min(cheek(p)).min(jaw(p));

    let mut gray = paint(0.0, SKIN, skin);
    gray = paint(gray, 0.0, nose);
    gray = paint(gray, BRAIN + 4.0 * z, inside);
    gray = paint(gray, EYE, ellipsoid(p, [0.23, -0.62, 0.02], [0.11, 0.12, 0.11]));
    gray = paint(gray, BONE + 15.0 * z, skull);
    paint(gray, TEETH, teeth(p))
}

fn skin(p: Point) -> f64 {
    let head = ellipsoid(p, [0.0, 0.12, 0.28], [0.70, 0.82, 0.66]);
    let face = ellipsoid(p, [0.0, -0.26, -0.36], [0.66, 0.62, 0.60]);
    let nose = ellipsoid(p, [0.0, -0.86, -0.16], [0.10, 0.12, 0.15]);
    let chin = ellipsoid(p, [0.0, -0.62, -0.74], [0.24, 0.20, 0.22]);
    unite(unite(unite(head, face, 0.15), nose, 0.06), chin, 0.10)
}

fn brow(p: Point) -> f64 {
    rod(p, [0.0, -0.62, 0.14], [0.36, -0.52, 0.13], 0.085)
}

/// The pear-shaped opening of the nose, wider at its lower end.
fn nose(p: Point) -> f64 {
    let upper = ellipsoid(p, [0.0, -0.70, -0.12], [0.055, 0.30, 0.13]);
    let lower = ellipsoid(p, [0.0, -0.70, -0.21], [0.095, 0.30, 0.085]);
    unite(upper, lower, 0.04)
}

/// The cheek bone and the arch that bridges the temple, with a gap under it.
fn cheek(p: Point) -> f64 {
    let bone = rod(p, [0.30, -0.60, -0.16], [0.44, -0.48, -0.13], 0.07);
    let rim = rod(p, [0.42, -0.52, 0.10], [0.44, -0.48, -0.12], 0.05);
    let front = rod(p, [0.44, -0.48, -0.13], [0.59, -0.18, -0.12], 0.05);
    let back = rod(p, [0.59, -0.18, -0.12], [0.52, 0.10, -0.06], 0.045);
    unite(unite(bone, rim, 0.04), front.min(back), 0.04)
}

/// The lower jaw: chin, body, and the branch that rises to its joint below the arch.
fn jaw(p: Point) -> f64 {
    let chin = slab(p, [0.0, -0.65, -0.77], [0.12, 0.04, 0.08], 0.05);
    let body = rod(p, [0.12, -0.65, -0.75], [0.42, -0.20, -0.62], 0.075);
    let ridge = rod(p, [0.10, -0.62, -0.66], [0.38, -0.24, -0.55], 0.05);
    let branch = rod(p, [0.42, -0.20, -0.60], [0.46, -0.02, -0.20], 0.06);
    unite(unite(chin, body, 0.05), unite(ridge, branch, 0.05), 0.05)
}

/// Two rows of six teeth on each side, on a parabola.
fn teeth(p: Point) -> f64 {
    let tooth = |k: i32, z: f64| {
        let x = 0.036 + 0.066 * f64::from(k);
        slab(p, [x, 2.2 * x * x - 0.70, z], [0.014, 0.018, 0.036], 0.014)
    };
    (0..5).flat_map(|k| [tooth(k, -0.50), tooth(k, -0.615)]).fold(f64::INFINITY, f64::min)
}

/// A point (x, y, z) in the box −1..1.
type Point = [f64; 3];

/// Paints a tissue where its signed distance is negative, blended across the edge.
fn paint(below: f64, tissue: f64, distance: f64) -> f64 {
    let share = (0.5 - distance / SOFTNESS).clamp(0.0, 1.0);
    below + share * (tissue - below)
}

fn length([x, y, z]: Point) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

/// The approximate signed distance to an ellipsoid: exact on its surface, and to first order near it.
fn ellipsoid(p: Point, centre: Point, radii: Point) -> f64 {
    let scaled = [0, 1, 2].map(|i| (p[i] - centre[i]) / radii[i]);
    let gradient = length([0, 1, 2].map(|i| scaled[i] / radii[i]));
    let level = length(scaled);
    if gradient == 0.0 { -radii[0] } else { level * (level - 1.0) / gradient }
}

/// The signed distance to a box with rounded edges.
fn slab(p: Point, centre: Point, half: Point, rounding: f64) -> f64 {
    let beyond = [0, 1, 2].map(|i| (p[i] - centre[i]).abs() - half[i]);
    let inside = beyond[0].max(beyond[1]).max(beyond[2]).min(0.0);
    length(beyond.map(|b| b.max(0.0))) + inside - rounding
}

/// The signed distance to a rod with round ends.
fn rod(p: Point, from: Point, to: Point, radius: f64) -> f64 {
    let (axis, offset) = ([0, 1, 2].map(|i| to[i] - from[i]), [0, 1, 2].map(|i| p[i] - from[i]));
    let dot = |a: Point, b: Point| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let along = (dot(offset, axis) / dot(axis, axis)).clamp(0.0, 1.0);
    length([0, 1, 2].map(|i| offset[i] - along * axis[i])) - radius
}

/// The union of two bodies, with the seam rounded over `blend`.
fn unite(a: f64, b: f64, blend: f64) -> f64 {
    let overlap = (blend - (a - b).abs()).max(0.0);
    a.min(b) - overlap * overlap / (4.0 * blend)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(volume: &Volume, [x, y, z]: [usize; 3]) -> f32 {
        volume.samples()[[z, y, x]]
    }

    #[test]
    fn the_head_has_its_parts() {
        let head = phantom(64).unwrap();
        let (low, high) = head.value_range();
        assert!(head.has_gray_levels() && low == 0.0 && high > 200.0 && high <= 255.0);
        assert_eq!(at(&head, [0, 0, 0]), 0.0, "air around");
        let middle = 32;
        assert!((30.0..50.0).contains(&at(&head, [middle, 36, 42])), "brain");
        let top = (0..64).map(|z| at(&head, [middle, 36, z])).rposition(|v| v > 150.0);
        assert!(top.is_some_and(|z| (54..62).contains(&z)), "vault, up is +z: {top:?}");
        let brow = (0..64).map(|y| at(&head, [middle, y, 36])).position(|v| v > 150.0);
        let occiput = (0..64).map(|y| at(&head, [middle, y, 36])).rposition(|v| v > 150.0);
        assert!(brow.is_some_and(|y| y < 16) && occiput.is_some_and(|y| y > 54));
        for side in [24, 39] {
            let socket = (0..20).map(|y| at(&head, [side, y, 32])).fold(0f32, f32::max);
            assert!(socket < 50.0, "an orbit is open to the front: {socket}");
        }
        for x in 0..64 {
            for y in 0..64 {
                assert_eq!(at(&head, [x, y, 22]), at(&head, [63 - x, y, 22]), "symmetric");
            }
        }
    }

    #[test]
    fn any_size_is_the_same_head() {
        assert_eq!(phantom(1).unwrap().dims().samples(), 1);
        // A sample of the coarse head is at the middle one of 3×3×3 samples of the fine head.
        let (coarse, fine) = (phantom(20).unwrap(), phantom(60).unwrap());
        for [x, y, z] in [[10, 10, 14], [4, 10, 14], [12, 2, 8], [14, 5, 3]] {
            let (a, b) = (at(&coarse, [x, y, z]), at(&fine, [3 * x + 1, 3 * y + 1, 3 * z + 1]));
            assert!((a - b).abs() < 1e-3, "{a} {b}");
        }
    }
}
