//! A file in memory: its words, lines and binary numbers, with their places.
//!
//! Any size that a file states is compared with its actual size, before memory is allocated.

use std::str::{self, FromStr};

use walpha_base::memory::try_with_capacity;

use super::MeshError;

/// The form of numbers in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// Words.
    Text,
    /// Bytes, starting with the last.
    Little,
    /// Bytes, starting with the first.
    Big,
}

/// The advice for most kinds of damage.
pub(super) const WRITE_AGAIN: &str = "write the file again";
/// The longest part of a word that a message shows.
const SHOWN: usize = 40;

pub(super) struct Scan<'a> {
    bytes: &'a [u8],
    /// The position of the next byte.
    at: usize,
    /// The start of the part that was read last.
    last: usize,
    /// The form of the numbers that follow.
    pub(super) form: Form,
    /// Whether `#` begins a comment, up to the end of its line.
    comments: bool,
}

impl<'a> Scan<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, last: 0, form: Form::Text, comments: false }
    }

    /// Like [`new`](Self::new), for a file with comments.
    pub(super) fn with_comments(bytes: &'a [u8]) -> Self {
        Self { comments: true, ..Self::new(bytes) }
    }

    /// An error at the part that was read last.
    pub(super) fn fault(&self, why: impl Into<String>) -> MeshError {
        let error = MeshError::new(why).with_advice(WRITE_AGAIN);
        let before = &self.bytes[..self.last];
        // Behind binary numbers lines mean nothing.
        if before.contains(&0) {
            return error.at(&format!("byte {}", self.last));
        }
        let end = if before.contains(&b'\n') { b'\n' } else { b'\r' };
        let line = before.split(|&byte| byte == end).count();
        error.at(&format!("line {line}"))
    }

    fn truncated(&mut self, what: &str) -> MeshError {
        // The line that ends too early, rather than the empty one behind it.
        self.last = self.bytes.trim_ascii_end().len();
        self.fault(format!("the file ends where {what} should follow: it is truncated"))
    }

    fn left(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// The next word, if there is one.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        loop {
            self.at += self.left().len() - self.left().trim_ascii_start().len();
            if !(self.comments && self.left().starts_with(b"#")) {
                break;
            }
            self.skip_line();
        }
        self.last = self.at;
        let ends = |byte: &u8| byte.is_ascii_whitespace() || self.comments && *byte == b'#';
        let length = self.left().iter().position(ends).unwrap_or(self.left().len());
        let word = &self.left()[..length];
        self.at += length;
        (!word.is_empty()).then_some(word)
    }

    /// The next word, without moving past it.
    pub(super) fn peek(&mut self) -> Option<&'a [u8]> {
        let (at, last) = (self.at, self.last);
        let word = self.word();
        (self.at, self.last) = (at, last);
        word
    }

    /// The next word, which must exist.
    pub(super) fn expect(&mut self, what: &str) -> Result<&'a [u8], MeshError> {
        self.word().ok_or_else(|| self.truncated(what))
    }

    /// Goes to the beginning of the next line. Lines end with LF, CR LF or CR.
    pub(super) fn skip_line(&mut self) {
        let left = self.left();
        let width = |end: usize| if left[end..].starts_with(b"\r\n") { 2 } else { 1 };
        let end = left.iter().position(|byte| b"\r\n".contains(byte));
        self.at += end.map_or(left.len(), |end| end + width(end));
    }

    /// The rest of the line.
    pub(super) fn line(&mut self) -> &'a [u8] {
        self.last = self.at;
        self.skip_line();
        self.bytes[self.last..self.at].trim_ascii()
    }

    /// Puts the words of the next line that is not empty into `words`, without its comment.
    pub(super) fn record(&mut self, words: &mut Vec<&'a [u8]>) -> bool {
        words.clear();
        while words.is_empty() && self.at < self.bytes.len() {
            let line = self.line();
            let comment = line.iter().position(|&byte| byte == b'#' && self.comments);
            let line = &line[..comment.unwrap_or(line.len())];
            words.extend(line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()));
        }
        !words.is_empty()
    }

    /// The words of the next line that is not empty.
    pub(super) fn expect_record(
        &mut self,
        words: &mut Vec<&'a [u8]>,
        what: &str,
    ) -> Result<(), MeshError> {
        if self.record(words) { Ok(()) } else { Err(self.truncated(what)) }
    }

    /// Goes behind the next occurrence of `mark`.
    pub(super) fn skip_past(&mut self, mark: &[u8]) -> Result<(), MeshError> {
        match self.left().windows(mark.len()).position(|window| window == mark) {
            Some(at) => {
                self.at += at + mark.len();
                Ok(())
            }
            None => Err(self.truncated(&String::from_utf8_lossy(mark))),
        }
    }

    /// The value of a word.
    pub(super) fn value<T: FromStr>(&self, word: &[u8], what: &str) -> Result<T, MeshError> {
        let value = str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        value.ok_or_else(|| self.fault(format!("{:?} is not {what}", shown(word))))
    }

    /// A number of `N` bytes in the order of little endian, or otherwise the next word as text.
    fn number<T: FromStr, const N: usize>(
        &mut self,
        what: &str,
        decode: impl Fn([u8; N]) -> T,
    ) -> Result<T, MeshError> {
        if self.form == Form::Text {
            let word = self.expect(what)?;
            return self.value(word, what);
        }
        let mut bytes: [u8; N] = self.take(N, what)?.try_into().expect("N bytes were taken");
        if self.form == Form::Big {
            bytes.reverse();
        }
        Ok(decode(bytes))
    }

    /// An integer, in binary of 32 bits.
    pub(super) fn int(&mut self, what: &str) -> Result<i64, MeshError> {
        self.number(what, |bytes| i64::from(i32::from_le_bytes(bytes)))
    }

    /// A natural number, in binary of 64 bits.
    pub(super) fn size(&mut self, what: &str) -> Result<u64, MeshError> {
        self.number(what, u64::from_le_bytes)
    }

    /// A coordinate, in binary of 64 bits.
    pub(super) fn coordinate(&mut self) -> Result<f64, MeshError> {
        let x = self.number("a coordinate", f64::from_le_bytes)?;
        self.finite(x)
    }

    /// Three coordinates.
    pub(super) fn position(&mut self) -> Result<[f64; 3], MeshError> {
        Ok([self.coordinate()?, self.coordinate()?, self.coordinate()?])
    }

    /// Refuses NaN and infinities, which no triangulation has.
    pub(super) fn finite(&self, x: f64) -> Result<f64, MeshError> {
        if x.is_finite() {
            return Ok(x);
        }
        let error = self.fault(format!("a coordinate is {x}, and must be a finite number"));
        Err(error.with_advice("remove such points and their cells"))
    }

    /// Takes the requested number of bytes.
    pub(super) fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], MeshError> {
        let Some(bytes) = self.left().get(..count) else { return Err(self.truncated(what)) };
        self.last = self.at;
        self.at += count;
        Ok(bytes)
    }

    /// An empty vector for `count` things, each of at least `bytes` bytes in the file. A count for which the
    /// file has no room is an error.
    pub(super) fn room<T>(&self, count: u64, bytes: u64, what: &str) -> Result<Vec<T>, MeshError> {
        let left = self.left().len() as u64;
        if count.saturating_mul(bytes) > left || u32::try_from(count).is_err() {
            return Err(self.fault(format!(
                "the file states {count} {what}, and {left} bytes follow, which cannot hold them: it is truncated or damaged"
            )));
        }
        Ok(try_with_capacity(count as usize, || what.to_owned())?)
    }
}

/// A word in a message.
pub(super) fn shown(word: &[u8]) -> String {
    let mut text = String::from_utf8_lossy(&word[..word.len().min(SHOWN)]).into_owned();
    if word.len() > SHOWN {
        text.push('…');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_in_three_ways() {
        for text in
            ["# one\n1 2 # two\n\n3", "# one\r\n1 2 # two\r\n\r\n3", "# one\r1 2 # two\r\r3"]
        {
            let (mut scan, mut words) = (Scan::with_comments(text.as_bytes()), Vec::new());
            assert!(scan.record(&mut words), "{text:?}");
            assert_eq!(words, [b"1", b"2"], "{text:?}");
            assert!(scan.record(&mut words) && words == [b"3"], "{text:?}");
            assert!(!scan.record(&mut words), "{text:?}");
        }
    }
}
