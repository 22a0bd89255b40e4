//! How a text separates its fields and writes its numbers. This is decided by all rows together: a comma may separate fields,
//! mark decimals, or group thousands, and a single row has too little information.

use std::borrow::Cow;

use super::lines::Numbered;
use walpha_volume::Reason;

/// The separator of fields and the decimal mark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Dialect {
    separator: Separator,
    /// Whether the decimal mark is a comma.
    pub decimal_comma: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Separator {
    /// This character, which may have blanks around it.
    One(char),
    /// Blanks, and commas if these do not mark decimals.
    Blanks,
}

/// The advice about numbers that can be read in two ways.
pub(super) const PLAINLY: &str = "write it with decimal points and without marks between thousands";

impl Dialect {
    /// The dialect of some rows. `tabs` means that tabs separate fields instead of being blanks; `width` is the number of
    /// columns, if it is known.
    ///
    /// - Semicolons in most rows separate fields, and the commas of their numbers mark decimals.
    /// - If commas separate all fields, with or without blanks beside them, they are separators.
    /// - In numbers between blanks (or tabs), commas mark decimals, unless each of them could group thousands, as in `1,234`:
    ///   then the text is ambiguous.
    pub(super) fn of(
        rows: &Numbered<'_>,
        tabs: bool,
        width: Option<usize>,
    ) -> Result<Self, Reason> {
        let mut counts = [0; 4];
        for (_, row) in rows.contents() {
            let has = [true, row.contains(';'), row.contains('\t'), row.contains(',')];
            counts.iter_mut().zip(has).for_each(|(count, has)| *count += usize::from(has));
        }
        let [all, semicolons, with_tabs, commas] = counts;
        let one = |mark| Self { separator: Separator::One(mark), decimal_comma: false };
        let blanks = Self { separator: Separator::Blanks, decimal_comma: false };
        if 2 * semicolons > all {
            return one(';').with_commas(rows);
        }
        if tabs && 2 * with_tabs > all {
            return one('\t').with_commas(rows);
        }
        if commas == 0 {
            return Ok(blanks);
        }
        if rows.contents().any(|(_, row)| has_bare_blank(row)) {
            let marks = Marks::of(rows, |row| row.split_whitespace());
            if marks.decimal {
                let comma = Self { decimal_comma: true, ..blanks };
                marks.decide()?;
                return comma.without_spaced_thousands(rows, width);
            }
            if marks.thousands
                && let Some((line, word)) = marks.example
            {
                let both = format!("{} or {}", word.replace(',', " and "), word.replace(',', ""));
                return Err(two_readings(line, word, &both));
            }
        } else if let Some((line, row)) = rows.contents().find(|(_, row)| commas_differ(row)) {
            let marks = Marks::of(rows, |row| row.split(", "));
            if marks.decimal {
                let both = "have decimal commas, or commas between all numbers";
                return Err(two_readings(line, row, both));
            }
        }
        if tabs || commas == all && !rows.contents().any(|(_, row)| has_bare_blank(row)) {
            return one(',').with_commas(rows);
        }
        Ok(blanks)
    }

    /// Sets whether commas in fields mark decimals, if there are any.
    fn with_commas(self, rows: &Numbered<'_>) -> Result<Self, Reason> {
        let marks = Marks::of(rows, |row| self.fields(row).into_iter());
        if marks.example.is_none() {
            return Ok(self);
        }
        // Writers use semicolons as separators because commas mark decimals.
        if !(marks.decimal && self.separator == Separator::One(';')) {
            marks.decide()?;
        } else if let Some((line, word)) = marks.dotted {
            return Err(dotted(line, word));
        }
        Ok(Self { decimal_comma: marks.decimal, ..self })
    }

    /// Refuses rows whose blanks may group thousands, as in `1 234,5`.
    fn without_spaced_thousands(
        self,
        rows: &Numbered<'_>,
        width: Option<usize>,
    ) -> Result<Self, Reason> {
        fn spaced(row: &str) -> Option<(&str, &str)> {
            let group = |word: &str| word.split_once(',').is_some_and(|(whole, _)| is_group(whole));
            let words = row.split_whitespace();
            words.clone().zip(words.skip(1)).find(|(a, b)| is_first_group(a) && group(b))
        }
        let is_named = |row: &str| width == Some(row.split_whitespace().count());
        if let Some((line, first)) = rows.contents().next()
            && let Some((a, b)) = spaced(first)
            && !is_named(first)
            && rows.contents().all(|(_, row)| spaced(row).is_some())
        {
            let both = format!("{a} and {}, or {a}{}", point(b), point(b));
            return Err(two_readings(line, &format!("{a} {b}"), &both));
        }
        Ok(self)
    }

    /// Whether commas separate fields.
    pub(super) fn has_commas(self) -> bool {
        self.separator == Separator::One(',')
    }

    /// Whether semicolons separate fields.
    pub(super) fn has_semicolons(self) -> bool {
        self.separator == Separator::One(';')
    }

    /// The fields of a line, without the quotes and blanks around them.
    pub(super) fn fields(self, line: &str) -> Vec<&str> {
        match self.separator {
            Separator::Blanks if self.decimal_comma => line.split_whitespace().collect(),
            Separator::Blanks => {
                let words = line.split(|c: char| c.is_whitespace() || c == ',');
                words.filter(|word| !word.is_empty()).map(unquoted).collect()
            }
            Separator::One(mark) => split_at(line, mark),
        }
    }
}

/// The fields between these marks. Text in quotes is not split; quotes are at the ends of a field, and doubled within it (RFC 4180).
pub(super) fn split_at(line: &str, mark: char) -> Vec<&str> {
    let (mut quoted, mut may_open) = (false, true);
    let is_end = |c: char| {
        if c == '"' && (quoted || may_open) {
            quoted = !quoted;
            // A second one, right behind, is part of the text.
            may_open = !quoted;
            return false;
        }
        let is_end = c == mark && !quoted;
        may_open = is_end || may_open && c.is_whitespace();
        is_end
    };
    line.split(is_end).map(unquoted).collect()
}

fn unquoted(field: &str) -> &str {
    let field = field.trim();
    field.strip_prefix('"').and_then(|field| field.strip_suffix('"')).map_or(field, str::trim)
}

/// The number in a word: with a decimal comma, if the text uses it; and with Fortran's D for an exponent.
pub(super) fn number(word: &str, decimal_comma: bool) -> Option<f64> {
    if let Ok(number) = word.parse::<f64>() {
        return Some(number);
    }
    let is_other = |c: char| matches!(c, ',' | 'd' | 'D' | '\u{2212}');
    if !word.contains(is_other) || !word.contains(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let plain = word.replace(['d', 'D'], "e").replace('\u{2212}', "-");
    (if decimal_comma { plain.replace(',', ".") } else { plain }).parse().ok()
}

/// A number without the marks between its thousands, as in `1'234.5`, `1.234,5` and `1_234`; `None` if it has no such marks.
pub(super) fn without_marks(word: &str) -> Option<String> {
    let mark = ['\'', '\u{2019}', '_', '.', ','].into_iter().find(|&mark| {
        let whole = word.split(|c| c != mark && ".,".contains(c)).next().unwrap_or_default();
        let (sign, digits) = whole.split_at(usize::from(whole.starts_with(['+', '-'])));
        let mut groups = digits.split(mark);
        let first = groups.next().unwrap_or_default();
        let rest: Vec<&str> = groups.collect();
        sign.len() < 2
            && is_first_group(first)
            && !rest.is_empty()
            && rest.iter().all(|group| is_group(group))
    })?;
    let plain = word.replace(mark, "").replace(',', ".");
    plain.parse::<f64>().is_ok().then_some(plain)
}

/// The possible meanings of the commas in numbers.
struct Marks<'a> {
    /// The first number with a comma, and its line.
    example: Option<(u64, &'a str)>,
    /// Whether all of them can mark decimals.
    decimal: bool,
    /// Whether all of them can group thousands.
    thousands: bool,
    /// A number with a point that could group thousands.
    dotted: Option<(u64, &'a str)>,
}

impl<'a> Marks<'a> {
    fn of<F: Iterator<Item = &'a str>>(rows: &Numbered<'a>, fields: impl Fn(&'a str) -> F) -> Self {
        let mut marks = Self { example: None, decimal: true, thousands: true, dotted: None };
        for (line, row) in rows.contents() {
            for word in fields(row).map(str::trim).filter(|word| is_numeric(word)) {
                if word.contains(',') {
                    marks.example.get_or_insert((line, word));
                    marks.decimal &= is_decimal(word);
                    marks.thousands &= groups_thousands(word, ',');
                } else if marks.dotted.is_none() && groups_thousands(word, '.') {
                    marks.dotted = Some((line, word));
                }
            }
        }
        marks.decimal &= marks.example.is_some();
        marks.thousands &= marks.example.is_some();
        marks
    }

    /// Refuses numbers if nothing decides whether their commas mark decimals or group thousands.
    fn decide(&self) -> Result<(), Reason> {
        let Some((line, word)) = self.example else { return Ok(()) };
        match (self.decimal, self.thousands, self.dotted) {
            (true, true, _) => {
                let both = format!("{} or {}", point(word), word.replace(',', ""));
                Err(two_readings(line, word, &both))
            }
            (false, true, _) => {
                let what = format!("line {line}: {word:?} has commas between thousands");
                Err(Reason::content(what, PLAINLY))
            }
            (true, false, Some((line, word))) => Err(dotted(line, word)),
            _ => Ok(()),
        }
    }
}

/// The error for numbers that have two readings.
fn two_readings(line: u64, what: &str, both: &str) -> Reason {
    Reason::content(format!("line {line}: {what:?} may be {both}, and no row decides"), PLAINLY)
}

/// The error for a point that may group thousands, in a text with decimal commas.
fn dotted(line: u64, word: &str) -> Reason {
    let both = format!("{word} or {}, as other numbers have decimal commas", word.replace('.', ""));
    two_readings(line, word, &both)
}

fn point(word: &str) -> Cow<'_, str> {
    if word.contains(',') { word.replace(',', ".").into() } else { word.into() }
}

/// Whether a word consists of the characters of numbers.
fn is_numeric(word: &str) -> bool {
    let is_part = |c: char| c.is_ascii_digit() || "+-.,eEdD'\u{2212}".contains(c);
    word.contains(|c: char| c.is_ascii_digit()) && word.chars().all(is_part)
}

/// Whether the comma of a number, between digits, can mark decimals.
fn is_decimal(word: &str) -> bool {
    let Some((whole, decimals)) = word.split_once(',') else { return false };
    whole.ends_with(|c: char| c.is_ascii_digit())
        && decimals.starts_with(|c: char| c.is_ascii_digit())
        && !word.contains('.')
        && number(word, true).is_some()
}

/// Whether this mark can group the thousands of a number: up to three digits without a leading zero, followed by groups of three.
fn groups_thousands(word: &str, mark: char) -> bool {
    let digits = word.trim_start_matches(['+', '-', '\u{2212}']);
    let digits = if mark == ',' { digits.split('.').next().unwrap_or_default() } else { digits };
    let mut groups = digits.split(mark);
    let first = groups.next().unwrap_or_default();
    let mut count = 0;
    is_first_group(first) && groups.inspect(|_| count += 1).all(is_group) && count > 0
}

fn is_first_group(digits: &str) -> bool {
    let digits = digits.trim_start_matches(['+', '-', '\u{2212}']);
    (1..=3).contains(&digits.len())
        && digits.bytes().all(|byte| byte.is_ascii_digit())
        && !digits.starts_with('0')
}

fn is_group(digits: &str) -> bool {
    digits.len() == 3 && digits.bytes().all(|byte| byte.is_ascii_digit())
}

/// Whether a row has blanks between two fields and no comma beside them.
fn has_bare_blank(row: &str) -> bool {
    let mut words = row.split_whitespace();
    let mut before = words.next().unwrap_or_default();
    words.any(|word| {
        let last = std::mem::replace(&mut before, word);
        !last.ends_with(',') && !word.starts_with(',')
    })
}

/// Whether some commas of a row are followed by a blank and others are not.
fn commas_differ(row: &str) -> bool {
    let row = row.trim_end_matches([',', ' ', '\t']);
    let wide = row.matches(", ").count();
    wide > 0 && row.matches(',').count() > wide
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<Vec<f64>, String> {
        let rows = Numbered::new(text);
        let dialect = Dialect::of(&rows, false, None).map_err(|reason| reason.to_string())?;
        let all = rows.contents().flat_map(|(_, row)| dialect.fields(row));
        Ok(all.filter_map(|word| number(word, dialect.decimal_comma)).collect())
    }

    #[test]
    fn marks_between_thousands_are_known() {
        for (word, plain) in [
            ("1'234.5", Some("1234.5")),
            ("-1.234.567,5", Some("-1234567.5")),
            ("1,234,567.5", Some("1234567.5")),
            ("1_000", Some("1000")),
            ("two", None),
            ("0x10", None),
            ("1e400", None),
        ] {
            assert_eq!(without_marks(word).as_deref(), plain, "{word}");
        }
    }

    #[test]
    fn all_rows_decide_what_a_comma_is() {
        for (text, numbers) in [
            ("8,56 23,68 80,13", vec![8.56, 23.68, 80.13]),
            ("8,56\t23,68\t80,13", vec![8.56, 23.68, 80.13]),
            ("8 23,68 -80,1e2", vec![8.0, 23.68, -8010.0]),
            ("8,56;23,68;80,13", vec![8.56, 23.68, 80.13]),
            ("1,234;5,678;9,012", vec![1.234, 5.678, 9.012]),
            ("8.56;23.68;80.13", vec![8.56, 23.68, 80.13]),
            ("1,2,3\n4, 5 ,6", vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
            ("1 2, 3\n4 5 6", vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
            ("1,2,3\n4 5 6", vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
            ("1.5,2.5, 3.5", vec![1.5, 2.5, 3.5]),
            // A number of four digits, or a leading zero, is not a group of thousands.
            (
                "1,234 5,678 9,012\n1234,567 8,901 2,345",
                vec![1.234, 5.678, 9.012, 1234.567, 8.901, 2.345],
            ),
            ("1,234 5,678 0,012", vec![1.234, 5.678, 0.012]),
            ("1.0D+00 2d1 \u{2212}3", vec![1.0, 20.0, -3.0]),
        ] {
            assert_eq!(of(text), Ok(numbers), "{text}");
        }
        for (text, words) in [
            ("1,234 5,678 9,012", r#"line 1: "1,234" may be 1.234 or 1234"#),
            ("1,234,567 2,345,678 3,456,789", "1 and 234 and 567 or 1234567"),
            ("1,234.5 6,789.0 1,000.0", "1 and 234.5 or 1234.5"),
            ("0,5, 1,5, 2,5", "have decimal commas, or commas between"),
            ("1 234,5 2 345,6 3 456,7", "1 and 234.5, or 1234.5"),
            ("1.234;8,56;3,1", "1.234 or 1234, as other numbers"),
        ] {
            assert!(of(text).unwrap_err().contains(words), "{text}: {:?}", of(text));
        }
    }
}
