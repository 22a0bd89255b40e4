//! F at the samples of a volume, updated while points are inserted and removed.

use std::ops::Range;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

use walpha_base::Monitor;
use walpha_base::parallel::prelude::*;
use walpha_complex::canonical::smallest_even;
use walpha_regular::internals::{Cell, Growing};

use super::barycentric::coordinates;
use super::grid::OUTSIDE;
use super::interpolant::combine;
use super::least_squares::{Normal, PiecewiseLinear, Solved};
use super::raster::{CHUNK, for_each_inside};
use super::{Deviation, Grid, InterpolateError};
use walpha_points::Units;
use walpha_shape::ShapeError;
use walpha_volume::Volume;

/// The interpolant of samples of a volume on their Delaunay triangulation, evaluated at all samples.
///
/// A sample belongs to the same cell, and F has the same bits there, as if
/// [`Interpolant::resample`](super::Interpolant::resample) were called for the triangulation of the points in the order of their
/// insertion. Both locate samples by their indices and not by coordinates of the world, which are rounded in most frames;
/// computations with indices are exact, as a volume has fewer than 2³² samples. F is recomputed only in new cells and where the
/// cell of a sample changed.
pub(super) struct Sampled<'a> {
    volume: &'a Volume,
    units: Units,
    /// The grid of samples by their indices.
    grid: Grid,
    /// Whether a cell that is positively oriented in the world is negatively oriented in indices.
    mirrored: bool,
    /// Whether coordinates of the world are exact, so that every cell has a volume in indices, too.
    exact: bool,
    growing: Growing,
    /// The sample of each point, by the number of the point in the triangulation; 0 for the infinite vertex.
    voxels: Vec<u32>,
    /// The index (x, y, z) of each point in the volume.
    indices: Vec<[i64; 3]>,
    /// The values of points, by their numbers in the triangulation.
    values: Vec<f64>,
    /// The value of F at each sample.
    f: Vec<f32>,
    /// The cell of each sample, by its number in the triangulation.
    owners: Vec<u32>,
}

impl<'a> Sampled<'a> {
    /// Creates the interpolant of some samples.
    ///
    /// # Errors
    /// The samples span no volume, or there is not enough memory.
    pub(super) fn new(
        volume: &'a Volume,
        units: Units,
        voxels: &[u32],
    ) -> Result<Self, InterpolateError> {
        let samples = volume.dims().samples();
        let grid = Grid::of(volume, units);
        let growing = Growing::new(&positions(volume, units, voxels)).map_err(ShapeError::from)?;
        let mut sampled = Self {
            volume,
            units,
            exact: grid.bit_range().is_exact(),
            mirrored: grid.is_mirrored(),
            grid: grid.by_index(),
            growing,
            voxels: vec![0; Growing::FIRST as usize],
            indices: vec![[0; 3]; Growing::FIRST as usize],
            values: vec![0.0; Growing::FIRST as usize],
            f: vec![0.0; samples],
            owners: vec![OUTSIDE; samples],
        };
        sampled.describe(voxels);
        sampled.follow();
        Ok(sampled)
    }

    /// Inserts samples as points.
    ///
    /// # Errors
    /// There is not enough memory.
    pub(super) fn add(&mut self, voxels: &[u32]) -> Result<(), InterpolateError> {
        let named: Vec<u32> = self.name(voxels).collect();
        self.growing.insert(&named).map_err(ShapeError::from)?;
        self.follow();
        Ok(())
    }

    /// Registers samples as points that are not inserted yet; returns their numbers.
    pub(super) fn name(&mut self, voxels: &[u32]) -> Range<u32> {
        self.describe(voxels);
        self.growing.register(&positions(self.volume, self.units, voxels), &vec![0.0; voxels.len()])
    }

    /// Removes points and inserts others, by their numbers.
    ///
    /// # Errors
    /// There is not enough memory.
    pub(super) fn change(&mut self, leave: &[u32], join: &[u32]) -> Result<(), InterpolateError> {
        self.growing.remove(leave).map_err(ShapeError::from)?;
        self.growing.insert(join).map_err(ShapeError::from)?;
        self.follow();
        Ok(())
    }

    /// Fits the values of points to the volume by least squares, as [`refit`](super::refit()) does.
    ///
    /// # Errors
    /// There is not enough memory.
    pub(super) fn refit(&mut self, monitor: &Monitor) -> Result<(), InterpolateError> {
        let cells = self.triangulation();
        let free = self.values.len();
        let normal = Normal::assemble(&cells, &self.owners, &self.grid, self.volume, free)?;
        let Solved { change, .. } = normal.solve(monitor)?;
        self.values.iter_mut().zip(change).for_each(|(value, change)| *value += change);
        self.evaluate(|_, _| true);
        Ok(())
    }

    /// The deviation of F from the volume.
    pub(super) fn deviation(&self) -> Deviation {
        Deviation::at(self.volume, &self.f, |sample| self.owners[sample] != OUTSIDE)
    }

    /// The value of F at each sample; 0 outside all cells.
    pub(super) fn f(&self) -> &[f32] {
        &self.f
    }

    /// The triangulation.
    pub(super) fn growing(&self) -> &Growing {
        &self.growing
    }

    /// The values of points, by their numbers.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// The samples that the points are, by their numbers.
    pub(super) fn voxels(&self) -> &[u32] {
        &self.voxels
    }

    /// The numbers of the vertices.
    pub(super) fn vertices(&self) -> Vec<u32> {
        let all = Growing::FIRST..self.voxels.len() as u32;
        all.filter(|&v| self.growing.is_vertex(v)).collect()
    }

    /// The position of a sample, in the units of points.
    pub(super) fn place(&self, sample: u32) -> [f64; 3] {
        self.units.position(self.volume, sample)
    }

    /// The cell of each sample, or [`OUTSIDE`].
    pub(super) fn owners(&self) -> &[u32] {
        &self.owners
    }

    /// One more than the largest number of a cell.
    pub(super) fn cells(&self) -> usize {
        self.growing.cells().len()
    }

    fn describe(&mut self, voxels: &[u32]) {
        self.voxels.extend(voxels);
        let [nx, ny, _] = self.volume.dims().xyz().map(|n| n as i64);
        let index = |&voxel: &u32| i64::from(voxel);
        let index = |voxel| [index(voxel) % nx, index(voxel) / nx % ny, index(voxel) / (nx * ny)];
        self.indices.extend(voxels.iter().map(index));
        let value = |&voxel: &u32| f64::from(self.volume.as_slice()[voxel as usize]);
        self.values.extend(voxels.iter().map(value));
    }

    fn triangulation(&self) -> Cells<'_> {
        let Self { growing, values, indices, mirrored, .. } = self;
        Cells { growing, values, indices, mirrored: *mirrored }
    }

    /// Finds the cells of the samples in new cells, and computes F there.
    fn follow(&mut self) {
        let fresh = self.growing.take_new_cells();
        let mut is_fresh = vec![false; self.cells()];
        fresh.iter().for_each(|&cell| is_fresh[cell as usize] = true);
        if self.exact {
            let stays = |&&owner: &&u32| {
                owner != OUTSIDE && !is_fresh[owner as usize] && self.growing.is_cell(owner)
            };
            let left = |owner: &u32| AtomicU32::new(*Some(owner).filter(stays).unwrap_or(&OUTSIDE));
            let owners: Vec<AtomicU32> = self.owners.par_iter().map(left).collect();
            self.draw(&fresh, &is_fresh, &owners);
            self.owners = owners.into_iter().map(AtomicU32::into_inner).collect();
            return;
        }
        let owners = self.draw_all();
        let before = std::mem::replace(&mut self.owners, owners);
        let changed =
            |sample: usize, owner: u32| owner != before[sample] || is_fresh[owner as usize];
        self.evaluate(changed);
    }

    /// The first of all cells that contain each sample. If coordinates of the world are rounded, four samples in one plane may
    /// form a cell without volume in indices. It contains nothing, and of two cells on its sides, which have no common facet,
    /// either may come first.
    fn draw_all(&self) -> Vec<u32> {
        let cells = self.triangulation();
        let none = |_| AtomicU32::new(OUTSIDE);
        let owners: Vec<AtomicU32> = (0..self.owners.len()).into_par_iter().map(none).collect();
        (0..self.cells() as u32).into_par_iter().with_min_len(CHUNK).for_each(|cell| {
            if !self.growing.is_cell(cell) {
                return;
            }
            let row = cells.row(cell);
            for_each_inside(row.map(|v| self.indices[v as usize]), |index, _, _| {
                let comes_first = |owner| owner == OUTSIDE || row < cells.row(owner);
                let claim = |owner| comes_first(owner).then_some(cell);
                _ = owners[self.sample(index)].fetch_update(Relaxed, Relaxed, claim);
            });
        });
        owners.into_iter().map(AtomicU32::into_inner).collect()
    }

    /// Finds the samples in new cells, if every cell has a volume. F is then the same whichever of several cells a sample belongs
    /// to, and is written immediately.
    fn draw(&mut self, fresh: &[u32], is_fresh: &[bool], owners: &[AtomicU32]) {
        let f: Vec<AtomicU32> = self.f.par_iter().map(|f| AtomicU32::new(f.to_bits())).collect();
        let cells = self.triangulation();
        fresh.par_iter().with_min_len(CHUNK).for_each(|&cell| {
            let row = cells.row(cell);
            let values = row.map(|v| self.values[v as usize]);
            for_each_inside(row.map(|v| self.indices[v as usize]), |index, volumes, whole| {
                let sample = self.sample(index);
                let owner = &owners[sample];
                // This owner was found from another new cell, which is enough, except at vertices, where another cell may come
                // first.
                let found = is_fresh.get(owner.load(Relaxed) as usize).is_some_and(|&fresh| fresh);
                if found && volumes.iter().filter(|&&volume| volume == 0).count() < 3 {
                    return;
                }
                let shares = volumes.map(|volume| volume as f64 / whole as f64);
                cells.claim(cell, &shares, owner);
                f[sample].store((combine(&shares, values) as f32).to_bits(), Relaxed);
            });
        });
        self.f = f.into_iter().map(|f| f32::from_bits(f.into_inner())).collect();
    }

    #[inline(always)]
    fn sample(&self, [x, y, z]: [i64; 3]) -> usize {
        let [nx, ny, _] = self.grid.dims().xyz().map(|n| n as i64);
        (x + nx * (y + ny * z)) as usize
    }

    /// Computes F at the samples for which `wanted` holds.
    fn evaluate(&mut self, wanted: impl Fn(usize, u32) -> bool + Sync) {
        let mut f = std::mem::take(&mut self.f);
        let cells = self.triangulation();
        let (grid, owners) = (&self.grid, &self.owners);
        let [nx, ny, _] = grid.dims().xyz();
        f.par_chunks_mut(nx).enumerate().for_each(|(y, f)| {
            for (x, f) in f.iter_mut().enumerate() {
                let owner = owners[x + nx * y];
                if owner == OUTSIDE || !wanted(x + nx * y, owner) {
                    continue;
                }
                let place = grid.position([x, y % ny, y / ny]);
                if let Some(shares) = cells.coordinates(cells.row(owner), place) {
                    *f = cells.value(owner, &shares) as f32;
                }
            }
        });
        self.f = f;
    }
}

fn positions(volume: &Volume, units: Units, voxels: &[u32]) -> Vec<[f64; 3]> {
    voxels.iter().map(|&voxel| units.position(volume, voxel)).collect()
}

/// The cells of a triangulation in the form of an interpolant, with corners at their indices.
struct Cells<'a> {
    growing: &'a Growing,
    values: &'a [f64],
    indices: &'a [[i64; 3]],
    mirrored: bool,
}

impl Cells<'_> {
    /// The corners of a cell in canonical order. Numbers of points are in the order of their indices.
    fn row(&self, cell: u32) -> [u32; 4] {
        smallest_even(self.growing.cells()[cell as usize].corners)
    }

    fn coordinates(&self, row: [u32; 4], place: [f64; 3]) -> Option<[f64; 4]> {
        let mut corners = row.map(|v| self.indices[v as usize].map(|x| x as f64));
        if !self.mirrored {
            return coordinates(&corners, place, true);
        }
        corners.swap(0, 1);
        let [b, a, c, d] = coordinates(&corners, place, true)?;
        Some([a, b, c, d])
    }

    /// Assigns a sample in a new cell to the first of the cells that contain it.
    #[inline(always)]
    fn claim(&self, cell: u32, shares: &[f64; 4], owner: &AtomicU32) {
        match shares.iter().filter(|share| **share == 0.0).count() {
            0 => owner.store(cell, Relaxed),
            1 => owner.store(self.first_across(cell, shares), Relaxed),
            2 => owner.store(self.first_at(cell, shares), Relaxed),
            // At a vertex F is the vertex's value, whichever cell the sample belongs to.
            _ => drop(owner.fetch_min(cell, Relaxed)),
        }
    }

    /// The first, in canonical order, of a cell and the cell beyond the facet on which a position lies.
    fn first_across(&self, cell: u32, shares: &[f64; 4]) -> u32 {
        let row = self.row(cell);
        let apex = (0..4).find(|&k| shares[k] == 0.0).expect("a share is 0");
        let Cell { corners, neighbors } = self.growing.cells()[cell as usize];
        let k = (0..4).find(|&k| corners[k] == row[apex]).expect("a corner");
        let next = neighbors[k] / 4;
        if !self.growing.is_cell(next) {
            return cell;
        }
        if self.row(next) < row { next } else { cell }
    }

    /// The first, in canonical order, of the cells at the face on which a position in one of them lies. These are the cells with
    /// all vertices of the face; they are connected by facets that contain all of these vertices, too.
    fn first_at(&self, cell: u32, shares: &[f64; 4]) -> u32 {
        let row = self.row(cell);
        let on = |v: u32| (0..4).any(|k| row[k] == v && shares[k] != 0.0);
        let mut seen = vec![cell];
        let mut first = (row, cell);
        let mut at = 0;
        while let Some(&cell) = seen.get(at) {
            at += 1;
            let Cell { corners, neighbors } = self.growing.cells()[cell as usize];
            for k in 0..4 {
                let next = neighbors[k] / 4;
                if on(corners[k]) || !self.growing.is_cell(next) || seen.contains(&next) {
                    continue;
                }
                first = first.min((self.row(next), next));
                seen.push(next);
            }
        }
        first.1
    }
}

impl PiecewiseLinear for Cells<'_> {
    fn count(&self) -> usize {
        self.growing.cells().len()
    }

    fn vertices(&self, cell: u32) -> ([u32; 4], usize) {
        (self.row(cell), 4)
    }

    fn coordinates(&self, cell: u32, place: [f64; 3]) -> Option<[f64; 4]> {
        self.coordinates(self.row(cell), place)
    }

    fn value(&self, cell: u32, shares: &[f64; 4]) -> f64 {
        combine(shares, self.row(cell).map(|v| self.values[v as usize]))
    }
}
