//! Files of points.

use crate::*;

#[test]
fn written_points_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let third = 1.0 / 3.0;
    for values in [None, Some(vec![1e-300, -7.5])] {
        let positions = vec![[third, -2.0, 1e20], [0.0, 5.0, 6.25]];
        let mut points = WeightedPoints::new(positions, vec![third * third, -1.0]).unwrap();
        points.values = values;
        let (csv, npy) = (folder.path().join("p.csv"), folder.path().join("p.npy"));
        for path in [csv, npy] {
            let mut file = std::fs::File::create(&path).unwrap();
            PointWriter::of(&path).unwrap().write(&points, &mut file).unwrap();
            assert!(is_point_file(&path).unwrap());
            let back = read_points(&path, None).unwrap();
            assert_eq!(
                weigh(&back, Weighting::Column, Alpha::from_squared(1.0).unwrap()).unwrap(),
                points,
                "{path:?}"
            );
        }
    }
}

#[test]
fn csv_columns_may_stand_anywhere() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points.csv");
    std::fs::write(&path, "\u{feff}name,Z, y ,weight,X\na,3,2,0.5,1\n\"b, c\",6,5,-1e1,4\n")
        .unwrap();
    let points = read_points(&path, None).unwrap();
    assert_eq!(points.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_eq!(points.weights, Some(vec![0.5, -10.0]));
    assert_eq!(points.values, None);
}

#[test]
fn bad_point_files_say_where_they_are_bad() {
    let folder = tempfile::tempdir().unwrap();
    let refuse = |name: &str, bytes: &[u8], parts: &[&str]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let text = read_points(&path, None).unwrap_err().told();
        for part in parts.iter().chain(&[name]) {
            assert!(text.contains(part), "{part:?} is missing in: {text}");
        }
    };
    refuse("empty.csv", b"", &["first line must name"]);
    refuse("nothing.csv", b"x,y,z\n", &["no point"]);
    refuse("axis.csv", b"x,z\n1,2\n", &["x, y and z"]);
    refuse("twice.csv", b"x,y,z,X\n1,2,3,4\n", &["twice"]);
    refuse("word.csv", b"x,y,z\n1,2,3\n1,two,3\n", &["line 3", "column y", "two"]);
    refuse("nan.csv", b"x,y,z,weight\n1,2,3,NaN\n", &["line 2", "column weight"]);
    refuse("short.csv", b"x,y,z\n1,2,3\n1,2\n", &["line: 3"]);
    refuse("text.csv", b"x,y,z\n\xff,2,3\n", &["UTF-8"]);

    let npy = |array: ndarray::Array2<f64>| {
        let mut bytes = Vec::new();
        ndarray_npy::WriteNpyExt::write_npy(&array, &mut bytes).unwrap();
        bytes
    };
    refuse("three.npy", &npy(ndarray::arr2(&[[1.0, 2.0, 3.0]])), &["[1, 3]", "n×4"]);
    let infinite = ndarray::arr2(&[[1.0, 2.0, f64::INFINITY, 0.0]]);
    refuse("inf.npy", &npy(infinite), &["row 0", "z is inf"]);
    refuse("none.npy", &npy(ndarray::Array2::zeros((0, 4))), &["no point"]);
    let text = read_points(Path::new("no/such.csv"), None).unwrap_err().told();
    assert!(text.contains("no/such.csv"), "{text}");
}
