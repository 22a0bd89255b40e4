//! Every row of the tables of fields in docs/formats.md, tried with a file that states that field.

#![expect(clippy::too_many_lines, reason = "a test is a table of all fields of a format")]

mod clouds;
mod crystals;
#[cfg(feature = "dicom")]
mod dicom;
mod grids;
mod inr;
#[cfg(feature = "las")]
mod las;
mod meshes;
mod metaimage;
mod mgh;
mod molecules;
mod nifti;
mod nrrd;
mod numpy;
mod points;
mod slices;
mod text;
mod tiff;
mod volumes;
mod vtk;
mod wvm;
#[cfg(feature = "zarr")]
mod zarr;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::common::run;

/// A field that a format can state, and what its reader does about it.
pub struct Field {
    /// Its name in the table.
    pub name: &'static str,
    /// Writes a file that states it to a folder, and returns the path to read.
    pub file: fn(&Path) -> PathBuf,
    pub fate: Fate,
}

/// The treatment of a field. The second column of the table begins with its name.
pub enum Fate {
    /// The field is read. The function reads the file and asserts that.
    Read(fn(&Path)),
    /// The file is not read; the error has these words.
    Refused(&'static [&'static str]),
    /// The file is read without it, and a warning has these words.
    PassedOver(&'static [&'static str]),
}

impl Fate {
    fn name(&self) -> &'static str {
        match self {
            Self::Read(_) => "read",
            Self::Refused(_) => "refused",
            Self::PassedOver(_) => "passed over",
        }
    }
}

/// The rows of the table below the heading of a format: each field, and its fate.
fn rows(format: &str) -> BTreeSet<(String, String)> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/formats.md");
    let page = std::fs::read_to_string(page).unwrap();
    let lines = page.lines().skip_while(|line| *line != format!("### {format}")).skip(1);
    let table = lines.take_while(|line| !line.starts_with('#')).filter(|l| l.starts_with('|'));
    let row = |line: &str| {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let fates = ["read", "refused", "passed over"];
        let fate = fates.into_iter().find(|fate| cells[1].starts_with(fate));
        (cells[0].to_owned(), fate.unwrap_or(cells[1]).to_owned())
    };
    table.skip(2).map(row).collect()
}

/// Compares the fields with those of the table, and tries each.
#[track_caller]
pub fn walk(format: &str, fields: &[Field]) {
    let tried = fields.iter().map(|f| (f.name.to_owned(), f.fate.name().to_owned())).collect();
    assert_eq!(rows(format), tried, "the table of {format} in docs/formats.md, and its tests");
    for Field { name, file, fate } in fields {
        let folder = tempfile::tempdir().unwrap();
        let path = file(folder.path());
        // Of a scan whose coordinates make no shape, `info` describes the rest.
        let of_shapes = matches!(fate, Fate::Refused(_)) && format == "LAS, LAZ";
        let command = if of_shapes { "points" } else { "info" };
        let (code, stdout, stderr) =
            run(folder.path(), &[command, path.to_str().unwrap(), "--json"]);
        let has = |text: &str, words: &[&str]| {
            for word in words {
                assert!(text.contains(word), "{format}, {name}: no {word:?} in\n{text}");
            }
        };
        let expected = i32::from(matches!(fate, Fate::Refused(_)));
        assert_eq!(code, expected, "{format}, {name}\n{stdout}\n{stderr}");
        match fate {
            Fate::Read(check) => check(&path),
            Fate::Refused(words) => {
                let report: serde_json::Value = serde_json::from_str(&stdout).unwrap();
                let part = |name| report["error"][name].as_str().unwrap().to_owned();
                has(&["what", "why", "next"].map(part).join("\n"), words);
            }
            Fate::PassedOver(words) => {
                let report: serde_json::Value = serde_json::from_str(&stdout).unwrap();
                has(&report["warnings"].to_string(), words);
                let lines: Vec<&str> = stderr.lines().collect();
                let distinct: BTreeSet<&str> = lines.iter().copied().collect();
                assert_eq!(lines.len(), distinct.len(), "{format}, {name}: said twice\n{stderr}");
            }
        }
    }
}
