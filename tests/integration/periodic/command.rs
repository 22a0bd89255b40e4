//! `--periodic` on the command line.

use super::{BCC, crystal};

use crate::common;

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
        assert!(checked.contains("exact: no findings"), "{checked}");
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
    refused(&["--periodic", "4,4,4", "--engine", "cgal"], 2, "engine cgal");
    refused(&["--periodic", "4,4,2", "--alpha", "0.3125"], 1, "repeat the points along z");
}

/// Points outside of the box are counted, and a cell that the file states is not passed over in silence.
#[test]
fn what_is_folded_and_stated_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    points(f);
    let args = ["shape", "p.xyz", "--periodic", "4,4,4", "--alpha", "0.3125"];
    assert_eq!(common::json(f, &args)["points"]["folded"], 0);
    assert!(!common::ok(f, &args).contains("moved into it"));
    assert_eq!(common::json(f, &["shape", "p.xyz", "--alpha", "1"])["points"].get("folded"), None);
    // Those at x = 0 are a box away.
    let text = std::fs::read_to_string(f.join("p.xyz")).unwrap();
    let outside = text.lines().filter(|line| line.starts_with("0 "));
    let shifted = text.lines().map(|line| match line.strip_prefix("0 ") {
        Some(rest) => format!("-4 {rest}\n"),
        None => format!("{line}\n"),
    });
    std::fs::write(f.join("q.xyz"), shifted.collect::<String>()).unwrap();
    let count = outside.count();
    let args = ["shape", "q.xyz", "--periodic", "4,4,4", "--alpha", "0.3125"];
    let told = common::json(f, &args);
    assert_eq!(
        (&told["points"]["folded"], &told["shape"]["volume"]),
        (&serde_json::json!(count), &serde_json::json!(64.0))
    );
    let words = format!("{count} outside of the periodic box, moved into it");
    assert!(count > 0 && common::ok(f, &args).contains(&words));
    let args = ["filtration", "q.xyz", "--periodic", "4,4,4", "-o", "f.json"];
    assert!(common::ok(f, &args).contains(&words));
    assert_eq!(common::json(f, &args)["folded"], count);

    let atoms: String = text.lines().map(|line| format!("Fe {line}\n")).collect();
    let cell = "Lattice=\"4 0 0 0 4 0 0 0 4\"";
    std::fs::write(f.join("e.xyz"), format!("{}\n{cell}\n{atoms}", text.lines().count())).unwrap();
    let plain = ["shape", "e.xyz", "--alpha", "0.3125"];
    let warned = common::json(f, &plain)["warnings"].to_string();
    assert!(warned.contains("it is not used") && warned.contains("4,4,4"), "{warned}");
    for (command, output) in [("shape", "g.ply"), ("filtration", "g.json")] {
        let args = [command, "e.xyz", "--periodic", "4,4,4", "-o", output];
        let told = common::json(f, &args);
        assert_eq!(told.get("warnings"), None);
    }
}
