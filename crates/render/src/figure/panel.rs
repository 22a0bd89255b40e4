use super::drawing::Drawing;
use crate::pixels::{ColourMap, Picture};

/// A part of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Above it, after its letter "(a)"; the letter is left out where there is one panel.
    pub title: String,
    /// What it shows.
    pub content: Content,
    /// Below it, wrapped to its width; a paragraph each.
    pub captions: Vec<String>,
}

/// What a panel shows.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// Pixels, fitted into the panel.
    Picture(Picture),
    /// Lines and words.
    Drawing(Drawing),
}

/// The values that the colours of a figure represent.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourBar {
    /// From values to colours.
    pub map: ColourMap,
    /// What is measured, with its unit.
    pub label: String,
}
