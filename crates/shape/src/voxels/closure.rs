//! The complex of cells: their faces, and the classes of all.

use std::ops::Range;

use rayon::prelude::*;
use walpha_base::Monitor;
use walpha_base::memory::try_reserve;
use walpha_complex::canonical::{outward_facets, smallest_even, sorted};

use crate::{Class, Complex, ShapeError, Simplices};

/// Sides of simplices that are sorted at once, about 256 MiB.
const AT_ONCE: usize = 1 << 24;

/// The complex of positively oriented cells in canonical form over this number of points, of which each is a corner of one. A facet of one cell is regular, as
/// are its edges and vertices, and everything else is interior.
pub(super) fn classified(
    mut cells: Vec<[u32; 4]>,
    points: usize,
    monitor: &Monitor,
) -> Result<Complex, ShapeError> {
    cells.par_sort_unstable();
    monitor.report(1, 4)?;
    let facets = facets(&cells, points)?;
    monitor.report(2, 4)?;
    let edges = edges(&facets, points)?;
    monitor.report(3, 4)?;
    let mut vertices = vec![Class::Interior; points];
    for facet in facets.of(Class::Regular) {
        facet.iter().for_each(|&v| vertices[v as usize] = Class::Regular);
    }
    let interior = vec![Class::Interior; cells.len()];
    let cells = Simplices::new(cells, interior).expect("a class for each");
    Ok(Complex { cells, facets, edges, vertices: (0..).map(|v| [v]).zip(vertices).collect() })
}

fn facets(cells: &[[u32; 4]], points: usize) -> Result<Simplices<3>, ShapeError> {
    let mut found = Rows::default();
    for range in ranges(points, 4 * cells.len()) {
        // The first vertex of a row is its smallest.
        let near = &cells[..cells.partition_point(|cell| cell[0] < range.end)];
        let side = |facet: [u32; 3]| (sorted(facet), smallest_even(facet));
        let sides = |cell: &[u32; 4]| {
            let sides = outward_facets(*cell).map(side).into_iter();
            let range = range.clone();
            sides.filter(move |(facet, _)| range.contains(&facet[0]))
        };
        let mut sides: Vec<_> = near.par_iter().flat_map_iter(sides).collect();
        sides.par_sort_unstable();
        let of_sides = sides.chunk_by(|a, b| a.0 == b.0).map(|sides| match sides {
            [(_, outward)] => (*outward, Class::Regular),
            _ => (sides[0].0, Class::Interior),
        });
        found.add(of_sides.collect())?;
    }
    Ok(found.simplices())
}

fn edges(facets: &Simplices<3>, points: usize) -> Result<Simplices<2>, ShapeError> {
    let mut found = Rows::default();
    for range in ranges(points, 3 * facets.len()) {
        let near = facets.rows().partition_point(|facet| facet[0] < range.end);
        let near = facets.rows()[..near].par_iter().zip(facets.classes());
        let sides = |(&[a, b, c], &class): (&[u32; 3], &Class)| {
            let range = range.clone();
            let edges = [[a, b], [a, c], [b, c]].map(sorted).into_iter();
            edges.filter(move |edge| range.contains(&edge[0])).map(move |edge| (edge, class))
        };
        let mut sides: Vec<([u32; 2], Class)> = near.flat_map_iter(sides).collect();
        sides.par_sort_unstable();
        // Of the classes around an edge the last is regular if one is.
        let last = sides.chunk_by(|a, b| a.0 == b.0).map(|sides| sides[sides.len() - 1]);
        found.add(last.collect())?;
    }
    Ok(found.simplices())
}

/// Ranges of points by which simplices are worked on, by their smallest vertices, so that each has about [`AT_ONCE`] of `sides`.
fn ranges(points: usize, sides: usize) -> impl Iterator<Item = Range<u32>> {
    let step = (points / sides.div_ceil(AT_ONCE).max(1)).max(1);
    (0..points).step_by(step).map(move |first| first as u32..points.min(first + step) as u32)
}

/// Rows and classes that grow as they are found.
#[derive(Default)]
struct Rows<const N: usize> {
    rows: Vec<[u32; N]>,
    classes: Vec<Class>,
}

impl<const N: usize> Rows<N> {
    /// Adds simplices that come after all others.
    fn add(&mut self, mut more: Vec<([u32; N], Class)>) -> Result<(), ShapeError> {
        more.par_sort_unstable();
        let what = || "the simplices of voxels".to_owned();
        try_reserve(&mut self.rows, more.len(), what)?;
        try_reserve(&mut self.classes, more.len(), what)?;
        self.rows.extend(more.iter().map(|(row, _)| row));
        self.classes.extend(more.iter().map(|(_, class)| class));
        Ok(())
    }

    fn simplices(self) -> Simplices<N> {
        Simplices::new(self.rows, self.classes).expect("a class for each")
    }
}
