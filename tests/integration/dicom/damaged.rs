//! Slices that make no volume, and damaged files.

use std::fs;

use super::{Slice, open, series, slice};
use crate::common::told::Told;

#[test]
fn what_makes_no_volume_is_told() {
    let at = |n: i16| slice(n, f64::from(n));
    let with = |group, number, kind: &'static [u8; 2], value: &str| Slice {
        changed: vec![(group, number, kind, value.into())],
        ..at(1)
    };
    let cases: [(Slice, &[&str]); 11] = [
        (Slice { position: [-10.0, 5.5, 5.0], ..at(1) }, &["gap of 3.000 mm", "slices missing: 1"]),
        (Slice { position: [-10.0, 5.5, 2.0], ..at(1) }, &["two slices at one place"]),
        (Slice { orientation: "0\\1\\0\\0\\0\\1", ..at(1) }, &["different orientations"]),
        (Slice { rows: 1, ..at(1) }, &["3×1 pixels"]),
        (with(0x28, 0x30, b"DS", "0.5\\0.5"), &["mm apart"]),
        (with(0x20, 0x32, b"DS", ""), &["no Image Position", "localisers"]),
        (with(0x28, 8, b"IS", "4"), &["has 4 frames and one place for all of them"]),
        (with(0x20, 0x32, b"DS", "1\\2"), &["no Image Position"]),
        (Slice { pixels: vec![1, 2], ..at(1) }, &["cannot be read"]),
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
