//! Points that repeat along one or two vectors, against finite copies in space, a torus with a gap, and boundary matrices.

use std::collections::BTreeMap;
use std::num::NonZeroUsize;

use walpha_regular::Torus;

use super::small::tests::{betti_by_ranks, random_points};
use super::{Filtration, Ordered};
use crate::copies::Copied;
use crate::winding::{Winding, minus};
use crate::{
    Alpha, AlphaShape, Betti, Class, ShapeOptions, WeightedPoints, alpha_shape,
};

const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// Hexagons in a tilted plane, and a vector out of it.
const TILTED: [[f64; 3]; 3] = [[1.0, -1.0, 0.0], [0.0, 1.0, -1.0], [0.5, 0.75, 1.0]];
const SLANTED: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.375, 0.875, 0.0], [-0.25, 0.125, 1.25]];
const SLABS: [[bool; 3]; 3] = [[true, true, false], [true, false, true], [false, true, true]];
const RODS: [[bool; 3]; 3] = [[true, false, false], [false, true, false], [false, false, true]];

fn torus(vectors: [[f64; 3]; 3], repeats: [bool; 3], scale: f64) -> Torus {
    Torus::repeating(vectors.map(|v| v.map(|x| scale * x)), repeats).unwrap()
}

/// A simplex by its points and their shifts, in order, the first shift 0.
type Key = Vec<(u32, Winding)>;

fn sorted(mut vertices: Key) -> (Key, Winding) {
    vertices.sort_unstable();
    let first = vertices[0].1;
    vertices.iter_mut().for_each(|vertex| vertex.1 = minus(vertex.1, first));
    (vertices, first)
}

fn key_of(shape: &AlphaShape, row: &[u32]) -> Key {
    let shifted = match *row {
        [a] => shape.shifted([a]).to_vec(),
        [a, b] => shape.shifted([a, b]).to_vec(),
        [a, b, c] => shape.shifted([a, b, c]).to_vec(),
        [a, b, c, d] => shape.shifted([a, b, c, d]).to_vec(),
        _ => unreachable!("no other simplices"),
    };
    sorted(shifted).0
}

/// When a simplex enters, becomes a face of another, and leaves the boundary; and whether it is Gabriel.
type Times = ([f64; 3], bool);

fn times(ordered: &Ordered<'_>, key: impl Fn(&[u32]) -> Option<Key>) -> BTreeMap<Key, Times> {
    let mut all = BTreeMap::new();
    for entry in ordered.iter() {
        if let Some(key) = key(entry.vertices) {
            let times = ([entry.value, entry.regular, entry.interior], entry.gabriel);
            assert!(all.insert(key, times).is_none(), "each simplex once");
        }
    }
    all
}

/// The simplices of copies of the points in space that belong to the box.
fn in_space(points: &WeightedPoints, torus: Torus, most: i32) -> BTreeMap<Key, Times> {
    let repeats = torus.repeats();
    let along = |k: usize| if repeats[k] { -most..=most } else { 0..=0 };
    let mut shifts = Vec::new();
    for i in along(0) {
        for j in along(1) {
            shifts.extend(along(2).map(|k| [i, j, k]));
        }
    }
    let moved = |&by: &Winding| points.positions.iter().map(move |&p| torus.moved(p, by));
    let positions = shifts.iter().flat_map(moved).collect();
    let weights = points.weights.repeat(shifts.len());
    let filtration = Filtration::new(WeightedPoints::new(positions, weights).unwrap()).unwrap();
    let ordered = filtration.simplices().unwrap();
    let count = points.len() as u32;
    let copied = |&v: &u32| -> Copied { (v % count, shifts[(v / count) as usize]) };
    times(&ordered, |row| {
        let (key, first) = sorted(row.iter().map(copied).collect());
        (first == [0; 3]).then_some(key)
    })
}

/// Points in the box and across it; some on a grid, with many ties, and some in a plane or on a line of the vectors.
fn points(seed: u64, count: usize, torus: Torus, kind: usize) -> WeightedPoints {
    let WeightedPoints { mut positions, weights, .. } = random_points(seed, count, 0.5);
    match kind {
        0 => {}
        1 => positions.iter_mut().for_each(|p| *p = p.map(|x| (2.0 * x).round() / 2.0)),
        _ => {
            // On a grid of the lattice.
            for p in &mut positions {
                let [x, y, z] = p.map(|x| x.round() / 4.0);
                let vectors = torus.vectors();
                *p = [0, 1, 2].map(|k| x * vectors[0][k] + y * vectors[1][k] + z * vectors[2][k]);
            }
        }
    }
    let weights = if kind == 0 { weights } else { vec![0.0; count] };
    WeightedPoints::new(positions, weights).unwrap()
}

/// The points that the shape has, without copies.
fn own(shape: &AlphaShape) -> WeightedPoints {
    let count = shape.own_points();
    let WeightedPoints { positions, weights, .. } = shape.points();
    WeightedPoints::new(positions[..count].to_vec(), weights[..count].to_vec()).unwrap()
}

/// The whole triangulation and its values, simplex by simplex.
#[test]
fn simplices_are_those_of_copies_in_space() {
    let (mut small, mut flat, mut hidden) = (0, 0, 0);
    for (seed, vectors) in [(1, AXES), (2, TILTED), (3, SLANTED)] {
        for repeats in SLABS.into_iter().chain(RODS) {
            for (kind, count) in [(0, 1), (0, 4), (0, 9), (1, 6), (2, 1), (2, 5), (0, 40)] {
                let scale = if count == 40 { 2.0 } else { 4.0 };
                let torus = torus(vectors, repeats, scale);
                let points = points(100 * seed + count as u64, count, torus, kind);
                let filtration = Filtration::on(Some(torus), points).unwrap();
                let whole = filtration.whole();
                let torus = filtration.torus().unwrap();
                let ordered = filtration.simplices().unwrap();
                let found = times(&ordered, |row| Some(key_of(whole, row)));
                let of_box = own(whole);
                let most = if torus.dimension() == 1 { 5 } else { 4 };
                let expected = in_space(&of_box, torus, most);
                assert_eq!(found.len(), expected.len(), "{seed} {repeats:?} {kind} {count}");
                for (key, times) in &expected {
                    assert_eq!(found.get(key), Some(times), "{seed} {repeats:?} {kind} {key:?}");
                }
                small += usize::from(!whole.copies().is_empty());
                flat += usize::from(whole.complex().cells.is_empty());
                hidden += whole.hidden().map_or(0, <[u32]>::len);
            }
        }
    }
    assert!(small > 60 && flat > 30 && hidden > 5, "{small} {flat} {hidden}");
}
