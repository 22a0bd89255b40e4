//! α and weights from the command line, and what the command says of a mesh.

use std::process::Command;

use tempfile::TempDir;

use super::folder;
use super::writers::{medit, tetgen};
use crate::archive::npy;

/// A tetrahedron whose circumscribed sphere has the squared radius 3/4, and two points of its sphere's inside.
const POINTS: [[f64; 3]; 5] =
    [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.25, 0.25, 0.25]];
const CELLS: [[u32; 4]; 1] = [[0, 1, 2, 3]];

/// Exit code, and standard output with standard error behind it.
fn run(folder: &TempDir, arguments: &[&str]) -> (i32, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_walpha-check"));
    let output = command.args(arguments).current_dir(folder).output().unwrap();
    let text = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
    (output.status.code().unwrap(), text)
}

fn write(folder: &TempDir, files: &[(&str, Vec<u8>)]) {
    files.iter().for_each(|(name, bytes)| std::fs::write(folder.path().join(name), bytes).unwrap());
}

/// Writes the files with a weight for each point, in the form of `TetGen`.
fn with_attributes(folder: &TempDir) {
    let [(_, node), (_, ele)] = tetgen(&POINTS, &CELLS, 0).try_into().unwrap();
    let node = String::from_utf8(node).unwrap().replace("5 3 0 0", "5 3 2 1");
    let rows = node.lines().enumerate().map(|(row, line)| match row {
        0 => format!("{line}\n"),
        5 => format!("{line} -9 3 1\n"),
        _ => format!("{line} 0 3 1\n"),
    });
    write(folder, &[("w.node", rows.collect::<String>().into_bytes()), ("w.ele", ele)]);
}

#[test]
fn weights_are_taken_where_they_are_asked_for() {
    let folder = folder();
    with_attributes(&folder);
    write(&folder, &tetgen(&POINTS, &CELLS, 1));
    write(
        &folder,
        &[
            ("w.csv", b"weight\n0\n0\n0\n0\n-9\n".to_vec()),
            (
                "w.npy",
                npy("<f4", "(5,)", &[0f32, 0.0, 0.0, 0.0, -9.0].map(f32::to_le_bytes).concat()),
            ),
            ("short.csv", b"0\n0\n".to_vec()),
            ("two.csv", b"0\n0 1\n".to_vec()),
            ("word.csv", b"0\nweight\n".to_vec()),
        ],
    );
    // Without its weight the fifth point is in the cell; with its weight, it is hidden.
    let (code, text) = run(&folder, &["w.ele"]);
    assert_eq!(code, 3, "{text}");
    assert!(text.contains("point 4 is not hidden"), "{text}");
    assert!(
        text.contains(
            "note: attributes of points are not weights; --weights column takes the first"
        ),
        "{text}"
    );
    for arguments in [
        ["w.node", "--weights", "column"],
        ["t.node", "--weights", "w.csv"],
        ["t.ele", "--weights", "w.npy"],
    ] {
        let (code, text) = run(&folder, &arguments);
        assert!(code == 0 && text.contains("exact: no findings"), "{arguments:?}: {text}");
        assert!(!text.contains("attributes"), "{text}");
    }
    for (source, words) in [
        ("column", "--weights column asks for the attributes"),
        ("short.csv", "`weights` has 2 entries, but needs 5"),
        ("two.csv", "two.csv, line 2: a line has more than one number"),
        ("word.csv", "word.csv, line 2: \"weight\" is not a weight"),
        ("none.csv", "none.csv: the mesh cannot be read"),
    ] {
        let (code, text) = run(&folder, &["t.node", "--weights", source]);
        assert!(code == 1 && text.contains(words), "{source}: {text}");
    }
}

/// With an α the cells are a shape; a file that states an α keeps it.
#[test]
fn alpha_makes_a_shape() {
    let folder = folder();
    write(&folder, &medit(&POINTS[..4], &CELLS));
    let stated = r#"{"points":[[0,0,0],[1,0,0],[0,1,0],[0,0,1]],"alpha":0.75,"cells":[[0,1,2,3]]}"#;
    write(&folder, &[("c.json", stated.into())]);
    let (code, text) = run(&folder, &["t.mesh"]);
    assert!(code == 0 && text.contains("note: judged as a triangulation (α = ∞)"), "{text}");
    let (code, text) = run(&folder, &["t.mesh", "--alpha", "0.75"]);
    assert!(code == 0 && !text.contains("α = ∞"), "{text}");
    let (code, text) = run(&folder, &["t.mesh", "--alpha", "0.7"]);
    assert!(code == 3 && text.contains("squared radius 0.75"), "{text}");
    let (code, text) = run(&folder, &["c.json", "--alpha", "0.75"]);
    assert!(code == 1 && text.contains("--alpha has no effect: the file states its α"), "{text}");
    let order = r#"{"points":[[0,0,0],[1,0,0]],"vertices":[0,1],"edges":[[0,1]],"facets":[],"cells":[],
        "values":{"vertices":[0,0],"edges":[0.25],"facets":[],"cells":[]},"order":[0,1,2]}"#;
    write(&folder, &[("f.json", order.into())]);
    let (code, text) = run(&folder, &["f.json", "--alpha", "1"]);
    assert!(code == 1 && text.contains("--alpha has no effect: a filtration"), "{text}");
}

/// All findings are counted by the broken rule.
#[test]
fn findings_are_counted_by_rule() {
    let folder = folder();
    write(&folder, &medit(&POINTS[..4], &[[0, 1, 2, 3], [0, 1, 2, 3], [3, 2, 1, 0]]));
    let (code, text) = run(&folder, &["t.mesh"]);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((code, lines[0]), (3, "\"t.mesh\": wrong: 7 findings"), "{text}");
    assert_eq!(lines[1], "  by rule: 4 crowded, 2 repeated_simplex, 1 volume");
    // The simplices that the checker derives from the cells are judged if they are a shape.
    let (_, text) = run(&folder, &["t.mesh", "--alpha", "9"]);
    assert!(text.contains(" class"), "{text}");
}

#[test]
fn what_is_not_read_is_refused_by_name() {
    let folder = folder();
    write(
        &folder,
        &[
            ("a.vtu", b"<VTKFile/>".to_vec()),
            ("a.PLY", b"ply\n".to_vec()),
            ("a.stl", Vec::new()),
            ("a.meshb", vec![1, 0, 0, 0]),
        ],
    );
    for (file, next) in [
        ("a.vtu", "next: use `walpha check`, which reads .vtu and .ply, too"),
        ("a.PLY", "next: use `walpha check`, which reads .vtu and .ply, too"),
        ("a.stl", "next: convert it to one of these"),
        ("a.meshb", "next: write it as text (.mesh)"),
    ] {
        let (code, text) = run(&folder, &[file]);
        assert!(code == 1 && text.contains(next), "{text}");
    }
}
