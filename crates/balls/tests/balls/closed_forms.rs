//! A few balls, and lattices, whose measures are known.

use std::f64::consts::PI;

use walpha_balls::BallUnion;
use walpha_shape::Torus;

use crate::{assert_consistent, assert_is, assert_same, shape, shape_on};

#[test]
fn one_ball_is_a_ball() {
    for r in [1.0, 0.3, 1e-6, 1e6, 7e-40, 3e90] {
        let shape = shape(&[[0.1, -7.0, 1e3]], &[r * r]);
        let union = BallUnion::new(&shape).unwrap();
        let r = (r * r).sqrt();
        assert_is(union.volume().per(r * r * r), 4.0 / 3.0 * PI);
        assert_is(union.area().per(r * r), 4.0 * PI);
        assert_is(union.mean_curvature().per(r), 4.0 * PI);
        assert_is(union.gaussian_curvature(), 4.0 * PI);
        assert_eq!(union.euler_characteristic(), 1);
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

/// Volume, area and mean curvature of two balls, and their contact.
fn two(d: f64, [a, b]: [f64; 2]) -> [f64; 4] {
    let x = (d * d + a * a - b * b) / (2.0 * d);
    let (cap_a, cap_b) = (a - x, b - (d - x));
    let cap = |r: f64, h: f64| PI * h * h * (3.0 * r - h) / 3.0;
    let ball = |r: f64| 4.0 / 3.0 * PI * r * r * r;
    let squared = a * a - x * x;
    let bend = ((a * a + b * b - d * d) / (2.0 * a * b)).clamp(-1.0, 1.0).acos();
    [
        ball(a) + ball(b) - cap(a, cap_a) - cap(b, cap_b),
        4.0 * PI * (a * a + b * b) - 2.0 * PI * (a * cap_a + b * cap_b),
        4.0 * PI * (a + b) - 2.0 * PI * (cap_a + cap_b) - PI * squared.max(0.0).sqrt() * bend,
        PI * squared,
    ]
}

#[test]
fn two_balls_share_a_lens() {
    // The plane of the circle lies between the centres, through one, and beyond one.
    for (d, radii) in
        [(1.0, [1.0, 1.0]), (1.5, [1.0, 1.25]), (0.75, [1.25, 1.0]), (1.0, [2.0, 1.5])]
    {
        let shape = shape(&[[0.0; 3], [0.0, d, 0.0]], &radii.map(|r| r * r));
        let union = BallUnion::new(&shape).unwrap();
        let [volume, area, mean, contact] = two(d, radii);
        assert_is(union.volume(), volume);
        assert_is(union.area(), area);
        assert_is(union.mean_curvature(), mean);
        assert_is(union.contacts().sizes.get(0), contact);
        assert_eq!(union.contacts().pairs, [[0, 1]]);
        assert_consistent(&union);
    }
}

#[test]
fn balls_that_touch_share_a_point() {
    // They touch, and all but touch from either side: the smallest doubles around 2.
    for (d, chi) in [(2.0, 1), (2f64.next_down(), 1), (2f64.next_up(), 2)] {
        let shape = shape(&[[0.0; 3], [d, 0.0, 0.0]], &[1.0; 2]);
        let union = BallUnion::new(&shape).unwrap();
        assert_is(union.volume(), 8.0 / 3.0 * PI);
        assert_is(union.area(), 8.0 * PI);
        assert_eq!(union.euler_characteristic(), chi);
        // An arc of radius 10⁻⁸ where the surface turns back.
        let arc = if d < 2.0 { PI * PI * f64::EPSILON.sqrt() } else { 0.0 };
        let mean = union.mean_curvature();
        assert!((mean.value - (8.0 * PI - arc)).abs() <= mean.bound + 1e-13, "{mean:?} {arc:e}");
        assert!(mean.bound < 1e-9);
        assert_consistent(&union);
    }
    // From inside: the smaller ball is hidden, or has a point of its own.
    for (x, parts) in [(1f64.next_down(), 0), (1.0, 1), (1f64.next_up(), 1)] {
        let shape = shape(&[[0.0; 3], [x, 0.0, 0.0]], &[4.0, 1.0]);
        let union = BallUnion::new(&shape).unwrap();
        assert_is(union.volume(), 32.0 / 3.0 * PI);
        assert_is(union.area(), 16.0 * PI);
        let seen = union.areas().bounds.iter().filter(|&&bound| bound > 0.0).count();
        assert_eq!(seen, 1 + parts);
        assert_consistent(&union);
    }
}

#[test]
fn hidden_balls_and_duplicates_have_no_part() {
    let centers = [[0.0; 3], [0.0; 3], [0.5, 0.0, 0.0], [9.0, 0.0, 0.0], [9.0, 0.0, 0.0]];
    let shape = shape(&centers, &[4.0, 1.0, 0.25, 0.0, -1.0]);
    let union = BallUnion::new(&shape).unwrap();
    assert_is(union.volume(), 32.0 / 3.0 * PI);
    assert_is(union.volumes().get(0), 32.0 / 3.0 * PI);
    assert_eq!(union.volumes().values[1..], [0.0; 4]);
    assert_eq!(union.areas().values[1..], [0.0; 4]);
    assert_eq!([1, 2, 4].map(|v| union.areas().bounds[v]), [0.0; 3]);
    // A ball of radius 0 is a point of the union.
    assert_eq!(union.euler_characteristic(), 2);
    assert_eq!(union.components().len(), 2);
    assert_same(union.components()[0].volume, union.volume());
}

#[test]
fn nothing_is_the_union_of_no_balls() {
    let shape = shape(&[[0.0; 3], [1.0, 0.0, 0.0]], &[-1.0; 2]);
    let union = BallUnion::new(&shape).unwrap();
    assert_eq!((union.volume().value, union.volume().bound), (0.0, 0.0));
    assert_eq!((union.area().value, union.euler_characteristic()), (0.0, 0));
    assert!(union.contacts().pairs.is_empty() && union.components().is_empty());
}

/// n balls of radius 1 along a line, a distance of 1 apart, at an angle.
#[test]
fn chains_have_a_lens_for_each_link() {
    let n = 200;
    let centers: Vec<[f64; 3]> =
        (0..n).map(|i| [0.0, f64::from(i) * 0.6, f64::from(i) * 0.8]).collect();
    let shape = shape(&centers, &vec![1.0; n as usize]);
    let union = BallUnion::new(&shape).unwrap();
    let n = f64::from(n);
    let lens = 2.0 * PI * 0.25 * 2.5 / 3.0;
    assert!(union.volume().is_within(1e-13));
    let volume = n * 4.0 / 3.0 * PI - (n - 1.0) * lens;
    // 0.6 and 0.8 are rounded.
    assert!((union.volume().value - volume).abs() < 1e-12 * volume);
    assert!((union.area().value - (n * 4.0 * PI - (n - 1.0) * 2.0 * PI)).abs() < 1e-9);
    assert_consistent(&union);
}

/// The positions of a lattice of n³ cubes of side 1, with the given places in each.
fn lattice(n: usize, places: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let cell = |i: usize| [i % n, i / n % n, i / n / n].map(|x| x as f64);
    let at = |i: usize| places.iter().map(move |p| [0, 1, 2].map(|k| cell(i)[k] + p[k]));
    (0..n * n * n).flat_map(at).collect()
}

const CUBIC: &[[f64; 3]] = &[[0.0; 3]];
const FCC: &[[f64; 3]] = &[[0.0; 3], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]];

/// Where no three balls meet, each has a cap less for each neighbour. Balls that touch their neighbours, and those that three meet of in a
/// point, are among them.
#[test]
fn lattices_in_a_box_have_caps_only() {
    let torus = Torus::new([4.0; 3]).unwrap();
    // The squared radius is exactly 1/2 or 1/8 where three cubic balls meet or two of FCC touch.
    let sets = [
        (CUBIC, 6.0, 0.5, vec![0.2, 0.25, 0.3, 0.49, 0.5]),
        (FCC, 12.0, 0.5f64.sqrt() / 2.0, vec![0.1, 0.125, 0.15, 0.16]),
    ];
    for (places, neighbours, half, squares) in sets {
        for squared in squares {
            let centers = lattice(4, places);
            let shape = shape_on(Some(torus), &centers, &vec![squared; centers.len()]);
            let union = BallUnion::new(&shape).unwrap();
            let r = f64::sqrt(squared);
            let h = (r - half).max(0.0);
            let ball = 4.0 / 3.0 * PI * r.powi(3) - neighbours * PI * h * h * (3.0 * r - h) / 3.0;
            let area = 4.0 * PI * squared - neighbours * 2.0 * PI * r * h;
            let n = centers.len() as f64;
            assert_is(union.volume().per(n), ball);
            assert_is(union.area().per(n), area);
            assert_is(union.box_fraction().unwrap(), ball * places.len() as f64);
            (0..centers.len()).for_each(|v| assert_is(union.volumes().get(v), ball));
            (0..centers.len()).for_each(|v| assert_is(union.areas().get(v), area));
            assert_consistent(&union);
        }
    }
}

/// Once the balls fill the box, all is interior, and each has the volume of its power cell.
#[test]
fn balls_that_fill_a_box_have_its_volume() {
    let torus = Torus::new([4.0; 3]).unwrap();
    for places in [CUBIC, FCC] {
        let centers = lattice(4, places);
        let shape = shape_on(Some(torus), &centers, &vec![0.75; centers.len()]);
        let union = BallUnion::new(&shape).unwrap();
        assert_is(union.volume(), 64.0);
        assert_is(union.box_fraction().unwrap(), 1.0);
        assert_eq!((union.area().value, union.area().bound), (0.0, 0.0));
        let part = 1.0 / places.len() as f64;
        (0..centers.len()).for_each(|v| assert_is(union.volumes().get(v), part));
        // Faces of the cubes, of area 1, or of the rhombic dodecahedra: √2 / 8.
        let total: f64 = union.contacts().sizes.values.iter().sum();
        let face = if places == CUBIC { 3.0 } else { 6.0 * 2f64.sqrt() / 8.0 };
        assert!((total - face * centers.len() as f64).abs() < 1e-11, "{total}");
        assert_consistent(&union);
    }
}

/// In space, with all ties of a lattice: eight balls on a sphere, at the α where they just fill their cube.
#[test]
fn a_cube_of_balls_is_filled_at_its_tie() {
    for (squared, chi) in [(0.75, 1), (0.75f64.next_down(), 1), (0.74, 2 - 1)] {
        let centers = lattice(2, CUBIC);
        let shape = shape(&centers, &[squared; 8]);
        let union = BallUnion::new(&shape).unwrap();
        let voids = union.voids().unwrap();
        let closed = squared == 0.75;
        assert_eq!(voids.is_empty(), closed);
        assert_eq!(union.euler_characteristic(), chi + i64::from(!closed));
        // By symmetry an eighth each.
        let volume = union.volume();
        for v in 0..8 {
            let part = union.volumes().get(v);
            assert!((part.value * 8.0 - volume.value).abs() <= 8.0 * part.bound + volume.bound);
            assert!(part.bound < 1e-11);
        }
        assert!(volume.bound < 1e-11);
        assert_consistent(&union);
    }
}
