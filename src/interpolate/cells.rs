//! The cells of a growing triangulation, and to which of several a place belongs.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use walpha_complex::canonical::smallest_even;
use walpha_regular::BitRange;
use walpha_regular::{Cell, Growing};

use super::barycentric::coordinates;
use super::interpolant::combine;
use super::least_squares::Pieces;

/// The cells of a triangulation as an interpolant has them.
pub(super) struct Cells<'a> {
    growing: &'a Growing,
    values: &'a [f64],
    bit_range: BitRange,
}

impl<'a> Cells<'a> {
    pub(super) fn of(growing: &'a Growing, values: &'a [f64]) -> Self {
        Self { growing, values, bit_range: BitRange::of(growing.positions()) }
    }

    /// The corners of a cell in canonical order. Numbers of points are in the order of their indices.
    pub(super) fn row(&self, cell: u32) -> [u32; 4] {
        smallest_even(self.growing.cells()[cell as usize].corners)
    }

    pub(super) fn coordinates(&self, row: [u32; 4], place: [f64; 3]) -> Option<[f64; 4]> {
        coordinates(&self.corners(row), place, self.bit_range.is_exact_with(place))
    }

    pub(super) fn corners(&self, row: [u32; 4]) -> [[f64; 3]; 4] {
        row.map(|v| self.growing.positions()[v as usize])
    }

    /// Gives a sample in a new cell to the first of the cells that hold it. Shares that are 0 may be so by
    /// rounding; then `holds` says which of the cells beside hold the sample, too.
    #[inline(always)]
    pub(super) fn claim(
        &self,
        cell: u32,
        shares: &[f64; 4],
        holds: impl Fn([u32; 4]) -> bool,
        owner: &AtomicU32,
    ) {
        match shares.iter().filter(|share| **share == 0.0).count() {
            0 => owner.store(cell, Relaxed),
            1 => owner.store(self.first_across(cell, shares, holds), Relaxed),
            2 => owner.store(self.first_at(cell, shares, holds), Relaxed),
            // At a vertex F is its value, whichever cell the sample belongs to.
            _ => drop(owner.fetch_min(cell, Relaxed)),
        }
    }

    /// The first in canonical order of a cell and the one beyond the facet that a place lies on.
    fn first_across(&self, cell: u32, shares: &[f64; 4], holds: impl Fn([u32; 4]) -> bool) -> u32 {
        let row = self.row(cell);
        let apex = (0..4).find(|&k| shares[k] == 0.0).expect("a share is 0");
        let Cell { corners, neighbors } = self.growing.cells()[cell as usize];
        let k = (0..4).find(|&k| corners[k] == row[apex]).expect("a corner");
        let next = neighbors[k] / 4;
        if !self.growing.is_cell(next) {
            return cell;
        }
        let across = self.row(next);
        if across < row && holds(across) { next } else { cell }
    }

    /// The first in canonical order of the cells at the face that a place lies on within one of them. They
    /// are those with all vertices of the face, and from one to the next the way leads through facets
    /// that have all of them, too.
    fn first_at(&self, cell: u32, shares: &[f64; 4], holds: impl Fn([u32; 4]) -> bool) -> u32 {
        let row = self.row(cell);
        let on = |v: u32| (0..4).any(|k| row[k] == v && shares[k] != 0.0);
        let mut seen = vec![cell];
        let mut first = (row, cell);
        let mut at = 0;
        while let Some(&cell) = seen.get(at) {
            at += 1;
            let Cell { corners, neighbors } = self.growing.cells()[cell as usize];
            for k in 0..4 {
                let next = neighbors[k] / 4;
                if on(corners[k]) || !self.growing.is_cell(next) || seen.contains(&next) {
                    continue;
                }
                let row = self.row(next);
                if holds(row) {
                    first = first.min((row, next));
                    seen.push(next);
                }
            }
        }
        first.1
    }
}

impl Pieces for Cells<'_> {
    fn count(&self) -> usize {
        self.growing.cells().len()
    }

    fn vertices(&self, cell: u32) -> ([u32; 4], usize) {
        (self.row(cell), 4)
    }

    fn coordinates(&self, cell: u32, place: [f64; 3]) -> Option<[f64; 4]> {
        self.coordinates(self.row(cell), place)
    }

    fn value(&self, cell: u32, shares: &[f64; 4]) -> f64 {
        combine(shares, self.row(cell).map(|v| self.values[v as usize]))
    }
}
