use std::io::{self, Read};
use std::path::Path;

use super::payload::{Length, unreadable};
use crate::error::format_error;
use crate::{Reason, VolumeError};

/// The volume of a file that is read, if a fourth axis (or further axes) counts several, one after the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameChoice {
    pub index: u64,
    pub count: u64,
}

impl FrameChoice {
    /// The only volume of a file.
    pub(super) const ONE: Self = Self { index: 0, count: 1 };

    /// Chooses the volume asked for in a file whose axes beyond the third have these sizes.
    pub(super) fn choose(
        path: &Path,
        beyond: &[u64],
        asked: Option<u64>,
    ) -> Result<Self, VolumeError> {
        let count = beyond.iter().try_fold(1u64, |product, &size| product.checked_mul(size));
        let count = count.unwrap_or(u64::MAX);
        match asked {
            Some(index) if index < count => Ok(Self { index, count }),
            None if count == 1 => Ok(Self::ONE),
            None if count == 0 => {
                Err(format_error(path, Reason::header("has an axis without samples")))
            }
            _ => Err(format_error(path, Reason::Several { count })),
        }
    }

    /// Moves a reader of all volumes, of `each` bytes, to the chosen one.
    pub(super) fn select<R: Read>(
        self,
        path: &Path,
        mut reader: R,
        length: Length,
        each: u64,
    ) -> Result<(io::Take<R>, Length), VolumeError> {
        let (skip, all) = (self.index.saturating_mul(each), self.count.saturating_mul(each));
        let left = match length {
            Length::Exactly(bytes) if self.count > 1 && bytes != all => {
                let claim = format!("{} volumes", self.count);
                let reason = Reason::Length { claim, needed: all, found: bytes, bound: "" };
                return Err(format_error(path, reason));
            }
            Length::Exactly(_) if self.count > 1 => Length::Exactly(each),
            other => other.minus(skip),
        };
        io::copy(&mut (&mut reader).take(skip), &mut io::sink()).map_err(unreadable(path))?;
        // A single volume must be all that the file contains.
        let most = if self.count > 1 { each } else { u64::MAX };
        Ok((reader.take(most), left))
    }
}
