//! What a file says of its elements.

use super::VtkXml;
use crate::{Dtype, Reason, VolumeError};

impl VtkXml<'_> {
    /// What the file holds, such as `ImageData`.
    pub fn kind(&self) -> &str {
        self.attribute(0, "type").unwrap_or("(nothing)")
    }

    /// An attribute of an element.
    pub fn attribute(&self, element: usize, name: &str) -> Option<&str> {
        self.elements[element].attributes.get(name).map(String::as_str)
    }

    /// As many numbers as an attribute should have, or the default where it is missing.
    ///
    /// # Errors
    /// [`VolumeError`]: what cannot be read, and why.
    pub fn numbers<const N: usize>(
        &self,
        element: usize,
        name: &str,
        default: Option<[f64; N]>,
    ) -> Result<[f64; N], VolumeError> {
        let place = &self.elements[element].name;
        let Some(text) = self.attribute(element, name) else {
            return default.ok_or_else(|| {
                self.said(Reason::header(format!("its element {place} has no {name}")))
            });
        };
        let numbers: Option<Vec<f64>> =
            text.split_whitespace().map(|number| number.parse().ok()).collect();
        numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| {
            self.said(Reason::header(format!(
                "its element {place} has {name}={text:?}, which is not {N} numbers"
            )))
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
    ///
    /// # Errors
    /// [`VolumeError`]: what cannot be read, and why.
    pub fn piece(&self) -> Result<(usize, usize), VolumeError> {
        let kind = self.kind();
        let dataset = self.children(0, kind).next().ok_or_else(|| {
            self.said(Reason::damaged(format!("has no element {kind}: it is damaged")))
        })?;
        let pieces: Vec<usize> = self.children(dataset, "Piece").collect();
        match pieces[..] {
            [piece] => Ok((dataset, piece)),
            _ => Err(self.said(Reason::unsupported(
                format!("holds {} pieces: only one is read", pieces.len()),
                "write it in one piece",
            ))),
        }
    }

    /// The type of an array's numbers.
    ///
    /// # Errors
    /// [`VolumeError`]: what cannot be read, and why.
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
                return Err(self.said(Reason::unsupported(
                    format!("has an array of type {name}, which is not read"),
                    "convert it first",
                )));
            }
        })
    }

    /// How many numbers an array has for each point or cell.
    pub fn components(&self, array: usize) -> &str {
        self.attribute(array, "NumberOfComponents").unwrap_or("1")
    }

    pub(super) fn name(&self, array: usize) -> &str {
        self.attribute(array, "Name").unwrap_or("without a name")
    }
}
