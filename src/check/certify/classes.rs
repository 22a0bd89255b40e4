//! The rules on classes: what the definition makes of each simplex against what it was given.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use rayon::prelude::*;

use super::emptiness::Emptiness;
use super::index::{Index, NONE};
use super::structure::Structure;
use super::{Extent, Finding, Points};
use crate::check::canonical::smallest_even;
use crate::check::exact::{Side, collinear, orientation, power_value, radius, radius_value, side};
use crate::shape::{Class, Simplices};

/// Judges the classes of all simplices, that faces are listed, and that regular facets turn
/// outward. Below cells a simplex is interior when all around it is, regular when it is a face
/// of something in the shape, and singular when its own sphere has squared radius ≤ α and no
/// point strictly inside.
///
/// In a whole triangulation that was found regular, only the neighbours of a simplex can be the
/// first inside its sphere, so only they are asked; in a shape alone, all points nearby are.
pub fn judge(structure: &Structure, judge: &Judge) -> Vec<Finding> {
    let complex = structure.complex;
    let (cells, mut findings) = judge.cells(&complex.cells);
    findings.extend(judge.compare(&complex.cells, &cells));

    let facets = judge.facets(structure, &cells);
    findings.extend(judge.compare(&complex.facets, &facets));
    findings.extend(windings(structure, &cells, &facets));
    if judge.extent == Extent::Whole {
        let strays = (0..complex.facets.len()).filter(|&i| structure.halves(i).next().is_none());
        let facet = |i: usize| complex.facets.vertices[i].into();
        findings.extend(strays.map(|i| Finding::Stray { simplex: facet(i) }));
    }

    const OF_FACET: [[usize; 2]; 3] = [[1, 2], [0, 2], [0, 1]];
    let (edges, found) =
        judge.faces(&complex.facets, &facets, OF_FACET, &complex.edges, &structure.edges);
    findings.extend(found);
    findings.extend(judge.compare(&complex.edges, &edges));

    const OF_EDGE: [[usize; 1]; 2] = [[1], [0]];
    let (vertices, found) =
        judge.faces(&complex.edges, &edges, OF_EDGE, &complex.vertices, &structure.vertices);
    findings.extend(found);
    findings.extend(judge.compare(&complex.vertices, &vertices));
    findings
}

/// What a class depends on.
pub struct Judge<'a> {
    pub points: Points<'a>,
    pub alpha: f64,
    pub extent: Extent,
    /// In a shape alone.
    pub emptiness: Option<&'a Emptiness<'a>>,
}

/// The class a simplex has, and the point that keeps it out of the shape, or [`NONE`].
#[derive(Clone, Copy)]
struct Verdict {
    class: Class,
    refuted_by: u32,
}

impl Verdict {
    fn of(class: Class) -> Self {
        Self { class, refuted_by: NONE }
    }
}

/// Some higher simplex has it as a face.
const SEEN: u8 = 1;
/// One in the shape has.
const COVERED: u8 = 2;
/// One that is not interior has.
const OPEN: u8 = 4;
/// Nothing in the shape has it as a face, and its own sphere is small enough.
const CANDIDATE: u8 = 8;

impl Judge<'_> {
    fn cells(&self, cells: &Simplices<4>) -> (Vec<Verdict>, Vec<Finding>) {
        let verdict = |&cell: &[u32; 4]| {
            let inside = !self.flat(cell) && self.small(cell);
            let class = if inside { Class::Interior } else { Class::Exterior };
            let refuter = self.emptiness.filter(|_| inside);
            let finding = refuter.and_then(|near| near.refuter_of_cell(cell)).map(|point| {
                let corners = self.points.at(cell);
                let power = power_value(corners.each_ref(), &self.points.get(point));
                Finding::NotRegular { cell: cell.into(), point, power }
            });
            (Verdict::of(class), finding)
        };
        let (verdicts, findings): (Vec<_>, Vec<_>) = cells.vertices.par_iter().map(verdict).unzip();
        (verdicts, findings.into_iter().flatten().collect())
    }

    fn facets(&self, structure: &Structure, cells: &[Verdict]) -> Vec<Verdict> {
        let rows = structure.complex.facets.vertices.par_iter().enumerate();
        let verdict = |(i, &facet): (usize, &[u32; 3])| {
            let inside =
                structure.halves(i).filter(|h| cells[h.cell].class == Class::Interior).count();
            if inside > 0 {
                return Verdict::of(if inside == 2 { Class::Interior } else { Class::Regular });
            }
            if self.flat(facet) || !self.small(facet) {
                return Verdict::of(Class::Exterior);
            }
            let corners = self.points.at(facet);
            let inside = |&q: &u32| side(corners.each_ref(), &self.points.get(q)) == Side::Inside;
            let neighbours = structure.halves(i).map(|half| structure.apex(half));
            self.alone(facet, neighbours.filter(inside).min())
        };
        rows.map(verdict).collect()
    }

    /// The verdicts on the faces of higher simplices, and which of these are missing or stray.
    fn faces<const N: usize, const M: usize>(
        &self,
        higher: &Simplices<N>,
        verdicts: &[Verdict],
        faces: [[usize; M]; N],
        lower: &Simplices<M>,
        index: &Index<M>,
    ) -> (Vec<Verdict>, Vec<Finding>) {
        let flags: Vec<AtomicU8> = lower.vertices.iter().map(|_| AtomicU8::new(0)).collect();
        let rows = || higher.vertices.par_iter().zip(verdicts);
        let missing = rows().flat_map_iter(|(row, verdict)| {
            let mut flag = SEEN;
            if verdict.class != Class::Exterior {
                flag |= COVERED;
            }
            if verdict.class != Class::Interior {
                flag |= OPEN;
            }
            let flags = &flags;
            faces.iter().filter_map(move |face| {
                let face = face.map(|k| row[k]);
                match flags.get(index.row(face) as usize) {
                    Some(slot) => {
                        slot.fetch_or(flag, Ordering::Relaxed);
                        None
                    }
                    None => Some((face, *row)),
                }
            })
        });
        let missing: Vec<([u32; M], [u32; N])> = missing.collect();
        let missing: BTreeMap<_, _> = missing.into_iter().rev().collect();
        let mut findings: Vec<_> = missing
            .into_iter()
            .map(|(face, of)| Finding::MissingFace { face: face.into(), of: of.into() })
            .collect();

        lower.vertices.par_iter().zip(&flags).for_each(|(&row, slot)| {
            let flag = slot.load(Ordering::Relaxed);
            if flag & COVERED == 0 && !self.flat(row) && self.small(row) {
                slot.store(flag | CANDIDATE, Ordering::Relaxed);
            }
        });
        let refuters: Vec<AtomicU32> =
            lower.vertices.iter().map(|_| AtomicU32::new(NONE)).collect();
        let candidate = |flag: &AtomicU8| flag.load(Ordering::Relaxed) & CANDIDATE != 0;
        if flags.par_iter().any(candidate) {
            rows().filter(|(_, verdict)| verdict.class == Class::Exterior).for_each(|(row, _)| {
                for (opposite, face) in faces.iter().enumerate() {
                    let face = face.map(|k| row[k]);
                    let at = index.row(face) as usize;
                    if flags.get(at).is_some_and(candidate) && self.inside(face, row[opposite]) {
                        refuters[at].fetch_min(row[opposite], Ordering::Relaxed);
                    }
                }
            });
        }

        let verdict = |((&row, flag), refuter): ((&[u32; M], &AtomicU8), &AtomicU32)| {
            let flag = flag.load(Ordering::Relaxed);
            if flag & COVERED != 0 {
                let open = flag & OPEN != 0;
                Verdict::of(if open { Class::Regular } else { Class::Interior })
            } else if flag & CANDIDATE == 0 {
                Verdict::of(Class::Exterior)
            } else {
                let refuter = refuter.load(Ordering::Relaxed);
                self.alone(row, Some(refuter).filter(|&point| point != NONE))
            }
        };
        let verdicts = lower.vertices.par_iter().zip(&flags).zip(&refuters).map(verdict).collect();
        if self.extent == Extent::Whole {
            let stray = |(_, flag): &(_, &AtomicU8)| flag.load(Ordering::Relaxed) & SEEN == 0;
            let strays = lower.vertices.iter().zip(&flags).filter(stray);
            findings.extend(strays.map(|(row, _)| Finding::Stray { simplex: (*row).into() }));
        }
        (verdicts, findings)
    }

    /// The verdict on a simplex with a small sphere and nothing of the shape above it.
    fn alone<const N: usize>(&self, row: [u32; N], neighbour_inside: Option<u32>) -> Verdict {
        let inside = neighbour_inside.or_else(|| self.emptiness.and_then(|near| near.refuter(row)));
        match inside {
            Some(refuted_by) => Verdict { class: Class::Exterior, refuted_by },
            None => Verdict::of(Class::Singular),
        }
    }

    /// Where given classes differ from the verdicts.
    fn compare<const N: usize>(&self, given: &Simplices<N>, verdicts: &[Verdict]) -> Vec<Finding> {
        let rows = given.vertices.par_iter().zip(&given.classes).zip(verdicts);
        rows.filter(|((_, given), verdict)| **given != verdict.class)
            .map(|((&row, &given), verdict)| {
                let corners = self.points.at(row);
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

    fn small<const N: usize>(&self, row: [u32; N]) -> bool {
        radius(self.points.at(row).each_ref(), self.alpha).is_le()
    }

    fn inside<const N: usize>(&self, row: [u32; N], q: u32) -> bool {
        side(self.points.at(row).each_ref(), &self.points.get(q)) == Side::Inside
    }

    /// Whether the corners are affinely dependent, so that there is no sphere of theirs.
    fn flat<const N: usize>(&self, row: [u32; N]) -> bool {
        match self.points.places(row)[..] {
            [a, b] => a == b,
            [a, b, c] => collinear(a, b, c),
            [a, b, c, d] => orientation(a, b, c, d).is_eq(),
            _ => false,
        }
    }
}

fn windings(structure: &Structure, cells: &[Verdict], facets: &[Verdict]) -> Vec<Finding> {
    let rows = structure.complex.facets.vertices.par_iter().enumerate();
    let judge = |(i, &facet): (usize, &[u32; 3])| {
        let inside = |half: &super::structure::Half| cells[half.cell].class == Class::Interior;
        let half = structure.halves(i).find(inside)?;
        let outward = smallest_even(structure.outward(half)) == smallest_even(facet);
        let behind = structure.apex(half);
        (facets[i].class == Class::Regular && !outward)
            .then(|| Finding::Winding { facet: facet.into(), behind })
    };
    rows.filter_map(judge).collect()
}
