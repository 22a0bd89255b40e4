//! A Delaunay triangulation that points join and leave again.

use std::collections::HashSet;
use std::ops::Range;

use super::leave::{Digger, Hole};
use super::{Native, rounds};
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
    body: Body,
}

/// What would come with a point.
pub struct Crown {
    /// Cells that would go, infinite ones among them.
    pub goes: Vec<u32>,
    /// The finite cells that would come.
    pub cells: Vec<[u32; 4]>,
}

/// What changes when a point comes or leaves.
pub(super) struct Body {
    pub native: Native,
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
        let native = Native::empty(positions.len(), positions.len() + 1, GHOST)?;
        let (taken, at, fresh) = (HashSet::new(), vec![NONE], Vec::new());
        let mut growing = Self {
            // A place for the ghost, which makes no bound wider.
            positions: vec![positions[0]],
            weights: vec![0.0],
            body: Body { native, taken, at, fresh },
        };
        let all = growing.name(positions);
        let Self { positions, weights, body } = &mut growing;
        let predicates = Predicates::new(positions, weights);
        let screen = Screen::with_ghost(&predicates, GHOST)?;
        body.native.begin(&screen, all.clone())?;
        (0..body.native.mesh.cells.len() as u32).for_each(|cell| body.note(cell));
        for v in body.native.first {
            body.taken.insert(place(positions[v as usize]));
        }
        body.insert_all(positions, &screen, &all.collect::<Vec<_>>())?;
        Ok(growing)
    }

    /// Gives points numbers; they are not vertices yet.
    pub fn name(&mut self, positions: &[[f64; 3]]) -> Range<u32> {
        let first = self.positions.len() as u32;
        self.positions.extend_from_slice(positions);
        let count = self.positions.len();
        self.weights.resize(count, 0.0);
        self.body.at.resize(count, NONE);
        self.body.native.cavity.admit(count);
        first..count as u32
    }

    /// Makes points vertices. One at the place of a vertex stays out.
    ///
    /// # Errors
    /// Too many cells, no memory.
    pub fn insert(&mut self, points: &[u32]) -> Result<(), TriangulationError> {
        let Self { positions, weights, body } = self;
        let predicates = Predicates::new(positions, weights);
        body.insert_all(positions, &Screen::with_ghost(&predicates, GHOST)?, points)
    }

    /// Removes vertices, other than those around which no triangulation would be left. Gives the number of
    /// those that left.
    ///
    /// # Errors
    /// Too many cells, no memory.
    pub fn remove(&mut self, points: &[u32]) -> Result<usize, TriangulationError> {
        let Self { positions, weights, body } = self;
        let predicates = Predicates::new(positions, weights);
        let screen = Screen::with_ghost(&predicates, GHOST)?;
        let mut digger = Digger::new(positions.len())?;
        let mut left = 0;
        for &v in points {
            if let Some(hole) = body.hole(&screen, v, &mut digger)? {
                body.close(v, &hole)?;
                body.taken.remove(&place(positions[v as usize]));
                left += 1;
            }
        }
        body.mark_gone();
        Ok(left)
    }

    /// What the [`Screen`](Self::screen) of all points with numbers begins with.
    pub fn predicates(&self) -> Predicates<'_> {
        Predicates::new(&self.positions, &self.weights)
    }

    /// Tests for [`Self::hole`] and [`Self::crown`].
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
        digger: &mut Digger,
    ) -> Result<Option<Hole>, TriangulationError> {
        self.body.hole(screen, v, digger)
    }

    /// What would come with a point that lies in a cell, and is not a vertex.
    pub fn crown(&self, screen: &Screen<'_>, v: u32, cell: u32) -> Crown {
        let mesh = &self.body.native.mesh;
        let (mut goes, mut stays, mut cells) = (vec![cell], Vec::new(), Vec::new());
        let mut at = 0;
        while let Some(&cell) = goes.get(at) {
            at += 1;
            let Cell { corners, beside } = mesh.cells[cell as usize];
            for k in 0..4 {
                let next = beside[k] / 4;
                if goes.contains(&next) {
                    continue;
                }
                if !stays.contains(&next) && mesh.conflicts(screen, next, v) {
                    goes.push(next);
                } else {
                    stays.push(next);
                    let mut joined = corners;
                    joined[k] = v;
                    cells.push(joined);
                }
            }
        }
        cells.retain(|cell| !cell.contains(&GHOST));
        Crown { goes, cells }
    }

    /// Whether a point is a vertex.
    pub fn is_vertex(&self, v: u32) -> bool {
        self.body.at[v as usize] != NONE
    }

    /// The corners of each cell and 4·cell + corner across each facet. Some are gone.
    pub fn cells(&self) -> &[Cell] {
        &self.body.native.mesh.cells
    }

    /// Whether there is a finite cell of this number.
    pub fn is_cell(&self, cell: u32) -> bool {
        let [a, b, c, d] = self.cells()[cell as usize].corners;
        a != GONE && a != GHOST && b != GHOST && c != GHOST && d != GHOST
    }

    /// The finite cells made since this was last asked, ascending.
    pub fn take_fresh(&mut self) -> Vec<u32> {
        let mut made = vec![false; self.cells().len()];
        std::mem::take(&mut self.body.fresh).iter().for_each(|&cell| made[cell as usize] = true);
        let fresh = (0..).zip(made).filter(|&(cell, made)| made && self.is_cell(cell));
        fresh.map(|(cell, _)| cell).collect()
    }

    /// Where points stand, by number.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }
}

impl Body {
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
            if self.taken.insert(place(positions[v as usize])) && self.native.insert(screen, v)? {
                for at in 0..self.native.cavity.made().len() {
                    self.note(self.native.cavity.made()[at]);
                }
            }
        }
        self.mark_gone();
        Ok(())
    }

    /// Marks the places of cells that are gone.
    fn mark_gone(&mut self) {
        let Native { free, mesh, .. } = &mut self.native;
        free.iter().for_each(|&place| mesh.cells[place as usize].corners[0] = GONE);
    }

    /// Takes note of a new cell.
    pub(super) fn note(&mut self, cell: u32) {
        self.fresh.push(cell);
        for v in self.native.mesh.cells[cell as usize].corners {
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
