//! What the points of a laser scan look like: the colours of their classes, and their own.

use super::attributes::{Column, ScanSummary, is_same};

/// The columns of LAS that hold classes.
pub const CLASS_COLUMN: &str = "classification";
/// The columns of LAS that hold colours.
pub const COLOUR_COLUMNS: [&str; 3] = ["red", "green", "blue"];

/// The colours of the ASPRS classes 0 to 18 as red, green and blue, as QGIS has them.
const CLASS_COLOURS: [[u8; 3]; 19] = [
    [170, 170, 170],
    [170, 170, 170],
    [170, 85, 0],
    [0, 170, 170],
    [85, 255, 85],
    [0, 128, 0],
    [255, 85, 85],
    [170, 0, 0],
    [85, 85, 85],
    [85, 170, 255],
    [170, 0, 170],
    [60, 60, 60],
    [85, 85, 85],
    [255, 255, 85],
    [255, 255, 85],
    [85, 85, 255],
    [255, 85, 255],
    [85, 85, 85],
    [170, 0, 0],
];

impl ScanSummary {
    /// The colour of an ASPRS class as red, green and blue; gray for those that the standard does not name.
    pub fn class_colour(class: u8) -> [u8; 3] {
        CLASS_COLOURS.get(usize::from(class)).copied().unwrap_or(CLASS_COLOURS[0])
    }
}

/// A column by its name.
fn column<'a>(columns: &'a [Column], name: &str) -> Option<&'a [f64]> {
    columns.iter().find(|column| is_same(&column.name, name)).map(|column| &column.values[..])
}

/// The ASPRS classes of points with these columns: those in [`CLASS_COLUMN`], or in a column `class`.
pub fn scan_classes(columns: &[Column]) -> Option<Vec<u8>> {
    Some(column(columns, CLASS_COLUMN)?.iter().map(|&class| class as u8).collect())
}

/// Whether some of these are classes: 0 and 1 stand for points without one.
pub fn has_classes(classes: &[u8]) -> bool {
    classes.iter().any(|&class| class > 1)
}

/// The colours of points with these columns, of [`COLOUR_COLUMNS`], as red, green and blue.
pub fn scan_colours(columns: &[Column]) -> Option<Vec<[u8; 3]>> {
    let [red, green, blue] = COLOUR_COLUMNS.map(|name| column(columns, name));
    let (red, green, blue) = (red?, green?, blue?);
    let all = || [red, green, blue].into_iter().flatten();
    // LAS has 16 bits, of which some writers use the lower 8 alone. Others write fractions of 1: whole numbers up to 1 may be either.
    let most = all().fold(0.0, |a: f64, &b| a.max(b));
    let are_fractions = all().all(|number| (0.0..=1.0).contains(number))
        && all().any(|number| number.fract() != 0.0);
    let byte = |number: f64| {
        if are_fractions {
            (number * 255.0).round() as u8
        } else if most > 255.0 {
            (number / 256.0) as u8
        } else {
            number as u8
        }
    };
    let rows = red.iter().zip(green).zip(blue);
    Some(rows.map(|((&r, &g), &b)| [byte(r), byte(g), byte(b)]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(all: &[(&str, [f64; 2])]) -> Vec<Column> {
        all.iter()
            .map(|(name, values)| Column { name: (*name).into(), values: values.to_vec() })
            .collect()
    }

    #[test]
    fn classes_and_colours_are_those_of_columns() {
        let all = columns(&[("Classification", [2.0, 200.0]), ("red", [65280.0, 256.0])]);
        assert_eq!(scan_classes(&all), Some(vec![2, 200]));
        assert_eq!(scan_colours(&all), None);
        assert_eq!([2, 200].map(ScanSummary::class_colour), [[170, 85, 0], [170; 3]]);
        let wide = columns(&[("red", [65280.0, 256.0]), ("green", [0.0; 2]), ("blue", [512.0; 2])]);
        assert_eq!(scan_colours(&wide), Some(vec![[255, 0, 2], [1, 0, 2]]));
        let narrow = columns(&[("red", [255.0, 1.0]), ("green", [0.0; 2]), ("blue", [7.0; 2])]);
        assert_eq!(scan_colours(&narrow), Some(vec![[255, 0, 7], [1, 0, 7]]));
        let of_one = columns(&[("red", [1.0, 0.5]), ("green", [0.0; 2]), ("blue", [1.0, 0.2])]);
        assert_eq!(scan_colours(&of_one), Some(vec![[255, 0, 255], [128, 0, 51]]));
        let dark = columns(&[("red", [1.0, 0.0]), ("green", [0.0; 2]), ("blue", [0.0, 1.0])]);
        assert_eq!(scan_colours(&dark), Some(vec![[1, 0, 0], [0, 0, 1]]));
        let mixed = columns(&[("red", [1.5, 0.0]), ("green", [0.5; 2]), ("blue", [0.0, 1.0])]);
        assert_eq!(scan_colours(&mixed), Some(vec![[1, 0, 0], [0, 0, 1]]));
        assert_eq!(scan_classes(&columns(&[("class", [3.0, 1.0])])), Some(vec![3, 1]));
        assert_eq!(
            (scan_classes(&narrow), has_classes(&[0, 1]), has_classes(&[0, 2])),
            (None, false, true)
        );
    }
}
