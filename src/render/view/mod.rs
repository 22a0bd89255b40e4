//! A page to look at: a ladder of shapes in three dimensions, in any browser, without a network.

mod html;
mod pack;
mod plot;
mod subject;

use super::error::RenderError;
pub use subject::{Original, Subject};

/// A self-contained HTML page.
#[derive(Clone, Debug)]
pub struct Page {
    /// The file.
    pub html: String,
    /// What was simplified for display, if anything.
    pub simplified: Option<String>,
    /// How many levels it has.
    pub levels: usize,
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
    /// slider goes over the levels, and a click or touch shows index, F, ω and class of a point. The
    /// library plotly.js, which draws it, is inside.
    ///
    /// # Errors
    /// [`RenderError::Isosurface`] for an isovalue that is not a finite
    /// number.
    ///
    /// # Panics
    /// When there are no levels, or more than [`Page::MOST_LEVELS`].
    pub fn new(subject: &Subject<'_>) -> Result<Self, RenderError> {
        let levels = subject.levels.len();
        assert!((1..=Self::MOST_LEVELS).contains(&levels), "{levels} levels");
        let packed = pack::Packed::of(subject, Self::MOST_FACETS)?;
        let (html, levels) = (html::page(subject, &packed), subject.levels.len());
        Ok(Self { html, simplified: packed.simplified, levels })
    }
}
