//! Complexes and filtrations in NPZ, the archives of arrays that `NumPy` writes.

use std::io::{Read, Seek, SeekFrom};

use walpha_base::foreign::decode;
use walpha_base::memory::asking;
use walpha_base::npy::Header;
use walpha_base::parallel::prelude::*;
use zip::ZipArchive;
use zip::read::ZipFile;

use super::{
    Below, BoxVectors, Classes, ComplexFile, FiltrationFile, PairsFile, SchemaError, Values,
};
use crate::{Alpha, Class, Voxels};

/// Deflate expands at most by this factor (zlib's technical details), so a larger claim is false.
const MAX_EXPANSION: u64 = 1032;
/// Points and simplices differ from row to row, and deflate encodes a row that differs from all earlier ones with at least two
/// bits: rows of up to 32 bytes expand at most 128-fold, and twice that is allowed.
const MAX_EXPANSION_OF_ROWS: u64 = 256;
/// Larger arrays of rows are held to [`MAX_EXPANSION_OF_ROWS`].
const SMALL: u64 = 16 << 20;

impl ComplexFile {
    /// Reads NPZ. Before any array is read, the claims of the headers are compared with the size of the file and with each other.
    ///
    /// # Errors
    /// Missing, ill-shaped or unreadable arrays; numbers that cannot be indices or classes.
    pub fn read_npz(mut reader: impl Read + Seek) -> Result<Self, SchemaError> {
        unpacked(|| Self::of_archive(Npz::new(&mut reader)?))
    }

    fn of_archive(mut file: Npz) -> Result<Self, SchemaError> {
        file.check(&COMPLEX_ARRAYS)?;
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
            periodic: file.box_vectors()?,
            copies: file.rows("copies", integer)?,
            voxels: file.voxels()?,
            isovalue: file.numbers("isovalue")?.map(|value| value[0]),
            ..Self::of_points(file.rows("points", |_, x| Ok(x))?.unwrap_or_default(), alpha)
        })
    }
}

/// Calls a reader of archives. A panic in it, in a decoder of another crate, becomes an error of the file.
fn unpacked<T>(read: impl FnOnce() -> Result<T, SchemaError>) -> Result<T, SchemaError> {
    decode(read).unwrap_or_else(|panicked| Err(SchemaError::Zip(panicked.to_string())))
}

/// The names of the arrays in NPZ; none if it cannot be read.
pub(super) fn names(mut reader: impl Read + Seek) -> Vec<String> {
    let Ok(Npz { archive, .. }) = Npz::new(&mut reader) else { return Vec::new() };
    let name = |entry: &str| entry.strip_suffix(".npy").unwrap_or(entry).to_owned();
    archive.file_names().map(name).collect()
}

/// Reads a complex whose points and cells have these names.
pub(super) fn read_named(
    mut reader: impl Read + Seek,
    [points, cells]: [&'static str; 2],
) -> Result<ComplexFile, SchemaError> {
    unpacked(|| named(Npz::new(&mut reader)?, [points, cells]))
}

fn named(mut file: Npz, [points, cells]: [&'static str; 2]) -> Result<ComplexFile, SchemaError> {
    file.check(&[
        (points, Kind::Rows(3)),
        (cells, Kind::Rows(4)),
        ("weights", Kind::Column(points)),
        ("alpha", Kind::Scalar),
    ])?;
    let stated = file.numbers("alpha")?.map(|alpha| self::alpha("alpha", alpha[0])).transpose()?;
    let positions = file.rows(points, |_, x| Ok(x))?.unwrap_or_default();
    Ok(ComplexFile {
        cells: file.rows(cells, index)?,
        weights: file.numbers("weights")?,
        ..ComplexFile::of_points(positions, stated.unwrap_or(Alpha::INFINITE))
    })
}

/// Reads NPY with one axis; `name` describes its content.
///
/// # Errors
/// A damaged or truncated file, another shape, and elements that are not numbers.
pub fn read_npy(name: &'static str, mut bytes: &[u8]) -> Result<Vec<f64>, SchemaError> {
    let header =
        Header::read(&mut bytes).map_err(|error| SchemaError::Npy { name, source: error })?;
    if header.shape.len() != 1 {
        let (got, expected) = (format!("shape {:?}", header.shape), "one dimension".into());
        return Err(SchemaError::Array { name, got, expected });
    }
    let length = bytes.len() as u64;
    decoded(name, &header, &mut bytes, length, |[x]: [f64; 1]| Ok(x))
}

/// The shape that an array must have.
#[derive(Clone, Copy)]
enum Kind {
    Scalar,
    /// One number for each row of another array.
    Column(&'static str),
    /// Rows with this number of columns.
    Rows(u64),
    /// Three sides, or three rows of three.
    Box,
}

const COMPLEX_ARRAYS: [(&str, Kind); 18] = [
    ("points", Kind::Rows(3)),
    ("alpha", Kind::Scalar),
    ("isovalue", Kind::Scalar),
    ("periodic", Kind::Box),
    ("copies", Kind::Rows(4)),
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
    ("voxel_runs", Kind::Rows(2)),
    ("voxel_grid", Kind::Rows(3)),
];

/// Reads a file, of any type: an archive of each type would be compiled anew.
type Reader<'r> = &'r mut (dyn ReadSeek + 'r);

trait ReadSeek: Read + Seek {}

impl<R: Read + Seek> ReadSeek for R {}

/// The arrays of a file, whose elements are read as doubles, which represent every index and class exactly.
struct Npz<'r> {
    archive: ZipArchive<Reader<'r>>,
    /// Size of the file in bytes.
    length: u64,
}

impl<'r> Npz<'r> {
    fn new(reader: Reader<'r>) -> Result<Self, SchemaError> {
        let damaged = |error: &dyn std::fmt::Display| SchemaError::Zip(error.to_string());
        let length = reader.seek(SeekFrom::End(0)).map_err(|error| damaged(&error))?;
        let archive = ZipArchive::new(reader).map_err(|error| damaged(&error))?;
        Ok(Self { archive, length })
    }

    /// Checks all headers: shapes, lengths that must be equal, and sizes beyond what the file can contain.
    fn check(&mut self, arrays: &[(&'static str, Kind)]) -> Result<(), SchemaError> {
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
            (Kind::Box, &[3] | &[3, 3]) => 3,
            (Kind::Box, _) => return wrong("shape [3] or [3, 3]".into()),
        };
        Ok(Some(rows))
    }

    /// The array of this name.
    fn member(&mut self, name: &str) -> Result<Option<ZipFile<'_, Reader<'r>>>, SchemaError> {
        let is_it = |entry: &str| entry.strip_suffix(".npy").unwrap_or(entry) == name;
        let at = self.archive.file_names().position(is_it);
        let found = at.map(|at| self.archive.by_index(at)).transpose();
        found.map_err(|error| SchemaError::Zip(format!("{name}: {error}")))
    }

    /// All numbers of an array, row by row.
    fn numbers(&mut self, name: &'static str) -> Result<Option<Vec<f64>>, SchemaError> {
        self.list(name, |_, x| Ok(x))
    }

    /// All elements of an array, row by row, converted from numbers.
    fn list<T: Copy + Send>(
        &mut self,
        name: &'static str,
        convert: impl Fn(&'static str, f64) -> Result<T, SchemaError> + Sync,
    ) -> Result<Option<Vec<T>>, SchemaError> {
        let Some(member) = self.member(name)? else { return Ok(None) };
        let mut array = Array::open(name, member)?;
        let elements = array.rows(name, |[x]: [f64; 1]| convert(name, x))?;
        Ok(Some(match array.header.shape[..] {
            [rows, columns] if array.header.fortran => {
                let (rows, columns) = (rows as usize, columns as usize);
                let at = |i: usize| elements[i % columns * rows + i / columns];
                (0..rows * columns).map(at).collect()
            }
            _ => elements,
        }))
    }

    /// The vectors of the periodic box, if there is one.
    fn box_vectors(&mut self) -> Result<Option<BoxVectors>, SchemaError> {
        let Some(numbers) = self.numbers("periodic")? else { return Ok(None) };
        let vectors = BoxVectors::of_numbers(&numbers);
        vectors.map(Some).ok_or_else(|| SchemaError::Array {
            name: "periodic",
            got: format!("{} numbers", numbers.len()),
            expected: "three sides, or three vectors as rows".into(),
        })
    }

    /// The voxels that the cells fill, if the complex is of labels.
    fn voxels(&mut self) -> Result<Option<Voxels>, SchemaError> {
        let Some(runs) = self.rows("voxel_runs", whole)? else { return Ok(None) };
        let grid = self.rows("voxel_grid", |_, x| Ok(x))?;
        let grid = grid.ok_or(SchemaError::Missing("voxel_grid"))?;
        let [dims, origin, a, b, c] = grid[..] else {
            return Err(SchemaError::Array {
                name: "voxel_grid",
                got: format!("{} rows", grid.len()),
                expected: "five: dims, origin and three axes".into(),
            });
        };
        let [x, y, z] = dims.map(|n| index("voxel_grid", n));
        Ok(Some(Voxels { dims: [x?, y?, z?], origin, axes: [a, b, c], runs }))
    }

    fn rows<T: Copy + Send, const N: usize>(
        &mut self,
        name: &'static str,
        convert: impl Fn(&'static str, f64) -> Result<T, SchemaError> + Sync,
    ) -> Result<Option<Vec<[T; N]>>, SchemaError> {
        let Some(member) = self.member(name)? else { return Ok(None) };
        let mut array = Array::open(name, member)?;
        if array.header.fortran {
            drop(array);
            let elements = self.list(name, convert)?;
            return Ok(elements.map(|elements| elements.as_chunks::<N>().0.to_vec()));
        }
        let row = |numbers: [f64; N]| {
            let mut row = [convert(name, numbers[0])?; N];
            for (element, number) in row.iter_mut().zip(numbers).skip(1) {
                *element = convert(name, number)?;
            }
            Ok(row)
        };
        array.rows(name, row).map(Some)
    }
}

/// An array of the archive, positioned at its first element.
struct Array<'a, 'r> {
    header: Header,
    member: ZipFile<'a, Reader<'r>>,
}

impl<'a, 'r> Array<'a, 'r> {
    fn open(name: &'static str, mut member: ZipFile<'a, Reader<'r>>) -> Result<Self, SchemaError> {
        let header =
            Header::read(&mut member).map_err(|error| SchemaError::Npy { name, source: error })?;
        Ok(Self { header, member })
    }

    /// All rows of `N` elements in the order of the file, converted from numbers.
    fn rows<T: Send, const N: usize>(
        &mut self,
        name: &'static str,
        convert: impl Fn([f64; N]) -> Result<T, SchemaError> + Sync,
    ) -> Result<Vec<T>, SchemaError> {
        let bytes = self.member.size().saturating_sub(self.header.length);
        decoded(name, &self.header, &mut self.member, bytes, convert)
    }
}

#[inline]
fn index(name: &'static str, value: f64) -> Result<u32, SchemaError> {
    // The conversion saturates, and takes NaN to 0.
    let number = value as u32;
    if f64::from(number) == value {
        Ok(number)
    } else {
        Err(unexpected(name, value, "a point number"))
    }
}

fn integer(name: &'static str, value: f64) -> Result<i32, SchemaError> {
    let number = value as i32;
    if f64::from(number) == value {
        Ok(number)
    } else {
        Err(unexpected(name, value, "a point number, or a multiple of a vector"))
    }
}

fn whole(name: &'static str, value: f64) -> Result<u64, SchemaError> {
    let number = value as u64;
    if number as f64 == value {
        Ok(number)
    } else {
        Err(unexpected(name, value, "a number of a voxel"))
    }
}

#[cold]
fn unexpected(name: &'static str, value: f64, expected: &'static str) -> SchemaError {
    SchemaError::Value { name, value: value.to_string(), expected }
}

fn alpha(name: &'static str, value: f64) -> Result<Alpha, SchemaError> {
    Alpha::from_squared(value).map_err(|_| unexpected(name, value, "a squared length"))
}

#[inline]
fn class(name: &'static str, value: f64) -> Result<Class, SchemaError> {
    let class = Class::from_number(value as u8).filter(|_| f64::from(value as u8) == value);
    let expected = "a class (0 exterior, 1 interior, 2 regular, 3 singular)";
    class.ok_or_else(|| unexpected(name, value, expected))
}

const FILTRATION_ARRAYS: [(&str, Kind); 31] = [
    ("points", Kind::Rows(3)),
    ("weights", Kind::Column("points")),
    ("vertices", Kind::Rows(1)),
    ("edges", Kind::Rows(2)),
    ("facets", Kind::Rows(3)),
    ("cells", Kind::Rows(4)),
    ("vertex_values", Kind::Column("vertices")),
    ("edge_values", Kind::Column("edges")),
    ("facet_values", Kind::Column("facets")),
    ("cell_values", Kind::Column("cells")),
    ("vertex_gabriel", Kind::Column("vertices")),
    ("edge_gabriel", Kind::Column("edges")),
    ("facet_gabriel", Kind::Column("facets")),
    ("vertex_regular", Kind::Column("vertices")),
    ("edge_regular", Kind::Column("edges")),
    ("facet_regular", Kind::Column("facets")),
    ("vertex_interior", Kind::Column("vertices")),
    ("edge_interior", Kind::Column("edges")),
    ("facet_interior", Kind::Column("facets")),
    ("order", Kind::Rows(1)),
    ("component_pairs", Kind::Rows(2)),
    ("lasting_components", Kind::Rows(1)),
    ("loop_pairs", Kind::Rows(2)),
    ("lasting_loops", Kind::Rows(1)),
    ("void_pairs", Kind::Rows(2)),
    ("lasting_voids", Kind::Rows(1)),
    ("last_cell", Kind::Rows(1)),
    ("periodic", Kind::Box),
    ("copies", Kind::Rows(4)),
    ("hidden", Kind::Rows(1)),
    ("duplicates", Kind::Rows(2)),
];

/// The names of the arrays of vertices, edges and facets.
struct ArrayNames([&'static str; 3]);

impl FiltrationFile {
    /// Whether NPZ contains a filtration: it has an array `order`.
    pub(super) fn is_npz(mut reader: impl Read + Seek) -> bool {
        Npz::new(&mut reader).is_ok_and(|mut file| matches!(file.member("order"), Ok(Some(_))))
    }

    /// Reads NPZ. Before any array is read, the claims of the headers are compared with the size of the file and with each other.
    ///
    /// # Errors
    /// Missing, ill-shaped or unreadable arrays; numbers that cannot be indices or values.
    pub fn read_npz(mut reader: impl Read + Seek) -> Result<Self, SchemaError> {
        unpacked(|| Self::of_archive(Npz::new(&mut reader)?))
    }

    fn of_archive(mut file: Npz) -> Result<Self, SchemaError> {
        file.check(&FILTRATION_ARRAYS)?;
        let components = file.rows("component_pairs", index)?;
        let lasting = file.list("lasting_components", index)?;
        let loops = file.rows("loop_pairs", index)?;
        let lasting_loops = file.list("lasting_loops", index)?.unwrap_or_default();
        let voids = file.rows("void_pairs", index)?;
        let pairs = components.zip(lasting).zip(voids);
        let lasting_voids = file.list("lasting_voids", index)?.unwrap_or_default();
        let last = file.list("last_cell", index)?.unwrap_or_default().first().copied();
        let pairs = pairs.map(|((components, lasting), voids)| PairsFile {
            components,
            lasting,
            loops,
            lasting_loops,
            voids,
            lasting_voids,
            last,
        });
        let values = ArrayNames(["vertex_values", "edge_values", "facet_values"]);
        let values =
            below(&mut file, values, alpha)?.ok_or(SchemaError::Missing("vertex_values"))?;
        let Below { vertices, edges, facets } = values;
        let cells = required(&mut file, "cell_values", alpha)?;
        Ok(Self {
            points: file.rows("points", |_, x| Ok(x))?.unwrap_or_default(),
            weights: file.numbers("weights")?,
            vertices: required(&mut file, "vertices", index)?,
            edges: file.rows("edges", index)?.ok_or(SchemaError::Missing("edges"))?,
            facets: file.rows("facets", index)?.ok_or(SchemaError::Missing("facets"))?,
            cells: file.rows("cells", index)?.ok_or(SchemaError::Missing("cells"))?,
            values: Values { vertices, edges, facets, cells },
            gabriel: below(
                &mut file,
                ArrayNames(["vertex_gabriel", "edge_gabriel", "facet_gabriel"]),
                truth,
            )?,
            regular: below(
                &mut file,
                ArrayNames(["vertex_regular", "edge_regular", "facet_regular"]),
                alpha,
            )?,
            interior: below(
                &mut file,
                ArrayNames(["vertex_interior", "edge_interior", "facet_interior"]),
                alpha,
            )?,
            order: required(&mut file, "order", index)?,
            pairs,
            hidden: file.list("hidden", index)?,
            duplicates: file.rows("duplicates", index)?,
            periodic: file.box_vectors()?,
            copies: file.rows("copies", integer)?,
            #[cfg(feature = "json")]
            info: None,
        })
    }
}

type Convert<T> = fn(&'static str, f64) -> Result<T, SchemaError>;

/// Three arrays; `None` if the first is missing, and an error if only others are.
fn below<T: Copy + Send>(
    file: &mut Npz,
    ArrayNames([vertices, edges, facets]): ArrayNames,
    convert: Convert<T>,
) -> Result<Option<Below<T>>, SchemaError> {
    let Some(of_vertices) = file.list(vertices, convert)? else { return Ok(None) };
    let (edges, facets) = (required(file, edges, convert)?, required(file, facets, convert)?);
    Ok(Some(Below { vertices: of_vertices, edges, facets }))
}

fn required<T: Copy + Send>(
    file: &mut Npz,
    name: &'static str,
    convert: Convert<T>,
) -> Result<Vec<T>, SchemaError> {
    file.list(name, convert)?.ok_or(SchemaError::Missing(name))
}

fn truth(name: &'static str, value: f64) -> Result<bool, SchemaError> {
    match value {
        0.0 => Ok(false),
        1.0 => Ok(true),
        _ => Err(unexpected(name, value, "0 or 1")),
    }
}

/// Bytes read at a time, so that the array and its numbers are never both completely in memory. A multiple of the size of a
/// row of up to four elements of any type.
const CHUNK_BYTES: usize = 24 << 18;
/// Rows that one thread decodes at a time.
const BATCH: usize = 1 << 12;

/// All rows of `N` elements of an array in the order of the file, converted from numbers. The reader is positioned after the
/// header; `bytes` more bytes follow, which must match the header exactly.
fn decoded<T: Send, const N: usize>(
    name: &'static str,
    header: &Header,
    reader: &mut dyn Read,
    bytes: u64,
    convert: impl Fn([f64; N]) -> Result<T, SchemaError> + Sync,
) -> Result<Vec<T>, SchemaError> {
    let elements = Elements::new(name, header, bytes)?;
    let count = elements.count() / N as u64;
    let mut rows = Vec::<T>::new();
    asking(|| rows.try_reserve_exact(usize::try_from(count).unwrap_or(usize::MAX))).map_err(
        |_| {
            let bytes = u128::from(count) * size_of::<T>() as u128;
            SchemaError::Memory { name, bytes }
        },
    )?;
    let batch = |bytes: &[u8]| -> Result<Vec<T>, SchemaError> {
        let numbers = elements.numbers(bytes);
        let mut rows = Vec::with_capacity(numbers.len() / N);
        for row in numbers.as_chunks::<N>().0 {
            rows.push(convert(*row)?);
        }
        Ok(rows)
    };
    elements.read(reader, &mut |chunk| {
        let batches = chunk.par_chunks(N * elements.size * BATCH).map(batch);
        for batch in batches.collect::<Vec<_>>() {
            rows.extend(batch?);
        }
        Ok(())
    })?;
    Ok(rows)
}

/// The elements of an array in a file.
struct Elements<'a> {
    name: &'static str,
    header: &'a Header,
    /// Size of an element in bytes.
    size: usize,
    decode: Decode,
}

impl<'a> Elements<'a> {
    /// The elements of a header that `bytes` bytes follow.
    fn new(name: &'static str, header: &'a Header, bytes: u64) -> Result<Self, SchemaError> {
        let Some((size, decode)) = element(&header.descr) else {
            let got = format!("elements of type {}", header.descr);
            let expected = "bool, an integer of 8 to 64 bits, f4 or f8; save a.astype('f8')".into();
            return Err(SchemaError::Array { name, got, expected });
        };
        let elements = Self { name, header, size, decode };
        if bytes == elements.bytes() {
            Ok(elements)
        } else {
            Err(elements.wrong(format!("{bytes} bytes of elements")))
        }
    }

    fn count(&self) -> u64 {
        self.header.shape.iter().fold(1, |product, &n| product.saturating_mul(n))
    }

    fn bytes(&self) -> u64 {
        self.count().saturating_mul(self.size as u64)
    }

    fn wrong(&self, got: String) -> SchemaError {
        let Header { shape, descr, .. } = self.header;
        let expected = format!("{} for shape {shape:?} of type {descr}", self.bytes());
        SchemaError::Array { name: self.name, got, expected }
    }

    fn numbers(&self, bytes: &[u8]) -> Vec<f64> {
        let mut numbers = Vec::with_capacity(bytes.len() / self.size);
        (self.decode)(bytes, &mut numbers);
        numbers
    }

    /// Reads all elements in chunks, each of which is given to `add` while the next one is read.
    fn read(
        &self,
        reader: &mut dyn Read,
        add: &mut (dyn FnMut(&[u8]) -> Result<(), SchemaError> + Send),
    ) -> Result<(), SchemaError> {
        let damaged = |error| SchemaError::Zip(format!("{}: {error}", self.name));
        let mut left = self.bytes();
        let mut read = |into: &mut Vec<u8>| {
            into.resize(left.min(CHUNK_BYTES as u64) as usize, 0);
            left -= into.len() as u64;
            reader.read_exact(into).map_err(damaged)
        };
        let (mut chunk, mut next) = (Vec::new(), Vec::new());
        read(&mut chunk)?;
        // Damage of the archive is only known at the end, and takes precedence.
        let mut added = Ok(());
        while !chunk.is_empty() {
            rayon::in_place_scope(|scope| {
                if added.is_ok() {
                    scope.spawn(|_| added = add(&chunk));
                }
                read(&mut next)
            })?;
            std::mem::swap(&mut chunk, &mut next);
        }
        // The archive verifies its checksum when a member is read to its end.
        match reader.read(&mut [0]).map_err(damaged)? {
            0 => added,
            _ => Err(self.wrong("more bytes than its archive claims".into())),
        }
    }
}

/// Converts the bytes of elements to doubles, which it appends.
type Decode = fn(&[u8], &mut Vec<f64>);

/// The size of an element in bytes and the conversion to doubles, for a `NumPy` type such as `<f4`.
/// Integers beyond 2⁵³ are rounded; no point number is that large.
#[expect(clippy::cast_lossless, reason = "one rule for all types, of which two are lossy")]
fn element(descr: &str) -> Option<(usize, Decode)> {
    macro_rules! number {
        ($kind:ty, $from:ident) => {
            Some((size_of::<$kind>(), |bytes, numbers| {
                let elements = bytes.as_chunks::<{ size_of::<$kind>() }>().0;
                numbers.extend(elements.iter().map(|&element| <$kind>::$from(element) as f64));
            }))
        };
    }
    let (order, kind) = descr.split_at_checked(1)?;
    match (order, kind) {
        ("<" | ">" | "|", "b1" | "u1") => number!(u8, from_le_bytes),
        ("<" | ">" | "|", "i1") => number!(i8, from_le_bytes),
        ("<", "u2") => number!(u16, from_le_bytes),
        (">", "u2") => number!(u16, from_be_bytes),
        ("<", "i2") => number!(i16, from_le_bytes),
        (">", "i2") => number!(i16, from_be_bytes),
        ("<", "u4") => number!(u32, from_le_bytes),
        (">", "u4") => number!(u32, from_be_bytes),
        ("<", "i4") => number!(i32, from_le_bytes),
        (">", "i4") => number!(i32, from_be_bytes),
        ("<", "u8") => number!(u64, from_le_bytes),
        (">", "u8") => number!(u64, from_be_bytes),
        ("<", "i8") => number!(i64, from_le_bytes),
        (">", "i8") => number!(i64, from_be_bytes),
        ("<", "f4") => number!(f32, from_le_bytes),
        (">", "f4") => number!(f32, from_be_bytes),
        ("<", "f8") => number!(f64, from_le_bytes),
        (">", "f8") => number!(f64, from_be_bytes),
        _ => None,
    }
}
