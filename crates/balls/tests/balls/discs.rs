//! Discs in the plane.

use std::f64::consts::PI;

use walpha_balls::DiscUnion;
use walpha_base::random::Random;

use crate::{assert_is, shape};

#[test]
fn few_discs_are_known() {
    let one = shape(&[[3.0, 4.0, 5.0]], &[4.0]);
    let union = DiscUnion::new(&one).unwrap();
    assert_is(union.area(), 4.0 * PI);
    assert_is(union.perimeter(), 4.0 * PI);
    // Two circles of radius 1 at distance 1: each loses 120°.
    let two = shape(&[[0.0; 3], [0.0, 0.0, 1.0]], &[1.0; 2]);
    let union = DiscUnion::new(&two).unwrap();
    assert_is(union.area(), 2.0 * PI - (2.0 * PI / 3.0 - 0.75f64.sqrt()));
    assert_is(union.perimeter(), 8.0 / 3.0 * PI);
    assert_is(union.contacts().sizes.get(0), 3f64.sqrt());
    assert_is(union.areas().get(0), union.area().value / 2.0);
    // One hides the other.
    let hidden = shape(&[[0.0; 3], [0.0, 0.0, 0.5]], &[4.0, 1.0]);
    let union = DiscUnion::new(&hidden).unwrap();
    assert_is(union.area(), 4.0 * PI);
    assert_eq!((union.areas().values[1], union.perimeters().values[1]), (0.0, 0.0));
}

/// A square lattice in a tilted plane, below, at and above the α where its squares fill.
#[test]
fn lattices_have_lenses() {
    let n = 6;
    // (3, 4, 0)/5 and (0, 0, 1) span the plane; 5 times them are integers.
    let centers: Vec<[f64; 3]> = (0..n * n)
        .map(|i| (f64::from(i % n), f64::from(i / n)))
        .map(|(x, y)| [3.0 * x, 4.0 * x, 5.0 * y])
        .collect();
    for squared in [6.0, 6.25, 9.0, 12.0, 12.5, 12.5f64.next_down()] {
        let shape = shape(&centers, &vec![squared; centers.len()]);
        let union = DiscUnion::new(&shape).unwrap();
        let r = f64::sqrt(squared);
        let half = (2.5 / r).min(1.0).acos();
        let lens = 2.0 * squared * (half - half.sin() * half.cos());
        let count = f64::from(n);
        let links = 2.0 * count * (count - 1.0);
        assert_is(union.area().per(100.0), (count * count * PI * squared - links * lens) / 100.0);
        let perimeter = count * count * 2.0 * PI * r - links * 4.0 * half * r;
        assert_is(union.perimeter().per(100.0), perimeter / 100.0);
        let holes = if squared < 6.25 { -1 } else { i64::from(squared < 12.5) * 25 - 1 };
        let chi = if squared < 6.25 { 36 } else { -holes };
        assert_eq!(union.euler_characteristic(), chi, "{squared}");
        let inner = union.areas().get(2 * 6 + 2);
        assert_is(inner, PI * squared - 2.0 * lens);
    }
}

trait Per {
    fn per(self, unit: f64) -> Self;
}

impl Per for walpha_balls::Bounded {
    fn per(self, unit: f64) -> Self {
        Self { value: self.value / unit, bound: self.bound / unit }
    }
}

#[test]
fn parts_are_those_of_samples() {
    let mut random = Random::new(3);
    let n = 80;
    let centers: Vec<[f64; 3]> =
        (0..n).map(|_| [random.unit() * 12.0, random.unit() * 12.0, 0.0]).collect();
    let squares: Vec<f64> = (0..n).map(|_| (0.5 + random.unit()).powi(2)).collect();
    let shape = shape(&centers, &squares);
    let union = DiscUnion::new(&shape).unwrap();
    let fine = 1500;
    let step = 15.0 / f64::from(fine);
    let mut sampled = vec![0.0; n];
    for i in 0..fine * fine {
        let at = |k: i32| (f64::from(k) + 0.5) * step - 1.5;
        let (x, y) = (at(i % fine), at(i / fine));
        let power =
            |v: usize| (x - centers[v][0]).powi(2) + (y - centers[v][1]).powi(2) - squares[v];
        let least = (0..n).map(|v| (power(v), v)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
        if least.0 <= 0.0 {
            sampled[least.1] += step * step;
        }
    }
    for (v, sampled) in sampled.into_iter().enumerate() {
        let found = union.areas().get(v);
        assert!((found.value - sampled).abs() < 0.02, "{v}: {found:?} {sampled}");
        assert!(found.bound < 1e-12);
    }
    let [areas, perimeters] =
        [union.areas(), union.perimeters()].map(|column| column.values.iter().sum::<f64>());
    assert!((areas - union.area().value).abs() < 1e-11);
    assert!((perimeters - union.perimeter().value).abs() < 1e-11);
    // The perimeter is the derivative of the area by a growth of all radii.
    let area = |more: f64| {
        let grown: Vec<f64> = squares.iter().map(|s| (s.sqrt() + more).powi(2)).collect();
        DiscUnion::new(&crate::shape(&centers, &grown)).unwrap().area().value
    };
    let growth = (area(1e-5) - area(-1e-5)) / 2e-5;
    assert!((growth - union.perimeter().value).abs() < 1e-5 * growth, "{growth}");
}
