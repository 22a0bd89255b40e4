//! Names of files, and numbers, in messages.

use std::path::Path;

/// A path for messages: control characters, which could move a terminal's cursor or change its
/// colours, are escaped.
pub fn shown(path: &Path) -> String {
    escaped(&path.to_string_lossy(), |_| false)
}

/// A number for messages: as it is, or with an exponent where it would begin or end in many
/// zeros.
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

/// A text with its control characters escaped, except those for which `kept` holds.
pub fn escaped(text: &str, kept: impl Fn(char) -> bool) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_control() && !kept(c) {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    shown
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
    fn one_thing_is_no_things() {
        assert_eq!([0, 1, 2].map(|n| counted(n, "void")), ["0 voids", "1 void", "2 voids"]);
    }

    #[test]
    fn nothing_reaches_the_terminal_but_text() {
        assert_eq!(shown(Path::new("häd\x1b[2J\n.nrrd")), "häd\\u{1b}[2J\\n.nrrd");
        assert_eq!(escaped("a\nb\u{9b}c", |c| c == '\n'), "a\nb\\u{9b}c");
    }
}
