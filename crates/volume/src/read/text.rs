use std::io::Read;
use std::str::FromStr;

use walpha_base::memory::{NoMemory, try_with_capacity};

use super::payload::Element;
use crate::{Dtype, Reason};

/// Reads exactly `count` numbers of a type, written as text with white space between them, from
/// `bytes` bytes. The text is held in memory along with the numbers.
///
/// The error says what is wrong, in words that follow the name of the file.
pub(super) fn numbers<T: Element + FromStr + Into<f64>>(
    reader: impl Read,
    bytes: u64,
    dtype: Dtype,
    count: u64,
) -> Result<Vec<T>, Reason> {
    // A digit each, and a space between.
    if bytes.saturating_add(1) / 2 < count {
        return Err(Reason::truncated(format!(
            "claims {count} numbers, which {bytes} bytes of text cannot hold: it is \
                 truncated or mislabelled"
        )));
    }
    let no_room =
        |lack: NoMemory| Reason::Memory { claim: lack.what().into(), needed: lack.bytes() as u64 };
    let mut text = try_with_capacity(bytes as usize, || "its text".into()).map_err(no_room)?;
    reader
        .take(bytes)
        .read_to_end(&mut text)
        .map_err(|error| Reason::damaged(format!("cannot be read: {error}")))?;
    let mut values = try_with_capacity(count as usize, || format!("a row of {count} numbers"))
        .map_err(no_room)?;
    for word in text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()) {
        if values.len() as u64 == count {
            return Err(Reason::header(format!(
                "claims {count} numbers, but more follow: it is mislabelled"
            )));
        }
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse::<T>().ok());
        match number {
            Some(number) if dtype.holds(number.into()) => values.push(number),
            _ => {
                let word = String::from_utf8_lossy(&word[..word.len().min(40)]);
                let place = values.len() + 1;
                return Err(Reason::value(format!(
                    "has {word:?} as number {place}, which is no {dtype}"
                )));
            }
        }
    }
    if (values.len() as u64) < count {
        return Err(Reason::truncated(format!(
            "claims {count} numbers, but has {}: it is truncated",
            values.len()
        )));
    }
    Ok(values)
}
