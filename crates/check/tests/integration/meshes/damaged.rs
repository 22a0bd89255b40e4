//! Damaged, truncated and hostile files: errors that say what, where and what to do, never a panic or much memory.

use walpha_base::random::Random;
use walpha_check::Advise;

use super::writers::{File, Form, all, gmsh_2, gmsh_4, medit, tetgen, vtk};
use super::{folder, read};

const POINTS: [[f64; 3]; 5] =
    [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [2.0, 2.0, 2.0]];
const CELLS: [[u32; 4]; 2] = [[0, 1, 2, 3], [1, 2, 3, 4]];

/// The error for the files of a format with a text replaced, which must be there.
fn error_of(files: Vec<File>, from: &[u8], to: &[u8]) -> String {
    let mut replaced = 0;
    let files: Vec<(&str, Vec<u8>)> = files
        .into_iter()
        .map(|(name, mut bytes)| {
            if let Some(at) = bytes.windows(from.len()).position(|window| window == from) {
                bytes.splice(at..at + from.len(), to.iter().copied());
                replaced += 1;
            }
            (name, bytes)
        })
        .collect();
    assert!(replaced > 0, "{:?} is not there", String::from_utf8_lossy(from));
    let files: Vec<(&str, &[u8])> = files.iter().map(|(name, bytes)| (*name, &bytes[..])).collect();
    let error = read(folder(), &files).unwrap_err();
    assert!(error.advice().is_some_and(|advice| !advice.to_string().is_empty()), "{error}");
    error.to_string()
}

/// Replaces a text of files by another one, and expects words in the error.
fn refuses(cases: Vec<(Vec<File>, &str, &str, &str)>) {
    let mut others = Vec::new();
    for (files, from, to, expected) in cases {
        let error = error_of(files, from.as_bytes(), to.as_bytes());
        if !error.contains(expected) {
            others.push([from.to_owned(), to.to_owned(), expected.to_owned(), error]);
        }
    }
    assert!(others.is_empty(), "{others:#?}");
}

#[test]
fn errors_of_tetgen_say_what_and_where() {
    let node = || tetgen(&POINTS, &CELLS, 1);
    refuses(vec![
        (
            node(),
            "2 1.0 0.0",
            "2 nan 0.0",
            "line 3: a coordinate is NaN, and must be a finite number",
        ),
        (
            node(),
            "2 1.0 0.0",
            "2 1e999 0.0",
            "line 3: a coordinate is inf, and must be a finite number",
        ),
        (node(), "2 1.0 0.0", "2 1,0 0.0", "line 3: \"1,0\" is not a coordinate"),
        (
            node(),
            "2 1.0 0.0",
            "2 0.0",
            "line 3: a point has 3 numbers, and by the first line of the file 4",
        ),
        (node(), "2 1.0 0.0", "3 1.0 0.0", "line 3: a point has the number 3 where 2 should be"),
        (
            node(),
            "1 0.0 0.0",
            "7 0.0 0.0",
            "line 2: a point has the number 7 where 0 or 1 should be",
        ),
        (node(), "5 3 0 0", "5 2 0 0", "line 1: points have 2 coordinates, not 3"),
        (
            node(),
            "5 3 0 0",
            "4 3 0 0",
            "line 6: there are more points than the first line of the file states",
        ),
        (
            node(),
            "5 3 0 0",
            "6 3 0 0",
            "line 6: the file ends where a point should follow: it is truncated",
        ),
        (
            node(),
            "2 4 0\n",
            "2 10 0\n",
            "t.ele: the file lists tetrahedra of 10 nodes, and only tetrahedra of 4 nodes are judged",
        ),
        (
            node(),
            "2 4 0\n1 1 2 3 4",
            "2 4 0\n1 1 2 3 6",
            "t.ele, line 2: corner 6 of a cell is not the number of a point: they are 1 to 5",
        ),
        (
            node(),
            "2 4 0\n1 1 2 3 4",
            "2 4 0\n1 1 2 3 0",
            "t.ele, line 2: corner 0 of a cell is not the number of a point: they are 1 to 5",
        ),
    ]);
}

#[test]
fn errors_of_medit_say_what_and_where() {
    let mesh = || medit(&POINTS, &CELLS);
    refuses(vec![
        (
            mesh(),
            "MeshVersionFormatted",
            "MFEM",
            "the file does not begin with MeshVersionFormatted: it is not a mesh of Medit",
        ),
        (
            mesh(),
            "MeshVersionFormatted",
            "\u{1}\0\0\0",
            "the file is binary Medit (.meshb), which is not read",
        ),
        (mesh(), "Dimension 3", "Dimension 2", "line 2: points have 2 coordinates, not 3"),
        (
            mesh(),
            "1.0 0.0 0.0 0",
            "1.0 inf 0.0 0",
            "line 6: a coordinate is inf, and must be a finite number",
        ),
        (
            mesh(),
            "2 3 4 5 0",
            "2 3 4 6 0",
            "line 13: corner 6 of a cell is not the number of a point: they are 1 to 5",
        ),
        (
            mesh(),
            "2 3 4 5 0",
            "2 3 4 0 0",
            "line 13: corner 0 of a cell is not the number of a point: they are 1 to 5",
        ),
        (
            mesh(),
            "1 2 3 4 0\n2 3 4 5 0\nEnd\n",
            "1 2 3 4 000000000\n2 3 4",
            "line 13: the file ends where the number of a point should follow: it is truncated",
        ),
        (
            mesh(),
            "End",
            "Hexahedra 1 1 2 3 4 5 1 2 3 0 End",
            "the file lists 1 Hexahedra, and only tetrahedra of 4 nodes are judged",
        ),
        (
            mesh(),
            "Tetrahedra",
            "Triangles",
            "the file lists no tetrahedra, which are what is judged",
        ),
        (mesh(), "Vertices\n5", "Vertices\n4", "line 9: \"2.0\" stands where a keyword should be"),
    ]);
}

#[test]
fn errors_of_gmsh_say_what_and_where() {
    let two = || gmsh_2(&POINTS, &CELLS, Form::Text);
    let four = || gmsh_4(&POINTS, &CELLS, Form::Text);
    refuses(vec![
        (
            two(),
            "$MeshFormat",
            "$NOD",
            "the file does not begin with $MeshFormat: it is not a mesh of Gmsh from version 2 on",
        ),
        (two(), "2.2 0 8", "4.0 0 8", "line 2: the version is \"4.0\", and 2.2 and 4.1 are read"),
        (two(), "2.2 0 8", "2.2 0 4", "line 2: numbers have 4 bytes, and 8 are read"),
        (two(), "17 0.0", "14 0.0", "line 10: two nodes have the tag 14"),
        (two(), "17 0.0", "-1 0.0", "line 6: -1 is negative, and must not be"),
        (
            two(),
            "7 17 14",
            "7 18 14",
            "line 16: corner 18 of a cell is not the tag of a node that comes before it",
        ),
        (
            two(),
            "2 4 1",
            "2 5 1",
            "the file lists hexahedra, and only tetrahedra of 4 nodes are judged",
        ),
        (two(), "2 4 1", "2 77 1", "line 16: elements have the type 77, which is not known here"),
        (
            two(),
            "$Elements\n3",
            "$Elements\n2",
            "line 17: \"3\" stands where $Elements should end: its counts are wrong",
        ),
        (
            two(),
            "$EndElements",
            "",
            "line 17: the file ends where the end of a section should follow: it is truncated",
        ),
        (four(), "2 5 5 17", "2 6 5 17", "line 5: blocks have 5 nodes, and the section states 6"),
        (
            four(),
            "2 5 5 17",
            "2 4 5 17",
            "line 5: blocks have more nodes than the 4 that the section states",
        ),
        (
            four(),
            "3 1 4 2",
            "3 1 11 2",
            "the file lists tetrahedra of 10 nodes, and only tetrahedra of 4 nodes are judged",
        ),
        (
            four(),
            "3 1 4 2",
            "3 1 4 3",
            "line 8: blocks have more elements than the 3 that the section states",
        ),
        (four(), "3 1 4 2", "3 1 4 1", "line 8: blocks have 2 elements, and the section states 3"),
        (four(), "1.0 0.0", "nan 0.0", "line 5: a coordinate is NaN, and must be a finite number"),
    ]);
}

#[test]
fn errors_of_vtk_say_what_and_where() {
    let old = || vtk(&POINTS, &CELLS, Form::Text, "4.2");
    let new = || vtk(&POINTS, &CELLS, Form::Text, "5.1");
    refuses(vec![
        (
            old(),
            "# vtk",
            "# what",
            "the file does not begin with # vtk DataFile: it is not a legacy VTK file",
        ),
        (old(), "ASCII", "XML", "line 3: \"XML\" is neither ASCII nor BINARY"),
        (
            old(),
            "UNSTRUCTURED_GRID",
            "POLYDATA",
            "line 4: the dataset is POLYDATA, and cells are read from UNSTRUCTURED_GRID",
        ),
        (old(), "1.0 0.0", "nan 0.0", "a coordinate is NaN, and must be a finite number"),
        (old(), "CELLS 2 10", "CELLS 2 9", "the 9 numbers of cells are not those of 2 cells"),
        (old(), "CELLS 2 10", "CELLS 3 10", "the 10 numbers of cells are not those of 3 cells"),
        (old(), "4 1 2 3 4", "3 1 2 3 4", "the 10 numbers of cells are not those of 2 cells"),
        (old(), "4 1 2 3 4", "4 1 2 3 -1", "cell 1: corner -1 is not the index of a point"),
        (
            old(),
            "10 10",
            "10 12",
            "cell 1: the file lists hexahedra, and only tetrahedra of 4 nodes are judged",
        ),
        (old(), "CELL_TYPES 2\n10 10", "CELL_TYPES 1\n10", "2 cells have 1 types"),
        (
            old(),
            "10 10",
            "10 14",
            "cell 1: the file lists pyramids, and only tetrahedra of 4 nodes are judged",
        ),
        (
            old(),
            "POINT_DATA 5",
            "POINT_DATA 4",
            "line 11: the data are those of 4, and there are 5",
        ),
        (
            old(),
            "SCALARS weight double",
            "SCALARS weight bit",
            "line 12: \"bit\" is not a type of numbers that is read",
        ),
        (
            old(),
            "LOOKUP_TABLE default\n",
            "",
            "line 13: \"0.0\" stands where LOOKUP_TABLE should, below SCALARS weight",
        ),
        (
            old(),
            "SCALARS weight",
            "WHAT weight",
            "line 12: \"WHAT\" stands where data should begin",
        ),
        (new(), "OFFSETS", "ONSETS", "line 8: \"ONSETS\" stands where OFFSETS should"),
        (new(), "0 4 8", "0 4 9", "cell 1: its corners are numbers 4 to 9 of 8"),
        (new(), "0 4 8", "0 3 8", "cell 0: it has 3 corners, and its type 4"),
    ]);
}

/// Behind binary numbers, places are bytes.
#[test]
fn errors_in_binary_say_which_byte() {
    let nan = f64::NAN.to_le_bytes();
    let one = 1f64.to_le_bytes();
    let error = error_of(gmsh_4(&POINTS, &CELLS, Form::Little), &one, &nan);
    let bytes = gmsh_4(&POINTS, &CELLS, Form::Little).remove(0).1;
    let at = bytes.windows(8).position(|window| window == one).unwrap();
    assert_eq!(error, format!("byte {at}: a coordinate is NaN, and must be a finite number"));
    let error = error_of(gmsh_2(&POINTS, &CELLS, Form::Big), &[0, 0, 0, 1, b'\n'], b"\0\0\0\x02\n");
    assert!(error.ends_with("the order of bytes is not stated by a 1"), "{error}");
}

/// The size that a file states is compared with its actual size, before memory is allocated.
#[test]
fn counts_beyond_the_file_are_refused() {
    let huge = ["4294967295", "99999999999999999", "18446744073709551615"];
    let text = Form::Text;
    for count in huge {
        let third = (count.parse::<u64>().unwrap() / 3).to_string();
        for (files, from, to) in [
            (tetgen(&POINTS, &CELLS, 1), "5 3 0 0".to_owned(), format!("{count} 3 0 0")),
            (tetgen(&POINTS, &CELLS, 1), "2 4 0\n".into(), format!("{count} 4 0\n")),
            (tetgen(&POINTS, &CELLS, 1), "5 3 0 0".into(), format!("5 3 {count} 0")),
            (medit(&POINTS, &CELLS), "Vertices\n5".into(), format!("Vertices\n{count}")),
            (medit(&POINTS, &CELLS), "Tetrahedra\n2".into(), format!("Tetrahedra\n{count}")),
            (gmsh_2(&POINTS, &CELLS, text), "$Nodes\n5".into(), format!("$Nodes\n{count}")),
            (gmsh_2(&POINTS, &CELLS, text), "$Elements\n3".into(), format!("$Elements\n{count}")),
            (gmsh_2(&POINTS, &CELLS, Form::Little), "$Nodes\n5".into(), format!("$Nodes\n{count}")),
            (
                gmsh_2(&POINTS, &CELLS, Form::Little),
                "$Elements\n3".into(),
                format!("$Elements\n{count}"),
            ),
            (gmsh_4(&POINTS, &CELLS, text), "$Nodes\n2 5".into(), format!("$Nodes\n2 {count}")),
            (
                gmsh_4(&POINTS, &CELLS, text),
                "$Elements\n2 3".into(),
                format!("$Elements\n2 {count}"),
            ),
            (vtk(&POINTS, &CELLS, text, "4.2"), "POINTS 5".into(), format!("POINTS {third}")),
            (vtk(&POINTS, &CELLS, Form::Big, "4.2"), "POINTS 5".into(), format!("POINTS {third}")),
            (
                vtk(&POINTS, &CELLS, Form::Big, "4.2"),
                "CELLS 2 10".into(),
                format!("CELLS 2 {count}"),
            ),
            (
                vtk(&POINTS, &CELLS, Form::Big, "5.1"),
                "CELLS 3 8".into(),
                format!("CELLS {count} 8"),
            ),
            (vtk(&POINTS, &CELLS, Form::Big, "5.1"), "TYPES 2".into(), format!("TYPES {count}")),
        ] {
            let error = error_of(files, from.as_bytes(), to.as_bytes());
            assert!(error.contains("which cannot hold them"), "{to}: {error}");
        }
    }
}

/// Files cut anywhere, and bytes changed anywhere.
#[test]
fn damage_makes_errors_or_meshes() {
    let folder = folder();
    let mut random = Random::new(342);
    let (mut good, mut refused) = (0, 0);
    for files in all(&POINTS, &CELLS) {
        let whole: Vec<(&str, &[u8])> =
            files.iter().map(|(name, bytes)| (*name, &bytes[..])).collect();
        for round in 0..300 {
            let mut bytes = files[0].1.clone();
            if round % 2 == 0 {
                bytes.truncate(random.below(bytes.len()));
            }
            for _ in 0..random.below(4) {
                if !bytes.is_empty() {
                    let at = random.below(bytes.len());
                    bytes[at] = random.pick(&[b'0', b'9', b'-', b'\n', b' ', 0, 0xff, 0x80]);
                }
            }
            let mut damaged = whole.clone();
            damaged[0].1 = &bytes;
            match read(&folder, &damaged) {
                Ok(_) => good += 1,
                Err(error) => {
                    assert!(!error.to_string().is_empty());
                    refused += 1;
                }
            }
        }
    }
    assert!(good > 100 && refused > 1500, "{good} read, {refused} refused");
}
