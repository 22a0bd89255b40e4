//! Classes of simplices below cells, from the higher simplices that have them as faces.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use rayon::prelude::*;

use super::Finding;
use super::classes::{Judge, Verdict};
use super::index::{Index, NONE};
use crate::{Class, Simplices};

/// Simplices, their verdicts, and the dimension below, whose simplices are their faces.
pub(super) struct Faces<'a, const N: usize, const M: usize> {
    pub(super) higher: &'a Simplices<N>,
    pub(super) verdicts: &'a [Verdict],
    /// The corners of each face; the i-th is opposite to corner i.
    pub(super) corners: [[usize; M]; N],
    pub(super) lower: &'a Simplices<M>,
    pub(super) index: &'a Index<M>,
}

/// What the higher simplices around one say of it. They are visited in parallel.
#[derive(Default)]
struct Around(AtomicU8);

impl Around {
    /// Some higher simplex has it as a face.
    const SEEN: u8 = 1;
    /// One in the shape has.
    const COVERED: u8 = 2;
    /// One that is not interior has.
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

/// What is known of a simplex once everything around it was seen.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    /// A face of something in the shape, and all around it is interior.
    Closed,
    /// A face of something in the shape, and not all around it is interior.
    Open,
    /// Nothing in the shape has it as a face, and its own sphere is small enough for α.
    Candidate,
    /// Nothing in the shape has it as a face, and it is flat or its sphere is too large.
    Outside,
}

impl<const N: usize, const M: usize> Faces<'_, N, M> {
    /// The verdict on each lower simplex, which of them are missing, and in a whole triangulation
    /// which belong to nothing.
    pub(super) fn judge(&self, judge: &Judge) -> (Vec<Verdict>, Vec<Finding>) {
        let (around, mut findings) = self.look_around();
        let states: Vec<State> = (self.lower.rows().par_iter().zip(&around))
            .map(|(&row, around)| state(row, around, judge))
            .collect();
        let refuters = self.neighbours_inside(&states, judge);
        let verdict = |((&row, &state), refuter): ((&[u32; M], &State), AtomicU32)| match state {
            State::Closed => Verdict::of(Class::Interior),
            State::Open => Verdict::of(Class::Regular),
            State::Outside => Verdict::of(Class::Exterior),
            State::Candidate => {
                judge.alone(row, Some(refuter.into_inner()).filter(|&point| point != NONE))
            }
        };
        let rows = self.lower.rows().par_iter();
        let verdicts = rows.zip(&states).zip(refuters).map(verdict).collect();
        if judge.has_strays::<M>() {
            let strays = self.lower.rows().iter().zip(&around);
            let strays = strays.filter(|(_, around)| !around.has(Around::SEEN));
            findings.extend(strays.map(|(row, _)| Finding::Stray { simplex: (*row).into() }));
        }
        (verdicts, findings)
    }

    /// What is around each lower simplex, and which faces are not listed.
    fn look_around(&self) -> (Vec<Around>, Vec<Finding>) {
        let around: Vec<Around> = self.lower.rows().iter().map(|_| Around::default()).collect();
        let rows = self.higher.rows().par_iter().zip(self.verdicts);
        let missing = rows.flat_map_iter(|(row, verdict)| {
            let around = &around;
            self.corners.iter().filter_map(move |corners| {
                let face = corners.map(|k| row[k]);
                match around.get(self.index.row(face) as usize) {
                    Some(around) => {
                        around.add(verdict.class);
                        None
                    }
                    None => Some((face, *row)),
                }
            })
        });
        let missing: Vec<([u32; M], [u32; N])> = missing.collect();
        // Of several simplices with a face, the first is named.
        let missing: BTreeMap<_, _> = missing.into_iter().rev().collect();
        let finding = |(face, of): ([u32; M], [u32; N])| Finding::MissingFace {
            face: face.into(),
            of: of.into(),
        };
        (around, missing.into_iter().map(finding).collect())
    }

    /// For each candidate the smallest corner opposite to it, in an exterior higher simplex, that
    /// is inside its sphere; else [`NONE`].
    fn neighbours_inside(&self, states: &[State], judge: &Judge) -> Vec<AtomicU32> {
        let refuters: Vec<AtomicU32> = states.iter().map(|_| AtomicU32::new(NONE)).collect();
        if !states.par_iter().any(|&state| state == State::Candidate) {
            return refuters;
        }
        let rows = self.higher.rows().par_iter().zip(self.verdicts);
        rows.filter(|(_, verdict)| verdict.class == Class::Exterior).for_each(|(row, _)| {
            for (corners, &opposite) in self.corners.iter().zip(row) {
                let face = corners.map(|k| row[k]);
                let at = self.index.row(face) as usize;
                if states.get(at) == Some(&State::Candidate) && judge.inside(face, opposite) {
                    refuters[at].fetch_min(opposite, Ordering::Relaxed);
                }
            }
        });
        refuters
    }
}

fn state<const M: usize>(row: [u32; M], around: &Around, judge: &Judge) -> State {
    match (around.has(Around::COVERED), around.has(Around::OPEN)) {
        (true, false) => State::Closed,
        (true, true) => State::Open,
        (false, _) if !judge.flat(row) && judge.small(row) => State::Candidate,
        (false, _) => State::Outside,
    }
}
