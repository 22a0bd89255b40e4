use std::io::{Read, Seek};
use std::path::Path;

use walpha_base::Monitor;
use walpha_base::advice::{Setting, advice};
use zip::ZipArchive;
use zip::result::ZipError;

use super::OpenFile;
use super::npy::{self, NpyFile};
use super::payload::MOST_EXPANSION;
use crate::error::{format_error, io_error};
use crate::{Reason, Volume, VolumeError};

/// Reads NPZ, `NumPy`'s archive of arrays (`savez`, `savez_compressed`): its only array of three axes, or
/// the one of this name.
pub(crate) fn read(
    file: &OpenFile,
    wanted: Option<&str>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let (path, length) = (file.path(), file.length());
    let mut archive = ZipArchive::new(file.reader()?).map_err(damaged(path))?;
    let mut found: Vec<(usize, String)> = Vec::new();
    for i in 0..archive.len() {
        let (name, array) = member(path, &mut archive, i, length)?;
        let named = |wanted: &str| name.strip_suffix(".npy").unwrap_or(&name) == wanted;
        if array.shape.len() == 3 && wanted.is_none_or(named) {
            found.push((i, name));
        }
    }
    match found.as_slice() {
        [(i, _)] => npy::volume(path, member(path, &mut archive, *i, length)?.1, monitor),
        [] => Err(format_error(
            path,
            match wanted {
                Some(name) => Reason::choice(
                    Setting::Array,
                    format!("holds no array {name:?} of three axes"),
                    advice!["name another with ", Setting::Array],
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

/// An array of the archive, at its first element.
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
            "claims {} bytes for its array {name}, more than {length} bytes can hold: it is \
                 damaged",
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
        other => format_error(
            path,
            Reason::other(format!("is no NPZ archive that can be read: {other}")),
        ),
    }
}
