//! Voids and pockets.

use std::f64::consts::PI;

use walpha_balls::{BallUnion, Bounded, Cavity};
use walpha_base::random::Random;
use walpha_shape::{Alpha, Torus};

use crate::{assert_consistent, assert_is, assert_same, shape, shape_on};

fn total(cavities: &[Cavity]) -> [Bounded; 2] {
    let zero = Bounded { value: 0.0, bound: 1e-13 };
    let add =
        |a: Bounded, b: Bounded| Bounded { value: a.value + b.value, bound: a.bound + b.bound };
    cavities.iter().fold([zero; 2], |[volume, area], cavity| {
        [add(volume, cavity.volume), add(area, cavity.area)]
    })
}

/// Between eight balls of a cubic lattice whose squares are closed, and whose cubes are not.
#[test]
fn cubes_of_a_lattice_hold_voids() {
    let torus = Torus::new([4.0; 3]).unwrap();
    let centers: Vec<[f64; 3]> =
        (0..64).map(|i| [i % 4, i / 4 % 4, i / 16].map(f64::from)).collect();
    for squared in [0.5, 0.55, 0.7, 0.75f64.next_down()] {
        let shape = shape_on(Some(torus), &centers, &[squared; 64]);
        let union = BallUnion::new(&shape).unwrap();
        let voids = union.voids().unwrap();
        assert_eq!(voids.len(), 64);
        for void in &voids {
            let [first, this] = [&voids[0], void];
            assert_same(first.volume, this.volume);
            assert_same(first.area, this.area);
            assert_eq!((this.lining.len(), this.filling_alpha.squared()), (8, 0.75 - squared));
        }
        let [volume, area] = total(&voids);
        assert_is(Bounded { value: volume.value + union.volume().value, ..volume }, 64.0);
        assert_same(area, union.area());
        if squared == 0.5 {
            let (r, h) = (0.5f64.sqrt(), 0.5f64.sqrt() - 0.5);
            let ball = 4.0 / 3.0 * PI * r.powi(3) - 6.0 * PI * h * h * (3.0 * r - h) / 3.0;
            assert_is(voids[0].volume, 1.0 - ball);
            assert_is(voids[0].area, 2.0 * PI - 12.0 * PI * r * h);
        }
        assert_consistent(&union);
    }
}

/// In a periodic box that balls nearly fill, what they leave is voids.
#[test]
fn voids_are_what_balls_leave_of_a_box() {
    for seed in 0..4 {
        let mut random = Random::new(seed);
        let torus = Torus::new([6.0; 3]).unwrap();
        let centers: Vec<[f64; 3]> =
            (0..300).map(|_| [0; 3].map(|_| (random.unit() * 6144.0).floor() / 1024.0)).collect();
        let squares: Vec<f64> = (0..300).map(|_| (0.85 + 0.15 * random.unit()).powi(2)).collect();
        let shape = shape_on(Some(torus), &centers, &squares);
        let union = BallUnion::new(&shape).unwrap();
        let voids = union.voids().unwrap();
        assert!(voids.len() > 3, "{}", voids.len());
        let [volume, area] = total(&voids);
        let left = 216.0 - union.volume().value;
        assert!(
            (volume.value - left).abs() <= volume.bound + union.volume().bound + 1e-12,
            "{volume:?} {left}"
        );
        assert!(volume.bound < 1e-10);
        assert_same(area, union.area());
        assert!(voids.iter().all(|void| void.volume.value > 0.0 && void.area.value > 0.0));
    }
}

/// The outer points of a lattice of 7³, five layers deep inside, without the point in the middle of one side.
fn flask() -> Vec<[f64; 3]> {
    let at = |i: i32| [i % 7, i / 7 % 7, i / 49];
    let is_wall = |p: &[i32; 3]| p.iter().any(|&x| x == 0 || x == 6) && *p != [3, 3, 6];
    (0..343).map(at).filter(is_wall).map(|p| p.map(f64::from)).collect()
}

#[test]
fn a_flask_is_a_pocket_until_its_mouth_closes() {
    let centers = flask();
    let at = |alpha: f64| shape(&centers, &vec![alpha; centers.len()]);
    let shape_below = at(0.6);
    let union = BallUnion::new(&shape_below).unwrap();
    assert!(union.voids().unwrap().is_empty());
    let pockets = union.pockets().unwrap();
    let large: Vec<_> = pockets.iter().filter(|pocket| pocket.cavity.cells > 20).collect();
    let [pocket] = large[..] else { panic!("{} pockets", large.len()) };
    assert_eq!(pocket.mouths.len(), 1);
    // Its mouth is the square of the four points around the gap, with a circle of radius 1.
    let closing = 0.6 + pocket.closing_alpha.unwrap().squared();
    assert!((closing - 1.0).abs() < 1e-15, "{closing}");
    // Of the 6³ cubes inside, what walls of balls of radius 0.77 leave.
    assert!((95.0..110.0).contains(&pocket.cavity.volume.value), "{:?}", pocket.cavity.volume);
    assert!(pocket.cavity.volume.bound < 1e-9);
    // Once it is closed it is a void, and a pocket without a mouth.
    let closed = at(1.0);
    let union = BallUnion::new(&closed).unwrap();
    let (voids, pockets) = (union.voids().unwrap(), union.pockets().unwrap());
    assert_eq!((voids.len(), pockets.len()), (1, 1));
    assert_eq!((&pockets[0].cavity, pockets[0].closing_alpha), (&voids[0], None));
    assert!(pockets[0].mouths.is_empty());
    let before = at(1f64.next_down());
    assert!(BallUnion::new(&before).unwrap().voids().unwrap().is_empty());
    // The sphere at (3, 3, 3 + 1/6) touches four sides and the circle of the gap: its squared radius is 9 + 1/36.
    let filling = voids[0].filling_alpha.squared();
    assert!((filling - (8.0 + 1.0 / 36.0)).abs() < 1e-14, "{filling}");
}

/// Voids are among the pockets, and at the α at which its mouths close a pocket contains a void.
#[test]
fn pockets_of_random_sets_close() {
    let (centers, squares) = crate::random_sets::balls(31, 400, 1.0);
    let shape_here = shape(&centers, &squares);
    let union = BallUnion::new(&shape_here).unwrap();
    let (voids, pockets) = (union.voids().unwrap(), union.pockets().unwrap());
    let mut closed: Vec<_> =
        pockets.iter().filter(|p| p.mouths.is_empty()).map(|p| &p.cavity).collect();
    assert_eq!(closed.len(), voids.len());
    closed.retain(|cavity| !voids.contains(cavity));
    assert!(closed.is_empty());
    assert!(pockets.len() > voids.len() + 10);
    for pocket in pockets.iter().filter(|pocket| !pocket.mouths.is_empty()) {
        let alpha = pocket.closing_alpha.unwrap();
        assert!(alpha > Alpha::ZERO && alpha <= pocket.cavity.filling_alpha);
        assert!(pocket.cavity.volume.value > -pocket.cavity.volume.bound);
    }
}
