//! Persistence pairs of dimensions 0 and 2, by the definition of each: which of two components, or of two
//! parts of the complement, is the younger when a simplex joins them.

use std::collections::{BTreeMap, BTreeSet};

use super::finding::FiltrationFinding;
use super::row_numbers::RowNumbers;
use super::spans::Spans;
use crate::certify::structure::Structure;
use crate::schema::{FiltrationFile, PairsFile};

/// Judges the pairs of a file whose simplices and order are right: those whose simplices have different values,
/// each once, and the components that last for ever.
pub(super) fn judge(
    file: &FiltrationFile,
    given: &PairsFile,
    structure: &Structure,
    rows: &RowNumbers,
    spans: &Spans,
) -> Vec<FiltrationFinding> {
    let pairing = Pairing { file, structure, rows, spans };
    let (components, lasting) = pairing.components();
    let mut findings = differences(0, &given.components, &components);
    findings.extend(differences(2, &given.voids, &pairing.voids()));
    let listed: BTreeSet<u32> = given.lasting.iter().copied().collect();
    if listed != lasting || listed.len() != given.lasting.len() {
        let (given, expected) = (given.lasting.clone(), lasting.into_iter().collect());
        findings.push(FiltrationFinding::Lasting { given, expected });
    }
    findings
}

/// Pairs that are listed and are none, or twice, and those that are missing.
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

impl Pairing<'_> {
    /// Upwards: a vertex begins a component, an edge between two ends the younger one.
    fn components(&self) -> (BTreeSet<[u32; 2]>, BTreeSet<u32>) {
        let vertices = self.file.vertices.len() as u32;
        let edges = self.file.edges.len() as u32;
        let number: BTreeMap<u32, u32> = self.file.vertices.iter().copied().zip(0..).collect();
        let mut oldest = Oldest::default();
        let mut pairs = BTreeSet::new();
        for &simplex in &self.file.order {
            if simplex < vertices {
                oldest.begin(simplex);
            } else if simplex - vertices < edges {
                let edge = (simplex - vertices) as usize;
                let ends = self.file.edges[edge].map(|v| number[&v]);
                if let Some(younger) = oldest.join(ends) {
                    let from = self.spans.vertices[self.rows.vertices[younger as usize]].first;
                    if from != self.spans.edges[self.rows.edges[edge]].first {
                        pairs.insert([younger, simplex]);
                    }
                }
            }
        }
        (pairs, oldest.remaining())
    }

    /// Downwards: a cell begins a part of the complement, a facet between two ends the younger one. The
    /// outside was there before all.
    fn voids(&self) -> BTreeSet<[u32; 2]> {
        let below = self.file.vertices.len() + self.file.edges.len();
        let [facets, cells] = [below, below + self.file.facets.len()].map(|n| n as u32);
        // By rows of the triangulation, the numbers of the file.
        let number: BTreeMap<usize, u32> = self.rows.cells.iter().copied().zip(cells..).collect();
        let mut oldest = Oldest::default();
        oldest.begin(OUTSIDE);
        let mut pairs = BTreeSet::new();
        for &simplex in self.file.order.iter().rev() {
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
        pairs
    }
}

/// No number of a simplex.
const OUTSIDE: u32 = u32::MAX;

/// Sets, each with the member that began first; all others point towards it.
#[derive(Default)]
struct Oldest {
    /// Of each member an older one of its set, or itself; and when it began.
    older: BTreeMap<u32, (u32, usize)>,
}

impl Oldest {
    fn begin(&mut self, member: u32) {
        let age = self.older.len();
        self.older.insert(member, (member, age));
    }

    fn find(&mut self, member: u32) -> (u32, usize) {
        let mut way = Vec::new();
        let mut at = member;
        while self.older[&at].0 != at {
            way.push(at);
            at = self.older[&at].0;
        }
        for on_way in way {
            self.older.entry(on_way).and_modify(|entry| entry.0 = at);
        }
        self.older[&at]
    }

    /// Joins the sets of two members; gives the younger of those that began them, if there were two.
    fn join(&mut self, ends: [u32; 2]) -> Option<u32> {
        let [(a, from_a), (b, from_b)] = ends.map(|end| self.find(end));
        if a == b {
            return None;
        }
        let (older, younger) = if from_a < from_b { (a, b) } else { (b, a) };
        self.older.entry(younger).and_modify(|entry| entry.0 = older);
        Some(younger)
    }

    /// The members that began the sets there are.
    fn remaining(&self) -> BTreeSet<u32> {
        let all = self.older.iter();
        all.filter(|(member, (older, _))| *member == older).map(|(&member, _)| member).collect()
    }
}
