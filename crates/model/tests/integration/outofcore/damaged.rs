//! Files of a plan that are not what was written, and inputs that are not what was planned.

use std::fs;
use std::path::{Path, PathBuf};

use walpha_model::Advise;
use walpha_model::export::{ExportOptions, Format};
use walpha_model::outofcore::{Alone, BlocksError, Job, Plan, merge, run, whole};
use walpha_points::Weighting;
use walpha_points::haar::{Decomposition, Tolerance};
#[cfg(feature = "zarr")]
use walpha_volume::Source;
use walpha_volume::{ReadOptions, open};

use super::planned;

/// A plan with all its blocks.
fn done(job: &Job, blocks: usize, folder: &Path) -> Plan {
    let plan = planned(job, blocks, folder);
    (0..plan.blocks.len()).for_each(|block| run(&plan, block).unwrap());
    plan
}

/// The output of merging.
fn merged(plan: &Plan) -> Result<Vec<u8>, BlocksError> {
    let merged = merge(plan)?;
    let shape = whole(plan, &merged)?;
    let exporter = Format::of(Path::new("a.json")).unwrap().exporter(&ExportOptions::default());
    let mut bytes = Vec::new();
    exporter.write(&shape, &mut bytes).unwrap();
    Ok(bytes)
}

fn small(decomposition: Decomposition) -> Job {
    let mut job = super::job("sample:phantom@12");
    job.recipe.weighting = Some(Weighting::MinMax);
    job.recipe.haar = job.recipe.haar.decomposition(decomposition).tolerance(Tolerance::Rms(2.0));
    job
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

fn name(path: &Path) -> &str {
    path.file_name().unwrap().to_str().unwrap()
}

/// One bit of every byte is flipped: the merged output is right, or there is none, and the file is named.
#[test]
fn no_flipped_bit_makes_a_wrong_shape() {
    for decomposition in [Decomposition::NonStandard, Decomposition::Standard] {
        let folder = tempfile::tempdir().unwrap();
        let mut job = small(decomposition);
        // Use no more points than needed.
        job.recipe.choice = super::selected(walpha_points::SelectionRule::Count(16));
        let plan = done(&job, 2, folder.path());
        let expected = merged(&plan).unwrap();
        assert!(plan.check().unwrap().is_whole());
        let (mut named, mut harmless) = (0, 0);
        for path in files(folder.path()) {
            let sound = fs::read(&path).unwrap();
            let is_block = name(&path).starts_with("block-");
            for i in 0..sound.len() {
                let mut bytes = sound.clone();
                bytes[i] ^= 1 << (i % 8);
                fs::write(&path, bytes).unwrap();
                let what = format!("{} at {i}", path.display());
                let opened = Plan::open(folder.path());
                if name(&path) == "plan.json" {
                    let error = opened.expect_err(&what);
                    assert!(error.to_string().contains("plan.json"), "{what}: {error}");
                    assert!(error.advice().is_some());
                    continue;
                }
                let plan = opened.expect(&what);
                if i % 16 == 0 {
                    let checked = plan.check().expect(&what);
                    let found: Vec<&Path> =
                        checked.findings.iter().map(|finding| finding.path.as_path()).collect();
                    assert_eq!(found, [path.as_path()], "{what}");
                }
                match merged(&plan) {
                    Ok(shape) => {
                        assert!(shape == expected, "{what}: another shape");
                        harmless += 1;
                    }
                    Err(error) => {
                        assert!(
                            is_block && error.to_string().contains(name(&path)),
                            "{what}: {error}"
                        );
                        named += 1;
                    }
                }
            }
            fs::write(&path, sound).unwrap();
        }
        assert!(named > 5000 && harmless > 0, "{named} {harmless}");
        assert!(merged(&plan).unwrap() == expected);
    }
}

#[test]
fn a_file_that_is_cut_or_missing_is_made_again() {
    for decomposition in [Decomposition::NonStandard, Decomposition::Standard] {
        let folder = tempfile::tempdir().unwrap();
        let plan = done(&small(decomposition), 3, folder.path());
        let expected = merged(&plan).unwrap();
        let damages: [fn(&mut Vec<u8>); 5] = [
            |bytes| bytes.truncate(bytes.len() - 8),
            |bytes| bytes.clear(),
            |bytes| bytes.extend([0; 8]),
            |bytes| {
                let middle = bytes.len() / 2;
                bytes[middle] ^= 64;
            },
            |bytes| bytes.iter_mut().for_each(|byte| *byte = 0xff),
        ];
        for path in files(folder.path()).into_iter().filter(|path| name(path) != "plan.json") {
            let sound = fs::read(&path).unwrap();
            for damage in damages {
                let mut bytes = sound.clone();
                damage(&mut bytes);
                fs::write(&path, &bytes).unwrap();
                let findings = plan.check().unwrap().findings;
                assert!(findings.len() == 1 && findings[0].path == path, "{findings:?}");
                // A block that is there needs nothing of what the plan keeps.
                (1..3).for_each(|block| fs::remove_file(plan.block_file(block)).unwrap());
                (0..3).for_each(|block| run(&plan, block).unwrap());
                assert!(fs::read(&path).unwrap() == sound, "{} is what it was", path.display());
                assert!(merged(&plan).unwrap() == expected);
            }
            fs::remove_file(&path).unwrap();
            assert!(!plan.check().unwrap().is_whole());
            (0..3).for_each(|block| {
                let _ = fs::remove_file(plan.block_file(block));
            });
            (0..3).for_each(|block| run(&plan, block).unwrap());
            assert!(fs::read(&path).unwrap() == sound && plan.check().unwrap().is_whole());
        }
    }
}

#[test]
fn a_block_in_the_place_of_another_is_named_and_made_again() {
    let folder = tempfile::tempdir().unwrap();
    let plan = done(&small(Decomposition::NonStandard), 3, folder.path());
    let expected = merged(&plan).unwrap();
    fs::copy(plan.block_file(2), plan.block_file(1)).unwrap();
    let error = merged(&plan).unwrap_err().to_string();
    assert!(error.contains("block-00001.walpha") && error.contains("is block 2, not 1"), "{error}");
    assert_eq!(plan.missing().unwrap(), [1]);
    let error = plan.verify_blocks().unwrap_err();
    assert!(error.to_string().starts_with("1 file does not verify"), "{error}");
    assert!(error.advice().unwrap().to_string().contains("walpha blocks run"));
    run(&plan, 1).unwrap();
    assert!(merged(&plan).unwrap() == expected);
}

/// A volume in a file: the phantom, uncompressed.
fn written(path: &Path, change: impl FnOnce(&mut [f32])) {
    sized(path, 40, change);
}

fn sized(path: &Path, n: usize, change: impl FnOnce(&mut [f32])) {
    let phantom = open(format!("sample:phantom@{n}"), &ReadOptions::default()).unwrap();
    let mut samples = phantom.as_slice().to_vec();
    change(&mut samples);
    let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({n}, {n}, {n}), }}");
    let header = format!("{header:<117}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(samples.iter().flat_map(|v| v.to_le_bytes()));
    fs::write(path, bytes).unwrap();
}

#[test]
fn an_input_that_changed_is_refused_where_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("a.npy");
    written(&input, |_| {});
    let job = Job::new(input.to_str().unwrap(), walpha_model::Recipe::new()).unwrap();
    let work = folder.path().join("work");
    fs::create_dir(&work).unwrap();
    let plan = planned(&job, 4, &work);
    run(&plan, 0).unwrap();

    // One sample in the last corner changes by so little that the same points are selected.
    written(&input, |samples| samples[samples.len() - 1] += 1e-3);
    let changed = |plan: &Plan, block: usize| match run(plan, block) {
        Ok(()) => false,
        Err(BlocksError::Changed { .. }) => true,
        Err(error) => panic!("{error}"),
    };
    assert!(changed(&plan, 3), "the last block reads the last corner");
    assert!(!plan.block_file(3).exists());
    let error = run(&plan, 3).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("a.npy has changed since it was planned"), "{text}");
    assert!(error.advice().unwrap().to_string().contains("plan again"));

    // A file of another size.
    sized(&input, 20, |_| {});
    let text = run(&plan, 2).unwrap_err().to_string();
    assert!(text.contains("20×20×20 samples, not 40×40×40"), "{text}");

    // The original content, regardless of the time of writing.
    written(&input, |_| {});
    (0..4).for_each(|block| run(&plan, block).unwrap());
    let expected = {
        let other = folder.path().join("other");
        fs::create_dir(&other).unwrap();
        merged(&done(&job, 4, &other)).unwrap()
    };
    assert!(merged(&plan).unwrap() == expected);
}

/// A plan is one of its input however often that is written, and its blocks stay.
#[test]
fn work_goes_on_where_an_input_was_touched_and_anew_where_it_changed() {
    let folder = tempfile::tempdir().unwrap();
    let (input, work) = (folder.path().join("a.npy"), folder.path().join("work"));
    fs::create_dir(&work).unwrap();
    written(&input, |_| {});
    let job = Job::new(input.to_str().unwrap(), walpha_model::Recipe::new()).unwrap();
    let cutting = walpha_model::outofcore::Cutting::default().blocks(4);
    let plan = Plan::resume(job.clone(), cutting, &work, &Alone).unwrap();
    run(&plan, 0).unwrap();
    let touch = |seconds| {
        let file = fs::File::options().write(true).open(&input).unwrap();
        file.set_modified(std::time::SystemTime::now() + std::time::Duration::from_secs(seconds))
            .unwrap();
    };
    touch(100);
    run(&plan, 1).unwrap();
    let again = Plan::resume(job.clone(), cutting, &work, &Alone).unwrap();
    assert_eq!(again.digest(), plan.digest());
    assert_eq!(again.missing().unwrap(), [2, 3]);
    written(&input, |samples| samples[samples.len() - 1] += 1e-3);
    touch(200);
    let other = Plan::resume(job, cutting, &work, &Alone).unwrap();
    assert_ne!(other.digest(), plan.digest());
    assert_eq!(other.missing().unwrap(), [0, 1, 2, 3]);
}

/// One chunk in a folder of chunks changed.
#[cfg(feature = "zarr")]
#[test]
fn a_chunk_that_changed_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let convert = |name: &str, change: fn(&mut [f32])| {
        let from = folder.path().join("a.npy");
        sized(&from, 70, change);
        let source = Source::open(from.to_str().unwrap(), &ReadOptions::default()).unwrap();
        let path = folder.path().join(name);
        walpha_volume::convert(&source, &path).unwrap();
        path
    };
    let input = convert("a.zarr", |_| {});
    // The change is so small that the same points are selected.
    let other = convert("b.zarr", |samples| samples[samples.len() - 1] += 1e-3);
    let work = folder.path().join("work");
    fs::create_dir(&work).unwrap();
    let job = Job::new(input.to_str().unwrap(), walpha_model::Recipe::new()).unwrap();
    let plan = planned(&job, 2, &work);
    run(&plan, 0).unwrap();
    let chunk = Path::new("c/1/1/1");
    let to = input.join(chunk);
    fs::create_dir_all(to.parent().unwrap()).unwrap();
    fs::copy(other.join(chunk), to).unwrap();
    let error = run(&plan, 1).unwrap_err();
    assert!(matches!(error, BlocksError::Changed { .. }), "{error}");
}
