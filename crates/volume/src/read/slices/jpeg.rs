//! Gray JPEG slices, whose data must be complete.

use std::io::Read;
use std::path::Path;

use image::metadata::Orientation;
use jpeg_decoder::{Decoder, Error, ImageInfo, PixelFormat};
use walpha_base::memory::{afford, try_reserve, try_with_capacity};

use super::check_claim;
use crate::error::{format_error, io_error};
use crate::read::OpenFile;
use crate::read::scans::Scans;
use crate::read::tiff::{self, Page};
use crate::{Dtype, Reason, VolumeError};

/// Whether a file begins as JPEG does.
pub(super) fn is_jpeg(start: &[u8]) -> bool {
    start.starts_with(&[0xff, 0xd8])
}

/// Reads a slice, and checks that its data are complete.
///
/// If data are missing, decoders silently continue as if zeros followed. So the image is decoded twice, with different bytes
/// appended to the data of each scan, which a decoder ignores if it needs no more: if the results differ, data are missing.
pub(super) fn page(path: &Path, file: &OpenFile) -> Result<Page, VolumeError> {
    let refused = |reason| format_error(path, reason);
    let mut bytes = Vec::new();
    try_reserve(&mut bytes, file.length() as usize, || "a JPEG image".into())?;
    file.reader()?.read_to_end(&mut bytes).map_err(io_error(path))?;
    let mut headers = Decoder::new(&bytes[..]);
    headers.read_info().map_err(|error| refused(unreadable(&error)))?;
    let ImageInfo { width, height, pixel_format, .. } = headers.info().expect("it was read");
    let size = [width, height].map(u64::from);
    check_claim(path, size, file.length())?;
    if pixel_format != PixelFormat::L8 {
        let what = format!("pixels of {pixel_format:?}: only gray of 8 bits is read");
        return Err(refused(Reason::NotScalar { what, dims: None }));
    }
    let orientation = headers.exif_data().and_then(Orientation::from_exif_chunk);
    let orientation = orientation.unwrap_or(Orientation::NoTransforms).to_exif();
    let remarks = tiff::orientation_remark(orientation.into()).into_iter().collect();
    // For each pixel: a coefficient, the levels of both decodings, and the sample.
    let room = usize::try_from(size[0] * size[1] * 8).unwrap_or(usize::MAX);
    afford(room, || format!("an image of {width}×{height} pixels"))?;
    let cut = || refused(Reason::truncated("ends inside its image: it is truncated"));
    let scans = Scans::of(&bytes).ok_or_else(cut)?;
    if !scans.are_complete() {
        let what = "lacks scans that refine its pixels: it is truncated, or a preview";
        return Err(refused(Reason::content(what, "copy it again, or save the whole image")));
    }
    let levels = |appended: u8| {
        let room = bytes.len() + scans.ends.len() * APPENDED;
        let mut longer = try_with_capacity(room, || "a JPEG image".into())?;
        let mut from = 0;
        for &end in &scans.ends {
            longer.extend_from_slice(&bytes[from..end]);
            longer.resize(longer.len() + APPENDED, appended);
            from = end;
        }
        longer.extend_from_slice(&bytes[from..]);
        Decoder::new(&longer[..]).decode().map_err(|error| refused(unreadable(&error)))
    };
    let once = levels(0x00)?;
    if once != levels(0xaa)? {
        return Err(cut());
    }
    Ok(Page { size, dtype: Dtype::U8, samples: once.into_iter().map(f32::from).collect(), remarks })
}

/// The number of bytes that are appended to the data of a scan.
const APPENDED: usize = 64;

fn unreadable(error: &Error) -> Reason {
    match error {
        Error::Unsupported(error) => {
            let what = format!("is an image that is not read: {error:?}");
            Reason::unsupported(what, "save it as a gray PNG")
        }
        other => Reason::damaged(format!("is not an image that can be read: {other}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A JPEG file of 24 × 16 gray levels written by libjpeg, with scans that refine each other.
    const PROGRESSIVE: &str = "\
        ffd8ffe000104a46494600010100000100010000ffdb0043001b12141714111b1716171e1c1b2028422b28252528513a3d30\
        42605565645f555d5b6a7899816a7190735b5d85b586909ea3abadab6780bcc9baa6c799a8aba4ffc2000b08001000180101\
        1100ffc4001500010100000000000000000000000000000304ffda00080101000000018994d5ff00ffc40015100101000000\
        00000000000000000000000100ffda0008010100010502082082082fffc40014100100000000000000000000000000000020\
        ffda0008010100063f025fffc40017100003010000000000000000000000000000106151ffda0008010100013f210826268b\
        ffda00080101000000108fffc4001b10000202030100000000000000000000000111004121315181ffda0008010100013f10\
        3dde9c3842943b101260c300c63c5a83e98af20183b0a7ffd9\
        ";

    /// The image of [`PROGRESSIVE`] with a restart marker after every second block.
    const RESTARTED: &str = "\
        ffd8ffe000104a46494600010100000100010000ffdb0043001b12141714111b1716171e1c1b2028422b28252528513a3d30\
        42605565645f555d5b6a7899816a7190735b5d85b586909ea3abadab6780bcc9baa6c799a8aba4ffc0000b08001000180101\
        1100ffc40017000100030000000000000000000000000004010305ffc4001f10000202020105000000000000000000000103\
        00113141510212214281ffdd00040002ffda0008010100003f00c6528ef78b8b5288a1db8d0e67ffd0ad69a15560c3a9240b\
        1d1e38ac4fffd185287b5d8d7c8e4a45839153ffd9\
        ";

    /// The image of [`PROGRESSIVE`] in one scan.
    const BASELINE: &str = "\
        ffd8ffe000104a46494600010100000100010000ffdb0043001b12141714111b1716171e1c1b2028422b28252528513a3d30\
        42605565645f555d5b6a7899816a7190735b5d85b586909ea3abadab6780bcc9baa6c799a8aba4ffc0000b08001000180101\
        1100ffc4001500010100000000000000000000000000000405ffc4001f100002020201050000000000000000000001030011\
        3141510212214281ffda0008010100003f008ca51def1716a51143b71a1cc52d342aac1875248163a3c71588b5287b5d8d7c\
        8e4a45839153ffd9\
        ";

    fn bytes(hex: &str) -> Vec<u8> {
        let byte = |pair: &[u8]| u8::from_str_radix(str::from_utf8(pair).unwrap(), 16).unwrap();
        hex.as_bytes().chunks(2).map(byte).collect()
    }

    fn read(bytes: &[u8]) -> Result<Vec<f32>, VolumeError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("slice.jpg");
        std::fs::write(&path, bytes).unwrap();
        page(&path, &OpenFile::open(&path).unwrap()).map(|page| page.samples)
    }

    #[test]
    fn images_that_were_cut_are_refused() {
        let mut levels = Vec::new();
        for hex in [PROGRESSIVE, RESTARTED, BASELINE] {
            let whole = bytes(hex);
            let samples = read(&whole).unwrap();
            assert_eq!(samples.len(), 24 * 16);
            for end in 2..whole.len() {
                assert!(read(&whole[..end]).is_err(), "{end} bytes");
                // Some programs append an end marker to truncated data.
                let closed = [&whole[..end], &[0xff, 0xd9]].concat();
                if let Ok(found) = read(&closed) {
                    assert!(found == samples, "{end} bytes and an end marker");
                }
            }
            assert_eq!(read(&[&whole[..], b"trailing"].concat()).unwrap(), samples);
            levels.push(samples);
        }
        assert!(levels[1] == levels[2] && levels[0] == levels[2], "the same coefficients");
    }

    #[test]
    fn errors_tell_what_is_missing() {
        let whole = bytes(PROGRESSIVE);
        let text = |bytes: &[u8]| read(bytes).unwrap_err().to_string();
        assert!(text(&whole[..whole.len() - 9]).contains("ends inside its image"));
        let first = Scans::of(&whole).unwrap().ends[0];
        let preview = text(&[&whole[..first], &[0xff, 0xd9]].concat());
        assert!(preview.contains("lacks scans that refine"), "{preview}");
    }
}
