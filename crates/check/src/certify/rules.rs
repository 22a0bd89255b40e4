//! The rules in their order, and which of them are skipped once others are broken.

use std::cell::Cell;
use std::collections::BTreeSet;

use walpha_base::{Cancelled, Monitor};

use super::classes::{self, Judge};
use super::emptiness::Emptiness;
use super::flat::Cone;
use super::linked::Linked;
use super::structure;
use super::{Claim, Extent, Finding, Points, gaps, hull, non_vertices, ties};
use crate::exact::Exact;
use crate::flat::auxiliary_positions;

/// Why rules are left out.
pub(super) enum Stop {
    /// The visitor breaks, or a rule is broken without which others mean nothing.
    Enough,
    Cancelled(Cancelled),
}

impl From<Cancelled> for Stop {
    fn from(cancelled: Cancelled) -> Self {
        Self::Cancelled(cancelled)
    }
}

/// Takes the findings of a rule; stops when the visitor wants no more.
type Report<'r> = dyn FnMut(Vec<Finding>) -> Result<(), Stop> + 'r;

/// Applies all rules in turn, until one of the reasons to stop. The parts of the work take about as long as they are
/// large.
pub(super) fn apply(
    claim: &Claim,
    report: &mut Report,
    volume: &mut Option<Exact>,
    monitor: &Monitor,
) -> Result<(), Stop> {
    let (complex, alpha) = (claim.placed.complex, claim.placed.alpha);
    let points = Points::of(claim.placed);
    let whole = claim.extent == Extent::Whole;
    let rows = structure::rows(complex, points.len());
    let bad_rows = !rows.is_empty();
    report(rows)?;
    if bad_rows {
        return Err(Stop::Enough);
    }
    if whole && complex.cells.is_empty() {
        let apexes = auxiliary_positions(points.positions.iter().copied()).unwrap_or_default();
        if let Some(cone) = Cone::over(complex, points, &apexes) {
            return flat(claim, &cone, report, monitor);
        }
        report(vec![Finding::NoCells])?;
        return Err(Stop::Enough);
    }
    // Ends of parts, of 20: volume, links and neighbours, gaps.
    let [summed, linked, searched] = if whole { [3, 10, 11] } else { [1, 5, 12] };
    let cells = complex.cells.rows();
    let (sum, exponent) = hull::six_volumes(cells, points, &monitor.part(0, summed, 20))?;
    *volume = Some(Exact::integer(sum, exponent));

    let (kept, equal) = non_vertices::kept_points(points, complex, claim.duplicates);
    report(equal)?;
    let emptiness = (!whole).then(|| Emptiness::new(points, alpha, &kept));
    let extent = claim.extent;
    let judge = Judge { points, alpha, extent, dimension: 3, emptiness: emptiness.as_ref() };
    let listed = Linked::new(complex, points, extent, &monitor.part(summed, linked, 20))?;
    let gaps = &monitor.part(linked, searched, 20);
    let missing = gaps::missing_cells(&listed.structure, points, alpha, judge.emptiness, gaps)?;
    let rest = monitor.part(searched, 20, 20);
    if !missing.is_empty() {
        let filled = gaps::filled(complex, &missing);
        let filled = Linked::new(&filled, points, extent, &rest.part(0, 1, 3))?;
        if filled.is_regular() {
            report(gaps::findings(&missing, points))?;
            // Classes around a gap may be right without its cell, or with it.
            let wrong = classes::judge(&listed.structure, &judge, &rest.part(1, 2, 3))?;
            let wrong: BTreeSet<_> = wrong.iter().filter_map(Finding::judged_class).collect();
            let in_both = |finding: &Finding| {
                finding.judged_class().is_none_or(|simplex| wrong.contains(simplex))
            };
            let mut lasting =
                |findings: Vec<Finding>| report(findings.into_iter().filter(in_both).collect());
            let rest = rest.part(2, 3, 3);
            return apply_to(filled, claim, &judge, &kept, &mut lasting, &rest);
        }
    }
    apply_to(listed, claim, &judge, &kept, report, &rest)
}

/// Applies the rules after those on rows.
fn apply_to(
    linked: Linked,
    claim: &Claim,
    judge: &Judge,
    kept: &[u32],
    report: &mut Report,
    monitor: &Monitor,
) -> Result<(), Stop> {
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
        report(hull::volume(&structure, points, &monitor.part(0, 3, 10))?)?;
    }
    report(irregular)?;
    report(non_vertices::duplicates(&structure, kept, claim.duplicates))?;
    if let Some(emptiness) = judge.emptiness {
        report(non_vertices::of_shape(
            &structure,
            emptiness,
            kept,
            claim,
            &monitor.part(0, 1, 10),
        )?)?;
    } else {
        report(non_vertices::of_whole(&structure, kept, claim))?;
        if regular {
            let hidden = non_vertices::hidden(&structure, kept);
            let monitor = monitor.part(3, 4, 10);
            report(non_vertices::hiddenness(&structure, points, &hidden, &monitor)?)?;
        }
    }
    let judging =
        if judge.emptiness.is_none() { monitor.part(4, 10, 10) } else { monitor.part(1, 6, 10) };
    report(classes::judge(&structure, judge, &judging)?)?;
    if let (Some(emptiness), false) = (judge.emptiness, wrong.get()) {
        let (singular, mut found) =
            ties::singular(&structure, points, emptiness, &monitor.part(6, 8, 10))?;
        if tied.get() || found.iter().any(Finding::is_tie) {
            let monitor = monitor.part(8, 10, 10);
            found.extend(ties::cells(&structure, points, emptiness, &singular, &monitor)?);
        }
        report(found)?;
    }
    if regular { Ok(()) } else { Err(Stop::Enough) }
}

/// Applies the rules to a whole triangulation of points that span no volume: those on cells to a cone over it.
fn flat(claim: &Claim, cone: &Cone, report: &mut Report, monitor: &Monitor) -> Result<(), Stop> {
    let complex = claim.placed.complex;
    let points = Points::of(claim.placed);
    let (kept, equal) = non_vertices::kept_points(points, complex, claim.duplicates);
    report(equal)?;
    let linked = Linked::new(&cone.complex, cone.points(), Extent::Whole, &monitor.part(0, 4, 10))?;
    let regular = linked.is_regular();
    let (structure, repeated) =
        structure::Structure::new(complex, points, &monitor.part(4, 5, 10))?;
    let mut broken = cone.at_base(linked.broken);
    broken.extend(cone.at_base(hull::volume(
        &linked.structure,
        cone.points(),
        &monitor.unreported(),
    )?));
    broken.extend(cone.at_base(linked.irregular));
    let repeated = repeated.into_iter().filter(|finding| !broken.contains(finding)).collect();
    report(broken)?;
    report(repeated)?;
    report(non_vertices::duplicates(&structure, &kept, claim.duplicates))?;
    report(non_vertices::of_whole(&structure, &kept, claim))?;
    if regular {
        let hidden = non_vertices::hidden(&structure, &kept);
        let (cells, points) = (&linked.structure, cone.points());
        let monitor = monitor.part(5, 6, 10);
        let found = non_vertices::hiddenness(cells, points, &hidden, &monitor)?;
        report(cone.at_base(found))?;
    }
    let judge = Judge {
        points,
        alpha: claim.placed.alpha,
        extent: Extent::Whole,
        dimension: cone.dimension,
        emptiness: None,
    };
    report(classes::judge(&structure, &judge, &monitor.part(6, 10, 10))?)?;
    if regular { Ok(()) } else { Err(Stop::Enough) }
}
