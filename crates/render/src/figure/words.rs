//! Text broken into lines.

use std::fmt::Write;

use super::svg::{escape, num};

/// The distance of lines, in letter sizes.
pub(super) const LEADING: f64 = 1.35;

/// Writes lines of text below a point; the colour is in SVG notation.
pub(super) fn write_lines(
    svg: &mut String,
    lines: &[String],
    [x, y]: [f64; 2],
    size: f64,
    colour: &str,
) {
    for (k, line) in lines.iter().enumerate() {
        let _ = writeln!(
            svg,
            r#"<text x="{}" y="{}" font-size="{}" fill="{colour}">{}</text>"#,
            num(x),
            num(y + (k as f64 * LEADING + 1.0) * size),
            num(size),
            escape(line)
        );
    }
}

/// Words in lines that fit a width; a word that is longer has a line of its own.
pub(super) fn wrap(text: &str, width: f64, size: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(line, size) + text_width(word, size) + 0.3 * size <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// The estimated width of a text, a little too large, as a viewer may have another font.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    let of = |c: char| match c {
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | ' ' | '(' | ')' | '·' => 0.3,
        'm' | 'w' | 'M' | 'W' | '—' => 0.88,
        'A'..='Z' => 0.68,
        _ => 0.57,
    };
    text.chars().map(of).sum::<f64>() * size
}
