//! What the fuzz targets share: bytes become a file of a name, and the file is read. Whatever comes
//! out is right, as long as it comes out.

use std::io::Cursor;
use std::path::PathBuf;

use walpha::check::certify_filtration;
use walpha::check::schema::{ComplexFile, FiltrationFile, SchemaError};
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
    let _ = read_points(&path, None);
}

/// Reads bytes as the one slice of a folder, PNG or else JPEG.
pub fn slices(bytes: &[u8]) {
    let name = if bytes.starts_with(b"\x89PNG") { "1.png" } else { "1.jpg" };
    let (folder, _path) = file(name, bytes);
    let _ = read(folder.path(), &ReadOptions::default());
}

/// Reads bytes as a complex to be checked, NPZ or else JSON.
pub fn complex(bytes: &[u8]) {
    let file = if bytes.starts_with(b"PK") {
        ComplexFile::read_npz(Cursor::new(bytes))
    } else {
        ComplexFile::read_json(bytes)
    };
    let _ = file.and_then(ComplexFile::into_complex);
}

/// Reads bytes as a complex in JSON and judges it.
pub fn check_json(bytes: &[u8]) {
    judge(ComplexFile::read_json(bytes));
}

/// Reads bytes as a complex in NPZ and judges it.
pub fn check_npz(bytes: &[u8]) {
    judge(ComplexFile::read_npz(Cursor::new(bytes)));
}

fn judge(file: Result<ComplexFile, SchemaError>) {
    let Ok(placed) = file.and_then(ComplexFile::into_complex) else { return };
    if let Ok((findings, _)) = placed.findings() {
        findings.iter().for_each(|finding| assert!(!finding.to_string().is_empty()));
    }
}

/// Reads bytes as a filtration, NPZ or else JSON, and judges it.
pub fn filtration(bytes: &[u8]) {
    let file = if bytes.starts_with(b"PK") {
        FiltrationFile::read_npz(Cursor::new(bytes))
    } else {
        FiltrationFile::read_json(bytes)
    };
    let Ok(file) = file else { return };
    if let Ok((findings, _)) = certify_filtration(&file) {
        findings.iter().for_each(|finding| assert!(!finding.to_string().is_empty()));
    }
}

/// Reads bytes as a Zarr store: the metadata of an array, then its first chunk; of a group, if they
/// say so, then those of its array "0" and the chunk. What is never in UTF-8, 0xff, parts them.
pub fn zarr(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let write = |path: PathBuf, bytes: &[u8]| {
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("room for a folder");
        std::fs::write(path, bytes).expect("room for a small file");
    };
    let (mut array, mut rest) = (folder.path().to_owned(), bytes);
    let mut metadata = || {
        let end = rest.iter().position(|&byte| byte == 0xff).unwrap_or(rest.len());
        let metadata = &rest[..end];
        rest = &rest[rest.len().min(end + 1)..];
        (metadata, String::from_utf8_lossy(metadata).into_owned())
    };
    let (mut bytes, mut text) = metadata();
    if text.contains("multiscales") {
        write(array.join("zarr.json"), bytes);
        array.push("0");
        (bytes, text) = metadata();
    }
    // A store without chunks is as large as it says: that is no fault of the reader.
    if claims_much(&text) {
        return;
    }
    let third = text.contains("node_type");
    write(array.join(if third { "zarr.json" } else { ".zarray" }), bytes);
    write(array.join(if third { "c/0/0/0" } else { "0.0.0" }), rest);
    let _ = read(folder.path(), &ReadOptions::default());
}

/// Whether an array's shape or that of its chunks has a number that makes a large volume.
fn claims_much(metadata: &str) -> bool {
    let mut numbers = metadata.split(|c: char| !c.is_ascii_digit());
    numbers.any(|number| number.trim_start_matches('0').len() > 2)
}

fn file(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("room for a small file");
    (folder, path)
}
