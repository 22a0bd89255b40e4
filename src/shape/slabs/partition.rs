use crate::cgal::{Sites, SlabSites};

/// Sites cut along their longest axis into slabs of about equally many, without parting equal
/// coordinates.
pub(super) struct Partition {
    axis: usize,
    /// Coordinate at which each slab starts; the first is −∞.
    starts: Vec<f64>,
    /// The slab of each site.
    owner: Vec<u32>,
}

impl Partition {
    /// Cuts sites into at most so many slabs. O(n log n).
    pub fn new(sites: &Sites, slabs: usize) -> Self {
        let axis = longest_axis(sites.positions());
        let mut starts = vec![f64::NEG_INFINITY];
        if slabs > 1 {
            let coordinates = sorted_coordinates(sites.positions(), axis);
            for slab in 1..slabs {
                // A cut falls before all points that have the coordinate found here.
                let start = coordinates[slab * coordinates.len() / slabs];
                if start > *starts.last().expect("never empty") && start > coordinates[0] {
                    starts.push(start);
                }
            }
        }
        let owner = sites
            .positions()
            .iter()
            .map(|p| starts.partition_point(|start| *start <= p[axis]) as u32 - 1)
            .collect();
        Self { axis, starts, owner }
    }

    /// The number of slabs.
    pub fn len(&self) -> usize {
        self.starts.len()
    }

    /// The slab of each site.
    pub fn owner(&self) -> &[u32] {
        &self.owner
    }

    /// The points of a slab and of its halo.
    ///
    /// Points of a halo with α + ω < 0 have no ball and refute nothing: they are left out.
    pub fn points(&self, sites: &Sites, alpha: f64, slab: usize) -> SlabSites {
        let own = |site: usize| self.owner[site] == slab as u32;
        let ball = |site: usize| alpha + sites.weights()[site];
        let (mut low, mut high, mut largest) = (f64::INFINITY, f64::NEG_INFINITY, 0f64);
        for site in (0..self.owner.len()).filter(|&site| own(site)) {
            let at = sites.positions()[site][self.axis];
            (low, high) = (low.min(at), high.max(at));
            largest = largest.max(ball(site));
        }
        let near = |site: usize| {
            let at = sites.positions()[site][self.axis];
            let away = (low - at).max(at - high);
            // NaN for a point without a ball, which compares false.
            away <= rounded_up(ball(site).sqrt() + largest.sqrt())
        };
        self.gather(sites, slab, |site| own(site) || near(site))
    }

    /// A slab with all other sites as its halo.
    pub fn all_points(&self, sites: &Sites, slab: usize) -> SlabSites {
        self.gather(sites, slab, |_| true)
    }

    fn gather(&self, sites: &Sites, slab: usize, wanted: impl Fn(usize) -> bool) -> SlabSites {
        let mut points = SlabSites::default();
        for site in (0..self.owner.len()).filter(|&site| wanted(site)) {
            points.positions.push(sites.positions()[site]);
            points.weights.push(sites.weights()[site]);
            points.input.push(sites.input()[site]);
            points.owned.push((self.owner[site] == slab as u32).into());
        }
        points
    }
}

/// At least the exact value of a length that came out of a few operations, each off by at most
/// 2⁻⁵³ of its result.
pub(super) fn rounded_up(length: f64) -> f64 {
    length * (1.0 + 8.0 * f64::EPSILON)
}

pub(super) fn longest_axis(positions: &[[f64; 3]]) -> usize {
    let extent = |axis: usize| {
        let ends = positions.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
            (low.min(p[axis]), high.max(p[axis]))
        });
        ends.1 - ends.0
    };
    let extents = [0, 1, 2].map(extent);
    // Of equals the slowest in memory: its slabs own runs of neighbouring indices.
    (0..3).max_by(|&a, &b| extents[a].total_cmp(&extents[b])).unwrap_or(2)
}

pub(super) fn sorted_coordinates(positions: &[[f64; 3]], axis: usize) -> Vec<f64> {
    let mut coordinates: Vec<f64> = positions.iter().map(|p| p[axis]).collect();
    rayon::slice::ParallelSliceMut::par_sort_unstable_by(&mut coordinates[..], f64::total_cmp);
    coordinates
}
