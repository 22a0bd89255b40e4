//! INPUT: what it turned out to be, and reading it.

use std::path::Path;

use crate::export::Scratch;
use crate::points::{ModelFacts, read_model};
use crate::progress::Stage;
use crate::volume::Reason;
use crate::{GrayRange, Points, Volume, VolumeError, volume};

use super::super::args::{self, InputArgs};
use super::super::complaint::{is_usage, reasons};
use super::super::progress::Progress;
use super::super::said::{Said, said};

/// What INPUT turned out to be.
pub(in crate::cli) enum Input {
    /// A grid of gray levels.
    Volume(Grays),
    /// Points, perhaps with weights and values, and what else their file states.
    Points(Points, ModelFacts),
}

/// A volume in gray levels, and what they stand for.
pub(in crate::cli) struct Grays {
    pub volume: Volume,
    /// The values that became gray 0 and 255.
    pub range: GrayRange,
    /// The same where values are written, or else no change.
    pub written: GrayRange,
}

/// Reads INPUT.
pub(in crate::cli) fn read(args: &InputArgs, progress: &mut Progress) -> anyhow::Result<Input> {
    let monitor = progress.monitor();
    progress.stage(Stage::Read, || {
        with_file(args, |input| {
            if is_points(args, input)? {
                let (mut points, mut facts) = read_model(input, &args.of_points())?;
                if let Some(range) = &mut facts.range {
                    let written = args.written(*range);
                    if written != *range {
                        to_gray(&mut points, range);
                        *range = written;
                    }
                }
                return Ok(Input::Points(points, facts));
            }
            let options = args.options();
            let volume = volume::open_monitored(input, &options, &monitor).map_err(with_points)?;
            let (volume, range) = volume.into_gray(args.gray())?;
            Ok(Input::Volume(Grays { volume, range, written: args.written(range) }))
        })
    })
}

/// Gives points gray levels for values. As in a volume, they are of single precision.
pub(super) fn to_gray(points: &mut Points, range: &GrayRange) {
    let gray = |value: &mut f64| *value = f64::from(range.gray(*value) as f32);
    points.values.iter_mut().flatten().for_each(gray);
}

/// Adds the formats of points to the error for a file of no format known.
pub(in crate::cli) fn with_points(error: VolumeError) -> anyhow::Error {
    if !matches!(error, VolumeError::Format { reason: Reason::Unknown { .. }, .. }) {
        return error.into();
    }
    let names: Vec<&str> = crate::points::FORMATS.iter().map(|format| format.name).collect();
    let said = Said::from(error);
    Said { why: format!("{}, {} as points", said.why, names.join(", ")), ..said }.into()
}

/// Does something with INPUT as a file or the name of a sample. Standard input becomes a file for that
/// time: formats are read in several passes.
pub(in crate::cli) fn with_file<T>(
    args: &InputArgs,
    work: impl FnOnce(&Path) -> anyhow::Result<T>,
) -> anyhow::Result<T> {
    args.check_format()?;
    if !args.input.is_stdin() {
        return work(args.input.path());
    }
    let file = Scratch::of(&mut std::io::stdin().lock(), &args.extension())
        .map_err(|error| said!("cannot read standard input: {error}" => "name a file instead"))?;
    let path = file.path().to_string_lossy().into_owned();
    // Nobody knows the name of that file.
    work(file.path()).map_err(|error| {
        let (why, next) = reasons(&error);
        let named = |text: String| text.replace(&path, "standard input");
        let usage = is_usage(&error);
        Said { why: named(why), next: next.map(named), usage }.into()
    })
}

impl Input {
    /// Refuses options that have no effect on what INPUT is.
    pub(in crate::cli) fn accepts(&self, args: &InputArgs) -> Result<(), Said> {
        let holds = |what| format!("{} holds {what}", args.input);
        match self {
            Self::Volume(..) => args.given.refuse(&["columns"], holds("a volume")),
            Self::Points(_, facts) => {
                let what = holds("points, and no volume");
                if facts.range.is_none() {
                    args.given.refuse(&["gray_out"], &what)?;
                }
                args.given.refuse(&args::of_volumes(), what)
            }
        }
    }
}

/// Whether an input is a point file.
pub(in crate::cli) fn is_points(args: &InputArgs, input: &Path) -> anyhow::Result<bool> {
    let sample = input.to_str().is_some_and(|name| name.starts_with("sample:"));
    let volume = sample || args.options().raw.is_some();
    Ok(!volume && args.of_points().is_point_file(input)?)
}
