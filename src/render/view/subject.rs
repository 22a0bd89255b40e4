use crate::ladder::{Ladder, Levels};
use crate::points::Units;
use crate::volume::Volume;

/// What a page shows.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// Its heading.
    pub title: &'a str,
    /// Further facts, as pairs of a name and a value.
    pub facts: &'a [(String, String)],
    /// What coordinates are measured in, as "voxels".
    pub unit: &'a str,
    /// What F is, with its unit, as "value of the original volume, in gray levels".
    pub value: &'a str,
    /// How far F is from the original around each point, and in what; where that is known.
    pub differences: Option<(&'a [f64], &'a str)>,
    /// The shapes.
    pub levels: &'a Levels<'a>,
    /// Their numbers.
    pub ladder: &'a Ladder,
    /// The level shown first.
    pub first: usize,
    /// What the points come from, to compare.
    pub original: Option<Original<'a>>,
}

/// A volume that is shown by its isosurface, from every so many samples if it is large.
#[derive(Clone, Copy)]
pub struct Original<'a> {
    /// The samples.
    pub volume: &'a Volume,
    /// Where the surface is.
    pub isovalue: f64,
    /// What the coordinates of the points are measured in.
    pub units: Units,
}
