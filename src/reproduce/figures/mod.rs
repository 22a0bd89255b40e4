//! The table and the figures, one by one.

mod common;
mod comparison;
mod geomview;
mod isosurface;
mod points;
mod table;
mod weighted;

use std::collections::BTreeMap;

use super::stage::{panel, panel_size};
use super::study::{Shaped, Shapes, Study};
use super::{File, Item, ReproduceError, text};
use crate::render::{Figure, Panel, Picture};

/// Makes one item, and leaves its files with the bench.
type Make = fn(&mut Bench<'_>) -> Result<Item, ReproduceError>;

/// All there is, in the paper's order.
pub(super) const ALL: [(&str, Make); 9] = [
    ("Table 1", table::table_1),
    ("Figure 1", points::figure_1),
    ("Figure 5", isosurface::figure_5),
    ("Figure 6", common::figure_6),
    ("Figure 7", common::figure_7),
    ("Figure 8", weighted::figure_8),
    ("Figure 9", weighted::figure_9),
    ("Figure 10", comparison::figure_10),
    ("Figure 11", geomview::figure_11),
];

/// What figures are made from, and where their files go.
pub(super) struct Bench<'a> {
    pub study: &'a Study<'a>,
    pub shapes: &'a Shapes,
    pub files: Vec<File>,
    /// Pictures of shapes, by label and number of columns: several figures show the same.
    views: BTreeMap<(String, usize), Picture>,
}

impl<'a> Bench<'a> {
    pub fn new(study: &'a Study<'a>, shapes: &'a Shapes) -> Self {
        Self { study, shapes, files: Vec::new(), views: BTreeMap::new() }
    }

    /// Adds a file; gives its name.
    fn file(&mut self, name: &str, bytes: Vec<u8>) -> String {
        self.files.push(File { name: name.to_owned(), bytes });
        name.to_owned()
    }

    /// The picture of a shape for a panel in a row of `columns`.
    fn view(&mut self, shaped: &Shaped, columns: usize) -> Result<Picture, ReproduceError> {
        let key = (shaped.numbers.label.clone(), columns);
        if let Some(picture) = self.views.get(&key) {
            return Ok(picture.clone());
        }
        let picture = self.study.stage.shape(&shaped.shape, panel_size(columns))?;
        self.views.insert(key, picture.clone());
        Ok(picture)
    }

    /// A shape with its numbers below.
    fn shape_panel(
        &mut self,
        title: &str,
        shaped: &Shaped,
        columns: usize,
    ) -> Result<Panel, ReproduceError> {
        Ok(panel(title, self.view(shaped, columns)?, captions(shaped)))
    }

    /// The command line that draws a shape as our figure does, words left out.
    fn drawing_command(&self, shaped: &Shaped, columns: usize, file: &str) -> String {
        let camera = self.study.stage.options(panel_size(columns));
        format!("{} {camera} -o {file}", shaped.numbers.command)
    }
}

/// A figure of pictures, without colour bar or legend.
fn figure(title: &str, columns: usize, panels: Vec<Panel>) -> Figure {
    Figure {
        title: title.into(),
        columns,
        panel: panel_size(columns),
        panels,
        colour_bar: None,
        legend: Vec::new(),
        notes: Vec::new(),
    }
}

/// The numbers below the picture of a shape.
fn captions(shaped: &Shaped) -> Vec<String> {
    let n = &shaped.numbers;
    let boundary = n.facets.regular + n.facets.singular;
    vec![
        format!(
            "{} of {} points, {} hidden; {} cells, {boundary} boundary facets",
            n.points_in_shape, n.points, n.hidden, n.cells
        ),
        format!(
            "b₀ = {}, b₁ = {}, b₂ = {}; volume {}, voids {}",
            n.betti.b0,
            n.betti.b1,
            n.betti.b2,
            text::number(n.volume),
            text::number(n.void_volume)
        ),
    ]
}
