//! The simplices that a block owns, in buckets, and what the merge of blocks needs besides.

use std::ops::Range;

use super::state::State;
use crate::Class;

/// The simplices that a block owns, and what the merge of blocks needs besides.
#[derive(Default)]
pub(in crate::blocks) struct Owned {
    /// All simplices, until they are put into buckets.
    pub(super) rows: Bucket,
    /// The simplices by the bucket of their smallest vertices.
    pub buckets: Vec<Bucket>,
    /// Number of sheets.
    pub sheets: u32,
    /// Sides of facets, and singular edges, with vertices in this block and in others.
    pub shared: Vec<Side>,
    /// Points, each with another one of its component: uniting these pairs gives the components.
    pub components: Vec<[u32; 2]>,
    /// The ends of edges of the shape between points of this block and of others, possibly repeated.
    pub border: Vec<u32>,
    /// On a torus: an edge that spans half of the box or more, if there is one.
    pub long: Option<Long>,
}

/// An edge by its input indices, and its ends.
#[derive(Clone, Copy, Debug)]
pub(in crate::blocks) struct Long {
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
        (input / self.length) as usize
    }

    /// By bucket, the range of its elements in these input indices, which ascend.
    pub(crate) fn ranges(self, input: &[u32]) -> Vec<Range<usize>> {
        let start = |bucket| input.partition_point(|&i| self.at(i) < bucket);
        (0..self.count).map(|bucket| start(bucket)..start(bucket + 1)).collect()
    }
}

/// The simplices that a block owns whose smallest vertices are in one bucket, grouped by smallest vertex. That
/// vertex is left out of the rows, which saves a quarter to a half of their memory until blocks are merged.
#[derive(Default)]
pub(in crate::blocks) struct Bucket {
    pub cells: Rows<3>,
    pub facets: Rows<2>,
    pub edges: Rows<1>,
    /// The class of each point, `None` for those that are not vertices.
    pub vertices: Vec<Option<Class>>,
    /// By point, where its rows and sheets start, in the columns of [`Dimension`]; and where the last ones end.
    pub starts: Vec<Starts>,
    /// The sheet of each regular facet, and the two of each singular facet: first that on the side where
    /// the facet's sorted row turns clockwise. Numbered from 0 within the block.
    pub facet_sheets: Vec<u32>,
    /// The sheet of each singular edge.
    pub edge_sheets: Vec<u32>,
}

/// Positions in each of the lists of a [`Bucket`], by [`Dimension`].
pub(in crate::blocks) type Starts = [u32; 5];

/// Columns of [`Starts`].
#[derive(Clone, Copy)]
pub(in crate::blocks) enum Dimension {
    Cells,
    Facets,
    Edges,
    FacetSheets,
    EdgeSheets,
}

/// Simplices of `M` + 1 vertices, by input index, without the smallest.
pub(in crate::blocks) struct Rows<const M: usize> {
    pub vertices: Vec<[u32; M]>,
    pub classes: Vec<Class>,
}

impl<const M: usize> Default for Rows<M> {
    fn default() -> Self {
        Self { vertices: Vec::new(), classes: Vec::new() }
    }
}

impl<const M: usize> Rows<M> {
    /// Reserves memory for at most `most` rows, so that none is copied later.
    fn reserve(&mut self, most: usize) {
        self.vertices.reserve_exact(most);
        self.classes.reserve_exact(most);
    }

    pub(crate) fn push(&mut self, row: [u32; M], class: Class) {
        self.vertices.push(row);
        self.classes.push(class);
    }

    fn of(&self, ranges: impl Iterator<Item = Range<usize>> + Clone) -> Self {
        let vertices = gathered(&self.vertices, ranges.clone());
        Self { vertices, classes: gathered(&self.classes, ranges) }
    }
}

/// One side of a facet, or a singular edge, with vertices in several blocks.
pub struct Side {
    /// Sorted input indices; an edge repeats its last one.
    pub simplex: [u32; 3],
    /// Which side: 1 where an even permutation sorts the corners of the cell there, else 0; 0 for an edge.
    pub side: u32,
    /// Its sheet within the block.
    pub sheet: u32,
    /// On a torus: by how many sides its smallest vertex is moved.
    pub windings: [i32; 3],
}

/// Bytes of a merged simplex with so many vertices: 32-bit input indices and a class.
const fn merged_row(vertices: usize) -> usize {
    vertices * size_of::<u32>() + size_of::<Class>()
}

impl Owned {
    /// Reserves memory for the rows of a block whose cells have these states: an upper bound, as other blocks own
    /// some of them.
    pub(super) fn reserve(&mut self, states: &[State], points: usize) {
        let (mut cells, mut facets) = (0, 0);
        for state in states {
            cells += usize::from(state.is_inside());
            facets += state.emitted();
        }
        self.rows.cells.reserve(cells);
        self.rows.facets.reserve(facets);
        // By Euler's formula, a triangulation has about as many edges as cells and vertices together.
        self.rows.edges.reserve(cells + points);
        self.rows.starts.reserve_exact(points + 1);
        self.rows.vertices.reserve_exact(points);
    }

    /// The number of points.
    pub(crate) fn points(&self) -> usize {
        self.buckets.iter().map(|bucket| bucket.vertices.len()).sum()
    }

    /// Bytes of the rows, classes and sheets after merging.
    pub(crate) fn merged_bytes(&self) -> u64 {
        let bytes = |bucket: &Bucket| {
            let rows = merged_row(4) * bucket.cells.classes.len()
                + merged_row(3) * bucket.facets.classes.len()
                + merged_row(2) * bucket.edges.classes.len()
                + merged_row(1) * bucket.vertices.len();
            rows + size_of::<u32>() * (bucket.facet_sheets.len() + bucket.edge_sheets.len())
        };
        self.buckets.iter().map(bytes).sum::<usize>() as u64
    }

    /// Distributes the rows of points with these input indices to buckets.
    pub(super) fn fill_buckets(&mut self, buckets: Buckets, input: &[u32]) {
        let rows = std::mem::take(&mut self.rows);
        self.buckets = if buckets.count == 1 {
            vec![rows]
        } else {
            let mut points = vec![Vec::new(); buckets.count];
            (0..).zip(input).for_each(|(v, &i)| points[buckets.at(i)].push(v));
            points.iter().map(|points| rows.of(points)).collect()
        };
    }
}

impl Bucket {
    /// Starts the rows of the next point.
    pub(super) fn begin(&mut self) {
        self.starts.push(
            [
                self.cells.classes.len(),
                self.facets.classes.len(),
                self.edges.classes.len(),
                self.facet_sheets.len(),
                self.edge_sheets.len(),
            ]
            .map(|len| len as u32),
        );
    }

    /// The rows of some of the points.
    fn of(&self, points: &[u32]) -> Self {
        let ranges = |dimension: Dimension| {
            let start = move |v: u32| self.starts[v as usize][dimension as usize] as usize;
            points.iter().map(move |&v| start(v)..start(v + 1))
        };
        let mut bucket = Self {
            cells: self.cells.of(ranges(Dimension::Cells)),
            facets: self.facets.of(ranges(Dimension::Facets)),
            edges: self.edges.of(ranges(Dimension::Edges)),
            vertices: points.iter().map(|&v| self.vertices[v as usize]).collect(),
            starts: Vec::with_capacity(points.len() + 1),
            facet_sheets: gathered(&self.facet_sheets, ranges(Dimension::FacetSheets)),
            edge_sheets: gathered(&self.edge_sheets, ranges(Dimension::EdgeSheets)),
        };
        let mut end = [0; 5];
        bucket.starts.push(end);
        for &v in points {
            let [from, to] = [self.starts[v as usize], self.starts[v as usize + 1]];
            (0..5).for_each(|k| end[k] += to[k] - from[k]);
            bucket.starts.push(end);
        }
        bucket
    }
}

/// The elements in these ranges, in a vector of exactly their number.
fn gathered<T: Copy>(from: &[T], ranges: impl Iterator<Item = Range<usize>> + Clone) -> Vec<T> {
    let mut to = Vec::with_capacity(ranges.clone().map(|range| range.len()).sum());
    ranges.for_each(|range| to.extend_from_slice(&from[range]));
    to
}

#[cfg(test)]
mod tests {
    use walpha_base::Monitor;
    use walpha_regular::Lattice;
    use walpha_regular::Sites;

    use super::*;
    use crate::blocks::block::Question;
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
        let question = Question { alpha: 0.75, lattice, exterior: false };
        for blocks in [1, 7] {
            let limits = Limits { blocks: Some(blocks), memory: None };
            let plan = Plan::new(&sites, Reach::Balls(0.75), limits).unwrap();
            let buckets = Buckets::new(sites.input(), 1);
            let monitor = Monitor::noop();
            let work = monitor.units(1);
            let owned: Vec<_> = (0..plan.partition.len())
                .map(|block| decide(&sites, &plan.partition, block, &question, buckets, &work))
                .collect::<Result<_, _>>()
                .unwrap();
            assert_eq!(owned.iter().map(Owned::points).sum::<usize>(), positions.len());
            let foreseen: u64 = owned.iter().map(Owned::merged_bytes).sum();
            let made = merge(&sites, &plan, owned, &question, buckets);
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
