//! DICOM series among other files in a folder, and damaged ones.

use std::fs;
use std::path::Path;

use walpha::volume::{ReadOptions, read};

use super::{Slice, open, series, slice};
use crate::common::{Told, fails, json, ok};

#[test]
fn one_file_stands_for_its_series() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for n in 0..3 {
        slice(n, f64::from(n)).save(f, &format!("a{n}"));
        let other = Slice { series: "9.9", position: [0.0, 0.0, f64::from(n)], ..slice(n, 0.0) };
        other.save(f, &format!("b{n}.dcm"));
    }
    fs::write(f.join("notes.txt"), "no slice").unwrap();
    assert_eq!(open(&f.join("a1")).unwrap().frame().origin, [-10.0, 5.5, 0.0]);
    assert_eq!(open(&f.join("b2.dcm")).unwrap().frame().origin, [0.0; 3]);
    let text = open(f).unwrap_err().told();
    assert!(text.contains("2 DICOM series") && text.contains("b0.dcm"), "{text}");
}

#[test]
fn series_in_nested_folders_are_listed_and_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for n in 0..3i16 {
        let deep = f.join(format!("disc/{n}"));
        fs::create_dir_all(&deep).unwrap();
        slice(n, f64::from(n)).save(&deep, "slice");
        let other =
            Slice { series: "1.2.9", rows: 1, pixels: vec![n; 3], ..slice(n, 2.0 * f64::from(n)) };
        other.save(&deep, "other.dcm");
    }
    let of =
        |series: Option<&str>| read(f, &ReadOptions::default().series(series.map(str::to_owned)));
    let text = of(None).unwrap_err().told();
    assert!(text.contains("2 DICOM series") && text.contains("`series`"), "{text}");
    assert!(text.contains("3 slices of 3×1, 1.2.9, as "), "{text}");
    assert_eq!(of(Some("1")).unwrap().dims().xyz(), [3, 1, 3]);
    assert_eq!(of(Some(".9")).unwrap().dims().xyz(), [3, 1, 3]);
    assert_eq!(of(Some("2")).unwrap().dims().xyz(), [3, 2, 3]);
    assert!(of(Some("3")).unwrap_err().told().contains("no series 3"));
    let listed = walpha::volume::series(f).unwrap();
    assert_eq!(
        listed.iter().map(|one| (one.number, one.slices)).collect::<Vec<_>>(),
        [(1, 3), (2, 3)]
    );
    let frame = *of(Some("2")).unwrap().frame();
    assert_eq!(frame.coordinates, walpha::Coordinates::PATIENT);
}

/// A folder may be that of the whole disk: it is not walked to its end in search of slices.
#[test]
fn a_folder_of_ten_thousand_other_files_is_no_series() {
    let folder = tempfile::tempdir().unwrap();
    let others = folder.path().join("others");
    fs::create_dir(&others).unwrap();
    for i in 0..10_001 {
        fs::write(others.join(i.to_string()), "").unwrap();
    }
    let error = open(folder.path()).unwrap_err().told();
    assert!(!error.contains("DICOM files among"), "there is none: {error}");
    slice(1, 0.0).save(folder.path(), "a.dcm");
    let error = open(folder.path()).unwrap_err().told();
    assert!(error.contains("DICOM files among more than 10000 others"), "{error}");
    // A slice that is named itself is read: the folders next to it are not searched.
    assert_eq!(open(&folder.path().join("a.dcm")).unwrap().dims().xyz(), [3, 2, 1]);
}

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
        // A missing slice inside is a gap, regardless of skipped files.
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
    // If slices have no extension, either, a file must have more of their features to look like one.
    let bare = tempfile::tempdir().unwrap();
    (0..3).for_each(|n| slice(n, f64::from(n)).save(bare.path(), &format!("IM{n}")));
    fs::write(bare.path().join("README"), "slices of a phantom").unwrap();
    assert_eq!(open(bare.path()).unwrap().dims().xyz(), [3, 2, 3]);
    fails(f, 2, "info notes.txt --skip-damaged --dims 1,1,1 --dtype u8", &["cannot be used with"]);
}

#[test]
fn what_makes_no_volume_is_told() {
    let at = |n: i16| slice(n, f64::from(n));
    let with = |group, number, kind: &'static [u8; 2], value: &str| Slice {
        changed: vec![(group, number, kind, value.into())],
        ..at(1)
    };
    let cases: [(Slice, &[&str]); 14] = [
        (
            Slice { position: [-10.0, 5.5, 5.0], ..at(1) },
            &["gap of 3.000 mm", "neither the place of whole"],
        ),
        (Slice { position: [-10.0, 5.5, 2.0], ..at(1) }, &["two slices at one place"]),
        (Slice { orientation: "0\\1\\0\\0\\0\\1", ..at(1) }, &["different orientations"]),
        (Slice { rows: 1, ..at(1) }, &["3×1 pixels"]),
        (with(0x28, 0x30, b"DS", "0.5\\0.5"), &["mm apart"]),
        (with(0x20, 0x32, b"DS", ""), &["no Image Position", "localisers"]),
        (
            Slice { pixels: vec![0; 24], ..with(0x28, 8, b"IS", "4") },
            &["has 4 frames and one place for all of them"],
        ),
        (with(0x28, 8, b"IS", "4"), &["which are 48 bytes, and 12 bytes of them"]),
        (
            with(0x20, 0x32, b"DS", "1\\2"),
            &["has Image Position (Patient) (0020,0032)", "not 3 numbers"],
        ),
        (
            with(0x28, 0x30, b"DS", "0,5\\0,75"),
            &["has Pixel Spacing (0028,0030) \"0,5\\\\0,75\", which is not"],
        ),
        (with(8, 8, b"CS", "ORIGINAL\\PRIMARY\\MOSAIC"), &["is a mosaic", "dcm2niix"]),
        (Slice { pixels: vec![1, 2], ..at(1) }, &["which are 12 bytes, and 4 bytes of them"]),
        // Found by fuzzing: a table of as many values as these bits make.
        (with(0x28, 0x101, b"US", "\0\0"), &["claims 0 bits of the 16"]),
        (with(0x28, 0x101, b"US", "\x20\0"), &["claims 32 bits of the 16"]),
    ];
    for (other, parts) in cases {
        let text = series(&[at(0), other.clone(), at(2)]).unwrap_err();
        for part in parts {
            assert!(text.contains(part), "{part:?} is missing in {text}");
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let whole = at(0).bytes();
    for length in [132, 150, 200, 300, whole.len() - 40, whole.len() - 1] {
        fs::write(folder.path().join("a.dcm"), &whole[..length]).unwrap();
        let text = open(&folder.path().join("a.dcm")).unwrap_err().told();
        assert!(text.contains("a.dcm"), "{length}: {text}");
    }
    // An element that claims more than there is: of the data, and of the file's own table.
    let lies = |mark: &[u8], length: usize, claim: &[u8]| {
        let mut bytes = at(0).bytes();
        let place = bytes.windows(mark.len()).position(|part| part == mark).unwrap();
        bytes[place + length..place + length + claim.len()].copy_from_slice(claim);
        fs::write(folder.path().join("a.dcm"), bytes).unwrap();
        open(&folder.path().join("a.dcm")).unwrap_err().told()
    };
    let text = lies(b"\xe0\x7f\x10\x00OW", 8, &[0, 0, 0, 0x4e]);
    assert!(text.contains("claims an element of 1308622848 bytes"), "{text}");
    let text = lies(b"\x02\x00\x01\x00OB", 8, &[0, 0, 0, 0x4e]);
    assert!(text.contains("claims an element of 1308622848 bytes"), "{text}");
}
