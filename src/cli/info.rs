//! `walpha info`: what a file holds.

use std::path::Path;

use clap::Args;
use serde::Serialize;

use crate::points::read_model;
use crate::progress::Stage;
use crate::shown::number;
use crate::volume::{self, Series};
use crate::{Alpha, Coordinates, Frame, LengthUnit};

use super::args::InputArgs;
use super::output::{name, tell};
use super::progress::Progress;
use super::report::SCHEMA_VERSION;
use super::{Global, pipeline};

/// Describe a file, without computing anything.
///
/// Examples:
///
/// walpha info ct.nii.gz
///
/// walpha info scan.xyz --columns x,y,z,nx,ny,nz
///
/// walpha info sample:skull --json
#[derive(Args)]
pub(super) struct Info {
    #[command(flatten)]
    input: InputArgs,
}

#[derive(Serialize)]
struct Facts {
    schema_version: u32,
    input: String,
    #[serde(flatten)]
    content: Content,
}

#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum Content {
    Volume {
        format: String,
        /// How a sample is stored.
        samples: String,
        dims: [usize; 3],
        spacing: [f64; 3],
        origin: [f64; 3],
        /// Columns are the grid's axes.
        direction: [[f64; 3]; 3],
        #[serde(flatten)]
        coordinates: Coordinates,
        min: f32,
        max: f32,
        gray_levels: bool,
        /// Where the samples are, if not in INPUT itself.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        data_files: Vec<String>,
    },
    /// Several series in a folder, of which --series reads one.
    Series { series: Vec<Series> },
    Points {
        count: usize,
        low: [f64; 3],
        high: [f64; 3],
        weights: bool,
        values: bool,
        /// Samples along x, y and z of their grid; null where the file states none.
        grid: Option<[usize; 3]>,
        coordinates: Coordinates,
        /// The α that their shape is meant to be made at, a squared length.
        alpha: Option<Alpha>,
        /// The values that were gray 0 and 255.
        gray_range: Option<[f64; 2]>,
    },
}

impl Info {
    pub(super) fn run(self, global: Global) -> anyhow::Result<()> {
        let look = || pipeline::with_file(&self.input, |input| self.look(input));
        let content = Progress::new(global).stage(Stage::Read, look)?;
        tell(global, &Facts { schema_version: SCHEMA_VERSION, input: self.input.input, content })
    }

    fn look(&self, input: &str) -> anyhow::Result<Content> {
        if pipeline::is_points(&self.input, input)? {
            let level = self.input.options().level;
            let (points, facts) = read_model(input.as_ref(), self.input.columns(), level)?;
            let axis = |end: fn(f64, f64) -> f64, start: f64, axis: usize| {
                points.positions.iter().fold(start, |so_far, p| end(so_far, p[axis]))
            };
            return Ok(Content::Points {
                count: points.len(),
                low: [0, 1, 2].map(|i| axis(f64::min, f64::INFINITY, i)),
                high: [0, 1, 2].map(|i| axis(f64::max, f64::NEG_INFINITY, i)),
                weights: points.weights.is_some(),
                values: points.values.is_some(),
                grid: facts.grid.map(|grid| grid.dims.xyz()),
                coordinates: facts.coordinates,
                alpha: facts.alpha,
                gray_range: facts.range.map(|range| [range.low, range.high]),
            });
        }
        let options = self.input.options();
        if options.series.is_none() && Path::new(input).is_dir() {
            let series = volume::series(input.as_ref())?;
            if series.len() > 1 {
                return Ok(Content::Series { series });
            }
        }
        let volume = volume::open(input, &options).map_err(pipeline::with_points)?;
        let (min, max) = volume.value_range();
        let (format, data_files) = if input.starts_with("sample:") {
            ("sample".to_owned(), Vec::new())
        } else {
            let path = input.as_ref();
            (volume::format_name(path, &options)?, volume::data_files(path, &options)?)
        };
        Ok(Content::Volume {
            format,
            samples: volume.dtype().to_string(),
            dims: volume.dims().xyz(),
            spacing: volume.frame().spacing,
            origin: volume.frame().origin,
            direction: volume.frame().direction,
            coordinates: volume.frame().coordinates,
            min,
            max,
            gray_levels: volume.has_gray_levels(),
            data_files: data_files.iter().map(|file| file.display().to_string()).collect(),
        })
    }
}

impl std::fmt::Display for Facts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.content.fmt(f)
    }
}

impl Content {
    /// What the points are meant for.
    fn fmt_meant(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self::Points { alpha, gray_range, coordinates, .. } = self else { return Ok(()) };
        if let Some(alpha) = alpha {
            writeln!(f, "α         {} {}²", number(alpha.squared()), coordinates.unit.symbol())?;
        }
        match gray_range {
            Some([low, high]) => {
                writeln!(f, "gray      values {} to {} were 0 to 255", number(*low), number(*high))
            }
            None => Ok(()),
        }
    }
}

/// How the samples lie in the world.
fn fmt_frame(
    f: &mut std::fmt::Formatter<'_>,
    spacing: [f64; 3],
    origin: [f64; 3],
    direction: &[[f64; 3]; 3],
    Coordinates { space, unit }: Coordinates,
) -> std::fmt::Result {
    let stated = match (space.is_known(), unit) {
        (true, _) => space.name(),
        (false, LengthUnit::Voxel) => "none, the file places no grid",
        (false, _) => "unknown, the file does not say how its axes lie in a patient",
    };
    writeln!(f, "space     {stated}")?;
    let unit = unit.symbol();
    writeln!(f, "spacing   {} {unit}", spacing.map(number).join(" "))?;
    writeln!(f, "origin    {} {unit}", origin.map(number).join(" "))?;
    if *direction != Frame::VOXEL.direction {
        for (i, axis) in ["x", "y", "z"].iter().enumerate() {
            let steps = direction.map(|row| number(row[i]));
            writeln!(f, "axis {axis}    {}", steps.join(" "))?;
        }
    }
    Ok(())
}

impl std::fmt::Display for Content {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Volume {
                format,
                samples,
                dims: [x, y, z],
                spacing,
                origin,
                direction,
                coordinates,
                min,
                max,
                gray_levels,
                data_files,
            } => {
                writeln!(f, "format    {format}, samples of type {samples}")?;
                writeln!(f, "volume    {x}×{y}×{z} samples (x, y, z)")?;
                fmt_frame(f, *spacing, *origin, direction, *coordinates)?;
                let gray = if *gray_levels { ", gray levels as they are" } else { "" };
                let (min, max) = (number(f64::from(*min)), number(f64::from(*max)));
                writeln!(f, "values    {min} to {max}{gray}")?;
                match &data_files[..] {
                    [] => Ok(()),
                    [file] => writeln!(f, "samples   in {}", name(file)),
                    [first, .., last] => {
                        let ends = [first, last].map(|file| name(file)).join(" to ");
                        writeln!(f, "samples   in {} files, {ends}", data_files.len())
                    }
                }
            }
            Self::Series { series } => {
                writeln!(f, "series    {} in the folder; --series N reads one", series.len())?;
                series.iter().try_for_each(|one| writeln!(f, "          {one}"))
            }
            Self::Points { count, low, high, weights, values, grid, coordinates, .. } => {
                writeln!(f, "points    {count}")?;
                for (i, axis) in ["x", "y", "z"].iter().enumerate() {
                    writeln!(f, "{axis}         {} to {}", number(low[i]), number(high[i]))?;
                }
                let has = |there: bool| if there { "yes" } else { "no" };
                writeln!(f, "weights   {}\nvalues    {}", has(*weights), has(*values))?;
                if let Some([x, y, z]) = grid {
                    writeln!(f, "grid      {x}×{y}×{z} samples, coordinates in {coordinates}")?;
                }
                self.fmt_meant(f)
            }
        }
    }
}
