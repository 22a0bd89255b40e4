//! Folders of plans that others may write to, too: nothing outside is touched, and nothing that others made.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;

use walpha_files::Lock;

use crate::common::{fails, names, ok, run};

fn args(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

/// The contents of the files of a folder, by their names, and links.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut all: Vec<_> = entries
        .map(|path| {
            (path.file_name().unwrap().to_str().unwrap().to_owned(), fs::read(path).unwrap())
        })
        .collect();
    all.sort();
    all
}

#[test]
fn links_in_a_folder_of_a_plan_are_replaced_and_not_followed() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for options in ["--haar non-standard", "--haar standard"] {
        let plan = format!("blocks plan sample:phantom@24 --alpha 10 --blocks 2 {options} -o");
        ok(at, &args(&format!("{plan} plain")));
        ok(at, &args("blocks run plain"));
        let expected = contents(&at.join("plain"));
        assert_eq!(
            expected.len(),
            4,
            "a plan, two blocks, and what is kept of the truncated volume"
        );
        // All of them are links before the plan is made, and each again before the step that reads it.
        let work = at.join("work");
        fs::create_dir(&work).unwrap();
        let link = |name: &str| {
            let path = work.join(name);
            let _ = fs::remove_file(&path);
            fs::write(at.join("precious"), "PRECIOUS").unwrap();
            symlink("../precious", path).unwrap();
        };
        expected.iter().for_each(|(name, _)| link(name));
        ok(at, &args(&format!("{plan} work")));
        ok(at, &args("blocks run work"));
        for (name, _) in expected.iter().filter(|(name, _)| name != "plan.json") {
            link(name);
            let (code, stdout, stderr) = run(at, &args("blocks check work"));
            assert_eq!(code, 3, "{name}: {stdout}{stderr}");
            names(&stdout, &[name, "is a link"]);
            ok(at, &args("blocks run work"));
            assert_eq!(fs::read(at.join("precious")).unwrap(), b"PRECIOUS", "{name}");
        }
        let is_file = |name: &str| fs::symlink_metadata(work.join(name)).unwrap().is_file();
        assert!(expected.iter().all(|(name, _)| is_file(name)));
        assert_eq!(contents(&work), expected, "{options}");
        // A block that is what it should be, but elsewhere.
        let block = work.join("block-00000.walpha");
        fs::rename(&block, at.join("elsewhere")).unwrap();
        symlink("../elsewhere", &block).unwrap();
        let (code, _, stderr) = run(at, &args("blocks merge work -o merged.vtu"));
        assert_eq!(code, 1);
        names(&stderr, &["block-00000.walpha", "is a link", "blocks run"]);
        link("plan.json");
        let (code, _, stderr) = run(at, &args("blocks run work"));
        assert_eq!(code, 1);
        names(&stderr, &["plan.json", "is a link", "plan again"]);
        ["plain", "work"].iter().for_each(|name| fs::remove_dir_all(at.join(name)).unwrap());
    }
}

#[test]
fn a_shape_in_blocks_takes_no_folder_of_others() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let shape = "shape sample:phantom@24 --alpha 10 --blocks 2 -o out.pvtp";
    ok(at, &args("blocks plan sample:phantom@24 --alpha 10 --blocks 2 -o out.blocks"));
    let work = at.join("out.blocks");
    let before = contents(&work);
    fails(at, 1, shape, &["out.blocks", "did not make", "name another output"]);
    assert_eq!(contents(&work), before);
    fs::remove_dir_all(&work).unwrap();
    fs::create_dir(&work).unwrap();
    fails(at, 1, shape, &["did not make"]);
    assert!(work.exists(), "an empty folder of others stays");
    // Like a command that works there, and one that was interrupted.
    let mut lock = Lock::make(&work.join("shape.lock")).unwrap();
    fails(at, 1, shape, &["another walpha shape is at work in out.blocks", "wait for it"]);
    lock.keep();
    drop(lock);
    ok(at, &args(shape));
    assert!(!work.exists());
    // A failure leaves no files.
    fails(at, 1, "shape sample:phantom@24 --alpha 10 --blocks 2 --count 99999999 -o out.pvtp", &[]);
    fails(at, 1, "shape sample:phantom@24 --alpha 10 --memory 1K -o out.pvtp", &["allow more"]);
    assert!(!work.exists());
    // Nor does interrupted planning stop the next command, but files of others do.
    for name in ["sums.f64", "truncated.f32"] {
        fs::create_dir_all(&work).unwrap();
        fs::write(work.join(name), "half").unwrap();
    }
    fs::write(work.join("notes.txt"), "mine").unwrap();
    fails(at, 1, shape, &["did not make"]);
    fs::remove_file(work.join("notes.txt")).unwrap();
    ok(at, &args(shape));
    assert!(!work.exists());
}

/// Steps in blocks are for independent processes, however these are started.
#[test]
fn blocks_may_be_started_by_a_launcher() {
    let folder = tempfile::tempdir().unwrap();
    let started = |step: &str| {
        let walpha = env!("CARGO_BIN_EXE_walpha");
        let variables = [("SLURM_STEP_NUM_TASKS", "2"), ("SLURM_PROCID", "0")];
        let mut command = std::process::Command::new(walpha);
        command.args(step.split(' ')).current_dir(folder.path()).envs(variables);
        command.output().unwrap()
    };
    for step in [
        "blocks plan sample:phantom@24 --alpha 10 --blocks 2 -o work",
        "blocks run work",
        "blocks check work",
        "blocks merge work -o out.ply",
    ] {
        let output = started(step);
        assert!(output.status.success(), "{step}: {}", String::from_utf8_lossy(&output.stderr));
    }
    let output = started("points sample:phantom@24 -o p.csv");
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_block_does_not_replace_the_input() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::create_dir(at.join("w")).unwrap();
    ok(at, &args("haar sample:phantom@24 -o volume.nrrd"));
    for name in ["block-00001.walpha", "sums.f64"] {
        let input = at.join("w").join(name);
        fs::copy(at.join("volume.nrrd"), &input).unwrap();
        let plan = format!("blocks plan w/{name} --alpha 10 --blocks 2 -o w");
        let (mut code, _, mut stderr) = run(at, &args(&plan));
        if code == 0 {
            (code, _, stderr) = run(at, &args("blocks run w"));
        }
        assert_eq!(code, 1, "{name}");
        names(&stderr, &[name, "it is an input, which would be lost"]);
        assert_eq!(fs::read(&input).unwrap(), fs::read(at.join("volume.nrrd")).unwrap());
        fs::remove_file(input).unwrap();
    }
}

#[test]
fn a_file_of_settings_is_kept_and_has_an_end() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("k.csv"), "alpha = 10.0\n").unwrap();
    let words = ["k.csv", "it is an input, which would be lost"];
    fails(at, 1, "points sample:phantom@12 --config k.csv -o k.csv", &words);
    assert_eq!(fs::read_to_string(at.join("k.csv")).unwrap(), "alpha = 10.0\n");
    fails(at, 2, "info sample:phantom@12 --config /dev/zero", &["/dev/zero", "1048576 bytes"]);
}
