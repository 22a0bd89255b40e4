//! The shared part of the fuzz targets: bytes become a file with a name, and the file is read. Any result is right if there is
//! one.

use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use walpha::check::certify_filtration;
use walpha::check::meshes::{Mesh, open_weights};
use walpha::check::schema::{ComplexFile, FiltrationFile, PlacedComplex, SchemaError};
use walpha::outofcore::{Alone, BlockwiseFormat, Cutting, Job, Plan, merge, run, whole};
use walpha::points::{
    AtomSelection, Models, PointOptions, Radii, cells_of, is_point_file, read_complex, read_model,
    read_points,
};
use walpha::volume::{ReadOptions, Source, files_of, format_name, read, series};
use walpha::{Decomposition, HaarOptions, Recipe, Tolerance};

/// Reads bytes as a volume file of this name.
pub fn volume(name: &str, bytes: &[u8]) {
    let (_folder, path) = file(name, bytes);
    read_volume(&path);
}

/// Looks at a file in each way that commands do before they read it, reads a part of it, and all.
fn read_volume(path: &Path) {
    let options = ReadOptions::default();
    let _ = format_name(path, &options);
    let _ = files_of(path);
    let _ = series(path);
    if let Ok(source) = Source::open(path, &options) {
        let size = source.dims().xyz().map(|n| n.min(4));
        let _ = source.read([0; 3], size);
    }
    let _ = read(path, &options);
}

/// Reads bytes as a point file of this name.
pub fn points(name: &str, bytes: &[u8]) {
    let (_folder, path) = file(name, bytes);
    let _ = is_point_file(&path);
    let _ = read_points(&path, None);
    // All atoms of a molecule: other formats refuse the choice.
    let all = AtomSelection::default()
        .hydrogens(true)
        .waters(true)
        .hetero(true)
        .models(Some(Models::All));
    let _ = read_model(&path, &PointOptions::default().atoms(all).radii(Some(Radii::ProtOr)));
    let options = PointOptions::default();
    if cells_of(&path, &options).is_ok_and(|cells| !cells.is_empty()) {
        let _ = read_complex(&path, &options).map(|mesh| PlacedComplex::try_from(mesh.complex));
    }
}

/// Reads bytes as the one slice of a folder, PNG or else JPEG.
pub fn slices(bytes: &[u8]) {
    let name = if bytes.starts_with(b"\x89PNG") { "1.png" } else { "1.jpg" };
    let (folder, _path) = file(name, bytes);
    read_volume(folder.path());
}

/// Reads bytes as a complex to be checked, NPZ or else JSON.
pub fn complex(bytes: &[u8]) {
    let file = if bytes.starts_with(b"PK") {
        ComplexFile::read_npz(Cursor::new(bytes))
    } else {
        ComplexFile::read_json(bytes)
    };
    let _ = file.and_then(PlacedComplex::try_from);
}

/// Reads bytes as a complex in JSON and judges it.
pub fn check_json(bytes: &[u8]) {
    judge(ComplexFile::read_json(bytes));
}

/// Reads bytes as a complex in NPZ and judges it.
pub fn check_npz(bytes: &[u8]) {
    judge(ComplexFile::read_npz(Cursor::new(bytes)));
}

/// Reads bytes as a mesh of this name, and judges it.
pub fn mesh(name: &str, bytes: &[u8]) {
    let (_folder, path) = file(name, bytes);
    judge_mesh(&path);
}

/// Reads bytes as the points and, after the first byte that is 0, the cells of TetGen.
pub fn tetgen(bytes: &[u8]) {
    let mut parts = bytes.splitn(2, |&byte| byte == 0);
    let (folder, path) = file("m.node", parts.next().unwrap_or_default());
    let cells = parts.next().unwrap_or_default();
    std::fs::write(folder.path().join("m.ele"), cells).expect("room for a small file");
    judge_mesh(&path);
}

fn judge_mesh(path: &Path) {
    if let Ok(mesh) = Mesh::open(path) {
        judge(Ok(mesh.complex));
    }
}

/// Reads bytes as weights.
pub fn weights(bytes: &[u8]) {
    let (_folder, path) = file("w.txt", bytes);
    let _ = open_weights(&path);
}

fn judge(file: Result<ComplexFile, SchemaError>) {
    let Ok(placed) = file.and_then(PlacedComplex::try_from) else { return };
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

/// Reads bytes as the plan of a folder whose blocks are there, and merges these.
pub fn plan(bytes: &[u8]) {
    let folder = planned(Decomposition::NonStandard);
    std::fs::write(folder.join("plan.json"), bytes).expect("room for a small file");
    if let Ok(plan) = Plan::open(folder) {
        let _ = plan.check();
        merged(&plan);
    }
}

/// Reads bytes as one of two blocks, and merges them.
pub fn block(bytes: &[u8]) {
    let folder = planned(Decomposition::NonStandard);
    std::fs::write(folder.join("block-00000.walpha"), bytes).expect("room for a small file");
    let plan = Plan::open(folder).expect("it is left alone");
    let _ = plan.check();
    merged(&plan);
}

/// Computes a block with these bytes as the sums of bricks.
pub fn sums(bytes: &[u8]) {
    with_kept(Decomposition::NonStandard, "sums.f64", bytes);
}

/// Computes a block with these bytes as the truncated volume.
pub fn truncated(bytes: &[u8]) {
    with_kept(Decomposition::Standard, "truncated.f32", bytes);
}

fn with_kept(decomposition: Decomposition, name: &str, bytes: &[u8]) {
    let folder = planned(decomposition);
    std::fs::write(folder.join(name), bytes).expect("room for a small file");
    let plan = Plan::open(folder).expect("it is left alone");
    let _ = std::fs::remove_file(plan.block_file(0));
    let _ = run(&plan, 0);
}

fn merged(plan: &Plan) {
    let Ok(all) = merge(plan) else { return };
    let _ = whole(plan, &all);
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let _ = BlockwiseFormat::Grid.write(plan, Some(&all), &folder.path().join("a.pvtu"), &Alone);
    let _ = BlockwiseFormat::Surface.write(plan, Some(&all), &folder.path().join("a.pvtp"), &Alone);
}

/// The folder of a small plan with its blocks, made once: by the same options as the seeds.
fn planned(decomposition: Decomposition) -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder for temporary files").keep();
        let haar =
            HaarOptions::default().decomposition(decomposition).tolerance(Tolerance::Rms(2.0));
        let job = Job::new("sample:phantom@12", Recipe::new().haar(haar)).expect("a sample");
        let plan = Plan::make(job, Cutting::default().blocks(2), &folder, &Alone)
            .expect("room for a plan");
        (0..plan.blocks.len()).for_each(|block| run(&plan, block).expect("room for a block"));
        folder
    })
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
    read_volume(folder.path());
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
