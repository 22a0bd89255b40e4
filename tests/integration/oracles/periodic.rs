//! `Periodic_3_regular_triangulation_3`: the same cells in a cube, without weights and with those that CGAL takes. Points are random,
//! so that no tie is broken in another way.

use rayon::prelude::*;
use walpha::WeightedPoints;
use walpha::cgal::{self, periodic_regular_triangulation_3};
use walpha::ladder::Filtration;
use walpha::shape::{ShapeError, Torus};
use walpha_base::random::Random;

const SIDE: f64 = 8.0;

/// From 300 to 1500 points; every second set has weights from 0 to less than 1/64 of the squared side.
fn set(seed: u64) -> WeightedPoints {
    let mut random = Random::new(seed);
    let count = [300, 600, 1500][random.below(3)];
    // Places that are not changed in the box.
    let mut place = |_| [0; 3].map(|_| random.below(1 << 40) as f64 / (1u64 << 40) as f64 * SIDE);
    let positions: Vec<[f64; 3]> = (0..count).map(&mut place).collect();
    let weight = |random: &mut Random| random.unit() * SIDE * SIDE / 64.5;
    let weights =
        (0..count).map(|_| if seed % 2 == 1 { weight(&mut random) } else { 0.0 }).collect();
    WeightedPoints::new(positions, weights).unwrap()
}

/// The cells of our filtration, vertices ascending; `None` where an edge spans half of the box.
fn ours(points: &WeightedPoints) -> Option<Vec<[u32; 4]>> {
    let torus = Torus::new([SIDE; 3]).unwrap();
    let made = match Filtration::on(Some(torus), points.clone()) {
        Ok(made) => made,
        Err(ShapeError::Wraps { .. }) => return None,
        Err(error) => panic!("{error}"),
    };
    assert_eq!(made.points().positions(), points.positions());
    let ascending = |row: &[u32; 4]| {
        let mut row = *row;
        row.sort_unstable();
        row
    };
    let mut cells: Vec<_> = made.whole().complex().cells.rows().iter().map(ascending).collect();
    cells.sort_unstable();
    Some(cells)
}

#[test]
fn cells_of_a_cube_are_ours() {
    let compared: Vec<u64> = (0..20_u64)
        .into_par_iter()
        .filter(|&seed| {
            let points = set(seed);
            let theirs =
                periodic_regular_triangulation_3(points.positions(), Some(points.weights()), SIDE);
            // Some sets need several copies in one or both.
            let (Some(theirs), Some(ours)) = (theirs.unwrap(), ours(&points)) else { return false };
            assert!(ours == theirs, "set {seed}: {} and {} cells", ours.len(), theirs.len());
            true
        })
        .collect();
    let with_weights = compared.iter().filter(|&seed| seed % 2 == 1).count();
    assert!(with_weights >= 5 && compared.len() - with_weights >= 5, "{compared:?}");
}

#[test]
fn what_cgal_does_not_take_is_refused() {
    let points = [[0.0; 3], [1.0; 3], [2.0, 3.0, 7.5], [-0.0, 0.0, 0.0]];
    let of =
        |weights: Option<&[f64]>, side| periodic_regular_triangulation_3(&points, weights, side);
    // Few points, of which two are at one place: several copies.
    assert_eq!(of(None, 8.0).unwrap(), None);
    for side in [0.0, -8.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(of(None, side), Err(cgal::Error::Side { .. })), "{side}");
    }
    let error = of(None, 7.5).unwrap_err();
    assert!(matches!(error, cgal::Error::Outside { index: 2, axis: 'z', .. }), "{error}");
    for weight in [1.0, -1e-300] {
        let error = of(Some(&[0.0, 0.0, weight, 0.5]), 8.0).unwrap_err();
        assert!(matches!(error, cgal::Error::Weight { index: 2, .. }), "{error}");
    }
    assert!(of(Some(&[0.0, 0.0, 1.0_f64.next_down(), 0.5]), 8.0).is_ok());
    assert!(matches!(of(Some(&[0.0]), 8.0), Err(cgal::Error::Sites(_))));
    let nan = periodic_regular_triangulation_3(&[[f64::NAN; 3]], None, 8.0).unwrap_err();
    assert!(matches!(nan, cgal::Error::Sites(_)), "{nan}");
    assert!(periodic_regular_triangulation_3(&[], None, 8.0).is_err());
}
