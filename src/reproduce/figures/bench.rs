//! Common parts of all figures: shapes, pictures, files, claims and their verdicts.

use std::collections::BTreeMap;

use walpha_base::Monitor;

use crate::export::{Exporter, Ply};
use crate::render::{Figure, Panel, Picture, plain_colours};
use crate::reproduce::study::{Eye, panel, panel_size};
use crate::reproduce::study::{Shaped, Shapes, Study};
use crate::reproduce::{File, Finding, ReproduceError, Verdict, text};

/// The inputs of the figures, and the files that they make.
pub(in crate::reproduce) struct Bench<'a> {
    pub study: &'a Study<'a>,
    pub shapes: &'a Shapes,
    /// Cancels the work of a figure, whose progress is not shown.
    pub monitor: Monitor,
    pub(in crate::reproduce) files: Vec<File>,
    /// Pictures of shapes, by label, as several figures show the same picture.
    views: BTreeMap<(String, Eye), Picture>,
}

impl<'a> Bench<'a> {
    pub(in crate::reproduce) fn new(
        study: &'a Study<'a>,
        shapes: &'a Shapes,
        monitor: &Monitor,
    ) -> Self {
        let monitor = monitor.unreported();
        Self { study, shapes, monitor, files: Vec::new(), views: BTreeMap::new() }
    }

    /// Adds a file; returns its name.
    pub(super) fn file(&mut self, name: &str, bytes: Vec<u8>) -> String {
        self.files.push(File { name: name.to_owned(), bytes });
        name.to_owned()
    }

    /// Adds the boundary of a shape as a PLY file; returns its name.
    pub(super) fn mesh(&mut self, name: &str, shaped: &Shaped) -> Result<String, ReproduceError> {
        let mut bytes = Vec::new();
        Ply::default().write(&shaped.shape, &mut bytes)?;
        Ok(self.file(name, bytes))
    }

    /// The picture of a shape.
    pub(super) fn view(&mut self, shaped: &Shaped, eye: Eye) -> Result<Picture, ReproduceError> {
        let key = (shaped.numbers.label.clone(), eye);
        if let Some(picture) = self.views.get(&key) {
            return Ok(picture.clone());
        }
        let picture = self.study.cameras.shape(&shaped.shape, eye)?;
        self.views.insert(key, picture.clone());
        Ok(picture)
    }

    /// The portrait of a shape with its numbers below.
    pub(super) fn shape_panel(
        &mut self,
        title: &str,
        shaped: &Shaped,
    ) -> Result<Panel, ReproduceError> {
        Ok(panel(title, self.view(shaped, Eye::Portrait)?, captions(shaped)))
    }

    /// A shape seen from both cameras, with its numbers below.
    pub(super) fn two_views(&mut self, shaped: &Shaped) -> Result<Vec<Panel>, ReproduceError> {
        let side = self.view(shaped, Eye::Side)?;
        let front = self.shape_panel(VIEWS[0], shaped)?;
        Ok(vec![front, panel(VIEWS[1], side, Vec::new())])
    }
}

/// Titles of the two views of a shape.
pub(super) const VIEWS: [&str; 2] = ["from the front", "from its left"];

/// A figure of plain shapes, two in a row.
pub(super) fn figure(title: &str, panels: Vec<Panel>) -> Figure {
    Figure {
        title: title.into(),
        columns: 2,
        panel: panel_size(),
        panels,
        colour_bar: None,
        legend: plain_colours().map(|(name, colour)| (name.to_owned(), colour)).into(),
        notes: Vec::new(),
    }
}

/// The numbers below the picture of a shape.
pub(super) fn captions(shaped: &Shaped) -> Vec<String> {
    let n = &shaped.numbers;
    let boundary = n.facets.regular + n.facets.singular;
    vec![
        format!(
            "{} of {} points ({} hidden), {} cells",
            n.points_in_shape, n.points, n.hidden, n.cells
        ),
        format!(
            "{boundary} boundary facets; b₀ = {}, b₁ = {}, b₂ = {}",
            n.betti.b0, n.betti.b1, n.betti.b2
        ),
        format!("volume {}, voids {}", text::number(n.volume), text::number(n.void_volume)),
    ]
}

/// A claim of the paper, and the function that judges it by measurements.
pub(super) struct Claim<Evidence> {
    /// The claim.
    pub text: &'static str,
    /// The verdict, and the numbers that lead to it.
    pub decide: fn(&Evidence) -> (Verdict, String),
}

/// Judges the claims of a table, in its order.
pub(super) fn judge<Evidence>(claims: &[Claim<Evidence>], evidence: &Evidence) -> Vec<Finding> {
    let finding = |claim: &Claim<Evidence>| {
        let (verdict, reason) = (claim.decide)(evidence);
        Finding { claim: claim.text.into(), verdict, reason }
    };
    claims.iter().map(finding).collect()
}
