//! Persistence pairs of dimensions 0 and 2 by union-find (Edelsbrunner, Letscher and Zomorodian 2002,
//! doi:10.1007/s00454-002-2885-2; dimension 2 by duality, after Delfinado and Edelsbrunner 1995,
//! doi:10.1016/0167-8396(95)00016-Y).

use walpha_base::UnionFind;
use walpha_base::parallel::join;

use super::{Ordered, Pairs};
use crate::ladder::Filtration;
use crate::{Directions, Torus, United, WindingSets};

impl Ordered<'_> {
    /// Persistence pairs of dimensions 0 and 2. O(n α(n)). Those of dimension 1 are [`loops`](Self::loops), between
    /// the edges and facets that are in none of these. Computed once.
    pub fn pairs(&self) -> &Pairs {
        self.pairs.get(|| {
            let ((components, lasting), voids) =
                join(self.order().len(), || self.component_pairs(), || self.void_pairs());
            Pairs { components, lasting, ..voids }
        })
    }

    /// Whether the two simplices of a pair have different values.
    pub fn lasts(&self, [birth, death]: [u32; 2]) -> bool {
        self.rank(birth) != self.rank(death)
    }

    /// Pairs of dimension 0, by the elder rule: of two components that an edge merges, the younger ends.
    fn component_pairs(&self) -> (Vec<[u32; 2]>, Vec<u32>) {
        let rows = &self.filtration().incidence.vertex_rows;
        let [of_vertices, of_edges, of_facets, _] = self.numbers.first;
        let mut sets = ElderSets::new(self.vertices().len());
        let mut pairs = Vec::with_capacity(self.vertices().len());
        let mut lasting = Vec::new();
        for (age, &simplex) in (0..).zip(&self.order) {
            if (of_vertices..of_edges).contains(&simplex) {
                sets.add(simplex - of_vertices, age);
            } else if (of_edges..of_facets).contains(&simplex) {
                let ends = self.edges()[(simplex - of_edges) as usize];
                let [a, b] = ends.map(|v| rows[v as usize]);
                if let Some([_, younger]) = sets.unite(a, b) {
                    pairs.push([of_vertices + younger, simplex]);
                }
            }
        }
        for v in 0..self.vertices().len() as u32 {
            if sets.eldest_of(v) == v {
                lasting.push(of_vertices + v);
            }
        }
        (pairs, lasting)
    }

    /// Pairs of dimension 2, by the same rule for the complement, backwards: there a cell creates a component, and a
    /// facet merges two; or, on a torus, it makes the complement wind round in a new direction.
    fn void_pairs(&self) -> Pairs {
        let [_, _, _, of_cells] = self.numbers.first;
        let cells = self.cells.len();
        let mut sorted = vec![0; cells];
        self.cell_rows.iter().zip(0..).for_each(|(&row, at): (_, u32)| sorted[row as usize] = at);
        let mut ways = self
            .filtration()
            .torus()
            .map(|torus| ComplementWindings::new(torus, self.filtration()));
        let mut found = Pairs { voids: Vec::with_capacity(cells), ..Pairs::default() };
        if ways.as_ref().is_some_and(|ways| ways.torus.dimension() == 3) {
            found.last = self.order.iter().rev().copied().find(|&s| s >= of_cells);
        }
        self.each_facet_of_complement(|simplex, row, sides, merged| {
            let round = ways.as_mut().is_some_and(|ways| ways.open(row, sides));
            if let Some([_, younger]) = merged {
                found.voids.push([simplex, of_cells + sorted[younger as usize]]);
            } else if round {
                found.lasting_voids.push(simplex);
            }
        });
        found.voids.reverse();
        found.lasting_voids.reverse();
        found
    }

    /// Visits the mergers of components of the complement, backwards: the eldest cells, by row, of the older component and of the younger one. The
    /// outside of points in space is the oldest; its number follows that of the last cell.
    pub(super) fn merge_complement(&self, mut visit: impl FnMut(u32, u32)) {
        self.each_facet_of_complement(|_, _, _, merged| {
            if let Some([older, younger]) = merged {
                visit(older, younger);
            }
        });
    }

    /// Visits the facets, backwards, with their numbers, their rows, what is on [both sides](Filtration::sides), and the eldest cells of the
    /// two components that each merges, if it does.
    fn each_facet_of_complement(
        &self,
        mut visit: impl FnMut(u32, usize, [u32; 2], Option<[u32; 2]>),
    ) {
        let [_, _, of_facets, of_cells] = self.numbers.first;
        let cells = self.cells.len();
        let mut sets = ElderSets::new(cells + 1);
        // The outside is the oldest component.
        sets.add(cells as u32, 0);
        for (age, &simplex) in (1..).zip(self.order.iter().rev()) {
            if simplex >= of_cells {
                sets.add(self.cell_rows[(simplex - of_cells) as usize], age);
            } else if simplex >= of_facets {
                let row = (simplex - of_facets) as usize;
                let sides = self.filtration().sides(row);
                visit(simplex, row, sides, sets.unite(sides[0], sides[1]));
            }
        }
    }
}

/// The directions in which the complement winds round a torus.
struct ComplementWindings<'a> {
    torus: Torus,
    filtration: &'a Filtration,
    sets: WindingSets,
    rounds: Directions,
}

impl<'a> ComplementWindings<'a> {
    fn new(torus: Torus, filtration: &'a Filtration) -> Self {
        let sets = filtration.complement_sets(torus);
        let rounds = sets.directions();
        Self { torus, filtration, sets, rounds }
    }

    /// Joins what is on both sides of a facet; returns whether the complement now winds round in a new direction.
    fn open(&mut self, facet: usize, sides: [u32; 2]) -> bool {
        let way = self.filtration.way_across(self.torus, facet);
        match self.sets.unite(sides[0], sides[1], way) {
            United::Round(way) => self.rounds.add(way),
            _ => false,
        }
    }
}

/// A union-find that keeps the eldest member of each set.
struct ElderSets {
    sets: UnionFind,
    /// When each was added.
    ages: Vec<u32>,
    /// For each root, the eldest member of its set.
    eldest: Vec<u32>,
}

impl ElderSets {
    fn new(members: usize) -> Self {
        Self {
            sets: UnionFind::new(members),
            ages: vec![0; members],
            eldest: (0..members as u32).collect(),
        }
    }

    fn add(&mut self, member: u32, age: u32) {
        self.ages[member as usize] = age;
    }

    fn eldest_of(&mut self, member: u32) -> u32 {
        self.eldest[self.sets.find(member) as usize]
    }

    /// Unites two sets, and returns their eldest members, the older one first; `None` if they are already one set.
    fn unite(&mut self, a: u32, b: u32) -> Option<[u32; 2]> {
        let [a, b] = [self.eldest_of(a), self.eldest_of(b)];
        if !self.sets.unite(a, b) {
            return None;
        }
        let is_a_younger = self.ages[a as usize] > self.ages[b as usize];
        let [older, younger] = if is_a_younger { [b, a] } else { [a, b] };
        let root = self.sets.find(a);
        self.eldest[root as usize] = older;
        Some([older, younger])
    }
}
