//! `walpha ladder` over levels of detail: fewer points, or a coarser volume, and full detail in a region.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::io;
use std::path::Path;

use serde::Serialize;
use walpha_base::sort::sort_by_key;

use super::{Ladder, LevelErrors, Mesh, short};
use crate::cli::commands::folder::Folder;
use crate::cli::commands::outline;
use crate::cli::commands::pipeline::{Domain, read_suited};
use crate::cli::options::global::Global;
use crate::cli::process::errors::{Result, fail, fail_usage};
use crate::cli::process::output::{name, print_summary};
use crate::cli::process::progress::Progress;
use crate::cli::report::offsets::{FileOffset, print_offsets};
use crate::cli::report::{SCHEMA_VERSION, print_kept};
use crate::distance::SurfaceDistance;
use crate::haar::smooth;
use crate::pipeline::{Input, Parameter, PlacedVolume};
use crate::points::{Points, Region, difference, focus, select, spread_order, weigh};
use crate::progress::Stage;
use crate::shape::{Alpha, AlphaShape, Betti, Kept, Measures, ShapeOptions, Surface, alpha_shape};
use crate::{
    Coordinates, HaarOptions, Recipe, Selection, SelectionRule, Tolerance, Truncation, Volume,
    Weighting,
};

/// A level of detail, before its shape is made.
struct LevelPoints {
    name: String,
    points: Points,
    truncation: Truncation,
    parameter: Parameter,
}

impl Ladder {
    /// Makes each level, and writes its meshes and numbers. One function, because its steps share nearly all of
    /// their data.
    pub(super) fn over_detail(
        &self,
        global: Global,
        meshes: &[Mesh],
        mut folder: Folder,
    ) -> Result<()> {
        let given = &self.pipeline.input.typed;
        given.refuse(&["refit"], "levels of detail keep the values of the samples")?;
        given.refuse(
            &["alpha_ref"],
            "weights of a level of detail are computed for its own α, --alpha",
        )?;
        let mut progress = Progress::new(global);
        let mut recipe = self.pipeline.recipe()?;
        let read = read_suited(&self.pipeline.input, &mut recipe, &mut progress)?;
        let Input::Volume(volume) = read else {
            fail!("levels of detail are made of a volume, and this is a point file" => "use --alphas")
        };
        let weighting = recipe.weighting.unwrap_or(Weighting::Common(0.0));
        let source = recipe.source(volume)?;
        let PlacedVolume { ref volume, units, written, .. } = source;
        let coordinates = units.coordinates(volume);
        let domain = Domain::of_grid(volume, units);
        let Some(selection) = recipe.selection(&source.range) else {
            fail_usage!("--select adaptive has no effect: levels of detail are selected by differences" => "omit it");
        };
        let mut front_end = FrontEnd { source: &source, recipe: &recipe, smoothed: None };
        let selected = || front_end.points(&recipe.haar, &selection);
        let (full, truncation) = progress.stage(Stage::Points, selected)?;
        if let Some(region) = &self.focus
            && inside(&full, region) == 0
        {
            fail!("no point lies in --focus: it is in the units of the points, x first");
        }
        let shape_at = |points: Points, alpha: Alpha| -> Result<AlphaShape> {
            let shape = alpha_shape(weigh(points, weighting, alpha)?, &ShapeOptions::new(alpha))?;
            Ok(recipe.kept(shape.with_coordinates(coordinates), coordinates.unit)?)
        };
        let found = || self.level_points(&mut front_end, selection, &full, truncation);
        let levels = progress.stage(Stage::Points, found)?;
        let parameter = match recipe.alpha.of_volume(volume, units)? {
            Some(parameter) => parameter,
            None => progress.stage(Stage::Alpha, || recipe.level_parameter(&full, &source))?,
        };
        let whole = progress.stage(Stage::Shape, || shape_at(full.clone(), parameter.alpha))?;
        let mut rows = Vec::new();
        for LevelPoints { name, mut points, truncation, parameter } in levels {
            if let Some(region) = &self.focus {
                points = focus(&full, &points, region);
            }
            let grays = points.values.clone().unwrap_or_default();
            if let Some(values) = &mut points.values {
                values.iter_mut().for_each(|value| *value = written.value(*value));
            }
            outline::check(meshes.iter().map(|mesh| mesh.format), &points.positions)?;
            let shape = progress.stage(Stage::Shape, || shape_at(points, parameter.alpha))?;
            let distance = || SurfaceDistance::between(&shape, &whole);
            let distance = progress.stage(Stage::Measure, distance)?;
            let errors = || LevelErrors::of(&shape, &grays, volume, units);
            let errors = progress.stage(Stage::Interpolate, errors)?;
            let mut row = Row::of(&shape, parameter, &truncation, &domain, errors, distance);
            progress.stage(Stage::Write, || {
                write_meshes(&shape, &name, meshes, &mut folder, &mut row)
            })?;
            rows.push(row);
        }
        let facts = DetailSummary {
            schema_version: SCHEMA_VERSION,
            input: self.pipeline.input.input.to_string(),
            coordinates,
            alpha: parameter,
            weights: weighting.to_string(),
            domain,
            points_in_region: self.focus.as_ref().map(|region| inside(&full, region)),
            full: FullDetail::of(&whole),
            levels: rows,
            seconds: progress.finish().into_iter().collect(),
        };
        folder.write("detail.csv", |out| write_rows(&facts.levels, out))?;
        folder.write("detail.json", |out| Ok(serde_json::to_writer_pretty(out, &facts)?))?;
        folder.finish()?;
        print_summary(global, &facts)
    }

    /// The points of each level, without those of the region, and its α.
    fn level_points(
        &self,
        front_end: &mut FrontEnd<'_>,
        selection: Selection,
        full: &Points,
        truncation: Truncation,
    ) -> Result<Vec<LevelPoints>> {
        let (recipe, source) = (front_end.recipe, front_end.source);
        let order = if self.counts.is_empty() { Vec::new() } else { spread_order(full)? };
        let mut levels = Vec::new();
        for &count in &self.counts {
            let points = match order.get(..count as usize) {
                Some(first @ [_, ..]) => {
                    let mut kept = vec![false; full.len()];
                    first.iter().for_each(|&index| kept[index as usize] = true);
                    let mut points = full.clone();
                    points.keep(&kept);
                    points
                }
                // More than the shape has.
                _ => {
                    front_end.points(&recipe.haar, &selection.rule(SelectionRule::Count(count)))?.0
                }
            };
            let parameter = recipe.level_parameter(&points, source)?;
            levels.push(LevelPoints { name: count.to_string(), points, truncation, parameter });
        }
        never_below_finer(&mut levels);
        for &epsilon in &self.epsilons {
            let haar = recipe.haar.tolerance(Tolerance::Epsilon(epsilon));
            let (points, truncation) = front_end.points(&haar, &selection)?;
            let parameter = recipe.level_parameter(&points, source)?;
            let name = format!("epsilon-{}", short(epsilon));
            levels.push(LevelPoints { name, points, truncation, parameter });
        }
        Ok(levels)
    }
}

/// Raises α of levels to that of levels with more points, which have all of their points: a coarser level closes all that a finer one does.
fn never_below_finer(levels: &mut [LevelPoints]) {
    let mut order: Vec<usize> = (0..levels.len()).collect();
    sort_by_key(&mut order, |&level| std::cmp::Reverse(levels[level].points.len()));
    for pair in order.windows(2) {
        let finer = levels[pair[0]].parameter;
        if levels[pair[1]].parameter.alpha < finer.alpha {
            levels[pair[1]].parameter = finer;
        }
    }
}

/// Number of points in a region.
fn inside(points: &Points, region: &Region) -> usize {
    points.positions.iter().filter(|&&p| region.contains(p)).count()
}

/// Writes a level's shape in each format, and adds names and sizes to its row.
fn write_meshes(
    shape: &AlphaShape,
    level: &str,
    meshes: &[Mesh],
    folder: &mut Folder,
    row: &mut Row,
) -> Result<()> {
    for mesh in meshes {
        let name = format!("detail-{level}.{}", mesh.extension);
        row.bytes += folder.write(&name, |out| mesh.exporter.write(shape, out))?;
        row.offsets.extend(FileOffset::of(Path::new(&name), mesh.exporter.as_ref(), shape));
        row.files.push(name);
    }
    Ok(())
}

/// The stages before the weights; the truncated volume is kept for the next level.
struct FrontEnd<'a> {
    source: &'a PlacedVolume,
    recipe: &'a Recipe,
    smoothed: Option<(HaarOptions, Volume, Truncation)>,
}

impl FrontEnd<'_> {
    fn points(
        &mut self,
        options: &HaarOptions,
        selection: &Selection,
    ) -> Result<(Points, Truncation)> {
        let PlacedVolume { ref volume, units, ref range, .. } = *self.source;
        let (_, smoothed, truncation) =
            if let Some(known) = self.smoothed.take().filter(|s| s.0 == *options) {
                self.smoothed.insert(known)
            } else {
                let (smoothed, truncation) = smooth(volume, options)?;
                self.smoothed.insert((*options, smoothed, truncation))
            };
        let points = select(volume, smoothed, &difference(smoothed), selection, units)
            .map_err(|error| self.recipe.in_its_terms(error, range))?;
        Ok((points, *truncation))
    }
}

/// Summary of `walpha ladder` over levels of detail.
#[derive(Serialize)]
pub(super) struct DetailSummary {
    pub schema_version: u32,
    pub input: String,
    /// Unit of points and all lengths.
    pub coordinates: Coordinates,
    /// α of full detail.
    pub alpha: Parameter,
    pub weights: String,
    pub domain: Domain,
    /// Points with full detail, which each level has besides its own; null without a region.
    pub points_in_region: Option<usize>,
    /// The shape of all points that are selected, which levels are compared with.
    pub full: FullDetail,
    pub levels: Vec<Row>,
    pub seconds: BTreeMap<&'static str, f64>,
}

/// The shape of full detail.
#[derive(Serialize)]
pub(super) struct FullDetail {
    points: usize,
    /// How many components were kept, if not all were to be; all else is of what was kept.
    #[serde(skip_serializing_if = "Option::is_none")]
    kept: Option<Kept>,
    largest_part: Option<f64>,
    #[serde(flatten)]
    measures: Measures,
}

impl FullDetail {
    fn of(shape: &AlphaShape) -> Self {
        let (points, measures) = (shape.points().len(), shape.measures());
        Self { points, kept: shape.kept(), largest_part: largest_part(shape), measures }
    }
}

/// The share of the vertices of a shape that are in the component with the most of them; `None` without a vertex.
fn largest_part(shape: &AlphaShape) -> Option<f64> {
    let largest = shape.components().iter().map(|component| component.vertices).max()?;
    Some(largest as f64 / shape.points_in_shape() as f64)
}

#[derive(Serialize)]
pub(super) struct Row {
    pub points: usize,
    pub alpha: Parameter,
    /// How many components were kept, if not all were to be; all else is of what was kept.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kept_components: Option<Kept>,
    /// Of the wavelet stage: coefficients kept, ‖f − f̂‖ and its root mean square, gray levels.
    pub kept: u64,
    pub epsilon: f64,
    pub rms: f64,
    pub cells: usize,
    pub boundary_facets: usize,
    pub betti: Option<Betti>,
    #[serde(flatten)]
    pub measures: Measures,
    pub coverage: f64,
    /// Share of the vertices in the component that has the most; null without a vertex.
    pub largest_part: Option<f64>,
    /// Distance from the surface of full detail; null where one of both has no facet.
    pub distance: Option<SurfaceDistance>,
    /// RMSE of F, in gray levels: on the samples of the shape, and on all.
    #[serde(flatten)]
    pub errors: LevelErrors,
    /// Size of this level's meshes.
    pub bytes: u64,
    pub files: Vec<String>,
    /// What meshes in single precision have subtracted from coordinates, where they have.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub offsets: Vec<FileOffset>,
}

impl Row {
    /// The row of a level, before its meshes are written.
    pub(super) fn of(
        shape: &AlphaShape,
        alpha: Parameter,
        truncation: &Truncation,
        domain: &Domain,
        errors: LevelErrors,
        distance: Option<SurfaceDistance>,
    ) -> Self {
        Self {
            errors,
            distance,
            alpha,
            kept_components: shape.kept(),
            largest_part: largest_part(shape),
            points: shape.points().len(),
            kept: truncation.kept,
            epsilon: truncation.epsilon,
            rms: truncation.rms,
            cells: shape.complex().cells.len(),
            boundary_facets: Surface::of(shape).facets().count(),
            betti: shape.betti(),
            measures: shape.measures(),
            coverage: if domain.volume > 0.0 {
                shape.measures().volume / domain.volume
            } else {
                0.0
            },
            bytes: 0,
            files: Vec::new(),
            offsets: Vec::new(),
        }
    }
}

impl Display for DetailSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "input     {}", name(&self.input))?;
        writeln!(f, "lengths   in {}", self.coordinates)?;
        writeln!(f, "weights   {}", self.weights)?;
        let FullDetail { points, kept, measures, .. } = &self.full;
        let unit = self.coordinates.unit.symbol();
        writeln!(
            f,
            "full      {points} points, volume {:.1} {unit}³, {}",
            measures.volume, self.alpha
        )?;
        if let Some(kept) = kept {
            print_kept(f, kept, self.coordinates.unit)?;
        }
        if let Some(points) = self.points_in_region {
            writeln!(
                f,
                "region    {points} points of full detail in each level, and those of the level"
            )?;
        }
        writeln!(
            f,
            "{:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>12} {:>9} {:>8} {:>8} {:>8} {:>10}  files",
            "points",
            "α",
            "rms",
            "F inside",
            "F filled",
            "cells",
            "boundary",
            "volume",
            "coverage",
            "largest",
            "mean",
            "farthest",
            "bytes"
        )?;
        let or_none = |number: Option<f64>, digits: usize| {
            number.map_or("–".into(), |number| format!("{number:.digits$}"))
        };
        for row in &self.levels {
            let distance = row.distance;
            writeln!(
                f,
                "{:>9} {:>9.3} {:>9.4} {:>9} {:>9.4} {:>9} {:>9} {:>12.1} {:>8.2}% {:>7}% {:>8} {:>8} {:>10}  {}",
                row.points,
                row.alpha.alpha.squared(),
                row.rms,
                or_none(row.errors.inside, 4),
                row.errors.filled,
                row.cells,
                row.boundary_facets,
                row.measures.volume,
                100.0 * row.coverage,
                or_none(row.largest_part.map(|share| 100.0 * share), 1),
                or_none(distance.map(|distance| distance.mean), 3),
                or_none(distance.map(|distance| distance.max), 3),
                row.bytes,
                row.files.join(", ")
            )?;
        }
        for row in &self.levels {
            if let Some(kept) = &row.kept_components {
                writeln!(f, "kept      of {} points {kept}", row.points)?;
            }
        }
        let offsets = self.levels.iter().flat_map(|row| &row.offsets);
        print_offsets(offsets, f)?;
        writeln!(
            f,
            "rms: the error of the wavelet stage; F: RMSE of the interpolant, on the samples of the \
             shape, and filled, on all; in gray levels. largest: share of the vertices in the largest part. \
             mean, farthest: distance from the surface of full detail, in {unit}"
        )
    }
}

/// `detail.csv`: a row for each level.
pub(super) fn write_rows(rows: &[Row], out: &mut dyn io::Write) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record([
        "points",
        "kept",
        "epsilon",
        "rms",
        "cells",
        "boundary_facets",
        "b0",
        "b1",
        "b2",
        "volume",
        "area",
        "coverage",
        "rmse_inside",
        "rmse_filled",
        "bytes",
        "alpha",
        "largest_part",
        "distance_mean",
        "distance_max",
    ])?;
    let or_empty = |number: Option<f64>| number.map_or(String::new(), |number| number.to_string());
    for row in rows {
        let betti = row.betti.map(<[u64; 3]>::from);
        let betti = [0, 1, 2].map(|k| betti.map_or(String::new(), |betti| betti[k].to_string()));
        let [b0, b1, b2] = betti;
        csv.write_record([
            row.points.to_string(),
            row.kept.to_string(),
            row.epsilon.to_string(),
            row.rms.to_string(),
            row.cells.to_string(),
            row.boundary_facets.to_string(),
            b0,
            b1,
            b2,
            row.measures.volume.to_string(),
            row.measures.area.to_string(),
            row.coverage.to_string(),
            or_empty(row.errors.inside),
            row.errors.filled.to_string(),
            row.bytes.to_string(),
            row.alpha.alpha.to_string(),
            or_empty(row.largest_part),
            or_empty(row.distance.map(|distance| distance.mean)),
            or_empty(row.distance.map(|distance| distance.max)),
        ])?;
    }
    csv.flush()
}
