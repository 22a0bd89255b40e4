//! What `ImageJ` and OME-XML say of a stack in the description of its first page.

use std::path::Path;

use quick_xml::events::Event;
use quick_xml::{Reader, XmlVersion};
use walpha_base::shown::shown;

use super::directories::{Directories, tag};
use crate::error::format_error;
use crate::read::frames::FrameChoice;
use crate::read::layout::{Encoding, Layout, diagonal, frame, one_unit, unit_named};
use crate::{Coordinates, Dims, Dtype, Endian, LengthUnit, Reason, VolumeError};

/// What the first page says of the stack.
#[derive(Debug)]
pub(super) struct StackInfo {
    spacing: [f64; 3],
    origin: [f64; 3],
    unit: LengthUnit,
    /// Pages, as `ImageJ` counts them.
    pub(super) images: Option<u64>,
    /// What the pages run along, fastest first, and how many there are of each.
    axes: [(Axis, u64); 3],
    /// Whether other images follow that have nothing to do with this one.
    others: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Axis {
    Slice,
    Channel,
    Time,
}

/// The pages of one volume: `count` from `first` on, each `step` after the one before.
#[derive(Clone, Copy, Debug)]
pub(super) struct PageRange {
    pub first: u64,
    pub step: u64,
    pub count: u64,
    /// Which of the file's volumes it is.
    pub frames: FrameChoice,
}

/// Millimetres of an inch.
const INCH: f64 = 25.4;

impl StackInfo {
    /// Pages that are slices, of which nothing is known.
    const PLAIN: Self = Self {
        spacing: [1.0; 3],
        origin: [0.0; 3],
        unit: LengthUnit::Voxel,
        images: None,
        axes: SLICES,
        others: false,
    };

    /// Looks at the description of the first page.
    pub(super) fn of(
        path: &Path,
        directories: &Directories,
        first: usize,
    ) -> Result<Self, VolumeError> {
        let text = directories.text(first, tag::IMAGE_DESCRIPTION)?.unwrap_or_default();
        if text.starts_with("ImageJ=") {
            return Self::of_imagej(path, directories, first, &text);
        }
        if text.contains("<OME") {
            return Self::of_ome(path, &text);
        }
        let [x, y] =
            [tag::X_RESOLUTION, tag::Y_RESOLUTION].map(|tag| directories.ratio(first, tag));
        let unit = match directories.number(first, tag::RESOLUTION_UNIT)?.unwrap_or(2) {
            2 => "inch",
            3 => "centimetre",
            _ => "unit",
        };
        if let (Some(x), Some(y)) = (x?, y?)
            && (unit != "unit" || x != y)
        {
            tracing::warn!(
                "{}: its resolution of {x} by {y} pixels per {unit} is passed over: it says nothing of slices, \
                 and may be that of a print",
                shown(path)
            );
        }
        Ok(Self::PLAIN)
    }

    /// Whether anything is said of where samples lie.
    pub(super) fn has_spacing(&self) -> bool {
        self.unit != LengthUnit::Voxel
    }

    fn of_imagej(
        path: &Path,
        directories: &Directories,
        first: usize,
        text: &str,
    ) -> Result<Self, VolumeError> {
        let value = |key: &str| {
            text.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix('=')).map(str::trim)
        };
        let count = |key: &str| value(key).and_then(|text| text.parse::<u64>().ok());
        let real = |key: &str| value(key).and_then(|text| text.parse::<f64>().ok());
        let axes = [(Axis::Channel, "channels"), (Axis::Slice, "slices"), (Axis::Time, "frames")];
        let axes = axes.map(|(axis, key)| (axis, count(key).unwrap_or(1)));
        // Pixels a unit.
        let along = |tag| {
            Ok::<f64, VolumeError>(
                directories.ratio(first, tag)?.map_or(1.0, |pixels| 1.0 / pixels),
            )
        };
        let slices = real("spacing").filter(|&length| length != 0.0).map_or(1.0, f64::abs);
        let mut spacing = [along(tag::X_RESOLUTION)?, along(tag::Y_RESOLUTION)?, slices];
        let by_tag = match directories.number(first, tag::RESOLUTION_UNIT)? {
            Some(2) => Some("inch"),
            Some(3) => Some("cm"),
            _ => None,
        };
        let unit = value("unit").or(by_tag);
        let units =
            [unit, value("yunit").or(unit), value("zunit").or(unit)].map(|name| match name {
                Some("inch" | "inches") => (LengthUnit::Millimetre, INCH),
                Some(name) => (unit_named(path, name), 1.0),
                None if spacing == [1.0; 3] => (LengthUnit::Voxel, 1.0),
                None => (LengthUnit::Unstated, 1.0),
            });
        let (unit, factors) = one_unit(path, units.map(|(unit, _)| Some(unit)))?;
        for ((length, (_, size)), factor) in spacing.iter_mut().zip(units).zip(factors) {
            *length *= size * factor;
        }
        // Places of the origin are counted in pixels.
        let places =
            ["xorigin", "yorigin", "zorigin"].map(|key| real(key).filter(|&place| place != 0.0));
        let origin = [0, 1, 2].map(|k| places[k].map_or(0.0, |place| -place * spacing[k]));
        if real("c1").is_some_and(|slope| slope != 1.0)
            || real("c0").is_some_and(|at_0| at_0 != 0.0)
        {
            tracing::warn!(
                "{}: ImageJ's calibration of values is passed over: they are as stored",
                shown(path)
            );
        }
        Ok(Self { spacing, origin, unit, images: count("images"), axes, others: false })
    }

    fn of_ome(path: &Path, text: &str) -> Result<Self, VolumeError> {
        let damaged = |what: &dyn std::fmt::Display| {
            format_error(path, Reason::damaged(format!("has OME-XML that cannot be read: {what}")))
        };
        let mut reader = Reader::from_str(text);
        let mut info: Option<Self> = None;
        let mut files: Vec<String> = Vec::new();
        let mut is_in_order = true;
        loop {
            let event = reader.read_event().map_err(|error| damaged(&error))?;
            let element = match &event {
                Event::Start(start) | Event::Empty(start) => start,
                Event::Eof => break,
                _ => continue,
            };
            let text = |name: &str| -> Result<Option<String>, VolumeError> {
                let attribute = element.try_get_attribute(name).map_err(|error| damaged(&error))?;
                let Some(attribute) = attribute else { return Ok(None) };
                let value = attribute.normalized_value(XmlVersion::Implicit1_0);
                Ok(Some(value.map_err(|error| damaged(&error))?.into_owned()))
            };
            let number = |name: &str| -> Result<Option<f64>, VolumeError> {
                let Some(text) = text(name)? else { return Ok(None) };
                let number = text.trim().parse();
                number.map(Some).map_err(|_| damaged(&format!("{name}={text:?}")))
            };
            match element.local_name().as_ref() {
                "Pixels" => match &mut info {
                    Some(info) => info.others = true,
                    None => info = Some(Self::of_pixels(path, &text, &number, &damaged)?),
                },
                "UUID" => files.extend(text("FileName")?.filter(|name| !files.contains(name))),
                "TiffData" => {
                    if let (Some(info), Some(page)) = (&info, number("IFD")?) {
                        let [z, c, t] = ["FirstZ", "FirstC", "FirstT"].map(&number);
                        let first = [z?, c?, t?].map(|first| first.unwrap_or(0.0) as u64);
                        is_in_order &= info.others || info.page_of(first) as f64 == page;
                    }
                }
                _ => {}
            }
        }
        if files.len() > 1 {
            let what = format!("is one of the {} files of a volume, by its OME-XML", files.len());
            return Err(format_error(path, Reason::unsupported(what, "save it as one file")));
        }
        if !is_in_order {
            let what = "has its pages in another order than its OME-XML names (DimensionOrder)";
            let reason = Reason::unsupported(what, "save it anew, in that order");
            return Err(format_error(path, reason));
        }
        info.ok_or_else(|| damaged(&"it has no element Pixels"))
    }

    /// What an element Pixels says.
    fn of_pixels(
        path: &Path,
        text: &dyn Fn(&str) -> Result<Option<String>, VolumeError>,
        number: &dyn Fn(&str) -> Result<Option<f64>, VolumeError>,
        damaged: &dyn Fn(&dyn std::fmt::Display) -> VolumeError,
    ) -> Result<Self, VolumeError> {
        let size = |name| number(name).map(|size| size.unwrap_or(1.0) as u64);
        let sizes = [size("SizeZ")?, size("SizeC")?, size("SizeT")?];
        let order = text("DimensionOrder")?.unwrap_or_else(|| "XYZCT".into());
        let axes = ordered(&order, sizes).ok_or_else(|| damaged(&format!("order {order}")))?;
        let (mut spacing, mut units) = ([1.0; 3], [None; 3]);
        for (k, axis) in ["X", "Y", "Z"].into_iter().enumerate() {
            let Some(length) = number(&format!("PhysicalSize{axis}"))? else { continue };
            spacing[k] = length;
            // The schema's default.
            let unit = text(&format!("PhysicalSize{axis}Unit"))?;
            units[k] = Some(unit.map_or(LengthUnit::Micrometre, |name| unit_named(path, &name)));
        }
        if units == [None; 3] {
            return Ok(Self { axes, ..Self::PLAIN });
        }
        let (unit, factors) = one_unit(path, units)?;
        let spacing = [0, 1, 2].map(|k| spacing[k] * factors[k]);
        Ok(Self { spacing, unit, axes, ..Self::PLAIN })
    }

    /// The page of a slice of a channel at a time.
    fn page_of(&self, [z, c, t]: [u64; 3]) -> u64 {
        let mut step = 1u64;
        let mut page = 0u64;
        for (axis, size) in self.axes {
            let index = match axis {
                Axis::Slice => z,
                Axis::Channel => c,
                Axis::Time => t,
            };
            page = page.saturating_add(index.saturating_mul(step));
            step = step.saturating_mul(size);
        }
        page
    }

    /// Pages of all volumes, as the description counts them.
    fn stated(&self) -> u64 {
        let of_axes =
            self.axes.iter().fold(1u64, |product, (_, size)| product.saturating_mul(*size));
        self.images.unwrap_or(1).max(of_axes)
    }

    /// The pages of the volume asked for, of `pages` there are. Where pages run along one axis only, they are
    /// slices, whatever the program called them: a stack of many channels and one slice is common.
    pub(super) fn wanted(
        &self,
        path: &Path,
        pages: u64,
        asked: Option<u64>,
    ) -> Result<PageRange, VolumeError> {
        let of = |axis: Axis| {
            let faster = self.axes.iter().take_while(|(other, _)| *other != axis);
            let step = faster.fold(1, |step: u64, (_, size)| step.saturating_mul(*size));
            let size = self.axes.iter().find(|(other, _)| *other == axis).map_or(1, |(_, n)| *n);
            (step, size)
        };
        let ((along, slices), (by_channel, channels), (by_time, times)) =
            (of(Axis::Slice), of(Axis::Channel), of(Axis::Time));
        let stated = self.stated();
        if self.others && stated < pages {
            tracing::warn!("{}: of its images the first is read", shown(path));
        } else if stated > 1 && stated != pages {
            tracing::warn!(
                "{}: has {pages} pages, but its description counts {stated}",
                shown(path)
            );
        }
        let mut long = self.axes.iter().filter(|(_, size)| *size > 1);
        let (longest, several) = (long.next(), long.next().is_some());
        if !several {
            if let Some((axis @ (Axis::Channel | Axis::Time), _)) = longest {
                let named = if *axis == Axis::Time { "times" } else { "channels" };
                tracing::warn!(
                    "{}: its pages are {named} by its description, and read as slices",
                    shown(path)
                );
            }
            let frames = FrameChoice::choose(path, &[], asked)?;
            let count = if self.others { stated.min(pages) } else { pages };
            return Ok(PageRange { first: 0, step: 1, count, frames });
        }
        let frames = FrameChoice::choose(path, &[channels, times], asked)?;
        let (channel, time) = (frames.index % channels.max(1), frames.index / channels.max(1));
        let first =
            (channel.saturating_mul(by_channel)).saturating_add(time.saturating_mul(by_time));
        let last = first.saturating_add(slices.saturating_sub(1).saturating_mul(along));
        if last >= pages {
            let what = "has fewer pages than its description counts: this volume is not whole";
            return Err(format_error(path, Reason::header(what)));
        }
        Ok(PageRange { first, step: along.max(1), count: slices, frames })
    }

    /// The grid of a volume.
    pub(super) fn layout(
        &self,
        path: &Path,
        dims: Dims,
        dtype: Dtype,
        endian: Endian,
        frames: FrameChoice,
    ) -> Result<Layout, VolumeError> {
        let coordinates = Coordinates { unit: self.unit, ..Coordinates::default() };
        let frame = frame(path, self.origin, diagonal(self.spacing), coordinates)?;
        let encoding = Encoding::Raw;
        Ok(Layout { dims, dtype, endian, frame, encoding, frames })
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
