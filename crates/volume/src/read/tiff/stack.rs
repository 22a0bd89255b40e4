//! The statements of programs about a stack in its first page: those of `ImageJ`, OME-XML, SCIFIO and tifffile in the
//! description, and those of `MetaMorph` and Zeiss in their own tags.

use std::path::Path;

use quick_xml::events::Event;
use quick_xml::{Reader, XmlVersion};
use serde_json::Value;
use walpha_base::shown::shown;

use super::directories::{Directories, Table, tag};
use crate::error::format_error;
use crate::read::frames::FrameChoice;
use crate::read::layout::{Encoding, Layout, diagonal, frame, one_unit, unit_named};
use crate::{Coordinates, Dims, Dtype, Endian, LengthUnit, Reason, VolumeError};

/// The statements of the first page about the stack.
#[derive(Debug)]
pub(super) struct StackInfo {
    spacing: [f64; 3],
    origin: [f64; 3],
    unit: LengthUnit,
    /// The number of pages according to `ImageJ`, tifffile or `MetaMorph`. They may follow a single page.
    pub(super) images: Option<u64>,
    /// The axes along which the pages run, fastest first, and the number of positions on each.
    axes: [(Axis, u64); 3],
    /// Whether unrelated images follow.
    others: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Axis {
    Slice,
    Channel,
    Time,
}

/// The pages of one volume: `count` of them, beginning with `first`, each `step` after the one before.
#[derive(Clone, Copy, Debug)]
pub(super) struct PageRange {
    pub first: u64,
    pub step: u64,
    pub count: u64,
    /// The choice of this volume among those of the file.
    pub frames: FrameChoice,
}

/// The number of millimetres in an inch.
const INCH: f64 = 25.4;

impl StackInfo {
    /// A stack whose pages are slices, without further information.
    const PLAIN: Self = Self {
        spacing: [1.0; 3],
        origin: [0.0; 3],
        unit: LengthUnit::Voxel,
        images: None,
        axes: SLICES,
        others: false,
    };

    /// Interprets the first page.
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
        if text.starts_with("SCIFIO=") {
            return Self::of_scifio(path, &text);
        }
        if let Some(table) = directories.table(first, tag::CZ_LSMINFO)? {
            return Self::of_lsm(path, &table);
        }
        let shaped =
            serde_json::from_str(&text).ok().filter(|about: &Value| about["shape"].is_array());
        let info = match shaped {
            Some(about) => Self::of_shape(path, directories, first, &about)?,
            None => Self { images: directories.count(first, tag::UIC2), ..Self::PLAIN },
        };
        if info.has_spacing() {
            return Ok(info);
        }
        if directories.count(first, tag::UIC2).is_some() {
            tracing::warn!(
                "{}: MetaMorph's distances of slices (UIC tags) are passed over",
                shown(path)
            );
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
        Ok(info)
    }

    /// Whether the spacing of samples is known.
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
        let slices = real("spacing").filter(|&length| length != 0.0).map_or(1.0, f64::abs);
        let unit = value("unit");
        let units = [unit, value("yunit").or(unit), value("zunit").or(unit)];
        let (spacing, unit) = calibration(path, directories, first, units, slices)?;
        // The positions of the origin are in pixels.
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

    /// Interprets a description of SCIFIO by its lists of axes, fastest first.
    fn of_scifio(path: &Path, text: &str) -> Result<Self, VolumeError> {
        let list = |key: &str| -> Vec<&str> {
            let line = text.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix('='));
            line.map(|line| line.split(',').map(str::trim).collect()).unwrap_or_default()
        };
        let (names, lengths) = (list("axes"), list("lengths"));
        let sizes: Vec<u64> = lengths.iter().filter_map(|length| length.parse().ok()).collect();
        if names.is_empty() {
            return Ok(Self::PLAIN);
        }
        let ["X", "Y", pages @ ..] = names.as_slice() else {
            return Err(unlike_pages(path, &names.join(",")));
        };
        if sizes.len() != names.len() {
            let what = "states as many lengths as axes neither in number nor as numbers (SCIFIO)";
            return Err(format_error(path, Reason::header(what)));
        }
        let pages = pages.iter().copied().zip(sizes[2..].iter().copied());
        let axes = axes_of(pages).ok_or_else(|| unlike_pages(path, &names.join(",")))?;
        let place = |axis: &str| names.iter().position(|name| *name == axis);
        let (scales, units) = (list("scales"), list("units"));
        let along = ["X", "Y", "Z"].map(|axis| {
            let place = place(axis)?;
            let scale = scales.get(place).and_then(|scale| scale.parse::<f64>().ok());
            Some((scale?, units.get(place).filter(|unit| **unit != "null").copied()))
        });
        let spacing = along.map(|axis| axis.map_or(1.0, |(scale, _)| scale.abs()));
        let units = along.map(|axis| axis.and_then(|(_, unit)| unit));
        let images =
            Some(sizes[2..].iter().fold(1, |product: u64, size| product.saturating_mul(*size)));
        if spacing == [1.0; 3] && units == [None; 3] {
            return Ok(Self { images, axes, ..Self::PLAIN });
        }
        let (unit, factors) =
            one_unit(path, units.map(|unit| unit.map(|name| unit_named(path, name))))?;
        let spacing = [0, 1, 2].map(|k| spacing[k] * factors[k]);
        Ok(Self { spacing, unit, images, axes, ..Self::PLAIN })
    }

    /// Interprets the shape in tifffile's description, slowest axis first, and the names of axes, if there are any.
    fn of_shape(
        path: &Path,
        directories: &Directories,
        first: usize,
        about: &Value,
    ) -> Result<Self, VolumeError> {
        let shape: Vec<u64> =
            about["shape"].as_array().into_iter().flatten().filter_map(Value::as_u64).collect();
        let names = about["axes"].as_str().unwrap_or_default();
        let letters: Vec<String> = match names {
            "" => vec![String::new(); shape.len()],
            _ => names.chars().map(String::from).collect(),
        };
        let fits = letters.len() == shape.len() && (names.is_empty() || names.ends_with("YX"));
        let beyond = shape.len().checked_sub(2).filter(|_| fits);
        let pages = beyond.map(|beyond| (0..beyond).rev().map(|k| (letters[k].as_str(), shape[k])));
        let axes = pages.and_then(axes_of).ok_or_else(|| unlike_pages(path, names))?;
        let images = axes.iter().fold(1, |product: u64, (_, size)| product.saturating_mul(*size));
        // Arrays of one page each are slices that were written one by one.
        let info = Self { axes, images: Some(images), others: images > 1, ..Self::PLAIN };
        let (slices, unit) = (about["spacing"].as_f64(), about["unit"].as_str());
        if slices.is_none() && unit.is_none() {
            return Ok(info);
        }
        if unit.is_some() && matches!(directories.number(first, tag::RESOLUTION_UNIT)?, Some(2 | 3))
        {
            tracing::warn!(
                "{}: its resolution is taken to be pixels per {}, the unit of its description, and not per inch or centimetre",
                shown(path),
                unit.unwrap_or_default()
            );
        }
        let slices = slices.filter(|&length| length != 0.0).map_or(1.0, f64::abs);
        let (spacing, unit) = calibration(path, directories, first, [unit; 3], slices)?;
        Ok(Self { spacing, unit, ..info })
    }

    /// Interprets the table of Zeiss' LSM format, in which lengths are in metres.
    fn of_lsm(path: &Path, table: &Table) -> Result<Self, VolumeError> {
        let damaged =
            || format_error(path, Reason::damaged("has a table CZ_LSMINFO that is too short"));
        let size = |place| table.number(place, 4).ok_or_else(damaged);
        let scan = table.number(88, 2).ok_or_else(damaged)?;
        // These scan types consist of planes of x and y: a stack, times of a plane, and times of a stack.
        if !matches!(scan, 0 | 3 | 6) {
            let what =
                format!("is an LSM file of scan type {scan}: only planes of x and y are read");
            return Err(format_error(path, Reason::unsupported(what, "export its planes")));
        }
        let axes = [(Axis::Slice, size(16)?), (Axis::Channel, 1), (Axis::Time, size(24)?)];
        let to = |unit| Coordinates { unit, ..Coordinates::default() };
        let unit = LengthUnit::Micrometre;
        let micrometres = to(LengthUnit::Metre).to(to(unit));
        let mut spacing = [1.0; 3];
        for (k, length) in spacing.iter_mut().enumerate() {
            *length = micrometres.length(table.double(40 + 8 * k).ok_or_else(damaged)?);
        }
        // A single plane has no distance to the next.
        if spacing[2] == 0.0 && axes[0].1 <= 1 {
            spacing[2] = spacing[0];
        }
        Ok(Self { spacing, unit, axes, ..Self::PLAIN })
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
                "BinaryOnly" => {
                    let file = text("MetadataFile")?.unwrap_or_default();
                    let what = format!(
                        "has no OME-XML of its own, but names the file that has it (BinaryOnly): {file:?}"
                    );
                    let advice = "save it as one OME-TIFF file with its own metadata";
                    return Err(format_error(path, Reason::unsupported(what, advice)));
                }
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

    /// Interprets an element Pixels.
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
            // This is the schema's default.
            let unit = text(&format!("PhysicalSize{axis}Unit"))?;
            units[k] = Some(unit.map_or(LengthUnit::Micrometre, |name| unit_named(path, &name)));
        }
        if units == [None; 3] {
            return Ok(Self { axes, ..Self::PLAIN });
        }
        let (unit, factors) = one_unit(path, units)?;
        let missing = (0..3).filter(|&k| units[k].is_none() && (k < 2 || sizes[0] > 1));
        for axis in missing.map(|k| ["X", "Y", "Z"][k]) {
            tracing::warn!(
                "{}: no PhysicalSize{axis} is stated: it is taken to be 1 {}",
                shown(path),
                unit.symbol()
            );
        }
        let spacing = [0, 1, 2].map(|k| spacing[k] * factors[k]);
        Ok(Self { spacing, unit, axes, ..Self::PLAIN })
    }

    /// The page of a slice in a channel at a time.
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

    /// The number of pages of all volumes, according to the description.
    fn stated(&self) -> u64 {
        let of_axes =
            self.axes.iter().fold(1u64, |product, (_, size)| product.saturating_mul(*size));
        self.images.unwrap_or(1).max(of_axes)
    }

    /// The pages of the requested volume, of `pages` in all. If pages run along one axis only, they are slices, whatever the
    /// program called them: a stack of many channels with one slice is common.
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

    /// The layout of a volume.
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

/// The spacing and its unit according to the resolution of pixels and a distance of slices. The resolution is in the unit of x
/// that the description names, or else in that of its tag.
fn calibration(
    path: &Path,
    directories: &Directories,
    first: usize,
    [x, y, z]: [Option<&str>; 3],
    slices: f64,
) -> Result<([f64; 3], LengthUnit), VolumeError> {
    // The resolution in pixels per unit.
    let along = |tag| {
        Ok::<f64, VolumeError>(directories.ratio(first, tag)?.map_or(1.0, |pixels| 1.0 / pixels))
    };
    let mut spacing = [along(tag::X_RESOLUTION)?, along(tag::Y_RESOLUTION)?, slices];
    let by_tag = match directories.number(first, tag::RESOLUTION_UNIT)? {
        Some(2) => Some("inch"),
        Some(3) => Some("cm"),
        _ => None,
    };
    let units = [x, y, z].map(|unit| match unit.or(by_tag) {
        Some("inch" | "inches") => (LengthUnit::Millimetre, INCH),
        Some(name) => (unit_named(path, name), 1.0),
        None if spacing == [1.0; 3] => (LengthUnit::Voxel, 1.0),
        None => (LengthUnit::Unstated, 1.0),
    });
    let (unit, factors) = one_unit(path, units.map(|(unit, _)| Some(unit)))?;
    for ((length, (_, size)), factor) in spacing.iter_mut().zip(units).zip(factors) {
        *length *= size * factor;
    }
    Ok((spacing, unit))
}

/// The axes of a stack whose pages are slices.
const SLICES: [(Axis, u64); 3] = [(Axis::Slice, 1), (Axis::Channel, 1), (Axis::Time, 1)];

/// The slices, channels and times of axes with these names, fastest first. Axes of one page are left out. An axis with another
/// name becomes that of slices or, if this is taken, of times or channels. `None` if all are taken, or two axes have the same
/// meaning.
fn axes_of<'a>(named: impl Iterator<Item = (&'a str, u64)>) -> Option<[(Axis, u64); 3]> {
    let known = |name: &str| match name {
        "Z" => Some(Axis::Slice),
        "C" | "Channel" => Some(Axis::Channel),
        "T" | "Time" => Some(Axis::Time),
        _ => None,
    };
    let mut axes: Vec<(Option<Axis>, u64)> =
        named.filter(|(_, size)| *size != 1).map(|(name, size)| (known(name), size)).collect();
    for place in [Axis::Slice, Axis::Time, Axis::Channel] {
        let count = axes.iter().filter(|(axis, _)| *axis == Some(place)).count();
        match (count, axes.iter_mut().find(|(axis, _)| axis.is_none())) {
            (0, Some((free, _))) => *free = Some(place),
            (0, None) => axes.push((Some(place), 1)),
            (1, _) => {}
            _ => return None,
        }
    }
    let axes: Option<Vec<_>> = axes.into_iter().map(|(axis, size)| Some((axis?, size))).collect();
    axes?.try_into().ok()
}

/// The error for axes that cannot be those of pages.
fn unlike_pages(path: &Path, names: &str) -> VolumeError {
    let what = format!(
        "has the axes {names:?} by its description: pages of x and y are read, along slices, channels and times"
    );
    format_error(path, Reason::unsupported(what, "save it in that order"))
}

/// The numbers of slices, channels and times, in the order that OME names, such as XYZCT.
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
