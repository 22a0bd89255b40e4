//! Which format a file or folder is of, and reading it.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;

use walpha_base::Monitor;
use walpha_base::advice::Setting;
use walpha_base::near::nearest;

use super::{FORMATS, VolumeFormat};

#[cfg(feature = "formats")]
use crate::read::naming;
use crate::read::{format_error, io_error, raw};
use crate::source::whole_only;
use crate::{ReadOptions, Reason, Series, Source, Volume, VolumeError};

/// Bytes looked at.
const BYTES: u64 = 1024;

/// Formats that are known and not read as volumes: what they begin with, what they are, and what to
/// do.
const REFUSED: [(&[u8], &str, &str); 8] = [
    (b"\x89PNG", "a PNG image, one slice", "give the folder of all slices"),
    (b"\xff\xd8\xff", "a JPEG image, one slice", "give the folder of all slices"),
    (b"\x89HDF\r\n", "HDF5 (or MINC2, NetCDF-4), which is not read", "convert it to NRRD or NIfTI"),
    (b"CDF", "NetCDF (or MINC1), which is not read", "convert it to NRRD or NIfTI"),
    (b"BZh", "compressed with bzip2", "unpack it first"),
    (b"\xfd7zXZ", "compressed with xz", "unpack it first"),
    (b"\x28\xb5\x2f\xfd", "compressed with Zstandard", "unpack it first"),
    (b"%PDF", "a PDF document", "name a file with a volume in it"),
];

/// Reads a volume from a file: raw samples if a layout is given, else by what the file begins with,
/// and where that says nothing by its extension. Folders are read as the first format that they look
/// like.
///
/// [`FORMATS`] are read, as far as their features were built in. Spacing, origin and directions are
/// those of the file, in the space it means; where it says none, spacing is 1 and the origin 0.
///
/// A header's claim is compared with the length of the file before memory is allocated. Samples of
/// unsigned 8 bits are marked as gray levels. One pass; memory for the samples and a few MB.
///
/// # Errors
/// The file cannot be read, is of no format known, is truncated, longer than it claims or
/// otherwise not what it says, has an empty axis or too many samples, or holds a NaN or infinity.
/// Every message names the file.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Volume, VolumeError> {
    read_monitored(path, options, &Monitor::noop())
}

/// The same, which says how far it is and can be cancelled.
///
/// # Errors
/// Those of [`read`], and [`VolumeError::Cancelled`].
pub fn read_monitored(
    path: &Path,
    options: &ReadOptions,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let volume = match &options.raw {
        Some(layout) => raw::read(path, layout, monitor),
        None => found(path, options).and_then(|found| found.read(path, options, monitor)),
    };
    let settled =
        |volume: Volume| volume.settled(options.nan).map_err(|error| beside(path, options, error));
    let volume = volume.and_then(|volume| options.part(settled(volume)?));
    volume.map_err(|error| match error {
        VolumeError::Io { .. }
        | VolumeError::Format { .. }
        | VolumeError::InFile { .. }
        | VolumeError::Cancelled(_) => error,
        other => VolumeError::InFile { path: path.into(), source: Box::new(other) },
    })
}

/// An error about samples, with the names of the files that hold them where those are not the header's.
fn beside(path: &Path, options: &ReadOptions, error: VolumeError) -> VolumeError {
    #[cfg(feature = "formats")]
    if let Ok(files) = data_files(path, options)
        && !files.is_empty()
    {
        return naming(path, &files)(error);
    }
    let _ = (path, options);
    error
}

/// Opens a volume to be read part by part.
pub(crate) fn source(path: &Path, options: &ReadOptions) -> Result<Source, VolumeError> {
    match &options.raw {
        Some(layout) => Ok(raw::rows(path, layout)?.source()),
        None => found(path, options)?.source(path, options),
    }
}

/// What a file or folder is, as `NRRD` or `NIfTI, gzip`.
///
/// # Errors
/// The file cannot be read or is of no format known.
pub fn format_name(path: &Path, options: &ReadOptions) -> Result<String, VolumeError> {
    if options.raw.is_some() {
        return Ok("raw samples".into());
    }
    let Found { format, gzip } = found(path, options)?;
    Ok(match (path.is_dir(), gzip) {
        (true, _) => format.folder_name.into(),
        (_, true) => format!("{}, gzip", format.name),
        _ => format.name.into(),
    })
}

/// The files that hold the samples of a volume, where its header is a file of its own (NRRD,
/// `MetaImage`, `NIfTI`); else none. A header may name any file, not only those of its folder.
///
/// # Errors
/// The header cannot be read.
pub fn data_files(path: &Path, options: &ReadOptions) -> Result<Vec<PathBuf>, VolumeError> {
    if options.raw.is_some() || !path.is_file() {
        return Ok(Vec::new());
    }
    match found(path, options)? {
        Found { format: VolumeFormat { data_files: Some(data_files), .. }, gzip: false } => {
            data_files(path)
        }
        _ => Ok(Vec::new()),
    }
}

/// The series in a folder; none where it holds no DICOM files.
///
/// # Errors
/// The folder or a file in it cannot be read.
pub fn series(folder: &Path) -> Result<Vec<Series>, VolumeError> {
    #[cfg(feature = "dicom")]
    return crate::read::dicom::series(folder);
    #[cfg(not(feature = "dicom"))]
    {
        let _ = folder;
        Ok(Vec::new())
    }
}

/// Whether a file that starts so is of a format of volumes.
pub fn begins_as_volume(start: &[u8]) -> bool {
    by_content(start).is_some()
}

/// The first bytes of a file, from which its format is recognised.
///
/// # Errors
/// [`VolumeError`]: what cannot be read, and why.
pub fn start_of(path: &Path) -> Result<Vec<u8>, VolumeError> {
    let mut start = Vec::new();
    let file = File::open(path).map_err(io_error(path))?;
    file.take(BYTES).read_to_end(&mut start).map_err(io_error(path))?;
    Ok(start)
}

/// The error for a file of no format known.
pub(super) fn unknown(path: &Path) -> VolumeError {
    let given = path.extension().unwrap_or_default().to_string_lossy();
    let known = FORMATS.iter().filter(|format| format.is_built_in());
    let named = |format: &VolumeFormat| {
        let dotted: Vec<String> = format.extensions.iter().map(|e| format!(".{e}")).collect();
        format!("{} ({})", format.name, dotted.join(", "))
    };
    let with_names = known.clone().filter(|format| !format.extensions.is_empty());
    let names: Vec<String> = with_names.map(named).collect();
    let near = nearest(&given, known.flat_map(|format| format.extensions).copied());
    let known = format!("{} and folders of slices", names.join(", "));
    format_error(path, Reason::Unknown { known, near })
}

/// A format, and whether a file of it is compressed as a whole.
struct Found {
    format: &'static VolumeFormat,
    gzip: bool,
}

impl Found {
    fn read(
        &self,
        path: &Path,
        options: &ReadOptions,
        monitor: &Monitor,
    ) -> Result<Volume, VolumeError> {
        let Self { format, .. } = self;
        self.accepts(path, options)?;
        match (format.read, format.feature) {
            (Some(read), _) => read(path, options, monitor),
            (None, feature) => {
                let (what, feature) = (format.name, feature.unwrap_or_default());
                Err(format_error(path, Reason::Without { what, feature }))
            }
        }
    }

    fn source(&self, path: &Path, options: &ReadOptions) -> Result<Source, VolumeError> {
        let Self { format, gzip } = self;
        self.accepts(path, options)?;
        match format.parts {
            Some(parts) if !gzip => parts(path, options),
            // It says what is missing where the format was left out.
            _ if !format.is_built_in() => Err(self
                .read(path, options, &Monitor::noop())
                .err()
                .unwrap_or_else(|| whole_only(path, format.name))),
            _ => Err(whole_only(path, format.name)),
        }
    }

    /// Refuses settings that the format has no use for.
    fn accepts(&self, path: &Path, options: &ReadOptions) -> Result<(), VolumeError> {
        let Self { format, .. } = self;
        for (setting, given) in [
            (Setting::Level, options.level.is_some()),
            (Setting::Array, options.array.is_some()),
            (Setting::Frame, options.frame.is_some()),
            (Setting::Series, options.series.is_some()),
            (Setting::SkipDamaged, options.skip_damaged),
        ] {
            if given && !format.chooses.contains(&setting) {
                let what = match setting {
                    Setting::Level => "is not a pyramid",
                    Setting::Array => "has no arrays with names",
                    Setting::Frame => "is of a format of one volume",
                    _ => "is no DICOM series",
                };
                return Err(format_error(path, Reason::needless(setting, what)));
            }
        }
        Ok(())
    }
}

/// The format of a file or folder, which must be the one that the user says, if one is said.
fn found(path: &Path, options: &ReadOptions) -> Result<Found, VolumeError> {
    let asked = options.format.as_deref();
    let found = found_as(path, asked)?;
    let Found { format, .. } = found;
    let is_it = |asked: &str| format.extensions.iter().any(|own| own.eq_ignore_ascii_case(asked));
    // DICOM has no extension of its own.
    if asked.is_some_and(|asked| !is_it(asked) && !format.extensions.is_empty()) {
        let what = format!("is of the format {} by its content", format.name);
        return Err(format_error(path, Reason::needless(Setting::Format, what)));
    }
    Ok(found)
}

fn found_as(path: &Path, asked: Option<&str>) -> Result<Found, VolumeError> {
    if path.is_dir() {
        for format in &FORMATS {
            if (format.is_folder)(path)? {
                return Ok(Found { format, gzip: false });
            }
        }
    }
    let start = start_of(path)?;
    if start.is_empty() {
        let reason = Reason::content("is empty: there is no volume in it", "write it again");
        return Err(format_error(path, reason));
    }
    if let Some(format) = by_content(&start) {
        return Ok(Found { format, gzip: false });
    }
    if let Some((_, what, advice)) = REFUSED.iter().find(|(magic, ..)| start.starts_with(magic)) {
        return Err(format_error(path, Reason::unsupported(format!("is {what}"), *advice)));
    }
    if start.starts_with(&[0x1f, 0x8b]) {
        return unpacked(path, asked);
    }
    #[expect(clippy::case_sensitive_file_extension_comparisons, reason = "names are in lower case")]
    if name(path, asked).ends_with(".gz") {
        let what = "is not compressed with gzip, whatever its name says";
        return Err(format_error(path, Reason::content(what, "rename it")));
    }
    let format = by_extension(path, asked).ok_or_else(|| unknown(path))?;
    Ok(Found { format, gzip: false })
}

fn by_content(start: &[u8]) -> Option<&'static VolumeFormat> {
    FORMATS.iter().find(|format| (format.begins)(start))
}

fn by_extension(path: &Path, asked: Option<&str>) -> Option<&'static VolumeFormat> {
    let name = name(path, asked);
    let ends =
        |extension: &&str| name.strip_suffix(*extension).is_some_and(|stem| stem.ends_with('.'));
    FORMATS.iter().find(|format| format.extensions.iter().any(ends))
}

/// The file's name in lower case, with the extension that the user says, if one is said.
fn name(path: &Path, asked: Option<&str>) -> String {
    let own = || path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    asked.map_or_else(own, |asked| format!("it.{}", asked.to_lowercase()))
}

/// What a gzip stream holds.
fn unpacked(path: &Path, asked: Option<&str>) -> Result<Found, VolumeError> {
    let file = File::open(path).map_err(io_error(path))?;
    let mut start = Vec::new();
    // What cannot be unpacked is left to the reader, which says why.
    let unpacked = MultiGzDecoder::new(BufReader::new(file)).take(BYTES).read_to_end(&mut start);
    let packed = FORMATS.iter().filter(|format| format.gzip);
    let names: Vec<&str> = packed.clone().map(|format| format.name).collect();
    let names = names.join(", ");
    let of_name = by_extension(path, asked).filter(|format| format.gzip);
    match (by_content(&start), of_name) {
        (Some(format), _) if format.gzip => Ok(Found { format, gzip: true }),
        (Some(_), _) => {
            let what =
                format!("is a whole file compressed with gzip, which is read for {names} only");
            Err(format_error(path, Reason::unsupported(what, "unpack it first")))
        }
        (None, Some(format)) => Ok(Found { format, gzip: true }),
        (None, None) => {
            let what = match unpacked {
                Ok(_) => format!(
                    "is compressed with gzip, but holds no format known by content: {names} \
                         are read so"
                ),
                Err(error) => format!("is compressed with gzip, and damaged ({error})"),
            };
            Err(format_error(path, Reason::content(what, "unpack it first")))
        }
    }
}
