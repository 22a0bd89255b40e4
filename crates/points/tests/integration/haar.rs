//! The Haar stage against its definition: explicit basis functions, sorting, sums, ties and zeros, truncation.

use ndarray::{Array3, ArrayView3};
use proptest::prelude::*;
use walpha_base::Sum;
use walpha_base::advice::Advise;
use walpha_base::random::Random;
use walpha_points::haar::{Decomposition, HaarError, HaarOptions, Tolerance, forward, smooth};
use walpha_volume::{Frame, Volume};

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
    // Rounded once: the error of a running sum would be that of the test.
    let sum: Sum = values.iter().map(|&v| v.into().powi(2)).collect();
    sum.value()
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

/// For data of any size, exactly those coefficients are 0 that are 0 in exact numbers.
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
            // Values some ulps away from the exact sum, which a user may give.
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
        // If the cut separates a pair of equal coefficients, the image is not symmetric.
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

/// Indices in the order in which coefficients stay.
pub fn by_magnitude(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[b].abs().total_cmp(&values[a].abs()).then(a.cmp(&b)));
    order
}

/// The number of coefficients that stay: the smallest number with a tail of squares of at most `budget`, a multiple of
/// approximately 1/(2³·3²·5²·…), far coarser than the rounding that is allowed for.
fn fewest(values: &[f64], order: &[usize], budget: f64) -> usize {
    let mut tail = 0.0;
    let fits = |&&i: &&usize| {
        tail += values[i].powi(2);
        tail <= budget * (1.0 + 1e-11)
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
            let mut coefficients = forward(samples.view(), Decomposition::NonStandard);
            let before: Vec<f64> = coefficients.values().iter().copied().collect();
            let order = by_magnitude(&before);
            let truncation = coefficients.truncate(asked).unwrap();
            let stay = match asked {
                Tolerance::Coefficients(n) => row.len().min(n as usize),
                Tolerance::Epsilon(e) => fewest(&before, &order, e * e),
                other => panic!("{other:?} is not tested"),
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
        let mut coefficients = forward(samples.view(), Decomposition::NonStandard);
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
    let mut coefficients = forward(samples.view(), Decomposition::NonStandard);
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
                let options =
                    HaarOptions::default().decomposition(decomposition).tolerance(tolerance);
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
                    other => panic!("{other:?} is not tested"),
                }
            }
        }
    }
}

#[test]
fn keeping_all_coefficients_changes_no_sample() {
    let mut samples = noise([21, 10, 6], 3);
    samples[[0, 0, 0]] = -0.0;
    let volume = Volume::new(samples, Frame::VOXEL).unwrap().with_gray_levels();
    for tolerance in [Tolerance::Rms(0.0), Tolerance::Epsilon(0.0), Tolerance::Coefficients(9999)] {
        let options = HaarOptions::default().tolerance(tolerance);
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
        let options = HaarOptions::default().tolerance(tolerance);
        let (smoothed, truncation) = smooth(&volume, &options).unwrap();
        assert_eq!(truncation.kept, 0);
        assert!(smoothed.as_slice().iter().all(|&v| v == 0.0));
    }
}

#[test]
fn invalid_tolerances_are_refused() {
    let volume = Volume::new(noise([2, 2, 2], 1), Frame::VOXEL).unwrap();
    for tolerance in [Tolerance::Rms(-1.0), Tolerance::Rms(f64::NAN), Tolerance::Epsilon(-0.5)] {
        let options = HaarOptions::default().tolerance(tolerance);
        let error = smooth(&volume, &options).unwrap_err();
        assert!(matches!(error, HaarError::Tolerance { .. }), "{error}");
        assert_eq!(error.advice().unwrap().to_string(), "give a number from 0 up");
        assert!(forward(volume.samples(), Decomposition::Standard).truncate(tolerance).is_err());
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
            let options = HaarOptions::default().decomposition(decomposition).tolerance(tolerance);
            let one = on(1, &options);
            assert!(on(2, &options) == one && on(5, &options) == one, "{options:?}");
        }
    }
}
