//! Options that several commands share, and how they become options of the library.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use crate::export::Target;
use crate::interpolate::Adaptive;
use crate::pipeline::{AlphaRule, Choice, Parameter};
use crate::points::Columns;
use crate::shape::{Engine, ShapeOptions};
use crate::volume::{Dtype, Endian, Nan, RawLayout, ReadOptions, Region};
use crate::{
    Alpha, Balls, Coordinates, Decomposition, Dims, Gray, GrayRange, HaarOptions, LengthUnit,
    Selection, SelectionRule, Space, Tolerance, Units, Volume, Weighting,
};
use clap::{Args, ValueEnum};

use super::given::Given;
use super::ranges;
use super::said::{Said, misused, refused, said};

/// What to read.
#[derive(Args, Clone)]
#[command(next_help_heading = "Input")]
pub struct InputArgs {
    /// What was given, the command's own options aside.
    #[command(flatten)]
    pub given: Given,
    /// Volume or point file, - (standard input), sample:skull, sample:phantom or sample:phantom@N.
    #[arg(value_name = "INPUT", help_heading = None::<&str>)]
    pub input: String,
    /// Format of standard input or output (-), as in --format nrrd.
    #[arg(long, value_name = "EXTENSION")]
    format: Option<String>,
    #[command(flatten)]
    part: PartArgs,
    /// Values mapped to gray 0 and 255 [default: unchanged for unsigned 8-bit samples, otherwise min..max].
    #[arg(long, value_name = "LO..HI", value_parser = gray_range, allow_hyphen_values = true)]
    gray: Option<GrayRange>,
    /// Write gray levels 0..255 instead of the values of INPUT.
    #[arg(long)]
    gray_out: bool,
    /// Columns of a table of points (CSV, XYZ): x, y, z, optionally weight and value, others under any
    /// name, as in x,y,z,nx,ny,nz; without z and others, points lie in the plane z = 0 [default: from
    /// its header, otherwise from its numbers].
    #[arg(long, value_name = "NAME,NAME,…")]
    columns: Option<Columns>,
    #[command(flatten)]
    pub raw: RawArgs,
}

impl InputArgs {
    /// How to read a volume.
    pub fn options(&self) -> ReadOptions {
        let PartArgs { level, array, frame, series, nan, roi, downsample } = self.part.clone();
        ReadOptions {
            raw: self.raw.layout(),
            level,
            array,
            frame,
            series,
            nan,
            region: roi,
            downsample,
        }
    }

    /// What the name of standard input would end with.
    pub fn extension(&self) -> String {
        let dotted = |format: &String| format!(".{}", format.trim_start_matches('.'));
        self.format.as_ref().map(dotted).unwrap_or_default()
    }

    /// A path for an output whose extension names the format: its own path, if it has one.
    pub fn output(&self, path: &Path) -> anyhow::Result<PathBuf> {
        match &self.format {
            _ if path.extension().is_some() => Ok(path.to_owned()),
            Some(_) => Ok(format!("output{}", self.extension()).into()),
            None if path == Path::new(Target::STDOUT) => {
                misused!("standard output has no extension" => "name the format, as in --format nrrd")
            }
            None => Ok(path.to_owned()),
        }
    }

    /// Refuses --format where nothing needs it.
    pub fn check_format<'a>(
        &self,
        mut outputs: impl Iterator<Item = &'a PathBuf>,
    ) -> anyhow::Result<()> {
        let used = self.input == Target::STDOUT || outputs.any(|path| path.extension().is_none());
        if self.format.is_some() && !used {
            misused!("--format has no effect: the extension of each file says its format" => "omit it");
        }
        Ok(())
    }

    /// What the columns of a table of points are.
    pub fn columns(&self) -> Option<&Columns> {
        self.columns.as_ref()
    }

    /// How values become gray levels.
    pub fn gray(&self) -> Gray {
        self.gray.map_or(Gray::Automatic, Gray::Range)
    }

    /// The values that gray levels stand for in what is written, where `range` became 0..255.
    pub fn written(&self, range: GrayRange) -> GrayRange {
        if self.gray_out { GrayRange::IDENTITY } else { range }
    }
}

/// Which part of a file is the volume, and what of it is taken.
#[derive(Args, Clone)]
#[command(next_help_heading = "Parts of a volume")]
struct PartArgs {
    /// Level of a pyramid (OME-Zarr); 0 is the finest [default: 0].
    #[arg(long, value_name = "N", conflicts_with = "dims")]
    level: Option<u32>,
    /// Array to read from a file with several (VTK, NPZ) [default for VTK: the first point array].
    #[arg(long, value_name = "NAME", conflicts_with = "dims")]
    array: Option<String>,
    /// Volume to read from a file with several (a fourth axis), counted from 0.
    #[arg(long, value_name = "K", conflicts_with = "dims")]
    frame: Option<u64>,
    /// Series to read from a folder with several (DICOM): its number in `walpha info`, or the end of its
    /// UID.
    #[arg(long, value_name = "N", conflicts_with = "dims")]
    series: Option<String>,
    /// Value that replaces NaN samples; without a value they are masked: no points, no errors.
    #[arg(long, value_name = "VALUE", num_args = 0..=1, default_missing_value = "mask",
          value_parser = nan, allow_negative_numbers = true)]
    nan: Option<Nan>,
    /// Crop to a range of indices along x, y and z, each end exclusive; ends may be omitted, as in
    /// 20:40,:,10:.
    #[arg(long, value_name = "X0:X1,Y0:Y1,Z0:Z1", value_parser = ranges::samples)]
    roi: Option<Region>,
    /// Average blocks of N×N×N samples.
    #[arg(long, value_name = "N")]
    downsample: Option<NonZeroUsize>,
}

/// The layout of a raw file.
#[derive(Args, Clone)]
#[command(next_help_heading = "Raw volumes")]
pub struct RawArgs {
    /// Sizes of a raw file along x, y and z (x fastest).
    #[arg(long, value_name = "X,Y,Z", value_parser = dims, requires = "dtype")]
    dims: Option<Dims>,
    #[arg(long, value_name = "TYPE", requires = "dims", help = dtype_help())]
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

/// The wavelet stage.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Wavelet stage")]
pub struct HaarArgs {
    /// Decomposition: all axes once per level, or each axis fully.
    #[arg(long, value_enum, default_value_t, value_name = "KIND")]
    haar: Decomposition,
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

impl HaarArgs {
    /// The stage's options.
    pub fn options(&self) -> HaarOptions {
        let tolerance = match (self.epsilon, self.coefficients) {
            (Some(epsilon), _) => Tolerance::Epsilon(epsilon),
            (_, Some(count)) => Tolerance::Coefficients(count),
            _ => Tolerance::Rms(self.rms),
        };
        HaarOptions { decomposition: self.haar, tolerance }
    }
}

/// Which samples become points.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Points")]
pub struct SelectArgs {
    /// Select the samples of largest gray difference, or adaptively: starting from the corners of the
    /// volume, those where the interpolant of the previous ones is worst.
    #[arg(long, value_enum, default_value_t, value_name = "HOW")]
    select: SelectArg,
    /// Adaptive: stop when the RMSE of the interpolant over all samples is at most E gray levels
    /// (--rms belongs to the wavelet stage). With --count or --ratio: at whichever comes first.
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
    /// Drop samples below this gray level after truncation.
    #[arg(long, value_name = "G", value_parser = not_nan, allow_negative_numbers = true)]
    gray_min: Option<f64>,
    /// Drop samples below this value of INPUT, as in --value-min 300 for Hounsfield units.
    #[arg(long, value_name = "V", allow_negative_numbers = true, conflicts_with = "gray_min")]
    value_min: Option<f64>,
    #[command(flatten)]
    place: PlaceArgs,
}

/// In what coordinates points, shapes and all lengths are.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Coordinates")]
pub struct PlaceArgs {
    /// Coordinates, α, weights and sizes in voxels, or in the unit of the file [default: world where the
    /// file states a spacing or an origin, otherwise voxel].
    #[arg(long, value_enum, value_name = "UNITS")]
    units: Option<Units>,
    /// Direction of world coordinates, where the file states the patient's orientation: x to the left
    /// and y to the back (lps), or to the right and the front (ras) [default: lps].
    #[arg(long, value_enum, value_name = "SPACE")]
    space: Option<Space>,
}

impl PlaceArgs {
    /// What the coordinates of this volume's points are measured in, and the volume in the space that
    /// they are in.
    pub fn place(&self, volume: Volume) -> anyhow::Result<(Volume, Units)> {
        let Coordinates { space, unit } = volume.frame().coordinates;
        let silent = if unit == LengthUnit::Voxel { Units::Voxel } else { Units::World };
        let units = self.units.unwrap_or(silent);
        let asked = match self.space {
            Some(_) if units == Units::Voxel => {
                refused!("--space is for world coordinates, and these are voxels" => "omit it")
            }
            Some(_) if !space.is_known() => {
                refused!("the input does not say how its axes lie in a patient, and --space cannot know" => "omit it")
            }
            asked => asked.unwrap_or(Space::Lps),
        };
        let frame = volume.frame().to(Coordinates { space: asked, unit });
        Ok((volume.with_frame(frame), units))
    }
}

#[derive(Clone, Copy, Default, PartialEq, ValueEnum)]
enum SelectArg {
    #[default]
    Difference,
    Adaptive,
}

impl SelectArgs {
    /// The stage's options, for a volume whose values `range` are gray 0..255.
    pub fn selection(&self, range: &GrayRange) -> Selection {
        let gray_min = self.gray_min.or(self.value_min.map(|value| range.gray(value)));
        Selection { rule: self.rule(), gray_min }
    }

    /// By what rule samples are chosen.
    pub fn rule(&self) -> SelectionRule {
        match (self.count, self.threshold) {
            (Some(count), _) => SelectionRule::Count(count),
            (_, Some(threshold)) => SelectionRule::Threshold(threshold),
            _ => self.ratio.map_or_else(SelectionRule::default, SelectionRule::Ratio),
        }
    }

    /// Which samples, of so many, become points.
    pub fn choice(&self, range: &GrayRange, samples: usize) -> anyhow::Result<Choice> {
        if self.select != SelectArg::Adaptive {
            if self.target_rmse.is_some() {
                misused!("--target-rmse belongs to --select adaptive" => "add it, or use --count");
            }
            return Ok(Choice::Difference(self.selection(range)));
        }
        if self.threshold.is_some() || self.gray_min.or(self.value_min).is_some() {
            misused!("--threshold, --gray-min and --value-min choose by gray levels, which --select adaptive does not" => "use --count, --ratio or --target-rmse");
        }
        let rmse = self.target_rmse.unwrap_or(0.0);
        let count = match self.rule() {
            SelectionRule::Count(count) => count,
            SelectionRule::Ratio(_) if self.ratio.is_none() && self.target_rmse.is_some() => {
                samples as u64
            }
            SelectionRule::Ratio(ratio) => (ratio * samples as f64).round() as u64,
            SelectionRule::Threshold(_) => unreachable!("refused above"),
        };
        Ok(Choice::Adaptive(Adaptive { count, rmse }))
    }

    /// In what coordinates the points are.
    pub fn place(&self, volume: Volume) -> anyhow::Result<(Volume, Units)> {
        self.place.place(volume)
    }
}

/// α and the weights in proportion to it.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Weights and α")]
pub struct WeightArgs {
    /// The parameter α, a squared length in the units of the points; `inf` gives the convex hull,
    /// `auto` the smallest α at which all points lie in one solid component [default: auto for
    /// scattered points; 10·h² for a volume, where h³ is the volume of a voxel].
    #[arg(long, value_name = "A", group = "parameter", allow_negative_numbers = true)]
    alpha: Option<AlphaRule>,
    /// The parameter as a radius: α = R².
    #[arg(long, value_name = "R", value_parser = alpha_radius, group = "parameter",
          allow_negative_numbers = true)]
    alpha_radius: Option<Alpha>,
    #[arg(long, value_name = "KIND", allow_hyphen_values = true, help = weights_help())]
    pub weights: Option<Weighting>,
}

impl WeightArgs {
    /// α as it is asked for.
    pub fn alpha(&self) -> AlphaRule {
        self.alpha_radius.map(AlphaRule::Given).or(self.alpha).unwrap_or_default()
    }

    /// α for work on a volume that makes several sets of points.
    pub fn of_volume(&self, volume: &Volume, units: Units) -> anyhow::Result<Parameter> {
        self.alpha().of_volume(volume, units)?.ok_or_else(|| {
            said!(
                "there are several sets of points, each with an `auto` of its own" => "give α as a \
                 number"
            )
            .into()
        })
    }
}

/// Weights in proportion to an α at which they are frozen.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Weights, frozen")]
pub struct FrozenArgs {
    /// The α, a squared length, for which weights are computed; they are the same at every level, so
    /// that levels are nested [default: as --alpha of `walpha shape`].
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    alpha_ref: Option<AlphaRule>,
    #[arg(long, value_name = "KIND", allow_hyphen_values = true, help = weights_help())]
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
    type Err = Said;

    fn from_str(text: &str) -> Result<Self, Said> {
        if text == "auto" {
            return Ok(Self::Auto);
        }
        Ok(Self::Given(text.split(',').map(|item| item.trim().parse()).collect::<Result<_, _>>()?))
    }
}

/// How the shape is computed.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Shape")]
pub struct ShapeArgs {
    /// A point is a ball of squared radius α + ω (power) or of radius α + ω (radius).
    #[arg(long, value_enum, default_value_t, value_name = "READING")]
    balls: Balls,
    /// Engine that computes the shape; all give the same answer.
    #[arg(long, value_enum, default_value_t, value_name = "ENGINE")]
    engine: Engine,
    /// Number of blocks [default: from threads and memory]; only a single block, the whole
    /// triangulation, knows hidden points.
    #[arg(long, value_name = "N")]
    blocks: Option<NonZeroUsize>,
    /// Memory limit to size blocks for, as in 2G or 500M; not with what needs the whole triangulation
    /// (α = inf, --exterior, --engine reference).
    #[arg(long, value_name = "SIZE", value_parser = bytes, conflicts_with = "blocks")]
    memory: Option<u64>,
    /// Keep the simplices outside the shape, too: the whole triangulation.
    #[arg(long)]
    exterior: bool,
}

impl ShapeArgs {
    /// Refuses options that have no use for each other, before the work.
    pub fn check(&self, alpha: AlphaRule) -> anyhow::Result<()> {
        if self.engine == Engine::Reference && self.blocks.is_some_and(|blocks| blocks.get() > 1) {
            misused!("--blocks has no effect: the reference engine knows no blocks" => "omit it, or take --engine native");
        }
        // What is found is finite.
        let alpha = match alpha {
            AlphaRule::Given(alpha) => alpha,
            _ => Alpha::from_squared(0.0)?,
        };
        let options = ShapeOptions { alpha, ..self.options() };
        Ok(options.check().map_err(|error| Said::usage_of(&error))?)
    }

    /// The stage's options, at α = ∞.
    pub fn options(&self) -> ShapeOptions {
        let Self { balls, engine, exterior, blocks, memory } = *self;
        ShapeOptions {
            alpha: Alpha::INFINITE,
            balls,
            engine,
            exterior,
            blocks,
            memory,
            refuse_flat: true,
        }
    }
}

/// The help of `--weights`.
fn weights_help() -> String {
    format!(
        "Weights ω (squared lengths): {} [default: column where the input has weights, else common=0]",
        Weighting::known()
    )
}

/// The help of `--dtype`.
fn dtype_help() -> String {
    format!("Type of a sample: {}", Dtype::ALL.map(Dtype::name).join(", "))
}

fn dims(text: &str) -> Result<Dims, Said> {
    let size = |size: &str| {
        let whole = size.trim().parse::<u64>();
        whole.map_err(|_| said!("{size:?} is no whole number" => "give sizes as in 64,64,64"))
    };
    let sizes: Vec<u64> = text.split(',').map(size).collect::<Result<_, _>>()?;
    let [x, y, z] = sizes[..] else {
        refused!("three sizes are needed" => "give those along x, y and z, as in 64,64,64");
    };
    Ok(Dims::new(x, y, z)?)
}

fn nan(text: &str) -> Result<Nan, Said> {
    if text == "mask" {
        return Ok(Nan::Mask);
    }
    let value = number(text)? as f32;
    if !value.is_finite() {
        refused!("a finite number is needed" => "give it as in -1000, or give none");
    }
    Ok(Nan::Value(value))
}

fn gray_range(text: &str) -> Result<GrayRange, Said> {
    let Some((low, high)) = text.split_once("..") else {
        refused!("two numbers are needed" => "give them as in -1000..2000");
    };
    let range = GrayRange { low: number(low)?, high: number(high)? };
    if !(range.low < range.high && range.low.is_finite() && range.high.is_finite()) {
        refused!("LO must be less than HI, and both finite" => "give them as in -1000..2000");
    }
    Ok(range)
}

fn bytes(text: &str) -> Result<u64, Said> {
    let units = [("K", 10), ("M", 20), ("G", 30), ("T", 40)];
    let unit = units.iter().find_map(|(name, bits)| Some((text.strip_suffix(name)?, bits)));
    let (number, bits) = unit.unwrap_or((text, &0));
    let Some(bytes) = number.parse().ok().and_then(|n: u64| n.checked_mul(1 << bits)) else {
        refused!("a whole number of bytes is needed" => "give it as in 2G, 500M or 1073741824");
    };
    Ok(bytes)
}

pub fn number(text: &str) -> Result<f64, Said> {
    text.trim().parse().map_err(|_| said!("{text:?} is not a number" => "give one as in 10 or 2.5"))
}

fn count(text: &str) -> Result<u64, Said> {
    match text.trim().parse() {
        Ok(0) => refused!("a count from 1 up is needed" => "give it as in 15956"),
        count => count.map_err(|_| said!("{text:?} is no whole number" => "give one as in 15956")),
    }
}

fn share(text: &str) -> Result<f64, Said> {
    let share = number(text)?;
    if !(share > 0.0 && share <= 1.0) {
        refused!("a share above 0 and up to 1 is needed" => "give it as in 0.0609 for 6.09 %");
    }
    Ok(share)
}

fn not_nan(text: &str) -> Result<f64, Said> {
    let number = number(text)?;
    if number.is_nan() {
        refused!("a gray level is needed" => "give it as in 50 or 12.5");
    }
    Ok(number)
}

pub fn not_negative(text: &str) -> Result<f64, Said> {
    let number = number(text)?;
    if number.is_nan() || number < 0.0 {
        refused!("a number from 0 up is needed" => "give it as in 1 or 2.5");
    }
    Ok(number)
}

fn alpha_radius(text: &str) -> Result<Alpha, Said> {
    Ok(Alpha::from_radius(number(text)?)?)
}
