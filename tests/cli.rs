//! The command as a user meets it: results, and bad input of every kind.

mod common;

use std::fs;
use std::path::Path;

use common::{json, ok, run};

/// Runs, expects this exit code, an error that names every word, nothing on standard output, and
/// nothing new in the folder.
fn fails(folder: &Path, code: i32, args: &str, words: &[&str]) {
    let entries = |folder| fs::read_dir(folder).unwrap().count();
    let before = entries(folder);
    let (got, stdout, stderr) = run(folder, &args.split(' ').collect::<Vec<_>>());
    assert_eq!(got, code, "walpha {args}\n{stderr}");
    assert_eq!(stdout, "", "walpha {args}");
    assert!(!stderr.contains("panicked"), "walpha {args}\n{stderr}");
    for word in words {
        assert!(stderr.contains(word), "walpha {args}: no {word:?} in\n{stderr}");
    }
    assert_eq!(entries(folder), before, "walpha {args} left something behind");
}

fn cube() -> String {
    let corner = |i: usize| format!("{},{},{},0,{}\n", i & 1, i >> 1 & 1, i >> 2, 10 * i);
    "x,y,z,weight,value\n".to_owned() + &(0..8).map(corner).collect::<String>()
}

#[test]
fn json_has_what_is_promised() {
    let folder = tempfile::tempdir().unwrap();
    let report = json(folder.path(), &["shape", "sample:phantom@24", "--weights", "min-max"]);
    for path in [
        "/schema_version",
        "/input/dims",
        "/input/gray_range",
        "/haar/kept",
        "/haar/epsilon",
        "/haar/rms",
        "/points/selected",
        "/points/duplicates",
        "/points/hidden",
        "/points/in_shape",
        "/alpha/squared",
        "/alpha/radius",
        "/weights/kind",
        "/weights/min",
        "/weights/mean",
        "/weights/max",
        "/shape/cells/interior",
        "/shape/facets/regular",
        "/shape/edges/singular",
        "/shape/vertices/interior",
        "/shape/betti/2",
        "/shape/volume",
        "/shape/area",
        "/engine",
        "/seconds/total",
        "/peak_memory_bytes",
    ] {
        assert!(report.pointer(path).is_some(), "{path} is missing: {report:#}");
    }
    assert_eq!(report["points"]["selected"], (0.0609f64 * 24.0 * 24.0 * 24.0).round() as u64);
    assert_eq!(report["weights"]["max"], 10.0);
}

#[test]
fn a_cube_of_points_is_a_cube() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.csv"), cube()).unwrap();
    let args = ["shape", "cube.csv", "--weights", "column", "--alpha", "0.75"];
    let report = json(folder.path(), &args);
    assert_eq!(report["shape"]["volume"], 1.0);
    assert_eq!(report["shape"]["area"], 6.0);
    assert_eq!(report["shape"]["betti"], serde_json::json!([1, 0, 0]));
    // The cube's sphere has squared radius 3/4 exactly.
    let args = ["shape", "cube.csv", "--weights", "column", "--alpha", "0.7499999999999999"];
    let report = json(folder.path(), &args);
    assert_eq!(report["shape"]["cells"]["interior"], 0);
    assert_eq!(report["shape"]["betti"], serde_json::json!([1, 0, 1]));
    let hull = json(folder.path(), &["shape", "cube.csv", "--alpha", "inf"]);
    assert_eq!(hull["shape"]["volume"], 1.0);
    assert_eq!(hull["alpha"]["squared"], "inf");
    let empty = json(folder.path(), &["shape", "cube.csv", "--alpha=-1"]);
    assert_eq!(empty["points"]["in_shape"], 0);
    assert_eq!(empty["shape"]["volume"], 0.0);
    let said = ok(folder.path(), &["shape", "cube.csv", "--alpha=-1"]);
    assert!(said.contains("the shape is empty"), "{said}");
}

#[test]
fn both_readings_of_the_balls() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.csv"), cube()).unwrap();
    // A radius of α + 0 = 0.5 is a squared radius of 0.25: edges of length 1 just close.
    let args = ["shape", "cube.csv", "--balls", "radius", "--alpha", "0.5"];
    let radius = json(folder.path(), &args);
    let power = json(folder.path(), &["shape", "cube.csv", "--alpha", "0.25"]);
    assert_eq!(radius["shape"], power["shape"]);
    assert_eq!(power["shape"]["edges"]["singular"], 12);
    fails(
        folder.path(),
        1,
        "shape cube.csv --balls radius --alpha=-1",
        &["radius", "--balls power"],
    );
}

#[test]
fn points_written_are_points_read() {
    let folder = tempfile::tempdir().unwrap();
    let select = ["sample:phantom@24", "--weights", "min-max", "--alpha", "4"];
    let direct = json(folder.path(), &[&["shape"], &select[..]].concat());
    for file in ["p.csv", "p.npy"] {
        ok(folder.path(), &[&["points"], &select[..], &["-o", file]].concat());
        let read = json(folder.path(), &["shape", file, "--alpha", "4"]);
        assert_eq!(read["weights"]["kind"], "column");
        assert_eq!(read["shape"], direct["shape"]);
    }
}

#[test]
fn check_names_a_wrong_simplex() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let make = ["shape", "sample:phantom@12", "--weights", "min-max", "--exterior", "-o", "a.json"];
    ok(f, &make);
    assert!(ok(f, &["check", "a.json"]).contains("certified: no finding"));
    let mut file: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(f.join("a.json")).unwrap()).unwrap();
    let classes = file["classes"]["facets"].as_array_mut().unwrap();
    let at = classes.iter().position(|class| class == "regular").unwrap();
    classes[at] = "interior".into();
    let facet = format!("facet {}", file["facets"][at]).replace(',', ", ");
    fs::write(f.join("b.json"), file.to_string()).unwrap();

    let (code, stdout, _) = run(f, &["check", "b.json"]);
    assert_eq!(code, 3);
    assert!(stdout.contains(&facet) && stdout.contains("1 findings"), "{facet}\n{stdout}");
    let (code, stdout, _) = run(f, &["compare", "a.json", "b.json"]);
    assert_eq!(code, 3);
    assert!(stdout.contains(&facet) && stdout.contains("A Regular, B Interior"), "{stdout}");
    assert!(ok(f, &["compare", "a.json", "a.json"]).contains("equal"));
    // Points may stand in a file of their own.
    ok(f, &["points", "sample:phantom@12", "--weights", "min-max", "-o", "p.csv"]);
    file["points"] = serde_json::json!([]);
    fs::write(f.join("c.json"), file.to_string()).unwrap();
    let (code, _, stderr) = run(f, &["check", "c.json"]);
    assert_eq!(code, 1);
    assert!(stderr.contains("c.json") && stderr.contains("--points"), "{stderr}");
    assert_eq!(run(f, &["check", "c.json", "--points", "p.csv"]).0, 3);
    fails(f, 1, "compare a.json missing.json", &["missing.json"]);
    fails(f, 1, "check sample:phantom@16 --enumerate", &["at most 200 points"]);
    fails(f, 2, "check sample:phantom --points p.csv", &["--points belongs to a complex"]);
    ok(f, &["check", "sample:phantom@12", "--weights", "min-max", "--enumerate", "--count", "50"]);
}

#[test]
fn threads_change_no_byte() {
    let folder = tempfile::tempdir().unwrap();
    for threads in ["1", "2", "5"] {
        let file = format!("{threads}.vtu");
        let args = ["shape", "sample:phantom@24", "--threads", threads, "-o", &file];
        ok(folder.path(), &args);
    }
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("1.vtu"), bytes("2.vtu"));
    assert_eq!(bytes("1.vtu"), bytes("5.vtu"));
}

#[test]
fn usage_errors_exit_with_2() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fails(f, 2, "shap sample:phantom", &["shape"]);
    fails(f, 2, "shape", &["INPUT"]);
    fails(f, 2, "shape sample:phantom --alpha nan", &["α cannot be NaN"]);
    fails(f, 2, "shape sample:phantom --alpha 1 --alpha-radius 1", &["cannot be used with"]);
    fails(f, 2, "shape sample:phantom --alpha-radius=-1", &["radius must not be negative"]);
    fails(f, 2, "shape sample:phantom --rms=-1", &["from 0 up"]);
    fails(f, 2, "shape sample:phantom --count 9 --ratio 0.5", &["cannot be used with"]);
    fails(f, 2, "shape sample:phantom --weights heavy", &["heavy", "barycentric"]);
    fails(f, 2, "shape sample:phantom --gray 9..2", &["LO must be less than HI"]);
    fails(f, 2, "shape a.raw --dims 2,2 --dtype u8", &["three sizes"]);
    fails(f, 2, "shape a.raw --dims 2,0,2 --dtype u8", &["empty"]);
    fails(f, 2, "shape a.raw --dims 2,2,2", &["--dtype"]);
    fails(f, 2, "shape sample:phantom --threads 0", &["--threads"]);
    fails(f, 2, "shape sample:phantom --ratio 2", &["a share above 0 and up to 1"]);
    fails(f, 2, "shape sample:phantom --ratio 0", &["a share above 0 and up to 1"]);
    fails(f, 2, "shape sample:phantom --ratio nan", &["a share above 0 and up to 1"]);
    fails(f, 2, "shape sample:phantom --count 0", &["a count from 1 up"]);
    fails(f, 2, "shape sample:phantom --threshold nan", &["a gray level is needed"]);
    fails(f, 2, "shape sample:phantom --gray-min nan", &["a gray level is needed"]);
    fails(f, 2, "shape sample:phantom -o a.xyz", &["`xyz`", ".ply"]);
    fails(f, 2, "points sample:phantom -o a.ply", &[".csv, .npy"]);
    fails(f, 2, "haar sample:phantom -o a.ply", &[".npy"]);
    fails(f, 2, "view sample:phantom -o a.htm", &["did you mean .html?"]);
}

/// What has no effect on this input, or on these outputs, is refused, and what to do is said.
#[test]
fn no_option_is_without_effect() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::write(f.join("cube.csv"), cube()).unwrap();
    ok(f, &["shape", "cube.csv", "--alpha", "1", "-o", "cube.json", "-q"]);
    let cases = [
        ("shape cube.csv --ratio 0.1", "--ratio has no effect: cube.csv holds points"),
        ("shape cube.csv --rms 1 --units voxel", "--rms, --units have no effect"),
        ("points cube.csv --gray 0..9", "--gray has no effect"),
        ("interpolate cube.csv --dims 4,4,4 --haar standard", "--haar has no effect"),
        ("view cube.csv -o a.html --isovalue 7", "--isovalue has no effect"),
        ("ladder cube.csv -o a --count 9", "--count has no effect"),
        ("shape sample:phantom@8 --columns x,y,z", "--columns has no effect"),
        ("shape sample:phantom@8 --size 9x9 -o a.ply", "no picture (.png) is written"),
        ("shape sample:phantom@8 --ascii -o a.obj", "only PLY has a binary form"),
        ("shape sample:phantom@8 --groups -o a.stl", "only OBJ, OFF and PLY"),
        ("shape sample:phantom@8 --solid -o a.vtu", "no output holds a boundary alone"),
        ("shape sample:phantom@8 --format ply -o a.ply", "--format has no effect"),
        ("shape sample:phantom@8 --engine reference --blocks 2", "--blocks has no effect"),
        ("check cube.json --alpha 1", "--alpha has no effect: cube.json is a complex"),
        ("check cube.json --engine native", "--engine has no effect"),
        ("shape cube.csv --balls radius", "give a number, as in --alpha 0.8"),
    ];
    for (args, words) in cases {
        fails(f, 2, args, &[words]);
    }
    // A file of options is for all inputs.
    fs::write(f.join("walpha.toml"), "ratio = 0.1\n").unwrap();
    ok(f, &["shape", "cube.csv", "--config", "walpha.toml"]);
    assert_eq!(run(f, &["check", "cube.json"]).0, 0);
}

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

#[test]
fn bad_selections_exit_with_1() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fails(f, 1, "shape sample:phantom@8 --count 513", &["from 1 to 512"]);
    let few = "shape sample:phantom@8 --count 3 --dimension 3";
    fails(f, 1, few, &["3 distinct points", "at least 4"]);
    fails(f, 1, "shape sample:phantom@8 --threshold 300", &["none of 512 voxels"]);
    fails(f, 1, "shape sample:phantom@8 --gray-min 300", &["no voxel reaches", "give less"]);
    fails(f, 1, "shape sample:phantom@1 --ratio 1 --dimension 3", &["1 distinct points"]);
    fails(f, 1, "shape sample:phantom@8 --weights column", &["column"]);
    fails(f, 1, "shape sample:phantom@8 --weights min-max --alpha inf", &["proportional to α"]);
}

#[test]
fn bad_points_exit_with_1() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let cases = [
        ("missing.csv", None, "missing.csv"),
        ("empty.csv", Some(""), "x, y and z"),
        ("header.csv", Some("a,b,c\n1,2,3\n"), "x, y and z"),
        ("none.csv", Some("x,y,z\n"), "no point"),
        ("word.csv", Some("x,y,z\n0,0,0\n0,one,0\n"), "line 3, column y"),
        ("nan.csv", Some("x,y,z\n0,0,nan\n"), "line 2, column z"),
        ("three.csv", Some("x,y,z\n0,0,0\n1,0,0\n0,1,0\n"), "3 distinct points"),
        ("equal.csv", Some("x,y,z\n1,1,1\n1,1,1\n1,1,1\n1,1,1\n1,1,1\n"), "1 distinct points"),
        ("line.csv", Some("x,y,z\n0,0,0\n1,1,1\n2,2,2\n3,3,3\n5,5,5\n"), "on one line"),
        ("plane.csv", Some("x,y,z\n0,0,0\n1,0,0\n0,1,0\n1,1,0\n5,2,0\n"), "in one plane"),
        ("huge.csv", Some("x,y,z\n0,0,0\n1,0,0\n0,1,0\n1e200,1,1\n"), "magnitude"),
    ];
    for (name, text, word) in cases {
        if let Some(text) = text {
            fs::write(f.join(name), text).unwrap();
        }
        fails(f, 1, &format!("shape {name} --dimension 3 --alpha 1 -o out.ply"), &[word]);
    }
}

#[test]
fn bad_volumes_exit_with_1() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let header = |x: u64| {
        let mut text = format!(
            "#INRIMAGE-4#{{\nXDIM={x}\nYDIM={x}\nZDIM={x}\nVDIM=1\nTYPE=float\nPIXSIZE=32 bits\nCPU=decm\n"
        );
        text.push_str(&"\n".repeat(252 - text.len()));
        text + "##}\n"
    };
    fs::write(f.join("short.raw"), [0; 7]).unwrap();
    fs::write(f.join("long.raw"), [0; 9]).unwrap();
    fails(f, 1, "shape short.raw --dims 2,2,2 --dtype u8", &["needs 8 bytes", "has 7", "--dims"]);
    fails(f, 1, "shape long.raw --dims 2,2,2 --dtype u8", &["needs 8 bytes", "has 9", "--offset"]);
    fs::write(f.join("huge.inr"), header(1 << 31)).unwrap();
    fails(f, 1, "shape huge.inr", &["huge.inr", "too many"]);
    fs::write(f.join("lying.inr"), header(1000)).unwrap();
    fails(f, 1, "shape lying.inr", &["lying.inr", "4000000000 bytes"]);
    fs::write(f.join("zero.inr"), header(0)).unwrap();
    fails(f, 1, "shape zero.inr", &["zero.inr", "empty"]);
    fs::write(f.join("text.inr"), "hello").unwrap();
    fails(f, 1, "shape text.inr", &["text.inr"]);
    fs::write(f.join("empty.npy"), "").unwrap();
    fails(f, 1, "shape empty.npy", &["empty"]);
    let mut nan = header(2).into_bytes();
    nan.extend([f32::NAN; 8].iter().flat_map(|v| v.to_le_bytes()));
    fs::write(f.join("nan.inr"), nan).unwrap();
    fails(f, 1, "shape nan.inr", &["nan.inr", "NaN", "[0, 0, 0]"]);
}

/// All differences are 0: the first voxels are taken, and those are coplanar or a slab.
#[test]
fn a_constant_volume_is_no_accident() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::write(f.join("flat.raw"), [7; 64]).unwrap();
    let raw = ["flat.raw", "--dims", "4,4,4", "--dtype", "u8"];
    let flat = "shape flat.raw --dims 4,4,4 --dtype u8 --count 10 --dimension 3";
    fails(f, 1, flat, &["in one plane"]);
    let args = [&["shape"], &raw[..], &["--ratio", "1", "--weights", "min-max"]].concat();
    let report = json(f, &args);
    assert_eq!(report["weights"]["max"], 0.0);
    assert_eq!(report["shape"]["volume"], 27.0);
}

#[test]
fn bad_outputs_exit_with_1() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::create_dir(f.join("folder.ply")).unwrap();
    fails(f, 1, "shape sample:phantom@8 -o nowhere/a.ply", &["nowhere/a.ply"]);
    fails(f, 1, "shape sample:phantom@8 -o folder.ply", &["folder.ply"]);
    // A failure after the target was opened leaves what stood there.
    fs::write(f.join("old.ply"), "precious").unwrap();
    let few = "shape sample:phantom@8 --count 3 --dimension 3 -o old.ply";
    fails(f, 1, few, &["3 distinct points"]);
    assert_eq!(fs::read_to_string(f.join("old.ply")).unwrap(), "precious");
}

#[test]
fn a_full_disk_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    if !Path::new("/dev/full").exists() {
        return;
    }
    // Standard output that takes nothing.
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_walpha"));
    let status = command
        .args(["info", "sample:phantom@8"])
        .current_dir(folder.path())
        .stdout(full)
        .stderr(std::process::Stdio::null())
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(1));
}
