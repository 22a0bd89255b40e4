//! What `walpha view` did.

use std::collections::BTreeMap;
use std::fmt::{self, Display};

use serde::Serialize;

use crate::cli::output::name;
use crate::render;

#[derive(Serialize)]
pub(super) struct ViewSummary {
    pub schema_version: u32,
    pub input: String,
    /// The coarsest first; the shape's own is the last.
    pub details: Vec<DetailSummary>,
    pub bytes: usize,
    /// What was left out for display, if anything.
    pub simplified: Option<String>,
    pub file: String,
    pub seconds: BTreeMap<&'static str, f64>,
}

/// A level of detail.
#[derive(Serialize)]
pub(super) struct DetailSummary {
    points: usize,
    levels: usize,
    /// Of F, filled in, on all samples, in the values that are written; null without a volume.
    rmse_filled: Option<f64>,
}

impl DetailSummary {
    pub(super) fn of(detail: &render::Detail<'_>) -> Self {
        Self {
            points: detail.levels.points().len(),
            levels: detail.levels.len(),
            rmse_filled: detail.differences.map(|differences| differences.rmse),
        }
    }
}

impl Display for ViewSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "input     {}", name(&self.input))?;
        for DetailSummary { points, levels, rmse_filled } in &self.details {
            write!(f, "detail    {points} points, {levels} levels")?;
            match rmse_filled {
                Some(rmse) => writeln!(f, ", RMSE of F {rmse:.4} (filled in)")?,
                None => writeln!(f)?,
            }
        }
        if let Some(told) = &self.simplified {
            writeln!(f, "page      {told}")?;
        }
        writeln!(f, "wrote     {}, {:.1} MB", name(&self.file), self.bytes as f64 / 1e6)?;
        let total = self.seconds.get("total").copied().unwrap_or_default();
        writeln!(f, "time      total {total:.2} s")
    }
}
