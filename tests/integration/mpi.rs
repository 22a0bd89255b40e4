//! `mpirun walpha shape`: several processes write the same bytes as one. Skipped if mpirun is missing.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::common::json;

/// Whether processes can be started; where `WALPHA_REQUIRE_MPI` is set, that they cannot is a failure.
fn has_mpirun() -> bool {
    let there = Command::new("mpirun").arg("--version").output();
    if let Err(error) = &there {
        assert!(std::env::var_os("WALPHA_REQUIRE_MPI").is_none(), "mpirun: {error}");
        eprintln!("skipped: mpirun: {error}");
    }
    there.is_ok()
}

/// The command with this number of ranks, more than there are processors.
fn mpirun(at: &Path, ranks: usize, options: &str) -> Command {
    let mut command = Command::new("mpirun");
    let version = Command::new("mpirun").arg("--version").output().expect("mpirun");
    if String::from_utf8_lossy(&version.stdout).contains("Open MPI") {
        command.args(["--oversubscribe", "--allow-run-as-root", "--bind-to", "none"]);
    }
    command.args(["-n", &ranks.to_string(), env!("CARGO_BIN_EXE_walpha")]);
    command.args(options.split_whitespace()).current_dir(at);
    command
}

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Runs with `--json` and expects one object, so that one rank alone spoke.
fn json_of(at: &Path, ranks: usize, options: &str) -> Value {
    let output = mpirun(at, ranks, &format!("{options} --json")).output().unwrap();
    assert!(output.status.success(), "{ranks} ranks, {options}\n{}", told(&output));
    serde_json::from_slice(&output.stdout).expect("one JSON object")
}

/// A report without what differs from run to run.
fn lasting(mut report: Value) -> Value {
    let facts = report.as_object_mut().expect("an object");
    for name in ["files", "seconds", "peak_memory_bytes"] {
        facts.remove(name).expect(name);
    }
    report
}

/// The files below a folder, with their bytes, in the order of their names.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        if entry.path().is_dir() {
            let inner = self::files(&entry.path()).into_iter();
            files.extend(inner.map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else {
            files.push((name, fs::read(entry.path()).unwrap()));
        }
    }
    files.sort();
    files
}

/// Asserts that any number of ranks gives the same pieces, files and numbers.
fn same(options: &str) {
    let one = tempfile::tempdir().unwrap();
    let command = format!("shape {options} --blocks 11 -o out.pvtu out.pvtp out.vtu");
    let args: Vec<&str> = command.split_whitespace().collect();
    let expected = lasting(json(one.path(), &args));
    let expected_files = files(one.path());
    assert!(expected_files.len() > 9, "{}", expected_files.len());
    let whole = format!("shape {options} --blocks 3 -o out.vtu");
    let args: Vec<&str> = whole.split_whitespace().collect();
    let in_one_piece = tempfile::tempdir().unwrap();
    assert_eq!(expected, lasting(json(in_one_piece.path(), &args)), "{options}");
    for ranks in [1, 2, 3, 8] {
        let folder = tempfile::tempdir().unwrap();
        let report = json_of(folder.path(), ranks, &command);
        assert_eq!(lasting(report), expected, "{ranks} ranks, {options}");
        let found = files(folder.path());
        let names = |files: &[(String, Vec<u8>)]| -> Vec<String> {
            files.iter().map(|(name, _)| name.clone()).collect()
        };
        assert_eq!(names(&found), names(&expected_files), "{ranks} ranks, {options}");
        for ((name, a), (_, b)) in found.iter().zip(&expected_files) {
            assert!(a == b, "{ranks} ranks, {options}: {name}, {} and {} bytes", a.len(), b.len());
        }
    }
}

#[test]
fn ranks_write_the_bytes_that_one_process_writes() {
    if has_mpirun() {
        same("sample:phantom@72 --weights min-max");
        same("sample:phantom@50 --haar standard --weights barycentric");
        same(
            "sample:phantom@50 --weights barycentric-n --engine native --gray 0..200 --balls power",
        );
    }
}

/// Ranks report and write the same as a single process, also without pieces.
#[test]
fn ranks_work_for_any_output_or_none() {
    if !has_mpirun() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let options = "shape sample:phantom@30 --weights min-max --blocks 3";
    let args = |text: &str| -> Vec<String> { text.split_whitespace().map(Into::into).collect() };
    let one = args(&format!("{options} -o one.ply one.vtu"));
    let expected = lasting(json(at, &one.iter().map(String::as_str).collect::<Vec<_>>()));
    assert_eq!(lasting(json_of(at, 2, options)), expected);
    assert_eq!(lasting(json_of(at, 3, &format!("{options} -o two.ply two.vtu"))), expected);
    for extension in ["ply", "vtu"] {
        let [one, two] =
            ["one", "two"].map(|name| fs::read(at.join(format!("{name}.{extension}"))));
        assert!(one.unwrap() == two.unwrap(), "{extension}");
    }
    let left: Vec<_> = files(at).into_iter().map(|(name, _)| name).collect();
    assert_eq!(left, ["one.ply", "one.vtu", "two.ply", "two.vtu"]);
}

/// Waits for a process, and fails where it takes too long.
fn ended(mut child: Child) -> Output {
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > Duration::from_secs(120) {
            child.kill().unwrap();
            panic!("it does not end");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    child.wait_with_output().unwrap()
}

fn fails(at: &Path, ranks: usize, options: &str) -> (i32, String) {
    let mut command = mpirun(at, ranks, options);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let output = ended(child);
    (output.status.code().expect("no signal"), told(&output))
}

#[test]
fn errors_end_all_ranks_and_are_told_once() {
    if !has_mpirun() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("file"), "").unwrap();
    let cases = [
        // Errors of the command line, of all ranks, and of the first rank.
        (2, "shape sample:phantom@20 --alpha x -o out.pvtu", "invalid value 'x'"),
        (1, "shape sample:phantom@20 --gray-min 999 -o out.pvtu", "no voxel reaches"),
        (1, "shape sample:phantom@20 -o file/out.pvtu", "cannot make the folder"),
        // Options that several processes do not support.
        (2, "shape sample:phantom@20 --alpha auto -o out.ply", "is not possible in blocks"),
        (2, "points sample:phantom@20 -o out.xyz", "3 processes were started"),
    ];
    for (code, options, why) in cases {
        let (found, stderr) = fails(at, 3, options);
        assert_eq!(found, code, "{options}: {stderr}");
        assert_eq!(stderr.matches("error: ").count(), 1, "{options}: {stderr}");
        assert!(stderr.contains(why), "{options}: {stderr}");
    }
    let left: Vec<_> = files(at).into_iter().map(|(name, _)| name).collect();
    assert_eq!(left, ["file"]);
    let output = mpirun(at, 3, "shape --help").output().unwrap();
    assert!(output.status.success(), "{}", told(&output));
    assert_eq!(String::from_utf8_lossy(&output.stdout).matches("Usage:").count(), 1);
}

/// Ids of the processes that run a command in a folder.
fn running(at: &Path) -> Vec<i32> {
    let is_ours = |id: &i32| {
        let process = Path::new("/proc").join(id.to_string());
        let program = fs::read_link(process.join("exe"));
        fs::read_link(process.join("cwd")).is_ok_and(|cwd| cwd == at.canonicalize().unwrap())
            && program.is_ok_and(|program| program == Path::new(env!("CARGO_BIN_EXE_walpha")))
    };
    let processes = fs::read_dir("/proc").into_iter().flatten().flatten();
    let ids = processes.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    ids.filter(is_ours).collect()
}

fn blocks_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut blocks: Vec<String> = names.filter(|name| name.starts_with("block-")).collect();
    blocks.sort();
    blocks
}

/// A rank that is killed ends the others, and what was done stays.
#[cfg(target_os = "linux")]
#[test]
fn a_killed_rank_loses_the_blocks_at_work_only() {
    use nix::sys::signal::{Signal, kill};
    use nix::unistd::Pid;

    if !has_mpirun() {
        return;
    }
    let options = "shape sample:phantom@64 --weights min-max --blocks 24 -o out.pvtu";
    let expected =
        json(tempfile::tempdir().unwrap().path(), &options.split(' ').collect::<Vec<_>>());
    for signal in [Signal::SIGKILL, Signal::SIGTERM] {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        let work = at.join("out.blocks");
        let child = mpirun(at, 3, options).stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
        let mut child = child.unwrap();
        let begun = Instant::now();
        while blocks_in(&work).len() < 3 {
            assert!(child.try_wait().unwrap().is_none(), "it ended before it could be killed");
            assert!(begun.elapsed() < Duration::from_secs(120), "no blocks come");
            std::thread::sleep(Duration::from_millis(1));
        }
        let ranks = running(at);
        assert_eq!(ranks.len(), 3);
        kill(Pid::from_raw(ranks[1]), signal).unwrap();
        assert!(!ended(child).status.success());
        let done = blocks_in(&work);
        assert!((3..24).contains(&done.len()), "{done:?}");
        assert!(!at.join("out.pvtu").exists());

        // Another number of ranks continues the work, and does not touch existing blocks.
        let written = |name: &String| fs::metadata(work.join(name)).unwrap().modified().unwrap();
        let before: Vec<_> = done.iter().map(written).collect();
        let kept = at.join("kept");
        fs::create_dir(&kept).unwrap();
        done.iter().for_each(|name| fs::hard_link(work.join(name), kept.join(name)).unwrap());
        assert_eq!(lasting(json_of(at, 2, options)), lasting(expected.clone()));
        let modified = |name: &String| fs::metadata(kept.join(name)).unwrap().modified().unwrap();
        assert_eq!(done.iter().map(modified).collect::<Vec<_>>(), before);
        assert!(!work.exists());
    }
}
