//! Meshes, whose vertices are points.

use walpha::points::read_points;

use super::files::save;
use crate::common::told::Told;

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
        let error = read_points(&save(folder.path(), name, bytes), None).unwrap_err().told();
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
