//! The division of sites into blocks by a k-d tree, and the halos of blocks.

use std::ops::Range;

use walpha_base::parallel::prelude::*;
use walpha_regular::Torus;
use walpha_regular::internals::Sites;

use super::block::{Block, Copies};

/// A k-d tree of boxes, each cut across its longest side, into blocks of about equally many sites.
pub(crate) struct Partition {
    /// The nodes of the tree, children after their parents; the first is the root.
    nodes: Vec<Node>,
    /// The leaf of each block.
    leaves: Vec<usize>,
    /// Sites by their ranks on the curve, grouped by block and ascending within a block.
    members: Vec<u32>,
}

struct Node {
    members: Range<usize>,
    low: [f64; 3],
    high: [f64; 3],
    /// The largest weight.
    heaviest: f64,
    /// The two nodes that it is cut into; `None` for a block.
    halves: Option<[usize; 2]>,
}

impl Partition {
    /// Cuts sites into `blocks` blocks, at most one per site. O(n log blocks).
    pub(crate) fn new(sites: &Sites<'_>, blocks: usize) -> Self {
        let count = sites.curve().len();
        let mut members: Vec<u32> = (0..count as u32).collect();
        let mut nodes = vec![Node::around(sites, &members, 0)];
        let mut leaves = Vec::new();
        // From the last to the first, so that blocks are numbered from low to high.
        let mut pending = vec![(0, blocks.clamp(1, count.max(1)))];
        while let Some((at, blocks)) = pending.pop() {
            let Range { start, end } = nodes[at].members;
            let here = &mut members[start..end];
            if blocks == 1 {
                here.par_sort_unstable();
                leaves.push(at);
                continue;
            }
            let axis = nodes[at].longest_side();
            let left = blocks / 2;
            // The product may exceed 32 bits.
            let middle = (here.len() as u64 * left as u64 / blocks as u64) as usize;
            let along =
                |&rank: &u32| sites.positions()[sites.curve()[rank as usize] as usize][axis];
            here.select_nth_unstable_by(middle, |a, b| {
                along(a).total_cmp(&along(b)).then(a.cmp(b))
            });
            let (low, high) = here.split_at(middle);
            let halves = [nodes.len(), nodes.len() + 1];
            nodes.push(Node::around(sites, low, start));
            nodes.push(Node::around(sites, high, start + middle));
            nodes[at].halves = Some(halves);
            pending.extend([(halves[1], blocks - left), (halves[0], left)]);
        }
        Self { nodes, leaves, members }
    }

    /// The number of blocks.
    pub(crate) fn len(&self) -> usize {
        self.leaves.len()
    }

    /// The sites of a block, along the curve.
    pub(crate) fn own<'a>(
        &'a self,
        sites: &'a Sites<'_>,
        block: usize,
    ) -> impl Iterator<Item = u32> + 'a {
        let members = &self.members[self.nodes[self.leaves[block]].members.clone()];
        members.iter().map(|&rank| sites.curve()[rank as usize])
    }

    /// The number of points of the largest block, including its halo.
    pub(crate) fn largest(&self, sites: &Sites<'_>, reach: Reach) -> usize {
        let size = |block: usize| self.size(sites, reach, block);
        (0..self.len()).into_par_iter().map(size).max().unwrap_or(0)
    }

    /// The number of points of a block, its halo included.
    pub(crate) fn size(&self, sites: &Sites<'_>, reach: Reach, block: usize) -> usize {
        let mut count = self.nodes[self.leaves[block]].members.len();
        self.halo(sites, reach, block, |_, _| count += 1);
        count
    }

    /// The points of a block, then those of its halo. On a torus the halo is sorted by winding, then along the
    /// curve.
    pub(crate) fn block(&self, sites: &Sites<'_>, reach: Reach, block: usize) -> Block {
        let own = self.nodes[self.leaves[block]].members.clone();
        let mut halo = Vec::new();
        self.halo(sites, reach, block, |rank, windings| halo.push((windings, rank)));
        halo.sort_unstable();
        let ranks = || self.members[own.clone()].iter().chain(halo.iter().map(|(_, rank)| rank));
        let site = |&rank: &u32| sites.curve()[rank as usize] as usize;
        let mut positions: Vec<_> = ranks().map(|rank| sites.positions()[site(rank)]).collect();
        let copies = sites.torus().map(|torus| {
            let windings: Vec<_> = halo.iter().map(|&(windings, _)| windings).collect();
            for (position, &windings) in positions[own.len()..].iter_mut().zip(&windings) {
                *position = torus.moved(*position, windings);
            }
            Copies { torus, windings }
        });
        Block {
            positions,
            weights: ranks().map(|rank| sites.weights()[site(rank)]).collect(),
            input: ranks().map(|rank| sites.input()[site(rank)]).collect(),
            own: own.len() as u32,
            copies,
        }
    }

    /// Visits the points of the halo of a block in unspecified order: the rank of each on the curve, and the
    /// multiples of the vectors by which it is moved.
    ///
    /// Points with α + ω < 0 have no ball and can refute nothing: they are left out.
    fn halo(
        &self,
        sites: &Sites<'_>,
        reach: Reach,
        block: usize,
        mut visit: impl FnMut(u32, [i32; 3]),
    ) {
        let leaf = self.leaves[block];
        let own = &self.nodes[leaf];
        let near = |low, high, heaviest| match reach {
            Reach::Along(distance) => {
                sites.torus().is_none_or(|torus| own.reaches_along(torus, low, high, distance))
            }
            _ => own.reaches(low, high, reach.distance(own.heaviest, heaviest)),
        };
        for windings in self.windings(sites, own, reach) {
            let moved = |position| match sites.torus() {
                None => position,
                Some(torus) => torus.moved(position, windings),
            };
            let mut pending = vec![0];
            while let Some(at) = pending.pop() {
                let node = &self.nodes[at];
                if (at == leaf && windings == [0; 3])
                    || !near(moved(node.low), moved(node.high), node.heaviest)
                {
                    continue;
                }
                if let Some(halves) = node.halves {
                    pending.extend(halves);
                    continue;
                }
                for &rank in &self.members[node.members.clone()] {
                    let site = sites.curve()[rank as usize] as usize;
                    let at = moved(sites.positions()[site]);
                    if near(at, at, sites.weights()[site]) {
                        visit(rank, windings);
                    }
                }
            }
        }
    }

    /// The multiples of the vectors by which points of the halo of a block may be moved: all that may be in reach, and possibly
    /// more.
    fn windings(&self, sites: &Sites<'_>, own: &Node, reach: Reach) -> Vec<[i32; 3]> {
        let Some(torus) = sites.torus() else { return vec![[0; 3]] };
        let all = &self.nodes[0];
        let reach = reach.distance(own.heaviest, all.heaviest).max(0.0);
        let low = [0, 1, 2].map(|k| own.low[k] - all.high[k] - reach);
        let high = [0, 1, 2].map(|k| own.high[k] - all.low[k] + reach);
        let along = |k: usize| {
            if !torus.repeats()[k] {
                return 0..=0;
            }
            // Rounded outward, so that no copy in reach is missed.
            let [below, above] = torus.part_range(k, low, high);
            below.floor() as i32..=above.ceil() as i32
        };
        let mut windings = Vec::new();
        for x in along(0) {
            for y in along(1) {
                windings.extend(along(2).map(|z| [x, y, z]));
            }
        }
        windings
    }
}

/// The extent of the halo of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reach {
    /// The points whose balls at this α meet a ball of the block's points: they decide the shape at α.
    Balls(f64),
    /// The points within this distance, for balls of any size.
    Distance(f64),
    /// The points within this distance as measured along the vectors of a torus that does not repeat along all of them, and possibly more.
    Along(f64),
}

impl Reach {
    /// All points; of a torus, the copies that decide the whole triangulation.
    ///
    /// Of the copies of the heaviest point, one is within half a diagonal of any place z, so the
    /// largest empty orthogonal sphere has R² + max ω ≤ (diagonal / 2)². A vertex v of it is at √(R² + ω(v))
    /// from its centre, no more than half a diagonal, and so is any point that could refute it.
    ///
    /// On a torus that does not repeat along all vectors, empty spheres may have any size. But a vertex of one is the nearest to its centre among
    /// its own copies. So it is at most half a diagonal from the centre along the vectors, and all vertices of a simplex are within a
    /// diagonal of each other. Hence the points within a diagonal of the block have all simplices at its points, which fill the space around
    /// these as far as there is any within the hull: no triangulation of these points has others there.
    pub(crate) fn whole(sites: &Sites<'_>) -> Self {
        match sites.torus() {
            None => Self::Distance(f64::INFINITY),
            Some(torus) if torus.dimension() < 3 => Self::Along(torus.diagonal()),
            Some(torus) => Self::Distance(torus.diagonal()),
        }
    }

    /// The extent that decides the shape at α.
    pub(crate) fn at(sites: &Sites<'_>, alpha: f64, heaviest: f64) -> Self {
        let whole = Self::whole(sites);
        match whole {
            Self::Distance(most) | Self::Along(most)
                if 2.0 * (alpha + heaviest).max(0.0).sqrt() >= most =>
            {
                whole
            }
            _ => Self::Balls(alpha),
        }
    }

    /// The distance up to which points of weight `other` are in the halo of a point of weight `weight`; NaN if they
    /// never are.
    #[inline]
    pub(crate) fn distance(self, weight: f64, other: f64) -> f64 {
        match self {
            Self::Balls(alpha) => (alpha + weight).max(0.0).sqrt() + (alpha + other).sqrt(),
            Self::Distance(distance) | Self::Along(distance) => distance,
        }
    }
}

/// The own points of a block, which decide whether another point is in their halo.
pub(super) struct Neighbourhood {
    own: Node,
    reach: Reach,
}

impl Neighbourhood {
    /// The neighbourhood of points with their weights.
    pub(super) fn of(points: impl Iterator<Item = ([f64; 3], f64)>, alpha: f64) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut heaviest = f64::NEG_INFINITY;
        for (at, weight) in points {
            for k in 0..3 {
                (low[k], high[k]) = (low[k].min(at[k]), high[k].max(at[k]));
            }
            heaviest = heaviest.max(weight);
        }
        let own = Node { members: 0..0, low, high, heaviest, halves: None };
        Self { reach: Reach::Balls(alpha), own }
    }

    /// Whether a point is in the halo.
    pub(super) fn holds(&self, at: [f64; 3], weight: f64) -> bool {
        self.own.reaches(at, at, self.reach.distance(self.own.heaviest, weight))
    }
}

/// Relative margin of squared distances: 32 roundings.
const MARGIN: f64 = 16.0 * f64::EPSILON;
/// Points of which one thread computes the extent.
const EXTENT_CHUNK: usize = 1 << 12;

/// The lowest and highest corner of a box, and the largest weight in it.
type Extent = ([f64; 3], [f64; 3], f64);

impl Node {
    fn around(sites: &Sites<'_>, members: &[u32], start: usize) -> Self {
        let nowhere = || ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], f64::NEG_INFINITY);
        let union = |(a, b, u): Extent, (c, d, v): Extent| {
            let (mut low, mut high) = (a, b);
            for k in 0..3 {
                low[k] = low[k].min(c[k]);
                high[k] = high[k].max(d[k]);
            }
            (low, high, u.max(v))
        };
        let extent = |&rank: &u32| {
            let site = sites.curve()[rank as usize] as usize;
            let at = sites.positions()[site];
            (at, at, sites.weights()[site])
        };
        let (low, high, heaviest) =
            members.par_iter().with_min_len(EXTENT_CHUNK).map(extent).reduce(nowhere, union);
        Self { members: start..start + members.len(), low, high, heaviest, halves: None }
    }

    fn longest_side(&self) -> usize {
        let side = |k: usize| self.high[k] - self.low[k];
        // Of equal sides, choose the last, along which the samples of a volume are farthest apart in memory.
        (0..3).max_by(|&a, &b| side(a).total_cmp(&side(b))).unwrap_or(2)
    }

    /// Whether a box may be within a distance of this one, as measured along the vectors of a torus.
    fn reaches_along(&self, torus: Torus, low: [f64; 3], high: [f64; 3], distance: f64) -> bool {
        let least = [0, 1, 2].map(|axis| self.low[axis] - high[axis]);
        let most = [0, 1, 2].map(|axis| self.high[axis] - low[axis]);
        let repeats = torus.repeats();
        (0..3).filter(|&k| repeats[k]).all(|k| {
            let [below, above] = torus.part_range(k, least, most);
            // A way has no larger part than its length in units of the height of the box over the other vectors.
            let part = distance / torus.height(k) * (1.0 + MARGIN);
            below <= part && above >= -part
        })
    }

    /// Whether the distance of a box from this one is at most `reach`; `false` for NaN.
    fn reaches(&self, low: [f64; 3], high: [f64; 3], reach: f64) -> bool {
        let away = |k: usize| (low[k] - self.high[k]).max(self.low[k] - high[k]).max(0.0);
        let apart = away(0) * away(0) + away(1) * away(1) + away(2) * away(2);
        // NaN compares false. The margin covers the roundings of both sides, a few operations of relative error 2⁻⁵³
        // each: a point too many does no harm.
        apart <= reach * reach * (1.0 + MARGIN)
    }
}

#[cfg(test)]
mod tests;
