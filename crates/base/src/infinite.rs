use serde::Serializer;

/// Serializes a number that may be infinite or missing in formats without ∞ (JSON): an infinite one as the string "inf" or
/// "-inf". For `#[serde(serialize_with)]`. An `Alpha` is serialized in the same way.
///
/// # Errors
/// Errors of the serializer.
pub fn number_or_null_or_name<S: Serializer>(
    number: &Option<f64>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    match number {
        Some(number) if number.is_finite() => serializer.serialize_f64(*number),
        Some(number) => serializer.serialize_str(&number.to_string()),
        None => serializer.serialize_none(),
    }
}
