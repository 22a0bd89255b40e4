use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{ItemName, Origin, Subject};
use crate::haar::Truncation;
use crate::points::WeightSummary;
use crate::shape::{Alpha, AlphaShape, Balls, Betti, ByClass, Void};

/// All results, as in `report.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Incremented when a field is removed or changes its meaning; new fields may be added at any time.
    pub schema_version: u32,
    /// Title of the paper.
    pub paper: &'static str,
    /// A note on the paper's origin, as far as it is known.
    pub source: &'static str,
    /// The version of this program.
    pub version: &'static str,
    /// The day on which the report was made.
    pub date: String,
    /// The volume on which the paper is reproduced.
    pub input: Input,
    /// The command line that makes all items.
    pub command: String,
    /// Whether `items` contains all items.
    pub complete: bool,
    /// Table and figures, in the paper's order: all, or those requested.
    pub items: Vec<Item>,
    /// Number of claims with each verdict.
    pub verdicts: BTreeMap<Verdict, usize>,
    /// The seconds of each stage and in all, which are the only difference between two runs.
    pub seconds: BTreeMap<&'static str, f64>,
}

/// The volume and the first stages.
#[derive(Clone, Debug, Serialize)]
pub struct Input {
    /// A sample's name, or a file.
    pub name: String,
    /// Samples along x, y and z.
    pub dims: [usize; 3],
    /// Samples in all.
    pub samples: usize,
    /// The origin of the volume, and whether it can be the paper's volume.
    pub origin: Origin,
    /// The values that became gray 0 and 255.
    pub gray_range: [f64; 2],
    /// The truncation.
    pub haar: Truncation,
    /// Points selected.
    pub points: usize,
    /// Points over samples, in percent.
    pub percent: f64,
}

/// The table or a figure.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Item {
    /// `table-1`, `figure-01`, …
    pub id: &'static str,
    /// The name of the item, and what it shows.
    pub title: String,
    /// The content or claim of the paper, in its words as far as possible.
    pub paper: String,
    /// The content of our item.
    pub ours: String,
    /// The picture, a PNG file beside the report.
    pub picture: Option<String>,
    /// Other files that belong to it.
    pub files: Vec<String>,
    /// The command line that makes only this item, with the same files.
    pub command: String,
    /// The command lines that make its parts without this module: meshes among its files, shapes, points.
    pub commands: Vec<String>,
    /// Shapes measured for it.
    pub shapes: Vec<ShapeNumbers>,
    /// Single numbers.
    pub facts: Vec<Fact>,
    /// Numbers in rows.
    pub tables: Vec<Table>,
    /// Claims and their verdicts.
    pub findings: Vec<Finding>,
}

/// A number with its name.
#[derive(Clone, Debug, Serialize)]
pub struct Fact {
    /// The quantity, with its unit.
    pub label: String,
    /// The number.
    pub value: f64,
}

/// Rows of text and numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// Its caption.
    pub caption: String,
    /// Names of the columns.
    pub head: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<String>>,
}

/// A claim of the paper, judged.
#[derive(Clone, Debug, Serialize)]
pub struct Finding {
    /// The claim of the paper.
    pub claim: String,
    /// Whether our numbers confirm the claim.
    pub verdict: Verdict,
    /// The numbers that decide.
    pub reason: String,
}

/// Whether a claim holds for our numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Verdict {
    /// The claim holds.
    #[serde(rename = "reproduced")]
    Reproduced,
    /// The claim does not hold.
    #[serde(rename = "not reproduced")]
    NotReproduced,
    /// The paper does not give enough information to decide.
    #[serde(rename = "cannot be decided")]
    Undecided,
}

impl Verdict {
    /// All verdicts.
    pub const ALL: [Self; 3] = [Self::Reproduced, Self::NotReproduced, Self::Undecided];

    /// The verdict in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::NotReproduced => "not reproduced",
            Self::Undecided => "cannot be decided",
        }
    }

    /// `Reproduced` if the claim holds, else `NotReproduced`.
    pub(super) fn of(holds: bool) -> Self {
        if holds { Self::Reproduced } else { Self::NotReproduced }
    }
}

impl Fact {
    /// A number with its name.
    pub(super) fn new(label: impl Into<String>, value: f64) -> Self {
        Self { label: label.into(), value }
    }

    /// A count with its name.
    pub(super) fn count(label: impl Into<String>, value: usize) -> Self {
        Self::new(label, value as f64)
    }
}

impl Report {
    pub(super) fn new(
        input: Input,
        subject: &Subject<'_>,
        items: Vec<Item>,
        seconds: Vec<(&'static str, f64)>,
    ) -> Self {
        let findings = || items.iter().flat_map(|item| &item.findings);
        let count = |verdict| findings().filter(|finding| finding.verdict == verdict).count();
        Self {
            schema_version: 1,
            paper: "Volume Modeling of Scattered Data based on Weighted Alpha Shapes",
            source: "in English, with a Korean abstract; the copy followed here names neither \
                     authors nor a journal, and its latest reference is of 2004",
            version: env!("CARGO_PKG_VERSION"),
            date: subject.date.into(),
            command: subject.command(None),
            complete: items.len() == ItemName::all().count(),
            verdicts: Verdict::ALL.map(|verdict| (verdict, count(verdict))).into(),
            input,
            items,
            seconds: seconds.into_iter().collect(),
        }
    }
}

/// Numbers measured of a shape.
#[derive(Clone, Debug, Serialize)]
pub struct ShapeNumbers {
    /// Its weights and α, in short.
    pub label: String,
    /// The command line that computes it.
    pub command: String,
    /// α, a squared length; the string "inf" where it is infinite.
    pub alpha: Alpha,
    /// The meaning of α + ω.
    pub balls: Balls,
    /// The range of the weights ω, squared lengths.
    pub weights: WeightSummary,
    /// Points given.
    pub points: usize,
    /// Points dropped because another is at the same position.
    pub duplicates: usize,
    /// Points that are not vertices of the regular triangulation.
    pub hidden: usize,
    /// Points that are vertices of the shape.
    pub points_in_shape: usize,
    /// Cells of the shape.
    pub cells: usize,
    /// Its facets.
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub facets: ByClass<usize>,
    /// Its edges.
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub edges: ByClass<usize>,
    /// Its vertices.
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub vertices: ByClass<usize>,
    /// Components, tunnels, voids.
    pub betti: Betti,
    /// The volume of all voids, in cubed voxels.
    pub void_volume: f64,
    /// The voids, largest first, at most [`ShapeNumbers::VOIDS`] of them.
    pub largest_voids: Vec<Void>,
    /// Volume, in cubed voxels.
    pub volume: f64,
    /// Area of the surface, in squared voxels: of regular and singular facets.
    pub area: f64,
    /// Area of the regular facets.
    pub regular_area: f64,
    /// Area of the singular facets.
    pub singular_area: f64,
}

impl ShapeNumbers {
    /// The most voids that are listed.
    pub const VOIDS: usize = 10;

    /// Measures a shape that was made with its exterior simplices.
    pub(super) fn of(shape: &AlphaShape, label: String, command: String) -> Self {
        let voids = shape.voids().expect("made with exterior simplices");
        let complex = shape.complex();
        Self {
            label,
            command,
            alpha: shape.options().alpha,
            balls: shape.options().balls,
            weights: shape.points().summary(),
            points: shape.points().len(),
            duplicates: shape.duplicates().len(),
            hidden: shape.hidden().expect("the whole triangulation").len(),
            points_in_shape: shape.points_in_shape(),
            cells: complex.cells.counts().interior,
            facets: complex.facets.counts(),
            edges: complex.edges.counts(),
            vertices: complex.vertices.counts(),
            betti: shape.betti().expect("the whole triangulation"),
            void_volume: voids.iter().fold(0.0, |sum, void| sum + void.volume),
            largest_voids: voids.into_iter().take(Self::VOIDS).collect(),
            volume: shape.measures().volume,
            area: shape.measures().area,
            regular_area: shape.measures().regular_area,
            singular_area: shape.measures().singular_area,
        }
    }

    /// The number of tunnels and voids together, both of which may be called holes.
    pub(super) fn holes(&self) -> u64 {
        self.betti.b1 + self.betti.b2
    }
}

/// A file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Its name, without a folder.
    pub name: String,
    /// Its content.
    pub bytes: Vec<u8>,
}
