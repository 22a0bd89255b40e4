//! Persistence pairs. Those of dimensions 0 and 2 follow from the elder rule: when a simplex joins two components of the shape,
//! or of its complement, the younger ends. Those of dimension 1 follow from reducing coboundaries of edges, last edge first (de
//! Silva, Morozov and Vejdemo-Johansson 2011, doi:10.1088/0266-5611/27/12/124003).

use std::collections::{BTreeMap, BTreeSet};

use walpha_base::{Cancelled, Monitor};

use super::finding::FiltrationFinding;
use super::values::{RowNumbers, Spans};
use crate::certify::structure::Structure;
use crate::schema::{FiltrationFile, PairsFile};

/// Judges the pairs of a file whose simplices and order are right: the pairs whose simplices have different values,
/// each once, and the components that never end.
pub(super) fn judge(
    file: &FiltrationFile,
    given: &PairsFile,
    structure: &Structure,
    rows: &RowNumbers,
    spans: &Spans,
    monitor: &Monitor,
) -> Result<Vec<FiltrationFinding>, Cancelled> {
    let pairing = Pairing { file, structure, rows, spans };
    let Components { pairs, lasting, merging } = pairing.components(&monitor.part(0, 1, 4))?;
    let mut findings = differences(0, &given.components, &pairs);
    findings.extend(differences(2, &given.voids, &pairing.voids(&monitor.part(1, 2, 4))?));
    if let Some(given) = &given.loops {
        let loops = pairing.loops(&merging, &monitor.part(2, 4, 4))?;
        findings.extend(differences(1, given, &loops));
    }
    let listed: BTreeSet<u32> = given.lasting.iter().copied().collect();
    if listed != lasting || listed.len() != given.lasting.len() {
        let (given, expected) = (given.lasting.clone(), lasting.into_iter().collect());
        findings.push(FiltrationFinding::Lasting { given, expected });
    }
    Ok(findings)
}

/// Findings on wrong, repeated and missing pairs.
fn differences(
    dimension: usize,
    given: &[[u32; 2]],
    expected: &BTreeSet<[u32; 2]>,
) -> Vec<FiltrationFinding> {
    let mut seen = BTreeSet::new();
    let wrong = given.iter().filter(|pair| !expected.contains(*pair) || !seen.insert(**pair));
    let wrong = wrong.map(|&pair| FiltrationFinding::Pair { dimension, pair, listed: true });
    let mut findings: Vec<_> = wrong.collect();
    let missing = expected.difference(&seen);
    let missing = missing.map(|&pair| FiltrationFinding::Pair { dimension, pair, listed: false });
    findings.extend(missing);
    findings
}

struct Pairing<'a> {
    file: &'a FiltrationFile,
    structure: &'a Structure<'a>,
    rows: &'a RowNumbers,
    spans: &'a Spans,
}

/// Pairs of dimension 0.
struct Components {
    /// The pairs whose simplices have different values.
    pairs: BTreeSet<[u32; 2]>,
    /// Vertices whose components never end.
    lasting: BTreeSet<u32>,
    /// The numbers of all edges that end a component.
    merging: BTreeSet<u32>,
}

impl Pairing<'_> {
    /// Visits simplices in order: a vertex creates a component, and an edge between two components ends the younger one.
    fn components(&self, monitor: &Monitor) -> Result<Components, Cancelled> {
        let work = monitor.units(self.file.order.len() as u64);
        let vertices = self.file.vertices.len() as u32;
        let edges = self.file.edges.len() as u32;
        let number: BTreeMap<u32, u32> = self.file.vertices.iter().copied().zip(0..).collect();
        let mut oldest = Oldest::default();
        let (mut pairs, mut merging) = (BTreeSet::new(), BTreeSet::new());
        for &simplex in &self.file.order {
            work.add(1)?;
            if simplex < vertices {
                oldest.begin(simplex);
            } else if simplex - vertices < edges {
                let edge = (simplex - vertices) as usize;
                let ends = self.file.edges[edge].map(|v| number[&v]);
                if let Some(younger) = oldest.join(ends) {
                    merging.insert(simplex);
                    let from = self.spans.vertices[self.rows.vertices[younger as usize]].first;
                    if from != self.spans.edges[self.rows.edges[edge]].first {
                        pairs.insert([younger, simplex]);
                    }
                }
            }
        }
        Ok(Components { pairs, lasting: oldest.remaining(), merging })
    }

    /// Visits simplices in reverse order: an edge that does not end a component closes a loop, which ends with the first facet of
    /// its coboundary, after coboundaries of later edges with the same first facet are added.
    fn loops(
        &self,
        merging: &BTreeSet<u32>,
        monitor: &Monitor,
    ) -> Result<BTreeSet<[u32; 2]>, Cancelled> {
        let work = monitor.units(self.file.order.len() as u64);
        let first_edge = self.file.vertices.len() as u32;
        let first_facet = first_edge + self.file.edges.len() as u32;
        let sorted = |[a, b]: [u32; 2]| if a < b { [a, b] } else { [b, a] };
        let edges: BTreeMap<[u32; 2], u32> =
            self.file.edges.iter().map(|&edge| sorted(edge)).zip(first_edge..).collect();
        // For each edge, by its number, places in the order.
        let mut coboundaries = BTreeMap::<u32, Vec<usize>>::new();
        for (place, &simplex) in self.file.order.iter().enumerate() {
            let facet = simplex.checked_sub(first_facet);
            let Some(&[a, b, c]) = facet.and_then(|row| self.file.facets.get(row as usize)) else {
                continue;
            };
            for side in [[a, b], [a, c], [b, c]] {
                coboundaries.entry(edges[&sorted(side)]).or_default().push(place);
            }
        }
        let mut pairs = BTreeSet::new();
        let mut reduced = BTreeMap::<usize, Vec<usize>>::new();
        for &edge in self.file.order.iter().rev() {
            work.add(1)?;
            if !(first_edge..first_facet).contains(&edge) || merging.contains(&edge) {
                continue;
            }
            let mut column: BTreeSet<usize> =
                coboundaries.remove(&edge).into_iter().flatten().collect();
            while let Some(other) = column.first().and_then(|first| reduced.get(first)) {
                for place in other {
                    if !column.remove(place) {
                        column.insert(*place);
                    }
                }
            }
            let Some(&first) = column.first() else { continue };
            let facet = self.file.order[first];
            let row = |number: u32, from: u32| (number - from) as usize;
            let from = self.spans.edges[self.rows.edges[row(edge, first_edge)]].first;
            let until = self.spans.facets[self.rows.facets[row(facet, first_facet)]].first;
            if from != until {
                pairs.insert([edge, facet]);
            }
            reduced.insert(first, column.into_iter().collect());
        }
        Ok(pairs)
    }

    /// Visits simplices in reverse order: a cell creates a component of the complement, and a facet between two components ends
    /// the younger one. The outside is the oldest.
    fn voids(&self, monitor: &Monitor) -> Result<BTreeSet<[u32; 2]>, Cancelled> {
        let work = monitor.units(self.file.order.len() as u64);
        let below = self.file.vertices.len() + self.file.edges.len();
        let [facets, cells] = [below, below + self.file.facets.len()].map(|n| n as u32);
        // The numbers of the file by the rows of the triangulation.
        let number: BTreeMap<usize, u32> = self.rows.cells.iter().copied().zip(cells..).collect();
        let mut oldest = Oldest::default();
        oldest.begin(OUTSIDE);
        let mut pairs = BTreeSet::new();
        for &simplex in self.file.order.iter().rev() {
            work.add(1)?;
            if simplex >= cells {
                oldest.begin(simplex);
            } else if simplex >= facets {
                let row = self.rows.facets[(simplex - facets) as usize];
                let mut sides = self.structure.halves(row).map(|half| number[&half.cell]);
                let ends = [0, 1].map(|_| sides.next().unwrap_or(OUTSIDE));
                if let Some(younger) = oldest.join(ends) {
                    let until = self.spans.cells[self.rows.cells[(younger - cells) as usize]];
                    if until != self.spans.facets[row].first {
                        pairs.insert([simplex, younger]);
                    }
                }
            }
        }
        Ok(pairs)
    }
}

/// Stands for the outside of the hull; no simplex has this number.
const OUTSIDE: u32 = u32::MAX;

/// Disjoint sets whose representatives are their oldest members.
#[derive(Default)]
struct Oldest {
    /// For each member, an older one of its set, or itself; and its age.
    older: BTreeMap<u32, (u32, usize)>,
}

impl Oldest {
    fn begin(&mut self, member: u32) {
        let age = self.older.len();
        self.older.insert(member, (member, age));
    }

    fn find(&mut self, member: u32) -> (u32, usize) {
        let mut path = Vec::new();
        let mut at = member;
        while self.older[&at].0 != at {
            path.push(at);
            at = self.older[&at].0;
        }
        for member in path {
            self.older.entry(member).and_modify(|entry| entry.0 = at);
        }
        self.older[&at]
    }

    /// Unites the sets of two members. Returns the younger of their oldest members, if there were two sets.
    fn join(&mut self, ends: [u32; 2]) -> Option<u32> {
        let [(a, from_a), (b, from_b)] = ends.map(|end| self.find(end));
        if a == b {
            return None;
        }
        let (older, younger) = if from_a < from_b { (a, b) } else { (b, a) };
        self.older.entry(younger).and_modify(|entry| entry.0 = older);
        Some(younger)
    }

    /// The oldest member of each set.
    fn remaining(&self) -> BTreeSet<u32> {
        let all = self.older.iter();
        all.filter(|(member, (older, _))| *member == older).map(|(&member, _)| member).collect()
    }
}
