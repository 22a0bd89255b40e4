//! Differences, selection and weights against brute force and by their laws.

mod files;
#[cfg(feature = "las")]
mod scans;

use std::path::Path;

use ndarray::Array3;
use proptest::prelude::*;
use walpha_points::haar::{HaarOptions, Tolerance, smooth};
use walpha_points::*;
use walpha_shape::Alpha;
use walpha_volume::{Frame, Gray, Volume, VolumeError, sample};

use crate::Told;

fn volume(samples: Array3<f32>) -> Volume {
    Volume::new(samples, Frame::VOXEL).unwrap().with_gray_levels()
}

/// L by its definition.
fn slow_difference(f: &Array3<f32>) -> Array3<f64> {
    let get = |z: i64, y: i64, x: i64| {
        let inside = z >= 0 && y >= 0 && x >= 0;
        if inside { f.get([z as usize, y as usize, x as usize]).copied() } else { None }
    };
    Array3::from_shape_fn(f.dim(), |(z, y, x)| {
        let (z, y, x) = (z as i64, y as i64, x as i64);
        let neighbours = [(0, 0, -1), (0, 0, 1), (0, -1, 0), (0, 1, 0), (-1, 0, 0), (1, 0, 0)];
        let here = f64::from(get(z, y, x).unwrap());
        let there = neighbours.iter().filter_map(|(dz, dy, dx)| get(z + dz, y + dy, x + dx));
        there.map(|v| (here - f64::from(v)).abs()).sum::<f64>() / 6.0
    })
}

fn grid() -> impl Strategy<Value = Array3<f32>> {
    (1usize..7, 1usize..7, 1usize..7).prop_flat_map(|(z, y, x)| {
        prop::collection::vec(0u8..5, x * y * z).prop_map(move |values| {
            let values = values.into_iter().map(f32::from).collect();
            Array3::from_shape_vec((z, y, x), values).unwrap()
        })
    })
}

/// Voxel indices the rule chooses, by sorting.
fn slow_selection(l: &Array3<f64>, f: &Array3<f32>, selection: &Selection) -> Option<Vec<usize>> {
    let (l, f): (Vec<f64>, Vec<f32>) = (l.iter().copied().collect(), f.iter().copied().collect());
    let least = selection.gray_min.unwrap_or(f64::NEG_INFINITY);
    let mut open: Vec<usize> = (0..l.len()).filter(|&i| f64::from(f[i]) >= least).collect();
    open.sort_by(|&a, &b| l[b].total_cmp(&l[a]).then(a.cmp(&b)));
    let count = match selection.rule {
        SelectionRule::Count(n) => n as usize,
        SelectionRule::Ratio(r) => ((r * l.len() as f64).round() as usize).max(1),
        SelectionRule::Threshold(t) => open.iter().filter(|&&i| l[i] >= t).count(),
        other @ SelectionRule::AtMost(_) => panic!("{other:?} is not tested"),
    };
    if count == 0 || count > open.len() {
        return None;
    }
    open.truncate(count);
    open.sort_unstable();
    Some(open)
}

proptest! {
    #[test]
    fn differences_are_those_of_the_definition(f in grid()) {
        prop_assert_eq!(difference(&volume(f.clone())), slow_difference(&f));
    }

    #[test]
    fn selection_is_what_sorting_gives(
        f in grid(),
        rule in prop_oneof![
            (0u64..40).prop_map(SelectionRule::Count),
            (0.001f64..=1.0).prop_map(SelectionRule::Ratio),
            (0.0f64..4.0).prop_map(SelectionRule::Threshold),
            // Just at an L: sixths of whole numbers.
            (1u8..24).prop_map(|sixths| SelectionRule::Threshold(f64::from(sixths) / 6.0)),
        ],
        gray_min in prop::option::of(0.0f64..4.0),
    ) {
        let selection = Selection::default().rule(rule).gray_min(gray_min);
        let (v, l) = (volume(f.clone()), slow_difference(&f));
        let (_, ny, nx) = f.dim();
        let chosen = select(&v, &v, &l, &selection, Units::Voxel);
        match slow_selection(&l, &f, &selection) {
            None => prop_assert!(chosen.is_err()),
            Some(expected) => {
                let points = chosen.unwrap();
                let index = |[x, y, z]: &[f64; 3]| *x as usize + nx * (*y as usize + ny * *z as usize);
                prop_assert_eq!(points.positions.iter().map(index).collect::<Vec<_>>(), expected.clone());
                let at = |column: Vec<f64>| -> Vec<f64> { expected.iter().map(|&i| column[i]).collect() };
                prop_assert_eq!(points.values.unwrap(), at(f.iter().map(|&v| v.into()).collect()));
                prop_assert_eq!(points.differences.unwrap(), at(l.into_iter().collect()));
            }
        }
    }
}

#[test]
fn the_skull_is_cut_where_it_should_be() {
    let skull = match sample("sample:skull") {
        Ok(skull) => skull,
        Err(missing @ VolumeError::NoSkull { .. }) => {
            eprintln!("skipped: {missing}");
            return;
        }
        Err(other) => panic!("{other}"),
    };
    let (gray, _) = skull.into_gray(Gray::Automatic).unwrap();
    let options = HaarOptions::default().tolerance(Tolerance::Rms(0.0));
    let (smoothed, _) = smooth(&gray, &options).unwrap();
    let l = difference(&smoothed);
    let by_count = Selection::default().rule(SelectionRule::Count(15956));
    let points = select(&gray, &smoothed, &l, &by_count, Units::Voxel).unwrap();
    let least = points.differences.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    assert!((least - 20.36094).abs() < 5e-6, "{least}");
    let by_threshold = Selection::default().rule(SelectionRule::Threshold(20.3608));
    assert_eq!(select(&gray, &smoothed, &l, &by_threshold, Units::Voxel).unwrap(), points);
    let next = Selection::default().rule(SelectionRule::Count(15957));
    let next = select(&gray, &smoothed, &l, &next, Units::Voxel).unwrap();
    let least = next.differences.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    assert!((least - 20.36070).abs() < 5e-6, "{least}");
    // 0.0609 · 262144 = 15964.57
    let default = select(&gray, &smoothed, &l, &Selection::default(), Units::Voxel).unwrap();
    assert_eq!(default.len(), 15965);
}

#[test]
fn world_units_follow_the_frame() {
    let frame = Frame { origin: [10.0, 20.0, 30.0], spacing: [2.0, 3.0, 0.5], ..Frame::VOXEL };
    let f = Array3::from_shape_fn((2, 2, 2), |(z, y, x)| (x + 2 * y + 4 * z) as f32);
    let v = Volume::new(f, frame).unwrap().with_gray_levels();
    let all = Selection::default().rule(SelectionRule::Ratio(1.0));
    let points = select(&v, &v, &difference(&v), &all, Units::World).unwrap();
    assert_eq!(points.positions[7], [12.0, 23.0, 30.5]);
    assert_eq!(points.positions[1], [12.0, 20.0, 30.0]);
}

/// Hounsfield units are not taken for gray levels.
#[test]
fn other_values_than_gray_levels_are_refused() {
    let values = Array3::from_shape_fn((2, 2, 2), |(z, y, x)| (1000 * (x + y + z)) as f32);
    let scan = Volume::new(values, Frame::VOXEL).unwrap();
    let all = |volume: &Volume| {
        let all = Selection::default().rule(SelectionRule::Ratio(1.0));
        select(volume, volume, &difference(volume), &all, Units::Voxel)
    };
    let told = all(&scan).unwrap_err().told();
    assert!(told.contains("0 to 3000") && told.contains("into_gray"), "{told}");
    let (gray, range) = scan.into_gray(Gray::Automatic).unwrap();
    assert_eq!((range.low, range.high), (0.0, 3000.0));
    assert_eq!(
        all(&gray).unwrap().values.unwrap(),
        [0, 1, 1, 2, 1, 2, 2, 3].map(|n| 85.0 * f64::from(n))
    );
}

#[test]
fn a_volume_without_samples_says_so() {
    let v = volume(Array3::zeros((2, 3, 4))).with_missing(Some(vec![true; 24]));
    let told = select(&v, &v, &difference(&v), &Selection::default(), Units::Voxel);
    assert!(told.unwrap_err().told().contains("none of 24 voxels"));
}

#[test]
fn impossible_selections_say_what_is_possible() {
    let v = volume(Array3::zeros((2, 3, 4)));
    let l = difference(&v);
    let refuse = |rule, gray_min| {
        select(&v, &v, &l, &Selection::default().rule(rule).gray_min(gray_min), Units::Voxel)
            .unwrap_err()
            .told()
    };
    assert!(
        refuse(SelectionRule::Count(1), None).contains("none of the 24 that take part differs")
    );
    assert!(
        refuse(SelectionRule::Count(25), None).contains("none of the 24 that take part differs")
    );
    let step = volume(Array3::from_shape_fn((1, 1, 9), |(_, _, x)| if x < 4 { 0.0 } else { 9.0 }));
    for count in [0, 3, 10] {
        let rule = Selection::default().rule(SelectionRule::Count(count));
        let told =
            select(&step, &step, &difference(&step), &rule, Units::Voxel).unwrap_err().told();
        assert!(
            told.contains("2 samples take part and differ") && told.contains("1 to 2"),
            "{told}"
        );
    }
    assert!(refuse(SelectionRule::Count(1), Some(1.0)).contains("no voxel reaches"));
    assert!(
        refuse(SelectionRule::Threshold(0.5), None)
            .contains("a difference of 0.5 gray levels: the largest is 0")
    );
    for ratio in [0.0, -0.1, 1.1, f64::NAN] {
        assert!(refuse(SelectionRule::Ratio(ratio), None).contains("ratio"));
    }
    assert!(refuse(SelectionRule::Threshold(f64::NAN), None).contains("threshold"));
    assert!(refuse(SelectionRule::Count(1), Some(f64::NAN)).contains("a least gray level of NaN"));
}

#[test]
fn threads_change_no_selection() {
    let f =
        Array3::from_shape_fn((70, 61, 52), |(z, y, x)| ((x * 7 + y * 13 + z * 29) % 17) as f32);
    let v = volume(f);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let select = || select(&v, &v, &difference(&v), &Selection::default(), Units::Voxel);
        pool.install(select).unwrap()
    };
    assert_eq!(on(1).len(), (0.0609 * 222_040f64).round() as usize);
    assert!(on(1) == on(2) && on(1) == on(5));
}

/// L = 5/6 twice: neither is lost to a threshold of 5/6.
#[test]
fn a_threshold_that_is_an_l_takes_it() {
    let v = volume(Array3::from_shape_fn((1, 1, 2), |(_, _, x)| 5.0 * x as f32));
    let rule = SelectionRule::Threshold(5.0 / 6.0);
    let selection = Selection::default().rule(rule);
    assert_eq!(select(&v, &v, &difference(&v), &selection, Units::Voxel).unwrap().len(), 2);
    let above = selection.rule(SelectionRule::Threshold((5f64 / 6.0).next_up()));
    assert!(select(&v, &v, &difference(&v), &above, Units::Voxel).is_err());
}

#[test]
fn a_least_gray_level_that_is_a_gray_takes_it() {
    let v = volume(Array3::from_shape_fn((1, 1, 3), |(_, _, x)| 5.0 * x as f32));
    let taken = |least: f64| {
        let rule = SelectionRule::Threshold(0.0);
        let selection = Selection::default().rule(rule).gray_min(Some(least));
        select(&v, &v, &difference(&v), &selection, Units::Voxel).unwrap().values.unwrap()
    };
    assert_eq!(taken(5.0), [5.0, 10.0]);
    assert_eq!(taken(5f64.next_up()), [10.0]);
}

/// L of a little more than another is chosen first, even where single precision cannot tell.
#[test]
fn close_differences_are_told_apart() {
    let mut samples = Array3::zeros((1, 1, 8));
    (samples[[0, 0, 1]], samples[[0, 0, 5]]) = (200.0, 200.0f32.next_up());
    samples[[0, 0, 3]] = 1e-7;
    let v = volume(samples);
    let selection = Selection::default().rule(SelectionRule::Count(1));
    let points = select(&v, &v, &difference(&v), &selection, Units::Voxel).unwrap();
    assert_eq!(points.positions, [[5.0, 0.0, 0.0]]);
    let l = difference(&v);
    // 200/6 and 10⁻⁷/6 more.
    assert!(l[[0, 0, 2]] > l[[0, 0, 0]] && l[[0, 0, 2]] as f32 == l[[0, 0, 0]] as f32);
}

/// The default never requests more points than exist; a user may.
#[test]
fn the_default_takes_all_where_little_is_left() {
    let samples = Array3::from_shape_fn((10, 10, 10), |(z, y, x)| (100 * z + 10 * y + x) as f32);
    let v = volume(samples);
    let l = difference(&v);
    let taken = |selection: Selection| select(&v, &v, &l, &selection, Units::Voxel);
    assert_eq!(taken(Selection::default()).unwrap().len(), 61);
    for (least, count) in [(900.0, 61), (939.0, 61), (940.0, 60), (999.0, 1)] {
        assert_eq!(taken(Selection::default().gray_min(least)).unwrap().len(), count, "{least}");
        let asked = taken(Selection::default().rule(SelectionRule::Ratio(0.0609)).gray_min(least));
        assert_eq!(asked.is_ok(), count == 61, "{least}");
    }
    assert!(taken(Selection::default().gray_min(1000.0)).is_err());
    let wrong = Selection::default().rule(SelectionRule::AtMost(0.0));
    assert!(taken(wrong).unwrap_err().told().contains("a ratio of 0"));
}

fn points(differences: &[f64]) -> Points {
    let positions = (0..differences.len()).map(|i| [i as f64, 0.0, 0.0]).collect();
    Points::new(positions).with_differences(differences.to_vec()).unwrap()
}

#[test]
fn weights_follow_their_equations() {
    let four = points(&[1.0, 2.0, 2.0, 5.0]);
    let of = |weighting| {
        weigh(four.clone(), weighting, Alpha::from_squared(8.0).unwrap()).unwrap().into_parts().1
    };
    assert_eq!(of(Weighting::Common(3.0)), [3.0; 4]);
    assert_eq!(of(Weighting::MinMax), [0.0, 2.0, 2.0, 8.0]);
    assert_eq!(of(Weighting::Barycentric), [0.8, 1.6, 1.6, 4.0]);
    let n =
        weigh(four.clone(), Weighting::BarycentricN, Alpha::from_squared(8.0).unwrap()).unwrap();
    assert_eq!((n.len(), n.is_empty()), (4, false));
    assert_eq!(n.weights(), [3.2, 6.4, 6.4, 16.0]);
    assert_eq!(n.summary(), WeightSummary { min: 3.2, mean: 8.0, max: 16.0 });
}

#[test]
fn equal_differences_weigh_nothing_by_min_max() {
    assert_eq!(
        weigh(points(&[2.0; 3]), Weighting::MinMax, Alpha::from_squared(9.0).unwrap())
            .unwrap()
            .weights(),
        [0.0; 3]
    );
    for weighting in [Weighting::MinMax, Weighting::Barycentric, Weighting::BarycentricN] {
        assert_eq!(
            weigh(points(&[0.0; 3]), weighting, Alpha::from_squared(9.0).unwrap())
                .unwrap()
                .weights(),
            [0.0; 3]
        );
    }
}

#[test]
fn weights_that_cannot_be_are_refused() {
    let here = points(&[1.0, 2.0]);
    for weighting in [Weighting::MinMax, Weighting::Barycentric, Weighting::BarycentricN] {
        let text = weigh(here.clone(), weighting, Alpha::INFINITE).unwrap_err().told();
        assert!(text.contains("finite α"), "{text}");
        let scattered = Points::new(here.positions.clone());
        let text = weigh(scattered.clone(), weighting, Alpha::from_squared(1.0).unwrap())
            .unwrap_err()
            .told();
        assert!(text.contains("column") && text.contains("common=C"), "{text}");
    }
    assert!(weigh(here.clone(), Weighting::Common(1.0), Alpha::INFINITE).is_ok());
    assert!(matches!(
        weigh(here.clone(), Weighting::Column, Alpha::from_squared(1.0).unwrap()),
        Err(PointsError::NoColumn)
    ));
    let error = weigh(here.clone(), Weighting::Common(f64::NAN), Alpha::from_squared(1.0).unwrap())
        .unwrap_err();
    assert!(matches!(error, PointsError::Weight { index: 0, .. }));
}

#[test]
fn weightings_are_read_as_they_are_written() {
    use Weighting::*;
    for weighting in [Common(10.0), Common(-0.5), MinMax, Barycentric, BarycentricN, Column] {
        assert_eq!(weighting.to_string().parse(), Ok(weighting));
    }
    for text in ["common", "common=", "common=nan", "common=inf", "minmax", ""] {
        assert!(text.parse::<Weighting>().unwrap_err().told().contains("min-max"), "{text}");
    }
}
