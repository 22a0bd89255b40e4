use walpha_base::Monitor;
use walpha_base::monitor::Units;
use walpha_base::parallel::prelude::*;
use walpha_regular::TriangulationError;
use walpha_regular::internals::{CellArrays, Lattice, Sites, check_span};

use super::block::{Block, BlockParams, MergedComplex, TRIANGULATION, WORK, triangulate};
use super::classify::{Buckets, Owned, classify};
use super::merge::merge;
use super::partition::{Partition, Reach};
use super::plan::Plan;
use super::spanning::spanning;
use super::torus::{on_torus, too_long};
use crate::ShapeError;

/// The α-complex of sites; with exterior simplices, which require one block, the whole triangulation.
pub(crate) fn run(
    sites: &Sites<'_>,
    plan: &Plan,
    params: &BlockParams,
    monitor: &Monitor,
) -> Result<MergedComplex, ShapeError> {
    let partition = &plan.partition;
    if sites.torus().is_none_or(|torus| torus.dimension() < 3) {
        check_span(sites).map_err(TriangulationError::from)?;
    }
    tracing::debug!(blocks = partition.len(), at_once = plan.at_once, "cut");
    // A batch of blocks frees its working memory before the next one starts.
    let buckets = Buckets::new(sites.input(), plan.buckets());
    let blocks: Vec<usize> = (0..partition.len()).collect();
    let mut owned: Vec<Owned> = Vec::with_capacity(blocks.len());
    let (mut bytes, mut points) = (0, 0);
    let work = monitor.units(WORK * sites.input().len() as u64);
    for batch in blocks.chunks(plan.at_once) {
        let done: Result<Vec<_>, ShapeError> = batch
            .par_iter()
            .map(|&block| decide(sites, partition, block, params, buckets, &work))
            .collect();
        for done in done? {
            bytes += done.merged_bytes(params.exterior);
            points += done.points();
            owned.push(done);
        }
        plan.keeps(bytes, points, sites.input().len())?;
        plan.give_back();
    }
    Ok(merge(sites, plan, owned, params, buckets))
}

/// The whole triangulation of sites in space, and the input index of each of its vertices, which are along the curve.
pub(crate) fn mesh(
    sites: &Sites<'_>,
    monitor: &Monitor,
) -> Result<(CellArrays, Vec<u32>), ShapeError> {
    let plan = Plan::whole(sites);
    plan.afford(sites.input().len())?;
    check_span(sites).map_err(TriangulationError::from)?;
    let points = plan.partition.block(sites, Reach::Balls(f64::INFINITY), 0);
    let work = monitor.units(TRIANGULATION * sites.input().len() as u64);
    Ok((triangulate(&points, &work)?, points.input))
}

/// Classifies the simplices that a block owns.
pub(super) fn decide(
    sites: &Sites<'_>,
    partition: &Partition,
    block: usize,
    params: &BlockParams,
    buckets: Buckets,
    work: &Units<'_>,
) -> Result<Owned, ShapeError> {
    let (points, made, lattice) = match sites.torus() {
        None => in_space(sites, partition, block, params, work)?,
        Some(torus) => on_torus(sites, torus, partition, block, params, work)?,
    };
    let params = BlockParams { lattice, ..*params };
    let owned = classify(&points, made, &params, buckets, work)?;
    match (owned.long, sites.torus()) {
        (Some(edge), Some(torus)) => Err(too_long(torus, edge)),
        _ => Ok(owned),
    }
}

/// A block with its halo, its triangulation, and the lattice of its points.
pub(super) fn in_space(
    sites: &Sites<'_>,
    partition: &Partition,
    block: usize,
    params: &BlockParams,
    work: &Units<'_>,
) -> Result<(Block, CellArrays, Lattice), ShapeError> {
    let mut points = partition.block(sites, Reach::Balls(params.alpha), block);
    let (inside, next) = (points.input.len(), sites.input().last().map_or(0, |last| last + 1));
    let made = spanning(&mut points, params.alpha, next, work)?;
    // Auxiliary points need not be on the lattice of the set.
    let lattice = if points.input.len() > inside {
        Lattice::of(&points.positions, &points.weights)
    } else {
        params.lattice
    };
    Ok((points, made, lattice))
}
