//! VTU, VTP, and legacy VTK files of points.

use super::points::*;
use super::{Fate, walk};

/// A VTP of these pieces.
fn vtp(pieces: &str) -> String {
    format!(
        "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData>{pieces}</PolyData></VTKFile>"
    )
}

/// A piece of these points, with point data.
fn piece(places: &str, data: &str) -> String {
    let count = places.split(' ').count() / 3;
    format!(
        "<Piece NumberOfPoints=\"{count}\"><PointData>{data}</PointData><Points>{}</Points></Piece>",
        array("Float32", "p", 3, places)
    )
}

fn array(kind: &str, name: &str, components: u8, text: &str) -> String {
    format!(
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">{text}</DataArray>"
    )
}

fn with(data: &str) -> String {
    vtp(&piece("1 2 3 4 5 6", data))
}

#[test]
fn each_field_of_vtk_xml() {
    walk(
        "VTU, VTP",
        &[
            row!("`Points`", "a.vtp", with(""), Fate::Read(without_a_word)),
            row!(
                "types",
                "a.vtp",
                with("").replace("Float32", "Int16"),
                Fate::Read(without_a_word)
            ),
            row!(
                "points of other dimensions",
                "a.vtp",
                with("").replace("\"3\"", "\"2\""),
                Fate::Refused(&["points of 2 coordinates"])
            ),
            row!(
                "`weight`",
                "a.vtp",
                with(&array("Float64", "Weight", 1, "7 8")),
                Fate::Read(weights)
            ),
            row!(
                "`radius`",
                "a.vtp",
                with(&array("Float64", "radius", 1, "2 3")),
                Fate::Read(radii)
            ),
            row!(
                "`value`",
                "a.vtp",
                with(&array("Float64", "value", 1, "7 8")),
                Fate::Read(values)
            ),
            row!(
                "active scalars",
                "a.vtp",
                with(&array("Float64", "t", 1, "7 8"))
                    .replace("<PointData>", "<PointData Scalars=\"t\">"),
                Fate::Read(values)
            ),
            row!(
                "several pieces",
                "a.vtp",
                vtp(&(piece("1 2 3", "") + &piece("4 5 6", ""))),
                Fate::Read(without_a_word)
            ),
            row!(
                "pieces with different data",
                "a.vtp",
                vtp(&(piece("1 2 3", &array("Float64", "value", 1, "7")) + &piece("4 5 6", ""))),
                Fate::Refused(&["pieces with weights or values, and others without"])
            ),
            row!(
                "`vtkGhostType`",
                "a.vtp",
                vtp(&piece("1 2 3 4 5 6 9 9 9", &array("UInt8", "vtkGhostType", 1, "0 0 1"))),
                Fate::PassedOver(&["1 points are copies or hidden"])
            ),
            row!(
                "a count that is wrong",
                "a.vtp",
                with("").replace("NumberOfPoints=\"2\"", "NumberOfPoints=\"3\""),
                Fate::Refused(&["claims 9 numbers"])
            ),
            row!(
                "other fields",
                "a.vtp",
                with(&array("Float64", "n", 3, "0 0 1 0 0 1")),
                Fate::Read(without_a_word)
            ),
        ],
    );
}

/// A legacy file in text.
fn legacy(dataset: &str, data: &str) -> String {
    format!(
        "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET {dataset}\nPOINTS 2 float\n1 2 3 4 5 6\nPOINT_DATA 2\n{data}"
    )
}

#[test]
fn each_field_of_legacy_vtk() {
    walk(
        "VTK polygons and grids",
        &[
            row!("`POINTS`", "a.vtk", legacy("POLYDATA", ""), Fate::Read(without_a_word)),
            row!(
                "`BINARY`",
                "a.vtk",
                {
                    let numbers: Vec<u8> = [1f32, 2.0, 3.0, 4.0, 5.0, 6.0]
                        .iter()
                        .flat_map(|x| x.to_be_bytes())
                        .collect();
                    [&b"# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 2 float\n"[..], &numbers, b"\n"].concat()
                },
                Fate::Read(without_a_word)
            ),
            row!(
                "`weight`",
                "a.vtk",
                legacy("POLYDATA", "FIELD f 1\nweight 1 2 double\n7 8\n"),
                Fate::Read(weights)
            ),
            row!(
                "`radius`",
                "a.vtk",
                legacy("POLYDATA", "FIELD f 1\nradius 1 2 double\n2 3\n"),
                Fate::Read(radii)
            ),
            row!(
                "`value`, or else active scalars",
                "a.vtk",
                legacy("POLYDATA", "SCALARS t float\nLOOKUP_TABLE default\n7 8\n"),
                Fate::Read(values)
            ),
            row!(
                "`vtkGhostType`",
                "a.vtk",
                legacy("POLYDATA", "FIELD f 1\nvtkGhostType 1 2 unsigned_char\n0 2\n"),
                Fate::PassedOver(&["1 points are copies or hidden"])
            ),
            row!(
                "`FIELD` of the whole dataset",
                "a.vtk",
                legacy("POLYDATA", "FIELD f 1\nweight 1 2 double\n7 8\n")
                    .replace("POINTS", "FIELD FieldData 1\nweight 1 1 double\n9\nPOINTS"),
                Fate::Read(weights)
            ),
            row!(
                "texts",
                "a.vtk",
                legacy("POLYDATA", "FIELD f 2\nname 1 2 string\na\n\nweight 1 2 double\n7 8\n"),
                Fate::Read(weights)
            ),
            row!(
                "what is not understood",
                "a.vtk",
                legacy("POLYDATA", "SCALARS t float\n7 8\nFIELD f 1\nweight 1 2 double\n7 8\n"),
                Fate::PassedOver(&[
                    "what follows is passed over",
                    "no LOOKUP_TABLE line below SCALARS t"
                ])
            ),
            row!(
                "a dataset of another kind",
                "a.vtk",
                "# vtk DataFile Version 3.0\nt\nASCII\nDATASET RECTILINEAR_GRID\n",
                Fate::Refused(&["RECTILINEAR_GRID"])
            ),
            row!(
                "other fields",
                "a.vtk",
                legacy("UNSTRUCTURED_GRID", "VECTORS v float\n0 0 1 0 0 1\n"),
                Fate::Read(without_a_word)
            ),
        ],
    );
}

/// Texts in binary, short and long: each behind its length.
#[test]
fn arrays_behind_texts_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let long = "n".repeat(300);
    let texts = [&b"\xc1a\x81\x2c"[..], long.as_bytes(), b"\n"].concat();
    let numbers = |numbers: &[f64]| {
        numbers.iter().flat_map(|number| number.to_be_bytes()).collect::<Vec<u8>>()
    };
    let file = [
        b"# vtk DataFile Version 5.1\nt\nBINARY\nDATASET POLYDATA\nPOINTS 2 double\n",
        &numbers(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])[..],
        b"\nPOINT_DATA 2\nFIELD f 2\nname 1 2 string\n",
        &texts,
        b"METADATA\nINFORMATION 0\n\nweight 1 2 double\n",
        &numbers(&[7.0, 8.0]),
        b"\n",
    ]
    .concat();
    let path = crate::formats::files::save(folder.path(), "a.vtk", &file);
    weights(&path);
    assert_eq!(warnings(&path), "null");
}

/// Texts in addition to samples are not samples.
#[test]
fn texts_are_passed_by_in_a_volume() {
    use crate::formats::files::{VTK, open, save};
    let folder = tempfile::tempdir().unwrap();
    let texts = format!("FIELD f 1\nname 1 12 string\n{}SCALARS", "a b\n\n".repeat(6));
    let file = VTK.replace("SCALARS", &texts) + "0 1 2 3 4 5 6 7 8 9 10 11\n";
    let volume = open(&save(folder.path(), "v.vtk", file)).unwrap();
    assert_eq!(volume.as_slice()[..3], [0.0, 1.0, 2.0]);
}
