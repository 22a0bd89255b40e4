//! What a plan keeps in files beside its own: the sums of bricks, or the truncated volume.

use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Serialize};
use walpha_base::Monitor;

use super::digest::Digest;
use super::field::{Field, Truncated};
use super::file::{digest_of, numbers, read_file};
use super::passes::Passes;
use super::read_digests::ReadDigests;
use super::survey::truncated;
use super::{Alone, BlocksError, Plan, SampleBox};
use crate::export::Target;
use crate::volume::{Dims, Dtype, RawLayout, ReadOptions, Source};

/// A file that the plan has the digest of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct DigestedFile {
    pub name: String,
    pub bytes: u64,
    pub digest: Digest,
}

impl DigestedFile {
    /// Writes the sums of bricks into a folder.
    pub(super) fn write_sums(sums: &[f64], folder: &Path) -> Result<Self, BlocksError> {
        let bytes: Vec<u8> = sums.iter().flat_map(|sum| sum.to_le_bytes()).collect();
        Target::open(&folder.join(Plan::SUMS))?.write(|out| out.write_all(&bytes))?;
        let digest = Digest::of(&bytes);
        Ok(Self { name: Plan::SUMS.into(), bytes: bytes.len() as u64, digest })
    }

    /// Reads it and looks whether it is what was written.
    ///
    /// # Errors
    /// It is not, or is not there.
    pub(super) fn verify(&self, folder: &Path) -> Result<(), BlocksError> {
        let path = folder.join(&self.name);
        let found = File::open(&path).and_then(digest_of);
        match found {
            Ok((bytes, digest)) if bytes == self.bytes && self.digest.is(digest) => Ok(()),
            Ok(_) => Err(BlocksError::Damaged { path, what: Self::DAMAGED.into() }),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                Err(BlocksError::Damaged { path, what: "is not there".into() })
            }
            Err(source) => Err(BlocksError::Io { path, source }),
        }
    }

    const DAMAGED: &str = "is damaged, cut off, or of another plan";
}

impl Plan {
    pub(super) const SUMS: &str = "sums.f64";
    /// The truncated volume, of the standard decomposition.
    pub(super) const SMOOTHED: &str = "truncated.f32";

    /// The truncated volume, of which a part will be read.
    ///
    /// # Errors
    /// Its file is not there or does not verify. Of the samples in a file it is known when they were read.
    pub(super) fn truncated(&self, part: &SampleBox) -> Result<Truncated, BlocksError> {
        if let Some(cut) = self.survey.cut {
            let path = self.folder.join(Self::SUMS);
            let damaged =
                || BlocksError::Damaged { path: path.clone(), what: DigestedFile::DAMAGED.into() };
            let bytes = match read_file(&path) {
                Err(BlocksError::Io { source, .. }) if source.kind() == io::ErrorKind::NotFound => {
                    let what = "is not there".into();
                    return Err(BlocksError::Damaged { path, what });
                }
                other => other?,
            };
            let sound = self.kept.iter().any(|kept| kept.digest.is_of(&bytes));
            let bricks = Field::bricks_of(self.job.dims.xyz()).count().iter().product::<usize>();
            let sums = numbers(&bytes).filter(|sums: &Vec<f64>| sound && sums.len() == bricks);
            Ok(Truncated::Bricks { cut, sums: sums.ok_or_else(damaged)? })
        } else if self.survey.truncation.epsilon > 0.0 {
            let smoothed = Self::smoothed(&self.folder, self.job.dims);
            let (source, _) = smoothed.map_err(|error| BlocksError::Damaged {
                path: self.folder.join(Self::SMOOTHED),
                what: format!("cannot be read: {error}"),
            })?;
            let dims = self.job.dims.xyz();
            let seen = ReadDigests::none_of(part, Field::bricks_of(dims).side(), dims);
            Ok(Truncated::File(source, seen))
        } else {
            Ok(Truncated::Same)
        }
    }

    /// The truncated volume that a plan of the standard decomposition left in its folder, and that nothing
    /// was read of it.
    pub(super) fn smoothed(
        folder: &Path,
        dims: Dims,
    ) -> Result<(Source, ReadDigests), BlocksError> {
        let path = folder.join(Self::SMOOTHED);
        let options = ReadOptions::default().raw(RawLayout::new(dims, Dtype::F32));
        let source = Source::open(&path, &options)?;
        let dims = dims.xyz();
        Ok((
            source,
            ReadDigests::none_of(&SampleBox::whole(dims), Field::bricks_of(dims).side(), dims),
        ))
    }

    /// Reads the files beside the plan, and looks whether they are what was written.
    ///
    /// # Errors
    /// One is not.
    pub(super) fn verify_kept(&self) -> Result<(), BlocksError> {
        self.kept.iter().try_for_each(|kept| kept.verify(&self.folder))
    }

    /// Makes again what does not verify of the files beside the plan: sums, or the truncated volume. Reads these, and
    /// the volume a few times where that is so.
    ///
    /// # Errors
    /// As planning; the input has changed.
    pub fn restore(&self) -> Result<(), BlocksError> {
        // Of several threads that miss it, one makes it.
        static ONE: Mutex<()> = Mutex::new(());
        let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
        if self.verify_kept().is_ok() {
            return Ok(());
        }
        let mut field = Field::open(&self.job, None)?;
        (field.range, field.least) = (self.survey.range, self.survey.least);
        let tiles = SampleBox::whole(field.dims).tiles(field.tile());
        let monitor = Monitor::noop();
        let mut passes = Passes::new(&Alone, &tiles, &monitor);
        let (_, truncated, mut made) = truncated(&self.job, &field, &self.folder, &mut passes)?;
        if let Truncated::Bricks { sums, .. } = &truncated {
            made.push(DigestedFile::write_sums(sums, &self.folder)?);
        }
        if made != self.kept {
            let what = "its truncated volume is another".to_owned();
            return Err(BlocksError::changed(&self.job, what));
        }
        self.verify_kept()
    }
}
