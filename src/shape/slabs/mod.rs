//! The slabs engine: the α-complex slab by slab.
//!
//! The α-complex is local. A simplex of the shape has an orthogonal sphere of squared radius at
//! most α, so each of its vertices v lies within √(α + ω(v)) of the sphere's centre, and a point q
//! that could refute it, by lying inside, within √(α + ω(q)). The points of a slab and those
//! within √(α + ω(q)) + √(α + max ω of the slab) of it therefore decide every simplex that has a
//! vertex in the slab. Ties too: a face of the lower hull of all lifted points is one of any
//! subset that has its vertices, and CGAL breaks ties by raising lifted points in an order of their
//! coordinates, which does not depend on what other points there are.
//!
//! With `Balls::Radius` the weights are (α + ω)² and α is 0, and the same bound reads: the sum of
//! the two radii.

mod merge;
mod partition;
mod plan;

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::union_find::UnionFind;
use super::{Complex, ShapeError};
use crate::cgal::{self, CgalError, RawSlab, Sites, SlabQuestion};
use crate::progress;

use merge::merge;
use partition::Partition;
pub(super) use plan::Plan;
pub use plan::PlanError;

/// What the slabs say together.
pub(super) struct Answer {
    pub complex: Complex,
    /// The sheet of each regular facet, in the order of the facets, two of each singular one.
    pub facet_sheets: Vec<u32>,
    /// The sheet of each singular edge, in their order.
    pub edge_sheets: Vec<u32>,
}

/// The α-complex of sites; with exterior simplices, which need one slab, the whole triangulation.
pub(super) fn run(
    sites: &Sites,
    plan: &Plan,
    question: &SlabQuestion,
) -> Result<Answer, ShapeError> {
    let partition = Partition::new(sites, plan.slabs);
    tracing::debug!(slabs = partition.len(), at_once = plan.at_once, "cut");
    // So many slabs at once, each giving its memory back before the next.
    let slabs: Vec<usize> = (0..partition.len()).collect();
    let mut raw = Vec::with_capacity(slabs.len());
    for batch in slabs.chunks(plan.at_once) {
        let done: Result<Vec<_>, ShapeError> =
            batch.par_iter().map(|&slab| decide(sites, &partition, slab, question)).collect();
        raw.extend(done?);
        progress::report(raw.len() as u64, partition.len() as u64);
        question.give_back();
    }
    Ok(merge(sites, &partition, raw, question))
}

/// Triangulates a slab with its halo, or, where these span no volume, with all other sites.
fn decide(
    sites: &Sites,
    partition: &Partition,
    slab: usize,
    question: &SlabQuestion,
) -> Result<RawSlab, ShapeError> {
    if partition.len() > 1 {
        let points = partition.points(sites, question.alpha, slab);
        match cgal::slab(&points, question) {
            Err(CgalError::Sites(_)) => {}
            decided => return Ok(decided?),
        }
    }
    let points = partition.all_points(sites, slab);
    Ok(cgal::slab(&points, question)?)
}

/// Makes one numbering of the sheets of all slabs: those that share a side of a facet, or a
/// singular edge, are one. Gives each slab's sheets their common numbers.
fn common_sheets(slabs: &[RawSlab]) -> Vec<Vec<u32>> {
    let starts: Vec<u32> = slabs
        .iter()
        .scan(0, |next, slab| {
            let start = *next;
            *next += slab.sheets();
            Some(start)
        })
        .collect();
    let total: u32 = slabs.iter().map(RawSlab::sheets).sum();
    let mut sets = UnionFind::new(total as usize);
    let mut known = BTreeMap::new();
    for (slab, start) in slabs.iter().zip(&starts) {
        for &[a, b, c, side, sheet] in slab.shared() {
            let sheet = start + sheet;
            sets.unite(*known.entry([a, b, c, side]).or_insert(sheet), sheet);
        }
    }
    let numbers = |(slab, start): (&RawSlab, &u32)| {
        (0..slab.sheets()).map(|sheet| sets.find(start + sheet)).collect()
    };
    slabs.iter().zip(&starts).map(numbers).collect()
}
