use crate::outofcore::field::Field;
use crate::outofcore::passes::Passes;
use crate::outofcore::{BlocksError, Job};
use crate::volume::{GrayRange, Nan, VolumeError};

/// Finds the values that become gray 0 and 255.
pub(super) fn gray_levels(
    job: &Job,
    field: &mut Field,
    passes: &mut Passes<'_>,
) -> Result<(), BlocksError> {
    if field.is_gray() && job.recipe.gray.is_none() {
        return Ok(());
    }
    // Missing values must not be the least.
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
        return Err(VolumeError::NotFinite { value: f32::INFINITY, at: [0; 3] }.into());
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
