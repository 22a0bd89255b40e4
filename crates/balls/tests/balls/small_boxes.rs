//! Boxes so small that balls meet copies of themselves.

use walpha_balls::{BallUnion, BallsError, Bounded, union_curve};
use walpha_base::random::Random;
use walpha_shape::ladder::Filtration;
use walpha_shape::{Alpha, AlphaShape, ShapeOptions, Torus, WeightedPoints, alpha_shape};

type Vectors = [[f64; 3]; 3];

const FCC: Vectors = [[0.0, 2.0, 2.0], [2.0, 0.0, 2.0], [2.0, 2.0, 0.0]];
const SLANTED: Vectors = [[4.0, 0.0, 0.0], [1.5, 3.5, 0.0], [-1.0, 0.5, 5.0]];

/// Points with coordinates of few bits, so that copies are exact.
fn points(seed: u64, count: usize) -> WeightedPoints {
    let mut random = Random::new(seed);
    let mut number = || random.below(256) as f64 / 64.0;
    let positions = (0..count).map(|_| [number(), number(), number()]).collect();
    let weights = (0..count).map(|_| number() / 8.0).collect();
    WeightedPoints::new(positions, weights).unwrap()
}

fn shape(vectors: Vectors, points: WeightedPoints, alpha: f64) -> AlphaShape {
    let options = ShapeOptions::new(Alpha::from_squared(alpha).unwrap())
        .periodic(Some(Torus::of_vectors(vectors).unwrap()));
    alpha_shape(points, &options).unwrap()
}

/// Three copies along each vector, and the box that holds them.
fn repeated(vectors: Vectors, points: &WeightedPoints) -> (Vectors, WeightedPoints) {
    let moved = |by: [f64; 3]| {
        let shift = [0, 1, 2].map(|axis| (0..3).map(|k| by[k] * vectors[k][axis]).sum::<f64>());
        points.positions().iter().map(move |p| [0, 1, 2].map(|axis| p[axis] + shift[axis]))
    };
    let copies = (0..27).map(|i| [i % 3, i / 3 % 3, i / 9].map(f64::from));
    let positions = copies.flat_map(moved).collect();
    let points = WeightedPoints::new(positions, points.weights().repeat(27)).unwrap();
    (vectors.map(|v| v.map(|x| 3.0 * x)), points)
}

/// Whether two numbers agree within their bounds, which are small.
fn agree(one: Bounded, other: Bounded) -> bool {
    let near = (one.value - other.value).abs() <= one.bound + other.bound;
    near && one.bound + other.bound < 1e-9 * (1.0 + one.value.abs())
}

/// The union in a small box is a 27th of that in 27 copies of it, and so are its parts and derivatives those of the copies.
#[test]
fn balls_that_meet_themselves_are_measured() {
    let mut self_contacts = 0;
    for (seed, vectors, count) in [(1, FCC, 1), (2, FCC, 2), (3, SLANTED, 1), (4, SLANTED, 3)] {
        for alpha in [0.5, 1.5, 3.0, 4.5, 9.0] {
            let points = points(seed, count);
            let (large, copies) = repeated(vectors, &points);
            let (small, large) = (shape(vectors, points, alpha), shape(large, copies, alpha));
            let (one, all) = (BallUnion::new(&small).unwrap(), BallUnion::new(&large).unwrap());
            let part = |total: Bounded| Bounded { value: total.value / 27.0, bound: total.bound };
            assert!(agree(one.volume(), part(all.volume())), "{seed} {alpha}");
            assert!(agree(one.area(), part(all.area())));
            assert!(agree(one.mean_curvature(), part(all.mean_curvature())));
            assert_eq!(27 * one.euler_characteristic(), all.euler_characteristic());
            assert!(agree(one.box_fraction().unwrap(), all.box_fraction().unwrap()));
            assert_eq!(one.volumes().len(), count);
            let (own, of_all) = (one.gradients(None).unwrap(), all.gradients(None).unwrap());
            for v in 0..count {
                assert!(agree(one.volumes().get(v), all.volumes().get(v)));
                assert!(agree(one.areas().get(v), all.areas().get(v)));
                let (a, b) = (own.volume.by_radii.get(v), of_all.volume.by_radii.get(v));
                assert!((a.value - b.value).abs() <= a.bound + b.bound);
            }
            let contacts = one.contacts();
            assert_eq!(27 * contacts.pairs.len(), all.contacts().pairs.len());
            assert!(agree(
                contacts.sizes.sum(0..contacts.pairs.len()),
                part(all.contacts().sizes.sum(0..all.contacts().pairs.len()))
            ));
            self_contacts += contacts.pairs.iter().filter(|[a, b]| a == b).count();
            let of_components: usize = one.components().iter().map(|part| part.balls).sum();
            assert_eq!(of_components, small.points_in_shape());
        }
    }
    assert!(self_contacts > 20, "{self_contacts}");
}

/// The curve of a small box is that of its unions.
#[test]
fn curves_of_small_boxes_are_those_of_their_unions() {
    for (seed, vectors, count) in [(5, FCC, 1), (6, SLANTED, 2)] {
        let torus = Torus::of_vectors(vectors).unwrap();
        let filtration = Filtration::on(Some(torus), points(seed, count)).unwrap();
        let alphas = [0.25, 1.0, 2.0, 4.0, 6.0].map(|a| Alpha::from_squared(a).unwrap());
        for level in union_curve(&filtration, &alphas).unwrap() {
            let shape = shape(vectors, points(seed, count), level.alpha.squared());
            let union = BallUnion::new(&shape).unwrap();
            assert!(agree(level.volume, union.volume()), "{level:?} {:?}", union.volume());
            assert!(agree(level.area, union.area()));
            assert_eq!(level.euler_characteristic, union.euler_characteristic());
        }
    }
}

#[test]
fn voids_of_small_boxes_are_refused() {
    let shape = shape(FCC, points(1, 1), 3.0);
    let union = BallUnion::new(&shape).unwrap();
    assert_eq!(union.voids().unwrap_err(), BallsError::SmallBox { what: "voids" });
}

/// Balls that repeat along one or two vectors are those of a box that repeats along all, with a gap between the layers or rods.
#[test]
fn slabs_and_rods_are_boxes_with_a_gap() {
    const FAR: f64 = 6.0;
    let mut meet_themselves = 0;
    for (seed, vectors, repeats) in [
        (1, SLANTED, [true, true, false]),
        (2, FCC, [true, false, true]),
        (3, SLANTED, [false, true, false]),
        (4, SLANTED, [true, true, false]),
    ] {
        let count = 1 + seed as usize % 3;
        // The other vectors are so long that copies along them are apart.
        let long = [0, 1, 2].map(|k| vectors[k].map(|x| if repeats[k] { x } else { FAR * x }));
        let part = Torus::repeating(vectors, repeats).unwrap();
        let whole = Torus::of_vectors(long).unwrap();
        for alpha in [0.5, 2.0, 4.5] {
            let of = |torus| {
                let options = ShapeOptions::new(Alpha::from_squared(alpha).unwrap());
                alpha_shape(points(seed, count), &options.periodic(Some(torus))).unwrap()
            };
            let (part, whole) = (of(part), of(whole));
            let (one, other) = (BallUnion::new(&part).unwrap(), BallUnion::new(&whole).unwrap());
            assert!(agree(one.volume(), other.volume()), "{seed} {alpha}");
            assert!(agree(one.area(), other.area()));
            assert!(agree(one.mean_curvature(), other.mean_curvature()));
            assert_eq!(one.euler_characteristic(), other.euler_characteristic());
            assert_eq!(one.box_fraction(), None);
            for v in 0..count {
                assert!(agree(one.volumes().get(v), other.volumes().get(v)));
                assert!(agree(one.areas().get(v), other.areas().get(v)));
            }
            meet_themselves += one.contacts().pairs.iter().filter(|[a, b]| a == b).count();
        }
    }
    assert!(meet_themselves > 5, "{meet_themselves}");
}
