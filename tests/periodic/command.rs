//! `--periodic` on the command line.

#[path = "../common/mod.rs"]
mod common;

use crate::{BCC, crystal};

fn points(folder: &std::path::Path) {
    let lines =
        crystal([4, 4, 4], &BCC).positions.into_iter().map(|[x, y, z]| format!("{x} {y} {z}\n"));
    std::fs::write(folder.join("p.xyz"), lines.collect::<String>()).unwrap();
}

#[test]
fn shapes_filtrations_and_checks() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    points(f);
    let make = ["shape", "p.xyz", "--periodic", "4,4,4", "--alpha", "0.3125", "-o"];
    let told = common::json(f, &[&make[..], &["a.json", "a.npz", "a.vtu", "a.ply"]].concat());
    assert_eq!(told["shape"]["betti"], serde_json::json!([1, 3, 3, 1]));
    assert_eq!(told["shape"]["volume"], 64.0);
    assert_eq!(told["shape"]["components"][0]["rounds"], 3);
    for file in ["a.json", "a.npz"] {
        let checked = common::ok(f, &["check", file]);
        assert!(checked.contains("certified: no finding"), "{checked}");
    }
    common::ok(f, &["check", "p.xyz", "--periodic", "4,4,4"]);
    // The smallest α with one solid component is that at which all is filled.
    let auto = common::json(f, &["shape", "p.xyz", "--periodic", "4,4,4", "-o", "b.json"]);
    assert_eq!(auto["alpha"]["squared"], 0.3125);
    let made = ["filtration", "p.xyz", "--periodic", "4,4,4", "-o", "f.npz", "f.json"];
    assert_eq!(common::json(f, &made)["values"], 5);
    assert_eq!(common::run(f, &["check", "f.npz"]).0, 1);
    assert_eq!(common::run(f, &["compare", "a.json", "a.npz"]).0, 1);
}

#[test]
fn what_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    points(f);
    let refused = |more: &[&str], code: i32, words: &str| {
        let all = [&["shape", "p.xyz", "-o", "a.ply"], more].concat();
        let (found, _, said) = common::run(f, &all);
        assert!(found == code && said.contains(words), "{found}: {said}");
        assert!(!f.join("a.ply").exists());
    };
    refused(&["--periodic", "4,4"], 2, "three sides");
    refused(&["--periodic", "4,4,-4"], 2, "along z");
    refused(&["--periodic", "4,4,4", "--solid"], 2, "--solid");
    refused(&["--periodic", "4,4,4", "--engine", "reference"], 2, "reference engine");
    refused(&["--periodic", "4,4,2", "--alpha", "0.3125"], 1, "repeat the points along z");
}
