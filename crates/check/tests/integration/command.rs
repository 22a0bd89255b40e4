//! The command `walpha-check`.

use std::path::{Path, PathBuf};
use std::process::Command;

use walpha_base::random::Random;

const POINTS: &str = r#""points":[[0,0,0],[1,0,0],[0,1,0],[0,0,1]],"alpha":0.75"#;

/// A folder for each test, below Cargo's folder for tests.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    for (name, rows) in
        [("right.json", "[[0,1,2,3]]"), ("wrong.json", "[[0,1,2,3],[0,1,2,3]]"), ("odd.json", "7")]
    {
        std::fs::write(folder.join(name), format!("{{{POINTS},\"cells\":{rows}}}")).unwrap();
    }
    folder
}

/// Exit code, standard output and standard error.
fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_walpha-check"));
    let output = command.args(arguments).current_dir(folder).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

#[test]
fn exit_codes_say_what_was_found() {
    let folder = folder("exit_codes");
    for (arguments, code) in [
        (&["right.json"][..], 0),
        (&["odd.json"], 1),
        (&["none.json"], 1),
        (&["right.csv"], 1),
        (&[], 2),
        (&["--no-such-option"], 2),
        (&["wrong.json"], 3),
        (&["wrong.json", "right.json"], 3),
        (&["odd.json", "wrong.json"], 1),
    ] {
        let (got, stdout, stderr) = run(&folder, arguments);
        assert_eq!(got, code, "{arguments:?}\n{stdout}{stderr}");
    }
}

/// So many points are near each other that edges between them are not searched for: no fault is found, and there is a separate
/// exit code.
#[test]
fn what_is_right_as_far_as_judged_has_an_exit_code_of_its_own() {
    let folder = folder("as_far_as_judged");
    let mut random = Random::new(26);
    let points: Vec<[f64; 3]> =
        (0..94_000).map(|_| [0; 3].map(|_| random.whole(0, 1_000_000))).collect();
    let points = format!("{points:?}");
    for (alpha, code) in [(1e12, 4), (-1.0, 3)] {
        let vertices: Vec<u32> = (0..94_000).collect();
        let file = format!("{{\"points\":{points},\"alpha\":{alpha:?},\"vertices\":{vertices:?}}}");
        std::fs::write(folder.join("points.json"), file).unwrap();
        let (got, stdout, stderr) = run(&folder, &["points.json", "right.json"]);
        assert_eq!(got, code, "{stdout}{stderr}");
        if code == 4 {
            let verdict = "\"points.json\": exact as far as judged: no findings\n";
            assert!(stdout.starts_with(verdict), "{stdout}");
            assert!(
                stdout.contains("not judged: whether simplices of the shape are missing: about")
            );
            assert!(stdout.contains("beyond α = "), "{stdout}");
        }
    }
    // Whatever is wrong weighs more.
    let (got, ..) = run(&folder, &["wrong.json", "right.json"]);
    assert_eq!(got, 3);
}

#[test]
fn each_file_is_judged() {
    let folder = folder("each_file");
    let (_, stdout, stderr) = run(&folder, &["odd.json", "wrong.json", "right.json"]);
    assert!(stderr.starts_with("error: \"odd.json\": ") && stderr.contains("JSON"), "{stderr}");
    let lines: Vec<&str> = stdout.lines().filter(|line| !line.contains("not judged")).collect();
    assert_eq!(lines.first(), Some(&"\"wrong.json\": wrong: 1 finding"), "{stdout}");
    assert_eq!(lines[1], "  cell [0, 1, 2, 3] is listed twice");
    assert_eq!(lines.last(), Some(&"\"right.json\": exact: no findings"));
}

#[test]
fn what_cannot_be_judged_comes_with_advice() {
    let folder = folder("advice");
    let filtration = r#""points":[[0,0,0],[1,0,0]],"vertices":[0,1],"edges":[[0,1]],"facets":[],"cells":[],
        "values":{"vertices":[0,0],"edges":[0.25],"facets":[],"cells":[]},"order":[0,1,2]"#;
    for (fields, advice) in [
        (POINTS.to_owned(), "next: give at least one of cells, facets, edges, vertices"),
        (
            format!(r#"{POINTS},"cells":[[0,1,2,3]],"periodic":[1,1,1]"#),
            "next: move the points into the box, by multiples of its vectors",
        ),
        (
            format!(r#"{filtration},"periodic":[4,4,4]"#),
            "next: judge its complexes at single values of α instead",
        ),
        (format!(r#"{POINTS},"cells":[[0,1,2,9]]"#), "next: number points from 0 in all rows"),
    ] {
        std::fs::write(folder.join("not.json"), format!("{{{fields}}}")).unwrap();
        let (code, stdout, stderr) = run(&folder, &["not.json"]);
        assert_eq!((code, stdout.as_str()), (1, ""), "{fields}\n{stderr}");
        let next = stderr.lines().find(|line| line.starts_with("next")).unwrap_or_default();
        assert_eq!(next, advice, "{stderr}");
    }
}

/// A square that is cut along its other diagonal is right, unless the tie rule is requested.
#[test]
fn ties_are_findings_where_asked() {
    let folder = folder("ties");
    let square = |facets: &str| {
        format!(
            "{{\"points\":[[0,0,0],[1,0,0],[0,1,0],[1,1,0],[0,0,9]],\"alpha\":0.5,\"facets\":{facets},\"vertices\":[0,1,2,3,4]}}"
        )
    };
    std::fs::write(folder.join("one.json"), square("[[0,1,2],[1,2,3]]")).unwrap();
    std::fs::write(folder.join("other.json"), square("[[0,1,3],[0,2,3]]")).unwrap();
    let codes = |ties: &str| {
        let mut codes =
            ["one.json", "other.json"].map(|file| run(&folder, &[file, "--ties", ties]).0);
        codes.sort_unstable();
        codes
    };
    assert_eq!((codes("any"), codes("exact")), ([0, 0], [0, 3]));
}

/// Output that cannot be printed is lost, and the exit code tells it.
#[test]
#[cfg(target_os = "linux")]
fn a_verdict_that_cannot_be_printed_is_an_error() {
    let folder = folder("unprinted");
    for (redirection, code, words) in [
        (">/dev/full", 1, "No space left"),
        (">&-", 1, "standard output is closed"),
        ("| true", 141, "roken pipe"),
    ] {
        for arguments in ["right.json", "--help", "--version"] {
            // The reader is gone before anything is written.
            let line = match redirection {
                "| true" => format!("(sleep 0.3; \"$0\" {arguments}; echo $? >&2) | true"),
                _ => format!("\"$0\" {arguments} {redirection}; echo $? >&2"),
            };
            let mut shell = Command::new("sh");
            shell.args(["-c", &line, env!("CARGO_BIN_EXE_walpha-check")]).current_dir(&folder);
            let said = String::from_utf8(shell.output().unwrap().stderr).unwrap();
            assert!(said.contains(words), "{arguments} {redirection}: {said}");
            assert_eq!(said.lines().last(), Some(code.to_string().as_str()), "{said}");
        }
    }
    // The reader of the error has gone.
    let mut shell = Command::new("sh");
    let line =
        "(sleep 0.3; \"$0\" none.json 2>&1 >/dev/null; echo $? >code) | true; sleep 0.6; cat code";
    shell.args(["-c", line, env!("CARGO_BIN_EXE_walpha-check")]).current_dir(&folder);
    assert_eq!(shell.output().unwrap().stdout, b"1\n");
}
