//! Judges a claim: the rules in order, the rules that are skipped after others are broken, and the verdict.

use std::cell::Cell;
use std::collections::BTreeSet;
use std::ops::ControlFlow;

use dashu_int::IBig;
use walpha_base::memory::asking;
use walpha_base::{Cancelled, Monitor};

use super::certificate::{Certificate, CertifyError, NotJudged, Verdict};
use super::claim::{Claim, Extent};
use super::classes::{self, Judge};
use super::emptiness::Emptiness;
use super::finding::Finding;
use super::flat::Cone;
use super::gathered::gathered;
use super::geometry::{self, Boundary, Linked};
use super::spheres::Spheres;
use super::structure::{self, MAX_CELLS, Points, Structure};
use super::torus::Torus;
use super::{gaps, missing, non_vertices, ties};
use crate::exact::{Exact, WeightedPoint};
use crate::flat::auxiliary_positions;
use crate::{Complex, Placed};

impl Claim<'_> {
    /// Whether it is exact, valid or wrong, as far as it can be judged.
    ///
    /// # Errors
    /// [`CertifyError`].
    pub fn verdict(&self) -> Result<Verdict, CertifyError> {
        Ok(self.visit(&mut |_| ControlFlow::Continue(()))?.verdict)
    }

    /// The first finding: a broken rule, or a choice among ties other than the rule's.
    ///
    /// # Errors
    /// [`CertifyError`].
    pub fn first_finding(&self) -> Result<Option<Finding>, CertifyError> {
        let mut first = None;
        self.visit(&mut |finding| {
            first = Some(finding);
            ControlFlow::Break(())
        })?;
        Ok(first)
    }

    /// All broken rules, [ties](Finding::is_tie) that do not follow the rule, and the certificate.
    ///
    /// # Errors
    /// [`CertifyError`].
    pub fn findings(&self) -> Result<(Vec<Finding>, Certificate), CertifyError> {
        let monitor = &*Monitor::current();
        self.findings_on(None, monitor)
    }

    /// The findings. If `torus` is given, the complex is its unwrapped one, and only findings that involve a vertex inside the
    /// box are kept.
    pub(super) fn findings_on(
        &self,
        torus: Option<Torus>,
        monitor: &Monitor,
    ) -> Result<(Vec<Finding>, Certificate), CertifyError> {
        let mut all = Vec::new();
        let mut fits = true;
        let visitor = &mut |finding| {
            fits = asking(|| all.try_reserve(1)).is_ok();
            if fits {
                all.push(finding);
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        };
        let certificate = self.visit_on(torus, visitor, monitor)?;
        if fits {
            Ok((all, certificate))
        } else {
            let (cells, bytes) = (self.placed.complex.cells.len(), 2 * size_of_val(&*all));
            Err(CertifyError::Memory { cells, bytes })
        }
    }

    /// Judges the complex, and passes each finding to `visitor` until it breaks.
    ///
    /// The rules, each exact and each linear in the number of simplices (up to sorting):
    /// 1. rows name distinct input points, and no simplex is listed twice;
    /// 2. every face of a simplex is listed, so is each cell that has all its faces listed, and in
    ///    a whole triangulation nothing else is;
    /// 3. cells are positively oriented; a facet has at most two cells, one on each side;
    /// 4. no cell is refuted by its neighbours' vertices, by the perturbed power test; in a shape
    ///    alone, by no point nearby, and the cells listed on a sphere with more points fit together;
    /// 5. the hull is convex, goes around once, and the cells' volumes add up to what it
    ///    encloses (whole triangulations only);
    /// 6. no point is more than one of vertex, hidden and duplicate, and each is one of them (in a
    ///    shape alone: each that has no other inside or on its sphere is a vertex);
    /// 7. no simplex of a shape alone is missing, as far as it [claims](Claim::lowest) to list all of them;
    /// 8. every class is what the definition says, and regular facets turn counter-clockwise seen
    ///    from outside.
    ///
    /// Points that span no volume are judged in their plane, on their line, or as a single point: a whole triangulation then has
    /// no cells, and the rules on cells apply to its largest simplices.
    ///
    /// Rules that have no meaning after others are broken are then not applied; the certificate says so. A choice that departs
    /// only from the tie rule is a finding, too, and [is a tie](Finding::is_tie).
    ///
    /// Findings come in the same order on any number of threads. In a shape alone, cost also
    /// grows with the number of points within √(α + largest weight) of a simplex.
    ///
    /// # Errors
    /// [`CertifyError`].
    pub fn visit(
        &self,
        visitor: &mut dyn FnMut(Finding) -> ControlFlow<()>,
    ) -> Result<Certificate, CertifyError> {
        let monitor = &*Monitor::current();
        self.visit_on(None, visitor, monitor)
    }

    fn visit_on(
        &self,
        torus: Option<Torus>,
        visitor: &mut dyn FnMut(Finding) -> ControlFlow<()>,
        monitor: &Monitor,
    ) -> Result<Certificate, CertifyError> {
        self.check()?;
        let mut rest = monitor.part(0, 10, 10);
        if torus.is_none()
            && let Some(gathered) = gathered(self)
        {
            let claim = gathered.claim().with_extent(self.extent);
            let certificate =
                claim.judged(None, &mut |_| ControlFlow::Break(()), &monitor.part(0, 9, 10))?;
            if certificate.findings == 0 {
                monitor.report(10, 10)?;
                return Ok(certificate);
            }
            rest = monitor.part(9, 10, 10);
        }
        self.judged(torus, visitor, &rest)
    }

    /// Judges the complex with its points in their given order.
    fn judged(
        &self,
        torus: Option<Torus>,
        visitor: &mut dyn FnMut(Finding) -> ControlFlow<()>,
        monitor: &Monitor,
    ) -> Result<Certificate, CertifyError> {
        let mut certificate = Certificate {
            verdict: Verdict::Exact,
            findings: 0,
            ties: 0,
            six_volumes: Exact::default(),
            not_judged: Vec::new(),
        };
        if self.extent == Extent::Shape {
            certificate
                .not_judged
                .extend((self.lowest > 0).then_some(NotJudged::SingularSimplices));
            certificate.not_judged.push(NotJudged::HiddenAndHull);
        }
        if self.duplicates.is_none() {
            certificate.not_judged.push(NotJudged::Duplicates);
        }
        let mut report = |findings: Vec<Finding>| {
            near_box(torus, findings).into_iter().try_for_each(|finding| {
                certificate.findings += 1;
                certificate.ties += usize::from(finding.is_tie());
                if visitor(finding).is_break() { Err(Stop::Enough) } else { Ok(()) }
            })
        };
        let mut volume = None;
        let rules = apply(self, torus, &mut report, &mut volume, &monitor.part(0, 99, 100));
        let not_judged = match rules {
            Ok(not_judged) => not_judged,
            Err(Stop::Enough) => Some(NotJudged::AfterFindings),
            Err(Stop::Cancelled(cancelled)) => return Err(cancelled.into()),
        };
        monitor.part(99, 100, 100).report(1, 1)?;
        certificate.six_volumes = volume.unwrap_or_default();
        certificate.not_judged.extend(not_judged);
        certificate.conclude();
        Ok(certificate)
    }

    pub(super) fn check(&self) -> Result<(), CertifyError> {
        let Placed { positions, weights, complex, .. } = self.placed;
        if positions.len() != weights.len() {
            let (positions, weights) = (positions.len(), weights.len());
            return Err(CertifyError::Lengths { positions, weights });
        }
        let most = positions.len().max(complex.cells.len());
        if most > MAX_CELLS {
            return Err(CertifyError::TooMany(most));
        }
        let finite = |i: &usize| positions[*i].iter().chain([&weights[*i]]).all(|x| x.is_finite());
        if let Some(index) = (0..positions.len()).find(|i| !finite(i)) {
            return Err(CertifyError::NotFinite(index));
        }
        // For a shape alone there are also two grids, each with approximately this number of bytes.
        let copies = if self.extent == Extent::Shape { 3 } else { 1 };
        afford(complex, copies * positions.len())
    }
}

/// Checks that the memory which the judgement allocates piece by piece is available, including that for copies of points: it is
/// better to fail now than halfway.
fn afford(complex: &Complex, copies: usize) -> Result<(), CertifyError> {
    let bytes = Structure::bytes(complex) + copies * size_of::<WeightedPoint>();
    let cells = complex.cells.len();
    asking(|| Vec::<u8>::new().try_reserve_exact(bytes))
        .map_err(|_| CertifyError::Memory { cells, bytes })
}

/// Why the remaining rules are not applied.
enum Stop {
    /// The visitor needs no more findings, or a rule is broken on which the others depend.
    Enough,
    Cancelled(Cancelled),
}

impl From<Cancelled> for Stop {
    fn from(cancelled: Cancelled) -> Self {
        Self::Cancelled(cancelled)
    }
}

/// Takes the findings of a rule; stops when the visitor needs no more.
type Report<'r> = dyn FnMut(Vec<Finding>) -> Result<(), Stop> + 'r;

/// Keeps the findings for simplices that touch the box of a torus; in space, all.
fn near_box(torus: Option<Torus>, mut findings: Vec<Finding>) -> Vec<Finding> {
    if let Some(torus) = torus {
        findings.retain(|finding| finding.clone().at_box(torus.points).is_some());
    }
    findings
}

/// Applies the rules in turn, and returns the parts that were not judged. The monitor's parts are shares of the time of each
/// rule.
fn apply(
    claim: &Claim,
    torus: Option<Torus>,
    report: &mut Report,
    volume: &mut Option<Exact>,
    monitor: &Monitor,
) -> Result<Option<NotJudged>, Stop> {
    let (complex, alpha) = (claim.placed.complex, claim.placed.alpha);
    let sites = structure::sites(claim.placed.positions, claim.placed.weights);
    let points = Points { sites: &sites };
    let whole = claim.extent == Extent::Whole;
    let rows = structure::rows(complex, points.len());
    let bad_rows = !rows.is_empty();
    report(rows)?;
    if bad_rows {
        return Err(Stop::Enough);
    }
    if whole && torus.is_none() && complex.cells.is_empty() {
        let apexes = auxiliary_positions(points.positions()).unwrap_or_default();
        if let Some(cone) = Cone::over(complex, points, &apexes) {
            return flat(claim, points, &cone, report, monitor);
        }
        report(vec![Finding::NoCells])?;
        return Err(Stop::Enough);
    }
    let (kept, equal) = non_vertices::kept_points(points, complex, claim.duplicates);
    let largest = torus.map_or(f64::INFINITY, |torus| torus.largest_empty);
    let distinct = || non_vertices::distinct(&kept).collect();
    let emptiness = (!whole).then(|| Emptiness::new(points, alpha, largest, distinct()));
    let boundary = match (claim.extent, torus) {
        (Extent::Shape, _) => Boundary::Any,
        (Extent::Whole, None) => Boundary::Hull,
        // The boundary is judged where the points of the box are known.
        (Extent::Whole, Some(torus)) if torus.has_hull() => Boundary::Any,
        (Extent::Whole, Some(torus)) => Boundary::NoneAt { box_points: torus.points },
    };
    let judge = Judge {
        points,
        alpha,
        extent: claim.extent,
        dimension: 3,
        emptiness: emptiness.as_ref(),
        torus,
    };
    // Ends of parts, of 20: links and neighbours, volume, gaps.
    let [linked, summed, searched] = if whole { [7, 10, 11] } else { [4, 5, 12] };
    let listed = Linked::new(complex, points, boundary, &monitor.part(0, linked, 20))?;
    let summing = monitor.part(linked, summed, 20);
    // In a whole triangulation, the sum of all cells is a second proof that they fit together.
    let of_cells = if whole {
        geometry::six_volumes(complex.cells.rows(), points, &summing)?
    } else {
        geometry::six_volumes_linked(&listed, points, &summing)?
    };
    *volume = Some(Exact::integer(of_cells.0.clone(), of_cells.1));
    report(equal)?;
    let gaps = &monitor.part(summed, searched, 20);
    let missing = gaps::missing_cells(&listed.structure, points, alpha, judge.emptiness, gaps)?;
    let rest = monitor.part(searched, 20, 20);
    // Cells that could be missing overlap if one has points on its sphere, and parts of it could be missing, too. Those that the
    // tie rule makes do not overlap.
    let by_rule = gaps::by_rule(&missing, judge.emptiness);
    let choices = [missing, by_rule].into_iter().filter(|missing| !missing.is_empty());
    for (part, missing) in (0..).zip(choices) {
        let filled = gaps::filled(complex, &missing);
        let filled = Linked::new(&filled, points, boundary, &rest.part(part, part + 1, 6))?;
        if !filled.is_regular() {
            continue;
        }
        report(gaps::findings(&missing, points))?;
        // Classes around a gap may be right without its cell, or with it.
        let wrong = classes::judge(&listed.structure, &judge, false, &rest.part(2, 4, 6))?;
        let wrong: BTreeSet<_> = wrong.iter().filter_map(Finding::judged_class).collect();
        let in_both = |finding: &Finding| {
            finding.judged_class().is_none_or(|simplex| wrong.contains(simplex))
        };
        // Only of a whole triangulation are volumes judged.
        let of_cells = if whole {
            let cells = filled.structure.complex.cells.rows();
            geometry::six_volumes(cells, points, &rest.unreported())?
        } else {
            of_cells
        };
        let monitor = rest.part(4, 6, 6);
        return apply_to((filled, of_cells), claim, &judge, &kept, &in_both, report, &monitor);
    }
    apply_to((listed, of_cells), claim, &judge, &kept, &|_| true, report, &rest)
}

/// Applies the rules after those on rows. Six times the volume of the cells is given. Only findings with `lasts` count.
fn apply_to(
    (linked, of_cells): (Linked, (IBig, i64)),
    claim: &Claim,
    judge: &Judge,
    kept: &[u32],
    lasts: &dyn Fn(&Finding) -> bool,
    report: &mut Report,
    monitor: &Monitor,
) -> Result<Option<NotJudged>, Stop> {
    let regular = linked.is_regular();
    let Linked { structure, broken, irregular } = linked;
    let untied = broken.is_empty() && irregular.is_empty();
    let points = judge.points;
    let (wrong, lasting, tied) = (Cell::new(!regular), Cell::new(!regular), Cell::new(false));
    let mut report = |findings: Vec<Finding>| {
        let mut findings = near_box(judge.torus, findings);
        let is_wrong = |findings: &[Finding]| findings.iter().any(|finding| !finding.is_tie());
        wrong.set(wrong.get() || is_wrong(&findings));
        findings.retain(lasts);
        lasting.set(lasting.get() || is_wrong(&findings));
        tied.set(tied.get() || findings.iter().any(Finding::is_tie));
        report(findings)
    };
    report(broken)?;
    if claim.extent == Extent::Whole && judge.torus.is_none() {
        report(geometry::volume(&structure, points, of_cells, &monitor.part(0, 1, 10))?)?;
    }
    report(irregular)?;
    report(non_vertices::duplicates(&structure, kept, claim.duplicates))?;
    if judge.emptiness.is_some() {
        report(non_vertices::of_shape(&structure, kept, claim))?;
    } else {
        report(non_vertices::of_whole(&structure, kept, claim))?;
        if regular {
            let hidden = non_vertices::hidden(&structure, kept);
            let monitor = monitor.part(1, 3, 10);
            let judge = match judge.torus {
                Some(_) => non_vertices::hiddenness_in_cells,
                None => non_vertices::hiddenness,
            };
            report(judge(&structure, points, &hidden, &monitor)?)?;
        }
    }
    let judging =
        if judge.emptiness.is_none() { monitor.part(3, 10, 10) } else { monitor.part(1, 6, 10) };
    report(classes::judge(&structure, judge, untied, &judging)?)?;
    let Some(emptiness) = judge.emptiness else {
        return if regular { Ok(None) } else { Err(Stop::Enough) };
    };
    if !wrong.get() {
        let (singular, mut found) =
            ties::singular(&structure, points, emptiness, &monitor.part(6, 7, 10))?;
        if tied.get() || found.iter().any(Finding::is_tie) {
            let monitor = monitor.part(7, 8, 10);
            found.extend(ties::cells(&structure, points, emptiness, &singular, &monitor)?);
        }
        report(found)?;
    }
    if lasting.get() {
        return Err(Stop::Enough);
    }
    let search = missing::Search {
        structure: &structure,
        spheres: Spheres { points, alpha: judge.alpha, emptiness },
        torus: judge.torus,
        lowest: claim.lowest,
        most_pairs: missing::MOST_PAIRS,
    };
    match search.findings(kept, &monitor.part(8, 10, 10))? {
        Ok(found) => report(found).map(|()| None),
        Err(declined) => Ok(Some(NotJudged::MissingSimplices(declined))),
    }
}

/// Applies the rules to a whole triangulation of points that span no volume: the rules on cells are applied to a cone over it.
fn flat(
    claim: &Claim,
    points: Points,
    cone: &Cone,
    report: &mut Report,
    monitor: &Monitor,
) -> Result<Option<NotJudged>, Stop> {
    let complex = claim.placed.complex;
    let (kept, equal) = non_vertices::kept_points(points, complex, claim.duplicates);
    report(equal)?;
    let linked =
        Linked::new(&cone.complex, cone.points(), Boundary::Hull, &monitor.part(0, 4, 10))?;
    let regular = linked.is_regular();
    let (structure, repeated) = Structure::new(complex, points, &monitor.part(4, 5, 10))?;
    let mut broken = cone.at_base(linked.broken);
    let unreported = monitor.unreported();
    let of_cells = geometry::six_volumes(cone.complex.cells.rows(), cone.points(), &unreported)?;
    let volume = geometry::volume(&linked.structure, cone.points(), of_cells, &unreported)?;
    broken.extend(cone.at_base(volume));
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
        torus: None,
    };
    report(classes::judge(&structure, &judge, false, &monitor.part(6, 10, 10))?)?;
    if regular { Ok(None) } else { Err(Stop::Enough) }
}
