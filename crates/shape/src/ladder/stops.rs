//! Levels to look at: spread so that each shows something else.

use super::{Curve, Filtration, Levels};
use crate::Alpha;

/// What can be seen of a shape: boundary and singular facets, and singular edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Sight {
    /// How many there are.
    pub seen: u64,
    /// How many come, go, or turn from singular to boundary at this level.
    pub changed: u64,
}

impl Levels<'_> {
    /// What can be seen at each level. O(n).
    pub(super) fn sights(&self) -> Vec<Sight> {
        let mut change = vec![(0i64, 0u64); self.len() + 1];
        let mut event = |level: u32, more: i64| {
            let (seen, changed) = &mut change[level as usize];
            (*seen, *changed) = (*seen + more, *changed + 1);
        };
        for span in &self.facets {
            if span.first < span.interior {
                event(span.first, 1);
                if span.first < span.regular && span.regular < span.interior {
                    event(span.regular, 0);
                }
                event(span.interior, -1);
            }
        }
        for span in self.edges.iter().filter(|span| span.first < span.regular) {
            event(span.first, 1);
            event(span.regular, -1);
        }
        change.pop();
        let mut seen = 0;
        let sight = |(more, changed): (i64, u64)| {
            seen += more;
            Sight { seen: seen as u64, changed }
        };
        change.into_iter().map(sight).collect()
    }

    /// The levels that show something, and something else than the level before. Of levels that show
    /// the same, `wanted` stays, or else the first. O(n).
    pub fn distinct(&self, wanted: Alpha) -> Vec<Alpha> {
        let mut kept: Vec<Alpha> = Vec::new();
        let mut stands = false;
        for (&alpha, sight) in self.alphas().iter().zip(self.sights()) {
            let same = stands && sight.changed == 0;
            stands = sight.seen > 0;
            if same && alpha == wanted {
                kept.pop();
            }
            if stands && (!same || alpha == wanted) {
                kept.push(alpha);
            }
        }
        kept
    }
}

impl Filtration {
    /// At most `count` critical values to look at, ascending: each shows something, and something
    /// else than the one before.
    ///
    /// Their distances are even in the mean of three measures, so that neither few large simplices
    /// nor many small ones take all: the logarithm of the squared radius of the largest balls, the
    /// facets and edges that come and go, and the Betti numbers that change. The last two put most
    /// where the shape gets its form. O(n).
    pub fn stops(&self, curve: &Curve, count: usize) -> Vec<Alpha> {
        let shows = |&k: &usize| {
            let Sight { seen, changed } = curve.sights[k];
            seen > 0 && changed > 0 && curve.size(k) > 0.0
        };
        let all: Vec<usize> = (0..curve.len()).filter(shows).collect();
        let (Some(&first), Some(&last)) = (all.first(), all.last()) else { return Vec::new() };
        let measures = [
            (first..=last).map(|k| curve.size(k).max(curve.size(first)).ln()).collect(),
            sums((first..=last).map(|k| curve.sights[k].changed)),
            sums((first..=last).map(|k| curve.betti_change(k))),
        ];
        let place = |k: usize| -> f64 {
            let share = |sums: &Vec<f64>| {
                let (low, high) = (sums[0], sums[sums.len() - 1]);
                if high > low { (sums[k - first] - low) / (high - low) } else { 0.0 }
            };
            measures.iter().map(share).sum()
        };
        let whole = place(last);
        let mut chosen: Vec<usize> = Vec::new();
        for step in 0..count {
            let wanted = whole * step as f64 / (count.max(2) - 1) as f64;
            let at = all.partition_point(|&k| place(k) < wanted).min(all.len() - 1);
            if chosen.last().is_none_or(|&before| before < all[at]) {
                chosen.push(all[at]);
            }
        }
        chosen.into_iter().map(|k| self.first_alpha(curve.values[k])).collect()
    }
}

impl Curve {
    /// By how much the Betti numbers differ from those before.
    fn betti_change(&self, k: usize) -> u64 {
        let of = |k: usize| <[u64; 3]>::from(self.betti[k]);
        let before = if k == 0 { [0; 3] } else { of(k - 1) };
        of(k).into_iter().zip(before).map(|(now, before)| now.abs_diff(before)).sum()
    }
}

/// Sums of the first, the first two, and so on.
fn sums(numbers: impl Iterator<Item = u64>) -> Vec<f64> {
    let mut sum = 0;
    let add = |number| {
        sum += number;
        sum as f64
    };
    numbers.map(add).collect()
}
