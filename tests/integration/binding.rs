//! The default content of the module `cgal`: shapes at one α, and the inputs that it does not pass to CGAL.

use walpha::cgal::{Error, fixed_alpha_shape};
use walpha::shape::{Engine, ShapeOptions};
use walpha::triangulation::SitesError;
use walpha::{Alpha, alpha_shape};
use walpha_base::random::Random;

use crate::triangulation::FAMILIES;

#[test]
fn shapes_are_those_of_the_engine() {
    let mut compared = 0;
    for seed in 0..500 {
        let points = FAMILIES[seed as usize % FAMILIES.len()](&mut Random::new(seed));
        let alpha = Alpha::from_squared([f64::INFINITY, 1.0, 0.5][seed as usize % 3]).unwrap();
        let theirs = fixed_alpha_shape(points.positions(), Some(points.weights()), alpha);
        let options = ShapeOptions::new(alpha).engine(Engine::Native).exterior(true);
        let ours = alpha_shape(points, &options.refuse_flat(true));
        match theirs {
            Ok(theirs) => {
                assert_eq!(theirs, *ours.unwrap().complex(), "set {seed}");
                compared += 1;
            }
            Err(Error::Sites(error)) => assert_eq!(ours.unwrap_err(), error.into()),
            Err(error) => panic!("{error}"),
        }
    }
    assert!(compared > 250, "{compared}");
}

#[test]
fn what_cgal_does_not_stand_is_refused() {
    let cube = |i: i32| [i & 1, i >> 1 & 1, i >> 2].map(f64::from);
    let points: Vec<[f64; 3]> = (0..8).map(cube).collect();
    let refused = |positions: &[[f64; 3]], weights: Option<&[f64]>| match fixed_alpha_shape(
        positions,
        weights,
        Alpha::ZERO,
    ) {
        Err(Error::Sites(error)) => error,
        other => panic!("{other:?}"),
    };
    for bad in [f64::NAN, f64::INFINITY, 1e200] {
        let mut points = points.clone();
        points[3][1] = bad;
        let error = refused(&points, None);
        assert!(matches!(error, SitesError::Value { index: 3, what: "y", .. }), "{error}");
    }
    let mut weights = [0.0; 8];
    weights[5] = f64::NEG_INFINITY;
    let error = refused(&points, Some(&weights));
    assert!(matches!(error, SitesError::Value { index: 5, what: "weight", .. }), "{error}");
    assert!(matches!(refused(&points, Some(&[0.0; 7])), SitesError::Lengths { .. }));
    assert!(matches!(refused(&points[..3], None), SitesError::TooFew { distinct: 3 }));
    assert!(matches!(refused(&points[..4], None), SitesError::Flat { points: 4, .. }));
    assert!(matches!(refused(&[[0.0; 3]; 5], None), SitesError::TooFew { distinct: 1 }));
    assert_eq!(fixed_alpha_shape(&points, None, Alpha::INFINITE).unwrap().cells.len(), 6);
}
