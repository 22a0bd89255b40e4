//! Notes in exported files: α and coordinates, in the form that other programs look for.

use walpha_base::shown::{number, six_digits};

use crate::{Coordinates, LengthUnit, Space};
use walpha_complex::Alpha;

/// The text about α for a comment. In ASCII, as headers of PLY are.
pub fn alpha(alpha: Alpha) -> String {
    format!("alpha = {}", described(alpha))
}

/// α as a squared length, and also as a radius if it has one.
pub fn described(alpha: Alpha) -> String {
    let squared = number(alpha.squared());
    match alpha.radius().map(six_digits).map(number) {
        Some(radius) => format!("{squared} (squared length; radius {radius})"),
        None => format!("{squared} (squared length; negative, so no radius)"),
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

/// What a file states: the name of a space and of a unit, each empty if there is none.
pub(crate) fn coordinates(space: &str, unit: &str) -> Coordinates {
    let space = match space {
        "LPS" => Space::Lps,
        "RAS" => Space::Ras,
        _ => Space::Unknown,
    };
    Coordinates {
        space,
        unit: if unit.is_empty() { LengthUnit::Unstated } else { LengthUnit::named(unit) },
    }
}

/// What [`comment`] wrote, anywhere in a text.
pub fn read(text: &str) -> Coordinates {
    let stated = |name| text.split_whitespace().find_map(|word| word.strip_prefix(name));
    coordinates(stated("SPACE=").unwrap_or_default(), stated("UNIT=").unwrap_or_default())
}

/// What was subtracted from the coordinates of a file in single precision, as its text states it: ` OFFSET=x,y,z`.
pub fn offset(text: &str) -> Option<[f64; 3]> {
    let stated = text.split_whitespace().find_map(|word| word.strip_prefix("OFFSET="))?;
    let numbers: Vec<f64> = stated.split(',').map(str::parse).collect::<Result<_, _>>().ok()?;
    numbers.try_into().ok().filter(|offset: &[f64; 3]| offset.iter().all(|x| x.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        for coordinates in [
            Coordinates::default(),
            Coordinates::PATIENT,
            Coordinates { space: Space::Ras, unit: LengthUnit::Unstated },
            Coordinates { space: Space::Unknown, unit: LengthUnit::Angstrom },
            Coordinates { space: Space::Unknown, unit: LengthUnit::Micrometre },
        ] {
            assert_eq!(read(&format!("made by{}", comment(coordinates))), coordinates);
        }
        assert_eq!(read("SPACE=up UNIT= UNITS=mm"), Coordinates::default());
        assert_eq!(offset("walpha OFFSET=1e3,-2.5,0 UNIT=m"), Some([1000.0, -2.5, 0.0]));
        for text in ["", "OFFSET=1,2", "OFFSET=1,2,3,4", "OFFSET=1,2,inf", "OFFSET=a,2,3"] {
            assert_eq!(offset(text), None, "{text}");
        }
    }

    #[test]
    fn alpha_is_a_squared_length() {
        let texts = [10.0, -1e300, f64::INFINITY].map(|x| alpha(Alpha::from_squared(x).unwrap()));
        assert_eq!(texts[0], "alpha = 10 (squared length; radius 3.16228)");
        assert_eq!(texts[1], "alpha = -1e300 (squared length; negative, so no radius)");
        assert_eq!(texts[2], "alpha = inf (squared length; radius inf)");
    }
}
