//! What the fuzz targets share: bytes become a file of a name, and the file is read. Whatever comes
//! out is right, as long as it comes out.

use std::path::PathBuf;

use walpha::points::{is_point_file, read_points};
use walpha::volume::{ReadOptions, read};

/// Reads bytes as a volume file of this name.
pub fn volume(name: &str, bytes: &[u8]) {
    let (_folder, path) = file(name, bytes);
    let _ = read(&path, &ReadOptions::default());
}

/// Reads bytes as a point file of this name.
pub fn points(name: &str, bytes: &[u8]) {
    let (_folder, path) = file(name, bytes);
    let _ = is_point_file(&path);
    let _ = read_points(&path);
}

fn file(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("room for a small file");
    (folder, path)
}
