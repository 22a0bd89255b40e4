//! Complexes of a torus: their copies in space around one box are judged.
//!
//! No edge may span half of the box. Then all simplices around a simplex that touches the box have their vertices in it or in a
//! neighbouring copy. So among 27 copies of the complex, the simplices that touch the middle one are judged as in space. If the
//! complex is whole (it lists exterior simplices, or α = ∞), the rules are those for a whole triangulation, except for the
//! boundary: there is none, so each facet is between two cells, and the volumes of the cells add up to the volume of the box, so
//! they cover it once. A shape alone is judged like one in space.
//!
//! Where points do not repeat along all vectors, there are as many copies fewer. The hull of all copies is then bounded by planes that are
//! parallel to the vectors. A facet with one cell must lie in one of them, and volumes add up to what the hull has of one box.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use walpha_base::sort::sort_by_key;
use walpha_base::{Cancelled, Monitor};
use walpha_complex::canonical::{outward_facets, sort, sorted};

use super::certificate::{Certificate, CertifyError, NotJudged, Verdict};
use super::claim::{Claim, Extent};
use super::finding::Finding;
use super::geometry;
use super::structure::{self, Points};
use crate::exact::{Exact, orientation};
use crate::period::Period;
use crate::schema::{BoxVectors, PlacedComplex};
use crate::{Alpha, Complex, Placed, Simplices};

/// The torus whose copies are in a complex in space.
#[derive(Clone, Copy)]
pub(super) struct Torus {
    /// The number of points in the box. They come before all copies.
    pub points: u32,
    /// Half of the diagonal, rounded up: the centre of an empty sphere is no farther from a vertex. Where points do not repeat along all vectors, half
    /// of the greatest distance of a vertex from a point that refutes its sphere, of which one copy is at most a diagonal away along the vectors.
    pub largest_empty: f64,
    /// Along which vectors points repeat.
    repeats: [bool; 3],
}

impl Torus {
    /// The copies of a simplex in the layout, including the simplex itself.
    pub(super) fn copies(self, row: &[u32]) -> Vec<Vec<u32>> {
        let moves = moves(self.repeats);
        let copy = |by: [i32; 3]| {
            let copied = row.iter().map(|&v| {
                let from = moves[(v / self.points) as usize];
                let to = [0, 1, 2].map(|k| from[k] + by[k]);
                let number = moves.iter().position(|moved| *moved == to)?;
                Some(number as u32 * self.points + v % self.points)
            });
            copied.collect::<Option<Vec<u32>>>()
        };
        let ways = (0..125).map(|i| [i / 25 - 2, i / 5 % 5 - 2, i % 5 - 2]);
        ways.filter_map(copy).collect()
    }

    /// Whether points do not repeat along all vectors, so that there is something outside their hull.
    pub(super) fn has_hull(self) -> bool {
        self.repeats != [true; 3]
    }

    fn new(positions: &[[f64; 3]], period: &Period) -> Self {
        let repeats = period.repeats();
        // A copy of the heaviest point is within half a diagonal of any centre.
        let mut largest_empty = period.reach();
        if repeats != [true; 3] {
            let side = |axis: usize| {
                let along = || positions.iter().map(|position| position[axis]);
                along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
            };
            let across = side(0).hypot(side(1)).hypot(side(2)) / 2.0;
            largest_empty = 1.0001 * largest_empty.hypot(across);
        }
        Self { points: positions.len() as u32, largest_empty, repeats }
    }
}

/// All broken rules of a complex of a torus with these vectors, and the certificate.
///
/// # Errors
/// [`CertifyError`]; points whose copies cannot be represented exactly.
pub(super) fn findings(
    placed: &PlacedComplex,
    vectors: BoxVectors,
    monitor: &Monitor,
) -> Result<(Vec<Finding>, Certificate), CertifyError> {
    let period = &Period::new(vectors);
    if let Some(index) = placed.positions.iter().position(|&position| !period.holds(position)) {
        return Err(CertifyError::NotInBox(index));
    }
    let mut broken = structure::rows(&placed.complex, placed.positions.len());
    if broken.is_empty() {
        broken.extend(long_edges(placed, period));
    }
    if !broken.is_empty() {
        let certificate = Certificate {
            verdict: Verdict::Wrong,
            findings: broken.len(),
            ties: 0,
            six_volumes: Exact::default(),
            not_judged: vec![NotJudged::AfterFindings],
        };
        return Ok((broken, certificate));
    }
    let mut extent = Extent::of(&placed.complex, placed.alpha);
    let mut copies = Copies::of(placed, period);
    let torus = Torus::new(&placed.positions, period);
    if torus.has_hull() && placed.complex.cells.is_empty() {
        // Of points in a plane or on a line, the shape is judged by itself.
        extent = Extent::Shape;
        copies.complex.retain_shape();
    }
    let count = torus.points;
    let (all, mut certificate) = copies.claim(extent).findings_on(Some(torus), monitor)?;
    let mut seen = BTreeSet::new();
    let near = all.into_iter().filter_map(|finding| finding.at_box(count));
    let mut found: Vec<Finding> =
        near.filter(|finding| seen.insert(format!("{finding:?}"))).collect();
    let whole = extent == Extent::Whole;
    if whole && torus.has_hull() {
        let hull = Hull::of(&placed.positions, period);
        let open = copies.open_facets(count);
        let wrong = open.into_iter().filter(|&facet| !hull.has(facet, &copies.positions));
        found.extend(
            wrong.filter_map(|facet| Finding::OpenFacet { facet: facet.into() }.at_box(count)),
        );
    }
    let (volume, missing) = copies.volume(count, period, &monitor.unreported())?;
    certificate.six_volumes = volume;
    if whole {
        found.extend(missing);
    }
    if placed.copies > 1 {
        let count = placed.points_in_box() as u32;
        let mut seen = BTreeSet::new();
        found = found.into_iter().filter_map(|finding| finding.at_box(count)).collect();
        found.retain(|finding| seen.insert(format!("{finding:?}")));
    }
    certificate.findings = found.len();
    certificate.ties = found.iter().filter(|finding| finding.is_tie()).count();
    certificate.conclude();
    Ok((found, certificate))
}

fn long_edges(placed: &PlacedComplex, period: &Period) -> Vec<Finding> {
    let is_long = |&&[a, b]: &&[u32; 2]| {
        let [p, q] = [a, b].map(|v| placed.positions[v as usize]);
        period.is_long(p, q)
    };
    let long = placed.complex.edges.rows().iter().filter(is_long);
    long.map(|&edge| Finding::LongEdge { edge: edge.into() }).collect()
}

/// Copies of a complex, those of the box itself first.
struct Copies {
    positions: Vec<[f64; 3]>,
    weights: Vec<f64>,
    alpha: Alpha,
    complex: Complex,
    hidden: Option<Vec<u32>>,
    duplicates: Option<Vec<[u32; 2]>>,
    lowest: usize,
}

impl Copies {
    fn of(placed: &PlacedComplex, period: &Period) -> Self {
        let PlacedComplex { positions, weights, complex, .. } = placed;
        let layout = Layout::new(positions, period);
        let mut copied = Complex {
            cells: layout.copied(&complex.cells),
            facets: layout.copied(&complex.facets),
            edges: layout.copied(&complex.edges),
            vertices: layout.copied(&complex.vertices),
        };
        sort(&mut copied);
        let pairs = |pairs: &Vec<[u32; 2]>| {
            layout.of_each(pairs.as_flattened()).as_chunks::<2>().0.to_vec()
        };
        let moves = &layout.moves;
        Self {
            positions: (moves.iter())
                .flat_map(|&by| positions.iter().map(move |&position| period.moved(position, by)))
                .collect(),
            weights: moves.iter().flat_map(|_| weights.iter().copied()).collect(),
            alpha: placed.alpha,
            complex: copied,
            hidden: placed.hidden.as_deref().map(|hidden| layout.of_each(hidden)),
            duplicates: placed.duplicates.as_ref().map(pairs),
            lowest: placed.lowest,
        }
    }

    fn claim(&self, extent: Extent) -> Claim<'_> {
        let placed = Placed::new(&self.positions, &self.weights, self.alpha, &self.complex);
        let claim = Claim::new(placed).with_extent(extent);
        claim
            .with_hidden(self.hidden.as_deref())
            .with_duplicates(self.duplicates.as_deref())
            .with_lowest(self.lowest)
    }

    /// The facets of only one cell that have a vertex in the box, counter-clockwise seen from the other side.
    fn open_facets(&self, count: u32) -> Vec<[u32; 3]> {
        let mut sides = BTreeMap::<[u32; 3], Vec<[u32; 3]>>::new();
        for &cell in self.complex.cells.rows() {
            for facet in outward_facets(cell) {
                if facet.iter().any(|&v| v < count) {
                    sides.entry(sorted(facet)).or_default().push(facet);
                }
            }
        }
        sides.into_values().filter(|sides| sides.len() == 1).map(|sides| sides[0]).collect()
    }

    /// Six times the volume of the cells of one box, and a finding if they do not fill it.
    fn volume(
        &self,
        count: u32,
        period: &Period,
        monitor: &Monitor,
    ) -> Result<(Exact, Option<Finding>), Cancelled> {
        // Each cell once: the copy whose smallest vertex, by its number in the box, is in the box.
        let of_box =
            |cell: &&[u32; 4]| cell.iter().min_by_key(|&&v| v % count).is_some_and(|&v| v < count);
        let cells: Vec<_> = self.complex.cells.rows().iter().filter(of_box).copied().collect();
        let sites = structure::sites(&self.positions, &self.weights);
        let points = Points { sites: &sites };
        let (corners, of_hull) = if period.repeats() == [true; 3] {
            (period.corners().to_vec(), BOX.to_vec())
        } else {
            Hull::of(&self.positions[..count as usize], period).cells(period)
        };
        let corners = structure::sites(&corners, &vec![0.0; corners.len()]);
        let corners = Points { sites: &corners };
        let volume = |cells: &[[u32; 4]], points: Points| {
            let (sum, exponent) = geometry::six_volumes(cells, points, monitor)?;
            Ok(Exact::integer(sum, exponent))
        };
        let (cells, hull) = (volume(&cells, points)?, volume(&of_hull, corners)?);
        let found = (cells != hull).then(|| Finding::Volume { cells: cells.clone(), hull });
        Ok((cells, found))
    }
}

/// A box cut into cells around its diagonal, positively oriented; the bits of a corner are its vectors.
const BOX: [[u32; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// The hull of all copies of points that repeat along one or two vectors, which is bounded by planes that are parallel to these.
struct Hull {
    /// Of a slab, a point of the plane below and one of the plane above; of a rod, a point of each line in which two planes meet, counter-clockwise.
    corners: Vec<[f64; 3]>,
    vectors: Vec<[f64; 3]>,
}

impl Hull {
    fn of(positions: &[[f64; 3]], period: &Period) -> Self {
        let vectors = period.repeating();
        let first = positions[0];
        let corners = match vectors[..] {
            [u, v] => {
                let higher = |p: [f64; 3], q: [f64; 3]| orientation(p, sum(p, u), sum(p, v), q);
                let extreme = |sign: Ordering| {
                    positions.iter().fold(first, |p, &q| if higher(p, q) == sign { q } else { p })
                };
                vec![extreme(Ordering::Less), extreme(Ordering::Greater)]
            }
            _ => around(positions, vectors[0]),
        };
        Self { corners, vectors }
    }

    /// Whether all corners of a facet lie in one of the planes.
    fn has(&self, facet: [u32; 3], positions: &[[f64; 3]]) -> bool {
        let places = facet.map(|v| positions[v as usize]);
        let in_plane = |origin: [f64; 3], one: [f64; 3], other: [f64; 3]| {
            places.iter().all(|&place| orientation(origin, one, other, place).is_eq())
        };
        if let [u, v] = self.vectors[..] {
            return self.corners.iter().any(|&p| in_plane(p, sum(p, u), sum(p, v)));
        }
        let next = self.corners.iter().cycle().skip(1);
        let mut sides = self.corners.iter().zip(next);
        sides.any(|(&p, &q)| in_plane(p, q, sum(p, self.vectors[0])))
    }

    /// Cells that together have the volume of the hull in one box, some of them several times: by their corners.
    fn cells(&self, period: &Period) -> (Vec<[f64; 3]>, Vec<[u32; 4]>) {
        let mut corners = self.corners.clone();
        let first = corners[0];
        let count = corners.len() as u32;
        corners.extend(period.repeating().into_iter().map(|vector| sum(first, vector)));
        let cells = if self.vectors.len() == 2 {
            // A sixth of a box with these edges.
            vec![[0, 2, 3, 1]; 6]
        } else {
            // A third of a prism with these edges.
            (2..count).flat_map(|i| [[0, i - 1, i, count]; 3]).collect()
        };
        (corners, cells)
    }
}

/// The corners of the hull of points as seen along a vector, counter-clockwise as seen against it.
fn around(positions: &[[f64; 3]], vector: [f64; 3]) -> Vec<[f64; 3]> {
    let size = |axis: usize| vector[axis].abs();
    let longest = (0..3).max_by(|&a, &b| size(a).total_cmp(&size(b))).unwrap_or(0);
    // Two coordinates across the vector. Where it does not lead along an axis, differences along the axis are not multiplied, and those along the
    // others are exact.
    let across = [1, 2].map(|step| {
        let mut axis = [0.0; 3];
        axis[(longest + step) % 3] = 1.0;
        axis
    });
    let order = |p: [f64; 3], q: [f64; 3]| {
        let way = [0, 1, 2].map(|axis| q[axis] - p[axis]);
        let [one, other] = across.map(|axis| orientation([0.0; 3], way, axis, vector));
        one.then(other)
    };
    let turn = |p: [f64; 3], q: [f64; 3], r: [f64; 3]| orientation(p, q, r, sum(p, vector));
    // The first in this order is a corner.
    let first =
        positions.iter().fold(positions[0], |p, &q| if order(p, q).is_lt() { q } else { p });
    let mut corners = vec![first];
    loop {
        let from = corners[corners.len() - 1];
        // The next corner: no point is to its right, and of several on one line it is the farthest.
        let next = positions.iter().fold(from, |best, &place| {
            let is_beyond = match turn(from, best, place) {
                Ordering::Less => true,
                Ordering::Greater => false,
                Ordering::Equal => {
                    order(from, best).is_eq() || order(from, best) == order(best, place)
                }
            };
            if is_beyond && order(from, place).is_ne() { place } else { best }
        });
        if order(next, first).is_eq() || corners.len() > positions.len() {
            return corners;
        }
        corners.push(next);
    }
}

fn sum(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| p[axis] + q[axis])
}

/// The multiples of the vectors by which each copy of the box is moved; 0 for the first.
fn moves(repeats: [bool; 3]) -> Vec<[i32; 3]> {
    let mut moves: Vec<[i32; 3]> = (0..27).map(|i| [i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1]).collect();
    moves.retain(|by| (0..3).all(|k| repeats[k] || by[k] == 0));
    sort_by_key(&mut moves, |by| *by != [0; 3]);
    moves
}

/// The numbering of copies.
struct Layout<'a> {
    positions: &'a [[f64; 3]],
    period: &'a Period,
    moves: Vec<[i32; 3]>,
    numbers: BTreeMap<[i32; 3], u32>,
}

impl<'a> Layout<'a> {
    /// Creates the layout of the copies that touch the box.
    fn new(positions: &'a [[f64; 3]], period: &'a Period) -> Self {
        let moves = moves(period.repeats());
        let numbers = moves.iter().copied().zip(0..).collect();
        Self { positions, period, moves, numbers }
    }

    /// The copies of simplices whose vertices are all in the box or in a neighbouring copy.
    fn copied<const N: usize>(&self, simplices: &Simplices<N>) -> Simplices<N> {
        let copies = simplices.iter().flat_map(|(&row, class)| {
            let ways = self.ways(row);
            let copy = move |by: &[i32; 3]| Some((self.row(row, ways, *by)?, class));
            self.moves.iter().filter_map(copy)
        });
        copies.collect()
    }

    /// For each vertex, the multiples of the vectors that move it to its copy nearest to the first.
    fn ways<const N: usize>(&self, row: [u32; N]) -> [[i32; 3]; N] {
        let place = |v: u32| self.positions[v as usize];
        row.map(|v| self.period.nearest_copy(place(row[0]), place(v)))
    }

    fn row<const N: usize>(
        &self,
        mut row: [u32; N],
        ways: [[i32; 3]; N],
        by: [i32; 3],
    ) -> Option<[u32; N]> {
        for (v, way) in row.iter_mut().zip(ways) {
            let by = [0, 1, 2].map(|k| by[k] + way[k]);
            *v += self.numbers.get(&by)? * self.positions.len() as u32;
        }
        Some(row)
    }

    /// The numbers of all copies of some points.
    fn of_each(&self, points: &[u32]) -> Vec<u32> {
        let count = self.positions.len() as u32;
        let copies = 0..self.moves.len() as u32;
        copies.flat_map(|copy| points.iter().map(move |v| copy * count + v)).collect()
    }
}
