//! TIFF stacks: pages as slices.

use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

use quick_xml::events::Event;
use tiff::decoder::ifd::Value;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::{ByteOrder, Tag};
use tiff::{ColorType, TiffError};
use walpha_base::Monitor;

use super::OpenFile;
use super::frames::FrameChoice;
use super::layout::{Encoding, Layout, diagonal, frame};
use crate::error::{format_error, io_error};
use crate::{Coordinates, Dims, Dtype, Endian, LengthUnit, Reason, Volume, VolumeError};

/// The most a compression that TIFF knows expands by: LZW writes up to 4096 bytes for a code of 12
/// bits.
const MOST_EXPANSION: u64 = 2731;
/// SGI's tag for volumes in one page.
const IMAGE_DEPTH: Tag = Tag::Unknown(32997);

/// Reads TIFF and `BigTIFF`: the pages are the slices. Spacing is what `ImageJ` or OME-XML say of it in
/// the description of the first page; resolutions of other programs are those of prints.
///
/// Large stacks that `ImageJ` writes after a single page are read too. Of a stack with several channels or
/// times, `frame` chooses one volume, channels counted first. Colours, palettes and samples of fewer
/// than 8 bits are refused.
pub(crate) fn read(
    file: &OpenFile,
    frame: Option<u64>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let mut pages = Pages::open(file)?;
    let info = StackInfo::of(path, &mut pages.decoder)?;
    let wanted = info.wanted(path, frame)?;
    let alone = !pages.decoder.more_images();
    if alone && info.images.is_some_and(|images| images > 1) {
        let first = pages.page()?;
        let (size, dtype) = (first.size, first.dtype);
        return behind_one_page(file, pages, &info, wanted, size, dtype, monitor);
    }
    pages.skip(wanted.first)?;
    let first = pages.page()?;
    let mut stack = first.samples;
    let mut slices = 1;
    while wanted.count.map_or(pages.decoder.more_images(), |count| slices < count) {
        pages.skip(wanted.step)?;
        pages.reserve(stack.len(), first.dtype)?;
        let page = pages.page()?;
        if (page.size, page.dtype) != (first.size, first.dtype) {
            return Err(format_error(
                path,
                Reason::content(
                    format!(
                        "has {:?} samples of {} in page {}, but {:?} of {} in the first: \
                             slices must be alike",
                        page.size,
                        page.dtype,
                        slices + 1,
                        first.size,
                        first.dtype
                    ),
                    "save them as one stack",
                ),
            ));
        }
        stack.extend(page.samples);
        slices += 1;
        match wanted.count {
            Some(count) => monitor.report(slices, count)?,
            None => monitor.check()?,
        }
    }
    let dims = Dims::new(first.size[0], first.size[1], slices)?;
    info.layout(path, dims, first.dtype, Endian::Little, FrameChoice::ONE)?.volume(stack)
}

/// Reads one page alone, as a slice.
pub(super) fn read_page(path: &Path) -> Result<Page, VolumeError> {
    let file = OpenFile::open(path)?;
    let mut pages = Pages::open(&file)?;
    let page = pages.page()?;
    if pages.decoder.more_images() {
        let reason = Reason::content(
            "holds several pages: it is a stack of its own, and no slice of the folder",
            "name the file itself",
        );
        return Err(format_error(path, reason));
    }
    Ok(page)
}

/// A decoded page.
pub(super) struct Page {
    /// Samples along x and y.
    pub size: [u64; 2],
    pub dtype: Dtype,
    pub samples: Vec<f32>,
}

struct Pages<'a> {
    path: &'a Path,
    decoder: Decoder<BufReader<&'a File>>,
    /// The most bytes all samples can have.
    most: u64,
}

impl<'a> Pages<'a> {
    fn open(file: &'a OpenFile) -> Result<Self, VolumeError> {
        let (path, length) = (file.path(), file.length());
        let most = length.saturating_mul(MOST_EXPANSION);
        // The decoder's own limits are those of photographs; the length of the file is a better one.
        let mut limits = Limits::default();
        limits.decoding_buffer_size = usize::try_from(most).unwrap_or(usize::MAX);
        limits.intermediate_buffer_size = limits.decoding_buffer_size;
        limits.ifd_value_size = usize::try_from(length).unwrap_or(usize::MAX);
        let decoder = Decoder::new(file.reader()?).map_err(damaged(path))?;
        Ok(Self { path, decoder: decoder.with_limits(limits), most })
    }

    /// Goes so many pages on.
    fn skip(&mut self, pages: u64) -> Result<(), VolumeError> {
        for _ in 0..pages {
            if !self.decoder.more_images() {
                let reason = Reason::truncated(
                    "has fewer pages than its description says: it is truncated or damaged",
                );
                return Err(format_error(self.path, reason));
            }
            self.decoder.next_image().map_err(damaged(self.path))?;
        }
        Ok(())
    }

    /// Refuses another page where the file cannot hold so many samples.
    fn reserve(&mut self, samples: usize, dtype: Dtype) -> Result<(), VolumeError> {
        let (x, y) = self.decoder.dimensions().map_err(damaged(self.path))?;
        let samples = u64::from(x) * u64::from(y) + samples as u64;
        if samples > Dims::MAX_SAMPLES || samples.saturating_mul(dtype.size() as u64) > self.most {
            let reason =
                Reason::header(format!("claims more than {samples} samples, which it cannot hold"));
            return Err(format_error(self.path, reason));
        }
        Ok(())
    }

    fn page(&mut self) -> Result<Page, VolumeError> {
        let path = self.path;
        let fail = |reason: Reason| format_error(path, reason);
        let (x, y) = self.decoder.dimensions().map_err(damaged(path))?;
        match self.decoder.colortype().map_err(damaged(path))? {
            ColorType::Gray(8 | 16 | 32 | 64) => {}
            ColorType::Gray(bits) => {
                return Err(fail(Reason::unsupported(
                    format!("has samples of {bits} bits"),
                    "convert it to 8 or 16",
                )));
            }
            other => {
                let what = format!("colours ({other:?}): only gray is read");
                return Err(fail(Reason::NotScalar { what, dims: None }));
            }
        }
        let depth = self.decoder.find_tag_unsigned::<u64>(IMAGE_DEPTH).map_err(damaged(path))?;
        if depth.is_some_and(|depth| depth > 1) {
            return Err(fail(Reason::content(
                "is a volume in one page (ImageDepth)",
                "save its slices as pages",
            )));
        }
        self.reserve(0, Dtype::U8)?;
        let (samples, dtype) = match self.decoder.read_image().map_err(damaged(path))? {
            DecodingResult::U8(v) => (v.into_iter().map(f32::from).collect(), Dtype::U8),
            DecodingResult::I8(v) => (v.into_iter().map(f32::from).collect(), Dtype::I8),
            DecodingResult::U16(v) => (v.into_iter().map(f32::from).collect(), Dtype::U16),
            DecodingResult::I16(v) => (v.into_iter().map(f32::from).collect(), Dtype::I16),
            DecodingResult::U32(v) => (v.into_iter().map(|v| v as f32).collect(), Dtype::U32),
            DecodingResult::I32(v) => (v.into_iter().map(|v| v as f32).collect(), Dtype::I32),
            DecodingResult::U64(v) => (v.into_iter().map(|v| v as f32).collect(), Dtype::U64),
            DecodingResult::I64(v) => (v.into_iter().map(|v| v as f32).collect(), Dtype::I64),
            DecodingResult::F32(v) => (v, Dtype::F32),
            DecodingResult::F64(v) => (v.into_iter().map(|v| v as f32).collect(), Dtype::F64),
            DecodingResult::F16(_) => {
                return Err(fail(Reason::unsupported(
                    "has floats of 16 bits, which are not read",
                    "save 32",
                )));
            }
        };
        let samples: Vec<f32> = samples;
        let size = [x.into(), y.into()];
        if samples.len() as u64 != size[0] * size[1] {
            let found = samples.len();
            return Err(fail(Reason::damaged(format!(
                "has {found} samples in a page of {size:?}: it is damaged"
            ))));
        }
        Ok(Page { size, dtype, samples })
    }
}

/// Reads a stack that `ImageJ` wrote uncompressed after its only page.
fn behind_one_page(
    file: &OpenFile,
    mut pages: Pages,
    info: &StackInfo,
    wanted: PageRange,
    size: [u64; 2],
    dtype: Dtype,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let slices = wanted.count.or(info.images).unwrap_or(1);
    if wanted.step > 1 {
        let reason = Reason::unsupported(
            "interleaves its channels behind one page",
            "save it with a page for each image, or one channel alone",
        );
        return Err(format_error(path, reason));
    }
    let compression: Option<u64> =
        pages.decoder.find_tag_unsigned(Tag::Compression).map_err(damaged(path))?;
    let offsets: Option<Vec<u64>> =
        pages.decoder.find_tag_unsigned_vec(Tag::StripOffsets).map_err(damaged(path))?;
    let (None | Some(1), Some(&offset)) = (compression, offsets.as_ref().and_then(|o| o.first()))
    else {
        return Err(format_error(
            path,
            Reason::header(format!("claims {slices} images, but has one page")),
        ));
    };
    let endian = match pages.decoder.byte_order() {
        ByteOrder::LittleEndian => Endian::Little,
        ByteOrder::BigEndian => Endian::Big,
    };
    let dims = Dims::new(size[0], size[1], slices)?;
    let layout = info.layout(path, dims, dtype, endian, wanted.frames)?;
    // Tags may follow the samples.
    let bytes = layout.bytes().min(file.length().saturating_sub(offset));
    layout.read(path, file.reader_at(offset)?.take(bytes), bytes, monitor)
}

fn damaged(path: &Path) -> impl Fn(TiffError) -> VolumeError {
    move |error| match error {
        TiffError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            format_error(path, Reason::truncated("ends inside its TIFF pages: it is truncated"))
        }
        TiffError::IoError(error) => io_error(path)(error),
        other => format_error(
            path,
            Reason::damaged(format!("is a TIFF file that cannot be read: {other}")),
        ),
    }
}

/// What the first page says of the stack.
#[derive(Debug)]
struct StackInfo {
    spacing: [f64; 3],
    unit: LengthUnit,
    /// Pages, as `ImageJ` counts them.
    images: Option<u64>,
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
struct PageRange {
    first: u64,
    step: u64,
    count: Option<u64>,
    /// Which of the file's volumes it is.
    frames: FrameChoice,
}

impl StackInfo {
    /// Looks at the description of the first page.
    fn of(path: &Path, decoder: &mut Decoder<impl Read + Seek>) -> Result<Self, VolumeError> {
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
        let default_unit =
            if spacing == [1.0; 3] { LengthUnit::Voxel } else { LengthUnit::Unstated };
        Self { spacing, unit: unit.unwrap_or(default_unit), images: count("images"), axes }
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
            let mut info = Self { spacing: [1.0; 3], unit: LengthUnit::Voxel, images: None, axes };
            for (k, axis) in ["X", "Y", "Z"].into_iter().enumerate() {
                let Some(length) = number(&format!("PhysicalSize{axis}"))? else { continue };
                // The schema's default.
                let unit = text(&format!("PhysicalSize{axis}Unit"))?;
                let unit = unit.map_or(LengthUnit::Micrometre, |name| LengthUnit::named(&name));
                if info.unit == LengthUnit::Voxel {
                    info.unit = unit;
                }
                let [from, unit] =
                    [unit, info.unit].map(|unit| Coordinates { unit, ..Coordinates::default() });
                info.spacing[k] = from.to(unit).length(length);
            }
            return Ok(info);
        }
    }

    /// The pages of the volume asked for. Where pages run along one axis only, they are slices,
    /// whatever the program called them: a stack of many channels and one slice is common.
    fn wanted(&self, path: &Path, asked: Option<u64>) -> Result<PageRange, VolumeError> {
        let of = |axis: Axis| {
            let faster = self.axes.iter().take_while(|(other, _)| *other != axis);
            let step = faster.fold(1, |step: u64, (_, size)| step.saturating_mul(*size));
            let size = self.axes.iter().find(|(other, _)| *other == axis).map_or(1, |(_, n)| *n);
            (step, size)
        };
        let ((along, slices), (by_channel, channels), (by_time, times)) =
            (of(Axis::Slice), of(Axis::Channel), of(Axis::Time));
        if self.axes.iter().filter(|(_, size)| *size > 1).count() <= 1 {
            let frames = FrameChoice::choose(path, &[], asked)?;
            return Ok(PageRange { first: 0, step: 1, count: None, frames });
        }
        let frames = FrameChoice::choose(path, &[channels, times], asked)?;
        let (channel, time) = (frames.index % channels.max(1), frames.index / channels.max(1));
        let first =
            (channel.saturating_mul(by_channel)).saturating_add(time.saturating_mul(by_time));
        Ok(PageRange { first, step: along.max(1), count: Some(slices), frames })
    }

    /// The grid of a volume.
    fn layout(
        &self,
        path: &Path,
        dims: Dims,
        dtype: Dtype,
        endian: Endian,
        frames: FrameChoice,
    ) -> Result<Layout, VolumeError> {
        let coordinates = Coordinates { unit: self.unit, ..Coordinates::default() };
        let frame = frame(path, [0.0; 3], diagonal(self.spacing), coordinates)?;
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
