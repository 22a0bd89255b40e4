//! A page to look at: a ladder of shapes in three dimensions, in any browser, without a network.

mod html;
mod pack;
mod plot;

use crate::ladder::{Ladder, Levels};
use crate::points::Units;
use crate::volume::Volume;

/// What a page shows.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// Its heading.
    pub title: &'a str,
    /// What else is to be told, as pairs of a name and a value.
    pub facts: &'a [(String, String)],
    /// What coordinates are measured in, as "voxels".
    pub unit: &'a str,
    /// What F is, with its unit, as "value of the original volume, in gray levels".
    pub value: &'a str,
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

/// A self-contained HTML page.
#[derive(Clone, Debug)]
pub struct Page {
    /// The file.
    pub html: String,
    /// What was simplified for display, if anything.
    pub simplified: Option<String>,
}

impl Page {
    /// More facets than this are drawn simplified: what a phone turns without stutter, and a few
    /// megabytes.
    pub const MOST_FACETS: usize = 300_000;
    /// More levels than this make no page: levels are counted in bytes.
    pub const MOST_LEVELS: usize = 250;

    /// Makes the page. The same subject gives the same bytes.
    ///
    /// The boundary and what is singular are traces of their own, points are sized by weight, a
    /// slider goes over the levels, and a click or touch tells index, F, ω and class of a point. The
    /// library plotly.js, which draws it, is inside.
    ///
    /// # Errors
    /// [`RenderError::Isosurface`](super::RenderError::Isosurface) for an isovalue that is no finite
    /// number.
    ///
    /// # Panics
    /// When there are no levels, or more than [`Page::MOST_LEVELS`].
    pub fn new(subject: &Subject<'_>) -> Result<Self, super::RenderError> {
        let levels = subject.levels.len();
        assert!((1..=Self::MOST_LEVELS).contains(&levels), "{levels} levels");
        let packed = pack::Packed::of(subject, Self::MOST_FACETS)?;
        Ok(Self { html: html::page(subject, &packed), simplified: packed.simplified })
    }
}
