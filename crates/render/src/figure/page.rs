use std::fmt::Write;

use super::panel::ColourBar;
use super::svg::{FAMILIES, escape, num};
use super::ticks::ticks;
use super::words::{LEADING, text_width, wrap, write_lines};
use crate::pixels::Rgb;

pub(super) const INK: &str = "#111111";
pub(super) const SOFT_INK: &str = "#333333";

/// A page that is filled from top to bottom.
pub(super) struct Page {
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
    pub(super) fn new(panels: f64, columns: usize) -> Self {
        // Still readable at half size: 1600 pixels give letters of 27.
        let letters = panels / 58.0;
        let (margin, gap) = (letters, letters * 1.2);
        let width = panels + 2.0 * margin + (columns - 1) as f64 * gap;
        Self { svg: String::new(), width, margin, gap, letters, y: margin * 0.6 }
    }

    fn inner(&self) -> f64 {
        self.width - 2.0 * self.margin
    }

    pub(super) fn paragraph(&mut self, text: &str, size: f64, colour: &str) {
        let lines = wrap(text, self.inner(), size);
        write_lines(&mut self.svg, &lines, [self.margin, self.y], size, colour);
        if !lines.is_empty() {
            self.y += (lines.len() as f64 * LEADING + 0.3) * size;
        }
    }

    pub(super) fn colour_bar(&mut self, bar: &ColourBar) {
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

    pub(super) fn legend(&mut self, entries: &[(String, Rgb)]) {
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

    pub(super) fn finish(self) -> (String, [f64; 2]) {
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
