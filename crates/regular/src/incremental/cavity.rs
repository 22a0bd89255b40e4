//! The cells that go when a point comes, and those that take their place.

use super::{Builder, Mesh};
use crate::predicates::Screen;
use crate::{Cell, Triangulation, TriangulationError, filled};

/// So many different corners of a cavity's boundary, the ghost among them, fit the table.
const TABLE: usize = 64;

/// What one insertion works with; kept so that the next need not allocate.
pub(super) struct Cavity {
    /// The cells that go; later the places of the new ones.
    cells: Vec<u32>,
    /// The facets of its boundary, and room for those of one more cell.
    boundary: Vec<Facet>,
    /// Number of facets of the boundary.
    facets: usize,
    /// Corners of the boundary have numbers of their own, from 0: this is `base` plus that for those
    /// that have been met in this insertion, less than `base` for all others.
    names: Vec<u32>,
    base: u32,
    /// Number of distinct corners of the boundary.
    corners: u32,
    /// By the own numbers of two corners x, y: 4·cell + corner of the new facet that holds v, x, y.
    table: Box<[u32; TABLE * TABLE]>,
    /// The mark of cells seen from this cavity and left alone; one more is that of its own cells.
    seen: u32,
}

/// A facet of the boundary.
#[derive(Clone, Copy, Default)]
struct Facet {
    /// With the new point these make a positively oriented cell.
    corners: [u32; 3],
    /// 4·cell + corner outside the cavity.
    outside: u32,
}

/// The new point's place in new cells.
const APEX: u32 = 3;

impl Cavity {
    /// For points with numbers below one.
    pub(super) fn new(below: usize) -> Result<Self, TriangulationError> {
        let names = filled(below, 0)?;
        Ok(Self {
            cells: Vec::new(),
            boundary: vec![Facet::default(); 4],
            facets: 0,
            names,
            base: 1,
            corners: 0,
            table: vec![0; TABLE * TABLE].try_into().expect("as long"),
            seen: 0,
        })
    }

    /// Makes room for points of larger numbers.
    pub(super) fn admit(&mut self, below: usize) {
        self.names.resize(self.names.len().max(below), 0);
    }

    /// The cells that the last insertion made.
    pub(super) fn made(&self) -> &[u32] {
        &self.cells[..self.facets]
    }

    /// Forgets the last cavity.
    fn clear(&mut self, marks: &mut [u32]) {
        self.cells.clear();
        self.facets = 0;
        self.base += self.corners;
        self.corners = 0;
        self.seen += 2;
        // Half the numbers are left for one cavity.
        if self.base > u32::MAX / 2 {
            self.names.fill(0);
            self.base = 1;
        }
        if self.seen > u32::MAX / 2 {
            marks.fill(0);
            self.seen = 2;
        }
    }
}

impl Builder {
    /// Collects the cells in conflict with a point, beginning with one, and their boundary.
    pub(super) fn dig(&mut self, screen: &Screen<'_>, start: u32, v: u32) {
        let Self { mesh, marks, cavity, .. } = self;
        cavity.clear(marks);
        let seen = cavity.seen;
        marks[start as usize] = seen + 1;
        cavity.cells.push(start);
        let mut at = 0;
        while let Some(&cell) = cavity.cells.get(at) {
            at += 1;
            let across = mesh.cells[cell as usize].neighbors;
            let mut stays = 0;
            for (corner, outside) in across.into_iter().enumerate() {
                let next = outside / 4;
                let mark = &mut marks[next as usize];
                if *mark < seen {
                    let goes = mesh.conflicts(screen, next, v);
                    *mark = seen + u32::from(goes);
                    if goes {
                        cavity.cells.push(next);
                    }
                }
                stays |= usize::from(*mark == seen) << corner;
            }
            cavity.bound(mesh.cells[cell as usize].corners, across, stays);
        }
    }

    /// Joins the point to the boundary of the cavity.
    pub(super) fn fill(&mut self, v: u32) -> Result<(), TriangulationError> {
        self.make_room()?;
        self.write(v);
        let Self { mesh, cavity, .. } = self;
        if cavity.corners as usize <= TABLE {
            cavity.join_by_table(mesh);
        } else {
            cavity.join_by_sorting(mesh);
        }
        self.near = cavity.cells[cavity.facets - 1];
        Ok(())
    }

    /// Finds places for the new cells: those of the cavity first, then others that are free, then
    /// new ones.
    fn make_room(&mut self) -> Result<(), TriangulationError> {
        let wanted = self.cavity.facets;
        let places = &mut self.cavity.cells;
        if wanted < places.len() {
            self.free.extend(places.drain(wanted..));
        }
        let reused = self.free.len() - (wanted - places.len()).min(self.free.len());
        places.extend(self.free.drain(reused..));
        let more = wanted - places.len();
        if more > 0 {
            let count = self.mesh.cells.len();
            if count + more > Triangulation::MOST_CELLS {
                return Err(TriangulationError::TooManyCells);
            }
            places.extend(count as u32..(count + more) as u32);
            self.reserve(more)?;
            self.mesh.cells.resize(count + more, Cell::default());
            self.marks.resize(count + more, 0);
        }
        Ok(())
    }

    /// Writes the new cells, links them to the cells outside, and notes in the table where they meet
    /// each other: each edge of the boundary is in two facets, which run along it in opposite
    /// directions.
    fn write(&mut self, v: u32) {
        let Self { mesh, cavity, .. } = self;
        let Cavity { boundary, facets, cells, names, base, corners, table, .. } = cavity;
        let mut number = |v: u32| {
            let name = &mut names[v as usize];
            let is_new = *name < *base;
            *name = if is_new { *base + *corners } else { *name };
            *corners += u32::from(is_new);
            *name - *base
        };
        for (facet, &place) in boundary[..*facets].iter().zip(&*cells) {
            let Facet { corners: [a, b, c], outside } = *facet;
            mesh.cells[place as usize].corners = [a, b, c, v];
            mesh.cells[outside as usize / 4].neighbors[outside as usize % 4] = 4 * place + APEX;
            let (a, b, c) = (number(a), number(b), number(c));
            for (corner, x, y) in [(0, b, c), (1, c, a), (2, a, b)] {
                table[slot(x, y)] = 4 * place + corner;
            }
        }
    }
}

/// The place of an edge of the boundary in the table.
#[inline(always)]
fn slot(x: u32, y: u32) -> usize {
    (x as usize * TABLE + y as usize) % (TABLE * TABLE)
}

impl Cavity {
    /// Adds the facets of a cell beyond which cells stay. They are written anyway, without branches
    /// that would be guessed wrong half the time, and the next ones take the place of others.
    #[inline(always)]
    fn bound(&mut self, cell: [u32; 4], across: [u32; 4], stays: usize) {
        if self.boundary.len() < self.facets + 4 {
            self.boundary.resize(2 * self.boundary.len(), Facet::default());
        }
        let room = self.boundary[self.facets..].first_chunk_mut::<4>();
        let room = room.expect("made above");
        let [a, b, c, d] = cell;
        let facets = [[b, d, c], [a, c, d], [b, a, d], [a, b, c]];
        let mut at = 0;
        for (k, (corners, outside)) in facets.into_iter().zip(across).enumerate() {
            room[at % 4] = Facet { corners, outside };
            at += stays >> k & 1;
        }
        self.facets += at;
    }

    /// Joins new cells to each other.
    fn join_by_table(&mut self, mesh: &mut Mesh) {
        for (facet, &place) in self.boundary[..self.facets].iter().zip(&self.cells) {
            let Facet { corners: [a, b, c], outside } = *facet;
            let number = |v: u32| self.names[v as usize] - self.base;
            let (a, b, c) = (number(a), number(b), number(c));
            let neighbors = |x: u32, y: u32| self.table[slot(x, y)];
            mesh.cells[place as usize].neighbors =
                [neighbors(c, b), neighbors(a, c), neighbors(b, a), outside];
        }
    }

    /// The same with more corners than the table has room for: the two facets at an edge meet by
    /// sorting.
    fn join_by_sorting(&mut self, mesh: &mut Mesh) {
        let mut edges = Vec::with_capacity(3 * self.facets);
        for (facet, &place) in self.boundary[..self.facets].iter().zip(&self.cells) {
            let [a, b, c] = facet.corners;
            mesh.cells[place as usize].neighbors[APEX as usize] = facet.outside;
            for (corner, x, y) in [(0, b, c), (1, c, a), (2, a, b)] {
                edges.push(((x.min(y), x.max(y)), 4 * place + corner));
            }
        }
        edges.sort_unstable();
        for pair in edges.chunks_exact(2) {
            mesh.join(pair[0].1, pair[1].1);
        }
    }
}
