//! Columns of points beside coordinates, weights and values: what a file states about each point, by name.

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::Serialize;
use walpha_base::keep;

use super::Points;

/// A column of numbers, one for each point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Column {
    /// The name, as the file has it.
    pub name: String,
    /// The numbers, in the order of the points; NaN where the file states that there is none.
    pub values: Vec<f64>,
}

/// The columns that a reader keeps beside coordinates, weights and values.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Attributes {
    /// None: they need no memory.
    #[default]
    None,
    /// Those with these names.
    Named(Vec<String>),
    /// Those with these names that are there.
    IfThere(Vec<String>),
    /// All that are numbers.
    All,
}

/// A description of a column: its name, type and range.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ColumnSummary {
    /// The name, as the file has it.
    #[serde(skip)]
    pub name: String,
    /// The type, such as `uint16`.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// The least number; `None` if there is none.
    pub min: Option<f64>,
    /// The greatest number; `None` if there is none.
    pub max: Option<f64>,
    /// How many points have no number.
    pub missing: u64,
}

/// A description of all points of a laser scan, chosen or not.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ScanSummary {
    /// The version of LAS, such as `1.4`.
    pub version: String,
    /// The number of the point format, 0 to 10.
    pub point_format: u8,
    /// Whether the points are compressed.
    pub compressed: bool,
    /// The numbers of points of each class, by its ASPRS code.
    pub classes: BTreeMap<u8, u64>,
    /// The numbers of points that are the first, second, … return of their pulse.
    pub returns: BTreeMap<u8, u64>,
    /// The numbers of points that are withheld, in an overlap of swaths, synthetic, or key points.
    pub flags: Flags,
    /// The first and the last time, in seconds; `None` if the points have none.
    pub time: Option<[f64; 2]>,
    /// What times are: seconds of the GPS week, or GPS seconds less 10⁹.
    pub time_of: &'static str,
}

/// The numbers of points with each flag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[allow(missing_docs, reason = "they are flags of LAS")]
pub struct Flags {
    pub withheld: u64,
    pub overlap: u64,
    pub synthetic: u64,
    pub key_point: u64,
}

/// The names of the ASPRS classes 0 to 18 (LAS 1.4 R15, table 17).
const CLASS_NAMES: [&str; 19] = [
    "never classified",
    "unclassified",
    "ground",
    "low vegetation",
    "medium vegetation",
    "high vegetation",
    "building",
    "low noise",
    "model key point",
    "water",
    "rail",
    "road surface",
    "overlap",
    "wire guard",
    "wire conductor",
    "transmission tower",
    "wire connector",
    "bridge deck",
    "high noise",
];

impl ScanSummary {
    /// The name of an ASPRS class: `ground` for 2.
    pub fn class_name(class: u8) -> &'static str {
        match class {
            0..19 => CLASS_NAMES[usize::from(class)],
            19..64 => "reserved",
            64.. => "user defined",
        }
    }
}

impl Column {
    /// A description of the column, whose file has it in numbers of this type.
    pub(crate) fn summary(&self, kind: &'static str) -> ColumnSummary {
        let mut summary = ColumnSummary::new(&self.name, kind);
        self.values.iter().for_each(|&value| summary.add(value));
        summary
    }
}

impl ColumnSummary {
    pub(crate) fn new(name: &str, kind: &'static str) -> Self {
        Self { name: name.to_owned(), kind, min: None, max: None, missing: 0 }
    }

    /// Takes a number into account, or its absence if it is NaN.
    pub(crate) fn add(&mut self, value: f64) {
        if value.is_nan() {
            self.missing += 1;
        } else {
            self.min = Some(self.min.map_or(value, |min| min.min(value)));
            self.max = Some(self.max.map_or(value, |max| max.max(value)));
        }
    }
}

/// Whether two names are of one column: equal but for letter case, or both of the class of LAS.
pub(crate) fn is_same(name: &str, other: &str) -> bool {
    const CLASS: [&str; 2] = ["class", "classification"];
    let is_class = |name: &str| CLASS.iter().any(|known| known.eq_ignore_ascii_case(name));
    name.eq_ignore_ascii_case(other) || is_class(name) && is_class(other)
}

impl Attributes {
    /// Whether a column with this name is kept.
    pub(crate) fn keeps(&self, name: &str) -> bool {
        match self {
            Self::None => false,
            Self::Named(names) | Self::IfThere(names) => {
                names.iter().any(|named| is_same(named, name))
            }
            Self::All => true,
        }
    }

    /// The names of the columns that must be there.
    pub(crate) fn names(&self) -> &[String] {
        match self {
            Self::Named(names) => names,
            Self::None | Self::IfThere(_) | Self::All => &[],
        }
    }

    /// These, and one more if there is one.
    pub(crate) fn and(&self, name: Option<&String>) -> Self {
        let Some(name) = name else { return self.clone() };
        match self {
            Self::All => Self::All,
            Self::None => Self::Named(vec![name.clone()]),
            Self::Named(names) => Self::Named([&names[..], std::slice::from_ref(name)].concat()),
            Self::IfThere(names) => {
                Self::IfThere([&names[..], std::slice::from_ref(name)].concat())
            }
        }
    }
}

impl Points {
    /// A column by its name, in any letter case: one that was [kept](Attributes), or x, y, z or height, weight or value.
    pub fn column(&self, name: &str) -> Option<Cow<'_, [f64]>> {
        let exact = self.columns.iter().find(|column| column.name == name);
        let column =
            exact.or_else(|| self.columns.iter().find(|column| is_same(&column.name, name)));
        if let Some(column) = column {
            return Some(Cow::Borrowed(&column.values));
        }
        let axis = |axis: usize| {
            Some(Cow::Owned(self.positions.iter().map(|place| place[axis]).collect()))
        };
        match name.to_ascii_lowercase().as_str() {
            "x" => axis(0),
            "y" => axis(1),
            "z" | "height" => axis(2),
            "weight" => self.weights.as_deref().map(Cow::Borrowed),
            "value" => self.values.as_deref().map(Cow::Borrowed),
            _ => None,
        }
    }
}

/// Keeps the marked numbers of columns.
pub(crate) fn keep_rows(columns: &mut [Column], kept: &[bool]) {
    columns.iter_mut().for_each(|column| keep(&mut column.values, kept));
}
