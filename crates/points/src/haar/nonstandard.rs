use ndarray::Array3;
use walpha_base::parallel::prelude::*;

use super::support::{Axis, forward_row, forward_rows, inverse_row, inverse_rows, strides};

/// The minimum number of pairs of rows in one parallel task.
const PAIRS: usize = 8;

/// Transforms samples to coefficients, on all levels.
pub(super) fn forward(values: &mut Array3<f64>) {
    let (z, y, x) = values.dim();
    let flat = values.as_slice_mut().expect("standard layout");
    let sums = Sums::of_samples([x, y, z]);
    strides(x.max(y).max(z)).for_each(|stride| sums.forward(flat, stride));
    flat[0] /= whole_norm([x, y, z]);
}

/// Transforms coefficients to samples, on all levels.
pub(super) fn inverse(values: &mut Array3<f64>) {
    let (z, y, x) = values.dim();
    let flat = values.as_slice_mut().expect("standard layout");
    flat[0] *= whole_norm([x, y, z]);
    let sums = Sums::of_samples([x, y, z]);
    strides(x.max(y).max(z)).rev().for_each(|stride| sums.inverse(flat, stride));
}

/// The norm of the function 1: the ratio of the sum of all samples and its coefficient.
pub(super) fn whole_norm(dims: [usize; 3]) -> f64 {
    dims.map(|n| n as f64).iter().product::<f64>().sqrt()
}

/// A grid of sums over cubes of samples, which are the samples if cubes consist of one.
pub(super) struct Sums {
    axes: [Axis; 3],
    dims: [usize; 3],
}

impl Sums {
    /// The grid of samples.
    pub(super) fn of_samples(dims: [usize; 3]) -> Self {
        Self { axes: dims.map(Axis::of_samples), dims }
    }

    /// The grid of sums over cubes of `unit` samples a side, for a volume with these numbers of samples.
    pub(super) fn of_cubes(samples: [usize; 3], unit: usize) -> Self {
        let dims = samples.map(|n| n.div_ceil(unit));
        Self { axes: samples.map(|n| Axis { n, unit }), dims }
    }

    /// Transforms one level; its stride is in sums of the grid.
    pub(super) fn forward(&self, flat: &mut [f64], stride: usize) {
        let level = self.level(stride);
        level.each_bundle(flat, |bundle| level.forward(bundle));
    }

    /// Inverts one level; its stride is in sums of the grid.
    pub(super) fn inverse(&self, flat: &mut [f64], stride: usize) {
        let level = self.level(stride);
        level.each_bundle(flat, |bundle| level.inverse(bundle));
    }

    fn level(&self, stride: usize) -> Level {
        let Self { axes, dims } = *self;
        let squares = (0..dims[0]).step_by(stride).map(|i| axes[0].square(stride, i)).collect();
        Level { axes, dims, stride, squares }
    }
}

/// One level of the transform: sums at multiples of the stride in each axis.
struct Level {
    axes: [Axis; 3],
    dims: [usize; 3],
    stride: usize,
    /// The factors along x of the square of the raw value at each multiple of the stride.
    squares: Vec<f64>,
}

/// Up to 2×2 rows that take a step together: those at y and y + s, in the slices at z and z + s.
struct Bundle<'a> {
    y: usize,
    z: usize,
    rows: [[Option<&'a mut [f64]>; 2]; 2],
}

impl Level {
    /// Calls `work` on each bundle, in parallel.
    fn each_bundle(&self, flat: &mut [f64], work: impl Fn(Bundle<'_>) + Sync) {
        let ([x, y, _], s) = (self.dims, self.stride);
        let (slice, rows) = (x * y, 2 * s * x);
        flat.par_chunks_mut(2 * s * slice).enumerate().for_each(|(k, slab)| {
            let z = 2 * s * k;
            let (near, far) = slab.split_at_mut(slab.len().min(s * slice));
            let near = near[..slice].par_chunks_mut(rows).with_min_len(PAIRS).enumerate();
            let bundle =
                |j: usize, near, far| Bundle { y: 2 * s * j, z, rows: [pair(near, s * x, x), far] };
            if far.is_empty() {
                near.for_each(|(j, near)| work(bundle(j, near, [None, None])));
            } else {
                near.zip(far[..slice].par_chunks_mut(rows))
                    .for_each(|((j, near), far)| work(bundle(j, near, pair(far, s * x, x))));
            }
        });
    }

    fn forward(&self, Bundle { y, z, mut rows }: Bundle<'_>) {
        let s = self.stride;
        rows.iter_mut().flatten().flatten().for_each(|row| forward_row(row, self.axes[0], s));
        let [near, far] = &mut rows;
        for slice in [&mut *near, &mut *far] {
            if let [Some(first), Some(second)] = slice {
                forward_rows(first, second, s, self.axes[1].step(s, y + s));
            }
        }
        for (first, second) in near.iter_mut().zip(far) {
            if let (Some(first), Some(second)) = (first, second) {
                forward_rows(first, second, s, self.axes[2].step(s, z + s));
            }
        }
        self.scale(y, z, &mut rows, |square| 1.0 / square.sqrt());
    }

    fn inverse(&self, Bundle { y, z, mut rows }: Bundle<'_>) {
        let s = self.stride;
        self.scale(y, z, &mut rows, f64::sqrt);
        let [near, far] = &mut rows;
        for (first, second) in near.iter_mut().zip(&mut *far) {
            if let (Some(first), Some(second)) = (first, second) {
                inverse_rows(first, second, s, self.axes[2].step(s, z + s));
            }
        }
        for slice in [near, far] {
            if let [Some(first), Some(second)] = slice {
                inverse_rows(first, second, s, self.axes[1].step(s, y + s));
            }
        }
        rows.iter_mut().flatten().flatten().for_each(|row| inverse_row(row, self.axes[0], s));
    }

    /// Multiplies each detail by a function of its square. Sums remain for the next level.
    fn scale(
        &self,
        y: usize,
        z: usize,
        rows: &mut [[Option<&mut [f64]>; 2]; 2],
        of: impl Fn(f64) -> f64,
    ) {
        let ([x, ..], s) = (self.dims, self.stride);
        let [along_x, along_y, along_z] = self.axes;
        for (dz, slice) in rows.iter_mut().enumerate() {
            for (dy, row) in slice.iter_mut().enumerate() {
                let Some(row) = row else { continue };
                let square_yz = along_y.square(s, y + dy * s) * along_z.square(s, z + dz * s);
                let factor = |k: usize| of(square_yz * self.squares[k]);
                // All pairs along x except the last have the same two squares.
                let (sum, detail) = (factor(0), factor(self.squares.len().min(2) - 1));
                let sum = if dy == 0 && dz == 0 { 1.0 } else { sum };
                let full = along_x.n / (2 * s * along_x.unit) * (2 * s);
                if s == 1 {
                    let (pairs, _) = row[..full].as_chunks_mut::<2>();
                    for [p, q] in pairs {
                        *p *= sum;
                        *q *= detail;
                    }
                } else {
                    for i in (0..full).step_by(2 * s) {
                        row[i] *= sum;
                        row[i + s] *= detail;
                    }
                }
                for i in (full..x).step_by(s) {
                    if i > full || dy == 1 || dz == 1 {
                        row[i] *= factor(i / s);
                    }
                }
            }
        }
    }
}

/// The rows of `x` samples at 0 and at `apart`, if the latter exists.
fn pair(rows: &mut [f64], apart: usize, x: usize) -> [Option<&mut [f64]>; 2] {
    let (first, second) = rows.split_at_mut(rows.len().min(apart));
    [Some(&mut first[..x]), second.get_mut(..x)]
}

/// The non-standard transform of a volume that need not be in memory as a whole. It is divided into *bricks*, the cubes of 2ᵏ
/// samples a side that begin at multiples of 2ᵏ; those at the far ends are smaller.
///
/// The levels below 2ᵏ stay within a brick ([`fine`](Self::fine)) and leave its sum. The levels above are a transform of these
/// sums alone ([`coarse`](Self::coarse)), which are 1/8ᵏ of the samples. The result equals that of [`forward`](super::forward)
/// bit for bit.
#[derive(Clone, Copy, Debug)]
pub struct Bricks {
    /// The number of samples of the whole volume along x, y and z.
    dims: [usize; 3],
    k: u32,
}

impl Bricks {
    /// Divides a volume with these numbers of samples along x, y and z into bricks.
    pub fn new(dims: [usize; 3], k: u32) -> Self {
        Self { dims, k }
    }

    /// The number of samples along a side of a brick.
    pub fn side(self) -> usize {
        1 << self.k
    }

    /// The number of bricks along x, y and z.
    pub fn count(self) -> [usize; 3] {
        self.dims.map(|n| n.div_ceil(self.side()))
    }

    /// Transforms the samples of a box of bricks with `dims` samples to coefficients, and leaves the sum of each brick at its
    /// first place. O(n).
    pub fn fine(self, values: &mut [f64], dims: [usize; 3]) {
        let sums = Sums::of_samples(dims);
        self.strides().take(self.k as usize).for_each(|stride| sums.forward(values, stride));
    }

    /// The inverse of [`fine`](Self::fine).
    pub fn inverse_fine(self, values: &mut [f64], dims: [usize; 3]) {
        let sums = Sums::of_samples(dims);
        let strides = self.strides().rev().filter(|&stride| stride < self.side());
        strides.for_each(|stride| sums.inverse(values, stride));
    }

    /// Transforms the sums of all bricks to the coefficients at their first places. O(bricks).
    pub fn coarse(self, sums: &mut [f64]) {
        let grid = Sums::of_cubes(self.dims, self.side());
        let strides = self.strides().skip(self.k as usize);
        strides.for_each(|stride| grid.forward(sums, stride / self.side()));
        sums[0] /= whole_norm(self.dims);
    }

    /// The inverse of [`coarse`](Self::coarse).
    pub fn inverse_coarse(self, sums: &mut [f64]) {
        let grid = Sums::of_cubes(self.dims, self.side());
        sums[0] *= whole_norm(self.dims);
        let strides = self.strides().rev().filter(|&stride| stride >= self.side());
        strides.for_each(|stride| grid.inverse(sums, stride / self.side()));
    }

    fn strides(self) -> impl DoubleEndedIterator<Item = usize> {
        let [x, y, z] = self.dims;
        strides(x.max(y).max(z))
    }
}

#[cfg(test)]
mod tests {
    use ndarray::{Array3, s};
    use walpha_base::random::Random;

    use super::*;
    use crate::haar::{Decomposition, forward};

    /// The coefficients computed by bricks, in boxes of this many bricks a side, and the samples computed back from them.
    fn by_bricks(samples: &Array3<f32>, k: u32, bricks: usize) -> (Array3<f64>, Array3<f64>) {
        let (z, y, x) = samples.dim();
        let whole = Bricks::new([x, y, z], k);
        let mut values = samples.mapv(f64::from);
        let [cx, cy, cz] = whole.count();
        let mut sums = Array3::zeros((cz, cy, cx));
        let boxes = |n: usize| {
            let step = bricks << k;
            (0..n).step_by(step).map(move |from| from..(from + step).min(n))
        };
        let each = |values: &mut Array3<f64>, work: &mut dyn FnMut(&mut [f64], [usize; 3])| {
            for z in boxes(z) {
                for y in boxes(y) {
                    for x in boxes(x) {
                        let at = s![z.clone(), y.clone(), x.clone()];
                        let mut part = values.slice(at).to_owned();
                        work(part.as_slice_mut().unwrap(), [x.len(), y.len(), z.len()]);
                        values.slice_mut(at).assign(&part);
                    }
                }
            }
        };
        each(&mut values, &mut |values, dims| whole.fine(values, dims));
        let firsts = s![..;1 << k, ..;1 << k, ..;1 << k];
        sums.assign(&values.slice(firsts));
        whole.coarse(sums.as_slice_mut().unwrap());
        let mut coefficients = values.clone();
        coefficients.slice_mut(firsts).assign(&sums);
        whole.inverse_coarse(sums.as_slice_mut().unwrap());
        values.slice_mut(firsts).assign(&sums);
        each(&mut values, &mut |values, dims| whole.inverse_fine(values, dims));
        (coefficients, values)
    }

    #[test]
    fn bricks_make_what_the_whole_makes() {
        let sizes = [(20, 33, 17), (1, 5, 70), (64, 16, 8), (9, 9, 9), (1, 1, 1), (7, 40, 2)];
        for (z, y, x) in sizes {
            let mut random = Random::new(3);
            let samples = Array3::from_shape_simple_fn((z, y, x), || {
                // These are not whole numbers: sums are rounded, and must be added in the same order.
                random.below(1 << 24) as f32 / 65537.3
            });
            let whole = forward(samples.view(), Decomposition::NonStandard);
            let back = whole.clone().inverse();
            for (k, bricks) in [(1, 1), (2, 3), (3, 1), (4, 2)] {
                let (coefficients, samples) = by_bricks(&samples, k, bricks);
                assert_eq!(coefficients.view(), whole.values(), "{z}×{y}×{x}, 2^{k}");
                assert_eq!(samples.mapv(|v| v as f32), back, "{z}×{y}×{x}, 2^{k}");
            }
        }
    }
}
