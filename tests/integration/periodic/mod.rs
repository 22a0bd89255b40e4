//! Shapes of a torus: against copies in space, against homology by matrices, and by the laws that only a
//! torus has.

mod betti;
mod check;
#[cfg(feature = "cli")]
mod command;
mod copies;
mod levels;
mod oracle;

use walpha::shape::{Engine, ShapeError, ShapeOptions, Torus};
use walpha::{Alpha, AlphaShape, WeightedPoints, alpha_shape};
use walpha_base::random::Random;

fn alpha(squared: f64) -> Alpha {
    Alpha::from_squared(squared).unwrap()
}

fn options(sides: [f64; 3], squared: f64) -> ShapeOptions {
    let periodic = Some(Torus::new(sides).unwrap());
    let engine = Engine::Native;
    ShapeOptions::new(alpha(squared)).periodic(periodic).engine(engine)
}

fn shape(points: &WeightedPoints, sides: [f64; 3], squared: f64) -> Result<AlphaShape, ShapeError> {
    alpha_shape(points.clone(), &options(sides, squared))
}

fn unweighted(positions: Vec<[f64; 3]>) -> WeightedPoints {
    let weights = vec![0.0; positions.len()];
    WeightedPoints::new(positions, weights).unwrap()
}

/// A lattice in a box of so many cells, with these points in each cell.
fn crystal(cells: [i32; 3], basis: &[[f64; 3]]) -> WeightedPoints {
    let mut positions = Vec::new();
    for x in 0..cells[0] {
        for y in 0..cells[1] {
            for z in 0..cells[2] {
                let at = [x, y, z].map(f64::from);
                positions.extend(basis.iter().map(|b| [0, 1, 2].map(|k| at[k] + b[k])));
            }
        }
    }
    unweighted(positions)
}

const CUBIC: [[f64; 3]; 1] = [[0.0; 3]];
const BCC: [[f64; 3]; 2] = [[0.0; 3], [0.5; 3]];
const FCC: [[f64; 3]; 4] = [[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]];

/// Points of a box: of a lattice or anywhere, weighted or not, each place once.
fn sets(count: u64) -> impl Iterator<Item = (WeightedPoints, [f64; 3])> {
    (0..count).map(|seed| {
        let mut random = Random::new(1000 + seed);
        let sides = [0; 3].map(|_| [4.0, 5.0, 6.0, 8.0][random.below(4)]);
        let size = 1 + random.below([12, 60, 150][seed as usize % 3]);
        let mut points = unweighted(Vec::new());
        for _ in 0..size {
            let place = [0, 1, 2].map(|k: usize| match seed % 4 {
                0 | 1 => random.below(sides[k] as usize) as f64,
                2 => random.below(2 * sides[k] as usize) as f64 / 2.0,
                _ => (random.below(1 << 40) as f64) / (1u64 << 40) as f64 * sides[k],
            });
            let weight = match seed % 5 {
                0 | 1 => 0.0,
                2 => random.below(5) as f64 / 4.0 - 0.5,
                _ => random.unit() * 0.7,
            };
            if !points.positions.contains(&place) {
                points.positions.push(place);
                points.weights.push(weight);
            }
        }
        (points, sides)
    })
}

/// Points so dense that the whole triangulation has no long edge: on a lattice, on half of one, anywhere.
fn dense(seed: u64) -> (WeightedPoints, [f64; 3]) {
    let mut random = Random::new(seed);
    let sides = [4.0, 4.0, 5.0];
    let mut points = crystal([4, 4, 5], [&CUBIC[..], &BCC, &FCC][seed as usize % 3]);
    for (place, weight) in points.positions.iter_mut().zip(&mut points.weights) {
        match seed % 4 {
            0 => {}
            1 => *weight = random.below(3) as f64 / 8.0,
            2 => place.iter_mut().for_each(|x| *x += random.unit() / 4.0),
            _ => {
                place.iter_mut().for_each(|x| *x += random.below(2) as f64 / 4.0);
                *weight = random.unit() / 2.0;
            }
        }
    }
    (points, sides)
}

#[test]
fn what_cannot_be_is_refused_with_advice() {
    let lattice = crystal([2, 4, 4], &CUBIC);
    let error = shape(&lattice, [2.0, 4.0, 4.0], 0.25).unwrap_err();
    let ShapeError::Wraps { axis: 'x', span, side, .. } = error else { panic!("{error:?}") };
    assert_eq!((span, side), (1.0, 2.0));
    let next = error.advice().unwrap().to_string();
    assert!(next.contains("repeat the points along x"), "{next}");
    // Below the bound every set is accepted, however few its points are.
    for squared in [-1.0, 0.0, 0.24] {
        assert!(shape(&lattice, [2.0, 4.0, 4.0], squared).is_ok());
        assert!(shape(&unweighted(vec![[0.0; 3]]), [2.0, 4.0, 4.0], squared).is_ok());
    }
    let reference = options([4.0; 3], 1.0).engine(Engine::Cgal);
    let error = alpha_shape(lattice.clone(), &reference).unwrap_err();
    assert!(matches!(error, ShapeError::Unrepeated), "{error:?}");
    let nan = unweighted(vec![[0.0; 3], [f64::NAN, 0.0, 0.0]]);
    assert!(shape(&nan, [4.0; 3], 1.0).is_err());
    assert!(shape(&unweighted(vec![]), [4.0; 3], 1.0).is_err());
}

#[test]
fn points_beyond_the_box_are_moved_into_it() {
    let mut points = crystal([4, 4, 4], &CUBIC);
    let inside = shape(&points, [4.0; 3], 0.75).unwrap();
    points
        .positions
        .iter_mut()
        .enumerate()
        .for_each(|(i, p)| p[i % 3] += 4.0 * (i % 5) as f64 - 8.0);
    // A point and its copy are duplicates.
    points.positions.push([-4.0, 8.0, 3.0]);
    points.weights.push(0.0);
    let outside = shape(&points, [4.0; 3], 0.75).unwrap();
    assert_eq!(inside.complex(), outside.complex());
    assert_eq!(outside.duplicates(), [[64, 3]]);
    assert_eq!(outside.points().positions[..64], inside.points().positions);
}

#[test]
fn blocks_agree_with_the_whole() {
    let mut compared = 0;
    for (k, (points, sides)) in sets(60).enumerate() {
        for squared in [0.5, 1.0, 2.25] {
            let Ok(one) = shape(&points, sides, squared) else { continue };
            let whole = options(sides, squared).exterior(true);
            if let Ok(whole) = alpha_shape(points.clone(), &whole) {
                let mut complex = whole.complex().clone();
                complex.retain_shape();
                assert_eq!(*one.complex(), complex, "set {k}, α = {squared}");
                assert_eq!(one.betti(), whole.betti());
            }
            for blocks in [2, 3, 5] {
                let blocks = std::num::NonZeroUsize::new(blocks);
                let options = options(sides, squared).blocks(blocks);
                let other = alpha_shape(points.clone(), &options).unwrap();
                assert_eq!(one.complex(), other.complex(), "set {k}, α = {squared}, {blocks:?}");
                assert_eq!((one.betti(), one.sheets()), (other.betti(), other.sheets()));
                compared += 1;
            }
        }
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn moving_all_points_changes_nothing() {
    for (k, (points, sides)) in sets(60).enumerate() {
        let Ok(still) = shape(&points, sides, 1.0) else { continue };
        for by in [[1.0, 0.0, 0.0], [0.0, 2.0, 1.0], [-3.0, 7.0, 2.5], [40.0, -40.0, 1.0]] {
            let mut moved = points.clone();
            moved.positions.iter_mut().for_each(|p| (0..3).for_each(|k| p[k] += by[k]));
            let moved = shape(&moved, sides, 1.0).unwrap();
            assert_eq!(still.complex(), moved.complex(), "set {k}, moved by {by:?}");
            assert_eq!(still.betti(), moved.betti());
        }
    }
}
