//! Commands open their input once: their information about it and their data are from one file, even if another takes its place
//! meanwhile.

use std::fs;
use std::path::Path;

use nix::sys::inotify::{AddWatchFlags, InitFlags, Inotify};

use crate::common::ok;

/// The number of times a command opens a file.
fn openings(folder: &Path, file: &str, args: &[&str]) -> usize {
    let inotify = Inotify::init(InitFlags::IN_NONBLOCK).unwrap();
    // Equal events that follow each other are one. Whoever opens a file reads from it before it is opened again.
    let events = AddWatchFlags::IN_OPEN | AddWatchFlags::IN_ACCESS | AddWatchFlags::IN_CLOSE;
    inotify.add_watch(&folder.join(file), events).unwrap();
    ok(folder, args);
    let mut count = 0;
    while let Ok(events) = inotify.read_events() {
        count += events.iter().filter(|e| e.mask.contains(AddWatchFlags::IN_OPEN)).count();
    }
    count
}

#[test]
fn commands_open_their_input_once() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for volume in ["v.nii.gz", "v.nii", "v.nrrd", "v.mha", "v.npy", "v.vti", "v.tif"] {
        ok(f, &["haar", "sample:phantom@16", "-o", volume]);
    }
    ok(
        f,
        &["shape", "sample:phantom@16", "--weights", "min-max", "-o", "m.ply", "m.vtu", "m.json"],
    );
    let corners = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
    for (name, text) in [
        ("p.xyz", corners.to_owned()),
        ("p.off", format!("OFF\n4 0 0\n{corners}")),
        ("t.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n".into()),
        ("t.ele", "1 4 0\n1 1 2 3 4\n".into()),
        (
            "t.mesh",
            "MeshVersionFormatted 2 Dimension 3 Vertices 4 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0 \
             Tetrahedra 1 1 2 3 4 0 End"
                .into(),
        ),
        (
            "t.vtk",
            format!(
                "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n\
                 POINTS 4 double\n{corners}CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n"
            ),
        ),
        ("t.json", r#"{"p":[[0,0,0],[1,0,0],[0,1,0],[0,0,1]],"t":[[0,1,2,3]]}"#.into()),
    ] {
        fs::write(f.join(name), text).unwrap();
    }
    ok(f, &["points", "p.xyz", "-o", "p.npy"]);
    ok(f, &["points", "v.nrrd", "-o", "p.wvm"]);
    ok(f, &["filtration", "p.xyz", "-o", "f.json", "f.npz"]);

    let volumes = ["v.nii.gz", "v.nii", "v.nrrd", "v.mha", "v.npy", "v.vti", "v.tif"];
    let points = ["p.xyz", "p.off", "p.npy", "p.wvm"];
    let meshes = ["m.vtu", "t.node", "t.ele", "t.mesh", "t.vtk"];
    let complexes = ["m.json", "t.json", "f.json", "f.npz"];
    let described = volumes.iter().chain(&points).chain(&meshes).chain(&["m.ply"]);
    let judged = volumes.iter().chain(&points).chain(&meshes).chain(&complexes);
    let shaped = volumes.iter().chain(&points);
    for (command, files) in [
        ("info", described.collect::<Vec<_>>()),
        ("check", judged.collect()),
        ("shape", shaped.collect()),
    ] {
        for file in files {
            assert_eq!(openings(f, file, &[command, file]), 1, "{command} {file}");
        }
    }
    if cfg!(feature = "zarr") {
        for (k, file) in volumes.iter().enumerate() {
            let zarr = format!("{k}.zarr");
            assert_eq!(openings(f, file, &["convert", file, "-o", &zarr]), 1, "convert {file}");
        }
    }
}
