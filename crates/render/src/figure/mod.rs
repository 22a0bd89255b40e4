//! Figures of panels, as in a paper.

mod drawing;
mod ink;
mod page;
mod panel;
mod svg;
mod ticks;
mod words;

use std::fmt::Write;

use crate::base64::base64;
use crate::error::RenderError;
use crate::pixels::{Picture, Rgb, Size};
pub use drawing::{Drawing, Pen, Step};
use page::{INK, Page, SOFT_INK};
pub use panel::{ColourBar, Content, Panel};
use svg::{num, rasterise};
use words::{LEADING, wrap, write_lines};

/// A figure as in a paper: panels in rows, each with its letter, title and caption, under a
/// common title, with the meaning of the colours below. One description gives the SVG and the PNG.
///
/// Text in a PNG is set in Ubuntu Light, which has Greek and √ ² ₁ × − ≤ ≥ ∞; a line with a character
/// that it lacks (arrows, ∈, ⊆, ‖, ₊) is set in Hack as a whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Above all panels; empty for none.
    pub title: String,
    /// Panels in a row.
    pub columns: usize,
    /// The pixels of a panel, the same for all, so that equal cameras give equal scales.
    pub panel: Size,
    /// In reading order.
    pub panels: Vec<Panel>,
    /// The values that colours represent.
    pub colour_bar: Option<ColourBar>,
    /// The classes that colours represent.
    pub legend: Vec<(String, Rgb)>,
    /// Below everything, wrapped to the width; a paragraph each.
    pub notes: Vec<String>,
}

impl Figure {
    /// PNG files are at least this wide; a narrower figure is enlarged.
    pub const MIN_WIDTH: u32 = 1600;

    /// The figure as a self-contained SVG file: pictures inside as PNG, text as text.
    ///
    /// # Errors
    /// [`RenderError::Png`] when a picture cannot be encoded.
    pub fn to_svg(&self) -> Result<String, RenderError> {
        Ok(self.compose()?.0)
    }

    /// The figure as a PNG file, set in fonts that come with the library: the same everywhere.
    ///
    /// # Errors
    /// [`RenderError::Size`] when the figure has more pixels than a picture may have.
    pub fn to_png(&self) -> Result<Vec<u8>, RenderError> {
        self.to_picture()?.to_png()
    }

    /// The figure as pixels.
    ///
    /// # Errors
    /// As [`Figure::to_png`].
    pub fn to_picture(&self) -> Result<Picture, RenderError> {
        let (svg, [width, height]) = self.compose()?;
        let scale = (f64::from(Self::MIN_WIDTH) / width).max(1.0);
        let size = Size::new((width * scale).ceil() as u32, (height * scale).ceil() as u32)?;
        rasterise(&svg, size)
    }

    /// The file, and its width and height.
    fn compose(&self) -> Result<(String, [f64; 2]), RenderError> {
        let columns = self.columns.clamp(1, self.panels.len().max(1));
        let panel = [f64::from(self.panel.width()), f64::from(self.panel.height())];
        let mut page = Page::new(panel[0] * columns as f64, columns);
        page.paragraph(&self.title, page.letters * 1.25, INK);
        for (row, panels) in self.panels.chunks(columns).enumerate() {
            self.row(&mut page, panels, row * columns, panel)?;
        }
        if let Some(bar) = &self.colour_bar {
            page.colour_bar(bar);
        }
        page.legend(&self.legend);
        for note in &self.notes {
            page.paragraph(note, page.letters * 0.85, SOFT_INK);
        }
        Ok(page.finish())
    }

    fn row(
        &self,
        page: &mut Page,
        panels: &[Panel],
        first: usize,
        size: [f64; 2],
    ) -> Result<(), RenderError> {
        let letters = page.letters;
        let lefts = |k: usize| page.margin + k as f64 * (size[0] + page.gap);
        let heads: Vec<String> = (first..)
            .zip(panels)
            .map(|(k, panel)| match (self.panels.len(), panel.title.as_str()) {
                (1, title) => title.to_owned(),
                (_, title) => format!("({}) {title}", letter(k)),
            })
            .collect();
        let mut svg = String::new();
        let y = page.y;
        let heads: Vec<_> = heads.iter().map(|h| wrap(h, size[0], letters)).collect();
        let lines = heads.iter().map(Vec::len).max().unwrap_or(0) as f64;
        for (k, head) in heads.iter().enumerate() {
            write_lines(&mut svg, head, [lefts(k), y], letters, INK);
        }
        let y = y + (lines * LEADING + 0.2) * letters;
        let small = letters * 0.85;
        let mut lowest = y + size[1];
        for (k, panel) in panels.iter().enumerate() {
            let corner = [lefts(k), y];
            match &panel.content {
                Content::Picture(picture) => write_picture(&mut svg, picture, corner, size)?,
                Content::Drawing(drawing) => {
                    drawing.write(&mut svg, corner, size, &format!("panel{}", first + k));
                }
            }
            let mut y = y + size[1] + small * 0.3;
            for caption in &panel.captions {
                let lines = wrap(caption, size[0], small);
                write_lines(&mut svg, &lines, [lefts(k), y], small, SOFT_INK);
                y += lines.len() as f64 * LEADING * small;
            }
            lowest = lowest.max(y);
        }
        page.svg.push_str(&svg);
        page.y = lowest + letters * 0.8;
        Ok(())
    }
}

/// a, b, … z, aa, ab, …
fn letter(index: usize) -> String {
    let last = (b'a' + (index % 26) as u8) as char;
    if index < 26 { last.to_string() } else { letter(index / 26 - 1) + &last.to_string() }
}

fn write_picture(
    svg: &mut String,
    picture: &Picture,
    corner: [f64; 2],
    size: [f64; 2],
) -> Result<(), RenderError> {
    let data = base64(&picture.to_png()?);
    let [x, y] = corner.map(num);
    let [w, h] = size.map(num);
    let _ = writeln!(
        svg,
        r#"<image x="{x}" y="{y}" width="{w}" height="{h}" href="data:image/png;base64,{data}"/>"#
    );
    Ok(())
}

#[cfg(test)]
mod tests;
