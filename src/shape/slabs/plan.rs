use super::partition::{longest_axis, rounded_up, sorted_coordinates};
use crate::cgal::Sites;
use crate::memory;

/// How many slabs there are, and how many are worked on at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Plan {
    pub slabs: usize,
    pub at_once: usize,
}

/// The memory allowed does not suffice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "--memory {} MiB does not suffice: with {slabs} slabs, one at a time, about {} MiB are needed; \
     allow more, or select fewer points",
    asked >> 20,
    needed >> 20
)]
pub struct PlanError {
    /// Bytes allowed.
    pub asked: u64,
    /// Bytes that the smallest plan needs.
    pub needed: u64,
    /// Its number of slabs.
    pub slabs: usize,
}

/// Bytes for each point of a slab at work: 6 to 7 cells of 80 bytes in CGAL, and half as much when
/// they are copied into flat arrays. Measured peaks lie below this and the next two.
const AT_WORK: u64 = 950;
/// Bytes for each point of slabs that are done: the rows and classes of 6 to 7 cells, 12 to 14
/// facets and 7 to 8 edges, without their smallest vertices, and the sides that slabs share.
const DONE: u64 = 340;
/// Bytes for each point while slabs are merged: what is done, and the whole rows of one dimension
/// after the other.
const MERGED: u64 = 465;
/// Slabs are made no smaller for the sake of threads: halos would cost more than a thread gains.
const WORTHWHILE: usize = 2000;
/// No set has use for more slabs.
const MOST: usize = 1 << 12;

impl Plan {
    /// The whole as one slab.
    pub const WHOLE: Self = Self { slabs: 1, at_once: 1 };

    /// So many slabs, as many at once as there are threads.
    pub fn of(slabs: usize) -> Self {
        Self { slabs, at_once: slabs.min(rayon::current_num_threads()) }
    }

    /// The fewest slabs that keep all threads at work and the memory below a bound, if one is
    /// given. O(n log n).
    ///
    /// # Errors
    /// [`PlanError`] when the bound cannot be kept.
    pub fn new(sites: &Sites, alpha: f64, memory: Option<u64>) -> Result<Self, PlanError> {
        let sizes = Sizes::new(sites, alpha);
        let threads = rayon::current_num_threads();
        let useful = threads.min(sites.input().len() / WORTHWHILE).max(1);
        // More slabs than one pay only if none of them is nearly the whole.
        let slabs = (1..=useful).min_by_key(|&slabs| sizes.largest(slabs)).unwrap_or(1);
        let Some(asked) = memory else { return Ok(Self::of(slabs)) };
        let resident = memory::resident_bytes().unwrap_or(0);
        let points = sizes.points() as u64;
        let needs = |plan: Self| {
            let at_work = (plan.at_once * sizes.largest(plan.slabs)) as u64;
            resident + (DONE * points + AT_WORK * at_work).max(MERGED * points)
        };
        let mut smallest: Option<(u64, Self)> = None;
        let mut slabs = slabs;
        while slabs <= MOST.min(sizes.points()) {
            for at_once in (1..=threads.min(slabs)).rev() {
                let plan = Self { slabs, at_once };
                if needs(plan) <= asked {
                    return Ok(plan);
                }
                smallest =
                    smallest.filter(|(need, _)| *need <= needs(plan)).or(Some((needs(plan), plan)));
            }
            slabs *= 2;
        }
        let (needed, plan) = smallest.unwrap_or((needs(Self::WHOLE), Self::WHOLE));
        Err(PlanError { asked, needed, slabs: plan.slabs })
    }
}

/// How large slabs get, halos included.
struct Sizes {
    coordinates: Vec<f64>,
    reach: f64,
}

impl Sizes {
    fn new(sites: &Sites, alpha: f64) -> Self {
        let coordinates = sorted_coordinates(sites.positions(), longest_axis(sites.positions()));
        let largest = sites.weights().iter().fold(0f64, |most, weight| most.max(alpha + weight));
        Self { coordinates, reach: rounded_up(2.0 * largest.sqrt()) }
    }

    fn points(&self) -> usize {
        self.coordinates.len()
    }

    /// The most points a slab has, if there are so many slabs.
    fn largest(&self, slabs: usize) -> usize {
        let n = self.points();
        let size = |slab: usize| {
            let low = self.coordinates[slab * n / slabs] - self.reach;
            let high = self.coordinates[((slab + 1) * n / slabs).saturating_sub(1)] + self.reach;
            let before = |end: f64| self.coordinates.partition_point(|&at| at < end);
            self.coordinates.partition_point(|&at| at <= high) - before(low)
        };
        (0..slabs).map(size).max().unwrap_or(0)
    }
}
