//! Points in text: many extensions, extended XYZ, legacy VTK, bare arrays, and columns with names of their own.

use std::process::Command;

use walpha::points::{PointOptions, read_model, read_points};

use super::files::save;
use crate::common::{Told, fails, json, names, ok, run};

const PLACES: [[f64; 3]; 2] = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];

#[test]
fn text_under_many_extensions() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let cases = [
        ("a.txt", "1 2 3\n4 5 6\n", None),
        ("a.asc", "1 2 3 7\n4 5 6 8\n", Some(vec![7.0, 8.0])),
        ("b.asc", "x,y,z\n1,2,3\n4,5,6\n", None),
        ("a.xyzn", "1 2 3 0 3 0\n4 5 6 0 0 7\n", None),
        ("a.xyzrgb", "1 2 3 0.5 0.25 1\n4 5 6 0 0 0.1\n", None),
        ("a.pts", "2\n1 2 3 7 9 9 9\n4 5 6 8 9 9 9\n", Some(vec![7.0, 8.0])),
        ("b.pts", "1 2 3 7\n4 5 6 8\n", Some(vec![7.0, 8.0])),
        ("c.PTS", "2\n1 2 3\n4 5 6\n", None),
    ];
    for (name, text, values) in cases {
        let path = save(f, name, text);
        assert!(walpha::points::is_point_file(&path).unwrap(), "{name}");
        let points = read_points(&path, None).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((points.positions.as_slice(), points.values), (&PLACES[..], values), "{name}");
    }
    save(f, "short.pts", "3\n1 2 3\n4 5 6\n");
    fails(f, 1, "info short.pts", &["claims 3 points in line 1, but has 2"]);
    save(f, "grid.asc", "ncols 2\nnrows 2\nxllcorner 0\n1 2\n3 4\n");
    fails(f, 1, "info grid.asc", &["ESRI ASCII", "convert it to x,y,z"]);
    // A file with the content of a volume is one, with any name.
    assert!(!walpha::points::is_point_file(&save(f, "v.txt", "NRRD0004\n")).unwrap());
}

#[test]
fn the_format_may_be_said() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for name in ["a.dat", "a.csv", "a"] {
        save(f, name, "1 2 3\n4 5 6\n7 8 10\n");
        let told = json(f, &["info", name, "--input-format", "xyz"]);
        assert_eq!(told["count"], 3, "{name}");
    }
    ok(f, &["points", "a.dat", "--input-format", ".XYZ", "-o", "b.csv"]);
    let points = read_points(f.join("b.csv"), None).unwrap();
    assert_eq!(points.positions[2], [7.0, 8.0, 10.0]);
    // Each end has its own.
    let mut both = Command::new(env!("CARGO_BIN_EXE_walpha"));
    both.args(["points", "-", "--input-format", "xyz", "-o", "-", "--output-format", "csv"]);
    let done = both.stdin(std::fs::File::open(f.join("a.dat")).unwrap()).output().unwrap();
    assert_eq!(done.stdout, std::fs::read(f.join("b.csv")).unwrap());
    save(f, "a.ply", super::files::PLY.to_owned() + "2 0 1\n1 2 3 0 7\n4 5 6 0 8\n");
    fails(
        f,
        1,
        "info a.ply --input-format xyz",
        &["like a file of the format PLY", "omit --input-format"],
    );
    save(f, "v.nrrd", "NRRD0004\n");
    fails(
        f,
        1,
        "info v.nrrd --input-format mha",
        &["is of the format NRRD", "omit --input-format"],
    );
    fails(f, 2, "info a.dat --input-format foo", &["no format that is read", "xyz"]);
}

#[test]
fn extended_xyz_states_columns_and_a_cell() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let text = |comment: &str| format!("2\n{comment}\nC 1 2 3 0.5\nH 4 5 6 7\n");
    let properties = "Properties=species:S:1:pos:R:3:value:R:1";
    let read = |comment: &str| {
        let path = save(f, "e.xyz", text(comment));
        read_model(&path, &PointOptions::default())
    };
    let lattice = "Lattice=\"10.0 0 0 0 20 0 0 0 30\"";
    let (points, facts) = read(&format!("{lattice} {properties} pbc=\"T T T\"")).unwrap();
    assert_eq!((points.positions.as_slice(), points.values), (&PLACES[..], Some(vec![0.5, 7.0])));
    assert_eq!(facts.cell.unwrap().sides(), Some([10.0, 20.0, 30.0]));
    // Without Properties the second word is x, and the words after z are skipped.
    let (points, facts) = read(&format!("a title {lattice}")).unwrap();
    assert_eq!((points.positions.as_slice(), points.values), (&PLACES[..], None));
    assert!(facts.cell.is_some());
    let told = ok(f, &["info", "e.xyz"]);
    names(&told, &["sides 10,20,30", "--periodic cell makes points repeat"]);
    let facts = json(f, &["info", "e.xyz"]);
    assert_eq!(facts["cell"]["sides"], serde_json::json!([10.0, 20.0, 30.0]));
    assert_eq!(
        read("a title = nothing pbc=\"F F F\" Lattice=\"1 0 0 0 1 0 0 0 1\"").unwrap().1.cell,
        None
    );
    assert_eq!(read("plain title").unwrap().1.cell, None);
    for (oblique, words) in [
        (
            "Lattice='1 0 0 0.5 1 0 0 0 1'",
            "the vectors (1,0,0), (0.5,1,0), (0,0,1): --periodic cell makes points repeat",
        ),
        (
            "Lattice=\"1 0 0 0 1 0 0 0 1\" pbc=\"T T F\"",
            "a box of sides 1,1,1, repeating along the first and the second: --periodic cell makes points repeat",
        ),
    ] {
        assert_eq!(read(oblique).unwrap().1.cell.unwrap().sides(), None);
        assert!(ok(f, &["info", "e.xyz"]).contains(words), "{words}");
    }
    for (wrong, words) in [
        ("Lattice=\"1 2 3\"", "nine numbers"),
        ("Properties=species:S:1:pos:R", "names, types and numbers"),
        ("Properties=species:S:1:velo:R:3:x:R:1", "without pos:R:3"),
    ] {
        let error = read(wrong).unwrap_err().told();
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn legacy_vtk_files_hold_points() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let head = |version: &str, kind: &str, dataset: &str| {
        format!("# vtk DataFile Version {version}\ntitle\n{kind}\nDATASET {dataset}\n").into_bytes()
    };
    let big = |numbers: &[f32]| numbers.iter().flat_map(|x| x.to_be_bytes()).collect::<Vec<u8>>();
    let places = big(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    let data = |text: &str| text.as_bytes().to_vec();
    let scalars = data("\nPOINT_DATA 2\nSCALARS t float\nLOOKUP_TABLE default\n");
    let cells = |numbers: &[i32]| numbers.iter().flat_map(|x| x.to_be_bytes()).collect::<Vec<u8>>();
    let wide = |numbers: &[i64]| numbers.iter().flat_map(|x| x.to_be_bytes()).collect::<Vec<u8>>();
    let old = [
        head("3.0", "BINARY", "UNSTRUCTURED_GRID"),
        data("POINTS 2 float\n"),
        places.clone(),
        data("\nCELLS 1 3\n"),
        cells(&[2, 0, 1]),
        data("\nCELL_TYPES 1\n"),
        cells(&[3]),
        scalars.clone(),
        big(&[7.0, 8.0]),
        data("\n"),
    ];
    let new = [
        head("5.1", "BINARY", "POLYDATA"),
        data("POINTS 2 float\n"),
        places,
        data("\nMETADATA\nINFORMATION 0\n\nLINES 2 2\nOFFSETS vtktypeint64\n"),
        wide(&[0, 2]),
        data("\nCONNECTIVITY vtktypeint64\n"),
        wide(&[0, 1]),
        scalars,
        big(&[7.0, 8.0]),
        data("\n"),
    ];
    let text = [
        head("2.0", "ASCII", "POLYDATA"),
        data("POINTS 2 double\n1 2 3\n4 5 6\nVERTICES 1 3\n2 0 1\nPOINT_DATA 2\nFIELD f 2\n"),
        data("ids 1 2 int\n3 4\nvalue 1 2 float\n7 8\n"),
    ];
    for (name, bytes) in
        [("old.vtk", old.concat()), ("new.vtk", new.concat()), ("text.vtk", text.concat())]
    {
        let path = save(f, name, bytes);
        assert!(walpha::points::is_point_file(&path).unwrap(), "{name}");
        let points = read_points(&path, None).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(points.positions, PLACES, "{name}");
        assert_eq!((points.values, points.weights), (Some(vec![7.0, 8.0]), None), "{name}");
    }
    let cut = [head("3.0", "BINARY", "POLYDATA"), data("POINTS 2 float\n1234")].concat();
    save(f, "cut.vtk", cut);
    fails(f, 1, "info cut.vtk", &["POINTS of type f32"]);
    save(f, "none.vtk", head("3.0", "ASCII", "POLYDATA"));
    fails(f, 1, "info none.vtk", &["ends before"]);
    save(f, "rect.vtk", head("3.0", "ASCII", "RECTILINEAR_GRID"));
    fails(f, 1, "info rect.vtk", &["RECTILINEAR_GRID"]);
}

#[test]
fn arrays_of_places_alone() {
    let folder = tempfile::tempdir().unwrap();
    let array = ndarray::arr2(&PLACES);
    let mut bytes = Vec::new();
    ndarray_npy::WriteNpyExt::write_npy(&array, &mut bytes).unwrap();
    let points = read_points(save(folder.path(), "p.npy", bytes), None).unwrap();
    assert_eq!((points.positions.as_slice(), points.weights), (&PLACES[..], None));
}

/// Two points of radii 2 and 3, in every format whose columns have names.
fn with_radii() -> Vec<(&'static str, Vec<u8>)> {
    let ply = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
               property float z\nproperty float Radius\nend_header\n1 2 3 2\n4 5 6 3\n";
    let pcd = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z radius\nSIZE 4 4 4 4\nTYPE F F F F\n\
               COUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n\
               1 2 3 2\n4 5 6 3\n";
    let array = |kind: &str, name: &str, components: u8, text: &str| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"ascii\">{text}</DataArray>"
        )
    };
    let vtp = format!(
        "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\" version=\"0.1\" \
         byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\"2\"><Points>{}</Points>\
         <PointData Scalars=\"radius\">{}</PointData></Piece></PolyData></VTKFile>",
        array("Float64", "p", 3, "1 2 3 4 5 6"),
        array("Float64", "radius", 1, "2 3"),
    );
    let extended = "2\nProperties=species:S:1:radius:R:1:pos:R:3 Time=0\nC 2 1 2 3\nH 3 4 5 6\n";
    let legacy = "# vtk DataFile Version 3.0\nballs\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n\
                  1 2 3 4 5 6\nVERTICES 2 4\n1 0\n1 1\nPOINT_DATA 2\nSCALARS radius float 1\n\
                  LOOKUP_TABLE default\n2 3\n";
    [
        ("a.csv", "x,y,z,radius\n1,2,3,2\n4,5,6,3\n"),
        ("a.xyz", "# x y z RADIUS\n1 2 3 2\n4 5 6 3\n"),
        ("b.xyz", extended),
        ("a.ply", ply),
        ("a.pcd", pcd),
        ("a.vtp", &vtp),
        ("a.vtk", legacy),
    ]
    .map(|(name, text)| (name, text.as_bytes().to_vec()))
    .into()
}

#[test]
fn a_radius_is_a_weight_its_square() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in with_radii() {
        let points = read_points(save(folder.path(), name, bytes), None).unwrap();
        assert_eq!(points.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{name}");
        assert_eq!(points.weights, Some(vec![4.0, 9.0]), "{name}");
        assert!(points.of_radii && points.values.is_none(), "{name}");
    }
}

#[test]
fn the_report_says_that_weights_are_squares() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    save(f, "r.csv", "x,y,z,radius\n0,0,0,1\n1,0,0,1\n0,1,0,1\n0,0,1,2\n");
    let told = json(f, &["shape", "r.csv", "--alpha", "0"]);
    assert_eq!(told["weights"]["of_radii"], true);
    assert_eq!(
        (&told["weights"]["min"], &told["weights"]["max"]),
        (&serde_json::json!(1.0), &serde_json::json!(4.0))
    );
    assert_ne!(told["points"]["in_shape"], 0, "balls of their radii are not empty");
    let text = ok(f, &["shape", "r.csv", "--alpha", "0"]);
    assert!(text.contains("column, squares of its radii: 1 to 4 unit²"), "{text}");
    assert!(ok(f, &["info", "r.csv"]).contains("weights   yes, squares of its radii"));
    assert_eq!(json(f, &["info", "r.csv"])["of_radii"], true);
    // Requested options take precedence.
    let told = json(f, &["shape", "r.csv", "--alpha", "1", "--weights", "common=0"]);
    assert_eq!(
        (&told["weights"]["of_radii"], &told["weights"]["max"]),
        (&serde_json::json!(false), &serde_json::json!(0.0))
    );
}

#[test]
fn weights_come_before_radii_and_bad_radii_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    save(f, "both.csv", "x,y,z,radius,weight\n0,0,0,1,5\n1,0,0,1,6\n");
    let points = read_points(f.join("both.csv"), None).unwrap();
    assert_eq!((points.weights, points.of_radii), (Some(vec![5.0, 6.0]), false));
    let told = json(f, &["info", "both.csv"]);
    names(told["warnings"][0].as_str().unwrap(), &["both.csv", "radii", "weights are taken"]);
    for bad in ["-1", "1e200"] {
        let path = save(f, "bad.csv", format!("x,y,z,radius\n0,0,0,1\n1,0,0,{bad}\n"));
        let error = read_points(&path, None).unwrap_err().told();
        assert!(error.contains("row 1: radius is") && error.contains("from 0 up"), "{error}");
    }
}

#[test]
fn coordinates_of_maps_are_x_y_z() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let places = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    for text in [
        "Easting,Northing,Height\n1,2,3\n4,5,6\n",
        "id,NORTHING,EASTING,elevation\n7,2,1,3\n8,5,4,6\n",
        "x,y,altitude\n1,2,3\n4,5,6\n",
        "height,x,y,z\n9,1,2,3\n9,4,5,6\n",
    ] {
        assert_eq!(read_points(save(f, "m.csv", text), None).unwrap().positions, places, "{text}");
    }
    save(f, "lon.csv", "lon,lat,height\n1,2,3\n4,5,6\n");
    fails(f, 1, "info lon.csv", &["which are angles, not lengths", "UTM"]);
    save(f, "two.csv", "easting,northing,height,elevation\n1,2,3,4\n");
    fails(f, 1, "info two.csv", &["name z twice"]);
}

/// Quotes are at the ends of a field, and doubled within it.
#[test]
fn quotes_are_those_of_csv() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let quoted = "x,y,z,\"c\"\"d\",\"e,f\"\n0,0,0,1,2\n1,0,0,3,4\n0,1,0,5,6\n0,0,1,7,8\n";
    save(f, "a.csv", quoted);
    for (from, to) in [("a.csv", "b.csv"), ("b.csv", "c.csv")] {
        let columns = json(f, &["info", from])["columns"].clone();
        let names: Vec<&String> = columns.as_object().unwrap().keys().collect();
        assert_eq!(names, ["c\"d", "e,f"], "{from}");
        ok(f, &["points", from, "-o", to]);
    }
    save(f, "inch.csv", "name,x,y,z\n5\" pipe,0,0,0\n3\" pipe,1,0,0\n");
    assert_eq!(json(f, &["info", "inch.csv"])["count"], 2);
}

/// Points are rows.
#[test]
fn transposed_arrays_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let array = ndarray::Array2::from_shape_fn((3, 1000), |(axis, k)| (axis * k) as f64);
    ndarray_npy::write_npy(f.join("t.npy"), &array).unwrap();
    let (code, _, stderr) = run(f, &["info", "t.npy"]);
    assert!(code == 1 && stderr.len() < 400, "{stderr}");
    names(&stderr, &["3 rows of 1000 numbers", "a.T"]);
}
