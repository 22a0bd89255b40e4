//! The order in which simplices enter.

use walpha_base::{Cancelled, Monitor};
use walpha_complex::canonical::sorted;

use super::finding::FiltrationFinding;
use super::values::{Ranks, RowNumbers, Spans};
use crate::certify::finding::Simplex;
use crate::schema::FiltrationFile;

/// Judges that each simplex is in the order once, and comes after the one before it: by the exact
/// number, then by dimension, then by vertices.
pub(super) fn judge(
    file: &FiltrationFile,
    rows: &RowNumbers,
    ranks: &Ranks,
    spans: &Spans,
    monitor: &Monitor,
) -> Result<Vec<FiltrationFinding>, Cancelled> {
    let counts = [file.vertices.len(), file.edges.len(), file.facets.len(), file.cells.len()];
    let total: usize = counts.iter().sum();
    let mut findings = Vec::new();
    let mut seen = vec![false; total];
    for &number in &file.order {
        match seen.get_mut(number as usize) {
            Some(seen) if !*seen => *seen = true,
            _ => findings.push(FiltrationFinding::Number { number, simplices: total }),
        }
    }
    let absent = (0..).zip(&seen).filter(|(_, seen)| !**seen);
    findings.extend(absent.map(|(number, _)| FiltrationFinding::Absent { number }));
    if !findings.is_empty() {
        return Ok(findings);
    }
    let key_of = |number: u32| OrderKey::of(file, number, counts, rows, spans);
    let pairs = monitor.units(total as u64);
    for pair in file.order.windows(2) {
        pairs.add(1)?;
        let [before, after] = [pair[0], pair[1]].map(key_of);
        if before.key() > after.key() {
            let exact = |key: &OrderKey| ranks.exact(key.rank).cloned().unwrap_or_default();
            let values = [exact(&before), exact(&after)];
            findings.push(FiltrationFinding::Order {
                before: before.simplex(),
                after: after.simplex(),
                values,
            });
        }
    }
    Ok(findings)
}

/// The key that determines the position of a simplex in the order.
struct OrderKey {
    rank: u32,
    /// Ascending.
    vertices: Vec<u32>,
}

impl OrderKey {
    fn of(
        file: &FiltrationFile,
        number: u32,
        counts: [usize; 4],
        rows: &RowNumbers,
        spans: &Spans,
    ) -> Self {
        let mut row = number as usize;
        let mut dimension = 0;
        while row >= counts[dimension] {
            row -= counts[dimension];
            dimension += 1;
        }
        match dimension {
            0 => Self {
                rank: spans.vertices[rows.vertices[row]].first,
                vertices: vec![file.vertices[row]],
            },
            1 => Self {
                rank: spans.edges[rows.edges[row]].first,
                vertices: sorted(file.edges[row]).to_vec(),
            },
            2 => Self {
                rank: spans.facets[rows.facets[row]].first,
                vertices: sorted(file.facets[row]).to_vec(),
            },
            _ => Self {
                rank: spans.cells[rows.cells[row]],
                vertices: sorted(file.cells[row]).to_vec(),
            },
        }
    }

    fn key(&self) -> (u32, usize, &[u32]) {
        (self.rank, self.vertices.len(), &self.vertices)
    }

    fn simplex(self) -> Simplex {
        match self.vertices[..] {
            [a] => [a].into(),
            [a, b] => [a, b].into(),
            [a, b, c] => [a, b, c].into(),
            _ => {
                let [a, b, c, d] = self.vertices[..] else { unreachable!("four vertices at most") };
                [a, b, c, d].into()
            }
        }
    }
}
