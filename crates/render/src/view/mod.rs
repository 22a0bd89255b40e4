//! An interactive page: a ladder of shapes in three dimensions, in any browser, without a network.

mod html;
mod pack;
mod plot;
mod subject;

use crate::error::RenderError;
pub use subject::{Detail, Differences, Original, Subject};

/// A self-contained HTML page.
#[derive(Clone, Debug)]
pub struct Page {
    /// The file.
    pub html: String,
    /// What was simplified for display, if anything.
    pub simplified: Option<String>,
}

impl Page {
    /// More facets than this are drawn simplified: this many a phone rotates smoothly, and they take a few
    /// megabytes.
    pub const MOST_FACETS: usize = 300_000;
    /// The most levels of a page, as levels are stored in bytes.
    pub const MOST_LEVELS: usize = 250;

    /// Makes the page. The same subject gives the same bytes.
    ///
    /// The boundary and what is singular are traces of their own, points are sized by weight, a
    /// slider goes over α, a list over levels of detail, and a click or touch shows index, F, ω and
    /// class of a point. The library plotly.js, which draws it, is included.
    ///
    /// # Errors
    /// [`RenderError::Isosurface`] for an isovalue that is not a finite
    /// number.
    ///
    /// # Panics
    /// When there are no levels of detail, or one with no α or more than [`Page::MOST_LEVELS`].
    pub fn new(subject: &Subject<'_>) -> Result<Self, RenderError> {
        assert!(!subject.details.is_empty(), "nothing to show");
        let surface = subject.original.as_ref().map(pack::surface).transpose()?;
        let pack = |detail: &Detail<'_>| {
            let levels = detail.levels.len();
            assert!((1..=Self::MOST_LEVELS).contains(&levels), "{levels} levels");
            pack::Packed::of(detail, Self::MOST_FACETS)
        };
        let packed: Vec<_> = subject.details.iter().map(pack).collect();
        let html = html::page(subject, &packed, surface.as_ref());
        Ok(Self { html, simplified: simplified(subject, &packed) })
    }
}

/// What was simplified at each level of detail.
fn simplified(subject: &Subject<'_>, packed: &[pack::Packed]) -> Option<String> {
    let of = |(detail, packed): (&Detail<'_>, &pack::Packed)| {
        let points = detail.levels.points().len();
        Some(format!("{points} points are {}", packed.simplified.as_ref()?))
    };
    let texts: Vec<String> = subject.details.iter().zip(packed).filter_map(of).collect();
    (!texts.is_empty()).then(|| texts.join("; "))
}
