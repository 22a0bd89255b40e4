//! `walpha check` and `walpha compare`: point sets, certificates, and files that the checker reads.

#[allow(dead_code, reason = "the tests of walpha-check use the rest")]
#[path = "../../crates/check/tests/integration/common.rs"]
mod cases;

use std::io::Cursor;
use std::num::NonZeroUsize;
use std::path::Path;

use walpha::check::schema::ComplexFile;
use walpha::check::{Extent, Finding, NotJudged};
use walpha::export::{Exporter, Json, Npz};
use walpha::shape::{Engine, ShapeError, ShapeOptions, claim};
use walpha::{Alpha, WeightedPoints, alpha_shape};
use walpha_base::random::Random;

use crate::common;

pub use cases::{Answer, Case, definition, grid, shape_of};

/// CGAL's own answer: the whole triangulation.
pub fn engine(case: &Case) -> Result<Answer, ShapeError> {
    engine_of(case, Engine::Cgal)
}

/// An engine's answer: the whole triangulation.
pub fn engine_of(case: &Case, engine: Engine) -> Result<Answer, ShapeError> {
    let options = ShapeOptions::new(case.alpha()).exterior(true).engine(engine);
    let Case { positions, weights, .. } = case.clone();
    let shape = alpha_shape(WeightedPoints::new(positions, weights).unwrap(), &options)?;
    Ok(Answer {
        complex: shape.complex().clone(),
        hidden: shape.hidden().expect("the whole triangulation was seen").to_vec(),
        duplicates: shape.duplicates().to_vec(),
    })
}

/// Cells without a sphere are a finding, with a separate exit code.
#[test]
fn corners_in_one_place_are_a_finding() {
    let folder = tempfile::tempdir().unwrap();
    let points = r#""points":[[0,0,0],[0,0,0],[1,0,0],[0,1,0],[0,0,1]],"alpha":1"#;
    for rows in [r#""facets":[[0,1,2]]"#, r#""edges":[[0,1]]"#, r#""cells":[[0,1,2,3]]"#] {
        std::fs::write(folder.path().join("c.json"), format!("{{{points},{rows}}}")).unwrap();
        let (code, stdout, stderr) = common::run(folder.path(), &["check", "c.json"]);
        assert_eq!(code, 3, "{rows}: {stdout}{stderr}");
    }
}

/// The command says what it compared, and fails where that differs.
#[test]
fn the_command_compares_weights_and_alpha() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, weight: f64, alpha: f64| {
        let points = "[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]";
        let text = format!(
            r#"{{"points":{points},"weights":[{weight},0,0,0],"alpha":{alpha},"cells":[[0,1,2,3]]}}"#
        );
        std::fs::write(folder.path().join(name), text).unwrap();
    };
    write("a.json", 0.0, 1.0);
    write("heavy.json", 0.25, 1.0);
    write("high.json", 0.0, 2.0);
    for (other, code, words) in [
        ("a.json", 0, "equal in all that was compared"),
        ("heavy.json", 3, "weights that differ: 1"),
        ("high.json", 3, "α: 1 in A, 2 in B"),
    ] {
        let (got, stdout, _) = common::run(folder.path(), &["compare", "a.json", other]);
        assert_eq!(got, code, "{stdout}");
        assert!(stdout.contains(words), "{stdout}");
        assert!(stdout.contains("not compared: "), "{stdout}");
    }
}

/// An unstructured grid as other programs write it, as text.
fn write_grid(path: &Path, points: &[[f64; 3]], cells: &[Vec<usize>]) {
    let numbers = |rows: Vec<String>| rows.join("\n");
    let places = points.iter().map(|[x, y, z]| format!("{x:?} {y:?} {z:?}")).collect();
    let rows = cells.iter().map(|cell| format!("{cell:?}").replace([',', '[', ']'], " ")).collect();
    let ends = cells.iter().scan(0, |end, cell| {
        *end += cell.len();
        Some(end.to_string())
    });
    let kinds = cells.iter().map(|cell| [1, 3, 5, 10, 14, 0, 0, 12][cell.len() - 1].to_string());
    let array = |kind: &str, name: &str, components: usize, text: String| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"ascii\">\n{text}\n</DataArray>\n"
        )
    };
    let text = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" \
         byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" \
         NumberOfCells=\"{}\">\n<Points>\n{}</Points>\n<Cells>\n{}{}{}</Cells>\n</Piece>\n\
         </UnstructuredGrid>\n</VTKFile>\n",
        points.len(),
        cells.len(),
        array("Float64", "Points", 3, numbers(places)),
        array("Int64", "connectivity", 1, numbers(rows)),
        array("Int64", "offsets", 1, numbers(ends.collect())),
        array("UInt8", "types", 1, numbers(kinds.collect())),
    );
    std::fs::write(path, text).unwrap();
}

/// A lattice of n³ points, and each cube of it cut into six cells around its diagonal: a Delaunay
/// triangulation, and not the one of the rule.
fn cubes(n: usize) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
    let at = |[x, y, z]: [usize; 3]| (z * n + y) * n + x;
    let points = (0..n * n * n).map(|i| [i % n, i / n % n, i / n / n].map(|k| k as f64)).collect();
    let mut cells = Vec::new();
    for corner in 0..n * n * n {
        let corner = [corner % n, corner / n % n, corner / n / n];
        if corner.iter().any(|&k| k + 1 == n) {
            continue;
        }
        for axes in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let mut at_corner = corner;
            let mut cell = vec![at(corner)];
            for axis in axes {
                at_corner[axis] += 1;
                cell.push(at(at_corner));
            }
            cells.push(cell);
        }
    }
    (points, cells)
}

/// A mesh is judged by its cells, and what was judged is said first.
#[test]
fn cells_of_a_mesh_are_judged() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (points, cells) = cubes(4);
    write_grid(&folder.join("cubes.vtu"), &points, &cells);
    let fewer: Vec<_> =
        cells.iter().enumerate().filter(|(i, _)| i % 40 != 7).map(|(_, c)| c.clone()).collect();
    assert_eq!(fewer.len(), cells.len() - 4);
    write_grid(&folder.join("bad.vtu"), &points, &fewer);
    let judge = |args: &[&str]| common::run(folder, &[&["check"], args].concat());

    let (code, stdout, stderr) = judge(&["cubes.vtu"]);
    assert_eq!(code, 0, "{stdout}{stderr}");
    assert!(stdout.starts_with("judged    the 162 tetrahedra of cubes.vtu"), "{stdout}");
    assert!(stdout.contains("verdict   valid: another choice at "), "{stdout}");
    let (code, stdout, stderr) = judge(&["cubes.vtu", "--ties", "exact"]);
    assert_eq!(code, 3, "{stdout}{stderr}");
    assert!(stdout.contains("inside by the perturbation"), "{stdout}");
    let (code, stdout, stderr) = judge(&["bad.vtu", "--json"]);
    assert_eq!(code, 3, "{stdout}{stderr}");
    let facts: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!((&facts["verdict"], &facts["valid"]), (&"wrong".into(), &false.into()), "{facts:#}");
    assert_eq!(facts["simplices"][0], 158);
    let info = common::json(folder, &["info", "bad.vtu"]);
    assert_eq!(info["cells"], serde_json::json!([{ "kind": "tetrahedra", "count": 158 }]));

    // The faults, as a mesh to look at.
    assert_eq!(judge(&["bad.vtu", "-o", "findings.vtu"]).0, 3);
    let parts = common::json(folder, &["info", "findings.vtu"])["cells"].clone();
    let count = |kind: &str| {
        let of_kind = |row: &&serde_json::Value| row["kind"] == kind;
        parts
            .as_array()
            .unwrap()
            .iter()
            .find(of_kind)
            .map_or(0, |row| row["count"].as_u64().unwrap())
    };
    // Each finding names a facet or an edge of a hole, some with a cell or a point.
    let found = facts["findings_total"].as_u64().unwrap();
    assert!(count("triangles") + count("edges") >= found && found > 0, "{parts} {found}");
    assert_eq!(judge(&["cubes.vtu", "-o", "none.vtu"]).0, 0);
    assert_eq!(common::json(folder, &["info", "none.vtu"])["count"], 64);
    common::fails(folder, 2, "check bad.vtu -o findings.ply", &["findings.ply", ".vtu"]);

    // With an α, all listed simplices are in the shape: those of cubes of side 1 from 3/4 on.
    assert_eq!(judge(&["cubes.vtu", "--alpha", "0.75"]).0, 0);
    assert_eq!(judge(&["cubes.vtu", "--alpha", "0.74"]).0, 3);
    let (code, _, stderr) = judge(&["cubes.vtu", "--weights", "common=0"]);
    assert_eq!(code, 2, "{stderr}");
}

/// Meshes of other programs are judged by the readers of walpha-check, with points and weights of their own if asked.
#[test]
fn meshes_of_other_programs_are_judged() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    write(
        "a.mesh",
        "MeshVersionFormatted 2 Dimension 3 Vertices 5 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0 2 2 2 0 \
         Triangles 1 1 2 3 0 Tetrahedra 2 1 2 3 4 0 2 3 4 5 0 End",
    );
    let facts = common::json(folder, &["check", "a.mesh"]);
    assert_eq!((&facts["verdict"], &facts["extent"]), (&"exact".into(), &"whole".into()));
    let notes = facts["notes"].to_string();
    assert!(notes.contains("nearest double") && notes.contains("1 Triangles"), "{notes}");
    let info = common::json(folder, &["info", "a.mesh"]);
    assert_eq!((&info["kind"], &info["tetrahedra"]), (&"mesh".into(), &2.into()), "{info:#}");
    let (code, stdout, stderr) = common::run(folder, &["check", "a.mesh", "--alpha", "0.5"]);
    assert_eq!(code, 3, "{stdout}{stderr}");
    assert!(stdout.contains("by rule   "), "{stdout}");

    // The fifth point moved into the sphere of the first cell.
    write("moved.csv", "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n0.75,0.75,0.75\n");
    let (code, stdout, _) = common::run(folder, &["check", "a.mesh", "--points", "moved.csv"]);
    assert_eq!(code, 3, "{stdout}");
    assert!(stdout.contains("is not regular"), "{stdout}");
    write("few.csv", "x,y,z\n0,0,0\n1,0,0\n");
    let (code, _, stderr) = common::run(folder, &["check", "a.mesh", "--points", "few.csv"]);
    assert!(code == 1 && stderr.contains("lists 2 points"), "{stderr}");

    // Hidden by its weight, the fourth attribute of its line.
    write("w.node", "5 3 1 0\n0 0 0 0 0\n1 1 0 0 0\n2 0 1 0 0\n3 0 0 1 0\n4 .25 .25 .25 -9\n");
    write("w.ele", "1 4 0\n0 0 1 2 3\n");
    assert_eq!(common::run(folder, &["check", "w.ele"]).0, 3);
    assert_eq!(common::run(folder, &["check", "w.node", "--weights", "column"]).0, 0);

    write(
        "a.vtk",
        "# vtk DataFile Version 4.2\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n\
         0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 2 9\n4 0 1 2 3\n3 0 1 2\nCELL_TYPES 2\n10\n5\n",
    );
    let (code, stdout, stderr) = common::run(folder, &["check", "a.vtk"]);
    assert_eq!(code, 0, "{stdout}{stderr}");
    assert!(stdout.contains("note      only tetrahedra are judged"), "{stdout}");
    write("theirs.json", r#"{"p":[[0,0,0],[1,0,0],[0,1,0],[0,0,1]],"t":[[0,1,2,3]]}"#);
    assert_eq!(common::run(folder, &["check", "theirs.json"]).0, 0);
    assert_eq!(common::run(folder, &["check", "theirs.json", "--alpha", "0.5"]).0, 3);
}

/// Our own files hold α and classes.
#[test]
fn our_meshes_are_judged_as_the_shapes_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let make = ["shape", "sample:phantom@16", "--weights", "min-max", "--alpha", "3"];
    common::ok(folder, &[&make[..], &["-o", "shape.vtu"]].concat());
    common::ok(folder, &[&make[..], &["--exterior", "-o", "whole.vtu"]].concat());
    for (file, extent) in [("shape.vtu", "shape"), ("whole.vtu", "whole")] {
        let facts = common::json(folder, &["check", file]);
        assert_eq!((&facts["verdict"], &facts["extent"]), (&"exact".into(), &extent.into()));
        let made = common::json(folder, &[&make[..], &["--exterior"]].concat());
        let listed = |k: usize| facts["simplices"][k].as_u64().unwrap();
        let inside = made["shape"]["cells"]["interior"].as_u64();
        if let Some(inside) = inside.filter(|_| extent == "shape") {
            assert_eq!(listed(0), inside, "{made:#}");
        }
        assert!(listed(0) > 100);
    }
    // An α that is changed is found.
    let bytes = std::fs::read(folder.join("shape.vtu")).unwrap();
    let alpha = 3f64.to_le_bytes();
    let at = bytes.windows(8).position(|window| window == alpha).unwrap();
    let mut other = bytes.clone();
    other[at..at + 8].copy_from_slice(&2f64.to_le_bytes());
    std::fs::write(folder.join("other.vtu"), other).unwrap();
    assert_eq!(common::run(folder, &["check", "other.vtu"]).0, 3);
    let (code, _, stderr) = common::run(folder, &["check", "shape.vtu", "--alpha", "3"]);
    assert_eq!(code, 2, "{stderr}");
}

/// Exact output is written in each format, for any input of a shape, any engine, and any number of blocks.
#[test]
fn what_we_write_is_exact() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut judged = 0;
    for (points, weights, alphas) in [
        ("hard:slab-18", "common=0", &["0", "0.25", "0.5", "0.75", "100"][..]),
        ("hard:duplicates", "column", &["-0.2", "0.25", "0.5"]),
        ("hard:hidden", "column", &["-1", "0", "0.25", "1"]),
        ("hard:radii", "column", &["-0.1", "0", "0.1"]),
        ("hard:rings", "common=0", &["100", "4000", "4300"]),
        ("hard:oblique-plane", "common=0", &["0", "3", "20"]),
        ("hard:line", "common=0", &["0", "1", "50"]),
        ("hard:one-ulp", "common=0", &["0", "0.5", "0.75"]),
        ("sample:phantom@16", "min-max", &["0.5", "3", "40", "1e9"]),
    ] {
        for alpha in alphas {
            let options: &[&[&str]] =
                &[&[], &["--blocks", "3"], &["--balls", "radius"], &["--engine", "native"]];
            for more in options.iter().filter(|more| alpha.len() < 4 || more.len() < 2) {
                // With the other interpretation α is a length to add to weights, which are radii.
                if more.contains(&"radius") && (alpha.starts_with('-') || weights == "column") {
                    continue;
                }
                let make = ["shape", points, "--weights", weights, "--alpha", alpha, "--in-place"];
                let outputs = ["-o", "s.json", "-o", "s.npz", "-o", "s.vtu"];
                common::ok(folder, &[&make[..], &outputs, more].concat());
                for file in ["s.json", "s.npz", "s.vtu"] {
                    let facts = common::json(folder, &["check", file]);
                    let words = format!("{points} {alpha} {more:?} {file}: {facts:#}");
                    assert_eq!(facts["verdict"], "exact", "{words}");
                    let rules = facts["certificate"]["not_judged"].to_string();
                    assert!(!rules.contains("simplices"), "{words}");
                    judged += 1;
                }
            }
        }
    }
    assert!(judged > 200, "{judged}");
}

/// The shape of a smaller α is not that of a larger one, and what is missing is named: as a complex, and by its cells.
#[test]
fn a_shape_of_a_smaller_alpha_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let make = ["shape", "sample:phantom@16", "--weights", "min-max"];
    for (alpha, name) in [("3", "small"), ("3.5", "large")] {
        let json = format!("{name}.json");
        common::ok(folder, &[&make[..], &["--alpha", alpha, "-o", &json]].concat());
        let written = std::fs::read(folder.join(&json)).unwrap();
        let mut file: serde_json::Value = serde_json::from_slice(&written).unwrap();
        file["alpha"] = 3.5.into();
        std::fs::write(folder.join(&json), file.to_string()).unwrap();
        for kind in ["facets", "edges", "vertices"] {
            file.as_object_mut().unwrap().remove(kind);
            file["classes"].as_object_mut().unwrap().remove(kind);
        }
        std::fs::write(folder.join(format!("{name}-cells.json")), file.to_string()).unwrap();
    }
    for (file, code) in
        [("large.json", 0), ("large-cells.json", 0), ("small.json", 3), ("small-cells.json", 3)]
    {
        let (got, stdout, stderr) = common::run(folder, &["check", file, "--json"]);
        assert_eq!(got, code, "{stdout}{stderr}");
        let facts: serde_json::Value = serde_json::from_str(&stdout).unwrap();
        let count = |rule: &str| facts["findings_by_rule"][rule].as_u64().unwrap_or(0);
        let missing = count("missing_simplex") + count("missing_cell");
        assert_eq!((missing > 0, facts["valid"] == true), (code == 3, code == 0), "{facts:#}");
    }
    let (_, stdout, _) = common::run(folder, &["check", "small-cells.json"]);
    assert!(stdout.contains("judged    the complex of small-cells.json, by its cells"), "{stdout}");
    assert!(stdout.contains("] is missing: "), "{stdout}");
}

/// A mesh of a shape lists no points, edges and facets that are faces of no cell: without them it is right.
#[test]
fn what_a_mesh_cannot_list_is_not_missing() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // Two cells that are apart, and a triangle, an edge and a point next to one of them.
    let points = "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 20 0 0\n6 21 0 0\n7 20 1 0\n8 20 0 1\n\
                  9 40 0 0\n10 41 0 0\n11 40 1 0\n12 60 0 0\n13 61 0 0\n14 80 0 0\n";
    std::fs::write(folder.join("m.node"), format!("14 3 0 0\n{points}")).unwrap();
    for (cells, code) in [("1 1 2 3 4\n2 5 6 7 8\n", 0), ("1 1 2 3 4\n", 3)] {
        let count = cells.lines().count();
        std::fs::write(folder.join("m.ele"), format!("{count} 4 0\n{cells}")).unwrap();
        let check = ["check", "m.ele", "--alpha", "0.75"];
        let (got, stdout, stderr) = common::run(folder, &check);
        assert_eq!(got, code, "{stdout}{stderr}");
        let head =
            format!("judged    the {count} tetrahedra of m.ele, by its cells, over 14 points");
        assert!(stdout.starts_with(&head), "{stdout}");
        let (got, stdout, _) = common::run(folder, &[&check[..], &["--enumerate"]].concat());
        assert_eq!(got, code, "{stdout}");
        let verdict =
            if code == 0 { "verdict   exact: no findings" } else { "cell [4, 5, 6, 7] is missing" };
        assert!(stdout.contains(verdict), "{stdout}");
    }
}

/// PLY with tetrahedra as `VCGlib` lists them, in text and in binary, with a face in addition.
#[test]
fn tetrahedra_of_ply_are_judged() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (points, cells) = cubes(3);
    let head = |format: &str, count: usize| {
        format!(
            "ply\nformat {format} 1.0\nelement vertex {}\nproperty double x\nproperty double y\n\
             property double z\nproperty float weight\nelement face 1\nproperty list uchar int vertex_indices\n\
             element tetra {count}\nproperty float quality\nproperty list uchar int vertex_indices\nend_header\n",
            points.len()
        )
    };
    let write = |name: &str, cells: &[Vec<usize>]| {
        let words = |row: &[usize]| row.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
        let mut text = head("ascii", cells.len());
        points.iter().for_each(|[x, y, z]| text += &format!("{x} {y} {z} 0.5\n"));
        text += "3 0 1 2\n";
        cells.iter().for_each(|row| text += &format!("0.25 {} {}\n", row.len(), words(row)));
        std::fs::write(folder.join(format!("{name}.ply")), text).unwrap();
        let mut bytes = head("binary_big_endian", cells.len()).into_bytes();
        for point in &points {
            point.iter().for_each(|x| bytes.extend(x.to_be_bytes()));
            bytes.extend(0.5f32.to_be_bytes());
        }
        let list = |bytes: &mut Vec<u8>, row: &[usize]| {
            bytes.push(row.len() as u8);
            row.iter().for_each(|&v| bytes.extend((v as i32).to_be_bytes()));
        };
        list(&mut bytes, &[0, 1, 2]);
        for row in cells {
            bytes.extend(0.25f32.to_be_bytes());
            list(&mut bytes, row);
        }
        std::fs::write(folder.join(format!("{name}-binary.ply")), bytes).unwrap();
    };
    write("right", &cells);
    write("wrong", &cells[1..]);
    write("short", &[vec![0, 1, 2]]);
    for (name, decimal) in [("right", true), ("right-binary", false)] {
        let stdout = common::ok(folder, &["check", &format!("{name}.ply"), "--json"]);
        let facts: serde_json::Value = serde_json::from_str(&stdout).unwrap();
        assert_eq!(
            (facts["verdict"].as_str(), &facts["simplices"][0]),
            (Some("valid"), &cells.len().into())
        );
        let notes = facts["notes"].to_string();
        assert_eq!(notes.contains("nearest double"), decimal, "{notes}");
        assert!(notes.contains("only tetrahedra are judged: 1 faces are ignored"), "{notes}");
        // Weights are read: without them no cell is in a shape below α = 3/4.
        let weighted = common::run(folder, &["check", &format!("{name}.ply"), "--alpha", "0.3"]);
        assert_eq!(weighted.0, 0, "{}", weighted.1);
    }
    for name in ["wrong", "wrong-binary"] {
        assert_eq!(common::run(folder, &["check", &format!("{name}.ply")]).0, 3);
    }
    common::fails(folder, 1, "check short.ply", &["3 corners"]);
}

/// A file that lists cells which are not judged is refused, not judged by its points; a cloud of points is judged by our own
/// shape of it.
#[test]
fn what_is_not_judged_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let make = ["shape", "sample:phantom@16", "--weights", "common=0", "--alpha", "3"];
    let outputs = ["-o", "s.ply", "-o", "s.off", "-o", "s.obj", "-o", "s.stl", "-o", "s.vtp"];
    common::ok(folder, &[&make[..], &outputs].concat());
    let (points, _) = cubes(2);
    write_grid(&folder.join("hexahedra.vtu"), &points, &[vec![0, 1, 3, 2, 4, 5, 7, 6]]);
    for (file, kind) in [
        ("s.ply", "faces"),
        ("s.off", "faces"),
        ("s.obj", "faces"),
        ("s.stl", "facets"),
        ("s.vtp", "polygons"),
        ("hexahedra.vtu", "hexahedra"),
    ] {
        let (code, stdout, stderr) = common::run(folder, &["check", file]);
        assert_eq!((code, stdout.as_str()), (1, ""), "{file}: {stderr}");
        assert!(stderr.contains(kind) && stderr.contains("walpha points"), "{file}: {stderr}");
        let info = common::json(folder, &["info", file]);
        assert_eq!(info["cells"][0]["kind"], kind, "{info:#}");
    }
    // VTU lists the simplices of these without what decides them.
    for (input, given, what) in [
        ("sample:phantom@16", "--surface 100", "a solid without α"),
        ("cloud.csv", "--periodic 2,2,2 --alpha 0.3", "a periodic box"),
    ] {
        std::fs::write(folder.join("cloud.csv"), "x,y,z\n0,0,0\n.5,0,0\n0,.5,0\n0,0,.5\n").unwrap();
        let args = format!("shape {input} {given} -o solid.vtu solid.json solid.npz");
        common::ok(folder, &args.split(' ').collect::<Vec<_>>());
        let (code, _, stderr) = common::run(folder, &["check", "solid.vtu"]);
        assert_eq!(code, 1, "{stderr}");
        assert!(stderr.contains(what) && stderr.contains(".json or .npz"), "{stderr}");
        let (_, stdout, _) = common::run(folder, &["check", "solid.json"]);
        assert!(stdout.contains("verdict   exact"), "{stdout}");
        for file in ["solid.json", "solid.npz"] {
            let (code, _, stderr) = common::run(folder, &["info", file]);
            assert_eq!(code, 1, "{stderr}");
            assert!(
                stderr.contains("simplices of a shape") && stderr.contains("walpha check"),
                "{stderr}"
            );
        }
    }
    write_grid(&folder.join("cloud.vtu"), &points, &(0..8).map(|v| vec![v]).collect::<Vec<_>>());
    let stdout = common::ok(folder, &["check", "cloud.vtu", "--alpha", "1"]);
    assert!(stdout.starts_with("judged    our own shape of cloud.vtu"), "{stdout}");
    assert!(common::json(folder, &["info", "cloud.vtu"])["cells"].is_null());
    for (cells, code, words) in [
        (vec![vec![0, 1, 2, 8]], 1, "names point 8"),
        (vec![vec![0, 1, 2, 3], vec![0, 1, 2, 4]], 3, "verdict   wrong"),
    ] {
        write_grid(&folder.join("wrong.vtu"), &points, &cells);
        let (got, stdout, stderr) = common::run(folder, &["check", "wrong.vtu"]);
        assert_eq!(got, code, "{stdout}{stderr}");
        assert!((stdout + &stderr).contains(words), "{stderr}");
    }
}

/// Points in a plane, as the shape and as its file.
#[test]
fn flat_sets_are_judged() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("t.csv"), "x,y,z\n0,0,0\n1,0,0\n0,1,0\n1,1,0\n1.25,0.5,0\n")
        .unwrap();
    let mut sizes = Vec::new();
    for alpha in ["inf", "0", "0.25", "0.5", "1.1", "-1"] {
        for exterior in [&[][..], &["--exterior"]] {
            let make =
                ["shape", "t.csv", "--weights", "common=0", "--alpha", alpha, "-o", "t.json"];
            // At α = −1 the shape is empty.
            let empty = if alpha == "-1" { &["--allow-empty"][..] } else { &[] };
            common::ok(folder, &[&make[..], exterior, empty].concat());
            let facts = common::json(folder, &["check", "t.json"]);
            assert_eq!(facts["verdict"], "exact", "{alpha} {exterior:?}: {facts:#}");
            sizes.push(facts["simplices"].clone());
        }
        let make = ["check", "t.csv", "--weights", "common=0", "--alpha", alpha, "--enumerate"];
        assert_eq!(common::json(folder, &make)["verdict"], "exact");
    }
    sizes.dedup();
    assert!(sizes.len() > 4, "{sizes:?}");
}

fn whole(case: &Case, answer: &Answer) -> Vec<Finding> {
    case.findings(answer, Extent::Whole)
}

fn shape(case: &Case, answer: &Answer) -> Vec<Finding> {
    case.findings(answer, Extent::Shape)
}

/// Points with ties, hidden points and duplicates.
fn lattice_case(random: &mut Random) -> Case {
    let n = 10 + random.below(40);
    let side = 3 + random.below(3);
    let positions = (0..n).map(|_| [0; 3].map(|_| random.below(side) as f64)).collect();
    let kinds = 1 + random.below(5);
    let weights = (0..n).map(|_| random.below(kinds) as f64 / 2.0).collect();
    let alpha = random.pick(&[-1.0, 0.0, 0.5, 0.75, 1.0, 2.0, 5.0, f64::INFINITY]);
    Case { positions, weights, alpha }
}

#[test]
fn right_answers_are_certified() {
    let mut random = Random::new(3);
    let mut certified = 0;
    for _ in 0..1500 {
        let case = lattice_case(&mut random);
        let Ok(answer) = engine(&case) else { continue };
        assert_eq!(whole(&case, &answer), [], "{case:?}");
        assert_eq!(shape(&case, &shape_of(&answer)), [], "{case:?}");
        certified += 1;
    }
    assert!(certified > 1200);
}

#[test]
fn a_grid_with_min_max_weights_is_certified() {
    let mut random = Random::new(12);
    let positions = grid(12);
    let weights = (0..positions.len()).map(|_| 3.0 * random.unit()).collect();
    let case = Case { positions, weights, alpha: 3.0 };
    let answer = engine(&case).unwrap();
    assert!(answer.hidden.len() > 50);
    let (findings, certificate) = case.claim(&answer, Extent::Whole).findings().unwrap();
    assert_eq!(findings, []);
    assert_eq!(certificate.not_judged, []);
    assert_eq!(certificate.six_volumes.to_string(), (6 * 11 * 11 * 11).to_string());
    assert_eq!(shape(&case, &shape_of(&answer)), []);
}

/// The local engine never sees the whole triangulation; its shape is certified all the same.
#[test]
fn shapes_made_slab_by_slab_are_certified() {
    let mut random = Random::new(8);
    for blocks in [2, 5] {
        let mut positions = grid(14);
        positions.retain(|_| random.unit() < 0.5);
        let weights: Vec<_> = positions.iter().map(|_| random.below(4) as f64 / 2.0).collect();
        let mut options = ShapeOptions::new(Alpha::from_squared(1.5).unwrap());
        (options.engine, options.blocks) = (Engine::Native, NonZeroUsize::new(blocks));
        let points = WeightedPoints::new(positions, weights).unwrap();
        let shape = alpha_shape(points, &options).unwrap();
        let (findings, certificate) = claim(&shape).findings().unwrap();
        assert_eq!(findings, []);
        assert!(certificate.not_judged.contains(&NotJudged::HiddenAndHull));
        assert!(shape.complex().cells.len() > 1000);
    }
}

fn points() -> WeightedPoints {
    let mut random = Random::new(5);
    let mut positions = grid(4);
    positions.iter_mut().flatten().step_by(7).for_each(|x| *x += random.unit());
    positions.push(positions[3]);
    let weights = (0..65).map(|_| random.unit()).collect();
    WeightedPoints::new(positions, weights).unwrap()
}

/// The two files of a shape say the same, also when `NumPy` has compressed one of them.
#[test]
fn npz_is_json() {
    let points = points();
    for (alpha, exterior) in [(0.9, true), (0.9, false), (f64::INFINITY, false), (-5.0, false)] {
        let options = ShapeOptions::new(Alpha::from_squared(alpha).unwrap()).exterior(exterior);
        let shape = alpha_shape(points.clone(), &options).unwrap();
        let (mut json, mut npz) = (Vec::new(), Vec::new());
        Json.write(&shape, &mut json).unwrap();
        Npz.write(&shape, &mut npz).unwrap();
        let mut json = ComplexFile::read_json(&json[..]).unwrap();
        json.info = None;
        for bytes in [compressed(&npz), npz] {
            assert_eq!(ComplexFile::read_npz(Cursor::new(bytes)).unwrap(), json, "α = {alpha}");
        }
    }
}

fn compressed(archive: &[u8]) -> Vec<u8> {
    let mut stored = zip::ZipArchive::new(Cursor::new(archive)).unwrap();
    let mut packed = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Deflated);
    for i in 0..stored.len() {
        let mut member = stored.by_index(i).unwrap();
        packed.start_file(member.name(), options).unwrap();
        std::io::copy(&mut member, &mut packed).unwrap();
    }
    packed.finish().unwrap().into_inner()
}
