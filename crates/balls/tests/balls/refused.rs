//! What has no union of balls.

use walpha_balls::{BallUnion, BallsError, DiscUnion, PeriodicBalls};
use walpha_base::advice::Advise;
use walpha_shape::{Alpha, ShapeOptions, Torus, alpha_shape};

#[test]
fn shapes_without_balls_are_refused() {
    let square = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let infinite = alpha_shape(&square, &ShapeOptions::new(Alpha::INFINITE)).unwrap();
    for error in [BallUnion::new(&infinite).err(), DiscUnion::new(&infinite).err()] {
        let error = error.unwrap();
        assert_eq!(error, BallsError::Infinite);
        assert_eq!(error.advice().unwrap().to_string(), "give a finite `alpha`");
    }
    let shape = alpha_shape(&square, &ShapeOptions::new(Alpha::ZERO)).unwrap();
    let union = BallUnion::new(&shape).unwrap();
    assert_eq!(union.voids(), Err(BallsError::NoExterior { what: "voids" }));
    assert_eq!(union.pockets(), Err(BallsError::NoExterior { what: "pockets" }));
    let cube: Vec<[f64; 3]> = (0..64).map(|i| [i % 4, i / 4 % 4, i / 16].map(f64::from)).collect();
    // An empty shape of points in space.
    let shape = alpha_shape(&cube, &ShapeOptions::new(Alpha::from_squared(-1.0).unwrap())).unwrap();
    assert_eq!(DiscUnion::new(&shape).err(), Some(BallsError::Solid));
    let torus = Torus::new([4.0; 3]).unwrap();
    let options =
        ShapeOptions::new(Alpha::from_squared(0.3).unwrap()).periodic(Some(torus)).exterior(true);
    let shape = alpha_shape(&cube, &options).unwrap();
    assert_eq!(DiscUnion::new(&shape).err(), Some(BallsError::Periodic));
    let union = BallUnion::new(&shape).unwrap();
    assert_eq!(union.pockets(), Err(BallsError::NoOutside));
    let unwrapped = shape.unwrapped();
    assert_eq!(BallUnion::new(&unwrapped).err(), Some(BallsError::Unwrapped));
}

#[test]
fn boxes_and_probes_without_pores_are_refused() {
    let slab = Torus::repeating([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]], [true, true, false]);
    let balls = |torus, radii: &[f64]| PeriodicBalls::new(torus, vec![[0.0; 3]], radii.to_vec());
    assert_eq!(balls(slab.unwrap(), &[0.1]).unwrap_err(), BallsError::Slab);
    let cube = Torus::new([1.0; 3]).unwrap();
    let other = BallsError::Weights { weights: 2, points: 1 };
    assert_eq!(balls(cube, &[0.1, 0.2]).unwrap_err(), other);
    for radius in [-1.0, f64::INFINITY, 1e200] {
        let error = balls(cube, &[radius]).unwrap_err();
        assert_eq!(error, BallsError::Radius { row: 0, radius });
    }
    let one = balls(cube, &[0.1]).unwrap();
    assert_eq!(one.probed(1e200).unwrap_err(), BallsError::Probe { radius: 1e200 });
    assert!(one.probed(0.1).is_ok());
}
