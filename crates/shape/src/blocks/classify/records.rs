//! The simplices that a block owns, recorded by point, and further data for the merge of blocks.

use std::ops::Range;

use walpha_base::parallel::prelude::*;

use crate::Class;
use crate::blocks::gather::Counts;

/// The simplices that a block owns, and further data for the merge of blocks.
#[derive(Default)]
pub(in crate::blocks) struct Owned {
    /// The records by the bucket of the smallest vertex, and by the range of points along the curve.
    pub buckets: Vec<Vec<Records>>,
    /// Number of sheets.
    pub sheets: u32,
    /// Sides of facets, and singular edges, with vertices in this block and in others.
    pub shared: Vec<Side>,
    /// Pairs of a point and another one of its component, none of which follows from others: uniting these pairs gives the
    /// components.
    pub components: Vec<[u32; 2]>,
    /// The ends of edges of the shape between points of this block and of others, possibly repeated.
    pub border: Vec<u32>,
    /// On a torus: the first edge that spans half of the box or more, if one exists.
    pub long: Option<Long>,
}

/// An edge by its input indices, and its ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Long {
    pub edge: [u32; 2],
    pub ends: [[f64; 3]; 2],
}

/// Divides input indices into runs of about equal length, the buckets. The rows of one bucket are merged, and their
/// memory is freed, before those of the next.
#[derive(Clone, Copy)]
pub(in crate::blocks) struct Buckets {
    pub count: usize,
    length: u32,
}

impl Buckets {
    /// `count` buckets for these input indices, which ascend.
    pub(crate) fn new(input: &[u32], count: usize) -> Self {
        let end = input.last().map_or(0, |&last| last as usize + 1);
        Self { count, length: end.div_ceil(count).max(1) as u32 }
    }

    /// The bucket of an input index.
    pub(crate) fn at(self, input: u32) -> usize {
        ((input / self.length) as usize).min(self.count - 1)
    }

    /// For each bucket, the range of its elements among these ascending input indices.
    pub(crate) fn ranges(self, input: &[u32]) -> Vec<Range<usize>> {
        let start = |bucket| input.partition_point(|&i| self.at(i) < bucket);
        (0..self.count).map(|bucket| start(bucket)..start(bucket + 1)).collect()
    }
}

/// The simplices whose smallest vertices are given points of one bucket. These vertices are left out of the rows, and classes
/// take two bits each, which saves memory until blocks are merged. The data of a point is in one place, because points are merged
/// in another order than that along the curve.
#[derive(Clone, Default)]
pub(in crate::blocks) struct Records {
    pub points: Vec<PointRows>,
    /// For each point: the vertices of its cells, facets and edges, by input index, then their classes.
    words: Vec<u32>,
    /// For each point: the sheet of each regular facet, and both sheets of each singular facet, starting with the side where the
    /// facet's sorted row turns clockwise; then the sheet of each singular edge. Numbered from 0 within the block.
    sheets: Vec<u32>,
}

/// A point, and the number of simplices of which it is the smallest vertex.
#[derive(Clone, Copy)]
pub(in crate::blocks) struct PointRows {
    /// The class of the point, `None` if it is not a vertex.
    pub class: Option<Class>,
    pub cells: u32,
    pub facets: u32,
    pub edges: u32,
    pub facet_sheets: u32,
    pub edge_sheets: u32,
    words: u32,
    sheets: u32,
}

/// The record of a point: rows without their smallest vertices, and sheets.
pub(in crate::blocks) struct Record<'a> {
    pub cells: &'a [[u32; 3]],
    pub facets: &'a [[u32; 2]],
    pub edges: &'a [[u32; 1]],
    /// The classes of the cells, then of the facets, then of the edges.
    pub classes: Classes<'a>,
    pub facet_sheets: &'a [u32],
    pub edge_sheets: &'a [u32],
}

/// Classes, 16 to a word.
pub(in crate::blocks) struct Classes<'a> {
    words: std::slice::Iter<'a, u32>,
    /// The unread part of a word; the bit above it marks its end.
    rest: u64,
}

/// Classes in a word.
const CLASSES: usize = 16;

impl Classes<'_> {
    /// The next class; exterior after the last.
    #[inline(always)]
    pub(in crate::blocks) fn next(&mut self) -> Class {
        const END: u64 = 1;
        if self.rest == END {
            self.rest = u64::from(self.words.next().copied().unwrap_or(0)) | END << (2 * CLASSES);
        }
        let class = Class::ALL[(self.rest & 3) as usize];
        self.rest >>= 2;
        class
    }
}

impl Records {
    /// Returns the record of a point.
    pub(in crate::blocks) fn of(&self, point: &PointRows) -> Record<'_> {
        let mut words = &self.words[point.words as usize..];
        let mut rest = |length: u32| {
            let (first, others) = words.split_at(length as usize);
            words = others;
            first
        };
        let cells = rest(3 * point.cells).as_chunks().0;
        let facets = rest(2 * point.facets).as_chunks().0;
        let edges = rest(point.edges).as_chunks().0;
        let classes = Classes { words: words.iter(), rest: 1 };
        let sheets = &self.sheets[point.sheets as usize..];
        let (facet_sheets, sheets) = sheets.split_at(point.facet_sheets as usize);
        let edge_sheets = &sheets[..point.edge_sheets as usize];
        Record { cells, facets, edges, classes, facet_sheets, edge_sheets }
    }

    /// Records the next point, and empties the draft.
    pub(super) fn push(&mut self, class: Option<Class>, draft: &mut Draft) {
        let [words, sheets] = [&self.words, &self.sheets].map(|list| list.len() as u32);
        let Draft { cells, facets, edges, facet_sheets, edge_sheets, .. } = *draft;
        let counts =
            PointRows { class, cells, facets, edges, facet_sheets, edge_sheets, words, sheets };
        self.points.push(counts);
        self.words.extend_from_slice(&draft.words);
        let packed = |classes: &[Class]| {
            classes.iter().rev().fold(0, |word, &class| word << 2 | class as u32)
        };
        self.words.extend(draft.classes.chunks(CLASSES).map(packed));
        self.sheets.extend_from_slice(&draft.sheets);
        draft.clear();
    }

    pub(super) fn clear(&mut self) {
        self.points.clear();
        self.words.clear();
        self.sheets.clear();
    }
}

/// The record of a point while it is being found: first its cells, then its facets, then its edges, each ascending.
#[derive(Default)]
pub(super) struct Draft {
    words: Vec<u32>,
    classes: Vec<Class>,
    sheets: Vec<u32>,
    cells: u32,
    facets: u32,
    edges: u32,
    facet_sheets: u32,
    edge_sheets: u32,
}

impl Draft {
    pub(super) fn cell(&mut self, others: [u32; 3], class: Class) {
        self.words.extend(others);
        self.classes.push(class);
        self.cells += 1;
    }

    /// A facet, with the sheets that bound it.
    pub(super) fn facet(&mut self, others: [u32; 2], class: Class, sheets: &[u32]) {
        self.words.extend(others);
        self.classes.push(class);
        self.sheets.extend_from_slice(sheets);
        self.facets += 1;
        self.facet_sheets += sheets.len() as u32;
    }

    /// An edge, with the sheet around it if it is singular.
    pub(super) fn edge(&mut self, other: u32, class: Class, sheet: Option<u32>) {
        self.words.push(other);
        self.classes.push(class);
        self.sheets.extend(sheet);
        self.edges += 1;
        self.edge_sheets += u32::from(sheet.is_some());
    }

    fn clear(&mut self) {
        self.words.clear();
        self.classes.clear();
        self.sheets.clear();
        (self.cells, self.facets, self.edges) = (0, 0, 0);
        (self.facet_sheets, self.edge_sheets) = (0, 0);
    }
}

impl PointRows {
    /// Whether the point will be listed among the vertices.
    pub(in crate::blocks) fn is_listed(&self, exterior: bool) -> bool {
        self.class.is_some_and(|class| exterior || class != Class::Exterior)
    }
}

/// One side of a facet, or a singular edge, with vertices in several blocks.
#[derive(Debug)]
pub struct Side {
    /// Sorted input indices; an edge repeats its last one.
    pub simplex: [u32; 3],
    /// The side: 1 if an even permutation sorts the corners of the cell there, otherwise 0; 0 for an edge.
    pub side: u32,
    /// Its sheet within the block.
    pub sheet: u32,
    /// On a torus: the number of box sides by which its smallest vertex is moved, along each axis.
    pub windings: [i32; 3],
}

impl Owned {
    /// All records.
    pub(in crate::blocks) fn records(&self) -> impl ParallelIterator<Item = &Records> {
        self.buckets.par_iter().flatten()
    }

    /// Visits the sheets at all records, and those of shared sides.
    pub(in crate::blocks) fn each_sheet(&mut self, visit: impl Fn(&mut u32) + Sync) {
        let records = self.buckets.par_iter_mut().flatten();
        records.for_each(|records| records.sheets.iter_mut().for_each(&visit));
        self.shared.par_iter_mut().coarse().for_each(|side| visit(&mut side.sheet));
    }

    /// The number of points.
    pub(in crate::blocks) fn points(&self) -> usize {
        self.records().map(|records| records.points.len()).sum()
    }

    /// Bytes of the rows, classes and sheets after merging.
    pub(in crate::blocks) fn merged_bytes(&self, exterior: bool) -> u64 {
        Counts::of_all(self.records(), exterior).bytes()
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::Monitor;
    use walpha_regular::internals::Lattice;
    use walpha_regular::internals::Sites;

    use super::*;
    use crate::blocks::block::BlockParams;
    use crate::blocks::merge::merge;
    use crate::blocks::run::decide;
    use crate::blocks::{Limits, Plan, Reach};

    #[test]
    fn merged_rows_take_the_bytes_foreseen() {
        let axis = || (0..5).map(f64::from);
        let rows = axis().flat_map(|z| axis().flat_map(move |y| axis().map(move |x| [x, y, z])));
        // Points of which facets and edges dangle.
        let apart =
            [[9.0, 0.0, 0.0], [9.5, 0.0, 0.0], [8.7, 0.3, 0.0], [9.0, 0.0, 3.0], [9.0, 0.5, 3.0]];
        let positions: Vec<_> = rows.chain(apart).collect();
        let weights = vec![0.0; positions.len()];
        let sites = Sites::new(&positions, &weights).unwrap();
        let lattice = Lattice::of(&positions, &weights);
        let params = BlockParams { alpha: 0.75, lattice, exterior: false };
        for blocks in [1, 7] {
            let limits = Limits { blocks: Some(blocks), memory: None };
            let plan = Plan::new(&sites, Reach::Balls(0.75), limits).unwrap();
            let buckets = Buckets::new(sites.input(), 1);
            let monitor = Monitor::noop();
            let work = monitor.units(1);
            let owned: Vec<_> = (0..plan.partition.len())
                .map(|block| decide(&sites, &plan.partition, block, &params, buckets, &work))
                .collect::<Result<_, _>>()
                .unwrap();
            assert_eq!(owned.iter().map(Owned::points).sum::<usize>(), positions.len());
            let foreseen: u64 = owned.iter().map(|owned| owned.merged_bytes(false)).sum();
            let made = merge(&sites, &plan, owned, &params, buckets);
            let complex = &made.complex;
            assert!(made.facet_sheets.len() > 2 && !made.edge_sheets.is_empty());
            let bytes = size_of_val(complex.cells.rows())
                + size_of_val(complex.cells.classes())
                + size_of_val(complex.facets.rows())
                + size_of_val(complex.facets.classes())
                + size_of_val(complex.edges.rows())
                + size_of_val(complex.edges.classes())
                + size_of_val(complex.vertices.rows())
                + size_of_val(complex.vertices.classes())
                + size_of_val(&made.facet_sheets[..])
                + size_of_val(&made.edge_sheets[..]);
            assert_eq!(foreseen, bytes as u64, "{blocks}");
        }
    }
}
