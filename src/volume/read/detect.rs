use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;
use walpha_check::npy::MAGIC;

use super::{VtkXml, format_error, inr, io_error, metaimage, nifti, nrrd, vtk};
use crate::near::nearest;
use crate::volume::VolumeError;

/// Bytes looked at.
pub(super) const BYTES: u64 = 1024;

/// The formats there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Npy,
    Npz,
    Inrimage,
    InrimageGzip,
    Nifti,
    NiftiGzip,
    Nrrd,
    MetaImage,
    VtkLegacy,
    VtkXml,
    Tiff,
    #[cfg(feature = "dicom")]
    Dicom,
}

impl Kind {
    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Npy => "NPY",
            Self::Npz => "NPZ",
            Self::Inrimage => "INRIMAGE",
            Self::InrimageGzip => "INRIMAGE, gzip",
            Self::Nifti => "NIfTI",
            Self::NiftiGzip => "NIfTI, gzip",
            Self::Nrrd => "NRRD",
            Self::MetaImage => "MetaImage",
            Self::VtkLegacy => "VTK structured points",
            Self::VtkXml => "VTK image data (XML)",
            Self::Tiff => "TIFF",
            #[cfg(feature = "dicom")]
            Self::Dicom => "DICOM",
        }
    }
}

/// What each extension stands for.
const EXTENSIONS: [(&str, Kind); 15] = [
    (".npy", Kind::Npy),
    (".npz", Kind::Npz),
    (".inr", Kind::Inrimage),
    (".inr.gz", Kind::InrimageGzip),
    (".nii", Kind::Nifti),
    (".hdr", Kind::Nifti),
    (".nii.gz", Kind::NiftiGzip),
    (".nrrd", Kind::Nrrd),
    (".nhdr", Kind::Nrrd),
    (".mha", Kind::MetaImage),
    (".mhd", Kind::MetaImage),
    (".vtk", Kind::VtkLegacy),
    (".vti", Kind::VtkXml),
    (".tif", Kind::Tiff),
    (".tiff", Kind::Tiff),
];

/// Formats that are known and not read as volumes: what they begin with, what they are, and what to
/// do.
const REFUSED: [(&[u8], &str); 8] = [
    (b"\x89PNG", "a PNG image, one slice: give the folder of all slices"),
    (b"\xff\xd8\xff", "a JPEG image, one slice: give the folder of all slices"),
    (b"\x89HDF\r\n", "HDF5 (or MINC2, NetCDF-4), which is not read: convert it to NRRD or NIfTI"),
    (b"CDF", "NetCDF (or MINC1), which is not read: convert it to NRRD or NIfTI"),
    (b"BZh", "compressed with bzip2: unpack it first"),
    (b"\xfd7zXZ", "compressed with xz: unpack it first"),
    (b"\x28\xb5\x2f\xfd", "compressed with Zstandard: unpack it first"),
    (b"%PDF", "a PDF document: there is no volume in it"),
];

/// What a file is, by its first bytes, then by its extension.
pub(super) fn kind(path: &Path, start: &[u8]) -> Result<Kind, VolumeError> {
    // First, because the bytes before the mark are anybody's: some scanners write a TIFF header there.
    if start.get(128..132) == Some(b"DICM") {
        #[cfg(feature = "dicom")]
        return Ok(Kind::Dicom);
        #[cfg(not(feature = "dicom"))]
        return Err(format_error(path, format!("is a DICOM file, {}", without("dicom"))));
    }
    if let Some(kind) = by_content(start) {
        return Ok(kind);
    }
    if let Some((_, what)) = REFUSED.iter().find(|(magic, _)| start.starts_with(magic)) {
        return Err(format_error(path, format!("is {what}")));
    }
    if start.starts_with(&[0x1f, 0x8b]) {
        return unpacked(path);
    }
    let name = name(path);
    if name.ends_with(".gz") {
        let what = "is not compressed with gzip, whatever its name says: rename it";
        return Err(format_error(path, what));
    }
    let of_extension = EXTENSIONS.iter().find(|(extension, _)| name.ends_with(extension));
    of_extension.map(|&(_, kind)| kind).ok_or_else(|| {
        let given = path.extension().unwrap_or_default().to_string_lossy();
        let known = EXTENSIONS.iter().map(|(extension, _)| &extension[1..]);
        let near = nearest(&given, known).map(|near| format!("is .{near} meant? "));
        format_error(
            path,
            format!(
                "is of no format known by content: NRRD (.nrrd, .nhdr), NIfTI (.nii, .nii.gz), \
                 MetaImage (.mha, .mhd), VTK (.vtk, .vti), TIFF, INRIMAGE (.inr, .inr.gz), NPY, NPZ \
                 (.npy, .npz) and folders of slices are read as volumes, CSV, TSV, XYZ, PWN, PLY, OFF, OBJ, \
                 STL, PCD, LAS, LAZ, VTU and VTP as points; {}for raw samples give --dims X,Y,Z and \
                 --dtype",
                near.unwrap_or_default()
            ),
        )
    })
}

/// What to say of a format whose feature was left out when walpha was built.
#[cfg(not(all(feature = "dicom", feature = "zarr")))]
pub(super) fn without(feature: &str) -> String {
    format!(
        "which this walpha was built without; build it with `cargo install --path . --features \
         {feature}`, or convert the volume to NRRD or NIfTI"
    )
}

fn by_content(start: &[u8]) -> Option<Kind> {
    const TIFF: [&[u8]; 4] = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];
    Some(if start.starts_with(MAGIC) {
        Kind::Npy
    } else if start.starts_with(b"PK\x03\x04") || start.starts_with(b"PK\x05\x06") {
        Kind::Npz
    } else if start.starts_with(inr::MAGIC) {
        Kind::Inrimage
    } else if start.starts_with(nrrd::MAGIC) {
        Kind::Nrrd
    } else if TIFF.iter().any(|magic| start.starts_with(magic)) {
        Kind::Tiff
    } else if start.starts_with(vtk::MAGIC) {
        Kind::VtkLegacy
    } else if VtkXml::is_header(start) {
        Kind::VtkXml
    } else if nifti::is_header(start) {
        Kind::Nifti
    } else if metaimage::is_header(start) {
        Kind::MetaImage
    } else {
        return None;
    })
}

/// The file's name in lower case.
fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().to_lowercase()
}

/// What a gzip stream holds.
fn unpacked(path: &Path) -> Result<Kind, VolumeError> {
    let file = File::open(path).map_err(io_error(path))?;
    let mut start = Vec::new();
    // What cannot be unpacked is left to the reader, which says why.
    let unpacked = MultiGzDecoder::new(BufReader::new(file)).take(BYTES).read_to_end(&mut start);
    match by_content(&start) {
        Some(Kind::Inrimage) => Ok(Kind::InrimageGzip),
        Some(Kind::Nifti) => Ok(Kind::NiftiGzip),
        Some(_) => Err(format_error(
            path,
            "is a whole file compressed with gzip, which is read for NIfTI and INRIMAGE only: unpack \
             it first",
        )),
        None if name(path).ends_with(".nii.gz") => Ok(Kind::NiftiGzip),
        None if name(path).ends_with(".inr.gz") || unpacked.is_err() => Ok(Kind::InrimageGzip),
        None => Err(format_error(
            path,
            "is compressed with gzip, but holds no format known by content: NIfTI and INRIMAGE are \
             read so; unpack it first",
        )),
    }
}
