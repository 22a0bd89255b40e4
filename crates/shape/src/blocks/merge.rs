//! Merges the records of all blocks into one complex in canonical order.

use walpha_base::UnionFind;
use walpha_base::parallel::prelude::*;
use walpha_regular::internals::Sites;

use super::block::{BlockParams, MergedComplex};
use super::classify::{Buckets, Owned, RANGE, Records, Side};
use super::gather::{Counts, Gathered, Location};
use super::partition::Partition;
use super::plan::Plan;
use crate::Class;
use crate::winding::{WindingSets, minus};

/// Sorts the records of blocks by the smallest vertices, which are left out of the stored rows. Rows with the same smallest
/// vertex are in order already. The records of a bucket are freed before the next bucket is merged, so only few rows are in
/// memory twice.
pub(super) fn merge(
    sites: &Sites<'_>,
    plan: &Plan,
    mut blocks: Vec<Owned>,
    params: &BlockParams,
    buckets: Buckets,
) -> MergedComplex {
    let exterior = params.exterior;
    let sheet_windings = unite_sheets(&mut blocks);
    let joined = joined(sites, &mut blocks);
    plan.give_back();
    let counts = Counts::of_all(blocks.par_iter().flat_map(Owned::records), exterior);
    let locations = locations(sites, &plan.partition, buckets);
    let mut gathered = Gathered::new(counts);
    let mut rest = gathered.rest();
    let mut hidden = Vec::new();
    for (bucket, sites_there) in buckets.ranges(sites.input()).into_iter().enumerate() {
        let records = |block: &mut Owned| std::mem::take(&mut block.buckets[bucket]);
        let records: Vec<Records> = blocks.iter_mut().flat_map(records).collect();
        let input = &sites.input()[sites_there.clone()];
        hidden.extend(rest.write(&records, &locations[sites_there], input, exterior));
        drop(records);
        plan.give_back();
    }
    let (complex, facet_sheets, edge_sheets) = gathered.into_parts();
    let in_shape = complex.vertices.classes().iter().filter(|&&class| class != Class::Exterior);
    // On a torus, one block with its halo is not the whole triangulation.
    let whole = blocks.len() == 1 && (sites.torus().is_none() || exterior);
    MergedComplex {
        b0: in_shape.count() as u64 - joined,
        complex,
        facet_sheets,
        edge_sheets,
        hidden: whole.then_some(hidden),
        sheet_windings,
    }
}

/// The location of the record of each site, among the records of its bucket in all blocks.
fn locations(sites: &Sites<'_>, partition: &Partition, buckets: Buckets) -> Vec<Location> {
    let mut locations = vec![Location::default(); sites.input().len()];
    let mut first = 0;
    for block in 0..partition.len() {
        let own: Vec<u32> = partition.own(sites, block).collect();
        for (records, range) in (first..).zip(own.chunks(RANGE)) {
            let mut counts = vec![0; buckets.count];
            for &site in range {
                let point = &mut counts[buckets.at(sites.input()[site as usize])];
                locations[site as usize] = Location { records, point: *point };
                *point += 1;
            }
        }
        first += own.len().div_ceil(RANGE) as u32;
    }
    locations
}

/// Unites the components of all blocks, and returns the number of times two of them became one.
fn joined(sites: &Sites<'_>, blocks: &mut [Owned]) -> u64 {
    // On a torus even one block has a halo, whose copies are joined to their own points more than once.
    if let [block] = blocks
        && sites.torus().is_none()
    {
        return std::mem::take(&mut block.components).len() as u64;
    }
    let sets = UnionFind::new(sites.input().last().map_or(0, |&last| last as usize + 1));
    let pairs = blocks.par_iter_mut().flat_map(|block| std::mem::take(&mut block.components));
    pairs.filter(|&[a, b]| sets.unite(a, b)).count() as u64
}

/// Gives the sheets of all blocks common numbers: those that share a side of a facet, or a singular edge, are one. Returns the
/// number of independent directions in which sheets wind round a torus.
fn unite_sheets(blocks: &mut [Owned]) -> usize {
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
        // Sets are moved so that their copies of the smallest vertex coincide.
        sets.unite(pair[0].1, pair[1].1, minus(pair[0].2, pair[1].2));
    }
    for (block, start) in blocks.iter_mut().zip(&starts) {
        let common: Vec<u32> = (0..block.sheets).map(|sheet| sets.find(start + sheet).0).collect();
        block.each_sheet(|sheet| *sheet = common[*sheet as usize]);
    }
    sets.directions().rank()
}
