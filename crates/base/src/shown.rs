//! File names and numbers in messages.

use std::path::Path;

/// A path for messages. Invisible characters are escaped, such as those that could move a terminal's cursor, change its colours,
/// or show letters in another order.
pub fn shown(path: &Path) -> String {
    escaped(&path.to_string_lossy(), |_| false)
}

/// A number for messages. It gets an exponent where it would begin or end with many zeros.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && size.is_finite() && !(1e-4..1e15).contains(&size) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

/// A number of things: "1 void", "2 voids".
pub fn counted(number: u64, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// A number rounded to six significant digits.
pub fn six_digits(number: f64) -> f64 {
    format!("{number:.5e}").parse().unwrap_or(number)
}

/// A number as text with at most six significant digits, as in reports.
pub fn rounded(value: f64) -> String {
    number(six_digits(value))
}

/// A coordinate as text, as precise as six digits of an extent of this size: two ends of a box that are far from the origin stay
/// apart.
pub fn rounded_within(value: f64, extent: f64) -> String {
    if extent <= 0.0 || !extent.is_finite() {
        return rounded(value);
    }
    let decimals = (5.0 - extent.log10().floor()).clamp(0.0, 17.0) as usize;
    // Not "-0".
    number(format!("{value:.decimals$}").parse().unwrap_or(value) + 0.0)
}

/// A measure for people: four significant digits, and thousands apart, as in "1 776" and "709.2".
pub fn brief(value: f64) -> String {
    let text = number(format!("{value:.3e}").parse().unwrap_or(value));
    if text.contains(['e', 'n']) {
        return text;
    }
    let (sign, digits) = text.strip_prefix('-').map_or(("", &*text), |digits| ("-", digits));
    let (whole, fraction) = digits.split_once('.').map_or((digits, ""), |(w, f)| (w, f));
    let point = if fraction.is_empty() { "" } else { "." };
    format!("{sign}{}{point}{fraction}", in_groups(whole))
}

/// A count with its thousands apart: "51 410".
pub fn grouped(count: u64) -> String {
    in_groups(&count.to_string())
}

/// Digits in groups of three from the right.
fn in_groups(digits: &str) -> String {
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// Escapes the [unseen](is_unseen) characters of a text, except those for which `kept` holds.
pub fn escaped(text: &str, kept: impl Fn(char) -> bool) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if is_unseen(c) && !kept(c) {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    shown
}

/// Whether a character is invisible itself but may change how others are shown. These are Unicode's control characters (Cc), line
/// and paragraph separators (Zl, Zp), and format characters (Cf), which include marks of direction and characters without width;
/// and variation selectors and fillers, which are also invisible (Unicode 16, `DerivedGeneralCategory.txt` and
/// `Default_Ignorable_Code_Point`).
pub fn is_unseen(c: char) -> bool {
    c.is_control()
        || matches!(
            u32::from(c),
            0xad | 0x34f
                | 0x600..=0x605
                | 0x61c
                | 0x6dd
                | 0x70f
                | 0x890..=0x891
                | 0x8e2
                | 0x115f..=0x1160
                | 0x17b4..=0x17b5
                | 0x180b..=0x180f
                | 0x200b..=0x200f
                | 0x2028..=0x202e
                | 0x2060..=0x206f
                | 0x3164
                | 0xfe00..=0xfe0f
                | 0xfeff
                | 0xffa0
                | 0xfff0..=0xfffb
                | 0x110bd
                | 0x110cd
                | 0x13430..=0x1343f
                | 0x1bca0..=0x1bca3
                | 0x1d173..=0x1d17a
                | 0xe0000..=0xe0fff
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_not_made_of_zeros() {
        let texts =
            [0.0, -2.5, 0.000_000_000_000_217_145_52, 1e-4, 3e300, f64::INFINITY].map(number);
        assert_eq!(texts, ["0", "-2.5", "2.1714552e-13", "0.0001", "3e300", "inf"]);
    }

    #[test]
    fn numbers_are_short_for_people() {
        let measures = [709_169.34, 1776.17, 8.204_46, 0.000_123_46, -43.866_357, 0.0, 1e20];
        let texts = measures.map(brief);
        assert_eq!(texts, ["709 200", "1 776", "8.204", "0.0001235", "-43.87", "0", "1e20"]);
        assert_eq!([f64::INFINITY, f64::NAN].map(brief), ["inf", "NaN"]);
        assert_eq!([0, 999, 1000, 1_234_567].map(grouped), ["0", "999", "1 000", "1 234 567"]);
        assert_eq!([-76.859_999_999_999_99, 8_123_456.0].map(rounded), ["-76.86", "8123460"]);
        // A box of 100 m by UTM coordinates, which six digits would make flat.
        let ends = [5_400_000.0, 5_400_123.456_789].map(|end| rounded_within(end, 123.456_789));
        assert_eq!(ends, ["5400000", "5400123.457"]);
        assert_eq!([-3e-16, 5.7e-14].map(|value| rounded_within(value, 9.0)), ["0", "0"]);
        assert_eq!([2.5, 1e9].map(|value| rounded_within(value, 0.0)), ["2.5", "1000000000"]);
    }

    #[test]
    fn a_single_item_has_no_plural() {
        assert_eq!([0, 1, 2].map(|n| counted(n, "void")), ["0 voids", "1 void", "2 voids"]);
    }

    #[test]
    fn nothing_reaches_the_terminal_but_text() {
        assert_eq!(shown(Path::new("häd\x1b[2J\n.nrrd")), "häd\\u{1b}[2J\\n.nrrd");
        assert_eq!(escaped("a\nb\u{9b}c", |c| c == '\n'), "a\nb\\u{9b}c");
        // A program whose name looks like that of a picture, and names that look equal.
        let hidden = "a\u{202e}gpj.exe b\u{200b} c\u{2066} \u{feff}d e\u{e0041} f\u{2028}";
        let seen = "a\\u{202e}gpj.exe b\\u{200b} c\\u{2066} \\u{feff}d e\\u{e0041} f\\u{2028}";
        assert_eq!(shown(Path::new(hidden)), seen);
        let words = "Schädel, 頭蓋骨, جمجمة, 🦴, e\u{301}";
        assert_eq!(shown(Path::new(words)), words);
    }
}
