//! What lies beside slices: files of no concern, and slices that were damaged.

use std::fs;
use std::path::Path;

use walpha::volume::{ReadOptions, read};

use super::{Slice, open, slice};
use crate::common::told::Told;
use crate::common::{fails, json, ok};

/// Slices at 0 to 4 mm, called s0.dcm to s4.dcm.
fn five(folder: &Path) {
    for n in 0..5 {
        slice(n, f64::from(n)).save(folder, &format!("s{n}.dcm"));
    }
}

#[test]
fn a_named_file_is_not_refused_for_its_neighbours() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    slice(1, 7.0).save(f, "CT_small.dcm");
    let colours = (0x28, 2, b"US", vec![3, 0]);
    Slice { series: "9.9", changed: vec![colours], ..slice(2, 8.0) }.save(f, "SC_rgb.dcm");
    let whole = slice(1, 7.0).bytes();
    fs::write(f.join("cut.dcm"), &whole[..150]).unwrap();
    fs::write(f.join("empty.dcm"), "").unwrap();
    let volume = open(&f.join("CT_small.dcm")).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(volume.dims().xyz(), [3, 2, 1]);
    let told = json(f, &["info", "CT_small.dcm"]);
    assert_eq!(told["dims"], serde_json::json!([3, 2, 1]));
    let warned = told["warnings"].to_string();
    assert!(warned.contains("cut.dcm is left out") && warned.contains("empty.dcm"), "{warned}");
}

#[test]
fn damaged_slices_are_named_wherever_they_are() {
    type Damage = fn(&[u8]) -> Vec<u8>;
    let damage: [(&str, Damage); 7] = [
        ("empty", |_| Vec::new()),
        ("zeroed", |whole| vec![0; whole.len()]),
        ("cut before the mark", |whole| whole[..100].to_vec()),
        ("cut before the series", |whole| {
            let named = whole.windows(6).position(|start| start == b"\x20\0\x0e\0UI").unwrap();
            whole[..named].to_vec()
        }),
        ("cut in the header", |whole| whole[..400].to_vec()),
        ("cut in the pixels", |whole| whole[..whole.len() - 5].to_vec()),
        ("not DICOM", |_| b"<html>404</html>".to_vec()),
    ];
    for (how, damage) in damage {
        let ruin = |path: &Path| fs::write(path, damage(&fs::read(path).unwrap())).unwrap();
        for (end, first) in [("s0.dcm", 1.0), ("s4.dcm", 0.0)] {
            let folder = tempfile::tempdir().unwrap();
            let f = folder.path();
            five(f);
            ruin(&f.join(end));
            for path in [f.to_owned(), f.join("s2.dcm")] {
                let error = open(&path).expect_err(how).told();
                assert!(error.contains(end) && error.contains("`skip_damaged`"), "{how}: {error}");
                let volume = read(&path, &ReadOptions::default().skip_damaged(true))
                    .unwrap_or_else(|e| panic!("{how}: {e}"));
                assert_eq!(volume.dims().xyz(), [3, 2, 4], "{how}");
                assert_eq!(volume.frame().origin[2], first, "{how}");
                assert_eq!(volume.as_slice()[0], 10.0 * first as f32, "{how}");
            }
            let told = json(f, &["info", "s2.dcm", "--skip-damaged"]);
            let warned = told["warnings"].to_string();
            assert!(warned.contains(end) && warned.contains("left out"), "{how}: {warned}");
            fails(f, 1, "info .", &[end, "--skip-damaged"]);
        }
        // One that is missed inside is a gap, whatever is skipped.
        let folder = tempfile::tempdir().unwrap();
        let f = folder.path();
        five(f);
        ruin(&f.join("s2.dcm"));
        assert!(open(f).expect_err(how).told().contains("s2.dcm"));
        let skipped = read(f, &ReadOptions::default().skip_damaged(true)).expect_err(how).told();
        assert!(skipped.contains("gap of 2.000 mm"), "{how}: {skipped}");
    }
}

#[test]
fn other_files_are_of_no_concern() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    five(f);
    fs::write(f.join("notes.txt"), "").unwrap();
    fs::write(f.join("README"), "slices of a phantom").unwrap();
    fs::write(f.join("._s0.dcm"), [0; 200]).unwrap();
    assert_eq!(open(f).unwrap().dims().xyz(), [3, 2, 5]);
    assert!(!ok(f, &["info", "."]).contains("left out"));
    // Where slices have no extension, either, it takes more to look like one of them.
    let bare = tempfile::tempdir().unwrap();
    (0..3).for_each(|n| slice(n, f64::from(n)).save(bare.path(), &format!("IM{n}")));
    fs::write(bare.path().join("README"), "slices of a phantom").unwrap();
    assert_eq!(open(bare.path()).unwrap().dims().xyz(), [3, 2, 3]);
    fails(f, 2, "info notes.txt --skip-damaged --dims 1,1,1 --dtype u8", &["cannot be used with"]);
}
