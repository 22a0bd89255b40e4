//! Complexes of a torus: their copies in space around one box are judged.
//!
//! No edge may span half of the box. Then all simplices around a simplex that touches the box have their vertices in it or in a
//! neighbouring copy. So among 27 copies of the complex, the simplices that touch the middle one are judged as in space. If the
//! complex is whole (it lists exterior simplices, or α = ∞), the rules are those for a whole triangulation, except for the
//! boundary: there is none, so each facet is between two cells, and the volumes of the cells add up to the volume of the box, so
//! they cover it once. A shape alone is judged like one in space.

use std::collections::{BTreeMap, BTreeSet};

use walpha_base::{Cancelled, Monitor};
use walpha_complex::canonical::sort;

use super::certificate::{Certificate, CertifyError, NotJudged, Verdict};
use super::claim::{Claim, Extent};
use super::finding::Finding;
use super::geometry;
use super::structure::{self, Points};
use crate::exact::Exact;
use crate::period::Period;
use crate::schema::{BoxVectors, PlacedComplex};
use crate::{Alpha, Complex, Placed, Simplices};

/// The torus whose copies are in a complex in space.
#[derive(Clone, Copy)]
pub(super) struct Torus {
    /// The number of points in the box. They come before all copies.
    pub points: u32,
    /// Half of the diagonal, rounded up: the centre of an empty sphere is no farther from a vertex.
    pub largest_empty: f64,
}

impl Torus {
    /// The copies of a simplex in the layout, including the simplex itself.
    pub(super) fn copies(self, row: &[u32]) -> Vec<Vec<u32>> {
        let moves = moves();
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

    fn new(points: usize, period: &Period) -> Self {
        // A copy of the heaviest point is within half a diagonal of any centre.
        Self { points: points as u32, largest_empty: period.reach() }
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
    let copies = Copies::of(placed, period);
    let extent = Extent::of(&placed.complex, placed.alpha);
    let torus = Torus::new(placed.positions.len(), period);
    let count = torus.points;
    let (all, mut certificate) = copies.claim(extent).findings_on(Some(torus), monitor)?;
    let mut seen = BTreeSet::new();
    let near = all.into_iter().filter_map(|finding| finding.at_box(count));
    let mut found: Vec<Finding> =
        near.filter(|finding| seen.insert(format!("{finding:?}"))).collect();
    let whole = extent == Extent::Whole;
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
        let corners = period.corners();
        let corners = structure::sites(&corners, &[0.0; 8]);
        let corners = Points { sites: &corners };
        let volume = |cells: &[[u32; 4]], points: Points| {
            let (sum, exponent) = geometry::six_volumes(cells, points, monitor)?;
            Ok(Exact::integer(sum, exponent))
        };
        let (cells, hull) = (volume(&cells, points)?, volume(&BOX, corners)?);
        let found = (cells != hull).then(|| Finding::Volume { cells: cells.clone(), hull });
        Ok((cells, found))
    }
}

/// A box cut into cells around its diagonal, positively oriented; the bits of a corner are its vectors.
const BOX: [[u32; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// The multiples of the vectors by which each copy of the box is moved; 0 for the first.
fn moves() -> Vec<[i32; 3]> {
    let mut moves: Vec<[i32; 3]> = (0..27).map(|i| [i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1]).collect();
    moves.sort_by_key(|by| *by != [0; 3]);
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
        let moves = moves();
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
