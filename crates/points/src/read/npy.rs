use std::io::Read;
use std::path::Path;

use walpha_base::advice::{Setting, advice};
use walpha_base::npy::Header;

use super::columns::{RADIUS, VALUE, WEIGHT};
use super::{Columns, Points, PointsError, format, take_radii};
use crate::{Attributes, Column, PointOptions};
use walpha_volume::{Dtype, Element as _, Endian, NpyFile, OpenFile, Reason, npy_element};

/// Whether an array lists points: its elements have fields, or it has two axes.
pub(crate) fn holds_points(file: &OpenFile) -> Result<bool, PointsError> {
    Ok(match fields_of(file)? {
        // An array of three axes is a volume, one of whose fields is requested.
        Some(header) => header.shape.len() != 3,
        None => NpyFile::open(file)?.shape.len() == 2,
    })
}

/// Reads an array of two axes with the given columns, by default x, y, z and perhaps a value; or an array whose elements have
/// fields with these names.
pub(crate) fn read(file: &OpenFile, options: &PointOptions) -> Result<Points, PointsError> {
    match fields_of(file)? {
        Some(header) => structured(file, &header, options),
        None => plain(file, options),
    }
}

/// The header of an array whose elements have fields.
fn fields_of(file: &OpenFile) -> Result<Option<Header>, PointsError> {
    // If the header is invalid, the reader of arrays says why.
    let header = Header::read(&mut file.reader()?).ok();
    Ok(header.filter(|header| header.descr.starts_with('[')))
}

fn plain(file: &OpenFile, options: &PointOptions) -> Result<Points, PointsError> {
    /// The number of rows from which columns without names are guessed, as in text.
    const ROWS: usize = 100;
    let path = file.path();
    let file = NpyFile::open(file)?;
    let &[rows, width] = file.shape.as_slice() else {
        let what =
            format!("is an array of shape {:?}, and points are rows of two axes", file.shape);
        return Err(format(path, Reason::content(what, "save a.reshape(-1, 3)")));
    };
    let (fortran, rows, width) = (file.fortran, rows as usize, width as usize);
    let dtype = file.dtype;
    let numbers: Vec<f64> = file.values(path)?;
    let at = |row: usize, column: usize| {
        numbers[if fortran { column * rows + row } else { row * width + column }]
    };
    if rows == 0 {
        return Ok(Points::default());
    }
    let columns = if let Some(columns) = &options.columns {
        columns.clone()
    } else {
        let row = |row| (0..width).map(|column| at(row, column)).collect();
        let first: Vec<Vec<f64>> = (0..rows.min(ROWS)).map(row).collect();
        Columns::guess(path, &first).map_err(|reason| format(path, reason))?
    };
    if columns.len() != width {
        return Err(format(path, wrong_width(width, columns.len())));
    }
    points(path, rows, &columns, &options.attributes, |column| {
        let numbers: Vec<f64> = (0..rows).map(|row| at(row, column)).collect();
        check_integers(path, dtype, &numbers)?;
        Ok(numbers)
    })
}

/// Refuses integers that may differ from the doubles nearest to them.
fn check_integers(path: &Path, dtype: Dtype, numbers: &[f64]) -> Result<(), PointsError> {
    /// All integers below this are doubles.
    const LEAST: f64 = (1u64 << f64::MANTISSA_DIGITS) as f64;
    let wrong = numbers.iter().position(|number| number.abs() >= LEAST);
    let Some(row) = wrong.filter(|_| matches!(dtype, Dtype::I64 | Dtype::U64)) else {
        return Ok(());
    };
    let what = format!("row {row}: a double may not hold an integer near {} exactly", numbers[row]);
    let advice = "subtract an offset before it is saved, or round on purpose, by a.astype('f8')";
    Err(format(path, Reason::content(what, advice)))
}

/// The error for a wrong number of named columns.
fn wrong_width(found: usize, named: usize) -> Reason {
    Reason::choice(
        Setting::Columns,
        format!("has {found} columns, but {named} were named"),
        advice!["name each with ", Setting::Columns],
    )
}

/// The points whose columns are read one by one.
fn points(
    path: &Path,
    rows: usize,
    columns: &Columns,
    attributes: &Attributes,
    read: impl Fn(usize) -> Result<Vec<f64>, PointsError>,
) -> Result<Points, PointsError> {
    let places = &columns.places;
    let column = |place| places.iter().position(|&column| column == Some(place));
    let mut others = Vec::new();
    for (index, name) in columns.others().filter(|(_, name)| attributes.keeps(name)) {
        match read(index) {
            Ok(values) => others.push(Column { name: name.to_owned(), values }),
            // Where all are kept, others than numbers are not.
            Err(_) if *attributes == Attributes::All => {}
            Err(error) => return Err(error),
        }
    }
    let read = |place| column(place).map(&read).transpose();
    let axes = [read(0)?, read(1)?, read(2)?];
    let axis = |axis: usize, row: usize| axes[axis].as_ref().map_or(0.0, |numbers| numbers[row]);
    let mut points = Points {
        positions: (0..rows).map(|row| [axis(0, row), axis(1, row), axis(2, row)]).collect(),
        weights: read(WEIGHT)?,
        values: read(VALUE)?,
        columns: others,
        ..Points::default()
    };
    take_radii(path, &mut points, read(RADIUS)?)?;
    Ok(points)
}

/// A field of the elements of a structured array, or one of its numbers if it has several.
struct Field<'a> {
    name: &'a str,
    /// The type of the field, if it is a number.
    kind: Option<(Dtype, Endian)>,
    /// The position of the field in an element, in bytes.
    offset: usize,
}

fn structured(
    file: &OpenFile,
    header: &Header,
    options: &PointOptions,
) -> Result<Points, PointsError> {
    let path = file.path();
    let Some((fields, size)) = fields(&header.descr).filter(|(_, size)| *size > 0) else {
        let what = format!("has elements of the type {}], which is not understood", header.descr);
        return Err(format(
            path,
            Reason::unsupported(what, "save x, y and z as one array of floats"),
        ));
    };
    let count = header.shape.iter().fold(1u64, |product, &n| product.saturating_mul(n));
    let (needed, found) =
        (count.saturating_mul(size as u64), file.length().saturating_sub(header.length));
    if needed != found {
        let claim = format!("an array of shape {:?}, {size} bytes each", header.shape);
        return Err(format(path, Reason::Length { claim, needed, found, bound: "" }));
    }
    let names: Vec<&str> = fields.iter().map(|field| field.name).collect();
    let columns = match &options.columns {
        Some(columns) if columns.len() == fields.len() => columns.clone(),
        Some(columns) => return Err(format(path, wrong_width(fields.len(), columns.len()))),
        None => Columns::named(&names)
            .map_err(|error| format(path, Reason::content(error.to_string(), error.next)))?,
    };
    let mut bytes = Vec::new();
    let mut reader = file.reader_at(header.length)?;
    walpha_base::memory::try_reserve(&mut bytes, found as usize, || "an array of points".into())?;
    reader.read_to_end(&mut bytes).map_err(walpha_volume::io_error(path))?;
    points(path, count as usize, &columns, &options.attributes, |column| {
        let Field { name, kind, offset } = fields[column];
        let Some((dtype, endian)) = kind else {
            let what = format!("has a field {name} of a type that is not read");
            return Err(format(path, Reason::unsupported(what, "save it as f4 or f8")));
        };
        let elements = bytes.chunks_exact(size);
        let own: Vec<u8> =
            elements.flat_map(|element| &element[offset..offset + dtype.size()]).copied().collect();
        let mut numbers = vec![0.0; count as usize];
        f64::decode(&own, dtype, endian, &mut numbers);
        check_integers(path, dtype, &numbers)?;
        Ok(numbers)
    })
}

/// The fields of a structured type such as `[('x', '<f4'), ('normal', '<f4', (3,))`, and the size of an element in bytes.
fn fields(descr: &str) -> Option<(Vec<Field<'_>>, usize)> {
    let (mut fields, mut offset) = (Vec::new(), 0usize);
    let mut rest = descr.strip_prefix('[')?.trim();
    while !rest.is_empty() {
        let (name, behind) = quoted(rest.strip_prefix('(')?)?;
        let (kind, behind) = quoted(behind.trim_start().strip_prefix(',')?.trim_start())?;
        // A shape such as (3,) may follow.
        let (shape, behind) = behind.split_once(')')?;
        let shape = shape.trim_start_matches(',').trim_start();
        let (shape, behind) = match shape.strip_prefix('(') {
            Some(shape) => (shape, behind.trim_start().strip_prefix(')')?),
            None => (shape, behind),
        };
        let axes = shape.split(',').map(str::trim).filter(|axis| !axis.is_empty());
        let count = axes
            .map(|axis| axis.parse::<usize>().ok())
            .try_fold(1usize, |product, axis| product.checked_mul(axis?))?;
        let bytes = match kind.as_bytes() {
            [_, b'U', ..] => kind[2..].parse::<usize>().ok()?.checked_mul(4)?,
            [_, _, ..] => kind.get(2..)?.parse().ok()?,
            _ => return None,
        };
        if count > 1 << 10 || bytes > 1 << 20 {
            return None;
        }
        let place = count == 3 && AXES.iter().any(|known| known.eq_ignore_ascii_case(name));
        for k in 0..count {
            let name = if place {
                ["x", "y", "z"][k]
            } else if count > 1 {
                ""
            } else {
                name
            };
            let kind = npy_element(kind).map(|(dtype, endian, _)| (dtype, endian));
            fields.push(Field { name, kind, offset });
            offset += bytes;
        }
        rest = behind.trim_start_matches([' ', ',']);
    }
    Some((fields, offset))
}

/// The names of fields of three numbers that are x, y and z.
const AXES: [&str; 6] = ["xyz", "pos", "position", "points", "coordinates", "vertex"];

/// Separates a text in quotes from the text behind it.
fn quoted(text: &str) -> Option<(&str, &str)> {
    let quote = text.chars().next().filter(|quote| ['\'', '"'].contains(quote))?;
    text[1..].split_once(quote)
}
