use super::FEW;
use crate::haar::Truncation;
use crate::outofcore::field::{Field, Truncated};
use crate::outofcore::passes::Passes;
use crate::outofcore::{BlocksError, Job};
use crate::select::{Counts, Search};

/// Finds which coefficients of the non-standard decomposition stay, and the sums of bricks of the truncated
/// volume.
pub(super) fn truncate(
    job: &Job,
    field: &Field,
    passes: &mut Passes<'_>,
) -> Result<(Truncation, Truncated), BlocksError> {
    let total = job.dims.samples() as u64;
    let tolerance = job.recipe.haar.tolerance;
    tolerance.check()?;
    let search = Search::new(tolerance.budget(total), FEW);
    let mut sums = vec![0.0; field.bricks.count().iter().product()];
    let mut is_first = true;
    let (cut, dropped) = search.find(|search| {
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
        counts = passes.team.reduce(counts, Counts::join);
        if is_first {
            let mine = std::mem::take(&mut sums);
            sums = passes.team.reduce(mine, |sums, others| either(sums, others));
            field.bricks.coarse(&mut sums);
            is_first = false;
        }
        counts.join(search.count(coarse(field, &sums)));
        Ok::<_, BlocksError>(counts)
    })?;
    let truncation = Truncation::new(tolerance, total, dropped);
    if truncation.epsilon == 0.0 {
        return Ok((truncation, Truncated::Same));
    }
    let kept: Vec<f64> =
        coarse(field, &sums).map(|(v, i)| if cut.keeps(v, i) { v } else { 0.0 }).collect();
    let mut sums = kept;
    field.bricks.inverse_coarse(&mut sums);
    Ok((truncation, Truncated::Bricks { cut, sums }))
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
