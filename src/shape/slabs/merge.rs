//! The rows of all slabs as one complex, in canonical order.

use std::ops::Range;

use rayon::prelude::*;

use super::partition::Partition;
use super::{Answer, common_sheets};
use crate::cgal::{HIDDEN, RawSlab, Sites};
use crate::shape::{Class, Complex, Simplices};

/// Puts the rows of slabs in order of their smallest vertices. Each slab's rows are so already, so
/// runs of sites of one slab are copied whole. Slabs give the rows of one dimension back before
/// those of the next are merged.
pub(super) fn merge(
    sites: &Sites,
    partition: &Partition,
    mut slabs: Vec<RawSlab>,
    exterior: bool,
) -> Answer {
    let sheets = common_sheets(&slabs);
    let runs = runs(partition.owner(), slabs.len());
    let vertices = vertices(&runs, &slabs, sites.input(), exterior);
    let cells = rows(&runs, &slabs, 0, RawSlab::cells);
    slabs.iter_mut().for_each(RawSlab::drop_cells);
    let facets = rows(&runs, &slabs, 1, RawSlab::facets);
    let facet_sheets = boundary(&runs, &slabs, 1, RawSlab::facets, RawSlab::facet_sheets, &sheets);
    slabs.iter_mut().for_each(RawSlab::drop_facets);
    let edges = rows(&runs, &slabs, 2, RawSlab::edges);
    let edge_sheets = boundary(&runs, &slabs, 2, RawSlab::edges, RawSlab::edge_sheets, &sheets);
    Answer { complex: Complex { cells, facets, edges, vertices }, facet_sheets, edge_sheets }
}

/// Sites in a row that one slab owns, by their ordinals among that slab's own.
struct Run {
    slab: usize,
    ordinals: Range<usize>,
}

fn runs(owner: &[u32], slabs: usize) -> Vec<Run> {
    let mut next = vec![0; slabs];
    let run = |sites: &[u32]| {
        let slab = sites[0] as usize;
        let start = next[slab];
        next[slab] += sites.len();
        Run { slab, ordinals: start..next[slab] }
    };
    owner.chunk_by(|a, b| a == b).map(run).collect()
}

/// For each run the range of its rows among those of its slab.
fn ranges(runs: &[Run], slabs: &[RawSlab], dimension: usize) -> Vec<Range<usize>> {
    let mut at = vec![0; slabs.len()];
    let range = |run: &Run| {
        let counts = &slabs[run.slab].counts()[run.ordinals.clone()];
        let start = at[run.slab];
        at[run.slab] += counts.iter().map(|count| count[dimension] as usize).sum::<usize>();
        start..at[run.slab]
    };
    runs.iter().map(range).collect()
}

fn rows<const N: usize>(
    runs: &[Run],
    slabs: &[RawSlab],
    dimension: usize,
    of: impl Fn(&RawSlab) -> (&[[u32; N]], &[u8]),
) -> Simplices<N> {
    let parts: Vec<_> = slabs.iter().map(of).collect();
    let total = parts.iter().map(|part| part.0.len()).sum();
    let mut vertices = vec![[0; N]; total];
    let mut classes = vec![Class::Exterior; total];
    let (mut to_vertices, mut to_classes) = (&mut vertices[..], &mut classes[..]);
    let mut copies = Vec::with_capacity(runs.len());
    for (run, range) in runs.iter().zip(ranges(runs, slabs, dimension)) {
        let (rows, numbers) = parts[run.slab];
        let to = (
            to_vertices.split_off_mut(..range.len()).expect("as many rows as were counted"),
            to_classes.split_off_mut(..range.len()).expect("as many classes as rows"),
        );
        copies.push((to, &rows[range.clone()], &numbers[range]));
    }
    copies.into_par_iter().with_min_len(64).for_each(|((vertices, classes), rows, numbers)| {
        vertices.copy_from_slice(rows);
        for (class, &number) in classes.iter_mut().zip(numbers) {
            *class = Class::from_number(number);
        }
    });
    Simplices { vertices, classes }
}

/// The common numbers of the sheets that boundary rows lie on: one for each regular facet, two for
/// each singular facet, one for each singular edge.
fn boundary<const N: usize>(
    runs: &[Run],
    slabs: &[RawSlab],
    dimension: usize,
    rows: impl Fn(&RawSlab) -> (&[[u32; N]], &[u8]),
    sheets: impl Fn(&RawSlab) -> &[u32],
    common: &[Vec<u32>],
) -> Vec<u32> {
    let mut merged = Vec::new();
    let mut at = vec![0; slabs.len()];
    for (run, range) in runs.iter().zip(ranges(runs, slabs, dimension)) {
        let slab = &slabs[run.slab];
        let sides = |&number: &u8| match Class::from_number(number) {
            Class::Regular if N == 3 => 1,
            Class::Singular => N - 1,
            _ => 0,
        };
        let start = at[run.slab];
        at[run.slab] += rows(slab).1[range].iter().map(sides).sum::<usize>();
        let names = &sheets(slab)[start..at[run.slab]];
        merged.extend(names.iter().map(|&name| common[run.slab][name as usize]));
    }
    merged
}

fn vertices(runs: &[Run], slabs: &[RawSlab], input: &[u32], exterior: bool) -> Simplices<1> {
    let numbers =
        runs.iter().flat_map(|run| &slabs[run.slab].vertex_classes()[run.ordinals.clone()]);
    let mut simplices = Simplices::default();
    for (&site, &number) in input.iter().zip(numbers) {
        if number != HIDDEN && (exterior || Class::from_number(number) != Class::Exterior) {
            simplices.vertices.push([site]);
            simplices.classes.push(Class::from_number(number));
        }
    }
    simplices
}
