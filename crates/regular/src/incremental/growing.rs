//! A regular triangulation with insertion and removal of points.

use std::collections::HashSet;
use std::ops::Range;

use super::Builder;
use super::removal::{Hole, Workspace};
use crate::kernel::{Predicates, Screen};
use crate::order::{position_bits, rounds};
use crate::{Cell, DELETED, Sites, TriangulationError, order};

/// The regular triangulation of a set of points that grows in batches, and from which points may be removed.
///
/// Ties are broken as in [`Triangulation`](crate::Triangulation), so the cells depend only on the points in the triangulation,
/// and not on the order of insertions and removals. Points are numbered from [`Growing::FIRST`] on in the order in which they are
/// registered; a registered point need not be a vertex. The infinite vertex is vertex 0. Without weights, or if all are equal,
/// every inserted point becomes a vertex and stays one; otherwise [`Growing::settle`] finds the vertices.
#[derive(Debug)]
pub struct Growing {
    positions: Vec<[f64; 3]>,
    weights: Vec<f64>,
    state: State,
}

/// The changes that the insertion of a point would make; see [`Growing::insertion`].
#[derive(Debug)]
pub struct Insertion {
    /// The cells in conflict with the point, including infinite ones.
    pub removed: Vec<u32>,
    /// The finite cells that would replace them.
    pub cells: Vec<[u32; 4]>,
}

/// The part of [`Growing`] that insertions and removals change, apart from the points that they read.
#[derive(Debug)]
pub(super) struct State {
    pub builder: Builder,
    /// The [`position_bits`] of all vertices: no two are equal.
    occupied: HashSet<[u64; 3]>,
    /// A cell at each vertex; [`NO_CELL`] for other points.
    pub cell_at: Vec<u32>,
    /// Cells made since the last [`Growing::take_new_cells`]; some may have been deleted since.
    new_cells: Vec<u32>,
}

/// The infinite vertex. Its number precedes those of the points, because their number is not known in advance.
pub(super) const AT_INFINITY: u32 = 0;
/// Stands for the absence of a cell.
pub(super) const NO_CELL: u32 = u32::MAX;

impl Growing {
    /// The number of the first point.
    pub const FIRST: u32 = AT_INFINITY + 1;

    /// The Delaunay triangulation of points.
    ///
    /// # Errors
    /// Points that are not valid [`Sites`] or span no volume; out of memory.
    pub fn new(positions: &[[f64; 3]]) -> Result<Self, TriangulationError> {
        let weights = vec![0.0; positions.len()];
        Sites::new(positions, &weights)?;
        let mut growing = Self::empty(positions, &weights)?;
        let all: Vec<u32> = (Self::FIRST..growing.positions.len() as u32).collect();
        growing.start_again(&all)?;
        Ok(growing)
    }

    /// Registers points, at least one, without inserting them: [`Growing::start_again`] must be called first.
    ///
    /// # Errors
    /// Out of memory.
    pub fn empty(positions: &[[f64; 3]], weights: &[f64]) -> Result<Self, TriangulationError> {
        let builder = Builder::with_capacity(positions.len(), positions.len() + 1, AT_INFINITY)?;
        let (occupied, cell_at, new_cells) = (HashSet::new(), vec![NO_CELL], Vec::new());
        let mut growing = Self {
            // The infinite vertex is like one of the points, so that it widens no bound.
            positions: vec![positions[0]],
            weights: vec![weights[0]],
            state: State { builder, occupied, cell_at, new_cells },
        };
        growing.register(positions, weights);
        Ok(growing)
    }

    /// Triangulates these registered points alone.
    ///
    /// # Errors
    /// Points that span no volume, in which case nothing changes. Too many cells; out of memory.
    pub fn start_again(&mut self, points: &[u32]) -> Result<(), TriangulationError> {
        let Self { positions, weights, state } = self;
        let predicates = Predicates::new(positions, weights);
        let screen = Screen::with_infinite(&predicates, AT_INFINITY)?;
        state.builder.start(&screen, points.iter().copied())?;
        state.cell_at.fill(NO_CELL);
        state.new_cells.clear();
        (0..state.builder.mesh.cells.len() as u32).for_each(|cell| state.record_cell(cell));
        state.occupied.clear();
        for v in state.builder.first_cell {
            state.occupied.insert(position_bits(positions[v as usize]));
        }
        state.insert_all(positions, &screen, points)
    }

    /// Gives points numbers, without inserting them.
    pub fn register(&mut self, positions: &[[f64; 3]], weights: &[f64]) -> Range<u32> {
        let first = self.positions.len() as u32;
        self.positions.extend_from_slice(positions);
        self.weights.extend_from_slice(weights);
        let count = self.positions.len();
        self.state.cell_at.resize(count, NO_CELL);
        self.state.builder.cavity.grow(count);
        first..count as u32
    }

    /// Inserts registered points. A point at the position of a vertex is left out.
    ///
    /// # Errors
    /// Too many cells; out of memory.
    pub fn insert(&mut self, points: &[u32]) -> Result<(), TriangulationError> {
        let Self { positions, weights, state } = self;
        let predicates = Predicates::new(positions, weights);
        state.insert_all(positions, &Screen::with_infinite(&predicates, AT_INFINITY)?, points)
    }

    /// Removes vertices, except those without which the others span no volume. Returns the number of vertices removed.
    ///
    /// # Errors
    /// Too many cells; out of memory.
    pub fn remove(&mut self, points: &[u32]) -> Result<usize, TriangulationError> {
        let Self { positions, weights, state } = self;
        let predicates = Predicates::new(positions, weights);
        let screen = Screen::with_infinite(&predicates, AT_INFINITY)?;
        let mut workspace = Workspace::new(positions.len())?;
        let mut removed = 0;
        for &v in points {
            if let Some(hole) = state.hole(&screen, v, &mut workspace)? {
                state.close(v, &hole)?;
                state.occupied.remove(&position_bits(positions[v as usize]));
                removed += 1;
            }
        }
        state.mark_deleted();
        Ok(removed)
    }

    /// Determines the vertices after an insertion that may have hidden some. Hidden points can be inserted again.
    pub fn settle(&mut self) {
        let Self { positions, state, .. } = self;
        state.cell_at.fill(NO_CELL);
        state.new_cells.clear();
        for (number, cell) in (0..).zip(&state.builder.mesh.cells) {
            if cell.corners[0] != DELETED {
                cell.corners.iter().for_each(|&v| state.cell_at[v as usize] = number);
            }
        }
        let vertices = positions.iter().zip(&state.cell_at).skip(Self::FIRST as usize);
        let vertices = vertices.filter(|&(_, &cell)| cell != NO_CELL);
        state.occupied = vertices.map(|(&place, _)| position_bits(place)).collect();
    }

    /// Predicates of all registered points, for [`Self::screen`].
    pub fn predicates(&self) -> Predicates<'_> {
        Predicates::new(&self.positions, &self.weights)
    }

    /// The filtered predicates that [`Self::hole`] and [`Self::insertion`] need.
    ///
    /// # Errors
    /// Out of memory.
    pub fn screen<'a>(predicates: &'a Predicates<'a>) -> Result<Screen<'a>, TriangulationError> {
        Screen::with_infinite(predicates, AT_INFINITY)
    }

    /// The changes that the removal of a vertex would make; `None` if all others span no volume.
    ///
    /// # Errors
    /// Out of memory.
    pub fn hole(
        &self,
        screen: &Screen<'_>,
        v: u32,
        workspace: &mut Workspace,
    ) -> Result<Option<Hole>, TriangulationError> {
        self.state.hole(screen, v, workspace)
    }

    /// The changes that the insertion of a registered point would make. It must not be a vertex, and must lie in the cell `cell`.
    pub fn insertion(&self, screen: &Screen<'_>, v: u32, cell: u32) -> Insertion {
        let mesh = &self.state.builder.mesh;
        let (mut removed, mut kept, mut cells) = (vec![cell], Vec::new(), Vec::new());
        let mut at = 0;
        while let Some(&cell) = removed.get(at) {
            at += 1;
            let Cell { corners, neighbors } = mesh.cells[cell as usize];
            for k in 0..4 {
                let next = neighbors[k] / 4;
                if removed.contains(&next) {
                    continue;
                }
                if !kept.contains(&next) && mesh.conflicts(screen, next, v) {
                    removed.push(next);
                } else {
                    kept.push(next);
                    let mut joined = corners;
                    joined[k] = v;
                    cells.push(joined);
                }
            }
        }
        cells.retain(|cell| !cell.contains(&AT_INFINITY));
        Insertion { removed, cells }
    }

    /// Whether a point is a vertex.
    pub fn is_vertex(&self, v: u32) -> bool {
        self.state.cell_at[v as usize] != NO_CELL
    }

    /// All cells, including infinite and deleted ones; see [`Self::is_cell`].
    pub fn cells(&self) -> &[Cell] {
        &self.state.builder.mesh.cells
    }

    /// Whether a cell is finite and not deleted.
    pub fn is_cell(&self, cell: u32) -> bool {
        let [a, b, c, d] = self.cells()[cell as usize].corners;
        a != DELETED && a != AT_INFINITY && b != AT_INFINITY && c != AT_INFINITY && d != AT_INFINITY
    }

    /// The finite cells made since the last call, ascending.
    pub fn take_new_cells(&mut self) -> Vec<u32> {
        let mut made = vec![false; self.cells().len()];
        std::mem::take(&mut self.state.new_cells)
            .iter()
            .for_each(|&cell| made[cell as usize] = true);
        let new = (0..).zip(made).filter(|&(cell, made)| made && self.is_cell(cell));
        new.map(|(cell, _)| cell).collect()
    }

    /// The positions of registered points, by number; index 0 is a placeholder for the infinite vertex.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// The weights of registered points, indexed like their positions.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }
}

impl State {
    fn insert_all(
        &mut self,
        positions: &[[f64; 3]],
        screen: &Screen<'_>,
        points: &[u32],
    ) -> Result<(), TriangulationError> {
        let batch: Vec<_> = points.iter().map(|&v| positions[v as usize]).collect();
        let along = order::along_curve(&batch);
        for i in rounds(points.len() as u32) {
            let v = points[along[i as usize].1 as usize];
            if self.occupied.insert(position_bits(positions[v as usize]))
                && self.builder.insert(screen, v)?
            {
                for at in 0..self.builder.cavity.new_cells().len() {
                    self.record_cell(self.builder.cavity.new_cells()[at]);
                }
            }
        }
        self.mark_deleted();
        Ok(())
    }

    /// Marks the cells in free slots as [`DELETED`].
    fn mark_deleted(&mut self) {
        let Builder { free_slots, mesh, .. } = &mut self.builder;
        free_slots.iter().for_each(|&slot| mesh.cells[slot as usize].corners[0] = DELETED);
    }

    /// Records a new cell, and that it is at its corners.
    pub(super) fn record_cell(&mut self, cell: u32) {
        self.new_cells.push(cell);
        for v in self.builder.mesh.cells[cell as usize].corners {
            self.cell_at[v as usize] = cell;
        }
    }
}

#[cfg(test)]
mod tests;
