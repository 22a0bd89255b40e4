use ndarray::Array3;
use rayon::prelude::*;

use super::support::{
    Axis, Step, forward_row, forward_rows, inverse_row, inverse_rows, square, strides,
};

/// Each axis in full, x first, from samples to coefficients.
pub(super) fn forward(values: &mut Array3<f64>) {
    let (z, y, x) = values.dim();
    let flat = values.as_slice_mut().expect("standard layout");
    flat.par_chunks_mut(x)
        .for_each(|row| strides(x).for_each(|s| forward_row(row, Axis::of_samples(x), s)));
    flat.par_chunks_mut(x * y).for_each(|slice| along(slice, y, false));
    along(flat, z, false);
    scale(flat, [x, y, z], |square| 1.0 / square.sqrt());
}

/// Each axis in full, z first, from coefficients to samples.
pub(super) fn inverse(values: &mut Array3<f64>) {
    let (z, y, x) = values.dim();
    let flat = values.as_slice_mut().expect("standard layout");
    scale(flat, [x, y, z], f64::sqrt);
    along(flat, z, true);
    flat.par_chunks_mut(x * y).for_each(|slice| along(slice, y, true));
    flat.par_chunks_mut(x)
        .for_each(|row| strides(x).rev().for_each(|s| inverse_row(row, Axis::of_samples(x), s)));
}

/// All levels along the slowest of the axes of `flat`, which has n lines.
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

/// Multiplies each value by a function of its square.
fn scale(flat: &mut [f64], dims: [usize; 3], of: impl Fn(f64) -> f64 + Sync) {
    let [in_x, in_y, in_z] = dims.map(squares);
    flat.par_chunks_mut(dims[0]).enumerate().for_each(|(row, values)| {
        let square_yz = in_y[row % dims[1]] * in_z[row / dims[1]];
        for (value, square_x) in values.iter_mut().zip(&in_x) {
            *value *= of(square_yz * square_x);
        }
    });
}

/// The factors of a row of n samples.
fn squares(n: usize) -> Vec<f64> {
    let at = |i: usize| if i == 0 { n as f64 } else { square(n, 1 << i.trailing_zeros(), i) };
    (0..n).map(at).collect()
}
