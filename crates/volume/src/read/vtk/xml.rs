//! VTK's XML formats: the elements and their attributes.

use std::collections::HashMap;
use std::io::{self, BufRead, Read};

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use walpha_base::Monitor;

use crate::error::{format_error, io_error};
use crate::read::OpenFile;
use crate::{Dtype, Endian, Reason, VolumeError};

/// A file in one of VTK's XML formats (VTK User's Guide, "VTK File Formats"): its elements, and their arrays, which are read on
/// demand. Arrays may be text, base64, or appended raw or in base64, and compressed with zlib or LZ4.
pub struct VtkXml<'a> {
    pub(super) file: &'a OpenFile,
    pub(super) endian: Endian,
    /// The size in bytes of the length that precedes an array.
    pub(super) word: usize,
    /// The compressor of arrays that are not text, or the name of one that is not read.
    pub(super) compressor: Result<Option<Compressor>, String>,
    pub(super) elements: Vec<XmlElement>,
    pub(super) appended: Option<Appended>,
    pub(super) monitor: Monitor,
}

/// An element with its attributes.
#[derive(Debug)]
pub(super) struct XmlElement {
    pub(super) name: String,
    pub(super) parent: Option<usize>,
    pub(super) attributes: HashMap<String, String>,
    /// The position of its text in the file, and the end of that text: at the end of the element or at its first child.
    pub(super) text: u64,
    pub(super) text_end: Option<u64>,
}

/// The mark with which a text in UTF-8 may begin.
const MARK: &[u8] = b"\xef\xbb\xbf";

/// The compression of the blocks of arrays.
#[derive(Clone, Copy, Debug)]
pub(super) enum Compressor {
    Zlib,
    Lz4,
}

/// The position of the appended arrays, and whether they are in base64.
#[derive(Clone, Copy, Debug)]
pub(super) struct Appended {
    pub(super) start: u64,
    pub(super) base64: bool,
}

impl<'a> VtkXml<'a> {
    /// Reads everything except the arrays. The root must be `VTKFile`.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn open(file: &'a OpenFile) -> Result<Self, VolumeError> {
        let path = file.path();
        if !file.is_ordinary() {
            let reason = Reason::unsupported(
                "is not an ordinary file, and VTK's XML is read in several passes",
                "copy it into one",
            );
            return Err(format_error(path, reason));
        }
        let mut this = Self {
            file,
            endian: Endian::Little,
            word: 4,
            compressor: Ok(None),
            elements: Vec::new(),
            appended: None,
            monitor: Monitor::noop(),
        };
        let mut reader = file.reader()?;
        // This comes before the search for the first element, which may go through all of a huge file.
        if !begins_as_xml(reader.fill_buf().map_err(io_error(path))?) {
            return Err(
                this.fail(Reason::other("is not a VTK file: it does not begin with an element"))
            );
        }
        this.scan(reader)?;
        this.root()?;
        Ok(this)
    }

    /// Returns this file with its arrays read under this monitor.
    #[must_use]
    pub fn monitored(self, monitor: &Monitor) -> Self {
        Self { monitor: monitor.clone(), ..self }
    }

    pub(super) fn fail(&self, reason: Reason) -> VolumeError {
        format_error(self.file.path(), reason)
    }

    fn scan(&mut self, mut file: impl BufRead) -> Result<(), VolumeError> {
        // The parser leaves this mark out of its positions.
        let mark = if file.fill_buf().map_err(io_error(self.file.path()))?.starts_with(MARK) {
            file.consume(MARK.len());
            MARK.len() as u64
        } else {
            0
        };
        let mut reader = Reader::from_reader(file);
        let mut buffer = Vec::new();
        let mut open: Vec<usize> = Vec::new();
        loop {
            buffer.clear();
            let before = mark + reader.buffer_position();
            let event = reader.read_event_into(&mut buffer).map_err(|error| match error {
                quick_xml::Error::Io(error) => {
                    io_error(self.file.path())(io::Error::new(error.kind(), error.to_string()))
                }
                other => self.fail(Reason::header(format!(
                    "is not well-formed XML at byte {before}: {other}"
                ))),
            })?;
            match event {
                Event::Start(start) => {
                    self.end_text(open.last(), before);
                    let after = mark + reader.buffer_position();
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
                    let after = mark + reader.buffer_position();
                    let element = self.element(&start, open.last().copied(), after)?;
                    self.elements.push(element);
                }
                Event::End(_) => {
                    let closed = open
                        .pop()
                        .ok_or_else(|| self.fail(Reason::header("closes an element twice")))?;
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
                Err(self.fail(Reason::truncated(format!(
                    "ends inside its element {name}: it is truncated"
                ))))
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
                self.fail(Reason::header(format!(
                    "has an attribute that is not XML before byte {position}: {error}"
                )))
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
                return Err(self.fail(Reason::header(format!(
                    "has appended data in encoding {given}, not raw or base64"
                ))));
            }
        };
        let mut before = Vec::new();
        let mut reader = self.part(element.text, self.file.length())?;
        (&mut reader)
            .take(4096)
            .read_until(b'_', &mut before)
            .map_err(io_error(self.file.path()))?;
        if before.pop() != Some(b'_') || !before.trim_ascii().is_empty() {
            return Err(self.fail(Reason::header("has no underscore before its appended data")));
        }
        Ok(Appended { start: element.text + before.len() as u64 + 1, base64 })
    }

    /// Checks the root, and reads its statements about all arrays.
    fn root(&mut self) -> Result<(), VolumeError> {
        let Some(root) = self.elements.first().filter(|root| root.name == "VTKFile") else {
            return Err(
                self.fail(Reason::other("is not a VTK file: its first element is not VTKFile"))
            );
        };
        let attribute = |name: &str| root.attributes.get(name).map(String::as_str);
        self.endian = match attribute("byte_order") {
            Some("LittleEndian") | None => Endian::Little,
            Some("BigEndian") => Endian::Big,
            Some(other) => {
                return Err(self.fail(Reason::header(format!(
                    "has byte_order {other:?}, which is not a byte order"
                ))));
            }
        };
        self.word = match attribute("header_type") {
            Some("UInt32") | None => 4,
            Some("UInt64") => 8,
            Some(other) => {
                return Err(self.fail(Reason::header(format!(
                    "has header_type {other:?}, not UInt32 or UInt64"
                ))));
            }
        };
        self.compressor = match attribute("compressor") {
            None | Some("") => Ok(None),
            Some("vtkZLibDataCompressor") => Ok(Some(Compressor::Zlib)),
            Some("vtkLZ4DataCompressor") => Ok(Some(Compressor::Lz4)),
            Some(other) => Err(other.to_owned()),
        };
        Ok(())
    }

    /// A reader for a part of the file.
    pub(super) fn part(&self, start: u64, end: u64) -> Result<impl BufRead + use<'a>, VolumeError> {
        Ok(self.file.reader_at(start)?.take(end.saturating_sub(start)))
    }
}

fn begins_as_xml(start: &[u8]) -> bool {
    let start = start.strip_prefix(MARK).unwrap_or(start);
    start.trim_ascii_start().starts_with(b"<")
}

/// Queries of elements and their attributes.
impl VtkXml<'_> {
    /// The type of the dataset, such as `ImageData`.
    pub fn kind(&self) -> &str {
        self.attribute(0, "type").unwrap_or("(nothing)")
    }

    /// An attribute of an element.
    pub fn attribute(&self, element: usize, name: &str) -> Option<&str> {
        self.elements[element].attributes.get(name).map(String::as_str)
    }

    /// A count in an attribute; `None` if it is missing, or not a number.
    pub fn count(&self, element: usize, name: &str) -> Option<u64> {
        self.attribute(element, name)?.trim().parse().ok()
    }

    /// As many numbers as an attribute should have, or the default if it is missing.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn numbers<const N: usize>(
        &self,
        element: usize,
        name: &str,
        default: Option<[f64; N]>,
    ) -> Result<[f64; N], VolumeError> {
        let place = &self.elements[element].name;
        let Some(text) = self.attribute(element, name) else {
            return default.ok_or_else(|| {
                self.fail(Reason::header(format!("its element {place} has no {name}")))
            });
        };
        let numbers: Option<Vec<f64>> =
            text.split_whitespace().map(|number| number.parse().ok()).collect();
        numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| {
            self.fail(Reason::header(format!(
                "its element {place} has {name}={text:?}, which is not {N} numbers"
            )))
        })
    }

    /// The children of an element that have this name.
    pub fn children(&self, parent: usize, name: &str) -> impl Iterator<Item = usize> {
        let is_child = move |i: &usize| {
            self.elements[*i].parent == Some(parent) && self.elements[*i].name == name
        };
        (0..self.elements.len()).filter(is_child)
    }

    /// The dataset and its elements `Piece`.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn pieces(&self) -> Result<(usize, Vec<usize>), VolumeError> {
        let kind = self.kind();
        let dataset = self.children(0, kind).next().ok_or_else(|| {
            self.fail(Reason::header(format!("has no element {kind}, which is its type")))
        })?;
        Ok((dataset, self.children(dataset, "Piece").collect()))
    }

    /// The dataset and its element `Piece`, of which there must be exactly one.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn piece(&self) -> Result<(usize, usize), VolumeError> {
        let (dataset, pieces) = self.pieces()?;
        match pieces[..] {
            [piece] => Ok((dataset, piece)),
            _ => Err(self.fail(Reason::unsupported(
                format!("holds {} pieces: only one is read", pieces.len()),
                "write it in one piece",
            ))),
        }
    }

    /// The type of an array's numbers.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
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
                return Err(self.fail(Reason::unsupported(
                    format!("has an array of type {name}, which is not read"),
                    "convert it first",
                )));
            }
        })
    }

    /// The number of components of an array.
    pub fn components(&self, array: usize) -> &str {
        self.attribute(array, "NumberOfComponents").unwrap_or("1").trim()
    }

    pub(super) fn name(&self, array: usize) -> &str {
        self.attribute(array, "Name").unwrap_or("without a name")
    }
}
