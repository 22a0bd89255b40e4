//! Files in single precision, far from the origin.

use std::collections::HashSet;
use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use walpha::points::read_points;

use crate::common::{json, names, ok, run};

/// A roof of points 5 cm apart and its underside, as far from the origin as UTM has them.
fn roof(folder: &Path, at: [f64; 3]) {
    let mut text = String::from("x,y,z\n");
    for low in [0.0, 0.3] {
        for i in 0..400 {
            let (x, y) = (0.05 * f64::from(i % 20), 0.05 * f64::from(i / 20));
            let z = at[2] + 0.2 * (x - 0.5).abs() - low;
            text += &format!("{:.3},{:.3},{z:.3}\n", at[0] + x, at[1] + y);
        }
    }
    fs::write(folder.join("roof.csv"), text).unwrap();
}

const UTM: [f64; 3] = [434_123.4, 5_412_345.6, 412.0];

/// The corners of all facets of a binary STL.
fn corners(bytes: &[u8]) -> Vec<[f32; 3]> {
    let number = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    let corner = |k: usize| 84 + k / 3 * 50 + 12 * (k % 3 + 1);
    (0..3 * count).map(corner).map(|at| [number(at), number(at + 4), number(at + 8)]).collect()
}

/// The document and the binary chunk of a GLB.
fn parts(bytes: &[u8]) -> (Value, &[u8]) {
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    (serde_json::from_slice(&bytes[20..20 + length]).unwrap(), &bytes[28 + length..])
}

/// Number of different places.
fn different<const N: usize>(places: impl IntoIterator<Item = [u32; N]>) -> usize {
    places.into_iter().collect::<HashSet<_>>().len()
}

/// Each vertex stays apart from the others, and is at its place except for rounding, after the offset that file and report state
/// is added.
#[test]
fn an_offset_keeps_vertices_apart() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    roof(f, UTM);
    let report =
        json(f, &["shape", "roof.csv", "--alpha-radius", "0.2", "-o", "r.stl", "r.glb", "r.ply"]);
    let offset = [434_000.0, 5_412_000.0, 0.0];
    let stated = |file: &str| json!({ "file": file, "offset": offset });
    assert_eq!(report["offsets"], json!([stated("r.stl"), stated("r.glb")]));
    let warned = report["warnings"].to_string();
    names(
        &warned,
        &[
            "r.stl: programs read its coordinates in single precision",
            "434000, 5412000, 0 is subtracted",
        ],
    );
    // PLY holds doubles.
    let wanted = read_points(f.join("r.ply"), None).unwrap().positions;
    let near = |found: [f64; 3]| {
        let is_near = |place: &&[f64; 3]| (0..3).all(|k| (place[k] - found[k]).abs() <= 5e-5);
        assert_eq!(wanted.iter().filter(is_near).count(), 1, "{found:?}");
    };
    assert!(wanted.len() > 700, "{}", wanted.len());

    let stl = fs::read(f.join("r.stl")).unwrap();
    assert!(stl.starts_with(b"walpha OFFSET=434000,5412000,0 "), "{:?}", &stl[..80]);
    let found = corners(&stl);
    assert_eq!(different(found.iter().map(|c| c.map(f32::to_bits))), wanted.len());
    found.iter().for_each(|c| near([0, 1, 2].map(|k| offset[k] + f64::from(c[k]))));

    let glb = fs::read(f.join("r.glb")).unwrap();
    let (document, binary) = parts(&glb);
    // The node is rotated so that z points up, which is y there.
    assert_eq!(document["nodes"][0]["translation"], json!([434_000.0, 0.0, -5_412_000.0]));
    let count = document["accessors"][0]["count"].as_u64().unwrap() as usize;
    let floats: Vec<f32> =
        binary[..12 * count].as_chunks::<4>().0.iter().map(|&b| f32::from_le_bytes(b)).collect();
    let places: Vec<[f32; 3]> = floats.as_chunks::<3>().0.to_vec();
    assert_eq!(different(places.iter().map(|c| c.map(f32::to_bits))), wanted.len());
    places.iter().for_each(|c| near([0, 1, 2].map(|k| offset[k] + f64::from(c[k]))));

    let (_, text, said) = run(f, &["shape", "roof.csv", "--alpha-radius", "0.2", "-o", "r.stl"]);
    names(&text, &["offset    434000, 5412000, 0 is subtracted from x, y, z in r.stl"]);
    names(&said, &["r.stl: programs read its coordinates in single precision"]);
}

/// Coordinates that single precision can hold are written without an offset.
#[test]
fn near_the_origin_nothing_is_subtracted() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    roof(f, [0.0; 3]);
    let report = json(f, &["shape", "roof.csv", "--alpha-radius", "0.2", "-o", "r.stl", "r.glb"]);
    assert_eq!((report.get("offsets"), report.get("warnings")), (None, None));
    let stl = fs::read(f.join("r.stl")).unwrap();
    assert!(stl.starts_with(b"walpha, boundary of an alpha shape"));
    assert_eq!(parts(&fs::read(f.join("r.glb")).unwrap()).0["nodes"][0].get("translation"), None);
}

/// Meshes of groups, and those of levels, have one offset, so that they fit together.
#[test]
fn meshes_that_belong_together_have_one_offset() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    // Trees in a row, 700 m apart, across a multiple of 10 km.
    let mut text = String::from("x,y,z,tree\n");
    for (tree, i, j, k) in
        (0..6).flat_map(|tree| (0..64).map(move |n| (tree, n % 4, n / 4 % 4, n / 16)))
    {
        let (x, y) = (
            690_100.0 + 0.3 * f64::from(i),
            5_333_200.0 + 700.0 * f64::from(tree) + 0.3 * f64::from(j),
        );
        text += &format!("{x},{y},{},{tree}\n", 0.3 * f64::from(k));
    }
    fs::write(f.join("trees.csv"), text).unwrap();
    let head = |path: &str| {
        let stl = fs::read(f.join(path)).unwrap();
        String::from_utf8_lossy(&stl[..40]).into_owned()
    };
    let by = ["shape", "trees.csv", "--by", "tree", "--radius", "2", "-o", "out"];
    let (code, report, said) = run(f, &by);
    assert_eq!(code, 0, "{said}");
    let heads: Vec<String> = (0..6).map(|tree| head(&format!("out/tree-{tree}.stl"))).collect();
    assert!(heads[0].starts_with("walpha OFFSET=690000,53"), "{heads:?}");
    assert!(heads.iter().all(|head| *head == heads[0]), "{heads:?}");
    names(&report, &["is subtracted from x, y, z in tree-0.stl and 5 more"]);
    assert_eq!(said.matches("is subtracted").count(), 1, "{said}");
    ok(f, &["ladder", "trees.csv", "--alphas", "1,100000", "--mesh", "stl", "-o", "levels"]);
    assert_eq!(head("levels/level-1-alpha-1.stl"), head("levels/level-2-alpha-100000.stl"));
}

/// Ladders and blocks state it, too; of pages see `view.rs`.
#[test]
fn each_command_states_it() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    roof(f, UTM);
    ok(f, &["ladder", "roof.csv", "--alphas", "0.04,0.09", "--mesh", "stl,glb", "-o", "out"]);
    let report: Value =
        serde_json::from_slice(&fs::read(f.join("out/ladder.json")).unwrap()).unwrap();
    assert_eq!(report["offsets"].as_array().unwrap().len(), 4, "{}", report["offsets"]);
    assert_eq!(report["offsets"][0]["offset"], json!([434_000.0, 5_412_000.0, 0.0]));

    // A volume of 0.05 mm, far away.
    let header = "NRRD0005\ntype: float\ndimension: 3\nsizes: 8 8 8\nspace: LPS\nencoding: raw\nendian: little\n\
                  space directions: (0.05,0,0) (0,0.05,0) (0,0,0.05)\nspace origin: (434123.4,5412345.6,0)\n\n";
    let samples = (0..512).flat_map(|i| (((i * 7919) % 255) as f32).to_le_bytes());
    fs::write(f.join("far.nrrd"), header.bytes().chain(samples).collect::<Vec<u8>>()).unwrap();
    let args = [
        "ladder", "far.nrrd", "--counts", "200", "--alpha", "0.01", "--mesh", "stl", "-o", "detail",
    ];
    ok(f, &args);
    let report: Value =
        serde_json::from_slice(&fs::read(f.join("detail/detail.json")).unwrap()).unwrap();
    assert_eq!(report["levels"][0]["offsets"][0]["file"], "detail-200.stl", "{report}");
    ok(
        f,
        &[
            "blocks", "plan", "far.nrrd", "--count", "200", "--alpha", "0.01", "--blocks", "2",
            "-o", "work",
        ],
    );
    ok(f, &["blocks", "run", "work"]);
    let report = json(f, &["blocks", "merge", "work", "-o", "m.stl"]);
    assert_eq!(report["offsets"][0]["file"], "m.stl");
}
