//! The simplices of points recorded in any order, in canonical order.

use walpha_base::parallel::prelude::*;

use super::classify::{Classes, PointRows, Records};
use crate::{Class, Complex, Simplices};

/// Points whose records one thread gathers at a time.
const CHUNK: usize = 1 << 12;

/// The location of the record of a point.
#[derive(Clone, Copy, Default)]
pub(super) struct Location {
    pub records: u32,
    /// Number of the point among these.
    pub point: u32,
}

/// Numbers of rows and of sheets.
#[derive(Clone, Copy, Default)]
pub(super) struct Counts {
    cells: usize,
    facets: usize,
    edges: usize,
    vertices: usize,
    facet_sheets: usize,
    edge_sheets: usize,
}

impl Counts {
    /// The counts for some points. Exterior vertices count only if exterior simplices are wanted.
    fn of<'a>(points: impl Iterator<Item = &'a PointRows>, exterior: bool) -> Self {
        points.fold(Self::default(), |sum, point| {
            sum.plus(Self {
                cells: point.cells as usize,
                facets: point.facets as usize,
                edges: point.edges as usize,
                vertices: usize::from(point.is_listed(exterior)),
                facet_sheets: point.facet_sheets as usize,
                edge_sheets: point.edge_sheets as usize,
            })
        })
    }

    /// The counts for all points in some records.
    pub(super) fn of_all<'a>(
        records: impl ParallelIterator<Item = &'a Records>,
        exterior: bool,
    ) -> Self {
        let count = |records: &Records| Self::of(records.points.iter(), exterior);
        records.map(count).reduce(Self::default, Self::plus)
    }

    fn plus(self, other: Self) -> Self {
        Self {
            cells: self.cells + other.cells,
            facets: self.facets + other.facets,
            edges: self.edges + other.edges,
            vertices: self.vertices + other.vertices,
            facet_sheets: self.facet_sheets + other.facet_sheets,
            edge_sheets: self.edge_sheets + other.edge_sheets,
        }
    }

    /// The bytes of these rows, classes and sheets after they are gathered.
    pub(super) fn bytes(self) -> u64 {
        let rows = |vertices: usize, count: usize| {
            (vertices * size_of::<u32>() + size_of::<Class>()) as u64 * count as u64
        };
        let sheets = |count: usize| size_of::<u32>() as u64 * count as u64;
        rows(4, self.cells)
            + rows(3, self.facets)
            + rows(2, self.edges)
            + rows(1, self.vertices)
            + sheets(self.facet_sheets)
            + sheets(self.edge_sheets)
    }
}

/// Gathered simplices and sheets.
pub(super) struct Gathered {
    cells: List<4>,
    facets: List<3>,
    edges: List<2>,
    vertices: List<1>,
    facet_sheets: Vec<u32>,
    edge_sheets: Vec<u32>,
}

struct List<const N: usize> {
    rows: Vec<[u32; N]>,
    classes: Vec<Class>,
}

impl<const N: usize> List<N> {
    fn new(rows: usize) -> Self {
        Self { rows: vec![[0; N]; rows], classes: vec![Class::Exterior; rows] }
    }

    fn rest(&mut self) -> Part<'_, N> {
        Part { rows: &mut self.rows, classes: &mut self.classes }
    }

    fn simplices(self) -> Simplices<N> {
        Simplices::new(self.rows, self.classes).expect("as many classes as rows")
    }
}

impl Gathered {
    /// Allocates lists for this number of elements, which are then written.
    pub(super) fn new(counts: Counts) -> Self {
        Self {
            cells: List::new(counts.cells),
            facets: List::new(counts.facets),
            edges: List::new(counts.edges),
            vertices: List::new(counts.vertices),
            facet_sheets: vec![0; counts.facet_sheets],
            edge_sheets: vec![0; counts.edge_sheets],
        }
    }

    /// Everything that has to be written.
    pub(super) fn rest(&mut self) -> Rest<'_> {
        Rest {
            cells: self.cells.rest(),
            facets: self.facets.rest(),
            edges: self.edges.rest(),
            vertices: self.vertices.rest(),
            facet_sheets: &mut self.facet_sheets,
            edge_sheets: &mut self.edge_sheets,
        }
    }

    /// The complex; the one sheet of each regular facet and the two sheets of each singular facet, in the order of the facets;
    /// and the sheet of each singular edge, in the order of the edges.
    pub(super) fn into_parts(self) -> (Complex, Vec<u32>, Vec<u32>) {
        let complex = Complex {
            cells: self.cells.simplices(),
            facets: self.facets.simplices(),
            edges: self.edges.simplices(),
            vertices: self.vertices.simplices(),
        };
        (complex, self.facet_sheets, self.edge_sheets)
    }
}

/// The part of gathered lists that is not written yet.
pub(super) struct Rest<'a> {
    cells: Part<'a, 4>,
    facets: Part<'a, 3>,
    edges: Part<'a, 2>,
    vertices: Part<'a, 1>,
    facet_sheets: &'a mut [u32],
    edge_sheets: &'a mut [u32],
}

struct Part<'a, const N: usize> {
    rows: &'a mut [[u32; N]],
    classes: &'a mut [Class],
}

impl<const N: usize> Part<'_, N> {
    fn take(&mut self, count: usize) -> Self {
        Self { rows: take(&mut self.rows, count), classes: take(&mut self.classes, count) }
    }

    /// Writes the next rows: their smallest vertex, the others, and classes.
    #[inline(always)]
    fn write<const M: usize>(
        &mut self,
        smallest: u32,
        rows: &[[u32; M]],
        classes: &mut Classes<'_>,
    ) {
        let Part { rows: own, classes: to } = self.take(rows.len());
        for ((row, to), others) in own.iter_mut().zip(to).zip(rows) {
            row[0] = smallest;
            row[1..].copy_from_slice(others);
            *to = classes.next();
        }
    }
}

#[expect(clippy::mut_mut, reason = "the slice itself becomes shorter")]
fn take<'a, T>(rest: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    rest.split_off_mut(..count).expect("as many as were counted")
}

impl Rest<'_> {
    fn take(&mut self, counts: Counts) -> Self {
        Self {
            cells: self.cells.take(counts.cells),
            facets: self.facets.take(counts.facets),
            edges: self.edges.take(counts.edges),
            vertices: self.vertices.take(counts.vertices),
            facet_sheets: take(&mut self.facet_sheets, counts.facet_sheets),
            edge_sheets: take(&mut self.edge_sheets, counts.edge_sheets),
        }
    }

    /// Writes the simplices of the next points, on all threads, given the location of their records and their ascending input
    /// indices. Returns the points that are not vertices of the triangulation.
    pub(super) fn write(
        &mut self,
        records: &[Records],
        locations: &[Location],
        input: &[u32],
        exterior: bool,
    ) -> Vec<u32> {
        let point = |at: &Location| &records[at.records as usize].points[at.point as usize];
        let chunks = locations.par_chunks(CHUNK);
        let counts: Vec<_> =
            chunks.map(|chunk| Counts::of(chunk.iter().map(point), exterior)).collect();
        let parts: Vec<_> = counts.into_iter().map(|counts| self.take(counts)).collect();
        let chunks =
            parts.into_par_iter().zip(locations.par_chunks(CHUNK)).zip(input.par_chunks(CHUNK));
        let hidden = chunks.flat_map_iter(|((mut part, locations), input)| {
            let mut hidden = Vec::new();
            for (location, &smallest) in locations.iter().zip(input) {
                let point = point(location);
                part.write_point(&records[location.records as usize], point, smallest, exterior);
                if point.class.is_none() {
                    hidden.push(smallest);
                }
            }
            hidden
        });
        hidden.collect()
    }

    /// Writes the simplices of the next point.
    fn write_point(&mut self, records: &Records, point: &PointRows, smallest: u32, exterior: bool) {
        let mut record = records.of(point);
        self.cells.write(smallest, record.cells, &mut record.classes);
        self.facets.write(smallest, record.facets, &mut record.classes);
        self.edges.write(smallest, record.edges, &mut record.classes);
        if let Some(class) = point.class.filter(|_| point.is_listed(exterior)) {
            let vertex = self.vertices.take(1);
            (vertex.rows[0], vertex.classes[0]) = ([smallest], class);
        }
        let sheets = record.facet_sheets;
        take(&mut self.facet_sheets, sheets.len()).copy_from_slice(sheets);
        let sheets = record.edge_sheets;
        take(&mut self.edge_sheets, sheets.len()).copy_from_slice(sheets);
    }
}
