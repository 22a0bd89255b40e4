//! Computes a periodic shape by other means: simplices by the engine for points in space (or by the definition of the exact
//! checker) on many copies, Betti numbers by ranks of boundary matrices.

use std::collections::BTreeMap;

use walpha::shape::{Engine, ShapeOptions, Simplices, Torus};
use walpha::{Alpha, AlphaShape, Class, Complex, WeightedPoints, alpha_shape};

/// Copies of points of a box, those of the box itself first.
pub fn copies(points: &WeightedPoints, torus: Torus, around: i32) -> WeightedPoints {
    let range = || -around..=around;
    let mut moves: Vec<[i32; 3]> =
        range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, y, z]))).collect();
    moves.sort_by_key(|m| *m != [0; 3]);
    let (mut positions, mut weights) = (Vec::new(), Vec::new());
    for by in moves {
        let along = |axis: usize| (0..3).map(move |k| f64::from(by[k]) * torus.vectors()[k][axis]);
        let place = |p: &[f64; 3]| [0, 1, 2].map(|axis| p[axis] + along(axis).sum::<f64>());
        positions.extend(points.positions().iter().map(place));
        weights.extend(points.weights());
    }
    WeightedPoints::new(positions, weights).unwrap()
}

/// The rows of copies that stand for all others: their smallest vertex, by the number of the point it is a
/// copy of, is in the box.
fn orbits(
    points: &WeightedPoints,
    torus: Torus,
    all: &WeightedPoints,
    complex: &Complex,
) -> Option<Complex> {
    let n = points.positions().len() as u32;
    let long = complex.edges.rows().iter().any(|&[a, b]| {
        let [p, q] = [a, b].map(|v| all.positions()[v as usize]);
        (a < n || b < n) && spans_half(torus, [0, 1, 2].map(|k| q[k] - p[k]))
    });
    (!long).then(|| Complex {
        cells: of_box(&complex.cells, n, even),
        facets: of_box(&complex.facets, n, turned),
        edges: of_box(&complex.edges, n, |row, _| ascending(row)),
        vertices: of_box(&complex.vertices, n, |row, _| row),
    })
}

/// Whether a way spans half of a vector of the box or more, in integers of 2⁻³⁰.
fn spans_half(torus: Torus, way: [f64; 3]) -> bool {
    let unit = f64::from(1 << 30);
    let integers = |v: [f64; 3]| v.map(|x| (x * unit) as i128);
    let det = |[a, b, c]: [[i128; 3]; 3]| {
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)
    };
    let (vectors, way) = (torus.vectors().map(integers), integers(way));
    (0..3).any(|k| {
        let mut replaced = vectors;
        replaced[k] = way;
        2 * det(replaced).abs() >= det(vectors).abs()
    })
}

fn of_box<const N: usize>(
    simplices: &Simplices<N>,
    n: u32,
    canonical: fn([u32; N], Class) -> [u32; N],
) -> Simplices<N> {
    let mut rows: Vec<([u32; N], Class)> = Vec::new();
    for (&row, class) in simplices.iter() {
        if *row.iter().min_by_key(|&&v| v % n).unwrap() < n {
            rows.push((canonical(row.map(|v| v % n), class), class));
        }
    }
    rows.sort();
    rows.into_iter().collect()
}

fn ascending<const N: usize>(mut row: [u32; N]) -> [u32; N] {
    row.sort_unstable();
    row
}

fn turned(mut row: [u32; 3], class: Class) -> [u32; 3] {
    if class != Class::Regular {
        return ascending(row);
    }
    let first = (0..3).min_by_key(|&k| row[k]).unwrap();
    row.rotate_left(first);
    row
}

/// The smallest of the even permutations of a row.
fn even(row: [u32; 4], _: Class) -> [u32; 4] {
    let inversions =
        (0..4).flat_map(|i| (0..i).map(move |j| (j, i))).filter(|&(j, i)| row[j] > row[i]).count();
    let mut sorted = ascending(row);
    if inversions % 2 == 1 {
        sorted.swap(2, 3);
    }
    sorted
}

/// The shape with its classes, or the whole triangulation, by the engine for points in space. `None` if it has
/// an edge that spans half of the box.
pub fn by_copies(
    points: &WeightedPoints,
    torus: Torus,
    alpha: Alpha,
    exterior: bool,
) -> Option<Complex> {
    let all = copies(points, torus, 2);
    let options = ShapeOptions::new(alpha).exterior(exterior).engine(Engine::Native);
    let shape = alpha_shape(all.clone(), &options).unwrap();
    orbits(points, torus, &all, shape.complex())
}

/// Betti numbers by ranks of the boundary matrices modulo a prime.
pub fn homology(shape: &AlphaShape) -> [u64; 4] {
    let complex = shape.complex();
    let in_shape = |classes: &[Class]| classes.iter().map(|&c| c != Class::Exterior).collect();
    let mut chains = [
        sorted(complex.vertices.rows(), in_shape(complex.vertices.classes())),
        sorted(complex.edges.rows(), in_shape(complex.edges.classes())),
        sorted(complex.facets.rows(), in_shape(complex.facets.classes())),
        sorted(complex.cells.rows(), in_shape(complex.cells.classes())),
    ];
    chains.iter_mut().for_each(|chain| chain.sort());
    let rank = |dimension: usize| match dimension {
        0 | 4 => 0,
        _ => rank(&chains[dimension], &chains[dimension - 1]),
    };
    let ranks = [0, 1, 2, 3, 4].map(rank);
    [0, 1, 2, 3].map(|d| (chains[d].len() - ranks[d] - ranks[d + 1]) as u64)
}

fn sorted<const N: usize>(rows: &[[u32; N]], wanted: Vec<bool>) -> Vec<Vec<u32>> {
    let rows = rows.iter().zip(wanted).filter(|(_, wanted)| *wanted);
    rows.map(|(row, _)| ascending(*row).to_vec()).collect()
}

const PRIME: u64 = 1_000_003;

/// The rank of the boundary map between simplices.
fn rank(of: &[Vec<u32>], to: &[Vec<u32>]) -> usize {
    let number: BTreeMap<&[u32], u32> = to.iter().map(Vec::as_slice).zip(0..).collect();
    // Indexed by the last row that is not 0.
    let mut reduced: BTreeMap<u32, BTreeMap<u32, u64>> = BTreeMap::new();
    for simplex in of {
        let mut column: BTreeMap<u32, u64> = BTreeMap::new();
        for skip in 0..simplex.len() {
            let mut face = simplex.clone();
            face.remove(skip);
            let sign = if skip % 2 == 0 { 1 } else { PRIME - 1 };
            column.insert(number[face.as_slice()], sign);
        }
        while let Some((&last, &value)) = column.last_key_value() {
            let Some(other) = reduced.get(&last) else {
                reduced.insert(last, column);
                break;
            };
            let times = PRIME - value * inverse(other[&last]) % PRIME;
            for (&row, &entry) in other {
                let sum = (column.get(&row).copied().unwrap_or(0) + times * entry) % PRIME;
                if sum == 0 {
                    column.remove(&row);
                } else {
                    column.insert(row, sum);
                }
            }
        }
    }
    reduced.len()
}

fn inverse(of: u64) -> u64 {
    let (mut result, mut base, mut power) = (1, of, PRIME - 2);
    while power > 0 {
        if power % 2 == 1 {
            result = result * base % PRIME;
        }
        base = base * base % PRIME;
        power /= 2;
    }
    result
}
