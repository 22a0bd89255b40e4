//! Text in files of samples: header lines and numbers.

use std::io::{self, BufRead, Read};
use std::path::Path;
use std::str::FromStr;

use walpha_base::memory::{NoMemory, try_with_capacity};

use super::payload::Element;
use crate::dtype::HELD;
use crate::rounding::Rounding;
use crate::{Dtype, Reason, Sample as _};

/// The largest length of a line. Longer ones are data mistaken for a header.
const MAX_LINE: u64 = 1 << 20;

/// Reads the lines of a header in front of other data, and counts their bytes.
pub struct Lines<R> {
    reader: R,
    bytes: u64,
}

impl<R: BufRead> Lines<R> {
    /// Creates a reader at the first line.
    pub fn new(reader: R) -> Self {
        Self { reader, bytes: 0 }
    }

    /// The next line without its end (LF or CR LF); `None` at the end of the file. Bytes that are not UTF-8 are replaced.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn read_line(&mut self) -> io::Result<Option<String>> {
        let mut line = Vec::new();
        let found = (&mut self.reader).take(MAX_LINE).read_until(b'\n', &mut line)? as u64;
        if found == MAX_LINE {
            let what = "a line of its header has no end within 1 MB";
            return Err(io::Error::new(io::ErrorKind::InvalidData, what));
        }
        self.bytes += found;
        if line.ends_with(b"\n") {
            line.pop();
        }
        if line.ends_with(b"\r") {
            line.pop();
        }
        Ok((found > 0).then(|| String::from_utf8_lossy(&line).into_owned()))
    }

    /// Skips bytes that are not lines.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn skip(&mut self, bytes: u64) -> io::Result<()> {
        let passed = io::copy(&mut (&mut self.reader).take(bytes), &mut io::sink())?;
        self.bytes += passed;
        Ok(())
    }

    /// The next byte, which belongs to no line; 0 at the end of the file.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn byte(&mut self) -> io::Result<u8> {
        let mut byte = [0];
        self.bytes += self.reader.read(&mut byte)? as u64;
        Ok(byte[0])
    }

    /// Whether the file ends here.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn at_end(&mut self) -> io::Result<bool> {
        Ok(self.reader.fill_buf()?.is_empty())
    }

    /// The number of bytes of the lines so far.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The reader, positioned after the last line.
    pub fn into_inner(self) -> R {
        self.reader
    }
}

/// Reads exactly `count` numbers of a type, written as text with white space between them, from `bytes` bytes. The text is held
/// in memory along with the numbers.
///
/// The error says what is wrong, in words that follow the name of the file.
pub(super) fn numbers<T: Element + FromStr + Into<f64>>(
    path: &Path,
    reader: impl Read,
    bytes: u64,
    dtype: Dtype,
    count: u64,
) -> Result<Vec<T>, Reason> {
    // Each number needs at least a digit, and a space before the next one.
    if bytes.saturating_add(1) / 2 < count {
        return Err(Reason::claims_more(format!(
            "claims {count} numbers, which {bytes} bytes of text cannot hold: it is \
                 truncated or mislabelled"
        )));
    }
    let no_room =
        |lack: NoMemory| Reason::Memory { claim: lack.what().into(), needed: lack.bytes() as u64 };
    let room = |count: u64| usize::try_from(count).unwrap_or(usize::MAX);
    let mut text = try_with_capacity(room(bytes), || "its text".into()).map_err(no_room)?;
    reader
        .take(bytes)
        .read_to_end(&mut text)
        .map_err(|error| Reason::damaged(format!("cannot be read: {error}")))?;
    let mut values =
        try_with_capacity(room(count), || format!("a row of {count} numbers")).map_err(no_room)?;
    let rounding = Rounding::default();
    for word in text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()) {
        if values.len() as u64 == count {
            return Err(Reason::header(format!(
                "claims {count} numbers, but more follow: it is mislabelled"
            )));
        }
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse::<T>().ok());
        match number {
            Some(number) if dtype.holds(number.into()) => {
                let is_single = size_of::<T>() == size_of::<f32>() && dtype != Dtype::F32;
                if is_single && number.into().abs() >= HELD {
                    let exact = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
                    rounding.note(exact.is_some_and(f64::is_rounded));
                }
                values.push(number);
            }
            _ => {
                let word = String::from_utf8_lossy(&word[..word.len().min(40)]);
                let place = values.len() + 1;
                return Err(Reason::value(format!(
                    "has {word:?} as number {place}, which is not a valid {dtype}"
                )));
            }
        }
    }
    if (values.len() as u64) < count {
        return Err(Reason::claims_more(format!(
            "claims {count} numbers, but has {}: it is truncated or mislabelled",
            values.len()
        )));
    }
    rounding.say(path);
    Ok(values)
}
