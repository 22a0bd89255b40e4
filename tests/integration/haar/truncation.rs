//! What truncation keeps, drops and reports.

use ndarray::Array3;
use proptest::prelude::*;
use walpha::haar::{Decomposition, HaarError, HaarOptions, Tolerance, forward, smooth};
use walpha::volume::{Frame, Volume};

use super::{BOTH, distance_squared, noise};

/// Indices in the order in which coefficients stay.
pub fn by_magnitude(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[b].abs().total_cmp(&values[a].abs()).then(a.cmp(&b)));
    order
}

/// How many stay: the fewest with a tail of squares of at most `budget`, a whole number of
/// 1/(2³·3²·5²·…) or so: far coarser than the rounding that is allowed for.
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
fn nothing_lost_is_nothing_changed() {
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
fn tolerances_that_are_none_are_refused() {
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
