//! TIFF stacks: pages as slices.

mod directories;
mod stack;

use std::io::Read;
use std::path::Path;

use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::{ByteOrder, Tag};
use tiff::{ColorType, TiffError};
use walpha_base::Monitor;
use walpha_base::memory::afford;
use walpha_base::shown::{counted, shown};

use super::OpenFile;
use super::frames::FrameChoice;
use super::scans::Scans;
use crate::error::{format_error, io_error};
use crate::rounding::Rounding;
use crate::{Dims, Dtype, Endian, Reason, Sample, Volume, VolumeError};
use directories::{AsStored, Directories, Tiles, tag};
use stack::{PageRange, StackInfo};

/// The largest factor by which a compression of TIFF expands data: LZW writes up to 4096 bytes for a code of 12 bits.
const MOST_EXPANSION: u64 = 2731;

/// Reads TIFF and `BigTIFF`. The pages are the slices, except smaller copies of others. Values are as stored, whatever their
/// display. The spacing is that of `ImageJ` or OME-XML in the description of the first page; resolutions of other programs are
/// those of prints.
///
/// Large stacks that `ImageJ` writes after a single page are read, too. If a stack has several channels or times, `frame` chooses
/// one volume, channels counted first. Colours, palettes and samples of fewer than 8 bits are refused.
pub(crate) fn read(
    file: &OpenFile,
    frame: Option<u64>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let mut pages = Pages::open(file)?;
    pages.say_what_is_left_out();
    let mut said = Vec::new();
    for &page in &pages.slices {
        say(path, &pages.remarks(page)?, &mut said);
    }
    pages.check_gray(pages.slices[0])?;
    let info = StackInfo::of(path, &pages.directories, pages.slices[0])?;
    let count = pages.slices.len() as u64;
    if let (Some(images @ 2..), 1) = (info.images, count) {
        let wanted = info.wanted(path, images, frame)?;
        let first = pages.page(0)?;
        let (size, dtype) = (first.size, first.dtype);
        return behind_one_page(file, pages, &info, wanted, size, dtype, monitor);
    }
    let wanted = info.wanted(path, count, frame)?;
    let first = pages.page(wanted.first)?;
    let mut stack = first.samples;
    for slice in 1..wanted.count {
        let place = wanted.first + slice * wanted.step;
        pages.reserve(place, stack.len(), first.dtype)?;
        let page = pages.page(place)?;
        if (page.size, page.dtype) != (first.size, first.dtype) {
            return Err(format_error(
                path,
                Reason::content(
                    format!(
                        "has {:?} samples of {} in page {}, but {:?} of {} in the first: \
                             slices must be alike",
                        page.size,
                        page.dtype,
                        place + 1,
                        first.size,
                        first.dtype
                    ),
                    "save them as one stack",
                ),
            ));
        }
        stack.extend(page.samples);
        monitor.report(slice + 1, wanted.count)?;
    }
    let dims = Dims::new(first.size[0], first.size[1], wanted.count)?;
    info.layout(path, dims, first.dtype, Endian::Little, FrameChoice::ONE)?.volume(stack)
}

/// Reads a single page, as a slice of a folder. For the first slice, warns about skipped pages.
pub(super) fn read_page(path: &Path, is_first: bool) -> Result<Page, VolumeError> {
    let file = OpenFile::open(path)?;
    let mut pages = Pages::open(&file)?;
    if is_first {
        pages.say_what_is_left_out();
        let info = StackInfo::of(path, &pages.directories, pages.slices[0])?;
        if info.has_spacing() {
            tracing::warn!(
                "{}: its spacing is passed over: slices of a folder have none",
                shown(path)
            );
        }
    }
    if pages.slices.len() > 1 {
        let reason = Reason::content(
            "holds several pages: it is a stack of its own, and no slice of the folder",
            "name the file itself",
        );
        return Err(format_error(path, reason));
    }
    pages.page(0)
}

/// A decoded page.
pub(super) struct Page {
    /// The number of samples along x and y.
    pub size: [u64; 2],
    pub dtype: Dtype,
    pub samples: Vec<f32>,
    /// Remarks on statements of the page that are not followed.
    pub remarks: Vec<String>,
}

/// The orientation in which the first row is the top and the first column the left.
const AS_STORED: u64 = 1;

/// The remark on another orientation.
pub(super) fn orientation_remark(orientation: u64) -> Option<String> {
    (orientation != AS_STORED).then(|| {
        format!("Orientation {orientation} is passed over: rows and columns are as stored")
    })
}

/// Reports each remark once.
pub(super) fn say(path: &Path, remarks: &[String], said: &mut Vec<String>) {
    for remark in remarks {
        if !said.contains(remark) {
            tracing::warn!("{}: {remark}", shown(path));
            said.push(remark.clone());
        }
    }
}

struct Pages<'a> {
    path: &'a Path,
    decoder: Decoder<AsStored<'a>>,
    directories: Directories<'a>,
    /// The pages that are slices, and the current page of the decoder.
    slices: Vec<usize>,
    at: usize,
    /// The largest possible size of all samples in bytes.
    most: u64,
    rounding: Rounding,
}

impl<'a> Pages<'a> {
    fn open(file: &'a OpenFile) -> Result<Self, VolumeError> {
        let (path, length) = (file.path(), file.length());
        let most = length.saturating_mul(MOST_EXPANSION);
        // The decoder's own limits are made for photographs; the length of the file is a better limit.
        let mut limits = Limits::default();
        limits.decoding_buffer_size = usize::try_from(most).unwrap_or(usize::MAX);
        limits.intermediate_buffer_size = limits.decoding_buffer_size;
        limits.ifd_value_size = usize::try_from(length).unwrap_or(usize::MAX);
        let directories = Directories::read(file)?;
        let mut slices = Vec::new();
        for page in 0..directories.pages.len() {
            if !directories.is_copy(page)? {
                slices.push(page);
            }
        }
        // All pages claim to be copies, but there is nothing to be copied.
        if slices.is_empty() {
            for page in 0..directories.pages.len() {
                if !directories.is_mask(page)? {
                    slices.push(page);
                }
            }
            tracing::warn!(
                "{}: all its pages claim to be smaller copies of others (NewSubfileType), and are read as slices",
                shown(path)
            );
        }
        if slices.is_empty() {
            let reason = Reason::content("has no page of samples", "name another file");
            return Err(format_error(path, reason));
        }
        let decoder = Decoder::new(directories.as_stored()?).map_err(damaged(path))?;
        let decoder = decoder.with_limits(limits);
        let rounding = Rounding::default();
        Ok(Self { path, decoder, directories, slices, at: 0, most, rounding })
    }

    /// Reports the pages that are not slices.
    fn say_what_is_left_out(&self) {
        let copies = self.directories.pages.len() - self.slices.len();
        if copies > 0 {
            let (path, copies) = (shown(self.path), counted(copies as u64, "page"));
            tracing::warn!("{path}: {copies} passed over: smaller copies or masks of others");
        }
    }

    /// Remarks on statements of a page that are not followed.
    fn remarks(&self, page: usize) -> Result<Vec<String>, VolumeError> {
        let directories = &self.directories;
        let mut remarks = Vec::new();
        if directories.is_white_zero(page)? {
            remarks.push("0 is white (photometric interpretation 0); values are as stored".into());
        }
        let orientation = directories.number(page, tag::ORIENTATION)?.unwrap_or(AS_STORED);
        remarks.extend(orientation_remark(orientation));
        if let Some(value) = directories.text(page, tag::GDAL_NODATA)? {
            remarks.push(format!("the value {value:?} of no data (GDAL) is passed over"));
        }
        let gdal = directories.text(page, tag::GDAL_METADATA)?.unwrap_or_default();
        if ["scale", "offset"].iter().any(|role| gdal.contains(&format!("role=\"{role}\""))) {
            remarks.push(
                "the scale and offset of values that GDAL states are passed over: values are as stored"
                    .into(),
            );
        }
        if directories.number(page, tag::MODEL_PIXEL_SCALE)?.is_some() {
            remarks.push("the place on Earth that GeoTIFF states is passed over".into());
        }
        Ok(remarks)
    }

    /// Moves to a slice, which must not be before the current one.
    fn go_to(&mut self, slice: u64) -> Result<usize, VolumeError> {
        let page = self.slices[slice as usize];
        while self.at < page {
            self.decoder.next_image().map_err(damaged(self.path))?;
            self.at += 1;
        }
        Ok(page)
    }

    /// Refuses another page if the file cannot contain so many samples.
    fn reserve(&mut self, slice: u64, samples: usize, dtype: Dtype) -> Result<(), VolumeError> {
        self.go_to(slice)?;
        let (x, y) = self.decoder.dimensions().map_err(damaged(self.path))?;
        let samples = u64::from(x) * u64::from(y) + samples as u64;
        if samples > Dims::MAX_SAMPLES || samples.saturating_mul(dtype.size() as u64) > self.most {
            let reason =
                Reason::header(format!("claims more than {samples} samples, which it cannot hold"));
            return Err(format_error(self.path, reason));
        }
        Ok(())
    }

    /// Refuses pages whose pixels are not single gray values.
    fn check_gray(&self, page: usize) -> Result<(), VolumeError> {
        let fail = |reason: Reason| Err(format_error(self.path, reason));
        let number = |tag, default| {
            Ok::<u64, VolumeError>(self.directories.number(page, tag)?.unwrap_or(default))
        };
        match number(tag::PHOTOMETRIC, 1)? {
            0 | 1 => {}
            3 => {
                let what =
                    "has a palette of colours (photometric interpretation 3): only gray is read";
                return fail(Reason::unsupported(what, "save it as gray"));
            }
            4 => return fail(Reason::unsupported("is a mask of transparency", "save it as gray")),
            other => {
                let what =
                    format!("colours (photometric interpretation {other}): only gray is read");
                return fail(Reason::NotScalar { what, dims: None });
            }
        }
        let (channels, bits) =
            (number(tag::SAMPLES_PER_PIXEL, 1)?, number(tag::BITS_PER_SAMPLE, 1)?);
        if channels > 1 {
            let what = format!("{channels} values in each pixel");
            return fail(Reason::not_scalar(what, None));
        }
        if number(tag::FILL_ORDER, 1)? == 2 {
            let what = "has the bits of its bytes in reverse (FillOrder 2), which is not read";
            return fail(Reason::unsupported(what, "save it anew"));
        }
        match number(tag::SAMPLE_FORMAT, 1)? {
            1..=3 => {}
            5 | 6 => {
                let what = "holds complex numbers (SampleFormat), which are not read";
                return fail(Reason::unsupported(what, "save their real part or magnitude"));
            }
            other => {
                let what = format!("does not say what its samples are (SampleFormat {other})");
                return fail(Reason::unsupported(what, "save them as whole numbers or floats"));
            }
        }
        match bits {
            8 | 16 | 32 | 64 => Ok(()),
            _ => fail(Reason::unsupported(
                format!("has samples of {bits} bits"),
                "convert it to 8 or 16",
            )),
        }
    }

    /// Refuses JPEG strips and tiles of this page that have no end marker: decoders silently continue as if zeros followed.
    fn check_jpegs(&mut self) -> Result<(), VolumeError> {
        const JPEG: u64 = 7;
        let path = self.path;
        let compression: Option<u64> =
            self.decoder.find_tag_unsigned(Tag::Compression).map_err(damaged(path))?;
        if compression != Some(JPEG) {
            return Ok(());
        }
        for places in
            [[Tag::StripOffsets, Tag::StripByteCounts], [Tag::TileOffsets, Tag::TileByteCounts]]
        {
            let mut numbers = |tag| {
                let numbers: Option<Vec<u64>> =
                    self.decoder.find_tag_unsigned_vec(tag).map_err(damaged(path))?;
                Ok::<_, VolumeError>(numbers.unwrap_or_default())
            };
            let [offsets, lengths] = [numbers(places[0])?, numbers(places[1])?];
            for (offset, length) in offsets.into_iter().zip(lengths) {
                let mut bytes = Vec::new();
                let part = self.directories.file.reader_at(offset)?;
                part.take(length).read_to_end(&mut bytes).map_err(io_error(path))?;
                if Scans::of(&bytes).is_none() {
                    let reason = Reason::truncated("ends inside its JPEG data: it is truncated");
                    return Err(format_error(path, reason));
                }
            }
        }
        Ok(())
    }

    fn page(&mut self, slice: u64) -> Result<Page, VolumeError> {
        let path = self.path;
        let fail = |reason: Reason| format_error(path, reason);
        let page = self.go_to(slice)?;
        self.check_gray(page)?;
        let (x, y) = self.decoder.dimensions().map_err(damaged(path))?;
        let bits = match self.decoder.colortype().map_err(damaged(path))? {
            ColorType::Gray(bits) => bits,
            other => {
                let what = format!("colours ({other:?}): only gray is read");
                return Err(fail(Reason::NotScalar { what, dims: None }));
            }
        };
        if self.directories.number(page, tag::IMAGE_DEPTH)?.is_some_and(|depth| depth > 1) {
            return Err(fail(Reason::content(
                "is a volume in one page (ImageDepth)",
                "save its slices as pages",
            )));
        }
        self.reserve(slice, 0, Dtype::U8)?;
        self.check_jpegs()?;
        // Memory for the samples as they are stored, and as floats.
        let room = u64::from(x) * u64::from(y) * (u64::from(bits / 8) + 4);
        let room = usize::try_from(room).unwrap_or(usize::MAX);
        afford(room, || format!("a page of {x}×{y} samples"))?;
        let mut size = [x.into(), y.into()];
        let tiles = self.directories.lzw_tiles(page)?.filter(|tiles| tiles.whole() == size);
        let (samples, dtype) = if let Some(tiles) = tiles {
            size = tiles.page;
            self.tiled(&tiles)?
        } else {
            let decoded = self.decoder.read_image().map_err(damaged(path))?;
            self.samples(decoded)?
        };
        if samples.len() as u64 != size[0] * size[1] {
            let found = samples.len();
            let what = format!("has {found} samples in a page of {size:?}");
            return Err(fail(Reason::damaged(what)));
        }
        let remarks = self.remarks(page)?;
        Ok(Page { size, dtype, samples, remarks })
    }

    /// The samples of the page, decoded tile by tile.
    fn tiled(&mut self, tiles: &Tiles) -> Result<(Vec<f32>, Dtype), VolumeError> {
        let [width, length] = tiles.page.map(|side| side as usize);
        let [across, down] = tiles.tile.map(|side| side as usize);
        let mut all = vec![0.0; width * length];
        let mut kind = Dtype::U8;
        let places =
            (0..length).step_by(down).flat_map(|y| (0..width).step_by(across).map(move |x| (x, y)));
        for (index, (x, y)) in (0..).zip(places) {
            let decoded = self.decoder.read_chunk(index).map_err(damaged(self.path))?;
            let (samples, dtype) = self.samples(decoded)?;
            if samples.len() != across * down {
                let what = format!("has {} samples in a tile of {across}×{down}", samples.len());
                return Err(format_error(self.path, Reason::damaged(what)));
            }
            kind = dtype;
            let columns = across.min(width - x);
            for (row, y) in samples.chunks_exact(across).zip(y..length) {
                all[y * width + x..][..columns].copy_from_slice(&row[..columns]);
            }
        }
        Ok((all, kind))
    }

    /// Decoded numbers as samples, and their type.
    fn samples(&self, decoded: DecodingResult) -> Result<(Vec<f32>, Dtype), VolumeError> {
        Ok(match decoded {
            DecodingResult::U8(v) => (v.into_iter().map(f32::from).collect(), Dtype::U8),
            DecodingResult::I8(v) => (v.into_iter().map(f32::from).collect(), Dtype::I8),
            DecodingResult::U16(v) => (v.into_iter().map(f32::from).collect(), Dtype::U16),
            DecodingResult::I16(v) => (v.into_iter().map(f32::from).collect(), Dtype::I16),
            DecodingResult::U32(v) => (self.rounded(v), Dtype::U32),
            DecodingResult::I32(v) => (self.rounded(v), Dtype::I32),
            DecodingResult::U64(v) => (self.rounded(v), Dtype::U64),
            DecodingResult::I64(v) => (self.rounded(v), Dtype::I64),
            DecodingResult::F32(v) => (v, Dtype::F32),
            DecodingResult::F64(v) => (self.rounded(v), Dtype::F64),
            DecodingResult::F16(_) => {
                return Err(format_error(
                    self.path,
                    Reason::unsupported(
                        "has floats of 16 bits, which are not read",
                        "save floats of 32 bits",
                    ),
                ));
            }
        })
    }

    /// Converts numbers to samples, and reports rounding.
    fn rounded(&self, numbers: Vec<impl Sample>) -> Vec<f32> {
        let samples = numbers.into_iter().map(|number| self.rounding.sample(number)).collect();
        self.rounding.say(self.path);
        samples
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
    let slices = wanted.count;
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
        TiffError::UnsupportedError(what) => {
            let what = format!("is a TIFF file of a kind that is not read: {what}");
            format_error(
                path,
                Reason::unsupported(what, "save it without compression, or with LZW or Deflate"),
            )
        }
        other => format_error(
            path,
            Reason::damaged(format!("is a TIFF file that cannot be read: {other}")),
        ),
    }
}
