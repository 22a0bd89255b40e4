//! The meaning of the numbers in pixels: how they are stored, which of them are padding, and the values that they represent.

use std::sync::Arc;

use dicom_object::mem::InMemElement;
use dicom_object::{InMemDicomObject, Tag};

use super::claims::{DOUBLE_PIXEL_DATA, FLOAT_PIXEL_DATA};
use super::header::Header;
use crate::rounding::Rounding;
use crate::{Dtype, Reason, VolumeError};

const BITS_ALLOCATED: Tag = Tag(0x0028, 0x0100);
const BITS_STORED: Tag = Tag(0x0028, 0x0101);
const HIGH_BIT: Tag = Tag(0x0028, 0x0102);
const PIXEL_REPRESENTATION: Tag = Tag(0x0028, 0x0103);
const PIXEL_PADDING_VALUE: Tag = Tag(0x0028, 0x0120);
const PIXEL_PADDING_RANGE_LIMIT: Tag = Tag(0x0028, 0x0121);
const FLOAT_PADDING: [Tag; 2] = [Tag(0x0028, 0x0122), Tag(0x0028, 0x0124)];
const DOUBLE_PADDING: [Tag; 2] = [Tag(0x0028, 0x0123), Tag(0x0028, 0x0125)];
const RESCALE_INTERCEPT: Tag = Tag(0x0028, 0x1052);
const RESCALE_SLOPE: Tag = Tag(0x0028, 0x1053);
const MODALITY_LUT_SEQUENCE: Tag = Tag(0x0028, 0x3000);
const LUT_DESCRIPTOR: Tag = Tag(0x0028, 0x3002);
const LUT_DATA: Tag = Tag(0x0028, 0x3006);
const PIXEL_VALUE_TRANSFORMATION: Tag = Tag(0x0028, 0x9145);
/// The scaling of radiation doses (PS3.3, C.8.8.3).
const DOSE_GRID_SCALING: Tag = Tag(0x3004, 0x000E);

/// The coding of stored numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Coding {
    /// One bit; a byte contains eight pixels, the first in its lowest bit.
    Bit,
    /// An integer in `stored` bits, from bit `high` down, of a word of `bytes` bytes.
    Integer {
        bytes: u32,
        stored: u32,
        high: u32,
        signed: bool,
    },
    Float,
    Double,
}

impl Coding {
    /// The coding of the pixels in an element, if the header says how they are stored.
    pub(super) fn of(header: Header<'_>, pixels: Option<Tag>) -> Result<Self, VolumeError> {
        match pixels {
            Some(FLOAT_PIXEL_DATA) => return Ok(Self::Float),
            Some(DOUBLE_PIXEL_DATA) => return Ok(Self::Double),
            _ => {}
        }
        let allocated = header.number_or(BITS_ALLOCATED, 16.0)?;
        let stored = header.number_or(BITS_STORED, allocated)?;
        let high = header.number_or(HIGH_BIT, stored - 1.0)?;
        let signed = header.number_or(PIXEL_REPRESENTATION, 0.0)? == 1.0;
        if allocated == 1.0 {
            return Ok(Self::Bit);
        }
        if ![8.0, 16.0, 32.0].contains(&allocated) {
            let what =
                format!("has pixels of {allocated} bits, and those of 1, 8, 16 and 32 are read");
            let next = "convert it to pixels of 16 bits, or to NRRD";
            return Err(header.fail(Reason::unsupported(what, next)));
        }
        if !(1.0..=allocated).contains(&stored) {
            let what = format!("claims {stored} bits of the {allocated} of a pixel");
            return Err(header.fail(Reason::header(what)));
        }
        if !(stored - 1.0..allocated).contains(&high) {
            let what = format!(
                "claims {stored} bits of the {allocated} of a pixel, and bit {high} as the highest of them"
            );
            return Err(header.fail(Reason::header(what)));
        }
        let [bytes, stored, high] = [allocated / 8.0, stored, high].map(|bits| bits as u32);
        Ok(Self::Integer { bytes, stored, high, signed })
    }

    /// The number of bytes of a number of pixels.
    pub(super) fn bytes(self, pixels: u64) -> u64 {
        match self {
            Self::Bit => pixels.div_ceil(8),
            Self::Integer { bytes, .. } => pixels.saturating_mul(bytes.into()),
            Self::Float => pixels.saturating_mul(4),
            Self::Double => pixels.saturating_mul(8),
        }
    }

    fn is_signed(self) -> bool {
        matches!(self, Self::Integer { signed: true, .. })
    }

    /// The smallest and the largest number that can be stored; `None` for codings with fractions.
    fn range(self) -> Option<(f64, f64)> {
        match self {
            Self::Bit => Some((0.0, 1.0)),
            Self::Integer { stored, signed: false, .. } => {
                Some((0.0, 2f64.powi(stored as i32) - 1.0))
            }
            Self::Integer { stored, .. } => {
                let half = 2f64.powi(stored as i32 - 1);
                Some((-half, half - 1.0))
            }
            Self::Float | Self::Double => None,
        }
    }
}

/// The stored numbers that represent no data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Padding {
    pub low: f64,
    pub high: f64,
    /// Whether the numbers are beyond the range of the stored bits, and are therefore compared with all bits of a pixel.
    whole: bool,
}

impl Padding {
    fn of(header: Header<'_>, coding: Coding) -> Result<Option<Self>, VolumeError> {
        let tags = match coding {
            Coding::Float => FLOAT_PADDING,
            Coding::Double => DOUBLE_PADDING,
            _ => [PIXEL_PADDING_VALUE, PIXEL_PADDING_RANGE_LIMIT],
        };
        let number = |tag| match header.element(None, tag) {
            None => Ok(None),
            // The number has the type of pixels, whatever the file or a dictionary says.
            Some(element) if coding.range().is_some() => match word(element, coding.is_signed()) {
                None if element.value().multiplicity() == 0 => Ok(None),
                None => header.number(None, tag),
                word => Ok(word),
            },
            Some(element) => Ok(element.to_float64().ok()),
        };
        let Some(value) = number(tags[0])? else { return Ok(None) };
        // If there is no limit, it equals the value.
        let limit = number(tags[1])?.unwrap_or(value);
        let (low, high) = (value.min(limit), value.max(limit));
        let whole = coding.range().is_some_and(|(least, most)| low < least || high > most);
        Ok(Some(Self { low, high, whole }))
    }

    /// Whether a pixel is padding; `stored` is its number in the stored bits, `whole` that of all bits.
    fn holds(&self, stored: f64, whole: f64) -> bool {
        let number = if self.whole { whole } else { stored };
        (self.low..=self.high).contains(&number) || number.is_nan() && self.low.is_nan()
    }
}

/// The first 16-bit number in an element, if its type holds such numbers.
fn word(element: &InMemElement, signed: bool) -> Option<f64> {
    words(element, signed)?.first().copied()
}

/// The 16-bit numbers in an element, if its type holds such numbers.
fn words(element: &InMemElement, signed: bool) -> Option<Vec<f64>> {
    if !["US", "SS", "OW", "OB", "UN"].contains(&element.vr().to_string()) {
        return None;
    }
    let bytes = element.value().to_bytes().ok()?;
    let number = |&word: &[u8; 2]| {
        if signed { i16::from_le_bytes(word).into() } else { u16::from_le_bytes(word).into() }
    };
    Some(bytes.as_chunks().0.iter().map(number).collect())
}

/// The mapping from stored numbers to values.
#[derive(Clone, Debug, PartialEq)]
enum Mapping {
    Linear { slope: f64, intercept: f64 },
    Table(Arc<Table>),
}

/// The values of stored numbers from `first` on. Smaller numbers have the first value, larger ones the last.
#[derive(Debug, PartialEq)]
struct Table {
    first: f64,
    entries: Vec<f64>,
}

impl Mapping {
    /// The mapping of a frame: a Modality LUT, or a slope and an intercept.
    fn of(header: Header<'_>, coding: Coding) -> Result<Self, VolumeError> {
        let number = |tag| header.number(PIXEL_VALUE_TRANSFORMATION, tag);
        let (slope, intercept) = (number(RESCALE_SLOPE)?, number(RESCALE_INTERCEPT)?);
        let (slope, intercept) = (slope.unwrap_or(1.0), intercept.unwrap_or(0.0));
        if slope == 0.0 {
            let what = format!("has Rescale Slope {RESCALE_SLOPE} 0, which makes all values equal");
            return Err(header.fail(Reason::header(what)));
        }
        let linear = Self::Linear { slope, intercept };
        let Some([table, ..]) = header.items(PIXEL_VALUE_TRANSFORMATION, MODALITY_LUT_SEQUENCE)
        else {
            return Ok(linear);
        };
        if linear != (Self::Linear { slope: 1.0, intercept: 0.0 }) {
            let what = format!(
                "states a Modality LUT Sequence {MODALITY_LUT_SEQUENCE}, and a Rescale Slope of {slope} with an \
                 Intercept of {intercept} {RESCALE_SLOPE}: only one of them can hold"
            );
            let next = "remove the one that does not hold, as with dcmodify";
            return Err(header.fail(Reason::content(what, next)));
        }
        Ok(Self::Table(Arc::new(Table::of(header, table, coding)?)))
    }

    fn value(&self, stored: f64) -> f64 {
        match self {
            Self::Linear { slope, intercept } => stored * slope + intercept,
            Self::Table(table) => {
                let last = table.entries.len() - 1;
                table.entries[(stored - table.first).clamp(0.0, last as f64) as usize]
            }
        }
    }
}

impl Table {
    fn of(
        header: Header<'_>,
        item: &InMemDicomObject,
        coding: Coding,
    ) -> Result<Self, VolumeError> {
        let wrong =
            |what: String| header.fail(Reason::header(format!("has a Modality LUT {what}")));
        if coding.range().is_none() {
            return Err(wrong("for pixels that are not whole numbers".into()));
        }
        let numbers = |signed| item.get(LUT_DESCRIPTOR).and_then(|of| words(of, signed));
        let (Some(unsigned), Some(own)) = (numbers(false), numbers(coding.is_signed())) else {
            return Err(wrong(format!("without LUT Descriptor {LUT_DESCRIPTOR}")));
        };
        let ([count, _, bits], [_, first, _]) = (&unsigned[..], &own[..]) else {
            let count = unsigned.len();
            return Err(wrong(format!(
                "whose LUT Descriptor {LUT_DESCRIPTOR} has {count} numbers, not 3"
            )));
        };
        // 0 means 2¹⁶, which 16 bits cannot hold.
        let count = if *count == 0.0 { 1 << 16 } else { *count as usize };
        let data = item.get(LUT_DATA);
        let bytes = data.and_then(|data| data.value().to_bytes().ok()).unwrap_or_default();
        // Entries are unsigned (C.11.1.1), except those of a signed type.
        let signed = data.is_some_and(|data| data.vr().to_string() == "SS");
        let entries: Vec<f64> = if bytes.len() >= 2 * count {
            data.and_then(|data| words(data, signed)).unwrap_or_default()
        } else if *bits == 8.0 {
            bytes.iter().map(|&byte| f64::from(byte)).collect()
        } else {
            Vec::new()
        };
        if entries.len() < count {
            return Err(wrong(format!(
                "of {count} entries of {bits} bits, and {} bytes of them in LUT Data {LUT_DATA}",
                bytes.len()
            )));
        }
        Ok(Self { first: *first, entries: entries[..count].to_vec() })
    }
}

/// The meaning of the numbers in the pixels of a frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Values {
    pub coding: Coding,
    pub padding: Option<Padding>,
    mapping: Mapping,
    /// The factor by which values are multiplied in the end.
    factor: f64,
}

impl Values {
    /// The meaning of the pixels of a frame that are stored in this coding.
    pub(super) fn of(header: Header<'_>, coding: Coding) -> Result<Self, VolumeError> {
        let padding = Padding::of(header, coding)?;
        let factor = header.number_or(DOSE_GRID_SCALING, 1.0)?;
        Ok(Self { coding, padding, mapping: Mapping::of(header, coding)?, factor })
    }

    /// Multiplies the values by a factor.
    pub(super) fn times(self, factor: f64) -> Self {
        Self { factor: self.factor * factor, ..self }
    }

    /// The type that holds all possible values if they are whole; otherwise `f32`.
    pub(super) fn dtype(&self) -> Dtype {
        let Some((least, most)) = self.coding.range() else {
            return if self.coding == Coding::Double { Dtype::F64 } else { Dtype::F32 };
        };
        if self.factor != 1.0 {
            return Dtype::F32;
        }
        let fits = |ends: &[f64], among: &[Dtype]| {
            let holds = |dtype: &&Dtype| ends.iter().all(|&end| dtype.holds(end));
            among.iter().find(holds).copied().unwrap_or(Dtype::F32)
        };
        // Bytes are gray levels only if the file stores them as bytes.
        let wide = [Dtype::U16, Dtype::I16, Dtype::U32, Dtype::I32];
        let is_wide = matches!(self.coding, Coding::Integer { bytes: 2.., .. });
        match &self.mapping {
            Mapping::Linear { slope: 1.0, intercept: 0.0 } if !is_wide => {
                fits(&[least, most], &[Dtype::U8, Dtype::I8])
            }
            Mapping::Linear { slope: 1.0, intercept } => {
                fits(&[least + intercept, most + intercept], &wide)
            }
            Mapping::Linear { .. } => Dtype::F32,
            Mapping::Table(table) => fits(&table.entries, &wide),
        }
    }

    /// The values of the pixels of a frame, and which of them are padding, if any is. `bytes` contains all frames, and `first`
    /// pixels precede this one.
    pub(super) fn decode(
        &self,
        bytes: &[u8],
        first: usize,
        count: usize,
        rounding: &Rounding,
    ) -> Option<(Vec<f32>, Option<Vec<bool>>)> {
        let end = first.checked_add(count)?;
        if u64::try_from(bytes.len()).ok()? < self.coding.bytes(end as u64) {
            return None;
        }
        let mut samples = Vec::with_capacity(count);
        let mut padded = Vec::new();
        let mut take = |stored: f64, whole: f64| {
            if self.padding.is_some_and(|padding| padding.holds(stored, whole)) {
                padded.resize(samples.len(), false);
                padded.push(true);
            }
            samples.push(rounding.sample(self.mapping.value(stored) * self.factor));
        };
        match self.coding {
            Coding::Bit => {
                let bit = |i: usize| bytes.get(i / 8).map(|byte| f64::from(byte >> (i % 8) & 1));
                for bit in (first..end).filter_map(bit) {
                    take(bit, bit);
                }
            }
            Coding::Float => {
                let words = bytes.as_chunks().0.get(first..end)?;
                words.iter().map(|&word| f32::from_le_bytes(word).into()).for_each(|v| take(v, v));
            }
            Coding::Double => {
                let words = bytes.as_chunks().0.get(first..end)?;
                words.iter().map(|&word| f64::from_le_bytes(word)).for_each(|v| take(v, v));
            }
            Coding::Integer { bytes: size, stored, high, signed } => {
                let size = size as usize;
                let words = bytes.get(first * size..end * size)?;
                let number = |word: u32, low: u32, bits: u32| {
                    // The shift to the upper end removes the bits above; the shift back extends the sign.
                    let up = word << (32 - bits - low);
                    let down = 32 - bits;
                    if signed { f64::from(up as i32 >> down) } else { f64::from(up >> down) }
                };
                for word in words.chunks_exact(size) {
                    let word = word.iter().rev().fold(0, |all, &byte| all << 8 | u32::from(byte));
                    take(number(word, high + 1 - stored, stored), number(word, 0, 8 * size as u32));
                }
            }
        }
        if !padded.is_empty() {
            padded.resize(samples.len(), false);
        }
        Some((samples, (!padded.is_empty()).then_some(padded)))
    }
}
