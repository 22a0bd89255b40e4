//! Options that several commands share, and how they become options of the library.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{anyhow, bail};
use clap::{Args, ValueEnum};
use walpha::export::Target;
use walpha::interpolate::Adaptive;
use walpha::points::Columns;
use walpha::shape::{Engine, ShapeOptions};
use walpha::volume::{Dtype, Endian, RawLayout, ReadOptions};
use walpha::{
    Alpha, Balls, Decomposition, Dims, Gray, GrayRange, HaarOptions, Selection, SelectionRule,
    Tolerance, Units, Volume, Weighting,
};

use super::given::{Given, misused};
use super::parameter::Parameter;

/// What to read.
#[derive(Args, Clone)]
#[command(next_help_heading = "Input")]
pub struct InputArgs {
    /// What was given, the command's own options aside.
    #[command(flatten)]
    pub given: Given,
    /// Volume or point file, sample:skull, sample:phantom or sample:phantom@N.
    #[arg(value_name = "INPUT", help_heading = None::<&str>)]
    pub input: String,
    /// Level of a pyramid (OME-Zarr) to read; 0 is the finest [default: 0].
    #[arg(long, value_name = "N", conflicts_with = "dims")]
    level: Option<u32>,
    /// Values that become gray 0 and 255 [default: as they are for unsigned 8 bits, else min..max].
    #[arg(long, value_name = "LO..HI", value_parser = gray_range, allow_hyphen_values = true)]
    gray: Option<GrayRange>,
    /// What the columns of a table of points are (CSV, XYZ): x, y and z, perhaps weight and value, and
    /// others by any name, as in x,y,z,nx,ny,nz [default: what its first line says, or else its
    /// numbers].
    #[arg(long, value_name = "NAME,NAME,…")]
    columns: Option<Columns>,
    #[command(flatten)]
    pub raw: RawArgs,
}

impl InputArgs {
    /// How to read a volume.
    pub fn options(&self) -> ReadOptions {
        ReadOptions { raw: self.raw.layout(), level: self.level }
    }

    /// What the columns of a table of points are.
    pub fn columns(&self) -> Option<&Columns> {
        self.columns.as_ref()
    }

    /// How values become gray levels.
    pub fn gray(&self) -> Gray {
        self.gray.map_or(Gray::Automatic, Gray::Range)
    }
}

/// The layout of a raw file.
#[derive(Args, Clone)]
#[command(next_help_heading = "Raw volumes")]
pub struct RawArgs {
    /// Read bare samples, so many along x, y and z (x fastest in the file).
    #[arg(long, value_name = "X,Y,Z", value_parser = dims, requires = "dtype")]
    dims: Option<Dims>,
    /// Type of a sample: u8, i8, u16, i16, u32, i32, u64, i64, f32 or f64.
    #[arg(long, value_name = "TYPE", requires = "dims")]
    dtype: Option<Dtype>,
    /// Byte order of a sample: little or big.
    #[arg(long, value_name = "ORDER", default_value = "little", requires = "dims")]
    endian: Endian,
    /// Bytes to skip at the start of the file.
    #[arg(long, value_name = "BYTES", default_value_t = 0, requires = "dims")]
    offset: u64,
}

impl RawArgs {
    /// The grid that `--dims` asks for where it does not describe a raw file.
    pub fn grid(&self) -> Option<Dims> {
        self.dims.filter(|_| self.dtype.is_none())
    }

    /// How samples lie in the file, if it is raw.
    fn layout(&self) -> Option<RawLayout> {
        let layout =
            |(dims, dtype)| RawLayout { dims, dtype, endian: self.endian, offset: self.offset };
        self.dims.zip(self.dtype).map(layout)
    }
}

/// From an input to weighted points.
#[derive(Args, Clone)]
pub struct PipelineArgs {
    #[command(flatten)]
    pub input: InputArgs,
    #[command(flatten)]
    pub haar: HaarArgs,
    #[command(flatten)]
    pub select: SelectArgs,
    #[command(flatten)]
    pub weights: WeightArgs,
}

/// Which format goes to standard output.
#[derive(Args, Clone)]
pub struct FormatArgs {
    /// Format of a file whose name has no extension, as of standard output (-o -): --format ply.
    #[arg(long, value_name = "EXTENSION", requires = "output")]
    format: Option<String>,
}

impl FormatArgs {
    /// Refuses the option where every path has an extension.
    pub fn check<'a>(&self, mut paths: impl Iterator<Item = &'a PathBuf>) -> anyhow::Result<()> {
        if self.format.is_some() && paths.all(|path| path.extension().is_some()) {
            misused!(
                "--format has no effect: the extension of each output says its format; leave it away"
            );
        }
        Ok(())
    }

    /// A path whose extension tells the format: the path itself, if it has one.
    pub fn name(&self, path: &Path) -> anyhow::Result<PathBuf> {
        match &self.format {
            _ if path.extension().is_some() => Ok(path.to_owned()),
            Some(format) => Ok(format!("output.{}", format.trim_start_matches('.')).into()),
            None if path == Path::new(Target::STDOUT) => {
                misused!("standard output has no extension; name the format, as in --format nrrd")
            }
            None => Ok(path.to_owned()),
        }
    }
}

/// The wavelet stage.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Wavelet stage")]
pub struct HaarArgs {
    /// Decomposition: all axes once per level, or each axis fully.
    #[arg(long, value_enum, default_value_t, value_name = "KIND")]
    haar: Haar,
    /// Root mean square error allowed, in gray levels.
    #[arg(long, value_name = "E", group = "tolerance", value_parser = not_negative,
          default_value = "1")]
    rms: f64,
    /// L² norm of the error allowed, in gray levels.
    #[arg(long, value_name = "E", group = "tolerance", value_parser = not_negative)]
    epsilon: Option<f64>,
    /// Coefficients to keep.
    #[arg(long, value_name = "N", group = "tolerance")]
    coefficients: Option<u64>,
}

#[derive(Clone, Copy, Default, ValueEnum)]
enum Haar {
    #[default]
    NonStandard,
    Standard,
}

impl HaarArgs {
    /// The stage's options.
    pub fn options(&self) -> HaarOptions {
        let tolerance = match (self.epsilon, self.coefficients) {
            (Some(epsilon), _) => Tolerance::Epsilon(epsilon),
            (_, Some(count)) => Tolerance::Coefficients(count),
            _ => Tolerance::Rms(self.rms),
        };
        let decomposition = match self.haar {
            Haar::NonStandard => Decomposition::NonStandard,
            Haar::Standard => Decomposition::Standard,
        };
        HaarOptions { decomposition, tolerance }
    }
}

/// Which samples become points.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Points")]
pub struct SelectArgs {
    /// Which samples: those of largest gray difference; or adaptive: from the corners of the volume
    /// on, those where the interpolant of the ones before is worst.
    #[arg(long, value_enum, default_value_t, value_name = "HOW")]
    select: SelectArg,
    /// Adaptive: stop when the RMSE of the interpolant over all samples is at most E gray levels
    /// (--rms is that of the wavelet stage). With --count or --ratio: at what comes first.
    #[arg(long, value_name = "E", value_parser = not_negative)]
    target_rmse: Option<f64>,
    /// Keep N samples.
    #[arg(long, value_name = "N", group = "rule", value_parser = count)]
    count: Option<u64>,
    /// Keep this share of all samples, 0 < R ≤ 1 [default: 0.0609].
    #[arg(long, value_name = "R", group = "rule", value_parser = share)]
    ratio: Option<f64>,
    /// Keep the samples whose gray difference is at least T gray levels.
    #[arg(long, value_name = "T", group = "rule", value_parser = not_nan,
          allow_negative_numbers = true)]
    threshold: Option<f64>,
    /// Leave out samples below this gray level after truncation.
    #[arg(long, value_name = "G", value_parser = not_nan, allow_negative_numbers = true)]
    gray_min: Option<f64>,
    /// Coordinates in voxels, or in the file's units; then α, weights and sizes are too.
    #[arg(long, value_enum, default_value_t, value_name = "UNITS")]
    units: UnitsArg,
}

#[derive(Clone, Copy, Default, PartialEq, ValueEnum)]
enum SelectArg {
    #[default]
    Difference,
    Adaptive,
}

#[derive(Clone, Copy, Default, ValueEnum)]
enum UnitsArg {
    #[default]
    Voxel,
    World,
}

impl SelectArgs {
    /// The stage's options.
    pub fn selection(&self) -> Selection {
        let rule = match (self.count, self.threshold) {
            (Some(count), _) => SelectionRule::Count(count),
            (_, Some(threshold)) => SelectionRule::Threshold(threshold),
            _ => self.ratio.map_or_else(SelectionRule::default, SelectionRule::Ratio),
        };
        Selection { rule, gray_min: self.gray_min }
    }

    /// The goal of adaptive selection, if that is asked for, among so many samples.
    pub fn adaptive(&self, samples: usize) -> anyhow::Result<Option<Adaptive>> {
        if self.select != SelectArg::Adaptive {
            if self.target_rmse.is_some() {
                misused!("--target-rmse belongs to --select adaptive: add it, or use --count");
            }
            return Ok(None);
        }
        if self.threshold.is_some() || self.gray_min.is_some() {
            misused!(
                "--threshold and --gray-min choose by gray levels, which --select adaptive does \
                 not: use --count, --ratio or --target-rmse"
            );
        }
        let rmse = self.target_rmse.unwrap_or(0.0);
        let count = match self.selection().rule {
            SelectionRule::Count(count) => count,
            SelectionRule::Ratio(_) if self.ratio.is_none() && self.target_rmse.is_some() => {
                samples as u64
            }
            SelectionRule::Ratio(ratio) => (ratio * samples as f64).round() as u64,
            SelectionRule::Threshold(_) => unreachable!("refused above"),
        };
        Ok(Some(Adaptive { count, rmse }))
    }

    /// What coordinates are measured in.
    pub fn units(&self) -> Units {
        match self.units {
            UnitsArg::Voxel => Units::Voxel,
            UnitsArg::World => Units::World,
        }
    }
}

/// α as it is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaArg {
    /// The smallest at which all points are in one solid component.
    Auto,
    /// This.
    Given(Alpha),
}

impl FromStr for AlphaArg {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> anyhow::Result<Self> {
        if text.trim() == "auto" { Ok(Self::Auto) } else { Ok(Self::Given(alpha(text)?)) }
    }
}

/// α and the weights in proportion to it.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Weights and α")]
pub struct WeightArgs {
    /// The parameter α, a squared length in the units of the points; `inf` gives the convex hull, and
    /// `auto` the smallest α at which all points are in one solid component [default: auto for
    /// scattered points; for a volume 10·h², where h³ is the volume of a voxel].
    #[arg(long, value_name = "A", group = "parameter", allow_negative_numbers = true)]
    alpha: Option<AlphaArg>,
    /// The parameter as a radius: α = R².
    #[arg(long, value_name = "R", value_parser = alpha_radius, group = "parameter",
          allow_negative_numbers = true)]
    alpha_radius: Option<Alpha>,
    /// Weights ω (squared lengths): common=C, min-max (eq. 4.1), barycentric (eq. 4.2),
    /// barycentric-n (N times that) or column (from the input) [default: column where the input has
    /// weights, else common=0].
    #[arg(long, value_name = "KIND", allow_hyphen_values = true)]
    weights: Option<Weighting>,
}

impl WeightArgs {
    /// α as it is asked for, if it is.
    pub fn alpha(&self) -> Option<AlphaArg> {
        self.alpha_radius.map(AlphaArg::Given).or(self.alpha)
    }

    /// α for work on a volume that makes several sets of points.
    pub fn of_volume(&self, volume: &Volume, units: Units) -> anyhow::Result<Parameter> {
        match self.alpha() {
            None => Parameter::of_volume(volume, units),
            asked => Parameter::given(asked).ok_or_else(|| {
                anyhow!("there are several sets of points, each with an `auto` of its own; give α as a number")
            }),
        }
    }

    /// The weights asked for; without a word, those of the input, or else none.
    pub fn weighting(&self, input_has_weights: bool) -> Weighting {
        let silent = if input_has_weights { Weighting::Column } else { Weighting::Common(0.0) };
        self.weights.unwrap_or(silent)
    }
}

/// Weights in proportion to an α at which they are frozen.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Weights, frozen")]
pub struct FrozenArgs {
    /// The α, a squared length, for which weights are computed; they stay the same at every level,
    /// so that levels are nested [default: as --alpha of `walpha shape`].
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    alpha_ref: Option<AlphaArg>,
    /// Weights ω (squared lengths): common=C, min-max (eq. 4.1), barycentric (eq. 4.2),
    /// barycentric-n (N times that) or column (from the input) [default: column where the input has
    /// weights, else common=0].
    #[arg(long, value_name = "KIND", allow_hyphen_values = true)]
    weights: Option<Weighting>,
}

impl From<FrozenArgs> for WeightArgs {
    fn from(FrozenArgs { alpha_ref, weights }: FrozenArgs) -> Self {
        Self { alpha: alpha_ref, alpha_radius: None, weights }
    }
}

/// The α of a ladder.
#[derive(Clone, Debug, PartialEq)]
pub enum Alphas {
    /// Critical values, chosen to be readable.
    Auto,
    /// These.
    Given(Vec<Alpha>),
}

impl FromStr for Alphas {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> anyhow::Result<Self> {
        if text == "auto" {
            return Ok(Self::Auto);
        }
        Ok(Self::Given(text.split(',').map(|item| alpha(item.trim())).collect::<Result<_, _>>()?))
    }
}

/// How the shape is computed.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Shape")]
pub struct ShapeArgs {
    /// A point is a ball of squared radius α + ω (power), or of radius α + ω (radius).
    #[arg(long, value_enum, default_value_t, value_name = "READING")]
    balls: BallsArg,
    /// Program that computes the shape; all give the same answer.
    #[arg(long, value_enum, default_value_t, value_name = "ENGINE")]
    engine: EngineArg,
    /// Blocks to cut the points into [default: by threads and memory]; 1 is the whole
    /// triangulation, which alone knows hidden points.
    #[arg(long, value_name = "N")]
    blocks: Option<NonZeroUsize>,
    /// Memory to plan blocks for, as in 2G or 500M.
    #[arg(long, value_name = "SIZE", value_parser = bytes, conflicts_with = "blocks")]
    memory: Option<u64>,
    /// Keep the simplices outside the shape too: the whole triangulation.
    #[arg(long)]
    exterior: bool,
}

#[derive(Clone, Copy, Default, PartialEq, ValueEnum)]
enum EngineArg {
    /// CGAL's triangulation in blocks.
    #[cfg_attr(feature = "cgal", default)]
    Cgal,
    /// Our own triangulation in blocks: the fastest.
    #[cfg_attr(not(feature = "cgal"), default)]
    Native,
    /// Plain CGAL, as in the paper.
    Reference,
}

#[derive(Clone, Copy, Default, PartialEq, ValueEnum)]
enum BallsArg {
    #[default]
    Power,
    Radius,
}

impl ShapeArgs {
    /// Whether `--balls radius` is in force, under which α is no squared length.
    pub fn radii(&self) -> bool {
        self.balls == BallsArg::Radius
    }

    /// Refuses options that the engine has no use for.
    pub fn check(&self) -> anyhow::Result<()> {
        if self.engine == EngineArg::Reference && self.blocks.is_some_and(|blocks| blocks.get() > 1)
        {
            misused!(
                "--blocks has no effect: the reference engine knows no blocks; leave it away, or take \
                 --engine native"
            );
        }
        Ok(())
    }

    /// The stage's options.
    pub fn options(&self, alpha: Alpha) -> ShapeOptions {
        let balls = match self.balls {
            BallsArg::Power => Balls::Power,
            BallsArg::Radius => Balls::Radius,
        };
        let engine = match self.engine {
            EngineArg::Cgal => Engine::Cgal,
            EngineArg::Native => Engine::Native,
            EngineArg::Reference => Engine::Reference,
        };
        let Self { exterior, blocks, memory, .. } = *self;
        ShapeOptions { alpha, balls, engine, exterior, blocks, memory }
    }
}

fn dims(text: &str) -> anyhow::Result<Dims> {
    let size = |size: &str| {
        let whole = size.trim().parse::<u64>();
        whole.map_err(|_| anyhow!("{size:?} is no whole number; give sizes as in 64,64,64"))
    };
    let sizes: Vec<u64> = text.split(',').map(size).collect::<Result<_, _>>()?;
    let [x, y, z] = sizes[..] else {
        bail!("three sizes are needed; give those along x, y and z, as in 64,64,64");
    };
    Ok(Dims::new(x, y, z)?)
}

fn gray_range(text: &str) -> anyhow::Result<GrayRange> {
    let Some((low, high)) = text.split_once("..") else {
        bail!("two numbers are needed; give them as in -1000..2000");
    };
    let range = GrayRange { low: number(low)?, high: number(high)? };
    if !(range.low < range.high && range.low.is_finite() && range.high.is_finite()) {
        bail!("LO must be less than HI, and both finite; give them as in -1000..2000");
    }
    Ok(range)
}

fn bytes(text: &str) -> anyhow::Result<u64> {
    let units = [("K", 10), ("M", 20), ("G", 30), ("T", 40)];
    let unit = units.iter().find_map(|(name, bits)| Some((text.strip_suffix(name)?, bits)));
    let (number, bits) = unit.unwrap_or((text, &0));
    let Some(bytes) = number.parse().ok().and_then(|n: u64| n.checked_mul(1 << bits)) else {
        bail!("a whole number of bytes is needed; give it as in 2G, 500M or 1073741824");
    };
    Ok(bytes)
}

fn number(text: &str) -> anyhow::Result<f64> {
    text.trim().parse().map_err(|_| anyhow!("{text:?} is no number; give one as in 10 or 2.5"))
}

fn count(text: &str) -> anyhow::Result<u64> {
    match text.trim().parse() {
        Ok(0) => bail!("a count from 1 up is needed; give it as in 15956"),
        count => count.map_err(|_| anyhow!("{text:?} is no whole number; give one as in 15956")),
    }
}

fn share(text: &str) -> anyhow::Result<f64> {
    let share = number(text)?;
    if !(share > 0.0 && share <= 1.0) {
        bail!("a share above 0 and up to 1 is needed; give it as in 0.0609 for 6.09 %");
    }
    Ok(share)
}

fn not_nan(text: &str) -> anyhow::Result<f64> {
    let number = number(text)?;
    if number.is_nan() {
        bail!("a gray level is needed; give it as in 50 or 12.5");
    }
    Ok(number)
}

/// A number that is not infinite.
pub fn finite(text: &str) -> anyhow::Result<f64> {
    let number = number(text)?;
    if !number.is_finite() {
        bail!("a finite number is needed; give it as in 50 or 12.5");
    }
    Ok(number)
}

pub fn not_negative(text: &str) -> anyhow::Result<f64> {
    let number = number(text)?;
    if number.is_nan() || number < 0.0 {
        bail!("a number from 0 up is needed; give it as in 1 or 2.5");
    }
    Ok(number)
}

fn alpha(text: &str) -> anyhow::Result<Alpha> {
    Ok(Alpha::from_squared(number(text)?)?)
}

fn alpha_radius(text: &str) -> anyhow::Result<Alpha> {
    Ok(Alpha::from_radius(number(text)?)?)
}
