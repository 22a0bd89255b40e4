//! The points and the listed simplices: an index by vertices, and links between cells and facets.

use std::collections::BTreeSet;

use walpha_base::parallel::prelude::*;
use walpha_base::{Cancelled, Monitor};
use walpha_complex::canonical::outward_facets;

use super::finding::{Finding, Simplex};
use crate::Complex;
use crate::exact::WeightedPoint;
pub(super) use crate::index::{Index, NONE};
use crate::parallel::one_for_each;

/// Points, each with its position and weight together in memory.
pub(super) fn sites(positions: &[[f64; 3]], weights: &[f64]) -> Vec<WeightedPoint> {
    let sites = positions.iter().zip(weights);
    sites.map(|(&position, &weight)| WeightedPoint { position, weight }).collect()
}

/// The input points.
#[derive(Clone, Copy)]
pub(super) struct Points<'a> {
    pub sites: &'a [WeightedPoint],
}

impl<'a> Points<'a> {
    pub(super) fn len(self) -> usize {
        self.sites.len()
    }

    pub(super) fn get(self, i: u32) -> WeightedPoint {
        self.sites[i as usize]
    }

    pub(super) fn position(self, i: u32) -> [f64; 3] {
        self.get(i).position
    }

    pub(super) fn weight(self, i: u32) -> f64 {
        self.get(i).weight
    }

    /// Some of the points.
    pub(super) fn of(self, numbers: &[u32]) -> Vec<WeightedPoint> {
        numbers.iter().map(|&i| self.get(i)).collect()
    }

    /// All positions.
    pub(super) fn positions(self) -> impl Iterator<Item = [f64; 3]> + Clone + 'a {
        self.sites.iter().map(|site| site.position)
    }

    /// The corners of a row.
    pub(super) fn corners<const N: usize>(self, row: [u32; N]) -> [WeightedPoint; N] {
        row.map(|i| self.get(i))
    }

    /// The positions of the vertices of a row.
    pub(super) fn positions_of<const N: usize>(self, row: [u32; N]) -> [[f64; 3]; N] {
        row.map(|i| self.position(i))
    }
}

/// The maximum number of cells, limited by the 32-bit numbers of their sides, 4 · cell + 0..4.
pub(super) const MAX_CELLS: usize = (u32::MAX / 4) as usize;

/// The listed simplices, linked: cells to facets and back, and each simplex found by its vertices.
pub(super) struct Structure<'a> {
    pub complex: &'a Complex,
    pub cells: Index<'a, 4>,
    pub facets: Index<'a, 3>,
    pub edges: Index<'a, 2>,
    pub vertices: Index<'a, 1>,
    /// For each facet, its sides in cells as 4 · cell + the corner opposite to it, ascending; [`NONE`] for a missing one. Only
    /// the first two for a crowded facet.
    pub sides: Vec<[u32; 2]>,
    /// The rows of each cell's facets, opposite to its vertices.
    pub cell_facets: Vec<[u32; 4]>,
}

/// A facet seen from one of its cells.
#[derive(Clone, Copy)]
pub(super) struct Half {
    pub cell: usize,
    /// The opposite corner of the cell.
    pub opposite: usize,
}

impl<'a> Structure<'a> {
    /// The maximum number of bytes for linking a complex, without the complex itself.
    pub(super) fn bytes(complex: &Complex) -> usize {
        let row = size_of::<u32>();
        let (cell, facet) = (row + size_of::<[u32; 4]>(), row + size_of::<[u32; 2]>());
        cell * complex.cells.len()
            + facet * complex.facets.len()
            + row * (complex.edges.len() + complex.vertices.len())
    }

    /// Links cells by their facets. Vertices of all rows must be valid.
    pub(super) fn new(
        complex: &'a Complex,
        points: Points,
        monitor: &Monitor,
    ) -> Result<(Self, Vec<Finding>), Cancelled> {
        let n = points.len();
        let cell_index = Index::new(complex.cells.rows(), n);
        monitor.report(2, 10)?;
        let facets = Index::new(complex.facets.rows(), n);
        monitor.report(5, 10)?;
        let edges = Index::new(complex.edges.rows(), n);
        let vertices = Index::new(complex.vertices.rows(), n);
        let mut findings = repeated(&cell_index);
        findings.extend(repeated(&facets));
        findings.extend(repeated(&edges));
        findings.extend(repeated(&vertices));
        monitor.report(7, 10)?;

        let cells = complex.cells.rows();
        let cell_facets = one_for_each(cells.len(), [NONE; 4], &monitor.part(7, 10, 10), |i| {
            outward_facets(cells[i]).map(|facet| facets.row(facet))
        })?;
        let missing = cell_facets.par_iter().zip(cells).flat_map_iter(|(rows, cell)| {
            let facets = outward_facets(*cell).into_iter().zip(rows);
            facets.filter(|(_, row)| **row == NONE).map(|(facet, _)| (facet, *cell))
        });
        findings.par_extend(
            missing
                .map(|(facet, cell)| Finding::MissingFace { face: facet.into(), of: cell.into() }),
        );
        let (sides, crowded) = sides(complex.facets.len(), cell_facets.as_flattened());
        findings.extend(crowded.into_iter().map(|row| Finding::Crowded {
            facet: complex.facets.rows()[row as usize].into(),
            cells: cells_with(cells, &cell_facets, row),
        }));
        let cells = cell_index;
        Ok((Self { complex, cells, facets, edges, vertices, sides, cell_facets }, findings))
    }

    /// Whether a cell is the only one on one of its facets.
    pub(super) fn is_outermost(&self, cell: usize) -> bool {
        self.cell_facets[cell].iter().any(|&facet| self.sides[facet as usize][1] == NONE)
    }

    /// For each point, whether it is surrounded by cells: it is a vertex of some, and no facet at it has only one cell.
    pub(super) fn surrounded(&self, points: usize) -> Vec<bool> {
        let mut surrounded = vec![false; points];
        for &v in self.complex.cells.rows().as_flattened() {
            surrounded[v as usize] = true;
        }
        for (facet, sides) in self.complex.facets.rows().iter().zip(&self.sides) {
            if sides[0] != NONE && sides[1] == NONE {
                facet.iter().for_each(|&v| surrounded[v as usize] = false);
            }
        }
        surrounded
    }

    /// The half-facets of a facet, at most two.
    pub(super) fn halves(&self, facet: usize) -> impl Iterator<Item = Half> + use<> {
        let present = self.sides[facet].into_iter().filter(|&half| half != NONE);
        present.map(|half| Half { cell: half as usize / 4, opposite: half as usize % 4 })
    }

    /// The facets with exactly one cell, counter-clockwise seen from outside.
    pub(super) fn hull(&self) -> Vec<[u32; 3]> {
        (0..self.sides.len())
            .into_par_iter()
            .filter_map(|facet| {
                let mut halves = self.halves(facet);
                let half = halves.next()?;
                halves.next().is_none().then(|| self.outward(half))
            })
            .collect()
    }

    /// The facet of a half-facet, counter-clockwise seen from outside its cell.
    pub(super) fn outward(&self, half: Half) -> [u32; 3] {
        outward_facets(self.complex.cells.rows()[half.cell])[half.opposite]
    }

    /// The vertex of a half-facet's cell that is opposite to it.
    pub(super) fn apex(&self, half: Half) -> u32 {
        self.complex.cells.rows()[half.cell][half.opposite]
    }
}

/// The first two sides of each facet, and the facets that have more, given the facet at each side of the cells.
fn sides(facets: usize, facet_at: &[u32]) -> (Vec<[u32; 2]>, BTreeSet<u32>) {
    let mut sides = vec![[NONE; 2]; facets];
    // Each thread visits all cells, and records their sides at some of the facets.
    let share = facets.div_ceil(rayon::current_num_threads()).max(1);
    let parts = sides.par_chunks_mut(share).enumerate().map(|(part, sides)| {
        let start = (part * share) as u32;
        let mut crowded = BTreeSet::new();
        for (half, row) in (0..).zip(facet_at) {
            match sides.get_mut(row.wrapping_sub(start) as usize) {
                Some([first, _]) if *first == NONE => *first = half,
                Some([_, second]) if *second == NONE => *second = half,
                Some(_) => _ = crowded.insert(*row),
                None => {}
            }
        }
        crowded
    });
    let crowded = parts.flatten_iter().collect();
    (sides, crowded)
}

/// Findings for simplices that are listed more than once.
fn repeated<const N: usize>(index: &Index<N>) -> Vec<Finding> {
    index
        .repeated()
        .into_iter()
        .map(|row| Finding::RepeatedSimplex { simplex: row.into() })
        .collect()
}

fn cells_with(cells: &[[u32; 4]], facets: &[[u32; 4]], row: u32) -> Vec<Simplex> {
    let has = |(_, rows): &(&[u32; 4], &[u32; 4])| rows.contains(&row);
    cells.iter().zip(facets).filter(has).map(|(cell, _)| (*cell).into()).collect()
}

/// Findings for single rows: vertices that do not exist, or occur twice.
pub(super) fn rows(complex: &Complex, points: usize) -> Vec<Finding> {
    let mut findings = row_findings(complex.cells.rows(), points);
    findings.extend(row_findings(complex.facets.rows(), points));
    findings.extend(row_findings(complex.edges.rows(), points));
    findings.extend(row_findings(complex.vertices.rows(), points));
    findings
}

fn row_findings<const N: usize>(rows: &[[u32; N]], points: usize) -> Vec<Finding> {
    let judge = |row: &[u32; N]| {
        let simplex = || (*row).into();
        if row.iter().any(|&v| v as usize >= points) {
            Some(Finding::Index { simplex: simplex(), points })
        } else if (1..N).any(|i| row[..i].contains(&row[i])) {
            Some(Finding::RepeatedVertex { simplex: simplex() })
        } else {
            None
        }
    };
    rows.par_iter().filter_map(judge).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Class;

    /// A row takes 4 bytes in its index, a cell 16 for its facets, and a facet 8 for its two sides.
    #[test]
    fn bytes_are_those_of_all_rows() {
        let complex = Complex {
            cells: [([0, 1, 2, 3], Class::Interior)].into_iter().collect(),
            facets: [[0, 1, 2], [0, 1, 3]].map(|row| (row, Class::Regular)).into_iter().collect(),
            edges: [[0, 1], [0, 2], [0, 3]].map(|row| (row, Class::Regular)).into_iter().collect(),
            vertices: [0, 1, 2, 3, 4].map(|v| ([v], Class::Regular)).into_iter().collect(),
        };
        assert_eq!(Structure::bytes(&complex), (4 + 16) + 2 * (4 + 8) + 3 * 4 + 5 * 4);
    }
}
