use super::nonstandard::{Sums, whole_norm};
use super::support::strides;

/// The non-standard transform of a volume that is never in one place: by *bricks*, the cubes of 2ᵏ samples a
/// side that begin at multiples of 2ᵏ, those at the far ends smaller.
///
/// The levels below 2ᵏ stay within a brick ([`fine`](Self::fine)) and leave its sum; the levels above are
/// a transform of these sums alone ([`coarse`](Self::coarse)), 1/8ᵏ of the samples. Bit for bit what
/// [`forward`](super::forward) makes of the whole.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bricks {
    /// Samples of the whole along x, y and z.
    dims: [usize; 3],
    k: u32,
}

impl Bricks {
    /// The bricks of a volume of so many samples along x, y and z.
    pub(crate) fn new(dims: [usize; 3], k: u32) -> Self {
        Self { dims, k }
    }

    /// Samples along a side of a brick.
    pub(crate) fn side(self) -> usize {
        1 << self.k
    }

    /// How many bricks there are along x, y and z.
    pub(crate) fn count(self) -> [usize; 3] {
        self.dims.map(|n| n.div_ceil(self.side()))
    }

    /// From the samples of some bricks, a box of `dims` of them, to coefficients, with the sum of each brick
    /// at its first place. O(n).
    pub(crate) fn fine(self, values: &mut [f64], dims: [usize; 3]) {
        let sums = Sums::of_samples(dims);
        self.strides().take(self.k as usize).for_each(|stride| sums.forward(values, stride));
    }

    /// Back from that.
    pub(crate) fn inverse_fine(self, values: &mut [f64], dims: [usize; 3]) {
        let sums = Sums::of_samples(dims);
        let strides = self.strides().rev().filter(|&stride| stride < self.side());
        strides.for_each(|stride| sums.inverse(values, stride));
    }

    /// From the sums of all bricks to the coefficients at their first places. O(bricks).
    pub(crate) fn coarse(self, sums: &mut [f64]) {
        let grid = Sums::of_cubes(self.dims, self.side());
        let strides = self.strides().skip(self.k as usize);
        strides.for_each(|stride| grid.forward(sums, stride / self.side()));
        sums[0] /= whole_norm(self.dims);
    }

    /// Back from that.
    pub(crate) fn inverse_coarse(self, sums: &mut [f64]) {
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

    /// Coefficients by bricks, boxes of so many at a time, and the samples back from them.
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
                // No whole numbers: sums are rounded, and must be so in the same order.
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
