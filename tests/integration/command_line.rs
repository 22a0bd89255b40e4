//! The expected features of a command: configuration, pipes, near misses, three lines of error, manual pages, names, and streams
//! that do not accept output.

use std::fs::{self, OpenOptions};
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};

use base64::prelude::{BASE64_STANDARD, Engine};

use crate::common::{fails, json, names, ok, run};

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
    fs::copy(f.join("flat.csv"), f.join("-flat.csv")).unwrap();
    fs::write(f.join("notes.doc"), "hello").unwrap();
    fs::create_dir(f.join("empty")).unwrap();
    let cases = [
        (1, "shape sample:skul", "could not read its input", "did you mean sample:skull?"),
        (1, "shape skull", "could not read its input", "did you mean sample:skull?"),
        (1, "info missing.nrrd", "could not read its input", "check the path"),
        (1, "info empty", "could not read its input", "a folder of slices"),
        (1, "info notes.doc", "could not read its input", "--dims X,Y,Z"),
        (1, "shape skull.raw --dims 64,64,64 --dtype u8", "could not read its input", "--dims"),
        (2, "shape -flat.csv", "unexpected argument", "the file is ./-flat.csv"),
        (1, "haar flat.csv", "could not read its input", "name a volume"),
        (
            1,
            "shape flat.csv --require-3d",
            "could not compute the shape",
            "select points off this plane",
        ),
        (2, "shape sample:phantom@8 -o a.plx", "cannot do this", "did you mean .ply?"),
        (2, "points sample:phantom@8 -o a.cvs", "cannot do this", "did you mean .csv?"),
        (2, "haar sample:phantom@8 -o a.nrd", "cannot do this", "did you mean .nrrd?"),
        (2, "haar sample:phantom@8 -o -", "cannot do this", "--output-format nrrd"),
        (1, "haar sample:phantom@8 -o no/a.npy", "could not start", "choose an existing one"),
        (2, "check flat.csv --points flat.csv", "cannot do this", "omit it"),
        (1, "compare a.txt b.txt", "could not read its input", "docs/cross-checking.md"),
        (
            1,
            "points sample:phantom@8 --count 999",
            "could not make weighted points",
            "a count from 1 to ",
        ),
        (1, "reproduce --input sample:fantom", "could not read its input", "sample:phantom?"),
        (2, "shpe sample:phantom", "unrecognized subcommand 'shpe'", "'shape'"),
        (2, "shape sample:phantom --alpa 3", "unexpected argument '--alpa'", "'--alpha'"),
        (2, "shape sample:phantom --balls pwer", "invalid value 'pwer'", "'power'"),
        (2, "shape sample:phantom --alpha ten", "invalid value 'ten'", "as in 10"),
        (2, "shape sample:phantom --weights minmax", "invalid value 'minmax'", "min-max"),
        (2, "shape sample:phantom --count 1 --ratio 0.5", "cannot be used with", "keep one of"),
        (2, "shape sample:phantom --memory 1G --alpha inf", "cannot do this", "a finite --alpha"),
        (2, "shape sample:phantom --memory 1G --exterior", "cannot do this", "omit --exterior"),
        (2, "check a.csv --memory 1G --engine cgal", "cannot do this", "--engine native"),
        (2, "interpolate a --memory 1G --alpha-radius inf", "cannot do this", "a finite --alpha"),
        (2, "interpolate sample:phantom --memory 1G --fill", "cannot be used with", "keep one of"),
        (2, "shape", "required arguments", "sample:ct"),
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
        assert!(
            report.contains("12×12×12 samples") || report.contains("coefficients kept"),
            "the report is elsewhere: {report}"
        );
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

/// Errors and help are plain if the output cannot show colours.
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
    for (command, own) in [("ladder", "--alphas"), ("view", "--alphas"), ("check", "--enumerate")] {
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

#[test]
fn a_file_sets_options_and_the_command_line_wins() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let text = "alpha = 4\nrms = 2.5\nweights = 'min-max'\nquiet = false\n\n\
                [shape]\nalpha = 5.5\nexterior = true\n\n[points]\ncount = 100\n";
    fs::write(f.join("walpha.toml"), text).unwrap();
    let with = |args: &[&str]| json(f, &[args, &["--config", "walpha.toml"]].concat());
    let shape = with(&["shape", "sample:phantom@16"]);
    assert_eq!(shape["alpha"]["squared"], 5.5);
    assert_eq!(shape["weights"]["kind"], "min-max");
    assert!(shape["shape"]["voids"].is_array(), "exterior was set");
    let points = with(&["points", "sample:phantom@16"]);
    assert_eq!(points["alpha"]["squared"], 4.0);
    assert_eq!(points["points"]["selected"], 100);
    // Given options take precedence, also over what they exclude.
    let given = with(&["points", "sample:phantom@16", "--alpha-radius", "3", "--ratio", "0.5"]);
    assert_eq!(given["alpha"]["squared"], 9.0);
    assert_eq!(given["points"]["selected"], 2048);
    let epsilon = with(&["haar", "sample:phantom@16", "--epsilon", "0"]);
    assert_eq!(epsilon["haar"]["rms"], 0.0);
}

#[test]
fn what_a_file_says_wrongly_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let cases = [
        ("alhpa = 4", "alhpa", "did you mean alpha?"),
        ("[shape]\nalhpa = 4", "[shape] alhpa", "did you mean alpha?"),
        ("[shape]\ninput = 'a.nrrd'", "[shape] input", ""),
        ("[shap]\nalpha = 4", "shap", "did you mean shape?"),
        ("config = 'b.toml'", "config", ""),
        ("alpha = ", "is not a TOML file", "--print-config"),
        ("exterior = 3", "exterior = 3 is not valid", "give true or false"),
        ("alpha = true", "alpha = true is not valid", "give a text or a number"),
    ];
    for (text, why, next) in cases {
        fs::write(f.join("c.toml"), text).unwrap();
        let [_, got_why, got_next] = complaint(f, 2, "shape sample:phantom@8 --config c.toml");
        assert!(got_why.contains("c.toml") && got_why.contains(why), "{text}: {got_why}");
        assert!(got_next.contains(next), "{text}: {got_next}");
    }
    let [_, why, _] = complaint(f, 2, "shape sample:phantom@8 --config d.toml");
    assert!(why.contains("d.toml"), "{why}");
    fs::write(f.join("c.toml"), "alpha = 'ten'").unwrap();
    let [what, _, next] = complaint(f, 2, "shape sample:phantom@8 --config c.toml");
    assert!(what.contains("'ten'") && next.contains("--config"), "{what} {next}");
}

#[test]
fn what_is_printed_can_be_fed_back() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let given: [&[&str]; 5] = [
        &["shape"],
        &[
            "shape",
            "--alpha-radius",
            "3",
            "--count",
            "99",
            "-o",
            "a.ply",
            "b file.vtu",
            "--exterior",
        ],
        &["points", "a.raw", "--dims", "2,3,4", "--dtype", "u8", "--gray=-10..20", "--alpha=-1"],
        &["haar", "--epsilon", "1e3", "--threads", "1", "--json"],
        &["reproduce", "--out", "it's"],
    ];
    for args in given {
        let first = ok(f, &[args, &["--print-config"]].concat());
        let table: toml::Table = first.parse().unwrap();
        assert!(!table.is_empty(), "{first}");
        fs::write(f.join("walpha.toml"), &first).unwrap();
        let again = ok(f, &[args[0], "--config", "walpha.toml", "--print-config"]);
        assert_eq!(first, again);
    }
    let text = ok(f, &["shape", "--count", "99", "--print-config"]);
    assert!(text.contains("rms = 1\n") && text.contains("count = 99\n"), "{text}");
    assert!(!text.contains("ratio"), "excluded by --count: {text}");
}

/// Commands that print, each in its way.
const PRINTING: [&[&str]; 13] = [
    &["info", "sample:phantom@8"],
    &["info", "sample:phantom@8", "--json"],
    &["shape", "sample:phantom@12", "-o", "a.ply"],
    &["shape", "sample:phantom@12", "-o", "-", "--output-format", "json"],
    &["points", "sample:phantom@12", "-o", "-", "--output-format", "csv"],
    &["haar", "sample:phantom@8", "-o", "-", "--output-format", "nrrd"],
    &["check", "a.json"],
    &["compare", "a.json", "a.json"],
    &["man"],
    &["completions", "zsh"],
    &["--help"],
    &["--version"],
    &["shape", "--print-config"],
];

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    ok(folder.path(), &["shape", "sample:phantom@12", "-o", "a.json", "-q"]);
    folder
}

fn walpha(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_walpha"));
    command.args(args).current_dir(folder).stderr(Stdio::piped());
    command
}

/// If a reader goes away early, as `head` does, the exit code says so, as that of a program which the signal PIPE ends, and
/// nothing else does.
#[test]
fn a_reader_that_goes_away_is_left_in_peace() {
    let folder = folder();
    for args in PRINTING {
        let mut child = walpha(folder.path(), args).stdout(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let mut said = String::new();
        child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(141), "{args:?}: {said}");
        assert!(!said.contains("error") && !said.contains("panicked"), "{args:?}: {said}");
    }
}

#[test]
fn a_standard_output_that_is_full_is_an_error() {
    let Ok(full) = OpenOptions::new().write(true).open("/dev/full") else { return };
    let folder = folder();
    for args in PRINTING {
        let done = walpha(folder.path(), args).stdout(full.try_clone().unwrap()).output().unwrap();
        let said = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(1), "{args:?}: {said}");
        assert!(said.contains("No space left"), "{args:?}: {said}");
    }
}

/// A closed standard output, as after `>&-`: only a shell starts a process like this.
#[cfg(target_os = "linux")]
#[test]
fn a_standard_output_that_is_closed_is_an_error() {
    let folder = folder();
    for args in PRINTING {
        let mut shell = Command::new("sh");
        shell.args(["-c", "exec \"$0\" \"$@\" >&-", env!("CARGO_BIN_EXE_walpha")]).args(args);
        let done = shell.current_dir(&folder).output().unwrap();
        let said = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(1), "{args:?}: {said}");
        assert!(said.contains("standard output is closed"), "{args:?}: {said}");
    }
    // Output that is not printed loses nothing.
    let quiet = "exec \"$0\" shape sample:phantom@12 -o b.json -q >&-";
    let mut shell = Command::new("sh");
    shell.args(["-c", quiet, env!("CARGO_BIN_EXE_walpha")]).current_dir(&folder);
    assert!(shell.status().unwrap().success());
}

/// A closed standard error, as in `walpha … 2>&1 >/dev/null | true`, is not a fault of the program.
#[test]
fn a_closed_standard_error_is_not_a_failure() {
    let folder = folder();
    for (args, code) in [
        (&["shape", "nope.csv"][..], 1),
        (&["shape", "--no-such-option"], 2),
        (&["shape", "sample:phantom@12", "--solid", "--verbose", "-o", "b.off"], 0),
        (&["view", "sample:phantom@12", "-o", "b.html"], 0),
        (&["shape", "sample:phantom@12", "--threads", "10000"], 0),
    ] {
        let mut child = walpha(folder.path(), args).stdout(Stdio::null()).spawn().unwrap();
        drop(child.stderr.take());
        assert_eq!(child.wait().unwrap().code(), Some(code), "{args:?}");
    }
}

/// `-h` fits one screen, and shows the common options in the order of use.
#[test]
fn short_help_fits_a_screen() {
    let folder = tempfile::tempdir().unwrap();
    let commands =
        ["info", "shape", "view", "ladder", "filtration", "interpolate", "check", "points"];
    for command in commands {
        let help = ok(folder.path(), &[command, "-h"]);
        let lines = help.lines().count();
        assert!(lines <= 42, "{command}: {lines} lines\n{help}");
    }
    let help = ok(folder.path(), &["shape", "-h"]);
    let places = ["--preset", "--alpha", "--weights", "--output", "--json"]
        .map(|option| help.find(option).unwrap_or_else(|| panic!("{option} is common:\n{help}")));
    assert!(places.is_sorted(), "{help}");
    let long = ok(folder.path(), &["shape", "--help"]);
    let groups = ["Input:", "Weights and α:", "Output:", "Raw volumes:", "Every command:"];
    let places = groups.map(|group| long.find(group).expect("a group"));
    assert!(places.is_sorted() && !long.contains('`'), "{long}");
}

/// A CT gets a bone window if no option says what to look for, as the preset says, and other presets are others.
#[test]
fn presets_are_options() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let shape = |options: &[&str]| {
        let made = json(f, &[&["points", "sample:ct"][..], options].concat());
        (made["input"]["gray_range"].clone(), made["points"]["selected"].as_u64().unwrap())
    };
    let stated = ["--gray", "0..1000", "--gray-min", "64", "--threshold", "30", "--rms", "4"];
    let bone = shape(&stated);
    assert_eq!(shape(&[]), bone);
    assert_eq!(shape(&["--preset", "ct-bone"]), bone);
    assert_ne!(shape(&["--preset", "ct-skin"]), bone);
    assert_eq!(json(f, &["info", "sample:ct"])["preset"], "ct-bone");
    // Stated options take precedence, and disable assumptions.
    assert!(shape(&["--preset", "ct-bone", "--threshold", "60"]).1 < bone.1);
    assert_eq!(shape(&["--count", "500"]), (serde_json::json!([-1105.0, 1863.0]), 500));
    fs::write(f.join("own.toml"), "threshold = 60\n").unwrap();
    let both = shape(&["--config", "own.toml", "--preset", "ct-bone"]);
    assert_eq!(both, shape(&["--preset", "ct-bone", "--threshold", "60"]));
    let warned = run(f, &["points", "sample:ct", "-o", "of bone.csv"]).2;
    assert!(warned.contains("--gray 0..1000") && warned.contains("ct-bone"), "{warned}");
    assert!(!warned.contains("warning"), "{warned}");
    let printed = ok(f, &["shape", "--preset", "paper", "--print-config"]);
    assert!(printed.contains("weights = \"min-max\"") && !printed.contains("preset"), "{printed}");
    let paper = json(f, &["points", "sample:phantom", "--preset", "paper"]);
    assert_eq!(
        (&paper["points"]["selected"], &paper["weights"]["kind"]),
        (&15956.into(), &"min-max".into())
    );
    fails(f, 2, "shape sample:ct --preset bone", &["ct-bone"]);
}

/// The pixels of sixels, red, green and blue, row by row.
fn decoded(sixels: &str) -> (usize, Vec<[u8; 3]>) {
    let body = sixels.strip_prefix("\x1bPq\"1;1;").unwrap().strip_suffix("\x1b\\").unwrap();
    let (size, mut rest) = body.split_at(body.find('#').unwrap());
    let (width, height) = size.split_once(';').unwrap();
    let (width, height): (usize, usize) = (width.parse().unwrap(), height.parse().unwrap());
    let mut pixels = vec![[0; 3]; width * height];
    let (mut palette, mut colour, mut x, mut band) = (vec![[0u8; 3]; 256], 0, 0, 0);
    let number = |rest: &mut &str| {
        let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        let (digits, after) = rest.split_at(end);
        *rest = after;
        digits.parse::<usize>().unwrap()
    };
    while let Some(sign) = rest.chars().next() {
        rest = &rest[1..];
        match sign {
            '#' => {
                colour = number(&mut rest);
                if rest.starts_with(";2;") {
                    rest = &rest[2..];
                    palette[colour] = [0, 1, 2].map(|_| {
                        rest = &rest[1..];
                        (number(&mut rest) * 255 / 100) as u8
                    });
                }
            }
            '!' => {
                let count = number(&mut rest);
                let bits = rest.as_bytes()[0] - b'?';
                rest = &rest[1..];
                for column in x..x + count {
                    for row in (0..6).filter(|row| bits >> row & 1 == 1) {
                        pixels[(6 * band + row) * width + column] = palette[colour];
                    }
                }
                x += count;
            }
            '$' => x = 0,
            '-' => (x, band) = (0, band + 1),
            other => panic!("{other:?} in sixels"),
        }
    }
    (width, pixels)
}

/// A shape is shown by the protocol that is asked for, as a file has it, and not at all in what is no terminal.
#[test]
fn pictures_are_shown_in_terminals() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let shape = ["shape", "sample:phantom@16"];
    let shown = |more: &[&str]| ok(f, &[&shape, more].concat());
    assert!(!shown(&[]).contains('\x1b'), "a pipe is no terminal");
    shown(&["-o", "a.png", "--size", "800x680"]);
    let png = fs::read(f.join("a.png")).unwrap();
    let of_kitty = shown(&["--picture", "kitty"]);
    let (picture, report) = of_kitty.rsplit_once("\x1b\\\n").unwrap();
    assert!(report.starts_with("input ") && report.contains("nothing written"), "{report}");
    let parts: Vec<&str> = picture.split("\x1b\\").collect();
    let payload = parts.iter().enumerate().map(|(k, part)| {
        let (how, text) = part.split_once(';').unwrap();
        let more = u8::from(k + 1 < parts.len());
        let first = if k == 0 { "a=T,f=100," } else { "" };
        assert_eq!(how, format!("\x1b_G{first}m={more}"));
        text
    });
    assert_eq!(BASE64_STANDARD.decode(payload.collect::<String>()).unwrap(), png);
    let of_iterm2 = shown(&["--picture", "iterm2"]);
    let start = format!("\x1b]1337;File=inline=1;size={}:", png.len());
    let text = of_iterm2.strip_prefix(&start).unwrap().split_once('\x07').unwrap().0;
    assert_eq!(BASE64_STANDARD.decode(text).unwrap(), png);
    let of_sixel = shown(&["--picture", "sixel"]);
    let (width, pixels) = decoded(of_sixel.split_once('\n').unwrap().0);
    let expected = image::load_from_memory(&png).unwrap().to_rgb8();
    assert_eq!((width, pixels.len()), (800, 800 * 680));
    let is_near = |(a, b): (&[u8; 3], &image::Rgb<u8>)| (0..3).all(|k| a[k].abs_diff(b.0[k]) < 16);
    let near = pixels.iter().zip(expected.pixels()).filter(|&pair| is_near(pair)).count();
    assert!(near > 8 * 680 * 99, "{near} of 544000 pixels");
    let (code, report, _) = run(f, &[&shape[..], &["--picture", "kitty", "--json"]].concat());
    let error: serde_json::Value = serde_json::from_str(&report).unwrap();
    let error = &error["error"];
    assert!(code == 2 && error["why"].as_str().unwrap().contains("standard output"), "{error}");
    assert_eq!(error["next"], "omit it");
}

/// A range may begin with a negative number, warnings name options, and a missing temporary folder is the cause that is told.
#[test]
fn options_and_causes_are_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::write(f.join("p.xyz"), "0 0 0\n1 0 0\n-3 0 0\n").unwrap();
    let told = json(f, &["points", "p.xyz", "--roi", "-1:1,:,:"]);
    assert_eq!(told["points"]["selected"], 2);
    fs::write(f.join("a.xyz"), "2\n\nA 0 0 0\nQ 1 0 0\n").unwrap();
    let (_, _, stderr) = run(f, &["info", "a.xyz"]);
    names(&stderr, &["--radii FILE gives them"]);
    let mut command = Command::new(env!("CARGO_BIN_EXE_walpha"));
    let command = command.args(["shape", "-", "--input-format", "xyz"]).env("TMPDIR", "/not/there");
    let output = command.stdin(fs::File::open(f.join("p.xyz")).unwrap()).output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    names(&stderr, &["no file can be made in /not/there"]);
}
