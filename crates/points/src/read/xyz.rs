use std::collections::HashSet;
use std::path::Path;
use std::sync::Arc;

use walpha_base::memory::{NoMemory, try_reserve, try_with_capacity};
use walpha_base::shown::shown;

use super::dialect::{Dialect, number};
use super::extended::Comment;
use super::header::Header;
use super::lines::{Frame, Miscount, Numbered, count, frames, is_comment};
use super::rows::TextRows;
use super::text::text;
use super::{Columns, Points, PointsError, choose_frame, format};
use crate::molecule::{Atom, Element, Molecule, Radii, warn_of_labels};
use crate::{Attributes, Cell, ModelMetadata, PointOptions};
use walpha_volume::{Coordinates, LengthUnit, OpenFile, Reason};

/// The layout of lines of numbers that have no names.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum TextLayout {
    /// A table, whose fields may be empty.
    Table,
    /// If the first line contains only a count, it begins chemistry's XYZ: a comment line, whose form extended XYZ defines, then
    /// for each atom an element, its coordinates, and possibly more columns.
    Atoms,
    /// Like `Atoms`, but six columns are a position with a normal or colour.
    Vectors,
    /// PTS: a count may come first; seven columns are x y z, the intensity and a colour.
    Scan,
    /// PWN: a count, the points, and then as many normals.
    PointsThenNormals,
}

impl TextLayout {
    /// The columns to assume without names; `None` if they are guessed from their numbers.
    fn default_columns(self) -> Option<Columns> {
        let axes = [Some(0), Some(1), Some(2)];
        match self {
            Self::Table | Self::Atoms | Self::PointsThenNormals => None,
            Self::Vectors => Some(Columns::without_names([axes, [None; 3]].concat())),
            Self::Scan => {
                Some(Columns::without_names([&axes[..], &[Some(4)], &[None; 3]].concat()))
            }
        }
    }

    /// Whether counts may be followed by a comment line.
    fn has_comments(self) -> bool {
        matches!(self, Self::Atoms | Self::Vectors)
    }
}

/// Reads lines of numbers: a table with or without names, atoms, or scans with counts. The encoding is recognised from the text,
/// and [`Dialect`] decides on the separators. Lines that begin with `#` or `/` are comments. Of several frames, one is read.
pub(crate) fn read(
    file: &OpenFile,
    options: &PointOptions,
    layout: TextLayout,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = file.path();
    let text = text(file)?;
    let mut lines = Numbered::new(&text);
    let Header { columns, unit } = Header::read(path, &mut lines, options.columns.as_ref())?;
    let in_unit =
        |unit| ModelMetadata::default().coordinates(Coordinates { unit, ..Coordinates::default() });
    if lines.is_at_end() {
        return Err(format(path, Reason::content("has no rows of numbers", "name another file")));
    }
    if lines.contents().next().is_none_or(|(_, line)| count(line).is_none()) {
        choose_frame(path, 1, options.frame)?;
        let rows = rows(path, &lines, columns, layout, &options.attributes)?;
        return Ok((rows, in_unit(unit)));
    }
    if layout == TextLayout::PointsThenNormals {
        choose_frame(path, 1, options.frame)?;
        return Ok((points_then_normals(path, lines)?, in_unit(unit)));
    }
    let frames = counted(path, &lines, layout)?;
    let frame = &frames[choose_frame(path, frames.len(), options.frame)?];
    let Header { columns, unit } = match frame.comment.filter(|_| !layout.has_comments()) {
        Some(names) => Header::read(path, &mut Numbered::new(names), options.columns.as_ref())?,
        None => Header { columns, unit },
    };
    let (points, cell) = of_frame(path, frame, columns, layout, options)?;
    // Elements are those of atoms, whose places chemistry states in this unit.
    let unit = if points.molecule.is_some() { LengthUnit::Angstrom } else { unit };
    Ok((points, in_unit(unit).cell(cell)))
}

/// The frames of lines that begin with a count. In chemistry's XYZ a comment line follows it; if the numbers of rows show that
/// there is none, points follow.
fn counted<'a>(
    path: &Path,
    lines: &Numbered<'a>,
    layout: TextLayout,
) -> Result<Vec<Frame<'a>>, PointsError> {
    let points = |miscount: Miscount| miscount.error(path, "points");
    let without = frames(lines.clone(), false);
    if !layout.has_comments() {
        return without.map_err(points);
    }
    match (frames(lines.clone(), true), without) {
        (Ok(frames), _) if is_row_or_comment(&frames) => {
            let (count, comment) = (frames[0].rows.contents().count(), frames[0].comment);
            let what = format!(
                "counts {count} points, and {:?} behind that may be a comment or one more of them",
                comment.unwrap_or_default().trim()
            );
            let advice = "correct the count, or write words into the comment";
            Err(format(path, Reason::content(what, advice)))
        }
        (Ok(frames), _) | (_, Ok(frames)) => Ok(frames),
        (Err(atoms), Err(miscount)) => {
            let second = lines.clone().nth(1).map(|(_, line)| line).unwrap_or_default();
            let mut words = second.split_whitespace();
            let is_row =
                words.clone().count() > 1 && words.all(|word| number(word, true).is_some());
            Err(if is_row { points(miscount) } else { atoms.error(path, "atoms") })
        }
    }
}

/// Whether the comment of a single frame looks like its rows, with numbers, and as many of them.
fn is_row_or_comment(frames: &[Frame<'_>]) -> bool {
    let [Frame { rows, comment: Some(comment) }] = frames else { return false };
    let numbers = |line: &str| {
        let words = line.split_whitespace();
        let are_numbers = words.clone().all(|word| number(word, true).is_some());
        are_numbers.then(|| words.count()).filter(|count| *count > 1)
    };
    let own = numbers(comment);
    own.is_some() && rows.contents().next().is_some_and(|(_, row)| numbers(row) == own)
}

/// The points of a frame, and the cell that its comment states.
fn of_frame(
    path: &Path,
    frame: &Frame<'_>,
    columns: Option<Columns>,
    layout: TextLayout,
    options: &PointOptions,
) -> Result<(Points, Option<Cell>), PointsError> {
    let PointOptions { radii, attributes, .. } = options;
    let comment = frame.comment.filter(|_| layout.has_comments());
    let Comment { columns: stated, species, cell } = match comment {
        Some(comment) => Comment::read(path, comment)?,
        None => Comment::default(),
    };
    // Columns that are named in another place are others.
    let mut species = species.filter(|_| columns.is_none());
    let columns = columns.or(stated);
    let has_comment = frame.comment.is_some();
    let atoms = columns.is_none() && layout.has_comments() && are_atoms(&frame.rows, has_comment);
    // Points directly behind their count are laid out as scanners do.
    let is_scan = layout == TextLayout::Atoms && !has_comment;
    let layout = if is_scan { TextLayout::Scan } else { layout };
    let columns = if atoms {
        let first = frame.rows.contents().next();
        if first.is_some_and(|(_, row)| row.split_whitespace().count() > 4) {
            tracing::warn!(
                "{}: what follows z is passed over, as the comment line has no Properties=… that names it",
                shown(path)
            );
        }
        species = Some(0);
        Some(Columns::without_names(vec![None, Some(0), Some(1), Some(2)]))
    } else {
        columns
    };
    let mut names = species.map(Species::new);
    let rows = Rows { layout, open_ended: atoms, attributes };
    let mut points = rows_with(path, &frame.rows, columns, rows, names.as_mut())?;
    if let Some(Species { names, .. }) = names {
        take_atoms(path, &mut points, names, radii.as_ref())?;
    }
    Ok((points, cell))
}

/// A column of names of elements.
struct Species {
    column: usize,
    names: Vec<Arc<str>>,
    /// One copy of each.
    known: HashSet<Arc<str>>,
}

impl Species {
    fn new(column: usize) -> Self {
        Self { column, names: Vec::new(), known: HashSet::new() }
    }

    fn push(&mut self, fields: &[&str]) -> Result<(), NoMemory> {
        try_reserve(&mut self.names, 1, || "the names of atoms".into())?;
        let name = fields.get(self.column).copied().unwrap_or_default();
        let known = self.known.get(name).cloned().unwrap_or_else(|| {
            let new: Arc<str> = name.into();
            self.known.insert(new.clone());
            new
        });
        self.names.push(known);
        Ok(())
    }
}

/// Makes points those of atoms with these names, and looks up their radii. Names of which none is an element are labels, unless
/// radii are asked for.
fn take_atoms(
    path: &Path,
    points: &mut Points,
    names: Vec<Arc<str>>,
    radii: Option<&Radii>,
) -> Result<(), PointsError> {
    let element = |name: &str| match name.parse() {
        Ok(number) => Element::numbered(number),
        Err(_) => Element::named(name),
    };
    let atoms = names.into_iter().map(|name| Atom {
        element: element(&name),
        name,
        model: 1,
        ..Atom::default()
    });
    let mut list = try_with_capacity(atoms.len(), || "the atoms of a file".into())?;
    list.extend(atoms);
    let molecule = Molecule { atoms: list, ..Molecule::default() };
    let is_asked = radii.is_some_and(|radii| *radii != Radii::None);
    if !is_asked && molecule.atoms.iter().all(|atom| atom.element.is_none()) {
        if radii.is_none() {
            warn_of_labels(path, molecule.atoms.first());
        }
        return Ok(());
    }
    points.molecule = Some(molecule);
    match radii {
        None if points.weights.is_some() => Ok(()),
        Some(Radii::Column) if points.of_radii => Ok(()),
        _ => points.look_up_radii(path, None, radii),
    }
}

/// Whether rows begin with elements before x, y and z, or, with `by_number`, with atomic numbers.
fn are_atoms(rows: &Numbered<'_>, by_number: bool) -> bool {
    let first = |row: &'_ str| row.split_whitespace().next().map(str::to_owned).unwrap_or_default();
    let is_name = |word: &str| number(word, true).is_none();
    let is_atomic_number =
        |word: &str| word.parse().is_ok_and(|number: u8| (1..=118).contains(&number));
    let has_four = |row: &str| row.split_whitespace().count() > 3;
    rows.contents().next().is_some_and(|(_, row)| is_name(&first(row)))
        || by_number
            && rows.contents().all(|(_, row)| has_four(row) && is_atomic_number(&first(row)))
}

/// Converts rows to points.
fn rows(
    path: &Path,
    lines: &Numbered<'_>,
    columns: Option<Columns>,
    layout: TextLayout,
    attributes: &Attributes,
) -> Result<Points, PointsError> {
    rows_with(path, lines, columns, Rows { layout, open_ended: false, attributes }, None)
}

/// What is known of rows beside their columns.
struct Rows<'a> {
    layout: TextLayout,
    /// Whether they may have more columns than are known.
    open_ended: bool,
    /// The other columns to keep.
    attributes: &'a Attributes,
}

/// The points of rows, and the names in one column.
fn rows_with(
    path: &Path,
    lines: &Numbered<'_>,
    columns: Option<Columns>,
    Rows { layout, open_ended, attributes }: Rows<'_>,
    mut species: Option<&mut Species>,
) -> Result<Points, PointsError> {
    let width = columns.as_ref().map(Columns::len);
    let dialect = Dialect::of(lines, layout == TextLayout::Table, width)
        .map_err(|reason| format(path, reason))?;
    if dialect.decimal_comma && !dialect.has_semicolons() {
        tracing::warn!("{}: the commas of its numbers mark decimals", shown(path));
    }
    let mut rows = TextRows::new(path, columns, attributes);
    rows.decimal_comma = dialect.decimal_comma;
    rows.at_commas = dialect.has_commas();
    rows.default_columns = layout.default_columns();
    rows.open_ended = open_ended;
    let mut labelled = 0;
    for (number, line) in lines.contents() {
        labelled += usize::from(is_comment(line));
        let fields = dialect.fields(line);
        rows.push(number, &fields)?;
        if let Some(species) = &mut species {
            species.push(&fields)?;
        }
    }
    if labelled > 0 {
        tracing::warn!(
            "{}: {labelled} lines that begin as comments do have a field for each name, and numbers for x, y and z: they are \
             taken for rows",
            shown(path)
        );
    }
    rows.finish()
}

/// Reads a count, as many points, and as many normals, if there are any, which are skipped.
fn points_then_normals(path: &Path, mut lines: Numbered<'_>) -> Result<Points, PointsError> {
    let first = lines.next_content();
    let count = first.and_then(|(_, line)| count(line)).unwrap_or_default();
    let columns = Columns::without_names(vec![Some(0), Some(1), Some(2)]);
    let layout = TextLayout::PointsThenNormals;
    let mut points = rows(path, &lines, Some(columns), layout, &Attributes::None)?;
    let found = points.len() as u64;
    if found != count && Some(found) != count.checked_mul(2) {
        let what =
            format!("claims {count} points and perhaps as many normals, but has {found} lines");
        let reason = if found < count {
            Reason::claims_more(format!("{what}: it is truncated, or the count is wrong"))
        } else {
            Reason::content(what, "correct the count")
        };
        return Err(format(path, reason));
    }
    points.positions.truncate(count as usize);
    Ok(points)
}
