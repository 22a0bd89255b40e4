//! Writers of points.

#[cfg(feature = "las")]
pub(super) mod las;

use std::borrow::Cow;
use std::io::{self, Write};

use walpha_base::npy::MAGIC;

use super::{Column, ModelMetadata, Packing, WeightedPoints};

/// What is written of points.
pub(super) struct Content<'a> {
    pub points: &'a WeightedPoints,
    /// Their further columns.
    pub columns: &'a [Column],
    pub metadata: &'a ModelMetadata,
    pub packing: &'a Packing,
}

/// A name for each of some columns that none of `taken` and no other has.
fn names<'a>(taken: &[&str], columns: &'a [Column]) -> Vec<Cow<'a, str>> {
    let mut names: Vec<Cow<'a, str>> = Vec::new();
    for column in columns {
        let mut name = Cow::Borrowed(column.name.as_str());
        let is_taken = |name: &str| {
            taken.iter().any(|known| known.eq_ignore_ascii_case(name))
                || names.iter().any(|known| *known == name)
        };
        while is_taken(&name) {
            name.to_mut().insert_str(0, "file_");
        }
        names.push(name);
    }
    names
}

/// The names of what a point has in tables: x, y, z, weight and, if known, value.
fn own_names(points: &WeightedPoints) -> &'static [&'static str] {
    const ALL: &[&str] = &["x", "y", "z", "weight", "value"];
    if points.values().is_some() { ALL } else { &ALL[..4] }
}

/// The numbers of each point: those that [`own_names`] names, and those of further columns.
fn rows<'a>(content: &Content<'a>) -> impl Iterator<Item = impl Iterator<Item = f64> + 'a> {
    let Content { points, columns, .. } = *content;
    let rows = points.positions().iter().zip(points.weights()).enumerate();
    rows.map(move |(index, (place, weight))| {
        let value = points.values().map(|values| values[index]);
        let others = columns.iter().map(move |column| column.values[index]);
        place.iter().copied().chain([*weight]).chain(value).chain(others)
    })
}

/// Writes points as CSV with the columns x, y, z, weight and, if known, value, and further ones. Each number has the shortest
/// form that reads back as the same double; `nan` stands for none.
///
/// # Errors
/// Errors of the writer.
pub(super) fn csv(content: &Content<'_>, out: &mut dyn Write) -> io::Result<()> {
    let own = own_names(content.points);
    let others = names(own, content.columns);
    let mut head = csv::Writer::from_writer(&mut *out);
    head.write_record(own.iter().copied().chain(others.iter().map(AsRef::as_ref)))?;
    head.flush()?;
    drop(head);
    for row in rows(content) {
        for (k, number) in row.enumerate() {
            let comma = if k > 0 { "," } else { "" };
            if number.is_nan() {
                write!(out, "{comma}nan")?;
            } else {
                write!(out, "{comma}{number}")?;
            }
        }
        writeln!(out)?;
    }
    out.flush()
}

/// Writes points as a structured NPY array with the fields x, y, z, weight and, if known, value, and further ones, all doubles.
///
/// # Errors
/// Errors of the writer, and more columns than a header can name.
pub(super) fn npy(content: &Content<'_>, out: &mut dyn Write) -> io::Result<()> {
    /// Bytes before the text of the header: the magic string, the version, and the length of the text.
    const BEFORE: usize = 10;
    let own = own_names(content.points);
    let others = names(own, content.columns);
    let field = |name: &str| format!("('{}', '<f8')", name.escape_default());
    let fields: Vec<String> =
        own.iter().copied().chain(others.iter().map(AsRef::as_ref)).map(field).collect();
    let mut header = format!(
        "{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}",
        fields.join(", "),
        content.points.len()
    );
    // NumPy aligns the elements to 64 bytes; a line end comes last.
    let length = BEFORE + header.len() + 1;
    header += &" ".repeat(length.next_multiple_of(64) - length);
    header.push('\n');
    let length = u16::try_from(header.len()).map_err(|_| {
        let what = format!("{} columns are more than an NPY file can name", fields.len());
        io::Error::new(io::ErrorKind::InvalidInput, what)
    })?;
    out.write_all(MAGIC)?;
    out.write_all(&[1, 0])?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(header.as_bytes())?;
    for number in rows(content).flatten() {
        out.write_all(&number.to_le_bytes())?;
    }
    out.flush()
}
