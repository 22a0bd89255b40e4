//! Notes in exported files: α and coordinates, in the form that other programs look for.

use walpha_base::shown::{number, six_digits};

use crate::{Coordinates, LengthUnit};
use walpha_complex::Alpha;

/// The text about α for a comment: as a squared length, and also as a radius if it has one.
pub fn alpha(alpha: Alpha) -> String {
    let squared = number(alpha.squared());
    match alpha.radius().map(six_digits).map(number) {
        Some(radius) => format!("α = {squared} (squared length; √α = {radius})"),
        None => format!("α = {squared} (squared length; negative, so no radius)"),
    }
}

/// The text about coordinates to append to a comment: ` SPACE=LPS UNIT=mm`, as 3D Slicer looks for it. It is `UNIT` alone if the
/// space is not known, and empty if nothing is known.
pub fn comment(coordinates: Coordinates) -> String {
    pairs(coordinates).into_iter().map(|(name, value)| format!(" {name}={value}")).collect()
}

/// A line with [`comment`] after `sign`, the word or sign that begins a comment; empty if nothing is known.
pub fn line(sign: &str, coordinates: Coordinates) -> String {
    match comment(coordinates) {
        comment if comment.is_empty() => comment,
        comment => format!("{sign}{comment}\n"),
    }
}

/// The coordinates as VTK's field data in XML: arrays of one string each, given by the codes of its characters.
pub fn field_data(coordinates: Coordinates) -> String {
    let pairs = pairs(coordinates);
    if pairs.is_empty() {
        return String::new();
    }
    let array = |(name, value): &(&str, &str)| {
        let bytes: Vec<String> = value.bytes().map(|byte| byte.to_string()).collect();
        format!(
            "<Array type=\"String\" Name=\"{name}\" NumberOfTuples=\"1\" format=\"ascii\">{} \
                 0</Array>\n",
            bytes.join(" ")
        )
    };
    format!("<FieldData>\n{}</FieldData>\n", pairs.iter().map(array).collect::<String>())
}

/// The names and texts of the properties that are known.
pub fn pairs(Coordinates { space, unit }: Coordinates) -> Vec<(&'static str, &'static str)> {
    let space = space.is_known().then(|| ("SPACE", space.name()));
    let unit = (unit != LengthUnit::Unstated).then(|| ("UNIT", unit.ascii()));
    space.into_iter().chain(unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alpha_is_a_squared_length() {
        let texts = [10.0, -1e300, f64::INFINITY].map(|x| alpha(Alpha::from_squared(x).unwrap()));
        assert_eq!(texts[0], "α = 10 (squared length; √α = 3.16228)");
        assert_eq!(texts[1], "α = -1e300 (squared length; negative, so no radius)");
        assert_eq!(texts[2], "α = inf (squared length; √α = inf)");
    }
}
