//! Laser scans: what a file knows about its points, its columns, groups of points, and outlines on the Earth.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use walpha::points::{Attributes, PointOptions, read_model};

use crate::common::{fails, json as told, names, ok, run};

/// Two trees, cubes of 2 m with corners and centre, numbered 7 and 9 in the extra bytes; ground below, which has no number; in
/// UTM zone 32 with heights above sea level.
fn tile(path: &Path) {
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(7).unwrap();
    builder.point_format.extra_bytes = 4;
    builder.point_format.is_compressed = path.extension().is_some_and(|e| e == "laz");
    let transform = las::Transform { scale: 0.01, offset: 0.0 };
    builder.transforms = las::Vector { x: transform, y: transform, z: transform };
    builder.vlrs.push(las::Vlr {
        user_id: "LASF_Projection".into(),
        record_id: 34735,
        description: String::new(),
        data: [1, 1, 0, 4, 1024, 0, 1, 1, 3072, 0, 1, 25832, 3076, 0, 1, 9001, 4096, 0, 1, 5941]
            .iter()
            .flat_map(|key: &u16| key.to_le_bytes())
            .collect(),
    });
    let mut extra = vec![0; 192];
    (extra[2], extra[3]) = (6, 1);
    extra[4..10].copy_from_slice(b"treeID");
    extra[40..48].copy_from_slice(&(-1i64).to_le_bytes());
    builder.vlrs.push(las::Vlr {
        user_id: "LASF_Spec".into(),
        record_id: 4,
        description: String::new(),
        data: extra,
    });
    let mut writer = las::Writer::from_path(path, builder.into_header().unwrap()).unwrap();
    let mut write = |[x, y, z]: [f64; 3], class: u8, tree: i32| {
        writer
            .write_point(las::Point {
                x: 500_000.0 + x,
                y: 5_500_000.0 + y,
                z,
                intensity: 40 * u16::from(class),
                classification: las::point::Classification::new(class).unwrap(),
                gps_time: Some(f64::from(tree)),
                color: Some(las::Color::new(0xff00, 256, 0)),
                is_overlap: class == 2,
                extra_bytes: tree.to_le_bytes().to_vec(),
                ..las::Point::default()
            })
            .unwrap();
    };
    for (tree, start) in [(9, 20.0), (7, 0.0)] {
        for k in 0..8u8 {
            let corner = [k & 1, k >> 1 & 1, k >> 2].map(|bit| 2.0 * f64::from(bit));
            write([start + corner[0], corner[1], 10.0 + corner[2]], 5, tree);
        }
        write([start + 1.0, 1.0, 11.0], 4, tree);
    }
    for k in 0..9u8 {
        write([f64::from(k % 3) * 10.0, f64::from(k / 3), 1.0], 2, -1);
    }
    writer.close().unwrap();
}

#[test]
fn info_tells_what_a_scan_knows() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for name in ["tile.las", "tile.laz"] {
        tile(&f.join(name));
        let made = told(f, &["info", name]);
        assert_eq!(made["crs"]["epsg"], 25832);
        assert_eq!(made["crs"]["name"], "ETRS89 / UTM zone 32N");
        assert_eq!(made["crs"]["vertical"]["epsg"], 5941);
        assert_eq!(made["unit"], "m");
        assert_eq!(made["classes"], json!({"2": 9, "4": 2, "5": 16}));
        assert_eq!(made["class_names"]["5"], "high vegetation");
        assert_eq!(made["point_format"], 7);
        assert_eq!(made["version"], "1.4");
        assert_eq!(made["compressed"], name == "tile.laz");
        assert_eq!(made["flags"]["overlap"], 9);
        // Times in layers are not decompressed.
        let time = if name == "tile.las" { json!([-1.0, 9.0]) } else { Value::Null };
        assert_eq!(made["time"], time);
        let columns = &made["columns"];
        let tree = json!({"type": "int32", "min": 7.0, "max": 9.0, "missing": 9});
        assert_eq!(columns["treeID"], tree);
        assert_eq!(columns["intensity"]["max"], 200.0);
        let text = ok(f, &["info", name]);
        names(&text, &["ETRS89 / UTM zone 32N (EPSG:25832)", "5 (high vegetation): 16"]);
        names(&text, &["treeID: int32, 7 to 9, none for 9 points", "unit      m", "overlap 9"]);
    }
    let table = "x,y,z,label,species\n0,0,0,1,oak\n1,0,0,2,ash\n0,1,0,2,ash\n0,0,1,1,ash\n";
    fs::write(f.join("t.csv"), table).unwrap();
    let columns = &told(f, &["info", "t.csv"])["columns"];
    assert_eq!(columns.as_object().unwrap().keys().collect::<Vec<_>>(), ["label"]);
    assert_eq!(columns["label"]["max"], 2.0);
}

/// Longitude and latitude are refused for a shape, and described by `info`.
#[test]
fn angles_are_described() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    tile(&f.join("tile.las"));
    let mut bytes = fs::read(f.join("tile.las")).unwrap();
    let projected: Vec<u8> = [1024u16, 0, 1, 1, 3072, 0, 1, 25832].map(u16::to_le_bytes).concat();
    let place = bytes.windows(16).position(|at| at == projected).unwrap();
    let angles = [1024u16, 0, 1, 2, 2048, 0, 1, 4326].map(u16::to_le_bytes).concat();
    bytes[place..place + 16].copy_from_slice(&angles);
    fs::write(f.join("tile.las"), bytes).unwrap();
    let made = told(f, &["info", "tile.las"]);
    assert_eq!((&made["crs"]["epsg"], &made["unit"]), (&json!(4326), &json!("degree")));
    assert_eq!(made["crs"]["name"], "WGS 84");
    fails(f, 1, "shape tile.las", &["longitude and latitude"]);
}

#[test]
fn columns_are_read_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    tile(&f.join("tile.laz"));
    let attributes = Attributes::Named(vec!["treeid".into(), "class".into()]);
    let options = PointOptions::default().attributes(attributes).classes(Some(vec![4, 2]));
    let (points, _) = read_model(f.join("tile.laz"), &options).unwrap();
    assert_eq!(points.len(), 11);
    let trees = points.column("treeID").unwrap();
    assert_eq!(trees[..2], [9.0, 7.0]);
    assert!(trees[2..].iter().all(|tree| tree.is_nan()));
    assert_eq!(points.column("classification").unwrap()[1..3], [4.0, 2.0]);
    assert_eq!(points.columns.len(), 2);
    // F is the intensity, unless a column is named.
    let values = |value: &[&str]| {
        ok(f, &[&["points", "tile.laz", "-o", "-", "--output-format", "csv"], value].concat())
    };
    names(&values(&[]), &["500020,5500000,10,0,200"]);
    names(&values(&["--value", "height"]), &["500020,5500000,10,0,10"]);
    names(&values(&["--value", "red"]), &["500020,5500000,10,0,65280"]);
    fails(f, 1, "points tile.laz --value nope", &["no column nope", "treeID", "intensity"]);
    fails(f, 1, "points tile.laz --value treeID", &["must be a finite number"]);
    fails(f, 2, "points sample:phantom@8 --value height", &["--value", "a volume"]);
    let classes = ["class 6 (building)", "2 (ground), 4 (medium vegetation), 5 (high vegetation)"];
    fails(f, 1, "points tile.laz --class building", &classes);
}

/// Meshes carry the columns.
#[test]
fn meshes_carry_columns() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    tile(&f.join("tile.las"));
    let class = ["shape", "tile.las", "--class", "4,5", "--alpha", "3"];
    ok(f, &[&class[..], &["-o", "t.ply", "t.vtu", "t.vtp", "--ascii"]].concat());
    let ply = fs::read_to_string(f.join("t.ply")).unwrap();
    names(&ply, &["property double treeID\n", "property double file_red\n"]);
    for name in ["t.vtu", "t.vtp"] {
        let bytes = fs::read(f.join(name)).unwrap();
        names(&String::from_utf8_lossy(&bytes), &["Name=\"treeID\"", "Name=\"classification\""]);
    }
    // The columns of a mesh are read like any others.
    for (name, red) in [("t.ply", "file_red"), ("t.vtu", "red")] {
        let columns = &told(f, &["info", name])["columns"];
        let tree = &columns["treeID"];
        assert_eq!((&tree["min"], &tree["max"]), (&json!(7.0), &json!(9.0)), "{name}");
        assert_eq!(columns[red]["min"], 65280.0);
    }
}

/// A shape for each tree, at one α: a table, crowns on the Earth, and meshes.
#[test]
fn each_value_of_a_column_has_its_shape() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    tile(&f.join("tile.laz"));
    let by = ["shape", "tile.laz", "--by", "treeID", "--alpha-radius", "2"];
    let outputs = ["-o", "trees.csv", "crowns.geojson", "trees"];
    let made = told(f, &[&by[..], &outputs].concat());
    assert_eq!((&made["points"], &made["left_out"]), (&json!(27), &json!(9)));
    assert_eq!((&made["volume"], &made["alpha"]["squared"]), (&json!(16.0), &json!(4.0)));
    let table = fs::read_to_string(f.join("trees.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(
        lines[0],
        "treeID,points,alpha,volume,area,height,outline_area,outline_perimeter,xmin,ymin,zmin,xmax,ymax,zmax"
    );
    assert_eq!(
        lines[1],
        "7,9,4.0,8.0,24.0,2.0,4.0,8.0,500000.0,5500000.0,10.0,500002.0,5500002.0,12.0"
    );
    assert!(lines[2].starts_with("9,9,4.0,8.0,24.0,2.0,4.0,8.0,500020.0"), "{table}");
    assert_eq!(lines.len(), 3);
    let crowns: Value =
        serde_json::from_slice(&fs::read(f.join("crowns.geojson")).unwrap()).unwrap();
    let [first, second] = crowns["features"].as_array().unwrap().as_slice() else { panic!() };
    assert_eq!(
        (&first["properties"]["treeID"], &first["properties"]["volume"]),
        (&json!(7), &json!(8.0))
    );
    assert_eq!(first["geometry"]["type"], "MultiPolygon");
    // Zone 32 has its central meridian at 9°, where x is 500 km; the latitude is PROJ's.
    let place = first["geometry"]["coordinates"][0][0][0].as_array().unwrap();
    let [x, y] = [0, 1].map(|k| place[k].as_f64().unwrap());
    assert!((x - 9.0).abs() < 1e-9 && (y - 49.652_542_923_6).abs() < 1e-9, "{x} {y}");
    assert_eq!(second["properties"]["treeID"], 9);
    for name in ["treeID-7.stl", "treeID-9.stl"] {
        assert!(f.join("trees").join(name).exists(), "{name}");
    }
    names(&ok(f, &by), &["group     7: 9 points, 8 m³", "9 have no treeID", "the same for all"]);
    // Without an α, that of all points; classes are groups, too, and so are columns of a table.
    let found = told(f, &["shape", "tile.laz", "--by", "class"]);
    assert_eq!(found["groups"].as_array().unwrap().len(), 3);
    assert_eq!(found["alpha"]["origin"], "auto");
    let rows = "x,y,z,label,size\n0,0,0,1,.5\n1,0,0,1,2\n0,1,0,1,2\n0,0,1,1,2\n5,5,5,2,2\n";
    fs::write(f.join("t.csv"), rows).unwrap();
    let table = told(f, &["shape", "t.csv", "--by", "label", "--alpha", "inf"]);
    assert_eq!(table["groups"][0]["volume"], json!(1.0 / 6.0));
    assert_eq!(
        (&table["groups"][1]["points"], &table["groups"][1]["volume"]),
        (&json!(1), &json!(0.0))
    );
    fails(f, 1, "shape t.csv --by nope", &["no column nope", "x, y, z, label, size"]);
    fails(f, 1, "shape t.csv --by size", &["has 0.5 at point 0, and 1 numbers"]);
    fails(f, 2, "shape t.csv --by label -o t.ply", &["makes a shape for each value", ".geojson"]);
    fails(f, 2, "shape t.csv --by label --mesh ply -o t2.csv", &["--mesh has no effect"]);
    fails(f, 2, "shape sample:phantom@8 --by label", &["holds a volume", "--each-label"]);
    fails(f, 2, "shape t.csv --by label --each-label -o x", &["--each-label"]);
}

/// Each polygon is a feature, in longitude and latitude, and points of space are seen from above.
#[test]
fn outlines_lie_on_the_earth() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    tile(&f.join("tile.laz"));
    let args = ["shape", "tile.laz", "--class", "4,5", "--flat", "--alpha-radius", "2", "-o"];
    let (code, _, said) = run(f, &[&args[..], &["a.geojson", "a.wkt"]].concat());
    assert_eq!(code, 0, "{said}");
    assert!(!said.contains("coordinates are those"), "{said}");
    let made: Value = serde_json::from_slice(&fs::read(f.join("a.geojson")).unwrap()).unwrap();
    let [first, second] = made["features"].as_array().unwrap().as_slice() else { panic!("{made}") };
    for feature in [first, second] {
        assert_eq!(feature["geometry"]["type"], "Polygon");
        let properties = &feature["properties"];
        assert_eq!((&properties["area"], &properties["perimeter"]), (&json!(4.0), &json!(8.0)));
        assert_eq!(properties["unit"], "m");
        assert_eq!(feature["geometry"]["coordinates"][0][0].as_array().unwrap().len(), 2);
    }
    names(&fs::read_to_string(f.join("a.wkt")).unwrap(), &["500020 5500000"]);
    fs::write(f.join("t.csv"), "x,y\n0,0\n1,0\n0,1\n").unwrap();
    let (_, _, said) = run(f, &["shape", "t.csv", "--alpha", "inf", "-o", "t.geojson"]);
    names(&said, &["coordinates are those of the points, as their coordinate system is not known"]);
    fails(f, 2, "shape sample:phantom@8 --flat -o a.svg", &["--flat has no effect"]);
}

/// Scans are coloured by class, tables are plain.
#[test]
#[cfg(feature = "render")]
fn pictures_of_scans_have_colours() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    tile(&f.join("tile.laz"));
    let picture = |colour: &[&str]| {
        let args = ["shape", "tile.laz", "--alpha", "9", "--size", "80x60", "-o", "a.png"];
        ok(f, &[&args[..], colour].concat());
        let picture = image::open(f.join("a.png")).unwrap().to_rgb8();
        picture.pixels().map(|pixel| pixel.0).collect::<Vec<_>>()
    };
    let default = picture(&[]);
    assert_eq!(default, picture(&["--colour", "asprs"]));
    // High vegetation is green, and the scan is red.
    assert!(default.iter().any(|[r, g, b]| *g > r + 30 && *g > b + 30));
    assert!(picture(&["--colour", "rgb"]).iter().any(|[r, g, b]| *r > g + 60 && *r > b + 60));
    assert_ne!(picture(&["--colour", "height"]), picture(&["--colour", "plain"]));
    fs::write(f.join("t.csv"), "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n").unwrap();
    fails(f, 1, "shape t.csv --colour rgb -o t.png", &["no column red"]);
}
