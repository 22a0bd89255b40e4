//! What `walpha ladder` did over detail.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::io;

use serde::Serialize;

use crate::cli::ladder::errors::Errors;
use crate::cli::output::name;
use crate::cli::pipeline::Domain;
use crate::pipeline::Parameter;
use crate::shape::{AlphaShape, Betti, Measures, Surface};
use crate::{Coordinates, Truncation};

/// What `walpha ladder` did over detail.
#[derive(Serialize)]
pub(super) struct DetailSummary {
    pub schema_version: u32,
    pub input: String,
    /// Of points and all lengths.
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
    /// How far F is from the volume, in gray levels: on the samples of the shape, and on all.
    #[serde(flatten)]
    pub errors: Errors,
    /// Of all meshes of this level.
    pub bytes: u64,
    pub files: Vec<String>,
}

impl Row {
    /// Of a level's shape, before its meshes are written.
    pub(super) fn of(
        shape: &AlphaShape,
        truncation: &Truncation,
        domain: &Domain,
        errors: Errors,
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
            measures: *shape.measures(),
            coverage: if domain.volume > 0.0 {
                shape.measures().volume / domain.volume
            } else {
                0.0
            },
            bytes: 0,
            files: Vec::new(),
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
