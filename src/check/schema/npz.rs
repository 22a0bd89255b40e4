use std::io::{Read, Seek};

use ndarray::{ArrayD, Axis, Ix0, Ix1, Ix2};
use ndarray_npy::{NpzReader, ReadNpzError, ReadableElement};

use super::{Classes, ComplexFile, SchemaError};
use crate::shape::Class;

impl ComplexFile {
    /// Reads NPZ.
    ///
    /// # Errors
    /// Missing, ill-shaped or unreadable arrays; numbers that are no indices or classes.
    pub fn read_npz(reader: impl Read + Seek) -> Result<Self, SchemaError> {
        let mut file = Npz::new(reader)?;
        let points = file.rows("points", Ok)?.unwrap_or_default();
        let alpha = file.array("alpha")?.ok_or(SchemaError::Missing("alpha"))?;
        let alpha = alpha.into_dimensionality::<Ix0>().map_err(|_| SchemaError::Array {
            name: "alpha",
            got: "more than one number".into(),
            expected: "a scalar".into(),
        })?;
        let classes = Classes {
            cells: file.list("cell_classes", class)?,
            facets: file.list("facet_classes", class)?,
            edges: file.list("edge_classes", class)?,
            vertices: file.list("vertex_classes", class)?,
        };
        Ok(Self {
            points,
            weights: file.list("weights", |_, weight| Ok(weight))?,
            alpha: alpha.into_scalar(),
            cells: file.rows("cells", index_in("cells"))?,
            facets: file.rows("facets", index_in("facets"))?,
            edges: file.rows("edges", index_in("edges"))?,
            vertices: file.list("vertices", index)?,
            classes,
            hidden: file.list("hidden", index)?,
            duplicates: file.rows("duplicates", index_in("duplicates"))?,
            info: None,
        })
    }
}

/// The arrays of a file, read as doubles: they hold every index and class exactly.
struct Npz<R: Read + Seek> {
    reader: NpzReader<R>,
    names: Vec<String>,
}

impl<R: Read + Seek> Npz<R> {
    fn new(reader: R) -> Result<Self, SchemaError> {
        let mut reader = NpzReader::new(reader)?;
        let names = reader.names()?;
        Ok(Self { reader, names })
    }

    fn array(&mut self, name: &'static str) -> Result<Option<ArrayD<f64>>, SchemaError> {
        if !self.names.iter().any(|n| n == name || n.strip_suffix(".npy") == Some(name)) {
            return Ok(None);
        }
        let found = self
            .try_as(name, |x: f64| x)
            .or_else(|| self.try_as(name, |x: i64| x as f64))
            .or_else(|| self.try_as(name, |x: u32| x.into()))
            .or_else(|| self.try_as(name, |x: i32| x.into()))
            .or_else(|| self.try_as(name, |x: u64| x as f64))
            .or_else(|| self.try_as(name, |x: f32| x.into()))
            .or_else(|| self.try_as(name, |x: u8| x.into()))
            .or_else(|| self.try_as(name, |x: i8| x.into()));
        match found {
            Some(array) => Ok(Some(array?)),
            None => Err(SchemaError::Array {
                name,
                got: "another type of element".into(),
                expected: "float32, float64, int8, int32, int64, uint8, uint32 or uint64".into(),
            }),
        }
    }

    /// None if the elements are of another type.
    fn try_as<T: ReadableElement + Clone>(
        &mut self,
        name: &str,
        convert: impl Fn(T) -> f64,
    ) -> Option<Result<ArrayD<f64>, ReadNpzError>> {
        use ndarray_npy::ReadNpyError::WrongDescriptor;
        let found = self.reader.by_name::<ndarray::OwnedRepr<T>, ndarray::IxDyn>(name);
        match found {
            Err(ReadNpzError::Npy(WrongDescriptor(_))) => None,
            other => Some(other.map(|array| array.mapv(convert))),
        }
    }

    fn list<T>(
        &mut self,
        name: &'static str,
        convert: impl Fn(&'static str, f64) -> Result<T, SchemaError>,
    ) -> Result<Option<Vec<T>>, SchemaError> {
        let Some(array) = self.array(name)? else { return Ok(None) };
        let got = format!("shape {:?}", array.shape());
        let list = array.into_dimensionality::<Ix1>().map_err(|_| SchemaError::Array {
            name,
            got,
            expected: "one dimension".into(),
        })?;
        list.into_iter().map(|x| convert(name, x)).collect::<Result<_, _>>().map(Some)
    }

    fn rows<T: Copy + Default, const N: usize>(
        &mut self,
        name: &'static str,
        convert: impl Fn(f64) -> Result<T, SchemaError>,
    ) -> Result<Option<Vec<[T; N]>>, SchemaError> {
        let Some(array) = self.array(name)? else { return Ok(None) };
        let got = format!("shape {:?}", array.shape());
        let empty = array.is_empty();
        let wrong = || SchemaError::Array { name, got, expected: format!("shape [m, {N}]") };
        match array.into_dimensionality::<Ix2>() {
            // NumPy makes a flat array of an empty list of rows.
            Err(_) if empty => Ok(Some(Vec::new())),
            Ok(table) if table.ncols() == N => {
                let row = |row: ndarray::ArrayView1<f64>| {
                    let mut out = [T::default(); N];
                    for (slot, &x) in out.iter_mut().zip(row) {
                        *slot = convert(x)?;
                    }
                    Ok(out)
                };
                table.axis_iter(Axis(0)).map(row).collect::<Result<_, _>>().map(Some)
            }
            _ => Err(wrong()),
        }
    }
}

fn index_in(name: &'static str) -> impl Fn(f64) -> Result<u32, SchemaError> {
    move |value| index(name, value)
}

fn index(name: &'static str, value: f64) -> Result<u32, SchemaError> {
    if value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value) {
        Ok(value as u32)
    } else {
        let value = value.to_string();
        Err(SchemaError::Value { name, value, expected: "point number" })
    }
}

fn class(name: &'static str, value: f64) -> Result<Class, SchemaError> {
    let number = index(name, value)? as usize;
    Class::ALL.get(number).copied().ok_or_else(|| SchemaError::Value {
        name,
        value: number.to_string(),
        expected: "class (0 exterior, 1 interior, 2 regular, 3 singular)",
    })
}
