//! α where nobody gives it.

use super::*;

#[test]
fn alpha_is_found_where_nobody_gives_it() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    // Two cubes of different sizes, and a gap of four between them.
    let corner = |i: u32| [i & 1, i >> 1 & 1, i >> 2].map(f64::from);
    let cubes = [(0.0, 1.0), (5.0, 3.0)];
    let mut text = "x,y,z,value\n".to_owned();
    for (place, side) in cubes {
        for [x, y, z] in (0..8).map(corner) {
            text += &format!("{},{},{},{}\n", place + side * x, side * y, side * z, x + y);
        }
    }
    fs::write(f.join("two.csv"), &text).unwrap();
    let silent = json(f, &["shape", "two.csv"]);
    let asked = json(f, &["shape", "two.csv", "--alpha", "auto"]);
    assert_eq!(silent["alpha"], asked["alpha"]);
    assert_eq!(silent["alpha"]["origin"], "auto");
    assert_eq!(
        (&silent["points"]["in_shape"], &silent["shape"]["betti"][0]),
        (&16.into(), &1.into())
    );
    // It is the smallest: just below it the shape falls apart, or leaves a point out.
    let alpha = silent["alpha"]["squared"].as_f64().unwrap();
    let solid = |alpha: f64| {
        ok(f, &["shape", "two.csv", "--alpha", &alpha.to_string(), "-o", "two.json", "-q"]);
        let made: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(f.join("two.json")).unwrap()).unwrap();
        let cells: Vec<Vec<u64>> = serde_json::from_value(made["cells"].clone()).unwrap();
        let shared = |a: &[u64], b: &[u64]| a.iter().filter(|v| b.contains(v)).count();
        let mut reached = vec![0];
        let mut next = 0;
        while let Some(&cell) = reached.get(next) {
            next += 1;
            for other in 0..cells.len() {
                if shared(&cells[cell], &cells[other]) == 3 && !reached.contains(&other) {
                    reached.push(other);
                }
            }
        }
        let points: std::collections::BTreeSet<&u64> = cells.iter().flatten().collect();
        points.len() == 16 && reached.len() == cells.len()
    };
    assert!(solid(alpha));
    assert!(!solid(alpha.next_down()));
    // The same number, given, gives the same shape; and every command finds it.
    let given = json(f, &["shape", "two.csv", "--alpha", &alpha.to_string()]);
    assert_eq!(given["shape"], silent["shape"]);
    assert_eq!(given["alpha"]["origin"], "given");
    let interpolated = json(f, &["interpolate", "two.csv", "--dims", "3,3,3"]);
    assert_eq!(interpolated["alpha"], silent["alpha"]);
    assert_eq!(run(f, &["check", "two.csv"]).0, 0);
    let weighted = json(f, &["shape", "two.csv", "--weights", "min-max"]);
    assert_eq!(weighted["alpha"]["origin"], "auto-unweighted");
    assert_eq!(
        (&weighted["alpha"]["squared"], &weighted["weights"]["max"]),
        (&alpha.into(), &alpha.into())
    );
    // A volume has a scale of its own.
    let volume = json(f, &["shape", "sample:phantom@8"]);
    assert_eq!(
        (&volume["alpha"]["squared"], &volume["alpha"]["origin"]),
        (&10.0.into(), &"default".into())
    );
    let volume = json(f, &["shape", "sample:phantom@8", "--alpha", "auto"]);
    assert_eq!(volume["alpha"]["squared"], 4.75);
    let skull = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nspacings: 0.25 0.5 1\nencoding: raw\n\n";
    let samples: Vec<u8> = (0..512u32).map(|i| (i * i % 251) as u8).collect();
    fs::write(f.join("v.nrrd"), [skull.as_bytes(), &samples].concat()).unwrap();
    let volume = json(f, &["shape", "v.nrrd", "--units", "world"]);
    assert_eq!(volume["alpha"]["squared"], 2.5, "0.25·0.5·1 is the cube of 0.5");
}
