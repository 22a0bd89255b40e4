//! α in JSON: a number, or `"inf"` or `"-inf"`, which JSON numbers cannot say.

use serde::{Deserialize, Deserializer, Serializer, de};

pub fn serialize<S: Serializer>(alpha: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    match *alpha {
        f64::INFINITY => serializer.serialize_str("inf"),
        f64::NEG_INFINITY => serializer.serialize_str("-inf"),
        finite => serializer.serialize_f64(finite),
    }
}

pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "alpha must be a number, \"inf\" or \"-inf\"")]
    enum Alpha {
        Number(f64),
        Word(String),
    }
    match Alpha::deserialize(deserializer)? {
        Alpha::Number(number) => Ok(number),
        Alpha::Word(word) => match word.as_str() {
            "inf" => Ok(f64::INFINITY),
            "-inf" => Ok(f64::NEG_INFINITY),
            _ => Err(de::Error::custom(format!(
                "alpha must be a number, \"inf\" or \"-inf\", not {word:?}"
            ))),
        },
    }
}
