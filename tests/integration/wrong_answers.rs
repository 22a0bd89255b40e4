//! Command lines that a newcomer types, and the answers that take them further.

use std::fs;
use std::path::Path;

use crate::common::{json, ok, run};

/// Writes the files that the command lines below name.
fn prepare(folder: &Path) {
    ok(folder, &["points", "sample:phantom@8", "--count", "60", "-o", "s.csv", "-q"]);
    fs::write(folder.join("note.txt"), "hello this is prose\nand another line of it\n").unwrap();
    fs::write(folder.join("my scan.csv"), "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n").unwrap();
}

/// The arguments, the exit code, and words of the three lines: what, why, next.
const WRONG: &[(&[&str], i32, [&str; 3])] = &[
    // A file where a command is expected.
    (&["s.csv"], 2, ["unrecognized", "is the name of a file", "walpha view s.csv -o s.html"]),
    (&["./s.csv"], 2, ["unrecognized", "is the name of a file", "walpha view ./s.csv -o s.html"]),
    (&["my scan.csv"], 2, ["", "my scan.csv is", "walpha view 'my scan.csv' -o 'my scan.html'"]),
    (&["no.xyz"], 2, ["unrecognized", "a command comes first", "walpha view no.xyz -o no.html"]),
    (&["sample:ct"], 2, ["", "name of a sample", "walpha view sample:ct -o sample-ct.html"]),
    // Commands.
    (&["shpe", "s.csv"], 2, ["'shpe'", "no command of this name", "did you mean 'shape'?"]),
    (&["help", "shpe"], 2, ["'shpe'", "no command of this name", "did you mean 'shape'?"]),
    (&["mesh", "s.csv"], 2, ["'mesh'", "no command of this name", "`walpha --help` lists"]),
    (&["blocks", "mrge"], 2, ["'mrge'", "walpha blocks has no command", "did you mean 'merge'?"]),
    (
        &["blocks", "plan", "s.csv"],
        2,
        ["--output <DIR>", "walpha blocks plan", "add --output <DIR>"],
    ),
    // Outputs.
    (
        &["shape", "s.csv", "-o"],
        2,
        ["value is required", "-o needs the name of a file", "-o bone.ply"],
    ),
    (
        &["ladder", "s.csv", "-o"],
        2,
        ["value is required", "-o needs the name of a folder", "-o folder"],
    ),
    (&["shape", "s.csv", "out.ply"], 2, ["'out.ply'", "an output follows -o", "-o out.ply"]),
    // What is there would be replaced.
    (&["shape", "s.csv", "s.csv"], 2, ["'s.csv'", "takes no further name", "name one input"]),
    (&["view", "s.csv", "-o", "v.htm"], 2, ["", "cannot write .htm; a page", "-o page.html"]),
    (&["shape", "s.csv", "-O", "x.ply"], 2, ["'-O'", "no such option", "did you mean -o x.ply?"]),
    (&["shape", "s.csv", "-Q"], 2, ["'-Q'", "no such option", "did you mean -q?"]),
    (&["shape", "s.csv", "-X"], 2, ["'-X'", "no such option", "walpha shape --help"]),
    (
        &["shape", "s.csv", "-o", "x.html"],
        2,
        ["", "cannot write .html; a shape can be written as .ply", "walpha view s.csv -o x.html"],
    ),
    (
        &["view", "s.csv", "-o", "x.png"],
        2,
        ["", "cannot write .png; a page can be written as .html", "walpha shape s.csv -o x.png"],
    ),
    (
        &["shape", "s.csv", "-o", "x.foo"],
        2,
        ["", "cannot write .foo; a shape", "choose one of these"],
    ),
    (
        &["shape", "s.csv", "-o", "x"],
        2,
        ["", "it has no extension; a shape", "choose one of these"],
    ),
    (&["shape", "s.csv", "-o", "x.plx"], 2, ["", "cannot write .plx", "did you mean .ply?"]),
    (
        &["points", "s.csv", "-o", "x.xyz"],
        2,
        ["", "cannot write .xyz; points", "choose one of these"],
    ),
    // Values.
    (&["shape", "s.csv", "--preset", "ct"], 2, ["'ct'", "one of ct-bone", "ct-bone or ct-skin?"]),
    (
        &["shape", "s.csv", "--preset", "bone"],
        2,
        ["'bone'", "one of ct-bone", "did you mean ct-bone?"],
    ),
    (&["shape", "s.csv", "--preset", "mir"], 2, ["'mir'", "one of ct-bone", "did you mean 'mri'?"]),
    (
        &["shape", "s.csv", "--preset"],
        2,
        ["value is required", "one of ct-bone", "give one of these"],
    ),
    (&["shape", "s.csv", "--engine", "fast"], 2, ["'fast'", "one of auto", "give one of these"]),
    (
        &["shape", "s.csv", "--alpha"],
        2,
        ["value is required", "--alpha needs a value", "--alpha A"],
    ),
    (&["shape", "s.csv", "--alpha", "big"], 2, ["'big'", "is not a number", "a squared length"]),
    (&["shape", "s.csv", "--threads", "0"], 2, ["'0'", "not a number of threads", "from 1 to"]),
    (&["shape", "s.csv", "--threads", "two"], 2, ["'two'", "not a number of threads", "from 1 to"]),
    // Options.
    (
        &["shape", "s.csv", "--count", "100", "--threshold", "3"],
        2,
        ["cannot be used with", "each excludes the others", "keep one of --count and --threshold"],
    ),
    (
        &["shape", "s.csv", "--alpha", "3", "--radius", "2"],
        2,
        ["cannot be used with", "each excludes the others", "--alpha and --alpha-radius"],
    ),
    (
        &["shape", "s.csv", "--alpah", "3"],
        2,
        ["'--alpah'", "no such option", "did you mean '--alpha'?"],
    ),
    (&["shape", "s.csv", "--xyzzy"], 2, ["'--xyzzy'", "no such option", "walpha shape --help"]),
    (&["shape", "s.raw", "--dims", "2,2,2"], 2, ["--dtype", "usage", "add --dtype <TYPE>"]),
    (&["shape"], 2, ["<INPUT>", "usage", "name a file to read, or sample:ct"]),
    // Inputs.
    (
        &["shape", "note.txt"],
        1,
        ["read its input", "not look like a table of points", "name a file"],
    ),
    (
        &["info", "note.txt"],
        1,
        ["read its input", "not look like a table of points", "name a file"],
    ),
    (&["shape", "s.csw"], 1, ["read its input", "No such file", "check the path"]),
    (
        &["shape", "sample:phantom@8", "--value-min", "99999"],
        1,
        ["weighted points", "no voxel reaches", "give less for --value-min"],
    ),
    // A shape of nothing.
    (&["shape", "s.csv", "--alpha", "-3", "-o", "e.ply"], 1, ["", "e.ply", "--allow-empty"]),
];

#[test]
fn wrong_command_lines_are_led_further() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    prepare(f);
    let before = fs::read_dir(f).unwrap().count();
    for (args, code, parts) in WRONG {
        let (got, stdout, stderr) = run(f, args);
        assert_eq!((got, &*stdout), (*code, ""), "{args:?}\n{stderr}");
        let lines: Vec<&str> = stderr.lines().collect();
        let labels = ["error: ", "  why: ", " next: "];
        assert_eq!(lines.len(), labels.len(), "{args:?}\n{stderr}");
        for ((line, label), part) in lines.iter().zip(labels).zip(parts) {
            assert!(
                line.starts_with(label) && line.contains(part),
                "{args:?}: {part:?} in\n{stderr}"
            );
        }
        assert!(!stderr.contains("-- -"), "{args:?}: nobody needs this\n{stderr}");
    }
    assert_eq!(fs::read_dir(f).unwrap().count(), before, "something was left behind");
}

/// With `--json` an error is one object, too.
#[test]
fn errors_are_json_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    prepare(f);
    for (args, code, parts) in WRONG {
        let (got, stdout, stderr) = run(f, &[*args, &["--json"]].concat());
        if args.last().is_some_and(|last| ["-o", "--alpha", "--preset"].contains(last)) {
            // These take --json for the value that is missing, or say that it is.
            continue;
        }
        assert_eq!((got, &*stderr), (*code, ""), "{args:?}\n{stdout}");
        let report: serde_json::Value = serde_json::from_str(&stdout).expect("one object");
        let error = &report["error"];
        assert_eq!(error["exit_code"], *code, "{args:?}");
        assert!(report["schema_version"].is_u64(), "{args:?}");
        for (name, part) in ["what", "why", "next"].into_iter().zip(parts) {
            assert!(error[name].as_str().unwrap().contains(part), "{args:?}: {part:?} in {error}");
        }
    }
    // If a file goes to standard output, the object does not.
    let args = ["shape", "no.csv", "--json", "-o", "-", "--output-format", "ply"];
    let (code, stdout, stderr) = run(f, &args);
    assert_eq!((code, &*stdout), (1, ""));
    let report: serde_json::Value = serde_json::from_str(&stderr).expect("one object");
    assert!(report["error"]["why"].as_str().unwrap().contains("no.csv"), "{report}");
}

#[test]
fn a_radius_and_a_color_are_understood() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    prepare(f);
    let report = json(f, &["shape", "s.csv", "--radius", "1.5"]);
    assert_eq!(report["alpha"]["squared"], 2.25);
    #[cfg(feature = "render")]
    ok(f, &["shape", "s.csv", "--color", "class", "--size", "16x16", "-o", "s.png"]);
    let help = ok(f, &["shape", "-h"]);
    assert!(help.contains("--alpha-radius <R>"), "{help}");
    let help = ok(f, &["check", "-h"]);
    assert!(help.contains("mesh to judge"), "{help}");
}

/// Good news is a note, and no warning.
#[test]
fn hounsfield_units_are_a_note() {
    let folder = tempfile::tempdir().unwrap();
    let (code, _, stderr) = run(folder.path(), &["points", "sample:ct"]);
    assert_eq!(code, 0);
    let lines: Vec<&str> = stderr.lines().collect();
    assert_eq!(lines.len(), 1, "{stderr}");
    assert!(lines[0].starts_with("note: the values look like Hounsfield units"), "{stderr}");
    assert!(
        lines[0].contains("bone is selected, as by --preset ct-bone (--gray 0..1000"),
        "{stderr}"
    );
    let (_, _, quiet) = run(folder.path(), &["points", "sample:ct", "--quiet"]);
    assert_eq!(quiet, "");
}
