mod jpeg;
mod numbers;

use std::cmp::Ordering;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageDecoder, ImageError, ImageReader};
use walpha_base::memory::{afford, try_reserve};
use walpha_base::sort::sort_by;

use crate::error::{format_error, io_error};
use crate::read::OpenFile;
use crate::read::frames::FrameChoice;
use crate::read::layout::{Encoding, Layout};
use crate::read::payload::MOST_EXPANSION;
use crate::read::tiff::{self, Page};
use crate::{Dims, Dtype, Endian, Frame, Reason, Volume, VolumeError};

/// The extensions of slices.
const EXTENSIONS: [[&str; 2]; 3] = [["png", "png"], ["jpg", "jpeg"], ["tif", "tiff"]];

/// The extensions of pictures that are not read as slices.
const OTHER_PICTURES: [&str; 7] = ["bmp", "dcm", "gif", "jp2", "pgm", "ppm", "webp"];

/// Reads a folder of gray PNG, JPEG or TIFF slices, all of one kind and size, in the natural order of their names: `slice9`
/// before `slice10`. Their numbers, which may have decimals and signs, must be a sequence without gaps. Other files and hidden
/// files are ignored.
pub(crate) fn read(folder: &Path) -> Result<Volume, VolumeError> {
    let paths = slices(folder)?;
    numbers::check(folder, &paths)?;
    let mut stack = Vec::new();
    let mut first: Option<([u64; 2], Dtype)> = None;
    let mut said = Vec::new();
    for path in &paths {
        let Page { size, dtype, samples, remarks } = page(path, first.is_none())?;
        tiff::say(path, &remarks, &mut said);
        let expected = *first.get_or_insert((size, dtype));
        if (size, dtype) != expected {
            let (sizes, other) = expected;
            let reason = Reason::content(
                format!(
                    "has {size:?} samples of {dtype}, but the first slice {sizes:?} of {other}: \
                     slices must be alike"
                ),
                "leave only the slices in the folder",
            );
            return Err(format_error(path, reason));
        }
        Dims::new(size[0], size[1], paths.len() as u64)?;
        try_reserve(&mut stack, samples.len(), || "a stack of slices".into())?;
        stack.extend(samples);
    }
    let Some((size, dtype)) = first else {
        return Err(format_error(folder, no_slices(folder)));
    };
    let dims = Dims::new(size[0], size[1], paths.len() as u64)?;
    let (endian, frame, encoding) = (Endian::Little, Frame::VOXEL, Encoding::Raw);
    Layout { dims, dtype, endian, frame, encoding, frames: FrameChoice::ONE }.volume(stack)
}

/// Why a folder without slices is not read.
fn no_slices(folder: &Path) -> Reason {
    let entries =
        || std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let kind = |path: &Path| Some(path.extension()?.to_str()?.to_ascii_lowercase());
    let picture =
        entries().filter_map(|path| kind(&path)).find(|own| OTHER_PICTURES.contains(&own.as_str()));
    if let Some(kind) = picture {
        let what = format!(
            "holds no PNG, JPEG or TIFF slices, but files called .{kind}, which are not read as slices"
        );
        return Reason::unsupported(what, "save them as PNG or TIFF");
    }
    Reason::content("holds no PNG, JPEG or TIFF slices", "name a file in it, or a folder of slices")
}

/// The slices of a folder, in order.
pub(crate) fn slices(folder: &Path) -> Result<Vec<PathBuf>, VolumeError> {
    let mut found: [Vec<PathBuf>; 3] = Default::default();
    for entry in std::fs::read_dir(folder).map_err(io_error(folder))? {
        let path = entry.map_err(io_error(folder))?.path();
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        let hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes()[0] == b'.');
        let kind = EXTENSIONS.iter().position(|names| names.iter().any(|&name| extension == name));
        if let (Some(kind), false) = (kind, hidden) {
            found[kind].push(path);
        }
    }
    if found.iter().filter(|paths| !paths.is_empty()).count() > 1 {
        let reason =
            Reason::content("holds images of several kinds", "leave only the slices in it");
        return Err(format_error(folder, reason));
    }
    let mut paths = found.concat();
    sort_by(&mut paths, |a, b| natural(&a.to_string_lossy(), &b.to_string_lossy()).then(a.cmp(b)));
    Ok(numbers::by_real_numbers(&paths).unwrap_or(paths))
}

fn page(path: &Path, is_first: bool) -> Result<Page, VolumeError> {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    if EXTENSIONS[2].iter().any(|&name| extension == name) {
        return tiff::read_page(path, is_first);
    }
    let unreadable = |error| match error {
        ImageError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            format_error(path, Reason::truncated("ends inside its image: it is truncated"))
        }
        ImageError::IoError(error) => io_error(path)(error),
        ImageError::Unsupported(error) => format_error(
            path,
            Reason::unsupported(
                format!("is an image that is not read: {error}"),
                "save it as a gray PNG",
            ),
        ),
        other => format_error(
            path,
            Reason::damaged(format!("is not an image that can be read: {other}")),
        ),
    };
    let file = OpenFile::open(path)?;
    if jpeg::is_jpeg(file.start()) {
        return jpeg::page(path, &file);
    }
    let png = Png::of(file.start());
    if png == Some(Png::Palette) {
        let what = "has a palette of colours: only gray is read";
        return Err(format_error(path, Reason::unsupported(what, "save it as gray")));
    }
    let mut decoder = ImageReader::new(file.reader()?)
        .with_guessed_format()
        .map_err(io_error(path))?
        .into_decoder()
        .map_err(unreadable)?;
    let (width, height) = decoder.dimensions();
    let orientation = decoder.orientation().map_err(unreadable)?.to_exif();
    let remarks = tiff::orientation_remark(orientation.into()).into_iter().collect();
    let size = [width, height].map(u64::from);
    check_claim(path, size, file.length())?;
    let room = decoder.total_bytes().saturating_add(size[0] * size[1] * 4);
    let room = usize::try_from(room).unwrap_or(usize::MAX);
    afford(room, || format!("an image of {width}×{height} pixels"))?;
    let image = DynamicImage::from_decoder(decoder).map_err(unreadable)?;
    match image {
        DynamicImage::ImageLuma8(image) => {
            // The decoder spreads levels of fewer bits over a byte.
            let step = png.map_or(1, Png::step);
            let samples =
                image.into_raw().into_iter().map(|level| f32::from(level / step)).collect();
            Ok(Page { size, dtype: Dtype::U8, samples, remarks })
        }
        DynamicImage::ImageLuma16(image) => {
            let samples = image.into_raw().into_iter().map(f32::from).collect();
            Ok(Page { size, dtype: Dtype::U16, samples, remarks })
        }
        DynamicImage::ImageLumaA8(_) | DynamicImage::ImageLumaA16(_) => {
            let what = "gray values with transparency: only gray is read";
            Err(format_error(
                path,
                Reason::unsupported(format!("has {what}"), "save it without transparency"),
            ))
        }
        other => {
            let what = format!("pixels of {:?}: only gray is read", other.color());
            Err(format_error(path, Reason::NotScalar { what, dims: None }))
        }
    }
}

/// Checks that a file of this length may contain as many pixels as it claims. PNG may have eight pixels in a byte; JPEG has 64 in
/// two bits at best.
fn check_claim(path: &Path, [width, height]: [u64; 2], length: u64) -> Result<(), VolumeError> {
    if width * height <= length.saturating_mul(8 * MOST_EXPANSION) {
        return Ok(());
    }
    let what = format!(
        "claims {width}×{height} pixels, which {length} bytes cannot hold: it is truncated or damaged"
    );
    Err(format_error(path, Reason::claims_more(what)))
}

/// What the header of a PNG says about its pixels.
#[derive(Clone, Copy, PartialEq)]
enum Png {
    Palette,
    /// Gray levels with this number of bits.
    Gray(u8),
    Other,
}

impl Png {
    fn of(start: &[u8]) -> Option<Self> {
        start.starts_with(b"\x89PNG").then_some(())?;
        Some(match (start.get(25)?, start.get(24)?) {
            (3, _) => Self::Palette,
            (0, &bits) => Self::Gray(bits),
            _ => Self::Other,
        })
    }

    /// The distance of levels after they are spread over a byte.
    fn step(self) -> u8 {
        match self {
            Self::Gray(1) => 255,
            Self::Gray(2) => 85,
            Self::Gray(4) => 17,
            _ => 1,
        }
    }
}

/// Compares names, with runs of digits compared by their number.
fn natural(a: &str, b: &str) -> Ordering {
    let (mut a, mut b) = (a.as_bytes(), b.as_bytes());
    loop {
        let (digits_a, digits_b) = (digits(a), digits(b));
        let order = if digits_a > 0 && digits_b > 0 {
            let ((number_a, rest_a), (number_b, rest_b)) =
                (a.split_at(digits_a), b.split_at(digits_b));
            (a, b) = (rest_a, rest_b);
            let [x, y] = [number_a, number_b].map(significant);
            x.len().cmp(&y.len()).then(x.cmp(y))
        } else {
            let (Some((x, rest_a)), Some((y, rest_b))) = (a.split_first(), b.split_first()) else {
                return a.len().cmp(&b.len());
            };
            (a, b) = (rest_a, rest_b);
            x.cmp(y)
        };
        if order != Ordering::Equal {
            return order;
        }
    }
}

fn digits(text: &[u8]) -> usize {
    text.iter().take_while(|byte| byte.is_ascii_digit()).count()
}

fn significant(number: &[u8]) -> &[u8] {
    let zeros = number.iter().take_while(|&&digit| digit == b'0').count();
    &number[zeros..]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_names_count() {
        let mut names = ["s10.png", "s9.png", "s009.png", "s1b.png", "s1.png", "a.png", "s.png"];
        sort_by(&mut names, |a, b| natural(a, b).then(a.cmp(b)));
        assert_eq!(names, ["a.png", "s.png", "s1.png", "s1b.png", "s009.png", "s9.png", "s10.png"]);
        let huge = ["x99999999999999999999999", "x100000000000000000000000"];
        assert_eq!(natural(huge[0], huge[1]), Ordering::Less);
    }
}
