use std::io::{Read, Seek};
use std::path::Path;

use quick_xml::events::Event;
use tiff::decoder::{Decoder, ifd::Value};
use tiff::tags::Tag;

use crate::read::described::{Described, Encoding, diagonal, frame};
use crate::read::format_error;
use crate::read::frames::Frames;
use crate::{Coordinates, Dims, Dtype, Endian, LengthUnit, Reason, VolumeError};

/// What the first page says of the stack.
#[derive(Debug)]
pub(super) struct About {
    spacing: [f64; 3],
    unit: LengthUnit,
    /// Pages, as `ImageJ` counts them.
    pub images: Option<u64>,
    /// What the pages run along, fastest first, and how many there are of each.
    axes: [(Axis, u64); 3],
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Axis {
    Slice,
    Channel,
    Time,
}

/// The pages of one volume: so many from `first` on, each `step` after the one before; without a
/// count all there are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub first: u64,
    pub step: u64,
    pub count: Option<u64>,
    /// Which of the file's volumes it is.
    pub frames: Frames,
}

impl About {
    /// Looks at the description of the first page.
    pub(super) fn of(
        path: &Path,
        decoder: &mut Decoder<impl Read + Seek>,
    ) -> Result<Self, VolumeError> {
        let text = match decoder.find_tag(Tag::ImageDescription) {
            Ok(Some(Value::Ascii(text))) => text,
            _ => String::new(),
        };
        if text.starts_with("ImageJ=") {
            return Ok(Self::of_imagej(decoder, &text));
        }
        if text.contains("<OME") {
            return Self::of_ome(path, &text);
        }
        Ok(Self { spacing: [1.0; 3], unit: LengthUnit::Voxel, images: None, axes: SLICES })
    }

    fn of_imagej(decoder: &mut Decoder<impl Read + Seek>, text: &str) -> Self {
        let value =
            |key: &str| text.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix('='));
        let count = |key: &str| value(key).and_then(|text| text.trim().parse::<u64>().ok());
        let axes = [(Axis::Channel, "channels"), (Axis::Slice, "slices"), (Axis::Time, "frames")];
        let axes = axes.map(|(axis, key)| (axis, count(key).unwrap_or(1)));
        // Pixels a unit.
        let mut along = |tag| match decoder.find_tag(tag) {
            Ok(Some(Value::Rational(n, d))) if n > 0 && d > 0 => f64::from(d) / f64::from(n),
            _ => 1.0,
        };
        let slices = value("spacing").and_then(|text| text.trim().parse().ok());
        let spacing = [along(Tag::XResolution), along(Tag::YResolution), slices.unwrap_or(1.0)];
        let unit = value("unit").map(LengthUnit::named);
        let silent = if spacing == [1.0; 3] { LengthUnit::Voxel } else { LengthUnit::Unstated };
        Self { spacing, unit: unit.unwrap_or(silent), images: count("images"), axes }
    }

    fn of_ome(path: &Path, text: &str) -> Result<Self, VolumeError> {
        let damaged = |what: &dyn std::fmt::Display| {
            format_error(path, Reason::damaged(format!("has OME-XML that cannot be read: {what}")))
        };
        let mut reader = quick_xml::Reader::from_str(text);
        loop {
            let pixels = match reader.read_event().map_err(|error| damaged(&error))? {
                Event::Start(start) | Event::Empty(start)
                    if start.local_name().as_ref() == "Pixels" =>
                {
                    start
                }
                Event::Eof => return Err(damaged(&"it has no element Pixels")),
                _ => continue,
            };
            let number = |name: &str| -> Result<Option<f64>, VolumeError> {
                let attribute = pixels.try_get_attribute(name).map_err(|error| damaged(&error))?;
                let Some(attribute) = attribute else { return Ok(None) };
                let text = &attribute.value;
                let number =
                    text.trim().parse().map_err(|_| damaged(&format!("{name}={text:?}")))?;
                Ok(Some(number))
            };
            let size = |name| number(name).map(|size| size.unwrap_or(1.0) as u64);
            let sizes = [size("SizeZ")?, size("SizeC")?, size("SizeT")?];
            let text = |name: &str| -> Result<Option<String>, VolumeError> {
                let attribute = pixels.try_get_attribute(name).map_err(|error| damaged(&error))?;
                Ok(attribute.map(|attribute| attribute.value.to_string()))
            };
            let order = text("DimensionOrder")?.unwrap_or_else(|| "XYZCT".into());
            let axes = ordered(&order, sizes).ok_or_else(|| damaged(&format!("order {order}")))?;
            let mut about = Self { spacing: [1.0; 3], unit: LengthUnit::Voxel, images: None, axes };
            for (k, axis) in ["X", "Y", "Z"].into_iter().enumerate() {
                let Some(length) = number(&format!("PhysicalSize{axis}"))? else { continue };
                // The schema's default.
                let unit = text(&format!("PhysicalSize{axis}Unit"))?;
                let unit = unit.map_or(LengthUnit::Micrometre, |name| LengthUnit::named(&name));
                if about.unit == LengthUnit::Voxel {
                    about.unit = unit;
                }
                let [from, unit] =
                    [unit, about.unit].map(|unit| Coordinates { unit, ..Coordinates::default() });
                about.spacing[k] = from.to(unit).length(length);
            }
            return Ok(about);
        }
    }

    /// The pages of the volume asked for. Where pages run along one axis only, they are slices,
    /// whatever the program called them: a stack of many channels and one slice is common.
    pub(super) fn wanted(&self, path: &Path, asked: Option<u64>) -> Result<Wanted, VolumeError> {
        let of = |axis: Axis| {
            let faster = self.axes.iter().take_while(|(other, _)| *other != axis);
            let step = faster.fold(1, |step: u64, (_, size)| step.saturating_mul(*size));
            let size = self.axes.iter().find(|(other, _)| *other == axis).map_or(1, |(_, n)| *n);
            (step, size)
        };
        let ((along, slices), (by_channel, channels), (by_time, times)) =
            (of(Axis::Slice), of(Axis::Channel), of(Axis::Time));
        if self.axes.iter().filter(|(_, size)| *size > 1).count() <= 1 {
            let frames = Frames::choose(path, &[], asked)?;
            return Ok(Wanted { first: 0, step: 1, count: None, frames });
        }
        let frames = Frames::choose(path, &[channels, times], asked)?;
        let (channel, time) = (frames.index % channels.max(1), frames.index / channels.max(1));
        let first =
            (channel.saturating_mul(by_channel)).saturating_add(time.saturating_mul(by_time));
        Ok(Wanted { first, step: along.max(1), count: Some(slices), frames })
    }

    /// The grid of a volume.
    pub(super) fn described(
        &self,
        path: &Path,
        dims: Dims,
        dtype: Dtype,
        endian: Endian,
        frames: Frames,
    ) -> Result<Described, VolumeError> {
        let coordinates = Coordinates { unit: self.unit, ..Coordinates::default() };
        let frame = frame(path, [0.0; 3], diagonal(self.spacing), coordinates)?;
        let encoding = Encoding::Raw;
        Ok(Described { dims, dtype, endian, frame, encoding, frames })
    }
}

/// Pages that are slices.
const SLICES: [(Axis, u64); 3] = [(Axis::Slice, 1), (Axis::Channel, 1), (Axis::Time, 1)];

/// Numbers of slices, channels and times, in the order that OME names, as in XYZCT.
fn ordered(order: &str, [z, c, t]: [u64; 3]) -> Option<[(Axis, u64); 3]> {
    let axis = |letter| match letter {
        'Z' => Some((Axis::Slice, z)),
        'C' => Some((Axis::Channel, c)),
        'T' => Some((Axis::Time, t)),
        _ => None,
    };
    let axes: Option<Vec<_>> = order.strip_prefix("XY")?.chars().map(axis).collect();
    axes?.try_into().ok()
}
