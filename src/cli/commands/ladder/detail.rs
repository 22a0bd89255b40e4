//! `walpha ladder` over levels of detail: fewer points, or a coarser volume, and full detail in a region.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::io;
use std::path::Path;

use serde::Serialize;

use super::{Ladder, LevelErrors, Mesh, short};
use crate::cli::commands::folder::Folder;
use crate::cli::commands::outline;
use crate::cli::commands::pipeline::{Domain, read};
use crate::cli::options::global::Global;
use crate::cli::options::one_alpha;
use crate::cli::process::errors::{Result, fail, fail_usage};
use crate::cli::process::output::{name, print_summary};
use crate::cli::process::progress::Progress;
use crate::cli::report::SCHEMA_VERSION;
use crate::cli::report::offsets::FileOffset;
use crate::haar::smooth;
use crate::pipeline::{Input, Parameter, PlacedVolume};
use crate::points::{Points, Region, difference, focus, select, weigh};
use crate::progress::Stage;
use crate::shape::{AlphaShape, Betti, Measures, ShapeOptions, Surface, alpha_shape};
use crate::{
    Coordinates, HaarOptions, Recipe, Selection, SelectionRule, Tolerance, Truncation, Volume,
    Weighting,
};

/// How a level selects its points.
struct LevelOptions {
    name: String,
    haar: HaarOptions,
    selection: Selection,
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
        let mut progress = Progress::new(global);
        let recipe = self.pipeline.recipe()?;
        let Input::Volume(grays) = read(&self.pipeline.input, &recipe, &mut progress)? else {
            fail!("levels of detail are made of a volume, and this is a point file" => "use --alphas");
        };
        let weighting = recipe.weighting.unwrap_or(Weighting::Common(0.0));
        let source = recipe.source(grays)?;
        let parameter = one_alpha(recipe.alpha, &source)?;
        let PlacedVolume { ref volume, units, written, .. } = source;
        let alpha = parameter.alpha;
        let coordinates = units.coordinates(volume);
        let domain = Domain::of_grid(volume, units);
        let Some(selection) = recipe.selection(&source.range) else {
            fail_usage!("--select adaptive has no effect: levels of detail are selected by differences" => "omit it");
        };
        let mut front_end = FrontEnd { source: &source, recipe: &recipe, smoothed: None };
        let full =
            progress.stage(Stage::Points, || self.full(&mut front_end, &recipe, selection))?;
        let mut rows = Vec::new();
        for level in self.level_options(&recipe, selection) {
            let found = || front_end.points(&level.haar, &level.selection);
            let (mut points, truncation) = progress.stage(Stage::Points, found)?;
            if let Some((full, region)) = &full {
                points = focus(full, &points, region);
            }
            let grays = points.values.clone().unwrap_or_default();
            if let Some(values) = &mut points.values {
                values.iter_mut().for_each(|value| *value = written.value(*value));
            }
            outline::check(meshes.iter().map(|mesh| mesh.format), &points.positions)?;
            let weighted = weigh(points, weighting, alpha)?;
            let options = ShapeOptions::new(alpha);
            let shape = progress.stage(Stage::Shape, || alpha_shape(weighted, &options))?;
            let shape = shape.with_coordinates(coordinates);
            let errors = || LevelErrors::of(&shape, &grays, volume, units);
            let errors = progress.stage(Stage::Interpolate, errors)?;
            let mut row = Row::of(&shape, &truncation, &domain, errors);
            progress.stage(Stage::Write, || {
                write_meshes(&shape, &level.name, meshes, &mut folder, &mut row)
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
            points_in_region: full.as_ref().map(|(points, region)| inside(points, region)),
            levels: rows,
            seconds: progress.finish().into_iter().collect(),
        };
        folder.write("detail.csv", |out| write_rows(&facts.levels, out))?;
        folder.write("detail.json", |out| Ok(serde_json::to_writer_pretty(out, &facts)?))?;
        folder.finish()?;
        print_summary(global, &facts)
    }

    /// The points of full detail, and the region that keeps them, if `--focus` is given.
    fn full(
        &self,
        front_end: &mut FrontEnd<'_>,
        recipe: &Recipe,
        selection: Selection,
    ) -> Result<Option<(Points, &Region)>> {
        let Some(region) = &self.focus else { return Ok(None) };
        let (points, _) = front_end.points(&recipe.haar, &selection)?;
        if inside(&points, region) == 0 {
            fail!("no point lies in --focus: it is in the units of the points, x first");
        }
        Ok(Some((points, region)))
    }

    fn level_options(&self, recipe: &Recipe, selection: Selection) -> Vec<LevelOptions> {
        let haar = recipe.haar;
        let by_count = self.counts.iter().map(|&count| LevelOptions {
            name: count.to_string(),
            haar,
            selection: selection.rule(SelectionRule::Count(count)),
        });
        let by_epsilon = self.epsilons.iter().map(|&epsilon| LevelOptions {
            name: format!("epsilon-{}", short(epsilon)),
            haar: haar.tolerance(Tolerance::Epsilon(epsilon)),
            selection,
        });
        by_count.chain(by_epsilon).collect()
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
    pub alpha: Parameter,
    pub weights: String,
    pub domain: Domain,
    /// Points with full detail, which each level has besides its own; null without a region.
    pub points_in_region: Option<usize>,
    pub levels: Vec<Row>,
    pub seconds: BTreeMap<&'static str, f64>,
}

#[derive(Serialize)]
pub(super) struct Row {
    pub points: usize,
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
        truncation: &Truncation,
        domain: &Domain,
        errors: LevelErrors,
    ) -> Self {
        Self {
            errors,
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
        writeln!(f, "parameter {}", self.alpha)?;
        if let Some(points) = self.points_in_region {
            writeln!(
                f,
                "region    {points} points of full detail in each level, and those of the level"
            )?;
        }
        writeln!(
            f,
            "{:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>12} {:>9} {:>10}  files",
            "points",
            "rms",
            "F inside",
            "F filled",
            "cells",
            "boundary",
            "volume",
            "coverage",
            "bytes"
        )?;
        for row in &self.levels {
            writeln!(
                f,
                "{:>9} {:>9.4} {:>9} {:>9.4} {:>9} {:>9} {:>12.1} {:>8.2}% {:>10}  {}",
                row.points,
                row.rms,
                row.errors.inside.map_or("–".into(), |rmse| format!("{rmse:.4}")),
                row.errors.filled,
                row.cells,
                row.boundary_facets,
                row.measures.volume,
                100.0 * row.coverage,
                row.bytes,
                row.files.join(", ")
            )?;
        }
        let offsets = self.levels.iter().flat_map(|row| &row.offsets);
        offsets.into_iter().try_for_each(|offset| offset.fmt(f))?;
        writeln!(
            f,
            "rms: the error of the wavelet stage; F: RMSE of the interpolant, on the samples of the \
             shape, and filled, on all; in gray levels"
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
    ])?;
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
            row.errors.inside.map_or(String::new(), |rmse| rmse.to_string()),
            row.errors.filled.to_string(),
            row.bytes.to_string(),
        ])?;
    }
    csv.flush()
}
