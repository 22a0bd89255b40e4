//! The rows of all slabs as one complex, in canonical order.

use std::ops::Range;

use rayon::prelude::*;

use super::partition::Partition;
use super::{Answer, common_sheets};
use crate::cgal::{HIDDEN, RawSlab, Sites, SlabQuestion};
use crate::shape::{Class, Complex, Simplices};

/// Puts the rows of slabs in order of their smallest vertices, which they come without. Each slab's
/// rows are in order already. Slabs give the rows of one dimension back before those of the next are
/// merged; facets, the most, come first, while nothing else is there.
pub(super) fn merge(
    sites: &Sites,
    partition: &Partition,
    mut slabs: Vec<RawSlab>,
    question: &SlabQuestion,
) -> Answer {
    let sheets = common_sheets(&slabs);
    slabs.iter_mut().for_each(RawSlab::drop_shared);
    question.give_back();
    let blocks = blocks(sites.input(), partition.owner(), &slabs);
    let vertices = vertices(&blocks, &slabs, question.exterior);
    let facets = rows(&blocks, &slabs, 1, RawSlab::facets);
    let facet_sheets =
        boundary(&blocks, &slabs, 1, |slab| (slab.facets().1, slab.facet_sheets()), &sheets);
    slabs.iter_mut().for_each(RawSlab::drop_facets);
    question.give_back();
    let cells = rows(&blocks, &slabs, 0, RawSlab::cells);
    slabs.iter_mut().for_each(RawSlab::drop_cells);
    question.give_back();
    let edges = rows(&blocks, &slabs, 2, RawSlab::edges);
    let edge_sheets =
        boundary(&blocks, &slabs, 2, |slab| (slab.edges().1, slab.edge_sheets()), &sheets);
    Answer { complex: Complex { cells, facets, edges, vertices }, facet_sheets, edge_sheets }
}

/// Some sites in order, merged by one thread.
struct Block<'a> {
    /// Their input indices.
    sites: &'a [u32],
    /// The slab of each.
    owners: &'a [u32],
    /// How far each slab has come where the block begins.
    at: Vec<Place>,
    /// How many rows of each dimension it has: cells, facets, edges.
    rows: [usize; 3],
}

/// A place in what a slab says: sites of its own before it, and their rows of each dimension.
#[derive(Clone, Copy, Default)]
struct Place {
    sites: usize,
    rows: [usize; 3],
}

/// Sites in a row of one slab.
struct Run<'a> {
    slab: usize,
    /// Their input indices.
    sites: &'a [u32],
    /// Which of the slab's own they are.
    ordinals: Range<usize>,
    /// Their rows in one dimension.
    rows: Range<usize>,
}

fn blocks<'a>(sites: &'a [u32], owner: &'a [u32], slabs: &[RawSlab]) -> Vec<Block<'a>> {
    const SITES: usize = 1 << 14;
    let mut at = vec![Place::default(); slabs.len()];
    let block = |(sites, owners): (&'a [u32], &'a [u32])| {
        let start = at.clone();
        let mut rows = [0; 3];
        for &slab in owners {
            let place = &mut at[slab as usize];
            let counts = slabs[slab as usize].counts()[place.sites];
            place.sites += 1;
            for dimension in 0..3 {
                place.rows[dimension] += counts[dimension] as usize;
                rows[dimension] += counts[dimension] as usize;
            }
        }
        Block { sites, owners, at: start, rows }
    };
    sites.chunks(SITES).zip(owner.chunks(SITES)).map(block).collect()
}

impl<'a> Block<'a> {
    fn runs(&self, slabs: &[RawSlab], dimension: usize) -> impl Iterator<Item = Run<'a>> {
        let (mut sites, mut at) = (self.sites, self.at.clone());
        self.owners.chunk_by(|a, b| a == b).map(move |owners| {
            let slab = owners[0] as usize;
            let (here, later) = sites.split_at(owners.len());
            sites = later;
            let place = &mut at[slab];
            let (ordinal, row) = (place.sites, place.rows[dimension]);
            place.sites += here.len();
            let counts = &slabs[slab].counts()[ordinal..place.sites];
            place.rows[dimension] += counts.iter().map(|n| n[dimension] as usize).sum::<usize>();
            let (ordinals, rows) = (ordinal..place.sites, row..place.rows[dimension]);
            Run { slab, sites: here, ordinals, rows }
        })
    }
}

/// Rows of `M` vertices get their smallest and become simplices of `N = M + 1`.
fn rows<const M: usize, const N: usize>(
    blocks: &[Block],
    slabs: &[RawSlab],
    dimension: usize,
    of: impl Fn(&RawSlab) -> (&[[u32; M]], &[u8]) + Sync,
) -> Simplices<N> {
    let total = blocks.iter().map(|block| block.rows[dimension]).sum();
    let mut vertices = vec![[0; N]; total];
    let mut classes = vec![Class::Exterior; total];
    let (mut to_vertices, mut to_classes) = (&mut vertices[..], &mut classes[..]);
    let mut tasks = Vec::with_capacity(blocks.len());
    for block in blocks {
        let count = ..block.rows[dimension];
        let vertices = to_vertices.split_off_mut(count).expect("as many rows as were counted");
        let classes = to_classes.split_off_mut(count).expect("as many classes as rows");
        tasks.push((block, vertices, classes));
    }
    tasks.into_par_iter().for_each(|(block, vertices, classes)| {
        let mut to = vertices.iter_mut().zip(classes);
        for run in block.runs(slabs, dimension) {
            let (rows, numbers) = of(&slabs[run.slab]);
            let mut from = rows[run.rows.clone()].iter().zip(&numbers[run.rows]);
            let counts = &slabs[run.slab].counts()[run.ordinals];
            for (&site, count) in run.sites.iter().zip(counts) {
                let count = count[dimension] as usize;
                for ((row, &number), (vertices, class)) in (&mut from).zip(&mut to).take(count) {
                    vertices[0] = site;
                    vertices[1..].copy_from_slice(row);
                    *class = Class::from_number(number);
                }
            }
        }
    });
    Simplices { vertices, classes }
}

/// The common numbers of the sheets that boundary rows lie on: one for each regular facet, two for
/// each singular facet, one for each singular edge. `of` gives a slab's classes and sheets.
fn boundary(
    blocks: &[Block],
    slabs: &[RawSlab],
    dimension: usize,
    of: impl Fn(&RawSlab) -> (&[u8], &[u32]),
    common: &[Vec<u32>],
) -> Vec<u32> {
    let mut merged = Vec::new();
    let mut at = vec![0; slabs.len()];
    for run in blocks.iter().flat_map(|block| block.runs(slabs, dimension)) {
        let (classes, sheets) = of(&slabs[run.slab]);
        let sides = |&number: &u8| match Class::from_number(number) {
            Class::Regular if dimension == 1 => 1,
            Class::Singular => 3 - dimension,
            _ => 0,
        };
        let start = at[run.slab];
        at[run.slab] += classes[run.rows].iter().map(sides).sum::<usize>();
        let names = &sheets[start..at[run.slab]];
        merged.extend(names.iter().map(|&name| common[run.slab][name as usize]));
    }
    merged
}

fn vertices(blocks: &[Block], slabs: &[RawSlab], exterior: bool) -> Simplices<1> {
    let mut simplices = Simplices::default();
    for run in blocks.iter().flat_map(|block| block.runs(slabs, 0)) {
        let numbers = &slabs[run.slab].vertex_classes()[run.ordinals];
        for (&site, &number) in run.sites.iter().zip(numbers) {
            if number != HIDDEN && (exterior || Class::from_number(number) != Class::Exterior) {
                simplices.vertices.push([site]);
                simplices.classes.push(Class::from_number(number));
            }
        }
    }
    simplices
}
