//! Solids as a reader sees them that takes equal coordinates for one vertex.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use walpha_base::random::Random;
use walpha_complex::Voxels;
use walpha_regular::predicates::orientation;

use super::boxes::{Boxes, bounds};
use super::crossing::cross;
use super::direction::length;
use super::tiling::opposite;
use super::*;
use crate::{Alpha, ShapeOptions, SinglePrecision, WeightedPoints, alpha_shape, voxel_shape};

type Point = [f64; 3];

/// The facets of a solid, by vertices that are numbered by their coordinates.
fn merged(facets: &[[u32; 3]], places: &[Point]) -> Surface {
    let mut numbers: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    let mut number = |v: u32| {
        // Adding 0 turns −0 into 0.
        let key = places[v as usize].map(|x| (x + 0.0).to_bits());
        let next = numbers.len() as u32;
        *numbers.entry(key).or_insert(next)
    };
    let regular: Vec<[u32; 3]> = facets.iter().map(|row| row.map(&mut number)).collect();
    Surface { vertices: (0..numbers.len() as u32).collect(), regular, ..Surface::default() }
}

/// Each edge is on two facets, which go along it in opposite directions, and around each vertex is one fan.
fn is_manifold(surface: &Surface) -> bool {
    let mut edges: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for [a, b, c] in &surface.regular {
        for edge in [[*a, *b], [*b, *c], [*c, *a]] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    let paired = edges.iter().all(|([a, b], n)| *n == 1 && edges.get(&[*b, *a]) == Some(&1));
    paired && surface.manifold_defects().is_empty()
}

/// Pairs of facets that cross each other.
fn crossings(facets: &[[u32; 3]], places: &[Point]) -> usize {
    let corners = |row: &[u32; 3]| row.map(|v| places[v as usize]);
    let boxes: Vec<_> = facets.iter().map(|row| bounds(corners(row))).collect();
    let tree = Boxes::new(boxes.iter().copied());
    let of_facet = |(i, row): (usize, &[u32; 3])| {
        let after = tree.near(boxes[i]).into_iter().filter(|&j| j as usize > i);
        after.filter(|&j| cross(corners(row), corners(&facets[j as usize]))).count()
    };
    facets.iter().enumerate().map(of_facet).sum()
}

fn volume(facets: &[[u32; 3]], places: &[Point]) -> f64 {
    let of_facet = |row: &[u32; 3]| {
        let [a, b, c] = row.map(|v| places[v as usize]);
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        (a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)) / 6.0
    };
    facets.iter().map(of_facet).sum()
}

fn points(points: &[Point], alpha: f64) -> AlphaShape {
    alpha_shape(points, &ShapeOptions::new(Alpha::from_squared(alpha).unwrap())).unwrap()
}

const UNIT: [Point; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The solid of the voxels for which `inside` holds.
fn voxels(side: u32, mut inside: impl FnMut([u32; 3]) -> bool) -> AlphaShape {
    let at = |i: u32| [i % side, i / side % side, i / side / side];
    let chosen = (0..side.pow(3)).filter(|&i| inside(at(i)));
    let runs = chosen.map(|i| [u64::from(i), 1]).collect();
    let voxels = Voxels { dims: [side; 3], origin: [0.5; 3], axes: UNIT, runs };
    voxel_shape(voxels, |_| 0.0).unwrap()
}

/// A shape of scattered points, of points of a lattice, with weights or without, or of voxels.
fn some_shape(seed: u64) -> AlphaShape {
    let mut random = Random::new(seed);
    let share = random.unit();
    match seed % 4 {
        0 => {
            let places: Vec<Point> = (0..300).map(|_| [0; 3].map(|_| random.unit())).collect();
            points(&places, 0.004 + 0.02 * share)
        }
        1 => {
            let grid = (0..729).map(|i| [i % 9, i / 9 % 9, i / 81].map(f64::from));
            let chosen: Vec<Point> = grid.filter(|_| random.unit() < share.max(0.05)).collect();
            points(&chosen, random.pick(&[0.75, 0.8, 1.0, 1.5]))
        }
        2 => {
            let places: Vec<Point> =
                (0..250).map(|_| [0; 3].map(|_| random.below(7) as f64)).collect();
            let weights = places.iter().map(|_| random.below(6) as f64 / 2.0).collect();
            let alpha = Alpha::from_squared(random.pick(&[0.25, 0.5, 0.75, 1.5])).unwrap();
            let weighted = WeightedPoints::new(places, weights).unwrap();
            alpha_shape(weighted, &ShapeOptions::new(alpha)).unwrap()
        }
        _ => voxels(8, |at| at == [0; 3] || random.unit() < share),
    }
}

/// The solid is a manifold for readers that take equal coordinates for one vertex, in doubles and in single precision, and
/// nowhere crosses itself; vertices that were not cut apart stay in place.
fn is_apart(shape: &AlphaShape) -> (Cuts, f64) {
    let (solid, cuts) = shape.solid();
    let of_input = shape.points().positions();
    let before: Vec<Point> = solid.unmoved(of_input).collect();
    let after: Vec<Point> = solid.positions(of_input).collect();
    let facets = &solid.regular;
    assert_eq!((cuts.together, cuts.moved), (0, cuts.vertices + cuts.midpoints), "{cuts:?}");
    assert!(is_manifold(&merged(facets, &after)), "{cuts:?}");
    let single = SinglePrecision::of_surface(solid, of_input);
    let rounded: Vec<Point> = after.iter().map(|&p| single.round(p).map(f64::from)).collect();
    assert!(!single.is_lossy && is_manifold(&merged(facets, &rounded)), "{cuts:?} {single:?}");
    assert_eq!(crossings(facets, &after), 0, "{cuts:?}");
    for (v, (old, new)) in before.iter().zip(&after).enumerate() {
        let copies = solid.vertices.iter().filter(|&&w| solid.vertices.get(v) == Some(&w));
        assert!(old == new || copies.count() != 1, "{v} has no copies");
        let distance = length([0, 1, 2].map(|k| old[k] - new[k]));
        assert!(distance <= cuts.largest_move);
    }
    let [old, new] = [&before, &after].map(|places| volume(facets, places));
    (cuts, if old == new { 0.0 } else { new / old - 1.0 })
}

#[test]
fn solids_are_manifolds_by_their_coordinates() {
    let mut seen = Cuts::default();
    for seed in 0..80 {
        let (cuts, change) = is_apart(&some_shape(seed));
        assert!(change.abs() < 2e-3, "{seed}: {change}");
        seen.vertices += cuts.vertices;
        seen.midpoints += cuts.midpoints;
    }
    assert!(seen.vertices > 2000 && seen.midpoints > 50, "{seen:?}");
}

/// The cells around moved vertices stay positively oriented, and each facet there is on one cell.
fn is_tiled(shape: &AlphaShape) {
    let Cut { solid, middles, around, .. } = Cut::of(shape);
    let Some((tiling, places)) = around else { return };
    let of_input = shape.points().positions();
    let mut apart = Apart::new(&solid, of_input, tiling);
    apart.separate(&middles, &places);
    let mut facets: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    for &cell in apart.cells() {
        let [a, b, c, d] = cell.map(|v| apart.at(v));
        assert_eq!(orientation(a, b, c, d), Ordering::Greater, "{cell:?}");
        for corner in cell {
            *facets.entry(sorted(opposite(cell, corner))).or_default() += 1;
        }
    }
    let copies = places.iter().flat_map(|place| place.copies.clone());
    let moved: BTreeSet<u32> = copies.chain(middles.iter().map(|middle| middle.vertex)).collect();
    for row in solid.regular.iter().filter(|row| row.iter().any(|v| moved.contains(v))) {
        assert_eq!(facets.get(&sorted(*row)), Some(&1), "{row:?}");
    }
}

#[test]
fn cells_stay_positively_oriented() {
    // Vertices that are moved anywhere near may leave their cells, but voxels need no such moves.
    (3..160).step_by(4).for_each(|seed| is_tiled(&some_shape(seed)));
}

fn sorted(mut row: [u32; 3]) -> [u32; 3] {
    row.sort_unstable();
    row
}

/// The shape that has these cells, for any α.
fn of_cells(places: &[Point], cells: &[[u32; 4]]) -> AlphaShape {
    let mut facets: BTreeMap<[u32; 3], Vec<[u32; 3]>> = BTreeMap::new();
    for &cell in cells {
        let [a, b, c, d] = cell.map(|v| places[v as usize]);
        let inward = orientation(a, b, c, d) == Ordering::Greater;
        for corner in cell {
            let [a, b, c] = opposite(cell, corner);
            let outward = if inward { [a, c, b] } else { [a, b, c] };
            facets.entry(sorted(outward)).or_default().push(outward);
        }
    }
    let mut shape = points(places, 0.0);
    let class = |rows: &[[u32; 3]]| if rows.len() == 1 { Class::Regular } else { Class::Interior };
    shape.complex.cells = cells.iter().map(|&row| (row, Class::Interior)).collect();
    shape.complex.facets = facets.values().map(|rows| (rows[0], class(rows))).collect();
    shape
}

/// The opposite facet is nearer than the first step is long.
#[test]
fn steps_stay_in_flat_cells() {
    let height = 1e-5;
    let at = |x: f64, y: f64, up: f64| [x, y, up * height];
    let places = [
        [0.0; 3],
        at(1.0, 0.0, -1.0),
        at(-1.0, 1.0, -1.0),
        at(-1.0, -1.0, -1.0),
        at(-1.0, 0.0, 1.0),
        at(1.0, 1.0, 1.0),
        at(1.0, -1.0, 1.0),
    ];
    let (cuts, _) = is_apart(&of_cells(&places, &[[0, 1, 2, 3], [0, 4, 5, 6]]));
    assert_eq!(cuts.moved, 1);
    assert!(cuts.largest_move < height, "{cuts:?}");
}

/// In a wide shape the first step is longer, so that single precision resolves it.
#[test]
fn places_differ_in_single_precision() {
    let tetrahedron = |[x, y, z]: Point, size: f64| {
        [[x, y, z], [x + size, y, z], [x, y + size, z], [x, y, z + size]]
    };
    let far = 1000.0;
    let mut places = tetrahedron([0.0; 3], 0.02).to_vec();
    places.extend(&tetrahedron([0.0; 3], -0.02)[1..]);
    places.extend(tetrahedron([far; 3], 1.0));
    let (cuts, _) = is_apart(&of_cells(&places, &[[0, 1, 2, 3], [0, 4, 5, 6], [7, 8, 9, 10]]));
    assert_eq!(cuts.moved, 1);
    assert!(cuts.largest_move > 1e-4, "{cuts:?}");
}

/// Two cubes that share an edge or a corner, a chessboard in space, and a cross of bars that ends in a chessboard.
#[test]
fn voxels_that_touch_are_moved_apart() {
    let (along_an_edge, less) = is_apart(&voxels(2, |[x, y, z]| x == y && z == 0));
    assert_eq!((along_an_edge.moved, along_an_edge.largest_move < 1e-3), (2, true));
    assert!(less < 0.0 && less > -2e-3, "{less}");
    let (at_a_corner, _) = is_apart(&voxels(2, |[x, y, z]| x == y && y == z));
    assert_eq!(at_a_corner.moved, 1);
    let (board, _) = is_apart(&voxels(5, |[x, y, z]| (x + y + z) % 2 == 0));
    assert!(board.edges > 100 && board.moved > 100, "{board:?}");
}

/// Cavities that touch each other, or the outside, at a vertex: between them are the same cells.
#[test]
fn cavities_that_touch_retreat() {
    let two = |at: [u32; 3]| at == [1; 3] || at == [2; 3];
    is_tiled(&voxels(4, |at| !two(at)));
    let (cuts, more) = is_apart(&voxels(4, |at| !two(at)));
    assert_eq!(cuts.moved, 1);
    assert!((cuts.largest_move * 1024.0 - 1.0).abs() < 1e-9, "straight into one: {cuts:?}");
    assert!(more > 0.0 && more < 1e-4, "the solid grows: {more}");
    // The second is open to the outside.
    let open = |[x, y, z]: [u32; 3]| two([x, y, z]) || (x >= 2 && y == 2 && z == 2);
    assert_eq!(is_apart(&voxels(4, |at| !open(at))).0.moved, 1);
    // Along an edge, with facets to both sides at both ends.
    let beside = |at: [u32; 3]| at == [1, 1, 1] || at == [2, 2, 1];
    let (cuts, _) = is_apart(&voxels(4, |at| !beside(at)));
    assert_eq!((cuts.edges, cuts.moved), (1, cuts.vertices + cuts.midpoints));
}

/// Lattices with few doubles: the places between them are all tried.
#[test]
fn rounded_steps_cross_nothing() {
    let mut random = Random::new(4);
    for round in 0..40 {
        let step = f64::EPSILON * random.pick(&[2.0, 4.0, 16.0, 64.0]);
        let grid = (0..343).map(|i| [i % 7, i / 7 % 7, i / 49].map(f64::from));
        let chosen: Vec<Point> = grid.filter(|_| random.unit() < 0.6).collect();
        let places: Vec<Point> = chosen.iter().map(|p| p.map(|x| 1.0 + step * x)).collect();
        let shape = points(&places, step * step * 0.8);
        let (solid, _) = shape.solid();
        let places: Vec<Point> = solid.positions(shape.points().positions()).collect();
        let before: Vec<Point> = solid.unmoved(shape.points().positions()).collect();
        let [old, new] = [&before, &places].map(|places| crossings(&solid.regular, places));
        assert!(new <= old, "{round}: {old} before, {new} after");
    }
}

/// Points as near to each other as doubles can be leave no room: vertices that stay together are counted.
#[test]
fn what_cannot_be_moved_apart_is_counted() {
    let mut random = Random::new(3);
    let mut left = 0;
    for round in 0..20 {
        let mut places: Vec<Point> = Vec::new();
        while places.len() < 200 {
            let p = [0; 3].map(|_| 1.0 + random.unit());
            places.extend([p, [p[0].next_up(), p[1], p[2]], [p[0], p[1], p[2] + 1e-6]]);
        }
        let shape = points(&places, 0.02 + 0.002 * f64::from(round));
        let (solid, cuts) = shape.solid();
        let places: Vec<Point> = solid.positions(shape.points().positions()).collect();
        let distinct = merged(&solid.regular, &places).vertices.len();
        assert!(places.len() - distinct <= cuts.together, "{cuts:?}");
        left += cuts.together;
    }
    assert!(left > 0, "there was room for all");
}

#[test]
fn solids_are_the_same_on_any_number_of_threads() {
    for seed in [0, 5, 7] {
        let of = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let shape = some_shape(seed);
                let (solid, cuts) = shape.solid();
                (solid.clone(), cuts)
            })
        };
        assert_eq!(of(1), of(3));
    }
}
