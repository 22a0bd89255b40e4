//! Points that repeat along one or two vectors: the exact checker, and the texts that name directions.

use walpha_base::random::Random;
use walpha_check::{Finding, Verdict};
use walpha_model::export::placed_complex;
use walpha_shape::{Alpha, AlphaShape, ShapeOptions, Torus, WeightedPoints, alpha_shape};

/// Along the axes, tilted hexagons, and slanted.
const VECTORS: [[[f64; 3]; 3]; 3] = [
    [[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]],
    [[4.0, -4.0, 0.0], [0.0, 4.0, -4.0], [2.0, 3.0, 4.0]],
    [[4.0, 0.0, 0.0], [1.5, 3.5, 0.0], [-1.0, 0.5, 5.0]],
];
const REPEATS: [[bool; 3]; 5] = [
    [true, true, false],
    [true, false, true],
    [false, true, true],
    [true, false, false],
    [false, false, true],
];

fn shape(vectors: [[f64; 3]; 3], repeats: [bool; 3], count: u64, alpha: f64) -> AlphaShape {
    let torus = Torus::repeating(vectors, repeats).unwrap();
    let mut random = Random::new(count);
    let positions = (0..count).map(|_| [0; 3].map(|_| 4.0 * random.unit())).collect();
    let weights = (0..count).map(|_| 0.25 * random.unit()).collect();
    let options = ShapeOptions::new(Alpha::from_squared(alpha).unwrap());
    let options = options.periodic(Some(torus)).exterior(alpha > 1.0);
    alpha_shape(WeightedPoints::new(positions, weights).unwrap(), &options).unwrap()
}

/// Whole triangulations, large and small boxes, and shapes alone; and what is wrong with one cell less.
#[test]
fn slabs_and_rods_are_certified() {
    let (mut whole, mut wrong) = (0, 0);
    for vectors in VECTORS {
        for repeats in REPEATS {
            for count in [3, 12, 60] {
                for alpha in [0.3, 2.0, f64::INFINITY] {
                    let shape = shape(vectors, repeats, count, alpha);
                    let mut placed = placed_complex(&shape);
                    let (found, certificate) = placed.findings().unwrap();
                    assert_eq!(found, [], "{vectors:?} {repeats:?} {count} {alpha}");
                    assert_eq!(certificate.verdict, Verdict::Exact);
                    if alpha == f64::INFINITY && !placed.complex.cells.is_empty() {
                        whole += 1;
                        placed.complex.cells =
                            placed.complex.cells.iter().skip(1).map(|(r, c)| (*r, c)).collect();
                        let (found, _) = placed.findings().unwrap();
                        wrong += usize::from(!found.is_empty());
                        let is_volume =
                            |finding: &Finding| matches!(finding, Finding::Volume { .. });
                        assert!(found.iter().any(is_volume) || found.len() > 1, "{found:?}");
                    }
                }
            }
        }
    }
    assert!(whole > 30 && wrong == whole, "{whole} {wrong}");
}
