//! Points in a plane as polygons: files for geographic programs and browsers, the report, and what is refused.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::common::{fails, json as told, names, ok, run};

/// A square of 5×5 small squares of side 1/3 without the middle 3×3, except for the halves at their corners, and an isolated edge
/// and point far away, as a table. Coordinates are not short decimals, and z has this value.
fn table(folder: &Path, name: &str, z: Option<f64>) -> Vec<[f64; 2]> {
    let square = (0..36).map(|i| [i % 6, i / 6]).filter(|p| !p.iter().all(|x| (2..4).contains(x)));
    let mut points: Vec<[f64; 2]> = square.map(|p| p.map(|x| f64::from(x) / 3.0)).collect();
    points.extend([[5.0, 0.1], [5.0 + 1.0 / 3.0, 0.1], [-4.0, 1e-17]]);
    let header = if z.is_some() { "x,y,z\n" } else { "x,y\n" };
    let row =
        |[x, y]: &[f64; 2]| format!("{x},{y}{}\n", z.map_or(String::new(), |z| format!(",{z}")));
    fs::write(folder.join(name), header.to_owned() + &points.iter().map(row).collect::<String>())
        .unwrap();
    points
}

/// α at which squares of side 1/3 are filled, and larger ones are not.
const ALPHA: &str = "0.06";

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

/// Twice the area within a closed ring.
fn twice_area(ring: &Value) -> f64 {
    let places: Vec<Vec<f64>> = serde_json::from_value(ring.clone()).unwrap();
    assert_eq!(places.first(), places.last(), "closed");
    places.windows(2).map(|pair| pair[0][0] * pair[1][1] - pair[0][1] * pair[1][0]).sum()
}

#[test]
fn one_command_makes_polygons_of_points() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let points = table(f, "points.csv", None);
    let args = ["shape", "points.csv", "--alpha", ALPHA, "-o"];
    let files = ["outline.geojson", "outline.wkt", "outline.svg"];
    let report = told(f, &[&args[..], &files].concat());
    let close = |value: &Value, wanted: f64| (value.as_f64().unwrap() - wanted).abs() < 1e-12;

    let plane = &report["shape"]["plane"];
    assert_eq!((&plane["polygons"], &plane["holes"]), (&json!(1), &json!(1)));
    assert_eq!(plane["facets"], json!({"interior": 36, "regular": 0, "singular": 0}));
    assert_eq!(plane["edges"], json!({"interior": 40, "regular": 28, "singular": 1}));
    assert_eq!(plane["vertices"], json!({"interior": 4, "regular": 30, "singular": 1}));
    assert!(close(&plane["area"], 18.0 / 9.0), "{plane}");
    let perimeter = (24.0 + 4.0 * 2f64.sqrt()) / 3.0;
    assert!(close(&plane["perimeter"], perimeter), "{plane}");
    // Classes of space are there, too.
    assert_eq!(report["shape"]["facets"]["singular"], 36);

    let made: Value = serde_json::from_str(&read(f, "outline.geojson")).unwrap();
    assert_eq!(made["type"], "FeatureCollection");
    let [polygons, edges, lone] = made["features"].as_array().unwrap().as_slice() else {
        panic!("three features: {made}")
    };
    assert!([polygons, edges, lone].iter().all(|feature| feature["type"] == "Feature"));
    let properties = &polygons["properties"];
    assert_eq!((&properties["part"], &properties["unit"]), (&json!("polygon"), &json!("unit")));
    assert_eq!(properties["alpha"], 0.06);
    assert!(close(&properties["area"], 18.0 / 9.0) && close(&properties["perimeter"], perimeter));
    assert_eq!(polygons["geometry"]["type"], "Polygon");
    let [outer, hole] = polygons["geometry"]["coordinates"].as_array().unwrap().as_slice() else {
        panic!("one hole")
    };
    assert!((twice_area(outer) - 50.0 / 9.0).abs() < 1e-12, "counter-clockwise");
    assert!((twice_area(hole) + 14.0 / 9.0).abs() < 1e-12, "clockwise");
    // The same doubles, without z.
    let places = |value: &Value| serde_json::from_value::<Vec<[f64; 2]>>(value.clone()).unwrap();
    assert!(places(outer).iter().chain(&places(hole)).all(|place| points.contains(place)));
    assert_eq!(edges["geometry"]["type"], "MultiLineString");
    assert_eq!(edges["geometry"]["coordinates"], json!([[points[32], points[33]]]));
    let alone = json!({"type": "MultiPoint", "coordinates": [points[34]]});
    assert_eq!(lone["geometry"], alone);

    let wkt = read(f, "outline.wkt");
    let ring = |ring: &Value| {
        let places: Vec<String> = places(ring).iter().map(|[x, y]| format!("{x} {y}")).collect();
        places.join(", ")
    };
    let polygon = format!("MULTIPOLYGON ((({}), ({})))", ring(outer), ring(hole));
    let [[ax, ay], [bx, by], [x, y]] = [points[32], points[33], points[34]];
    let line = format!("MULTILINESTRING (({ax} {ay}, {bx} {by}))");
    assert_eq!(wkt, format!("GEOMETRYCOLLECTION ({polygon}, {line}, MULTIPOINT (({x} {y})))\n"));

    let svg = read(f, "outline.svg");
    let path = |ring: &Value| {
        let mut places = places(ring);
        places.pop();
        let steps = places.iter().map(|&[x, y]| format!("{x} {}", 0.0 - y));
        format!("M{}Z", steps.collect::<Vec<_>>().join("L"))
    };
    names(
        &svg,
        &[
            r#"xmlns="http://www.w3.org/2000/svg""#,
            r#"fill-rule="evenodd""#,
            &format!(r#"<path d="{}{}"/>"#, path(outer), path(hole)),
            &format!(r#"d="M{ax} {}L{bx} {}"/>"#, -ay, -by),
            &format!(r#"<circle cx="{x}" cy="{}""#, 0.0 - y),
        ],
    );
    // All of it is visible.
    let (_, rest) = svg.split_once("viewBox=\"").unwrap();
    let view: Vec<f64> =
        rest.split('"').next().unwrap().split(' ').map(|x| x.parse().unwrap()).collect();
    for [x, y] in points {
        assert!(view[0] < x && x < view[0] + view[2]);
        assert!(view[1] < -y && -y < view[1] + view[3]);
    }
}

#[test]
fn text_reports_say_that_points_are_in_a_plane() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    table(f, "points.csv", Some(2.0));
    let text = ok(f, &["shape", "points.csv", "--alpha", ALPHA]);
    names(&text, &["in a plane: 1 polygon with 1 hole, area 2 unit², perimeter 9.886 unit\n"]);
    names(&text, &["loose     1 edge, 1 point: part of no triangle\n"]);
    assert!(!text.contains("volume") && !text.contains("cell"), "{text}");
    let text = ok(f, &["shape", "points.csv", "--alpha", ALPHA, "--verbose"]);
    names(&text, &["plane     ", "36 interior         0 regular", "1 polygon with 1 hole"]);
    assert!(!text.contains("volume") && !text.contains("cells"), "{text}");
}

/// Files have z unless it is 0; there is a warning about a vertical plane.
#[test]
fn planes_in_space() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for (z, has_z) in [(0.0, false), (-0.25, true)] {
        table(f, "points.csv", Some(z));
        ok(f, &["shape", "points.csv", "--alpha", ALPHA, "-o", "a.geojson", "a.wkt"]);
        let wkt = read(f, "a.wkt");
        assert_eq!(wkt.starts_with("GEOMETRYCOLLECTION Z (MULTIPOLYGON Z (((0 0 -0.25, "), has_z);
        assert_eq!(wkt.starts_with("GEOMETRYCOLLECTION (MULTIPOLYGON (((0 0, "), !has_z);
        let made: Value = serde_json::from_str(&read(f, "a.geojson")).unwrap();
        let place = &made["features"][0]["geometry"]["coordinates"][0][0];
        assert_eq!(*place, if has_z { json!([0.0, 0.0, -0.25]) } else { json!([0.0, 0.0]) });
    }
    fs::write(f.join("wall.csv"), "x,y,z\n0,1,0\n2,1,0\n0,1,3\n2,1,3\n").unwrap();
    let args = ["shape", "wall.csv", "--alpha", "inf", "-o", "w.wkt", "w.svg"];
    let (code, _, said) = run(f, &args);
    assert_eq!(code, 0);
    names(&said, &["w.wkt: the plane is vertical"]);
    assert!(!said.contains("w.svg"), "{said}");
    assert_eq!(read(f, "w.wkt"), "MULTIPOLYGON Z (((0 1 0, 2 1 0, 2 1 3, 0 1 3, 0 1 0)))\n");
    names(&read(f, "w.svg"), &[r#"<path d="M0 0L2 0L2 -3L0 -3Z"/>"#]);
}

#[test]
fn empty_shapes_have_empty_files() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    table(f, "points.csv", None);
    let empty = ["shape", "points.csv", "--alpha", "-1", "--allow-empty", "-o"];
    ok(f, &[&empty[..], &["a.geojson", "a.wkt", "a.svg"]].concat());
    assert_eq!(read(f, "a.wkt"), "MULTIPOLYGON EMPTY\n");
    let made: Value = serde_json::from_str(&read(f, "a.geojson")).unwrap();
    assert_eq!(made["features"], json!([]));
    assert!(!read(f, "a.svg").contains("<path"));
}

/// Before the work, and before anything is written.
#[test]
fn what_has_no_outline_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    table(f, "points.csv", None);
    let cube: String = (0..8).map(|i| format!("{} {} {}\n", i & 1, i >> 1 & 1, i >> 2)).collect();
    fs::write(f.join("cube.xyz"), cube).unwrap();
    fs::write(f.join("line.csv"), "x,y\n0,0\n1,1\n3,3\n").unwrap();
    for extension in ["geojson", "wkt", "svg"] {
        let volume = format!("shape cube.xyz -o a.ply a.{extension}");
        fails(f, 1, &volume, &["needs an outline: the points span a volume", "boundary"]);
    }
    // For a volume it is known after its points are selected.
    let volume = "shape sample:phantom@8 --count 20 -o a.svg";
    fails(f, 1, volume, &["SVG needs an outline: the points span a volume"]);
    fails(f, 1, "shape line.csv -o a.wkt", &["WKT needs an outline: the points lie on one line"]);
    fails(f, 1, "ladder cube.xyz --mesh geojson -o out", &["GeoJSON needs an outline"]);
    let periodic = "shape points.csv --alpha 0.01 --periodic 9,9,9 -o a.svg";
    fails(f, 2, periodic, &["SVG holds the outline of points in a plane", "torus"]);
    fails(f, 2, "shape points.csv --require-3d -o a.geojson", &["GeoJSON", "--require-3d"]);
    let blocks = "shape sample:phantom@8 --alpha 1 -o a.pvtu a.wkt";
    fails(f, 2, blocks, &["WKT holds the outline", "blocks"]);
    let plan =
        ["blocks", "plan", "sample:phantom@8", "--alpha", "1", "--blocks", "2", "-o", "work"];
    ok(f, &plan);
    fails(f, 2, "blocks merge work -o a.geojson", &["GeoJSON holds the outline", "a plan"]);
}

#[test]
fn each_level_of_a_ladder_has_its_outline() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    table(f, "points.csv", None);
    let args =
        ["ladder", "points.csv", "--alphas", "0.06,inf", "--mesh", "wkt,svg", "-o", "levels"];
    ok(f, &args);
    let level = |k: usize, alpha: &str| read(f, &format!("levels/level-{k}-alpha-{alpha}.wkt"));
    names(&level(1, "0.06"), &["MULTIPOLYGON", "MULTILINESTRING", "MULTIPOINT"]);
    assert!(level(2, "inf").starts_with("MULTIPOLYGON ((("), "the hull alone");
    assert!(f.join("levels/level-2-alpha-inf.svg").exists());
}

/// Programs draw SVG in single precision: far from the origin a round number is subtracted, which file and report state.
#[test]
fn svg_is_drawn_near_the_origin() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let draw = |far: f64| {
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        let rows = corners.map(|[x, y]| format!("{},{}\n", x + far, y + far));
        fs::write(f.join("p.csv"), format!("x,y\n{}", rows.concat())).unwrap();
        let report = told(f, &["shape", "p.csv", "--alpha", "1", "-o", "p.svg"]);
        (report["offsets"].clone(), fs::read_to_string(f.join("p.svg")).unwrap())
    };
    let (offsets, near) = draw(0.0);
    assert!(offsets.as_array().is_none_or(Vec::is_empty) && !near.contains("OFFSET"), "{offsets}");
    let (offsets, far) = draw(1e8);
    assert_eq!(offsets, json!([{ "file": "p.svg", "offset": [1e8, 1e8, 0.0] }]));
    assert_eq!(far.replace("<desc>OFFSET=100000000,100000000,0</desc>\n", ""), near);
}
