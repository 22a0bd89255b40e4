//! Merges the rows of all blocks into one complex in canonical order.

use std::ops::Range;

use rayon::prelude::*;
use walpha_base::UnionFind;
use walpha_regular::Sites;

use super::block::{Answer, Question};
use super::classify::{Bucket, Buckets, Dimension, Owned, Rows, Side, Starts};
use super::partition::Partition;
use super::plan::Plan;
use crate::winding::{WindingSets, minus};
use crate::{Class, Complex, Simplices};

/// Sites merged by one thread at a time.
const CHUNK: usize = 1 << 12;

/// Puts the rows of blocks in the order of their smallest vertices, which they are stored without. Rows of one
/// smallest vertex are in order already. The rows of a bucket are freed before the next bucket is merged, so
/// that few rows are in memory twice.
pub(super) fn merge(
    sites: &Sites<'_>,
    plan: &Plan,
    mut blocks: Vec<Owned>,
    question: &Question,
    buckets: Buckets,
) -> Answer {
    let (sheets, sheet_windings) = common_sheets(&mut blocks);
    let mut components = components(sites, &mut blocks);
    plan.give_back();
    let locations = locations(sites, &plan.partition, buckets);
    let buckets = buckets.ranges(sites.input());
    let merged = Merged { input: sites.input(), locations, buckets, plan };
    // On a torus, one block with its halo is not the whole triangulation.
    let whole = blocks.len() == 1 && (sites.torus().is_none() || question.exterior);
    let hidden = whole.then(|| merged.hidden(&blocks));
    let vertices = merged.vertices(&blocks, question.exterior);
    let b0 = (vertices.iter())
        .filter(|&(&[v], class)| class != Class::Exterior && components.find(v) == v)
        .count() as u64;
    drop(components);
    let facet_sheets = merged.sheets(
        &mut blocks,
        Dimension::FacetSheets,
        |bucket| &mut bucket.facet_sheets,
        &sheets,
    );
    let edge_sheets = merged.sheets(
        &mut blocks,
        Dimension::EdgeSheets,
        |bucket| &mut bucket.edge_sheets,
        &sheets,
    );
    let facets = merged.rows(&mut blocks, Dimension::Facets, |bucket| &mut bucket.facets);
    let cells = merged.rows(&mut blocks, Dimension::Cells, |bucket| &mut bucket.cells);
    let edges = merged.rows(&mut blocks, Dimension::Edges, |bucket| &mut bucket.edges);
    let complex = Complex { cells, facets, edges, vertices };
    Answer { complex, b0, facet_sheets, edge_sheets, hidden, sheet_windings }
}

/// Where the rows of a site are.
#[derive(Clone, Copy, Default)]
struct Location {
    block: u32,
    /// Number of the site among the block's points in the site's bucket.
    point: u32,
}

fn locations(sites: &Sites<'_>, partition: &Partition, buckets: Buckets) -> Vec<Location> {
    let mut locations = vec![Location::default(); sites.input().len()];
    for block in 0..partition.len() {
        let mut counts = vec![0; buckets.count];
        for site in partition.own(sites, block) {
            let count = &mut counts[buckets.at(sites.input()[site as usize])];
            locations[site as usize] = Location { block: block as u32, point: *count };
            *count += 1;
        }
    }
    locations
}

/// The sites in the order of their input indices, with the locations of their rows.
struct Merged<'a> {
    input: &'a [u32],
    locations: Vec<Location>,
    /// The sites of each bucket.
    buckets: Vec<Range<usize>>,
    plan: &'a Plan,
}

/// Where the rows of each point start, by block.
struct BlockStarts<'a> {
    blocks: Vec<&'a [Starts]>,
    dimension: Dimension,
}

impl BlockStarts<'_> {
    fn range(&self, location: Location) -> Range<usize> {
        let start = |point: u32| {
            self.blocks[location.block as usize][point as usize][self.dimension as usize] as usize
        };
        start(location.point)..start(location.point + 1)
    }
}

impl Merged<'_> {
    /// Adds the smallest vertices to rows of `M` vertices: simplices of `N = M + 1`.
    fn rows<const M: usize, const N: usize>(
        &self,
        blocks: &mut [Owned],
        dimension: Dimension,
        of: fn(&mut Bucket) -> &mut Rows<M>,
    ) -> Simplices<N> {
        let buckets = blocks.iter_mut().flat_map(|block| &mut block.buckets);
        let total = buckets.map(|bucket| of(bucket).classes.len()).sum();
        let mut vertices = vec![[0; N]; total];
        let mut classes = vec![Class::Exterior; total];
        let (mut to, mut to_classes) = (&mut vertices[..], &mut classes[..]);
        for (bucket, sites) in self.buckets.iter().enumerate() {
            let (starts, rows) = take(blocks, bucket, dimension, of);
            let locations = &self.locations[sites.clone()];
            let count =
                |locations: &[Location]| locations.iter().map(|p| starts.range(*p).len()).sum();
            let counts: Vec<usize> = locations.par_chunks(CHUNK).map(count).collect();
            let to = split(&mut to, &counts).into_iter().zip(split(&mut to_classes, &counts));
            let from = locations.chunks(CHUNK).zip(self.input[sites.clone()].chunks(CHUNK));
            let tasks: Vec<_> = from.zip(to).collect();
            tasks.into_par_iter().for_each(|((locations, input), (mut vertices, mut classes))| {
                for (location, &smallest) in locations.iter().zip(input) {
                    let (rows, range) = (&rows[location.block as usize], starts.range(*location));
                    let own = split_off(&mut vertices, range.len());
                    for (to, from) in own.iter_mut().zip(&rows.vertices[range.clone()]) {
                        to[0] = smallest;
                        to[1..].copy_from_slice(from);
                    }
                    let own = split_off(&mut classes, range.len());
                    own.copy_from_slice(&rows.classes[range]);
                }
            });
            drop(rows);
            self.plan.give_back();
        }
        Simplices::new(vertices, classes).expect("as many classes as rows")
    }

    /// The sheets of boundary rows, in their common numbering.
    fn sheets(
        &self,
        blocks: &mut [Owned],
        dimension: Dimension,
        of: fn(&mut Bucket) -> &mut Vec<u32>,
        common: &[Vec<u32>],
    ) -> Vec<u32> {
        let mut merged = Vec::new();
        for (bucket, sites) in self.buckets.iter().enumerate() {
            let (starts, names) = take(blocks, bucket, dimension, of);
            let common = |location: &Location| {
                let (names, common) =
                    (&names[location.block as usize], &common[location.block as usize]);
                names[starts.range(*location)].iter().map(|&name| common[name as usize])
            };
            merged.par_extend(self.locations[sites.clone()].par_iter().flat_map_iter(common));
        }
        merged
    }

    /// Each site with its class; `None` for hidden sites.
    fn classes(&self, blocks: &[Owned]) -> impl Iterator<Item = (u32, Option<Class>)> {
        let buckets = self.buckets.iter().enumerate();
        buckets.flat_map(move |(bucket, sites)| {
            let input = &self.input[sites.clone()];
            let class = move |location: &Location| {
                blocks[location.block as usize].buckets[bucket].vertices[location.point as usize]
            };
            input.iter().copied().zip(self.locations[sites.clone()].iter().map(class))
        })
    }

    fn hidden(&self, blocks: &[Owned]) -> Vec<u32> {
        self.classes(blocks).filter(|(_, class)| class.is_none()).map(|(site, _)| site).collect()
    }

    fn vertices(&self, blocks: &[Owned], exterior: bool) -> Simplices<1> {
        let mut simplices = Simplices::default();
        for (site, class) in self.classes(blocks) {
            if let Some(class) = class.filter(|&class| exterior || class != Class::Exterior) {
                simplices.push([site], class);
            }
        }
        simplices
    }
}

/// Takes a list of a bucket from all blocks; also where the elements of each point start in it.
fn take<T: Default>(
    blocks: &mut [Owned],
    bucket: usize,
    dimension: Dimension,
    of: fn(&mut Bucket) -> &mut T,
) -> (BlockStarts<'_>, Vec<T>) {
    let take = |block: &mut Owned| std::mem::take(of(&mut block.buckets[bucket]));
    let taken = blocks.iter_mut().map(take).collect();
    let starts = blocks.iter().map(|block| &block.buckets[bucket].starts[..]).collect();
    (BlockStarts { blocks: starts, dimension }, taken)
}

/// Splits parts of these lengths off the front of a slice.
#[expect(clippy::mut_mut, reason = "the slice itself becomes shorter")]
fn split<'a, T>(whole: &mut &'a mut [T], lengths: &[usize]) -> Vec<&'a mut [T]> {
    lengths.iter().map(|&length| split_off(whole, length)).collect()
}

#[expect(clippy::mut_mut, reason = "the slice itself becomes shorter")]
fn split_off<'a, T>(whole: &mut &'a mut [T], length: usize) -> &'a mut [T] {
    whole.split_off_mut(..length).expect("as many as were counted")
}

/// A common numbering of the sheets of all blocks: those that share a side of a facet, or a singular edge, are
/// one. Returns the common number of each block's sheets, and the number of independent directions in which sheets
/// wind round a torus.
fn common_sheets(blocks: &mut [Owned]) -> (Vec<Vec<u32>>, usize) {
    let starts: Vec<u32> = (blocks.iter())
        .scan(0, |next, block| {
            let start = *next;
            *next += block.sheets;
            Some(start)
        })
        .collect();
    let mut shared = Vec::new();
    for (block, start) in blocks.iter_mut().zip(&starts) {
        let sides = std::mem::take(&mut block.shared).into_iter();
        let side = |side: Side| ((side.simplex, side.side), start + side.sheet, side.windings);
        shared.extend(sides.map(side));
    }
    shared.par_sort_unstable();
    let total: u32 = blocks.iter().map(|block| block.sheets).sum();
    let mut sets = WindingSets::new(total as usize);
    for pair in shared.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        // Moved so that their copies of the smallest vertex coincide.
        sets.unite(pair[0].1, pair[1].1, minus(pair[0].2, pair[1].2));
    }
    let numbers = |(block, start): (&Owned, &u32)| {
        (0..block.sheets).map(|sheet| sets.find(start + sheet).0).collect()
    };
    let numbers = blocks.iter().zip(&starts).map(numbers).collect();
    (numbers, sets.directions().rank())
}

/// The components, united over all blocks.
fn components(sites: &Sites<'_>, blocks: &mut [Owned]) -> UnionFind {
    let mut sets = UnionFind::new(sites.input().last().map_or(0, |&last| last as usize + 1));
    for block in blocks {
        for [a, b] in std::mem::take(&mut block.components) {
            sets.unite(a, b);
        }
    }
    sets
}
