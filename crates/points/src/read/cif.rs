//! The syntax of CIF 1.1 (Hall, Allen & Brown 1991, doi:10.1107/S010876739101067X; International Tables G, 2.2.7): tags with a
//! value each, and loops of tags with rows of values.

use std::path::Path;

use super::{PointsError, format};
use walpha_volume::Reason;

/// A word of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'a> {
    /// `data_NAME`.
    Block,
    /// `save_NAME` or `save_`, as in dictionaries.
    Frame,
    /// `loop_`.
    Loop,
    /// A tag with its underscore.
    Tag(&'a str),
    /// A value, and whether it stands in quotes or between semicolons, so that `?` and `.` are text.
    Value(&'a str, bool),
}

impl<'a> Token<'a> {
    /// The text of a value, unless it says that there is none.
    pub(super) fn value(self) -> Option<&'a str> {
        match self {
            Self::Value("?" | ".", false) => None,
            Self::Value(text, _) => Some(text),
            _ => None,
        }
    }
}

/// Why text is not CIF.
#[derive(Debug, PartialEq)]
pub(super) struct SyntaxError {
    pub what: String,
    /// Whether it ends too early.
    pub is_cut: bool,
}

impl SyntaxError {
    pub(super) fn cut(what: String) -> Self {
        Self { what, is_cut: true }
    }

    pub(super) fn at(line: u64, what: &str) -> Self {
        Self { what: format!("line {line} {what}"), is_cut: false }
    }
}

/// The words of a text whose lines end with `\n`.
#[derive(Clone)]
pub(super) struct Tokens<'a> {
    rest: &'a str,
    /// The line of `rest`, counted from 1.
    line: u64,
    begins_line: bool,
}

impl<'a> Tokens<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { rest: text, line: 1, begins_line: true }
    }

    /// The line of the word that came last.
    pub(super) fn line(&self) -> u64 {
        self.line
    }

    /// The next word, if there is one.
    pub(super) fn next(&mut self) -> Result<Option<Token<'a>>, SyntaxError> {
        loop {
            let blank = self.rest.trim_start_matches([' ', '\t', '\n']);
            let passed = &self.rest[..self.rest.len() - blank.len()];
            self.line += passed.matches('\n').count() as u64;
            self.begins_line = passed.ends_with('\n') || passed.is_empty() && self.begins_line;
            self.rest = blank;
            if !blank.starts_with('#') {
                break;
            }
            let end = blank.find('\n').unwrap_or(blank.len());
            (self.rest, self.begins_line) = (&blank[end..], false);
        }
        let Some(first) = self.rest.chars().next() else { return Ok(None) };
        match first {
            ';' if self.begins_line => self.text_field().map(Some),
            '\'' | '"' => self.quoted(first).map(Some),
            _ => self.word().map(Some),
        }
    }

    /// A word without quotes.
    fn word(&mut self) -> Result<Token<'a>, SyntaxError> {
        let end = self.rest.find([' ', '\t', '\n']).unwrap_or(self.rest.len());
        let word = &self.rest[..end];
        self.pass(end);
        let is = |name: &str| word.eq_ignore_ascii_case(name);
        let begins = |name: &str| {
            word.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name))
        };
        Ok(match word {
            _ if word.starts_with('_') => Token::Tag(word),
            _ if is("loop_") => Token::Loop,
            _ if begins("data_") => Token::Block,
            _ if begins("save_") => Token::Frame,
            _ if is("global_") || is("stop_") => {
                return Err(SyntaxError::at(self.line, &format!("has {word}, which CIF reserves")));
            }
            _ if word.starts_with(['$', '[', ']']) => {
                let what = format!("has {word:?}, which is not a value unless it is in quotes");
                return Err(SyntaxError::at(self.line, &what));
            }
            _ => Token::Value(word, false),
        })
    }

    /// A value in quotes, which ends at the first quote that white space follows.
    fn quoted(&mut self, quote: char) -> Result<Token<'a>, SyntaxError> {
        let text = &self.rest[1..];
        let line = text.split('\n').next().unwrap_or_default();
        let ends =
            |at: &usize| line[at + 1..].chars().next().is_none_or(|next| " \t".contains(next));
        let Some(end) = line.match_indices(quote).map(|(at, _)| at).find(ends) else {
            let what = "has a quote without an end";
            return Err(if line.len() == text.len() {
                SyntaxError::cut(format!("ends inside a quote in line {}", self.line))
            } else {
                SyntaxError::at(self.line, what)
            });
        };
        self.pass(end + 2);
        Ok(Token::Value(&line[..end], true))
    }

    /// Lines between one that begins with a semicolon and the next that does.
    fn text_field(&mut self) -> Result<Token<'a>, SyntaxError> {
        let text = &self.rest[1..];
        let Some(end) = text.find("\n;") else {
            return Err(SyntaxError::cut(format!(
                "ends inside the text that begins in line {}",
                self.line
            )));
        };
        self.line += text[..=end].matches('\n').count() as u64;
        self.pass(end + 3);
        Ok(Token::Value(&text[..end], true))
    }

    fn pass(&mut self, bytes: usize) {
        (self.rest, self.begins_line) = (&self.rest[bytes..], false);
    }
}

/// The words of a file, with errors that name it.
pub(super) struct Words<'a> {
    path: &'a Path,
    tokens: Tokens<'a>,
}

impl<'a> Words<'a> {
    pub(super) fn new(path: &'a Path, text: &'a str) -> Self {
        Self { path, tokens: Tokens::new(text) }
    }

    pub(super) fn next(&mut self) -> Result<Option<Token<'a>>, PointsError> {
        self.tokens.next().map_err(|SyntaxError { what, is_cut }| {
            let reason = if is_cut {
                Reason::truncated(format!("{what}: it is truncated"))
            } else {
                Reason::value(what)
            };
            format(self.path, reason)
        })
    }

    /// The value of the tag that came last.
    pub(super) fn value_of(&mut self, tag: &str) -> Result<Token<'a>, PointsError> {
        match self.next()? {
            Some(value @ Token::Value(..)) => Ok(value),
            Some(_) => Err(self.wrong_here(&format!("has no value behind {tag}"))),
            None => {
                let what = format!("ends behind the tag {tag}: it is truncated");
                Err(format(self.path, Reason::truncated(what)))
            }
        }
    }

    /// The tags of a loop, and the word behind them.
    pub(super) fn tags(&mut self) -> Result<(Vec<&'a str>, Option<Token<'a>>), PointsError> {
        let mut tags = Vec::new();
        let mut ahead = self.next()?;
        while let Some(Token::Tag(tag)) = ahead {
            tags.push(tag);
            ahead = self.next()?;
        }
        if tags.is_empty() {
            return Err(self.wrong_here("has a loop_ without tags"));
        }
        Ok((tags, ahead))
    }

    /// Reads the next row of a loop; returns whether there is one. `ahead` is the word behind the tags, and in the end that behind the
    /// rows.
    pub(super) fn row(
        &mut self,
        tags: &[&str],
        row: &mut Vec<Token<'a>>,
        ahead: &mut Option<Token<'a>>,
    ) -> Result<bool, PointsError> {
        row.clear();
        while row.len() < tags.len() {
            let word = match ahead.take() {
                None => self.next()?,
                word => word,
            };
            match word {
                Some(value @ Token::Value(..)) => row.push(value),
                other => {
                    *ahead = other;
                    break;
                }
            }
        }
        if row.is_empty() || row.len() == tags.len() {
            return Ok(!row.is_empty());
        }
        let (found, all, first) = (row.len(), tags.len(), tags[0]);
        let what = format!("{found} of {all} values in the last row of the loop of {first}");
        Err(match ahead {
            None => {
                format(self.path, Reason::truncated(format!("ends behind {what}: it is truncated")))
            }
            Some(_) => self.wrong_here(&format!("comes behind {what}")),
        })
    }

    /// The error for a value that has no tag.
    pub(super) fn without_tag(&self, value: &str) -> PointsError {
        let value: String = value.chars().take(20).collect();
        self.wrong_here(&format!("has a value without a tag, {value:?}"))
    }

    /// The error for what is in the line of the last word.
    pub(super) fn wrong_here(&self, what: &str) -> PointsError {
        format(self.path, Reason::value(format!("line {} {what}", self.tokens.line())))
    }
}

/// A finite number, which may have its uncertainty in parentheses.
pub(super) fn number(text: &str) -> Option<f64> {
    let text = match text.split_once('(') {
        Some((number, uncertainty)) => {
            let digits = uncertainty.strip_suffix(')')?;
            (!digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()))
                .then_some(number)?
        }
        None => text,
    };
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

/// A symbol without the charge behind it, as in `Fe3+`.
pub(super) fn without_charge(symbol: &str) -> &str {
    match symbol.strip_suffix(['+', '-']) {
        Some(rest) => rest.trim_end_matches(|c: char| c.is_ascii_digit()),
        None => symbol,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Result<Vec<Token<'_>>, SyntaxError> {
        let mut tokens = Tokens::new(text);
        let mut all = Vec::new();
        while let Some(token) = tokens.next()? {
            all.push(token);
        }
        Ok(all)
    }

    #[test]
    fn words_are_told_apart() {
        use Token::{Block, Frame, Loop, Tag, Value};
        let text = "data_1 # a comment; 'x\nLOOP_ _a.b\t_C\n'a b' \"it's\" 'it's' x#y ? '?' ;no\n;a\n b;\n; .\nsave_x";
        let expected = [
            Block,
            Loop,
            Tag("_a.b"),
            Tag("_C"),
            Value("a b", true),
            Value("it's", true),
            Value("it's", true),
            Value("x#y", false),
            Value("?", false),
            Value("?", true),
            Value(";no", false),
            Value("a\n b;", true),
            Value(".", false),
            Frame,
        ];
        assert_eq!(all(text).unwrap(), expected);
        let values: Vec<_> = expected[8..13].iter().map(|token| token.value()).collect();
        assert_eq!(values, [None, Some("?"), Some(";no"), Some("a\n b;"), None]);
        assert_eq!(all(" \n#x").unwrap(), []);
        // Two text fields in a row, and an empty one.
        assert_eq!(all(";a\n;\n;\n;").unwrap(), [Value("a", true), Value("", true)]);
    }

    #[test]
    fn what_is_not_cif_is_an_error() {
        for (text, what, is_cut) in [
            ("'a\nb'", "line 1 has a quote without an end", false),
            ("x\n\"a", "ends inside a quote in line 2", true),
            ("\n;a\nb", "ends inside the text that begins in line 2", true),
            ("x\n[1]", "line 2 has \"[1]\"", false),
            ("stop_", "which CIF reserves", false),
        ] {
            let error = all(text).unwrap_err();
            assert!(error.what.contains(what) && error.is_cut == is_cut, "{text}: {error:?}");
        }
    }
}
