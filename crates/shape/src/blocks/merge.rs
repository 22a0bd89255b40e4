//! The rows of all blocks as one complex, in canonical order.

use std::ops::Range;

use rayon::prelude::*;
use walpha_base::UnionFind;
use walpha_regular::Sites;

use super::classify::{Dimension, Owned, Rows, Shelf, Shelves, Side};
use super::{Answer, Partition, Plan, Question};
use crate::winding::{WindingSets, minus};
use crate::{Class, Complex, Simplices};

/// Sites merged by one thread at a time.
const CHUNK: usize = 1 << 12;

/// Puts the rows of blocks in order of their smallest vertices, which they come without. Around each
/// vertex rows are in order already. Blocks give the rows of one shelf back before those of the next
/// are merged, so that little is there twice.
pub(super) fn merge(
    sites: &Sites<'_>,
    plan: &Plan,
    mut blocks: Vec<Owned>,
    question: &Question,
    shelves: Shelves,
) -> Answer {
    let (sheets, sheet_windings) = common_sheets(&mut blocks);
    let mut components = components(sites, &mut blocks);
    plan.give_back();
    let places = places(sites, &plan.partition, shelves);
    let shelves = shelves.ranges(sites.input());
    let merged = Merged { input: sites.input(), places, shelves, plan };
    // Of a torus, one block with its halo is not the whole.
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
        |shelf| &mut shelf.facet_sheets,
        &sheets,
    );
    let edge_sheets =
        merged.sheets(&mut blocks, Dimension::EdgeSheets, |shelf| &mut shelf.edge_sheets, &sheets);
    let facets = merged.rows(&mut blocks, Dimension::Facets, |shelf| &mut shelf.facets);
    let cells = merged.rows(&mut blocks, Dimension::Cells, |shelf| &mut shelf.cells);
    let edges = merged.rows(&mut blocks, Dimension::Edges, |shelf| &mut shelf.edges);
    let complex = Complex { cells, facets, edges, vertices };
    Answer { complex, b0, facet_sheets, edge_sheets, hidden, sheet_windings }
}

/// Where a site's rows are.
#[derive(Clone, Copy, Default)]
struct Place {
    block: u32,
    /// Which of the points it is that the block has on the site's shelf.
    point: u32,
}

fn places(sites: &Sites<'_>, partition: &Partition, shelves: Shelves) -> Vec<Place> {
    let mut places = vec![Place::default(); sites.input().len()];
    for block in 0..partition.len() {
        let mut counts = vec![0; shelves.count];
        for site in partition.own(sites, block) {
            let count = &mut counts[shelves.at(sites.input()[site as usize])];
            places[site as usize] = Place { block: block as u32, point: *count };
            *count += 1;
        }
    }
    places
}

/// All sites in order.
struct Merged<'a> {
    input: &'a [u32],
    places: Vec<Place>,
    /// The sites of each shelf.
    shelves: Vec<Range<usize>>,
    plan: &'a Plan,
}

/// Where the rows of each point begin, by block.
struct Starts<'a> {
    blocks: Vec<&'a [[u32; 5]]>,
    dimension: Dimension,
}

impl Starts<'_> {
    fn range(&self, place: Place) -> Range<usize> {
        let start = |point: u32| {
            self.blocks[place.block as usize][point as usize][self.dimension as usize] as usize
        };
        start(place.point)..start(place.point + 1)
    }
}

impl Merged<'_> {
    /// Rows of `M` vertices get their smallest and become simplices of `N = M + 1`.
    fn rows<const M: usize, const N: usize>(
        &self,
        blocks: &mut [Owned],
        dimension: Dimension,
        of: fn(&mut Shelf) -> &mut Rows<M>,
    ) -> Simplices<N> {
        let shelves = blocks.iter_mut().flat_map(|block| &mut block.shelves);
        let total = shelves.map(|shelf| of(shelf).classes.len()).sum();
        let mut vertices = vec![[0; N]; total];
        let mut classes = vec![Class::Exterior; total];
        let (mut to, mut to_classes) = (&mut vertices[..], &mut classes[..]);
        for (shelf, sites) in self.shelves.iter().enumerate() {
            let (starts, rows) = take(blocks, shelf, dimension, of);
            let places = &self.places[sites.clone()];
            let count = |places: &[Place]| places.iter().map(|p| starts.range(*p).len()).sum();
            let counts: Vec<usize> = places.par_chunks(CHUNK).map(count).collect();
            let to = split(&mut to, &counts).into_iter().zip(split(&mut to_classes, &counts));
            let from = places.chunks(CHUNK).zip(self.input[sites.clone()].chunks(CHUNK));
            let tasks: Vec<_> = from.zip(to).collect();
            tasks.into_par_iter().for_each(|((places, input), (mut vertices, mut classes))| {
                for (place, &smallest) in places.iter().zip(input) {
                    let (rows, range) = (&rows[place.block as usize], starts.range(*place));
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

    /// The common numbers of the sheets that boundary rows lie on.
    fn sheets(
        &self,
        blocks: &mut [Owned],
        dimension: Dimension,
        of: fn(&mut Shelf) -> &mut Vec<u32>,
        common: &[Vec<u32>],
    ) -> Vec<u32> {
        let mut merged = Vec::new();
        for (shelf, sites) in self.shelves.iter().enumerate() {
            let (starts, names) = take(blocks, shelf, dimension, of);
            let common = |place: &Place| {
                let (names, common) = (&names[place.block as usize], &common[place.block as usize]);
                names[starts.range(*place)].iter().map(|&name| common[name as usize])
            };
            merged.par_extend(self.places[sites.clone()].par_iter().flat_map_iter(common));
        }
        merged
    }

    /// Each site with its class, if it is a vertex.
    fn classes(&self, blocks: &[Owned]) -> impl Iterator<Item = (u32, Option<Class>)> {
        let shelves = self.shelves.iter().enumerate();
        shelves.flat_map(move |(shelf, sites)| {
            let input = &self.input[sites.clone()];
            let class = move |place: &Place| {
                blocks[place.block as usize].shelves[shelf].vertices[place.point as usize]
            };
            input.iter().copied().zip(self.places[sites.clone()].iter().map(class))
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

/// What all blocks have on a shelf, taken from them, and where each point's begins.
fn take<T: Default>(
    blocks: &mut [Owned],
    shelf: usize,
    dimension: Dimension,
    of: fn(&mut Shelf) -> &mut T,
) -> (Starts<'_>, Vec<T>) {
    let take = |block: &mut Owned| std::mem::take(of(&mut block.shelves[shelf]));
    let taken = blocks.iter_mut().map(take).collect();
    let starts = blocks.iter().map(|block| &block.shelves[shelf].starts[..]).collect();
    (Starts { blocks: starts, dimension }, taken)
}

/// Cuts pieces of these lengths off a slice.
#[expect(clippy::mut_mut, reason = "the slice itself becomes shorter")]
fn split<'a, T>(whole: &mut &'a mut [T], lengths: &[usize]) -> Vec<&'a mut [T]> {
    lengths.iter().map(|&length| split_off(whole, length)).collect()
}

#[expect(clippy::mut_mut, reason = "the slice itself becomes shorter")]
fn split_off<'a, T>(whole: &mut &'a mut [T], length: usize) -> &'a mut [T] {
    whole.split_off_mut(..length).expect("as many as were counted")
}

/// Makes one numbering of the sheets of all blocks: those that share a side of a facet, or a
/// singular edge, are one. Gives each block's sheets their common numbers, and in how many directions
/// sheets go round a torus.
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
        // Both meet where their copies of the smallest vertex do.
        sets.unite(pair[0].1, pair[1].1, minus(pair[0].2, pair[1].2));
    }
    let numbers = |(block, start): (&Owned, &u32)| {
        (0..block.sheets).map(|sheet| sets.find(start + sheet).0).collect()
    };
    let numbers = blocks.iter().zip(&starts).map(numbers).collect();
    (numbers, sets.directions().rank())
}

/// The points united by all blocks.
fn components(sites: &Sites<'_>, blocks: &mut [Owned]) -> UnionFind {
    let mut sets = UnionFind::new(sites.input().last().map_or(0, |&last| last as usize + 1));
    for block in blocks {
        for [a, b] in std::mem::take(&mut block.joined) {
            sets.unite(a, b);
        }
    }
    sets
}
