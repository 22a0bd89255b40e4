//! The shared parts of the tests of volumes' fields.

use std::path::Path;

use walpha::Volume;
use walpha::volume::{ReadOptions, read};

use crate::common::json;
use crate::formats::files::{numbers, open};

/// The volume in a file that can be read.
#[track_caller]
pub fn volume(path: &Path) -> Volume {
    open(path).unwrap_or_else(|error| panic!("{error}"))
}

/// A volume of a file with several.
#[track_caller]
pub fn frame(path: &Path, frame: u64) -> Volume {
    read(path, &ReadOptions::default().frame(frame)).unwrap_or_else(|error| panic!("{error}"))
}

/// Asserts that the samples are those of `numbers`.
#[track_caller]
pub fn same(path: &Path) {
    assert_eq!(volume(path).as_slice(), numbers());
}

/// Asserts that the samples are the same, and that nothing is said about them.
#[track_caller]
pub fn same_without_a_word(path: &Path) {
    same(path);
    let report = json(path.parent().unwrap(), &["info", path.to_str().unwrap()]);
    let warnings = report["warnings"].as_array().cloned().unwrap_or_default();
    assert_eq!(warnings, Vec::<serde_json::Value>::new());
}
