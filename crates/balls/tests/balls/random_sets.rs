//! Random sets, held to slices, to sampling, to other α, and to copies of themselves.

use walpha_balls::{BallUnion, DiscUnion};
use walpha_base::random::Random;

use crate::{assert_consistent, assert_same, shape};

/// Balls in a cube whose side keeps about so many of them together.
pub(crate) fn balls(seed: u64, n: usize, spread: f64) -> (Vec<[f64; 3]>, Vec<f64>) {
    let mut random = Random::new(seed);
    let side = (n as f64).cbrt() * spread;
    let centers = (0..n).map(|_| [0; 3].map(|_| random.unit() * side)).collect();
    let squares = (0..n).map(|_| (0.5 + 0.7 * random.unit()).powi(2)).collect();
    (centers, squares)
}

#[test]
fn volumes_are_those_of_the_slices() {
    for seed in 0..6 {
        let (centers, squares) = balls(seed, 2 + 3 * seed as usize, 0.9);
        let shape = shape(&centers, &squares);
        let union = BallUnion::new(&shape).unwrap();
        let slices = 4000;
        let top = centers.iter().map(|c| c[2]).fold(0.0, f64::max) + 1.2;
        let (low, step) = (-1.2, (top + 1.2) / f64::from(slices));
        let slice = |i: i32| {
            let z = low + (f64::from(i) + 0.5) * step;
            let place = |c: &[f64; 3]| [c[0], c[1], 0.0];
            let left = |(c, s): (&[f64; 3], &f64)| s - (c[2] - z).powi(2);
            let places: Vec<_> = centers.iter().map(place).collect();
            let squares: Vec<_> = centers.iter().zip(&squares).map(left).collect();
            DiscUnion::new(&crate::shape(&places, &squares)).unwrap().area().value
        };
        let volume: f64 = (0..slices).map(slice).sum::<f64>() * step;
        let found = union.volume().value;
        assert!((found - volume).abs() < 2e-6 * volume, "seed {seed}: {found} {volume}");
    }
}

/// Dense sets, with many balls that are covered; sparse ones, with voids and tunnels.
#[test]
fn parts_are_those_of_samples() {
    for (seed, spread) in [(1, 0.8), (2, 1.1), (3, 1.4)] {
        let n = 60;
        let (centers, squares) = balls(seed, n, spread);
        let shape = shape(&centers, &squares);
        let union = BallUnion::new(&shape).unwrap();
        assert_consistent(&union);
        let mut random = Random::new(seed);
        let side = (n as f64).cbrt() * spread + 2.4;
        let samples = 400_000;
        let mut inside = vec![0.0; n];
        for _ in 0..samples {
            let x = [0; 3].map(|_| random.unit() * side - 1.2);
            let power =
                |v: usize| (0..3).map(|k| (x[k] - centers[v][k]).powi(2)).sum::<f64>() - squares[v];
            let least = (0..n).map(|v| (power(v), v)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
            if least.0 <= 0.0 {
                inside[least.1] += 1.0;
            }
        }
        let each = side.powi(3) / f64::from(samples);
        for (v, inside) in inside.into_iter().enumerate() {
            let (found, sampled) = (union.volumes().get(v).value, inside * each);
            // Five standard deviations.
            let deviation = each * (inside + 10.0f64).sqrt();
            assert!((found - sampled).abs() < 5.0 * deviation, "{v}: {found} {sampled}");
        }
        // Sample points of each sphere: a spiral.
        let on_sphere = 4000;
        for v in 0..n {
            let point = |i: i32| {
                let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(on_sphere);
                let (r, turn) = ((1.0 - z * z).sqrt(), 2.399963229728653 * f64::from(i));
                let r = [r * turn.cos(), r * turn.sin(), z].map(|x| x * squares[v].sqrt());
                [0, 1, 2].map(|k| centers[v][k] + r[k])
            };
            let is_open = |x: &[f64; 3]| {
                (0..n).all(|u| {
                    u == v
                        || (0..3).map(|k| (x[k] - centers[u][k]).powi(2)).sum::<f64>() > squares[u]
                })
            };
            let open = (0..on_sphere).map(point).filter(is_open).count() as f64;
            let sphere = 4.0 * std::f64::consts::PI * squares[v];
            let (found, sampled) =
                (union.areas().get(v).value, open / f64::from(on_sphere) * sphere);
            assert!((found - sampled).abs() < 0.02 * sphere, "{v}: {found} {sampled}");
        }
    }
}

/// The area is the derivative of the volume by a growth of all radii.
#[test]
fn areas_are_how_volumes_grow() {
    for seed in 10..16 {
        let (centers, squares) = balls(seed, 40, 1.0);
        let volume = |more: f64| {
            let grown: Vec<f64> = squares.iter().map(|s| (s.sqrt() + more).powi(2)).collect();
            BallUnion::new(&shape(&centers, &grown)).unwrap().volume().value
        };
        let h = 1e-4;
        let growth = (volume(h) - volume(-h)) / (2.0 * h);
        let area = BallUnion::new(&shape(&centers, &squares)).unwrap().area().value;
        // The volume has a continuous second derivative except at isolated radii.
        assert!((growth - area).abs() < 1e-5 * area, "{growth} {area}");
    }
}

#[test]
fn copies_have_the_same_measures() {
    let (centers, squares) = balls(7, 300, 0.9);
    let shape_here = shape(&centers, &squares);
    let here = BallUnion::new(&shape_here).unwrap();
    // Exchanged axes, another order of the balls, and a shift and a scale that round coordinates: less than 10⁻¹³ of the area.
    let moved: Vec<[f64; 3]> =
        centers.iter().rev().map(|&[x, y, z]| [z + 1000.0, x - 3.0, y]).collect();
    let reversed: Vec<f64> = squares.iter().rev().copied().collect();
    let shape_there = shape(&moved, &reversed);
    let there = BallUnion::new(&shape_there).unwrap();
    for (a, b) in [(here.volume(), there.volume()), (here.area(), there.area())] {
        assert!((a.value - b.value).abs() <= a.bound + b.bound + 1e-10, "{a:?} {b:?}");
    }
    for v in 0..300 {
        let (a, b) = (here.volumes().get(v), there.volumes().get(299 - v));
        assert!((a.value - b.value).abs() <= a.bound + b.bound + 1e-10, "{a:?} {b:?}");
    }
    // A power of two changes the unit alone.
    for scale in [2f64.powi(90), 2f64.powi(-90)] {
        let scaled: Vec<_> = centers.iter().map(|c| c.map(|x| x * scale)).collect();
        let squares: Vec<_> = squares.iter().map(|s| s * scale * scale).collect();
        let shape = shape(&scaled, &squares);
        let union = BallUnion::new(&shape).unwrap();
        let (a, b) = (union.volume(), here.volume());
        let unit = scale.powi(3);
        assert!(
            (a.value / unit - b.value).abs() <= 1e-12 * b.value && a.bound / unit < 2.0 * b.bound
        );
    }
}

#[test]
fn results_do_not_depend_on_threads() {
    let (centers, squares) = balls(8, 3000, 0.9);
    let shape = shape(&centers, &squares);
    let weights: Vec<f64> = (0..3000).map(|i| f64::from(i % 7)).collect();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let union = BallUnion::new(&shape).unwrap();
            let gradients = union.gradients(Some(&weights)).unwrap();
            let totals =
                [union.volume(), union.area(), union.mean_curvature(), union.gaussian_curvature()];
            let columns =
                (union.volumes().clone(), union.areas().clone(), union.contacts().sizes.clone());
            (totals, columns, gradients, union.voids().unwrap(), union.pockets().unwrap())
        })
    };
    let one = run(1);
    assert!(!one.3.is_empty(), "the set has a void");
    assert!(one == run(2) && one == run(5));
}

/// One large ball and small ones on it, and balls a millionth of it.
#[test]
fn radii_of_all_sizes_are_measured() {
    let mut random = Random::new(5);
    let (mut centers, mut squares) = (vec![[0.0; 3]], vec![1e12]);
    for _ in 0..200 {
        let way = [0; 3].map(|_| random.unit() - 0.5);
        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
        let far = 1e6 + (random.unit() - 0.5) * 1e-6;
        centers.push(way.map(|x| x / length * far));
        squares.push((1e-6 * (1.0 + random.unit())).powi(2));
    }
    let shape = shape(&centers, &squares);
    let union = BallUnion::new(&shape).unwrap();
    assert!(union.volume().is_within(1e-13) && union.area().is_within(1e-13));
    assert_consistent(&union);
    // A ball on the large one has less than its own area and volume, and more than nothing, for certain.
    let seen: Vec<_> = (1..201).filter(|&v| union.areas().get(v).value > 0.0).collect();
    assert!(seen.len() > 100);
    for v in seen {
        let (area, volume) = (union.areas().get(v), union.volumes().get(v));
        assert!(area.value < 4.0 * std::f64::consts::PI * squares[v] + area.bound, "{area:?}");
        assert!(
            area.bound < 1e-7 * squares[v] && volume.bound < 1e-6 * squares[v].powf(1.5),
            "{area:?} {volume:?}"
        );
    }
}

/// Small balls on one that is ten billion times larger, in one cell with it: whatever is computed from its centre has lost most digits.
#[test]
fn cells_of_unequal_balls_are_measured_from_the_smallest() {
    let far = 118727.5644;
    let spots = [
        [1.3340818094650596e-05, 1.4560433449960817e-06, far + 2.7639e-5],
        [-2.386999944447273e-07, 6.528247552160568e-06, far + 3.48251e-5],
        [-8.613440783743593e-06, 1.5401272648043557e-05, far + 3.843662e-5],
        [-6.026915224023847e-06, 1.003997133104311e-05, far + 3.166937e-5],
    ];
    let centers: Vec<_> = [[0.0; 3]].into_iter().chain(spots).collect();
    let squares = [14096234556.608887, 7.276e-11, 1.1356e-10, 8.371e-11, 8.0098e-11];
    let shape = shape(&centers, &squares);
    assert_eq!(shape.complex().cells.counts().interior, 1);
    let union = BallUnion::new(&shape).unwrap();
    assert!(union.volume().is_within(1e-13) && union.area().is_within(1e-13), "{:?}", union.area());
    assert_consistent(&union);
}

/// Coordinates that differ from those of a lattice by one unit in the last place: slivers, and circles of radius 10⁻⁸.
#[test]
fn neighbours_of_lattices_keep_their_bounds() {
    let mut random = Random::new(11);
    let n = 5;
    let exact: Vec<[f64; 3]> =
        (0..n * n * n).map(|i| [i % n, i / n % n, i / n / n].map(f64::from)).collect();
    let centers: Vec<[f64; 3]> =
        exact.iter().map(|p| p.map(|x| [x.next_down(), x, x.next_up()][random.below(3)])).collect();
    for squared in [0.25, 0.5, 0.75, 1.0] {
        let squares = vec![squared; centers.len()];
        let (near, at) = (shape(&centers, &squares), shape(&exact, &squares));
        let (near, at) = (BallUnion::new(&near).unwrap(), BallUnion::new(&at).unwrap());
        assert!(near.volume().is_within(1e-9) && near.area().is_within(1e-9), "{squared}");
        let (a, b) = (near.volume(), at.volume());
        assert!((a.value - b.value).abs() <= a.bound + b.bound + 1e-12, "{squared}: {a:?} {b:?}");
        let (a, b) = (near.area(), at.area());
        assert!((a.value - b.value).abs() <= a.bound + b.bound + 1e-11, "{squared}: {a:?} {b:?}");
        assert_consistent(&near);
    }
    assert_same(at_tie(&exact), at_tie(&exact.iter().rev().copied().collect::<Vec<_>>()));
}

fn at_tie(centers: &[[f64; 3]]) -> walpha_balls::Bounded {
    BallUnion::new(&shape(centers, &vec![0.75; centers.len()])).unwrap().volume()
}
