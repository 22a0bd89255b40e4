//! Cells in canonical order, whatever made them.

use std::sync::atomic::{AtomicU32, Ordering};

use rayon::prelude::*;

use super::slots::Slots;
use crate::{Cell, DELETED, Triangulation, TriangulationError, filled};

/// The permutations that bring the smallest of four first and the smallest of the others second, and are even: entry
/// 3·p + r where the smallest was at p, after which the other three are rotated r times. Where each comes from.
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

/// Which of [`EVEN`] makes corners the lexicographically smallest.
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

impl Triangulation {
    /// The triangulation of cells in the order in which they were made.
    pub(crate) fn of_cells(cells: Vec<Cell>, ghost: u32) -> Result<Self, TriangulationError> {
        number(Slots::of_one(cells), ghost)
    }
}

/// Slots that one task looks at.
const PIECE: usize = 1 << 16;
/// Vertices whose cells one task puts in order: so few that its working memory stays in the cache.
const VERTICES: usize = 1 << 12;

/// The cells in canonical order: each as its lexicographically smallest even permutation, and these ascending. So cells
/// of consecutive points are close in memory. O(cells) for bounded numbers of cells at a point.
pub(super) fn number(slots: Slots, ghost: u32) -> Result<Triangulation, TriangulationError> {
    let Slots { chunks: mut old, bits, .. } = slots;
    let ranges = ghost as usize / VERTICES + 1;
    // By slot, how its corners were permuted; and by piece and range of vertices, the cells whose smallest corner is
    // there.
    let by_piece: Vec<_> = (old.par_iter_mut().enumerate())
        .flat_map(|(chunk, cells)| {
            let start = (chunk as u32) << bits;
            cells
                .par_chunks_mut(PIECE)
                .enumerate()
                .map(move |(piece, cells)| permute(cells, start + (piece * PIECE) as u32, ranges))
        })
        .collect();
    let old: Vec<Vec<Cell>> = old;
    let mut codes: Vec<Vec<u8>> = old.iter().map(|cells| Vec::with_capacity(cells.len())).collect();
    let mut lists = Vec::with_capacity(by_piece.len());
    for Piece { start, codes: more, lists: list } in by_piece {
        codes[(start >> bits) as usize].extend(more);
        lists.push(list);
    }
    let counts: Vec<usize> =
        (0..ranges).map(|range| lists.iter().map(|list| list[range].len()).sum()).collect();
    let count = counts.iter().sum();
    let mut cells: Vec<[u32; 4]> = filled(count, [0; 4])?;
    let mut from: Vec<u32> = filled(count, 0)?;
    let numbers: Vec<Vec<AtomicU32>> =
        old.iter().map(|cells| cells.iter().map(|_| AtomicU32::new(0)).collect()).collect();
    let mask = (1 << bits) - 1;
    let at = |slot: u32| ((slot >> bits) as usize, (slot & mask) as usize);
    let (mut rest, mut rest_from, mut start) = (&mut cells[..], &mut from[..], 0);
    let mut tasks = Vec::with_capacity(ranges);
    for (range, &count) in counts.iter().enumerate() {
        let (Some(cells), Some(from)) =
            (rest.split_off_mut(..count), rest_from.split_off_mut(..count))
        else {
            unreachable!("as many as were counted");
        };
        tasks.push((range, start as u32, cells, from));
        start += count;
    }
    tasks.into_par_iter().for_each(|(range, start, cells, from)| {
        let slots = lists.iter().flat_map(|list| list[range].iter().copied());
        let corners = |slot: u32| old[at(slot).0][at(slot).1].corners;
        let mut sorted: Vec<([u32; 4], u32)> = slots.map(|slot| (corners(slot), slot)).collect();
        sorted.sort_unstable();
        for ((number, (corners, slot)), (cell, from)) in
            (start..).zip(sorted).zip(cells.iter_mut().zip(from))
        {
            (*cell, *from) = (corners, slot);
            numbers[at(slot).0][at(slot).1].store(number, Ordering::Relaxed);
        }
    });
    drop(lists);
    // Collected in place; shrinking then frees half the memory of the old cells.
    let old: Vec<Vec<[u32; 4]>> = (old.into_par_iter())
        .map(|cells| {
            let mut across: Vec<_> = cells.into_iter().map(|cell| cell.neighbors).collect();
            across.shrink_to_fit();
            across
        })
        .collect();
    let mut neighbors: Vec<[u32; 4]> = filled(count, [0; 4])?;
    neighbors.par_iter_mut().zip(&from).with_min_len(PIECE).for_each(|(neighbors, &slot)| {
        *neighbors = old[at(slot).0][at(slot).1].map(|side| {
            let (chunk, slot) = at(side / 4);
            let from = &EVEN[usize::from(codes[chunk][slot])];
            let corner = (0..4).find(|&k| u32::from(from[k as usize]) == side % 4).unwrap_or(0);
            4 * numbers[chunk][slot].load(Ordering::Relaxed) + corner
        });
    });
    Ok(Triangulation { cells, neighbors, ghost })
}

/// Consecutive slots of a chunk, the first of which is given.
struct Piece {
    start: u32,
    /// By slot, the entry of [`EVEN`] by which its corners were permuted.
    codes: Vec<u8>,
    /// By range of vertices, the slots of the cells whose smallest corner is there.
    lists: Vec<Vec<u32>>,
}

/// Permutes the corners of cells, and lists these by range of vertices.
fn permute(cells: &mut [Cell], start: u32, ranges: usize) -> Piece {
    let mut lists = vec![Vec::new(); ranges];
    let mut codes = Vec::with_capacity(cells.len());
    for (slot, cell) in (start..).zip(cells) {
        if cell.corners[0] == DELETED {
            codes.push(0);
            continue;
        }
        let code = canonical(cell.corners);
        let from = EVEN[code].map(usize::from);
        cell.corners = from.map(|k| cell.corners[k]);
        cell.neighbors = from.map(|k| cell.neighbors[k]);
        codes.push(code as u8);
        lists[cell.corners[0] as usize / VERTICES].push(slot);
    }
    Piece { start, codes, lists }
}
