//! What people expect of a command: configuration, pipes, near misses, three lines of error, manual
//! pages, names.

mod config;

mod streams;

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{json, ok, run};

/// The three lines of an error: what, why, next.
fn complaint(folder: &Path, code: i32, args: &str) -> [String; 3] {
    let (got, stdout, stderr) = run(folder, &args.split(' ').collect::<Vec<_>>());
    assert_eq!(got, code, "walpha {args}\n{stderr}");
    assert_eq!(stdout, "", "walpha {args}");
    let lines: Vec<&str> = stderr.lines().collect();
    assert_eq!(lines.len(), 3, "walpha {args}\n{stderr}");
    [("error: ", 0), ("  why: ", 1), (" next: ", 2)].map(|(label, line)| {
        let text = lines[line].strip_prefix(label);
        text.unwrap_or_else(|| panic!("walpha {args}: no {label:?}\n{stderr}")).to_owned()
    })
}

#[test]
fn errors_say_what_why_and_what_next() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::write(f.join("skull.raw"), vec![0; 262_143]).unwrap();
    fs::write(f.join("flat.csv"), "x,y,z\n0,0,0\n1,0,0\n0,1,0\n1,1,0\n").unwrap();
    fs::write(f.join("notes.doc"), "hello").unwrap();
    fs::create_dir(f.join("empty")).unwrap();
    let cases = [
        (1, "shape sample:skul", "could not read its input", "did you mean sample:skull?"),
        (1, "shape skull", "could not read its input", "did you mean sample:skull?"),
        (1, "info missing.nrrd", "could not read its input", "check the path"),
        (1, "info empty", "could not read its input", "a folder of slices"),
        (1, "info notes.doc", "could not read its input", "--dims X,Y,Z"),
        (1, "shape skull.raw --dims 64,64,64 --dtype u8", "could not read its input", "--dims"),
        (1, "haar flat.csv", "could not read its input", "name a volume"),
        (1, "shape flat.csv --dimension 3", "could not compute the shape", "select more points"),
        (2, "shape sample:phantom@8 -o a.plx", "cannot do this", "did you mean .ply?"),
        (2, "points sample:phantom@8 -o a.cvs", "cannot do this", "did you mean .csv?"),
        (2, "haar sample:phantom@8 -o a.nrd", "cannot do this", "did you mean .nrrd?"),
        (2, "haar sample:phantom@8 -o -", "cannot do this", "--output-format nrrd"),
        (1, "haar sample:phantom@8 -o no/a.npy", "could not start", "choose an existing one"),
        (2, "check flat.csv --points flat.csv", "cannot do this", "omit it"),
        (1, "compare a.txt b.txt", "could not start", "docs/cross-checking.md"),
        (
            1,
            "points sample:phantom@8 --count 999",
            "could not make weighted points",
            "from 1 to 512",
        ),
        (1, "reproduce --input sample:fantom", "could not read its input", "sample:phantom?"),
        (2, "shpe sample:phantom", "unrecognized subcommand 'shpe'", "'shape'"),
        (2, "shape sample:phantom --alpa 3", "unexpected argument '--alpa'", "'--alpha'"),
        (2, "shape sample:phantom --balls pwer", "invalid value 'pwer'", "'power'"),
        (2, "shape sample:phantom --alpha ten", "invalid value 'ten'", "as in 10"),
        (2, "shape sample:phantom --weights minmax", "invalid value 'minmax'", "min-max"),
        (2, "shape sample:phantom --count 1 --ratio 0.5", "cannot be used with", "--help"),
        (2, "shape sample:phantom --memory 1G --alpha inf", "cannot do this", "a finite --alpha"),
        (2, "shape sample:phantom --memory 1G --exterior", "cannot do this", "omit --exterior"),
        (2, "check a.csv --memory 1G --engine cgal", "cannot do this", "--engine native"),
        (2, "interpolate a --memory 1G --alpha-radius inf", "cannot do this", "a finite --alpha"),
        (2, "interpolate sample:phantom --memory 1G --fill", "cannot be used with", "--help"),
        (2, "shape", "required arguments", "walpha shape --help"),
        (2, "shape a.raw --dims 2,2 --dtype u8", "invalid value '2,2'", "64,64,64"),
        (2, "completions basch", "invalid value 'basch'", "'bash'"),
    ];
    for (code, args, what, next) in cases {
        let [got_what, why, got_next] = complaint(f, code, args);
        assert!(got_what.contains(what), "walpha {args}: {got_what}");
        assert!(!why.is_empty(), "walpha {args}");
        assert!(got_next.contains(next), "walpha {args}: {got_next}");
    }
}

#[test]
fn files_go_into_pipes() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let piped = |args: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_walpha"));
        let done = command.args(args).current_dir(f).output().unwrap();
        assert!(done.status.success(), "{args:?}: {}", String::from_utf8_lossy(&done.stderr));
        (done.stdout, String::from_utf8(done.stderr).unwrap())
    };
    let cases: [(&[&str], &str); 4] = [
        (&["shape", "sample:phantom@12"], "ply"),
        (&["shape", "sample:phantom@12"], "npz"),
        (&["points", "sample:phantom@12"], "csv"),
        (&["haar", "sample:phantom@12"], "nii.gz"),
    ];
    for (args, format) in cases {
        let file = format!("a.{format}");
        ok(f, &[args, &["-o", &file]].concat());
        let (bytes, report) = piped(&[args, &["-o", "-", "--output-format", format]].concat());
        assert_eq!(bytes, fs::read(f.join(&file)).unwrap(), "{args:?}");
        assert!(report.contains("coefficients kept"), "the report is elsewhere: {report}");
        let (_, report) =
            piped(&[args, &["-o", "-", "--output-format", format, "--quiet"]].concat());
        assert_eq!(report, "");
    }
    assert_eq!(fs::read_dir(f).unwrap().count(), 4, "nothing is called -");
}

/// Names with control characters cannot play with the terminal.
#[test]
fn names_are_shown_without_control_characters() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let name = "a\x1b[2Jb\rc\nZ";
    fs::write(f.join(format!("{name}.csv")), "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n").unwrap();
    let shown = "a\\u{1b}[2Jb\\rc\\nZ";
    for args in [["info", &format!("{name}.nrrd")], ["check", &format!("{name}.json")]] {
        let (code, _, said) = run(f, &args);
        assert!(code == 1 && said.contains(shown), "{said}");
        assert!(!said.contains(['\x1b', '\r']) && said.lines().count() == 3, "{said}");
    }
    let named = |extension: &str| format!("{name}.{extension}");
    let [csv, json, npy, html, nrrd] = ["csv", "json", "npy", "html", "nrrd"].map(named);
    let reports: [&[&str]; 8] = [
        &["shape", &csv, "-o", &json],
        &["points", &csv, "-o", &npy],
        &["check", &csv],
        &["compare", &json, &json],
        &["ladder", &csv, "-o", name],
        &["view", &csv, "-o", &html],
        &["interpolate", "sample:phantom@8", "-o", &nrrd],
        &["interpolate", &nrrd, "--curve", "-o", &named("curve")],
    ];
    for args in reports {
        let said = ok(f, args);
        assert!(!said.contains(['\x1b', '\r']) && said.contains(shown), "{said}");
        // The last letter of the name, behind its line feed.
        assert!(!said.lines().any(|line| line.starts_with('Z')), "{said}");
    }
}

#[test]
fn too_many_threads_are_not_started() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["haar", "sample:phantom@8", "--threads", "65535"];
    let (code, _, said) = run(folder.path(), &args);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("--threads 65535") && said.contains("start"), "{said}");
}

#[test]
fn pages_and_completions_know_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let page = ok(f, &["man"]);
    assert!(page.contains(".TH walpha 1") && page.contains("shape"), "{page}");
    ok(f, &["man", "-o", "."]);
    let shape = fs::read_to_string(f.join("walpha-shape.1")).unwrap();
    assert!(shape.contains("alpha\\-radius"), "{shape}");
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = ok(f, &["completions", shell]);
        assert!(script.contains("alpha-radius") && script.contains("compare"), "{shell}");
    }
}

/// Errors and help are plain where nobody can see colours.
#[test]
fn colours_stay_out_of_files() {
    let folder = tempfile::tempdir().unwrap();
    for args in [&["shape", "sample:skul", "-v"][..], &["shape", "--help"], &["shape", "--x"]] {
        let (_, stdout, stderr) = run(folder.path(), args);
        assert!(!stdout.contains('\x1b') && !stderr.contains('\x1b'), "{args:?}");
    }
}

/// The command's own options stand first, those of every command last; each shows how it is used, on a
/// CT, too.
#[test]
fn help_leads_with_what_is_special() {
    let folder = tempfile::tempdir().unwrap();
    for (command, own) in [("shape", "--output"), ("view", "--alphas"), ("check", "--enumerate")] {
        let help = ok(folder.path(), &[command, "--help"]);
        let at = |word: &str| help.find(word).unwrap_or_else(|| panic!("no {word} in\n{help}"));
        assert!(help.contains("Examples:") && help.contains("ct.nii.gz"), "{help}");
        let order = ["Usage:", "Options:", &format!("{own} <"), "Input:", "Every command:"];
        let order = if command == "check" {
            order.map(|o| o.trim_end_matches(" <").into())
        } else {
            order.map(String::from)
        };
        let places = order.each_ref().map(|word| at(word));
        assert!(places.is_sorted(), "{order:?} at {places:?} in\n{help}");
        assert!(at("--json") > at("Every command:"), "{help}");
        assert!(at("[default: column") > at("--weights"), "{help}");
    }
    for command in ["points", "haar", "interpolate", "info", "ladder", "reproduce"] {
        let help = ok(folder.path(), &[command, "--help"]);
        let (head, _) = help.split_once("Usage:").unwrap();
        assert!(head.matches(&format!("walpha {command}")).count() >= 2, "{head}");
        assert!(head.contains("ct.nii.gz"), "{head}");
    }
}
