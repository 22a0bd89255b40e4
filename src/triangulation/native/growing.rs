//! A Delaunay triangulation that points join and leave again.

use std::collections::HashSet;
use std::ops::Range;

use super::super::predicates::{Predicates, Screen};
use super::super::{Cell, GONE, Sites, TriangulationError, curve};
use super::leave::{Digger, Hole};
use super::{Native, rounds};

/// The Delaunay triangulation of points that come in batches, and may leave one by one.
///
/// Ties are broken as ever, so it is that of the points in it and of nothing else: not of the order in
/// which they came, nor of those that left. Points have numbers in the order in which they are
/// named, from [`Growing::FIRST`] on; what has a number need not be in it.
pub(crate) struct Growing {
    positions: Vec<[f64; 3]>,
    weights: Vec<f64>,
    body: Body,
}

/// What would come with a point.
pub(crate) struct Crown {
    /// Cells that would go, infinite ones among them.
    pub goes: Vec<u32>,
    /// The finite cells that would come.
    pub cells: Vec<[u32; 4]>,
}

/// What changes when a point comes or leaves.
pub(super) struct Body {
    pub native: Native,
    /// The places of vertices, so that no two stand at one.
    taken: HashSet<[u64; 3]>,
    /// A cell at each vertex; [`NONE`] at other points.
    pub at: Vec<u32>,
    /// Cells made since they were last asked for, some of them gone again.
    fresh: Vec<u32>,
}

/// The number before that of the first point.
pub(super) const GHOST: u32 = 0;
/// The cell at a point that is not a vertex.
pub(super) const NONE: u32 = u32::MAX;

impl Growing {
    /// The number of the first point.
    pub(crate) const FIRST: u32 = GHOST + 1;

    /// The triangulation of some points.
    ///
    /// # Errors
    /// Points that are not sites or span no volume; no memory.
    pub(crate) fn new(positions: &[[f64; 3]]) -> Result<Self, TriangulationError> {
        Sites::new(positions, &vec![0.0; positions.len()])?;
        let native = Native::empty(positions.len(), positions.len() + 1, GHOST)?;
        let (taken, at, fresh) = (HashSet::new(), vec![NONE], Vec::new());
        let mut growing = Self {
            // A place for the ghost, which makes no bound wider.
            positions: vec![positions[0]],
            weights: vec![0.0],
            body: Body { native, taken, at, fresh },
        };
        let all = growing.name(positions);
        let Self { positions, weights, body } = &mut growing;
        let predicates = Predicates::new(positions, weights);
        let screen = Screen::haunted(&predicates, GHOST)?;
        body.native.begin(&screen, all.clone())?;
        (0..body.native.mesh.cells.len() as u32).for_each(|cell| body.note(cell));
        for v in body.native.first {
            body.taken.insert(place(positions[v as usize]));
        }
        body.insert_all(positions, &screen, &all.collect::<Vec<_>>())?;
        Ok(growing)
    }

    /// Gives points numbers; they are not vertices yet.
    pub(crate) fn name(&mut self, positions: &[[f64; 3]]) -> Range<u32> {
        let first = self.positions.len() as u32;
        self.positions.extend_from_slice(positions);
        let count = self.positions.len();
        self.weights.resize(count, 0.0);
        self.body.at.resize(count, NONE);
        self.body.native.cavity.admit(count);
        first..count as u32
    }

    /// Makes points vertices. One at the place of a vertex stays out.
    ///
    /// # Errors
    /// Too many cells, no memory.
    pub(crate) fn insert(&mut self, points: &[u32]) -> Result<(), TriangulationError> {
        let Self { positions, weights, body } = self;
        let predicates = Predicates::new(positions, weights);
        body.insert_all(positions, &Screen::haunted(&predicates, GHOST)?, points)
    }

    /// Removes vertices, other than those around which no triangulation would be left. Gives the number of
    /// those that left.
    ///
    /// # Errors
    /// Too many cells, no memory.
    pub(crate) fn remove(&mut self, points: &[u32]) -> Result<usize, TriangulationError> {
        let Self { positions, weights, body } = self;
        let predicates = Predicates::new(positions, weights);
        let screen = Screen::haunted(&predicates, GHOST)?;
        let mut digger = Digger::new(positions.len())?;
        let mut left = 0;
        for &v in points {
            if let Some(hole) = body.hole(&screen, v, &mut digger)? {
                body.close(v, &hole)?;
                body.taken.remove(&place(positions[v as usize]));
                left += 1;
            }
        }
        body.mark_gone();
        Ok(left)
    }

    /// What the [`Screen`](Self::screen) of all points with numbers begins with.
    pub(crate) fn predicates(&self) -> Predicates<'_> {
        Predicates::new(&self.positions, &self.weights)
    }

    /// Tests for [`Self::hole`] and [`Self::crown`].
    pub(crate) fn screen<'a>(
        predicates: &'a Predicates<'a>,
    ) -> Result<Screen<'a>, TriangulationError> {
        Screen::haunted(predicates, GHOST)
    }

    /// What would come in the place of a vertex; `None` where no triangulation would be left.
    pub(crate) fn hole(
        &self,
        screen: &Screen<'_>,
        v: u32,
        digger: &mut Digger,
    ) -> Result<Option<Hole>, TriangulationError> {
        self.body.hole(screen, v, digger)
    }

    /// What would come with a point that lies in a cell, and is not a vertex.
    pub(crate) fn crown(&self, screen: &Screen<'_>, v: u32, cell: u32) -> Crown {
        let mesh = &self.body.native.mesh;
        let (mut goes, mut stays, mut cells) = (vec![cell], Vec::new(), Vec::new());
        let mut at = 0;
        while let Some(&cell) = goes.get(at) {
            at += 1;
            let Cell { corners, beside } = mesh.cells[cell as usize];
            for k in 0..4 {
                let next = beside[k] / 4;
                if goes.contains(&next) {
                    continue;
                }
                if !stays.contains(&next) && mesh.conflicts(screen, next, v) {
                    goes.push(next);
                } else {
                    stays.push(next);
                    let mut joined = corners;
                    joined[k] = v;
                    cells.push(joined);
                }
            }
        }
        cells.retain(|cell| !cell.contains(&GHOST));
        Crown { goes, cells }
    }

    /// Whether a point is a vertex.
    pub(crate) fn is_vertex(&self, v: u32) -> bool {
        self.body.at[v as usize] != NONE
    }

    /// The corners of each cell and 4·cell + corner across each facet. Some are gone.
    pub(crate) fn cells(&self) -> &[Cell] {
        &self.body.native.mesh.cells
    }

    /// Whether there is a finite cell of this number.
    pub(crate) fn is_cell(&self, cell: u32) -> bool {
        let [a, b, c, d] = self.cells()[cell as usize].corners;
        a != GONE && a != GHOST && b != GHOST && c != GHOST && d != GHOST
    }

    /// The finite cells made since this was last asked, ascending.
    pub(crate) fn take_fresh(&mut self) -> Vec<u32> {
        let mut made = vec![false; self.cells().len()];
        std::mem::take(&mut self.body.fresh).iter().for_each(|&cell| made[cell as usize] = true);
        let fresh = (0..).zip(made).filter(|&(cell, made)| made && self.is_cell(cell));
        fresh.map(|(cell, _)| cell).collect()
    }

    /// Where points stand, by number.
    pub(crate) fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }
}

impl Body {
    fn insert_all(
        &mut self,
        positions: &[[f64; 3]],
        screen: &Screen<'_>,
        points: &[u32],
    ) -> Result<(), TriangulationError> {
        let places: Vec<_> = points.iter().map(|&v| positions[v as usize]).collect();
        let along = curve::keyed(&places);
        for i in rounds(points.len() as u32) {
            let v = points[along[i as usize].1 as usize];
            if self.taken.insert(place(positions[v as usize])) && self.native.insert(screen, v)? {
                for at in 0..self.native.cavity.made().len() {
                    self.note(self.native.cavity.made()[at]);
                }
            }
        }
        self.mark_gone();
        Ok(())
    }

    /// Marks the places of cells that are gone.
    fn mark_gone(&mut self) {
        let Native { free, mesh, .. } = &mut self.native;
        free.iter().for_each(|&place| mesh.cells[place as usize].corners[0] = GONE);
    }

    /// Takes note of a new cell.
    pub(super) fn note(&mut self, cell: u32) {
        self.fresh.push(cell);
        for v in self.native.mesh.cells[cell as usize].corners {
            self.at[v as usize] = cell;
        }
    }
}

/// Equal places have equal bits: adding 0.0 turns −0.0 into 0.0.
fn place(position: [f64; 3]) -> [u64; 3] {
    position.map(|x| (x + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::super::super::{Maker, triangulate};
    use super::*;
    use proptest::prelude::*;

    /// The finite cells as places, corners and cells in order.
    fn cells(rows: impl Iterator<Item = [u32; 4]>, positions: &[[f64; 3]]) -> Vec<[[u64; 3]; 4]> {
        let mut cells: Vec<_> = rows
            .map(|row| {
                let mut corners = row.map(|v| place(positions[v as usize]));
                corners.sort_unstable();
                corners
            })
            .collect();
        cells.sort_unstable();
        cells
    }

    fn from_the_start(positions: &[[f64; 3]]) -> Vec<[[u64; 3]; 4]> {
        let weights = vec![0.0; positions.len()];
        let made = triangulate(&Sites::new(positions, &weights).unwrap(), Maker::Native).unwrap();
        let finite = made.cells().iter().filter(|cell| !cell.contains(&made.ghost()));
        cells(finite.copied(), positions)
    }

    fn agree(growing: &Growing, when: &str) {
        let there: Vec<[f64; 3]> = (Growing::FIRST..growing.positions().len() as u32)
            .filter(|&v| growing.is_vertex(v))
            .map(|v| growing.positions()[v as usize])
            .collect();
        let finite = (0..growing.cells().len() as u32).filter(|&cell| growing.is_cell(cell));
        let rows = finite.map(|cell| growing.cells()[cell as usize].corners);
        assert!(cells(rows, growing.positions()) == from_the_start(&there), "{when}: {there:?}");
    }

    /// The corners of a box, and points in it, on its sides and on its edges.
    fn in_a_box() -> impl Strategy<Value = (Vec<[f64; 3]>, f64)> {
        let inside = prop::collection::btree_set([0..5u8, 0..5u8, 0..5u8], 20..70);
        (inside, prop_oneof![Just(1.0), Just(0.1)]).prop_map(|(inside, step)| {
            let corners = (0..8u8).map(|i| [4 * (i & 1), 4 * (i >> 1 & 1), 4 * (i >> 2)]);
            let mut all: Vec<[u8; 3]> = corners.collect();
            all.extend(inside.into_iter().filter(|p| p.iter().any(|x| x % 4 != 0)));
            (all.into_iter().map(|p| p.map(|x| step * f64::from(x))).collect(), step)
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

        #[test]
        fn it_is_that_of_the_points_in_it(
            (points, step) in in_a_box(), cut in 8..20usize,
            leave in prop::collection::vec(any::<prop::sample::Index>(), 1..30),
        ) {
            let mut growing = Growing::new(&points[..cut]).unwrap();
            agree(&growing, "of the first");
            let rest: Vec<u32> = growing.name(&points[cut..]).collect();
            growing.insert(&rest).unwrap();
            agree(&growing, "with more");
            let inner = points.len() - 8;
            let mut leave: Vec<u32> =
                leave.iter().map(|i| Growing::FIRST + 8 + i.index(inner) as u32).collect();
            leave.sort_unstable();
            leave.dedup();
            let left = growing.remove(&leave).unwrap();
            // Rounded places may lie outside the box of the others.
            prop_assert!(left == leave.len() || step != 1.0);
            agree(&growing, "without some");
            let gone: Vec<u32> = leave.into_iter().filter(|&v| !growing.is_vertex(v)).collect();
            growing.insert(&gone).unwrap();
            agree(&growing, "with them again");
        }

        #[test]
        fn looks_tell_what_comes((points, _) in in_a_box(), pick in any::<prop::sample::Index>()) {
            let mut growing = Growing::new(&points[..points.len() - 1]).unwrap();
            let [v] = growing.name(&points[points.len() - 1..]).collect::<Vec<_>>()[..] else {
                panic!("one point");
            };
            growing.take_fresh();
            let crowns: Vec<Crown> = {
                let predicates = growing.predicates();
                let screen = Growing::screen(&predicates).unwrap();
                let holds = |cell: &u32| {
                    let cell = growing.cells()[*cell as usize].corners;
                    (0..4).all(|k| {
                        let mut moved = cell;
                        moved[k] = v;
                        screen.orientation(moved).is_ge()
                    })
                };
                let finite = (0..growing.cells().len() as u32).filter(|&cell| growing.is_cell(cell));
                finite.filter(holds).map(|cell| growing.crown(&screen, v, cell)).collect()
            };
            growing.insert(&[v]).unwrap();
            let fresh = growing.take_fresh();
            let rows = fresh.iter().map(|&cell| growing.cells()[cell as usize].corners);
            let come = cells(rows, growing.positions());
            for crown in &crowns {
                let foreseen = cells(crown.cells.iter().copied(), growing.positions());
                prop_assert_eq!(&foreseen, &come);
            }
            let leaves = Growing::FIRST + 8 + pick.index(points.len() - 8) as u32;
            let foreseen = {
                let predicates = growing.predicates();
                let screen = Growing::screen(&predicates).unwrap();
                let mut digger = Digger::new(growing.positions().len()).unwrap();
                let hole = growing.hole(&screen, leaves, &mut digger).unwrap();
                hole.map(|hole| {
                    let rows = hole.filling.iter().map(|cell| cell.corners);
                    cells(rows.filter(|row| !row.contains(&GHOST)), growing.positions())
                })
            };
            if let Some(foreseen) = foreseen {
                growing.remove(&[leaves]).unwrap();
                let fresh = growing.take_fresh();
                let rows = fresh.iter().map(|&cell| growing.cells()[cell as usize].corners);
                prop_assert_eq!(foreseen, cells(rows, growing.positions()));
            }
        }
    }
}
