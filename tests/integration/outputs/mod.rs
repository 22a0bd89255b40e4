//! The treatment of files: inputs, outputs that are replaced or cannot be written, and unfinished files.

mod unfinished;

use std::fs::{self, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt, chown, symlink};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use nix::sys::resource::{Resource, setrlimit};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

use crate::common::{ok, run};

const HAAR: [&str; 5] = ["haar", "sample:phantom@8", "-q", "-o", "a.npy"];

/// Runs under a limit of the system.
fn limited(folder: &Path, resource: Resource, limit: u64, args: &[&str]) -> Output {
    limited_with(&[], folder, resource, limit, args)
}

/// Like [`limited`], with environment variables.
fn limited_with(
    variables: &[(&str, &str)],
    folder: &Path,
    resource: Resource,
    limit: u64,
    args: &[&str],
) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_walpha"));
    command.args(args).current_dir(folder).env_remove("RUST_BACKTRACE");
    command.envs(variables.iter().copied());
    let lower = move || Ok(setrlimit(resource, limit, limit)?);
    // SAFETY: between fork and exec this makes one system call, which allocates nothing.
    unsafe { command.pre_exec(lower) };
    command.output().unwrap()
}

/// Expects exit code 1, an error with these words, and these files in the folder alone.
fn refused(folder: &Path, args: &str, words: &[&str]) {
    refused_as(1, folder, args, words);
}

/// Like [`refused`], with another exit code.
fn refused_as(expected: i32, folder: &Path, args: &str, words: &[&str]) {
    let names = || -> Vec<_> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let before = names();
    let (code, _, said) = run(folder, &args.split(' ').collect::<Vec<_>>());
    assert_eq!(code, expected, "walpha {args}\n{said}");
    for word in words {
        assert!(said.contains(word), "walpha {args}: no {word:?} in\n{said}");
    }
    assert_eq!(names(), before, "walpha {args}");
}

#[test]
fn a_replaced_file_keeps_its_mode_and_owner() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.npy");
    for mode in [0o600, 0o640, 0o666] {
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, Permissions::from_mode(mode)).unwrap();
        ok(folder.path(), &HAAR);
        assert_eq!(fs::metadata(&file).unwrap().mode() & 0o777, mode);
        assert!(fs::read(&file).unwrap().starts_with(b"\x93NUMPY"));
    }
    // Only root may give files away.
    if chown(&file, Some(4321), Some(4321)).is_ok() {
        ok(folder.path(), &HAAR);
        let kept = fs::metadata(&file).unwrap();
        assert_eq!((kept.uid(), kept.gid()), (4321, 4321));
    }
}

#[test]
fn links_lead_to_what_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::create_dir(f.join("there")).unwrap();
    let real = f.join("there/real.npy");
    symlink("next.npy", f.join("a.npy")).unwrap();
    symlink("there/real.npy", f.join("next.npy")).unwrap();
    // Once to a place where nothing stands, once to a file.
    for _ in 0..2 {
        ok(f, &HAAR);
        assert!(f.join("a.npy").is_symlink() && f.join("next.npy").is_symlink());
        assert!(fs::read(&real).unwrap().starts_with(b"\x93NUMPY") && !real.is_symlink());
        fs::write(&real, "old").unwrap();
    }
    symlink("b.npy", f.join("b.npy")).unwrap();
    refused(f, "haar sample:phantom@8 -o b.npy", &["b.npy"]);
}

#[test]
fn other_names_of_a_file_see_what_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let [file, other] = ["a.npy", "other.npy"].map(|name| folder.path().join(name));
    // Shorter and longer than what comes.
    for length in [3, 100_000] {
        fs::write(&file, vec![b'x'; length]).unwrap();
        let _ = fs::remove_file(&other);
        fs::hard_link(&file, &other).unwrap();
        ok(folder.path(), &HAAR);
        assert_eq!(fs::metadata(&file).unwrap().nlink(), 2);
        let bytes = fs::read(&other).unwrap();
        assert!(bytes.starts_with(b"\x93NUMPY") && bytes.len() == 2176, "{}", bytes.len());
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
}

#[test]
fn places_that_cannot_be_are_refused_at_the_start() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::write(f.join("a.npy"), "precious").unwrap();
    fs::set_permissions(f.join("a.npy"), Permissions::from_mode(0o444)).unwrap();
    // The input would be an error, too, if one came so far.
    refused(f, "haar no.nrrd -o a.npy", &["a.npy", "write-protected", "make it writable"]);
    assert_eq!(fs::read_to_string(f.join("a.npy")).unwrap(), "precious");
    refused(f, "haar no.nrrd -o no/b.npy", &["there is no folder no", "create the folder"]);
    let name = format!("{}.npy", "b".repeat(400));
    refused(f, &format!("haar no.nrrd -o {name}"), &["too long", "choose a shorter name"]);
    refused(f, "ladder no.nrrd -o no/ladder", &["no/ladder", "--output"]);
    // The future content of a folder is checked before the work, too.
    fs::create_dir(f.join("ladder")).unwrap();
    fs::write(f.join("ladder/voids.csv"), "precious").unwrap();
    fs::set_permissions(f.join("ladder/voids.csv"), Permissions::from_mode(0o444)).unwrap();
    refused(f, "ladder no.nrrd -o ladder", &["voids.csv", "write-protected"]);

    let many: Vec<String> = (0..60).map(|k| format!("{k}.ply")).collect();
    let mut args = vec!["shape", "sample:phantom@8", "-o"];
    args.extend(many.iter().map(String::as_str));
    let output = limited(f, Resource::RLIMIT_NOFILE, 30, &args);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("Too many open files") && said.contains("ulimit -n"), "{said}");
}

#[test]
fn no_output_is_lost_to_another() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let word = ["the destination of another output", "a name of its own"];
    refused(f, "shape no.nrrd -o s.ply ./s.ply", &word);
    refused(f, "interpolate no.nrrd -o s.npy --mask s.npy", &word);
    refused(f, "shape no.nrrd -o - - --output-format ply", &word);
    symlink("s.ply", f.join("link.ply")).unwrap();
    refused(f, "shape no.nrrd -o s.ply link.ply", &word);
    fs::write(f.join("a.ply"), "").unwrap();
    fs::hard_link(f.join("a.ply"), f.join("b.ply")).unwrap();
    refused(f, "shape no.nrrd -o a.ply b.ply", &word);
    refused_as(2, f, "ladder no.nrrd --mesh ply,.PLY -o ladder", &["--mesh", "twice"]);
    refused_as(2, f, "ladder no.nrrd --counts 100,100 -o ladder", &["--counts", "twice"]);
    refused_as(2, f, "ladder no.nrrd --epsilons 5,5.0 -o ladder", &["--epsilons", "twice"]);
}

/// α of 300 digits would make names longer than a system takes.
#[test]
fn levels_of_any_alpha_have_names() {
    let folder = tempfile::tempdir().unwrap();
    let alphas = "1e-300,10,1e300";
    ok(
        folder.path(),
        &["ladder", "sample:phantom@8", "--alphas", alphas, "--mesh", "off", "-q", "-o", "out"],
    );
    assert!(folder.path().join("out/level-1-alpha-1e-300.off").exists());
    assert!(folder.path().join("out/level-2-alpha-10.off").exists());
}

const IS_INPUT: [&str; 3] =
    ["it is an input, which would be lost", "another destination", "--in-place"];

fn points(folder: &Path, name: &str) -> std::path::PathBuf {
    let path = folder.join(name);
    fs::write(&path, "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n").unwrap();
    path
}

#[test]
fn an_input_is_not_replaced_under_any_of_its_names() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let input = points(f, "in.csv");
    let before = fs::read(&input).unwrap();
    symlink("in.csv", f.join("link.csv")).unwrap();
    fs::hard_link(&input, f.join("hard.csv")).unwrap();
    fs::create_dir(f.join("sub")).unwrap();
    for output in ["in.csv", "./in.csv", "sub/../in.csv", "link.csv", "hard.csv"] {
        refused(f, &format!("points in.csv -o {output}"), &IS_INPUT);
        refused(f, &format!("points link.csv -o {output}"), &IS_INPUT);
    }
    fs::write(f.join("in.npy"), "what is in it does not matter").unwrap();
    refused(f, "interpolate in.npy -o a.npy --mask in.npy", &IS_INPUT);
    assert_eq!(fs::read(&input).unwrap(), before);
    ok(f, &["points", "in.csv", "-o", "other.csv"]);
    ok(f, &["points", "in.csv", "-o", "in.csv", "--in-place"]);
    assert_ne!(fs::read(&input).unwrap(), before);
    let word = ["--in-place has no effect", "writes no file"];
    refused_as(2, f, "info in.csv --in-place", &word);
}

#[test]
fn the_data_file_of_a_header_is_an_input() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let header = "NRRD0004\ntype: float\ndimension: 3\nsizes: 8 8 8\nendian: little\n\
                  encoding: raw\ndata file: d.raw\n";
    fs::write(f.join("d.nhdr"), header).unwrap();
    let samples: Vec<u8> = (0..512).flat_map(|i| (i as f32).to_le_bytes()).collect();
    fs::write(f.join("d.raw"), &samples).unwrap();
    symlink("d.raw", f.join("link.raw")).unwrap();
    for output in ["d.raw", "link.raw"] {
        refused(f, &format!("haar d.nhdr -o {output}"), &IS_INPUT);
    }
    assert_eq!(fs::read(f.join("d.raw")).unwrap(), samples);
    ok(f, &["haar", "d.nhdr", "-o", "d.raw", "--in-place"]);
}

/// The slices of a folder are inputs; other files in it are not.
#[cfg(feature = "render")]
#[test]
fn slices_are_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::create_dir(f.join("slices")).unwrap();
    for i in 0..6 {
        fs::write(f.join(format!("slices/{i}.png")), "a slice").unwrap();
    }
    refused(f, "shape slices --count 100 -o slices/3.png", &IS_INPUT);
    fs::write(f.join("slices/a.ply"), "old").unwrap();
    let args = "shape slices --count 100 -o slices/a.ply";
    let (_, _, said) = run(f, &args.split(' ').collect::<Vec<_>>());
    assert!(!said.contains("it is an input"), "{said}");
}

#[test]
fn the_folder_of_a_plan_is_for_its_files_alone() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    ok(f, &["haar", "sample:phantom@20", "-o", "in.npy"]);
    ok(f, &["blocks", "plan", "in.npy", "--blocks", "3", "-o", "work"]);
    ok(f, &["blocks", "run", "work"]);
    symlink("work", f.join("link")).unwrap();
    let plan = fs::read(f.join("work/plan.json")).unwrap();
    let word = ["it is in the working folder of a plan", "another destination", "--in-place"];
    for output in
        ["work/plan.json", "work/new.json", "link/plan.json", "work/new.pvtu", "work.pvtu"]
    {
        refused(f, &format!("blocks merge work -o {output}"), &word);
        refused(f, &format!("blocks merge work -o a.ply {output}"), &word);
    }
    symlink("in.npy", f.join("in.ply")).unwrap();
    refused(f, "blocks merge work -o in.ply", &IS_INPUT);
    assert_eq!(fs::read(f.join("work/plan.json")).unwrap(), plan);
    ok(f, &["blocks", "check", "work"]);
    ok(f, &["blocks", "merge", "work", "-o", "a.ply", "b.pvtu"]);
    fs::create_dir(f.join("c.blocks")).unwrap();
    refused(f, "shape in.npy -o c.pvtu c.blocks/a.ply", &word);
    ok(f, &["blocks", "merge", "work", "-o", "work/new.json", "--in-place"]);
}
