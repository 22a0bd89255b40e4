//! The voids of all levels, by taking cells away: the complement only grows as α falls, so one
//! union-find serves them all (Delfinado and Edelsbrunner 1995, doi:10.1016/0167-8396(94)00016-Y).

use std::collections::BTreeMap;

use super::Levels;
use super::incidence::Incidence;
use super::levels::ByLevel;
use crate::shape::{Hollow, UnionFind, Void};
use crate::triangulation::Predicates;

/// What a level leaves empty: the components of its complement.
pub(super) struct Hollows<'a> {
    levels: &'a Levels<'a>,
    spheres: Predicates<'a>,
    sets: UnionFind,
    /// The hollow of each component, at its root.
    hollows: Vec<Hollow>,
    /// Roots, and cells that were roots once.
    roots: Vec<u32>,
    count: u64,
    /// The cells of each component in a ring, each with the next.
    next: Vec<u32>,
    /// The α that fills a component, by its root, where it was asked for; and how many cells it had.
    known: BTreeMap<u32, (usize, f64)>,
}

impl Levels<'_> {
    /// The hole ledger: the voids of each level, as many as its second Betti number, largest first
    /// as in [`AlphaShape::voids`](crate::AlphaShape::voids).
    /// O(n α(n)) and the length of the answer.
    pub fn voids(&self) -> Vec<Vec<Void>> {
        let mut voids = vec![Vec::new(); self.len()];
        self.descend(|level, complement| voids[level] = complement.voids());
        voids
    }

    /// Visits the complement of each level, from the last to the first.
    pub(super) fn descend(&self, mut visit: impl FnMut(usize, &mut Hollows<'_>)) {
        let incidence = &self.filtration.incidence;
        let cells = ByLevel::new(self.len(), self.cells.iter().copied());
        let facets = ByLevel::new(self.len(), self.facets.iter().map(|span| span.first));
        let complex = self.filtration.whole.complex();
        let positions = &self.filtration.points().positions;
        let hollow = |(row, cell): (usize, &[u32; 4])| {
            let corners = cell.map(|v| positions[v as usize]);
            Hollow::of(self.filtration.cells[row], corners)
        };
        let outside = self.cells.len() as u32;
        let mut complement = Hollows {
            levels: self,
            spheres: self.filtration.spheres(),
            sets: UnionFind::new(self.cells.len() + 1),
            hollows: complex.cells.rows().iter().enumerate().map(hollow).collect(),
            roots: Vec::new(),
            count: 1,
            next: (0..outside).collect(),
            known: BTreeMap::new(),
        };
        for level in (0..self.len()).rev() {
            let gone = cells.at(level + 1);
            complement.count += gone.len() as u64;
            complement.roots.extend_from_slice(gone);
            for &facet in facets.at(level + 1) {
                let [a, b] = incidence.facet_cells[facet as usize]
                    .map(|side| if side == Incidence::OUTSIDE { outside } else { side });
                complement.join(a, b);
            }
            visit(level, &mut complement);
        }
    }
}

impl Hollows<'_> {
    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.sets.find(a), self.sets.find(b));
        if !self.sets.unite(a, b) {
            return;
        }
        self.count -= 1;
        let (root, other) = (a.min(b) as usize, a.max(b) as usize);
        // The outside is the last set of all and keeps no account.
        if other < self.hollows.len() {
            self.next.swap(root, other);
            let other = self.hollows[other];
            self.hollows[root].join(&other);
        }
    }

    /// The number of voids.
    pub fn bounded(&self) -> u64 {
        self.count - 1
    }

    fn voids(&mut self) -> Vec<Void> {
        let outside = self.sets.find(self.hollows.len() as u32);
        let mut roots = std::mem::take(&mut self.roots);
        roots.retain(|&root| self.sets.find(root) == root && root != outside);
        let void = |&root: &u32| {
            let alpha = self.filling(root);
            self.hollows[root as usize].void(alpha)
        };
        let mut voids: Vec<Void> = roots.iter().map(void).collect();
        voids.sort_by(Void::order);
        self.roots = roots;
        voids
    }

    /// The first double at which all cells of a component fit.
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
            hollow.raise(&mut alpha, &self.spheres, cells[at], filtration.cells[at]);
            at = self.next[at] as usize;
            if at == root as usize {
                break;
            }
        }
        self.known.insert(root, (hollow.cells(), alpha));
        alpha
    }
}
