mod about;

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::{ByteOrder, Tag};
use tiff::{ColorType, TiffError};
use walpha_base::Monitor;

use super::frames::Frames;
use super::{OpenFile, format_error, io_error};
use crate::{Dims, Dtype, Endian, Reason, Volume, VolumeError};
use about::{About, Wanted};

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
    let about = About::of(path, &mut pages.decoder)?;
    let wanted = about.wanted(path, frame)?;
    let alone = !pages.decoder.more_images();
    if alone && about.images.is_some_and(|images| images > 1) {
        let first = pages.page()?;
        let (size, dtype) = (first.size, first.dtype);
        return behind_one_page(file, pages, &about, wanted, size, dtype, monitor);
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
    about.described(path, dims, first.dtype, Endian::Little, Frames::ONE)?.volume(stack)
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
        let said = |reason: Reason| format_error(path, reason);
        let (x, y) = self.decoder.dimensions().map_err(damaged(path))?;
        match self.decoder.colortype().map_err(damaged(path))? {
            ColorType::Gray(8 | 16 | 32 | 64) => {}
            ColorType::Gray(bits) => {
                return Err(said(Reason::unsupported(
                    format!("has samples of {bits} bits"),
                    "convert it to 8 or 16",
                )));
            }
            other => {
                let what = format!("colours ({other:?}): only gray is read");
                return Err(said(Reason::NotScalar { what, dims: None }));
            }
        }
        let depth = self.decoder.find_tag_unsigned::<u64>(IMAGE_DEPTH).map_err(damaged(path))?;
        if depth.is_some_and(|depth| depth > 1) {
            return Err(said(Reason::content(
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
                return Err(said(Reason::unsupported(
                    "has floats of 16 bits, which are not read",
                    "save 32",
                )));
            }
        };
        let samples: Vec<f32> = samples;
        let size = [x.into(), y.into()];
        if samples.len() as u64 != size[0] * size[1] {
            let found = samples.len();
            return Err(said(Reason::damaged(format!(
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
    about: &About,
    wanted: Wanted,
    size: [u64; 2],
    dtype: Dtype,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let slices = wanted.count.or(about.images).unwrap_or(1);
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
    let described = about.described(path, dims, dtype, endian, wanted.frames)?;
    // Tags may follow the samples.
    let bytes = described.bytes().min(file.length().saturating_sub(offset));
    described.read(path, file.reader_at(offset)?.take(bytes), bytes, monitor)
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
