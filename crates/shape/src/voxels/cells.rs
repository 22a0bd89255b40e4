//! The parts that voxels of a region play in its solid, and the simplices that fill deep voxels.

use walpha_base::Monitor;
use walpha_base::memory::try_with_capacity;
use walpha_base::parallel::prelude::*;
use walpha_complex::canonical::{outward_facets, smallest_even, sorted};
use walpha_regular::triangulate;

use super::VoxelsError;
use crate::ShapeError;
use crate::bits::{Bits, Numbered};

/// The maximum number of corners, limited by the 32-bit numbers of their octants.
pub(super) const MOST_CORNERS: u64 = 1 << 29;

/// A region by the part that voxels play in its solid.
pub(super) struct Lattice {
    /// Voxels that have a neighbour outside of the region: their corners are the points.
    pub(super) shell: Bits,
    /// The others.
    deep: Bits,
    /// The corners of the shell.
    pub(super) corners: Numbered,
}

impl Lattice {
    pub(super) fn of(region: &Bits) -> Result<Self, ShapeError> {
        let deep = region.deep()?;
        let shell = region.without(&deep)?;
        let corners = shell.corners()?;
        let count = corners.count();
        if count > MOST_CORNERS {
            return Err(VoxelsError::TooMany { corners: count }.into());
        }
        Ok(Self { shell, deep, corners: Numbered::new(corners)? })
    }

    /// The cells that fill the deep voxels. They are positively oriented if the axes of the grid are right-handed; they are
    /// turned over if `mirrored`.
    pub(super) fn filling(&self, mirrored: bool, monitor: &Monitor) -> Result<Filling, ShapeError> {
        let what = || "the cells of deep voxels".to_owned();
        let lining = self.deep.dilated()?.and(&self.shell)?.corners()?;
        if lining.count() == 0 {
            return Ok(Filling::default());
        }
        let mut corners = try_with_capacity(lining.count() as usize, what)?;
        lining.each(|corner| corners.push(corner));
        drop(lining);
        let mut points = try_with_capacity(corners.len(), what)?;
        points.extend(corners.iter().map(|corner| corner.map(|i| i as f64)));
        let filling = monitor.watch(|| triangulate(&points, None))?;
        drop(points);
        let is_deep = |cell: &[u32; 4]| {
            let corners = cell.map(|v| corners[v as usize]);
            // A centroid on a face between voxels lies inside of its cell, so both are in the same part.
            let of = |k: usize| corners.iter().map(|corner| corner[k]).sum::<usize>() / 4;
            self.deep.has([of(0), of(1), of(2)].map(|i| i as i64))
        };
        let deep = || filling.finite_cells().map(|(_, cell)| cell).filter(is_deep);
        let mut cells = try_with_capacity(deep().count(), what)?;
        let number = |v: u32| self.corners.number(corners[v as usize]);
        cells.extend(deep().map(|cell| written(cell.map(number), mirrored)));
        Filling::of(cells)
    }
}

/// A positively oriented cell in canonical form, turned over if `mirrored`.
pub(super) fn written(mut cell: [u32; 4], mirrored: bool) -> [u32; 4] {
    if mirrored {
        cell.swap(2, 3);
    }
    smallest_even(cell)
}

/// The simplices that fill the deep voxels and are not of a voxel of the shell, sorted. All are interior.
#[derive(Default)]
pub(super) struct Filling {
    pub(super) cells: Vec<[u32; 4]>,
    pub(super) facets: Vec<[u32; 3]>,
    /// Some are edges of the shell.
    pub(super) edges: Vec<[u32; 2]>,
}

impl Filling {
    fn of(mut cells: Vec<[u32; 4]>) -> Result<Self, ShapeError> {
        let what = || "the simplices of deep voxels".to_owned();
        cells.par_sort_unstable();
        let mut facets = try_with_capacity(4 * cells.len(), what)?;
        facets.extend(cells.iter().flat_map(|cell| outward_facets(*cell).map(sorted)));
        facets.par_sort_unstable();
        // A facet of one cell lies between a deep voxel and one of the shell, which lists it.
        let shared = || facets.chunk_by(|a, b| a == b).filter(|same| same.len() == 2);
        let mut inner = try_with_capacity(shared().count(), what)?;
        inner.extend(shared().map(|same| same[0]));
        drop(facets);
        let mut edges = try_with_capacity(3 * inner.len(), what)?;
        edges.extend(inner.iter().flat_map(|&[a, b, c]| [[a, b], [a, c], [b, c]]));
        edges.par_sort_unstable();
        edges.dedup();
        Ok(Self { cells, facets: inner, edges })
    }
}
