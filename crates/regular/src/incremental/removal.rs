//! Removal of a vertex: its star is replaced by cells of the regular triangulation of its neighbours.

use super::Builder;
use super::growing::{AT_INFINITY, NO_CELL, State};
use crate::kernel::Screen;
use crate::{Cell, DELETED, Triangulation, TriangulationError, facets, smallest_first};

/// The star of a vertex, and the cells that would replace it.
#[derive(Debug)]
pub struct Hole {
    /// The cells at the vertex.
    pub star: Vec<u32>,
    /// The cells that replace the star. Cells are numbered by their index here, in `neighbors`, too.
    pub filling: Vec<Cell>,
    /// The facets of the boundary: 4·cell + corner inside, by the index in `filling`, and 4·cell + corner outside,
    /// in the triangulation.
    boundary: Vec<[u32; 2]>,
}

/// Working memory of [`Growing::hole`](super::Growing::hole), kept so that the next call need not allocate.
#[derive(Debug)]
pub struct Workspace {
    /// The triangulation of the neighbours.
    builder: Builder,
    /// All facets of its cells, sorted: the vertices, in the orientation of [`facets`] with the smallest first, and 4·cell +
    /// corner.
    facets: Vec<([u32; 3], u32)>,
    /// For each 4·cell + corner: for a facet of the boundary, 4·cell + corner outside the hole; otherwise [`NO_CELL`].
    outside: Vec<u32>,
    /// The index of each cell in the filling, or [`NO_CELL`].
    index_of: Vec<u32>,
}

/// Typical number of neighbours of a vertex, an estimate for the first allocation (about 15 on average in a
/// Poisson–Delaunay triangulation).
const TYPICAL_DEGREE: usize = 32;

impl Workspace {
    /// Creates the work space for vertices with numbers below `below`.
    ///
    /// # Errors
    /// Out of memory.
    pub fn new(below: usize) -> Result<Self, TriangulationError> {
        let builder = Builder::with_capacity(TYPICAL_DEGREE, below, AT_INFINITY)?;
        Ok(Self { builder, facets: Vec::new(), outside: Vec::new(), index_of: Vec::new() })
    }

    /// Triangulates the neighbours of a vertex; `false` if they span no volume.
    fn triangulate(
        &mut self,
        screen: &Screen<'_>,
        points: &[u32],
    ) -> Result<bool, TriangulationError> {
        match self.builder.start(screen, points.iter().copied()) {
            Err(TriangulationError::Sites(_)) => return Ok(false),
            begun => begun?,
        }
        for &v in points {
            if !self.builder.first_cell.contains(&v) {
                self.builder.insert(screen, v)?;
            }
        }
        let cells = &mut self.builder.mesh.cells;
        self.builder.free_slots.iter().for_each(|&slot| cells[slot as usize].corners[0] = DELETED);
        self.facets.clear();
        for (number, cell) in
            cells.iter().enumerate().filter(|(_, cell)| cell.corners[0] != DELETED)
        {
            let codes = (4 * number as u32..).zip(facets(cell.corners));
            self.facets.extend(codes.map(|(code, facet)| (smallest_first(facet), code)));
        }
        self.facets.sort_unstable();
        self.outside.clear();
        self.outside.resize(4 * cells.len(), NO_CELL);
        self.index_of.clear();
        self.index_of.resize(cells.len(), NO_CELL);
        Ok(true)
    }

    /// Collects the cells within the boundary, and their neighbours.
    fn fill(&mut self, star: Vec<u32>, boundary: &[([u32; 3], u32)]) -> Option<Hole> {
        let mut inside = Vec::new();
        for &(facet, outside) in boundary {
            let found = self.facets.binary_search_by_key(&facet, |entry| entry.0).ok()?;
            let code = self.facets[found].1;
            self.outside[code as usize] = outside;
            self.add(code / 4, &mut inside);
        }
        let (mut filling, mut boundary) = (Vec::new(), Vec::new());
        while let Some(&cell) = inside.get(filling.len()) {
            let Cell { corners, mut neighbors } = self.builder.mesh.cells[cell as usize];
            for (corner, side) in (0..).zip(&mut neighbors) {
                let outside = self.outside[4 * cell as usize + corner as usize];
                if outside == NO_CELL {
                    *side = 4 * self.add(*side / 4, &mut inside) + *side % 4;
                } else {
                    boundary.push([4 * filling.len() as u32 + corner, outside]);
                }
            }
            filling.push(Cell { corners, neighbors });
        }
        Some(Hole { star, filling, boundary })
    }

    /// The index of a cell in the filling; appends the cell if it has none.
    fn add(&mut self, cell: u32, inside: &mut Vec<u32>) -> u32 {
        let index = &mut self.index_of[cell as usize];
        if *index == NO_CELL {
            *index = inside.len() as u32;
            inside.push(cell);
        }
        *index
    }
}

impl State {
    /// The star of a vertex and the cells that would replace it; `None` if all other vertices span no volume.
    ///
    /// The orthogonal sphere of a cell that replaces part of the star is in conflict with no other vertex, in particular no neighbour of
    /// the vertex. So it is a cell of the triangulation of the neighbours, of which the part within the boundary
    /// of the star is taken.
    pub(super) fn hole(
        &self,
        screen: &Screen<'_>,
        v: u32,
        workspace: &mut Workspace,
    ) -> Result<Option<Hole>, TriangulationError> {
        let (star, boundary) = self.star(v);
        let corners = boundary.iter().flat_map(|facet| facet.0);
        let mut around: Vec<u32> = corners.filter(|&w| w != AT_INFINITY).collect();
        around.sort_unstable();
        around.dedup();
        if !workspace.triangulate(screen, &around)? {
            // A peak over a plane of neighbours: with points beyond the plane they span a volume. The cells that
            // fill the hole are cells of any set of vertices that has their corners.
            around.extend(boundary.iter().map(|&(_, outside)| self.corner(outside)));
            around.retain(|&w| w != AT_INFINITY);
            around.sort_unstable();
            around.dedup();
            if !workspace.triangulate(screen, &around)? {
                return Ok(None);
            }
        }
        Ok(workspace.fill(star, &boundary))
    }

    /// The vertex of the cell 4·cell + corner that is this corner.
    fn corner(&self, side: u32) -> u32 {
        self.builder.mesh.cells[side as usize / 4].corners[side as usize % 4]
    }

    /// The star of a vertex: its cells, and for each the facet opposite the vertex (its link) with 4·cell + corner on the other
    /// side.
    fn star(&self, v: u32) -> (Vec<u32>, Vec<([u32; 3], u32)>) {
        let (mut star, mut boundary) = (vec![self.cell_at[v as usize]], Vec::new());
        while let Some(&cell) = star.get(boundary.len()) {
            let Cell { corners, neighbors } = self.builder.mesh.cells[cell as usize];
            for k in 0..4 {
                let next = neighbors[k] / 4;
                if corners[k] == v {
                    boundary.push((smallest_first(facets(corners)[k]), neighbors[k]));
                } else if !star.contains(&next) {
                    star.push(next);
                }
            }
        }
        (star, boundary)
    }

    /// Removes a vertex: replaces its star by the filling.
    pub(super) fn close(&mut self, v: u32, hole: &Hole) -> Result<(), TriangulationError> {
        let Hole { star, filling, boundary } = hole;
        let mut slots = star.clone();
        let builder = &mut self.builder;
        if slots.len() > filling.len() {
            builder.free_slots.extend(slots.drain(filling.len()..));
        }
        while slots.len() < filling.len() {
            slots.push(match builder.free_slots.pop() {
                Some(slot) => slot,
                None => builder.new_cell()?,
            });
        }
        for (Cell { corners, neighbors }, &slot) in filling.iter().zip(&slots) {
            let neighbors = neighbors.map(|side| match slots.get(side as usize / 4) {
                Some(next) => 4 * next + side % 4,
                // Across a facet, which is joined below.
                None => 0,
            });
            builder.mesh.cells[slot as usize] = Cell { corners: *corners, neighbors };
        }
        for &[inside, outside] in boundary {
            builder.mesh.join(4 * slots[inside as usize / 4] + inside % 4, outside);
        }
        builder.hint = slots[0];
        self.cell_at[v as usize] = NO_CELL;
        slots.into_iter().for_each(|slot| self.record_cell(slot));
        Ok(())
    }
}

impl Builder {
    /// Appends a cell.
    fn new_cell(&mut self) -> Result<u32, TriangulationError> {
        let count = self.mesh.cells.len();
        if count == Triangulation::MAX_CELLS {
            return Err(TriangulationError::TooManyCells);
        }
        self.reserve(1)?;
        self.mesh.cells.push(Cell::default());
        self.stamps.push(0);
        Ok(count as u32)
    }
}
