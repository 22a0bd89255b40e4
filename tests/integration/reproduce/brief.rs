//! The report in brief, and its copy among the documents.

use std::fs;
use std::path::Path;

use crate::common::{has_skull, ok};

/// `docs/reproduction.md` is what the command writes.
#[test]
fn the_document_is_what_the_command_writes() {
    if !has_skull() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    ok(folder.path(), &["reproduce", "--out", "out", "-q"]);
    let made = fs::read_to_string(folder.path().join("out/reproduction.md")).unwrap();
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reproduction.md");
    let kept = fs::read_to_string(kept).unwrap();
    for (k, (made, kept)) in made.lines().zip(kept.lines()).enumerate() {
        assert_eq!(
            made,
            kept,
            "line {} of docs/reproduction.md is not what walpha reproduce writes",
            k + 1
        );
    }
    assert!(made == kept, "copy reproduction.md of walpha reproduce to docs/");
    // The skull that the document speaks of is the one that was read.
    let sums: Vec<&str> = made.split('`').filter(|part| part.len() == 64).collect();
    assert!(sums.len() == 2 && sums[0] == sums[1], "{sums:?}");
}
