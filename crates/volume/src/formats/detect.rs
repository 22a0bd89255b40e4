//! Recognises the format of a file or folder, and reads it.

use std::io;
use std::path::{Path, PathBuf};

use crate::near::nearest;
use walpha_base::Monitor;
use walpha_base::advice::Setting;
use walpha_base::foreign::decode;

use super::magic::{is_dicom, is_gzip};
#[cfg(feature = "dicom")]
use super::others::other_name;
use super::others::{other_kind, partner};
use super::table::{FORMATS, VolumeFormat};

use crate::crop::downsample_source;
use crate::error::{format_error, io_error};
use crate::read::naming;
use crate::read::series::is_zarr;
use crate::read::{OpenFile, raw};
use crate::source::whole_only;
use crate::{ReadOptions, Reason, Series, Source, Volume, VolumeError};

/// The number of unpacked bytes that are looked at.
const BYTES: u64 = 1024;

/// Common extensions of DICOM files. These files are recognised by their content alone.
const DICOM_EXTENSIONS: [&str; 4] = ["dcm", "dicom", "dic", "ima"];

/// Reads a volume from a file: as raw samples if a layout is given, otherwise in the format that its first bytes show, or else
/// its extension. A folder is read as the first format that it looks like.
///
/// All [`FORMATS`] are read, as far as their features were built in. Spacing, origin and directions are those of the file, in the
/// space that it means; without them, spacing is 1 and the origin 0.
///
/// The claim of a header is compared with the length of the file before memory is allocated. Samples of unsigned 8 bits are
/// marked as gray levels. Reading takes one pass, and memory for the samples and a few MB.
///
/// # Errors
/// The file cannot be read, has an unknown format, is truncated, longer than it claims or otherwise inconsistent, has an empty
/// axis or too many samples, or contains NaN or infinity. Every message names the file. [`VolumeError::Cancelled`], once a
/// [`Monitor`] that watches is cancelled.
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Volume, VolumeError> {
    let (path, monitor) = (path.as_ref(), &*Monitor::current());
    if !is_folder(path, options) {
        let file = OpenFile::open(path)?;
        return monitor.watch(|| read_file(&file, options));
    }
    let volume = format_of_folder(path).and_then(|format| {
        accept(format, path, options)?;
        let read = format.read_folder.ok_or_else(|| left_out(format, path))?;
        decoded(path, || read(path, options, monitor))
    });
    finish(path, options, volume, |error| error)
}

/// Like [`read`], for a file that is already open. A volume to be made coarser is read in parts, where its format allows that.
///
/// # Errors
/// See [`read`].
pub fn read_file(file: &OpenFile, options: &ReadOptions) -> Result<Volume, VolumeError> {
    let monitor = &*Monitor::current();
    if let Some(n) = options.downsample
        && options.region.is_none()
        && let Ok(source) = source_of(file, options)
    {
        return downsample_source(&source, n, options.nan, monitor)
            .map_err(|error| in_file(file.path(), naming_data_files(file, options, error)));
    }
    let volume = match &options.raw {
        Some(layout) => raw::read(file, layout, monitor),
        None => detect(file, options).and_then(|Detected { format, .. }| {
            accept(format, file.path(), options)?;
            let read = format.read.ok_or_else(|| left_out(format, file.path()))?;
            decoded(file.path(), || read(file, options, monitor))
        }),
    };
    finish(file.path(), options, volume, |error| naming_data_files(file, options, error))
}

/// The requested part of a volume, without NaN, which no sample beyond that part changes. Errors about samples get the names of files by
/// `name`.
fn finish(
    path: &Path,
    options: &ReadOptions,
    volume: Result<Volume, VolumeError>,
    name: impl Fn(VolumeError) -> VolumeError,
) -> Result<Volume, VolumeError> {
    let volume = volume.and_then(|volume| {
        let first = options.region.map_or([0; 3], |region| region.first);
        let part = options.cropped(volume)?;
        let finite = part.resolve_nan(options.nan).map_err(|error| name(error.moved(first)))?;
        Ok(options.coarse(finite))
    });
    volume.map_err(|error| in_file(path, error))
}

/// Adds the file to an error that does not name it.
fn in_file(path: &Path, error: VolumeError) -> VolumeError {
    match error {
        VolumeError::Io { .. }
        | VolumeError::Format { .. }
        | VolumeError::InFile { .. }
        | VolumeError::Cancelled(_) => error,
        other => VolumeError::InFile { path: path.into(), source: Box::new(other) },
    }
}

/// Adds the names of the files that hold the samples to an error about samples, if these are not in the header's file.
fn naming_data_files(file: &OpenFile, options: &ReadOptions, error: VolumeError) -> VolumeError {
    if let Ok(files) = data_files_of(file, options)
        && !files.is_empty()
    {
        return naming(file.path(), &files)(error);
    }
    let _ = (file, options);
    error
}

/// Calls a reader. A panic in a decoder of another author becomes an error of the file.
pub(crate) fn decoded<T>(
    path: &Path,
    read: impl FnOnce() -> Result<T, VolumeError>,
) -> Result<T, VolumeError> {
    decode(read)
        .unwrap_or_else(|panicked| Err(format_error(path, Reason::damaged(panicked.to_string()))))
}

/// Opens a volume to be read part by part.
pub(crate) fn source(path: &Path, options: &ReadOptions) -> Result<Source, VolumeError> {
    if is_folder(path, options) {
        let format = format_of_folder(path)?;
        accept(format, path, options)?;
        return match format.parts_of_folder {
            Some(parts) => decoded(path, || parts(path, options)),
            None => Err(whole(format, path)),
        };
    }
    source_of(&OpenFile::open(path)?, options)
}

/// Like [`source`], for a file that is already open.
pub(crate) fn source_of(file: &OpenFile, options: &ReadOptions) -> Result<Source, VolumeError> {
    if let Some(layout) = &options.raw {
        return Ok(raw::box_reader(file, layout)?.source());
    }
    let Detected { format, gzip } = detect(file, options)?;
    accept(format, file.path(), options)?;
    match format.parts {
        Some(parts) if !gzip => decoded(file.path(), || parts(file, options)),
        _ => Err(whole(format, file.path())),
    }
}

/// The error for a format that is not read part by part, or not at all in this build.
fn whole(format: &VolumeFormat, path: &Path) -> VolumeError {
    if format.is_built_in() { whole_only(path, format.name) } else { left_out(format, path) }
}

/// The error for a format that was not built in.
fn left_out(format: &VolumeFormat, path: &Path) -> VolumeError {
    let (what, feature) = (format.name, format.feature.unwrap_or_default());
    format_error(path, Reason::Without { what, feature })
}

/// Whether a path is a folder whose format is to be recognised. Bare samples are always in a file.
fn is_folder(path: &Path, options: &ReadOptions) -> bool {
    options.raw.is_none() && path.is_dir()
}

/// The name of the format of a file or folder, such as `NRRD` or `NIfTI, gzip`.
///
/// # Errors
/// The file cannot be read, or its format is not known.
pub fn format_name(path: impl AsRef<Path>, options: &ReadOptions) -> Result<String, VolumeError> {
    let path = path.as_ref();
    if is_folder(path, options) {
        return Ok(format_of_folder(path)?.folder_name.into());
    }
    format_name_of(&OpenFile::open(path)?, options)
}

/// Like [`format_name`], for a file that is already open.
pub(crate) fn format_name_of(
    file: &OpenFile,
    options: &ReadOptions,
) -> Result<String, VolumeError> {
    if options.raw.is_some() {
        return Ok("raw samples".into());
    }
    let Detected { format, gzip } = detect(file, options)?;
    Ok(if gzip { format!("{}, gzip", format.name) } else { format.name.into() })
}

/// The files that hold the samples of a volume whose header is a file of its own (NRRD, `MetaImage`, `NIfTI`); otherwise none. A
/// header may name any file, also one outside its folder.
///
/// # Errors
/// The header cannot be read.
pub fn data_files(
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<Vec<PathBuf>, VolumeError> {
    let path = path.as_ref();
    if options.raw.is_some() || !path.is_file() {
        return Ok(Vec::new());
    }
    data_files_of(&OpenFile::open(path)?, options)
}

/// Like [`data_files`], for a file that is already open.
pub(crate) fn data_files_of(
    file: &OpenFile,
    options: &ReadOptions,
) -> Result<Vec<PathBuf>, VolumeError> {
    if options.raw.is_some() {
        return Ok(Vec::new());
    }
    match detect(file, options)? {
        Detected { format: VolumeFormat { data_files: Some(data_files), .. }, gzip: false } => {
            decoded(file.path(), || data_files(file))
        }
        _ => Ok(Vec::new()),
    }
}

/// All files that a volume is read from: a file and those that its header names; for a folder, its DICOM files, its slices, or
/// all files of a Zarr store. The list is best effort: nothing is listed for a file that cannot be read.
pub fn files_of(path: &Path) -> Vec<PathBuf> {
    if path.is_dir() {
        return files_of_folder(path);
    }
    let mut files = data_files(path, &ReadOptions::default()).unwrap_or_default();
    files.push(path.to_owned());
    files
}

fn files_of_folder(folder: &Path) -> Vec<PathBuf> {
    let files = files_below(folder);
    if is_zarr(folder) {
        return files;
    }
    let is_dicom = |path: &PathBuf| OpenFile::open(path).is_ok_and(|file| is_dicom(file.start()));
    let series: Vec<PathBuf> = files.into_iter().filter(is_dicom).collect();
    if series.is_empty() {
        return crate::read::slices::slices(folder).unwrap_or_default();
    }
    series
}

/// The files in a folder and its subfolders. Links to folders are not followed, as they may form cycles.
fn files_below(folder: &Path) -> Vec<PathBuf> {
    let (mut folders, mut files) = (vec![folder.to_owned()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                folders.push(entry.path());
            } else if entry.path().is_file() {
                files.push(entry.path());
            }
        }
    }
    files
}

/// The DICOM series in a folder; none if it contains no DICOM files.
///
/// # Errors
/// The folder or a file in it cannot be read.
pub fn series(folder: impl AsRef<Path>) -> Result<Vec<Series>, VolumeError> {
    let folder = folder.as_ref();
    #[cfg(feature = "dicom")]
    return crate::read::dicom::series(folder);
    #[cfg(not(feature = "dicom"))]
    {
        let _ = folder;
        Ok(Vec::new())
    }
}

/// Whether a file with these first bytes is in a format of volumes.
pub fn begins_as_volume(start: &[u8]) -> bool {
    by_content(start).is_some()
}

/// What a file is according to its content, in words for people, if that is known.
#[cfg(feature = "dicom")]
pub(crate) fn recognised(start: &[u8]) -> Option<&'static str> {
    by_content(start).map(|format| format.name).or_else(|| other_name(start))
}

/// The error for a file of an unknown format.
fn unknown(path: &Path) -> VolumeError {
    let given = path.extension().unwrap_or_default().to_string_lossy();
    if DICOM_EXTENSIONS.iter().any(|own| given.eq_ignore_ascii_case(own)) {
        let what = format!(
            "is called .{given}, and is not a DICOM file: it has neither the mark (DICM at byte 128) nor the elements of one"
        );
        return format_error(path, Reason::other(what));
    }
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

/// A format, and whether the file is compressed as a whole.
struct Detected {
    format: &'static VolumeFormat,
    gzip: bool,
}

/// Refuses settings that the format does not use.
fn accept(format: &VolumeFormat, path: &Path, options: &ReadOptions) -> Result<(), VolumeError> {
    refuse_needless(format.chooses, path, options)
}

/// Refuses settings that a sample has no use for: those of files.
///
/// # Errors
/// One is given.
pub(crate) fn accept_sample(path: &Path, options: &ReadOptions) -> Result<(), VolumeError> {
    for (setting, given) in
        [(Setting::Dims, options.raw.is_some()), (Setting::Format, options.format.is_some())]
    {
        if given {
            let reason = Reason::needless(setting, "is a sample, and not a file");
            return Err(format_error(path, reason));
        }
    }
    refuse_needless(&[], path, options)
}

/// Refuses settings that are not among those that something is chosen by.
fn refuse_needless(
    chooses: &[Setting],
    path: &Path,
    options: &ReadOptions,
) -> Result<(), VolumeError> {
    for (setting, given) in [
        (Setting::Level, options.level.is_some()),
        (Setting::Array, options.array.is_some()),
        (Setting::Frame, options.frame.is_some()),
        (Setting::Series, options.series.is_some()),
        (Setting::SkipDamaged, options.skip_damaged),
        (Setting::NoResample, options.no_resample),
    ] {
        if given && !chooses.contains(&setting) {
            let what = match setting {
                Setting::Level => "is not a pyramid",
                Setting::Array => "has no arrays with names",
                Setting::Frame => "is in a format with a single volume",
                _ => "is not a DICOM series",
            };
            return Err(format_error(path, Reason::needless(setting, what)));
        }
    }
    Ok(())
}

/// The first format that a folder looks like.
fn format_of_folder(path: &Path) -> Result<&'static VolumeFormat, VolumeError> {
    for format in &FORMATS {
        if (format.is_folder)(path)? {
            return Ok(format);
        }
    }
    Err(io_error(path)(io::ErrorKind::IsADirectory.into()))
}

/// The format of a file. If the user states a format, it must be the same.
fn detect(file: &OpenFile, options: &ReadOptions) -> Result<Detected, VolumeError> {
    let asked = options.format.as_deref();
    let detected = detect_as(file, asked)?;
    let Detected { format, .. } = detected;
    let is_it = |asked: &str| format.extensions.iter().any(|own| own.eq_ignore_ascii_case(asked));
    // DICOM has no extension of its own.
    if asked.is_some_and(|asked| !is_it(asked) && !format.extensions.is_empty()) {
        let what = format!("is of the format {} by its content", format.name);
        return Err(format_error(file.path(), Reason::needless(Setting::Format, what)));
    }
    Ok(detected)
}

fn detect_as(file: &OpenFile, asked: Option<&str>) -> Result<Detected, VolumeError> {
    let (path, start) = (file.path(), file.start());
    if start.is_empty() {
        let reason = if file.is_ordinary() {
            Reason::content("is empty: there is no volume in it", "write it again")
        } else {
            Reason::unsupported(
                "is not an ordinary file, and volumes and laser scans (LAS, LAZ) are read in several passes",
                "copy it into one",
            )
        };
        return Err(format_error(path, reason));
    }
    if let Some(format) = by_content(start) {
        return Ok(Detected { format, gzip: false });
    }
    if let Some(reason) = other_kind(start) {
        return Err(format_error(path, reason));
    }
    if is_gzip(start) {
        return unpacked(file, asked);
    }
    #[expect(clippy::case_sensitive_file_extension_comparisons, reason = "names are in lower case")]
    if name(path, asked).ends_with(".gz") {
        let what = "is not compressed with gzip, whatever its name says";
        return Err(format_error(path, Reason::content(what, "rename it")));
    }
    let unknown =
        || partner(path).map_or_else(|| unknown(path), |reason| format_error(path, reason));
    let format = by_extension(path, asked).ok_or_else(unknown)?;
    Ok(Detected { format, gzip: false })
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

/// The file's name in lower case, with the extension that the user states, if any.
fn name(path: &Path, asked: Option<&str>) -> String {
    let own = || path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    asked.map_or_else(own, |asked| format!("it.{}", asked.to_lowercase()))
}

/// Detects the content of a gzip stream.
fn unpacked(file: &OpenFile, asked: Option<&str>) -> Result<Detected, VolumeError> {
    let path = file.path();
    // If it cannot be unpacked, the reader says why.
    let (start, failed) = file.start_unpacked(BYTES)?;
    let packed = FORMATS.iter().filter(|format| format.gzip);
    let names: Vec<&str> = packed.clone().map(|format| format.name).collect();
    let names = names.join(", ");
    let of_name = by_extension(path, asked).filter(|format| format.gzip);
    match (by_content(&start), of_name) {
        (Some(format), _) if format.gzip => Ok(Detected { format, gzip: true }),
        (Some(_), _) => {
            let what =
                format!("is a whole file compressed with gzip, which is read for {names} only");
            Err(format_error(path, Reason::unsupported(what, "unpack it first")))
        }
        (None, Some(format)) => Ok(Detected { format, gzip: true }),
        (None, None) if start.starts_with(b"LASF") => {
            let what = "is LAS or LAZ compressed with gzip once more, which is not read";
            Err(format_error(path, Reason::unsupported(what, "unpack it first")))
        }
        (None, None) => Err(format_error(
            path,
            match (failed, other_kind(&start)) {
                (Some(error), _) if error.kind() == io::ErrorKind::UnexpectedEof => {
                    Reason::truncated(
                        "is compressed with gzip, and ends inside its stream: it is truncated",
                    )
                }
                (Some(error), _) => {
                    Reason::damaged(format!("is compressed with gzip, and damaged ({error})"))
                }
                (None, Some(other)) => Reason::unsupported(
                    format!("is compressed with gzip, and what it holds {other}"),
                    other.advice(),
                ),
                (None, None) => Reason::content(
                    format!(
                        "is compressed with gzip, but holds no format that is recognised by its content: {names} \
                         are read so"
                    ),
                    "unpack it first",
                ),
            },
        )),
    }
}
