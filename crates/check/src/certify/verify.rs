//! Judging a claim: whether it can be judged, the findings, and the verdict that follows from them.

use std::ops::ControlFlow;

use walpha_base::Monitor;

use super::rules::Stop;
use super::structure::{MAX_CELLS, Structure};
use super::{Certificate, CertifyError, Claim, Extent, Finding, NotJudged, Verdict, rules};
use crate::exact::Exact;
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

    /// All broken rules and [ties](Finding::is_tie) that are not decided by the rule, and the certificate.
    ///
    /// # Errors
    /// [`CertifyError`].
    pub fn findings(&self) -> Result<(Vec<Finding>, Certificate), CertifyError> {
        self.findings_monitored(&Monitor::noop())
    }

    /// The same, as one stage under a monitor, which can cancel it.
    ///
    /// # Errors
    /// [`CertifyError`].
    pub fn findings_monitored(
        &self,
        monitor: &Monitor,
    ) -> Result<(Vec<Finding>, Certificate), CertifyError> {
        let mut all = Vec::new();
        let visitor = &mut |finding| {
            all.push(finding);
            ControlFlow::Continue(())
        };
        let certificate = self.visit_monitored(visitor, monitor)?;
        Ok((all, certificate))
    }

    /// Judges the complex, handing each finding to `visitor` until it breaks.
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
    /// 7. every class is what the definition says, and regular facets turn counter-clockwise seen
    ///    from outside.
    ///
    /// Points that span no volume are judged in their plane, on their line, or as a single point:
    /// a whole triangulation then has no cells, and the rules on cells hold for its largest simplices.
    ///
    /// Rules that mean nothing once others are broken are then not applied; the certificate says
    /// so. A choice that departs only from the rule for ties is a finding, too, and [is a tie](Finding::is_tie).
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
        self.visit_monitored(visitor, &Monitor::noop())
    }

    /// The same, as one stage under a monitor, which can cancel it.
    ///
    /// # Errors
    /// [`CertifyError`].
    pub fn visit_monitored(
        &self,
        visitor: &mut dyn FnMut(Finding) -> ControlFlow<()>,
        monitor: &Monitor,
    ) -> Result<Certificate, CertifyError> {
        self.check()?;
        let mut certificate = Certificate {
            verdict: Verdict::Exact,
            findings: 0,
            ties: 0,
            six_volumes: Exact::default(),
            not_judged: Vec::new(),
        };
        if self.extent == Extent::Shape {
            certificate.not_judged.extend([NotJudged::MissingSimplices, NotJudged::HiddenAndHull]);
        }
        if self.duplicates.is_none() {
            certificate.not_judged.push(NotJudged::Duplicates);
        }
        let mut report = |findings: Vec<Finding>| {
            findings.into_iter().try_for_each(|finding| {
                certificate.findings += 1;
                certificate.ties += usize::from(finding.is_tie());
                if visitor(finding).is_break() { Err(Stop::Enough) } else { Ok(()) }
            })
        };
        let mut volume = None;
        let rules = rules::apply(self, &mut report, &mut volume, &monitor.part(0, 99, 100));
        let all_rules = match rules {
            Ok(()) => true,
            Err(Stop::Enough) => false,
            Err(Stop::Cancelled(cancelled)) => return Err(cancelled.into()),
        };
        monitor.part(99, 100, 100).report(1, 1)?;
        certificate.verdict = Verdict::of(certificate.findings, certificate.ties);
        certificate.six_volumes = volume.unwrap_or_default();
        if !all_rules {
            certificate.not_judged.push(NotJudged::AfterFindings);
        }
        Ok(certificate)
    }

    fn check(&self) -> Result<(), CertifyError> {
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
        match (0..positions.len()).find(|i| !finite(i)) {
            Some(index) => Err(CertifyError::NotFinite(index)),
            None => afford(complex),
        }
    }
}

/// Checks that the memory which the judgement takes piece by piece is available: it is better to fail now
/// than halfway.
fn afford(complex: &Complex) -> Result<(), CertifyError> {
    let bytes = Structure::bytes(complex);
    let cells = complex.cells.len();
    Vec::<u8>::new().try_reserve_exact(bytes).map_err(|_| CertifyError::Memory { cells, bytes })
}
