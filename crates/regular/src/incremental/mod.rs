//! Incremental insertion (Bowyer 1981, doi:10.1093/comjnl/24.2.162; Watson 1981,
//! doi:10.1093/comjnl/24.2.167) with weights, over flat arrays.
//!
//! 1. Points are inserted in [`rounds`]. Within a round they follow a space-filling curve
//!    ([`Sites::curve`](super::Sites::curve)), so that the cells and points touched are in the cache.
//! 2. A walk from the last new cell finds the cell that contains the point ([`Builder::locate`]). If the
//!    point is not in conflict with that cell, that is not inside its orthogonal sphere, it is hidden.
//! 3. The cells in conflict with the point are connected: the cavity. New cells join the point to the
//!    boundary facets of the cavity ([`cavity`]) and reuse the slots of the old cells.

mod cavity;
mod growing;
mod removal;

use std::cmp::Ordering;

use walpha_base::Cancelled;
use walpha_base::memory::asking;

use super::kernel::{Predicates, Screen};
use super::order::rounds;
use super::{CellArrays, DELETED, SitesError, TriangulationError, no_memory};
use cavity::Cavity;
pub use growing::Growing;
pub use removal::Workspace;

/// A cell under construction.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cell {
    /// Its corners.
    pub corners: [u32; 4],
    /// 4·cell + corner across the facet opposite each.
    pub neighbors: [u32; 4],
}

/// Insertions between two reports of progress: some milliseconds.
const REPORT_EVERY: usize = 4096;

/// The regular triangulation of points, which satisfy the conditions of [`Sites`](super::Sites) and follow a space-filling curve.
/// `inserted` is called from time to time with the number of points inserted since the last call. Expected O(n log n) for evenly
/// distributed points.
///
/// # Errors
/// Points that span no volume; too many cells; out of memory; what `inserted` returns.
pub fn insert_all(
    positions: &[[f64; 3]],
    weights: &[f64],
    inserted: impl FnMut(usize) -> Result<(), Cancelled>,
) -> Result<CellArrays, TriangulationError> {
    let Built { cells, at_infinity, .. } = insert_cells(positions, weights, inserted)?;
    CellArrays::of_cells(cells, at_infinity)
}

/// Like [`insert_all`], with cells in the order of their creation. The corner 0 of free slots is [`DELETED`].
pub(crate) fn insert_cells(
    positions: &[[f64; 3]],
    weights: &[f64],
    mut inserted: impl FnMut(usize) -> Result<(), Cancelled>,
) -> Result<Built, TriangulationError> {
    let predicates = Predicates::new(positions, weights);
    let screen = Screen::new(&predicates)?;
    let count = screen.count() as u32;
    let mut builder = Builder::with_capacity(screen.count(), screen.count() + 1, count)?;
    builder.start(&screen, 0..count)?;
    for (i, v) in rounds(count).enumerate() {
        if i % REPORT_EVERY == REPORT_EVERY - 1 {
            inserted(REPORT_EVERY)?;
        }
        if !builder.first_cell.contains(&v) {
            builder.insert(&screen, v)?;
        }
    }
    Ok(builder.finish())
}

/// A triangulation whose cells are in the slots of their creation.
pub(crate) struct Built {
    pub cells: Vec<Cell>,
    /// Slots of deleted cells.
    pub free_slots: Vec<u32>,
    pub at_infinity: u32,
}

/// Memory is reserved for this many cells per point, and 1/16 more. A Poisson–Delaunay triangulation has
/// about 6.8; some more exist during construction.
const CELLS_PER_POINT: usize = 7;
/// The minimum number of cells that are reserved.
const MIN_CELLS: usize = 64;
/// Memory of a cell: itself and its visit stamp.
const CELL_BYTES: usize = size_of::<Cell>() + size_of::<u32>();

/// A triangulation under construction.
#[derive(Debug)]
struct Builder {
    mesh: Mesh,
    /// Visit stamp per cell: the last insertion that visited it, and whether the cell was in conflict. See
    /// `Cavity::stamp`.
    stamps: Vec<u32>,
    /// Slots of deleted cells, to be reused.
    free_slots: Vec<u32>,
    /// The corners of the cell that construction started from.
    first_cell: [u32; 4],
    /// The start of the next walk: a cell at the last vertex.
    hint: u32,
    cavity: Cavity,
}

impl Builder {
    /// An empty triangulation with capacity for `points` points. All vertex numbers, including that of the infinite vertex, are
    /// below `below`.
    fn with_capacity(
        points: usize,
        below: usize,
        at_infinity: u32,
    ) -> Result<Self, TriangulationError> {
        let expected = (points + points / 16).saturating_mul(CELLS_PER_POINT).max(MIN_CELLS);
        let mut builder = Self {
            mesh: Mesh { cells: Vec::new(), at_infinity },
            stamps: Vec::new(),
            free_slots: Vec::new(),
            first_cell: [at_infinity; 4],
            hint: 0,
            cavity: Cavity::new(below)?,
        };
        builder.reserve(expected)?;
        Ok(builder)
    }

    /// Starts with four of some points that span a volume: one cell and the four infinite cells around it. O(n) if the first
    /// points span none.
    fn start(
        &mut self,
        screen: &Screen<'_>,
        points: impl Iterator<Item = u32> + Clone,
    ) -> Result<(), TriangulationError> {
        let Self {
            mesh: Mesh { cells, at_infinity }, stamps, free_slots, first_cell, hint, ..
        } = self;
        *first_cell = spanning(screen, points)?;
        cells.clear();
        free_slots.clear();
        stamps.clear();
        *hint = 0;
        cells.push(Cell { corners: *first_cell, neighbors: [0; 4] });
        for corner in 0..4 {
            let mut infinite = *first_cell;
            infinite[corner] = *at_infinity;
            // Seen from outside, the facet has the opposite orientation.
            infinite.swap((corner + 1) % 4, (corner + 2) % 4);
            cells.push(Cell { corners: infinite, neighbors: [0; 4] });
        }
        stamps.resize(5, 0);
        for a in 0..5 {
            for b in 0..5 {
                if let Some([from, to]) = common_facet(cells[a].corners, cells[b].corners) {
                    cells[a].neighbors[from] = (4 * b + to) as u32;
                }
            }
        }
        Ok(())
    }

    /// Reserves memory for `more` more cells.
    fn reserve(&mut self, more: usize) -> Result<(), TriangulationError> {
        let bytes = (self.mesh.cells.len() + more).saturating_mul(CELL_BYTES);
        asking(|| self.mesh.cells.try_reserve(more))
            .and_then(|()| asking(|| self.stamps.try_reserve(more)))
            .map_err(|_| no_memory(bytes))
    }

    /// Inserts a point; `false` if it is hidden.
    fn insert(&mut self, screen: &Screen<'_>, v: u32) -> Result<bool, TriangulationError> {
        let cell = self.locate(screen, v);
        let is_vertex = self.mesh.conflicts(screen, cell, v);
        if is_vertex {
            self.find_cavity(screen, cell, v);
            self.fill_cavity(v)?;
        }
        Ok(is_vertex)
    }

    /// The finite cell that contains a point, or an infinite cell whose facet of the hull has the point strictly
    /// beyond it. Found by a visibility walk: it crosses facets that separate the cell from the point. In a regular
    /// triangulation such a walk never returns to a cell (Edelsbrunner 1990, doi:10.1007/BF02122779).
    #[inline(never)]
    fn locate(&self, screen: &Screen<'_>, v: u32) -> u32 {
        let mut cell = self.hint;
        if let Some(corner) = self.mesh.infinite_corner(cell) {
            cell = self.mesh.cells[cell as usize].neighbors[corner] / 4;
        }
        let mut from = u32::MAX;
        'walk: loop {
            let corners = self.mesh.cells[cell as usize].corners;
            let across = self.mesh.cells[cell as usize].neighbors;
            for corner in 0..4 {
                let next = across[corner] / 4;
                if next == from {
                    continue;
                }
                let mut moved = corners;
                moved[corner] = v;
                if screen.orientation(moved).is_lt() {
                    if self.mesh.infinite_corner(next).is_some() {
                        return next;
                    }
                    from = cell;
                    cell = next;
                    continue 'walk;
                }
            }
            return cell;
        }
    }

    fn finish(self) -> Built {
        let Self { mesh: Mesh { mut cells, at_infinity }, free_slots, .. } = self;
        free_slots.iter().for_each(|&slot| cells[slot as usize].corners[0] = DELETED);
        Built { cells, free_slots, at_infinity }
    }
}

/// Cells and their adjacency as in [`CellArrays`].
#[derive(Debug)]
struct Mesh {
    cells: Vec<Cell>,
    /// The number of the infinite vertex. In [`CellArrays`] it is the number of points, so that the points are
    /// 0, 1, …; in [`Growing`], where points are added later, it is 0 and the points are 1, 2, …
    at_infinity: u32,
}

impl Mesh {
    /// Whether a cell is in conflict with a point: the point lies inside its orthogonal sphere.
    #[inline(always)]
    fn conflicts(&self, screen: &Screen<'_>, cell: u32, v: u32) -> bool {
        let quick = screen.conflicts(self.cells[cell as usize].corners, v);
        quick.unwrap_or_else(|| self.conflicts_exactly(screen, cell, v))
    }

    /// The exact test. The sphere of an infinite cell is the open half-space beyond its facet of the hull; in the plane of that
    /// facet, the sphere of the finite cell behind it decides.
    #[inline(never)]
    fn conflicts_exactly(&self, screen: &Screen<'_>, cell: u32, v: u32) -> bool {
        let mut corners = self.cells[cell as usize].corners;
        let Some(corner) = self.infinite_corner(cell) else {
            return screen.conflicts_exactly(corners, v);
        };
        corners[corner] = v;
        match screen.orientation(corners) {
            Ordering::Greater => true,
            Ordering::Less => false,
            Ordering::Equal => {
                let behind =
                    self.cells[self.cells[cell as usize].neighbors[corner] as usize / 4].corners;
                let quick = screen.conflicts(behind, v);
                quick.unwrap_or_else(|| screen.conflicts_exactly(behind, v))
            }
        }
    }

    /// The corner of a cell that is the infinite vertex; `None` for finite cells.
    #[inline(always)]
    fn infinite_corner(&self, cell: u32) -> Option<usize> {
        self.cells[cell as usize].corners.iter().position(|&v| v == self.at_infinity)
    }

    /// Makes two cells adjacent across the facets 4·cell + corner.
    #[inline(always)]
    fn join(&mut self, a: u32, b: u32) {
        self.cells[a as usize / 4].neighbors[a as usize % 4] = b;
        self.cells[b as usize / 4].neighbors[b as usize % 4] = a;
    }
}

/// The first four points that span a volume, positively oriented.
fn spanning(
    screen: &Screen<'_>,
    mut points: impl Iterator<Item = u32> + Clone,
) -> Result<[u32; 4], TriangulationError> {
    let all = points.clone();
    let flat = |dimension| SitesError::flat(all.clone().count(), dimension);
    let (Some(a), Some(b)) = (points.next(), points.next()) else { return Err(flat(0).into()) };
    let c = points.find(|&c| !screen.collinear([a, b, c])).ok_or_else(|| flat(1))?;
    let sign = |d: u32| screen.orientation([a, b, c, d]);
    let d = points.find(|&d| sign(d).is_ne()).ok_or_else(|| flat(2))?;
    Ok(if sign(d) == Ordering::Greater { [a, b, c, d] } else { [b, a, c, d] })
}

/// The corners opposite the facet that two different cells share, if they share one.
fn common_facet(a: [u32; 4], b: [u32; 4]) -> Option<[usize; 2]> {
    let opposite = |a: [u32; 4], b: [u32; 4]| {
        let mut lone = (0..4).filter(|&k| !b.contains(&a[k]));
        lone.next().filter(|_| lone.next().is_none())
    };
    Some([opposite(a, b)?, opposite(b, a)?])
}
