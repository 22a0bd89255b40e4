//! The rules on classes: the class that each simplex has by the definition, compared with the given one.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use walpha_base::parallel::prelude::*;
use walpha_base::{Cancelled, Monitor};
use walpha_complex::canonical::smallest_even;

use super::claim::Extent;
use super::emptiness::Emptiness;
use super::finding::Finding;
use super::grid::Grid;
use super::non_vertices::in_cell;
use super::structure::{Half, Index, NONE, Points, Structure};
use super::torus::Torus;
use crate::exact::{
    Side, collinear, in_conflict, orientation, power_value, radius, radius_value, side,
};
use crate::parallel::{of_each, one_for_each};
use crate::{Alpha, Class, Simplices};

/// Judges the classes of all simplices, that faces are listed, and that regular facets turn outward. Below cells, a simplex is
/// interior if all its cofaces are, regular if it is a face of a simplex of the shape, and singular if its own sphere has squared
/// radius ≤ α and no point strictly inside.
///
/// In a whole triangulation that was found regular, a sphere that contains any point contains a neighbour of its simplex, so only
/// neighbours are tested; in a shape alone, all points nearby are tested. `untied` is whether cells are linked as they must be,
/// and none is refuted by a neighbour, not even in a tie.
pub(super) fn judge(
    structure: &Structure,
    judge: &Judge,
    untied: bool,
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    let complex = structure.complex;
    let mut findings = Vec::new();
    let cells = judge.cells(structure, untied, &mut findings, &monitor.part(0, 2, 10))?;
    let facets = &|i: usize| judge.facet(structure, &cells, i);
    let of_facets = &monitor.part(2, 5, 10);
    let facets = judge.classes(&complex.facets, facets, &mut findings, of_facets)?;
    findings.extend(windings(structure, &cells, &facets, &monitor.part(5, 6, 10))?);
    if judge.has_strays::<3>() {
        let strays = (0..complex.facets.len()).filter(|&i| structure.halves(i).next().is_none());
        let facet = |i: usize| complex.facets.rows()[i].into();
        findings.extend(strays.map(|i| Finding::Stray { simplex: facet(i) }));
    }

    let of_facets = Faces {
        higher: &complex.facets,
        classes: &facets,
        corners: [[1, 2], [0, 2], [0, 1]],
        lower: &complex.edges,
        index: &structure.edges,
    };
    let edges = of_facets.judge(judge, &mut findings, &monitor.part(6, 9, 10))?;

    let of_edges = Faces {
        higher: &complex.edges,
        classes: &edges,
        corners: [[1], [0]],
        lower: &complex.vertices,
        index: &structure.vertices,
    };
    of_edges.judge(judge, &mut findings, &monitor.part(9, 10, 10))?;
    Ok(findings)
}

/// The data that the class of a simplex depends on.
pub(super) struct Judge<'a> {
    pub points: Points<'a>,
    pub alpha: Alpha,
    pub extent: Extent,
    /// The dimension of the affine hull of the points: less than 3 if they span no volume.
    pub dimension: usize,
    /// Only in a shape alone.
    pub emptiness: Option<&'a Emptiness<'a>>,
    /// The torus of which the complex contains copies.
    pub torus: Option<Torus>,
}

/// The class of a simplex, and the point in its sphere that excludes it from the shape, or [`NONE`].
#[derive(Clone, Copy)]
pub(super) struct Verdict {
    pub(super) class: Class,
    refuted_by: u32,
}

impl Verdict {
    pub(super) fn of(class: Class) -> Self {
        Self { class, refuted_by: NONE }
    }
}

impl Judge<'_> {
    /// Whether simplices with `N` corners must be faces of others: in a whole triangulation, those below the largest dimension.
    pub(super) fn has_strays<const N: usize>(&self) -> bool {
        self.extent == Extent::Whole && N != self.dimension + 1
    }

    fn cells(
        &self,
        structure: &Structure,
        untied: bool,
        findings: &mut Vec<Finding>,
        monitor: &Monitor,
    ) -> Result<Vec<Class>, Cancelled> {
        let cells = &structure.complex.cells;
        let class = |i: usize| {
            let cell = cells.rows()[i];
            // Cells that are linked correctly are not flat.
            let inside = (untied || !self.flat(cell)) && self.fits(cell);
            Verdict::of(if inside { Class::Interior } else { Class::Exterior })
        };
        let mut differing = Vec::new();
        let classes = self.classes(cells, &class, &mut differing, &monitor.part(0, 1, 4))?;
        findings.extend(self.refuted(structure, &classes, untied, &monitor.part(1, 4, 4))?);
        findings.extend(differing);
        Ok(classes)
    }

    /// Findings for cells that a point refutes, in a shape alone.
    ///
    /// If no neighbour refutes another, a cell with neighbours on all sides is tested only with points that lie in it and are not
    /// surrounded by cells. Why: suppose that a point refutes a cell, and walk straight from the cell to the point; each cell on the way
    /// is refuted, too. The walk ends in an outermost cell, which is tested with all points, or in a cell that contains the point
    /// although others surround it. But outermost cells that pass belong to the regular triangulation, and behind these no cells
    /// overlap (Lemma 8 in docs/certifying.md).
    fn refuted(
        &self,
        structure: &Structure,
        classes: &[Class],
        untied: bool,
        monitor: &Monitor,
    ) -> Result<Vec<Finding>, Cancelled> {
        let Some(near) = self.emptiness else { return Ok(Vec::new()) };
        let cells = structure.complex.cells.rows();
        let refuter = |i: usize| {
            let fits = classes[i] == Class::Interior;
            fits.then(|| near.refuter_of_cell(cells[i])).flatten()
        };
        let fit = || classes.par_iter().all(|&class| class == Class::Interior);
        if untied && self.torus.is_none() && fit() {
            let surrounded = structure.surrounded(self.points.len());
            let exposed = near.tested().filter(|&point| !surrounded[point as usize]).collect();
            let exposed = Grid::new(self.points, exposed);
            let refutes = |cell: [u32; 4], point: u32| {
                in_conflict(self.points.corners(cell).each_ref(), &self.points.get(point))
            };
            let is_refuted = |i: usize| {
                if structure.is_outermost(i) {
                    refuter(i).is_some()
                } else {
                    let cell = cells[i];
                    let test = |point: u32| refutes(cell, point).then_some(());
                    in_cell(&exposed, self.points, cell, test).is_some()
                }
            };
            let monitor = &monitor.part(0, 1, 2);
            if of_each(cells.len(), monitor, |i| is_refuted(i).then_some(()))?.is_empty() {
                return Ok(Vec::new());
            }
        }
        of_each(cells.len(), &monitor.part(1, 2, 2), |i| {
            let point = refuter(i)?;
            let corners = self.points.corners(cells[i]);
            let power = power_value(corners.each_ref(), &self.points.get(point));
            Some(Finding::NotRegular { cell: cells[i].into(), point, power })
        })
    }

    fn facet(&self, structure: &Structure, cells: &[Class], i: usize) -> Verdict {
        let facet = structure.complex.facets.rows()[i];
        let inside = structure.halves(i).filter(|half| cells[half.cell] == Class::Interior).count();
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

    /// The classes of some simplices by their verdicts, and findings for given classes that differ.
    fn classes<const N: usize>(
        &self,
        given: &Simplices<N>,
        verdict: &(impl Fn(usize) -> Verdict + Sync),
        findings: &mut Vec<Finding>,
        monitor: &Monitor,
    ) -> Result<Vec<Class>, Cancelled> {
        let classes = one_for_each(given.len(), Class::Exterior, monitor, |i| verdict(i).class)?;
        let differs = |i: &usize| given.classes()[*i] != classes[*i];
        let differing = (0..given.len()).into_par_iter().filter(differs).map(|i| {
            let (row, Verdict { class, refuted_by }) = (given.rows()[i], verdict(i));
            let corners = self.points.corners(row);
            let corners = corners.each_ref();
            let refuted_by = Some(refuted_by).filter(|&point| point != NONE);
            Finding::Class {
                simplex: row.into(),
                given: given.classes()[i],
                expected: class,
                radius_squared: (!self.flat(row)).then(|| radius_value(corners)),
                refuted_by: refuted_by
                    .map(|point| (point, power_value(corners, &self.points.get(point)))),
            }
        });
        findings.par_extend(differing);
        Ok(classes)
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
    cells: &[Class],
    facets: &[Class],
    monitor: &Monitor,
) -> Result<Vec<Finding>, Cancelled> {
    let rows = structure.complex.facets.rows();
    of_each(rows.len(), monitor, |i| {
        let facet = rows[i];
        let inside = |half: &Half| cells[half.cell] == Class::Interior;
        let half = structure.halves(i).find(inside)?;
        let outward = smallest_even(structure.outward(half)) == smallest_even(facet);
        let behind = structure.apex(half);
        (facets[i] == Class::Regular && !outward)
            .then(|| Finding::Winding { facet: facet.into(), behind })
    })
}

/// Simplices, their classes, and the dimension below, whose simplices are their faces.
pub(super) struct Faces<'a, const N: usize, const M: usize> {
    pub(super) higher: &'a Simplices<N>,
    pub(super) classes: &'a [Class],
    /// The corners of each face; the i-th is opposite to corner i.
    pub(super) corners: [[usize; M]; N],
    pub(super) lower: &'a Simplices<M>,
    pub(super) index: &'a Index<'a, M>,
}

/// The information about a simplex that its cofaces give. They are visited in parallel.
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

/// The information about a simplex after all its cofaces were visited.
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
    /// The class of each lower simplex; findings for given classes that differ, for missing simplices and, in a whole
    /// triangulation, for simplices that are not faces.
    pub(super) fn judge(
        &self,
        judge: &Judge,
        findings: &mut Vec<Finding>,
        monitor: &Monitor,
    ) -> Result<Vec<Class>, Cancelled> {
        let (cofaces, missing) = self.cofaces(&monitor.part(0, 4, 10))?;
        findings.extend(missing);
        let rows = self.lower.rows();
        let states = one_for_each(rows.len(), State::Outside, &monitor.part(4, 6, 10), |i| {
            state(rows[i], &cofaces[i], judge)
        })?;
        let refuters = self.neighbours_inside(&states, judge, &monitor.part(6, 9, 10))?;
        if judge.has_strays::<M>() {
            let strays = self.lower.rows().iter().zip(&cofaces);
            let strays = strays.filter(|(_, cofaces)| !cofaces.has(Cofaces::SEEN));
            findings.extend(strays.map(|(row, _)| Finding::Stray { simplex: (*row).into() }));
        }
        drop(cofaces);
        let verdict = |i: usize| match states[i] {
            State::Closed => Verdict::of(Class::Interior),
            State::Open => Verdict::of(Class::Regular),
            State::Outside => Verdict::of(Class::Exterior),
            State::Candidate => {
                let refuter = refuters[i].load(Ordering::Relaxed);
                judge.alone(rows[i], Some(refuter).filter(|&point| point != NONE))
            }
        };
        judge.classes(self.lower, &verdict, findings, &monitor.part(9, 10, 10))
    }

    /// Returns the state of the cofaces of each lower simplex, and findings for faces that are not listed.
    fn cofaces(&self, monitor: &Monitor) -> Result<(Vec<Cofaces>, Vec<Finding>), Cancelled> {
        let cofaces: Vec<Cofaces> = self.lower.rows().iter().map(|_| Cofaces::default()).collect();
        let missing = of_each(self.higher.len(), monitor, |i| {
            let (row, class) = (self.higher.rows()[i], self.classes[i]);
            let cofaces = &cofaces;
            self.corners.iter().filter_map(move |corners| {
                let face = corners.map(|k| row[k]);
                match cofaces.get(self.index.row(face) as usize) {
                    Some(cofaces) => {
                        cofaces.add(class);
                        None
                    }
                    None => Some((face, row)),
                }
            })
        })?;
        // If several simplices have the face, the first is named.
        let missing: BTreeMap<_, _> = missing.into_iter().rev().collect();
        let finding = |(face, of): ([u32; M], [u32; N])| Finding::MissingFace {
            face: face.into(),
            of: of.into(),
        };
        Ok((cofaces, missing.into_iter().map(finding).collect()))
    }

    /// For each candidate, the smallest corner opposite to it, in an exterior higher simplex, that is inside its sphere,
    /// otherwise [`NONE`]. Empty if there are no candidates.
    fn neighbours_inside(
        &self,
        states: &[State],
        judge: &Judge,
        monitor: &Monitor,
    ) -> Result<Vec<AtomicU32>, Cancelled> {
        if !states.par_iter().any(|&state| state == State::Candidate) {
            return Ok(Vec::new());
        }
        let refuters: Vec<AtomicU32> = states.iter().map(|_| AtomicU32::new(NONE)).collect();
        of_each(self.higher.len(), monitor, |i| {
            let row = self.higher.rows()[i];
            let exterior = self.classes[i] == Class::Exterior;
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

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;
    use crate::certify::flat::closed;
    use crate::certify::geometry::{Boundary, Linked};
    use crate::certify::non_vertices::{distinct, kept_points};
    use crate::enumerate;
    use crate::exact::WeightedPoint;

    /// Cells of two triangulations of different points, one of them inside the other or across it: cells that a point refutes are
    /// also found if most cells are tested with few points. Some cells are left out.
    #[test]
    fn surrounded_points_need_no_test() {
        let mut random = Random::new(6);
        let alpha = Alpha::from_squared(1e9).unwrap();
        let (mut empty, mut refuted_outermost, mut refuted_within) = (0, 0, 0);
        for round in 0..1500 {
            let unit = random.pick(&[1.0, 7.0]);
            let mut jitter = |x: i64, by: i64| unit * random.whole(x - by, x + by);
            let corner = |i: usize, size: i64| {
                [i & 1, i >> 1 & 1, i >> 2 & 1].map(|side| (2 * side as i64 - 1) * size)
            };
            // A cube in a cube, and a few points in the middle or anywhere.
            let outer: Vec<[f64; 3]> = (0..16)
                .map(|i| corner(i, if i < 8 { 40 } else { 12 }).map(|x| jitter(x, 2)))
                .collect();
            let spread = if round % 2 == 0 { 2 } else { 30 };
            let inner: Vec<[f64; 3]> = (0..5).map(|_| [0; 3].map(|x| jitter(x, spread))).collect();
            let positions = [outer, inner].concat();
            let site =
                |&position: &[f64; 3]| WeightedPoint { position, weight: random.whole(0, 1) };
            let sites: Vec<_> = positions.iter().map(site).collect();
            // Apart, or together.
            let ends: &[usize] = if round % 3 == 0 { &[0, 21] } else { &[0, 16, 21] };
            let mut cells = Vec::new();
            for part in ends.windows(2).map(|ends| ends[0]..ends[1]) {
                let weights: Vec<_> = sites[part.clone()].iter().map(|site| site.weight).collect();
                let Ok(made) = enumerate(&positions[part.clone()], &weights, alpha) else {
                    continue;
                };
                let sparse = random.below(3) == 0;
                let own = made.complex.cells.rows();
                let own = own.iter().filter(|_| !sparse || random.below(8) > 0);
                cells.extend(own.map(|cell| cell.map(|v| part.start as u32 + v)));
            }
            if cells.is_empty() {
                continue;
            }
            let (complex, points) = (closed(&cells), Points { sites: &sites });
            let noop = Monitor::noop();
            let linked = Linked::new(&complex, points, Boundary::Any, &noop).unwrap();
            assert!(linked.broken.is_empty());
            if !linked.irregular.is_empty() {
                continue;
            }
            let tested = distinct(&kept_points(points, &complex, None).0).collect();
            let emptiness = Emptiness::new(points, alpha, f64::INFINITY, tested);
            let judge = Judge {
                points,
                alpha,
                extent: Extent::Shape,
                dimension: 3,
                emptiness: Some(&emptiness),
                torus: None,
            };
            let classes = vec![Class::Interior; complex.cells.len()];
            let structure = &linked.structure;
            let all = judge.refuted(structure, &classes, false, &noop).unwrap();
            assert_eq!(judge.refuted(structure, &classes, true, &noop).unwrap(), all);
            let outermost = |finding: &Finding| {
                let Finding::NotRegular { cell, .. } = finding else { panic!("{finding:?}") };
                let row = cell.vertices().try_into().unwrap();
                structure.is_outermost(structure.cells.row(row) as usize)
            };
            if all.is_empty() {
                empty += 1;
            } else if all.iter().any(outermost) {
                refuted_outermost += 1;
            } else {
                refuted_within += 1;
            }
        }
        let counts = [empty, refuted_outermost, refuted_within];
        assert!(counts.iter().all(|&count| count > 20), "{counts:?}");
    }
}
