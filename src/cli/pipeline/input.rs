//! Reading INPUT.

use std::path::Path;

use crate::export::Scratch;
use crate::pipeline::{Input, PipelineError};
use crate::progress::Stage;
use crate::volume::Reason;
use crate::{PointsError, Recipe, VolumeError};

use crate::cli::args::{self, InputArgs};
use crate::cli::complaint::{is_usage, reasons};
use crate::cli::progress::Progress;
use crate::cli::said::{Said, said};

/// Reads INPUT.
pub(in crate::cli) fn read(
    args: &InputArgs,
    recipe: &Recipe,
    progress: &mut Progress,
) -> anyhow::Result<Input> {
    let monitor = progress.monitor();
    progress.stage(Stage::Read, || {
        with_file(args, |input| {
            recipe.open(input, &monitor).map_err(|error| match error {
                PipelineError::Points(PointsError::File(error)) => with_points(error),
                error => error.into(),
            })
        })
    })
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

/// Refuses options that have no effect on what INPUT is.
pub(in crate::cli) fn accept(input: &Input, args: &InputArgs) -> Result<(), Said> {
    let holds = |what| format!("{} holds {what}", args.input);
    match input {
        Input::Volume(..) => args.given.refuse(&["columns"], holds("a volume")),
        Input::Points(_, facts) => {
            let what = holds("points, and no volume");
            if facts.range.is_none() {
                args.given.refuse(&["gray_out"], &what)?;
            }
            args.given.refuse(&args::of_volumes(), what)
        }
    }
}
