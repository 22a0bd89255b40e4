//! The cells that go when a point comes, and those that take their place.

use super::super::{Triangulation, TriangulationError, filled};
use super::{Mesh, Native};

/// So many different corners of a cavity's boundary, the ghost among them, fit the table.
const TABLE: usize = 64;

/// What one insertion works with; kept so that the next need not allocate.
pub(super) struct Cavity {
    /// The cells that go.
    cells: Vec<u32>,
    /// Cells of the cavity whose neighbours were not looked at yet.
    pending: Vec<u32>,
    boundary: Vec<Facet>,
    /// Corners of the boundary have numbers of their own, from 0: this is `base` plus that for those
    /// that have been met in this insertion, less than `base` for all others.
    names: Vec<u32>,
    base: u32,
    /// How many there are.
    corners: u32,
    /// By the own numbers of two corners x, y: 4·cell + corner of the new facet that holds v, x, y.
    table: Box<[u32; TABLE * TABLE]>,
    /// The mark of cells seen from this cavity and left alone; one more is that of its own cells.
    seen: u32,
}

/// A facet of the boundary with the new point in place of the corner opposite.
struct Facet {
    corners: [u32; 4],
    /// Their numbers on the boundary; that of the new point means nothing.
    numbers: [u32; 4],
    /// The place of the new point.
    apex: u32,
    /// 4·cell + corner outside the cavity.
    outside: u32,
}

/// For a cell with the new point at a place: the corner opposite each of the other facets, and the
/// other two corners x, y, such that (point, corner, x, y) is an even permutation. The facet beyond
/// has the same with y, x.
const AROUND: [[[usize; 3]; 3]; 4] = [
    [[1, 2, 3], [2, 3, 1], [3, 1, 2]],
    [[0, 3, 2], [2, 0, 3], [3, 2, 0]],
    [[0, 1, 3], [1, 3, 0], [3, 0, 1]],
    [[0, 2, 1], [1, 0, 2], [2, 1, 0]],
];

impl Cavity {
    pub fn new(ghost: u32) -> Result<Self, TriangulationError> {
        let count = ghost as usize + 1;
        let names = filled(count, 0)?;
        Ok(Self {
            cells: Vec::new(),
            pending: Vec::new(),
            boundary: Vec::new(),
            names,
            base: 1,
            corners: 0,
            table: vec![0; TABLE * TABLE].try_into().expect("as long"),
            seen: 0,
        })
    }

    /// Forgets the last cavity.
    fn clear(&mut self, marks: &mut [u32]) {
        self.cells.clear();
        self.boundary.clear();
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

impl Native<'_> {
    /// Collects the cells in conflict with a point, beginning with one, and their boundary.
    pub(super) fn dig(&mut self, start: u32, v: u32) {
        let Self { screen, mesh, marks, cavity, .. } = self;
        cavity.clear(marks);
        let seen = cavity.seen;
        marks[start as usize] = seen + 1;
        cavity.pending.push(start);
        while let Some(cell) = cavity.pending.pop() {
            cavity.cells.push(cell);
            let corners = mesh.cells[cell as usize];
            let across = mesh.beside[cell as usize];
            for apex in 0..4 {
                let outside = across[apex];
                let next = outside / 4;
                let mark = &mut marks[next as usize];
                if *mark < seen {
                    let goes = mesh.conflicts(screen, next, v);
                    *mark = seen + u32::from(goes);
                    if goes {
                        cavity.pending.push(next);
                    }
                }
                if *mark == seen {
                    let mut corners = corners;
                    corners[apex] = v;
                    cavity.boundary.push(Facet {
                        corners,
                        numbers: [0; 4],
                        apex: apex as u32,
                        outside,
                    });
                }
            }
        }
    }

    /// Joins the point to the boundary of the cavity.
    pub(super) fn fill(&mut self) -> Result<(), TriangulationError> {
        self.make_room()?;
        self.write();
        let Self { mesh, cavity, .. } = self;
        if cavity.corners as usize <= TABLE {
            cavity.join_by_table(mesh);
        } else {
            cavity.join_by_sorting(mesh);
        }
        self.near = cavity.cells[cavity.boundary.len() - 1];
        Ok(())
    }

    /// Finds places for the new cells: those of the cavity first, then others that are free, then
    /// new ones.
    fn make_room(&mut self) -> Result<(), TriangulationError> {
        let wanted = self.cavity.boundary.len();
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
            self.mesh.cells.resize(count + more, [0; 4]);
            self.mesh.beside.resize(count + more, [0; 4]);
            self.marks.resize(count + more, 0);
        }
        Ok(())
    }

    /// Writes the new cells and joins them to what is outside; notes in the table where they meet
    /// each other: each edge of the boundary is in two facets, which run along it in opposite
    /// directions.
    fn write(&mut self) {
        let Self { mesh, marks, cavity, .. } = self;
        let Cavity { boundary, cells, names, base, corners, table, .. } = cavity;
        let mut number = |v: u32| {
            let name = &mut names[v as usize];
            if *name < *base {
                *name = *base + *corners;
                *corners += 1;
            }
            *name - *base
        };
        for (facet, &place) in boundary.iter_mut().zip(&*cells) {
            mesh.cells[place as usize] = facet.corners;
            marks[place as usize] = 0;
            mesh.join(4 * place + facet.apex, facet.outside);
            let [[p, ..], [q, ..], [r, ..]] = AROUND[facet.apex as usize % 4];
            for k in [p, q, r] {
                facet.numbers[k] = number(facet.corners[k]);
            }
            for [corner, x, y] in AROUND[facet.apex as usize % 4] {
                table[slot(facet.numbers[x], facet.numbers[y])] = 4 * place + corner as u32;
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
    /// Joins new cells to each other.
    fn join_by_table(&mut self, mesh: &mut Mesh) {
        for (facet, &place) in self.boundary.iter().zip(&self.cells) {
            let beside = &mut mesh.beside[place as usize];
            for [corner, x, y] in AROUND[facet.apex as usize % 4] {
                beside[corner] = self.table[slot(facet.numbers[y], facet.numbers[x])];
            }
        }
    }

    /// The same with more corners than the table has room for: the two facets at an edge meet by
    /// sorting.
    fn join_by_sorting(&mut self, mesh: &mut Mesh) {
        let mut edges = Vec::with_capacity(3 * self.boundary.len());
        for (facet, &place) in self.boundary.iter().zip(&self.cells) {
            for [corner, x, y] in AROUND[facet.apex as usize] {
                let (x, y) = (facet.corners[x], facet.corners[y]);
                edges.push(((x.min(y), x.max(y)), 4 * place + corner as u32));
            }
        }
        edges.sort_unstable();
        for pair in edges.chunks_exact(2) {
            mesh.join(pair[0].1, pair[1].1);
        }
    }
}
