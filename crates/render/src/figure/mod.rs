//! Figures of panels, as in a paper.

mod drawing;
mod svg;
mod ticks;

use std::fmt::Write;

use crate::colour::{ColourMap, Rgb};
use crate::error::RenderError;
use crate::pixels::{Picture, Size};
use base64::prelude::{BASE64_STANDARD, Engine};
use drawing::Layout;
pub use drawing::{Drawing, Pen, Step};
use svg::{FAMILIES, LEADING, escape, num, rasterise, text_width, wrap, write_lines};
pub use ticks::Scale;
use ticks::ticks;

/// A figure as in a paper: panels in rows, each with a letter, a title and captions, under a common title, with the meaning of
/// the colours below. SVG and PNG are made from the same description.
///
/// Text in a PNG is set in Ubuntu Light, which has Greek and √ ² ₁ × − ≤ ≥ ∞; a line with a missing character (arrows, ∈, ⊆, ‖,
/// ₊) is set entirely in Hack.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Above all panels; empty for none.
    pub title: String,
    /// Panels in a row.
    pub columns: usize,
    /// The pixels of a panel, the same for all, so that equal cameras give equal scales.
    pub panel: Size,
    /// The panels in reading order.
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
    /// See [`Figure::to_png`].
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
        // Axes of panels that are beside or below each other are in line.
        let layouts = self.panels.iter().map(|panel| panel.layout(size, small));
        let mut layouts: Vec<Option<Layout>> = layouts.collect();
        let sides = layouts.iter().flatten().fold([0.0; 2], |[left, right], layout| {
            [layout.sides[0].max(left), layout.sides[1].max(right)]
        });
        layouts.iter_mut().flatten().for_each(|layout| layout.sides = sides);
        let mut lowest = y + size[1];
        for (k, panel) in panels.iter().enumerate() {
            let corner = [lefts(k), y];
            match &panel.content {
                Content::Picture(picture) => write_picture(&mut svg, picture, corner, size)?,
                Content::Drawing(drawing) => {
                    let name = format!("panel{}", first + k);
                    drawing.write(&mut svg, corner, size, layouts[first + k].as_ref(), &name);
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
    let data = BASE64_STANDARD.encode(picture.to_png()?);
    let [x, y] = corner.map(num);
    let [w, h] = size.map(num);
    let _ = writeln!(
        svg,
        r#"<image x="{x}" y="{y}" width="{w}" height="{h}" href="data:image/png;base64,{data}"/>"#
    );
    Ok(())
}

/// A part of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The text above it, after its letter "(a)"; a single panel has no letter.
    pub title: String,
    /// The content of the panel.
    pub content: Content,
    /// The text below it, wrapped to its width, with a paragraph for each element.
    pub captions: Vec<String>,
}

impl Panel {
    /// The layout of a chart.
    fn layout(&self, size: [f64; 2], most_letters: f64) -> Option<Layout> {
        match &self.content {
            Content::Drawing(drawing) => drawing.layout(size, most_letters),
            Content::Picture(_) => None,
        }
    }
}

/// The content of a panel.
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
    /// The map from values to colours.
    pub map: ColourMap,
    /// The measured quantity, with its unit.
    pub label: String,
}

const INK: &str = "#111111";
const SOFT_INK: &str = "#333333";

/// The page of a figure, filled from top to bottom.
struct Page {
    pub svg: String,
    width: f64,
    pub margin: f64,
    pub gap: f64,
    /// The size of letters.
    pub letters: f64,
    /// The top of the free space.
    pub y: f64,
}

impl Page {
    fn new(panels: f64, columns: usize) -> Self {
        // Still readable at half size: 1600 pixels give letters of 27.
        let letters = panels / 58.0;
        let (margin, gap) = (letters, letters * 1.2);
        let width = panels + 2.0 * margin + (columns - 1) as f64 * gap;
        Self { svg: String::new(), width, margin, gap, letters, y: margin * 0.6 }
    }

    fn inner(&self) -> f64 {
        self.width - 2.0 * self.margin
    }

    fn paragraph(&mut self, text: &str, size: f64, colour: &str) {
        let lines = wrap(text, self.inner(), size);
        write_lines(&mut self.svg, &lines, [self.margin, self.y], size, colour);
        if !lines.is_empty() {
            self.y += (lines.len() as f64 * LEADING + 0.3) * size;
        }
    }

    fn colour_bar(&mut self, bar: &ColourBar) {
        let size = self.letters * 0.85;
        let width = self.inner() * 0.5;
        let (left, height) = ((self.width - width) / 2.0, size * 0.9);
        let y = self.y + size * LEADING;
        let (low, high) = bar.map.range();
        let middle = num(self.width / 2.0);
        let _ = writeln!(
            self.svg,
            r#"<text x="{middle}" y="{}" font-size="{}" fill="{INK}" text-anchor="middle">{}</text>"#,
            num(self.y + size),
            num(size),
            escape(&bar.label)
        );
        // Each strip extends under the next, so that no seam is visible.
        const STRIPS: usize = 128;
        let strip = width / STRIPS as f64;
        for k in 0..STRIPS {
            let value = low + (high - low) * (k as f64 + 0.5) / STRIPS as f64;
            let x = left + k as f64 * strip;
            let _ = writeln!(
                self.svg,
                r#"<rect x="{}" y="{}" width="{}" height="{}" fill="{}"/>"#,
                num(x),
                num(y),
                num((strip + 1.0).min(left + width - x)),
                num(height),
                bar.map.colour(value).hex()
            );
        }
        for (value, text) in ticks(low, high, 6) {
            let x = left + width * (value - low) / (high - low);
            let _ = writeln!(
                self.svg,
                r#"<path d="M{x} {}v{}" stroke="{INK}" stroke-width="{}"/><text x="{x}" y="{}" font-size="{}" fill="{INK}" text-anchor="middle">{text}</text>"#,
                num(y + height),
                num(size * 0.3),
                num(size * 0.07),
                num(y + height + size * 1.3),
                num(size * 0.9),
                x = num(x),
            );
        }
        self.y = y + height + size * 2.0;
    }

    fn legend(&mut self, entries: &[(String, Rgb)]) {
        let size = self.letters * 0.85;
        let advance = |text: &str| text_width(text, size) + size * 2.4;
        let mut rest = entries;
        while !rest.is_empty() {
            let mut width = 0.0;
            let fits = |(text, _): &&(String, Rgb)| {
                width += advance(text);
                width <= self.inner()
            };
            let count = rest.iter().take_while(fits).count().max(1);
            let (line, later) = rest.split_at(count);
            let width: f64 = line.iter().map(|(text, _)| advance(text)).sum();
            let mut x = ((self.width - width) / 2.0).max(self.margin);
            for (text, colour) in line {
                let _ = writeln!(
                    self.svg,
                    r#"<rect x="{}" y="{}" width="{s}" height="{s}" fill="{}"/><text x="{}" y="{}" font-size="{}" fill="{INK}">{}</text>"#,
                    num(x),
                    num(self.y + size * 0.2),
                    colour.hex(),
                    num(x + size * 1.2),
                    num(self.y + size),
                    num(size),
                    escape(text),
                    s = num(size * 0.85),
                );
                x += advance(text);
            }
            self.y += size * LEADING;
            rest = later;
        }
        if !entries.is_empty() {
            self.y += size * 0.5;
        }
    }

    fn finish(self) -> (String, [f64; 2]) {
        let size = [self.width.ceil(), (self.y + self.margin * 0.6).ceil()];
        let [w, h] = size.map(num);
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" \
             viewBox=\"0 0 {w} {h}\" font-family=\"{FAMILIES}\">\n\
             <rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            self.svg
        );
        (svg, size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::ColourMap;

    fn square() -> Drawing {
        let mut drawing = Drawing::plane([[0.0, 0.0], [4.0, 4.0]]);
        let corners = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]];
        drawing.polygon(&corners, Pen::area(Rgb([255, 0, 0]), 1.0));
        drawing
    }

    fn panel(title: &str, content: Content) -> Panel {
        Panel { title: title.into(), content, captions: vec!["b₀ = 1 & b₁ < 2".into()] }
    }

    fn figure(panels: Vec<Panel>) -> Figure {
        Figure {
            title: "A title".into(),
            columns: 2,
            panel: Size::new(400, 300).unwrap(),
            panels,
            colour_bar: Some(ColourBar {
                map: ColourMap::new(0.0, 255.0),
                label: "F (gray levels)".into(),
            }),
            legend: vec![("singular facets".into(), Rgb([0, 0, 255]))],
            notes: vec!["A note.".into()],
        }
    }

    #[test]
    fn png_and_svg_are_the_same_each_time_and_show_the_panels() {
        let red = Picture::new(Size::new(4, 3).unwrap(), vec![[255, 0, 0, 255]; 12]);
        let panels = vec![
            panel("first", Content::Picture(red)),
            panel("second", Content::Drawing(square())),
            panel("third", Content::Drawing(Drawing::chart([[0.0, 0.0], [1.0, 2.0]], "N", "RMSE"))),
        ];
        let figure = figure(panels);
        let svg = figure.to_svg().unwrap();
        for part in ["(a) first", "(b) second", "(c) third", "b₁ &lt; 2", "data:image/png;base64,"]
        {
            assert!(svg.contains(part), "{part} is missing");
        }
        assert_eq!(svg, figure.to_svg().unwrap());
        let picture = figure.to_picture().unwrap();
        assert_eq!(picture, figure.to_picture().unwrap());
        assert!(picture.size().width() >= Figure::MIN_WIDTH);
        let share = |colour: [u8; 4]| {
            let hits = picture.pixels().iter().filter(|&&p| p == colour).count() as f64;
            let scale = f64::from(picture.size().width()) / 842.0;
            hits / (scale * scale)
        };
        // The red picture fills a panel, the square (half as high as the panel) a part of another.
        let expected = 400.0 * 300.0 + 150.0 * 150.0;
        let got = share([255, 0, 0, 255]);
        assert!((got / expected - 1.0).abs() < 0.02, "{got} red pixels, not {expected}");
        assert!(share([0, 0, 255, 255]) > 30.0);
        assert_eq!(picture.pixel(0, 0), [255; 4]);
    }

    #[test]
    fn a_single_panel_has_no_letter_and_an_empty_figure_is_drawn() {
        let svg = figure(vec![panel("only", Content::Drawing(square()))]).to_svg().unwrap();
        assert!(svg.contains(">only<") && !svg.contains("(a)"));
        figure(Vec::new()).to_png().unwrap();
    }

    #[test]
    fn panels_beyond_any_picture_are_refused() {
        let mut wide = figure(vec![panel("w", Content::Drawing(square())); 3]);
        wide.columns = 3;
        wide.panel = Size::new(Size::MAX_SIDE, 8).unwrap();
        assert!(matches!(wide.to_png(), Err(RenderError::Size { .. })));
    }

    #[test]
    fn letters_go_on_after_z() {
        assert_eq!([0, 25, 26, 27, 51, 52].map(letter), ["a", "z", "aa", "ab", "az", "ba"]);
    }

    #[test]
    fn captions_wrap_at_words() {
        let lines = wrap("one two three four", 60.0, 10.0);
        assert_eq!(lines, ["one two", "three four"]);
        assert_eq!(wrap("incomprehensibilities", 10.0, 10.0).len(), 1);
        assert!(wrap("", 10.0, 10.0).is_empty());
    }
}
