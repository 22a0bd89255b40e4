use serde::{Serialize, Serializer};

/// Writes a number that may be infinite, as α is, where the format has no ∞ (JSON): as the string "inf"
/// or "-inf". For `#[serde(serialize_with)]`.
///
/// # Errors
/// Those of the serializer.
pub fn number_or_name<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if number.is_finite() {
        serializer.serialize_f64(*number)
    } else {
        serializer.serialize_str(&number.to_string())
    }
}

/// The same where there may be no number.
///
/// # Errors
/// Those of the serializer.
pub fn number_or_null_or_name<S: Serializer>(
    number: &Option<f64>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    match number {
        Some(number) => number_or_name(number, serializer),
        None => serializer.serialize_none(),
    }
}

/// The same for two numbers.
pub(crate) fn each_number_or_name<S: Serializer>(
    numbers: &[f64; 2],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Named(#[serde(serialize_with = "number_or_name")] f64);
    numbers.map(Named).serialize(serializer)
}
