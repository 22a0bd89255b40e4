//! LAS, byte by byte: version 1.2, of records of format 0.

use walpha::points::{PointOptions, read_model};

use super::points::*;
use super::{Fate, walk};
use crate::common::{json, names, ok};

/// Bytes of the header, and of a record.
const HEADER: u16 = 227;
const RECORD: u16 = 20;

/// Points (1, 2, 3) and (4, 5, 6) with intensities 7 and 8; the bytes of flags and classes; and changes by their place.
fn las(classes: [u8; 2], changes: &[(usize, &[u8])], behind: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0; usize::from(HEADER)];
    bytes[..4].copy_from_slice(b"LASF");
    bytes[24..26].copy_from_slice(&[1, 2]);
    bytes[94..96].copy_from_slice(&HEADER.to_le_bytes());
    bytes[96..98].copy_from_slice(&HEADER.to_le_bytes());
    bytes[105..107].copy_from_slice(&RECORD.to_le_bytes());
    bytes[107] = 2;
    for axis in 0..3 {
        bytes[131 + 8 * axis..][..8].copy_from_slice(&0.5f64.to_le_bytes());
    }
    for ([x, y, z], (intensity, class)) in
        [[1, 2, 3], [4, 5, 6]].into_iter().zip([7u16, 8].into_iter().zip(classes))
    {
        [x, y, z].iter().for_each(|c: &i32| bytes.extend((2 * c).to_le_bytes()));
        bytes.extend(intensity.to_le_bytes());
        bytes.extend([0x09, class, 0, 0, 0, 0]);
    }
    for (place, change) in changes {
        bytes[*place..][..change.len()].copy_from_slice(change);
    }
    [&bytes[..], behind].concat()
}

/// A file of version 1.4, with the numbers of points that its two fields state.
fn las_of_1_4(old: u32, large: u64) -> Vec<u8> {
    /// Bytes of the header, and where the number of 64 bits is.
    const HEADER_OF_1_4: u16 = 375;
    const LARGE: usize = 247;
    let size = HEADER_OF_1_4.to_le_bytes();
    let [old, large] = [old.to_le_bytes().to_vec(), large.to_le_bytes().to_vec()];
    let short = las([2, 6], &[(25, &[4]), (94, &size), (96, &size), (107, &old)], b"");
    let (head, records) = short.split_at(HEADER.into());
    let mut head = head.to_vec();
    head.resize(HEADER_OF_1_4.into(), 0);
    head[LARGE..][..8].copy_from_slice(&large);
    [&head, records].concat()
}

/// A file with a record that says what its coordinates are.
fn las_with_system(number: u16, content: &[u8]) -> Vec<u8> {
    let mut record = vec![0; 54];
    record[2..17].copy_from_slice(b"LASF_Projection");
    record[18..20].copy_from_slice(&number.to_le_bytes());
    record[20..22].copy_from_slice(&(content.len() as u16).to_le_bytes());
    let offset = u32::from(HEADER) + (record.len() + content.len()) as u32;
    let whole = las([2, 6], &[(96, &offset.to_le_bytes()), (100, &[1])], b"");
    let (head, records) = whole.split_at(HEADER.into());
    [head, &record, content, records].concat()
}

/// A file with a weight and a value for each point in extra bytes, as doubles.
fn las_with_weights() -> Vec<u8> {
    const DOUBLE: u8 = 10;
    let mut record = vec![0; 54];
    record[2..11].copy_from_slice(b"LASF_Spec");
    record[18] = 4;
    for name in ["weight", "value"] {
        let mut described = vec![0; 192];
        described[2] = DOUBLE;
        described[4..4 + name.len()].copy_from_slice(name.as_bytes());
        record.extend(described);
    }
    record[20..22].copy_from_slice(&384u16.to_le_bytes());
    let offset = u32::from(HEADER) + record.len() as u32;
    let length = RECORD + 16;
    let changes: [(usize, &[u8]); 3] =
        [(96, &offset.to_le_bytes()), (100, &[1]), (105, &length.to_le_bytes())];
    let whole = las([2, 6], &changes, b"");
    let (head, records) = whole.split_at(HEADER.into());
    let numbers = [[0.5f64, 7.5], [1.5, 8.5]].map(|pair| pair.map(f64::to_le_bytes).concat());
    let records = records.chunks(RECORD.into()).zip(numbers);
    let records = records.flat_map(|(record, numbers)| [record, &numbers].concat());
    [head, &record].concat().into_iter().chain(records).collect()
}

const WITHHELD: u8 = 0x80;

#[test]
#[expect(clippy::too_many_lines, reason = "a row for each field")]
fn each_field_of_the_table() {
    walk(
        "LAS, LAZ",
        &[
            row!(
                "scales, offsets",
                "a.las",
                las([2, 6], &[], b""),
                Fate::Read(|path| assert_eq!(points(path).positions, PLACES))
            ),
            row!(
                "a scale of 0, or NaN",
                "a.las",
                las([2, 6], &[(139, &f64::NAN.to_le_bytes())], b""),
                Fate::Refused(&["scale NaN", "for y", "correct its header"])
            ),
            row!("intensity", "a.las", las([2, 6], &[], b""), Fate::Read(values)),
            row!(
                "class",
                "a.las",
                las([2, 6], &[], b""),
                Fate::Read(|path| {
                    let options = PointOptions::default().classes(Some(vec![6]));
                    assert_eq!(read_model(path, &options).unwrap().0.positions, [PLACES[1]]);
                })
            ),
            row!(
                "flag *withheld*",
                "a.las",
                las([2, 2 | WITHHELD], &[], b""),
                Fate::PassedOver(&["1 points are flagged as withheld"])
            ),
            row!(
                "all *withheld*",
                "a.las",
                las([WITHHELD; 2], &[], b""),
                Fate::Refused(&["all of them withheld", "give --withheld"])
            ),
            row!(
                "flags *synthetic*, *key-point*, *overlap*",
                "a.las",
                las([0x20, 0x40], &[], b""),
                Fate::Read(|path| {
                    values(path);
                    let told = json(path.parent().unwrap(), &["info", "a.las"]);
                    assert_eq!(told["notes"], serde_json::json!(["1 synthetic", "1 key points"]));
                })
            ),
            row!(
                "classes 7, 12 and 18",
                "a.las",
                las([7, 18], &[], b""),
                Fate::Read(|path| {
                    let told = json(path.parent().unwrap(), &["info", "a.las"]);
                    assert_eq!(
                        told["notes"],
                        serde_json::json!(["1 noise (class 7)", "1 high noise (class 18)"])
                    );
                })
            ),
            row!(
                "a number of points that is too high",
                "a.las",
                las([2, 6], &[(107, &[3])], b""),
                Fate::Refused(&["claims 3 points, but has 2", "copy it again"])
            ),
            row!(
                "a number of points that is too low",
                "a.las",
                las([2, 6], &[(107, &[1])], b""),
                Fate::PassedOver(&["counts 1 points in its header, but has 2"])
            ),
            row!(
                "no number of points",
                "a.las",
                las([2, 6], &[(107, &[0])], b""),
                Fate::Refused(&["counts 0 points in its header, but has 2", "right count"])
            ),
            row!(
                "a number of points in 64 bits",
                "a.las",
                las_of_1_4(0, 2),
                Fate::Read(|path| {
                    values(path);
                    let told = json(path.parent().unwrap(), &["info", "a.las"]);
                    assert!(told["warnings"].as_array().is_none_or(Vec::is_empty), "{told}");
                })
            ),
            row!(
                "an old number of points that differs from it",
                "a.las",
                las_of_1_4(1, 2),
                Fate::PassedOver(&[
                    "counts 1 points for programs",
                    "2 in its own field: 2 are read"
                ])
            ),
            row!(
                "longer records",
                "a.las",
                {
                    let short = las([2, 6], &[(105, &[24])], b"");
                    let (head, records) = short.split_at(HEADER.into());
                    let longer =
                        records.chunks(RECORD.into()).flat_map(|record| [record, &[9; 4]].concat());
                    head.iter().copied().chain(longer).collect::<Vec<u8>>()
                },
                Fate::Read(values)
            ),
            row!(
                "longitude and latitude as reference system",
                "a.las",
                {
                    // A record of keys: model type (1024) is 2, geographic.
                    let keys = [1u16, 1, 0, 1, 1024, 0, 1, 2].map(u16::to_le_bytes);
                    las_with_system(34735, keys.as_flattened())
                },
                Fate::Refused(&["longitude and latitude", "UTM"])
            ),
            row!(
                "units of heights that differ",
                "a.las",
                las_with_system(
                    2112,
                    br#"COMPD_CS["c",PROJCS["p",UNIT["metre",1]],VERT_CS["v",UNIT["foot",0.3048]]]"#
                ),
                Fate::Refused(&["metre of x and y and foot of z", "in one unit"])
            ),
            row!(
                "columns `weight` and `value` of extra bytes",
                "a.las",
                las_with_weights(),
                Fate::Read(|path| {
                    let read = points(path);
                    assert_eq!(read.weights, Some(vec![0.5, 1.5]));
                    assert_eq!(read.values, Some(vec![7.5, 8.5]));
                })
            ),
            row!(
                "other fields",
                "a.las",
                las([2, 6], &[(26, b"system"), (58, b"software")], b""),
                Fate::Read(|path| {
                    values(path);
                    let told = json(path.parent().unwrap(), &["info", "a.las"]);
                    assert!(told["warnings"].as_array().is_none_or(Vec::is_empty), "{told}");
                })
            ),
        ],
    );
}

/// In version 1.4 the 64-bit number counts, whichever is larger, unless it is left out.
#[test]
fn numbers_of_points_that_differ() {
    let folder = tempfile::tempdir().unwrap();
    for (old, large, read) in [(0, 2, 2), (1, 2, 2), (9, 2, 2), (2, 1, 1), (2, 0, 2)] {
        let path = crate::formats::files::save(folder.path(), "a.las", las_of_1_4(old, large));
        assert_eq!(points(&path).positions, PLACES[..read], "{old} {large}");
    }
}

#[test]
fn withheld_points_are_taken_where_that_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let path = crate::formats::files::save(f, "a.las", las([2, 2 | WITHHELD], &[], b""));
    assert_eq!(points(&path).positions, [PLACES[0]]);
    let options = PointOptions::default().withheld(true);
    assert_eq!(read_model(&path, &options).unwrap().0.positions, PLACES);
    assert_eq!(json(f, &["info", "a.las", "--withheld"])["count"], 2);
    names(&ok(f, &["info", "a.las"]), &["points    1, without 1 withheld ones, which classes"]);
    names(&ok(f, &["info", "a.las", "--withheld"]), &["points    2\n"]);
    crate::formats::files::save(f, "b.xyz", "1 2 3\n");
    crate::common::fails(f, 1, "info b.xyz --withheld", &["no points that can be withheld"]);
}
