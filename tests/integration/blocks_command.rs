//! `walpha blocks`, and `walpha shape` with a file for each block.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::common::{json, ok, run};

/// A report without what differs from run to run.
fn lasting(mut report: Value) -> Value {
    let facts = report.as_object_mut().expect("an object");
    for name in ["files", "seconds", "peak_memory_bytes"] {
        facts.remove(name).expect(name);
    }
    report
}

fn args(text: &str) -> Vec<&str> {
    text.split_whitespace().collect()
}

/// Asserts that all formats have the same bytes, written from one piece and from blocks.
fn same_files(options: &str, blocks: usize) {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let extensions = ["ply", "vtu", "vtp", "npz", "json", "off"];
    let names = |stem: &str| extensions.map(|extension| format!("{stem}.{extension}"));
    let whole = format!("shape {options} --blocks 3 -o {}", names("whole").join(" "));
    let expected = json(at, &args(&whole));
    ok(at, &args(&format!("blocks plan {options} --blocks {blocks} -o work")));
    ok(at, &args("blocks run work 1"));
    ok(at, &args("blocks run work"));
    let merge = format!("blocks merge work -o {}", names("merged").join(" "));
    let merged = json(at, &args(&merge));
    for (whole, merged) in names("whole").iter().zip(names("merged")) {
        let [whole, merged] = [whole, &merged].map(|name| fs::read(at.join(name)).unwrap());
        assert!(whole == merged, "{options}: {} and {} bytes", whole.len(), merged.len());
    }
    assert_eq!(lasting(merged), lasting(expected), "{options}");
}

#[test]
fn blocks_write_the_bytes_that_one_piece_writes() {
    same_files("sample:phantom@40 --weights min-max", 5);
    same_files("sample:phantom@33 --weights barycentric-n --engine native --balls power", 17);
    same_files("sample:phantom@40 --value-min 30 --threshold 12 --alpha 6 --gray 0..200", 4);
}

/// The numbers of cells that the pieces of a file have, by its index.
fn in_pieces(index: &Path, attribute: &str) -> Vec<usize> {
    let text = fs::read_to_string(index).unwrap();
    let sources =
        text.split("<Piece Source=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
    let cells = sources.map(|name| {
        let bytes = fs::read(index.parent().unwrap().join(name)).unwrap();
        let head = String::from_utf8_lossy(&bytes[..4000.min(bytes.len())]).into_owned();
        let number = head.split(&format!("{attribute}=\"")).nth(1).expect(attribute);
        number.split('"').next().unwrap().parse().unwrap()
    });
    cells.collect()
}

fn sum(report: &Value, dimension: &str) -> usize {
    let classes = report["shape"][dimension].as_object().unwrap().values();
    classes.map(|count| count.as_u64().unwrap() as usize).sum()
}

#[test]
fn pieces_have_every_simplex_once() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let options = "sample:phantom@40 --weights min-max --blocks 6";
    let report = json(at, &args(&format!("shape {options} -o out.pvtu out.pvtp out.ply")));
    let expected = json(at, &args(&format!("shape {options} -o one.ply")));
    assert_eq!(lasting(report.clone()), lasting(expected));
    assert_eq!(fs::read(at.join("out.ply")).unwrap(), fs::read(at.join("one.ply")).unwrap());
    let cells = in_pieces(&at.join("out.pvtu"), "NumberOfCells");
    assert!(cells.len() > 3, "{cells:?}");
    let all: usize = ["cells", "facets", "edges", "vertices"].map(|d| sum(&report, d)).iter().sum();
    assert_eq!(cells.iter().sum::<usize>(), all);
    let polygons = in_pieces(&at.join("out.pvtp"), "NumberOfPolys");
    let facets = &report["shape"]["facets"];
    let boundary = facets["regular"].as_u64().unwrap() + facets["singular"].as_u64().unwrap();
    assert_eq!(polygons.iter().sum::<usize>() as u64, boundary);
    assert!(!at.join("out.blocks").exists(), "the blocks are gone");
}

/// Starts a command and kills it when a file is there.
fn kill_when(at: &Path, command: &str, is_time: impl Fn() -> bool) -> bool {
    let mut child = Command::new(env!("CARGO_BIN_EXE_walpha"))
        .args(args(command))
        .current_dir(at)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    let killed = loop {
        assert!(begun.elapsed() < Duration::from_secs(300), "{command} does not end");
        if is_time() {
            // SIGKILL: nothing is cleaned up.
            child.kill().unwrap();
            break true;
        }
        if child.try_wait().unwrap().is_some() {
            break false;
        }
        std::thread::sleep(Duration::from_millis(1));
    };
    child.wait().unwrap();
    killed
}

/// The names of the files of finished blocks. They come in order of their size, not of their numbers.
fn finished(folder: &Path) -> impl Iterator<Item = String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.filter(|name| name.starts_with("block-"))
}

fn blocks_in(folder: &Path) -> usize {
    finished(folder).count()
}

#[test]
fn a_killed_run_loses_the_blocks_at_work_only() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let options = "sample:phantom@56 --weights min-max --blocks 24";
    let expected = json(at, &args(&format!("shape {options} -o whole.vtu")));
    ok(at, &args(&format!("blocks plan {options} -o work")));
    let (code, _, stderr) = run(at, &args("blocks merge work"));
    assert_eq!(code, 1);
    assert!(stderr.contains("24 of 24 blocks are missing: 0, 1, 2"), "{stderr}");

    let work = at.join("work");
    let killed = kill_when(at, "blocks run work --threads 1", || blocks_in(&work) >= 3);
    assert!(killed, "it was done before it could be killed");
    let done = blocks_in(&work);
    assert!((3..24).contains(&done), "{done}");
    let (code, _, stderr) = run(at, &args("blocks merge work"));
    assert_eq!(code, 1);
    assert!(stderr.contains(&format!("{} of 24 blocks are missing", 24 - done)), "{stderr}");

    let again = json(at, &args("blocks run work"));
    assert_eq!(again["blocks"].as_array().unwrap().len(), 24 - done, "only what was missing");
    let merged = json(at, &args("blocks merge work -o merged.vtu"));
    assert_eq!(lasting(merged), lasting(expected));
    let read = |name: &str| fs::read(at.join(name)).unwrap();
    assert!(read("merged.vtu") == read("whole.vtu"));
}

#[test]
fn a_killed_shape_goes_on_where_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let command = "shape sample:phantom@56 --blocks 24 --threads 1 -o out.pvtp";
    let work = at.join("out.blocks");
    assert!(kill_when(at, command, || blocks_in(&work) >= 2));
    let first = work.join(finished(&work).next().unwrap());
    let written = fs::metadata(&first).unwrap().modified().unwrap();
    // Held by a second name, so that it can be looked at when the folder is gone.
    fs::hard_link(&first, at.join("kept")).unwrap();
    // It may also have been killed in the middle of a file.
    fs::write(work.join(".walpha-half.part"), "half").unwrap();
    let report = json(at, &args(command));
    assert_eq!(fs::metadata(at.join("kept")).unwrap().modified().unwrap(), written);
    let expected = json(at, &args("shape sample:phantom@56 --blocks 4 -o one.vtp"));
    assert_eq!(lasting(report), lasting(expected));
    assert!(!work.exists());
}

/// `check` names what does not verify, `merge` does, and `run` mends it.
#[test]
fn damaged_files_are_named_and_mended() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    ok(at, &args("blocks plan sample:phantom@30 --blocks 4 -o work"));
    let (code, stdout, _) = run(at, &args("blocks check work"));
    assert!(code == 3 && stdout.contains("missing   0, 1, 2, 3"), "{stdout}");
    ok(at, &args("blocks run work"));
    let stdout = ok(at, &args("blocks check work"));
    assert!(stdout.contains("verified  4 blocks in work"), "{stdout}");
    assert_eq!(json(at, &args("blocks check work"))["whole"], true);
    ok(at, &args("blocks merge work -o before.vtu"));

    let flip = |name: &str, at: usize| {
        let path = folder.path().join(name);
        let mut bytes = fs::read(&path).unwrap();
        let last = bytes.len() - 1;
        bytes[at.min(last)] ^= 1;
        fs::write(path, bytes).unwrap();
    };
    flip("work/block-00001.walpha", usize::MAX);
    // A change in the header.
    flip("work/block-00003.walpha", 100);
    let (code, stdout, _) = run(at, &args("blocks check work --json"));
    let facts: Value = serde_json::from_str(&stdout).unwrap();
    let named: Vec<&str> =
        facts["findings"].as_array().unwrap().iter().map(|f| f["path"].as_str().unwrap()).collect();
    assert_eq!((code, named), (3, vec!["work/block-00001.walpha", "work/block-00003.walpha"]));
    for outputs in ["", " -o after.vtu", " -o after.pvtu"] {
        let (code, _, stderr) = run(at, &args(&format!("blocks merge work{outputs}")));
        assert_eq!(code, 1, "{stderr}");
        for word in ["2 files do not verify", "block-00001.walpha is damaged", "block-00003"] {
            assert!(stderr.contains(word), "{stderr}");
        }
        assert!(stderr.contains("walpha blocks run"), "{stderr}");
        assert!(!at.join("after.vtu").exists() && !at.join("after.pvtu").exists());
    }
    flip("work/sums.f64", 11);
    let again = json(at, &args("blocks run work"));
    assert_eq!(again["blocks"], serde_json::json!([1, 3]), "only what was damaged");
    ok(at, &args("blocks check work"));
    ok(at, &args("blocks merge work -o after.vtu"));
    assert!(fs::read(at.join("after.vtu")).unwrap() == fs::read(at.join("before.vtu")).unwrap());
    // A damaged file next to complete blocks is repaired, too.
    flip("work/sums.f64", 11);
    let (code, stdout, _) = run(at, &args("blocks check work"));
    assert!(code == 3 && stdout.contains("sums.f64"), "{stdout}");
    assert_eq!(json(at, &args("blocks run work"))["blocks"], serde_json::json!([]));
    ok(at, &args("blocks check work"));

    flip("work/plan.json", 200);
    let (code, stdout, _) = run(at, &args("blocks check work"));
    assert!(code == 3 && stdout.contains("plan.json: is damaged"), "{stdout}");
    for step in ["run work", "merge work"] {
        let (code, _, stderr) = run(at, &args(&format!("blocks {step}")));
        assert!(
            code == 1 && stderr.contains("plan.json") && stderr.contains("plan again"),
            "{stderr}"
        );
    }
}

#[test]
fn what_blocks_cannot_do_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("points.xyz"), "0 0 0\n1 0 0\n0 1 0\n0 0 1\n").unwrap();
    ok(at, &args("haar sample:phantom@20 -o packed.nii.gz"));
    let cases = [
        (2, "points.xyz", "holds points", "write another format"),
        (2, "-", "standard input cannot be read in parts", "name a file"),
        (1, "packed.nii.gz", "not read in parts", "convert it to uncompressed"),
        (2, "sample:phantom@20 --alpha auto", "is not possible in blocks", "give α as a number"),
        (2, "sample:phantom@20 --alpha inf", "is not possible in blocks", "give a finite α"),
        (2, "sample:phantom@20 --engine cgal", "is not possible in blocks", "engine native"),
        (2, "sample:phantom@20 -o out.pvtu", "out.pvtu is named twice", "name it once"),
        (2, "sample:phantom@20 --exterior", "whole triangulation", "omit --exterior"),
        (2, "sample:phantom@20 --select adaptive", "all points at once", "omit it"),
        (1, "sample:phantom@20 --downsample 2", "cannot be downsampled", "omit --downsample"),
        (1, "sample:phantom@20 --gray-min 999", "no voxel reaches", "--gray-min"),
        (1, "sample:phantom@20 --memory 1M", "is not enough", "allow more"),
    ];
    for (code, options, why, next) in cases {
        let (found, _, stderr) = run(at, &args(&format!("shape {options} -o out.pvtu")));
        assert_eq!(found, code, "{options}: {stderr}");
        assert!(stderr.contains(why) && stderr.contains(next), "{options}: {stderr}");
        assert!(!at.join("out.pvtu").exists(), "{options}");
    }
    let (code, _, stderr) = run(at, &args("blocks run nowhere 0"));
    assert!(code == 1 && stderr.contains("walpha blocks plan"), "{stderr}");
    ok(at, &args("blocks plan sample:phantom@20 --blocks 2 -o work"));
    let (code, _, stderr) = run(at, &args("blocks run work 2"));
    assert!(code == 1 && stderr.contains("from 0 to 1"), "{stderr}");
}

#[test]
fn the_price_is_told_without_work() {
    let folder = tempfile::tempdir().unwrap();
    let options = "sample:phantom@4096 --weights min-max --blocks 4096 --dry-run";
    let price = json(folder.path(), &args(&format!("blocks plan {options}")));
    assert_eq!(price["samples"], 4096u64.pow(3));
    assert_eq!(price["points"], (0.0609 * 4096f64.powi(3)).round() as u64);
    assert!(price["halo_share"].as_f64().unwrap() > 0.1);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
