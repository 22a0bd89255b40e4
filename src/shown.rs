//! Names of files as messages show them.

use std::path::Path;

/// A path for people to read: control characters, which could move a terminal's cursor or change its
/// colours, are escaped.
pub fn shown(path: &Path) -> String {
    escaped(&path.to_string_lossy(), |_| false)
}

/// A text with its control characters escaped, but for those `kept`.
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
    fn nothing_reaches_the_terminal_but_text() {
        assert_eq!(shown(Path::new("häd\x1b[2J\n.nrrd")), "häd\\u{1b}[2J\\n.nrrd");
        assert_eq!(escaped("a\nb\u{9b}c", |c| c == '\n'), "a\nb\\u{9b}c");
    }
}
