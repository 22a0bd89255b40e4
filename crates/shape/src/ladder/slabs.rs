//! Points that repeat along one or two vectors, against finite copies in space, a torus with a gap, and boundary matrices.

use std::collections::BTreeMap;
use std::num::NonZeroUsize;

use walpha_base::parallel::prelude::*;
use walpha_regular::Torus;

use super::small::tests::{alive_at, betti_by_ranks, random_points};
use super::{Filtration, Ordered};
use crate::copies::Copied;
use crate::winding::{Winding, minus};
use crate::{Alpha, AlphaShape, Betti, Class, ShapeOptions, Void, WeightedPoints, alpha_shape};

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

/// Betti numbers and pairs at each value, of points in general position, on grids, in planes and on lines; and those of shapes.
#[test]
fn betti_numbers_are_those_of_boundary_matrices() {
    let boxes = [(1_u64, AXES), (2, TILTED), (3, SLANTED)].into_iter();
    let boxes =
        boxes.flat_map(|of| SLABS.into_iter().chain(RODS).map(move |repeats| (of, repeats)));
    let kinds = [(0, 1), (0, 4), (0, 7), (1, 6), (2, 1), (2, 5), (0, 30)];
    let sets = boxes.flat_map(|of| kinds.map(|kind| (of, kind)));
    let compare = |(((seed, vectors), repeats), (kind, count))| {
        let (mut compared, mut sheets, mut voids) = (0, 0, 0);
        let scale = if count == 30 { 2.0 } else { 4.0 };
        let torus = torus(vectors, repeats, scale);
        let points = points(10 * seed + count as u64, count, torus, kind);
        let filtration = Filtration::on(Some(torus), points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let curve = ordered.betti_curve();
        let diagrams: Vec<Vec<_>> =
            (0..4).map(|dimension| ordered.persistence(dimension).unwrap()).collect();
        // Values are rounded.
        let above = |value: &Alpha| Alpha::from_squared(value.squared().next_up()).unwrap();
        // What is rounded in several copies of the box stays as it is.
        let points = own(filtration.whole());
        let torus = filtration.torus().unwrap();
        let values: Vec<Alpha> = ordered.values().iter().map(above).collect();
        let levels = filtration.levels(&values);
        assert_eq!(levels.len(), curve.len());
        let (of_levels, of_voids) = (levels.betti(), levels.voids());
        let by_ranks = betti_by_ranks(&ordered);
        for (rank, (&betti, expected)) in (0..).zip(curve.iter().zip(by_ranks)) {
            let context = format!("{seed} {repeats:?} {kind} {count} {rank}");
            assert_eq!(Vec::from(betti), expected.map(|b| b as u64), "{context}");
            assert_eq!(alive_at(&ordered, &diagrams, rank), expected, "{context}");
            assert_eq!(of_levels[rank as usize], betti, "{context}");
            // A sheet parts what is above a slab from what is below, and a tube what is in it from what is around; they enclose nothing.
            let void_count = of_voids[rank as usize].len() as u64;
            let open = betti.b2.checked_sub(void_count);
            sheets += open.expect("each void has a surface");
            voids += void_count;
            // Each shape costs more than all numbers of a filtration.
            let step = if count == 30 {
                40
            } else if kind == 0 {
                5
            } else {
                3
            };
            if rank % step == 0 {
                let options = ShapeOptions::new(values[rank as usize]);
                for exterior in [false, true] {
                    let options = options.periodic(Some(torus)).exterior(exterior);
                    let shape = alpha_shape(points.clone(), &options).unwrap();
                    assert_eq!(shape.betti(), Some(betti), "{context} {exterior}");
                    if exterior {
                        let sizes = |voids: &[Void]| -> Vec<_> {
                            voids.iter().map(|v| (v.cells, v.filling_alpha)).collect()
                        };
                        let found = shape.voids().unwrap();
                        assert_eq!(sizes(&found), sizes(&of_voids[rank as usize]));
                    }
                }
            }
            compared += 1;
        }
        [compared, sheets, voids]
    };
    let all = sets.collect::<Vec<_>>().into_par_iter().map(compare);
    let [compared, sheets, voids] = all.reduce(|| [0; 3], |a, b| [0, 1, 2].map(|k| a[k] + b[k]));
    assert!(compared > 2000 && sheets > 50 && voids > 50, "{compared} {sheets} {voids}");
}

/// The points of each simplex, with its class, in order.
fn simplices(shape: &AlphaShape) -> Vec<(Vec<u32>, Class)> {
    fn of<const N: usize>(
        shape: &AlphaShape,
        rows: &crate::Simplices<N>,
    ) -> Vec<(Vec<u32>, Class)> {
        let points = |row: &[u32; N]| {
            let mut points: Vec<u32> = row.iter().map(|&v| shape.copied(v).0).collect();
            points.sort_unstable();
            points
        };
        rows.iter().map(|(row, class)| (points(row), class)).collect()
    }
    let complex = shape.complex();
    let mut all = of(shape, &complex.cells);
    all.extend(of(shape, &complex.facets));
    all.extend(of(shape, &complex.edges));
    all.extend(of(shape, &complex.vertices));
    all.sort_unstable();
    all
}

/// Far from the copies along a third vector, the shape of a torus is that of the slab or rod.
#[test]
fn shapes_are_those_of_a_torus_with_a_gap() {
    const GAP: f64 = 16.0;
    let mut regular = 0;
    for (seed, vectors) in [(1, AXES), (2, TILTED), (3, SLANTED)] {
        for repeats in SLABS.into_iter().chain(RODS) {
            let partial = torus(vectors, repeats, 4.0);
            // Perpendicular to what repeats: out of a slab, and around a rod.
            let [a, b, c] = partial.vectors();
            let cross = |u: [f64; 3], v: [f64; 3]| {
                [0, 1, 2].map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3])
            };
            let sum = [0, 1, 2].map(|k| a[k] + b[k] + c[k]);
            let mut others = [cross(a, b), cross(b, c), cross(c, a)];
            if partial.dimension() == 1 {
                let across = cross(sum, [0.25, -0.5, 1.0]);
                others = [across, cross(sum, across), across];
            }
            let mut others = others.into_iter().filter(|v| *v != [0.0; 3]);
            let full = partial.vectors().map(|vector| {
                if vector != [0.0; 3] {
                    return vector;
                }
                let other = others.next().unwrap();
                let length = other[0].hypot(other[1]).hypot(other[2]);
                other.map(|x| (x * GAP / length).round())
            });
            let full = Torus::of_vectors(full).unwrap();
            for count in [2, 30] {
                let points = random_points(seed + 100 * count, count as usize, 0.25);
                let round = |x: f64| (x * 1048576.0).round() / 1048576.0;
                let positions = points.positions.iter().map(|p| p.map(round)).collect();
                let points = WeightedPoints { positions, ..points };
                for alpha in [0.1, 0.4, 1.0, 1.75, 3.5] {
                    let alpha = Alpha::from_squared(alpha).unwrap();
                    let [one, other] = [partial, full].map(|torus| {
                        let options = ShapeOptions::new(alpha).periodic(Some(torus));
                        alpha_shape(points.clone(), &options).unwrap()
                    });
                    assert_eq!(simplices(&one), simplices(&other), "{seed} {repeats:?} {count}");
                    assert_eq!(one.betti(), other.betti(), "{seed} {repeats:?} {count}");
                    let sizes = |shape: &AlphaShape| -> Vec<_> {
                        let components = shape.components();
                        components.iter().map(|c| (c.vertices, c.cells, c.rounds)).collect()
                    };
                    assert_eq!(sizes(&one), sizes(&other));
                    let (one, other) = (one.measures(), other.measures());
                    assert!((one.volume - other.volume).abs() < 1e-9);
                    assert!((one.area - other.area).abs() < 1e-9);
                    regular += usize::from(one.regular_area > 0.0);
                }
            }
        }
    }
    assert!(regular > 60, "{regular}");
}

/// Blocks with halos, some of them flat, have the shape of one block.
#[test]
fn blocks_have_the_shape_of_the_whole() {
    for (vectors, repeats) in
        [(AXES, SLABS[1]), (TILTED, SLABS[0]), (SLANTED, SLABS[2]), (SLANTED, RODS[0])]
    {
        let torus = torus(vectors, repeats, 8.0);
        let mut points = random_points(5, 400, 0.1);
        // A line of points far out, so that a block of these alone is flat.
        for i in 0..20 {
            points
                .positions
                .push([0, 1, 2].map(|k| 4.0 + torus.vectors()[0][k] * f64::from(i) / 20.0));
            points.weights.push(0.0);
        }
        for alpha in [0.05, 0.3, 1.0] {
            let options =
                ShapeOptions::new(Alpha::from_squared(alpha).unwrap()).periodic(Some(torus));
            let [one, many] = [1, 7].map(|blocks| {
                let options = options.blocks(NonZeroUsize::new(blocks));
                alpha_shape(points.clone(), &options).unwrap()
            });
            assert_eq!((one.copies().len(), many.copies().len()), (0, 0), "{repeats:?} {alpha}");
            assert!(one.complex() == many.complex(), "{repeats:?} {alpha}");
            assert_eq!(one.betti(), many.betti(), "{repeats:?} {alpha}");
            assert_eq!(one.sheets().map(|s| s.count), many.sheets().map(|s| s.count));
            // Where an edge of the whole triangulation spans half of the box, rows name copies.
            let whole = alpha_shape(points.clone(), &options.exterior(true)).unwrap();
            assert_eq!(whole.betti(), one.betti());
            let mut listed = simplices(&whole);
            listed.retain(|(_, class)| *class != Class::Exterior);
            assert!(listed == simplices(&one), "{repeats:?} {alpha}");
        }
    }
}

/// A wire of one atom, a sheet of squares, graphene, and layers of a cubic lattice.
#[test]
fn wires_sheets_and_layers() {
    let betti = |b0, b1, b2| Some(Betti { b0, b1, b2, b3: Some(0) });
    let at = |torus: Torus, points: &[[f64; 3]]| {
        let filtration = Filtration::on(Some(torus), points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let counts = [0, 1, 2, 3].map(|dimension| ordered.count(dimension));
        let values: Vec<f64> = ordered.values().iter().map(|alpha| alpha.squared()).collect();
        let lasting = |dimension| {
            let intervals = ordered.persistence(dimension).unwrap();
            intervals.iter().filter(|interval| interval.ends.is_none()).count()
        };
        let lasting = [0, 1, 2, 3].map(lasting);
        (filtration.whole().betti(), counts, values, lasting)
    };
    let wire = torus(SLANTED, RODS[1], 1.0);
    let square = 0.375f64.powi(2) + 0.875f64.powi(2);
    let expected = (betti(1, 1, 0), [1, 1, 0, 0], vec![0.0, square / 4.0], [1, 1, 0, 0]);
    assert_eq!(at(wire, &[[0.25, 7.0, -3.0]]), expected);

    let sheet = torus(AXES, SLABS[1], 1.0);
    let expected = (betti(1, 2, 1), [1, 3, 2, 0], vec![0.0, 0.25, 0.5], [1, 2, 1, 0]);
    assert_eq!(at(sheet, &[[0.5, 7.0, 0.5]]), expected);

    let half = 0.75f64.sqrt();
    let graphene = [[1.0, 0.0, 0.0], [-0.5, half, 0.0], [0.0, 0.0, 9.0]];
    let graphene = Torus::repeating(graphene, SLABS[0]).unwrap();
    let atoms = [[0.0, 0.0, 2.0], [0.0, half * 2.0 / 3.0, 2.0]];
    let (whole, counts, values, lasting) = at(graphene, &atoms);
    assert_eq!((whole, counts, lasting), (betti(1, 2, 1), [2, 6, 4, 0], [1, 2, 1, 0]));
    // Bonds, and the centres of hexagons.
    let bond = 1.0 / 3.0;
    assert!((values[1] - bond / 4.0).abs() < 1e-9 && (values.last().unwrap() - bond).abs() < 1e-9);
    let bonds = Alpha::from_squared(bond / 3.0).unwrap();
    let options = ShapeOptions::new(bonds).periodic(Some(graphene));
    assert_eq!(alpha_shape(&atoms[..], &options).unwrap().betti(), betti(1, 2, 0));

    // Two layers of cubes between three of points.
    let layers = [[0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]];
    let slab = torus(AXES, SLABS[0], 1.0);
    let (whole, counts, values, lasting) = at(slab, &layers);
    assert_eq!((whole, counts, lasting), (betti(1, 2, 1), [3, 17, 26, 12], [1, 2, 1, 0]));
    assert_eq!(values, [0.0, 0.25, 0.5, 0.75]);
    let filtration = Filtration::on(Some(slab), &layers[..]).unwrap();
    assert_eq!(filtration.whole().measures().volume, 2.0);
    assert_eq!(filtration.whole().measures().area, 2.0);
}
