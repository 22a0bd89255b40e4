use serde::{Deserialize, Serialize};

use super::FEW;
use crate::outofcore::field::{Field, Sample, Truncated};
use crate::outofcore::passes::Passes;
use crate::outofcore::{BlocksError, Job};
use crate::points::{Asked, PointsError, Selection, check_least};
use crate::select::{Budget, Counts, Cut, Search};

/// Which samples are points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::outofcore) struct Chosen {
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
    pub(in crate::outofcore) fn is_point(&self, sample: &Sample) -> bool {
        let difference = Self::masked(self.gray_min, sample);
        match self.rule {
            Rule::Largest(cut) => cut.keeps(difference, sample.voxel),
            Rule::Threshold(least) => difference >= least,
        }
    }
}

/// Finds which samples are points.
pub(super) fn choose(
    job: &Job,
    field: &Field,
    truncated: &Truncated,
    passes: &mut Passes<'_>,
) -> Result<Chosen, BlocksError> {
    let Selection { rule, gray_min } = job.selection(&field.range);
    check_least(gray_min)?;
    let most = match rule.asked(job.dims.samples() as u64)? {
        Asked::Largest(most) => most,
        Asked::AtLeast(least) => return Ok(Chosen { rule: Rule::Threshold(least), gray_min }),
    };
    // The first round asks the same whatever the budget is.
    let first = Search::new(Budget::Count(0), FEW);
    let (counts, highest) = round(&first, gray_min, field, truncated, passes)?;
    let available = counts.total();
    if available == 0 {
        let least = gray_min.unwrap_or(f64::NEG_INFINITY);
        return Err(PointsError::Masked { least, highest: highest.into() }.into());
    }
    let mut search = Search::new(Budget::Count(most.not_chosen(available)?), FEW);
    search.learn(counts);
    let next = |search: &Search| Ok(round(search, gray_min, field, truncated, passes)?.0);
    let (cut, _) = search.find::<BlocksError>(next)?;
    Ok(Chosen { rule: Rule::Largest(cut), gray_min })
}

/// What a search asks next about the differences of all samples, and the highest truncated gray level.
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
                differences.push((Chosen::masked(gray_min, &sample), sample.voxel));
            })?;
            Ok((search.count(differences.into_iter()), highest))
        },
        |more| join(&mut all, more),
    )?;
    Ok(passes.team.reduce(all, join))
}
