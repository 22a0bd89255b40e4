use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use dashu_int::IBig;
use serde::Serialize;
use walpha_complex::canonical::{outward_facets, smallest_even, sorted};

use super::places::{Places, weights_by_place};
use crate::exact::{Exact, Lattice, Lift, WeightedPoint, orientation};
use crate::schema::turn;
use crate::{Claim, Class, Placed, Verdict};

/// What the cells of two shapes cover.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Domain {
    /// The same cells.
    SameCells,
    /// The same region, cut into other cells.
    SameRegion {
        /// Six times the volume of the region.
        six_volumes: Exact,
        /// Whether the cells that differ also cover the same on each orthogonal sphere. If not, one of
        /// the two is not a regular triangulation.
        tied: bool,
        /// Where they do, what A and B are found to be each by itself. Only if neither is wrong is this a
        /// choice: where more than four points lie on one empty sphere, their polytope may be cut in
        /// any way.
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
                        "which are not on the same spheres: no tie, and at most one of A and B is regular"
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
/// Two sets of cells cover the same region if their boundaries are the same surface: what is in
/// one region only would have no boundary. The boundaries are compared plane by plane, because
/// a flat face may be cut into other triangles: within a plane, two sets of triangles cover the
/// same if their boundaries cancel, edge by directed edge.
pub(super) fn compare(a: Placed, b: Placed, places: &Places) -> Domain {
    let in_a = interior_cells(a, &places.a, places);
    let in_b = interior_cells(b, &places.b, places);
    if in_a == in_b {
        return Domain::SameCells;
    }
    let lattice = Lattice::through(&places.positions);
    let six_volumes = |cells: &BTreeSet<[u32; 4]>| {
        let cells: Vec<_> = cells.iter().map(|cell| at(places, *cell)).collect();
        let sum = lattice.six_volumes(cells.len(), |i| cells[i]);
        Exact::integer(sum, 3 * i64::from(lattice.exponent()))
    };
    let (six_volumes_a, six_volumes_b) = (six_volumes(&in_a), six_volumes(&in_b));
    if six_volumes_a == six_volumes_b && same_surface(&in_a, &in_b, places, lattice) {
        let tied = tied(Side::new(a, &places.a, &in_a), Side::new(b, &places.b, &in_b), places);
        let verdicts = tied.then(|| [a, b].map(verdict));
        Domain::SameRegion { six_volumes: six_volumes_a, tied, verdicts }
    } else {
        Domain::Different { six_volumes_a, six_volumes_b }
    }
}

/// What a complex is found to be, with its simplices turned the canonical way, as windings are not compared.
/// What cannot be judged is not excused.
fn verdict(placed: Placed) -> Verdict {
    let mut complex = placed.complex.clone();
    turn(&mut complex, placed.positions, None);
    Claim::new(placed.with_complex(&complex)).verdict().unwrap_or(Verdict::Wrong)
}

/// The interior cells by places, positively oriented, flat ones left out.
fn interior_cells(
    Placed { complex, .. }: Placed,
    place: &[u32],
    places: &Places,
) -> BTreeSet<[u32; 4]> {
    let cells = complex.cells.of(Class::Interior);
    let oriented = cells.filter_map(|cell| {
        let [a, b, c, d] = cell.map(|v| place[v as usize]);
        let [p, q, r, s] = at(places, [a, b, c, d]);
        match orientation(p, q, r, s) {
            std::cmp::Ordering::Greater => Some([a, b, c, d]),
            std::cmp::Ordering::Less => Some([a, b, d, c]),
            std::cmp::Ordering::Equal => None,
        }
    });
    oriented.map(smallest_even).collect()
}

/// The cells of a complex, and the weight at each place that it has a point at.
struct Side<'a> {
    cells: &'a BTreeSet<[u32; 4]>,
    weights: Vec<f64>,
}

impl<'a> Side<'a> {
    fn new(placed: Placed, place: &[u32], cells: &'a BTreeSet<[u32; 4]>) -> Self {
        Self { cells, weights: weights_by_place(placed.weights, place) }
    }
}

/// Whether the cells that only one has are the same regions with the same lifted heights: for each
/// hyperplane, and so for each orthogonal sphere, cells of A and of B must cover the same.
fn tied(a: Side, b: Side, places: &Places) -> bool {
    let corner = |side: &Side, place: u32| WeightedPoint {
        position: places.positions[place as usize],
        weight: side.weights[place as usize],
    };
    let only = [(&a, a.cells - b.cells), (&b, b.cells - a.cells)];
    let corners = only
        .iter()
        .flat_map(|(side, cells)| cells.iter().flatten().map(move |&place| corner(side, place)));
    let lift = Lift::through(corners);
    let mut spheres = BTreeMap::<[IBig; 5], [BTreeSet<[u32; 4]>; 2]>::new();
    for (which, (side, cells)) in only.iter().enumerate() {
        for cell in cells {
            let plane = lift.hyperplane(cell.map(|place| corner(side, place)));
            spheres.entry(plane).or_default()[which].insert(*cell);
        }
    }
    let lattice = Lattice::through(&places.positions);
    let volume = |cells: &BTreeSet<[u32; 4]>| {
        let cells: Vec<_> = cells.iter().map(|cell| at(places, *cell)).collect();
        lattice.six_volumes(cells.len(), |i| cells[i])
    };
    spheres.values().all(|[a, b]| volume(a) == volume(b) && same_surface(a, b, places, lattice))
}

fn same_surface(
    a: &BTreeSet<[u32; 4]>,
    b: &BTreeSet<[u32; 4]>,
    places: &Places,
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
        let border = planes.entry(lattice.plane(at(places, [u, v, w]))).or_default();
        // The rows are sorted, so u → v → w → u has the edges uv, vw forward and uw backward.
        for (edge, sign) in [([u, v], 1), ([v, w], 1), ([u, w], -1)] {
            *border.entry(edge).or_default() += sign * turns;
        }
    }
    planes.values().flat_map(BTreeMap::values).all(|&turns| turns == 0)
}

fn at<const N: usize>(places: &Places, row: [u32; N]) -> [[f64; 3]; N] {
    row.map(|v| places.positions[v as usize])
}
