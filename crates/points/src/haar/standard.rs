use ndarray::Array3;
use walpha_base::parallel::prelude::*;

use super::support::{
    Axis, Step, forward_row, forward_rows, inverse_row, inverse_rows, square, strides,
};

/// Transforms samples to coefficients: each axis in full, x first.
pub(super) fn forward(values: &mut Array3<f64>) {
    let (slabs, flat) = whole(values);
    slabs.forward_planes(flat);
    slabs.forward_walls(flat, 0);
}

/// Transforms coefficients to samples: each axis in full, z first.
pub(super) fn inverse(values: &mut Array3<f64>) {
    let (slabs, flat) = whole(values);
    slabs.inverse_walls(flat, 0);
    slabs.inverse_planes(flat);
}

fn whole(values: &mut Array3<f64>) -> (Slabs, &mut [f64]) {
    let (z, y, x) = values.dim();
    (Slabs::new([x, y, z]), values.as_slice_mut().expect("standard layout"))
}

/// The standard transform of a volume that need not be in memory as a whole: first by *planes*, all samples of some z, and then
/// by *walls*, all samples of some y. The result is equal bit for bit however many are transformed at a time.
#[derive(Clone, Copy, Debug)]
pub struct Slabs {
    /// The number of samples of the whole volume along x, y and z.
    dims: [usize; 3],
}

impl Slabs {
    /// The slabs of a volume with these numbers of samples along x, y and z.
    pub fn new(dims: [usize; 3]) -> Self {
        Self { dims }
    }

    /// Transforms the samples of some planes along x and y. O(n).
    pub fn forward_planes(self, planes: &mut [f64]) {
        let [x, y, _] = self.dims;
        planes
            .par_chunks_mut(x)
            .for_each(|row| strides(x).for_each(|s| forward_row(row, Axis::of_samples(x), s)));
        planes.par_chunks_mut(x * y).for_each(|plane| along(plane, y, false));
    }

    /// Transforms some walls along z, of which the first is at `y`. They then contain coefficients. O(n).
    pub fn forward_walls(self, walls: &mut [f64], y: usize) {
        along(walls, self.dims[2], false);
        self.scale(walls, y, |square| 1.0 / square.sqrt());
    }

    /// The inverse of [`forward_walls`](Self::forward_walls).
    pub fn inverse_walls(self, walls: &mut [f64], y: usize) {
        self.scale(walls, y, f64::sqrt);
        along(walls, self.dims[2], true);
    }

    /// The inverse of [`forward_planes`](Self::forward_planes).
    pub fn inverse_planes(self, planes: &mut [f64]) {
        let [x, y, _] = self.dims;
        planes.par_chunks_mut(x * y).for_each(|plane| along(plane, y, true));
        planes.par_chunks_mut(x).for_each(|row| {
            strides(x).rev().for_each(|s| inverse_row(row, Axis::of_samples(x), s));
        });
    }

    /// Multiplies each value of some walls by a function of its square.
    fn scale(self, walls: &mut [f64], y: usize, of: impl Fn(f64) -> f64 + Sync) {
        let [in_x, in_y, in_z] = self.dims.map(squares);
        let rows = walls.len() / (self.dims[0] * self.dims[2]);
        walls.par_chunks_mut(self.dims[0]).enumerate().for_each(|(row, values)| {
            let square_yz = in_y[y + row % rows] * in_z[row / rows];
            for (value, square_x) in values.iter_mut().zip(&in_x) {
                *value *= of(square_yz * square_x);
            }
        });
    }
}

/// Transforms all levels along the slowest axis of `flat`, which has n lines, or inverts them if `back` is set.
fn along(flat: &mut [f64], n: usize, back: bool) {
    let line = flat.len() / n;
    let level = |s: usize| {
        flat.par_chunks_mut(2 * s * line).enumerate().for_each(|(k, pair)| {
            let (first, second) = pair.split_at_mut(pair.len().min(s * line));
            if second.is_empty() {
                return;
            }
            let step = Step::of(n, s, 2 * s * k + s);
            let work = if back { inverse_rows } else { forward_rows };
            let (first, second) = (&mut first[..line], &mut second[..line]);
            let pieces = first.par_chunks_mut(1 << 14).zip(second.par_chunks_mut(1 << 14));
            pieces.for_each(|(first, second)| work(first, second, 1, step));
        });
    };
    if back { strides(n).rev().for_each(level) } else { strides(n).for_each(level) }
}

/// The squares for a row of n samples.
fn squares(n: usize) -> Vec<f64> {
    let at = |i: usize| if i == 0 { n as f64 } else { square(n, 1 << i.trailing_zeros(), i) };
    (0..n).map(at).collect()
}

#[cfg(test)]
mod tests {
    use ndarray::{Array3, s};
    use walpha_base::random::Random;

    use super::*;

    #[test]
    fn slabs_make_what_the_whole_makes() {
        for (z, y, x) in [(5, 7, 9), (1, 4, 3), (8, 1, 16), (17, 33, 2), (1, 1, 1)] {
            let mut random = Random::new(5);
            let samples =
                Array3::from_shape_simple_fn((z, y, x), || random.below(1 << 24) as f64 / 65537.3);
            let mut whole = samples.clone();
            forward(&mut whole);
            let mut back = whole.clone();
            inverse(&mut back);
            for some in [1, 3] {
                let slabs = Slabs::new([x, y, z]);
                let mut values = samples.clone();
                let each = |n: usize| (0..n).step_by(some).map(move |k| k..(k + some).min(n));
                let in_planes = |values: &mut Array3<f64>, work: fn(Slabs, &mut [f64])| {
                    for range in each(z) {
                        let mut part = values.slice(s![range.clone(), .., ..]).to_owned();
                        work(slabs, part.as_slice_mut().unwrap());
                        values.slice_mut(s![range, .., ..]).assign(&part);
                    }
                };
                let in_walls = |values: &mut Array3<f64>, work: fn(Slabs, &mut [f64], usize)| {
                    for range in each(y) {
                        let (first, at) = (range.start, s![.., range, ..]);
                        let mut part = values.slice(at).as_standard_layout().into_owned();
                        work(slabs, part.as_slice_mut().unwrap(), first);
                        values.slice_mut(at).assign(&part);
                    }
                };
                in_planes(&mut values, Slabs::forward_planes);
                in_walls(&mut values, Slabs::forward_walls);
                assert_eq!(values, whole, "{z}×{y}×{x}, {some}");
                in_walls(&mut values, Slabs::inverse_walls);
                in_planes(&mut values, Slabs::inverse_planes);
                assert_eq!(values, back, "{z}×{y}×{x}, {some}");
            }
        }
    }
}
