//! The commands of the README, of the documentation and of help work as printed.

use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use walpha_base::random::Random;

use crate::common::ok;

/// Documents that teach by commands: that one of them has none is a mistake of [`shell_lines`].
const TEACHING: [&str; 8] = [
    "README.md",
    "docs/clusters.md",
    "docs/gallery.md",
    "docs/labels.md",
    "docs/tutorials/ct.md",
    "docs/tutorials/lidar.md",
    "docs/tutorials/molecules.md",
    "docs/tutorials/zeolite.md",
];

/// Commands whose help has examples that are run, in an order in which each finds the files of those before.
const COMMANDS: [&str; 13] = [
    "info",
    "shape",
    "balls",
    "view",
    "ladder",
    "filtration",
    "interpolate",
    "check",
    "points",
    "haar",
    "compare",
    "convert",
    "blocks",
];

/// The README and all pages of the documentation.
fn documents() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = vec![root.join("README.md")];
    let mut folders = vec![root.join("docs")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "md") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The files that a reader would have.
fn reader_files(folder: &Path) {
    // An eighth of the samples, because pages of the whole take a long time.
    ok(folder, &["haar", "sample:ct", "--downsample", "2", "-o", "ct.nii.gz"]);
    fs::copy(folder.join("ct.nii.gz"), folder.join("t1.nii.gz")).expect("a copy");
    for scan in ["scan.nrrd", "scan.nii.gz"] {
        ok(folder, &["haar", "sample:phantom@48", "-o", scan]);
    }
    let write = |name: &str, lines: &[String]| {
        fs::write(folder.join(name), lines.join("\n")).expect("a file");
    };
    let mut random = Random::new(1);
    let mut row = |n: usize, separator: &str| {
        let numbers: Vec<String> = (0..n).map(|_| (20.0 * random.unit()).to_string()).collect();
        numbers.join(separator)
    };
    write("foam.xyz", &(0..500).map(|_| row(3, " ")).collect::<Vec<_>>());
    // Points with normals, which all point up.
    write("scan.xyz", &(0..500).map(|_| row(3, " ") + " 0 0 1").collect::<Vec<_>>());
    let mut table = |header: &str, n: usize| {
        let rows = (0..500).map(|_| row(n, ","));
        std::iter::once(header.to_owned()).chain(rows).collect::<Vec<_>>()
    };
    write("scattered.csv", &table("x,y,z,value", 4));
    write("outline.csv", &table("x,y", 2));
    write("trees.csv", &table("x,y", 2));
    write("buckyball.csv", &buckyball());
    let bubble = |row: String| if row.starts_with('x') { row + ",radius" } else { row + ",1.5" };
    write("foam.csv", &table("x,y,z", 3).into_iter().map(bubble).collect::<Vec<_>>());
    // Carbon atoms of glycine, in a lattice.
    let atoms = (0..27).map(|i| (i + 1, [i % 3, i / 3 % 3, i / 9].map(|k| 3 * k)));
    let of_pdb = |(number, [x, y, z]): (i32, [i32; 3])| {
        format!(
            "ATOM  {number:>5}  CA  GLY A{number:>4}    {x:>8}{y:>8}{z:>8}  1.00  0.00           C"
        )
    };
    write("1crn.pdb", &atoms.clone().map(of_pdb).collect::<Vec<_>>());
    // Cristobalite, idealised.
    let cif = "data_z\n_cell_length_a 7.16\n_cell_length_b 7.16\n_cell_length_c 7.16\n\
               _cell_angle_alpha 90\n_cell_angle_beta 90\n_cell_angle_gamma 90\n\
               loop_\n_atom_site_label\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n\
               Si1 0 0 0\nSi2 0.25 0.25 0.25\nO1 0.125 0.125 0.125\n";
    fs::write(folder.join("zeolite.cif"), cif).expect("a file");
    let chabazite = include_str!("../../docs/tutorials/chabazite.cif");
    fs::write(folder.join("chabazite.cif"), chabazite).expect("a file");
    let names = [
        "group_PDB",
        "id",
        "type_symbol",
        "label_atom_id",
        "label_comp_id",
        "label_asym_id",
        "label_seq_id",
    ];
    let names = names.into_iter().chain(["Cartn_x", "Cartn_y", "Cartn_z"]);
    let head = ["data_1HVR".to_owned(), "loop_".to_owned()].into_iter();
    let head = head.chain(names.map(|name| format!("_atom_site.{name}")));
    let of_cif = |(number, [x, y, z]): (i32, [i32; 3])| {
        format!("ATOM {number} C CA GLY A {number} {x} {y} {z}")
    };
    write("1hvr.cif", &head.chain(atoms.map(of_cif)).collect::<Vec<_>>());
    // Two organs.
    let header = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 12 10 8\nencoding: raw\n\n";
    let organ = |i: usize| match [i % 12, i / 12 % 10, i / 120] {
        [2..6, 2..8, 2..6] => 3,
        [6..10, 3..7, 1..5] => 5,
        _ => 0,
    };
    let labels: Vec<u8> = header.bytes().chain((0..960).map(organ)).collect();
    fs::write(folder.join("labels.nrrd"), labels).expect("a file");
    // Files of other programs.
    let mesh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n\
                $Elements\n1\n1 4 0 1 2 3 4\n$EndElements";
    write("theirs.msh", &[mesh.to_owned()]);
    ok(folder, &["points", "sample:phantom@16", "-o", "skull.csv"]);
    let theirs = ["shape", "skull.csv", "--weights", "common=0", "--alpha", "2", "-o"];
    ok(folder, &[&theirs[..], &["gudhi.json", "theirs.json", "theirs.vtu"]].concat());
}

/// The atoms of C₆₀, as `docs/tutorials/molecules.md` makes them.
fn buckyball() -> Vec<String> {
    let phi = f64::midpoint(1.0, 5_f64.sqrt());
    let mut atoms = BTreeSet::new();
    for [a, b, c] in
        [[0.0, 1.0, 3.0 * phi], [1.0, 2.0 + phi, 2.0 * phi], [phi, 2.0, 2.0 * phi + 1.0]]
    {
        for signs in 0..8 {
            let sign = |bit: u32| if (signs >> bit) & 1 == 1 { -0.71 } else { 0.71 };
            let place = [a * sign(0), b * sign(1), c * sign(2)];
            for turn in 0..3 {
                let [x, y, z] = [0, 1, 2].map(|k| place[(k + turn) % 3] + 0.0);
                atoms.insert(format!("{x:.4},{y:.4},{z:.4},1.70"));
            }
        }
    }
    assert_eq!(atoms.len(), 60);
    std::iter::once("x,y,z,radius".to_owned()).chain(atoms).collect()
}

/// The lines of a document's shell blocks that begin with `walpha` or make a folder, without their comments.
fn shell_lines(document: &str) -> Vec<String> {
    let mut blocks = document.split("```");
    // Text and blocks take turns.
    blocks.next();
    let shell = blocks.step_by(2).filter_map(|block| block.strip_prefix("sh\n"));
    let is_run = |line: &&str| line.starts_with("walpha ") || line.starts_with("mkdir ");
    let lines = shell.flat_map(str::lines).filter(is_run);
    lines.map(|line| line.split("  #").next().unwrap_or(line).trim().to_owned()).collect()
}

/// The quotes of the report in sentences about it, with `#` for each number.
fn quoted_reports(document: &str) -> Vec<String> {
    let of_report = document.split(". ").filter(|sentence| sentence.contains("report"));
    // Text and quotes alternate.
    let quotes = of_report.flat_map(|sentence| sentence.split('"').skip(1).step_by(2));
    quotes.filter(|quote| quote.split_whitespace().count() > 2).map(without_numbers).collect()
}

/// A text with a mark for each number, whose thousands may stand apart.
fn without_numbers(text: &str) -> String {
    let mut kept = String::new();
    for (at, c) in text.char_indices() {
        let is_group = |rest: &str| rest.bytes().take_while(u8::is_ascii_digit).count() == 3;
        match c {
            ' ' if kept.ends_with('#') && is_group(&text[at + 1..]) => {}
            '0'..='9' if kept.ends_with('#') => {}
            '0'..='9' => kept.push('#'),
            '\n' => kept.push(' '),
            c => kept.push(c),
        }
    }
    kept
}

/// The lines of a command's help that are examples.
fn examples(help: &str) -> Vec<String> {
    let (_, rest) = help.split_once("\nExample").expect("examples");
    let (examples, _) = rest.split_once("Usage:").expect("how it is used");
    examples.lines().filter(|line| line.starts_with("walpha ")).map(str::to_owned).collect()
}

/// Whether a command can be run here, within seconds.
fn is_run_here(command: &str) -> bool {
    let has = |words: &[&str]| words.iter().any(|word| command.contains(word));
    // A folder of DICOM slices is what the tests of the feature dicom read.
    let of_others = has(&[" ct/", "/scratch", "phantom1024"]);
    // Minutes each; the reproduction is a step of CI.
    let long = has(&["--count 100000", "--curve", "walpha reproduce"]);
    let without_zarr = !cfg!(feature = "zarr") && has(&[".zarr", "walpha blocks"]);
    let without_las = !cfg!(feature = "las") && has(&[".laz", ".gpkg"]);
    let without_skull = has(&["sample:skull", "skull.json"]) && !crate::common::has_skull();
    !(of_others || long || without_zarr || without_las || without_skull)
}

/// Runs a command in a shell that finds the built program.
fn run(folder: &Path, command: &str, printed_in: &str) {
    let program = Path::new(env!("CARGO_BIN_EXE_walpha")).parent().expect("its folder");
    let path = env::var("PATH").unwrap_or_default();
    let made = Command::new("sh")
        .args(["-ec", command])
        .current_dir(folder)
        .env("PATH", format!("{}:{path}", program.display()))
        .env("HOME", folder)
        .output()
        .expect("a shell");
    let errors = String::from_utf8_lossy(&made.stderr);
    assert!(made.status.success(), "{printed_in}: {command}\n{errors}");
}

#[test]
fn printed_commands_work() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    reader_files(folder);
    // A line that is printed twice is run once.
    let mut seen = BTreeSet::new();
    for path in documents() {
        let lines = shell_lines(&fs::read_to_string(&path).expect("a document"));
        let name =
            path.strip_prefix(env!("CARGO_MANIFEST_DIR")).expect("a part").display().to_string();
        assert!(lines.len() > 1 || !TEACHING.contains(&name.as_str()), "{name} has commands");
        for line in lines.iter().filter(|line| is_run_here(line)) {
            if seen.insert(line.clone()) {
                run(folder, line, &name);
            }
        }
    }
    assert!(seen.len() > TEACHING.len(), "{seen:?}");
}

#[test]
fn quoted_reports_are_printed() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let mut random = Random::new(1);
    let mut rows: Vec<String> =
        (0..500).map(|_| [0; 3].map(|_| random.unit().to_string()).join(" ")).collect();
    rows.push("9 9 9".into());
    fs::write(folder.join("strays.xyz"), rows.join("\n")).expect("a file");
    fs::write(folder.join("buckyball.csv"), buckyball().join("\n")).expect("a file");
    let commands = [&["shape", "strays.xyz"][..], &["shape", "buckyball.csv", "--alpha", "1"]];
    let printed = commands.map(|command| {
        let all = ok(folder, &[command, &["--verbose"]].concat());
        without_numbers(&(ok(folder, command) + &all))
    });
    let printed = printed.concat();
    let mut quotes = 0;
    for path in documents() {
        for quote in quoted_reports(&fs::read_to_string(&path).expect("a document")) {
            assert!(printed.contains(&quote), "{}: {quote:?} in\n{printed}", path.display());
            quotes += 1;
        }
    }
    assert!(quotes > 2, "{quotes}");
}

#[test]
fn examples_of_help_work() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    reader_files(folder);
    let is_built_in = |command: &&str| *command != "convert" || cfg!(feature = "zarr");
    for command in COMMANDS.into_iter().filter(is_built_in) {
        if command == "compare" {
            // The files that the text above its examples makes.
            let shape = ["shape", "sample:phantom@16", "--weights", "min-max", "-o"];
            ok(folder, &[&shape[..], &["skull.json", "theirs.json"]].concat());
            ok(folder, &[&shape[..], &["cgal.npz", "--engine", "cgal"]].concat());
        }
        let examples = examples(&ok(folder, &[command, "--help"]));
        assert!(!examples.is_empty(), "{command} has examples");
        for example in examples.iter().filter(|example| is_run_here(example)) {
            run(folder, example, command);
        }
    }
}
