//! Puts cells in canonical order, regardless of how they were made.

use std::sync::atomic::{AtomicU32, Ordering};

use rayon::iter::repeat_n;
use walpha_base::parallel::prelude::*;

use super::slots::Slots;
use crate::{Cell, CellArrays, DELETED, TriangulationError, with_capacity};

/// The even permutations that bring the smallest of four first and the smallest of the others second. Entry 3·p + r is for a
/// smallest one at p, after which the other three are rotated r times. Each entry lists the sources of the elements.
const EVEN: [[u8; 4]; 12] = [
    [0, 1, 2, 3],
    [0, 2, 3, 1],
    [0, 3, 1, 2],
    [1, 0, 3, 2],
    [1, 3, 2, 0],
    [1, 2, 0, 3],
    [2, 3, 0, 1],
    [2, 0, 1, 3],
    [2, 1, 3, 0],
    [3, 2, 1, 0],
    [3, 1, 0, 2],
    [3, 0, 2, 1],
];

/// The target of each corner under the permutations of [`EVEN`].
const TO: [[u8; 4]; 12] = {
    let mut to = [[0; 4]; 12];
    let mut code = 0;
    while code < 12 {
        let mut k = 0;
        while k < 4 {
            to[code][EVEN[code][k] as usize] = k as u8;
            k += 1;
        }
        code += 1;
    }
    to
};

/// The permutation of [`EVEN`] that makes corners the lexicographically smallest.
#[inline(always)]
fn canonical(corners: [u32; 4]) -> usize {
    let [a, b, c, d] = corners;
    let (low, high) = (usize::from(b < a), 2 + usize::from(d < c));
    let first = if corners[high] < corners[low] { high } else { low };
    let [_, x, y, z] = EVEN[3 * first].map(|k| corners[k as usize]);
    3 * first
        + if x < y && x < z {
            0
        } else if y < z {
            1
        } else {
            2
        }
}

impl CellArrays {
    /// The triangulation of cells in the order in which they were made.
    pub(crate) fn of_cells(cells: Vec<Cell>, at_infinity: u32) -> Result<Self, TriangulationError> {
        number(Slots::of_one(cells), at_infinity)
    }
}

/// The number of slots that one task handles.
const PIECE: usize = 1 << 16;
/// The number of vertices whose cells one task sorts: few enough for its working memory to stay in the cache.
const VERTICES: usize = 1 << 11;

/// The cells in canonical order: each as its lexicographically smallest even permutation, and the cells ascending. So cells of
/// consecutive points are close in memory. O(cells) for bounded numbers of cells at a point.
pub(super) fn number(slots: Slots, at_infinity: u32) -> Result<CellArrays, TriangulationError> {
    let Slots { chunks: mut old, bits, .. } = slots;
    let ranges = at_infinity as usize / VERTICES + 1;
    let by_piece: Vec<Vec<Vec<Corners>>> = (old.par_iter_mut().enumerate())
        .flat_map(|(chunk, cells)| {
            let start = (chunk as u32) << bits;
            cells
                .par_chunks_mut(PIECE)
                .enumerate()
                .map(move |(piece, cells)| permute(cells, start + (piece * PIECE) as u32, ranges))
        })
        .collect();
    // Collected in place; shrinking then frees a quarter of the memory of the old cells.
    let old: Vec<Vec<Moved>> = (old.into_par_iter())
        .map(|cells| {
            let mut moved: Vec<_> = cells.into_iter().map(Moved::of).collect();
            moved.shrink_to_fit();
            moved
        })
        .collect();
    let mut by_range: Vec<Vec<Vec<Corners>>> = (0..ranges).map(|_| Vec::new()).collect();
    for piece in by_piece {
        for (lists, list) in by_range.iter_mut().zip(piece).filter(|(_, list)| !list.is_empty()) {
            lists.push(list);
        }
    }
    let count = by_range.iter().flatten().map(Vec::len).sum();
    let (mut cells, mut from): (Vec<[u32; 4]>, Vec<u32>) =
        (with_capacity(count)?, with_capacity(count)?);
    // This is parallel because the kernel takes much of the time, for new pages.
    cells.par_extend(repeat_n([0; 4], count).coarse());
    from.par_extend(repeat_n(0, count).coarse());
    let mask = (1 << bits) - 1;
    let at = |slot: u32| &old[(slot >> bits) as usize][(slot & mask) as usize];
    let (mut rest, mut rest_from, mut start) = (&mut cells[..], &mut from[..], 0);
    let mut tasks = Vec::with_capacity(ranges);
    for (range, lists) in by_range.into_iter().enumerate() {
        let count = lists.iter().map(Vec::len).sum();
        let (Some(cells), Some(from)) =
            (rest.split_off_mut(..count), rest_from.split_off_mut(..count))
        else {
            unreachable!("as many as were counted");
        };
        tasks.push((range, lists, start as u32, cells, from));
        start += count;
    }
    tasks.into_par_iter().for_each(|(range, lists, start, cells, from)| {
        let sorted = sort(lists, (range * VERTICES) as u32);
        for ((number, (corners, slot)), (cell, from)) in
            (start..).zip(sorted).zip(cells.iter_mut().zip(from))
        {
            (*cell, *from) = (corners, slot);
            at(slot).number.store(number, Ordering::Relaxed);
        }
    });
    let mut adjacency: Vec<[u32; 4]> = with_capacity(count)?;
    (from.par_iter().with_min_len(PIECE))
        .map(|&slot| {
            at(slot).neighbors.map(|side| {
                let Moved { number, code, .. } = at(side / 4);
                let corner = TO[*code as usize][side as usize % 4];
                4 * number.load(Ordering::Relaxed) + u32::from(corner)
            })
        })
        .collect_into_vec(&mut adjacency);
    Ok(CellArrays { cells, adjacency, at_infinity })
}

/// The corners of a cell, permuted, and its slot.
type Corners = ([u32; 4], u32);

/// The content of a slot while cells move from it to their numbers.
struct Moved {
    /// The neighbours in the order of the permuted corners, as 4·slot + corner before these were permuted.
    neighbors: [u32; 4],
    number: AtomicU32,
    /// The entry of [`EVEN`] by which the corners were permuted.
    code: u32,
}

impl Moved {
    /// A cell after [`permute`].
    fn of(cell: Cell) -> Self {
        let Cell { corners: [code, ..], neighbors } = cell;
        Self { neighbors, number: AtomicU32::new(0), code }
    }
}

/// Permutes the cells of consecutive slots, the first of which is given, and stores the entry of [`EVEN`] in place of their first
/// corner. Returns for each range of vertices the cells whose smallest corner is there.
fn permute(cells: &mut [Cell], start: u32, ranges: usize) -> Vec<Vec<Corners>> {
    let range = |cell: &Cell| cell.corners.into_iter().min().unwrap_or(0) as usize / VERTICES;
    let mut counts = vec![0; ranges];
    for cell in cells.iter().filter(|cell| cell.corners[0] != DELETED) {
        counts[range(cell)] += 1;
    }
    let mut lists: Vec<Vec<Corners>> = counts.into_iter().map(Vec::with_capacity).collect();
    for (slot, cell) in (start..).zip(cells) {
        if cell.corners[0] == DELETED {
            cell.corners[0] = 0;
            continue;
        }
        let code = canonical(cell.corners);
        let from = EVEN[code].map(usize::from);
        let corners = from.map(|k| cell.corners[k]);
        lists[corners[0] as usize / VERTICES].push((corners, slot));
        cell.neighbors = from.map(|k| cell.neighbors[k]);
        cell.corners[0] = code as u32;
    }
    lists
}

/// Sorts the cells of a range of vertices: by their smallest corner in one pass, and then the few cells of each.
fn sort(lists: Vec<Vec<Corners>>, first: u32) -> Vec<Corners> {
    let of = |corners: [u32; 4]| (corners[0] - first) as usize;
    let mut ends = vec![0; VERTICES + 1];
    lists.iter().flatten().for_each(|&(corners, _)| ends[of(corners) + 1] += 1);
    for v in 0..VERTICES {
        ends[v + 1] += ends[v];
    }
    let mut sorted = vec![Corners::default(); ends[VERTICES]];
    // The position of the next cell of each vertex; finally, the end of its cells.
    for cell in lists.into_iter().flatten() {
        let at = &mut ends[of(cell.0)];
        sorted[*at] = cell;
        *at += 1;
    }
    let mut start = 0;
    for &end in &ends[..VERTICES] {
        sorted[start..end].sort_unstable();
        start = end;
    }
    sorted
}
