//! Columns of names that say what they are: radii, and coordinates of maps.

use walpha::points::read_points;

use super::files::save;
use crate::common::told::Told;
use crate::common::{fails, json, names, ok};

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
        let points = read_points(&save(folder.path(), name, bytes), None).unwrap();
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
    assert!(text.contains("column, squares of its radii: min 1"), "{text}");
    assert!(ok(f, &["info", "r.csv"]).contains("weights   yes, squares of its radii"));
    assert_eq!(json(f, &["info", "r.csv"])["of_radii"], true);
    // What is asked for comes first.
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
    let points = read_points(&f.join("both.csv"), None).unwrap();
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
        assert_eq!(read_points(&save(f, "m.csv", text), None).unwrap().positions, places, "{text}");
    }
    save(f, "lon.csv", "lon,lat,height\n1,2,3\n4,5,6\n");
    fails(f, 1, "info lon.csv", &["which are angles and no lengths", "UTM"]);
    save(f, "two.csv", "easting,northing,height,elevation\n1,2,3,4\n");
    fails(f, 1, "info two.csv", &["name z twice"]);
}
