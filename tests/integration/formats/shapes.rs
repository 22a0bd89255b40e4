//! Scattered values: how they differ, and weights from them.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{Cursor, Read};
use std::path::Path;

use walpha::export::{ExportOptions, Format};
use walpha::points::{PointsError, WeightedPoints, read_points, scattered_difference};
use walpha::shape::{Alpha, ShapeOptions, alpha_shape};
use walpha::{Coordinates, LengthUnit, Points};

use super::files::save;
use crate::common::{self, Told};

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
        let weights = read_points(folder.path().join("w.csv"), None).unwrap().weights.unwrap();
        assert!(weights.iter().any(|&w| w > 0.0));
    }
    save(folder.path(), "bare.csv", text.replace("value", "other"));
    let (code, _, said) =
        common::run(folder.path(), &["points", "bare.csv", "--weights", "min-max"]);
    assert!(code == 1 && said.contains("column `value`"), "{said}");
}

fn shape() -> walpha::AlphaShape {
    let Points { positions, values, .. } = scattered();
    let points = WeightedPoints::unweighted(positions).with_values(values.unwrap()).unwrap();
    alpha_shape(points, &ShapeOptions::new(Alpha::from_squared(f64::INFINITY).unwrap())).unwrap()
}

fn format(extension: &str) -> &'static Format {
    Format::of(Path::new(&format!("s.{extension}"))).unwrap()
}

fn exported(extension: &str, shape: &walpha::AlphaShape) -> Vec<u8> {
    let mut bytes = Vec::new();
    format(extension).exporter(&ExportOptions::default()).write(shape, &mut bytes).unwrap();
    bytes
}

/// The hull of a tetrahedron with a point inside: four facets, no point of them the inner one.
#[test]
fn written_shapes_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let shape = shape();
    for (extension, corners) in [("ply", 4), ("vtp", 4), ("vtu", 5)] {
        let path = save(folder.path(), &format!("s.{extension}"), exported(extension, &shape));
        let back = read_points(&path, None).unwrap();
        assert_eq!(back.positions, shape.points().positions()[..corners], "{extension}");
        assert_eq!(back.values.unwrap(), [1.0, 2.0, 3.0, 5.0, 10.0][..corners], "{extension}");
        assert_eq!(back.weights, Some(vec![0.0; corners]), "{extension}");
    }

    let stl = exported("stl", &shape);
    assert_eq!(stl.len(), 84 + 4 * 50);
    assert_eq!(stl[80..84], 4u32.to_le_bytes());
    let number = |place: usize| f32::from_le_bytes(stl[place..place + 4].try_into().unwrap());
    let mut volume = 0.0;
    for facet in 0..4 {
        let vector = |v: usize| [0, 1, 2].map(|c| number(84 + 50 * facet + 12 * v + 4 * c));
        let [n, a, b, c] = [0, 1, 2, 3].map(vector);
        let cross = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        volume += (a[0] * cross(1, 2) + a[1] * cross(2, 0) + a[2] * cross(0, 1)) / 6.0;
        assert!((n.iter().map(|v| v * v).sum::<f32>() - 1.0).abs() < 1e-6);
    }
    assert!((volume - 64.0 / 6.0).abs() < 1e-5, "outward: {volume}");

    let glb = exported("glb", &shape);
    let length =
        |place: usize| u32::from_le_bytes(glb[place..place + 4].try_into().unwrap()) as usize;
    assert_eq!((&glb[..4], length(4), length(8)), (&b"glTF"[..], 2, glb.len()));
    // Keys are in the order of the specification, not of the alphabet, with any features of the build.
    assert!(glb[20..].starts_with(b"{\"asset\":{\"version\""));
    let document: serde_json::Value = serde_json::from_slice(&glb[20..20 + length(12)]).unwrap();
    assert_eq!(document["accessors"][0]["max"], serde_json::json!([4.0, 4.0, 4.0]));
    assert_eq!(document["accessors"][2]["count"], 12);

    let path = save(folder.path(), "s.npz", exported("npz", &shape));
    let mut archive = payloads(&path);
    let cells = archive("cells");
    assert_eq!(cells.len(), shape.complex().cells.len() * 16);
    assert_eq!(archive("cell_classes"), vec![1; 4]);
    assert_eq!(archive("points").len(), 6 * 24);
}

/// The payload of an array of an NPZ archive.
fn payloads(path: &Path) -> impl FnMut(&str) -> Vec<u8> {
    let mut archive = zip::ZipArchive::new(fs::File::open(path).unwrap()).unwrap();
    move |name| {
        let mut bytes = Vec::new();
        let mut member = archive.by_name(&format!("{name}.npy")).unwrap();
        std::io::copy(&mut member, &mut bytes).unwrap();
        let header = u16::from_le_bytes([bytes[8], bytes[9]]) as usize;
        bytes.split_off(10 + header)
    }
}

#[test]
fn stl_says_when_the_boundary_is_no_manifold() {
    assert_eq!(format("stl").exporter(&ExportOptions::default()).remark(&shape()), None);
    // Two tetrahedra that touch at a vertex.
    let folder = tempfile::tempdir().unwrap();
    let text = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n-1 -1 0\n-1 0 -1\n0 -1 -1\n";
    save(folder.path(), "two.xyz", text);
    let args = ["shape", "two.xyz", "--alpha", "0.75", "-o", "two.stl", "two.ply"];
    let (code, _, said) = common::run(folder.path(), &args);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("two.stl: the boundary is not manifold"), "{said}");
    assert!(said.contains("facets: 0,") && said.contains("parts touch: 1;"), "{said}");
    assert!(!said.contains("two.ply"), "{said}");
    let (_, _, said) = common::run(folder.path(), &[&args[..], &["--quiet"]].concat());
    assert_eq!(said, "");
}

fn text(extension: &str, options: &ExportOptions, shape: &walpha::AlphaShape) -> String {
    let mut bytes = Vec::new();
    format(extension).exporter(options).write(shape, &mut bytes).unwrap();
    String::from_utf8_lossy(&bytes).into_owned()
}

#[test]
fn vertices_are_coloured_by_their_values() {
    let shape = shape();
    let options = ExportOptions::default().ascii(true);
    let ply = text("ply", &options, &shape);
    let (head, body) = ply.split_once("end_header\n").unwrap();
    assert!(
        head.contains("property uchar red\nproperty uchar green\nproperty uchar blue\n"),
        "{head}"
    );
    assert!(!head.contains("element edge"), "which meshio, trimesh and others refuse: {head}");
    assert!(head.ends_with("vertex_indices\n"), "meshio reads no numbers of facets: {head}");
    let groups = text("ply", &options.clone().groups(true), &shape);
    assert!(groups.contains("property uchar class\nproperty uint component\nproperty int sheet"));
    // Of the values 1, 2, 3 and 5 on the hull, the smallest is dark and the largest is light.
    let rows: Vec<&str> = body.lines().take(4).collect();
    assert_eq!(rows[0], "0 0 0 0 1 68 1 84 0");
    assert_eq!(rows[3], "0 0 4 0 5 253 231 37 3");
}

#[test]
fn groups_are_made_where_they_are_asked_for() {
    let shape = shape();
    let plain = ExportOptions::default();
    let groups = ExportOptions::default().groups(true);
    assert!(!text("obj", &plain, &shape).contains("\ng "));
    assert!(text("obj", &groups, &shape).contains("\ng regular\nf "));
    let facets = |off: String| {
        off.lines()
            .filter(|line| line.starts_with("3 "))
            .map(|l| l.split(' ').count())
            .collect::<Vec<_>>()
    };
    assert_eq!(facets(text("off", &plain, &shape)), [4; 4]);
    assert_eq!(facets(text("off", &groups, &shape)), [7; 4]);
}

#[test]
fn files_say_how_they_were_made() {
    let shape = shape();
    let options = ExportOptions::default().input("a <file> & \"more\".csv".to_owned());
    let vtp = text("vtp", &options, &shape);
    for word in ["walpha ", "a <file> & \"more\".csv\0", "2 regular, 3 singular\0"] {
        assert!(vtp.contains(word), "{word}");
    }
    for name in ["alpha", "alpha_radius", "made_by", "class_legend", "input"] {
        let named = format!("Name=\"{name}\" NumberOfTuples=");
        assert!(vtp.contains(&named), "{name}");
        assert!(text("vtu", &options, &shape).contains(&named), "{name}");
    }
    let vtu = text("vtu", &options, &shape);
    assert!(!vtu.contains("String"), "which meshio refuses");
    let glb = exported("glb", &shape);
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let document: serde_json::Value = serde_json::from_slice(&glb[20..20 + length]).unwrap();
    // A quarter turn: (x, y, z) becomes (x, z, -y).
    let [x, y, z, w] = [0, 1, 2, 3].map(|k| document["nodes"][0]["rotation"][k].as_f64().unwrap());
    let half = 0.5f64.sqrt();
    assert!((x + half).abs() < 1e-12 && y == 0.0 && z == 0.0 && (w - half).abs() < 1e-12);
}

#[test]
fn the_report_says_where_a_solid_was_cut() {
    let folder = tempfile::tempdir().unwrap();
    let text = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n-1 -1 0\n-1 0 -1\n0 -1 -1\n";
    save(folder.path(), "two.xyz", text);
    let args = ["shape", "two.xyz", "--alpha", "0.75", "--solid", "-o", "two.stl", "two.ply"];
    let said = common::ok(folder.path(), &args);
    assert!(said.contains("cut apart at 0 edges, with 1 more vertices"), "{said}");
    assert!(said.contains("; 1 are moved, by 0.0009766 unit at most"), "{said}");
    let made = common::json(folder.path(), &args);
    let solid = &made["solid"];
    let counts = ["edges", "vertices", "midpoints", "moved", "together"].map(|name| &solid[name]);
    assert_eq!(counts, [0, 1, 0, 1, 0]);
    assert!((solid["largest_move"].as_f64().unwrap() - 1.0 / 1024.0).abs() < 1e-9, "{solid}");
    assert_eq!(read_points(folder.path().join("two.ply"), None).unwrap().len(), 8);
    let (_, _, stderr) = common::run(folder.path(), &args);
    assert!(!stderr.contains("manifold"), "{stderr}");
}

/// The parts of a 3MF file, by their names.
fn parts(bytes: Vec<u8>) -> BTreeMap<String, String> {
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let part = |i| {
        let mut member = archive.by_index(i).unwrap();
        let mut text = String::new();
        member.read_to_string(&mut text).unwrap();
        (member.name().to_owned(), text)
    };
    (0..3).map(part).collect()
}

#[test]
fn a_3mf_is_a_solid_with_its_unit() {
    // Two tetrahedra that touch at a vertex, far from the origin.
    let corners = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, -1, 0], [-1, 0, -1], [0, -1, -1]];
    let far = [434_000.0, 5_412_000.0, 0.0];
    let places = [[0; 3]].iter().chain(&corners);
    let places: Vec<[f64; 3]> =
        places.map(|p| [0, 1, 2].map(|k| far[k] + f64::from(p[k]) / 3.0)).collect();
    let options = ShapeOptions::new(Alpha::from_squared(0.0834).unwrap());
    let shape = alpha_shape(&places, &options).unwrap();
    let exporter = format("3mf").exporter(&ExportOptions::default());
    let write = |shape: &walpha::AlphaShape| {
        let mut bytes = Vec::new();
        exporter.write(shape, &mut bytes).unwrap();
        bytes
    };
    assert_eq!(write(&shape), write(&shape));
    let files = parts(write(&shape));
    let names: Vec<&str> = files.keys().map(String::as_str).collect();
    assert_eq!(names, ["3D/3dmodel.model", "[Content_Types].xml", "_rels/.rels"]);
    assert!(files["_rels/.rels"].contains("Target=\"/3D/3dmodel.model\""));
    let model = &files["3D/3dmodel.model"];
    let vertices: BTreeSet<&str> =
        model.lines().filter(|line| line.starts_with("<vertex ")).collect();
    assert_eq!(vertices.len(), 8, "at different places: {vertices:?}");
    assert_eq!(model.matches("<triangle ").count(), 8);
    let placed = "transform=\"1 0 0 0 1 0 0 0 1 430000 5410000 0\"";
    assert!(model.contains(placed) && model.contains("type=\"model\""), "{model}");
    // A unit that is not known is said to be, and taken for millimetres.
    assert!(model.contains("unit=\"millimeter\""));
    assert!(exporter.remark(&shape).unwrap().to_string().contains("not known"));
    let micrometres = Coordinates { unit: LengthUnit::Micrometre, ..Coordinates::default() };
    let small = shape.with_coordinates(micrometres);
    assert!(parts(write(&small))["3D/3dmodel.model"].contains("unit=\"micron\""));
    assert!(exporter.remark(&small).is_none());
}
