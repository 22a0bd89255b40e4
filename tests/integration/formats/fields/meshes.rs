//! PLY, OFF, OBJ and STL.

use super::points::*;
use super::{Fate, walk};
use crate::common::{json, ok, run};

/// A PLY of this format, with these lines between the first and the last of the header.
fn ply(format: &str, lines: &str, data: &[u8]) -> Vec<u8> {
    [format!("ply\nformat {format} 1.0\n{lines}end_header\n").as_bytes(), data].concat()
}

/// The lines of two vertices with a further property.
fn vertex(property: &str) -> String {
    format!("element vertex 2\nproperty float x\nproperty float y\nproperty float z\n{property}")
}

fn floats(numbers: &[f32], order: fn(f32) -> [u8; 4]) -> Vec<u8> {
    numbers.iter().copied().flat_map(order).collect()
}

const ALL: [f32; 6] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
const ROWS: &[u8] = b"1 2 3\n4 5 6\n";

#[test]
#[expect(clippy::too_many_lines, reason = "a row for each field")]
fn each_field_of_ply() {
    walk(
        "PLY",
        &[
            row!("`ascii`", "a.ply", ply("ascii", &vertex(""), ROWS), Fate::Read(without_a_word)),
            row!(
                "`binary_little_endian`",
                "a.ply",
                ply("binary_little_endian", &vertex(""), &floats(&ALL, f32::to_le_bytes)),
                Fate::Read(without_a_word)
            ),
            row!(
                "`binary_big_endian`",
                "a.ply",
                ply("binary_big_endian", &vertex(""), &floats(&ALL, f32::to_be_bytes)),
                Fate::Read(without_a_word)
            ),
            row!(
                "another format",
                "a.ply",
                ply("xml", &vertex(""), ROWS),
                Fate::Refused(&["format xml", "not understood"])
            ),
            row!(
                "ends of lines",
                "a.ply",
                {
                    let head =
                        String::from_utf8(ply("binary_little_endian", &vertex(""), b"")).unwrap();
                    [head.replace('\n', "\r").as_bytes(), &floats(&ALL, f32::to_le_bytes)].concat()
                },
                Fate::Read(without_a_word)
            ),
            row!(
                "types of properties",
                "a.ply",
                ply(
                    "ascii",
                    "element vertex 2\nproperty int8 x\nproperty ushort y\nproperty double z\n",
                    ROWS
                ),
                Fate::Read(without_a_word)
            ),
            row!(
                "order of properties",
                "a.ply",
                ply(
                    "ascii",
                    "element vertex 2\nproperty list uchar int l\nproperty int z\nproperty int y\nproperty int x\n",
                    b"2 9 9 3 2 1\n0 6 5 4\n"
                ),
                Fate::Read(without_a_word)
            ),
            row!(
                "`weight`",
                "a.ply",
                ply("ascii", &vertex("property float scalar_weight\n"), b"1 2 3 7\n4 5 6 8\n"),
                Fate::Read(weights)
            ),
            row!(
                "`radius`",
                "a.ply",
                ply("ascii", &vertex("property float radius\n"), b"1 2 3 2\n4 5 6 3\n"),
                Fate::Read(radii)
            ),
            row!(
                "`value`, or else `intensity`",
                "a.ply",
                ply("ascii", &vertex("property float scalar_intensity\n"), b"1 2 3 7\n4 5 6 8\n"),
                Fate::Read(values)
            ),
            row!(
                "x, y or z missing, or twice",
                "a.ply",
                ply("ascii", &vertex("property float x\n"), b"1 2 3 1\n4 5 6 4\n"),
                Fate::Refused(&["2 vertex properties x"])
            ),
            row!(
                "elements before and behind the vertices",
                "a.ply",
                ply(
                    "ascii",
                    &format!(
                        "element face 1\nproperty list uchar int v\n{}element edge 1\nproperty int a\n",
                        vertex("")
                    ),
                    b"3 0 1 2\n1 2 3\n4 5 6\n9\n"
                ),
                Fate::Read(without_a_word)
            ),
            row!(
                "two elements `vertex`",
                "a.ply",
                ply("ascii", &vertex("").repeat(2), &ROWS.repeat(2)),
                Fate::Refused(&["two elements vertex"])
            ),
            row!(
                "a count that is too low",
                "a.ply",
                ply("ascii", &vertex(""), b"1 2 3\n4 5 6\n7 8 9\n"),
                Fate::Refused(&["continues after its last element", "correct its header"])
            ),
            row!(
                "a count that is too high",
                "a.ply",
                ply("ascii", &vertex(""), b"1 2 3\n4 5\n"),
                Fate::Refused(&["ends before all its elements", "copy it again"])
            ),
            row!(
                "zeros and line ends behind the last element",
                "a.ply",
                ply(
                    "binary_little_endian",
                    &vertex(""),
                    &[floats(&ALL, f32::to_le_bytes), b"\0\0\n".to_vec()].concat()
                ),
                Fate::Read(without_a_word)
            ),
            row!(
                "rows over several lines, or several in one",
                "a.ply",
                ply("ascii", &vertex("property int a\n"), b"1 2\n3 9\n4\n5\n6\n9"),
                Fate::Read(without_a_word)
            ),
            row!(
                "lines of more or fewer numbers than declared",
                "a.ply",
                ply(
                    "ascii",
                    &format!("{}element face 1\nproperty list uchar int v\n", vertex("")),
                    b"1 2 3 7\n4 5 6 7\n3 0 1\n0\n"
                ),
                Fate::Refused(&["has 4 numbers in line 1 behind its header, which declares 3"])
            ),
            row!(
                "NaN",
                "a.ply",
                ply("ascii", &vertex(""), b"1 2 3\n4 nan 6\n"),
                Fate::Refused(&["row 1: y is NaN"])
            ),
            row!(
                "other fields",
                "a.ply",
                ply(
                    "ascii",
                    &format!("comment c\nobj_info o\n{}", vertex("property uchar red\n")),
                    b"1 2 3 9\n4 5 6 9\n"
                ),
                Fate::Read(without_a_word)
            ),
        ],
    );
}

/// The error tells the content of the lines, rather than a wrong count.
#[test]
fn lines_that_differ_from_the_header_of_ply_are_named() {
    let folder = tempfile::tempdir().unwrap();
    for (rows, words) in [
        (&b"1 2 3 0 0 1\n4 5 6 0 0 1\n"[..], "has 6 numbers in line 1 behind"),
        (b"1 2 3 red\n4 5 6 red\n", "has 4 numbers in line 1 behind"),
        (b"1 2\n4 5 6\n7\n", "has 2 numbers in line 1 behind"),
        (b"\n1 2 3 4\n5 6\n", "has 4 numbers in line 2 behind"),
    ] {
        let bytes = ply("ascii", &vertex(""), rows);
        let path = crate::formats::files::save(folder.path(), "a.ply", bytes);
        let error = walpha::points::read_points(path, None).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
    let bytes = ply("ascii", &vertex(""), b"1 2 3 4 5 6\n");
    without_a_word(&crate::formats::files::save(folder.path(), "a.ply", bytes));
}

#[test]
fn each_field_of_off() {
    walk(
        "OFF",
        &[
            row!("`OFF`", "a.off", "OFF\n2 0 0\n1 2 3\n4 5 6\n", Fate::Read(without_a_word)),
            row!(
                "counts behind `OFF`",
                "a.off",
                "OFF 2 1 0 # mesh\n1 2 3\n4 5 6\n3 0 1 0\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "`COFF`, `NOFF`, `STOFF`",
                "a.off",
                "STCNOFF\n2 0 0\n1 2 3 0 0 1 9 9 9 9 0 0\n4 5 6 0 0 1 9 9 9 9 0 0\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "`nOFF` of 3 coordinates",
                "a.off",
                "nOFF 3\n2 0 0\n1 2 3\n4 5 6\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "`4OFF`, `nOFF` of others",
                "a.off",
                "4OFF\n1 0 0\n1 2 3 4\n",
                Fate::Refused(&["is 4OFF", "three coordinates"])
            ),
            row!(
                "a count right behind the kind",
                "a.off",
                "OFF2 0 0\n1 2 3\n4 5 6\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "line breaks anywhere",
                "a.off",
                "OFF\n2 1\n0\n1 2\n3 4 5 6\n3\n0 1 0\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "lines of other numbers than a vertex has",
                "a.off",
                "OFF\n2 0 0\n1 2 3 4\n4 5 6 7\n",
                Fate::Refused(&["has 4 numbers in line 3, where a vertex has 3"])
            ),
            row!("`BINARY`", "a.off", "OFF BINARY\n", Fate::Refused(&["is binary"])),
            row!(
                "counts that are too high",
                "a.off",
                "OFF\n3 0 0\n1 2 3\n4 5 6\n",
                Fate::Refused(&["ends before its 3 vertices", "copy it again"])
            ),
            row!(
                "counts that are too low",
                "a.off",
                "OFF\n1 0 0\n1 2 3\n4 5 6\n",
                Fate::Refused(&["goes on in line 4", "correct its counts"])
            ),
            row!(
                "ends of lines",
                "a.off",
                "OFF\r2 0 0\r1 2 3\r4 5 6\r",
                Fate::Read(without_a_word)
            ),
        ],
    );
}

/// Lines mean nothing where the numbers are those of the counts; where they are not, nothing is read.
#[test]
fn off_is_read_word_by_word() {
    let folder = tempfile::tempdir().unwrap();
    let save = |text: &str| crate::formats::files::save(folder.path(), "a.off", text);
    for text in [
        "OFF 2 1 0 1 2 3 4 5 6 3 0 1 0",
        "OFF\n2 2 0\n1 2 3  4 5 6\n3 0 1 0\n3 0 1 1\n",
        "OFF\n2 1\n1 2 3 255 0 0\n4 5 6 0 0 0\n3 0 1 0 0.5 0.5 0.5\n",
        "COFF\n2 0 0\n1 2 3 255 0 0\n4 5 6 0 0 0\n",
        "COFF\n2 1 0\n1 2 3\n1 0 0 1 4 5 6 0 0 0 1 2 0 1\n",
        "2 0 0\n1 2 3\n4 5 6\n",
    ] {
        without_a_word(&save(text));
    }
    for (text, words) in [
        ("OFF\n2 0 0\n1 2 3 4 5 6\n7 8 9\n", "goes on in line 4"),
        (
            "OFF\n4 2 0\n0 0 0  1 0 0\n0 1 0  0 0 1\n3 0 1 2\n3 0 1 3\n4 0 1 2 3\n3 1 2 3\n",
            "goes on in line 7",
        ),
        ("OFF\n2 1 0\n1 2 3\n4 5 6\n3 0 1\n", "ends before its 2 vertices and 1 faces"),
        ("OFF\n2 1 0\n1 2 3\n4 5 6\nx\n", "\"x\" is not the number of corners"),
        ("OFFICE\n", "does not say how many"),
    ] {
        let error = walpha::points::read_points(save(text), None).unwrap_err().to_string();
        assert!(error.contains(words), "{text}: {error}");
    }
}

#[test]
fn each_field_of_obj() {
    walk(
        "OBJ",
        &[
            row!("`v`", "a.obj", "v 1 2 3\nv 4 5 6\n", Fate::Read(without_a_word)),
            row!(
                "colours of vertices",
                "a.obj",
                "v 1 2 3 0.5 1 0\nv 4 5 6 0 0 0\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "w of rational curves",
                "a.obj",
                "v 1 2 3 2\nv 4 5 6 1\n",
                Fate::PassedOver(&["1 vertices have a weight w", "not divided"])
            ),
            row!(
                "lines that go on",
                "a.obj",
                "v 1 2 \\\n3\nv 4 5 6\nf 1 \\\n2 1\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "comments",
                "a.obj",
                "#\\\nv 1 2 3 # 1 \\\n# C:\\\nv 4 5 6 #\\\nf 1 2 1\n",
                Fate::Read(without_a_word)
            ),
            row!("ends of lines", "a.obj", "v 1 2 3\rv 4 5 6\r", Fate::Read(without_a_word)),
            row!(
                "decimal commas",
                "a.obj",
                "v 1,5 2,5 3,5\n",
                Fate::Refused(&["line 1: x is \"1,5\""])
            ),
            row!(
                "other fields",
                "a.obj",
                "# c\no a\nv 1 2 3\nvn 0 0 1\nvt 0 0\nv 4 5 6\nf -1 -2 -1\n",
                Fate::Read(without_a_word)
            ),
        ],
    );
}

/// A text of one facet, whose third corner is the first.
const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nvertex 4 5 6\nvertex 1 2 3\nendloop\nendfacet\nendsolid a\n";

/// A binary file that claims `count` facets and has this one, with attribute bytes.
fn stl(head: &str, count: u32, attribute: u16, behind: &[u8]) -> Vec<u8> {
    let mut bytes = format!("{head:80}").into_bytes();
    bytes.extend(count.to_le_bytes());
    bytes.extend(floats(
        &[0.0, 0.0, 1.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 1.0, 2.0, 3.0],
        f32::to_le_bytes,
    ));
    bytes.extend(attribute.to_le_bytes());
    bytes.extend(behind);
    bytes
}

#[test]
fn each_field_of_stl() {
    walk(
        "STL",
        &[
            row!("text", "a.stl", STL, Fate::Read(without_a_word)),
            row!(
                "letter case, blanks, marks of encodings",
                "a.stl",
                format!("\u{feff}\n  {}", STL.to_uppercase()),
                Fate::Read(without_a_word)
            ),
            row!(
                "long names",
                "a.stl",
                STL.replace("solid a", &format!("solid {}", "n/".repeat(600))),
                Fate::Read(without_a_word)
            ),
            row!("ends of lines", "a.stl", STL.replace('\n', "\r"), Fate::Read(without_a_word)),
            row!(
                "several solids",
                "a.stl",
                STL.repeat(2).replace("4 5 6", "4 5 6 "),
                Fate::Read(without_a_word)
            ),
            row!(
                "line breaks anywhere",
                "a.stl",
                STL.replace("solid a", "solid of facet vertex").replace('\n', " ")
                    + &STL.replace("loop\n", "loop "),
                Fate::Read(|path| {
                    without_a_word(path);
                    let told = json(path.parent().unwrap(), &["info", "a.stl"]);
                    assert_eq!(told["cells"][0]["count"], 2, "{told}");
                })
            ),
            row!(
                "facets of other than three corners",
                "a.stl",
                STL.replace("vertex 1 2 3\nendloop", "endloop"),
                Fate::PassedOver(&["has 2 vertices in 1 facets"])
            ),
            row!(
                "a solid without an end",
                "a.stl",
                STL.replace("endsolid a\n", ""),
                Fate::Refused(&["ends before endsolid", "copy it again"])
            ),
            row!(
                "binary, whatever its header",
                "a.stl",
                stl("solid of a program", 1, 0, b""),
                Fate::Read(without_a_word)
            ),
            row!(
                "attributes of facets",
                "a.stl",
                stl("COLOR=", 1, 0x8111, b""),
                Fate::PassedOver(&["attributes of its facets"])
            ),
            row!(
                "a line end behind the facets",
                "a.stl",
                stl("solid", 1, 0, b"\n"),
                Fate::Read(without_a_word)
            ),
            row!(
                "bytes behind the facets",
                "a.stl",
                stl("b", 1, 0, b"more"),
                Fate::PassedOver(&["4 bytes behind its facets"])
            ),
            row!(
                "a count that is too low",
                "a.stl",
                stl("solid", 0, 0, b""),
                Fate::Refused(&["claims 0 facets", "more facets follow", "right count"])
            ),
            row!(
                "a count that is too high",
                "a.stl",
                stl("b", 2, 0, b""),
                Fate::Refused(&["claims 2 facets, 184 bytes, but has 134", "copy it again"])
            ),
        ],
    );
}

/// What our own meshes state is kept: axes, unit, and the offset of single precision. Their facets are not used, which is said.
#[test]
fn a_mesh_keeps_what_it_states() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    ok(f, &["haar", "sample:ct", "--downsample", "4", "-o", "ct.nrrd"]);
    let made = ["ct.ply", "ct.obj", "ct.off", "ct.stl", "ct.vtu", "ct.vtp"];
    ok(f, &[&["shape", "ct.nrrd", "--threshold", "20", "-o"][..], &made].concat());
    for mesh in made {
        let (code, out, warned) = run(f, &["shape", mesh, "--alpha", "40", "--json"]);
        assert_eq!(code, 0, "{mesh}: {warned}");
        let facts: serde_json::Value = serde_json::from_str(&out).unwrap();
        let stated = &facts["coordinates"];
        assert_eq!((&stated["space"], &stated["unit"]), (&"LPS".into(), &"mm".into()), "{mesh}");
        assert!(warned.contains("are not used: a shape is made of its points alone"), "{warned}");
    }
    // Far from the origin single precision needs an offset, which is added again.
    let far = "x,y,z\n10000000,0,0\n10000001,0,0\n10000000,1,0\n10000000,0,1\n";
    std::fs::write(f.join("far.csv"), far).unwrap();
    ok(f, &["shape", "far.csv", "--alpha", "1", "-o", "far.stl"]);
    let facts = json(f, &["shape", "far.stl", "--alpha", "1"]);
    assert!((facts["shape"]["volume"].as_f64().unwrap() - 1.0 / 6.0).abs() < 1e-12);
    assert_eq!(facts["shape"]["components"][0]["low"][0].as_f64(), Some(1e7), "{facts}");
}
