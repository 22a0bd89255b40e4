//! The rules on classes: the class that each simplex has by the definition, against the one it was given.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use rayon::prelude::*;
use walpha_base::{Cancelled, Monitor};
use walpha_complex::canonical::smallest_even;

use super::claim::Extent;
use super::emptiness::Emptiness;
use super::finding::Finding;
use super::structure::{Half, Index, NONE, Points, Structure};
use super::torus::Torus;
use crate::exact::{Side, collinear, orientation, power_value, radius, radius_value, side};
use crate::parallel::{of_each, one_for_each};
use crate::{Alpha, Class, Simplices};

/// Judges the classes of all simplices, that faces are listed, and that regular facets turn
/// outward. Below cells a simplex is interior when all its cofaces are, regular when it is a face
/// of a simplex of the shape, and singular when its own sphere has squared radius ≤ α and no
/// point strictly inside.
///
/// In a whole triangulation that was found regular, a sphere that contains any point contains a
/// neighbour of its simplex, so only neighbours are tested; in a shape alone, all points nearby are.
pub(super) fn judge(
    structure: &Structure,
    judge: &Judge,
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    let complex = structure.complex;
    let (cells, mut findings) = judge.cells(&complex.cells, &monitor.part(0, 2, 10))?;
    findings.extend(judge.compare(&complex.cells, &cells));

    let facets = judge.facets(structure, &cells, &monitor.part(2, 5, 10))?;
    findings.extend(judge.compare(&complex.facets, &facets));
    findings.extend(windings(structure, &cells, &facets, &monitor.part(5, 6, 10))?);
    if judge.has_strays::<3>() {
        let strays = (0..complex.facets.len()).filter(|&i| structure.halves(i).next().is_none());
        let facet = |i: usize| complex.facets.rows()[i].into();
        findings.extend(strays.map(|i| Finding::Stray { simplex: facet(i) }));
    }

    let of_facets = Faces {
        higher: &complex.facets,
        verdicts: &facets,
        corners: [[1, 2], [0, 2], [0, 1]],
        lower: &complex.edges,
        index: &structure.edges,
    };
    let (edges, found) = of_facets.judge(judge, &monitor.part(6, 9, 10))?;
    findings.extend(found);
    findings.extend(judge.compare(&complex.edges, &edges));

    let of_edges = Faces {
        higher: &complex.edges,
        verdicts: &edges,
        corners: [[1], [0]],
        lower: &complex.vertices,
        index: &structure.vertices,
    };
    let (vertices, found) = of_edges.judge(judge, &monitor.part(9, 10, 10))?;
    findings.extend(found);
    findings.extend(judge.compare(&complex.vertices, &vertices));
    Ok(findings)
}

/// What the class of a simplex depends on.
pub(super) struct Judge<'a> {
    pub points: Points<'a>,
    pub alpha: Alpha,
    pub extent: Extent,
    /// The dimension of the affine hull of the points: less than 3 where they span no volume.
    pub dimension: usize,
    /// Only in a shape alone.
    pub emptiness: Option<&'a Emptiness<'a>>,
    /// Of which the complex has copies.
    pub torus: Option<Torus>,
}

/// The class that a simplex has, and the point in its sphere that excludes it from the shape, or [`NONE`].
#[derive(Clone, Copy)]
pub(super) struct Verdict {
    pub(super) class: Class,
    refuted_by: u32,
}

impl Verdict {
    /// What stands in the place of a verdict until it is known.
    const UNKNOWN: Self = Self { class: Class::Exterior, refuted_by: NONE };

    pub(super) fn of(class: Class) -> Self {
        Self { class, refuted_by: NONE }
    }
}

impl Judge<'_> {
    /// Whether simplices with `N` corners must be faces of others: those of a whole triangulation that are not
    /// of the largest dimension.
    pub(super) fn has_strays<const N: usize>(&self) -> bool {
        self.extent == Extent::Whole && N != self.dimension + 1
    }

    fn cells(
        &self,
        cells: &Simplices<4>,
        monitor: &Monitor,
    ) -> Result<(Vec<Verdict>, Vec<Finding>), Cancelled> {
        let verdict = |i: usize| {
            let cell = cells.rows()[i];
            let inside = !self.flat(cell) && self.fits(cell);
            let class = if inside { Class::Interior } else { Class::Exterior };
            let refuter = self.emptiness.filter(|_| inside);
            let refuted_by = refuter.and_then(|near| near.refuter_of_cell(cell)).unwrap_or(NONE);
            Verdict { class, refuted_by }
        };
        let mut verdicts = one_for_each(cells.len(), Verdict::UNKNOWN, monitor, verdict)?;
        let refuted = cells.rows().iter().zip(&verdicts);
        let finding = |(&cell, verdict): (&[u32; 4], &Verdict)| {
            let corners = self.points.corners(cell);
            let power = power_value(corners.each_ref(), &self.points.get(verdict.refuted_by));
            Finding::NotRegular { cell: cell.into(), point: verdict.refuted_by, power }
        };
        let findings = refuted.filter(|(_, verdict)| verdict.refuted_by != NONE).map(finding);
        let findings = findings.collect();
        // It refutes the cell, not its class.
        verdicts.par_iter_mut().for_each(|verdict| verdict.refuted_by = NONE);
        Ok((verdicts, findings))
    }

    fn facets(
        &self,
        structure: &Structure,
        cells: &[Verdict],
        monitor: &Monitor,
    ) -> Result<Vec<Verdict>, Cancelled> {
        let rows = structure.complex.facets.rows();
        let verdict = |i: usize| {
            let facet = rows[i];
            let inside =
                structure.halves(i).filter(|h| cells[h.cell].class == Class::Interior).count();
            if inside > 0 {
                return Verdict::of(if inside == 2 { Class::Interior } else { Class::Regular });
            }
            if self.flat(facet) || !self.fits(facet) {
                return Verdict::of(Class::Exterior);
            }
            let corners = self.points.corners(facet);
            let inside = |&q: &u32| side(corners.each_ref(), &self.points.get(q)) == Side::Inside;
            let neighbours = structure.halves(i).map(|half| structure.apex(half));
            self.alone(facet, neighbours.filter(inside).min())
        };
        one_for_each(rows.len(), Verdict::UNKNOWN, monitor, verdict)
    }

    /// The verdict on a simplex whose sphere fits α and that has no coface in the shape.
    pub(super) fn alone<const N: usize>(
        &self,
        row: [u32; N],
        neighbour_inside: Option<u32>,
    ) -> Verdict {
        let inside = neighbour_inside.or_else(|| self.emptiness.and_then(|near| near.refuter(row)));
        match inside {
            Some(refuted_by) => Verdict { class: Class::Exterior, refuted_by },
            None => Verdict::of(Class::Singular),
        }
    }

    /// Findings where given classes differ from the verdicts.
    fn compare<const N: usize>(&self, given: &Simplices<N>, verdicts: &[Verdict]) -> Vec<Finding> {
        let rows = given.rows().par_iter().zip(given.classes()).zip(verdicts);
        rows.filter(|((_, given), verdict)| **given != verdict.class)
            .map(|((&row, &given), verdict)| {
                let corners = self.points.corners(row);
                let corners = corners.each_ref();
                let refuted_by = Some(verdict.refuted_by).filter(|&point| point != NONE);
                Finding::Class {
                    simplex: row.into(),
                    given,
                    expected: verdict.class,
                    radius_squared: (!self.flat(row)).then(|| radius_value(corners)),
                    refuted_by: refuted_by
                        .map(|point| (point, power_value(corners, &self.points.get(point)))),
                }
            })
            .collect()
    }

    pub(super) fn fits<const N: usize>(&self, row: [u32; N]) -> bool {
        radius(self.points.corners(row).each_ref(), self.alpha).is_le()
    }

    pub(super) fn inside<const N: usize>(&self, row: [u32; N], q: u32) -> bool {
        side(self.points.corners(row).each_ref(), &self.points.get(q)) == Side::Inside
    }

    /// Whether the corners are affinely dependent, so that they have no orthogonal sphere.
    pub(super) fn flat<const N: usize>(&self, row: [u32; N]) -> bool {
        match self.points.positions_of(row)[..] {
            [a, b] => a == b,
            [a, b, c] => collinear(a, b, c),
            [a, b, c, d] => orientation(a, b, c, d).is_eq(),
            _ => false,
        }
    }
}

fn windings(
    structure: &Structure,
    cells: &[Verdict],
    facets: &[Verdict],
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    let rows = structure.complex.facets.rows();
    of_each(rows.len(), monitor, |i| {
        let facet = rows[i];
        let inside = |half: &Half| cells[half.cell].class == Class::Interior;
        let half = structure.halves(i).find(inside)?;
        let outward = smallest_even(structure.outward(half)) == smallest_even(facet);
        let behind = structure.apex(half);
        (facets[i].class == Class::Regular && !outward)
            .then(|| Finding::Winding { facet: facet.into(), behind })
    })
}

/// Simplices, their verdicts, and the dimension below, whose simplices are their faces.
pub(super) struct Faces<'a, const N: usize, const M: usize> {
    pub(super) higher: &'a Simplices<N>,
    pub(super) verdicts: &'a [Verdict],
    /// The corners of each face; the i-th is opposite to corner i.
    pub(super) corners: [[usize; M]; N],
    pub(super) lower: &'a Simplices<M>,
    pub(super) index: &'a Index<'a, M>,
}

/// What is known of a simplex from its cofaces, which are visited in parallel.
#[derive(Default)]
struct Cofaces(AtomicU8);

impl Cofaces {
    /// It has a coface.
    const SEEN: u8 = 1;
    /// It has a coface in the shape.
    const COVERED: u8 = 2;
    /// It has a coface that is not interior.
    const OPEN: u8 = 4;

    fn add(&self, class: Class) {
        let seen = match class {
            Class::Interior => Self::SEEN | Self::COVERED,
            Class::Regular | Class::Singular => Self::SEEN | Self::COVERED | Self::OPEN,
            Class::Exterior => Self::SEEN | Self::OPEN,
        };
        self.0.fetch_or(seen, Ordering::Relaxed);
    }

    fn has(&self, what: u8) -> bool {
        self.0.load(Ordering::Relaxed) & what != 0
    }
}

/// What is known of a simplex once all its cofaces were visited.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    /// It has a coface in the shape, and all of them are interior.
    Closed,
    /// It has a coface in the shape, and not all of them are interior.
    Open,
    /// It has no coface in the shape, and its own sphere fits α.
    Candidate,
    /// It has no coface in the shape, and it is flat or its sphere is too large.
    Outside,
}

impl<const N: usize, const M: usize> Faces<'_, N, M> {
    /// The verdict on each lower simplex, and findings on those that are missing and, in a whole triangulation,
    /// on those that are no faces.
    pub(super) fn judge(
        &self,
        judge: &Judge,
        monitor: &Monitor,
    ) -> Result<(Vec<Verdict>, Vec<Finding>), Cancelled> {
        let (cofaces, mut findings) = self.cofaces(&monitor.part(0, 4, 10))?;
        let rows = self.lower.rows();
        let states = one_for_each(rows.len(), State::Outside, &monitor.part(4, 6, 10), |i| {
            state(rows[i], &cofaces[i], judge)
        })?;
        let refuters = self.neighbours_inside(&states, judge, &monitor.part(6, 9, 10))?;
        let verdict = |i: usize| {
            let refuter = Some(refuters[i].load(Ordering::Relaxed)).filter(|&point| point != NONE);
            match states[i] {
                State::Closed => Verdict::of(Class::Interior),
                State::Open => Verdict::of(Class::Regular),
                State::Outside => Verdict::of(Class::Exterior),
                State::Candidate => judge.alone(rows[i], refuter),
            }
        };
        let monitor = &monitor.part(9, 10, 10);
        let verdicts = one_for_each(rows.len(), Verdict::UNKNOWN, monitor, verdict)?;
        if judge.has_strays::<M>() {
            let strays = self.lower.rows().iter().zip(&cofaces);
            let strays = strays.filter(|(_, cofaces)| !cofaces.has(Cofaces::SEEN));
            findings.extend(strays.map(|(row, _)| Finding::Stray { simplex: (*row).into() }));
        }
        Ok((verdicts, findings))
    }

    /// What each lower simplex has for cofaces, and which faces are not listed.
    fn cofaces(&self, monitor: &Monitor) -> Result<(Vec<Cofaces>, Vec<Finding>), Cancelled> {
        let cofaces: Vec<Cofaces> = self.lower.rows().iter().map(|_| Cofaces::default()).collect();
        let missing = of_each(self.higher.len(), monitor, |i| {
            let (row, verdict) = (self.higher.rows()[i], self.verdicts[i]);
            let cofaces = &cofaces;
            self.corners.iter().filter_map(move |corners| {
                let face = corners.map(|k| row[k]);
                match cofaces.get(self.index.row(face) as usize) {
                    Some(cofaces) => {
                        cofaces.add(verdict.class);
                        None
                    }
                    None => Some((face, row)),
                }
            })
        })?;
        // Of several simplices with the face, the first is named.
        let missing: BTreeMap<_, _> = missing.into_iter().rev().collect();
        let finding = |(face, of): ([u32; M], [u32; N])| Finding::MissingFace {
            face: face.into(),
            of: of.into(),
        };
        Ok((cofaces, missing.into_iter().map(finding).collect()))
    }

    /// For each candidate the smallest corner opposite to it, in an exterior higher simplex, that
    /// is inside its sphere; else [`NONE`].
    fn neighbours_inside(
        &self,
        states: &[State],
        judge: &Judge,
        monitor: &Monitor,
    ) -> Result<Vec<AtomicU32>, Cancelled> {
        let refuters: Vec<AtomicU32> = states.iter().map(|_| AtomicU32::new(NONE)).collect();
        if !states.par_iter().any(|&state| state == State::Candidate) {
            return Ok(refuters);
        }
        of_each(self.higher.len(), monitor, |i| {
            let row = self.higher.rows()[i];
            let exterior = self.verdicts[i].class == Class::Exterior;
            for (corners, &opposite) in self.corners.iter().zip(&row).filter(|_| exterior) {
                let face = corners.map(|k| row[k]);
                let at = self.index.row(face) as usize;
                if states.get(at) == Some(&State::Candidate) && judge.inside(face, opposite) {
                    refuters[at].fetch_min(opposite, Ordering::Relaxed);
                }
            }
            None::<()>
        })?;
        Ok(refuters)
    }
}

fn state<const M: usize>(row: [u32; M], cofaces: &Cofaces, judge: &Judge) -> State {
    match (cofaces.has(Cofaces::COVERED), cofaces.has(Cofaces::OPEN)) {
        (true, false) => State::Closed,
        (true, true) => State::Open,
        (false, _) if !judge.flat(row) && judge.fits(row) => State::Candidate,
        (false, _) => State::Outside,
    }
}
