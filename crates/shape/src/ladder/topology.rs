//! Betti numbers, solid components and voids of all levels.
//!
//! Components are counted upwards, adding the simplices that enter at each level. The complement is followed downwards:
//! it only grows as α falls, so one union-find over cells serves all levels (Delfinado and Edelsbrunner 1995,
//! doi:10.1016/0167-8396(95)00016-Y).

use std::collections::BTreeMap;

use walpha_base::UnionFind;
use walpha_base::sort::sort_by;
use walpha_regular::Torus;
use walpha_regular::internals::{Interval, Predicates};

use super::Levels;
use super::build::Incidence;
use super::levels::ByLevel;
use crate::{Betti, Directions, Hollow, United, Void, WindingSets};

impl Levels<'_> {
    /// Connected components of each level. O(n α(n)).
    pub(super) fn components(&self) -> Vec<u64> {
        let complex = self.filtration.whole.complex();
        let vertices = ByLevel::new(self.len(), self.vertices.iter().map(|span| span.first));
        let edges = ByLevel::new(self.len(), self.edges.iter().map(|span| span.first));
        let sets = UnionFind::new(self.filtration.points().len());
        let mut count = 0;
        let grow = |level| {
            count += vertices.at(level).len() as u64;
            for &edge in edges.at(level) {
                let [a, b] =
                    complex.edges.rows()[edge as usize].map(|v| self.filtration.whole.copied(v).0);
                count -= u64::from(sets.unite(a, b));
            }
            count
        };
        (0..self.len()).map(grow).collect()
    }

    /// Solid components of each level: cells joined through facets, as counted by CGAL's
    /// `Alpha_shape_3::number_of_solid_components`; if points span no volume, triangles joined through edges, or edges through
    /// vertices. O(n α(n)).
    pub fn solid_components(&self) -> Vec<u64> {
        let firsts = self.firsts_of_maximal();
        let simplices = ByLevel::new(self.len(), firsts.iter().copied());
        // Two are united when the later of them enters.
        let adjacent_pairs = self.filtration.adjacent_pairs();
        let later = adjacent_pairs.iter().map(|&[a, b]| firsts[a as usize].max(firsts[b as usize]));
        let by_level = ByLevel::new(self.len(), later);
        let sets = UnionFind::new(firsts.len());
        let mut count = 0;
        let grow = |level| {
            // Count all of them first, because one may be united with others that enter at the same level.
            count += simplices.at(level).len() as u64;
            for &joint in by_level.at(level) {
                let [a, b] = adjacent_pairs[joint as usize];
                count -= u64::from(sets.unite(a, b));
            }
            count
        };
        (0..self.len()).map(grow).collect()
    }

    /// The Euler characteristic of each level.
    fn euler_characteristics(&self) -> Vec<i64> {
        let mut change = vec![0; self.len() + 1];
        self.vertices.iter().for_each(|span| change[span.first as usize] += 1);
        self.edges.iter().for_each(|span| change[span.first as usize] -= 1);
        self.facets.iter().for_each(|span| change[span.first as usize] += 1);
        self.cells.iter().for_each(|&first| change[first as usize] -= 1);
        let sums = change.iter().scan(0, |sum, change| {
            *sum += change;
            Some(*sum)
        });
        sums.take(self.len()).collect()
    }

    /// The Betti numbers of each level, with b2 and b3 given: b1 = b0 + b2 − b3 − χ.
    pub(super) fn betti_with(&self, closed: &[UpperBetti]) -> Vec<Betti> {
        let parts = self.components().into_iter().zip(closed).zip(self.euler_characteristics());
        let betti = |((b0, closed), euler): ((u64, &UpperBetti), i64)| {
            Betti::with_euler(b0, closed.b2, closed.b3, euler)
        };
        parts.map(betti).collect()
    }

    /// The Betti numbers of each level. O(n α(n)).
    pub fn betti(&self) -> Vec<Betti> {
        self.betti_and_voids().0
    }

    /// The Betti numbers and the number of [voids](Self::voids) of each level. O(n α(n)).
    pub(super) fn betti_and_voids(&self) -> (Vec<Betti>, Vec<u64>) {
        let mut closed = vec![UpperBetti::default(); self.len()];
        let mut voids = vec![0; self.len()];
        self.descend(|level, complement| {
            (closed[level], voids[level]) = (complement.closed(), complement.bounded());
        });
        (self.betti_with(&closed), voids)
    }
}

/// The components of the complement of a level.
pub(super) struct LevelComplement<'a> {
    levels: &'a Levels<'a>,
    spheres: Predicates<'a>,
    sets: Sets,
    /// For each root, the sums over its component.
    hollows: Vec<Hollow>,
    /// A superset of the roots: the roots, and cells that were roots before.
    roots: Vec<u32>,
    count: u64,
    /// The cells of each component as a circular list: the next of each cell.
    next: Vec<u32>,
    /// For each root, the α that fills its component and its number of cells then, if it was computed.
    known: BTreeMap<u32, (usize, f64)>,
}

/// Betti numbers that follow from the complement.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct UpperBetti {
    pub b2: u64,
    pub b3: Option<u64>,
}

/// The union-find over cells.
enum Sets {
    /// Includes the outside, whose number follows that of the last cell.
    InSpace(UnionFind),
    /// Includes what is [outside](WindingSets::with_outside), and the directions in which all of them together wind round.
    OnTorus(Box<Torus>, WindingSets, Directions),
}

impl Sets {
    fn find(&mut self, cell: u32) -> u32 {
        match self {
            Self::InSpace(sets) => sets.find(cell),
            Self::OnTorus(_, sets, _) => sets.find(cell).0,
        }
    }
}

impl Levels<'_> {
    /// The voids of each level, in space as many as its second Betti number, largest first, like in
    /// [`AlphaShape::voids`](crate::AlphaShape::voids). O(n α(n)), and the length of the result.
    pub fn voids(&self) -> Vec<Vec<Void>> {
        let mut voids = vec![Vec::new(); self.len()];
        self.descend(|level, complement| voids[level] = complement.voids());
        voids
    }

    /// The facets around the first [voids](Self::voids) of each level, this many at most: corners counter-clockwise
    /// seen from outside the void. A facet with the void on both sides hangs into it, and is not listed. O(n α(n)), and the
    /// number of cells of the voids.
    #[doc(hidden)]
    pub fn void_facets(&self, most: usize) -> Vec<Vec<Vec<[u32; 3]>>> {
        let mut facets = vec![Vec::new(); self.len()];
        if most == 0 {
            return facets;
        }
        self.descend(|level, complement| facets[level] = complement.void_facets(most));
        facets
    }

    /// Visits the complement of each level, from the last to the first.
    pub(super) fn descend(&self, mut visit: impl FnMut(usize, &mut LevelComplement<'_>)) {
        let cells = ByLevel::new(self.len(), self.cells.iter().copied());
        let facets = ByLevel::new(self.len(), self.facets.iter().map(|span| span.first));
        let whole = &self.filtration.whole;
        let hollow = |(row, &cell): (usize, &[u32; 4])| {
            let radius = Interval::around(self.filtration.radii.cells[row]);
            Hollow::of(radius, whole.corners(cell))
        };
        let (sets, count) = match self.filtration.torus() {
            None => (Sets::InSpace(UnionFind::new(self.cells.len() + 1)), 1),
            Some(torus) => {
                let sets = self.filtration.complement_sets(torus);
                let (rounds, count) = (sets.directions(), sets.winding_sets() as u64);
                (Sets::OnTorus(Box::new(torus), sets, rounds), count)
            }
        };
        let mut complement = LevelComplement {
            levels: self,
            spheres: self.filtration.spheres(),
            sets,
            hollows: whole.complex().cells.rows().iter().enumerate().map(hollow).collect(),
            roots: Vec::new(),
            count,
            next: (0..self.cells.len() as u32).collect(),
            known: BTreeMap::new(),
        };
        for level in (0..self.len()).rev() {
            let gone = cells.at(level + 1);
            complement.count += gone.len() as u64;
            complement.roots.extend_from_slice(gone);
            for &facet in facets.at(level + 1) {
                complement.join(self.filtration.sides(facet as usize), facet);
            }
            visit(level, &mut complement);
        }
    }
}

impl LevelComplement<'_> {
    /// Unites the two cells of a facet.
    fn join(&mut self, [a, b]: [u32; 2], facet: u32) {
        let roots = [self.sets.find(a), self.sets.find(b)];
        let (low, high) = (roots[0].min(roots[1]), roots[0].max(roots[1]));
        let filtration = self.levels.filtration;
        let joined = match &mut self.sets {
            Sets::InSpace(sets) => {
                sets.unite(a, b);
                low != high
            }
            Sets::OnTorus(torus, sets, rounds) => {
                let way = filtration.way_across(**torus, facet as usize);
                let united = sets.unite(a, b, way);
                if let United::Round(way) = united {
                    rounds.add(way);
                }
                // What is outside has no sums.
                if let Some(hollow) = self.hollows.get_mut(high as usize) {
                    hollow.moved(**torus, sets.find(high).1);
                }
                united == United::Two
            }
        };
        if joined {
            self.add_up(low as usize, high as usize);
        }
    }

    /// Accounts for the union of two components.
    fn add_up(&mut self, root: usize, other: usize) {
        self.count -= 1;
        // The outside is the last set, and has no sums.
        if other < self.hollows.len() {
            self.next.swap(root, other);
            let other = self.hollows[other];
            self.hollows[root].join(&other);
        }
    }

    /// The Betti numbers that the number of components determines, and on a torus the directions in which they
    /// go round: b2 and b3 (Alexander duality, and on a torus the exact sequence of the pair of it and the
    /// complement: H₁(complement) → H₁(torus) → H²(shape) → H₀(complement) → H₀(torus) → H³(shape)). A torus that does not repeat along
    /// all vectors is one in which the shape leaves a gap.
    pub(super) fn closed(&self) -> UpperBetti {
        match &self.sets {
            Sets::InSpace(_) => UpperBetti { b2: self.count - 1, b3: None },
            Sets::OnTorus(.., rounds) => {
                let b3 = u64::from(self.count == 0);
                UpperBetti { b2: self.count + b3 + 2 - rounds.rank() as u64, b3: Some(b3) }
            }
        }
    }

    /// The number of bounded components.
    fn bounded(&self) -> u64 {
        match &self.sets {
            Sets::InSpace(_) => self.count - 1,
            Sets::OnTorus(_, sets, _) => self.count - sets.winding_sets() as u64,
        }
    }

    /// Whether a component, given by its root, is bounded.
    fn is_bounded(&mut self, root: u32) -> bool {
        let outside = self.hollows.len() as u32;
        match &mut self.sets {
            Sets::InSpace(sets) => sets.find(outside) != root,
            Sets::OnTorus(_, sets, _) => sets.rounds(root).is_none(),
        }
    }

    pub(super) fn voids(&mut self) -> Vec<Void> {
        self.voids_and_roots().into_iter().map(|(void, _)| void).collect()
    }

    /// The voids with their roots.
    fn voids_and_roots(&mut self) -> Vec<(Void, u32)> {
        let mut roots = std::mem::take(&mut self.roots);
        // A component that winds round will always do so.
        roots.retain(|&root| self.sets.find(root) == root && self.is_bounded(root));
        let void = |&root: &u32| {
            let alpha = self.filling(root);
            (self.hollows[root as usize].void(alpha), root)
        };
        let mut voids: Vec<(Void, u32)> = roots.iter().map(void).collect();
        sort_by(&mut voids, |(a, _), (b, _)| a.order(b));
        self.roots = roots;
        voids
    }

    /// The facets around the first voids, this many at most.
    fn void_facets(&mut self, most: usize) -> Vec<Vec<[u32; 3]>> {
        let roots = self.voids_and_roots();
        roots.iter().take(most).map(|&(_, root)| self.facets_around(root)).collect()
    }

    fn facets_around(&mut self, root: u32) -> Vec<[u32; 3]> {
        let filtration = self.levels.filtration;
        let Incidence { cell_facets, facet_cells, .. } = &filtration.incidence;
        let cells = filtration.whole.complex().cells.rows();
        let mut facets = Vec::new();
        let mut at = root;
        loop {
            for (opposite, facet) in cell_facets[at as usize].into_iter().enumerate() {
                let sides = facet_cells[facet as usize];
                let other = if sides[0] == at { sides[1] } else { sides[0] };
                if other == Incidence::OUTSIDE || self.sets.find(other) != root {
                    facets.push(Incidence::outward(opposite).map(|k| cells[at as usize][k]));
                }
            }
            at = self.next[at as usize];
            if at == root {
                return facets;
            }
        }
    }

    /// The smallest double at which all cells of a component fit.
    fn filling(&mut self, root: u32) -> f64 {
        let hollow = self.hollows[root as usize];
        match self.known.get(&root) {
            Some(&(cells, alpha)) if cells == hollow.cells() => return alpha,
            _ => {}
        }
        let filtration = self.levels.filtration;
        let cells = filtration.whole.complex().cells.rows();
        let (mut alpha, mut at) = (f64::NEG_INFINITY, root as usize);
        loop {
            let radius = Interval::around(filtration.radii.cells[at]);
            hollow.raise(&mut alpha, &self.spheres, cells[at], radius);
            at = self.next[at] as usize;
            if at == root as usize {
                break;
            }
        }
        self.known.insert(root, (hollow.cells(), alpha));
        alpha
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use crate::ladder::Filtration;
    use crate::{Alpha, WeightedPoints, six_volumes};

    /// The facets around each void are closed: a cone over them from any place has the volume of the void, and they have its box.
    #[test]
    fn facets_enclose_the_voids() {
        let mut random = Random::new(61);
        let mut compared = 0;
        for k in 0..60 {
            // On a lattice or not; some lie in others.
            let step = if k % 2 == 0 { 16.0 } else { 15.3 };
            let mut number = || random.below(61) as f64 / step;
            let positions = (0..60).map(|_| [number(), number(), number()]).collect();
            let weights = (0..60).map(|_| number() / 40.0).collect();
            let points = WeightedPoints::new(positions, weights).unwrap();
            let filtration = Filtration::new(points).unwrap();
            let alphas: Vec<Alpha> =
                (0..24).map(|k| Alpha::from_squared(0.05 * f64::from(k)).unwrap()).collect();
            let levels = filtration.levels(&alphas);
            let facets = levels.void_facets(usize::MAX);
            for (voids, facets) in levels.voids().iter().zip(&facets) {
                assert_eq!(voids.len(), facets.len());
                for (void, facets) in voids.iter().zip(facets) {
                    let corners: Vec<[[f64; 3]; 3]> = facets
                        .iter()
                        .map(|facet| facet.map(|v| filtration.points().positions()[v as usize]))
                        .collect();
                    let cones = corners.iter().map(|&[a, b, c]| six_volumes([[9.0; 3], a, b, c]));
                    assert!((cones.sum::<f64>() / 6.0 - void.volume).abs() < 1e-9);
                    for axis in 0..3 {
                        let along = || corners.as_flattened().iter().map(|corner| corner[axis]);
                        assert_eq!(along().fold(f64::INFINITY, f64::min), void.low[axis]);
                        assert_eq!(along().fold(f64::NEG_INFINITY, f64::max), void.high[axis]);
                    }
                    compared += 1;
                }
            }
            let first: Vec<_> =
                facets.iter().map(|level| level[..level.len().min(1)].to_vec()).collect();
            assert_eq!(levels.void_facets(1), first);
        }
        assert!(compared > 300, "{compared}");
    }
}
