//! The remains of a failure or an interrupt.

use super::*;

#[test]
fn a_file_that_may_not_grow_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    // The tables are shorter than that, the picture is longer.
    let args = ["ladder", "sample:phantom@16", "-o", "out"];
    let output = limited(folder.path(), Resource::RLIMIT_FSIZE, 20_000, &args);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{:?} {said}", output.status);
    for word in ["ladder.png", "File too large", "nothing was left behind"] {
        assert!(said.contains(word), "no {word:?} in {said}");
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0, "{said}");

    let args = ["shape", "sample:phantom@16", "-o", "a.off", "b.json"];
    let output = limited(folder.path(), Resource::RLIMIT_FSIZE, 100_000, &args);
    assert_eq!(output.status.code(), Some(1), "{:?}", output.status);
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0, "a.off was complete, b.json was not");
}

/// Pieces, which are complete, go with the file that is not.
#[test]
fn pieces_are_written_with_all_outputs_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    ok(f, &["blocks", "plan", "sample:phantom@24", "--blocks", "6", "-o", "work"]);
    ok(f, &["blocks", "run", "work"]);
    let whole = ["blocks", "merge", "work", "-o", "a.pvtu", "b.json"];
    ok(f, &whole);
    let bytes = |name: &str| fs::metadata(f.join(name)).unwrap().len();
    let pieces = fs::read_dir(f.join("a")).unwrap();
    let largest = pieces.map(|piece| piece.unwrap().metadata().unwrap().len()).max().unwrap();
    let limit = u64::midpoint(largest, bytes("b.json"));
    assert!(limit > largest && limit < bytes("b.json"), "{largest} {limit}");
    // Once without existing files, and once with them.
    for with in [true, false] {
        if with {
            fs::remove_dir_all(f.join("a")).unwrap();
            fs::remove_file(f.join("a.pvtu")).unwrap();
            fs::remove_file(f.join("b.json")).unwrap();
        }
        let before: Vec<_> = tree(f);
        let output = limited(f, Resource::RLIMIT_FSIZE, limit, &whole);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains("b.json") && said.contains("nothing was left behind"), "{said}");
        assert!(tree(f) == before, "{:?}\n{said}", names(&tree(f)));
        ok(f, &whole);
    }
    #[cfg(feature = "zarr")]
    {
        let before = tree(f);
        let args = ["blocks", "merge", "work", "-o", "c.zarr", "d.json"];
        let output = limited(f, Resource::RLIMIT_FSIZE, limit, &args);
        assert_eq!(output.status.code(), Some(1));
        assert!(tree(f) == before, "{:?}", names(&tree(f)));
    }
}

fn names(files: &[(std::path::PathBuf, Vec<u8>)]) -> Vec<&Path> {
    files.iter().map(|(path, _)| path.as_path()).collect()
}

/// All files below a folder with their bytes.
fn tree(folder: &Path) -> Vec<(std::path::PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        if entry.path().is_dir() {
            found.push((entry.path(), Vec::new()));
            found.extend(tree(&entry.path()));
        } else {
            found.push((entry.path(), fs::read(entry.path()).unwrap()));
        }
    }
    found.sort();
    found
}

/// The content is overwritten only where there is room for it.
#[test]
fn a_file_with_other_names_survives_a_lack_of_room() {
    let folder = tempfile::tempdir().unwrap();
    let [file, other] = ["a.npy", "other.npy"].map(|name| folder.path().join(name));
    fs::write(&file, "precious").unwrap();
    fs::hard_link(&file, &other).unwrap();
    let output = limited(folder.path(), Resource::RLIMIT_FSIZE, 1000, &HAAR);
    assert_eq!(output.status.code(), Some(1), "{:?}", output.status);
    assert_eq!(fs::read_to_string(&other).unwrap(), "precious");
}

#[test]
fn an_interrupt_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let cases: [&[&str]; 3] = [
        &["shape", "sample:phantom@128", "--ratio", "0.3", "-o", "a.ply", "b.vtu"],
        &["ladder", "sample:phantom@128", "--ratio", "0.3", "-o", "made"],
        &["reproduce", "--input", "sample:phantom@64", "--out", "made"],
    ];
    for args in cases {
        for signal in [Signal::SIGINT, Signal::SIGTERM] {
            let mut command = Command::new(env!("CARGO_BIN_EXE_walpha"));
            let mut child = command.args(args).current_dir(&folder).spawn().unwrap();
            let count = || fs::read_dir(&folder).unwrap().count();
            while count() == 0 {
                assert!(child.try_wait().unwrap().is_none(), "done before it was interrupted");
            }
            kill(Pid::from_raw(child.id() as i32), signal).unwrap();
            assert_eq!(child.wait().unwrap().code(), Some(130), "{signal} {args:?}");
            assert_eq!(count(), 0, "{signal} {args:?}");
        }
    }
}

/// With too little memory a command says so, and removes its unfinished files.
#[test]
fn a_lack_of_memory_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let cases: [&[&str]; 4] = [
        &["haar", "sample:phantom@160", "-o", "a.npy"],
        &["view", "sample:phantom@48", "-o", "a.html"],
        &["shape", "sample:phantom@48", "-o", "a.ply", "a.png"],
        &["ladder", "sample:phantom@48", "-o", "made"],
    ];
    let mut failed = 0;
    for args in cases {
        for megabytes in [60, 80, 110, 140, 200, 300] {
            let output = limited(folder.path(), Resource::RLIMIT_AS, megabytes << 20, args);
            let said = String::from_utf8_lossy(&output.stderr);
            let code = output.status.code();
            assert!(
                matches!(code, Some(0 | 1)),
                "{args:?} {megabytes} MB: {:?} {said}",
                output.status
            );
            let mut left = fs::read_dir(&folder).unwrap();
            if code == Some(1) {
                failed += 1;
                assert!(said.contains("error: walpha") && said.contains(" next: "), "{said}");
                assert!(left.next().is_none(), "{args:?} {megabytes} MB left something behind");
            }
            for entry in left {
                let path = entry.unwrap().path();
                let _ =
                    if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
            }
        }
    }
    assert!(failed > 4, "{failed} runs had too little memory");
}

#[test]
fn sizes_beyond_all_memory_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let few = 400 << 20;
    let cases: [(&[&str], &str); 3] = [
        (&["haar", "sample:phantom@1000"], "needs 3814 MiB"),
        (&["interpolate", "sample:phantom@8", "--dims", "1000,1000,1000"], "needs 3814 MiB"),
        (&["shape", "sample:phantom@8", "-o", "a.png", "--size", "16384x16384"], "needs 1024 MiB"),
    ];
    for (args, words) in cases {
        let output = limited(folder.path(), Resource::RLIMIT_AS, few, args);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(1) && said.contains(words), "{args:?}: {said}");
    }
    // There is room for the samples, with what the allocator reserves for a thread or two that begin, and not
    // for 12 bytes more of each.
    let args = ["haar", "sample:phantom@256", "--threads", "1"];
    let output = limited(folder.path(), Resource::RLIMIT_AS, 360 << 20, &args);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(1) && said.contains("needs 192 MiB"), "{said}");
}

/// The variable that rayon reads is bounded as the option is: 10 000 stacks would not have room here, and the
/// command would say so.
#[test]
fn threads_of_the_environment_are_bounded() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["haar", "sample:phantom@8"];
    let variables = [("RAYON_NUM_THREADS", "10000")];
    let output = limited_with(&variables, folder.path(), Resource::RLIMIT_AS, 8 << 30, &args);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), said.contains("threads start")), (Some(0), false), "{said}");
}

/// No block is small enough: the shape is refused before anything of it is computed.
#[test]
fn a_memory_that_no_block_fits_is_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["shape", "sample:phantom@192", "--memory", "1K", "--alpha", "10000"];
    // Computed it takes minutes of a processor, and half of one to count the points around every block.
    let output = limited(folder.path(), Resource::RLIMIT_CPU, 15, &args);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    for word in ["1 KiB of memory", "are needed", "next: "] {
        assert!(said.contains(word), "no {word:?} in {said}");
    }
}

/// An exception of C++ about a lack of memory arrives as such an error.
#[test]
fn cpp_says_that_it_has_no_memory() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["shape", "sample:phantom@64", "--count", "40000", "--engine", "cgal"];
    let named = [60, 80, 100, 120, 140, 160, 180, 200].into_iter().any(|megabytes| {
        let output = limited(folder.path(), Resource::RLIMIT_AS, megabytes << 20, &args);
        let said = String::from_utf8(output.stderr).unwrap();
        said.contains("no memory for the alpha shape: C++ ran out of it")
            && output.status.code() == Some(1)
    });
    assert!(named);
}

#[test]
fn an_endless_device_is_not_read_to_its_end() {
    if !Path::new("/dev/zero").exists() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.vti", "a.vtu", "a.vtp"] {
        symlink("/dev/zero", folder.path().join(name)).unwrap();
        let started = Instant::now();
        // A gigabyte is soon full of it.
        let output = limited(folder.path(), Resource::RLIMIT_AS, 1 << 30, &["info", name]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{:?} {said}", output.status);
        assert!(said.contains(name) && said.contains("not an ordinary file"), "{said}");
        assert!(started.elapsed() < Duration::from_secs(5), "{name}");
    }
}
