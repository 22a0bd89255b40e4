//! The requests of the page.

use std::path::PathBuf;

use serde::Deserialize;
use walpha_model::Settings;

/// A request; fields are named as in JavaScript.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "camelCase", rename_all_fields = "camelCase")]
pub(crate) enum Request {
    /// The presets of the command.
    Presets,
    /// Reads a file, a folder or a sample, and says what it is.
    Open { input: String, options: Settings },
    /// The samples of a plane of the volume: across an axis (x, y, z), at an index.
    Plane { axis: usize, index: usize },
    /// Selects and weighs the points, and computes the shape to look at first.
    Shape { options: Settings },
    /// Computes the shapes at all other α, which the requests below need.
    Filtration,
    /// The simplices to draw at an α.
    At { alpha: f64 },
    /// Counts, measures and voids at an α.
    Measure { alpha: f64 },
    /// The facets around the voids at an α, as many voids as the page lists.
    Voids { alpha: f64, most: usize },
    /// Volume and area of the union of the balls of the input, their radii enlarged by that of a probe.
    Balls { probe: f64 },
    /// The cells at an α, cut open by a plane across an axis.
    Section { alpha: f64, axis: usize, place: f64 },
    /// Values of α at which something happens.
    Suggest,
    /// The persistence diagram.
    Diagram,
    /// The cycle of a pair of the diagram, by its dimension, 1 or 2, and the simplex that the diagram names.
    Cycle { dimension: usize, simplex: u32 },
    /// A file of the shape or of its points at an α, as the command writes it; its name says the format.
    Save { name: PathBuf, alpha: f64, solid: bool },
    /// The command and the configuration that make the same file.
    Command { name: String, alpha: f64, solid: bool },
}
