//! Points of every format, damaged ones, and tables.

#[cfg(unix)]
use std::{process::Command, sync::mpsc, thread, time::Duration};

use walpha::points::{Columns, read_points};
#[cfg(unix)]
use walpha::{Recipe, pipeline::Input, progress::Monitor};

use super::files::*;
use crate::common::told::Told;

#[test]
fn points_of_every_format_are_read() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in point_examples() {
        let path = save(folder.path(), name, bytes);
        assert!(walpha::points::is_point_file(&path).unwrap(), "{name}");
        let points = read_points(&path, None).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(points.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{name}");
        assert_eq!(points.values, Some(vec![7.0, 8.0]), "{name}");
        assert_eq!(points.weights, None, "{name}");
    }
    let atoms = "2\na molecule\nC 1 2 3\nH 4 5 6 0.1\n";
    let points = read_points(&save(folder.path(), "m.xyz", atoms), None).unwrap();
    assert_eq!((points.len(), points.values), (2, None));
    for (name, bytes) in examples() {
        let path = save(folder.path(), name, bytes);
        assert!(!walpha::points::is_point_file(&path).unwrap(), "{name}");
    }
    assert!(!walpha::points::is_point_file(folder.path()).unwrap());
}

/// Whoever opens a pipe again waits for ever: another writer does not come.
#[test]
#[cfg(unix)]
fn points_come_through_a_pipe_that_is_opened_once() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [
        ("p.xyz", "0 0 0\n1 0 0\n"),
        ("p.obj", "v 0 0 0\nv 1 0 0\n"),
        ("p.off", "OFF\n2 0 0\n0 0 0\n1 0 0\n"),
    ] {
        let path = folder.path().join(name);
        assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
        let (opened, done) = mpsc::channel();
        let input = path.clone();
        thread::spawn(move || {
            opened.send(Recipe::default().open(&input, &Monitor::noop()).map_err(|e| e.to_string()))
        });
        std::fs::write(&path, text).unwrap();
        let input = done.recv_timeout(Duration::from_secs(60)).expect(name).unwrap();
        assert!(matches!(input, Input::Points(points, _) if points.len() == 2), "{name}");
    }
}

#[test]
fn damaged_points_say_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let refuses = |name: &str, text: &str, part: &str| {
        let error = read_points(&save(folder.path(), name, text), None).unwrap_err().told();
        assert!(error.contains(part) && error.contains(name), "{part:?} is missing in: {error}");
    };
    let rows = "2 0 1\n1 2 3 0 7\n4 5 6 0 8\n";
    let ply = |from: &str, to: &str| (PLY.to_owned() + rows).replace(from, to);
    refuses("a.ply", "hello", "no PLY file");
    refuses("a.ply", &ply("format ascii 1.0\n", ""), "no format");
    refuses("a.ply", &ply("end_header", "end"), "not understood");
    refuses("a.ply", &ply("float x", "float q"), "properties x");
    refuses("a.ply", &ply("float y", "float x"), "properties x");
    refuses("a.ply", &ply("float x", "half x"), "half");
    refuses("a.ply", &ply("vertex 2", "vertex 3"), "truncated");
    refuses("a.ply", &ply("vertex 2", "vertex 99999999999"), "cannot hold");
    refuses("a.ply", &ply("vertex 2", "vertex 1"), "too long");
    refuses("a.ply", &ply("vertex 2", "vertex 0").replace(rows, "0\n"), "no point");
    refuses("a.ply", &ply("element vertex", "element corner"), "no element vertex");
    refuses("a.ply", &ply("1 2 3 0", "1 2 3 300"), "300");
    refuses("a.ply", &ply("1 2 3 0", "1 nan 3 0"), "y is NaN");
    refuses("a.xyz", "1 2\n", "2 columns");
    refuses("a.xyz", "1 2 3\n1 2 3 4\n", "line 2");
    refuses("a.xyz", "1 2 3\n1 two 3\n", "column y");
    refuses("a.xyz", "3\n\nC 1 2 3\n", "claims 3 atoms");
    refuses("a.vtp", &vtp("1 2 3 4 5"), "truncated");
    refuses("a.vtp", &vtp("1 2 3 4 5 6 7"), "more follow");
    refuses("a.vtp", &vtp("1 2 3 4 5 6").replace("PolyData", "Table"), "Table");
    refuses("a.vtp", &vtp("1 2 3 4 5 inf"), "z is inf");
}

#[test]
fn tables_need_no_header() {
    let folder = tempfile::tempdir().unwrap();
    let places = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    let columns = |names: &str| names.parse::<Columns>().unwrap();
    let cases = [
        ("plain.csv", "1,2,3\n4,5,6\n", None, None),
        ("semicolons.csv", "1;2;3;0,5\n4;5;6;7\n", None, Some(vec![0.5, 7.0])),
        ("named.csv", "z;y;x;value\n3;2;1;0,5\n6;5;4;7\n", None, Some(vec![0.5, 7.0])),
        ("tabs.tsv", "1\t2\t3\t0.5\n4\t5\t6\t7\n", None, Some(vec![0.5, 7.0])),
        ("normals.xyz", "1 2 3 0 0.6 0.8\n4 5 6 0 0 0\n", None, None),
        ("colours.xyz", "1 2 3 255 0 17\n4 5 6 1 2 3\n", None, None),
        ("remark.xyz", "# scanned today\n1 2 3\n4 5 6\n", None, None),
        ("normals.pwn", "1 2 3 0 0 1\n4 5 6 1 0 0\n", None, None),
        ("five.xyz", "9 1 2 3 0.5\n9 4 5 6 7\n", Some("id,x,y,z,value"), Some(vec![0.5, 7.0])),
        ("other.csv", "a,b,c\n1,2,3\n4,5,6\n", Some("x,y,z"), None),
    ];
    for (name, text, names, values) in cases {
        let path = save(folder.path(), name, text);
        let points =
            read_points(&path, names.map(columns).as_ref()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(points.positions, places, "{name}");
        assert_eq!(points.values, values, "{name}");
    }
    let refuses = |name: &str, text: &str, names: Option<&str>, part: &str| {
        let path = save(folder.path(), name, text);
        let error = read_points(&path, names.map(columns).as_ref()).unwrap_err().told();
        assert!(error.contains(part) && error.contains(name), "{part:?} is missing in: {error}");
    };
    refuses("six.xyz", "1 2 3 4 5 0.6\n", None, "`columns` x,y,z,nx,ny,nz");
    refuses("five.xyz", "1 2 3 4 5\n", None, "`columns` x,y,z,weight,value");
    refuses("nine.xyz", "1 2 3 4 5 6 7 8 9\n", None, "`columns` x,y,z,-,-,-,-,-,-");
    refuses("a.xyz", "1 2 3 4\n", Some("x,y,z"), "line 1 has 4 columns");
    refuses("a.ply", PLY, Some("x,y,z"), "omit `columns`");
    for (names, part) in [("x,y,nx", "do not name z"), ("x,y,z,X", "name x twice")] {
        assert!(names.parse::<Columns>().unwrap_err().told().contains(part), "{names}");
    }
}

/// Of CGAL's own examples all are read but one, whose lines are triangles; it says what to do.
#[test]
fn cgal_s_point_sets_are_read() {
    let archive = std::path::Path::new("/usr/share/doc/libcgal-dev/data.tar.gz");
    let Ok(file) = std::fs::File::open(archive) else {
        eprintln!("skipped: {} is not installed", archive.display());
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let mut files = tar::Archive::new(flate2::read::GzDecoder::new(file));
    let mut counts = std::collections::BTreeMap::new();
    for entry in files.entries().unwrap() {
        let mut entry = entry.unwrap();
        let name = entry.path().unwrap().to_path_buf();
        let wanted = name.parent().is_some_and(|parent| parent.ends_with("points_3"));
        let extension = name.extension().unwrap_or_default().to_string_lossy().into_owned();
        if !wanted || !["xyz", "pwn", "off", "ply"].contains(&extension.as_str()) {
            continue;
        }
        let path = folder.path().join(name.file_name().unwrap());
        entry.unpack(&path).unwrap();
        match read_points(&path, None) {
            Ok(points) => {
                assert!(!points.is_empty(), "{name:?}");
                *counts.entry(extension).or_insert(0) += 1;
            }
            Err(error) => {
                assert!(name.ends_with("triangles.xyz"), "{error}");
                assert!(error.to_string().contains("has 9 columns"), "{error}");
                let columns: Columns = "x,y,z,-,-,-,-,-,-".parse().unwrap();
                assert_eq!(read_points(&path, Some(&columns)).unwrap().len(), 10);
            }
        }
    }
    // Later versions of CGAL have more of them.
    assert!(counts["xyz"] >= 16 && counts["pwn"] >= 3 && counts["off"] >= 1, "{counts:?}");
}
