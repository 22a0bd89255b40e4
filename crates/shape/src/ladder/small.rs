//! The filtration of a box that is too small for vertices to identify simplices: an edge spans half of it or more.
//!
//! It is that of the torus that the box makes, taken from a larger torus, the *cover*: n₁ × n₂ × n₃ copies of the box, in which all edges are
//! short enough. Moving the cover by a vector of the box maps its triangulation to itself, as ties are broken by differences of
//! coordinates alone. No simplex is mapped to itself: in space it would be, and a translation moves each bounded set. So the
//! simplices of the cover fall into classes of n₁n₂n₃ that differ by a translation, and these classes are the simplices of the
//! box.
//!
//! A simplex is identified by its vertices with the multiples of the vectors by which each is moved, its *shifts*. Sorted by index and then by shift,
//! and moved so that the first shift is 0, it is the same for each member of a class; and as a translation keeps this order,
//! faces are ordered as in the simplex, and boundaries have the usual signs. (It is a Δ-complex: Hatcher, Algebraic Topology, section 2.1.)

use std::collections::BTreeMap;

use walpha_base::Monitor;
use walpha_base::sort::sort_by_key;
use walpha_regular::internals::{AXES, VECTORS};
use walpha_regular::{SitesError, Torus};

use super::Filtration;
use super::build::{Incidence, Radii};
use crate::copies::{Copier, Divided, Key, faces, key};
use crate::make::in_large_box;
use crate::winding::{minus, plus};
use crate::{
    Alpha, AlphaShape, Class, Complex, ShapeError, ShapeOptions, Simplices, WeightedPoints,
};

/// Copies of a box along its three vectors.
type Times = [u32; 3];

impl Filtration {
    /// The filtration of the smallest cover in which no edge spans half of the torus, divided by the translations.
    pub(crate) fn of_small_box(torus: Torus, points: WeightedPoints) -> Result<Self, ShapeError> {
        let (cover, covering) = covered(torus, &points, |cover| {
            Self::of_large_box(Some(cover.torus), cover.repeated())
        })?;
        Ok(cover.divide(covering))
    }
}

/// The shape of several copies of a box, and their number, for a shape whose rows name [copies](AlphaShape::copies).
#[derive(Debug)]
pub struct Covering {
    /// The shape of the larger box. Its first points are those of the box.
    pub shape: AlphaShape,
    /// The numbers of copies along the vectors.
    pub times: [u32; 3],
}

impl Covering {
    /// The number of copies.
    pub fn copies(&self) -> usize {
        product(self.times)
    }

    /// The row of one of the translates of a simplex of the box.
    pub fn row<const N: usize>(&self, of: &AlphaShape, row: [u32; N]) -> [u32; N] {
        let [a, b, _] = self.times;
        of.shifted(row).map(|(v, shift)| {
            let [i, j, k] = [0, 1, 2].map(|k| shift[k].rem_euclid(self.times[k] as i32) as u32);
            v + (i + a * (j + b * k)) * of.own_points() as u32
        })
    }
}

impl AlphaShape {
    /// The shape of several copies of the box, as few as make each edge of it span less than half of them, if rows of this one name copies.
    ///
    /// # Errors
    /// See [`alpha_shape`](crate::alpha_shape()).
    #[doc(hidden)]
    pub fn covering(&self) -> Result<Option<Covering>, ShapeError> {
        let monitor = &*Monitor::current();
        let Some(torus) = self.options().periodic.filter(|_| !self.copies().is_empty()) else {
            return Ok(None);
        };
        let WeightedPoints { positions, weights, .. } = self.points();
        let own = self.own_points();
        let points = WeightedPoints {
            positions: positions[..own].to_vec(),
            weights: weights[..own].to_vec(),
            values: None,
        };
        let (cover, shape) = covered(torus, &points, |cover| {
            let options = ShapeOptions { periodic: Some(cover.torus), ..*self.options() };
            in_large_box(cover.repeated(), &options, monitor)
        })?;
        Ok(Some(Covering { shape, times: cover.times }))
    }
}

/// The number of copies of a box.
fn product(times: Times) -> usize {
    times.iter().map(|&n| n as usize).product()
}

/// Finds something of the smallest cover in which no edge of it spans half of the torus; returns both.
fn covered<T>(
    torus: Torus,
    points: &WeightedPoints,
    find: impl Fn(&Cover) -> Result<T, ShapeError>,
) -> Result<(Cover, T), ShapeError> {
    let mut times = [1; 3];
    loop {
        let cover = Cover::new(torus, times, points.clone())?;
        match find(&cover) {
            Err(ShapeError::Wraps { axis, span, side, .. }) => {
                let k = AXES.iter().chain(&VECTORS).position(|&name| name == axis);
                let k = k.expect("the name of an axis or of a vector") % 3;
                // The span is rounded, and may be half of the side exactly.
                let enough = (2.0 * f64::from(times[k]) * span / side).floor() as u32 + 1;
                times[k] = enough.max(times[k] + 1);
            }
            found => return Ok((cover, found?)),
        }
    }
}

/// Several copies of a box.
struct Cover {
    /// The box.
    small: Torus,
    /// The box of all copies.
    torus: Torus,
    times: Times,
    /// The points in the small box.
    points: WeightedPoints,
}

impl Cover {
    fn new(torus: Torus, times: Times, mut points: WeightedPoints) -> Result<Self, ShapeError> {
        let copies = times.iter().try_fold(points.len(), |all, &n| all.checked_mul(n as usize));
        match copies {
            Some(copies) if u32::try_from(copies).is_ok() => {}
            _ => return Err(SitesError::TooMany(copies.unwrap_or(usize::MAX)).into()),
        }
        let [small, torus] = torus.covered(times, &points.positions);
        points.positions.iter_mut().for_each(|place| *place = small.wrap(*place));
        Ok(Self { small, torus, times, points })
    }

    /// The shift of a copy by its number.
    fn shift(&self, copy: u32) -> [i32; 3] {
        let [a, b, _] = self.times;
        [copy % a, copy / a % b, copy / a / b].map(|n| n as i32)
    }

    fn copies(&self) -> usize {
        product(self.times)
    }

    /// The points of all copies, copy after copy.
    fn repeated(&self) -> WeightedPoints {
        let moved = |copy| {
            let shift = self.shift(copy);
            self.points.positions.iter().map(move |&place| self.small.moved(place, shift))
        };
        let positions = (0..self.copies() as u32).flat_map(moved).collect();
        let weights = self.points.weights.repeat(self.copies());
        WeightedPoints { positions, weights, values: None }
    }

    /// The vertices of a row of the cover, with the shifts of the nearest copies, in the order of the row.
    fn shifted<const N: usize>(&self, row: [u32; N], positions: &[[f64; 3]]) -> Key<N> {
        let points = self.points.len() as u32;
        let first = positions[row[0] as usize];
        row.map(|v| {
            let round = self.torus.windings(first, positions[v as usize]);
            let round = [0, 1, 2].map(|k| round[k] * self.times[k] as i32);
            (v % points, plus(self.shift(v / points), round))
        })
    }

    /// The classes of rows, in order.
    fn classes<const N: usize>(
        &self,
        rows: &[[u32; N]],
        positions: &[[f64; 3]],
    ) -> Vec<Translates<N>> {
        let is_in_small_box =
            |shift: [i32; 3]| (0..3).all(|k| shift[k].rem_euclid(self.times[k] as i32) == 0);
        let mut classes = Vec::with_capacity(rows.len() / self.copies());
        for (at, &row) in rows.iter().enumerate() {
            let shifted = self.shifted(row, positions);
            let (key, shift) = key(shifted);
            // So it is for one member of each class.
            if is_in_small_box(shift) {
                classes.push(Translates { key, is_even: is_even(shifted), row: at });
            }
        }
        sort_by_key(&mut classes, |class| class.key);
        classes
    }

    /// The filtration of the small box.
    fn divide(self, cover: Filtration) -> Filtration {
        let Filtration { whole, incidence, radii } = cover;
        let (complex, positions) = (whole.complex(), whole.points().positions());
        let cells = self.classes(complex.cells.rows(), positions);
        let facets = self.classes(&incidence.facets, positions);
        let edges = self.classes(complex.edges.rows(), positions);
        let is_own = |v: u32| (v as usize) < self.points.len();
        let vertices: Vec<[u32; 1]> =
            complex.vertices.rows().iter().copied().filter(|&[v]| is_own(v)).collect();
        let radii = Radii {
            cells: cells.iter().map(|class| radii.cells[class.row]).collect(),
            facets: facets.iter().map(|class| radii.facets[class.row]).collect(),
            edges: edges.iter().map(|class| radii.edges[class.row]).collect(),
            // Copies come after all points.
            vertices: radii.vertices[..vertices.len()].to_vec(),
        };

        let mut copier = Copier::new(self.points.len());
        let edge_rows = edges.iter().map(|class| class.row(&mut copier)).collect();
        let facet_rows: Vec<[u32; 3]> = facets.iter().map(|class| class.row(&mut copier)).collect();
        let cell_rows = cells.iter().map(|class| class.even_row(&mut copier)).collect();
        let copied = copier.copied;

        let numbers = numbered(&edges);
        let edge = |ends: Key<2>| numbers[&key(ends).0];
        let facet_edges = facets.iter().map(|class| faces(class.key).map(edge)).collect();
        let numbers = numbered(&facets);
        let mut sides = vec![Vec::with_capacity(2); facets.len()];
        let cell_facets = (0..)
            .zip(&cells)
            .map(|(cell, class)| {
                faces(class.even()).map(|corners| {
                    let (facet, shift) = key(corners);
                    sides[numbers[&facet] as usize].push((cell, shift));
                    numbers[&facet]
                })
            })
            .collect();
        let (facet_cells, ways) = sides
            .iter()
            .map(|sides| match sides[..] {
                [(a, of_a), (b, of_b)] => ([a, b], minus(of_a, of_b)),
                [(a, _)] => ([a, Incidence::OUTSIDE], [0; 3]),
                _ => ([Incidence::OUTSIDE; 2], [0; 3]),
            })
            .unzip();
        let mut vertex_rows = vec![0; self.points.len()];
        (0..).zip(&vertices).for_each(|(row, &[v])| vertex_rows[v as usize] = row);
        let of_copies: Vec<u32> = copied.iter().map(|&(v, _)| vertex_rows[v as usize]).collect();
        vertex_rows.extend(of_copies);
        vertex_rows.push(vertices.len() as u32);
        let incidence = Incidence {
            facets: facet_rows.clone(),
            cell_facets,
            facet_cells,
            ways,
            facet_edges,
            vertex_rows,
        };

        let hidden =
            whole.hidden().map(|hidden| hidden.iter().copied().filter(|&v| is_own(v)).collect());
        let duplicates = whole.duplicates().iter().copied().filter(|&[v, _]| is_own(v)).collect();
        // All of a torus is solid.
        let complex = Complex {
            cells: interior(cell_rows),
            facets: interior(facet_rows),
            edges: interior(edge_rows),
            vertices: interior(vertices),
        };
        let Self { small: torus, points, .. } = self;
        let by = Divided { torus, points, complex, hidden, duplicates, copied };
        let whole = whole.divided(by);
        let mut divided = Filtration { whole, incidence, radii };
        if torus.dimension() < 3 {
            // There is a boundary.
            divided.whole = divided.shape_with(Alpha::INFINITE, true);
        }
        divided
    }
}

/// The simplices of the cover that differ by translations.
struct Translates<const N: usize> {
    key: Key<N>,
    /// Whether the order of the key is an even permutation of that of the row.
    is_even: bool,
    /// The row of one of them.
    row: usize,
}

impl<const N: usize> Translates<N> {
    /// The vertices in order.
    fn row(&self, copier: &mut Copier) -> [u32; N] {
        self.key.map(|vertex| copier.number(vertex))
    }

    /// The vertices in the first order that is an even permutation of that of the row, as in [`Complex`].
    fn even(&self) -> Key<N> {
        let mut vertices = self.key;
        if !self.is_even {
            vertices.swap(N - 2, N - 1);
        }
        vertices
    }

    fn even_row(&self, copier: &mut Copier) -> [u32; N] {
        self.even().map(|vertex| copier.number(vertex))
    }
}

/// Whether sorting is an even permutation.
pub(super) fn is_even<const N: usize>(vertices: Key<N>) -> bool {
    let inversions = |i: usize| (i + 1..N).filter(|&j| vertices[j] < vertices[i]).count();
    (0..N).map(inversions).sum::<usize>() % 2 == 0
}

fn numbered<const N: usize>(classes: &[Translates<N>]) -> BTreeMap<Key<N>, u32> {
    // A map that is collected sorts first, by code that is compiled for it.
    let mut numbers = BTreeMap::new();
    for (class, number) in classes.iter().zip(0..) {
        numbers.insert(class.key, number);
    }
    numbers
}

fn interior<const N: usize>(rows: Vec<[u32; N]>) -> Simplices<N> {
    rows.into_iter().map(|row| (row, Class::Interior)).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use walpha_base::random::Random;

    use super::*;
    use crate::ladder::{Interval, Ordered};
    use crate::{Alpha, Betti, alpha_shape};

    const UNIT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    const FCC: [[f64; 3]; 3] = [[0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]];
    const BCC: [[f64; 3]; 3] = [[-0.5, 0.5, 0.5], [0.5, -0.5, 0.5], [0.5, 0.5, -0.5]];
    const SLANTED: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.375, 0.875, 0.0], [-0.25, 0.125, 1.25]];

    fn filtration(vectors: [[f64; 3]; 3], points: &[[f64; 3]]) -> Filtration {
        let torus = Torus::of_vectors(vectors).unwrap();
        Filtration::on(Some(torus), points).unwrap()
    }

    /// The points of a box, with or without weights.
    pub(crate) fn random_points(seed: u64, count: usize, weight: f64) -> WeightedPoints {
        let mut random = Random::new(seed);
        let positions = (0..count).map(|_| [0; 3].map(|_| 4.0 * random.unit())).collect();
        let weights = (0..count).map(|_| weight * random.unit()).collect();
        WeightedPoints::new(positions, weights).unwrap()
    }

    /// All simplices by the points that their vertices are copies of, with their numbers.
    fn simplices(ordered: &Ordered<'_>) -> Vec<(Vec<u32>, [f64; 3], bool)> {
        let whole = ordered.filtration().whole();
        let mut all: Vec<_> = ordered
            .iter()
            .map(|entry| {
                let mut points: Vec<u32> =
                    entry.vertices.iter().map(|&v| whole.copied(v).0).collect();
                points.sort_unstable();
                (points, [entry.value, entry.regular, entry.interior], entry.gabriel)
            })
            .collect();
        all.sort_by(|a, b| a.partial_cmp(b).unwrap());
        all
    }

    /// The births and deaths of a dimension.
    fn diagram(ordered: &Ordered<'_>, dimension: usize) -> Vec<[f64; 2]> {
        let intervals = ordered.persistence(dimension).unwrap();
        let mut all: Vec<_> = intervals.iter().map(|i| [i.birth, i.death]).collect();
        all.sort_by(|a, b| a.partial_cmp(b).unwrap());
        all
    }

    /// A box that is large enough has the same filtration by its rows and as a quotient of any cover.
    #[test]
    fn the_quotient_of_a_cover_is_the_filtration_of_the_box() {
        for (seed, vectors) in [(1, UNIT), (2, SLANTED), (3, FCC)] {
            let vectors = vectors.map(|v| v.map(|x| 4.0 * x));
            for weight in [0.0, 0.1] {
                let points = random_points(seed, 400, weight);
                // So that both round to the same numbers.
                let round = |x: f64| (x * 2f64.powi(30)).round() / 2f64.powi(30);
                let positions = points.positions.iter().map(|p| p.map(round)).collect();
                let points = WeightedPoints { positions, ..points };
                let torus = Torus::of_vectors(vectors).unwrap();
                let direct = Filtration::of_large_box(Some(torus), points.clone()).unwrap();
                let expected = direct.simplices().unwrap();
                for times in [[1, 1, 1], [2, 1, 1], [1, 2, 3], [2, 2, 2]] {
                    let cover = Cover::new(torus, times, points.clone()).unwrap();
                    let covering =
                        Filtration::of_large_box(Some(cover.torus), cover.repeated()).unwrap();
                    let divided = cover.divide(covering);
                    let found = divided.simplices().unwrap();
                    assert_eq!(simplices(&found), simplices(&expected), "{times:?}");
                    assert_eq!(found.betti_curve(), expected.betti_curve());
                    for dimension in 0..4 {
                        assert_eq!(diagram(&found, dimension), diagram(&expected, dimension));
                    }
                    for alpha in [0.01, 0.1, 0.3, 1.0, f64::INFINITY] {
                        let alpha = Alpha::from_squared(alpha).unwrap();
                        let (one, other) = (divided.shape(alpha), direct.shape(alpha));
                        assert_eq!(one.betti(), other.betti());
                        let (one_measures, measures) = (one.measures(), other.measures());
                        assert!((one_measures.volume - measures.volume).abs() < 1e-9);
                        assert!((one_measures.area - measures.area).abs() < 1e-9);
                        let sizes = |shape: &AlphaShape| -> Vec<_> {
                            let components = shape.components();
                            components.iter().map(|c| (c.vertices, c.cells, c.rounds)).collect()
                        };
                        assert_eq!(sizes(&one), sizes(&other));
                    }
                    let [one, other] = [&divided, &direct].map(|filtration| {
                        let alpha = Alpha::from_squared(0.2).unwrap();
                        let levels = filtration.levels(&[alpha]);
                        let shape = levels.shape(0, true, Betti::default());
                        let voids = shape.voids().unwrap();
                        assert_eq!(voids.len(), levels.voids()[0].len());
                        voids
                            .iter()
                            .map(|void| (void.cells, void.filling_alpha))
                            .collect::<Vec<_>>()
                    });
                    assert_eq!(one, other);
                }
            }
        }
    }

    /// A lone point: its cubic lattice is cut into six tetrahedra, as each cube; those of the lattices of densest and of
    /// body-centred packing into their Delaunay cells.
    #[test]
    fn a_lone_point_is_enough() {
        for (vectors, largest) in [(UNIT, 0.75), (FCC, 0.25), (BCC, 0.3125)] {
            let filtration = filtration(vectors, &[[0.25, 0.125, 0.5]]);
            let ordered = filtration.simplices().unwrap();
            let counts = [0, 1, 2, 3].map(|dimension| ordered.count(dimension));
            assert_eq!(counts, [1, 7, 12, 6]);
            assert_eq!(ordered.values().last().unwrap().squared(), largest);
            let whole = filtration.whole();
            assert_eq!(whole.betti(), Some(Betti { b0: 1, b1: 3, b2: 3, b3: Some(1) }));
            assert_eq!(Some(whole.measures().volume), whole.options().periodic.unwrap().volume());
            assert_eq!(whole.components().len(), 1);
            assert!(whole.complex().cells.rows().iter().all(|cell| cell[0] == 0));
        }
    }

    /// The same crystal, in cells of one, two and four points and in supercells.
    #[test]
    fn primitive_and_conventional_cells_agree() {
        let fcc = [[0.0; 3], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]];
        let bcc = [[0.0; 3], [0.5; 3]];
        let diamond: Vec<[f64; 3]> = fcc.iter().flat_map(|&p| [p, p.map(|x| x + 0.25)]).collect();
        let cases = [
            (FCC, vec![[0.0; 3]], fcc.to_vec()),
            (BCC, vec![[0.0; 3]], bcc.to_vec()),
            (FCC, vec![[0.0; 3], [0.25; 3]], diamond),
        ];
        for (vectors, few, many) in cases {
            let ratio = many.len() / few.len();
            let (one, other) = (filtration(vectors, &few), filtration(UNIT, &many));
            let (one, other) = (one.simplices().unwrap(), other.simplices().unwrap());
            let repeated = |ordered: &Ordered<'_>, times: usize| {
                let mut values: Vec<(usize, f64, f64, f64)> = (ordered.iter())
                    .map(|s| (s.vertices.len(), s.value, s.regular, s.interior))
                    .flat_map(|value| std::iter::repeat_n(value, times))
                    .collect();
                values.sort_by(|a, b| a.partial_cmp(b).unwrap());
                values
            };
            assert_eq!(repeated(&one, ratio), repeated(&other, 1));
            for alpha in one.values() {
                let [a, b] = [&one, &other].map(|of| of.filtration().shape(*alpha));
                assert_eq!(ratio as f64 * a.measures().volume, b.measures().volume);
                assert_eq!(a.betti().map(|b| b.b3), b.betti().map(|b| b.b3));
            }
        }
    }

    /// The number of intervals of each dimension that contain the value of this rank.
    pub(in crate::ladder) fn alive_at(
        ordered: &Ordered<'_>,
        diagrams: &[Vec<Interval>],
        rank: u32,
    ) -> Vec<usize> {
        let rank_of = |number: u32| ordered.simplex(number).rank;
        let is_alive = |interval: &&Interval| {
            rank_of(interval.begins) <= rank && interval.ends.is_none_or(|end| rank_of(end) > rank)
        };
        diagrams.iter().map(|intervals| intervals.iter().filter(is_alive).count()).collect()
    }

    /// Rational Betti numbers of the simplices up to each value, by the ranks of boundary matrices modulo a prime: columns are added in order.
    pub(in crate::ladder) fn betti_by_ranks(ordered: &Ordered<'_>) -> Vec<[usize; 4]> {
        const PRIME: i64 = 1_000_003;
        let incidence = &ordered.filtration().incidence;
        let value_of = |number: usize| ordered.simplex(number as u32).rank as usize;
        let counts = [0, 1, 2, 3].map(|dimension| ordered.count(dimension));
        let first = [0, counts[0], counts[0] + counts[1], counts[0] + counts[1] + counts[2]];
        let boundary = |dimension: usize, row: usize| -> Vec<(usize, i64)> {
            match dimension {
                1 => {
                    let ends = ordered.edges()[row].map(|v| incidence.vertex_rows[v as usize]);
                    vec![(ends[1] as usize, 1), (ends[0] as usize, -1)]
                }
                2 => {
                    incidence.facet_edges[row].iter().map(|&e| e as usize).zip([1, -1, 1]).collect()
                }
                _ => {
                    // Opposite the corners of the row, the last two of which may be exchanged.
                    let whole = ordered.filtration().whole();
                    let corners = whole.complex().cells.rows()[row].map(|v| whole.copied(v));
                    let mut order = [0, 1, 2, 3];
                    order.sort_by_key(|&k| corners[k]);
                    let facets = incidence.cell_facets[row];
                    order.iter().map(|&k| facets[k] as usize).zip([1, -1, 1, -1]).collect()
                }
            }
        };
        // What each value adds.
        let mut added = vec![([0; 4], [0; 5]); ordered.values().len()];
        for row in 0..counts[0] {
            added[value_of(row)].0[0] += 1;
        }
        for dimension in 1..4 {
            // The boundary of a boundary is nothing.
            if dimension > 1 {
                for row in 0..counts[dimension] {
                    let mut sum = BTreeMap::<usize, i64>::new();
                    for (face, sign) in boundary(dimension, row) {
                        for (lower, other) in boundary(dimension - 1, face) {
                            *sum.entry(lower).or_default() += sign * other;
                        }
                    }
                    assert!(sum.values().all(|&sum| sum == 0), "{dimension} {row}");
                }
            }
            let mut pivots = BTreeMap::<usize, BTreeMap<usize, i64>>::new();
            let mut rows: Vec<usize> = (0..counts[dimension]).collect();
            rows.sort_by_key(|&row| value_of(first[dimension] + row));
            for row in rows {
                let (counts, ranks) = &mut added[value_of(first[dimension] + row)];
                counts[dimension] += 1;
                let mut column = BTreeMap::<usize, i64>::new();
                for (face, sign) in boundary(dimension, row) {
                    *column.entry(face).or_default() += sign;
                }
                column.retain(|_, value| value.rem_euclid(PRIME) != 0);
                while let Some((&last, &value)) = column.last_key_value() {
                    let Some(pivot) = pivots.get(&last) else {
                        let inverse = (0..20)
                            .fold(
                                (1, value.rem_euclid(PRIME), PRIME - 2),
                                |(product, power, left), _| {
                                    let product = if left % 2 == 1 {
                                        product * power % PRIME
                                    } else {
                                        product
                                    };
                                    (product, power * power % PRIME, left / 2)
                                },
                            )
                            .0;
                        column.values_mut().for_each(|v| *v = (*v * inverse).rem_euclid(PRIME));
                        pivots.insert(last, std::mem::take(&mut column));
                        ranks[dimension] += 1;
                        break;
                    };
                    for (&at, &pivot) in pivot {
                        let sum = column.entry(at).or_default();
                        *sum = (*sum - value * pivot).rem_euclid(PRIME);
                    }
                    column.retain(|_, value| *value != 0);
                }
            }
        }
        let (mut counts, mut ranks) = ([0; 4], [0; 5]);
        let betti = |(more, higher): ([usize; 4], [usize; 5])| {
            (0..4).for_each(|dimension| counts[dimension] += more[dimension]);
            (0..5).for_each(|dimension| ranks[dimension] += higher[dimension]);
            [0, 1, 2, 3].map(|d| counts[d] - ranks[d] - ranks[d + 1])
        };
        added.into_iter().map(betti).collect()
    }

    /// Betti numbers and pairs of small boxes follow from the ranks of boundary matrices, at each value.
    #[test]
    fn betti_numbers_are_those_of_boundary_matrices() {
        let (mut compared, mut loops) = (0, 0);
        for (seed, vectors) in [(1, UNIT), (2, SLANTED), (3, FCC), (4, BCC)] {
            let vectors = vectors.map(|v| v.map(|x| 4.0 * x));
            let torus = Torus::of_vectors(vectors).unwrap();
            for count in 1..7 {
                let points = random_points(10 * seed + count, count as usize, 0.5);
                let filtration = Filtration::on(Some(torus), points).unwrap();
                let ordered = filtration.simplices().unwrap();
                assert!(!filtration.whole().copies().is_empty());
                loops += ordered
                    .edges()
                    .iter()
                    .filter(|edge| filtration.whole().copied(edge[1]).0 == edge[0])
                    .count();
                let curve = ordered.betti_curve();
                let diagrams: Vec<Vec<_>> =
                    (0..4).map(|dimension| ordered.persistence(dimension).unwrap()).collect();
                let by_ranks = betti_by_ranks(&ordered);
                assert_eq!(by_ranks.len(), curve.len());
                for (rank, (&betti, expected)) in (0..).zip(curve.iter().zip(by_ranks)) {
                    let found = Vec::from(betti);
                    assert_eq!(found, expected.map(|b| b as u64), "{seed} {count} {rank}");
                    let alive = alive_at(&ordered, &diagrams, rank);
                    assert_eq!(alive, expected, "{seed} {count} {rank}");
                    compared += 1;
                }
            }
        }
        assert!(compared > 500 && loops > 50, "{compared} {loops}");
    }

    /// Shapes in small boxes are levels of the filtration, with weights of either kind and with values.
    #[test]
    fn shapes_of_small_boxes_have_their_points() {
        let torus = Torus::of_vectors(SLANTED).unwrap();
        let points = WeightedPoints { values: Some(vec![3.0, 7.0]), ..random_points(5, 2, 0.1) };
        let mut regular = 0;
        let cases = [crate::Balls::Power, crate::Balls::Radius]
            .into_iter()
            .flat_map(|balls| [0.05, 0.1, 0.15, 0.2, 0.3].map(|alpha| (balls, alpha)));
        for (balls, alpha) in cases {
            let options = ShapeOptions::new(Alpha::from_squared(alpha).unwrap())
                .periodic(Some(torus))
                .balls(balls)
                .exterior(true);
            let shape = alpha_shape(points.clone(), &options).unwrap();
            let copies = shape.copies();
            assert!(!copies.is_empty());
            // The first vertex of each row is a point of the box.
            let complex = shape.complex();
            assert!(complex.cells.rows().iter().all(|row| row[0] < 2));
            assert!(complex.facets.rows().iter().all(|row| row[0] < 2));
            assert!(complex.edges.rows().iter().all(|row| row[0] < 2));
            regular += complex.facets.of(Class::Regular).count();
            assert_eq!(
                shape.options(),
                &ShapeOptions { periodic: shape.options().periodic, ..options }
            );
            let WeightedPoints { positions, weights, values } = shape.points();
            assert_eq!(
                (&weights[..2], &values.as_ref().unwrap()[..2]),
                (&points.weights[..], &[3.0, 7.0][..])
            );
            let torus = shape.options().periodic.unwrap();
            for (k, (&v, &shift)) in copies.iter().zip(shape.shifts()).enumerate() {
                assert_eq!(positions[2 + k], torus.moved(positions[v as usize], shift));
                assert_eq!(weights[2 + k], weights[v as usize]);
                assert_eq!(shape.power_weights()[2 + k], shape.power_weights()[v as usize]);
            }
            let unwrapped = shape.unwrapped();
            assert_eq!(unwrapped.options().periodic, None);
            let volume = |shape: &AlphaShape| shape.measures().volume;
            assert!((volume(&unwrapped) - volume(&shape)).abs() < 1e-12);
            assert_eq!(unwrapped.components().len(), shape.components().len());
        }
        assert!(regular > 0);
    }
}
