//! Bad input of every kind, and the exit codes it gets.

use crate::cli::*;

#[test]
fn usage_errors_exit_with_2() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fails(f, 2, "shap sample:phantom", &["shape"]);
    fails(f, 2, "shape", &["INPUT"]);
    fails(f, 2, "shape a.txt --format xyz", &["--format"]);
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

/// An option without effect on this input, or on these outputs, is refused, with advice.
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
        ("shape sample:phantom@8 --output-format ply -o a.ply", "--output-format has no effect"),
        (
            "shape sample:phantom@8 --input-format nrrd",
            "--input-format has no effect: a sample is not a file",
        ),
        ("shape cube.csv --input-format foo", "no format that is read has the extension"),
        ("shape sample:phantom@8 --engine cgal --blocks 2", "--blocks has no effect"),
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
fn bad_selections_exit_with_1() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fails(f, 1, "shape sample:phantom@8 --count 513", &["from 1 to 512"]);
    let few = "shape sample:phantom@8 --count 3 --require-3d";
    fails(f, 1, few, &["3 distinct points", "at least 4"]);
    fails(f, 1, "shape sample:phantom@8 --threshold 300", &["none of 512 voxels"]);
    fails(f, 1, "shape sample:phantom@8 --gray-min 300", &["no voxel reaches", "give less"]);
    fails(f, 1, "shape sample:phantom@1 --ratio 1 --require-3d", &["1 distinct points"]);
    fails(f, 1, "shape sample:phantom@8 --weights column", &["column"]);
    fails(f, 1, "shape sample:phantom@8 --weights min-max --alpha inf", &["proportional to α"]);
}

/// The standard library says of any of these that a digit is invalid.
#[test]
fn numbers_that_are_not_whole_are_called_so() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for (option, value, words) in [
        ("--level", "-3", "\"-3\" is not a whole number from 0 up"),
        ("--frame", "1.5", "\"1.5\" is not a whole number from 0 up"),
        ("--downsample", "0", "\"0\" is not a whole number from 1 up"),
        ("--blocks", "-3", "\"-3\" is not a whole number from 1 up"),
        ("--coefficients", "x", "\"x\" is not a whole number from 0 up"),
        ("--count", "99999999999999999999", "99999999999999999999 is too large"),
        ("--size", "x1", "\"\" is not a whole number"),
        ("--size", "99999999999x1", "99999999999 is too large"),
    ] {
        let (code, _, error) = run(f, &["shape", "sample:phantom@8", option, value]);
        assert_eq!(code, 2, "{option} {value}");
        assert!(error.contains(words), "{error}");
    }
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
        fails(f, 1, &format!("shape {name} --require-3d --alpha 1 -o out.ply"), &[word]);
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

#[test]
fn bad_outputs_exit_with_1() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::create_dir(f.join("folder.ply")).unwrap();
    fails(f, 1, "shape sample:phantom@8 -o nowhere/a.ply", &["nowhere/a.ply"]);
    fails(f, 1, "shape sample:phantom@8 -o folder.ply", &["folder.ply"]);
    // A failure after the target was opened leaves what stood there.
    fs::write(f.join("old.ply"), "precious").unwrap();
    let few = "shape sample:phantom@8 --count 3 --require-3d -o old.ply";
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

/// Names are bytes to the system, and need not be text.
#[test]
#[cfg(target_os = "linux")]
fn names_need_not_be_utf_8() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let name = |end: &str| OsStr::from_bytes(&[b"caf\xe9", end.as_bytes()].concat()).to_owned();
    let walpha = |args: &[&OsStr]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_walpha"));
        let done = command.args(args).current_dir(f).output().unwrap();
        let said = String::from_utf8(done.stderr).unwrap();
        (done.status.code(), String::from_utf8(done.stdout).unwrap() + &said)
    };
    fs::write(f.join(name(".csv")), cube()).unwrap();
    let os = OsStr::new;
    let [csv, json, nrrd, html] = [".csv", ".json", ".nrrd", ".html"].map(name);
    let commands: [&[&OsStr]; 9] = [
        &[os("shape"), &csv, os("-o"), &json],
        &[os("info"), &csv],
        &[os("check"), &csv],
        &[os("check"), &json],
        &[os("compare"), &json, &json],
        &[os("haar"), os("sample:phantom@8"), os("-o"), &nrrd],
        &[os("info"), &nrrd, os("--json")],
        &[os("points"), &nrrd, os("-o"), &csv],
        &[os("view"), &csv, os("-o"), &html],
    ];
    for args in commands {
        let (code, said) = walpha(args);
        assert_eq!(code, Some(0), "{args:?}: {said}");
    }
    // Reports are text.
    let (_, said) = walpha(&[os("info"), &nrrd, os("--json")]);
    assert!(said.contains("caf\u{fffd}.nrrd"), "{said}");
    let (code, said) = walpha(&[os("shape"), &name(".none")]);
    assert!(code == Some(1) && said.contains("caf\u{fffd}.none"), "{said}");
}
