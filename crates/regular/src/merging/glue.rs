//! Merging the triangulations of two halves.

use walpha_base::Cancelled;

use super::open::{OPEN, flood};
use super::slots::{Marks, Mesh, Slots};
use super::{Half, Points};
use crate::incremental::{Built, insert_cells};
use crate::{Cell, DELETED, TriangulationError, facets, smallest_first};

/// Stands for the absence of a cell or facet.
const NONE: u32 = u32::MAX;

/// The triangulation of the points of two halves. `None` if more than the part `max_open` of all points are corners of open
/// cells, or a leaf has no slots left.
///
/// # Errors
/// Out of memory; what `inserted` returns.
pub(super) fn merge(
    a: Half,
    b: Half,
    points: &Points<'_>,
    max_open: f64,
    inserted: impl FnMut(usize) -> Result<(), Cancelled>,
) -> Result<Option<Half>, TriangulationError> {
    let all = a.points.start..b.points.end;
    let extent = a.extent.union(&b.extent);
    let mut corners = Corners::new(all.start, all.len(), points.at_infinity);
    let (mut mesh, mut infinite) = (a.mesh, Vec::new());
    for (half, of_half, other) in [(&a.points, &mesh, &b.extent), (&b.points, &b.mesh, &a.extent)] {
        if of_half.spans() {
            infinite.push((of_half.infinite, other));
        } else {
            half.clone().for_each(|v| corners.add(v as u32));
        }
    }
    mesh.append(b.mesh);
    let (mut open, mut marks) = (Vec::new(), mesh.slots.marks());
    for (start, other) in infinite {
        flood(&mesh.slots, start, other, points, &mut marks, &mut open);
    }
    let boundary = boundary_of(&mesh.slots, &open, &mut marks);
    drop(marks);
    for &slot in &open {
        mesh.slots.get(slot).corners.into_iter().for_each(|v| corners.add(v));
    }
    if corners.list.len() as f64 > max_open * all.len() as f64 {
        return Ok(None);
    }
    corners.number();
    let positions: Vec<_> = corners.list.iter().map(|&v| points.positions[v as usize]).collect();
    let weights: Vec<_> = corners.list.iter().map(|&v| points.weights[v as usize]).collect();
    let built = match insert_cells(&positions, &weights, inserted) {
        Ok(built) => built,
        Err(TriangulationError::Sites(_)) if !mesh.spans() => {
            return Ok(Some(Half { points: all, extent, mesh }));
        }
        Err(error) => return Err(error),
    };
    let filling = Filling::of(built, &boundary, &corners, mesh.count == open.len());
    Ok(filling.fill(&mut mesh, open).then_some(Half { points: all, extent, mesh }))
}

/// A facet between an open cell and a kept cell.
struct Facet {
    /// Its vertices, which with a point on the side of the open cell form a positively oriented cell.
    corners: [u32; 3],
    /// 4·slot + corner of the kept cell.
    kept: u32,
}

fn boundary_of(slots: &Slots, open: &[u32], marks: &mut Marks) -> Vec<Facet> {
    let mut boundary = Vec::new();
    for &slot in open {
        let Cell { corners, neighbors } = *slots.get(slot);
        for (corners, kept) in facets(corners).into_iter().zip(neighbors) {
            if *marks.of(kept / 4) != OPEN {
                boundary.push(Facet { corners, kept });
            }
        }
    }
    boundary
}

/// The corners of open cells, numbered along the curve.
struct Corners {
    first: usize,
    /// For each point of both halves: 1 for corners, and, after they are numbered, their number.
    numbers: Vec<u32>,
    list: Vec<u32>,
    at_infinity: u32,
}

impl Corners {
    fn new(first: usize, count: usize, at_infinity: u32) -> Self {
        Self { first, numbers: vec![0; count], list: Vec::new(), at_infinity }
    }

    fn add(&mut self, v: u32) {
        if v != self.at_infinity {
            let number = &mut self.numbers[v as usize - self.first];
            if *number == 0 {
                *number = 1;
                self.list.push(v);
            }
        }
    }

    /// Numbers the corners.
    fn number(&mut self) {
        self.list.sort_unstable();
        for (number, &v) in (0..).zip(&self.list) {
            self.numbers[v as usize - self.first] = number;
        }
    }

    /// The number of a corner; that of the infinite vertex is the number of corners.
    fn of(&self, v: u32) -> u32 {
        if v == self.at_infinity {
            self.list.len() as u32
        } else {
            self.numbers[v as usize - self.first]
        }
    }

    fn vertex(&self, number: u32) -> u32 {
        self.list.get(number as usize).copied().unwrap_or(self.at_infinity)
    }
}

/// The cells that replace the open ones.
struct Filling<'a> {
    built: Built,
    corners: &'a Corners,
    /// For each 4·cell + corner of `built`: 4·slot + corner of the kept cell, at facets of the boundary.
    kept: Vec<u32>,
    /// The cells that are taken.
    taken: Vec<u32>,
    /// For each cell, its index among those; [`NONE`] for others.
    index: Vec<u32>,
}

impl<'a> Filling<'a> {
    /// Floods from the boundary; without kept cells, all cells are taken.
    fn of(built: Built, boundary: &[Facet], corners: &'a Corners, is_whole: bool) -> Self {
        let by_vertex = FacetTable::of(boundary, corners);
        let count = built.cells.len();
        let mut filling = Self {
            built,
            corners,
            kept: vec![NONE; 4 * count],
            taken: Vec::new(),
            index: vec![NONE; count],
        };
        let mut found = 0;
        for cell in 0..count {
            let vertices = filling.built.cells[cell].corners;
            if vertices[0] == DELETED {
                continue;
            }
            if is_whole {
                filling.take(cell as u32);
            }
            for (corner, facet) in facets(vertices).into_iter().enumerate() {
                if let Some(kept) = by_vertex.get(facet) {
                    filling.kept[4 * cell + corner] = kept;
                    filling.take(cell as u32);
                    found += 1;
                }
            }
        }
        assert_eq!(found, boundary.len(), "the cells next to those that are kept are made again");
        let mut at = 0;
        while let Some(&cell) = filling.taken.get(at) {
            at += 1;
            for (corner, side) in
                filling.built.cells[cell as usize].neighbors.into_iter().enumerate()
            {
                if filling.kept[4 * cell as usize + corner] == NONE {
                    filling.take(side / 4);
                }
            }
        }
        filling
    }

    fn take(&mut self, cell: u32) {
        let index = &mut self.index[cell as usize];
        if *index == NONE {
            *index = self.taken.len() as u32;
            self.taken.push(cell);
        }
    }

    /// Puts the taken cells in the place of the open ones; `false` if slots run out.
    fn fill(&self, mesh: &mut Mesh, open: Vec<u32>) -> bool {
        mesh.count = mesh.count - open.len() + self.taken.len();
        let mut slots = open;
        while slots.len() < self.taken.len() {
            let Some(slot) = mesh.free.pop().or_else(|| mesh.slots.push()) else { return false };
            slots.push(slot);
        }
        for slot in slots.drain(self.taken.len()..) {
            mesh.slots.get_mut(slot).corners[0] = DELETED;
            mesh.free.push(slot);
        }
        let at_infinity = self.corners.list.len() as u32;
        for (&cell, &slot) in self.taken.iter().zip(&slots) {
            let Cell { corners, mut neighbors } = self.built.cells[cell as usize];
            for (corner, side) in (0..).zip(&mut neighbors) {
                let kept = self.kept[(4 * cell + corner) as usize];
                *side = if kept == NONE {
                    4 * slots[self.index[*side as usize / 4] as usize] + *side % 4
                } else {
                    mesh.slots.get_mut(kept / 4).neighbors[kept as usize % 4] = 4 * slot + corner;
                    kept
                };
            }
            if corners.contains(&at_infinity) {
                mesh.infinite = slot;
            }
            let corners = corners.map(|v| self.corners.vertex(v));
            *mesh.slots.get_mut(slot) = Cell { corners, neighbors };
        }
        true
    }
}

/// The facets of a boundary by their smallest corner.
struct FacetTable {
    /// For each corner, the start of its facets.
    starts: Vec<u32>,
    /// The other two vertices, in the order of the facet, and 4·slot + corner of the kept cell.
    rest: Vec<([u32; 2], u32)>,
}

impl FacetTable {
    fn of(boundary: &[Facet], corners: &Corners) -> Self {
        let numbered: Vec<_> = (boundary.iter())
            .map(|facet| smallest_first(facet.corners.map(|v| corners.of(v))))
            .collect();
        let mut starts = vec![0; corners.list.len() + 2];
        numbered.iter().for_each(|facet| starts[facet[0] as usize + 1] += 1);
        for v in 1..starts.len() {
            starts[v] += starts[v - 1];
        }
        let mut rest = vec![([0; 2], 0); boundary.len()];
        let mut next = starts.clone();
        for ([a, b, c], facet) in numbered.into_iter().zip(boundary) {
            let at = &mut next[a as usize];
            rest[*at as usize] = ([b, c], facet.kept);
            *at += 1;
        }
        Self { starts, rest }
    }

    fn get(&self, facet: [u32; 3]) -> Option<u32> {
        let [a, b, c] = smallest_first(facet);
        let range = self.starts[a as usize] as usize..self.starts[a as usize + 1] as usize;
        self.rest[range].iter().find(|(rest, _)| *rest == [b, c]).map(|&(_, kept)| kept)
    }
}
