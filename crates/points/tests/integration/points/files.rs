//! Files of points.

use std::fmt::Debug;
use std::sync::{Arc, Mutex};

use tracing::field::{Field, Visit};
use tracing::span::{Attributes as SpanAttributes, Id, Record};
use tracing::{Event, Metadata, Subscriber};

use super::*;

/// Collects warnings.
#[derive(Clone, Default)]
struct Warnings(Arc<Mutex<String>>);

impl Subscriber for Warnings {
    fn enabled(&self, _: &Metadata<'_>) -> bool {
        true
    }

    fn new_span(&self, _: &SpanAttributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn event(&self, event: &Event<'_>) {
        event.record(&mut self.clone());
    }

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}

impl Visit for Warnings {
    fn record_debug(&mut self, _: &Field, value: &dyn Debug) {
        self.0.lock().unwrap().push_str(&format!("{value:?}"));
    }
}

#[test]
fn written_points_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let third = 1.0 / 3.0;
    for values in [None, Some(vec![1e-300, -7.5])] {
        let positions = vec![[third, -2.0, 1e20], [0.0, 5.0, 6.25]];
        let points = WeightedPoints::new(positions, vec![third * third, -1.0]).unwrap();
        let points = points.with_values(values).unwrap();
        assert_eq!((points.is_empty(), points.len()), (false, 2));
        let (csv, npy) = (folder.path().join("p.csv"), folder.path().join("p.npy"));
        for path in [csv, npy] {
            let mut file = std::fs::File::create(&path).unwrap();
            PointWriter::of(&path).unwrap().write(&points, &mut file).unwrap();
            assert!(is_point_file(&path).unwrap());
            let back = read_points(&path, None).unwrap();
            assert_eq!(
                weigh(back, Weighting::Column, Alpha::from_squared(1.0).unwrap()).unwrap(),
                points,
                "{path:?}"
            );
        }
    }
}

/// The first axis fastest, as `numpy.asfortranarray` makes it.
#[test]
fn columns_of_an_array_may_come_first() {
    use ndarray::ShapeBuilder as _;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.npy");
    let of = |(row, column): (usize, usize)| (10 * row + column) as f64;
    for columns in [4, 5] {
        let mut bytes = Vec::new();
        let array = ndarray::Array2::from_shape_fn((3, columns).f(), of);
        ndarray_npy::WriteNpyExt::write_npy(&array, &mut bytes).unwrap();
        assert!(bytes.windows(22).any(|header| header == b"'fortran_order': True,"));
        std::fs::write(&path, bytes).unwrap();
        let names = ["x,y,z,weight", "x,y,z,weight,value"][columns - 4].parse().unwrap();
        let points = read_points(&path, Some(&names)).unwrap();
        assert_eq!(points.positions, [[0.0, 1.0, 2.0], [10.0, 11.0, 12.0], [20.0, 21.0, 22.0]]);
        assert_eq!(points.weights, Some(vec![3.0, 13.0, 23.0]));
        assert_eq!(points.values, (columns == 5).then(|| vec![4.0, 14.0, 24.0]));
        // Without names a fourth column has values, and a fifth is not guessed.
        let guessed = read_points(&path, None);
        assert_eq!(
            guessed.ok().map(|points| (points.weights, points.values)),
            (columns == 4).then(|| (None, Some(vec![3.0, 13.0, 23.0])))
        );
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

/// −0 is where 0 is.
#[test]
fn corners_of_facets_are_points_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.stl");
    let text = "solid\nvertex 0 0 1\nvertex -0 1 0\nvertex 1 0 0\nvertex 0 -0 1\nvertex 0 1 -0\nendsolid\n";
    std::fs::write(&path, text).unwrap();
    let points = read_points(&path, None).unwrap();
    assert_eq!(points.positions, [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]);
}

/// The kind of a file is known by its first bytes, for any name.
#[test]
fn content_goes_before_names() {
    let folder = tempfile::tempdir().unwrap();
    let points = WeightedPoints::unweighted(vec![[1.0, 2.0, 3.0], [0.5, 0.0, -1.0]]);
    let points = points.with_values(vec![7.0, 8.0]).unwrap();
    let ply = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
        property float z\nend_header\n1 2 3\n0.5 0 -1\n";
    let pcd = "# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 2\nDATA ascii\n\
        1 2 3\n0.5 0 -1\n";
    let vtp = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"2\">\
        <Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">1 2 3 0.5 0 -1\
        </DataArray></Points></Piece></PolyData></VTKFile>";
    let written = |name: &str| {
        let mut bytes = Vec::new();
        PointWriter::of(name).unwrap().write(&points, &mut bytes).unwrap();
        bytes
    };
    for bytes in [ply.into(), pcd.into(), vtp.into(), written("p.npy"), written("p.wvm")] {
        for name in ["points", "points.csv", "points.nii"] {
            let path = folder.path().join(name);
            std::fs::write(&path, &bytes).unwrap();
            let start = String::from_utf8_lossy(&bytes[..10]);
            assert!(is_point_file(&path).unwrap(), "{start} in {name}");
            let found = read_points(&path, None).unwrap();
            assert_eq!(found.positions, points.positions(), "{start} in {name}");
        }
    }
}

#[test]
fn formats_say_whether_they_are_built_in() {
    let absent = FORMATS.iter().filter(|format| !format.is_built_in());
    let absent: Vec<_> = absent.flat_map(|format| format.extensions).collect();
    let expected: &[&str] = if cfg!(feature = "las") { &[] } else { &["las", "laz"] };
    assert!(absent.iter().copied().eq(expected), "{absent:?}");
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
    refuse("empty.csv", b"", &["no rows of numbers"]);
    refuse("nothing.csv", b"x,y,z\n", &["no rows of numbers"]);
    refuse("axis.csv", b"x,z\n1,2\n", &["x, y and z"]);
    refuse("twice.csv", b"x,y,z,X\n1,2,3,4\n", &["twice"]);
    refuse("word.csv", b"x,y,z\n1,2,3\n1,two,3\n", &["line 3", "column y", "two"]);
    refuse("nan.csv", b"x,y,z,weight\n1,2,3,NaN\n", &["line 2", "column weight"]);
    refuse("short.csv", b"x,y,z\n1,2,3\n1,2\n", &["line 3", "2 columns"]);
    refuse("comma.tsv", b"x\ty\tz\n1,500\t2\t3\n", &["line 2", "1.500 or 1500"]);
    refuse("text.csv", b"x,y,z\n\xff,2,3\n", &["line 2", "column x", "ÿ"]);

    let npy = |array: ndarray::Array2<f64>| {
        let mut bytes = Vec::new();
        ndarray_npy::WriteNpyExt::write_npy(&array, &mut bytes).unwrap();
        bytes
    };
    refuse("two.npy", &npy(ndarray::arr2(&[[1.0, 2.0]])), &["2 columns", "`columns` x,y"]);
    let infinite = ndarray::arr2(&[[1.0, 2.0, f64::INFINITY, 0.0]]);
    refuse("inf.npy", &npy(infinite), &["row 0", "z is inf"]);
    refuse("none.npy", &npy(ndarray::Array2::zeros((0, 4))), &["no point"]);
    refuse("off.off", b"OFF\n2 0 0\n# two\n\n0 0 0\n0 zero 0\n", &["line 6", "y is \"zero\""]);
    // The first row alone could be a place and a unit vector.
    refuse("six.xyz", b"0 0 0 0 0 1\n0 0 1 0.5 7 300\n", &["has 6 columns"]);
    refuse("two.pwn", b"2\n0 0 0\n1 1\n", &["line 3", "2 columns"]);
    refuse("text.stl", b"solid\n\nvertex 0 zero 0\nendsolid\n", &["line 3", "y is \"zero\""]);
    let binary = [&[0; 80][..], &5u32.to_le_bytes(), &[0; 150]].concat();
    refuse("binary.stl", &binary, &["claims 5 facets, 334 bytes, but has 234"]);
    refuse("short.stl", &binary[..20], &["claims 0 facets"]);
    for items in ["1.5", "-1", "nan"] {
        let list = format!(
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n\
             element face 1\nproperty list float int vertex_indices\nend_header\n0 0 0\n{items} 0\n"
        );
        refuse("list.ply", list.as_bytes(), &["has a list of"]);
    }
    let text = read_points(Path::new("no/such.csv"), None).unwrap_err().told();
    assert!(text.contains("no/such.csv"), "{text}");
}

/// The files of a folder as points, or what is wrong with them.
fn read_text(name: &str, text: &str) -> Result<Points, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    read_points(&path, None).map_err(|error| error.told())
}

#[test]
fn weights_are_in_the_square_of_the_unit() {
    for unit in ["mm2", "mm^2", "mm²", "mm ^ 2", "mm**2"] {
        let points =
            read_text("a.csv", &format!("x [mm],y [mm],z [mm],weight [{unit}]\n1,2,3,4\n"));
        assert_eq!(points.unwrap().weights, Some(vec![4.0]), "{unit}");
    }
    for (unit, told) in
        [("mm", "the unit mm of the weight"), ("kg", "not a squared length"), ("m2", "mm and m;")]
    {
        let error = read_text("a.csv", &format!("x [mm],y [mm],z [mm],weight [{unit}]\n1,2,3,4\n"));
        let error = error.unwrap_err();
        assert!(error.contains(told) && error.contains("square"), "{unit}: {error}");
    }
}

#[test]
fn counts_may_come_before_names() {
    for (name, mark) in [("a.csv", ","), ("a.pts", " "), ("a.csv", ";")] {
        let of = |count: u32, names: &str| {
            let rows = "1 2 3 7\n4 5 6 8\n".replace(' ', mark);
            read_text(name, &format!("{count}\n{}\n{rows}", names.replace(' ', mark)))
        };
        let points = of(2, "x y z weight").unwrap();
        assert_eq!((points.len(), points.weights), (2, Some(vec![7.0, 8.0])), "{name} {mark}");
        assert_eq!(of(2, "z y x value").unwrap().positions[1], [6.0, 5.0, 4.0], "{name} {mark}");
        let error = of(3, "x y z weight").unwrap_err();
        assert!(error.contains("claims 3 points in line 1, but has 2"), "{error}");
    }
}

/// What is wrong with a row is said of the row.
#[test]
fn rows_that_are_no_numbers_say_so() {
    for (name, text, told) in [
        ("a.csv", "x,y,z\n'1','2','3'\n4,5,6\n", r#"line 2, column x: "'1'" is not"#),
        ("a.csv", "x,y,z\n\u{ff11},\u{ff12},\u{ff13}\n4,5,6\n", "line 2, column x"),
        ("a.xyz", "1 2 3 # a\n4 5 6 # b\n", "line 1, column 4: \"#\" is not"),
        ("a.xyz", "1 2 3 2023-01-01\n", "line 1, column 4: \"2023-01-01\" is not"),
    ] {
        let error = read_text(name, text).unwrap_err();
        assert!(error.contains(told), "{text:?}: {error}");
    }
    for units in ["m,m,m,counts", "[m],[m],[m],[furlong]", "(furlong),(furlong),(furlong),()"] {
        let points = read_text("a.csv", &format!("x,y,z,value\n{units}\n1,2,3,4\n"));
        assert_eq!(points.unwrap().len(), 1, "{units}");
    }
}

/// Decimal commas may make six columns of three.
#[test]
fn columns_that_are_not_read_are_named() {
    let warned = |text: &str| {
        let warnings = Warnings::default();
        let read = tracing::subscriber::with_default(warnings.clone(), || read_text("a.csv", text));
        assert_eq!(read.unwrap().len(), 2);
        warnings.0.lock().unwrap().clone()
    };
    let told = warned("1,5,2,5,3,5\n4,1,5,2,6,3\n");
    assert!(told.contains("the last three are taken for a normal or a colour"), "{told}");
    assert_eq!(warned("1.5,2,5,255,0,7\n4,1.5,5,2,6,3\n"), "");
    assert_eq!(warned("1 5 2 255 3 5\n4 1 5 2 6 3\n"), "");
    assert_eq!(warned("1.5,2,5,0.6,0,0.8\n4,1.5,5,0,0,1\n"), "");
}
