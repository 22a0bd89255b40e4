//! The building blocks of SVG, text in lines, and rasterisation.

use std::fmt::Write;
use std::sync::{Arc, LazyLock};

use resvg::{tiny_skia, usvg};

use crate::error::RenderError;
use crate::pixels::{Picture, Size};

/// The font families for viewers, starting with that of PNG files.
pub(super) const FAMILIES: &str =
    "Ubuntu, 'Noto Sans', 'DejaVu Sans', 'Helvetica Neue', Arial, sans-serif";

/// A number to a thousandth of a pixel, without trailing zeros; 0 for NaN.
pub(super) fn num(value: f64) -> String {
    if !value.is_finite() {
        return "0".into();
    }
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

/// Text with the special characters of XML replaced.
pub(super) fn escape(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '&' => "&amp;".into(),
            '<' => "&lt;".into(),
            '>' => "&gt;".into(),
            '"' => "&quot;".into(),
            // XML 1.0 has no control characters, not even escaped.
            c if c.is_control() => " ".into(),
            c => c.to_string(),
        })
        .collect()
}

/// The fonts that come with the library, and no others: Ubuntu Light, and Hack for missing characters.
static FONTS: LazyLock<Arc<usvg::fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    fonts.load_font_data(epaint_default_fonts::HACK_REGULAR.to_vec());
    Arc::new(fonts)
});

/// An SVG file as pixels.
pub(super) fn rasterise(svg: &str, size: Size) -> Result<Picture, RenderError> {
    let options = usvg::Options { fontdb: FONTS.clone(), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options)?;
    let (width, height) = (size.width(), size.height());
    let mut pixmap =
        tiny_skia::Pixmap::new(width, height).ok_or(RenderError::Size { width, height })?;
    let (sx, sy) = (width as f32 / tree.size().width(), height as f32 / tree.size().height());
    resvg::render(&tree, tiny_skia::Transform::from_scale(sx, sy), &mut pixmap.as_mut());
    let pixels = pixmap
        .pixels()
        .iter()
        .map(|p| {
            let p = p.demultiply();
            [p.red(), p.green(), p.blue(), p.alpha()]
        })
        .collect();
    Ok(Picture::new(size, pixels))
}

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

/// Breaks a text into lines that fit a width; a longer word gets a separate line.
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

/// The estimated width of a text, a little too large, because viewers may use another font.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    let of = |c: char| match c {
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | ' ' | '(' | ')' | '·' => 0.3,
        'm' | 'w' | 'M' | 'W' | '—' => 0.88,
        'A'..='Z' => 0.68,
        _ => 0.57,
    };
    text.chars().map(of).sum::<f64>() * size
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let pairs =
            [(1.0, "1"), (-0.0001, "0"), (2.5, "2.5"), (1.0 / 3.0, "0.333"), (100.0, "100")];
        for (value, text) in pairs {
            assert_eq!(num(value), text);
        }
        assert_eq!(num(f64::NAN), "0");
    }

    #[test]
    fn letters_symbols_and_greek_leave_ink() {
        let ink = |text: &str| {
            let svg = format!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="40" height="40"><text x="4" y="30" font-size="30" font-family="{FAMILIES}">{text}</text></svg>"#
            );
            let picture = rasterise(&svg, Size::new(40, 40).unwrap()).unwrap();
            picture.pixels().iter().map(|p| u32::from(p[3])).sum::<u32>()
        };
        assert_eq!(ink(" "), 0);
        // A character that is in no font would be left out, or be the same box as any other.
        let signs = ["a", "α", "ω", "√", "²", "³", "×", "−", "≥", "ρ", "→", "·", "…", "∞", "β"];
        for sign in signs {
            assert!(ink(sign) > 500, "{sign} is missing");
        }
        assert_ne!(ink("α"), ink("ω"));
    }
}
