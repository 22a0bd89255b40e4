//! Files without a preamble, without a mark or without the group that says how they are encoded.

use std::fs;

use walpha::volume::{ReadOptions, format_name};

use super::{Slice, element, meta, open, slice};
use crate::common::{Told, fails, json};

/// A data set of types that are not stated.
fn implicit(slice: &Slice) -> Vec<u8> {
    let element = |(group, number, _, value): &super::Element| {
        let mut bytes = [group.to_le_bytes(), number.to_le_bytes()].concat();
        let length = value.len().next_multiple_of(2);
        bytes.extend((length as u32).to_le_bytes());
        bytes.extend(value);
        bytes.resize(8 + length, 0);
        bytes
    };
    slice.elements().iter().flat_map(element).collect()
}

/// A data set whose greatest bytes come first.
fn big(slice: &Slice) -> Vec<u8> {
    let swapped = |(group, number, kind, value): &super::Element| {
        let mut bytes = [group.to_be_bytes(), number.to_be_bytes()].concat();
        bytes.extend(*kind);
        let mut value = value.clone();
        value.resize(value.len().next_multiple_of(2), b' ');
        if [b"US", b"SS", b"OW"].contains(kind) {
            value.chunks_exact_mut(2).for_each(|word| word.swap(0, 1));
        }
        if *kind == b"OW" {
            bytes.extend([0, 0]);
            bytes.extend((value.len() as u32).to_be_bytes());
        } else {
            bytes.extend((value.len() as u16).to_be_bytes());
        }
        [bytes, value].concat()
    };
    slice.elements().iter().flat_map(swapped).collect()
}

#[test]
fn files_begin_in_several_ways() {
    let preamble = [0; 128];
    let mark = b"DICM";
    let explicit = meta("1.2.840.10008.1.2.1");
    // The group need not say how long it is.
    let unmeasured = explicit[12..].to_vec();
    let data = slice(1, 7.0).data();
    let guessed = [
        None,
        Some("explicit little endian"),
        Some("implicit little endian"),
        Some("explicit big endian"),
    ];
    let files: [(Vec<u8>, Option<&str>); 9] = [
        ([&preamble[..], mark, &explicit, &data].concat(), guessed[0]),
        ([&mark[..], &explicit, &data].concat(), guessed[0]),
        ([&explicit[..], &data].concat(), guessed[0]),
        ([&preamble[..], mark, &unmeasured, &data].concat(), guessed[0]),
        (
            [&preamble[..], mark, &meta("1.2.840.10008.1.2"), &implicit(&slice(1, 7.0))].concat(),
            guessed[0],
        ),
        ([&preamble[..], mark, &data].concat(), guessed[1]),
        (data.clone(), guessed[1]),
        (implicit(&slice(1, 7.0)), guessed[2]),
        (big(&slice(1, 7.0)), guessed[3]),
    ];
    for (k, (bytes, guessed)) in files.into_iter().enumerate() {
        let folder = tempfile::tempdir().unwrap();
        let f = folder.path();
        fs::write(f.join("IM1"), bytes).unwrap();
        let volume = open(f).unwrap_or_else(|error| panic!("{k}: {error}"));
        assert_eq!(volume.as_slice(), [10.0, 11.0, 12.0, 13.0, 14.0, 15.0], "{k}");
        assert_eq!(volume.frame().origin, [-10.0, 5.5, 7.0], "{k}");
        assert_eq!(format_name(f.join("IM1"), &ReadOptions::default()).unwrap(), "DICOM", "{k}");
        let warned = json(f, &["info", "IM1"])["warnings"].to_string();
        assert_eq!(warned.contains("is read as"), guessed.is_some(), "{k}: {warned}");
        assert!(warned.contains(guessed.unwrap_or_default()), "{k}: {warned}");
    }
}

#[test]
fn an_index_names_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::create_dir(f.join("IMG")).unwrap();
    (0..3).for_each(|n| slice(n, f64::from(n)).save(&f.join("IMG"), &n.to_string()));
    let records = element(4, 0x1220, b"SQ", b"");
    let index = [&[0; 128][..], b"DICM", &meta("1.2.840.10008.1.2.1"), &records].concat();
    for name in ["DICOMDIR", "index"] {
        fs::write(f.join(name), &index).unwrap();
        assert_eq!(open(f).unwrap().dims().xyz(), [3, 2, 3]);
        let text = open(&f.join(name)).unwrap_err().told();
        assert!(
            text.contains("is a DICOMDIR, the index") && text.contains("name its folder, "),
            "{text}"
        );
    }
    fails(f, 1, "info DICOMDIR", &["name its folder, ."]);
}

#[test]
fn other_files_are_named_as_what_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let png = [&b"\x89PNG\r\n\x1a\n"[..], &[0; 200]].concat();
    let files: [(&str, &[u8], &str); 5] = [
        ("page.dcm", b"<html>404</html>", "is an HTML page"),
        ("text.dcm", b"404 not found", "is called .dcm, and is not a DICOM file"),
        ("zeros.IMA", &[0; 500], "is called .IMA, and is not a DICOM file"),
        ("picture.dcm", &png, "is a PNG picture"),
        ("empty.dcm", b"", "is empty"),
    ];
    for (name, bytes, words) in files {
        fs::write(f.join(name), bytes).unwrap();
        let text = open(&f.join(name)).unwrap_err().told();
        assert!(text.contains(words) && !text.contains("copy it again"), "{text}");
        fs::remove_file(f.join(name)).unwrap();
    }
    (0..3).for_each(|n| slice(n, f64::from(n)).save(f, &format!("{n}.dcm")));
    fs::write(f.join("picture.dcm"), &png).unwrap();
    let text = open(f).unwrap_err().told();
    assert!(
        text.contains("picture.dcm: is a PNG picture, one slice, beside DICOM files"),
        "{text}"
    );
    assert!(
        text.contains("move it out of the folder, or go on without it: `skip_damaged`"),
        "{text}"
    );
}
