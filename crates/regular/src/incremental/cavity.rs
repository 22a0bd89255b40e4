//! The cavity of a new point: the cells in conflict with it, and the new cells that replace them.

use super::{Builder, Mesh};
use crate::kernel::Screen;
use crate::{Cell, Triangulation, TriangulationError, filled};

/// Side of [`Cavity::table`]: the largest number of distinct vertices of the boundary of a cavity, including the infinite vertex,
/// whose cells are joined by table. A power of two.
const TABLE_SIDE: usize = 64;

/// Working memory of an insertion, kept so that the next one need not allocate.
#[derive(Debug)]
pub(super) struct Cavity {
    /// The cells in conflict with the point. Empty after their slots are given to new cells.
    conflicts: Vec<u32>,
    /// The slots of the new cells, one for each facet of the boundary.
    new_cells: Vec<u32>,
    /// The facets of its boundary, followed by at least four unused elements while facets are added.
    boundary: Vec<Facet>,
    /// Number of facets of the boundary.
    facets: usize,
    /// Vertices of the boundary have local numbers 0, 1, … in the order in which they are met. For each vertex this is `base`
    /// plus the local number; less than `base` for vertices that were not met in this insertion.
    local_numbers: Vec<u32>,
    base: u32,
    /// Number of distinct vertices of the boundary.
    vertices: u32,
    /// For the local numbers of two vertices x, y: 4·cell + corner of the new facet with vertices v, x, y, where v is the new
    /// point.
    table: Box<[u32; TABLE_SIDE * TABLE_SIDE]>,
    /// Stamp of cells that this insertion visited and that are not in conflict; `stamp + 1` is the stamp of cells in conflict.
    /// All older stamps are smaller.
    stamp: u32,
}

/// A boundary facet of the cavity.
#[derive(Clone, Copy, Debug, Default)]
struct Facet {
    /// Its vertices; with the new point as fourth corner they form a positively oriented cell.
    corners: [u32; 3],
    /// The facet as 4·cell + corner of the cell outside the cavity.
    outside: u32,
}

/// The corner of new cells that is the new point.
const APEX: u32 = 3;

impl Cavity {
    /// Creates the work space for vertices with numbers below `below`.
    pub(super) fn new(below: usize) -> Result<Self, TriangulationError> {
        let local_numbers = filled(below, 0)?;
        Ok(Self {
            conflicts: Vec::new(),
            new_cells: Vec::new(),
            boundary: vec![Facet::default(); 4],
            facets: 0,
            local_numbers,
            base: 1,
            vertices: 0,
            table: vec![0; TABLE_SIDE * TABLE_SIDE].try_into().expect("as long"),
            stamp: 0,
        })
    }

    /// Admits vertices with numbers below `below`.
    pub(super) fn grow(&mut self, below: usize) {
        self.local_numbers.resize(self.local_numbers.len().max(below), 0);
    }

    /// The cells that the last insertion made.
    pub(super) fn new_cells(&self) -> &[u32] {
        &self.new_cells
    }

    /// Prepares for the next point.
    fn clear(&mut self, stamps: &mut [u32]) {
        self.conflicts.clear();
        self.facets = 0;
        self.base += self.vertices;
        self.vertices = 0;
        self.stamp += 2;
        // The numbers of one cavity fit the upper half of u32.
        if self.base > u32::MAX / 2 {
            self.local_numbers.fill(0);
            self.base = 1;
        }
        if self.stamp > u32::MAX / 2 {
            stamps.fill(0);
            self.stamp = 2;
        }
    }
}

impl Builder {
    /// Collects the cells in conflict with a point, starting with one of them, and their boundary facets.
    pub(super) fn find_cavity(&mut self, screen: &Screen<'_>, start: u32, v: u32) {
        let Self { mesh, stamps, cavity, .. } = self;
        cavity.clear(stamps);
        let visited = cavity.stamp;
        stamps[start as usize] = visited + 1;
        cavity.conflicts.push(start);
        let mut at = 0;
        while let Some(&cell) = cavity.conflicts.get(at) {
            at += 1;
            let across = mesh.cells[cell as usize].neighbors;
            let mut kept = 0;
            for (corner, outside) in across.into_iter().enumerate() {
                let next = outside / 4;
                let stamp = &mut stamps[next as usize];
                if *stamp < visited {
                    let in_conflict = mesh.conflicts(screen, next, v);
                    *stamp = visited + u32::from(in_conflict);
                    if in_conflict {
                        cavity.conflicts.push(next);
                    }
                }
                kept |= usize::from(*stamp == visited) << corner;
            }
            cavity.add_boundary(mesh.cells[cell as usize].corners, across, kept);
        }
    }

    /// Replaces the cells of the cavity by cells that join its boundary facets to the point.
    pub(super) fn fill_cavity(&mut self, v: u32) -> Result<(), TriangulationError> {
        self.assign_slots()?;
        self.write_cells(v);
        let Self { mesh, cavity, .. } = self;
        if cavity.vertices as usize <= TABLE_SIDE {
            cavity.join_by_table(mesh);
        } else {
            cavity.join_by_sorting(mesh);
        }
        self.hint = cavity.new_cells[cavity.facets - 1];
        Ok(())
    }

    /// Assigns slots to the new cells: first those of the cells in conflict, then free ones, then new ones.
    fn assign_slots(&mut self) -> Result<(), TriangulationError> {
        let wanted = self.cavity.facets;
        // Exchanged rather than copied, because the result of the last insertion is no longer needed.
        std::mem::swap(&mut self.cavity.conflicts, &mut self.cavity.new_cells);
        self.cavity.conflicts.clear();
        let slots = &mut self.cavity.new_cells;
        if wanted < slots.len() {
            self.free_slots.extend(slots.drain(wanted..));
        }
        let reused = self.free_slots.len() - (wanted - slots.len()).min(self.free_slots.len());
        slots.extend(self.free_slots.drain(reused..));
        let more = wanted - slots.len();
        if more > 0 {
            let count = self.mesh.cells.len();
            if count + more > Triangulation::MAX_CELLS {
                return Err(TriangulationError::TooManyCells);
            }
            slots.extend(count as u32..(count + more) as u32);
            self.reserve(more)?;
            self.mesh.cells.resize(count + more, Cell::default());
            self.stamps.resize(count + more, 0);
        }
        Ok(())
    }

    /// Writes the corners of the new cells, makes them the neighbours of the cells outside, and enters their other
    /// facets in the table. Each edge of the boundary is in two boundary facets, whose orientations run along it in
    /// opposite directions: the entries (x, y) and (y, x).
    fn write_cells(&mut self, v: u32) {
        let Self { mesh, cavity, .. } = self;
        let Cavity { boundary, facets, new_cells, local_numbers, base, vertices, table, .. } =
            cavity;
        let mut number = |v: u32| {
            let number = &mut local_numbers[v as usize];
            let is_new = *number < *base;
            *number = if is_new { *base + *vertices } else { *number };
            *vertices += u32::from(is_new);
            *number - *base
        };
        for (facet, &new) in boundary[..*facets].iter().zip(&*new_cells) {
            let Facet { corners: [a, b, c], outside } = *facet;
            mesh.cells[new as usize].corners = [a, b, c, v];
            mesh.cells[outside as usize / 4].neighbors[outside as usize % 4] = 4 * new + APEX;
            let (a, b, c) = (number(a), number(b), number(c));
            for (corner, x, y) in [(0, b, c), (1, c, a), (2, a, b)] {
                table[table_index(x, y)] = 4 * new + corner;
            }
        }
    }
}

/// The entry of an edge of the boundary, by the local numbers of its vertices. If there are too many vertices for the table, the
/// entry is still within bounds, but is not used.
#[inline(always)]
fn table_index(x: u32, y: u32) -> usize {
    (x as usize * TABLE_SIDE + y as usize) % (TABLE_SIDE * TABLE_SIDE)
}

impl Cavity {
    /// Adds the boundary facets of a cell in conflict: bit k of `kept` says whether the neighbour opposite corner k
    /// is not in conflict. All four facets are written, and those that are not boundary facets are overwritten by
    /// the next: branches would be mispredicted half the time.
    #[inline(always)]
    fn add_boundary(&mut self, cell: [u32; 4], across: [u32; 4], kept: usize) {
        if self.boundary.len() < self.facets + 4 {
            self.boundary.resize(2 * self.boundary.len(), Facet::default());
        }
        let unused = self.boundary[self.facets..].first_chunk_mut::<4>();
        let unused = unused.expect("resized above");
        let [a, b, c, d] = cell;
        let facets = [[b, d, c], [a, c, d], [b, a, d], [a, b, c]];
        let mut at = 0;
        for (k, (corners, outside)) in facets.into_iter().zip(across).enumerate() {
            unused[at % 4] = Facet { corners, outside };
            at += kept >> k & 1;
        }
        self.facets += at;
    }

    /// Makes new cells the neighbours of each other, by the table.
    fn join_by_table(&mut self, mesh: &mut Mesh) {
        for (facet, &new) in self.boundary[..self.facets].iter().zip(&self.new_cells) {
            let Facet { corners: [a, b, c], outside } = *facet;
            let number = |v: u32| self.local_numbers[v as usize] - self.base;
            let (a, b, c) = (number(a), number(b), number(c));
            let neighbor = |x: u32, y: u32| self.table[table_index(x, y)];
            mesh.cells[new as usize].neighbors =
                [neighbor(c, b), neighbor(a, c), neighbor(b, a), outside];
        }
    }

    /// Makes new cells the neighbours of each other, for more vertices than the table holds: sorting by edge brings the two
    /// facets at each edge together.
    fn join_by_sorting(&mut self, mesh: &mut Mesh) {
        let mut edges = Vec::with_capacity(3 * self.facets);
        for (facet, &new) in self.boundary[..self.facets].iter().zip(&self.new_cells) {
            let [a, b, c] = facet.corners;
            mesh.cells[new as usize].neighbors[APEX as usize] = facet.outside;
            for (corner, x, y) in [(0, b, c), (1, c, a), (2, a, b)] {
                edges.push(((x.min(y), x.max(y)), 4 * new + corner));
            }
        }
        edges.sort_unstable();
        for pair in edges.chunks_exact(2) {
            mesh.join(pair[0].1, pair[1].1);
        }
    }
}
