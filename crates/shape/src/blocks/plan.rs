//! The number of blocks, from the number of threads and the memory allowed.

use walpha_base::memory::{self, NoMemory};
use walpha_regular::internals::Sites;

use super::partition::{Partition, Reach};
use crate::PlanError;

/// The blocks, and how many of them are computed at the same time.
pub(crate) struct Plan {
    pub partition: Partition,
    pub at_once: usize,
    /// The number of points, including those of halos, in the blocks that are computed at the same time.
    at_work: u64,
    /// The bound on memory, if there is one. With a bound, freed memory is returned to the system immediately, which costs a
    /// tenth of the time because it must be requested again.
    bound: Option<Bound>,
}

/// A bound on memory, in bytes.
#[derive(Clone, Copy)]
struct Bound {
    /// Allowed.
    asked: u64,
    /// The bytes in use when the plan was made.
    resident: u64,
}

/// The limits of a plan.
#[derive(Clone, Copy)]
pub(crate) struct Limits {
    /// The requested number of blocks.
    pub blocks: Option<usize>,
    /// The allowed number of bytes.
    pub memory: Option<u64>,
}

/// Bytes per point of finished blocks: the rows and classes of about 5 cells, 11 facets and 7
/// edges, without their smallest vertices, and the sides that blocks share. A shape that fills the
/// whole hull has up to 7, 14 and 8; [`Plan::keeps`] detects that.
const DONE: u64 = 215;
/// Bytes per point when blocks are merged: rows with all vertices.
const MERGED: u64 = 320;
/// Bytes per point that merging takes in addition to rows: the locations of the rows.
const LOCATIONS: u64 = 16;
/// Buckets in which rows are merged if memory is bounded: only one bucket is in memory twice.
const BUCKETS: usize = 32;
/// The speed-up of one mesh on 2ᵏ threads, as a fraction of 2ᵏ, is 2⁻ᵏ to this power. Measured on two threads
/// (`benches/shapes.rs`): 0.72 to 0.88.
const LOSS: f64 = 0.32;
/// The minimum number of points of a block that is cut to use more threads: with smaller blocks, halos cost more than another
/// thread gains.
const WORTHWHILE: usize = 2000;
/// The largest number of blocks.
const MAX_BLOCKS: usize = 1 << 12;

/// Bytes per point of a block during its computation, including the points of its halo: 6 to 7 cells of 36 bytes (corners,
/// neighbours and visit stamp) during triangulation; then cells of 32 bytes, with stars and rows.
pub const AT_WORK: u64 = 600;

/// Bytes that a shape of `points` points takes during the computation of blocks with `at_work` points, including halos.
fn taken(points: usize, at_work: u64) -> u64 {
    let working = DONE * points as u64 + AT_WORK * at_work;
    working.max(MERGED * points as u64)
}

/// The number of blocks to begin with.
fn fewest(points: usize, threads: usize) -> usize {
    threads.min(points / WORTHWHILE).max(1)
}

impl Plan {
    /// Plans one block with all sites.
    pub(crate) fn whole(sites: &Sites<'_>) -> Self {
        let at_work = sites.input().len() as u64;
        Self { partition: Partition::new(sites, 1), at_once: 1, at_work, bound: None }
    }

    /// Plans as many blocks as there are threads; with a bound on memory, the blocks that respect it and take the least time. O(n
    /// log n).
    ///
    /// # Errors
    /// [`PlanError`] when the bound cannot be kept.
    pub(crate) fn new(sites: &Sites<'_>, reach: Reach, limits: Limits) -> Result<Self, PlanError> {
        let threads = rayon::current_num_threads();
        let resident = memory::resident_bytes().unwrap_or(0);
        let bound = limits.memory.map(|asked| Bound { asked, resident });
        match (limits.blocks, bound) {
            (Some(blocks), _) => {
                let partition = Partition::new(sites, blocks);
                let at_once = partition.len().min(threads);
                let at_work = at_once as u64 * partition.largest(sites, reach) as u64;
                Ok(Self { partition, at_once, at_work, bound })
            }
            (None, Some(bound)) => Self::within(bound, sites, reach, threads),
            (None, None) => Ok(Self::fast(sites, reach, threads)),
        }
    }

    /// Plans as many blocks as there are threads, or a single block on all threads if halos would cost more than that loses.
    fn fast(sites: &Sites<'_>, reach: Reach, threads: usize) -> Self {
        let points = sites.input().len();
        let at_once = fewest(points, threads);
        let partition = Partition::new(sites, at_once);
        let at_work = at_once as u64 * partition.largest(sites, reach) as u64;
        if at_work as f64 > points as f64 * (at_once as f64).powf(LOSS) {
            return Self::whole(sites);
        }
        Self { partition, at_once, at_work, bound: None }
    }

    /// Chooses the blocks that respect a bound and take the least time.
    fn within(
        bound: Bound,
        sites: &Sites<'_>,
        reach: Reach,
        threads: usize,
    ) -> Result<Self, PlanError> {
        let Bound { asked, resident } = bound;
        let points = sites.input().len();
        let at_work = |at_once: usize, largest: usize| at_once as u64 * largest as u64;
        let needs =
            |at_once: usize, largest: usize| resident + taken(points, at_work(at_once, largest));
        let mut blocks = fewest(points, threads);
        let mut least = PlanError { asked, needed: u64::MAX, blocks };
        let mut best: Option<(f64, Self)> = None;
        loop {
            let partition = Partition::new(sites, blocks);
            // The largest block has at least as many points as this one. If that is already too many, and does not reduce the
            // known minimum, the others are not counted: with a long reach each has nearly all points.
            let some = partition.size(sites, reach, partition.len() / 2);
            let hopeless = needs(1, some) > asked && needs(1, some) >= least.needed;
            let largest = if hopeless { some } else { partition.largest(sites, reach) };
            // The time of a plan is that of its blocks with their halos, shared among threads.
            let work = at_work(blocks, largest) as f64;
            let time = |at_once: usize| work / at_once as f64;
            let shortest = best.as_ref().map_or(f64::INFINITY, |(time, _)| *time);
            let at_once = (1..=threads.min(blocks)).rev().find(|&at_once| {
                let needed = needs(at_once, largest);
                if needed < least.needed {
                    least = PlanError { asked, needed, blocks };
                }
                needed <= asked
            });
            if let Some(at_once) = at_once.filter(|&at_once| time(at_once) < shortest) {
                let (at_work, bound) = (at_work(at_once, largest), Some(bound));
                best = Some((time(at_once), Self { partition, at_once, at_work, bound }));
            }
            blocks *= 2;
            // More blocks have more points in halos: after all threads have work, more blocks are slower.
            if at_once == Some(threads)
                || (best.is_some() && time(threads) >= shortest)
                || blocks > MAX_BLOCKS.min(points)
            {
                return best.map(|(_, plan)| plan).ok_or(least);
            }
        }
    }

    /// Checks, as far as can be foreseen, that there is enough memory.
    ///
    /// # Errors
    /// [`NoMemory`] when not.
    pub(crate) fn afford(&self, points: usize) -> Result<(), NoMemory> {
        let bytes = usize::try_from(taken(points, self.at_work)).unwrap_or(usize::MAX);
        memory::afford(bytes, || format!("the shape of {points} points"))
    }

    /// The number of buckets in which rows are merged.
    pub(crate) fn buckets(&self) -> usize {
        if self.bound.is_some() { BUCKETS } else { 1 }
    }

    /// Checks that the bound will be kept if all points have as many rows as those of the blocks done so far.
    ///
    /// # Errors
    /// [`PlanError`] when not.
    pub(crate) fn keeps(&self, bytes: u64, points: usize, all: usize) -> Result<(), PlanError> {
        let Some(Bound { asked, resident }) = self.bound else { return Ok(()) };
        let rows = (bytes as f64 * all as f64 / points as f64) as u64;
        let needed = resident + rows + LOCATIONS * all as u64;
        let error = PlanError { asked, needed, blocks: self.partition.len() };
        if needed <= asked { Ok(()) } else { Err(error) }
    }

    /// Returns freed memory to the system if memory is bounded; some allocators (glibc's) would keep it.
    pub(crate) fn give_back(&self) {
        if self.bound.is_some() {
            memory::give_back();
        }
    }
}

#[cfg(test)]
mod tests;
