//! Writes a shape as arrays of Zarr, which are never in memory as a whole.

use std::path::Path;
use std::sync::Arc;

use serde_json::json;
use walpha_base::Monitor;
use walpha_base::parallel::prelude::*;
use walpha_files::{Filled, fill_folder};
use zarrs::array::codec::ZstdCodec;
use zarrs::array::{Array, ArrayBuilder, DataType, Element, FillValue};
use zarrs::array_subset::ArraySubset;
use zarrs::filesystem::FilesystemStore;
use zarrs::group::GroupBuilder;

use super::whole::MergedBlock;
use super::{BlocksError, Merged, Plan};
use walpha_shape::Simplices;

/// The number of rows of a chunk.
const ROWS: u64 = 1 << 18;

/// Writes a new folder.
pub(super) fn write(
    plan: &Plan,
    merged: &Merged,
    path: &Path,
    monitor: &Monitor,
) -> Result<Filled, BlocksError> {
    let failed = |source| BlocksError::Written { path: path.into(), source };
    fill_folder(path, failed, |part| fill(plan, merged, part, monitor))
}

/// Fills a folder with a group for each dimension, which has the rows of all blocks, in the order of blocks. Corners are named by
/// their index in the volume; `vertices/corners` and `vertices/positions` map these to positions. A block for each thread is in
/// memory.
fn fill(plan: &Plan, merged: &Merged, folder: &Path, monitor: &Monitor) -> Result<(), BlocksError> {
    let failed = |error: &dyn std::fmt::Display| BlocksError::Written {
        path: folder.into(),
        source: std::io::Error::other(error.to_string()),
    };
    let store = FilesystemStore::new(folder).map_err(|error| failed(&error))?;
    let file = File { store: Arc::new(store), failed: &failed };
    file.group(plan, merged)?;
    let mut vertices = file.rows::<1>("vertices", merged.vertices.in_shape())?;
    let [mut positions, mut weights, mut values, mut components] = [
        file.array("vertices/positions", merged.vertices.in_shape(), Some(3), &f64::NAN)?,
        file.array("vertices/weights", merged.vertices.in_shape(), None, &f64::NAN)?,
        file.array("vertices/values", merged.vertices.in_shape(), None, &f64::NAN)?,
        file.array("vertices/components", merged.vertices.in_shape(), None, &0u32)?,
    ];
    let mut edges = file.rows::<2>("edges", merged.edges.in_shape())?;
    let mut facets = file.rows::<3>("facets", merged.facets.in_shape())?;
    let mut cells = file.rows::<4>("cells", merged.cells)?;
    let blocks: Vec<usize> = (0..plan.blocks.len()).collect();
    for batch in blocks.chunks(rayon::current_num_threads()) {
        let read = |&block: &usize| MergedBlock::read(plan, block, &merged.numbers[block]);
        let pieces: Result<Vec<MergedBlock>, _> = batch.par_iter().map(read).collect();
        for piece in pieces? {
            let own = || piece.complex.vertices.rows().iter().map(|&[v]| v as usize);
            positions.push(&file, own().flat_map(|v| piece.positions[v]).collect::<Vec<_>>())?;
            weights.push(&file, own().map(|v| piece.weights[v]).collect::<Vec<_>>())?;
            values.push(&file, own().map(|v| piece.values[v]).collect::<Vec<_>>())?;
            components.push(&file, own().map(|v| piece.components[v]).collect::<Vec<_>>())?;
            vertices.push(&file, &piece.complex.vertices, &piece.voxels)?;
            edges.push(&file, &piece.complex.edges, &piece.voxels)?;
            facets.push(&file, &piece.complex.facets, &piece.voxels)?;
            cells.push(&file, &piece.complex.cells, &piece.voxels)?;
        }
        monitor.report(batch.last().map_or(0, |&last| last as u64 + 1), blocks.len() as u64)?;
    }
    Ok(())
}

/// A folder of arrays, and the conversion of errors there.
struct File<'a> {
    store: Arc<FilesystemStore>,
    failed: &'a dyn Fn(&dyn std::fmt::Display) -> BlocksError,
}

impl File<'_> {
    /// Writes the root group, with the numbers of the whole shape.
    fn group(&self, plan: &Plan, merged: &Merged) -> Result<(), BlocksError> {
        let coordinates = plan.job.units.coordinates_of(&plan.job.frame);
        let attributes = json!({ "walpha": {
            "version": env!("CARGO_PKG_VERSION"),
            "input": plan.job.input,
            "dims": plan.job.dims.xyz(),
            "coordinates": coordinates,
            "alpha": plan.job.alpha().squared(),
            "betti": merged.betti,
            "classes": { "1": "interior", "2": "regular", "3": "singular" },
        }});
        for (path, attributes) in [("/", attributes)]
            .into_iter()
            .chain(["/vertices", "/edges", "/facets", "/cells"].map(|path| (path, json!({}))))
        {
            GroupBuilder::new()
                .attributes(attributes.as_object().cloned().unwrap_or_default())
                .build(Arc::clone(&self.store), path)
                .map_err(|error| (self.failed)(&error))?
                .store_metadata()
                .map_err(|error| (self.failed)(&error))?;
        }
        Ok(())
    }

    /// Creates an array with this number of rows, each of one number or of `width`.
    fn array<T: ArrayNumber>(
        &self,
        name: &str,
        rows: usize,
        width: Option<usize>,
        fill: &T,
    ) -> Result<Growing, BlocksError> {
        let tail = || width.into_iter().map(|width| width as u64);
        let shape: Vec<u64> = std::iter::once(rows as u64).chain(tail()).collect();
        let chunk = (rows as u64).clamp(1, ROWS);
        let chunks: Vec<u64> = std::iter::once(chunk).chain(tail()).collect();
        let array = ArrayBuilder::new(shape, chunks, T::TYPE, fill.fill())
            .bytes_to_bytes_codecs(vec![Arc::new(ZstdCodec::new(1, false))])
            .build(Arc::clone(&self.store), &format!("/{name}"))
            .map_err(|error| (self.failed)(&error))?;
        array.store_metadata().map_err(|error| (self.failed)(&error))?;
        Ok(Growing { array, width: width.unwrap_or(1), rows: 0 })
    }

    /// Creates the arrays of simplices of a dimension.
    fn rows<const N: usize>(&self, name: &str, rows: usize) -> Result<SimplexArrays, BlocksError> {
        let corners = self.array(&format!("{name}/corners"), rows, Some(N), &0u64)?;
        let classes = self.array(&format!("{name}/classes"), rows, None, &0u8)?;
        Ok(SimplexArrays { corners, classes })
    }
}

/// A number type of arrays.
trait ArrayNumber: Element + Copy {
    const TYPE: DataType;
    fn fill(self) -> FillValue;
}

macro_rules! array_numbers {
    ($($number:ty: $data_type:ident),*) => {
        $(impl ArrayNumber for $number {
            const TYPE: DataType = DataType::$data_type;
            fn fill(self) -> FillValue {
                FillValue::from(self)
            }
        })*
    };
}

array_numbers!(u8: UInt8, u32: UInt32, u64: UInt64, f64: Float64);

/// An array that is written from its beginning on.
struct Growing {
    array: Array<FilesystemStore>,
    width: usize,
    /// The number of rows written.
    rows: u64,
}

impl Growing {
    fn push<T: ArrayNumber>(
        &mut self,
        file: &File<'_>,
        numbers: impl AsRef<[T]>,
    ) -> Result<(), BlocksError> {
        let numbers = numbers.as_ref();
        let rows = (numbers.len() / self.width) as u64;
        if rows == 0 {
            return Ok(());
        }
        let (mut start, mut shape) = (vec![self.rows], vec![rows]);
        if self.array.shape().len() > 1 {
            start.push(0);
            shape.push(self.width as u64);
        }
        self.rows += rows;
        let at = ArraySubset::new_with_start_shape(start, shape)
            .map_err(|error| (file.failed)(&error))?;
        let stored = self.array.store_array_subset_elements(&at, numbers);
        stored.map_err(|error| (file.failed)(&error))
    }
}

/// The simplices of a dimension.
struct SimplexArrays {
    corners: Growing,
    classes: Growing,
}

impl SimplexArrays {
    fn push<const N: usize>(
        &mut self,
        file: &File<'_>,
        simplices: &Simplices<N>,
        voxels: &[u64],
    ) -> Result<(), BlocksError> {
        let corners = simplices.rows().iter().flat_map(|row| row.map(|v| voxels[v as usize]));
        self.corners.push(file, corners.collect::<Vec<u64>>())?;
        let classes = simplices.classes().iter().map(|&class| class as u8);
        self.classes.push(file, classes.collect::<Vec<u8>>())
    }
}
