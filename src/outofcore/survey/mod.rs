//! The numbers that depend on the whole volume, found part by part.

mod choose;
mod count;
mod gray;
mod slabs;
mod truncate;

use std::path::Path;

use serde::{Deserialize, Serialize};
use walpha_base::Monitor;

use super::digested::DigestedFile;
use super::field::{Field, Truncated};
use super::passes::Passes;
use super::read_digests::ReadDigests;
use super::{BlocksError, Job, SampleBox, Team};
use crate::haar::{Decomposition, Truncation};
use crate::points::{Differences, PointsError};
use crate::select::Cut;
use crate::volume::GrayRange;

use choose::{Chosen, choose};
use count::{Counted, count};
use gray::gray_levels;
use slabs::truncate_to_file;
use truncate::truncate;

/// Values that a cut is looked for among are listed when so few are left: 64 MB.
const FEW: u64 = 1 << 22;

/// What is known of a volume as a whole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Survey {
    /// The values that are gray 0 and 255.
    pub range: GrayRange,
    /// The least value.
    pub(super) least: f32,
    /// What was dropped.
    pub truncation: Truncation,
    /// Which coefficients stay, where blocks need it: not where nothing but zeros goes.
    pub(super) cut: Option<Cut>,
    pub(super) choice: Chosen,
    pub(super) differences: Differences,
    /// The first of the points, by its index in the volume.
    pub(super) first: u64,
}

/// What a survey leaves beside itself.
pub(super) struct Surveyed {
    pub survey: Survey,
    pub truncated: Truncated,
    /// How many points each brick has.
    pub counts: Vec<u32>,
    /// Files that are written.
    pub kept: Vec<DigestedFile>,
}

/// Surveys the volume of a job: reads it five or six times. Each process of a team reads its share of the
/// tiles, and all come to know the same. Of the standard decomposition the truncated volume goes to a file in
/// the folder.
pub(super) fn survey(
    job: &Job,
    field: &mut Field,
    folder: &Path,
    team: &dyn Team,
    monitor: &Monitor,
) -> Result<Surveyed, BlocksError> {
    let tiles = SampleBox::whole(field.dims).tiles(field.tile());
    let mut passes = Passes::new(team, &tiles, monitor);
    gray_levels(job, field, &mut passes)?;
    let (truncation, mut truncated, kept) = truncated(job, field, folder, &mut passes)?;
    let choice = choose(job, field, &truncated, &mut passes)?;
    let Counted { differences, first, counts } = count(field, &truncated, &choice, &mut passes)?;
    if differences.count == 0 {
        return Err(PointsError::Empty { voxels: job.dims.samples() as u64 }.into());
    }
    all_saw(&mut field.seen, job, team)?;
    if let Truncated::File(_, seen) = &mut truncated {
        all_saw(seen, job, team)?;
    }
    let (range, least) = (field.range, field.least);
    let cut = if let Truncated::Bricks { cut, .. } = truncated { Some(cut) } else { None };
    let survey = Survey { range, least, truncation, cut, choice, differences, first };
    Ok(Surveyed { survey, truncated, counts, kept })
}

/// Truncates the volume of a job whose gray levels are known, and gives what is kept in a file.
pub(super) fn truncated(
    job: &Job,
    field: &Field,
    folder: &Path,
    passes: &mut Passes<'_>,
) -> Result<(Truncation, Truncated, Vec<DigestedFile>), BlocksError> {
    match job.recipe.haar.decomposition {
        Decomposition::NonStandard => {
            let (truncation, truncated) = truncate(job, field, passes)?;
            Ok((truncation, truncated, Vec::new()))
        }
        Decomposition::Standard => truncate_to_file(job, field, folder, passes),
    }
}

/// Joins what the processes of a team read.
fn all_saw(seen: &mut ReadDigests, job: &Job, team: &dyn Team) -> Result<(), BlocksError> {
    if team.size() == 1 {
        return Ok(());
    }
    let (all, same) = team.reduce((seen.bricks(), true), |(all, same), (others, too)| {
        *same &= too & ReadDigests::join(all, &others);
    });
    if !same {
        let what = "processes read other samples at one place".to_owned();
        return Err(BlocksError::changed(job, what));
    }
    seen.take(all);
    Ok(())
}
