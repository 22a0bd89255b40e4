//! Decodes text in various encodings and with various line ends.

use walpha_base::memory::{NoMemory, try_with_capacity};

use super::content::Content;
use super::{PointsError, format};
use walpha_volume::{OpenFile, Reason};

/// The whole file as text whose lines end with `\n`. The encoding may be UTF-8, UTF-16 of either byte order, with or without a
/// byte order mark, or else Latin-1. Lines may end with CR LF or CR.
pub(crate) fn text(file: &OpenFile) -> Result<String, PointsError> {
    let path = file.path();
    decoded(Content::of(file)?.bytes(path)?).map_err(|error| match error {
        Undecodable::Reason(reason) => format(path, reason),
        Undecodable::Memory(lack) => lack.into(),
    })
}

/// Why bytes are not text.
enum Undecodable {
    Reason(Reason),
    Memory(NoMemory),
}

impl From<NoMemory> for Undecodable {
    fn from(lack: NoMemory) -> Self {
        Self::Memory(lack)
    }
}

fn decoded(bytes: Vec<u8>) -> Result<String, Undecodable> {
    let text = match (bytes.as_slice(), wide(&bytes)) {
        ([0xff, 0xfe, rest @ ..], _) => utf16(rest, u16::from_le_bytes)?,
        ([0xfe, 0xff, rest @ ..], _) => utf16(rest, u16::from_be_bytes)?,
        (all, Some(order)) => utf16(all, order)?,
        _ => match String::from_utf8(bytes) {
            Ok(text) => text,
            // Bytes are characters of Latin-1, which take one or two bytes in UTF-8.
            Err(error) => {
                let bytes = error.into_bytes();
                let mut text = room(2 * bytes.len())?;
                text.extend(bytes.iter().copied().map(char::from));
                text
            }
        },
    };
    if text.contains('\0') {
        return Err(Undecodable::Reason(Reason::other("is not text: it holds bytes that are 0")));
    }
    let text = match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    };
    if !text.contains('\r') {
        return Ok(text);
    }
    let mut lines = room(text.len())?;
    let mut pieces = text.split('\r');
    lines.push_str(pieces.next().unwrap_or_default());
    for piece in pieces {
        if !piece.starts_with('\n') {
            lines.push('\n');
        }
        lines.push_str(piece);
    }
    Ok(lines)
}

fn room(bytes: usize) -> Result<String, NoMemory> {
    let bytes = try_with_capacity(bytes, || "the text of a file".into())?;
    Ok(String::from_utf8(bytes).expect("nothing is text"))
}

/// The byte order of UTF-16 without a byte order mark: each of the first characters has one byte 0, always the same one.
fn wide(bytes: &[u8]) -> Option<fn([u8; 2]) -> u16> {
    let (pairs, _) = bytes.as_chunks::<2>();
    let pairs = &pairs[..pairs.len().min(32)];
    let all = |place: usize| {
        pairs.len() > 1 && pairs.iter().all(|pair| pair[place] == 0 && pair[1 - place] != 0)
    };
    match (all(1), all(0)) {
        (true, _) => Some(u16::from_le_bytes),
        (_, true) => Some(u16::from_be_bytes),
        _ => None,
    }
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String, Undecodable> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    if !rest.is_empty() {
        let what = "ends inside a character of UTF-16: it is truncated";
        return Err(Undecodable::Reason(Reason::truncated(what)));
    }
    let mut text = room(3 * pairs.len())?;
    let units = pairs.iter().map(|&pair| unit(pair));
    text.extend(char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)));
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(bytes: &[u8]) -> String {
        decoded(bytes.to_vec()).unwrap_or_default()
    }

    #[test]
    fn text_is_decoded() {
        let text = "x;Höhe\n1;2\n";
        let wide =
            |order: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(order).collect::<Vec<u8>>();
        let (little, big) = (wide(u16::to_le_bytes), wide(u16::to_be_bytes));
        assert_eq!(of(text.as_bytes()), text);
        assert_eq!(of(&[b"\xef\xbb\xbf", text.as_bytes()].concat()), text);
        assert_eq!([of(&little), of(&big)], [text, text]);
        assert_eq!(
            [of(&[b"\xff\xfe", &little[..]].concat()), of(&[b"\xfe\xff", &big[..]].concat())],
            [text, text]
        );
        assert_eq!(of(b"x;H\xf6he\n1;2\n"), text);
        assert_eq!(of(b"x;H\xf6he\r1;2\r"), text);
        assert_eq!(of(b"x;H\xf6he\r\n1;2\r\n"), text);
        assert_eq!(of(b"a\r\rb\r\n\r\nc"), "a\n\nb\n\nc");
        assert_eq!(of(b"1 2\0"), "");
    }
}
