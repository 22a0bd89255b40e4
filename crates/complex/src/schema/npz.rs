use std::io::{Read, Seek, SeekFrom};

use walpha_base::npy::Header;
use zip::ZipArchive;
use zip::read::ZipFile;

use super::{Classes, ComplexFile, SchemaError, numbers};
use crate::{Alpha, Class};

/// Deflate expands by no more than this factor (zlib's technical details), so a larger claim is false.
const MAX_EXPANSION: u64 = 1032;
/// Points and simplices differ from row to row, and deflate encodes a row that differs from all before
/// it with at least two bits: rows of up to 32 bytes expand at most 128-fold, and twice that is allowed.
const MAX_EXPANSION_OF_ROWS: u64 = 256;
/// Larger arrays of rows are held to [`MAX_EXPANSION_OF_ROWS`].
const SMALL: u64 = 16 << 20;

impl ComplexFile {
    /// Reads NPZ. Before any array is read, what the headers claim is compared with the size of
    /// the file and with each other.
    ///
    /// # Errors
    /// Missing, ill-shaped or unreadable arrays; numbers that cannot be indices or classes.
    pub fn read_npz(reader: impl Read + Seek) -> Result<Self, SchemaError> {
        let mut file = Npz::new(reader)?;
        file.check(&ARRAYS)?;
        let alpha = file.numbers("alpha")?.ok_or(SchemaError::Missing("alpha"))?[0];
        let alpha = self::alpha("alpha", alpha)?;
        let classes = Classes {
            cells: file.list("cell_classes", class)?,
            facets: file.list("facet_classes", class)?,
            edges: file.list("edge_classes", class)?,
            vertices: file.list("vertex_classes", class)?,
        };
        Ok(Self {
            weights: file.numbers("weights")?,
            cells: file.rows("cells", index)?,
            facets: file.rows("facets", index)?,
            edges: file.rows("edges", index)?,
            vertices: file.list("vertices", index)?,
            classes,
            hidden: file.list("hidden", index)?,
            duplicates: file.rows("duplicates", index)?,
            periodic: file.sides()?,
            ..Self::of_points(file.rows("points", |_, x| Ok(x))?.unwrap_or_default(), alpha)
        })
    }
}

/// The shape that an array must have.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Scalar,
    /// One number for each row of another array.
    Column(&'static str),
    /// Rows with this number of columns.
    Rows(u64),
}

const ARRAYS: [(&str, Kind); 14] = [
    ("points", Kind::Rows(3)),
    ("alpha", Kind::Scalar),
    ("periodic", Kind::Rows(1)),
    ("cells", Kind::Rows(4)),
    ("facets", Kind::Rows(3)),
    ("edges", Kind::Rows(2)),
    ("vertices", Kind::Rows(1)),
    ("hidden", Kind::Rows(1)),
    ("duplicates", Kind::Rows(2)),
    ("weights", Kind::Column("points")),
    ("cell_classes", Kind::Column("cells")),
    ("facet_classes", Kind::Column("facets")),
    ("edge_classes", Kind::Column("edges")),
    ("vertex_classes", Kind::Column("vertices")),
];

/// The arrays of a file, read as doubles, which represent every index and class exactly.
pub(super) struct Npz<R> {
    archive: ZipArchive<R>,
    /// Size of the file in bytes.
    length: u64,
}

impl<R: Read + Seek> Npz<R> {
    pub(super) fn new(mut reader: R) -> Result<Self, SchemaError> {
        let damaged = |error: &dyn std::fmt::Display| SchemaError::Zip(error.to_string());
        let length = reader.seek(SeekFrom::End(0)).map_err(|error| damaged(&error))?;
        let archive = ZipArchive::new(reader).map_err(|error| damaged(&error))?;
        Ok(Self { archive, length })
    }

    /// Checks all headers: shapes, lengths that must be equal, and sizes beyond what the file can contain.
    pub(super) fn check(&mut self, arrays: &[(&'static str, Kind)]) -> Result<(), SchemaError> {
        let mut counts = Vec::new();
        for &(name, kind) in arrays {
            let Some(rows) = self.check_one(name, kind)? else { continue };
            if let Kind::Column(of) = kind {
                let expected = counts.iter().find(|(other, _)| *other == of);
                let expected = expected.map_or(0, |&(_, rows)| rows);
                if rows != expected {
                    let [got, expected] = [rows, expected].map(|rows| rows as usize);
                    return Err(SchemaError::Lengths { name, got, expected, of });
                }
            }
            counts.push((name, rows));
        }
        Ok(())
    }

    /// The number of rows that an array claims.
    fn check_one(&mut self, name: &'static str, kind: Kind) -> Result<Option<u64>, SchemaError> {
        let length = self.length;
        let Some(member) = self.member(name)? else { return Ok(None) };
        let (size, packed) = (member.size(), member.compressed_size().min(length));
        let most = match kind {
            Kind::Rows(_) if size > SMALL => MAX_EXPANSION_OF_ROWS,
            _ => MAX_EXPANSION,
        };
        if size > packed.saturating_mul(most).saturating_add(most) {
            return Err(SchemaError::Array {
                name,
                got: format!("{size} bytes in {packed} of the file"),
                expected: format!(
                    "no more than {most} times as many, as of an array that does not repeat itself"
                ),
            });
        }
        let Array { header, .. } = Array::open(name, member)?;
        let shape = header.shape;
        let wrong = |expected: String| {
            Err(SchemaError::Array { name, got: format!("shape {shape:?}"), expected })
        };
        let rows = match (kind, &shape[..]) {
            (Kind::Scalar, []) => 1,
            (Kind::Scalar, _) => return wrong("a scalar".into()),
            (Kind::Column(_) | Kind::Rows(1), &[rows]) => rows,
            (Kind::Column(_) | Kind::Rows(1), _) => return wrong("one dimension".into()),
            (Kind::Rows(columns), &[rows, given]) if given == columns => rows,
            // NumPy turns an empty list of rows into a flat array.
            (Kind::Rows(_), _) if shape.contains(&0) => 0,
            (Kind::Rows(columns), _) => return wrong(format!("shape [m, {columns}]")),
        };
        Ok(Some(rows))
    }

    /// The array of this name.
    pub(super) fn member(&mut self, name: &str) -> Result<Option<ZipFile<'_, R>>, SchemaError> {
        let is_it = |entry: &str| entry.strip_suffix(".npy").unwrap_or(entry) == name;
        let at = self.archive.file_names().position(is_it);
        let found = at.map(|at| self.archive.by_index(at)).transpose();
        found.map_err(|error| SchemaError::Zip(format!("{name}: {error}")))
    }

    /// All numbers of an array, row by row.
    pub(super) fn numbers(&mut self, name: &'static str) -> Result<Option<Vec<f64>>, SchemaError> {
        let Some(member) = self.member(name)? else { return Ok(None) };
        let Array { header, mut member } = Array::open(name, member)?;
        let columns = match header.shape[..] {
            [rows, columns] if header.fortran && rows > 0 => {
                Some((rows as usize, columns as usize))
            }
            _ => None,
        };
        let bytes = member.size().saturating_sub(header.length);
        let numbers = numbers::read(name, &header, &mut member, bytes)?;
        Ok(Some(match columns {
            None => numbers,
            Some((rows, columns)) => {
                let at = |i: usize| numbers[i % columns * rows + i / columns];
                (0..rows * columns).map(at).collect()
            }
        }))
    }

    /// The sides of the periodic box, if there is one.
    pub(super) fn sides(&mut self) -> Result<Option<[f64; 3]>, SchemaError> {
        let Some(sides) = self.numbers("periodic")? else { return Ok(None) };
        let count = sides.len();
        sides.try_into().map(Some).map_err(|_| SchemaError::Array {
            name: "periodic",
            got: format!("{count} numbers"),
            expected: "three sides".into(),
        })
    }

    pub(super) fn list<T>(
        &mut self,
        name: &'static str,
        convert: impl Fn(&'static str, f64) -> Result<T, SchemaError>,
    ) -> Result<Option<Vec<T>>, SchemaError> {
        let Some(numbers) = self.numbers(name)? else { return Ok(None) };
        numbers.into_iter().map(|x| convert(name, x)).collect::<Result<_, _>>().map(Some)
    }

    pub(super) fn rows<T: Copy + Default, const N: usize>(
        &mut self,
        name: &'static str,
        convert: impl Fn(&'static str, f64) -> Result<T, SchemaError>,
    ) -> Result<Option<Vec<[T; N]>>, SchemaError> {
        let Some(numbers) = self.numbers(name)? else { return Ok(None) };
        let (rows, _) = numbers.as_chunks::<N>();
        let row = |row: &[f64; N]| {
            let mut out = [T::default(); N];
            for (slot, &x) in out.iter_mut().zip(row) {
                *slot = convert(name, x)?;
            }
            Ok(out)
        };
        rows.iter().map(row).collect::<Result<_, _>>().map(Some)
    }
}

/// An array of the archive, positioned at its first element.
struct Array<'a, R: Read> {
    header: Header,
    member: ZipFile<'a, R>,
}

impl<'a, R: Read> Array<'a, R> {
    fn open(name: &'static str, mut member: ZipFile<'a, R>) -> Result<Self, SchemaError> {
        let header =
            Header::read(&mut member).map_err(|error| SchemaError::Npy { name, source: error })?;
        Ok(Self { header, member })
    }
}

pub(super) fn index(name: &'static str, value: f64) -> Result<u32, SchemaError> {
    if value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value) {
        Ok(value as u32)
    } else {
        let value = value.to_string();
        Err(SchemaError::Value { name, value, expected: "a point number" })
    }
}

pub(super) fn alpha(name: &'static str, value: f64) -> Result<Alpha, SchemaError> {
    Alpha::from_squared(value).map_err(|_| SchemaError::Value {
        name,
        value: value.to_string(),
        expected: "a squared length",
    })
}

fn class(name: &'static str, value: f64) -> Result<Class, SchemaError> {
    let number = index(name, value)?;
    u8::try_from(number).ok().and_then(Class::from_number).ok_or_else(|| SchemaError::Value {
        name,
        value: number.to_string(),
        expected: "a class (0 exterior, 1 interior, 2 regular, 3 singular)",
    })
}
