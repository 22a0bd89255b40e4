//! How files of each format begin.

use walpha_base::npy;

use crate::Endian;

/// Lengths of the headers of `NIfTI`'s versions 1 and 2, which their first numbers repeat.
pub(crate) const NIFTI_HEADERS: [usize; 2] = [348, 540];

/// Whether a file begins as a `NIfTI` (or Analyze) header does, of either version and byte order.
pub(super) fn is_nifti(start: &[u8]) -> bool {
    start.len() >= NIFTI_HEADERS[0] && nifti_version(start).is_some()
}

/// `NIfTI`'s version and byte order, by the first number.
pub(crate) fn nifti_version(start: &[u8]) -> Option<(u8, Endian)> {
    let first: [u8; 4] = start.get(..4)?.try_into().ok()?;
    for (size, version) in NIFTI_HEADERS.into_iter().zip(1..) {
        if u32::from_le_bytes(first) == size as u32 {
            return Some((version, Endian::Little));
        }
        if u32::from_be_bytes(first) == size as u32 {
            return Some((version, Endian::Big));
        }
    }
    None
}

/// Whether a file begins as a `MetaImage` header does: with a line of one of these keys.
pub(super) fn is_metaimage(start: &[u8]) -> bool {
    const FIRST_KEYS: [&str; 4] = ["ObjectType", "NDims", "Comment", "ObjectSubType"];
    let line = start.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let line = String::from_utf8_lossy(line);
    line.split_once('=').is_some_and(|(key, _)| FIRST_KEYS.contains(&key.trim()))
}

/// Whether a file begins as VTK's XML files do.
pub fn is_vtk_xml(start: &[u8]) -> bool {
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).trim_ascii_start();
    let name = b"<VTKFile";
    text.starts_with(b"<") && start.windows(name.len()).any(|window| window == name)
}

/// Whether a file begins as TIFF or `BigTIFF` does, of either byte order.
pub(super) fn is_tiff(start: &[u8]) -> bool {
    const MAGIC: [&[u8]; 4] = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];
    MAGIC.iter().any(|magic| start.starts_with(magic))
}

/// Whether a file begins as an MGH header does: with version 1, four sizes from 1 up, and a type that there is.
pub(super) fn is_mgh(start: &[u8]) -> bool {
    let (numbers, _) = start.as_chunks();
    let numbers: Vec<i32> =
        numbers.iter().take(6).map(|&bytes| i32::from_be_bytes(bytes)).collect();
    matches!(numbers[..], [1, x, y, z, t, 0..=10] if [x, y, z, t].iter().all(|n| (1..1 << 20).contains(n)))
}

/// Whether a file begins as legacy VTK files do.
pub fn is_vtk(start: &[u8]) -> bool {
    start.starts_with(b"# vtk DataFile")
}

/// Whether a file begins as NPY does.
pub fn is_npy(start: &[u8]) -> bool {
    start.starts_with(npy::MAGIC)
}

/// Whether a file begins as a gzip stream does.
pub(crate) fn is_gzip(start: &[u8]) -> bool {
    start.starts_with(&[0x1f, 0x8b])
}

/// Whether a file begins as a DICOM file does. The bytes before the mark are anybody's: some scanners
/// write a TIFF header there.
pub(super) fn is_dicom(start: &[u8]) -> bool {
    start.get(128..132) == Some(b"DICM")
}
