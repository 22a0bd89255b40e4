use walpha::Points;
use walpha::points::{PointsError, read_points, scattered_difference};

use crate::common;
use crate::files::*;

#[test]
fn points_of_every_format_are_read() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in point_examples() {
        let path = save(folder.path(), name, bytes);
        assert!(walpha::points::is_point_file(&path).unwrap(), "{name}");
        let points = read_points(&path, None).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(points.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{name}");
        assert_eq!(points.values, Some(vec![7.0, 8.0]), "{name}");
        assert_eq!(points.weights, None, "{name}");
    }
    let atoms = "2\na molecule\nC 1 2 3\nH 4 5 6 0.1\n";
    let points = read_points(&save(folder.path(), "m.xyz", atoms), None).unwrap();
    assert_eq!((points.len(), points.values), (2, None));
    for (name, bytes) in examples() {
        let path = save(folder.path(), name, bytes);
        assert!(!walpha::points::is_point_file(&path).unwrap(), "{name}");
    }
    assert!(!walpha::points::is_point_file(folder.path()).unwrap());
}

#[test]
fn damaged_points_say_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let refuses = |name: &str, text: &str, part: &str| {
        let error = read_points(&save(folder.path(), name, text), None).unwrap_err().to_string();
        assert!(error.contains(part) && error.contains(name), "{part:?} is missing in: {error}");
    };
    let rows = "2 0 1\n1 2 3 0 7\n4 5 6 0 8\n";
    let ply = |from: &str, to: &str| (PLY.to_owned() + rows).replace(from, to);
    refuses("a.ply", "hello", "no PLY file");
    refuses("a.ply", &ply("format ascii 1.0\n", ""), "no format");
    refuses("a.ply", &ply("end_header", "end"), "not understood");
    refuses("a.ply", &ply("float x", "float q"), "properties x");
    refuses("a.ply", &ply("float y", "float x"), "properties x");
    refuses("a.ply", &ply("float x", "half x"), "half");
    refuses("a.ply", &ply("vertex 2", "vertex 3"), "truncated");
    refuses("a.ply", &ply("vertex 2", "vertex 99999999999"), "cannot hold");
    refuses("a.ply", &ply("vertex 2", "vertex 1"), "too long");
    refuses("a.ply", &ply("vertex 2", "vertex 0").replace(rows, "0\n"), "no point");
    refuses("a.ply", &ply("element vertex", "element corner"), "no element vertex");
    refuses("a.ply", &ply("1 2 3 0", "1 2 3 300"), "300");
    refuses("a.ply", &ply("1 2 3 0", "1 nan 3 0"), "y is NaN");
    refuses("a.xyz", "1 2\n", "2 columns");
    refuses("a.xyz", "1 2 3\n1 2 3 4\n", "line 2");
    refuses("a.xyz", "1 2 3\n1 two 3\n", "column y");
    refuses("a.xyz", "3\n\nC 1 2 3\n", "claims 3 atoms");
    refuses("a.vtp", &vtp("1 2 3 4 5"), "truncated");
    refuses("a.vtp", &vtp("1 2 3 4 5 6 7"), "more follow");
    refuses("a.vtp", &vtp("1 2 3 4 5 6").replace("PolyData", "Table"), "Table");
    refuses("a.vtp", &vtp("1 2 3 4 5 inf"), "z is inf");
}

pub fn scattered() -> Points {
    Points {
        positions: vec![
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [0.0, 4.0, 0.0],
            [0.0, 0.0, 4.0],
            [1.0, 1.0, 1.0],
            [0.0, 0.0, 0.0],
        ],
        values: Some(vec![1.0, 2.0, 3.0, 5.0, 10.0, 4.0]),
        ..Points::default()
    }
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
    let without = Points { values: None, ..scattered() };
    assert!(matches!(scattered_difference(&without), Err(PointsError::NoValues)));
    let mut flat = scattered();
    flat.positions.iter_mut().for_each(|p| p[2] = 0.0);
    assert!(scattered_difference(&flat).unwrap_err().to_string().contains("in one plane"));
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
