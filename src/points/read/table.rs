use super::rows::TextRows;
use super::{Columns, Points, PointsError, format};
use crate::volume::{Lines, OpenFile, Reason, io_error};

/// Reads CSV, or tables whose fields are separated by tabs or semicolons; with semicolons, 0,5 is a half. The
/// first line may name the columns.
pub(crate) fn read(file: &OpenFile, columns: Option<&Columns>) -> Result<Points, PointsError> {
    let path = file.path();
    let fail = |error: csv::Error| {
        format(path, Reason::header(format!("is not a table of points: {error}")))
    };
    let delimiter = delimiter(file)?;
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .has_headers(false)
        .trim(csv::Trim::All)
        .from_reader(file.reader()?);
    let mut rows = TextRows::new(path, columns.cloned());
    rows.decimal_comma = delimiter == b';';
    let mut record = csv::StringRecord::new();
    let mut first = true;
    while reader.read_record(&mut record).map_err(fail)? {
        let line = record.position().map_or(0, csv::Position::line);
        let words: Vec<&str> = record.iter().collect();
        if !std::mem::take(&mut first) || is_numbers(&words) {
            rows.push(line, &words)?;
            continue;
        }
        let names: Vec<&str> =
            words.iter().map(|word| word.trim_start_matches(['\u{feff}', '#', ' '])).collect();
        match (Columns::named(&names), columns) {
            (_, Some(_)) => {}
            (Ok(named), None) => rows.set_columns(named),
            (Err(unknown), None) => {
                let reason = Reason::content(format!("{FIRST_LINE}: {unknown}"), unknown.advice());
                return Err(format(path, reason));
            }
        }
    }
    if first {
        return Err(format(
            path,
            Reason::content(format!("is empty: {FIRST_LINE}"), "write it again"),
        ));
    }
    rows.finish()
}

/// What the first line must be, for error messages.
const FIRST_LINE: &str = "its first line must name the columns x, y and z, perhaps weight (or radius) and \
                          value, or hold numbers alone";

/// Whether a first line holds data: a field of it is a number.
fn is_numbers(words: &[&str]) -> bool {
    let number = |word: &&str| {
        let word = word.trim_start_matches('\u{feff}').replace(',', ".");
        word.parse::<f64>().is_ok()
    };
    words.iter().any(number)
}

/// The first of semicolon, comma and tab that occurs in the first line; a comma if there is none.
fn delimiter(file: &OpenFile) -> Result<u8, PointsError> {
    let line = Lines::new(file.reader()?).read_line().map_err(io_error(file.path()))?;
    let line = line.unwrap_or_default();
    Ok(*b";,\t".iter().find(|&&byte| line.contains(char::from(byte))).unwrap_or(&b','))
}
