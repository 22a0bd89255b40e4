//! Certification: judging a complex that some engine or program made, without making one.

mod certificate;
mod classes;
mod emptiness;
mod filtration;
mod finding;
mod gaps;
mod geometry;
mod hull;
mod index;
mod message;
mod near;
mod places;
mod points;
mod structure;

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use super::exact::Exact;
use crate::memory;
use crate::shape::{Class, Complex};
use classes::Judge;
use emptiness::Emptiness;
use points::Points;
use structure::Structure;

pub use certificate::{Certificate, NotCertifiable, NotJudged};
pub use filtration::{
    Bound, FiltrationCertificate, FiltrationFinding, NotAFiltration, Unjudged, certify_filtration,
};
pub use finding::{Finding, Simplex};

/// How much a complex claims to hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// The whole regular triangulation, with the simplices that are not in the shape.
    Whole,
    /// The shape alone.
    Shape,
}

impl Extent {
    /// Whole if there is an exterior simplex, or if α = ∞, where all of the triangulation is in
    /// the shape.
    pub fn of(complex: &Complex, alpha: f64) -> Self {
        let exterior = complex.cells.classes.contains(&Class::Exterior)
            || complex.facets.classes.contains(&Class::Exterior)
            || complex.edges.classes.contains(&Class::Exterior)
            || complex.vertices.classes.contains(&Class::Exterior);
        if exterior || alpha == f64::INFINITY { Self::Whole } else { Self::Shape }
    }
}

/// A complex and what it claims to be: the α-complex of weighted points.
#[derive(Clone, Copy, Debug)]
pub struct Claim<'a> {
    /// x, y, z of each input point.
    pub positions: &'a [[f64; 3]],
    /// The power weight of each, a squared length.
    pub weights: &'a [f64],
    /// α, a squared length, or ±∞.
    pub alpha: f64,
    /// The complex, by input indices.
    pub complex: &'a Complex,
    /// How much of the triangulation the complex lists.
    pub extent: Extent,
    /// The points listed as hidden, if they are listed.
    pub hidden: Option<&'a [u32]>,
    /// Pairs (went, stayed) of points at one place, if they are listed.
    pub duplicates: Option<&'a [[u32; 2]]>,
}

/// A side of a cell is numbered by 4 · cell + 0..4 in 32 bits.
const MOST: usize = (u32::MAX / 4) as usize;

impl<'a> Claim<'a> {
    /// Whether every rule that can be judged holds.
    ///
    /// # Errors
    /// [`NotCertifiable`].
    pub fn is_valid(&self) -> Result<bool, NotCertifiable> {
        Ok(self.first_finding()?.is_none())
    }

    /// The first broken rule.
    ///
    /// # Errors
    /// [`NotCertifiable`].
    pub fn first_finding(&self) -> Result<Option<Finding>, NotCertifiable> {
        let mut first = None;
        self.visit(&mut |finding| {
            first = Some(finding);
            ControlFlow::Break(())
        })?;
        Ok(first)
    }

    /// All broken rules, and what was judged.
    ///
    /// # Errors
    /// [`NotCertifiable`].
    pub fn findings(&self) -> Result<(Vec<Finding>, Certificate), NotCertifiable> {
        let mut all = Vec::new();
        let certificate = self.visit(&mut |finding| {
            all.push(finding);
            ControlFlow::Continue(())
        })?;
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
    ///    alone, by no point nearby;
    /// 5. the hull is convex, goes around once, and the cells' volumes add up to what it
    ///    encloses (whole triangulations only);
    /// 6. no point is more than one of vertex, hidden and duplicate, and each is one of them (in a
    ///    shape alone: each that has no other inside or on its sphere is a vertex);
    /// 7. every class is what the definition says, and regular facets turn counter-clockwise seen
    ///    from outside.
    ///
    /// Rules that mean nothing once others are broken are not applied then; the certificate says
    /// so.
    ///
    /// Findings come in the same order on any number of threads. In a shape alone, cost also
    /// grows with the number of points within √(α + largest weight) of a simplex.
    ///
    /// # Errors
    /// [`NotCertifiable`].
    pub fn visit(
        &self,
        visitor: &mut dyn FnMut(Finding) -> ControlFlow<()>,
    ) -> Result<Certificate, NotCertifiable> {
        self.sane()?;
        let mut certificate =
            Certificate { findings: 0, six_volumes: Exact::default(), not_judged: Vec::new() };
        if self.extent == Extent::Shape {
            let local =
                [NotJudged::MissingSimplices, NotJudged::TiedSingular, NotJudged::HiddenAndHull];
            certificate.not_judged.extend(local);
        }
        if self.duplicates.is_none() {
            certificate.not_judged.push(NotJudged::Duplicates);
        }
        let mut report = |findings: Vec<Finding>| {
            findings.into_iter().try_for_each(|finding| {
                certificate.findings += 1;
                visitor(finding)
            })
        };
        let mut volume = None;
        let all_rules = self.run(&mut report, &mut volume).is_continue();
        certificate.six_volumes = volume.unwrap_or_default();
        if !all_rules {
            certificate.not_judged.push(NotJudged::AfterFindings);
        }
        Ok(certificate)
    }

    /// Applies all rules in turn. Breaks if the visitor does, or if a rule is broken without which
    /// others mean nothing.
    fn run(
        &self,
        report: &mut dyn FnMut(Vec<Finding>) -> ControlFlow<()>,
        volume: &mut Option<Exact>,
    ) -> ControlFlow<()> {
        let points = Points { positions: self.positions, weights: self.weights };
        let whole = self.extent == Extent::Whole;
        let rows = structure::rows(self.complex, points.len());
        let bad_rows = !rows.is_empty();
        report(rows)?;
        if whole && self.complex.cells.is_empty() {
            report(vec![Finding::NoCells])?;
            return ControlFlow::Break(());
        }
        if bad_rows {
            return ControlFlow::Break(());
        }
        let (sum, exponent) = hull::six_volumes(&self.complex.cells.vertices, points);
        *volume = Some(Exact::integer(sum, exponent));

        let stays = places::staying(points);
        let emptiness = (!whole).then(|| Emptiness::new(points, self.alpha, &stays));
        let emptiness = emptiness.as_ref();
        let judge = Judge { points, alpha: self.alpha, extent: self.extent, emptiness };
        let listed = Judged::new(self.complex, &judge);
        let missing = gaps::missing_cells(&listed.structure, points, self.alpha, emptiness);
        if !missing.is_empty() {
            let filled = gaps::filled(self.complex, &missing);
            let filled = Judged::new(&filled, &judge);
            if filled.broken.is_empty() && filled.unlike.is_empty() {
                report(gaps::findings(&missing, points))?;
                // Classes around a gap may be right without its cell, or with it.
                let wrong = classes::judge(&listed.structure, &judge);
                let wrong: BTreeSet<_> = wrong.iter().filter_map(Finding::judged_class).collect();
                let in_both = |finding: &Finding| {
                    finding.judged_class().is_none_or(|simplex| wrong.contains(simplex))
                };
                let mut lasting =
                    |findings: Vec<Finding>| report(findings.into_iter().filter(in_both).collect());
                return self.apply(filled, &judge, &stays, &mut lasting);
            }
        }
        self.apply(listed, &judge, &stays, report)
    }

    /// The rules after those on rows.
    fn apply(
        &self,
        Judged { structure, broken, unlike }: Judged,
        judge: &Judge,
        stays: &[u32],
        report: &mut dyn FnMut(Vec<Finding>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let points = judge.points;
        let regular = broken.is_empty() && unlike.is_empty();
        report(broken)?;
        if self.extent == Extent::Whole {
            report(hull::volume(&structure, points))?;
        }
        report(unlike)?;
        report(places::duplicates(&structure, stays, self.duplicates))?;
        match judge.emptiness {
            Some(emptiness) => report(places::of_shape(
                &structure,
                points,
                self.alpha,
                emptiness,
                stays,
                self.hidden,
            ))?,
            None => {
                let (hidden, findings) = places::hidden(&structure, stays, self.hidden);
                report(findings)?;
                if regular {
                    report(places::hiddenness(&structure, points, &hidden))?;
                }
            }
        }
        report(classes::judge(&structure, judge))?;
        if regular { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }

    fn sane(&self) -> Result<(), NotCertifiable> {
        let Self { positions, weights, complex, .. } = self;
        if positions.len() != weights.len() {
            let (positions, weights) = (positions.len(), weights.len());
            return Err(NotCertifiable::Lengths { positions, weights });
        }
        let listed = [
            (complex.vertices.vertices.len(), complex.vertices.classes.len()),
            (complex.edges.vertices.len(), complex.edges.classes.len()),
            (complex.facets.vertices.len(), complex.facets.classes.len()),
            (complex.cells.vertices.len(), complex.cells.classes.len()),
        ];
        for (dimension, (simplices, classes)) in listed.into_iter().enumerate() {
            if simplices != classes {
                return Err(NotCertifiable::Classes { dimension, simplices, classes });
            }
        }
        let most = positions.len().max(complex.cells.len());
        if most > MOST {
            return Err(NotCertifiable::TooMany(most));
        }
        if self.alpha.is_nan() {
            return Err(NotCertifiable::AlphaNan);
        }
        let finite = |i: &usize| positions[*i].iter().chain([&weights[*i]]).all(|x| x.is_finite());
        match (0..positions.len()).find(|i| !finite(i)) {
            Some(index) => Err(NotCertifiable::NotFinite(index)),
            None => Ok(memory::afford(Structure::bytes(complex), || {
                format!("the check of {} cells", complex.cells.len())
            })?),
        }
    }
}

/// How a complex hangs together, and which rules of structure and geometry it breaks.
struct Judged<'a> {
    structure: Structure<'a>,
    /// Rules without which the others mean nothing.
    broken: Vec<Finding>,
    /// Neighbours and hull, if nothing is broken.
    unlike: Vec<Finding>,
}

impl<'a> Judged<'a> {
    fn new(complex: &'a Complex, judge: &Judge) -> Self {
        let points = judge.points;
        let (structure, mut broken) = Structure::new(complex, points);
        broken.extend(geometry::orientations(&complex.cells.vertices, points));
        let mut unlike = Vec::new();
        if broken.is_empty() {
            unlike.extend(geometry::neighbours(&structure, points));
            if judge.extent == Extent::Whole {
                unlike.extend(hull::convexity(&structure, points));
            }
        }
        Self { structure, broken, unlike }
    }
}
