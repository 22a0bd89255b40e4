//! Series among others in a folder.

use std::fs;

use walpha::volume::{ReadOptions, read};

use super::{Slice, open, slice};
use crate::common::told::Told;

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
    // Named itself, the slice is read: the folders beside it are not looked into.
    assert_eq!(open(&folder.path().join("a.dcm")).unwrap().dims().xyz(), [3, 2, 1]);
}
