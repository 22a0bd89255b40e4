//! What several tests need.

pub mod alone;
pub mod largest;
pub mod sites;
pub mod told;

use std::path::Path;
use std::process::{Command, Output};

/// Whether `sample:skull` can be read. It comes with CGAL's demo package, which a machine need
/// not have; where `WALPHA_REQUIRE_SKULL` is set, its absence is a failure and not an excuse.
pub fn has_skull() -> bool {
    let there = walpha::volume::sample("sample:skull");
    if let Err(error) = &there {
        assert!(std::env::var_os("WALPHA_REQUIRE_SKULL").is_none(), "{error}");
        eprintln!("skipped: {error}");
    }
    there.is_ok()
}

/// The built command, in a folder.
pub fn walpha(folder: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_walpha"));
    command.args(args).current_dir(folder).output().expect("the command starts")
}

/// Its exit code, standard output and standard error.
pub fn run(folder: &Path, args: &[&str]) -> (i32, String, String) {
    let output = walpha(folder, args);
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("no signal"), text(output.stdout), text(output.stderr))
}

/// Runs and expects success; gives standard output.
pub fn ok(folder: &Path, args: &[&str]) -> String {
    let (code, stdout, stderr) = run(folder, args);
    assert_eq!(code, 0, "walpha {args:?}\n{stdout}\n{stderr}");
    stdout
}

/// Runs with `--json` and expects one object.
pub fn json(folder: &Path, args: &[&str]) -> serde_json::Value {
    let stdout = ok(folder, &[args, &["--json"]].concat());
    let value: serde_json::Value = serde_json::from_str(&stdout).expect("one JSON object");
    assert!(value.is_object());
    value
}

/// Asserts that a text has all these words.
#[track_caller]
pub fn names(text: &str, words: &[&str]) {
    for word in words {
        assert!(text.contains(word), "no {word:?} in\n{text}");
    }
}

/// Runs, expects this exit code, an error that names every word, nothing on standard output, and
/// nothing new in the folder.
pub fn fails(folder: &Path, code: i32, args: &str, words: &[&str]) {
    let entries = |folder| std::fs::read_dir(folder).unwrap().count();
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

/// Whether points are in no plane; exact where coordinates are small whole numbers or halves.
pub fn spans_a_volume(positions: &[[f64; 3]]) -> bool {
    let minus = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[k] - b[k]);
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let mut rays = positions.iter().map(|&p| minus(p, positions[0]));
    let Some(along) = rays.find(|&ray| ray != [0.0; 3]) else { return false };
    let Some(normal) = rays.map(|ray| cross(along, ray)).find(|&n| n != [0.0; 3]) else {
        return false;
    };
    let height =
        |p: [f64; 3]| minus(p, positions[0]).iter().zip(normal).map(|(x, n)| x * n).sum::<f64>();
    positions.iter().any(|&p| height(p) != 0.0)
}
