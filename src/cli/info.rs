//! `walpha info`: what a file holds.

use clap::Args;
use serde::Serialize;
use walpha::Frame;
use walpha::points::read_points;
use walpha::shown::number;
use walpha::volume;

use super::args::InputArgs;
use super::output::tell;
use super::progress::Progress;
use super::report::SCHEMA_VERSION;
use super::{Global, pipeline};

/// Say what a file holds, without computing anything.
///
/// Examples:
///
/// walpha info ct.nii.gz
///
/// walpha info scan.xyz --columns x,y,z,nx,ny,nz
///
/// walpha info sample:skull --json
#[derive(Args)]
pub struct Info {
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
        dims: [usize; 3],
        spacing: [f64; 3],
        origin: [f64; 3],
        direction: [[f64; 3]; 3],
        min: f32,
        max: f32,
        gray_levels: bool,
        /// Where the samples are, if not in INPUT itself.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        data_files: Vec<String>,
    },
    Points {
        count: usize,
        low: [f64; 3],
        high: [f64; 3],
        weights: bool,
        values: bool,
    },
}

impl Info {
    pub fn run(self, global: Global) -> anyhow::Result<()> {
        let content = Progress::new(global).stage("read", || self.look())?;
        tell(global, &Facts { schema_version: SCHEMA_VERSION, input: self.input.input, content })
    }

    fn look(&self) -> anyhow::Result<Content> {
        if pipeline::is_points(&self.input)? {
            let points = read_points(self.input.input.as_ref(), self.input.columns())?;
            let axis = |end: fn(f64, f64) -> f64, start: f64, axis: usize| {
                points.positions.iter().fold(start, |so_far, p| end(so_far, p[axis]))
            };
            return Ok(Content::Points {
                count: points.len(),
                low: [0, 1, 2].map(|i| axis(f64::min, f64::INFINITY, i)),
                high: [0, 1, 2].map(|i| axis(f64::max, f64::NEG_INFINITY, i)),
                weights: points.weights.is_some(),
                values: points.values.is_some(),
            });
        }
        let volume = volume::open(&self.input.input, &self.input.options())?;
        let (min, max) = volume.value_range();
        let input = self.input.input.as_str();
        let data_files = match input.starts_with("sample:") {
            true => Vec::new(),
            false => volume::data_files(input.as_ref(), &self.input.options())?,
        };
        Ok(Content::Volume {
            dims: volume.dims().xyz(),
            spacing: volume.frame().spacing,
            origin: volume.frame().origin,
            direction: volume.frame().direction,
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

impl std::fmt::Display for Content {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Volume {
                dims: [x, y, z],
                spacing,
                origin,
                direction,
                min,
                max,
                gray_levels,
                data_files,
            } => {
                writeln!(f, "volume    {x}×{y}×{z} samples (x, y, z)")?;
                writeln!(f, "spacing   {}", spacing.map(number).join(" "))?;
                writeln!(f, "origin    {}", origin.map(number).join(" "))?;
                if *direction != Frame::VOXEL.direction {
                    for (i, axis) in ["x", "y", "z"].iter().enumerate() {
                        let steps = direction.map(|row| number(row[i]));
                        writeln!(f, "axis {axis}    {}", steps.join(" "))?;
                    }
                }
                let gray = if *gray_levels { ", gray levels as they are" } else { "" };
                let (min, max) = (number(f64::from(*min)), number(f64::from(*max)));
                writeln!(f, "values    {min} to {max}{gray}")?;
                match &data_files[..] {
                    [] => Ok(()),
                    [file] => writeln!(f, "samples   in {file}"),
                    [first, .., last] => {
                        writeln!(f, "samples   in {} files, {first} to {last}", data_files.len())
                    }
                }
            }
            Self::Points { count, low, high, weights, values } => {
                writeln!(f, "points    {count}")?;
                for (i, axis) in ["x", "y", "z"].iter().enumerate() {
                    writeln!(f, "{axis}         {} to {}", number(low[i]), number(high[i]))?;
                }
                let has = |there: bool| if there { "yes" } else { "no" };
                writeln!(f, "weights   {}\nvalues    {}", has(*weights), has(*values))
            }
        }
    }
}
