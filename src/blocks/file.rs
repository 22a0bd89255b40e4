//! The files of blocks: a header in JSON, then arrays of little-endian numbers.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{BlocksError, Facts, Plan};
use crate::export::Target;

/// How a file of a block begins.
const MAGIC: &[u8; 16] = b"walpha block 1\r\n";

/// A number as files have it.
pub(super) trait Number: Copy {
    const SIZE: usize;
    fn put(self, bytes: &mut Vec<u8>);
    fn get(bytes: &[u8]) -> Self;
}

macro_rules! number {
    ($($number:ty)*) => {$(
        impl Number for $number {
            const SIZE: usize = size_of::<$number>();
            fn put(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
            fn get(bytes: &[u8]) -> Self {
                Self::from_le_bytes(bytes.try_into().expect("as many bytes as it has"))
            }
        }
    )*};
}

number!(u8 u32 u64 f64);

impl<T: Number, const N: usize> Number for [T; N] {
    const SIZE: usize = N * T::SIZE;
    fn put(self, bytes: &mut Vec<u8>) {
        self.into_iter().for_each(|number| number.put(bytes));
    }
    fn get(bytes: &[u8]) -> Self {
        std::array::from_fn(|i| T::get(&bytes[i * T::SIZE..][..T::SIZE]))
    }
}

/// Numbers out of their bytes; `None` where some are left.
pub(super) fn numbers<T: Number>(bytes: &[u8]) -> Option<Vec<T>> {
    let whole = bytes.len().is_multiple_of(T::SIZE);
    whole.then(|| bytes.chunks(T::SIZE).map(T::get).collect())
}

/// A whole file.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, BlocksError> {
    std::fs::read(path).map_err(|source| BlocksError::Io { path: path.into(), source })
}

/// What precedes the arrays.
#[derive(Serialize, Deserialize)]
struct Header {
    plan: String,
    facts: Facts,
    /// Names of arrays, and how many bytes each has.
    arrays: Vec<(String, u64)>,
}

/// Arrays that are to be written.
#[derive(Default)]
pub(super) struct Arrays(Vec<(&'static str, Vec<u8>)>);

impl Arrays {
    pub(super) fn add<T: Number>(
        &mut self,
        name: &'static str,
        numbers: impl IntoIterator<Item = T>,
    ) {
        let numbers = numbers.into_iter();
        let mut bytes = Vec::with_capacity(T::SIZE * numbers.size_hint().0);
        numbers.for_each(|number| number.put(&mut bytes));
        self.0.push((name, bytes));
    }

    /// Writes the file of a block, which appears when it is whole.
    pub(super) fn write(self, plan: &Plan, block: usize, facts: Facts) -> Result<(), BlocksError> {
        let arrays = self.0.iter().map(|(name, bytes)| ((*name).into(), bytes.len() as u64));
        let arrays = arrays.collect();
        let header = Header { plan: plan.digest.clone(), facts, arrays };
        let header = serde_json::to_vec(&header).expect("it has no maps");
        Target::open(&plan.block_file(block))?.write(|out| {
            out.write_all(MAGIC)?;
            out.write_all(&(header.len() as u64).to_le_bytes())?;
            out.write_all(&header)?;
            self.0.iter().try_for_each(|(_, bytes)| out.write_all(bytes))
        })?;
        Ok(())
    }
}

/// A finished block.
pub(super) struct BlockFile {
    path: PathBuf,
    pub facts: Facts,
    /// Names of arrays, where they begin, and how many bytes they have.
    arrays: Vec<(String, u64, u64)>,
}

impl BlockFile {
    /// Opens the file of a block, whose arrays are read when they are asked for.
    ///
    /// # Errors
    /// It is not there, damaged, or of another plan.
    pub(super) fn open(plan: &Plan, block: usize) -> Result<Self, BlocksError> {
        let path = plan.block_file(block);
        let read = || -> io::Result<Option<(Header, u64, u64)>> {
            let mut file = File::open(&path)?;
            let length = file.metadata()?.len();
            let mut start = [0; 24];
            if length < 24 {
                return Ok(None);
            }
            file.read_exact(&mut start)?;
            let size = u64::get(&start[16..]);
            if &start[..16] != MAGIC || size > length - 24 {
                return Ok(None);
            }
            let mut header = vec![0; size as usize];
            file.read_exact(&mut header)?;
            Ok(serde_json::from_slice(&header).ok().map(|header| (header, 24 + size, length)))
        };
        let read = read().map_err(|source| BlocksError::Io { path: path.clone(), source })?;
        let damaged =
            || BlocksError::Damaged { path: path.clone(), what: "is damaged, or cut off".into() };
        let (header, mut at, length) = read.ok_or_else(damaged)?;
        if header.plan != plan.digest {
            return Err(BlocksError::OtherPlan { path });
        }
        let mut arrays = Vec::new();
        for (name, bytes) in header.arrays {
            arrays.push((name, at, bytes));
            at = at.saturating_add(bytes);
        }
        if at != length {
            return Err(damaged());
        }
        Ok(Self { path, facts: header.facts, arrays })
    }

    /// An array.
    pub(super) fn read<T: Number>(&self, name: &str) -> Result<Vec<T>, BlocksError> {
        let damaged =
            || BlocksError::Damaged { path: self.path.clone(), what: format!("has no {name}") };
        let (_, at, bytes) =
            self.arrays.iter().find(|(known, ..)| known == name).ok_or_else(damaged)?;
        let read = || {
            let mut file = File::open(&self.path)?;
            file.seek(SeekFrom::Start(*at))?;
            let mut array = vec![0; *bytes as usize];
            file.read_exact(&mut array)?;
            Ok(array)
        };
        let array = read().map_err(|source| BlocksError::Io { path: self.path.clone(), source })?;
        numbers(&array).ok_or_else(damaged)
    }
}
