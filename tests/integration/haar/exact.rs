//! Ties and zeros, which rounding must not decide.

use ndarray::Array3;
use walpha::haar::{Decomposition, HaarOptions, Tolerance, forward, smooth};
use walpha::volume::{Frame, Volume};

use super::truncation::by_magnitude;
use super::{BOTH, SIZES, noise};

/// Whole numbers, mostly equal to their neighbours.
fn blocks([x, y, z]: [usize; 3], seed: u64) -> Array3<f32> {
    let whole = noise([x.div_ceil(3), y.div_ceil(3), z.div_ceil(3)], seed).mapv(f32::floor);
    Array3::from_shape_fn((z, y, x), |(k, j, i)| whole[[k / 3, j / 3, i / 3]])
}

/// A whole number for each x, y and z, summed: details along two axes are 0, though no two samples
/// need be equal.
fn sums([x, y, z]: [usize; 3], seed: u64) -> Array3<f32> {
    let parts = noise([x + y + z, 1, 1], seed).mapv(f32::floor);
    Array3::from_shape_fn((z, y, x), |(k, j, i)| {
        parts[[0, 0, i]] + parts[[0, 0, x + j]] + parts[[0, 0, x + y + k]]
    })
}

/// A coefficient times what makes it a whole number; nothing is rounded.
fn whole_product(f: &Array3<f32>, at: [usize; 3], decomposition: Decomposition) -> i128 {
    let (nz, ny, nx) = f.dim();
    let dims = [nx, ny, nz];
    let level = |i: usize| if i == 0 { 1 << 20 } else { 1 << i.trailing_zeros() };
    let finest = at.map(level).into_iter().min().unwrap();
    let axis = |a: usize| -> Vec<i128> {
        let width = if decomposition == Decomposition::Standard { level(at[a]) } else { finest };
        let (n, at) = (dims[a], at[a]);
        if (at / width).is_multiple_of(2) {
            return (0..n).map(|i| i128::from((at..at + 2 * width).contains(&i))).collect();
        }
        let (first, second) = (at - width..at, at..n.min(at + width));
        let (a, b) = (first.len() as i128, second.len() as i128);
        let value =
            |i: usize| i128::from(first.contains(&i)) * b - i128::from(second.contains(&i)) * a;
        (0..n).map(value).collect()
    };
    let [fx, fy, fz] = [0, 1, 2].map(axis);
    f.indexed_iter().map(|((z, y, x), &v)| fx[x] * fy[y] * fz[z] * v as i128).sum()
}

/// Of any size: what is 0 in exact numbers is 0, and nothing else is.
#[test]
fn coefficients_are_zero_just_where_they_are() {
    for (seed, dims) in SIZES.into_iter().chain([[13, 17, 11], [20, 9, 15]]).enumerate() {
        let kinds = [blocks(dims, seed as u64 + 50), sums(dims, seed as u64 + 70)];
        for (decomposition, f) in BOTH.into_iter().flat_map(|d| kinds.iter().map(move |f| (d, f))) {
            let mut coefficients = forward(f.view(), decomposition);
            let mut nonzero = 0;
            for ((z, y, x), &c) in coefficients.values().indexed_iter() {
                let exact = whole_product(f, [x, y, z], decomposition);
                assert_eq!(c == 0.0, exact == 0, "{dims:?} {decomposition} at {x},{y},{z}: {c}");
                nonzero += u64::from(exact != 0);
            }
            assert_eq!(coefficients.truncate(Tolerance::Rms(0.0)).unwrap().kept, nonzero);
        }
    }
}

/// ε at what a cut drops: neither one coefficient more is kept, nor one fewer.
#[test]
fn an_epsilon_at_a_bound_is_within() {
    for (seed, dims) in [[16, 8, 4], [9, 7, 5], [12, 1, 1], [8, 8, 8]].into_iter().enumerate() {
        let f = noise(dims, seed as u64 + 30).mapv(|v| (v / 32.0).floor());
        let coefficients = forward(f.view(), Decomposition::NonStandard);
        let values: Vec<f64> = coefficients.values().iter().copied().collect();
        let order = by_magnitude(&values);
        let mut tail = 0.0;
        for stay in (1..order.len()).rev() {
            tail += values[order[stay]].powi(2);
            if values[order[stay - 1]] == 0.0 {
                continue;
            }
            // Some ulps beside the exact sum, as a user's number may be.
            for epsilon in [tail.sqrt(), tail.sqrt() * (1.0 - 1e-15), tail.sqrt() * (1.0 + 1e-15)] {
                let truncation =
                    coefficients.clone().truncate(Tolerance::Epsilon(epsilon)).unwrap();
                assert_eq!(truncation.kept, stay as u64, "{dims:?} {epsilon}");
            }
        }
    }
}

/// A volume that is its own mirror image stays one, so mirrored voxels tie for their index.
#[test]
fn mirrored_samples_stay_equal() {
    let half = noise([8, 16, 16], 5);
    let f = Array3::from_shape_fn((16, 16, 16), |(z, y, x)| half[[z, y, x.min(15 - x)]]);
    let volume = Volume::new(f, Frame::VOXEL).unwrap();
    let mut whole = 0;
    for rms in [2.0, 3.0, 5.0, 8.0, 12.0, 18.0, 25.0, 30.0] {
        let options = HaarOptions::default().tolerance(Tolerance::Rms(rms));
        let mut coefficients = forward(volume.samples(), options.decomposition);
        let (smoothed, truncation) = smooth(&volume, &options).unwrap();
        coefficients.truncate(options.tolerance).unwrap();
        // Where the cut parts a pair of equal coefficients, the image is another.
        let kept = coefficients.values();
        let least = kept.iter().filter(|c| **c != 0.0).fold(f64::INFINITY, |m, c| m.min(c.abs()));
        let all = forward(volume.samples(), options.decomposition);
        let parted = all.values().iter().zip(&kept).any(|(c, k)| c.abs() == least && *k == 0.0);
        let samples = smoothed.samples();
        let mirrored = samples.indexed_iter().all(|((z, y, x), v)| *v == samples[[z, y, 15 - x]]);
        assert!(parted || mirrored, "{truncation:?}");
        whole += usize::from(!parted);
    }
    assert!(whole > 1);
}
