//! The facts that a command prints, as JSON or as text.

pub(super) mod offsets;
mod parts;
mod plane;

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::fs;

use serde::Serialize;
use walpha_base::memory;
use walpha_base::shown::{brief, counted, grouped, rounded, six_digits};

use crate::interpolate::{Adaptive, Fit, Refit};
use crate::labels::LabelSizes;
use crate::outofcore::{Merged, Plan};
use crate::pipeline::{Model, Parameter, Weighed};
use crate::points::WeightSummary;
use crate::shape::{Alpha, Cuts, Engine, Kept};
use crate::surface::Isovalue;
use crate::{Coordinates, GrayRange, LengthUnit};

use crate::cli::commands::pipeline::VolumeSummary;
use crate::cli::process::errors::Result;
use crate::cli::process::output::name;
use crate::cli::report::offsets::{FileOffset, print_offsets};
use parts::{BallsReport, EndedEarly, InputReport, PointsReport, ShapeReport};
pub(super) use parts::{HaarReport, MovedIntoBox, WeightsReport, certain};

/// The version of the schema. It is incremented when a field is removed or changes its meaning; new fields may be added at any
/// time.
pub(super) const SCHEMA_VERSION: u32 = 1;

/// The stages whose times are printed, in the order of the work.
const STAGES: [&str; 11] = [
    "read",
    "haar",
    "points",
    "alpha",
    "refit",
    "shape",
    "measure",
    "fill",
    "interpolate",
    "write",
    "total",
];

/// The report of `walpha shape` and `walpha points`. Unknown facts are null.
#[derive(Serialize)]
pub(super) struct Report {
    schema_version: u32,
    input: InputReport,
    /// The coordinates of points, and the unit of all lengths: areas are in the square of this unit, volumes in its cube, α and
    /// weights in the square.
    coordinates: Coordinates,
    /// The labels whose solid the shape is; absent if it is a shape of α.
    #[serde(skip_serializing_if = "Option::is_none")]
    labels: Option<LabelSizes>,
    /// The value at whose isosurface the shape ends; absent if the shape has an α.
    #[serde(skip_serializing_if = "Option::is_none")]
    isovalue: Option<Isovalue>,
    haar: Option<HaarReport>,
    points: PointsReport,
    /// The fit of values; null if they are those of samples.
    fit: Option<Fit>,
    /// Null if no α was needed.
    alpha: Option<Parameter>,
    /// Null for labels and isosurfaces, which have no weights.
    weights: Option<WeightsReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    shape: Option<ShapeReport>,
    /// The union of the balls; absent unless points have radii. The volume and area of `shape` are those of its simplices.
    #[serde(skip_serializing_if = "Option::is_none")]
    balls: Option<BallsReport>,
    /// α that joins 95 % of the points, where the default leaves the shape in pieces.
    #[serde(skip_serializing_if = "Option::is_none")]
    joining_alpha: Option<Alpha>,
    #[serde(skip_serializing_if = "Option::is_none")]
    engine: Option<Engine>,
    /// How many components were kept, if not all were to be; `shape` is what is kept.
    #[serde(skip_serializing_if = "Option::is_none")]
    kept: Option<Kept>,
    /// The places at which the boundary was cut apart, if it is written as that of a solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    solid: Option<Cuts>,
    files: Vec<String>,
    /// What shows the shape in the terminal, before the report.
    #[serde(skip)]
    pub(super) picture: Option<Vec<u8>>,
    /// Outputs that the command could have written.
    #[serde(skip)]
    pub(super) example: &'static str,
    /// The offsets that files in single precision have subtracted from coordinates, if they have.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) offsets: Vec<FileOffset>,
    seconds: BTreeMap<&'static str, f64>,
    pub(super) peak_memory_bytes: Option<u64>,
}

impl Report {
    /// Creates a report that leaves out everything unknown.
    fn new(input: InputReport, coordinates: Coordinates, points: PointsReport) -> Self {
        Self {
            schema_version: SCHEMA_VERSION,
            input,
            coordinates,
            labels: None,
            isovalue: None,
            haar: None,
            points,
            fit: None,
            alpha: None,
            weights: None,
            shape: None,
            balls: None,
            joining_alpha: None,
            engine: None,
            kept: None,
            solid: None,
            files: Vec::new(),
            picture: None,
            example: "bone.ply (or .stl, .vtu, .png)",
            offsets: Vec::new(),
            seconds: BTreeMap::new(),
            peak_memory_bytes: None,
        }
    }

    /// The report on points without a shape.
    pub(super) fn of_points(name: &str, weighed: &Weighed, volume: Option<&VolumeSummary>) -> Self {
        let origin = weighed.origin;
        let truncation = origin.truncation.as_ref().zip(volume);
        let input = InputReport {
            name: name.to_owned(),
            dims: volume.map(|v| v.dims),
            gray_range: volume
                .map(|VolumeSummary { range: GrayRange { low, high }, .. }| [*low, *high]),
        };
        let points =
            PointsReport {
                ended_early: origin.ended.map(|Adaptive { count, rmse, max_error, .. }| {
                    EndedEarly { asked: count, rmse, max_error }
                }),
                ..PointsReport::new(weighed.points.len())
            };
        Self {
            haar: truncation.map(|(truncation, v)| HaarReport::new(truncation, &v.range)),
            fit: origin.fit,
            alpha: weighed.parameter,
            weights: Some(WeightsReport::of(weighed)),
            ..Self::new(input, origin.coordinates, points)
        }
    }

    /// The report on a solid without α, on a grid of `dims` samples, before its shape is added.
    pub(super) fn of_solid(name: &str, dims: [usize; 3], model: &Model) -> Self {
        let input = InputReport { name: name.to_owned(), dims: Some(dims), gray_range: None };
        let points = PointsReport::new(model.shape.own_points());
        Self {
            labels: model.labels.clone(),
            isovalue: model.isovalue,
            ..Self::new(input, model.origin.coordinates, points)
        }
    }

    /// Adds a shape that was made by α.
    ///
    /// # Errors
    /// The errors of [`Model::joining_alpha`].
    pub(super) fn add_model(&mut self, model: &Model) -> Result<()> {
        self.alpha = Some(model.parameter);
        self.engine = Some(model.shape.options().engine);
        self.add_shape(model);
        self.balls = BallsReport::of(model)?;
        self.joining_alpha = model.joining_alpha()?;
        Ok(())
    }

    /// Adds a shape, whether it was made by α or not.
    pub(super) fn add_shape(&mut self, model: &Model) {
        let shape = &model.shape;
        self.points.duplicates = Some(shape.duplicates().len());
        self.points.folded = model.origin.folded;
        self.points.hidden = shape.hidden().map(<[u32]>::len);
        self.points.in_shape = Some(shape.points_in_shape());
        self.shape = Some(ShapeReport::of(shape));
        self.kept = shape.kept();
    }

    /// The report on a shape that was made in blocks.
    pub(super) fn of_blocks(plan: &Plan, merged: &Merged) -> Self {
        let (job, survey) = (&plan.job, &plan.survey);
        let GrayRange { low, high } = survey.range;
        let WeightSummary { min, mean, max } = merged.weights;
        let parameter = job.parameter();
        let input = InputReport {
            name: job.input.clone(),
            dims: Some(job.dims.xyz()),
            gray_range: Some([low, high]),
        };
        let points = PointsReport {
            duplicates: Some(0),
            in_shape: Some(merged.vertices.in_shape()),
            ..PointsReport::new(merged.points as usize)
        };
        Self {
            haar: Some(HaarReport::new(&survey.truncation, &survey.range)),
            alpha: Some(parameter),
            weights: Some(WeightsReport {
                kind: job.weighting().to_string(),
                of_radii: false,
                min,
                mean,
                max,
                unit: parameter.unit,
            }),
            shape: Some(ShapeReport::of_blocks(merged)),
            engine: Some(Engine::Native),
            ..Self::new(input, job.units.coordinates_of(&job.frame), points)
        }
    }

    /// Adds the places at which the boundary was cut apart.
    pub(super) fn add_solid(&mut self, cuts: Cuts) {
        self.solid = Some(cuts);
    }

    /// Adds the times, the files written, and the peak memory.
    pub(super) fn finish(&mut self, seconds: Vec<(&'static str, f64)>, files: Vec<String>) {
        self.seconds = seconds.into_iter().collect();
        self.files = files;
        self.peak_memory_bytes = memory::peak_bytes();
    }
}

/// In a few lines, or with classes, the wavelet stage and the time of each stage where the form is alternate (`{:#}`).
impl Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.print_origin(f)?;
        if f.alternate() {
            self.print_stages(f)?;
        } else {
            self.print_parameters(f)?;
        }
        if let Some(kept) = &self.kept {
            print_kept(f, kept, self.coordinates.unit)?;
        }
        if let Some(shape) = &self.shape {
            if f.alternate() {
                shape.print_all(f, self.coordinates.unit, self.balls.as_ref())?;
            } else {
                shape.print(f, self.coordinates.unit, self.balls.as_ref())?;
            }
        }
        self.print_apart(f)?;
        if self.points.in_shape == Some(0) {
            writeln!(f, "the shape is empty: every α + ω is negative; raise --alpha")?;
        }
        if let Some(cuts) = &self.solid {
            print_cuts(f, cuts, self.coordinates.unit)?;
        }
        print_offsets(&self.offsets, f)?;
        if f.alternate() {
            return ending(f, &self.files, &STAGES, &self.seconds);
        }
        print_files(f, &self.files)?;
        if self.files.is_empty() {
            writeln!(f, "nothing written: add -o {}", self.example)?;
        }
        match self.seconds.get("total") {
            Some(total) => writeln!(f, "time      {total:.2} s (-v: all numbers)"),
            None => Ok(()),
        }
    }
}

impl Report {
    /// Prints what was read, and what of it was selected.
    fn print_origin(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            writeln!(f, "input     {:#}", self.input)?;
        } else {
            write!(f, "input     {}", self.input)?;
            if self.coordinates.unit != LengthUnit::Unstated {
                write!(f, ", lengths in {}", self.coordinates)?;
            }
            writeln!(f)?;
        }
        if let Some(haar) = self.haar.as_ref().filter(|_| f.alternate()) {
            writeln!(f, "haar      {haar}")?;
        }
        if f.alternate() {
            writeln!(f, "points    {:#}", self.points)?;
        } else {
            writeln!(f, "points    {}", self.points)?;
        }
        if let Some(ended) = &self.points.ended_early {
            writeln!(f, "          {ended}")?;
        }
        if let Some(Fit { to, steps, residual }) = self.fit {
            let samples = match to {
                Refit::Whole => "all samples",
                Refit::Shape => "the samples on the shape",
            };
            write!(f, "values    fitted to {samples} by least squares: {steps} steps, ")?;
            writeln!(f, "relative residual {residual:.1e}")?;
        }
        if f.alternate() {
            writeln!(f, "lengths   in {}", self.coordinates)?;
        }
        if let Some(labels) = &self.labels {
            writeln!(f, "labels    {labels}, and the cells fill these voxels, without α")?;
        }
        if let Some(isovalue) = &self.isovalue {
            writeln!(
                f,
                "surface   at {isovalue}; the samples decide which cells are inside, without α"
            )?;
        }
        Ok(())
    }

    /// Prints the weights, if there are any, and α.
    fn print_parameters(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(weights) = self.weights.as_ref().filter(|weights| weights.are_there()) {
            writeln!(f, "weights   {weights}")?;
        }
        match &self.alpha {
            Some(alpha) => writeln!(f, "parameter {alpha}"),
            None => Ok(()),
        }
    }

    /// Prints the weights, α and the engine.
    fn print_stages(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(weights) = &self.weights {
            writeln!(f, "weights   {weights}")?;
        }
        if let Some(alpha) = &self.alpha {
            writeln!(f, "parameter {alpha:#}")?;
        }
        match self.engine {
            None => Ok(()),
            Some(Engine::Cgal) => writeln!(f, "engine    cgal; native gives the same"),
            Some(Engine::Both) => writeln!(f, "engine    both: cgal and native give the same"),
            Some(_) => writeln!(f, "engine    native; cgal gives the same"),
        }
    }
}

/// A size in a power of a unit, for people. Large ones in mm² and mm³ are in cm² and cm³.
pub(super) fn measure(size: f64, unit: LengthUnit, power: u32) -> String {
    /// From here on, the larger unit is easier to read.
    const LARGE: f64 = 1e4;
    let (size, unit) = match unit {
        LengthUnit::Millimetre if power > 1 && size >= LARGE => {
            (size / f64::from(10_u32.pow(power)), LengthUnit::Centimetre)
        }
        unit => (size, unit),
    };
    let exponent = ["", "", "²", "³"][power as usize];
    format!("{} {}{exponent}", brief(size), unit.symbol())
}

impl Report {
    /// Prints how many points are not connected to the others, and what to do about it. Where α was given, the user knows
    /// what holds together.
    fn print_apart(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let apart = self.shape.as_ref().map(|shape| shape.apart);
        let (Some(apart @ 1..), Some(all)) = (apart, self.points.in_shape) else { return Ok(()) };
        // Not `format_args!`, which Rust cannot bind to a name before 1.89.
        let [apart, all] = [apart, all].map(|count| grouped(count as u64));
        let text = format!("apart     {apart} of {all} points are not connected to the others");
        if let Some(alpha) = self.joining_alpha {
            let alpha = rounded_up(alpha.squared());
            return writeln!(f, "{text}; --alpha {alpha} joins 95 % of all");
        }
        match self.alpha.filter(Parameter::is_found) {
            Some(_) => writeln!(f, "{text}; raise --alpha to join them"),
            None => Ok(()),
        }
    }
}

/// A number that is not less, with six digits.
pub(super) fn rounded_up(least: f64) -> String {
    let near = six_digits(least);
    // One unit of the last digit, of which there are at least 10⁵.
    rounded(if near < least { near + near.abs() * 1e-5 } else { near })
}

/// Where a boundary was cut apart.
pub(super) fn print_cuts(f: &mut fmt::Formatter<'_>, cuts: &Cuts, unit: LengthUnit) -> fmt::Result {
    if *cuts == Cuts::default() {
        return writeln!(f, "solid     the boundary is a manifold as it is");
    }
    let Cuts { edges, vertices, midpoints, moved, largest_move, together, .. } = cuts;
    writeln!(
        f,
        "solid     the boundary is not a manifold: cut apart at {edges} edges, with {vertices} more \
         vertices and {midpoints} midpoints of edges; {moved} are moved, by {} at most",
        measure(*largest_move, unit, 1)
    )?;
    if *together > 0 {
        writeln!(
            f,
            "          {together} vertices still coincide with others, because there is no room to move them apart"
        )?;
    }
    Ok(())
}

/// What was kept of a shape.
pub(crate) fn print_kept(f: &mut fmt::Formatter<'_>, kept: &Kept, unit: LengthUnit) -> fmt::Result {
    if kept.of_volume == 0.0 {
        return writeln!(f, "kept      {kept}");
    }
    let volume = measure(kept.of_volume, unit, 3);
    writeln!(f, "kept      {kept}, which had a volume of {volume} together")
}

/// Prints the files written, and how large they are.
fn print_files(f: &mut fmt::Formatter<'_>, files: &[String]) -> fmt::Result {
    for file in files {
        write!(f, "wrote     {}", name(file))?;
        match fs::metadata(file) {
            Ok(found) if found.is_file() => {
                writeln!(f, ", {}", file_size(found.len()))?;
            }
            _ => writeln!(f)?,
        }
    }
    Ok(())
}

/// The size of a file, in units of powers of 1000.
fn file_size(bytes: u64) -> String {
    match bytes {
        0..1000 => counted(bytes, "byte"),
        1000..1_000_000 => format!("{:.1} kB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

/// Prints the last lines of a report: the files written, and the time of each stage.
pub(super) fn ending(
    f: &mut fmt::Formatter<'_>,
    files: &[String],
    stages: &[&str],
    seconds: &BTreeMap<&'static str, f64>,
) -> fmt::Result {
    print_files(f, files)?;
    let time = |stage: &&str| Some(format!("{stage} {:.2} s", seconds.get(stage)?));
    let times: Vec<String> = stages.iter().filter_map(time).collect();
    writeln!(f, "time      {}", times.join(", "))
}
