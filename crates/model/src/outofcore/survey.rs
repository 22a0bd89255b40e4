//! Finds the numbers that depend on the whole volume, part by part.

use std::path::Path;

use serde::{Deserialize, Serialize};
use walpha_base::Monitor;
use walpha_base::advice::Setting;

use super::brick_digests::ReadDigests;
use super::field::{Field, Passes, Sample, Truncated};
use super::truncate::{DigestedFile, FEW, truncated};
use super::{BlocksError, Job, SampleBox, Team};
use walpha_points::haar::Truncation;
use walpha_points::internal::{Asked, Differences, check_least};
use walpha_points::internal::{Budget, Counts, Cut, Search};
use walpha_points::{PointsError, Selection};
use walpha_volume::{GrayRange, Nan, VolumeError};

/// Numbers that depend on the whole volume.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Survey {
    /// The values that are gray 0 and 255.
    pub range: GrayRange,
    /// The least value.
    pub(super) least: f32,
    /// The result of the truncation.
    pub truncation: Truncation,
    /// The cut that determines which coefficients stay, if blocks need it; `None` if only zeros are dropped.
    pub(super) cut: Option<Cut>,
    pub(super) choice: Criterion,
    pub(super) differences: Differences,
    /// The index in the volume of the first point.
    pub(super) first: u64,
}

/// The result of a survey, and other data that planning needs.
pub(super) struct Surveyed {
    pub survey: Survey,
    pub truncated: Truncated,
    /// The number of points in each brick.
    pub counts: Vec<u32>,
    /// The files that were written.
    pub kept: Vec<DigestedFile>,
}

/// Surveys the volume of a job, and reads it five or six times. Each process of a team reads its share of the tiles, and all get
/// the same result. For the standard decomposition, the truncated volume goes to a file in the folder.
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
        return Err(choice.none_chosen(job, &field.range).into());
    }
    join_digests(&mut field.digests, job, team)?;
    if let Truncated::File(_, digests) = &mut truncated {
        join_digests(digests, job, team)?;
    }
    let (range, least) = (field.range, field.least);
    let cut = if let Truncated::Bricks { cut, .. } = truncated { Some(cut) } else { None };
    let survey = Survey { range, least, truncation, cut, choice, differences, first };
    Ok(Surveyed { survey, truncated, counts, kept })
}

/// Joins the digests of the samples that the processes of a team read.
fn join_digests(digests: &mut ReadDigests, job: &Job, team: &dyn Team) -> Result<(), BlocksError> {
    if team.size() == 1 {
        return Ok(());
    }
    let (all, same) = team.reduce((digests.bricks(), true), |(all, same), (others, too)| {
        *same &= too & ReadDigests::join(all, &others);
    });
    if !same {
        let what = "processes read different samples at the same position".to_owned();
        return Err(BlocksError::changed(&job.input, what));
    }
    digests.take(all);
    Ok(())
}

/// Finds the values that become gray 0 and 255.
pub(super) fn gray_levels(
    job: &Job,
    field: &mut Field,
    passes: &mut Passes<'_>,
) -> Result<(), BlocksError> {
    if field.is_gray() && job.recipe.gray.is_none() {
        return Ok(());
    }
    // The placeholder for missing values must not be the least.
    field.least = f32::MAX;
    let masks = job.recipe.read.nan == Some(Nan::Mask);
    let mut found = (f32::INFINITY, f32::NEG_INFINITY);
    let wider = |a: &mut (f32, f32), b: (f32, f32)| *a = (a.0.min(b.0), a.1.max(b.1));
    passes.each(
        |tile| {
            let grays = field.values(tile)?;
            let there = |i: usize| grays.missing.as_ref().is_none_or(|missing| !missing[i]);
            let values = grays.values.iter().enumerate().filter(|(i, _)| there(*i));
            Ok(values.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), (_, &v)| {
                (low.min(v), high.max(v))
            }))
        },
        |of_tile| wider(&mut found, of_tile),
    )?;
    let (low, high) = passes.team.reduce(found, wider);
    if masks && low > high {
        return Err(VolumeError::NoFinite.into());
    }
    field.least = low;
    let Some(range) = job.recipe.gray else {
        field.range = GrayRange { low: low.into(), high: high.into() };
        return Ok(());
    };
    let fits = |sample: f32| (range.gray(sample.into()) as f32).is_finite();
    let finite = range.low.is_finite() && range.high.is_finite();
    if !(range.low < range.high && finite && fits(low) && fits(high)) {
        let GrayRange { low, high } = range;
        return Err(VolumeError::GrayRange { low, high }.into());
    }
    field.range = range;
    Ok(())
}

/// The criterion by which samples are points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Criterion {
    rule: Rule,
    /// The least truncated gray level.
    gray_min: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Rule {
    Largest(Cut),
    Threshold(f64),
}

impl Criterion {
    /// The error if no sample is a point.
    fn none_chosen(&self, job: &Job, range: &GrayRange) -> PointsError {
        let error = match self.rule {
            Rule::Threshold(least) => {
                let mask = self.gray_min.map(|_| Setting::GrayMin);
                PointsError::Threshold { least, largest: None, mask }
            }
            Rule::Largest(_) => PointsError::Empty { voxels: job.dims.samples() as u64 },
        };
        job.recipe.in_its_terms(error, range)
    }

    /// The difference of a sample that takes part, or NaN for others.
    fn masked(gray_min: Option<f64>, sample: &Sample) -> f64 {
        let out =
            sample.missing || gray_min.is_some_and(|least| f64::from(sample.smoothed) < least);
        if out { f64::NAN } else { sample.difference }
    }

    /// Whether a sample is a point.
    pub(super) fn is_point(&self, sample: &Sample) -> bool {
        let difference = Self::masked(self.gray_min, sample);
        match self.rule {
            Rule::Largest(cut) => cut.keeps(difference, sample.voxel),
            Rule::Threshold(least) => difference >= least,
        }
    }
}

/// Finds the criterion by which samples are points.
pub(super) fn choose(
    job: &Job,
    field: &Field,
    truncated: &Truncated,
    passes: &mut Passes<'_>,
) -> Result<Criterion, BlocksError> {
    let Selection { rule, gray_min, .. } = job.selection(&field.range);
    let told = |error| BlocksError::from(job.recipe.in_its_terms(error, &field.range));
    check_least(gray_min).map_err(told)?;
    let most = match rule.asked(job.dims.samples() as u64)? {
        Asked::Largest(most) => most,
        Asked::AtLeast(least) => return Ok(Criterion { rule: Rule::Threshold(least), gray_min }),
    };
    // The first round does not depend on the budget.
    let first = Search::new(Budget::Count(0), FEW);
    let (counts, highest) = round(&first, gray_min, field, truncated, passes)?;
    let available = counts.total();
    if available == 0 {
        let masked = |least| PointsError::Masked { least, highest: highest.into() };
        let empty = PointsError::Empty { voxels: job.dims.samples() as u64 };
        return Err(told(gray_min.map_or(empty, masked)));
    }
    let left = most.not_chosen(available, available - counts.zeros()).map_err(told)?;
    let mut search = Search::new(Budget::Count(left), FEW);
    search.learn(counts);
    let next = |search: &Search| Ok(round(search, gray_min, field, truncated, passes)?.0);
    let (cut, _) = search.find::<BlocksError>(next)?;
    Ok(Criterion { rule: Rule::Largest(cut), gray_min })
}

/// Performs one round of a search over the differences of all samples, and finds the highest truncated gray level.
fn round(
    search: &Search,
    gray_min: Option<f64>,
    field: &Field,
    truncated: &Truncated,
    passes: &mut Passes<'_>,
) -> Result<(Counts, f32), BlocksError> {
    let join = |all: &mut (Counts, f32), (more, high): (Counts, f32)| {
        all.0.join(more);
        all.1 = all.1.max(high);
    };
    let mut all = (Counts::default(), f32::NEG_INFINITY);
    passes.each(
        |tile| {
            let mut differences = Vec::new();
            differences.reserve_exact(tile.samples());
            let mut highest = f32::NEG_INFINITY;
            field.samples(tile, truncated, |sample| {
                highest = highest.max(sample.smoothed);
                differences.push((Criterion::masked(gray_min, &sample), sample.voxel));
            })?;
            Ok((search.count(differences.into_iter()), highest))
        },
        |more| join(&mut all, more),
    )?;
    Ok(passes.team.reduce(all, join))
}

/// The statistics of all points.
#[derive(Serialize, Deserialize)]
pub(super) struct Counted {
    pub(super) differences: Differences,
    /// The index in the volume of the first point.
    pub(super) first: u64,
    /// The number of points in each brick.
    pub(super) counts: Vec<u32>,
}

impl Counted {
    fn join(&mut self, other: Self) {
        self.differences.join(&other.differences);
        self.first = self.first.min(other.first);
        self.counts.iter_mut().zip(other.counts).for_each(|(count, more)| *count += more);
    }
}

/// Computes the statistics of all points.
pub(super) fn count(
    field: &Field,
    truncated: &Truncated,
    choice: &Criterion,
    passes: &mut Passes<'_>,
) -> Result<Counted, BlocksError> {
    let ([cx, cy, _], side) = (field.bricks.count(), field.bricks.side());
    let counts = vec![0; field.bricks.count().iter().product()];
    let mut all = Counted { differences: Differences::default(), first: u64::MAX, counts };
    passes.each(
        |tile| {
            let mut points = Vec::new();
            field.samples(tile, truncated, |sample| {
                if choice.is_point(&sample) {
                    points.push((sample.voxel, sample.difference));
                }
            })?;
            let of_points: Vec<f64> = points.iter().map(|&(_, difference)| difference).collect();
            let voxels: Vec<u64> = points.into_iter().map(|(voxel, _)| voxel).collect();
            Ok((Differences::of(&of_points), voxels))
        },
        |(more, voxels)| {
            all.differences.join(&more);
            all.first = all.first.min(voxels.first().copied().unwrap_or(u64::MAX));
            let [nx, ny, _] = field.dims;
            for voxel in voxels {
                let voxel = voxel as usize;
                let [x, y, z] = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)].map(|i| i / side);
                all.counts[(z * cy + y) * cx + x] += 1;
            }
        },
    )?;
    Ok(passes.team.reduce(all, Counted::join))
}
