//! Levels of detail: fewer points, or a coarser volume, and full detail in a region.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::io;

use serde::Serialize;

use crate::cli::said::refused;
use crate::ladder::{Region, focus};
use crate::pipeline::Parameter;
use crate::points::{Points, Units, difference, select, weigh};
use crate::progress::Stage;
use crate::shape::{AlphaShape, Betti, Measures, ShapeOptions, Surface};
use crate::{
    Coordinates, GrayRange, HaarOptions, Selection, SelectionRule, Tolerance, Truncation, Volume,
    Weighting, alpha_shape, haar,
};

use super::super::Global;
use super::super::args::{FrozenPipelineArgs, WeightArgs};
use super::super::folder::Folder;
use super::super::output::{name, tell};
use super::super::pipeline::{Domain, Grays, Input, read};
use super::super::progress::Progress;
use super::super::report::SCHEMA_VERSION;
use super::errors::Errors;
use super::{Ladder, Mesh, short};

/// What `walpha ladder` did over detail.
#[derive(Serialize)]
struct Facts {
    schema_version: u32,
    input: String,
    /// Of points and all lengths.
    coordinates: Coordinates,
    alpha: Parameter,
    weights: String,
    domain: Domain,
    /// Points with full detail, which each level has besides its own; null without a region.
    points_in_region: Option<usize>,
    levels: Vec<Row>,
    seconds: BTreeMap<&'static str, f64>,
}

#[derive(Serialize)]
struct Row {
    points: usize,
    /// Of the wavelet stage: coefficients kept, ‖f − f̂‖ and its root mean square, gray levels.
    kept: u64,
    epsilon: f64,
    rms: f64,
    cells: usize,
    boundary_facets: usize,
    betti: Option<Betti>,
    #[serde(flatten)]
    measures: Measures,
    coverage: f64,
    /// How far F is from the volume, in gray levels: on the samples of the shape, and on all.
    #[serde(flatten)]
    errors: Errors,
    /// Of all meshes of this level.
    bytes: u64,
    files: Vec<String>,
}

impl Row {
    /// Of a level's shape, before its meshes are written.
    fn of(shape: &AlphaShape, truncation: &Truncation, domain: &Domain, errors: Errors) -> Self {
        Self {
            errors,
            points: shape.points().len(),
            kept: truncation.kept,
            epsilon: truncation.epsilon,
            rms: truncation.rms,
            cells: shape.complex().cells.len(),
            boundary_facets: Surface::of(shape).facets().count(),
            betti: shape.betti(),
            measures: *shape.measures(),
            coverage: shape.measures().volume / domain.volume,
            bytes: 0,
            files: Vec::new(),
        }
    }
}

/// What a level asks for.
struct Wanted {
    name: String,
    haar: HaarOptions,
    selection: Selection,
}

impl Ladder {
    pub(super) fn over_detail(
        &self,
        global: Global,
        meshes: &[Mesh],
        mut folder: Folder,
    ) -> anyhow::Result<()> {
        let given = &self.pipeline.input.given;
        given.refuse(&["refit"], "levels of detail keep the values of the samples")?;
        let mut progress = Progress::new(global);
        let Input::Volume(Grays { volume, range, written }) =
            read(&self.pipeline.input, &mut progress)?
        else {
            refused!("levels of detail are made of a volume, and this is a point file" => "use --alphas");
        };
        let weights = WeightArgs::from(self.pipeline.weights);
        let weighting = weights.weights.unwrap_or(Weighting::Common(0.0));
        let (volume, units) = self.pipeline.select.place(volume)?;
        let parameter = weights.of_volume(&volume, units)?;
        let alpha = parameter.alpha;
        let coordinates = units.coordinates(&volume);
        let domain = Domain::of_grid(&volume, units);
        let mut stages = Stages { volume: &volume, units, smoothed: None };
        let full = progress.stage(Stage::Points, || self.full(&mut stages, &range))?;
        let mut rows = Vec::new();
        for wanted in self.wanted(&range) {
            let (coarse, truncation) =
                progress.stage(Stage::Points, || stages.points(&wanted.haar, &wanted.selection))?;
            let mut points = match &full {
                Some((full, region)) => focus(full, &coarse, region),
                None => coarse,
            };
            let grays = points.values.clone().unwrap_or_default();
            if let Some(values) = &mut points.values {
                values.iter_mut().for_each(|value| *value = written.value(*value));
            }
            let weighted = weigh(&points, weighting, alpha)?;
            let options = ShapeOptions { refuse_flat: true, ..ShapeOptions::new(alpha) };
            let shape = progress.stage(Stage::Shape, || alpha_shape(weighted, &options))?;
            let shape = shape.meaning(coordinates);
            let errors = progress
                .stage(Stage::Interpolate, || Errors::of(&shape, &grays, &volume, units))?;
            let mut row = Row::of(&shape, &truncation, &domain, errors);
            progress.stage(Stage::Write, || -> anyhow::Result<()> {
                for mesh in meshes {
                    let name = format!("detail-{}.{}", wanted.name, mesh.extension);
                    row.bytes += folder.write(&name, |out| mesh.exporter.write(&shape, out))?;
                    row.files.push(name);
                }
                Ok(())
            })?;
            rows.push(row);
        }
        let in_region = |(points, region): &(Points, &Region)| {
            points.positions.iter().filter(|&&p| region.contains(p)).count()
        };
        let facts = Facts {
            schema_version: SCHEMA_VERSION,
            input: self.pipeline.input.input.clone(),
            coordinates,
            alpha: parameter,
            weights: weighting.to_string(),
            domain,
            points_in_region: full.as_ref().map(in_region),
            levels: rows,
            seconds: progress.finish().into_iter().collect(),
        };
        folder.write("detail.csv", |out| write_rows(&facts.levels, out))?;
        folder.write("detail.json", |out| Ok(serde_json::to_writer_pretty(out, &facts)?))?;
        folder.finish()?;
        tell(global, &facts)
    }

    /// The points of full detail, and the region that keeps them, if one does.
    fn full(
        &self,
        stages: &mut Stages<'_>,
        range: &GrayRange,
    ) -> anyhow::Result<Option<(Points, &Region)>> {
        let Some(region) = &self.focus else { return Ok(None) };
        let FrozenPipelineArgs { haar, select, .. } = &self.pipeline;
        let (points, _) = stages.points(&haar.options(), &select.selection(range))?;
        if !points.positions.iter().any(|&p| region.contains(p)) {
            refused!("no point lies in --focus: it is in the units of the points, x first");
        }
        Ok(Some((points, region)))
    }

    fn wanted(&self, range: &GrayRange) -> Vec<Wanted> {
        let FrozenPipelineArgs { haar, select, .. } = &self.pipeline;
        let (haar, selection) = (haar.options(), select.selection(range));
        let by_count = self.counts.iter().map(|&count| Wanted {
            name: count.to_string(),
            haar,
            selection: Selection { rule: SelectionRule::Count(count), ..selection },
        });
        let by_epsilon = self.epsilons.iter().map(|&epsilon| Wanted {
            name: format!("epsilon-{}", short(epsilon)),
            haar: HaarOptions { tolerance: Tolerance::Epsilon(epsilon), ..haar },
            selection,
        });
        by_count.chain(by_epsilon).collect()
    }
}

/// The stages before weights; the truncated volume is kept for the next level.
struct Stages<'a> {
    volume: &'a Volume,
    units: Units,
    smoothed: Option<(HaarOptions, Volume, Truncation)>,
}

impl Stages<'_> {
    fn points(
        &mut self,
        options: &HaarOptions,
        selection: &Selection,
    ) -> anyhow::Result<(Points, Truncation)> {
        let (_, smoothed, truncation) =
            if let Some(known) = self.smoothed.take().filter(|s| s.0 == *options) {
                self.smoothed.insert(known)
            } else {
                let (smoothed, truncation) = haar::smooth(self.volume, options)?;
                self.smoothed.insert((*options, smoothed, truncation))
            };
        let points = select(self.volume, smoothed, &difference(smoothed), selection, self.units)?;
        Ok((points, *truncation))
    }
}

impl Display for Facts {
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
        writeln!(
            f,
            "rms: the error of the wavelet stage; F: RMSE of the interpolant, on the samples of the \
             shape, and filled, on all; in gray levels"
        )
    }
}

/// `detail.csv`: a row for each level.
fn write_rows(rows: &[Row], out: &mut dyn io::Write) -> io::Result<()> {
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
