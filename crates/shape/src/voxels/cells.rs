//! The cells of a region of voxels: those of voxels with corners, and those that fill what is deep.

use walpha_base::Monitor;
use walpha_base::memory::{try_reserve, try_with_capacity};
use walpha_complex::canonical::smallest_even;
use walpha_regular::{triangulate, triangulate_monitored};

use super::VoxelsError;
use super::bits::{Bits, Numbered};
use crate::ShapeError;

/// As many corners as the 32-bit numbers of their octants leave room for.
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

    /// The cells, positively oriented where the axes of the grid are right-handed; turned over where `mirrored`.
    pub(super) fn cells(
        &self,
        mirrored: bool,
        monitor: &Monitor,
    ) -> Result<Vec<[u32; 4]>, ShapeError> {
        let written = |mut cell: [u32; 4]| {
            if mirrored {
                cell.swap(2, 3);
            }
            smallest_even(cell)
        };
        let what = || "the cells of voxels".to_owned();
        let cube = cells_of_cube()?;
        let mut cells = try_with_capacity(cube.len() * self.shell.count() as usize, what)?;
        self.shell.each(|voxel| {
            let corners =
                CUBE.map(|step| self.corners.number([0, 1, 2].map(|k| voxel[k] + step[k])));
            cells.extend(cube.iter().map(|cell| written(cell.map(|v| corners[v as usize]))));
        });
        let lining = self.deep.dilated()?.and(&self.shell)?.corners()?;
        if lining.count() == 0 {
            return Ok(cells);
        }
        let mut corners = try_with_capacity(lining.count() as usize, what)?;
        lining.each(|corner| corners.push(corner));
        drop(lining);
        let mut points = try_with_capacity(corners.len(), what)?;
        points.extend(corners.iter().map(|corner| corner.map(|i| i as f64)));
        let filling = triangulate_monitored(&points, None, monitor)?;
        drop(points);
        let is_deep = |cell: &[u32; 4]| {
            let corners = cell.map(|v| corners[v as usize]);
            // A centroid on a face between voxels lies inside of its cell, so both are in the same part.
            let of = |k: usize| corners.iter().map(|corner| corner[k]).sum::<usize>() / 4;
            self.deep.has([of(0), of(1), of(2)].map(|i| i as i64))
        };
        let deep = || filling.finite_cells().map(|(_, cell)| cell).filter(is_deep);
        try_reserve(&mut cells, deep().count(), what)?;
        cells.extend(
            deep().map(|cell| written(cell.map(|v| self.corners.number(corners[v as usize])))),
        );
        Ok(cells)
    }
}

/// The corners of a cube.
const CUBE: [[usize; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]];

/// The cells of a cube by the rule for ties, as rows of its corners.
fn cells_of_cube() -> Result<Vec<[u32; 4]>, ShapeError> {
    let cube = triangulate(&CUBE.map(|corner| corner.map(|i| i as f64)), None)?;
    Ok(cube.finite_cells().map(|(_, cell)| cell).collect())
}
