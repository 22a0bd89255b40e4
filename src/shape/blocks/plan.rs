//! Into how many blocks a set is cut.

use super::Partition;
use crate::memory;
use crate::triangulation::{Maker, Sites};

/// The blocks, and how many are worked on at once.
pub(crate) struct Plan {
    pub partition: Partition,
    pub at_once: usize,
    /// Whether memory that comes free goes back to the system at once. That takes a tenth of the
    /// time, as it must be asked for again.
    frugal: bool,
}

/// What a plan keeps to.
#[derive(Clone, Copy)]
pub(crate) struct Limits {
    /// Blocks asked for.
    pub blocks: Option<usize>,
    /// Bytes allowed.
    pub memory: Option<u64>,
}

/// The memory allowed does not suffice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "--memory {} does not suffice: with {blocks} blocks, one at a time, about {} are needed; \
     allow more, or select fewer points",
    memory::readable(*asked),
    memory::readable(*needed)
)]
pub struct PlanError {
    /// Bytes allowed.
    pub asked: u64,
    /// Bytes that the smallest plan needs.
    pub needed: u64,
    /// Its number of blocks.
    pub blocks: usize,
}

/// Bytes for each point of blocks that are done: the rows and classes of 6 to 7 cells, 12 to 14 facets
/// and 7 to 8 edges, without their smallest vertices, and the sides that blocks share. Measured peaks
/// lie below this and the next two.
const DONE: u64 = 340;
/// Bytes for each point while blocks are merged: what is done, and the whole rows of one dimension
/// after the other.
const MERGED: u64 = 465;
/// Blocks are made no smaller for the sake of threads: halos would cost more than a thread gains.
const WORTHWHILE: usize = 2000;
/// No set has use for more blocks.
const MOST: usize = 1 << 12;

/// Bytes for each point of a block at work, its halo's included.
fn at_work(maker: Maker) -> u64 {
    match maker {
        // 6 to 7 cells of 36 bytes while they are made; then of 32, with stars and rows.
        Maker::Native => 700,
        // 6 to 7 cells of 112 bytes in CGAL, and their copies.
        Maker::Cgal => 1250,
    }
}

impl Plan {
    /// All sites as one block.
    pub fn whole(sites: &Sites<'_>) -> Self {
        Self { partition: Partition::new(sites, 1), at_once: 1, frugal: false }
    }

    /// The fewest blocks that keep all threads at work and the memory below a bound, if one is
    /// given. O(n log n).
    ///
    /// # Errors
    /// [`PlanError`] when the bound cannot be kept.
    pub fn new(
        sites: &Sites<'_>,
        alpha: f64,
        maker: Maker,
        limits: Limits,
    ) -> Result<Self, PlanError> {
        let threads = rayon::current_num_threads();
        let points = sites.input().len();
        if let Some(blocks) = limits.blocks {
            let partition = Partition::new(sites, blocks);
            let at_once = partition.len().min(threads);
            return Ok(Self { partition, at_once, frugal: limits.memory.is_some() });
        }
        let mut blocks = threads.min(points / WORTHWHILE).max(1);
        let mut partition = Partition::new(sites, blocks);
        let mut largest = partition.largest(sites, alpha);
        // More blocks than one pay only if none of them is nearly the whole.
        if limits.memory.is_none() && largest > points - points / 8 {
            return Ok(Self::whole(sites));
        }
        let Some(asked) = limits.memory else {
            return Ok(Self { partition, at_once: blocks, frugal: false });
        };
        let resident = memory::resident_bytes().unwrap_or(0);
        let needs = |at_once: usize, largest: usize| {
            let at_work = at_work(maker) * (at_once * largest) as u64;
            resident + (DONE * points as u64 + at_work).max(MERGED * points as u64)
        };
        let mut least = PlanError { asked, needed: u64::MAX, blocks };
        loop {
            for at_once in (1..=threads.min(blocks)).rev() {
                let needed = needs(at_once, largest);
                if needed <= asked {
                    return Ok(Self { partition, at_once, frugal: true });
                }
                if needed < least.needed {
                    least = PlanError { asked, needed, blocks };
                }
            }
            blocks *= 2;
            if blocks > MOST.min(points) {
                return Err(least);
            }
            partition = Partition::new(sites, blocks);
            largest = partition.largest(sites, alpha);
        }
    }

    /// Gives freed memory back to the system, where memory matters more than time and the allocator
    /// would keep it for itself (glibc).
    pub fn give_back(&self) {
        if self.frugal {
            crate::cgal::give_back();
        }
    }
}
