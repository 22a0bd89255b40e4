//! Files of blocks: a header in JSON, followed by arrays of little-endian numbers. The file starts with the digest of the header,
//! which contains those of the arrays, so that every byte is verified.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use walpha_base::Sum;

use super::bytes::{self, Digest, Number, digest_of, numbers};
use super::{BlocksError, Plan};
use crate::export::Target;
use walpha_shape::{Class, Complex, ComponentSums, SheetSums, Sheets, Simplices};

/// The magic bytes of a block file. They are followed by the length of the header in 64 bits, and its digest.
const MAGIC: &[u8; 16] = b"walpha block 2\r\n";
/// The number of bytes before the header.
const START: usize = 40;

/// The header, before the arrays.
#[derive(Serialize, Deserialize)]
struct Header {
    /// The version of the program.
    version: String,
    /// The digest of the plan.
    plan: Digest,
    /// The number of the block.
    block: usize,
    summary: BlockSummary,
    arrays: Vec<Array>,
}

/// The name, length and digest of an array.
#[derive(Serialize, Deserialize)]
struct Array {
    name: String,
    /// The length in bytes.
    bytes: u64,
    digest: Digest,
}

/// Arrays to be written.
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

    /// Writes the file of a block, which appears when it is complete.
    pub(super) fn write(
        self,
        plan: &Plan,
        block: usize,
        summary: BlockSummary,
    ) -> Result<(), BlocksError> {
        let array = |(name, bytes): &(&str, Vec<u8>)| Array {
            name: (*name).into(),
            bytes: bytes.len() as u64,
            digest: Digest::of(bytes),
        };
        let arrays = self.0.iter().map(array).collect();
        let version = Plan::VERSION.into();
        let header = Header { version, plan: plan.digest, block, summary, arrays };
        let header = serde_json::to_vec(&header).expect("it has no maps");
        Target::replacing(plan.block_file(block))?.write(|out| {
            out.write_all(MAGIC)?;
            out.write_all(&(header.len() as u64).to_le_bytes())?;
            out.write_all(Digest::of(&header).bytes())?;
            out.write_all(&header)?;
            self.0.iter().try_for_each(|(_, bytes)| out.write_all(bytes))
        })?;
        Ok(())
    }
}

/// A finished block.
pub(super) struct BlockFile {
    path: PathBuf,
    pub summary: BlockSummary,
    /// The arrays, and their positions.
    arrays: Vec<(Array, u64)>,
    /// The number of samples of the volume.
    samples: u64,
}

impl BlockFile {
    /// Opens the file of a block. Its arrays are read on request.
    ///
    /// # Errors
    /// The file does not exist, does not verify, or belongs to another plan or block.
    pub(super) fn open(plan: &Plan, block: usize) -> Result<Self, BlocksError> {
        let path = plan.block_file(block);
        let mut file = bytes::open(&path)?;
        let read = |file: &mut File| -> io::Result<Option<(Vec<u8>, u64)>> {
            let length = file.metadata()?.len();
            let mut start = [0; START];
            if length < START as u64 {
                return Ok(None);
            }
            file.read_exact(&mut start)?;
            let size = u64::get(&start[16..24]);
            if &start[..16] != MAGIC || size > length - START as u64 {
                return Ok(None);
            }
            let mut header = vec![0; size as usize];
            file.read_exact(&mut header)?;
            let digest = Digest::read(&start[24..]);
            Ok(digest.is_of(&header).then_some((header, length)))
        };
        let read =
            read(&mut file).map_err(|source| BlocksError::Io { path: path.clone(), source })?;
        let damaged =
            |what: &str| BlocksError::Damaged { path: path.clone(), what: what.to_owned() };
        let (text, length) = read.ok_or_else(|| damaged(Self::DAMAGED))?;
        let header: Header = serde_json::from_slice(&text).map_err(|_| damaged(Self::DAMAGED))?;
        if header.version != Plan::VERSION || !plan.digest.is(header.plan) {
            return Err(BlocksError::OtherPlan { path });
        }
        if header.block != block {
            return Err(damaged(&format!("is block {}, not {block}", header.block)));
        }
        let mut at = START as u64 + text.len() as u64;
        let mut arrays = Vec::new();
        for array in header.arrays {
            let end = at.saturating_add(array.bytes);
            arrays.push((array, at));
            at = end;
        }
        if at != length {
            return Err(damaged(Self::DAMAGED));
        }
        let samples = plan.job.dims.samples() as u64;
        let file = Self { path: path.clone(), summary: header.summary, arrays, samples };
        if !file.fits(plan.blocks[block].points) {
            return Err(damaged("contradicts itself"));
        }
        Ok(file)
    }

    const DAMAGED: &str = "is damaged, or cut off";

    /// Whether the numbers of the summary match the lengths of the arrays. That is true for every block that was written; it is
    /// checked here so that later code may rely on it.
    fn fits(&self, points: u64) -> bool {
        let BlockSummary { cells, facets, edges, vertices, components, sheets, .. } = &self.summary;
        let sum = |counts: &[usize; 3]| counts.iter().map(|&count| count as u128).sum::<u128>();
        let has = |name: &str, size: u128, count: u128| {
            let array = self.arrays.iter().find(|(known, _)| known.name == name);
            array.is_some_and(|(array, _)| u128::from(array.bytes) == size * count)
        };
        let rows = |name: &str, size: u128| {
            let array = self.arrays.iter().find(|(known, _)| known.name == name);
            array.map_or(0, |(array, _)| u128::from(array.bytes) / size)
        };
        let (kept, border, shared) =
            (rows("voxels", 8), rows("border_points", 8), rows("shared_simplices", 24));
        // A regular facet has a sheet on one side, a singular one on both sides.
        let sides = facets[1] as u128 + 2 * facets[2] as u128;
        let lengths = [
            ("voxels", 8, kept),
            ("own", 1, kept),
            ("values", 8, kept),
            ("weights", 8, kept),
            ("components", 4, kept),
            ("cells", 16, *cells as u128),
            ("facets", 12, sum(facets)),
            ("facet_classes", 1, sum(facets)),
            ("facet_sheets", 4, sides),
            ("edges", 8, sum(edges)),
            ("edge_classes", 1, sum(edges)),
            ("edge_sheets", 4, edges[2] as u128),
            ("vertices", 4, sum(vertices)),
            ("vertex_classes", 1, sum(vertices)),
            ("border_points", 8, border),
            ("border_components", 4, border),
            ("shared_simplices", 24, shared),
            ("shared_sides", 4, shared),
            ("shared_sheets", 4, shared),
        ];
        lengths.into_iter().all(|(name, size, count)| has(name, size, count))
            && self.summary.points == points
            && self.summary.halo <= self.samples
            && self.summary.spanning.len() <= 4
            && components.iter().all(|component| {
                component.sums.vertices as u128 <= sum(vertices) && component.sums.cells <= *cells
            })
            && sheets
                .iter()
                .filter_map(|sheet| sheet.met)
                .all(|met| components.get(met.component as usize).is_some())
    }

    /// Reads an array.
    ///
    /// # Errors
    /// The array cannot be read, or does not verify.
    pub(super) fn read<T: Number>(&self, name: &str) -> Result<Vec<T>, BlocksError> {
        let known = self.arrays.iter().find(|(known, _)| known.name == name);
        let (array, at) = known.ok_or_else(|| self.damaged(&format!("has no {name}")))?;
        let mut file = bytes::open(&self.path)?;
        let mut read = || {
            file.seek(SeekFrom::Start(*at))?;
            let mut bytes = vec![0; array.bytes as usize];
            file.read_exact(&mut bytes)?;
            Ok(bytes)
        };
        let bytes = read().map_err(|source| BlocksError::Io { path: self.path.clone(), source })?;
        let sound = numbers(&bytes).filter(|_| array.digest.is_of(&bytes));
        sound.ok_or_else(|| self.damaged(Self::DAMAGED))
    }

    /// Reads an array of numbers that must be below a bound.
    ///
    /// # Errors
    /// See [`read`](Self::read); or a number is out of range.
    pub(super) fn below<T: Number + Ord>(
        &self,
        name: &str,
        bound: T,
    ) -> Result<Vec<T>, BlocksError> {
        let numbers = self.read::<T>(name)?;
        if numbers.iter().any(|number| *number >= bound) {
            return Err(self.damaged(&format!("has {name} that are not there")));
        }
        Ok(numbers)
    }

    /// The indices of the points in the volume, ascending.
    ///
    /// # Errors
    /// See [`read`](Self::read).
    pub(super) fn voxels(&self) -> Result<Vec<u64>, BlocksError> {
        let voxels = self.below("voxels", self.samples)?;
        if !voxels.is_sorted_by(|a, b| a < b) {
            return Err(self.damaged("has points out of order"));
        }
        Ok(voxels)
    }

    /// The error for content that a verified block cannot have.
    pub(super) fn damaged(&self, what: &str) -> BlocksError {
        BlocksError::Damaged { path: self.path.clone(), what: what.to_owned() }
    }

    /// Reads the whole file piece by piece, and verifies it.
    ///
    /// # Errors
    /// The file does not verify, or cannot be read.
    pub(super) fn verify(&self) -> Result<(), BlocksError> {
        let io = |source| BlocksError::Io { path: self.path.clone(), source };
        let mut file = bytes::open(&self.path)?;
        for (array, at) in &self.arrays {
            file.seek(SeekFrom::Start(*at)).map_err(io)?;
            let found = digest_of(file.by_ref().take(array.bytes)).map_err(io)?;
            if found.0 != array.bytes || !array.digest.is(found.1) {
                return Err(self.damaged(Self::DAMAGED));
            }
        }
        Ok(())
    }
}

/// The summary of a block: everything that merging needs besides keys and rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct BlockSummary {
    pub points: u64,
    pub halo: u64,
    pub cells: usize,
    /// The numbers by class: interior, regular, singular.
    pub facets: [usize; 3],
    pub edges: [usize; 3],
    pub vertices: [usize; 3],
    /// `None` if there is no point.
    pub weights: Option<Weights>,
    pub components: Vec<BlockComponent>,
    pub sheets: Vec<BlockSheet>,
    /// At most four positions, with the same affine hull as the points of the block and its halo.
    pub spanning: Vec<[f64; 3]>,
}

/// The weights ω of some points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Weights {
    pub min: f64,
    pub max: f64,
    pub sum: Sum,
}

/// The part of a component in a block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct BlockComponent {
    /// The smallest vertex, by its index in the volume.
    pub first: u64,
    pub sums: ComponentSums,
}

/// The part of a sheet in a block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct BlockSheet {
    /// The first occurrence in the order of the rows; `None` if the block has no row of the sheet.
    pub met: Option<Met>,
    pub sums: SheetSums,
}

/// A position in the order in which sheets occur: along the facets of the boundary, then along the singular edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) struct Met {
    pub is_edge: bool,
    pub row: [u64; 3],
    /// Whether it is the second side of a singular facet.
    pub is_second: bool,
    /// The component, within the block.
    pub component: u32,
}

/// Reads a block's part of the shape: rows of `points` points, and sheets by their common numbers.
///
/// # Errors
/// The file cannot be read, does not verify, or contains impossible simplices.
pub(super) fn read_rows(
    file: &BlockFile,
    points: usize,
    numbers: &[u32],
) -> Result<(Complex, Sheets), BlocksError> {
    let complex = Complex {
        cells: rows(file, "cells", None, points)?,
        facets: rows(file, "facets", Some("facet_classes"), points)?,
        edges: rows(file, "edges", Some("edge_classes"), points)?,
        vertices: rows(file, "vertices", Some("vertex_classes"), points)?,
    };
    let [facets, edges, vertices] =
        [complex.facets.counts(), complex.edges.counts(), complex.vertices.counts()]
            .map(|counts| [Class::Interior, Class::Regular, Class::Singular].map(|c| counts[c]));
    let summary = &file.summary;
    if (facets, edges, vertices) != (summary.facets, summary.edges, summary.vertices) {
        return Err(file.damaged("has classes that it did not count"));
    }
    let sheet = |name: u32| numbers[name as usize];
    let count = numbers.len() as u32;
    let mut names = file.below::<u32>("facet_sheets", count)?.into_iter().map(sheet);
    // There are as many names as sides: `BlockFile::open` has compared them.
    let mut next = || names.next().unwrap_or_default();
    let mut sheets = Sheets::default();
    for class in complex.facets.classes() {
        match class {
            Class::Regular => sheets.regular.push(next()),
            Class::Singular => sheets.singular.push([next(), next()]),
            _ => {}
        }
    }
    sheets.edges = file.below::<u32>("edge_sheets", count)?.into_iter().map(sheet).collect();
    Ok((complex, sheets))
}

/// Reads simplices with their classes; if `classes` is `None`, all are interior.
fn rows<const N: usize>(
    file: &BlockFile,
    name: &str,
    classes: Option<&str>,
    points: usize,
) -> Result<Simplices<N>, BlocksError> {
    let rows = file.read::<[u32; N]>(name)?;
    let is_row = |row: &[u32; N]| {
        let is_new = |(k, v): (usize, &u32)| (*v as usize) < points && !row[..k].contains(v);
        row.iter().enumerate().all(is_new)
    };
    if !rows.iter().all(is_row) {
        return Err(file.damaged(&format!("has {name} of points that are not there")));
    }
    let classes = match classes {
        Some(classes) => file.read(classes)?,
        None => vec![Class::Interior as u8; rows.len()],
    };
    let mut simplices = Simplices::default();
    for (row, number) in rows.into_iter().zip(classes) {
        let class = Class::from_number(number);
        let class = class.ok_or_else(|| file.damaged("has a class that is none"))?;
        simplices.push(row, class);
    }
    Ok(simplices)
}
