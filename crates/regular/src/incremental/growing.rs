//! A Delaunay triangulation that points join and leave again.

use std::collections::HashSet;
use std::ops::Range;

use super::leave::{Hole, Workspace};
use super::{Builder, rounds};
use crate::predicates::{Predicates, Screen};
use crate::{Cell, GONE, Sites, TriangulationError, curve};

/// The Delaunay triangulation of points that come in batches, and may leave one by one.
///
/// Ties are broken as ever, so it is that of the points in it and of nothing else: not of the order in
/// which they came, nor of those that left. Points have numbers in the order in which they are
/// named, from [`Growing::FIRST`] on; what has a number need not be in it.
pub struct Growing {
    positions: Vec<[f64; 3]>,
    weights: Vec<f64>,
    state: State,
}

/// What the insertion of a point would change.
pub struct Insertion {
    /// Cells in conflict with it, infinite ones among them.
    pub removed: Vec<u32>,
    /// The finite cells that would take their places.
    pub cells: Vec<[u32; 4]>,
}

/// What insertions and removals change.
pub(super) struct State {
    pub builder: Builder,
    /// The places of vertices, so that no two stand at one.
    taken: HashSet<[u64; 3]>,
    /// A cell at each vertex; [`NONE`] at other points.
    pub at: Vec<u32>,
    /// Cells made since they were last asked for, some of them gone again.
    fresh: Vec<u32>,
}

/// The number before that of the first point.
pub(super) const GHOST: u32 = 0;
/// The cell at a point that is not a vertex.
pub(super) const NONE: u32 = u32::MAX;

impl Growing {
    /// The number of the first point.
    pub const FIRST: u32 = GHOST + 1;

    /// The triangulation of some points.
    ///
    /// # Errors
    /// Points that are not sites or span no volume; no memory.
    pub fn new(positions: &[[f64; 3]]) -> Result<Self, TriangulationError> {
        Sites::new(positions, &vec![0.0; positions.len()])?;
        let builder = Builder::empty(positions.len(), positions.len() + 1, GHOST)?;
        let (taken, at, fresh) = (HashSet::new(), vec![NONE], Vec::new());
        let mut growing = Self {
            // A place for the ghost, which makes no bound wider.
            positions: vec![positions[0]],
            weights: vec![0.0],
            state: State { builder, taken, at, fresh },
        };
        let all = growing.name(positions);
        let Self { positions, weights, state } = &mut growing;
        let predicates = Predicates::new(positions, weights);
        let screen = Screen::with_ghost(&predicates, GHOST)?;
        state.builder.begin(&screen, all.clone())?;
        (0..state.builder.mesh.cells.len() as u32).for_each(|cell| state.note(cell));
        for v in state.builder.first {
            state.taken.insert(place(positions[v as usize]));
        }
        state.insert_all(positions, &screen, &all.collect::<Vec<_>>())?;
        Ok(growing)
    }

    /// Gives points numbers; they are not vertices yet.
    pub fn name(&mut self, positions: &[[f64; 3]]) -> Range<u32> {
        let first = self.positions.len() as u32;
        self.positions.extend_from_slice(positions);
        let count = self.positions.len();
        self.weights.resize(count, 0.0);
        self.state.at.resize(count, NONE);
        self.state.builder.cavity.admit(count);
        first..count as u32
    }

    /// Makes points vertices. One at the place of a vertex stays out.
    ///
    /// # Errors
    /// Too many cells, no memory.
    pub fn insert(&mut self, points: &[u32]) -> Result<(), TriangulationError> {
        let Self { positions, weights, state } = self;
        let predicates = Predicates::new(positions, weights);
        state.insert_all(positions, &Screen::with_ghost(&predicates, GHOST)?, points)
    }

    /// Removes vertices, other than those around which no triangulation would be left. Gives the number of
    /// those that left.
    ///
    /// # Errors
    /// Too many cells, no memory.
    pub fn remove(&mut self, points: &[u32]) -> Result<usize, TriangulationError> {
        let Self { positions, weights, state } = self;
        let predicates = Predicates::new(positions, weights);
        let screen = Screen::with_ghost(&predicates, GHOST)?;
        let mut workspace = Workspace::new(positions.len())?;
        let mut left = 0;
        for &v in points {
            if let Some(hole) = state.hole(&screen, v, &mut workspace)? {
                state.close(v, &hole)?;
                state.taken.remove(&place(positions[v as usize]));
                left += 1;
            }
        }
        state.mark_gone();
        Ok(left)
    }

    /// What the [`Screen`](Self::screen) of all points with numbers begins with.
    pub fn predicates(&self) -> Predicates<'_> {
        Predicates::new(&self.positions, &self.weights)
    }

    /// Tests for [`Self::hole`] and [`Self::insertion`].
    ///
    /// # Errors
    /// No memory.
    pub fn screen<'a>(predicates: &'a Predicates<'a>) -> Result<Screen<'a>, TriangulationError> {
        Screen::with_ghost(predicates, GHOST)
    }

    /// What would come in the place of a vertex; `None` where no triangulation would be left.
    ///
    /// # Errors
    /// No memory.
    pub fn hole(
        &self,
        screen: &Screen<'_>,
        v: u32,
        workspace: &mut Workspace,
    ) -> Result<Option<Hole>, TriangulationError> {
        self.state.hole(screen, v, workspace)
    }

    /// What would come with a point that lies in a cell, and is not a vertex.
    pub fn insertion(&self, screen: &Screen<'_>, v: u32, cell: u32) -> Insertion {
        let mesh = &self.state.builder.mesh;
        let (mut removed, mut stays, mut cells) = (vec![cell], Vec::new(), Vec::new());
        let mut at = 0;
        while let Some(&cell) = removed.get(at) {
            at += 1;
            let Cell { corners, neighbors } = mesh.cells[cell as usize];
            for k in 0..4 {
                let next = neighbors[k] / 4;
                if removed.contains(&next) {
                    continue;
                }
                if !stays.contains(&next) && mesh.conflicts(screen, next, v) {
                    removed.push(next);
                } else {
                    stays.push(next);
                    let mut joined = corners;
                    joined[k] = v;
                    cells.push(joined);
                }
            }
        }
        cells.retain(|cell| !cell.contains(&GHOST));
        Insertion { removed, cells }
    }

    /// Whether a point is a vertex.
    pub fn is_vertex(&self, v: u32) -> bool {
        self.state.at[v as usize] != NONE
    }

    /// The corners of each cell and 4·cell + corner across each facet. Some are gone.
    pub fn cells(&self) -> &[Cell] {
        &self.state.builder.mesh.cells
    }

    /// Whether there is a finite cell of this number.
    pub fn is_cell(&self, cell: u32) -> bool {
        let [a, b, c, d] = self.cells()[cell as usize].corners;
        a != GONE && a != GHOST && b != GHOST && c != GHOST && d != GHOST
    }

    /// The finite cells made since this was last asked, ascending.
    pub fn take_fresh(&mut self) -> Vec<u32> {
        let mut made = vec![false; self.cells().len()];
        std::mem::take(&mut self.state.fresh).iter().for_each(|&cell| made[cell as usize] = true);
        let fresh = (0..).zip(made).filter(|&(cell, made)| made && self.is_cell(cell));
        fresh.map(|(cell, _)| cell).collect()
    }

    /// Where points stand, by number.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }
}

impl State {
    fn insert_all(
        &mut self,
        positions: &[[f64; 3]],
        screen: &Screen<'_>,
        points: &[u32],
    ) -> Result<(), TriangulationError> {
        let places: Vec<_> = points.iter().map(|&v| positions[v as usize]).collect();
        let along = curve::keyed(&places);
        for i in rounds(points.len() as u32) {
            let v = points[along[i as usize].1 as usize];
            if self.taken.insert(place(positions[v as usize])) && self.builder.insert(screen, v)? {
                for at in 0..self.builder.cavity.made().len() {
                    self.note(self.builder.cavity.made()[at]);
                }
            }
        }
        self.mark_gone();
        Ok(())
    }

    /// Marks the places of cells that are gone.
    fn mark_gone(&mut self) {
        let Builder { free, mesh, .. } = &mut self.builder;
        free.iter().for_each(|&place| mesh.cells[place as usize].corners[0] = GONE);
    }

    /// Takes note of a new cell.
    pub(super) fn note(&mut self, cell: u32) {
        self.fresh.push(cell);
        for v in self.builder.mesh.cells[cell as usize].corners {
            self.at[v as usize] = cell;
        }
    }
}

/// Equal places have equal bits: adding 0.0 turns −0.0 into 0.0.
fn place(position: [f64; 3]) -> [u64; 3] {
    position.map(|x| (x + 0.0).to_bits())
}

#[cfg(test)]
mod tests;
