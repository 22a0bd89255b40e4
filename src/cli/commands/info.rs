//! `walpha info`: describes the content of a file.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use clap::Args;
use serde::{Serialize, Serializer};
use serde_json::Value;
use walpha_base::shown::{number, rounded, rounded_within};

use crate::check::meshes::Mesh;
use crate::cli::process::errors::{Result, option};
use crate::labels::{LabelSize, LabelSizes};
use crate::pipeline::Opened;
use crate::points::{
    Cell, CellCount, ColumnSummary, Crs, Flags, LeftOut, ModelMetadata, Molecule, Points,
    ScanSummary, bounding_box,
};
use crate::progress::Stage;
use crate::volume::{self, Dtype, Nan, OpenVolume, ReadOptions, Reason, SampleStats, Series};
use crate::{Alpha, Coordinates, Dims, Frame, LengthUnit, Units, VolumeError};
use walpha_points::internal::{cells_of_file, describe_file};

use crate::cli::commands::check::{mesh_format, read_mesh};
use crate::cli::commands::pipeline;
use crate::cli::options::InputArgs;
use crate::cli::options::global::Global;
use crate::cli::process::output::{name, print_summary};
use crate::cli::process::progress::Progress;
use crate::cli::report::SCHEMA_VERSION;
use crate::settings::{CT_BONE, LABELS};

/// Describe a file, without computing anything.
///
/// Examples:
///
/// walpha info ct.nii.gz   # a volume
///
/// walpha info scan.xyz --columns x,y,z,nx,ny,nz   # a table of points
///
/// walpha info sample:skull --json   # for programs
#[derive(Args)]
pub(crate) struct Info {
    #[command(flatten)]
    input: InputArgs,
}

#[derive(Serialize)]
struct InfoSummary {
    schema_version: u32,
    input: String,
    #[serde(flatten)]
    content: Content,
}

#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
#[expect(clippy::large_enum_variant, reason = "there is one")]
enum Content {
    Volume {
        format: String,
        /// The type of a stored sample.
        samples: String,
        dims: [usize; 3],
        spacing: [f64; 3],
        origin: [f64; 3],
        /// The columns are the grid's axes.
        direction: [[f64; 3]; 3],
        #[serde(flatten)]
        coordinates: Coordinates,
        /// The range of the finite values; null if there are none.
        min: Option<f32>,
        max: Option<f32>,
        /// The number of samples that are NaN, infinite or padding.
        missing: u64,
        /// Whether these samples are padding, and are masked without an option.
        #[serde(skip)]
        padding: bool,
        /// The preset that `walpha shape` uses if no option says what to look for. Absent if there is none.
        #[serde(skip_serializing_if = "Option::is_none")]
        preset: Option<&'static str>,
        /// The labels of a segmentation, with their numbers of voxels. Absent if the values are not labels.
        #[serde(skip_serializing_if = "Option::is_none")]
        labels: Option<LabelSummary>,
        /// The number of volumes in the file, of which --frame reads one; the first is described. Absent if there is only one.
        #[serde(skip_serializing_if = "Option::is_none")]
        volumes: Option<u64>,
        gray_levels: bool,
        /// The files with the samples, if these are not in INPUT itself.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        data_files: Vec<String>,
    },
    /// A volume with several values in each voxel, which is not read.
    Unread {
        format: String,
        /// A description of the content of a voxel.
        voxels: String,
        /// Null if only reading the samples would show them.
        dims: Option<[u64; 3]>,
    },
    /// A mesh of tetrahedra, which `walpha check` judges.
    Mesh {
        format: &'static str,
        points: usize,
        tetrahedra: usize,
        /// Notes on how numbers were read, and what was left out.
        notes: Vec<String>,
    },
    /// Several series in a folder, of which --series reads one.
    Series { series: Vec<Series> },
    Points {
        count: usize,
        low: [f64; 3],
        high: [f64; 3],
        weights: bool,
        /// Whether the weights are squares of radii, which the file has instead of weights.
        of_radii: bool,
        values: bool,
        /// What the atoms are; absent if the points are no molecule.
        #[serde(skip_serializing_if = "Option::is_none")]
        atoms: Option<AtomsSummary>,
        /// The numbers of cells that the file lists.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        cells: Vec<CellCount>,
        /// The cell in which the points repeat; absent if the file states none.
        #[serde(skip_serializing_if = "Option::is_none")]
        cell: Option<CellSummary>,
        #[serde(flatten)]
        scan: Option<ScanSummary>,
        /// The ASPRS names of the classes that occur, by their codes.
        #[serde(skip_serializing_if = "BTreeMap::is_empty")]
        class_names: BTreeMap<u8, &'static str>,
        /// The coordinate reference system; null if the file states none.
        crs: Option<Crs>,
        /// The unit of x and y: a length, degree, or unit if it is not known.
        unit: &'static str,
        /// Points in a square of the unit, of the squares of a grid in which there are points; null for a single point or a line.
        density: Option<f64>,
        /// The columns beside x, y and z, by name.
        #[serde(serialize_with = "by_name")]
        columns: Vec<ColumnSummary>,
        /// Remarks of the file on some of its points, for example how many are synthetic.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        notes: Vec<String>,
        /// The number of samples along x, y and z of their grid; null if the file states none.
        grid: Option<[usize; 3]>,
        coordinates: Coordinates,
        /// The α intended for their shape, a squared length.
        alpha: Option<Alpha>,
        /// The values that were gray 0 and 255.
        gray_range: Option<[f64; 2]>,
        /// The options that made the points, as far as they differ from the defaults.
        #[serde(skip_serializing_if = "Option::is_none")]
        recipe: Option<Value>,
    },
}

/// The labels of a segmentation.
#[derive(Serialize)]
struct LabelSummary {
    /// Whether the file states that its values are labels.
    stated: bool,
    #[serde(flatten)]
    sizes: LabelSizes,
}

/// The largest number of labels listed as text.
const MOST_LABELS: usize = 30;

impl std::fmt::Display for LabelSummary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let LabelSizes { labels, unit, .. } = &self.sizes;
        let how =
            if self.stated { "the file states labels" } else { "the values look like labels" };
        writeln!(
            f,
            "labels    {how}: `walpha shape` makes the solid of all but 0; --label N takes one"
        )?;
        let unit = unit.symbol();
        for LabelSize { label, voxels, volume, .. } in labels.iter().take(MOST_LABELS) {
            writeln!(f, "          {label}: {voxels} voxels, {} {unit}³", rounded(*volume))?;
        }
        match labels.len().saturating_sub(MOST_LABELS) {
            0 => Ok(()),
            more => writeln!(f, "          and {more} more, which --json lists"),
        }
    }
}

/// A unit cell with which points repeat.
#[derive(Serialize)]
struct CellSummary {
    vectors: [[f64; 3]; 3],
    repeats: [bool; 3],
    /// The sides; null if the cell is not a box along the axes.
    sides: Option<[f64; 3]>,
    #[serde(skip)]
    text: String,
}

/// The atoms of a molecule.
#[derive(Serialize)]
struct AtomsSummary {
    /// In a line: what they are, and what is left out.
    summary: String,
    left_out: LeftOut,
}

impl AtomsSummary {
    fn of(molecule: &Molecule) -> Self {
        let summary = molecule.summary().with_names(option);
        Self { summary, left_out: molecule.left_out.clone() }
    }
}

impl From<Cell> for CellSummary {
    fn from(cell: Cell) -> Self {
        let use_of_it =
            if cell.repeats == [false; 3] { "" } else { ": --periodic cell makes points repeat" };
        let text = format!("{cell}{use_of_it}");
        Self { vectors: cell.vectors, repeats: cell.repeats, sides: cell.sides(), text }
    }
}

/// Writes columns as an object, in their order.
fn by_name<S: Serializer>(columns: &[ColumnSummary], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(columns.iter().map(|column| (&column.name, column)))
}

/// The number of points in a square of the unit: squares of a grid for about 16 points each are counted if there are points in
/// them, so that neither holes nor the corners of a slanted tile matter. Squares end where the points do. O(n).
fn density(positions: &[[f64; 3]]) -> Option<f64> {
    const POINTS: f64 = 16.0;
    let [low, high] = bounding_box(positions);
    let area = (high[0] - low[0]) * (high[1] - low[1]);
    let side = (POINTS * area / positions.len() as f64).sqrt();
    if !(side > 0.0 && side.is_finite()) {
        return None;
    }
    let lengths = [0, 1].map(|k| high[k] - low[k]);
    let last = lengths.map(|length| ((length / side).ceil() as u32).saturating_sub(1));
    let square =
        |place: &[f64; 3]| [0, 1].map(|k| (((place[k] - low[k]) / side) as u32).min(last[k]));
    let taken: BTreeSet<[u32; 2]> = positions.iter().map(square).collect();
    // The last squares may reach beyond the points.
    let width = |k: usize, index: u32| (lengths[k] - f64::from(index) * side).min(side);
    let areas = taken.iter().map(|&[x, y]| width(0, x) * width(1, y));
    Some(positions.len() as f64 / areas.sum::<f64>())
}

impl Info {
    pub(crate) fn run(self, global: Global) -> Result<()> {
        let mut progress = Progress::new(global);
        let describe = || pipeline::with_file(&self.input, |input| self.describe(input));
        let content = progress.stage(Stage::Read, describe)?;
        print_summary(
            global,
            &InfoSummary {
                schema_version: SCHEMA_VERSION,
                input: self.input.input.to_string(),
                content,
            },
        )
    }

    fn describe(&self, input: &Path) -> Result<Content> {
        match self.input.recipe()?.opened(input).map_err(pipeline::unread)? {
            Opened::Made(points, metadata) => Ok(Content::of_points(&points, metadata, Vec::new())),
            Opened::Points(file) => {
                let options = self.input.point_options()?;
                let (points, metadata) = describe_file(&file, &options)?;
                Ok(Content::of_points(&points, metadata, cells_of_file(&file, &options)?))
            }
            Opened::Volume(volume) => self.describe_volume(input, &volume),
        }
    }

    /// Describes a volume, or a file that contains nothing but a mesh.
    fn describe_volume(&self, input: &Path, volume: &OpenVolume) -> Result<Content> {
        if let (OpenVolume::File(file), Some(format)) = (volume, mesh_format(input)) {
            let Mesh { complex, notes, .. } = read_mesh(format, file)?;
            return Ok(Content::Mesh {
                format: format.name,
                points: complex.points.len(),
                tetrahedra: complex.cells.map_or(0, |cells| cells.len()),
                notes,
            });
        }
        let options = self.input.options();
        if options.series.is_none() && input.is_dir() {
            let series = volume::series(input)?;
            if series.len() > 1 {
                return Ok(Content::Series { series });
            }
        }
        let summary = match VolumeSummary::of(volume, &options) {
            Ok(summary) => summary,
            Err(error) => match error.reason() {
                Some(Reason::NotScalar { what, dims }) => {
                    let format = volume.format_name(&options)?;
                    return Ok(Content::Unread { format, voxels: what.clone(), dims: *dims });
                }
                Some(&Reason::Several { count }) if options.frame.is_none() => {
                    let first = options.clone().frame(0);
                    VolumeSummary { volumes: Some(count), ..VolumeSummary::of(volume, &first)? }
                }
                _ => return Err(pipeline::with_points(error)),
            },
        };
        let (format, data_files) = (volume.format_name(&options)?, volume.data_files(&options)?);
        let VolumeSummary { dims, frame, dtype, gray_levels, stats, padding, volumes } = summary;
        let unit = frame.coordinates.unit;
        let units = if unit == LengthUnit::Voxel { Units::Voxel } else { Units::World };
        let labels = stats.labels.map(|found| LabelSummary {
            stated: found.stated,
            sizes: LabelSizes::new(found.foreground(), &frame, units),
        });
        Ok(Content::Volume {
            format,
            samples: dtype.to_string(),
            dims: dims.xyz(),
            spacing: frame.spacing,
            origin: frame.origin,
            direction: frame.direction,
            coordinates: frame.coordinates,
            min: stats.range.map(|(min, _)| min),
            max: stats.range.map(|(_, max)| max),
            missing: stats.missing,
            padding,
            preset: labels.as_ref().map(|_| LABELS).or(stats.hounsfield.map(|_| CT_BONE)),
            labels,
            volumes,
            gray_levels,
            data_files: data_files.iter().map(|file| file.display().to_string()).collect(),
        })
    }
}

/// Statistics of a volume.
struct VolumeSummary {
    dims: Dims,
    frame: Frame,
    dtype: Dtype,
    gray_levels: bool,
    stats: SampleStats,
    padding: bool,
    volumes: Option<u64>,
}

impl VolumeSummary {
    /// Summarises a volume: part by part if its format allows that, otherwise at once.
    fn of(volume: &OpenVolume, options: &ReadOptions) -> Result<Self, VolumeError> {
        if let Ok(source) = volume.source(options) {
            let stats = SampleStats::of(&source, options.nan)?;
            let (dims, frame, dtype) = (source.dims(), *source.frame(), source.dtype());
            let gray_levels = source.has_gray_levels();
            return Ok(Self {
                dims,
                frame,
                dtype,
                gray_levels,
                stats,
                padding: false,
                volumes: None,
            });
        }
        // Reading the whole volume also reports what is wrong with it.
        let read = |nan| volume.read(&options.clone().nan(nan));
        let (volume, padding) = match read(options.nan) {
            Err(error) if error.is_not_finite() => (read(Some(Nan::Mask)), false),
            read => (read, options.nan.is_none()),
        };
        let (volume, stats) = match volume {
            Ok(volume) => {
                let stats = SampleStats::of_volume(&volume);
                (volume, stats)
            }
            Err(error) if error.is_not_finite() => {
                let volume = read(Some(Nan::Value(0.0)))?;
                let missing = volume.dims().samples() as u64;
                (volume, SampleStats { range: None, missing, hounsfield: None, labels: None })
            }
            Err(error) => return Err(error),
        };
        let (dims, frame, dtype) = (volume.dims(), *volume.frame(), volume.dtype());
        let gray_levels = volume.has_gray_levels();
        Ok(Self { dims, frame, dtype, gray_levels, stats, padding, volumes: None })
    }
}

impl std::fmt::Display for InfoSummary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.content.fmt(f)
    }
}

impl Content {
    /// Describes points.
    fn of_points(points: &Points, metadata: ModelMetadata, cells: Vec<CellCount>) -> Self {
        let extreme = |pick: fn(f64, f64) -> f64, start: f64, axis: usize| {
            points.positions.iter().fold(start, |so_far, p| pick(so_far, p[axis]))
        };
        let ModelMetadata { grid, coordinates, alpha, range, recipe, cell, notes, .. } = metadata;
        let ModelMetadata { scan, crs, columns, .. } = metadata;
        let classes = scan.iter().flat_map(|scan| scan.classes.keys());
        let is_geographic = crs.as_ref().is_some_and(|crs| crs.geographic);
        Self::Points {
            count: points.len(),
            low: [0, 1, 2].map(|i| extreme(f64::min, f64::INFINITY, i)),
            high: [0, 1, 2].map(|i| extreme(f64::max, f64::NEG_INFINITY, i)),
            weights: points.weights.is_some(),
            of_radii: points.of_radii,
            values: points.values.is_some(),
            atoms: points.molecule.as_ref().map(AtomsSummary::of),
            cells,
            cell: cell.map(Into::into),
            class_names: classes.map(|&class| (class, ScanSummary::class_name(class))).collect(),
            unit: if is_geographic { "degree" } else { coordinates.unit.symbol() },
            density: density(&points.positions),
            scan,
            crs,
            columns,
            notes,
            grid: grid.map(|grid| grid.dims.xyz()),
            coordinates,
            alpha,
            gray_range: range.map(|range| [range.low, range.high]),
            recipe: recipe.map(|text| serde_json::from_str(&text).unwrap_or(text.into())),
        }
    }

    /// Displays points, with what is known of them.
    fn fmt_points(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self::Points {
            count,
            low,
            high,
            weights,
            of_radii,
            values,
            cells,
            cell,
            grid,
            coordinates,
            scan,
            ..
        } = self
        else {
            return Ok(());
        };
        if let Some(ScanSummary { version, point_format, compressed, .. }) = scan {
            let packed = if *compressed { ", compressed (LAZ)" } else { "" };
            writeln!(f, "format    LAS {version}, points of format {point_format}{packed}")?;
        }
        let all: u64 = scan.iter().flat_map(|scan| scan.returns.values()).sum();
        match scan.as_ref().map_or(0, |scan| scan.flags.withheld) {
            withheld @ 1.. if all == *count as u64 + withheld => writeln!(
                f,
                "points    {count}, without {withheld} withheld ones, which classes, returns, flags and columns include"
            )?,
            _ => writeln!(f, "points    {count}")?,
        }
        if !cells.is_empty() {
            let cells: Vec<String> = cells.iter().map(ToString::to_string).collect();
            writeln!(f, "cells     {}", cells.join(", "))?;
        }
        for (i, axis) in ["x", "y", "z"].iter().enumerate() {
            let [low, high] = [low[i], high[i]].map(|end| rounded_within(end, high[i] - low[i]));
            writeln!(f, "{axis}         {low} to {high}")?;
        }
        let has = |there: bool| if there { "yes" } else { "no" };
        let squares = if *of_radii { ", squares of its radii" } else { "" };
        writeln!(f, "weights   {}{squares}\nvalues    {}", has(*weights), has(*values))?;
        if let Some(CellSummary { text, .. }) = cell {
            writeln!(f, "cell      {text}")?;
        }
        if let Some([x, y, z]) = grid {
            writeln!(f, "grid      {x}×{y}×{z} samples, coordinates in {coordinates}")?;
        }
        self.fmt_scan(f)?;
        self.fmt_usage(f)
    }

    /// Displays what is known of the Earth and of the scan: the reference system, classes, returns, flags, times and columns.
    fn fmt_scan(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self::Points { scan, crs, unit, density, columns, .. } = self else { return Ok(()) };
        match crs {
            Some(crs) => writeln!(f, "system    {}", crs.label())?,
            None if scan.is_some() => writeln!(f, "system    none stated")?,
            None => {}
        }
        if let Some(Crs { vertical, .. }) = crs {
            let code = vertical.epsg.map(|epsg| format!("EPSG:{epsg}"));
            let unit = vertical.unit.as_ref().map(|unit| format!("in {unit}"));
            let stated: Vec<String> =
                [vertical.name.clone(), code, unit].into_iter().flatten().collect();
            if !stated.is_empty() {
                writeln!(f, "heights   {}", stated.join(", "))?;
            }
        }
        let Some(scan) = scan else { return fmt_columns(f, columns) };
        if let Some(density) = density {
            writeln!(f, "density   {} points in a square {unit}", rounded(*density))?;
        }
        for (index, (class, count)) in scan.classes.iter().enumerate() {
            let head = if index == 0 { "classes   " } else { "          " };
            writeln!(f, "{head}{class} ({}): {count}", ScanSummary::class_name(*class))?;
        }
        let returns = scan.returns.iter().map(|(number, count)| format!("{number}: {count}"));
        writeln!(f, "returns   {}", returns.collect::<Vec<_>>().join(", "))?;
        let Flags { withheld, overlap, synthetic, key_point } = scan.flags;
        writeln!(
            f,
            "flags     withheld {withheld}, overlap {overlap}, synthetic {synthetic}, key point {key_point}"
        )?;
        if let Some([first, last]) = scan.time {
            writeln!(f, "time      {first} to {last} s ({})", scan.time_of)?;
        }
        fmt_columns(f, columns)
    }

    /// Displays the file's remarks on its points, and how they were made and are meant to be used: atoms, notes, unit,
    /// recipe, α and gray range.
    fn fmt_usage(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self::Points { atoms, alpha, gray_range, grid, coordinates, recipe, notes, .. } = self
        else {
            return Ok(());
        };
        if let Some(AtomsSummary { summary, .. }) = atoms {
            writeln!(f, "molecule  {summary}")?;
        }
        if !notes.is_empty() {
            writeln!(f, "of these  {}", notes.join(", "))?;
        }
        if grid.is_none() && coordinates.unit.is_known() {
            writeln!(f, "unit      {}", coordinates.unit.symbol())?;
        }
        if let Some(recipe) = recipe {
            writeln!(f, "recipe    {recipe}")?;
        }
        if let Some(alpha) = alpha {
            writeln!(f, "α         {} {}²", rounded(alpha.squared()), coordinates.unit.symbol())?;
        }
        match gray_range {
            Some([low, high]) => {
                writeln!(
                    f,
                    "gray      values {} to {} were 0 to 255",
                    rounded(*low),
                    rounded(*high)
                )
            }
            None => Ok(()),
        }
    }
}

/// Displays the position and orientation of the samples in world coordinates.
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
    writeln!(f, "spacing   {} {unit}", spacing.map(rounded).join(" "))?;
    writeln!(f, "origin    {} {unit}", origin.map(rounded).join(" "))?;
    if *direction != Frame::VOXEL.direction {
        for (i, axis) in ["x", "y", "z"].iter().enumerate() {
            let steps = direction.map(|row| rounded(row[i]));
            writeln!(f, "axis {axis}    {}", steps.join(" "))?;
        }
    }
    Ok(())
}

/// Displays the range of the finite values, if there are any.
fn fmt_values(
    f: &mut std::fmt::Formatter<'_>,
    range: Option<(f32, f32)>,
    gray_levels: bool,
) -> std::fmt::Result {
    let Some((min, max)) = range else {
        return writeln!(f, "values    none that is a finite number");
    };
    // Whole numbers, such as labels, have all their digits.
    let shown = |value: f32| match f64::from(value) {
        value if value.fract() == 0.0 && value.abs() < 1e15 => number(value),
        value => rounded(value),
    };
    let (min, max) = (shown(min), shown(max));
    let gray = if gray_levels { ", gray levels as they are" } else { "" };
    writeln!(f, "values    {min} to {max}{gray}")
}

/// Displays the columns of points, each with its type and range.
fn fmt_columns(f: &mut std::fmt::Formatter<'_>, columns: &[ColumnSummary]) -> std::fmt::Result {
    for (index, ColumnSummary { name, kind, min, max, missing }) in columns.iter().enumerate() {
        let head = if index == 0 { "columns   " } else { "          " };
        write!(f, "{head}{name}: {kind}")?;
        if let (Some(min), Some(max)) = (min, max) {
            write!(f, ", {} to {}", number(*min), number(*max))?;
        }
        if *missing > 0 {
            write!(f, ", none for {missing} points")?;
        }
        writeln!(f)?;
    }
    Ok(())
}

/// Displays the files with the samples of a volume, if these are not in the file that describes it.
fn fmt_data_files(f: &mut std::fmt::Formatter<'_>, files: &[String]) -> std::fmt::Result {
    match files {
        [] => Ok(()),
        [file] => writeln!(f, "samples   in {}", name(file)),
        [first, .., last] => {
            let ends = [first, last].map(|file| name(file)).join(" to ");
            writeln!(f, "samples   in {} files, {ends}", files.len())
        }
    }
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
                missing,
                padding,
                preset,
                labels,
                volumes,
                gray_levels,
                data_files,
            } => {
                writeln!(f, "format    {format}, samples of type {samples}")?;
                writeln!(f, "volume    {x}×{y}×{z} samples (x, y, z)")?;
                fmt_frame(f, *spacing, *origin, direction, *coordinates)?;
                fmt_values(f, min.zip(*max), *gray_levels)?;
                if let Some(labels) = labels {
                    write!(f, "{labels}")?;
                } else if let Some(preset) = preset {
                    writeln!(
                        f,
                        "units     the values look like Hounsfield units: `walpha shape` selects bone unless told \
                         otherwise, as by --preset {preset}"
                    )?;
                }
                if *missing > 0 {
                    let what = if *padding {
                        "padding, and masked; --nan VALUE replaces them"
                    } else {
                        "NaN or infinite; --nan masks or replaces them"
                    };
                    writeln!(f, "missing   {missing} samples are {what}")?;
                }
                if let Some(volumes) = volumes {
                    writeln!(
                        f,
                        "volumes   {volumes} in the file; --frame K reads one, and 0 is described here"
                    )?;
                }
                fmt_data_files(f, data_files)
            }
            Self::Unread { format, voxels, dims } => {
                writeln!(f, "volume    {format}")?;
                if let Some([x, y, z]) = dims {
                    writeln!(f, "size      {x}×{y}×{z}")?;
                }
                writeln!(f, "samples   {voxels}; extract one first")
            }
            Self::Mesh { format, points, tetrahedra, notes } => {
                writeln!(f, "format    {format}, a mesh that `walpha check` judges")?;
                writeln!(f, "points    {points}\ncells     {tetrahedra} tetrahedra")?;
                notes.iter().try_for_each(|note| writeln!(f, "note      {note}"))
            }
            Self::Series { series } => {
                writeln!(f, "series    {} in the folder; --series N reads one", series.len())?;
                series.iter().try_for_each(|one| writeln!(f, "          {one}"))
            }
            Self::Points { .. } => self.fmt_points(f),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn density_is_the_same_every_time() {
        let places =
            (0..600).map(|k| [f64::from(k * 7 % 60) / 3.0, f64::from(k * 11 % 70) / 7.0, 0.0]);
        let places: Vec<[f64; 3]> = places.collect();
        let found: BTreeSet<u64> =
            (0..100).filter_map(|_| density(&places).map(f64::to_bits)).collect();
        assert_eq!(found.len(), 1, "{found:?}");
    }

    #[test]
    fn density_is_that_of_the_box_where_points_fill_it() {
        let grid = |x: u32, y: u32| -> Vec<[f64; 3]> {
            let places = (0..x).flat_map(|i| (0..y).map(move |j| [i, j]));
            places.map(|[i, j]| [f64::from(i), f64::from(j), 0.0]).collect()
        };
        let of_box = |x: u32, y: u32| f64::from(x * y) / f64::from((x - 1) * (y - 1));
        for (x, y) in [(18, 17), (500, 3), (3, 500), (100, 100), (2, 2)] {
            let (found, wanted) = (density(&grid(x, y)).unwrap(), of_box(x, y));
            assert!((found / wanted - 1.0).abs() < 1e-9, "{x} {y}: {found} {wanted}");
        }
        // A hole does not count.
        let mut corners = grid(10, 10);
        corners.extend(grid(10, 10).iter().map(|[x, y, z]| [x + 500.0, y + 500.0, *z]));
        assert!(density(&corners).unwrap() > 1e-3 * of_box(10, 10));
        assert_eq!(density(&[[1.0, 2.0, 3.0]]), None);
    }
}
