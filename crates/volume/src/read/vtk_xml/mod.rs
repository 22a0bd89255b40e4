mod arrays;
mod query;

use std::collections::HashMap;
use std::io::{self, BufRead, Read};

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use walpha_base::Monitor;

use super::{OpenFile, format_error, io_error};
use crate::{Endian, Reason, VolumeError};

/// A file of VTK's XML formats (VTK User's Guide, "VTK File Formats"): its elements, and the arrays
/// they hold, which are read on demand. Arrays may be text, base64, or appended raw or in base64, and
/// compressed with zlib or LZ4.
pub struct VtkXml<'a> {
    file: &'a OpenFile,
    endian: Endian,
    /// Bytes of a length in front of an array.
    word: usize,
    compressor: Option<Compressor>,
    elements: Vec<XmlElement>,
    appended: Option<Appended>,
    monitor: Monitor,
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

/// How the blocks of arrays are compressed.
#[derive(Clone, Copy, Debug)]
enum Compressor {
    Zlib,
    Lz4,
}

/// Where appended arrays begin, and whether they are in base64.
#[derive(Clone, Copy, Debug)]
struct Appended {
    start: u64,
    base64: bool,
}

impl<'a> VtkXml<'a> {
    /// Reads all but the arrays. The root must be `VTKFile`.
    ///
    /// # Errors
    /// [`VolumeError`]: what cannot be read, and why.
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
            compressor: None,
            elements: Vec::new(),
            appended: None,
            monitor: Monitor::noop(),
        };
        let mut reader = file.reader()?;
        // Before a search for the first element, which may go through all of a huge file.
        if !begins_as_xml(reader.fill_buf().map_err(io_error(path))?) {
            return Err(
                this.said(Reason::other("is no VTK file: it does not begin with an element"))
            );
        }
        this.scan(reader)?;
        this.root()?;
        Ok(this)
    }

    /// The same file, whose arrays are read under this monitor.
    #[must_use]
    pub fn monitored(self, monitor: &Monitor) -> Self {
        Self { monitor: monitor.clone(), ..self }
    }

    fn said(&self, reason: Reason) -> VolumeError {
        format_error(self.file.path(), reason)
    }

    fn scan(&mut self, file: impl BufRead) -> Result<(), VolumeError> {
        let mut reader = Reader::from_reader(file);
        let mut buffer = Vec::new();
        let mut open: Vec<usize> = Vec::new();
        loop {
            buffer.clear();
            let before = reader.buffer_position();
            let event = reader.read_event_into(&mut buffer).map_err(|error| match error {
                quick_xml::Error::Io(error) => {
                    io_error(self.file.path())(io::Error::new(error.kind(), error.to_string()))
                }
                other => self.said(Reason::header(format!(
                    "is not well-formed XML at byte {before}: {other}"
                ))),
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
                    let closed = open
                        .pop()
                        .ok_or_else(|| self.said(Reason::header("closes an element twice")))?;
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
                Err(self.said(Reason::truncated(format!(
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
                self.said(Reason::damaged(format!(
                    "has a damaged attribute before byte {position}: {error}"
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
                return Err(self.said(Reason::header(format!(
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
            return Err(self.said(Reason::damaged(
                "has no underscore before its appended data: it is damaged",
            )));
        }
        Ok(Appended { start: element.text + before.len() as u64 + 1, base64 })
    }

    /// Checks the root, and reads what it says of all arrays.
    fn root(&mut self) -> Result<(), VolumeError> {
        let Some(root) = self.elements.first().filter(|root| root.name == "VTKFile") else {
            return Err(
                self.said(Reason::other("is no VTK file: its first element is not VTKFile"))
            );
        };
        let attribute = |name: &str| root.attributes.get(name).map(String::as_str);
        self.endian = match attribute("byte_order") {
            Some("LittleEndian") | None => Endian::Little,
            Some("BigEndian") => Endian::Big,
            Some(other) => {
                return Err(
                    self.said(Reason::header(format!("has byte_order {other:?}, which is none")))
                );
            }
        };
        self.word = match attribute("header_type") {
            Some("UInt32") | None => 4,
            Some("UInt64") => 8,
            Some(other) => {
                return Err(self.said(Reason::header(format!(
                    "has header_type {other:?}, not UInt32 or UInt64"
                ))));
            }
        };
        self.compressor = match attribute("compressor") {
            None | Some("") => None,
            Some("vtkZLibDataCompressor") => Some(Compressor::Zlib),
            Some("vtkLZ4DataCompressor") => Some(Compressor::Lz4),
            Some(other) => {
                return Err(self.said(Reason::unsupported(
                    format!("is compressed by {other}, which is not read"),
                    "choose LZ4, ZLib or none where it is written",
                )));
            }
        };
        Ok(())
    }

    /// A part of the file.
    fn part(&self, start: u64, end: u64) -> Result<impl BufRead + use<'a>, VolumeError> {
        Ok(self.file.reader_at(start)?.take(end.saturating_sub(start)))
    }
}

fn begins_as_xml(start: &[u8]) -> bool {
    let start = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    start.trim_ascii_start().starts_with(b"<")
}
