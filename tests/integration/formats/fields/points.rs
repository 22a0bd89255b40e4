//! The shared parts of the tables of points: files of the points (1, 2, 3) and (4, 5, 6).

use std::path::Path;

use walpha::points::{PointOptions, Points, read_model, read_points};

use crate::common::json;

/// A field by its name, the name and the bytes of a file that states it, and its fate.
macro_rules! row {
    ($field:expr, $file:expr, $bytes:expr, $fate:expr) => {
        $crate::formats::fields::Field {
            name: $field,
            file: |folder| $crate::formats::files::save(folder, $file, $bytes),
            fate: $fate,
        }
    };
}
pub(super) use row;

pub const PLACES: [[f64; 3]; 2] = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];

pub fn points(path: &Path) -> Points {
    read_points(path, None).unwrap_or_else(|error| panic!("{error}"))
}

/// The points alone.
pub fn places(path: &Path) {
    let points = points(path);
    assert_eq!(points.positions, PLACES, "{}", path.display());
    assert_eq!((points.weights, points.values), (None, None), "{}", path.display());
}

/// Like [`places`]; also asserts that there are no warnings.
pub fn without_a_word(path: &Path) {
    places(path);
    let told = json(path.parent().unwrap(), &["info", path.to_str().unwrap()]);
    assert!(told.get("warnings").is_none_or(|told| told.as_array().unwrap().is_empty()), "{told}");
}

/// The warnings about a file.
pub fn warnings(path: &Path) -> String {
    json(path.parent().unwrap(), &["info", path.to_str().unwrap()])["warnings"].to_string()
}

/// The points with values 7 and 8.
pub fn values(path: &Path) {
    let points = points(path);
    assert_eq!(points.positions, PLACES);
    assert_eq!((points.weights, points.values), (None, Some(vec![7.0, 8.0])));
}

/// The points with weights 7 and 8.
pub fn weights(path: &Path) {
    let points = points(path);
    assert_eq!(points.positions, PLACES);
    assert_eq!((points.weights, points.values), (Some(vec![7.0, 8.0]), None));
}

/// The points with radii 2 and 3.
pub fn radii(path: &Path) {
    let points = points(path);
    assert_eq!((points.weights, points.of_radii), (Some(vec![4.0, 9.0]), true));
}

/// The points are the second of three frames.
pub fn second_frame(path: &Path) {
    let options = PointOptions::default().frame(Some(1));
    assert_eq!(read_model(path, &options).unwrap().0.positions, PLACES);
    let words = read_model(path, &PointOptions::default()).unwrap_err().to_string();
    assert!(words.contains("holds 3 frames"), "{words}");
}
