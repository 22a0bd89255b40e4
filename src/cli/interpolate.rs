//! `walpha interpolate`: F on a grid, and how far it is from the volume.

use std::fmt::{self, Display};
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::bail;
use clap::Args;
use serde::Serialize;
use walpha::export::{Content, Target, VolumeFormat, write_all};
use walpha::interpolate::{Deviation, Grid, Interpolant, Resampled, fill};
use walpha::{AlphaShape, Volume, alpha_shape};

use super::args::{FormatArgs, PipelineArgs, ShapeArgs};
use super::given::misused;
use super::output::tell;
use super::progress::Progress;
use super::report::{Report, number_or_null_or_name};
use super::{Global, curve, pipeline};

/// Interpolate the values of points on their shape, and measure the error.
///
/// F is linear on each cell of the shape (and on facets, edges and vertices that are faces of
/// none). It is sampled on the grid of the volume, or with --dims on another over the same extent,
/// from the first sample to the last; samples outside the shape are 0. Error is measured on the
/// samples of INPUT that the shape covers, in gray levels; the peak of PSNR is 255. Hidden points
/// carry no value. For points without a volume, --dims is needed and spans their box.
///
/// With --curve: error and coverage over the number of points instead, from a sixteenth to twice
/// those selected, for each way to select them and the weights common=0, min-max and barycentric, as
/// CSV, PNG and SVG.
///
/// Examples:
///
/// walpha interpolate ct.nii.gz --select adaptive --count 100000 --fill -o again.nii.gz
///
/// walpha interpolate scattered.csv --dims 64,64,64 -o grid.nrrd
///
/// walpha interpolate sample:skull --curve -o curves/
#[derive(Args)]
#[command(mut_arg("dims", |arg| {
    arg.requires(clap::builder::Resettable::<clap::Id>::Reset)
        .help("Sample F at so many places along x, y and z; with --dtype: read bare samples")
        .help_heading("Grid")
}))]
pub struct Interpolate {
    /// Volume to write F to, as f32: .nrrd, .nii, .nii.gz, .vti, .npy or .raw; or - (standard output,
    /// with --format). With --curve: a folder, or what names of files begin with. Files that are
    /// there are replaced.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Volume to write 1 to where a sample is on the shape, else 0; the same formats, and replaced.
    #[arg(long, value_name = "FILE")]
    mask: Option<PathBuf>,
    /// Interpolate everywhere: on the whole triangulation of the points (α = inf) and the 8 corners
    /// of the volume, which come with their values and the least weight of the points.
    #[arg(long)]
    fill: bool,
    /// Measure error against the number of points.
    #[arg(long, requires = "output", conflicts_with_all = [
        "mask", "fill", "select", "target_rmse", "threshold", "gray_min", "weights", "balls", "engine",
        "blocks", "memory", "exterior",
    ])]
    curve: bool,
    #[command(flatten)]
    format: FormatArgs,
    #[command(flatten)]
    pipeline: PipelineArgs,
    #[command(flatten)]
    shape: ShapeArgs,
}

#[derive(Serialize)]
struct Facts {
    #[serde(flatten)]
    report: Report,
    interpolation: Interpolation,
}

/// What was sampled, and its error where there is a volume to compare with.
#[derive(Serialize)]
struct Interpolation {
    /// Samples written, along x, y and z.
    grid: [usize; 3],
    /// Those of them on the shape.
    on_shape: usize,
    /// On the samples of INPUT that the shape covers; null for points.
    inside: Option<Error>,
    /// On all samples of INPUT; null without `--fill`.
    filled: Option<Error>,
}

#[derive(Serialize)]
struct Error {
    #[serde(flatten)]
    deviation: Deviation,
    coverage: f64,
    /// Decibels; "inf" where nothing differs.
    #[serde(serialize_with = "number_or_null_or_name")]
    psnr: Option<f64>,
}

impl From<Deviation> for Error {
    fn from(deviation: Deviation) -> Self {
        Self { deviation, coverage: deviation.coverage(), psnr: deviation.psnr() }
    }
}

impl Interpolate {
    pub fn run(self, global: Global) -> anyhow::Result<()> {
        if self.curve {
            if self.pipeline.input.raw.grid().is_some() {
                misused!("--curve measures on the samples of INPUT: leave --dims away");
            }
            let base = self.output.as_deref().expect("clap requires it");
            return curve::run(global, &self.pipeline, base);
        }
        self.format.check(self.output.iter())?;
        self.shape.check()?;
        let output = match &self.output {
            None => None,
            Some(path) => Some((VolumeFormat::of(&self.format.name(path)?)?, Target::open(path)?)),
        };
        let mask = self.mask.as_deref().map(open).transpose()?;
        let mut progress = Progress::new(global);
        let (mut weighed, volume) = pipeline::points_and_volume(&self.pipeline, &mut progress)?;
        let volume = volume.as_ref();
        let alpha = weighed.find_parameter(&self.shape, &mut progress)?.alpha;
        let mut report = Report::of_points(&self.pipeline.input.input, &weighed);
        let grid = self.grid(volume, &weighed.points.positions)?;
        let options = self.shape.options(alpha);
        let shape = progress.stage("shape", || alpha_shape(weighed.points, &options))?;
        report.add_shape(&shape);
        let sampled = progress.stage("interpolate", || self.sample(&shape, &grid, volume))?;
        let on_shape = sampled.resampled.covered();
        let mask = mask.map(|open| anyhow::Ok((open, sampled.resampled.mask()?))).transpose()?;
        let (inside, filled, resampled) = if self.fill {
            let units = self.pipeline.select.units();
            let whole = progress.stage("fill", || fill(&shape, volume, units))?;
            let filled = progress.stage("interpolate", || self.sample(&whole, &grid, volume))?;
            (sampled.error, filled.error, filled.resampled)
        } else {
            (sampled.error, None, sampled.resampled)
        };
        progress.stage("write", || {
            let (mask, values) = mask.unzip();
            let volumes = [(output, Some(resampled.volume())), (mask, values.as_ref())];
            write_all(volumes.into_iter().filter_map(|(open, volume)| {
                let ((format, target), volume) = (open?, volume?);
                let content = move |out: &mut dyn Write| format.write(volume, out);
                Some((target, Box::new(content) as Content<'_>))
            }))
        })?;
        let files = self.output.iter().chain(&self.mask).map(|path| path.display().to_string());
        report.finish(progress.finish(), files.collect());
        let grid = grid.dims().xyz();
        tell(
            global,
            &Facts { report, interpolation: Interpolation { grid, on_shape, inside, filled } },
        )
    }

    fn sample(
        &self,
        shape: &AlphaShape,
        grid: &Grid,
        volume: Option<&Volume>,
    ) -> anyhow::Result<Sampled> {
        let interpolant = Interpolant::new(shape)?;
        let resampled = interpolant.resample(grid)?;
        let error = match volume {
            None => None,
            Some(volume) if volume.dims() == grid.dims() => Some(Deviation::of(volume, &resampled)),
            Some(volume) => {
                let own = Grid::of(volume, self.pipeline.select.units());
                Some(Deviation::of(volume, &interpolant.resample(&own)?))
            }
        };
        Ok(Sampled { resampled, error: error.map(Error::from) })
    }

    /// The grid asked for.
    fn grid(&self, volume: Option<&Volume>, positions: &[[f64; 3]]) -> anyhow::Result<Grid> {
        let units = self.pipeline.select.units();
        let asked = self.pipeline.input.raw.grid();
        match (volume, asked) {
            (Some(volume), None) => Ok(Grid::of(volume, units)),
            (Some(volume), Some(dims)) => Ok(Grid::over(volume, dims, units)),
            (None, Some(dims)) => {
                let end = |f: fn(f64, f64) -> f64| {
                    let join = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| f(a[k], b[k]));
                    positions.iter().copied().reduce(join).unwrap_or_default()
                };
                Ok(Grid::spanning(end(f64::min), end(f64::max), dims))
            }
            (None, None) => bail!(
                "{} holds points, which have no grid of their own: give --dims X,Y,Z",
                self.pipeline.input.input
            ),
        }
    }
}

/// F on the grid asked for, and its error on the grid of INPUT.
struct Sampled {
    resampled: Resampled,
    error: Option<Error>,
}

fn open(path: &Path) -> anyhow::Result<(VolumeFormat, Target)> {
    Ok((VolumeFormat::of(path)?, Target::open(path)?))
}

impl Display for Facts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Interpolation { grid: [x, y, z], on_shape, inside, filled } = &self.interpolation;
        write!(f, "{}", self.report)?;
        writeln!(f, "grid      {x}×{y}×{z} samples, {on_shape} on the shape")?;
        for (what, error) in [("inside", inside), ("filled", filled)] {
            if let Some(error) = error {
                writeln!(f, "{what:<10}{error}")?;
            }
        }
        Ok(())
    }
}

impl Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Deviation { samples, rmse, max, .. } = self.deviation;
        write!(f, "{:.2} % of {samples} samples", 100.0 * self.coverage)?;
        if let (Some(rmse), Some(max), Some(psnr)) = (rmse, max, self.psnr) {
            write!(f, ", RMSE {rmse:.6}, largest error {max:.6} gray levels, PSNR {psnr:.2} dB")?;
        }
        Ok(())
    }
}
