use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::ops::ControlFlow;

use dashu_int::IBig;
use serde::Serialize;
use walpha_base::{Cancelled, Monitor};
use walpha_complex::canonical::{outward_facets, smallest_even, sorted};

use super::points::{CommonPositions, weights_by_position};
use crate::certify::{CertifyError, Claim, Verdict};
use crate::exact::{Exact, Lattice, Lift, WeightedPoint, orientation};
use crate::parallel::of_each;
use crate::schema::orient;
use crate::{Class, Placed};

/// The relation between the regions that the cells of two shapes cover.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Domain {
    /// The cells are the same.
    SameCells,
    /// The region is the same, but cut into other cells.
    SameRegion {
        /// Six times the volume of the region.
        six_volumes: Exact,
        /// Whether the cells that differ also cover the same region on each orthogonal sphere. If not, one of the two is not a
        /// regular triangulation.
        tied: bool,
        /// If they do, the verdicts on A and on B. This is a choice among ties only if neither is wrong: if more than four points
        /// lie on one empty sphere, their polytope may be cut in any way.
        #[serde(skip_serializing_if = "Option::is_none")]
        verdicts: Option<[Verdict; 2]>,
    },
    /// Different regions.
    Different {
        /// Six times the volume of A's cells.
        six_volumes_a: Exact,
        /// Six times the volume of B's cells.
        six_volumes_b: Exact,
    },
}

impl fmt::Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SameCells => write!(f, "domain: the same cells"),
            Self::SameRegion { six_volumes, verdicts, .. } => {
                let why = match verdicts {
                    None => {
                        "which are not on the same spheres: this is not a tie, and at most one of A and B is regular"
                    }
                    Some([Verdict::Wrong, Verdict::Wrong]) => {
                        "but A and B are wrong by themselves (check them)"
                    }
                    Some([Verdict::Wrong, _]) => "but A is wrong by itself (check it)",
                    Some([_, Verdict::Wrong]) => "but B is wrong by itself (check it)",
                    Some(_) => "as cospherical points allow: both are certified",
                };
                write!(
                    f,
                    "domain: the same region (same boundary, same exact volume {six_volumes}/6) cut into other cells, {why}"
                )
            }
            Self::Different { six_volumes_a, six_volumes_b } => write!(
                f,
                "domain: different regions (exact volumes {six_volumes_a}/6 in A, {six_volumes_b}/6 in B)"
            ),
        }
    }
}

/// Compares the regions that the interior cells cover, exactly.
///
/// Two sets of cells cover the same region if their boundaries are the same surface: their difference
/// would have no boundary. The boundaries are compared plane by plane, because a flat face may be cut
/// into other triangles: within a plane, two sets of triangles cover the same region if their
/// boundaries cancel, edge by directed edge.
pub(super) fn compare(
    a: Placed,
    b: Placed,
    common: &CommonPositions,
    monitor: &Monitor,
) -> Result<Domain, Cancelled> {
    let in_a = interior_cells(a, &common.a, common, &monitor.part(0, 1, 8))?;
    let in_b = interior_cells(b, &common.b, common, &monitor.part(1, 2, 8))?;
    if in_a == in_b {
        return Ok(Domain::SameCells);
    }
    let lattice = Lattice::through(common.positions.iter().copied());
    let six_volumes = |cells: &BTreeSet<[u32; 4]>, from: u64| {
        let cells: Vec<_> = cells.iter().map(|cell| at(common, *cell)).collect();
        let monitor = monitor.part(from, from + 1, 16);
        let sum = lattice.six_volumes(cells.len(), &monitor, |i| cells[i])?;
        Ok(Exact::integer(sum, 3 * i64::from(lattice.exponent())))
    };
    let (six_volumes_a, six_volumes_b) = (six_volumes(&in_a, 4)?, six_volumes(&in_b, 5)?);
    Ok(if six_volumes_a == six_volumes_b && same_surface(&in_a, &in_b, common, lattice) {
        monitor.report(4, 8)?;
        let (of_a, of_b) = (Side::new(a, &common.a, &in_a), Side::new(b, &common.b, &in_b));
        let tied = tied(of_a, of_b, common, &monitor.unreported())?;
        monitor.report(5, 8)?;
        let verdicts = if tied {
            let of_a = verdict(a, &monitor.part(5, 6, 8))?;
            Some([of_a, verdict(b, &monitor.part(6, 7, 8))?])
        } else {
            None
        };
        Domain::SameRegion { six_volumes: six_volumes_a, tied, verdicts }
    } else {
        Domain::Different { six_volumes_a, six_volumes_b }
    })
}

/// The verdict on a complex whose simplices are oriented canonically first, because windings are not compared. A complex that
/// cannot be judged counts as wrong.
fn verdict(placed: Placed, monitor: &Monitor) -> Result<Verdict, Cancelled> {
    let mut complex = placed.complex.clone();
    orient(&mut complex, placed.positions, None);
    // Regions are those of cells.
    let claim = Claim::new(placed.with_complex(&complex)).with_lowest(3);
    match monitor.watch(|| claim.visit(&mut |_| ControlFlow::Continue(()))) {
        Ok(certificate) => Ok(certificate.verdict),
        Err(CertifyError::Cancelled(cancelled)) => Err(cancelled),
        Err(_) => Ok(Verdict::Wrong),
    }
}

/// The interior cells in terms of positions, positively oriented, without flat ones.
fn interior_cells(
    Placed { complex, .. }: Placed,
    position: &[u32],
    common: &CommonPositions,
    monitor: &Monitor,
) -> Result<BTreeSet<[u32; 4]>, Cancelled> {
    let (rows, classes) = (complex.cells.rows(), complex.cells.classes());
    let oriented = of_each(rows.len(), monitor, |i| {
        if classes[i] != Class::Interior {
            return None;
        }
        let [a, b, c, d] = rows[i].map(|v| position[v as usize]);
        let [p, q, r, s] = at(common, [a, b, c, d]);
        let cell = match orientation(p, q, r, s) {
            std::cmp::Ordering::Greater => [a, b, c, d],
            std::cmp::Ordering::Less => [a, b, d, c],
            std::cmp::Ordering::Equal => return None,
        };
        Some(smallest_even(cell))
    })?;
    Ok(oriented.into_iter().collect())
}

/// The cells of a complex, and the largest weight at each position.
struct Side<'a> {
    cells: &'a BTreeSet<[u32; 4]>,
    weights: Vec<f64>,
}

impl<'a> Side<'a> {
    fn new(placed: Placed, position: &[u32], cells: &'a BTreeSet<[u32; 4]>) -> Self {
        Self { cells, weights: weights_by_position(placed.weights, position) }
    }
}

/// Whether the cells that only one has cover the same region with the same lifted heights: for each
/// hyperplane, and so for each orthogonal sphere, cells of A and of B must cover the same region.
fn tied(a: Side, b: Side, common: &CommonPositions, monitor: &Monitor) -> Result<bool, Cancelled> {
    let corner = |side: &Side, position: u32| WeightedPoint {
        position: common.positions[position as usize],
        weight: side.weights[position as usize],
    };
    let only = [(&a, a.cells - b.cells), (&b, b.cells - a.cells)];
    let corners = only.iter().flat_map(|(side, cells)| {
        cells.iter().flatten().map(move |&position| corner(side, position))
    });
    let lift = Lift::through(corners);
    let mut spheres = BTreeMap::<[IBig; 5], [BTreeSet<[u32; 4]>; 2]>::new();
    for (which, (side, cells)) in only.iter().enumerate() {
        for cell in cells {
            let plane = lift.hyperplane(cell.map(|position| corner(side, position)));
            spheres.entry(plane).or_default()[which].insert(*cell);
        }
    }
    let lattice = Lattice::through(common.positions.iter().copied());
    let volume = |cells: &BTreeSet<[u32; 4]>| {
        let cells: Vec<_> = cells.iter().map(|cell| at(common, *cell)).collect();
        lattice.six_volumes(cells.len(), monitor, |i| cells[i])
    };
    for [a, b] in spheres.values() {
        if volume(a)? != volume(b)? || !same_surface(a, b, common, lattice) {
            return Ok(false);
        }
    }
    Ok(true)
}

fn same_surface(
    a: &BTreeSet<[u32; 4]>,
    b: &BTreeSet<[u32; 4]>,
    common: &CommonPositions,
    lattice: Lattice,
) -> bool {
    // Facets as a chain: +1 for each cell of A behind them, −1 for each of B. The two sides of a
    // facet cancel.
    let mut chain = BTreeMap::<[u32; 3], i64>::new();
    for (cells, sign) in [(a.difference(b), 1), (b.difference(a), -1)] {
        for facet in cells.flat_map(|cell| outward_facets(*cell)) {
            let key = sorted(facet);
            let turn = if smallest_even(facet) == key { sign } else { -sign };
            *chain.entry(key).or_default() += turn;
        }
    }
    let mut planes = BTreeMap::<[IBig; 4], BTreeMap<[u32; 2], i64>>::new();
    for ([u, v, w], turns) in chain.into_iter().filter(|(_, turns)| *turns != 0) {
        let border = planes.entry(lattice.plane(at(common, [u, v, w]))).or_default();
        // The rows are sorted, so u → v → w → u has the edges uv, vw forward and uw backward.
        for (edge, sign) in [([u, v], 1), ([v, w], 1), ([u, w], -1)] {
            *border.entry(edge).or_default() += sign * turns;
        }
    }
    planes.values().flat_map(BTreeMap::values).all(|&turns| turns == 0)
}

fn at<const N: usize>(common: &CommonPositions, row: [u32; N]) -> [[f64; 3]; N] {
    row.map(|v| common.positions[v as usize])
}
