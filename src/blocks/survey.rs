//! The numbers that depend on the whole volume, found part by part.

use serde::{Deserialize, Serialize};

use super::field::{Field, Sample, Truncated};
use super::passes::Passes;
use super::{BlocksError, Job, Part, Team};
use crate::haar::Truncation;
use crate::points::{Differences, PointsError, SelectionRule};
use crate::select::{Budget, Counts, Cut, Search};
use crate::volume::{GrayRange, Nan, VolumeError};

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
    /// Which coefficients stay; `None` where nothing but zeros goes.
    pub(super) cut: Option<Cut>,
    pub(super) choice: Chosen,
    pub(super) differences: Differences,
    /// The first of the points, by its index in the volume.
    pub(super) first: u64,
}

/// Which samples are points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Chosen {
    rule: Rule,
    /// The least truncated gray level.
    gray_min: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Rule {
    Largest(Cut),
    Threshold(f64),
}

impl Chosen {
    /// The difference of a sample that takes part, else NaN.
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

/// What a survey leaves beside itself.
pub(super) struct Surveyed {
    pub survey: Survey,
    /// The sums of the bricks of the truncated volume; none where that is the volume.
    pub sums: Vec<f64>,
    /// How many points each brick has.
    pub counts: Vec<u32>,
}

/// Surveys the volume of a job: reads it five or six times. Each process of a team reads its share of the
/// tiles, and all come to know the same.
pub(super) fn survey(
    job: &Job,
    field: &mut Field,
    team: &dyn Team,
) -> Result<Surveyed, BlocksError> {
    let tiles = Part::whole(field.dims).tiles(field.tile());
    let mut passes = Passes::new(team, &tiles);
    gray_levels(job, field, &mut passes)?;
    let (truncation, cut, sums) = truncate(job, field, &mut passes)?;
    let truncated = cut.map(|cut| Truncated { cut, sums: &sums });
    let choice = choose(job, field, truncated, &mut passes)?;
    let Counted { differences, first, counts } = count(field, truncated, &choice, &mut passes)?;
    if differences.count == 0 {
        return Err(PointsError::Empty { voxels: job.dims.samples() as u64 }.into());
    }
    let (range, least) = (field.range, field.least);
    let survey = Survey { range, least, truncation, cut, choice, differences, first };
    Ok(Surveyed { survey, sums, counts })
}

/// Finds the values that become gray 0 and 255.
fn gray_levels(job: &Job, field: &mut Field, passes: &mut Passes<'_>) -> Result<(), BlocksError> {
    if field.is_gray() && job.gray.is_none() {
        return Ok(());
    }
    // Missing values must not be the least.
    field.least = f32::MAX;
    let masks = job.read.nan == Some(Nan::Mask);
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
    let (low, high) = passes.team.joined(found, wider);
    if masks && low > high {
        return Err(VolumeError::NotFinite { value: f32::INFINITY, at: [0; 3] }.into());
    }
    field.least = low;
    let Some(range) = job.gray else {
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

/// Finds which coefficients stay, and the sums of bricks of the truncated volume.
fn truncate(
    job: &Job,
    field: &Field,
    passes: &mut Passes<'_>,
) -> Result<(Truncation, Option<Cut>, Vec<f64>), BlocksError> {
    let total = job.dims.samples() as u64;
    let tolerance = job.haar.tolerance;
    tolerance.check()?;
    let mut search = Search::new(tolerance.budget(total), FEW);
    let mut sums = vec![0.0; field.bricks.count().iter().product()];
    let mut is_first = true;
    let found = loop {
        if let Some(found) = search.found() {
            break found;
        }
        let mut counts = Counts::default();
        passes.each(
            |tile| {
                let values = field.coefficients(tile, &field.grays(tile)?.values);
                let (mut details, mut firsts) = (Vec::new(), Vec::new());
                details.reserve_exact(values.len());
                field.places(tile, |place, voxel, brick| match brick {
                    Some(brick) => firsts.push((brick, values[place])),
                    None => details.push((values[place], voxel)),
                });
                Ok((search.count(details.into_iter()), firsts))
            },
            |(more, firsts)| {
                counts.join(more);
                if is_first {
                    firsts.into_iter().for_each(|(brick, sum)| sums[brick] = sum);
                }
            },
        )?;
        counts = passes.team.joined(counts, Counts::join);
        if is_first {
            sums = passes.team.joined(sums, |sums, others| either(sums, others));
            field.bricks.coarse(&mut sums);
            is_first = false;
        }
        counts.join(search.count(coarse(field, &sums)));
        search.learn(counts);
    };
    let (cut, dropped) = found;
    let truncation = Truncation::new(tolerance, total, dropped);
    if truncation.epsilon == 0.0 {
        return Ok((truncation, None, Vec::new()));
    }
    let kept: Vec<f64> =
        coarse(field, &sums).map(|(v, i)| if cut.keeps(v, i) { v } else { 0.0 }).collect();
    let mut sums = kept;
    field.bricks.inverse_coarse(&mut sums);
    Ok((truncation, Some(cut), sums))
}

/// Takes in sums of other bricks: those of which nothing is known are positive zeros.
fn either(sums: &mut [f64], others: Vec<f64>) {
    let known = sums.iter_mut().zip(others).filter(|(_, other)| other.to_bits() != 0);
    known.for_each(|(sum, other)| *sum = other);
}

/// The coefficients of levels above bricks, with their places in the volume.
fn coarse<'a>(field: &'a Field, sums: &'a [f64]) -> impl Iterator<Item = (f64, u64)> + 'a {
    let ([cx, cy, _], side) = (field.bricks.count(), field.bricks.side());
    sums.iter().enumerate().map(move |(brick, &value)| {
        let at = [brick % cx, brick / cx % cy, brick / (cx * cy)].map(|i| i * side);
        (value, field.voxel(at))
    })
}

/// Finds which samples are points.
fn choose(
    job: &Job,
    field: &Field,
    truncated: Option<Truncated<'_>>,
    passes: &mut Passes<'_>,
) -> Result<Chosen, BlocksError> {
    let gray_min = job.selection.gray_min.or(job.value_min.map(|value| field.range.gray(value)));
    if gray_min.is_some_and(f64::is_nan) {
        let (what, given, need) = ("a least gray level of", f64::NAN, "a number");
        return Err(PointsError::Number { what, given, need }.into());
    }
    let voxels = job.dims.samples() as u64;
    let count = match job.selection.rule {
        SelectionRule::Count(count) => count,
        SelectionRule::Ratio(ratio) if ratio > 0.0 && ratio <= 1.0 => {
            ((ratio * voxels as f64).round() as u64).clamp(1, voxels)
        }
        SelectionRule::Ratio(given) => {
            let need = "a share above 0 and up to 1, as in 0.0609 for 6.09 %";
            return Err(PointsError::Number { what: "a ratio of", given, need }.into());
        }
        SelectionRule::Threshold(given) if given.is_nan() => {
            let need = "a number of gray levels";
            return Err(PointsError::Number { what: "a threshold of", given, need }.into());
        }
        SelectionRule::Threshold(least) => {
            return Ok(Chosen { rule: Rule::Threshold(least), gray_min });
        }
    };
    let mut search: Option<Search> = None;
    loop {
        if let Some((cut, _)) = search.as_ref().and_then(Search::found) {
            return Ok(Chosen { rule: Rule::Largest(cut), gray_min });
        }
        // The first round asks the same whatever the budget is.
        let round = search.clone().unwrap_or_else(|| Search::new(Budget::Count(0), FEW));
        let (mut counts, mut highest) = (Counts::default(), f32::NEG_INFINITY);
        passes.each(
            |tile| {
                let mut differences = Vec::new();
                differences.reserve_exact(tile.samples());
                let mut highest = f32::NEG_INFINITY;
                field.samples(tile, truncated, |sample| {
                    highest = highest.max(sample.smoothed);
                    differences.push((Chosen::masked(gray_min, &sample), sample.voxel));
                })?;
                Ok((round.count(differences.into_iter()), highest))
            },
            |(more, high)| {
                counts.join(more);
                highest = highest.max(high);
            },
        )?;
        let joined = |all: &mut (Counts, f32), (more, high): (Counts, f32)| {
            all.0.join(more);
            all.1 = all.1.max(high);
        };
        let (counts, highest) = passes.team.joined((counts, highest), joined);
        let available = counts.total();
        let search = search.get_or_insert_with(|| {
            Search::new(Budget::Count(available.saturating_sub(count)), FEW)
        });
        if search.is_new() {
            if available == 0 {
                let least = gray_min.unwrap_or(f64::NEG_INFINITY);
                return Err(PointsError::Masked { least, highest: highest.into() }.into());
            }
            if count == 0 || count > available {
                return Err(PointsError::Count { asked: count, available }.into());
            }
        }
        search.learn(counts);
    }
}

/// What is known of the points together.
#[derive(Serialize, Deserialize)]
struct Counted {
    differences: Differences,
    /// The first of them, by its index in the volume.
    first: u64,
    /// How many each brick has.
    counts: Vec<u32>,
}

impl Counted {
    fn join(&mut self, other: Self) {
        self.differences.join(&other.differences);
        self.first = self.first.min(other.first);
        self.counts.iter_mut().zip(other.counts).for_each(|(count, more)| *count += more);
    }
}

fn count(
    field: &Field,
    truncated: Option<Truncated<'_>>,
    choice: &Chosen,
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
    Ok(passes.team.joined(all, Counted::join))
}
