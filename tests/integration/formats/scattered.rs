//! Scattered values: how they differ, and weights from them.

use walpha::Points;
use walpha::points::{PointsError, read_points, scattered_difference};

use super::files::save;
use crate::common;
use crate::common::told::Told;

pub fn scattered() -> Points {
    let positions = vec![
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [0.0, 4.0, 0.0],
        [0.0, 0.0, 4.0],
        [1.0, 1.0, 1.0],
        [0.0, 0.0, 0.0],
    ];
    Points::new(positions).with_values(vec![1.0, 2.0, 3.0, 5.0, 10.0, 4.0]).unwrap()
}

/// A tetrahedron with a point in it, so that all places are neighbours; the last stands on the first.
#[test]
fn scattered_values_differ_from_their_delaunay_neighbours() {
    let differences = scattered_difference(&scattered()).unwrap();
    let mean = |n: [f64; 4]| n.iter().sum::<f64>() / 4.0;
    assert_eq!(
        differences,
        [
            mean([1.0, 2.0, 4.0, 9.0]),
            mean([1.0, 1.0, 3.0, 8.0]),
            mean([2.0, 1.0, 2.0, 7.0]),
            mean([4.0, 3.0, 2.0, 5.0]),
            mean([9.0, 8.0, 7.0, 5.0]),
            mean([2.0, 1.0, 1.0, 6.0]),
        ]
    );
    let without = Points::new(scattered().positions);
    assert!(matches!(scattered_difference(&without), Err(PointsError::NoValues)));
    let mut flat = scattered();
    flat.positions.iter_mut().for_each(|p| p[2] = 0.0);
    assert!(scattered_difference(&flat).unwrap_err().told().contains("in one plane"));
}

#[test]
fn the_command_weighs_scattered_values() {
    let folder = tempfile::tempdir().unwrap();
    let points = scattered();
    let mut text = String::from("x,y,z,value\n");
    for ([x, y, z], value) in points.positions.iter().zip(points.values.iter().flatten()) {
        text += &format!("{x},{y},{z},{value}\n");
    }
    save(folder.path(), "s.csv", &text);
    for weights in ["min-max", "barycentric", "barycentric-n"] {
        common::ok(folder.path(), &["points", "s.csv", "--weights", weights, "-o", "w.csv"]);
        let weights = read_points(&folder.path().join("w.csv"), None).unwrap().weights.unwrap();
        assert!(weights.iter().any(|&w| w > 0.0));
    }
    save(folder.path(), "bare.csv", text.replace("value", "other"));
    let (code, _, said) =
        common::run(folder.path(), &["points", "bare.csv", "--weights", "min-max"]);
    assert!(code == 1 && said.contains("column `value`"), "{said}");
}
