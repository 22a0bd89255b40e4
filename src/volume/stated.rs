//! What a file says of its coordinates, where the programs that read it look.

use crate::volume::{Coordinates, LengthUnit};

/// For the comments of a file, behind what stands there: ` SPACE=LPS UNIT=mm`, as 3D Slicer looks for
/// it; `UNIT` alone where the space is not known, and nothing where nothing is.
pub(crate) fn comment(coordinates: Coordinates) -> String {
    pairs(coordinates).into_iter().map(|(name, value)| format!(" {name}={value}")).collect()
}

/// The same as a line of its own, behind the word or sign that begins a comment; none where nothing is
/// known.
pub(crate) fn line(sign: &str, coordinates: Coordinates) -> String {
    match comment(coordinates) {
        comment if comment.is_empty() => comment,
        comment => format!("{sign}{comment}\n"),
    }
}

/// The same as VTK's field data in XML: arrays of one string each, in the numbers of its characters.
#[cfg(feature = "formats")]
pub(crate) fn field_data(coordinates: Coordinates) -> String {
    let told = pairs(coordinates);
    if told.is_empty() {
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
    format!("<FieldData>\n{}</FieldData>\n", told.iter().map(array).collect::<String>())
}

/// The names and texts of what is known.
pub(crate) fn pairs(Coordinates { space, unit }: Coordinates) -> Vec<(&'static str, &'static str)> {
    let space = space.is_known().then(|| ("SPACE", space.name()));
    let unit = (unit != LengthUnit::Unstated).then(|| ("UNIT", unit.ascii()));
    space.into_iter().chain(unit).collect()
}
