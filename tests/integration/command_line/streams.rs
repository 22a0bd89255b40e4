//! Standard output and standard error that take nothing, or not all: nothing is lost with exit code 0.

use std::fs::OpenOptions;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::common::ok;

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

/// A reader that goes away early, as `head` does: what it did not read is lost, and the code says so, as that
/// of a program which the signal PIPE ends.
#[test]
fn a_reader_that_goes_away_is_told_of() {
    let folder = folder();
    for args in PRINTING {
        let mut child = walpha(folder.path(), args).stdout(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let mut said = String::new();
        child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(141), "{args:?}: {said}");
        assert!(said.contains("error: ") && said.contains("roken pipe"), "{args:?}: {said}");
        assert!(!said.contains("panicked"), "{args:?}: {said}");
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

/// As after `>&-`: only a shell starts a process without one.
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
    // Nothing is lost of what is not printed.
    let quiet = "exec \"$0\" shape sample:phantom@12 -o b.json -q >&-";
    let mut shell = Command::new("sh");
    shell.args(["-c", quiet, env!("CARGO_BIN_EXE_walpha")]).current_dir(&folder);
    assert!(shell.status().unwrap().success());
}

/// As in `walpha … 2>&1 >/dev/null | true`: nobody hears it, and that is no fault of the program.
#[test]
fn nobody_hears_standard_error() {
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
