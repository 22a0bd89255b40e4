//! The table and the figures, one by one.

mod barycentric;
mod claim;
mod common;
mod comparison;
mod compression;
mod extension;
mod geomview;
mod isosurface;
mod min_max;
mod plane;
mod points;
mod table;
mod unweighted;

use std::collections::BTreeMap;

use super::stage::{Eye, panel, panel_size};
use super::study::{Shaped, Shapes, Study};
use super::{File, Item, ReproduceError, text};
use crate::export::{Exporter, Ply};
use crate::render::{Figure, Panel, Picture, plain_colours};
use walpha_base::Monitor;

/// Makes one item, and leaves its files with the bench.
type Make = fn(&mut Bench<'_>) -> Result<Item, ReproduceError>;

/// All there is, in the paper's order, and what we add.
pub(super) const ALL: [(&str, Make); 14] = [
    ("Table 1", table::table_1),
    ("Figure 1", points::figure_1),
    ("Figure 2", plane::figure_2),
    ("Figure 3", plane::figure_3),
    ("Figure 4", plane::figure_4),
    ("Figure 5", isosurface::figure_5),
    ("Figure 6", unweighted::figure_6),
    ("Figure 7", common::figure_7),
    ("Figure 8", min_max::figure_8),
    ("Figure 9", barycentric::figure_9),
    ("Figure 10", comparison::figure_10),
    ("Figure 11", geomview::figure_11),
    ("Extension", extension::error_against_points),
    ("Compression", compression::bytes_against_error),
];

/// What figures are made from, and where their files go.
pub(super) struct Bench<'a> {
    pub study: &'a Study<'a>,
    pub shapes: &'a Shapes,
    /// Of what a figure does, whose progress is not shown.
    pub monitor: Monitor,
    pub files: Vec<File>,
    /// Pictures of shapes, by label: several figures show the same.
    views: BTreeMap<(String, Eye), Picture>,
}

impl<'a> Bench<'a> {
    pub(super) fn new(study: &'a Study<'a>, shapes: &'a Shapes, monitor: &Monitor) -> Self {
        let monitor = monitor.unreported();
        Self { study, shapes, monitor, files: Vec::new(), views: BTreeMap::new() }
    }

    /// Adds a file; gives its name.
    fn file(&mut self, name: &str, bytes: Vec<u8>) -> String {
        self.files.push(File { name: name.to_owned(), bytes });
        name.to_owned()
    }

    /// The boundary of a shape as a PLY file; gives its name.
    fn mesh(&mut self, name: &str, shaped: &Shaped) -> Result<String, ReproduceError> {
        let mut bytes = Vec::new();
        Ply::default().write(&shaped.shape, &mut bytes)?;
        Ok(self.file(name, bytes))
    }

    /// The picture of a shape.
    fn view(&mut self, shaped: &Shaped, eye: Eye) -> Result<Picture, ReproduceError> {
        let key = (shaped.numbers.label.clone(), eye);
        if let Some(picture) = self.views.get(&key) {
            return Ok(picture.clone());
        }
        let picture = self.study.stage.shape(&shaped.shape, eye)?;
        self.views.insert(key, picture.clone());
        Ok(picture)
    }

    /// The portrait of a shape with its numbers below.
    fn shape_panel(&mut self, title: &str, shaped: &Shaped) -> Result<Panel, ReproduceError> {
        Ok(panel(title, self.view(shaped, Eye::Portrait)?, captions(shaped)))
    }

    /// A shape from both cameras, its numbers below.
    fn two_views(&mut self, shaped: &Shaped) -> Result<Vec<Panel>, ReproduceError> {
        let side = self.view(shaped, Eye::Side)?;
        let front = self.shape_panel(VIEWS[0], shaped)?;
        Ok(vec![front, panel(VIEWS[1], side, Vec::new())])
    }

    /// The command line that makes everything again.
    fn reproduce_command(&self) -> String {
        format!("walpha reproduce --input {}", text::shell(self.study.subject.name))
    }

    /// The command line that draws a shape as our figure does, words left out.
    fn drawing_command(&self, shaped: &Shaped, file: &str) -> String {
        format!("{} {} -o {file}", shaped.numbers.command, self.study.stage.options())
    }
}

/// What the two views of a shape are called.
const VIEWS: [&str; 2] = ["from the front", "from its left"];

/// A figure of plain shapes, two in a row.
fn figure(title: &str, panels: Vec<Panel>) -> Figure {
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
fn captions(shaped: &Shaped) -> Vec<String> {
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
