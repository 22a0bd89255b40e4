//! The rows of all blocks as one complex, in canonical order.

use rayon::prelude::*;

use super::classify::{Dimension, Owned, Rows};
use super::{Answer, Partition, Plan};
use crate::shape::{Class, Complex, Simplices, UnionFind};
use crate::triangulation::Sites;

/// Sites merged by one thread at a time.
const CHUNK: usize = 1 << 13;

/// Puts the rows of blocks in order of their smallest vertices, which they come without. Around each
/// vertex rows are in order already. Blocks give the rows of one dimension back before those of the
/// next are merged; facets, the most, come first, while nothing else is there.
pub(super) fn merge(
    sites: &Sites<'_>,
    plan: &Plan,
    mut blocks: Vec<Owned>,
    exterior: bool,
) -> Answer {
    let sheets = common_sheets(&mut blocks);
    let mut components = components(sites, &mut blocks);
    plan.give_back();
    let places = places(sites, &plan.partition);
    let hidden = (blocks.len() == 1).then(|| hidden(sites, &places, &blocks));
    let vertices = vertices(sites, &places, &blocks, exterior);
    let b0 = (vertices.iter())
        .filter(|&(&[v], class)| class != Class::Exterior && components.find(v) == v)
        .count() as u64;
    drop(components);
    let merged = Merged { input: sites.input(), places: &places };
    let facets = merged.rows(&blocks, Dimension::Facets, |block| &block.facets);
    let facet_sheets =
        merged.sheets(&blocks, Dimension::FacetSheets, |block| &block.facet_sheets, &sheets);
    for block in &mut blocks {
        block.facets = Rows::default();
        block.facet_sheets = Vec::new();
    }
    plan.give_back();
    let cells = merged.rows(&blocks, Dimension::Cells, |block| &block.cells);
    blocks.iter_mut().for_each(|block| block.cells = Rows::default());
    plan.give_back();
    let edges = merged.rows(&blocks, Dimension::Edges, |block| &block.edges);
    let edge_sheets =
        merged.sheets(&blocks, Dimension::EdgeSheets, |block| &block.edge_sheets, &sheets);
    Answer {
        complex: Complex { cells, facets, edges, vertices },
        b0,
        facet_sheets,
        edge_sheets,
        hidden,
    }
}

/// Where a site's rows are.
#[derive(Clone, Copy, Default)]
struct Place {
    block: u32,
    /// Which of the block's points it is.
    point: u32,
}

impl Place {
    fn range(self, blocks: &[Owned], dimension: Dimension) -> std::ops::Range<usize> {
        let starts = &blocks[self.block as usize].starts;
        let start = |point: u32| starts[point as usize][dimension as usize] as usize;
        start(self.point)..start(self.point + 1)
    }
}

fn places(sites: &Sites<'_>, partition: &Partition) -> Vec<Place> {
    let mut places = vec![Place::default(); sites.input().len()];
    for block in 0..partition.len() {
        for (site, point) in partition.own(sites, block).zip(0..) {
            places[site as usize] = Place { block: block as u32, point };
        }
    }
    places
}

/// All sites in order.
struct Merged<'a> {
    input: &'a [u32],
    places: &'a [Place],
}

impl Merged<'_> {
    /// Rows of `M` vertices get their smallest and become simplices of `N = M + 1`.
    fn rows<const M: usize, const N: usize>(
        &self,
        blocks: &[Owned],
        dimension: Dimension,
        of: impl Fn(&Owned) -> &Rows<M> + Sync,
    ) -> Simplices<N> {
        let counts = self.counts(blocks, dimension);
        let total = counts.iter().sum();
        let mut vertices = vec![[0; N]; total];
        let mut classes = vec![Class::Exterior; total];
        let to = split(&mut vertices, &counts).into_iter().zip(split(&mut classes, &counts));
        let from = self.places.chunks(CHUNK).zip(self.input.chunks(CHUNK));
        let tasks: Vec<_> = from.zip(to).collect();
        tasks.into_par_iter().for_each(|((places, input), (mut vertices, mut classes))| {
            for (place, &smallest) in places.iter().zip(input) {
                let rows = of(&blocks[place.block as usize]);
                let range = place.range(blocks, dimension);
                let count = ..range.len();
                let own = vertices.split_off_mut(count).expect("as many rows as were counted");
                for (to, from) in own.iter_mut().zip(&rows.vertices[range.clone()]) {
                    to[0] = smallest;
                    to[1..].copy_from_slice(from);
                }
                let own = classes.split_off_mut(count).expect("as many classes as rows");
                own.copy_from_slice(&rows.classes[range]);
            }
        });
        Simplices { vertices, classes }
    }

    /// The common numbers of the sheets that boundary rows lie on.
    fn sheets(
        &self,
        blocks: &[Owned],
        dimension: Dimension,
        of: impl Fn(&Owned) -> &Vec<u32> + Sync,
        common: &[Vec<u32>],
    ) -> Vec<u32> {
        let mut merged = Vec::new();
        for place in self.places {
            let (block, common) = (&blocks[place.block as usize], &common[place.block as usize]);
            let names = &of(block)[place.range(blocks, dimension)];
            merged.extend(names.iter().map(|&name| common[name as usize]));
        }
        merged
    }

    /// How much each chunk has.
    fn counts(&self, blocks: &[Owned], dimension: Dimension) -> Vec<usize> {
        let count =
            |places: &[Place]| places.iter().map(|p| p.range(blocks, dimension).len()).sum();
        self.places.par_chunks(CHUNK).map(count).collect()
    }
}

/// Cuts a slice into pieces of these lengths.
fn split<'a, T>(mut whole: &'a mut [T], lengths: &[usize]) -> Vec<&'a mut [T]> {
    let piece = |&length: &usize| whole.split_off_mut(..length).expect("lengths of all pieces");
    lengths.iter().map(piece).collect()
}

fn hidden(sites: &Sites<'_>, places: &[Place], blocks: &[Owned]) -> Vec<u32> {
    let is_hidden =
        |place: &Place| blocks[place.block as usize].vertices[place.point as usize].is_none();
    let sites = sites.input().iter().zip(places);
    sites.filter(|(_, place)| is_hidden(place)).map(|(&site, _)| site).collect()
}

fn vertices(sites: &Sites<'_>, places: &[Place], blocks: &[Owned], exterior: bool) -> Simplices<1> {
    let mut simplices = Simplices::default();
    for (&site, place) in sites.input().iter().zip(places) {
        let class = blocks[place.block as usize].vertices[place.point as usize];
        if let Some(class) = class.filter(|&class| exterior || class != Class::Exterior) {
            simplices.vertices.push([site]);
            simplices.classes.push(class);
        }
    }
    simplices
}

/// Makes one numbering of the sheets of all blocks: those that share a side of a facet, or a
/// singular edge, are one. Gives each block's sheets their common numbers.
fn common_sheets(blocks: &mut [Owned]) -> Vec<Vec<u32>> {
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
        shared.extend(sides.map(|side| ((side.simplex, side.side), start + side.sheet)));
    }
    shared.par_sort_unstable();
    let total: u32 = blocks.iter().map(|block| block.sheets).sum();
    let mut sets = UnionFind::new(total as usize);
    for pair in shared.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        sets.unite(pair[0].1, pair[1].1);
    }
    let numbers = |(block, start): (&Owned, &u32)| {
        (0..block.sheets).map(|sheet| sets.find(start + sheet)).collect()
    };
    blocks.iter().zip(&starts).map(numbers).collect()
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
