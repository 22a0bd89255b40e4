//! From an input to weighted points, with what is to be told about the way.

use std::path::Path;

use walpha::interpolate::adaptive_voxels;
use walpha::points::{is_point_file, read_points, weigh};
use walpha::{
    GrayRange, Points, Truncation, Volume, WeightedPoints, Weighting, haar, points, volume,
};

use super::args::{InputArgs, PipelineArgs};
use super::progress::Progress;

/// What INPUT turned out to be.
pub enum Input {
    /// A grid of gray levels, and the values they came from.
    Volume(Volume, GrayRange),
    /// Points, with weights and values perhaps.
    Points(Points),
}

/// Reads INPUT.
pub fn read(args: &InputArgs, progress: &mut Progress) -> anyhow::Result<Input> {
    progress.stage("read", || {
        if is_points(args)? {
            return Ok(Input::Points(read_points(Path::new(&args.input))?));
        }
        let (volume, range) = volume::open(&args.input, &args.options())?.into_gray(args.gray())?;
        Ok(Input::Volume(volume, range))
    })
}

/// Whether INPUT is a point file.
pub fn is_points(args: &InputArgs) -> anyhow::Result<bool> {
    let volume = args.input.starts_with("sample:") || args.options().raw.is_some();
    Ok(!volume && is_point_file(Path::new(&args.input))?)
}

/// Weighted points and what is to be told about them.
pub struct Weighed {
    pub points: WeightedPoints,
    pub weighting: Weighting,
    pub volume: Option<VolumeFacts>,
}

/// What is to be told about a volume.
pub struct VolumeFacts {
    pub dims: [usize; 3],
    pub range: GrayRange,
    pub truncation: Truncation,
}

/// Steps 1 to 7: reads INPUT and makes weighted points of it.
pub fn weighted_points(args: &PipelineArgs, progress: &mut Progress) -> anyhow::Result<Weighed> {
    Ok(points_and_volume(args, progress)?.0)
}

/// The same, with the gray levels of the volume they come from.
pub fn points_and_volume(
    args: &PipelineArgs,
    progress: &mut Progress,
) -> anyhow::Result<(Weighed, Option<Volume>)> {
    let PipelineArgs { input, haar, select, weights } = args;
    let (mut points, volume) = match read(input, progress)? {
        Input::Points(points) => (points, None),
        Input::Volume(volume, range) => {
            let options = haar.options();
            let (smoothed, truncation) =
                progress.stage("haar", || haar::smooth(&volume, &options))?;
            let selected =
                progress.stage("points", || selected_points(&volume, &smoothed, select))?;
            let facts = VolumeFacts { dims: volume.dims().xyz(), range, truncation };
            (selected, Some((facts, volume)))
        }
    };
    let weighting = weights.weighting(points.weights.is_some());
    let points = progress.stage("points", || {
        let scattered = points.differences.is_none() && points.values.is_some();
        if scattered && weighting.needs_differences() {
            points.differences = Some(points::scattered_difference(&points)?);
        }
        weigh(&points, weighting, weights.alpha().squared())
    })?;
    let (facts, volume) = volume.unzip();
    Ok((Weighed { points, weighting, volume: facts }, volume))
}

/// Points as asked for: by differences, or adaptively.
fn selected_points(
    volume: &Volume,
    smoothed: &Volume,
    select: &SelectArgs,
) -> anyhow::Result<Points> {
    let differences = points::difference(smoothed);
    let units = select.units();
    let Some(goal) = select.adaptive(volume.dims().samples())? else {
        return Ok(points::select(volume, smoothed, &differences, &select.selection(), units)?);
    };
    let mut voxels = adaptive_voxels(volume, &goal, units)?;
    voxels.sort_unstable();
    Ok(points::points_at(volume, &differences, &voxels, units))
}
