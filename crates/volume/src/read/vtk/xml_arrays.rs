//! The arrays of VTK's XML formats in all encodings: text, base64, raw, and compressed.

use std::io::{self, BufRead, Read, Take};
use std::str::FromStr;

use flate2::read::ZlibDecoder;

use super::xml::{Appended, Compressor, VtkXml, XmlElement};
use crate::read::payload::{Element, Length, MOST_EXPANSION, Payload, payload_error_of};
use crate::read::text;
use crate::{Coordinates, Endian, Reason, VolumeError, annotation};

impl VtkXml<'_> {
    /// Reads an array, which must have exactly `count` numbers.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn values<T: Element + FromStr + Into<f64>>(
        &self,
        array: usize,
        count: u64,
    ) -> Result<Vec<T>, VolumeError> {
        let dtype = self.dtype(array)?;
        let XmlElement { text: start, text_end, .. } = self.elements[array];
        let end = text_end.unwrap_or(start);
        let of_array = |reason: Reason| {
            let part = format!("its array {}", self.name(array));
            self.fail(Reason::Within { part, reason: Box::new(reason) })
        };
        let format = self.format(array);
        match format.as_str() {
            "ascii" => {
                let (path, text) = (self.file.path(), self.part(start, end)?);
                text::numbers(path, text, end - start, dtype, count).map_err(of_array)
            }
            "binary" => {
                let text = Base64::new(self.part(start, end)?);
                self.decoded(array, text, (end - start) / 4 * 3, count)
            }
            "appended" => {
                let (from, base64) = self.appended_at(array).map_err(of_array)?;
                let left = self.file.length().saturating_sub(from);
                let data = self.part(from, self.file.length())?;
                if base64 {
                    self.decoded(array, Base64::new(data), left / 4 * 3, count)
                } else {
                    self.decoded(array, data, left, count)
                }
            }
            _ => Err(of_array(Reason::header(format!(
                "has format {format}, not ascii, binary or appended"
            )))),
        }
    }

    /// Axes and unit of a dataset, as its field data `SPACE` and `UNIT` state them; our own files have these, and those of 3D Slicer.
    ///
    /// # Errors
    /// [`VolumeError`]: what cannot be read, and why.
    pub fn coordinates(&self, dataset: usize) -> Result<Coordinates, VolumeError> {
        let text = |name| Ok::<_, VolumeError>(self.field_text(dataset, name)?.unwrap_or_default());
        Ok(annotation::coordinates(&text("SPACE")?, &text("UNIT")?))
    }

    /// The format of an array, in lower case. VTK takes it for text where it is not stated.
    fn format(&self, array: usize) -> String {
        self.attribute(array, "format").unwrap_or("ascii").to_ascii_lowercase()
    }

    /// Where the data of an appended array begin, and whether they are base64.
    fn appended_at(&self, array: usize) -> Result<(u64, bool), Reason> {
        let Some(Appended { start, base64 }) = self.appended else {
            return Err(Reason::header("is appended, but there are no appended data"));
        };
        let offset = self.count(array, "offset");
        let from = offset.and_then(|offset| start.checked_add(offset));
        let from = from.ok_or_else(|| Reason::header("has no offset in the appended data"))?;
        Ok((from, base64))
    }

    /// A text of the field data of a dataset: the first string of an array of strings, or an array of bytes. VTK writes
    /// the numbers of its characters, up to a 0. `None` if there is none, or it is compressed or longer than what is looked for.
    ///
    /// # Errors
    /// [`VolumeError`]: what cannot be read, and why.
    pub fn field_text(&self, dataset: usize, name: &str) -> Result<Option<String>, VolumeError> {
        /// Nothing that is looked for is longer.
        const LONGEST: u64 = 1000;
        let Some(fields) = self.children(dataset, "FieldData").next() else { return Ok(None) };
        let named = |&array: &usize| self.attribute(array, "Name") == Some(name);
        let mut arrays =
            ["Array", "DataArray"].into_iter().flat_map(|element| self.children(fields, element));
        let Some(array) = arrays.find(named) else { return Ok(None) };
        let XmlElement { text: start, text_end, .. } = self.elements[array];
        let end = text_end.unwrap_or(start);
        let damaged = |error: io::Error| {
            self.fail(Reason::damaged(format!("has damaged field data {name}: {error}")))
        };
        let bytes = match self.format(array).as_str() {
            "ascii" => {
                let mut text = String::new();
                let part = self.part(start, end.min(start + LONGEST))?;
                part.take(LONGEST).read_to_string(&mut text).map_err(damaged)?;
                Some(text.split_whitespace().map_while(|byte| byte.parse().ok()).collect())
            }
            "binary" => {
                self.short(Base64::new(self.part(start, end)?), LONGEST).map_err(damaged)?
            }
            "appended" => {
                let (from, base64) = self.appended_at(array).map_err(|reason| self.fail(reason))?;
                let data = self.part(from, self.file.length())?;
                if base64 {
                    self.short(Base64::new(data), LONGEST).map_err(damaged)?
                } else {
                    self.short(data, LONGEST).map_err(damaged)?
                }
            }
            _ => None,
        };
        let Some(bytes): Option<Vec<u8>> = bytes else { return Ok(None) };
        let first = bytes.split(|&byte| byte == 0).next().unwrap_or_default();
        Ok(Some(String::from_utf8_lossy(first).into_owned()))
    }

    /// The bytes of an array that follow its length; `None` if they are compressed, or more than `most`.
    fn short(&self, mut data: impl Read, most: u64) -> io::Result<Option<Vec<u8>>> {
        let length = self.word(&mut data)?;
        if !matches!(self.compressor, Ok(None)) || length > most {
            return Ok(None);
        }
        let mut bytes = vec![0; length as usize];
        data.read_exact(&mut bytes)?;
        Ok(Some(bytes))
    }

    /// Reads an array that follows its length, or the lengths of its compressed blocks, from at most `most` bytes.
    fn decoded<T: Element>(
        &self,
        array: usize,
        mut data: impl Read,
        most: u64,
        count: u64,
    ) -> Result<Vec<T>, VolumeError> {
        let dtype = self.dtype(array)?;
        let claim = format!("an array {} of {count} numbers of type {dtype}", self.name(array));
        let located = |error| payload_error_of(self.file.path(), &claim, error);
        let cut = |error: io::Error| match error.kind() {
            io::ErrorKind::UnexpectedEof => self.fail(Reason::truncated(format!(
                "ends before its array {}: it is truncated",
                self.name(array)
            ))),
            _ => self.fail(Reason::damaged(format!(
                "has a damaged array {}: {error}",
                self.name(array)
            ))),
        };
        let compressor = self.compressor.as_ref().map_err(|name| {
            self.fail(Reason::unsupported(
                format!("is compressed by {name}, which is not read"),
                "choose LZ4, ZLib or none where it is written",
            ))
        })?;
        let first = self.word(&mut data).map_err(cut)?;
        let Some(compressor) = *compressor else {
            if first > most {
                return Err(self.fail(Reason::claims_more(format!(
                    "claims {first} bytes for its array {}, but at most {most} follow: it is \
                     truncated",
                    self.name(array)
                ))));
            }
            let payload = Payload { reader: data.take(first), length: Length::Exactly(first) };
            return payload
                .samples(self.file.path(), dtype, self.endian, count, &self.monitor)
                .map_err(located);
        };
        let [block, last] =
            [self.word(&mut data).map_err(cut)?, self.word(&mut data).map_err(cut)?];
        if first > most / self.word as u64 {
            return Err(self.fail(Reason::header(format!(
                "claims {first} compressed blocks for its array {}, which it cannot hold",
                self.name(array)
            ))));
        }
        let whole = if last > 0 { first.saturating_sub(1) } else { first };
        let bytes = whole.checked_mul(block).and_then(|bytes| bytes.checked_add(last));
        let bytes = bytes.filter(|&bytes| bytes <= most.saturating_mul(MOST_EXPANSION));
        let Some(bytes) = bytes else {
            return Err(self.fail(Reason::header(format!(
                "claims {first} compressed blocks of {block} bytes for its array {}, more than \
                 it can hold",
                self.name(array)
            ))));
        };
        let sizes = (0..first).map(|_| self.word(&mut data)).collect::<io::Result<Vec<u64>>>();
        let sizes = sizes.map_err(cut)?;
        let packed = sizes.iter().fold(0u64, |sum, &size| sum.saturating_add(size));
        if packed > most {
            return Err(self.fail(Reason::claims_more(format!(
                "claims {packed} compressed bytes for its array {}, but at most {most} follow: it is \
                 truncated",
                self.name(array)
            ))));
        }
        if bytes > packed.saturating_mul(MOST_EXPANSION) {
            return Err(self.fail(Reason::header(format!(
                "claims that {packed} compressed bytes of its array {} hold {bytes}, which they cannot",
                self.name(array)
            ))));
        }
        let reader = Blocks {
            data: Some(data),
            compressor,
            sizes: sizes.into_iter(),
            block: block.max(last),
            at: At::End,
        };
        let payload = Payload { reader, length: Length::Exactly(bytes) };
        payload.samples(self.file.path(), dtype, self.endian, count, &self.monitor).map_err(located)
    }

    /// A length that precedes an array.
    fn word(&self, data: &mut impl Read) -> io::Result<u64> {
        let mut bytes = [0; 8];
        let bytes = &mut bytes[..self.word];
        data.read_exact(bytes)?;
        let add = |sum: u64, &byte: &u8| sum << 8 | u64::from(byte);
        Ok(match self.endian {
            Endian::Big => bytes.iter().fold(0, add),
            Endian::Little => bytes.iter().rev().fold(0, add),
        })
    }
}

/// Reads blocks that are compressed one by one.
struct Blocks<R> {
    /// The data after the current block, while no block is being read.
    data: Option<R>,
    compressor: Compressor,
    /// The compressed sizes of the remaining blocks.
    sizes: std::vec::IntoIter<u64>,
    /// The largest uncompressed size of a block.
    block: u64,
    at: At<R>,
}

/// The position in a block.
enum At<R> {
    /// In a block that is unpacked while it is read, as it may be as large as the array.
    Within(Take<ZlibDecoder<Take<R>>>),
    /// In a block that was unpacked at once; this is what is left of it.
    Ready(io::Cursor<Vec<u8>>),
    /// At the end of a block.
    End,
}

impl<R: Read> Read for Blocks<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            let found = match &mut self.at {
                At::Within(block) => block.read(buffer)?,
                At::Ready(bytes) => bytes.read(buffer)?,
                At::End => 0,
            };
            if found > 0 || buffer.is_empty() {
                return Ok(found);
            }
            if let At::Within(block) = std::mem::replace(&mut self.at, At::End) {
                let mut packed = block.into_inner().into_inner();
                // The decoder reads ahead, but not beyond the block.
                io::copy(&mut packed, &mut io::sink())?;
                if packed.limit() > 0 {
                    return Err(io::ErrorKind::UnexpectedEof.into());
                }
                self.data = Some(packed.into_inner());
            }
            let Some(size) = self.sizes.next() else { return Ok(0) };
            let mut packed = self.data.take().expect("no block is being read").take(size);
            self.at = match self.compressor {
                Compressor::Zlib => At::Within(ZlibDecoder::new(packed).take(self.block)),
                Compressor::Lz4 => {
                    let mut code = Vec::new();
                    packed.read_to_end(&mut code)?;
                    if packed.limit() > 0 {
                        return Err(io::ErrorKind::UnexpectedEof.into());
                    }
                    self.data = Some(packed.into_inner());
                    // LZ4 repeats a byte for each byte 255 in its code, so an expansion by this factor is possible.
                    let most = self.block.min(size.saturating_mul(256)) as usize;
                    let bytes = lz4_flex::block::decompress(&code, most)
                        .map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))?;
                    At::Ready(io::Cursor::new(bytes))
                }
            };
        }
    }
}

/// Decodes base64 (RFC 4648) as VTK writes it: white space is ignored, and padding may end one piece of data in the middle of the
/// text, where the next begins.
pub(in crate::read) struct Base64<R> {
    text: R,
    /// The decoded bytes, their number, and how many were returned.
    ready: [u8; 3],
    length: usize,
    given: usize,
}

impl<R: BufRead> Base64<R> {
    pub(in crate::read) fn new(text: R) -> Self {
        Self { text, ready: [0; 3], length: 0, given: 0 }
    }

    /// Decodes the next four characters; `false` at the end of the text.
    fn refill(&mut self) -> io::Result<bool> {
        let mut group = [0; 4];
        let mut filled = 0;
        while filled < 4 {
            let buffer = self.text.fill_buf()?;
            if buffer.is_empty() {
                break;
            }
            let mut used = 0;
            for &byte in buffer {
                used += 1;
                if !byte.is_ascii_whitespace() {
                    group[filled] = byte;
                    filled += 1;
                    if filled == 4 {
                        break;
                    }
                }
            }
            self.text.consume(used);
        }
        if filled == 0 {
            return Ok(false);
        }
        let (ready, length) = decode(group).filter(|_| filled == 4).ok_or_else(|| {
            io::Error::new(io::ErrorKind::InvalidData, "its base64 text is cut off or damaged")
        })?;
        (self.ready, self.length, self.given) = (ready, length, 0);
        Ok(true)
    }
}

impl<R: BufRead> Read for Base64<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let mut written = 0;
        while written < out.len() {
            if self.given == self.length && !self.refill()? {
                break;
            }
            let count = (self.length - self.given).min(out.len() - written);
            out[written..written + count].copy_from_slice(&self.ready[self.given..][..count]);
            self.given += count;
            written += count;
        }
        Ok(written)
    }
}

/// Decodes four characters to up to three bytes.
fn decode(group: [u8; 4]) -> Option<([u8; 3], usize)> {
    let padding = group.iter().rev().take_while(|&&character| character == b'=').count();
    let mut bits = 0u32;
    for (i, character) in group.into_iter().enumerate() {
        let six = match character {
            b'A'..=b'Z' => character - b'A',
            b'a'..=b'z' => character - b'a' + 26,
            b'0'..=b'9' => character - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            b'=' if i + padding >= 4 => 0,
            _ => return None,
        };
        bits = bits << 6 | u32::from(six);
    }
    let [_, a, b, c] = bits.to_be_bytes();
    (padding <= 2).then(|| ([a, b, c], 3 - padding))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(text: &str) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        Base64::new(text.as_bytes()).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    /// Tests the examples of RFC 4648, section 10.
    #[test]
    fn text_becomes_bytes() {
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            (" Zm9v\nYm Fy\n", "foobar"),
            ("Zg==Zm9v", "ffoo"),
        ] {
            assert_eq!(decoded(text).unwrap(), bytes.as_bytes(), "{text}");
        }
        for text in ["Z", "Zg=", "Z===", "====", "Zg=v", "Zm9*"] {
            assert!(decoded(text).is_err(), "{text}");
        }
    }
}
