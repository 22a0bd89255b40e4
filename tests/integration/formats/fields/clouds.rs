//! PCD, and NPY of points.

use super::points::*;
use super::{Fate, walk};

/// A PCD with these lines of its header in place of the usual ones of the same key.
fn pcd(lines: &[&str], data: &[u8]) -> Vec<u8> {
    let usual = [
        "# .PCD v.7",
        "VERSION .7",
        "FIELDS x y z",
        "SIZE 4 4 4",
        "TYPE F F F",
        "COUNT 1 1 1",
        "WIDTH 2",
        "HEIGHT 1",
        "VIEWPOINT 0 0 0 1 0 0 0",
        "POINTS 2",
        "DATA ascii",
    ];
    let key = |line: &str| line.split(' ').next().unwrap_or_default().to_owned();
    let mut head = usual;
    for line in &mut head {
        *line = lines.iter().find(|own| key(own) == key(line)).unwrap_or(line);
    }
    let head: Vec<&str> = head.into_iter().filter(|line| line.contains(' ')).collect();
    [head.join("\n").as_bytes(), b"\n", data].concat()
}

const ROWS: &[u8] = b"1 2 3\n4 5 6\n";

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

#[test]
#[expect(clippy::too_many_lines, reason = "a row for each field")]
fn each_field_of_pcd() {
    const FIVE: [&str; 4] =
        ["FIELDS x y z intensity _", "SIZE 4 4 4 4 1", "TYPE F F F F U", "COUNT 1 1 1 1 4"];
    walk(
        "PCD",
        &[
            row!(
                "`FIELDS`",
                "a.pcd",
                pcd(&["FIELDS z y x"], b"3 2 1\n6 5 4\n"),
                Fate::Read(without_a_word)
            ),
            row!(
                "`FIELDS` without x, y or z",
                "a.pcd",
                pcd(&["FIELDS x y q"], ROWS),
                Fate::Refused(&["without x, y or z"])
            ),
            row!(
                "x, y or z twice",
                "a.pcd",
                pcd(
                    &["FIELDS x y z x", "SIZE 4 4 4 4", "TYPE F F F F", "COUNT 1 1 1 1"],
                    b"1 2 3 1\n4 5 6 4\n"
                ),
                Fate::Refused(&["two fields for x"])
            ),
            row!(
                "`intensity`, padding",
                "a.pcd",
                pcd(&FIVE, b"1 2 3 7 0 0 0 0\n4 5 6 8 0 0 0 0\n"),
                Fate::Read(values)
            ),
            row!(
                "`weight`",
                "a.pcd",
                pcd(
                    &["FIELDS x y z weight", "SIZE 4 4 4 4", "TYPE F F F F", "COUNT 1 1 1 1"],
                    b"1 2 3 7\n4 5 6 8\n"
                ),
                Fate::Read(weights)
            ),
            row!(
                "`radius`",
                "a.pcd",
                pcd(
                    &["FIELDS x y z radius", "SIZE 4 4 4 4", "TYPE F F F F", "COUNT 1 1 1 1"],
                    b"1 2 3 2\n4 5 6 3\n"
                ),
                Fate::Read(radii)
            ),
            row!(
                "`SIZE`, `TYPE`",
                "a.pcd",
                pcd(
                    &["SIZE 1 2 8", "TYPE U I F", "DATA binary"],
                    &[&[1, 2, 0][..], &3f64.to_le_bytes(), &[4, 5, 0], &6f64.to_le_bytes()]
                        .concat()
                ),
                Fate::Read(without_a_word)
            ),
            row!(
                "an unknown type",
                "a.pcd",
                pcd(&["SIZE 3 4 4", "DATA binary"], &[0; 22]),
                Fate::Refused(&["type F and 3 bytes"])
            ),
            row!(
                "integers that no double holds",
                "a.pcd",
                pcd(
                    &["SIZE 8 8 8", "TYPE U I U", "WIDTH 1", "POINTS 1", "DATA binary"],
                    [5u64, (-(1i64 << 53) - 1).cast_unsigned(), 1 << 60]
                        .map(u64::to_le_bytes)
                        .as_flattened()
                ),
                Fate::Refused(&["the integer -9007199254740993", "subtract an offset"])
            ),
            row!(
                "`COUNT` of x, y or z",
                "a.pcd",
                pcd(&["COUNT 2 1 1"], b"1 1 2 3\n4 4 5 6\n"),
                Fate::Refused(&["COUNT 2 for the field x"])
            ),
            row!(
                "`COUNT` 0 of others",
                "a.pcd",
                pcd(&["FIELDS q x y z", "SIZE 4 4 4 4", "TYPE F F F F", "COUNT 0 1 1 1"], ROWS),
                Fate::Read(without_a_word)
            ),
            row!(
                "`WIDTH`, `HEIGHT` without `POINTS`",
                "a.pcd",
                pcd(&["POINTS", "WIDTH 1", "HEIGHT 2"], ROWS),
                Fate::Read(without_a_word)
            ),
            row!(
                "`POINTS` that differ from them",
                "a.pcd",
                pcd(&["WIDTH 3"], ROWS),
                Fate::Refused(&["2 POINTS, but 3 by WIDTH"])
            ),
            row!(
                "`POINTS` that are too many",
                "a.pcd",
                pcd(&["WIDTH 3", "POINTS 3"], ROWS),
                Fate::Refused(&["claims 3 points, but has 2", "copy it again"])
            ),
            row!(
                "`POINTS` that are too few",
                "a.pcd",
                pcd(&["WIDTH 1", "POINTS 1"], ROWS),
                Fate::Refused(&["claims 1 points, but has 2", "correct its header"])
            ),
            row!(
                "`VIEWPOINT`",
                "a.pcd",
                pcd(&["VIEWPOINT 9 0 0 1 0 0 0"], ROWS),
                Fate::PassedOver(&["VIEWPOINT 9 0 0", "as stored"])
            ),
            row!(
                "`DATA`",
                "a.pcd",
                pcd(&["DATA binary"], &floats(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])),
                Fate::Read(without_a_word)
            ),
            row!(
                "white space between words",
                "a.pcd",
                String::from_utf8(pcd(&[], ROWS)).unwrap().replace(' ', "\t "),
                Fate::Read(without_a_word)
            ),
            row!(
                "`DATA` of another kind",
                "a.pcd",
                pcd(&["DATA csv"], ROWS),
                Fate::Refused(&["DATA csv"])
            ),
            row!(
                "points without a place",
                "a.pcd",
                pcd(&[], b"1 2 3\nnan nan nan\n"),
                Fate::PassedOver(&["1 of 2 points have no position"])
            ),
            row!(
                "no point with a place",
                "a.pcd",
                pcd(&[], b"nan 2 3\nnan nan nan\n"),
                Fate::Refused(&["none of which has a position"])
            ),
            row!(
                "ends of lines",
                "a.pcd",
                String::from_utf8(pcd(&[], ROWS)).unwrap().replace('\n', "\r\n"),
                Fate::Read(without_a_word)
            ),
            row!(
                "other fields",
                "a.pcd",
                pcd(
                    &["FIELDS x y z rgb", "SIZE 4 4 4 4", "TYPE F F F F", "COUNT 1 1 1 1"],
                    b"1 2 3 1e-38\n4 5 6 0\n"
                ),
                Fate::Read(without_a_word)
            ),
        ],
    );
}

/// An array with this description and shape.
fn npy(descr: &str, order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}\n");
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), data].concat()
}

#[test]
#[expect(clippy::too_many_lines, reason = "a row for each field")]
fn each_field_of_npy() {
    const F4: &str = "'<f4'";
    walk(
        "NPY of points",
        &[
            row!(
                "an array n×3",
                "a.npy",
                npy(F4, "False", "(2, 3)", &floats(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])),
                Fate::Read(without_a_word)
            ),
            row!(
                "a fourth column",
                "a.npy",
                npy(F4, "False", "(2, 4)", &floats(&[1.0, 2.0, 3.0, 7.0, 4.0, 5.0, 6.0, 8.0])),
                Fate::Read(values)
            ),
            row!(
                "a fifth column",
                "a.npy",
                npy(F4, "False", "(1, 5)", &floats(&[0.0; 5])),
                Fate::Refused(&["5 columns", "--columns x,y,z,weight,value"])
            ),
            row!(
                "Fortran order",
                "a.npy",
                npy(F4, "True", "(2, 3)", &floats(&[1.0, 4.0, 2.0, 5.0, 3.0, 6.0])),
                Fate::Read(without_a_word)
            ),
            row!(
                "types, byte order",
                "a.npy",
                npy("'>i2'", "False", "(2, 3)", &[0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6]),
                Fate::Read(without_a_word)
            ),
            row!(
                "integers beyond those that doubles hold",
                "a.npy",
                npy(
                    "'<i8'",
                    "False",
                    "(2, 3)",
                    [1i64, 2, 3, 4, -((1 << 53) + 1), 6].map(i64::to_le_bytes).as_flattened()
                ),
                Fate::Refused(&[
                    "row 1: a double may not hold an integer near -9007199254740992",
                    "a.astype('f8')"
                ])
            ),
            row!(
                "types that are not numbers",
                "a.npy",
                npy("'<c8'", "False", "(1, 3)", &[0; 24]),
                Fate::Refused(&["<c8"])
            ),
            row!(
                "fields x, y, z",
                "a.npy",
                npy(
                    "[('z', '<f4'), ('y', '|u1'), ('x', '<f4')]",
                    "False",
                    "(2,)",
                    &[floats(&[3.0]), vec![2], floats(&[1.0, 6.0]), vec![5], floats(&[4.0])]
                        .concat()
                ),
                Fate::Read(without_a_word)
            ),
            row!(
                "a field of three numbers",
                "a.npy",
                npy(
                    "[('', '|V1'), ('xyz', '<f4', (3,)), ('n', '<f4', (2,))]",
                    "False",
                    "(2,)",
                    &[
                        vec![9],
                        floats(&[1.0, 2.0, 3.0, 9.0, 9.0]),
                        vec![9],
                        floats(&[4.0, 5.0, 6.0, 9.0, 9.0])
                    ]
                    .concat()
                ),
                Fate::Read(without_a_word)
            ),
            row!(
                "a field `weight`",
                "a.npy",
                npy(
                    "[('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('weight', '<f4')]",
                    "False",
                    "(2,)",
                    &floats(&[1.0, 2.0, 3.0, 7.0, 4.0, 5.0, 6.0, 8.0])
                ),
                Fate::Read(weights)
            ),
            row!(
                "a field `value`, or else `intensity`",
                "a.npy",
                npy(
                    "[('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('intensity', '<f4')]",
                    "False",
                    "(2,)",
                    &floats(&[1.0, 2.0, 3.0, 7.0, 4.0, 5.0, 6.0, 8.0])
                ),
                Fate::Read(values)
            ),
            row!(
                "fields without x, y or z",
                "a.npy",
                npy("[('a', '<f4'), ('b', '<f4')]", "False", "(1,)", &[0; 8]),
                Fate::Refused(&["do not name x"])
            ),
            row!(
                "NaN",
                "a.npy",
                npy(F4, "False", "(1, 3)", &floats(&[1.0, f32::NAN, 3.0])),
                Fate::Refused(&["row 0: y is NaN"])
            ),
            row!(
                "a shape that the file does not hold",
                "a.npy",
                npy("[('x', '<f4'), ('y', '<f4'), ('z', '<f4')]", "False", "(3,)", &[0; 24]),
                Fate::Refused(&["36 bytes", "24"])
            ),
        ],
    );
}

/// Columns that are named, and the fields that walpha writes.
#[test]
fn columns_of_arrays_may_be_named() {
    use walpha::points::{PointWriter, read_points};
    use walpha::shape::WeightedPoints;

    let folder = tempfile::tempdir().unwrap();
    let rows = [1.0, 2.0, 3.0, 7.0, 0.5, 4.0, 5.0, 6.0, 8.0, 0.25];
    let plain = crate::formats::files::save(
        folder.path(),
        "plain.npy",
        npy("'<f4'", "False", "(2, 5)", &floats(&rows)),
    );
    let columns = "x,y,z,weight,value".parse().unwrap();
    let points = read_points(plain, Some(&columns)).unwrap();
    let expected = (Some(vec![7.0, 8.0]), Some(vec![0.5, 0.25]));
    assert_eq!((points.weights, points.values), expected.clone());
    let weighted = WeightedPoints::new(PLACES.to_vec(), vec![7.0, 8.0]).unwrap();
    let weighted = weighted.with_values(Some(vec![0.5, 0.25])).unwrap();
    let mut bytes = Vec::new();
    PointWriter::of("fields.npy").unwrap().write(&weighted, &mut bytes).unwrap();
    assert_eq!((bytes.len() - 2 * 5 * 8) % 64, 0);
    let fields = crate::formats::files::save(folder.path(), "fields.npy", bytes);
    let points = read_points(fields, None).unwrap();
    assert_eq!(points.positions, PLACES);
    assert_eq!((points.weights, points.values), expected);
}
