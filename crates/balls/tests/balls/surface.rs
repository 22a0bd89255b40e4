//! The boundary as triangles.

use std::collections::HashSet;

use walpha_balls::{BallSurface, BallUnion, BallsError};
use walpha_base::random::Random;
use walpha_base::vector::{cross, dot, length, sub};
use walpha_shape::{Alpha, ShapeOptions, Torus, WeightedPoints, alpha_shape};

use crate::random_sets::balls;
use crate::shape;

/// Six times the volume that a mesh encloses, and twice the area of the triangles of each ball.
fn measures(surface: &BallSurface, balls: usize) -> (f64, Vec<f64>) {
    let (mut volume, mut areas) = (0.0, vec![0.0; balls]);
    for (triangle, &ball) in surface.triangles.iter().zip(&surface.balls) {
        let [a, b, c] = triangle.map(|v| surface.positions[v as usize]);
        volume += dot(a, cross(b, c));
        areas[ball as usize] += length(cross(sub(b, a), sub(c, a)));
    }
    (volume / 6.0, areas.into_iter().map(|area| area / 2.0).collect())
}

/// Asserts that each edge belongs to two triangles, once in each direction.
#[track_caller]
fn assert_closed(surface: &BallSurface) {
    let edges = surface.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut directed = HashSet::new();
    edges.for_each(|edge| assert!(directed.insert(edge), "{edge:?} twice"));
    for &[a, b] in &directed {
        assert!(directed.contains(&[b, a]), "{a} to {b} has a triangle on one side only");
    }
}

/// Asserts that a surface is closed, within its tolerance of the spheres, and near the volume and the areas of the balls.
#[track_caller]
fn assert_surface(centers: &[[f64; 3]], squares: &[f64], tolerance: f64) -> BallSurface {
    let shape = shape(centers, squares);
    let union = BallUnion::new(&shape).unwrap();
    let surface = union.surface(tolerance);
    let surface = surface.unwrap_or_else(|error| panic!("{error}, at {tolerance}"));
    assert_closed(&surface);
    let used: HashSet<u32> = surface.triangles.as_flattened().iter().copied().collect();
    assert_eq!(used.len(), surface.positions.len());
    for (triangle, &ball) in surface.triangles.iter().zip(&surface.balls) {
        let (centre, radius) = (centers[ball as usize], squares[ball as usize].sqrt());
        let corners = triangle.map(|v| sub(surface.positions[v as usize], centre));
        for corner in corners {
            assert!((length(corner) / radius - 1.0).abs() < 1e-6, "{corner:?} is off {radius}");
        }
        let [a, b, c] = corners;
        let normal = cross(sub(b, a), sub(c, a));
        // Of a triangle with an obtuse angle, the foot of the centre is outside, and its longest edge is farthest.
        let middles =
            [[a, b], [b, c], [c, a]].map(|[p, q]| length([0, 1, 2].map(|k| p[k] + q[k])) / 2.0);
        let nearest = middles.into_iter().fold(f64::INFINITY, f64::min);
        let height = dot(normal, a) / length(normal);
        let acute = dot(sub(b, a), sub(c, a)) > 0.0
            && dot(sub(a, b), sub(c, b)) > 0.0
            && dot(sub(a, c), sub(b, c)) > 0.0;
        let nearest = if acute { height } else { nearest };
        assert!(
            nearest >= radius * (1.0 - 1.01 * tolerance),
            "{} of {ball}",
            1.0 - nearest / radius
        );
    }
    let (volume, areas) = measures(&surface, centers.len());
    let wanted = union.volume().value;
    assert!((volume - wanted).abs() <= 3.0 * tolerance * wanted, "{volume}, not {wanted}");
    for (ball, (area, wanted)) in areas.iter().zip(&union.areas().values).enumerate() {
        let whole = 4.0 * std::f64::consts::PI * squares[ball].max(0.0);
        assert!(
            (area - wanted).abs() <= 3.0 * tolerance * whole,
            "{area}, not {wanted}, of {ball}"
        );
    }
    surface
}

fn lattice(side: usize) -> Vec<[f64; 3]> {
    (0..side * side * side)
        .map(|i| [i % side, i / side % side, i / side / side].map(|c| c as f64))
        .collect()
}

#[test]
fn few_balls_have_closed_surfaces() {
    assert_surface(&[[1.0, 2.0, 3.0]], &[4.0], 0.01);
    assert_surface(&[[0.0; 3], [1.0, 0.0, 0.0]], &[1.0; 2], 0.01);
    // A small ball that looks out of a large one, and one that is nearly hidden.
    assert_surface(&[[0.0; 3], [1.0, 0.0, 0.0]], &[1.0, 0.04], 0.01);
    assert_surface(&[[0.0; 3], [0.801, 0.0, 0.0]], &[1.0, 0.04], 0.01);
    // Balls that touch, from outside and from inside, and one in another.
    assert_surface(&[[0.0; 3], [2.0, 0.0, 0.0]], &[1.0; 2], 0.01);
    assert_surface(&[[0.0; 3], [0.5, 0.0, 0.0]], &[1.0, 0.25], 0.01);
    assert_surface(&[[0.0; 3], [0.1, 0.0, 0.0]], &[1.0, 0.01], 0.01);
    // Three around an axis, whose spheres share two points; a ring of four.
    assert_surface(&[[0.0; 3], [1.0, 0.0, 0.0], [0.4, 0.9, 0.1]], &[1.0, 0.8, 0.9], 0.01);
    let ring = [[0.0; 3], [1.5, 0.0, 0.0], [1.5, 1.5, 0.0], [0.0, 1.5, 0.0]];
    assert_surface(&ring, &[0.7; 4], 0.01);
    // Neither a point nor a ball without radius has a surface.
    let alone = assert_surface(&[[0.0; 3], [5.0, 0.0, 0.0]], &[1.0, 0.0], 0.01);
    assert!(alone.balls.iter().all(|&ball| ball == 0));
}

/// Patches that are small parts of their spheres, with arcs of large circles, in triangles that are large for them.
#[test]
fn small_patches_have_closed_surfaces() {
    // An atom and its neighbours in a molecule.
    let atoms = [
        [-9.537, 2.605, -3.68, 1.32],
        [-11.437, 3.397, -1.536, 1.7],
        [-10.039, 5.028, -4.642, 1.85],
        [-9.96, 3.805, -5.443, 2.275],
        [-9.153, 2.727, -4.72, 2.275],
        [-9.253, 1.369, -5.448, 2.06],
        [-7.682, 3.178, -4.647, 2.06],
        [-11.33, 3.245, -5.825, 2.0],
        [-12.239, 3.167, -4.83, 1.85],
    ];
    let centers = atoms.map(|[x, y, z, _]| [x, y, z]);
    let squares = atoms.map(|[.., radius]| radius * radius);
    for tolerance in [0.5, 0.2, 0.1, 0.05, 0.02, 0.01] {
        assert_surface(&centers, &squares, tolerance);
    }
    for seed in 0..40 {
        let (centers, squares) = balls(100 + seed, 60, 0.45);
        for tolerance in [0.5, 0.1, 0.05] {
            assert_surface(&centers, &squares, tolerance);
        }
    }
}

#[test]
fn lattices_have_closed_surfaces() {
    let places = lattice(3);
    // From balls that touch to those of which four share a point, and eight; voids are between.
    for square in [0.25, 0.3, 0.4999, 0.5, 0.5001, 0.6, 0.74, 0.75, 0.76, 1.0, 1.3, 2.0] {
        assert_surface(&places, &[square; 27], 0.02);
    }
}

#[test]
fn random_sets_have_closed_surfaces_at_any_tolerance() {
    for (seed, count, spread, tolerance) in
        [(1, 5, 1.0, 0.3), (2, 40, 0.7, 0.1), (3, 150, 0.9, 0.02), (4, 300, 1.2, 0.01)]
    {
        let (centers, squares) = balls(seed, count, spread);
        assert_surface(&centers, &squares, tolerance);
    }
}

/// Halving the tolerance halves the errors of volume and area, which are those of chords.
#[test]
fn volume_and_area_converge() {
    let (centers, squares) = balls(7, 60, 1.0);
    let shape = shape(&centers, &squares);
    let union = BallUnion::new(&shape).unwrap();
    let errors = [0.04, 0.01, 0.0025].map(|tolerance| {
        let (volume, areas) = measures(&union.surface(tolerance).unwrap(), 60);
        let area: f64 = areas.iter().sum();
        [volume / union.volume().value - 1.0, area / union.area().value - 1.0].map(f64::abs)
    });
    for two in errors.windows(2) {
        for (coarse, fine) in two[0].iter().zip(&two[1]) {
            assert!((2.5..6.5).contains(&(coarse / fine)), "{errors:?}");
        }
    }
    assert!(errors[2].iter().all(|&error| error < 0.0025), "{errors:?}");
}

#[test]
fn sizes_from_tiny_to_huge_have_the_same_surface() {
    let centers = [[0.0; 3], [1.0, 0.5, 0.0], [0.25, 1.0, 0.75]];
    let squares = [1.0, 0.5, 0.75];
    let one = assert_surface(&centers, &squares, 0.05);
    let factor = 2f64.powi(-200);
    let scaled = centers.map(|place| place.map(|x| x * factor));
    let shape = shape(&scaled, &squares.map(|square| square * factor * factor));
    let small = BallUnion::new(&shape).unwrap().surface(0.05).unwrap();
    assert_eq!(small.triangles, one.triangles);
    let grown = small.positions.iter().map(|place| place.map(|x| x / factor));
    assert!(grown.eq(one.positions.iter().copied()));
}

#[test]
fn what_has_no_surface_is_refused() {
    let one = shape(&[[0.0; 3]], &[1.0]);
    let union = BallUnion::new(&one).unwrap();
    for tolerance in [0.0, -0.1, 0.6, f64::NAN, 1e-7] {
        let error = union.surface(tolerance).unwrap_err();
        assert!(matches!(error, BallsError::Tolerance { .. }), "{error}");
    }
    let options = ShapeOptions::new(Alpha::from_squared(1.0).unwrap());
    let options = options.periodic(Some(Torus::new([9.0; 3]).unwrap()));
    let torus = alpha_shape(WeightedPoints::unweighted(vec![[1.0; 3]]), &options).unwrap();
    let error = BallUnion::new(&torus).unwrap().surface(0.1).unwrap_err();
    assert_eq!(error, BallsError::Seam);
}

/// Balls that touch, share circles or points, hide each other, or do so but for the last digits: each surface is closed.
#[test]
fn hard_sets_have_closed_surfaces() {
    for seed in 0..300 {
        let mut random = Random::new(seed);
        let count = 2 + (14.0 * random.unit()) as usize;
        let (mut centers, mut squares) = (Vec::new(), Vec::new());
        for k in 0..count {
            let place = [0; 3].map(|_| random.unit());
            let cell = place.map(|x| (3.0 * x).floor());
            let mut among = |sizes: &[f64]| sizes[(sizes.len() as f64 * random.unit()) as usize];
            let (center, square): ([f64; 3], f64) = match seed % 6 {
                0 => (cell, among(&[0.25, 0.5, 0.75, 1.0, 1.25, 2.0])),
                1 => (cell.map(|x| 2.0 * x), among(&[1.0, 1.0 + 1e-13, 1.0 - 1e-12])),
                2 => ([cell[0] + 0.5 * (k % 2) as f64, 0.0, 0.0], among(&[0.25, 0.5, 1.0])),
                3 => (cell.map(|x| x + 1e-9 * place[0]), among(&[0.5, 0.75, 1.0])),
                4 => {
                    let way = place.map(|x| x - 0.5);
                    (way.map(|x| x / length(way)), 1.0)
                }
                _ => {
                    let size = among(&[1e-4, 1e-2, 1.0, 1e2, 1e4]);
                    (place.map(|x| size * x), size * size)
                }
            };
            centers.push(center);
            squares.push(square);
        }
        let shape = shape(&centers, &squares);
        let union = BallUnion::new(&shape).unwrap();
        let surface = union.surface(0.05).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        assert_closed(&surface);
        let (volume, _) = measures(&surface, count);
        let wanted = union.volume().value;
        assert!((volume - wanted).abs() < 0.15 * wanted, "seed {seed}: {volume}, not {wanted}");
    }
}
