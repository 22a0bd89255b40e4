//! Curves over α, held to unions at each α.

use walpha_balls::{BallUnion, BallsError, union_curve};
use walpha_shape::ladder::Filtration;
use walpha_shape::{Alpha, Torus, WeightedPoints};

use crate::assert_same;
use crate::random_sets::balls;

fn compare(filtration: &Filtration, alphas: &[f64]) {
    let alphas: Vec<Alpha> = alphas.iter().map(|&a| Alpha::from_squared(a).unwrap()).collect();
    let curve = union_curve(filtration, &alphas).unwrap();
    assert_eq!(curve.len(), alphas.len());
    for (level, &alpha) in curve.iter().zip(&alphas) {
        assert_eq!(level.alpha, alpha);
        let shape = filtration.shape(alpha);
        let union = BallUnion::new(&shape).unwrap();
        assert_same(level.volume, union.volume());
        assert_same(level.area, union.area());
        assert_eq!(level.euler_characteristic, union.euler_characteristic());
        assert!(level.volume.bound <= 4.0 * union.volume().bound + 1e-300, "{level:?}");
    }
}

#[test]
fn levels_are_unions() {
    let (centers, squares) = balls(21, 400, 1.0);
    let points = WeightedPoints::new(centers, squares.iter().map(|s| s - 1.0).collect()).unwrap();
    let filtration = Filtration::new(points).unwrap();
    compare(&filtration, &[-0.9, -0.5, -0.2, 0.0, 0.1, 0.3, 0.7, 1.0, 2.0, 5.0, 100.0]);
}

/// All simplices of a kind enter at one α; on a torus, in a plane, on a line.
#[test]
fn levels_of_lattices_are_unions() {
    let at = |i: i32| [i % 4, i / 4 % 4, i / 16].map(f64::from);
    let cube: Vec<[f64; 3]> = (0..64).map(at).collect();
    let alphas = [-1.0, 0.0, 0.1, 0.25, 0.3, 0.5, 0.6, 0.75, 0.8, 3.0];
    compare(&Filtration::new(&cube).unwrap(), &alphas);
    compare(&Filtration::new(&cube[..16]).unwrap(), &alphas);
    compare(&Filtration::new(&cube[..4]).unwrap(), &alphas);
    compare(&Filtration::new(&cube[..1]).unwrap(), &alphas);
    let torus = Torus::new([4.0; 3]).unwrap();
    compare(&Filtration::on(Some(torus), &cube).unwrap(), &alphas[..9]);
}

#[test]
fn far_sets_are_scaled() {
    let scale = 2f64.powi(-80);
    let (centers, squares) = balls(22, 50, 1.0);
    let centers: Vec<_> = centers.iter().map(|c| c.map(|x| x * scale)).collect();
    let squares: Vec<_> = squares.iter().map(|s| s * scale * scale).collect();
    let filtration = Filtration::new(WeightedPoints::new(centers, squares).unwrap()).unwrap();
    compare(&filtration, &[0.0, scale * scale]);
}

#[test]
fn no_level_is_infinite() {
    let filtration = Filtration::new(&[[0.0; 3]]).unwrap();
    assert_eq!(union_curve(&filtration, &[Alpha::INFINITE]), Err(BallsError::Infinite));
}
