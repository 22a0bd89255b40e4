//! WVM, as `walpha points` writes it.

use std::path::{Path, PathBuf};

use walpha::points::{PointOptions, read_model};

use super::{Fate, Field, walk};
use crate::common::ok;

fn made(folder: &Path) -> PathBuf {
    ok(
        folder,
        &["points", "sample:phantom@16", "--count", "200", "--weights", "min-max", "-o", "a.wvm"],
    );
    folder.join("a.wvm")
}

/// The file of [`made`] with its bytes changed.
fn changed(folder: &Path, change: fn(&mut Vec<u8>)) -> PathBuf {
    let path = made(folder);
    let mut bytes = std::fs::read(&path).unwrap();
    change(&mut bytes);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn facts(path: &Path) -> (walpha::Points, walpha::points::ModelMetadata) {
    read_model(path, &PointOptions::default()).unwrap()
}

#[test]
fn each_field_of_the_table() {
    walk(
        "WVM",
        &[
            Field {
                name: "points",
                file: made,
                fate: Fate::Read(|path| assert_eq!(facts(path).0.len(), 200)),
            },
            Field {
                name: "weights, values",
                file: made,
                fate: Fate::Read(|path| {
                    let points = facts(path).0;
                    assert!(points.weights.is_some() && points.values.is_some());
                }),
            },
            Field {
                name: "grid, unit, α, gray range, recipe",
                file: made,
                fate: Fate::Read(|path| {
                    let facts = facts(path).1;
                    assert!(
                        facts.grid.is_some() && facts.alpha.is_some() && facts.recipe.is_some()
                    );
                }),
            },
            Field {
                name: "a check sum that is wrong",
                file: |folder| changed(folder, |bytes| *bytes.last_mut().unwrap() ^= 1),
                fate: Fate::Refused(&["a.wvm"]),
            },
            Field {
                name: "fewer bytes than it says",
                file: |folder| changed(folder, |bytes| bytes.truncate(bytes.len() / 2)),
                fate: Fate::Refused(&["a.wvm"]),
            },
        ],
    );
}
