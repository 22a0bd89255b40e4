//! INPUT: its name, how it is read, and which part of it is used.

use std::ffi::OsString;
use std::fmt::{self, Display};
use std::num::NonZeroUsize;
use std::ops::Deref;
use std::path::{Path, PathBuf};

use clap::Args;

use super::values::{class, dims, gray_range, input_format, nan, positive};
use crate::cli::command_line::TypedOptions;
use crate::cli::errors::CommandError;
use crate::cli::ranges;
use crate::export::Target;
use crate::points::{Columns, PointOptions};
use crate::volume::{Dtype, Endian, Nan, RawLayout, ReadOptions, Region};
use crate::{Dims, GrayRange, Recipe, shape};

/// What to read.
#[derive(Args, Clone)]
#[command(next_help_heading = "Input")]
pub(crate) struct InputArgs {
    /// Options typed on the command line.
    #[command(flatten)]
    pub typed: TypedOptions,
    /// Volume or point file, - (standard input), sample:ct, sample:skull, sample:phantom or sample:phantom@N.
    #[arg(value_name = "INPUT", help_heading = None::<&str>)]
    pub input: InputName,
    /// Format of INPUT where neither its content nor its name shows it, given as a file extension, as in
    /// --input-format xyz.
    #[arg(long, value_name = "EXTENSION", value_parser = input_format, conflicts_with = "dims")]
    input_format: Option<String>,
    #[command(flatten)]
    part: PartArgs,
    /// Values mapped to gray 0 and 255 [default: unchanged for unsigned 8-bit samples, otherwise min..max].
    #[arg(long, value_name = "LO..HI", value_parser = gray_range, allow_hyphen_values = true,
          help_heading = "Input")]
    gray: Option<GrayRange>,
    /// Write gray levels 0..255 instead of the values of INPUT.
    #[arg(long, help_heading = "Input")]
    gray_out: bool,
    /// Columns of a table of points (CSV, XYZ, PTS, NPY): x, y, z, optionally weight (or radius) and value, others
    /// under any name, as in x,y,z,nx,ny,nz; without z and others, points lie in the plane z = 0 [default: from
    /// its header, otherwise from its numbers, of which a fourth is a value].
    #[arg(long, value_name = "NAME,NAME,…", help_heading = "Input")]
    columns: Option<Columns>,
    /// Classes of points to read from LAS and LAZ: ground, vegetation, building, water, unclassified, or
    /// their numbers, as in 2,9 [default: all].
    #[arg(long, value_name = "CLASS,…", value_delimiter = ',', value_parser = class, help_heading = "Input")]
    class: Vec<Vec<u8>>,
    /// Also take points of LAS and LAZ that are flagged as withheld, which are not to be processed.
    #[arg(long, help_heading = "Input")]
    withheld: bool,
    /// Keep the first point in each cube of this side, in the unit of the points.
    #[arg(long, value_name = "SIDE", value_parser = positive, help_heading = "Input")]
    thin: Option<f64>,
    #[command(flatten)]
    pub raw: RawArgs,
}

impl InputArgs {
    /// Options for reading a volume.
    pub(crate) fn options(&self) -> ReadOptions {
        let PartArgs {
            level,
            array,
            frame,
            series,
            skip_damaged,
            no_resample,
            nan,
            roi,
            downsample,
        } = self.part.clone();
        ReadOptions::default()
            .raw(self.raw.layout())
            .format(self.input_format.clone())
            .level(level)
            .array(array)
            .frame(frame)
            .series(series)
            .skip_damaged(skip_damaged)
            .no_resample(no_resample)
            .nan(nan)
            .region(roi)
            .downsample(downsample)
    }

    /// The extension of a file in the format of `--input-format`, with its dot; empty without that option.
    pub(crate) fn extension(&self) -> String {
        self.input_format.as_ref().map(|format| format!(".{format}")).unwrap_or_default()
    }

    /// A recipe with these options.
    pub(crate) fn recipe(&self) -> Recipe {
        Recipe::new()
            .classifier(shape::CGAL)
            .read(self.options())
            .columns(self.columns.clone())
            .classes((!self.class.is_empty()).then(|| self.class.concat()))
            .withheld(self.withheld)
            .thin(self.thin)
            .gray(self.gray)
            .gray_out(self.gray_out)
    }

    /// Options for reading points.
    pub(crate) fn point_options(&self) -> PointOptions {
        self.recipe().of_points()
    }

    /// Refuses `--input-format` for a sample or a folder.
    pub(crate) fn check_format(&self) -> Result<(), CommandError> {
        if self.input.starts_with("sample:") {
            self.typed.refuse(&["input_format"], "a sample is no file")?;
        } else if self.input.path().is_dir() {
            self.typed.refuse(&["input_format"], "a folder says what it holds")?;
        }
        Ok(())
    }
}

/// Which volume of a file is read, and which part of it.
#[derive(Args, Clone)]
#[command(next_help_heading = "Parts of a volume")]
pub(super) struct PartArgs {
    /// Level of a pyramid (OME-Zarr), or of points in layers (WVM); 0 is the finest [default: 0].
    #[arg(long, value_name = "N", conflicts_with = "dims")]
    level: Option<u32>,
    /// Array to read from a file with several (VTK, NPZ) [default for VTK: the first point array].
    #[arg(long, value_name = "NAME", conflicts_with = "dims")]
    array: Option<String>,
    /// Volume to read from a file with several (a fourth axis; times, echoes or stacks of DICOM), or scan or step of points (PTS,
    /// XYZ), counted from 0.
    #[arg(long, value_name = "K", conflicts_with = "dims")]
    frame: Option<u64>,
    /// Series to read from a folder with several (DICOM): its number in walpha info, or the end of its
    /// UID.
    #[arg(long, value_name = "N", conflicts_with = "dims")]
    series: Option<String>,
    /// Skip damaged slices of a series (DICOM), with a warning for each.
    #[arg(long, conflicts_with = "dims")]
    skip_damaged: bool,
    /// Refuse slices at several distances (DICOM), instead of resampling them linearly to the finest.
    #[arg(long, conflicts_with = "dims")]
    no_resample: bool,
    /// Value that replaces samples that are NaN or infinite, or padding (DICOM); without a value they are masked: no
    /// points, no errors. Padding is masked anyway.
    #[arg(long, value_name = "VALUE", num_args = 0..=1, default_missing_value = "mask",
          value_parser = nan, allow_negative_numbers = true)]
    nan: Option<Nan>,
    /// Crop to a range of indices along x, y and z, each end exclusive; ends may be omitted, as in
    /// 20:40,:,10:.
    #[arg(long, value_name = "X0:X1,Y0:Y1,Z0:Z1", value_parser = ranges::samples)]
    roi: Option<Region>,
    /// Average blocks of N×N×N samples; of labels take the most frequent one.
    #[arg(long, value_name = "N")]
    downsample: Option<NonZeroUsize>,
}

/// The layout of a raw file.
#[derive(Args, Clone)]
#[command(next_help_heading = "Raw volumes")]
pub(crate) struct RawArgs {
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
    /// The grid that `--dims` asks for, if it does not describe a raw file.
    pub(crate) fn grid(&self) -> Option<Dims> {
        self.dims.filter(|_| self.dtype.is_none())
    }

    /// The layout of the samples, if the file is raw.
    fn layout(&self) -> Option<RawLayout> {
        let layout = |(dims, dtype)| RawLayout::new(dims, dtype).endian(self.endian);
        self.dims.zip(self.dtype).map(|of| layout(of).offset(self.offset))
    }
}

/// The help of `--dtype`.
fn dtype_help() -> String {
    format!("Type of a sample: {}", Dtype::ALL.map(Dtype::name).join(", "))
}

/// The name of a sample or a file: the path as the system has it, which need not be UTF-8, and the text shown to users and
/// in reports.
#[derive(Clone, Debug)]
pub(crate) struct InputName {
    path: PathBuf,
    text: String,
}

impl InputName {
    /// The path to open.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Whether it is standard input.
    pub(crate) fn is_stdin(&self) -> bool {
        self.path == Path::new(Target::STDOUT)
    }
}

impl From<OsString> for InputName {
    fn from(name: OsString) -> Self {
        Self { text: name.to_string_lossy().into_owned(), path: name.into() }
    }
}

/// Dereferences to the text.
impl Deref for InputName {
    type Target = str;

    fn deref(&self) -> &str {
        &self.text
    }
}

impl Display for InputName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
