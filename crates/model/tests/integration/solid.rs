//! Boundaries as those of solids: closed, oriented, manifold, and in the same place.

use std::collections::HashMap;

use walpha_points::Weighting;
use walpha_points::{Selection, SelectionRule, Units, difference, select, weigh};
use walpha_shape::{Alpha, AlphaShape, WeightedPoints, alpha_shape};
use walpha_shape::{Cuts, ShapeOptions, Surface};
use walpha_volume::sample;

fn shape(points: WeightedPoints, alpha: f64) -> AlphaShape {
    alpha_shape(points, &ShapeOptions::new(Alpha::from_squared(alpha).unwrap())).unwrap()
}

fn counts(cuts: Cuts) -> [usize; 3] {
    [cuts.edges, cuts.vertices, cuts.midpoints]
}

fn unweighted(positions: &[[f64; 3]]) -> WeightedPoints {
    let values: Vec<f64> = (0..positions.len()).map(|i| i as f64).collect();
    WeightedPoints::unweighted(positions.to_vec()).with_values(values).unwrap()
}

/// Each edge is walked along once in each direction, around each vertex is one fan, and the boundary
/// holds the volume of the cells.
fn is_solid(shape: &AlphaShape) -> Cuts {
    let (surface, cuts) = shape.solid();
    assert!(surface.singular.is_empty() && surface.edges.is_empty() && surface.points.is_empty());
    let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
    for [a, b, c] in &surface.regular {
        assert!(a != b && b != c && c != a);
        for edge in [[*a, *b], [*b, *c], [*c, *a]] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    for ([a, b], count) in &edges {
        assert_eq!((*count, edges.get(&[*b, *a])), (1, Some(&1)), "edge {a} {b}");
    }
    let defects = surface.manifold_defects();
    assert!(defects.is_empty(), "{defects:?}");
    let at: Vec<[f64; 3]> = surface.positions(shape.points().positions()).collect();
    assert_eq!(at.len(), surface.vertex_count());
    let volume: f64 = surface
        .regular
        .iter()
        .map(|facet| {
            let [a, b, c] = facet.map(|v| at[v as usize]);
            let cross = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
            (a[0] * cross(1, 2) + a[1] * cross(2, 0) + a[2] * cross(0, 1)) / 6.0
        })
        .sum();
    let expected = shape.measures().volume;
    // Copies of vertices are moved apart.
    let tolerated = if cuts.moved == 0 { 1e-9 } else { 4e-3 };
    assert!((volume - expected).abs() <= tolerated * expected, "{volume}, not {expected}");
    cuts
}

const CUBE: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [1.0, 1.0, 1.0],
];

#[test]
fn a_manifold_stays_as_it_is() {
    let shape = shape(unweighted(&CUBE), 0.75);
    assert_eq!(is_solid(&shape), Cuts::default());
    let (solid, _) = shape.solid();
    assert_eq!(solid.vertices, Surface::of(&shape).vertices);
    assert_eq!(solid.regular, Surface::of(&shape).regular);
}

/// Two tetrahedra that share an edge, or a vertex: it stands there twice.
#[test]
fn parts_that_touch_are_cut_apart() {
    let positions = [
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.5, 0.5],
        [0.5, 1.0, 0.5],
        [-1.0, -0.5, 0.5],
        [-0.5, -1.0, 0.5],
    ];
    let along_an_edge = is_solid(&shape(unweighted(&positions), 0.6));
    assert_eq!(counts(along_an_edge), [1, 2, 0]);
    let positions = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [-1.0, -1.0, 0.0],
        [-1.0, 0.0, -1.0],
        [0.0, -1.0, -1.0],
    ];
    let at_a_vertex = is_solid(&shape(unweighted(&positions), 0.75));
    assert_eq!(counts(at_a_vertex), [0, 1, 0]);
}

/// Six cubes around an edge, with gaps between the first and the last on both sides of it, above and
/// below which the ring is closed: both ends of the edge are in one fan.
#[test]
fn sheets_that_share_both_ends_are_bent_apart() {
    let mut positions = Vec::new();
    // A 2×2×3 block of cubes, without two that are opposite each other in the middle layer.
    let cubes = (0..12).map(|i| [i % 2, i / 2 % 2, i / 4]);
    let missing = |[x, y, z]: [i32; 3]| z == 1 && x == y;
    for cube in cubes.filter(|&cube| !missing(cube)) {
        let at = cube.map(f64::from);
        positions.extend(CUBE.map(|corner| [0, 1, 2].map(|k| 2.0 * (corner[k] + at[k]))));
        // A point in the middle keeps the cube in at an α that the missing ones need more than.
        positions.push(at.map(|c| 2.0 * c + 1.0));
    }
    let shape = shape(unweighted(&positions), 2.4);
    let cuts = is_solid(&shape);
    assert_eq!((cuts.edges, cuts.midpoints), (1, 1), "{cuts:?}");
    let (solid, _) = shape.solid();
    let values = shape.points().values().unwrap();
    let value = solid.numbers(values).last().unwrap();
    let ends = solid.midpoints[0].map(|v| values[solid.vertices[v as usize] as usize]);
    assert_eq!(value, f64::midpoint(ends[0], ends[1]), "F is linear on an edge");
}

#[test]
fn any_shape_of_a_volume_is_a_solid() {
    let volume = sample("sample:phantom@20").unwrap();
    let differences = difference(&volume);
    let selection = Selection::default().rule(SelectionRule::Ratio(0.0609));
    let points = select(&volume, &volume, &differences, &selection, Units::Voxel).unwrap();
    let mut seen = Cuts::default();
    for weighting in [Weighting::Common(0.0), Weighting::MinMax] {
        for alpha in [0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0] {
            let cuts = is_solid(&shape(
                weigh(points.clone(), weighting, Alpha::from_squared(alpha).unwrap()).unwrap(),
                alpha,
            ));
            seen.edges += cuts.edges;
            seen.vertices += cuts.vertices;
            seen.midpoints += cuts.midpoints;
        }
    }
    assert!(seen.edges > 0 && seen.vertices > 0, "the shapes tried are not manifolds: {seen:?}");
}
