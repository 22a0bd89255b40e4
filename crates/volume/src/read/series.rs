//! The content of a folder: a Zarr store, or the files of DICOM series.

use std::fmt;
use std::fs::{DirEntry, File, ReadDir};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use serde::Serialize;
use walpha_base::shown::shown;

#[cfg(feature = "dicom")]
use crate::Reason;
use crate::VolumeError;
#[cfg(feature = "dicom")]
use crate::error::format_error;
use crate::error::io_error;
use crate::formats::is_dicom;

/// A series of slices in a folder (DICOM).
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Series {
    /// Its number among the series of the folder, from 1.
    pub number: usize,
    /// Its UID.
    pub uid: String,
    /// The modality, such as CT or MR.
    pub modality: String,
    /// The description of the series in its files.
    pub description: String,
    /// The columns and rows of the first slice.
    pub size: [u64; 2],
    /// The number of its slices.
    pub slices: usize,
    /// The first of its files.
    pub file: PathBuf,
}

impl fmt::Display for Series {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { number, uid, modality, description, size: [columns, rows], slices, file } = self;
        let called = [modality, description].map(String::as_str).join(" ");
        let comma = if called.trim().is_empty() { "" } else { ", " };
        let called = called.trim();
        write!(f, "{number}: {called}{comma}{slices} slices of {columns}×{rows}, {uid}, as ")?;
        f.write_str(&shown(file))
    }
}

/// Whether a folder is a Zarr array or group.
pub(crate) fn is_zarr(folder: &Path) -> bool {
    [".zarray", ".zgroup", "zarr.json"].iter().any(|name| folder.join(name).is_file())
}

/// The first DICOM file in a folder or its subfolders, among the first entries.
pub(crate) fn first(folder: &Path) -> Result<Option<PathBuf>, VolumeError> {
    Walk::new(folder, true).next().transpose()
}

/// The DICOM files of a folder, and possibly damaged ones.
#[cfg(feature = "dicom")]
pub(super) struct Files {
    /// The DICOM files, recognised by content, in the order of their names.
    pub dicom: Vec<PathBuf>,
    /// Empty files, files that begin with zeros only, and files called .dcm, if their names end as those of the DICOM files do.
    pub suspects: Vec<PathBuf>,
}

/// The DICOM files of a folder and, if wanted, of its subfolders.
#[cfg(feature = "dicom")]
pub(super) fn files(folder: &Path, nested: bool) -> Result<Files, VolumeError> {
    let mut walk = Walk::new(folder, nested);
    let mut dicom = walk.by_ref().collect::<Result<Vec<_>, _>>()?;
    if walk.is_cut_short && !dicom.is_empty() {
        let reason = Reason::unsupported(
            format!(
                "holds DICOM files among more than {MOST_OTHERS} others, which are not all looked at"
            ),
            "name the folder of the series",
        );
        return Err(format_error(folder, reason));
    }
    dicom.sort();
    let mut suspects = walk.suspects;
    suspects.retain(|suspect| dicom.iter().any(|other| other.extension() == suspect.extension()));
    suspects.sort();
    Ok(Files { dicom, suspects })
}

/// The largest number of successive entries that are looked at without finding a DICOM file: a folder may be that of the whole
/// disk.
const MOST_OTHERS: usize = 10_000;

/// Iterates over DICOM files. Links to folders are not followed, as they may form cycles.
struct Walk {
    nested: bool,
    folders: Vec<PathBuf>,
    /// The remaining entries of the open folder.
    entries: Option<(PathBuf, ReadDir)>,
    /// The number of entries since the last DICOM file.
    others: usize,
    /// Whether there were too many entries.
    is_cut_short: bool,
    /// Files that may be damaged DICOM files.
    suspects: Vec<PathBuf>,
}

impl Walk {
    fn new(folder: &Path, nested: bool) -> Self {
        let (folders, suspects) = (vec![folder.to_owned()], Vec::new());
        Self { nested, folders, entries: None, others: 0, is_cut_short: false, suspects }
    }

    /// The next entry, and its folder.
    fn entry(&mut self) -> Option<Result<DirEntry, VolumeError>> {
        loop {
            let (folder, entries) = if let Some(open) = &mut self.entries {
                open
            } else {
                let folder = self.folders.pop()?;
                match std::fs::read_dir(&folder) {
                    Ok(entries) => self.entries.insert((folder, entries)),
                    Err(error) => return Some(Err(io_error(&folder)(error))),
                }
            };
            match entries.next() {
                Some(entry) => return Some(entry.map_err(io_error(folder))),
                None => self.entries = None,
            }
        }
    }
}

impl Iterator for Walk {
    type Item = Result<PathBuf, VolumeError>;

    fn next(&mut self) -> Option<Self::Item> {
        while self.others < MOST_OTHERS {
            let entry = match self.entry()? {
                Ok(entry) => entry,
                Err(error) => return Some(Err(error)),
            };
            self.others += 1;
            let path = entry.path();
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                if self.nested {
                    self.folders.push(path);
                }
                continue;
            }
            match path.is_file().then(|| kind(&path)) {
                Some(Ok(Kind::Dicom)) => {
                    self.others = 0;
                    return Some(Ok(path));
                }
                Some(Ok(Kind::Suspect)) => self.suspects.push(path),
                _ => {}
            }
        }
        self.is_cut_short = true;
        None
    }
}

/// The kind of a file, according to its first bytes.
enum Kind {
    Dicom,
    /// A file that may be a damaged DICOM file.
    Suspect,
    Other,
}

fn kind(path: &Path) -> io::Result<Kind> {
    let mut start = Vec::new();
    File::open(path)?.take(1024).read_to_end(&mut start)?;
    if is_dicom(&start) {
        return Ok(Kind::Dicom);
    }
    let is_hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
    let is_called_so =
        path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("dcm"));
    let is_suspect = !is_hidden && (is_called_so || start.iter().all(|&byte| byte == 0));
    Ok(if is_suspect { Kind::Suspect } else { Kind::Other })
}
