//! The Haar stage against its definition: explicit basis functions, sorting, sums.

mod exact;
mod truncation;

use ndarray::{Array3, ArrayView3};
use walpha::haar::{Decomposition, Tolerance, forward};
use walpha_base::Sum;
use walpha_base::random::Random;

const BOTH: [Decomposition; 2] = [Decomposition::NonStandard, Decomposition::Standard];

/// (x, y, z) sizes: powers of two, odd ones, flat ones, a point.
const SIZES: [[usize; 3]; 14] = [
    [1, 1, 1],
    [2, 1, 1],
    [1, 3, 1],
    [1, 1, 5],
    [2, 2, 2],
    [4, 4, 4],
    [3, 3, 3],
    [5, 5, 5],
    [7, 7, 7],
    [5, 2, 3],
    [7, 4, 1],
    [1, 6, 9],
    [8, 3, 5],
    [11, 2, 6],
];

/// Reproducible noise in 0..255.
fn noise([x, y, z]: [usize; 3], seed: u64) -> Array3<f32> {
    let mut random = Random::new(seed);
    Array3::from_shape_simple_fn((z, y, x), || random.unit() as f32 * 255.0)
}

/// The mean of `2ˡ = width` samples from `start`, as a unit vector.
fn mean_function(n: usize, start: usize, width: usize) -> Vec<f64> {
    let end = n.min(start + width);
    let value = 1.0 / ((end - start) as f64).sqrt();
    (0..n).map(|i| if (start..end).contains(&i) { value } else { 0.0 }).collect()
}

/// The difference between `width` samples before `middle` and up to as many from it on, as a unit
/// vector with mean zero.
fn detail_function(n: usize, middle: usize, width: usize) -> Vec<f64> {
    let (start, end) = (middle - width, n.min(middle + width));
    let (a, b) = (width as f64, (end - middle) as f64);
    let value = |i: usize| match i {
        i if (start..middle).contains(&i) => (b / (a * (a + b))).sqrt(),
        i if (middle..end).contains(&i) => -(a / (b * (a + b))).sqrt(),
        _ => 0.0,
    };
    (0..n).map(value).collect()
}

/// The factor along one axis of the basis function that belongs to index `at`.
fn factor(n: usize, at: usize, width: usize) -> Vec<f64> {
    if (at / width).is_multiple_of(2) {
        mean_function(n, at, 2 * width)
    } else {
        detail_function(n, at, width)
    }
}

/// The coefficient at (x, y, z) as an inner product with its basis function.
fn inner_product(f: &Array3<f32>, at: [usize; 3], decomposition: Decomposition) -> f64 {
    let (nz, ny, nx) = f.dim();
    let dims = [nx, ny, nz];
    let level = |i: usize| if i == 0 { 1 << 20 } else { 1 << i.trailing_zeros() };
    let finest = at.map(level).into_iter().min().unwrap();
    let axis = |a: usize| match decomposition {
        Decomposition::NonStandard => factor(dims[a], at[a], finest),
        Decomposition::Standard => factor(dims[a], at[a], level(at[a])),
    };
    let [fx, fy, fz] = [0, 1, 2].map(axis);
    f.indexed_iter().map(|((z, y, x), &v)| fx[x] * fy[y] * fz[z] * f64::from(v)).sum()
}

fn norm_squared<T: Copy + Into<f64>>(values: ArrayView3<'_, T>) -> f64 {
    // Rounded once: of many terms a plain sum is off by more than the transform is.
    values.iter().map(|&v| v.into().powi(2)).collect::<Sum>().value()
}

fn distance_squared(a: &Array3<f32>, b: &Array3<f32>) -> f64 {
    a.iter().zip(b).map(|(&a, &b)| (f64::from(a) - f64::from(b)).powi(2)).sum()
}

#[test]
fn coefficients_are_inner_products_with_the_basis() {
    for (seed, dims) in SIZES.into_iter().enumerate() {
        for decomposition in BOTH {
            let f = noise(dims, seed as u64 + 1);
            let coefficients = forward(f.view(), decomposition);
            let norm = norm_squared(f.view()).sqrt();
            for ((z, y, x), &c) in coefficients.values().indexed_iter() {
                let expected = inner_product(&f, [x, y, z], decomposition);
                let error = (c - expected).abs();
                assert!(
                    error <= 1e-14 * norm,
                    "{dims:?} {decomposition} at {x},{y},{z}: {c} {expected}"
                );
            }
        }
    }
}

#[test]
fn energy_is_kept_and_the_inverse_gives_the_samples_back() {
    for (seed, dims) in SIZES.into_iter().chain([[33, 17, 50], [64, 64, 64]]).enumerate() {
        for decomposition in BOTH {
            let f = noise(dims, seed as u64 + 100);
            let coefficients = forward(f.view(), decomposition);
            let (before, after) = (norm_squared(f.view()), norm_squared(coefficients.values()));
            assert!((before - after).abs() <= 1e-13 * before, "{dims:?} {decomposition}");
            assert_eq!(coefficients.decomposition(), decomposition);
            assert_eq!(coefficients.inverse(), f, "{dims:?} {decomposition}");
        }
    }
}

#[test]
fn a_constant_volume_has_no_details_at_all() {
    for dims in SIZES.into_iter().chain([[13, 37, 21]]) {
        for decomposition in BOTH {
            let f = Array3::from_elem((dims[2], dims[1], dims[0]), 0.1f32);
            let mut coefficients = forward(f.view(), decomposition);
            assert_eq!(coefficients.values().iter().filter(|&&c| c != 0.0).count(), 1, "{dims:?}");
            let truncation = coefficients.truncate(Tolerance::Rms(0.0)).unwrap();
            assert_eq!((truncation.kept, truncation.epsilon), (1, 0.0));
        }
    }
}
