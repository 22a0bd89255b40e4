//! Answers: JSON and arrays, laid out for the worker.

use serde_json::{Map, Value, json};

/// A JSON object and named arrays.
pub(crate) struct Answer {
    /// An object, until it has become the text.
    head: Value,
    arrays: Vec<Array>,
    text: String,
    /// Place and length of the text, for the worker.
    place: [u32; 2],
}

/// Numbers that the worker copies, by the name of the JavaScript type that holds them.
pub(crate) enum Array {
    U8(&'static str, Vec<u8>),
    U32(&'static str, Vec<u32>),
    F32(&'static str, Vec<f32>),
    F64(&'static str, Vec<f64>),
}

impl Array {
    /// Its name, type, address and length.
    fn described(&self) -> (&'static str, Value) {
        fn at<T>(kind: &str, numbers: &[T]) -> Value {
            json!({ "kind": kind, "at": numbers.as_ptr() as usize, "length": numbers.len() })
        }
        match self {
            Self::U8(name, numbers) => (name, at("Uint8Array", numbers)),
            Self::U32(name, numbers) => (name, at("Uint32Array", numbers)),
            Self::F32(name, numbers) => (name, at("Float32Array", numbers)),
            Self::F64(name, numbers) => (name, at("Float64Array", numbers)),
        }
    }
}

impl Answer {
    pub(crate) const EMPTY: Self =
        Self { head: Value::Null, arrays: Vec::new(), text: String::new(), place: [0; 2] };

    /// An answer of these fields, an object, and these arrays.
    pub(crate) fn of(head: Value, arrays: Vec<Array>) -> Self {
        Self { head, arrays, ..Self::EMPTY }
    }

    /// Tells what went wrong, and what to do next.
    pub(crate) fn failed(why: &str, next: Option<String>) -> Self {
        Self::of(json!({ "failed": why, "next": next }), Vec::new())
    }

    /// The address and length of the text of the answer.
    pub(crate) fn place(&mut self) -> *const u32 {
        let arrays: Map<String, Value> = (self.arrays.iter().map(Array::described))
            .map(|(name, array)| (name.to_owned(), array))
            .collect();
        let mut head = self.head.take();
        head["arrays"] = arrays.into();
        self.text = head.to_string();
        self.place = [self.text.as_ptr() as usize as u32, self.text.len() as u32];
        self.place.as_ptr()
    }
}
