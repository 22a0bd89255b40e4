//! The facts a command prints, as JSON or as text.

use std::collections::BTreeMap;
use std::fmt::{self, Display};

use serde::Serialize;

use crate::blocks::{Merged, Plan};
use crate::interpolate::{Adaptive, Fit, Refit};
use crate::pipeline::{Model, Parameter, Weighed};
use crate::points::WeightSummary;
use crate::shape::{Betti, ByClass, Component, Cuts, Engine, Void};
use crate::shown::number;
use crate::{AlphaShape, Coordinates, GrayRange, LengthUnit, Truncation, memory};

use super::output::name;
use super::pipeline::VolumeFacts;

/// Counted up when a field changes its meaning or goes; new fields may come at any time.
pub(super) const SCHEMA_VERSION: u32 = 1;

/// The stages whose times are printed, in the order of the work.
const STAGES: [&str; 10] =
    ["read", "haar", "points", "alpha", "refit", "shape", "fill", "interpolate", "write", "total"];

/// What `walpha shape` and `walpha points` did. A fact that is not known is null.
#[derive(Serialize)]
pub(super) struct Report {
    schema_version: u32,
    input: InputReport,
    /// Of points and all lengths: areas are in the square of this unit, volumes in its cube, α and
    /// weights in the square.
    coordinates: Coordinates,
    haar: Option<HaarReport>,
    points: PointsReport,
    /// How values were fitted; null where they are those of samples.
    fit: Option<Fit>,
    /// Null where no α was needed.
    alpha: Option<Parameter>,
    weights: WeightsReport,
    #[serde(skip_serializing_if = "Option::is_none")]
    shape: Option<ShapeReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    engine: Option<Engine>,
    /// Where the boundary was cut apart, if it is written as that of a solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    solid: Option<Cuts>,
    files: Vec<String>,
    seconds: BTreeMap<&'static str, f64>,
    pub(super) peak_memory_bytes: Option<u64>,
}

#[derive(Serialize)]
struct InputReport {
    name: String,
    /// Samples along x, y and z; null for points.
    dims: Option<[usize; 3]>,
    /// The values that became gray 0 and 255; null for points.
    gray_range: Option<[f64; 2]>,
}

#[derive(Serialize)]
pub(super) struct HaarReport {
    kept: u64,
    total: u64,
    /// Gray levels.
    epsilon: f64,
    rms: f64,
    /// In values of the input; null where these are gray levels.
    rms_in_values: Option<f64>,
}

#[derive(Serialize)]
struct PointsReport {
    selected: usize,
    duplicates: Option<usize>,
    hidden: Option<usize>,
    in_shape: Option<usize>,
    /// Adaptive selection needed fewer than asked for.
    ended_early: Option<Ended>,
}

/// Why there are fewer points than asked for.
#[derive(Clone, Copy, Serialize)]
struct Ended {
    asked: u64,
    /// The RMSE that was good enough; 0 where only a perfect interpolant is.
    rmse: f64,
    /// The bound on the largest error, if there was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    max_error: Option<f64>,
}

impl Display for Ended {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { asked, rmse, max_error } = self;
        write!(f, "fewer than {asked}: ")?;
        if let Some(bound) = max_error {
            return write!(
                f,
                "no sample is further than {bound} gray levels from the interpolant of these"
            );
        }
        match *rmse {
            0.0 => write!(f, "no sample differs from the interpolant of these any more"),
            rmse => write!(f, "these reach an RMSE of {rmse} gray levels"),
        }
    }
}

/// What the weights are.
#[derive(Serialize)]
pub(super) struct WeightsReport {
    kind: String,
    min: f64,
    mean: f64,
    max: f64,
    /// Of length; weights are in its square.
    unit: LengthUnit,
}

#[derive(Serialize)]
struct ShapeReport {
    cells: Cells,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    facets: ByClass<usize>,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    edges: ByClass<usize>,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    vertices: ByClass<usize>,
    betti: Option<Betti>,
    volume: f64,
    area: f64,
    singular_area: f64,
    /// The largest by volume, each with what its boundary shuts in.
    components: Vec<Component>,
    /// Null unless the simplices outside the shape are kept.
    voids: Option<Vec<Void>>,
}

#[derive(Serialize)]
struct Cells {
    interior: usize,
}

/// The simplices of a dimension in a line.
struct Line<'a>(&'a ByClass<usize>);

impl Display for Line<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ByClass { interior, regular, singular, .. } = self.0;
        write!(f, "{interior:>9} interior {regular:>9} regular {singular:>9} singular")
    }
}

impl WeightsReport {
    /// The weights of some points.
    pub(super) fn of(weighed: &Weighed) -> Self {
        let WeightSummary { min, mean, max } = weighed.points.summary();
        let origin = weighed.origin;
        let (kind, unit) = (origin.weighting.to_string(), origin.coordinates.unit);
        Self { kind, min, mean, max, unit }
    }
}

impl Display for WeightsReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, min, mean, max, unit } = self;
        write!(f, "{kind}: min {min:.6}, mean {mean:.6}, max {max:.6} {}²", unit.symbol())
    }
}

impl HaarReport {
    /// What was truncated, of values `range` that became gray 0..255.
    pub(super) fn new(t: &Truncation, range: &GrayRange) -> Self {
        let rms_in_values = (!range.is_identity()).then(|| t.rms * range.step());
        Self { kept: t.kept, total: t.total, epsilon: t.epsilon, rms: t.rms, rms_in_values }
    }
}

impl Display for HaarReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kept, total, epsilon, rms, rms_in_values } = self;
        write!(
            f,
            "{kept} of {total} coefficients kept, ε = {epsilon:.6}, rms {rms:.6} gray levels"
        )?;
        match rms_in_values {
            Some(rms) => write!(f, " ({rms:.6} in values)"),
            None => Ok(()),
        }
    }
}

impl Report {
    /// What is known before there is a shape.
    pub(super) fn of_points(name: &str, weighed: &Weighed, volume: Option<&VolumeFacts>) -> Self {
        let origin = weighed.origin;
        let truncation = origin.truncation.as_ref().zip(volume);
        Self {
            schema_version: SCHEMA_VERSION,
            input: InputReport {
                name: name.to_owned(),
                dims: volume.map(|v| v.dims),
                gray_range: volume
                    .map(|VolumeFacts { range: GrayRange { low, high }, .. }| [*low, *high]),
            },
            coordinates: origin.coordinates,
            haar: truncation.map(|(truncation, v)| HaarReport::new(truncation, &v.range)),
            points: PointsReport {
                selected: weighed.points.len(),
                duplicates: None,
                hidden: None,
                in_shape: None,
                ended_early: origin.ended.map(|Adaptive { count, rmse, max_error }| Ended {
                    asked: count,
                    rmse,
                    max_error,
                }),
            },
            fit: origin.fit,
            alpha: weighed.parameter,
            weights: WeightsReport::of(weighed),
            shape: None,
            engine: None,
            solid: None,
            files: Vec::new(),
            seconds: BTreeMap::new(),
            peak_memory_bytes: None,
        }
    }

    /// Adds what the shape is.
    pub(super) fn add_model(&mut self, model: &Model) {
        let shape = &model.shape;
        self.alpha = Some(model.parameter);
        let complex = shape.complex();
        self.points.duplicates = Some(shape.duplicates().len());
        self.points.hidden = shape.hidden().map(<[u32]>::len);
        self.points.in_shape = Some(shape.points_in_shape());
        self.engine = Some(shape.options().engine);
        self.shape = Some(ShapeReport {
            cells: Cells { interior: complex.cells.counts().interior },
            facets: complex.facets.counts(),
            edges: complex.edges.counts(),
            vertices: complex.vertices.counts(),
            betti: shape.betti(),
            volume: shape.measures().volume,
            area: shape.measures().area,
            singular_area: shape.measures().singular_area,
            components: largest_components(shape),
            voids: shape.voids(),
        });
    }

    /// What is known of a shape that was made in blocks.
    pub(super) fn of_blocks(plan: &Plan, merged: &Merged) -> Self {
        let (job, survey) = (&plan.job, &plan.survey);
        let GrayRange { low, high } = survey.range;
        let WeightSummary { min, mean, max } = merged.weights;
        let parameter = job.parameter();
        Self {
            schema_version: SCHEMA_VERSION,
            input: InputReport {
                name: job.input.clone(),
                dims: Some(job.dims.xyz()),
                gray_range: Some([low, high]),
            },
            coordinates: job.units.coordinates_of(&job.frame),
            haar: Some(HaarReport::new(&survey.truncation, &survey.range)),
            points: PointsReport {
                selected: merged.points as usize,
                duplicates: Some(0),
                hidden: merged.hidden.map(|hidden| hidden as usize),
                in_shape: Some(merged.vertices.in_shape()),
                ended_early: None,
            },
            alpha: Some(parameter),
            weights: WeightsReport {
                kind: job.weighting.to_string(),
                min,
                mean,
                max,
                unit: parameter.unit,
            },
            fit: None,
            shape: Some(ShapeReport {
                cells: Cells { interior: merged.cells },
                facets: merged.facets,
                edges: merged.edges,
                vertices: merged.vertices,
                betti: Some(merged.betti),
                volume: merged.measures.volume,
                area: merged.measures.area,
                singular_area: merged.measures.singular_area,
                components: largest_of(merged.components.clone()),
                voids: None,
            }),
            engine: Some(job.engine),
            solid: None,
            files: Vec::new(),
            seconds: BTreeMap::new(),
            peak_memory_bytes: None,
        }
    }

    /// Adds where the boundary was cut apart.
    pub(super) fn add_solid(&mut self, cuts: Cuts) {
        self.solid = Some(cuts);
    }

    /// Adds what it cost and what it left.
    pub(super) fn finish(&mut self, seconds: Vec<(&'static str, f64)>, files: Vec<String>) {
        self.seconds = seconds.into_iter().collect();
        self.files = files;
        self.peak_memory_bytes = memory::peak_bytes();
    }
}

/// Components listed at most.
const TOLD: usize = 20;

fn largest_components(shape: &AlphaShape) -> Vec<Component> {
    largest_of(shape.components())
}

fn largest_of(mut components: Vec<Component>) -> Vec<Component> {
    components.sort_by(|a, b| b.volume.total_cmp(&a.volume).then(b.vertices.cmp(&a.vertices)));
    components.truncate(TOLD);
    components
}

impl Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = self.coordinates.unit.symbol();
        writeln!(f, "input     {}", self.input)?;
        if let Some(haar) = &self.haar {
            writeln!(f, "haar      {haar}")?;
        }
        write!(f, "points    {}", self.points)?;
        if self.shape.is_some() && self.points.hidden.is_none() {
            write!(f, " (--blocks 1 counts hidden points)")?;
        }
        if let Some(ended) = &self.points.ended_early {
            write!(f, "\n          {ended}")?;
        }
        if let Some(Fit { to, steps, residual }) = self.fit {
            let samples = match to {
                Refit::Whole => "all samples",
                Refit::Shape => "the samples on the shape",
            };
            write!(f, "\nvalues    fitted to {samples} by least squares: {steps} steps, ")?;
            write!(f, "relative residual {residual:.1e}")?;
        }
        writeln!(f, "\nlengths   in {}", self.coordinates)?;
        writeln!(f, "weights   {} (squared lengths)", self.weights)?;
        if let Some(alpha) = &self.alpha {
            writeln!(f, "parameter {alpha}")?;
        }
        if let Some(shape) = &self.shape {
            shape.print(f, unit)?;
        }
        if self.points.in_shape == Some(0) {
            writeln!(f, "the shape is empty: every α + ω is negative; raise --alpha")?;
        }
        match self.solid {
            None => {}
            Some(cuts) if cuts == Cuts::default() => {
                writeln!(f, "solid     the boundary is a manifold as it is")?;
            }
            Some(Cuts { edges, vertices, midpoints }) => writeln!(
                f,
                "solid     the boundary is not a manifold: cut apart at {edges} edges, with {vertices} more \
                 vertices and {midpoints} midpoints of edges"
            )?,
        }
        ending(f, &self.files, &STAGES, &self.seconds)
    }
}

impl Display for InputReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", name(&self.name))?;
        if let (Some([x, y, z]), Some([low, high])) = (self.dims, self.gray_range) {
            let (low, high) = (number(low), number(high));
            write!(f, "  {x}×{y}×{z} samples, values {low}..{high} are gray 0..255")?;
        }
        Ok(())
    }
}

impl Display for PointsReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} selected", self.selected)?;
        let counts = [
            (self.duplicates, "duplicates"),
            (self.hidden, "hidden"),
            (self.in_shape, "in the shape"),
        ];
        for (count, what) in counts {
            if let Some(count) = count {
                write!(f, ", {count} {what}")?;
            }
        }
        Ok(())
    }
}

impl ShapeReport {
    /// Prints what the shape is, lengths in `unit`.
    fn print(&self, f: &mut fmt::Formatter<'_>, unit: &str) -> fmt::Result {
        writeln!(f, "cells     {:>9} interior", self.cells.interior)?;
        writeln!(f, "facets    {}", Line(&self.facets))?;
        writeln!(f, "edges     {}", Line(&self.edges))?;
        writeln!(f, "vertices  {}", Line(&self.vertices))?;
        match self.betti {
            None => {}
            Some(Betti { b0, b1, b2, b3: None }) => {
                writeln!(f, "topology  {b0} components, {b1} tunnels, {b2} voids")?;
            }
            Some(Betti { b0, b1, b2, b3: Some(b3) }) => {
                writeln!(f, "topology  b0 = {b0}, b1 = {b1}, b2 = {b2}, b3 = {b3} on the torus")?;
            }
        }
        writeln!(f, "volume    {:.6} {unit}³", self.volume)?;
        let (area, singular) = (self.area, self.singular_area);
        writeln!(f, "area      {area:.6} {unit}², singular facets {singular:.6} {unit}²")?;
        if let [largest, _, ..] = &self.components[..] {
            let Component { vertices, volume, .. } = largest;
            writeln!(f, "largest   component: {vertices} vertices, volume {volume:.6} {unit}³")?;
        }
        if let Some(voids) = &self.voids
            && let Some(largest) = voids.first()
        {
            let sum = voids.iter().fold(0.0, |sum, void| sum + void.volume);
            let Void { volume, filling_alpha, .. } = largest;
            writeln!(
                f,
                "voids     {sum:.6} {unit}³ in all, the largest {volume:.6} {unit}³, filled at α = \
                 {filling_alpha} {unit}²"
            )?;
        }
        Ok(())
    }
}

/// The last lines of a report: the files written, and how long each stage took.
pub(super) fn ending(
    f: &mut fmt::Formatter<'_>,
    files: &[String],
    stages: &[&str],
    seconds: &BTreeMap<&'static str, f64>,
) -> fmt::Result {
    for file in files {
        writeln!(f, "wrote     {}", name(file))?;
    }
    write!(f, "time     ")?;
    for stage in stages {
        if let Some(seconds) = seconds.get(stage) {
            write!(f, " {stage} {seconds:.2} s")?;
        }
    }
    writeln!(f)
}
