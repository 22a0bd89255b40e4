//! JSON and NPZ with the names that others use.

use walpha_check::Advise;
use walpha_check::schema::{AnyFile, ComplexFile, SchemaError};
use zip::CompressionMethod;

use super::folder;
use crate::archive::{archive, npy};

const POINTS: &str = "[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]";

fn open(name: &str, bytes: &[u8]) -> Result<ComplexFile, SchemaError> {
    let folder = folder();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    match AnyFile::open(path)? {
        AnyFile::Complex(file) => Ok(file),
        AnyFile::Filtration(_) => panic!("{name} is not a filtration"),
    }
}

#[test]
fn names_of_others_are_known() {
    for (points, cells) in [
        ("points", "simplices"),
        ("points", "tetra"),
        ("p", "t"),
        ("vertices", "tetra"),
        ("points", "cells"),
    ] {
        let json = format!(r#"{{"{points}":{POINTS},"{cells}":[[0,1,2,3]]}}"#);
        let file = open("a.json", json.as_bytes()).unwrap();
        assert_eq!((file.points.len(), file.cells.as_deref()), (4, Some(&[[0, 1, 2, 3]][..])));
        assert!(file.states_no_alpha());

        let doubles: Vec<u8> =
            file.points.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        let rows: Vec<u8> = [0i32, 1, 2, 3].iter().flat_map(|x| x.to_le_bytes()).collect();
        let arrays =
            [(points, npy("<f8", "(4, 3)", &doubles)), (cells, npy("<i4", "(1, 4)", &rows))];
        let npz = archive(&arrays, CompressionMethod::Stored);
        assert_eq!(open("a.npz", &npz).unwrap(), file, "{points} {cells}");
    }
}

/// Other data of `SciPy`, weights, and α if it is stated.
#[test]
fn what_else_is_there_is_passed_over() {
    let json = format!(
        r#"{{"points":{POINTS},"simplices":[[0,1,2,3]],"neighbors":[[-1,-1,-1,-1]],"name":"x",
            "weights":[1,2,3,4],"alpha":9}}"#
    );
    let file = open("a.json", json.as_bytes()).unwrap();
    assert_eq!((file.weights, file.alpha.squared()), (Some(vec![1.0, 2.0, 3.0, 4.0]), 9.0));
}

#[test]
fn errors_name_the_array() {
    for (json, words) in [
        (
            format!(r#"{{"points":{POINTS},"simplices":[[0,1,2]]}}"#),
            "`simplices`: invalid length 3",
        ),
        (r#"{"points":[[0,0]],"t":[[0,1,2,3]]}"#.into(), "`points`: invalid length 2"),
        (r#"{"simplices":[[0,1,2,3]]}"#.into(), "unknown field `simplices`"),
        // A slip in the name of α does not make it infinite.
        (format!(r#"{{"points":{POINTS},"cells":[[0,1,2,3]],"alfa":1}}"#), "unknown field `alfa`"),
        (format!(r#"{{"points":{POINTS},"edges":[[0,1]]}}"#), "missing field `alpha`"),
    ] {
        let error = open("a.json", json.as_bytes()).unwrap_err().to_string();
        assert!(error.contains(words), "{json}: {error}");
    }
    let rows = npy("<i4", "(1, 3)", &[0; 12]);
    let places = npy("<f8", "(1, 3)", &[0; 24]);
    let npz = archive(
        &[("points", places.clone()), ("simplices", rows.clone())],
        CompressionMethod::Stored,
    );
    let error = open("a.npz", &npz).unwrap_err().to_string();
    assert_eq!(error, "array `simplices` has shape [1, 3], expected shape [m, 4]");
    let npz = archive(
        &[("points", places), ("cells", npy("<i4", "(1, 4)", &[0; 16])), ("alfa", rows)],
        CompressionMethod::Stored,
    );
    let error = open("a.npz", &npz).unwrap_err();
    assert!(error.to_string().contains("no array `alpha`"), "{error}");
    assert!(error.advice().is_some());
}
