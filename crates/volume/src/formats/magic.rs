//! The first bytes of files of each format.

use walpha_base::npy;

use crate::Endian;

/// The lengths of the headers of `NIfTI`'s versions 1 and 2. The first number of a file repeats its length.
pub(crate) const NIFTI_HEADERS: [usize; 2] = [348, 540];

/// Whether a file begins as a `NIfTI` (or Analyze) header does, of either version and byte order.
pub(super) fn is_nifti(start: &[u8]) -> bool {
    start.len() >= NIFTI_HEADERS[0] && nifti_version(start).is_some()
}

/// The version and byte order of `NIfTI`, according to the first number.
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

/// Whether a file begins as a `MetaImage` header does: with a line that has one of these keys.
pub(super) fn is_metaimage(start: &[u8]) -> bool {
    const FIRST_KEYS: [&str; 4] = ["ObjectType", "NDims", "Comment", "ObjectSubType"];
    let line = start.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let line = String::from_utf8_lossy(line);
    line.split_once(['=', ':']).is_some_and(|(key, _)| FIRST_KEYS.contains(&key.trim()))
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

/// Whether a file begins as an MGH header does: with version 1, four sizes of at least 1, and an existing type.
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

/// Whether a file begins as a DICOM file does: with the `DICM` mark or, without a mark, with elements. The bytes before the mark
/// are free: some scanners write a TIFF header there.
pub(crate) fn is_dicom(start: &[u8]) -> bool {
    match dicom_mark(start) {
        Some(0) => dicom_order(&start[4..]).is_some(),
        Some(_) => true,
        None => dicom_order(start).is_some(),
    }
}

/// The position of the `DICM` mark of a DICOM file: behind 128 bytes, which some files lack.
pub(crate) fn dicom_mark(start: &[u8]) -> Option<u64> {
    [128, 0].into_iter().find(|&at| start.get(at..at + 4) == Some(b"DICM")).map(|at| at as u64)
}

/// The byte order of DICOM elements, and whether they state their types. It is decided by the first three elements, which are in
/// ascending order and begin with those about the file (group 2) or the image (group 8).
pub(crate) fn dicom_order(start: &[u8]) -> Option<(Endian, bool)> {
    let all = [(Endian::Little, true), (Endian::Little, false), (Endian::Big, true)];
    all.into_iter().find(|&(order, typed)| begins_with_elements(start, order, typed))
}

fn begins_with_elements(start: &[u8], order: Endian, typed: bool) -> bool {
    /// Types with a length of four bytes, after two unused ones.
    const LONG: [&[u8]; 6] = [b"OB", b"OW", b"SQ", b"UN", b"UT", b"OF"];
    const SHORT: [&[u8]; 13] =
        [b"AE", b"CS", b"DA", b"DS", b"IS", b"LO", b"PN", b"SH", b"TM", b"UI", b"UL", b"US", b"ST"];
    let short = |at: usize| {
        let bytes = start.get(at..at + 2)?.try_into().ok()?;
        Some(match order {
            Endian::Little => u16::from_le_bytes(bytes),
            Endian::Big => u16::from_be_bytes(bytes),
        })
    };
    let long = |at: usize| {
        let (low, high) = match order {
            Endian::Little => (short(at)?, short(at + 2)?),
            Endian::Big => (short(at + 2)?, short(at)?),
        };
        Some(usize::from(low) + (usize::from(high) << 16))
    };
    let (mut at, mut last) = (0, None);
    for _ in 0..3 {
        let tag = short(at).zip(short(at + 2));
        let Some((group, _)) = tag.filter(|_| tag > last) else { return false };
        if !(group == 2 || group == 8 || at > 0 && group <= 0x28) {
            return false;
        }
        let kind = start.get(at + 4..at + 6).unwrap_or_default();
        let value = if !typed {
            long(at + 4).map(|length| (at + 8, length))
        } else if LONG.contains(&kind) {
            long(at + 8).map(|length| (at + 12, length))
        } else if SHORT.contains(&kind) {
            short(at + 6).map(|length| (at + 8, length.into()))
        } else {
            None
        };
        // No long element, such as a sequence, precedes these.
        let Some((value, length)) = value.filter(|(_, length)| length % 2 == 0) else {
            return false;
        };
        (at, last) = (value + length, tag);
    }
    true
}
