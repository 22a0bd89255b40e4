//! The rules in their order, and which of them are skipped once others are broken.

use std::cell::Cell;
use std::collections::BTreeSet;
use std::ops::ControlFlow;

use super::classes::{self, Judge};
use super::emptiness::Emptiness;
use super::flat::Cone;
use super::linked::Linked;
use super::structure;
use super::{Claim, Extent, Finding, Points, gaps, hull, non_vertices, ties};
use crate::exact::Exact;
use crate::flat::auxiliary_positions;

/// Takes the findings of a rule; breaks when the visitor wants no more.
type Report<'r> = dyn FnMut(Vec<Finding>) -> ControlFlow<()> + 'r;

/// Applies all rules in turn. Breaks if the visitor does, or if a rule is broken without which
/// others mean nothing.
pub(super) fn apply(
    claim: &Claim,
    report: &mut Report,
    volume: &mut Option<Exact>,
) -> ControlFlow<()> {
    let (complex, alpha) = (claim.placed.complex, claim.placed.alpha);
    let points = Points::of(claim.placed);
    let whole = claim.extent == Extent::Whole;
    let rows = structure::rows(complex, points.len());
    let bad_rows = !rows.is_empty();
    report(rows)?;
    if bad_rows {
        return ControlFlow::Break(());
    }
    if whole && complex.cells.is_empty() {
        let apexes = auxiliary_positions(points.positions.iter().copied()).unwrap_or_default();
        if let Some(cone) = Cone::over(complex, points, &apexes) {
            return flat(claim, &cone, report);
        }
        report(vec![Finding::NoCells])?;
        return ControlFlow::Break(());
    }
    let (sum, exponent) = hull::six_volumes(complex.cells.rows(), points);
    *volume = Some(Exact::integer(sum, exponent));

    let (kept, equal) = non_vertices::kept_points(points, complex, claim.duplicates);
    report(equal)?;
    let emptiness = (!whole).then(|| Emptiness::new(points, alpha, &kept));
    let extent = claim.extent;
    let judge = Judge { points, alpha, extent, dimension: 3, emptiness: emptiness.as_ref() };
    let listed = Linked::new(complex, points, extent);
    let missing = gaps::missing_cells(&listed.structure, points, alpha, judge.emptiness);
    if !missing.is_empty() {
        let filled = gaps::filled(complex, &missing);
        let filled = Linked::new(&filled, points, extent);
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
            return apply_to(filled, claim, &judge, &kept, &mut lasting);
        }
    }
    apply_to(listed, claim, &judge, &kept, report)
}

/// Applies the rules after those on rows.
fn apply_to(
    linked: Linked,
    claim: &Claim,
    judge: &Judge,
    kept: &[u32],
    report: &mut Report,
) -> ControlFlow<()> {
    let regular = linked.is_regular();
    let Linked { structure, broken, irregular } = linked;
    let points = judge.points;
    let (wrong, tied) = (Cell::new(!regular), Cell::new(false));
    let mut report = |findings: Vec<Finding>| {
        wrong.set(wrong.get() || findings.iter().any(|finding| !finding.is_tie()));
        tied.set(tied.get() || findings.iter().any(Finding::is_tie));
        report(findings)
    };
    report(broken)?;
    if claim.extent == Extent::Whole {
        report(hull::volume(&structure, points))?;
    }
    report(irregular)?;
    report(non_vertices::duplicates(&structure, kept, claim.duplicates))?;
    if let Some(emptiness) = judge.emptiness {
        report(non_vertices::of_shape(&structure, emptiness, kept, claim))?;
    } else {
        report(non_vertices::of_whole(&structure, kept, claim))?;
        if regular {
            let hidden = non_vertices::hidden(&structure, kept);
            report(non_vertices::hiddenness(&structure, points, &hidden))?;
        }
    }
    report(classes::judge(&structure, judge))?;
    if let (Some(emptiness), false) = (judge.emptiness, wrong.get()) {
        let (singular, mut found) = ties::singular(&structure, points, emptiness);
        if tied.get() || found.iter().any(Finding::is_tie) {
            found.extend(ties::cells(&structure, points, emptiness, &singular));
        }
        report(found)?;
    }
    if regular { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}

/// Applies the rules to a whole triangulation of points that span no volume: those on cells to a cone over it.
fn flat(claim: &Claim, cone: &Cone, report: &mut Report) -> ControlFlow<()> {
    let complex = claim.placed.complex;
    let points = Points::of(claim.placed);
    let (kept, equal) = non_vertices::kept_points(points, complex, claim.duplicates);
    report(equal)?;
    let linked = Linked::new(&cone.complex, cone.points(), Extent::Whole);
    let regular = linked.is_regular();
    let (structure, repeated) = structure::Structure::new(complex, points);
    let mut broken = cone.at_base(linked.broken);
    broken.extend(cone.at_base(hull::volume(&linked.structure, cone.points())));
    broken.extend(cone.at_base(linked.irregular));
    let repeated = repeated.into_iter().filter(|finding| !broken.contains(finding)).collect();
    report(broken)?;
    report(repeated)?;
    report(non_vertices::duplicates(&structure, &kept, claim.duplicates))?;
    report(non_vertices::of_whole(&structure, &kept, claim))?;
    if regular {
        let hidden = non_vertices::hidden(&structure, &kept);
        let found = non_vertices::hiddenness(&linked.structure, cone.points(), &hidden);
        report(cone.at_base(found))?;
    }
    let judge = Judge {
        points,
        alpha: claim.placed.alpha,
        extent: Extent::Whole,
        dimension: cone.dimension,
        emptiness: None,
    };
    report(classes::judge(&structure, &judge))?;
    if regular { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}
