//! The numbered lines of a text, and the frames into which counts of rows divide them.

use std::path::Path;

use super::dialect::{number, split_at};
use super::{Columns, PointsError, format};
use walpha_volume::Reason;

/// Lines with their numbers, from 1.
#[derive(Clone)]
pub(super) struct Numbered<'a> {
    /// The remaining text.
    text: &'a str,
    /// The number of the next line.
    line: u64,
    /// The form of rows that begin like comments.
    labelled: Option<Labelled>,
}

impl<'a> Numbered<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, line: 1, labelled: None }
    }

    /// Treats lines that begin like comments as rows if they look like such rows.
    pub(super) fn set_labelled(&mut self, labelled: Labelled) {
        self.labelled = Some(labelled);
    }

    /// Returns the next line without consuming it.
    pub(super) fn peek(&self) -> Option<(u64, &'a str)> {
        self.clone().next()
    }

    /// The lines that are neither empty nor comments. Comments begin with `#` or `/`.
    pub(super) fn contents(&self) -> impl Iterator<Item = (u64, &'a str)> + use<'a> {
        let labelled = self.labelled;
        self.clone().filter(move |(_, line)| is_content(line, labelled))
    }

    /// The lines before a later place in the same text.
    fn until(&self, end: &Self) -> Self {
        Self { text: &self.text[..self.text.len() - end.text.len()], ..*self }
    }

    /// Whether only empty lines and comments are left.
    pub(super) fn is_at_end(&self) -> bool {
        self.contents().next().is_none()
    }

    /// The next line that is neither empty nor a comment.
    pub(super) fn next_content(&mut self) -> Option<(u64, &'a str)> {
        let labelled = self.labelled;
        self.find(|(_, line)| is_content(line, labelled))
    }
}

impl<'a> Iterator for Numbered<'a> {
    type Item = (u64, &'a str);

    fn next(&mut self) -> Option<(u64, &'a str)> {
        if self.text.is_empty() {
            return None;
        }
        let (line, rest) = split(self.text);
        let number = self.line;
        self.text = rest;
        self.line += 1 + line.matches('\n').count() as u64;
        Some((number, line))
    }
}

/// Splits a text into its first line and the rest. A field in quotes may extend over several lines.
fn split(text: &str) -> (&str, &str) {
    /// The largest number of lines of such a field.
    const LINES: usize = 4;
    let mut ends = text.match_indices('\n').map(|(end, _)| end).take(LINES);
    let first = ends.next().unwrap_or(text.len());
    let closed = |&end: &usize| !is_open(&text[..end]);
    let end = if is_open(&text[..first]) { ends.find(closed).unwrap_or(first) } else { first };
    (&text[..end], text.get(end + 1..).unwrap_or_default())
}

/// Whether a line ends inside a field in quotes.
fn is_open(line: &str) -> bool {
    let begins = |(at, _): (usize, &str)| {
        line[..at].trim_end_matches([' ', '\t']).is_empty()
            || line[..at].trim_end_matches(' ').ends_with([',', ';', '\t'])
    };
    line.matches('"').count() % 2 == 1 && line.match_indices('"').next().is_some_and(begins)
}

/// The words of lines, each with its line number.
pub(super) fn words<'a>(
    lines: impl Iterator<Item = (u64, &'a str)> + Clone,
) -> impl Iterator<Item = (u64, &'a str)> + Clone {
    lines.flat_map(|(number, line)| line.split_whitespace().map(move |word| (number, word)))
}

/// The form of rows that may begin with a label such as `#2` or `/data/b.jpg`, given by the names of their columns or by the
/// separator of these names.
#[derive(Clone, Copy)]
pub(super) struct Labelled {
    /// The separator; `None` for blanks.
    mark: Option<char>,
    width: usize,
    /// The columns of x, y and, if it exists, z.
    axes: [Option<usize>; 3],
}

impl Labelled {
    pub(super) fn new(Columns { places: columns, .. }: &Columns, mark: Option<char>) -> Self {
        let axis = |axis: usize| columns.iter().position(|&column| column == Some(axis));
        Self { mark, width: columns.len(), axes: [axis(0), axis(1), axis(2)] }
    }

    /// Whether a line has a field for each name, and numbers for x, y and z.
    pub(super) fn is_row(&self, line: &str) -> bool {
        let fields = fields_at(line, self.mark);
        let mut axes = self.axes.iter().flatten();
        fields.len() == self.width && axes.all(|&axis| number(fields[axis], true).is_some())
    }
}

/// The separator of the fields of a line: semicolon, tab or comma; `None` for blanks.
pub(super) fn mark(line: &str) -> Option<char> {
    [';', '\t', ','].into_iter().find(|&mark| line.contains(mark))
}

/// The fields of a line, without empty ones at its end.
pub(super) fn fields_at(line: &str, mark: Option<char>) -> Vec<&str> {
    let mut fields = match mark {
        Some(mark) => split_at(line, mark),
        None => line.split_whitespace().collect(),
    };
    while fields.len() > 1 && fields.last().is_some_and(|field| field.is_empty()) {
        fields.pop();
    }
    fields
}

/// Whether a line begins like a comment.
pub(super) fn is_comment(line: &str) -> bool {
    line.trim_start_matches([' ', '\t', ';', ',']).starts_with(['#', '/'])
}

/// Whether a line is neither empty nor a comment. A line that contains only separators is empty.
fn is_content(line: &str, labelled: Option<Labelled>) -> bool {
    !line.trim_matches([' ', '\t', ';', ',']).trim().is_empty()
        && (!is_comment(line) || labelled.is_some_and(|labelled| labelled.is_row(line)))
}

/// The number that is the whole content of a line.
pub(super) fn count(line: &str) -> Option<u64> {
    line.trim_matches([' ', '\t', ';', ',']).parse().ok()
}

/// The rows that follow a count of them.
pub(super) struct Frame<'a> {
    pub rows: Numbered<'a>,
    /// The line in between: the comment of chemistry's XYZ, or otherwise names of columns.
    pub comment: Option<&'a str>,
}

/// The error for a count that differs from the number of rows behind it.
pub(super) struct Miscount {
    line: u64,
    claimed: u64,
    found: u64,
}

impl Miscount {
    pub(super) fn error(&self, path: &Path, what: &str) -> PointsError {
        let Self { line, claimed, found } = self;
        let text = format!("claims {claimed} {what} in line {line}, but has {found} behind it");
        let reason = if found < claimed {
            Reason::claims_more(format!("{text}: it is truncated, or the count is wrong"))
        } else {
            Reason::content(text, "correct the count, or remove it")
        };
        format(path, reason)
    }
}

/// Divides lines, of which the first is a count, into frames. With `comments`, a line of any content follows each count;
/// otherwise names of columns may.
pub(super) fn frames(mut lines: Numbered<'_>, comments: bool) -> Result<Vec<Frame<'_>>, Miscount> {
    let mut frames = Vec::new();
    while let Some((line, text)) = lines.next_content() {
        let Some(claimed) = count(text) else { unreachable!("checked below, or by the caller") };
        let is_named = |line: &str| Columns::named(&fields_at(line, mark(line))).is_ok();
        let comment = if comments {
            lines.next()
        } else if lines.contents().next().is_some_and(|(_, line)| is_named(line)) {
            lines.next_content()
        } else {
            None
        };
        let comment = comment.map(|(_, comment)| comment);
        let rows = lines.clone();
        let mut found = 0;
        loop {
            let is_row = lines.contents().next().is_some_and(|(_, text)| count(text).is_none());
            if !is_row {
                break;
            }
            lines.next_content();
            found += 1;
        }
        if found != claimed {
            return Err(Miscount { line, claimed, found });
        }
        frames.push(Frame { rows: rows.until(&lines), comment });
    }
    Ok(frames)
}
