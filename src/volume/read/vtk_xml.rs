use std::collections::HashMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use flate2::read::ZlibDecoder;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::base64::Base64;
use super::payload::{Element, Length, Payload};
use super::{format_error, io_error, payload_error_of, text};
use crate::volume::{Dtype, Endian, VolumeError};

/// Deflate expands by no more than this.
const MOST_EXPANSION: u64 = 1032;

/// A file of VTK's XML formats (VTK User's Guide, "VTK File Formats"): its elements, and the arrays
/// they hold, which are read on demand. Arrays may be text, base64, or appended raw or in base64, and
/// compressed with zlib.
pub(crate) struct VtkXml {
    path: PathBuf,
    length: u64,
    endian: Endian,
    /// Bytes of a length in front of an array.
    word: usize,
    compressed: bool,
    elements: Vec<XmlElement>,
    appended: Option<Appended>,
}

/// An element with what it says of itself.
#[derive(Debug)]
struct XmlElement {
    name: String,
    parent: Option<usize>,
    attributes: HashMap<String, String>,
    /// Where its text begins in the file, and where it ends: at its end or its first child.
    text: u64,
    text_end: Option<u64>,
}

/// Where appended arrays begin, and whether they are in base64.
#[derive(Clone, Copy, Debug)]
struct Appended {
    start: u64,
    base64: bool,
}

impl VtkXml {
    /// Whether a file begins as VTK's XML files do.
    pub fn is_header(start: &[u8]) -> bool {
        let start = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).trim_ascii_start();
        let holds = |part: &[u8]| start.windows(part.len()).any(|window| window == part);
        start.starts_with(b"<") && holds(b"<VTKFile")
    }

    /// Reads all but the arrays. The root must be `VTKFile`.
    pub fn open(path: &Path) -> Result<Self, VolumeError> {
        let file = File::open(path).map_err(io_error(path))?;
        let length = file.metadata().map_err(io_error(path))?.len();
        let mut this = Self {
            path: path.into(),
            length,
            endian: Endian::Little,
            word: 4,
            compressed: false,
            elements: Vec::new(),
            appended: None,
        };
        this.scan(BufReader::new(file))?;
        this.root()?;
        Ok(this)
    }

    fn said(&self, what: impl Into<String>) -> VolumeError {
        format_error(&self.path, what)
    }

    fn scan(&mut self, file: BufReader<File>) -> Result<(), VolumeError> {
        let mut reader = Reader::from_reader(file);
        let mut buffer = Vec::new();
        let mut open: Vec<usize> = Vec::new();
        loop {
            buffer.clear();
            let before = reader.buffer_position();
            let event = reader.read_event_into(&mut buffer).map_err(|error| match error {
                quick_xml::Error::Io(error) => {
                    io_error(&self.path)(io::Error::new(error.kind(), error.to_string()))
                }
                other => self.said(format!("is no well-formed XML at byte {before}: {other}")),
            })?;
            match event {
                Event::Start(start) => {
                    self.end_text(open.last(), before);
                    let after = reader.buffer_position();
                    let element = self.element(&start, open.last().copied(), after)?;
                    if element.name == "AppendedData" {
                        self.appended = Some(self.appended(&element)?);
                        return Ok(());
                    }
                    open.push(self.elements.len());
                    self.elements.push(element);
                }
                Event::Empty(start) => {
                    self.end_text(open.last(), before);
                    let element =
                        self.element(&start, open.last().copied(), reader.buffer_position())?;
                    self.elements.push(element);
                }
                Event::End(_) => {
                    let closed = open.pop().ok_or_else(|| self.said("closes an element twice"))?;
                    self.end_text(Some(&closed), before);
                }
                Event::Eof => break,
                _ => {}
            }
        }
        match open.last() {
            None => Ok(()),
            Some(&inner) => {
                let name = &self.elements[inner].name;
                Err(self.said(format!("ends inside its element {name}: it is truncated")))
            }
        }
    }

    /// Ends the text of an element, unless a child has ended it already.
    fn end_text(&mut self, element: Option<&usize>, position: u64) {
        if let Some(&element) = element {
            self.elements[element].text_end.get_or_insert(position);
        }
    }

    fn element(
        &self,
        start: &BytesStart,
        parent: Option<usize>,
        position: u64,
    ) -> Result<XmlElement, VolumeError> {
        let mut attributes = HashMap::new();
        for attribute in start.attributes() {
            let damaged = |error: &dyn std::fmt::Display| {
                self.said(format!("has a damaged attribute before byte {position}: {error}"))
            };
            let attribute = attribute.map_err(|error| damaged(&error))?;
            let name = attribute.key.as_ref().to_owned();
            let value = attribute.normalized_value(XmlVersion::Implicit1_0);
            attributes.insert(name, value.map_err(|error| damaged(&error))?.into_owned());
        }
        let name = start.name().as_ref().to_owned();
        Ok(XmlElement { name, parent, attributes, text: position, text_end: None })
    }

    /// Finds the underscore before appended arrays.
    fn appended(&self, element: &XmlElement) -> Result<Appended, VolumeError> {
        let base64 = match element.attributes.get("encoding").map(String::as_str) {
            Some("raw") => false,
            Some("base64") => true,
            other => {
                let given = other.unwrap_or("(missing)");
                return Err(
                    self.said(format!("has appended data in encoding {given}, not raw or base64"))
                );
            }
        };
        let mut before = Vec::new();
        let mut reader = self.part(element.text, self.length)?;
        (&mut reader).take(4096).read_until(b'_', &mut before).map_err(io_error(&self.path))?;
        if before.pop() != Some(b'_') || !before.trim_ascii().is_empty() {
            return Err(self.said("has no underscore before its appended data: it is damaged"));
        }
        Ok(Appended { start: element.text + before.len() as u64 + 1, base64 })
    }

    /// Checks the root, and reads what it says of all arrays.
    fn root(&mut self) -> Result<(), VolumeError> {
        let Some(root) = self.elements.first().filter(|root| root.name == "VTKFile") else {
            return Err(self.said("is no VTK file: its first element is not VTKFile"));
        };
        let attribute = |name: &str| root.attributes.get(name).map(String::as_str);
        self.endian = match attribute("byte_order") {
            Some("LittleEndian") | None => Endian::Little,
            Some("BigEndian") => Endian::Big,
            Some(other) => {
                return Err(self.said(format!("has byte_order {other:?}, which is none")));
            }
        };
        self.word = match attribute("header_type") {
            Some("UInt32") | None => 4,
            Some("UInt64") => 8,
            Some(other) => {
                return Err(self.said(format!("has header_type {other:?}, not UInt32 or UInt64")));
            }
        };
        self.compressed = match attribute("compressor") {
            None | Some("") => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => {
                return Err(self.said(format!(
                    "is compressed by {other}, which is not read: choose ZLib or none where it is \
                     written"
                )));
            }
        };
        Ok(())
    }

    /// What the file holds, such as `ImageData`.
    pub fn kind(&self) -> &str {
        self.attribute(0, "type").unwrap_or("(nothing)")
    }

    /// An attribute of an element.
    pub fn attribute(&self, element: usize, name: &str) -> Option<&str> {
        self.elements[element].attributes.get(name).map(String::as_str)
    }

    /// As many numbers as an attribute should have, or the default where it is missing.
    pub fn numbers<const N: usize>(
        &self,
        element: usize,
        name: &str,
        default: Option<[f64; N]>,
    ) -> Result<[f64; N], VolumeError> {
        let place = &self.elements[element].name;
        let Some(text) = self.attribute(element, name) else {
            return default.ok_or_else(|| self.said(format!("its element {place} has no {name}")));
        };
        let numbers: Option<Vec<f64>> =
            text.split_whitespace().map(|number| number.parse().ok()).collect();
        numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| {
            self.said(format!("its element {place} has {name}={text:?}, which is not {N} numbers"))
        })
    }

    /// The elements of this name right inside another.
    pub fn children(&self, parent: usize, name: &str) -> impl Iterator<Item = usize> {
        let is_child = move |i: &usize| {
            self.elements[*i].parent == Some(parent) && self.elements[*i].name == name
        };
        (0..self.elements.len()).filter(is_child)
    }

    /// The element `Piece` of the dataset, of which there must be one.
    pub fn piece(&self) -> Result<(usize, usize), VolumeError> {
        let kind = self.kind();
        let dataset = self
            .children(0, kind)
            .next()
            .ok_or_else(|| self.said(format!("has no element {kind}: it is damaged")))?;
        let pieces: Vec<usize> = self.children(dataset, "Piece").collect();
        match pieces[..] {
            [piece] => Ok((dataset, piece)),
            _ => Err(self.said(format!(
                "holds {} pieces: only one is read; write it in one piece",
                pieces.len()
            ))),
        }
    }

    /// The type of an array's numbers.
    pub fn dtype(&self, array: usize) -> Result<Dtype, VolumeError> {
        Ok(match self.attribute(array, "type") {
            Some("Int8") => Dtype::I8,
            Some("UInt8") => Dtype::U8,
            Some("Int16") => Dtype::I16,
            Some("UInt16") => Dtype::U16,
            Some("Int32") => Dtype::I32,
            Some("UInt32") => Dtype::U32,
            Some("Int64") => Dtype::I64,
            Some("UInt64") => Dtype::U64,
            Some("Float32") => Dtype::F32,
            Some("Float64") => Dtype::F64,
            other => {
                let name = other.unwrap_or("(missing)");
                return Err(self.said(format!("has an array of type {name}, which is not read")));
            }
        })
    }

    /// How many numbers an array has for each point or cell.
    pub fn components(&self, array: usize) -> &str {
        self.attribute(array, "NumberOfComponents").unwrap_or("1")
    }

    /// Reads an array, which must have exactly `count` numbers.
    pub fn values<T: Element + FromStr + Into<f64>>(
        &self,
        array: usize,
        count: u64,
    ) -> Result<Vec<T>, VolumeError> {
        let dtype = self.dtype(array)?;
        let XmlElement { text: start, text_end, .. } = self.elements[array];
        let end = text_end.unwrap_or(start);
        let of_array = |what: String| self.said(format!("its array {} {what}", self.name(array)));
        match self.attribute(array, "format") {
            Some("ascii") => {
                text::numbers(self.part(start, end)?, end - start, dtype, count).map_err(of_array)
            }
            Some("binary") => {
                let text = Base64::new(self.part(start, end)?);
                self.decoded(array, text, (end - start) / 4 * 3, count)
            }
            Some("appended") => {
                let Some(Appended { start, base64 }) = self.appended else {
                    return Err(of_array("is appended, but there are no appended data".into()));
                };
                let offset = self.attribute(array, "offset").and_then(|text| text.parse().ok());
                let Some(from) = offset.and_then(|offset: u64| start.checked_add(offset)) else {
                    return Err(of_array("has no offset in the appended data".into()));
                };
                let left = self.length.saturating_sub(from);
                let data = self.part(from, self.length)?;
                if base64 {
                    self.decoded(array, Base64::new(data), left / 4 * 3, count)
                } else {
                    self.decoded(array, data, left, count)
                }
            }
            other => {
                let given = other.unwrap_or("(missing)");
                Err(of_array(format!("has format {given}, not ascii, binary or appended")))
            }
        }
    }

    fn name(&self, array: usize) -> &str {
        self.attribute(array, "Name").unwrap_or("without a name")
    }

    /// A part of the file.
    fn part(&self, start: u64, end: u64) -> Result<impl BufRead + use<>, VolumeError> {
        let mut file = File::open(&self.path).map_err(io_error(&self.path))?;
        file.seek(SeekFrom::Start(start)).map_err(io_error(&self.path))?;
        Ok(BufReader::new(file.take(end.saturating_sub(start))))
    }

    /// Reads an array behind its length, or behind the lengths of its compressed blocks; there are
    /// at most `most` bytes.
    fn decoded<T: Element>(
        &self,
        array: usize,
        mut data: impl Read,
        most: u64,
        count: u64,
    ) -> Result<Vec<T>, VolumeError> {
        let dtype = self.dtype(array)?;
        let claim = format!("an array {} of {count} numbers of type {dtype}", self.name(array));
        let located = |error| payload_error_of(&self.path, &claim, error);
        let cut = |error: io::Error| match error.kind() {
            io::ErrorKind::UnexpectedEof => {
                self.said(format!("ends before its array {}: it is truncated", self.name(array)))
            }
            _ => self.said(format!("has a damaged array {}: {error}", self.name(array))),
        };
        let first = self.word(&mut data).map_err(cut)?;
        if !self.compressed {
            if first > most {
                return Err(self.said(format!(
                    "claims {first} bytes for its array {}, but at most {most} follow: it is \
                     truncated",
                    self.name(array)
                )));
            }
            let payload = Payload { reader: data.take(first), length: Length::Exactly(first) };
            return payload.samples(dtype, self.endian, count).map_err(located);
        }
        let [block, last] =
            [self.word(&mut data).map_err(cut)?, self.word(&mut data).map_err(cut)?];
        if first > most / self.word as u64 {
            return Err(self.said(format!(
                "claims {first} compressed blocks for its array {}, which it cannot hold",
                self.name(array)
            )));
        }
        let whole = if last > 0 { first.saturating_sub(1) } else { first };
        let bytes = whole.checked_mul(block).and_then(|bytes| bytes.checked_add(last));
        let bytes = bytes.filter(|&bytes| bytes <= most.saturating_mul(MOST_EXPANSION));
        let Some(bytes) = bytes else {
            return Err(self.said(format!(
                "claims {first} compressed blocks of {block} bytes for its array {}, more than it \
                 can hold",
                self.name(array)
            )));
        };
        let sizes = (0..first).map(|_| self.word(&mut data)).collect::<io::Result<Vec<u64>>>();
        let sizes = sizes.map_err(cut)?.into_iter();
        let reader = Blocks { data, sizes, block: block.max(last), ready: io::Cursor::default() };
        let payload = Payload { reader, length: Length::Exactly(bytes) };
        payload.samples(dtype, self.endian, count).map_err(located)
    }

    /// A length in front of an array.
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

/// Blocks compressed one by one with zlib.
struct Blocks<R> {
    data: R,
    /// Compressed bytes of those to come.
    sizes: std::vec::IntoIter<u64>,
    /// The most bytes of one.
    block: u64,
    ready: io::Cursor<Vec<u8>>,
}

impl<R: Read> Read for Blocks<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            let found = self.ready.read(buffer)?;
            if found > 0 || buffer.is_empty() {
                return Ok(found);
            }
            let Some(size) = self.sizes.next() else { return Ok(0) };
            let mut packed = Vec::new();
            (&mut self.data).take(size).read_to_end(&mut packed)?;
            if (packed.len() as u64) < size {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
            let mut bytes = Vec::new();
            ZlibDecoder::new(&packed[..]).take(self.block).read_to_end(&mut bytes)?;
            self.ready = io::Cursor::new(bytes);
        }
    }
}
