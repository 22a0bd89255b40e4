//! The Haar stage against its definition: explicit basis functions, sorting, sums.

use ndarray::Array3;
use proptest::prelude::*;
use walpha::haar::{Decomposition, HaarError, HaarOptions, Tolerance, forward, smooth};
use walpha::volume::{Frame, Volume};

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

/// Reproducible noise in 0..255 (xorshift).
fn noise([x, y, z]: [usize; 3], seed: u64) -> Array3<f32> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    Array3::from_shape_simple_fn((z, y, x), || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / (1u64 << 24) as f32 * 255.0
    })
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

fn norm_squared(values: &Array3<f32>) -> f64 {
    values.iter().map(|&v| f64::from(v).powi(2)).sum()
}

fn distance_squared(a: &Array3<f32>, b: &Array3<f32>) -> f64 {
    a.iter().zip(b).map(|(&a, &b)| (f64::from(a) - f64::from(b)).powi(2)).sum()
}

#[test]
fn coefficients_are_inner_products_with_the_basis() {
    for (seed, dims) in SIZES.into_iter().enumerate() {
        for decomposition in BOTH {
            let f = noise(dims, seed as u64 + 1);
            let coefficients = forward(f.clone(), decomposition);
            let norm = norm_squared(&f).sqrt();
            for ((z, y, x), &c) in coefficients.values().indexed_iter() {
                let expected = inner_product(&f, [x, y, z], decomposition);
                let error = (f64::from(c) - expected).abs();
                assert!(
                    error <= 1e-6 * norm,
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
            let coefficients = forward(f.clone(), decomposition);
            let (before, after) =
                (norm_squared(&f), norm_squared(&coefficients.values().to_owned()));
            assert!((before - after).abs() <= 1e-6 * before, "{dims:?} {decomposition}");
            for (back, v) in coefficients.inverse().iter().zip(&f) {
                assert!((back - v).abs() <= 255.0 * 1e-6, "{dims:?} {decomposition}: {back} {v}");
            }
        }
    }
}

#[test]
fn a_constant_volume_has_no_details_at_all() {
    for dims in SIZES.into_iter().chain([[13, 37, 21]]) {
        for decomposition in BOTH {
            let f = Array3::from_elem((dims[2], dims[1], dims[0]), 0.1f32);
            let mut coefficients = forward(f.clone(), decomposition);
            assert_eq!(coefficients.values().iter().filter(|&&c| c != 0.0).count(), 1, "{dims:?}");
            let truncation = coefficients.truncate(Tolerance::Rms(0.0)).unwrap();
            assert_eq!((truncation.kept, truncation.epsilon), (1, 0.0));
        }
    }
}

/// Indices in the order in which coefficients stay.
fn by_magnitude(values: &[f32]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[b].abs().total_cmp(&values[a].abs()).then(a.cmp(&b)));
    order
}

/// How many stay: the fewest with a tail of squares of at most `budget`. Squares are exact in the
/// tests that call this.
fn fewest(values: &[f32], order: &[usize], budget: f64) -> usize {
    let mut tail = 0.0;
    let fits = |&&i: &&usize| {
        tail += f64::from(values[i]).powi(2);
        tail <= budget
    };
    order.len() - order.iter().rev().take_while(fits).count()
}

proptest! {
    /// On integers and halves (many ties, exact sums) truncation equals sorting.
    #[test]
    fn truncation_is_what_sorting_gives(
        row in prop::collection::vec(-6i8..=6, 1..200),
        budget in 0u32..4000,
        kept in 0u64..220,
    ) {
        // An axis of one sample per line: a row of 2ᵏ distinct coefficients is hard to prescribe,
        // so the samples are chosen, and the coefficients taken as they come.
        let samples = Array3::from_shape_fn((1, 1, row.len()), |(_, _, x)| f32::from(row[x]));
        for asked in [Tolerance::Epsilon(f64::from(budget).sqrt()), Tolerance::Coefficients(kept)] {
            let mut coefficients = forward(samples.clone(), Decomposition::NonStandard);
            let before: Vec<f32> = coefficients.values().iter().copied().collect();
            let order = by_magnitude(&before);
            let truncation = coefficients.truncate(asked).unwrap();
            let stay = match asked {
                Tolerance::Coefficients(n) => row.len().min(n as usize),
                Tolerance::Epsilon(e) => fewest(&before, &order, e * e),
                Tolerance::Rms(_) => unreachable!(),
            };
            prop_assert_eq!(truncation.kept, stay as u64);
            let mut expected = before.clone();
            order[stay..].iter().for_each(|&i| expected[i] = 0.0);
            prop_assert_eq!(coefficients.values().iter().copied().collect::<Vec<_>>(), expected);
        }
    }
}

#[test]
fn of_equal_coefficients_the_first_stay() {
    // Pairs (1, −1) have one detail each, √2, and mean 0.
    let samples =
        Array3::from_shape_fn((1, 1, 64), |(_, _, x)| if x % 2 == 0 { 1.0 } else { -1.0 });
    for kept in [0, 1, 5, 31, 32] {
        let mut coefficients = forward(samples.clone(), Decomposition::NonStandard);
        coefficients.truncate(Tolerance::Coefficients(kept)).unwrap();
        let stay: Vec<usize> = coefficients
            .values()
            .indexed_iter()
            .filter(|(_, c)| **c != 0.0)
            .map(|(i, _)| i.2)
            .collect();
        let first: Vec<usize> = (0..kept as usize).map(|k| 2 * k + 1).collect();
        assert_eq!(stay, first);
    }
    let mut coefficients = forward(samples, Decomposition::NonStandard);
    // ε² = 7 drops three of squares 2, the last ones.
    let truncation = coefficients.truncate(Tolerance::Epsilon(7f64.sqrt())).unwrap();
    assert_eq!(truncation.kept, 29);
    assert!((truncation.epsilon - 6f64.sqrt()).abs() < 1e-6);
    assert!(coefficients.values()[[0, 0, 57]] != 0.0 && coefficients.values()[[0, 0, 59]] == 0.0);
}

#[test]
fn what_is_dropped_is_the_distance() {
    for decomposition in BOTH {
        for dims in [[20, 13, 9], [32, 32, 32]] {
            let volume = Volume::new(noise(dims, 7), Frame::VOXEL).unwrap();
            let n = volume.dims().samples() as f64;
            for tolerance in [
                Tolerance::Rms(0.5),
                Tolerance::Rms(20.0),
                Tolerance::Epsilon(300.0),
                Tolerance::Coefficients(100),
            ] {
                let options = HaarOptions { decomposition, tolerance };
                let (smoothed, truncation) = smooth(&volume, &options).unwrap();
                let distance =
                    distance_squared(&volume.samples().to_owned(), &smoothed.samples().to_owned());
                let dropped = truncation.epsilon.powi(2);
                assert!((distance - dropped).abs() <= 1e-5 * dropped, "{distance} {dropped}");
                assert!((truncation.rms - (dropped / n).sqrt()).abs() < 1e-12);
                assert!(truncation.kept < truncation.total);
                match tolerance {
                    Tolerance::Rms(rms) => assert!(truncation.rms <= rms),
                    Tolerance::Epsilon(epsilon) => assert!(truncation.epsilon <= epsilon),
                    Tolerance::Coefficients(kept) => assert_eq!(truncation.kept, kept),
                }
            }
        }
    }
}

#[test]
fn nothing_lost_is_nothing_changed() {
    let mut samples = noise([21, 10, 6], 3);
    samples[[0, 0, 0]] = -0.0;
    let volume = Volume::new(samples, Frame::VOXEL).unwrap().with_gray_levels();
    for tolerance in [Tolerance::Rms(0.0), Tolerance::Epsilon(0.0), Tolerance::Coefficients(9999)] {
        let options = HaarOptions { tolerance, ..HaarOptions::default() };
        let (smoothed, truncation) = smooth(&volume, &options).unwrap();
        let bits = |v: &Volume| v.as_slice().iter().map(|s| s.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&smoothed), bits(&volume));
        assert!(smoothed.has_gray_levels());
        assert_eq!(truncation.rms, 0.0);
    }
}

#[test]
fn all_lost_is_zero() {
    let volume = Volume::new(noise([5, 4, 3], 3), Frame::VOXEL).unwrap();
    for tolerance in [Tolerance::Coefficients(0), Tolerance::Rms(f64::INFINITY)] {
        let options = HaarOptions { tolerance, ..HaarOptions::default() };
        let (smoothed, truncation) = smooth(&volume, &options).unwrap();
        assert_eq!(truncation.kept, 0);
        assert!(smoothed.as_slice().iter().all(|&v| v == 0.0));
    }
}

#[test]
fn tolerances_that_are_none_are_refused() {
    let volume = Volume::new(noise([2, 2, 2], 1), Frame::VOXEL).unwrap();
    for tolerance in [Tolerance::Rms(-1.0), Tolerance::Rms(f64::NAN), Tolerance::Epsilon(-0.5)] {
        let options = HaarOptions { tolerance, ..HaarOptions::default() };
        let error = smooth(&volume, &options).unwrap_err();
        assert!(matches!(error, HaarError::Tolerance { .. }), "{error}");
        assert!(
            forward(volume.samples().to_owned(), Decomposition::Standard)
                .truncate(tolerance)
                .is_err()
        );
    }
}

#[test]
fn threads_change_no_bit() {
    let volume = Volume::new(noise([90, 71, 83], 11), Frame::VOXEL).unwrap();
    let on = |threads: usize, options: &HaarOptions| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let (smoothed, truncation) = pool.install(|| smooth(&volume, options)).unwrap();
        let bits: Vec<u32> = smoothed.as_slice().iter().map(|v| v.to_bits()).collect();
        (bits, truncation.epsilon.to_bits(), truncation.kept)
    };
    for decomposition in BOTH {
        for tolerance in [Tolerance::Rms(9.3), Tolerance::Coefficients(12_345)] {
            let options = HaarOptions { decomposition, tolerance };
            let one = on(1, &options);
            assert!(on(2, &options) == one && on(5, &options) == one, "{options:?}");
        }
    }
}
