//! Points of every format: tables, point clouds, meshes, and damaged files.

#[cfg(unix)]
use std::{process::Command, sync::mpsc, thread, time::Duration};

use walpha::points::{Columns, read_points};
#[cfg(unix)]
use walpha::{Recipe, pipeline::Input};

use super::files::{save, *};
use crate::common::{Told, run};

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
    let points = read_points(save(folder.path(), "m.xyz", atoms), None).unwrap();
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
            let read = Recipe::default().open(&input);
            // There is no receiver if the test has ended.
            drop(opened.send(read.map_err(|error| error.to_string())));
        });
        std::fs::write(&path, text).unwrap();
        let input = done.recv_timeout(Duration::from_secs(60)).expect(name).unwrap();
        assert!(matches!(input, Input::Points(points, _) if points.len() == 2), "{name}");
    }
}

/// Commands that need more of a file than its points read a pipe once, or say why they cannot.
#[test]
#[cfg(unix)]
fn commands_open_a_pipe_once() {
    let folder = tempfile::tempdir().unwrap();
    let xyz = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1.5\n";
    let off = "OFF\n2 0 0\n0 0 0\n1 0 0\n";
    let mesh = "MeshVersionFormatted 2 Dimension 3 Vertices 4 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0 \
                Tetrahedra 1 1 2 3 4 0 End";
    let complex = r#"{"points":[[0,0,0]],"alpha":0,"vertices":[0]}"#;
    let unnamed = r#"{"p":[[0,0,0],[1,0,0],[0,1,0],[0,0,1]],"t":[[0,1,2,3]]}"#;
    for (command, name, text, code, part) in [
        ("info", "p.xyz", xyz, 0, "points    5"),
        ("check", "p.xyz", xyz, 0, "over 5 points"),
        ("info", "t.mesh", mesh, 0, "1 tetrahedra"),
        ("check", "t.mesh", mesh, 0, "over 4 points"),
        ("check", "c.json", complex, 0, "over 1 point"),
        ("info", "p.off", off, 1, "copy it"),
        ("check", "p.off", off, 1, "copy it"),
        ("check", "u.json", unnamed, 1, "Illegal seek"),
        ("info", "v.nrrd", "NRRD0004\n", 1, "copy it"),
    ] {
        let path = folder.path().join(name);
        assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
        let (ended, done) = mpsc::channel();
        let inside = folder.path().to_owned();
        thread::spawn(move || drop(ended.send(run(&inside, &[command, name]))));
        // Whoever refuses a pipe may have closed it before this is written.
        drop(std::fs::write(&path, text));
        let (exit, stdout, stderr) = done.recv_timeout(Duration::from_secs(60)).expect(name);
        std::fs::remove_file(&path).unwrap();
        let said = stdout + &stderr;
        assert_eq!(exit, code, "{command} {name}: {said}");
        assert!(said.contains(part), "{command} {name}: {said}");
    }
}

#[test]
fn damaged_points_say_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let refuses = |name: &str, text: &str, part: &str| {
        let error = read_points(save(folder.path(), name, text), None).unwrap_err().told();
        assert!(error.contains(part) && error.contains(name), "{part:?} is missing in: {error}");
    };
    let rows = "2 0 1\n1 2 3 0 7\n4 5 6 0 8\n";
    let ply = |from: &str, to: &str| (PLY.to_owned() + rows).replace(from, to);
    refuses("a.ply", "hello", "not a PLY file");
    refuses("a.ply", &ply("format ascii 1.0\n", ""), "no format");
    refuses("a.ply", &ply("end_header", "end"), "not understood");
    refuses("a.ply", &ply("float x", "float q"), "properties x");
    refuses("a.ply", &ply("float y", "float x"), "properties x");
    refuses("a.ply", &ply("float x", "half x"), "half");
    refuses("a.ply", &ply("vertex 2", "vertex 3"), "truncated");
    refuses("a.ply", &ply("vertex 2", "vertex 99999999999"), "cannot hold");
    refuses("a.ply", &ply("vertex 2", "vertex 1"), "continues after its last element");
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

/// All of CGAL's own examples are read except one, whose lines are triangles; it gets advice.
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

/// A PCD of the fields x, y, z, a normal of three numbers, and intensity.
fn pcd(data: &str, bytes: &[u8]) -> Vec<u8> {
    let head = format!(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z normal intensity\nSIZE 4 4 8 4 2\nTYPE F F F F U\n\
         COUNT 1 1 1 3 1\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA {data}\n"
    );
    [head.as_bytes(), bytes].concat()
}

/// Two points with values 7 and 8, and one without a place between them.
fn pcd_examples() -> [(&'static str, Vec<u8>); 4] {
    let nan = f32::NAN;
    let rows = [(1f32, 2f32, 3f64, 7u16), (nan, nan, f64::NAN, 9), (4.0, 5.0, 6.0, 8)];
    let text: String = rows.iter().map(|(x, y, z, i)| format!("{x} {y} {z} 0 0 1 {i}\n")).collect();
    let normal = [0f32, 0.0, 1.0].map(f32::to_le_bytes).concat();
    let side_by_side: Vec<u8> = rows
        .iter()
        .flat_map(|(x, y, z, i)| {
            [&x.to_le_bytes()[..], &y.to_le_bytes(), &z.to_le_bytes(), &normal, &i.to_le_bytes()]
                .concat()
        })
        .collect();
    let by_field = [
        rows.iter().flat_map(|row| row.0.to_le_bytes()).collect::<Vec<u8>>(),
        rows.iter().flat_map(|row| row.1.to_le_bytes()).collect(),
        rows.iter().flat_map(|row| row.2.to_le_bytes()).collect(),
        normal.repeat(3),
        rows.iter().flat_map(|row| row.3.to_le_bytes()).collect(),
    ]
    .concat();
    let packed = |pieces: Vec<u8>| {
        let sizes = [pieces.len(), by_field.len()].map(|n| (n as u32).to_le_bytes()).concat();
        [sizes, pieces].concat()
    };
    // Once without changes, and once with the second and third normals as copies of the 12 bytes before them.
    let literal = |bytes: &[u8]| {
        bytes.chunks(32).flat_map(|c| [&[c.len() as u8 - 1], c].concat()).collect::<Vec<u8>>()
    };
    let (before, after) = (3 * (4 + 4 + 8) + 12, 3 * (4 + 4 + 8) + 36);
    let copied = [
        // The zeros of z = 3 as copies of the first of them.
        literal(&by_field[..25]),
        vec![3 << 5, 0],
        literal(&by_field[30..before]),
        vec![7 << 5, 24 - 9, 11],
        literal(&by_field[after..]),
    ]
    .concat();
    [
        ("text.pcd", pcd("ascii", text.as_bytes())),
        ("binary.pcd", pcd("binary", &side_by_side)),
        ("literal.pcd", pcd("binary_compressed", &packed(literal(&by_field)))),
        ("copied.pcd", pcd("binary_compressed", &packed(copied))),
    ]
}

#[test]
fn point_clouds_are_read() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in pcd_examples() {
        let points = read_points(save(folder.path(), name, bytes), None).unwrap();
        assert_eq!(points.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{name}");
        assert_eq!(points.values, Some(vec![7.0, 8.0]), "{name}");
    }
    let [text, binary, packed, _] = pcd_examples();
    let refuses = |name: &str, bytes: &[u8], part: &str| {
        let error = read_points(save(folder.path(), name, bytes), None).unwrap_err().told();
        assert!(error.contains(part) && error.contains(name), "{part:?} is missing in: {error}");
    };
    let cut = |bytes: &[u8]| bytes[..bytes.len() - 5].to_vec();
    refuses("a.pcd", &binary.1[..60], "truncated");
    refuses("b.pcd", &cut(&binary.1), "claims 3 points of 30 bytes");
    refuses("c.pcd", &cut(&packed.1), "compressed data");
    let text = String::from_utf8(text.1).unwrap();
    refuses("d.pcd", text.replace("POINTS 3", "POINTS 4").as_bytes(), "4 POINTS, but 3 by WIDTH");
    refuses("e.pcd", text.replace("FIELDS x", "FIELDS q").as_bytes(), "without x, y or z");
    refuses("f.pcd", text.replace("SIZE 4", "SIZE 8 4").as_bytes(), "5 FIELDS, but 6 SIZE");
    refuses("g.pcd", text.replace("ascii", "utf-8").as_bytes(), "ascii, binary");
    let many = text.replace("POINTS 3", "POINTS 999999999999").replace("WIDTH 3\n", "");
    refuses("h.pcd", many.as_bytes(), "cannot hold");
    // Found by fuzzing: a field without numbers, looked for beyond the last one.
    let none = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 0\nPOINTS 1\nDATA ascii\n1 2\n";
    refuses("i.pcd", none.as_bytes(), "COUNT 0 for the field z");
}

/// The corners of a tetrahedron, in the order in which its facets name them.
const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 0.5], [0.0, 4.0, 0.0], [4.0, 0.0, 0.0], [0.0, 0.0, 4.0]];
const FACETS: [[usize; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];

#[test]
fn vertices_of_meshes_are_points() {
    let folder = tempfile::tempdir().unwrap();
    let lines = |begin: &str, end: &str| -> String {
        CORNERS.iter().map(|[x, y, z]| format!("{begin}{x} {y} {z}{end}\n")).collect()
    };
    let faces: String = FACETS.iter().map(|[a, b, c]| format!("3 {a} {b} {c}\n")).collect();
    let mut binary = [b' '; 80].to_vec();
    // The word that text begins with.
    binary[..5].copy_from_slice(b"solid");
    binary.extend(4u32.to_le_bytes());
    let mut text = "solid a\n".to_owned();
    for facet in FACETS {
        binary.extend([0; 12]);
        text += "facet normal 0 0 1\nouter loop\n";
        for [x, y, z] in facet.map(|v| CORNERS[v]) {
            [x, y, z].iter().for_each(|&c| binary.extend((c as f32).to_le_bytes()));
            text += &format!(" vertex {x} {y} {z}\n");
        }
        binary.extend([0; 2]);
        text += "endloop\nendfacet\n";
    }
    text += "endsolid a\n";
    let files: [(&str, Vec<u8>); 8] = [
        ("a.off", format!("OFF # a mesh\n\n4 4 6\n{}{faces}", lines("", "")).into()),
        ("counts.off", format!("OFF 4 4 0\n{}{faces}", lines("", "")).into()),
        ("colours.off", format!("COFF\n4 4 0\n{}{faces}", lines("", " 9 9 9 255")).into()),
        ("a.obj", format!("# a\nmtllib b\n{}vn 0 0 1\nf 1//1 2//1 3//1\n", lines("v ", "")).into()),
        ("colours.obj", lines("v ", " 0.5 0.5 1").into()),
        ("text.stl", text.clone().into()),
        ("binary.stl", binary.clone()),
        ("a.pwn", format!("4\n{}{}", lines("", ""), "0 0 1\n".repeat(4)).into()),
    ];
    for (name, bytes) in files {
        let path = save(folder.path(), name, bytes);
        assert!(walpha::points::is_point_file(&path).unwrap(), "{name}");
        let points = read_points(&path, None).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(points.positions, CORNERS, "{name}");
        assert_eq!((points.weights, points.values), (None, None), "{name}");
    }
    let refuses = |name: &str, bytes: &[u8], part: &str| {
        let error = read_points(save(folder.path(), name, bytes), None).unwrap_err().told();
        assert!(error.contains(part) && error.contains(name), "{part:?} is missing in: {error}");
    };
    refuses("a.off", format!("OFF\n4 9 0\n{}{faces}", lines("", "")).as_bytes(), "truncated");
    refuses("a.off", b"OFF\nhello\n", "how many vertices");
    refuses("a.off", b"4OFF\n1 0 0\n1 2 3 4\n", "three coordinates");
    refuses("a.off", b"OFF BINARY\n", "binary");
    refuses("a.obj", b"v 1 2\n", "line 1: z");
    refuses("a.obj", b"f 1 2 3\n", "no point");
    refuses("a.stl", &binary[..200], "truncated");
    refuses("a.stl", &text.as_bytes()[..90], "truncated");
    refuses("a.pwn", b"2\n0 0 0\n1 1 1\n0 0 1\n", "claims 2 points");
}
