//! The rules in their order, and which are skipped once others are broken.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use super::classes::{self, Judge};
use super::emptiness::Emptiness;
use super::structure::{self, Structure};
use super::{Claim, Extent, Finding, Points, gaps, geometry, hull, places};
use crate::Complex;
use crate::exact::Exact;

/// Takes the findings of a rule; breaks if the visitor has seen enough.
type Report<'r> = dyn FnMut(Vec<Finding>) -> ControlFlow<()> + 'r;

/// Applies all rules in turn. Breaks if the visitor does, or if a rule is broken without which
/// others mean nothing.
pub(super) fn apply(
    claim: &Claim,
    report: &mut Report,
    volume: &mut Option<Exact>,
) -> ControlFlow<()> {
    let (complex, alpha) = (claim.placed.complex, claim.placed.alpha);
    let points = Points { positions: claim.placed.positions, weights: claim.placed.weights };
    let whole = claim.extent == Extent::Whole;
    let rows = structure::rows(complex, points.len());
    let bad_rows = !rows.is_empty();
    report(rows)?;
    if whole && complex.cells.is_empty() {
        report(vec![Finding::NoCells])?;
        return ControlFlow::Break(());
    }
    if bad_rows {
        return ControlFlow::Break(());
    }
    let (sum, exponent) = hull::six_volumes(complex.cells.rows(), points);
    *volume = Some(Exact::integer(sum, exponent));

    let stays = places::staying(points);
    let emptiness = (!whole).then(|| Emptiness::new(points, alpha, &stays));
    let judge = Judge { points, alpha, extent: claim.extent, emptiness: emptiness.as_ref() };
    let listed = Linked::new(complex, &judge);
    let missing = gaps::missing_cells(&listed.structure, points, alpha, judge.emptiness);
    if !missing.is_empty() {
        let filled = gaps::filled(complex, &missing);
        let filled = Linked::new(&filled, &judge);
        if filled.is_regular() {
            report(gaps::findings(&missing, points))?;
            // Classes around a gap may be right without its cell, or with it.
            let wrong = classes::judge(&listed.structure, &judge);
            let wrong: BTreeSet<_> = wrong.iter().filter_map(Finding::judged_class).collect();
            let in_both = |finding: &Finding| {
                finding.judged_class().is_none_or(|simplex| wrong.contains(simplex))
            };
            let mut lasting =
                |findings: Vec<Finding>| report(findings.into_iter().filter(in_both).collect());
            return apply_to(filled, claim, &judge, &stays, &mut lasting);
        }
    }
    apply_to(listed, claim, &judge, &stays, report)
}

/// The rules after those on rows.
fn apply_to(
    linked: Linked,
    claim: &Claim,
    judge: &Judge,
    stays: &[u32],
    report: &mut Report,
) -> ControlFlow<()> {
    let regular = linked.is_regular();
    let Linked { structure, broken, irregular } = linked;
    let points = judge.points;
    report(broken)?;
    if claim.extent == Extent::Whole {
        report(hull::volume(&structure, points))?;
    }
    report(irregular)?;
    report(places::duplicates(&structure, stays, claim.duplicates))?;
    if let Some(emptiness) = judge.emptiness {
        let alpha = judge.alpha;
        report(places::of_shape(&structure, points, alpha, emptiness, stays, claim.hidden))?;
    } else {
        let (hidden, findings) = places::hidden(&structure, stays, claim.hidden);
        report(findings)?;
        if regular {
            report(places::hiddenness(&structure, points, &hidden))?;
        }
    }
    report(classes::judge(&structure, judge))?;
    if regular { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}

/// A complex with its simplices linked, and which rules of structure and geometry it breaks.
struct Linked<'a> {
    structure: Structure<'a>,
    /// Rules without which the others mean nothing.
    broken: Vec<Finding>,
    /// Neighbours and hull, judged if nothing is broken.
    irregular: Vec<Finding>,
}

impl<'a> Linked<'a> {
    fn new(complex: &'a Complex, judge: &Judge) -> Self {
        let points = judge.points;
        let (structure, mut broken) = Structure::new(complex, points);
        broken.extend(geometry::orientations(complex.cells.rows(), points));
        let mut irregular = Vec::new();
        if broken.is_empty() {
            irregular.extend(geometry::neighbours(&structure, points));
            if judge.extent == Extent::Whole {
                irregular.extend(hull::convexity(&structure, points));
            }
        }
        Self { structure, broken, irregular }
    }

    fn is_regular(&self) -> bool {
        self.broken.is_empty() && self.irregular.is_empty()
    }
}
