//! Betti numbers and solid parts of all levels, by adding what comes at each.

use walpha_base::UnionFind;

use super::Levels;
use super::levels::ByLevel;
use super::voids::Closed;
use crate::Betti;

impl Levels<'_> {
    /// Connected components of each level. O(n α(n)).
    pub(super) fn components(&self) -> Vec<u64> {
        let complex = self.filtration.whole.complex();
        let vertices = ByLevel::new(self.len(), self.vertices.iter().map(|span| span.first));
        let edges = ByLevel::new(self.len(), self.edges.iter().map(|span| span.first));
        let mut sets = UnionFind::new(self.filtration.points().len());
        let mut count = 0;
        let grow = |level| {
            count += vertices.at(level).len() as u64;
            for &edge in edges.at(level) {
                let [a, b] = complex.edges.rows()[edge as usize];
                count -= u64::from(sets.unite(a, b));
            }
            count
        };
        (0..self.len()).map(grow).collect()
    }

    /// Solid components of each level: cells joined through facets, as CGAL's
    /// `Alpha_shape_3::number_of_solid_components` counts them; where points span no volume, triangles joined
    /// through edges, or edges through vertices. O(n α(n)).
    pub fn solid_components(&self) -> Vec<u64> {
        let firsts = self.of_largest();
        let simplices = ByLevel::new(self.len(), firsts.iter().copied());
        // Two are united when the later of them comes.
        let joints = self.filtration.joints();
        let later = joints.iter().map(|&[a, b]| firsts[a as usize].max(firsts[b as usize]));
        let by_level = ByLevel::new(self.len(), later);
        let mut sets = UnionFind::new(firsts.len());
        let mut count = 0;
        let grow = |level| {
            // All of them first: one may be united with others that come at the same level.
            count += simplices.at(level).len() as u64;
            for &joint in by_level.at(level) {
                let [a, b] = joints[joint as usize];
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

    /// The Betti numbers of each level, of which some are given: b1 = b0 + b2 − b3 − χ.
    pub(super) fn betti_with(&self, closed: &[Closed]) -> Vec<Betti> {
        let parts = self.components().into_iter().zip(closed).zip(self.euler_characteristics());
        let betti = |((b0, closed), euler): ((u64, &Closed), i64)| {
            Betti::with_euler(b0, closed.b2, closed.b3, euler)
        };
        parts.map(betti).collect()
    }

    /// The Betti numbers of each level. O(n α(n)).
    pub fn betti(&self) -> Vec<Betti> {
        let mut closed = vec![Closed::default(); self.len()];
        self.descend(|level, complement| closed[level] = complement.closed());
        self.betti_with(&closed)
    }
}
