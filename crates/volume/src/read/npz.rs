use std::io::{Read, Seek};
use std::path::Path;

use walpha_base::Monitor;
use walpha_base::advice::{Setting, advice};
use walpha_base::npy::Header;
use walpha_base::shown::shown;
use zip::ZipArchive;
use zip::result::ZipError;

use super::OpenFile;
use super::npy::{self, NpyFile};
use super::payload::MOST_EXPANSION;
use crate::error::{format_error, io_error};
use crate::formats::OF_SIMPLICES;
use crate::{Reason, Volume, VolumeError};

/// Reads NPZ, `NumPy`'s archive of arrays (`savez`, `savez_compressed`): its only array of three axes, or the array with this
/// name.
pub(crate) fn read(
    file: &OpenFile,
    wanted: Option<&str>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let (path, length) = (file.path(), file.length());
    let mut archive = ZipArchive::new(file.reader()?).map_err(damaged(path))?;
    let files: Vec<String> = archive.file_names().map(|name| shown(Path::new(name))).collect();
    if !files.is_empty() && !files.iter().any(|name| is_array(name)) {
        let others = if files.len() > 1 {
            format!(" and {} others", files.len() - 1)
        } else {
            String::new()
        };
        let what = format!("is a zip archive of {}{others}, and of no array (.npy)", files[0]);
        return Err(format_error(
            path,
            Reason::unsupported(what, "unpack it, and name the file in it"),
        ));
    }
    let mut found: Vec<(usize, String)> = Vec::new();
    let mut refused = Vec::new();
    for i in 0..archive.len() {
        let is_wanted =
            |name: &str| wanted.is_none_or(|wanted| name.strip_suffix(".npy") == Some(wanted));
        let is_candidate =
            archive.name_for_index(i).is_some_and(|name| is_array(name) && is_wanted(name));
        if !is_candidate {
            continue;
        }
        match member(path, &mut archive, i, length) {
            Ok((name, array)) if array.shape.len() == 3 => found.push((i, name)),
            // An array of texts or objects may accompany the volume.
            Err(error @ VolumeError::Format { reason: Reason::Unsupported { .. }, .. })
                if wanted.is_none() =>
            {
                refused.push((i, error));
            }
            Ok(_) => {}
            Err(error) => return Err(error),
        }
    }
    if found.is_empty() {
        for (i, error) in refused {
            let mut member = archive.by_index(i).map_err(damaged(path))?;
            if Header::read(&mut member).is_ok_and(|header| header.shape.len() == 3) {
                return Err(error);
            }
        }
    }
    match found.as_slice() {
        [(i, _)] => {
            let array = member(path, &mut archive, *i, length)?.1;
            npy::warn_of_channels(path, &array.shape);
            npy::volume(path, array, monitor)
        }
        [] => Err(format_error(
            path,
            match wanted {
                Some(name) => Reason::choice(
                    Setting::Array,
                    format!("holds no array {name:?} of three axes"),
                    advice!["name another with ", Setting::Array],
                ),
                None if files.iter().any(|name| name == "cells.npy") => Reason::content(
                    "holds the simplices of a shape or a filtration, and no volume",
                    OF_SIMPLICES,
                ),
                None => Reason::content(
                    "holds no array of three axes: there is no volume in it",
                    "name another file",
                ),
            },
        )),
        several => {
            let names: Vec<&str> = several.iter().map(|(_, name)| name.as_str()).collect();
            Err(format_error(
                path,
                Reason::choice(
                    Setting::Array,
                    format!("holds several arrays of three axes, {}", names.join(", ")),
                    advice!["choose one with ", Setting::Array],
                ),
            ))
        }
    }
}

/// Whether a file of the archive is an array, according to its name.
#[expect(clippy::case_sensitive_file_extension_comparisons, reason = "NumPy writes no other")]
fn is_array(name: &str) -> bool {
    name.ends_with(".npy")
}

/// Opens an array of the archive at its first element.
fn member<'a>(
    path: &Path,
    archive: &'a mut ZipArchive<impl Read + Seek>,
    i: usize,
    length: u64,
) -> Result<(String, NpyFile<impl Read + 'a>), VolumeError> {
    let member = archive.by_index(i).map_err(damaged(path))?;
    let name = member.name().to_owned();
    let most = member.compressed_size().min(length).saturating_mul(MOST_EXPANSION);
    if member.size() > most.saturating_add(MOST_EXPANSION) {
        let reason = Reason::damaged(format!(
            "claims {} bytes for its array {name}, more than {length} bytes can hold",
            member.size()
        ));
        return Err(format_error(path, reason));
    }
    let size = member.size();
    Ok((name, NpyFile::of(path, member, size)?))
}

fn damaged(path: &Path) -> impl Fn(ZipError) -> VolumeError {
    move |error| match error {
        ZipError::Io(error) => io_error(path)(error),
        ZipError::UnsupportedArchive(what) => {
            let what = format!("is a zip archive of a kind that is not read: {what}");
            format_error(path, Reason::unsupported(what, "save it anew by numpy.savez"))
        }
        ZipError::InvalidArchive(what) => {
            let what = format!(
                "begins as a zip archive, and cannot be read as one ({what}): it may be truncated"
            );
            format_error(path, Reason::claims_more(what))
        }
        other => format_error(
            path,
            Reason::other(format!("is not an NPZ archive that can be read: {other}")),
        ),
    }
}
