use std::collections::BTreeSet;

use walpha_base::random::Random;

use super::*;
use crate::{Alpha, Engine, ShapeOptions, Simplices, Torus, WeightedPoints, alpha_shape};

type Place = [f64; 2];

fn shape(positions: Vec<[f64; 3]>, alpha: f64) -> AlphaShape {
    let alpha = Alpha::from_squared(alpha).unwrap();
    let options = ShapeOptions::new(alpha).engine(Engine::Native);
    alpha_shape(WeightedPoints::unweighted(positions), &options).unwrap()
}

fn flat(places: &[Place]) -> Vec<[f64; 3]> {
    places.iter().map(|&[x, y]| [x, y, 0.0]).collect()
}

/// Places of the lattice with both coordinates in 0..n, except some.
fn lattice(n: i32, is_left_out: impl Fn(i32, i32) -> bool) -> Vec<Place> {
    let all = (0..n * n).map(|i| (i % n, i / n));
    all.filter(|&(x, y)| !is_left_out(x, y)).map(|(x, y)| [x.into(), y.into()]).collect()
}

/// The triangles with all their faces, each singular, because classes of space do not matter here.
fn closed(triangles: &[[u32; 3]]) -> Complex {
    let sorted = |mut row: [u32; 3]| {
        row.sort_unstable();
        row
    };
    let facets: BTreeSet<[u32; 3]> = triangles.iter().copied().map(sorted).collect();
    let sides = |&[a, b, c]: &[u32; 3]| [[a, b], [a, c], [b, c]];
    let edges: BTreeSet<[u32; 2]> = facets.iter().flat_map(sides).collect();
    let vertices: BTreeSet<[u32; 1]> = facets.iter().flatten().map(|&v| [v]).collect();
    fn singular<const N: usize>(rows: BTreeSet<[u32; N]>) -> Simplices<N> {
        rows.into_iter().map(|row| (row, Class::Singular)).collect()
    }
    let (facets, edges, vertices) = (singular(facets), singular(edges), singular(vertices));
    Complex { cells: Simplices::default(), facets, edges, vertices }
}

/// The outline of triangles alone.
fn outline_of(triangles: &[[u32; 3]], places: &[Place]) -> Outline {
    let twice: f64 = triangles.iter().map(|row| twice_area(row, places).abs()).sum();
    Outline::of(&closed(triangles), &flat(places), twice / 2.0).unwrap()
}

/// Twice the area within a ring, positive if it turns counter-clockwise; exact for small whole numbers.
fn twice_area(ring: &[u32], places: &[Place]) -> f64 {
    let at = |i: usize| places[ring[i % ring.len()] as usize];
    (0..ring.len()).map(|i| at(i)[0] * at(i + 1)[1] - at(i)[1] * at(i + 1)[0]).sum()
}

/// Whether a place that is not on a ring is inside it, by the parity of crossings with a ray.
fn is_within(ring: &[u32], places: &[Place], [x, y]: Place) -> bool {
    let at = |i: usize| places[ring[i % ring.len()] as usize];
    let crosses = |&i: &usize| {
        let ([ax, ay], [bx, by]) = (at(i), at(i + 1));
        (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax)
    };
    (0..ring.len()).filter(crosses).count() % 2 == 1
}

fn rings(outline: &Outline) -> impl Iterator<Item = &Vec<u32>> {
    outline.polygons.iter().flat_map(|polygon| [&polygon.outer].into_iter().chain(&polygon.holes))
}

/// The number of holes and area of each polygon.
fn summary(outline: &Outline, places: &[Place]) -> Vec<(usize, f64)> {
    let area = |polygon: &Polygon| {
        let holes: f64 = polygon.holes.iter().map(|hole| twice_area(hole, places)).sum();
        f64::midpoint(twice_area(&polygon.outer, places), holes)
    };
    outline.polygons.iter().map(|polygon| (polygon.holes.len(), area(polygon))).collect()
}

#[test]
fn a_square_with_a_hole() {
    let places = lattice(6, |x, y| (2..4).contains(&x) && (2..4).contains(&y));
    let made = shape(flat(&places), 0.5);
    let outline = made.outline().cloned().unwrap();
    assert_eq!((outline.area, outline.perimeter), (18.0, 24.0 + 4.0 * 2f64.sqrt()));
    assert_eq!(summary(&outline, &places), [(1, 18.0)]);
    let Polygon { outer, holes } = &outline.polygons[0];
    assert_eq!((outer.len(), holes[0].len()), (20, 8));
    assert_eq!(outer[..7], [0, 1, 2, 3, 4, 5, 11], "from the smallest index, counter-clockwise");
    assert_eq!(holes[0][..3], [8, 13, 17], "clockwise");
    assert_eq!(outline.axes, [0, 1]);
    let counts = |class: Class| {
        let Complex { facets, edges, vertices, .. } = &outline.complex;
        [facets.counts()[class], edges.counts()[class], vertices.counts()[class]]
    };
    // The corners of the hole are cut: four vertices are on no ring.
    assert_eq!(counts(Class::Interior), [36, 40, 4]);
    assert_eq!(counts(Class::Regular), [0, 28, 28]);
    assert_eq!(counts(Class::Singular), [0, 0, 0]);
    assert_eq!((outline.edges.len(), outline.points.len()), (0, 0));
    assert_eq!(made.betti().unwrap().b1, 1);
}

/// Edges and points outside of polygons, also with exterior simplices listed.
#[test]
fn edges_and_points_beside_polygons() {
    let places = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [2.1, 0.0], [9.0, 9.0], [3.2, 0.0]];
    let options = ShapeOptions::new(Alpha::from_squared(0.5).unwrap()).engine(Engine::Native);
    for exterior in [false, true] {
        let points = WeightedPoints::unweighted(flat(&places));
        let made = alpha_shape(points, &options.exterior(exterior)).unwrap();
        let outline = made.outline().cloned().unwrap();
        assert_eq!(outline.polygons, [Polygon { outer: vec![0, 1, 2], holes: vec![] }]);
        assert_eq!(outline.edges, [[1, 3], [3, 5]]);
        assert_eq!(outline.points, [4]);
        assert_eq!((outline.area, outline.perimeter), (0.5, 2.0 + 2f64.sqrt()));
        let mut complex = outline.complex;
        assert_eq!(complex.lists_exterior(), exterior);
        complex.retain_shape();
        let class = |v: u32| complex.vertices.iter().find(|row| row.0[0] == v).unwrap().1;
        assert_eq!([0, 1, 3, 4, 5].map(class)[..3], [Class::Regular; 3]);
        assert_eq!((class(4), class(5)), (Class::Singular, Class::Regular));
        assert_eq!(complex.facets.rows(), [[0, 1, 2]]);
        let regular: Vec<_> = complex.edges.of(Class::Regular).collect();
        assert_eq!(regular, [&[0, 1], &[2, 0], &[1, 2]], "the triangle is on their left");
    }
}

#[test]
fn two_squares_that_touch_at_one_vertex() {
    let left = [[0.0, 0.0], [-1.0, 1.0], [-2.0, 0.0], [-1.0, -1.0], [-1.0, 0.0]];
    let right = left[1..].iter().map(|[x, y]| [-x, *y]);
    let places: Vec<Place> = left.into_iter().chain(right).collect();
    let outline = shape(flat(&places), 0.5).outline().cloned().unwrap();
    assert_eq!(summary(&outline, &places), [(0, 2.0), (0, 2.0)]);
    assert_eq!(outline.polygons[0].outer, [0, 1, 2, 3]);
    assert_eq!(outline.polygons[1].outer, [0, 7, 6, 5]);
    assert_eq!(outline.complex.vertices.counts().interior, 2);
}

/// A band of triangles whose two ends meet only at a vertex: the outer ring and the hole touch there.
#[test]
fn an_annulus_pinched_at_a_vertex() {
    let places = [[0.0, 0.0], [4.0, 2.0], [4.0, -2.0], [9.0, 9.0], [9.0, -9.0]];
    let outline = outline_of(&[[0, 1, 3], [1, 2, 3], [2, 3, 4], [0, 2, 4]], &places);
    assert_eq!(outline.polygons, [Polygon { outer: vec![0, 4, 3], holes: vec![vec![0, 1, 2]] }]);
    assert_eq!(summary(&outline, &places), [(1, 73.0)]);
}

/// A square ring, another one in its hole, and an island in the hole of that one.
#[test]
fn islands_in_holes() {
    let distance = |x: i32, y: i32| x.min(y).min(13 - x).min(13 - y);
    // From the rim inwards: a band of two rows of points, then a row left out.
    let places = lattice(14, |x, y| distance(x, y) % 3 == 2);
    let outline = shape(flat(&places), 0.5).outline().cloned().unwrap();
    assert_eq!(summary(&outline, &places), [(1, 50.0), (1, 26.0), (0, 1.0)]);
    assert_eq!((outline.polygons.len(), outline.holes()), (3, 2));
    assert_eq!(outline.area, 77.0);
}

/// Cocircular points everywhere: half of each square, all, and nothing.
#[test]
fn lattices_at_several_alphas() {
    let places = lattice(9, |_, _| false);
    for (alpha, polygons, area) in
        [(0.24, 0, 0.0), (0.25, 0, 0.0), (0.5, 1, 64.0), (f64::INFINITY, 1, 64.0)]
    {
        let outline = shape(flat(&places), alpha).outline().cloned().unwrap();
        assert_eq!((outline.polygons.len(), outline.area), (polygons, area), "{alpha}");
        let lone = if alpha < 0.25 { 81 } else { 0 };
        let edges = if alpha == 0.25 { 2 * 9 * 8 } else { 0 };
        assert_eq!((outline.points.len(), outline.edges.len()), (lone, edges), "{alpha}");
        assert_eq!(outline.perimeter, if polygons == 1 { 32.0 } else { 0.0 });
    }
}

/// The outline does not depend on the plane, except for how it is seen in two of the coordinates.
#[test]
fn tilted_planes() {
    let places = lattice(6, |x, y| (2..4).contains(&x) && (2..4).contains(&y));
    let [wanted, mirrored] = [1.0, -1.0].map(|sign| {
        let places: Vec<Place> = places.iter().map(|&[x, y]| [sign * x, y]).collect();
        shape(flat(&places), 0.5).outline().cloned().unwrap().polygons
    });
    assert_ne!(wanted, mirrored);
    // Each turns the plane and scales it evenly.
    type Turn = fn(f64, f64) -> [f64; 3];
    let turns: [(Turn, f64, [usize; 2], bool); 7] = [
        (|x, y| [x, y, 7.0], 1.0, [0, 1], true),
        (|x, y| [-x, y, -7.0], 1.0, [0, 1], false),
        (|x, y| [x, 0.25, y], 1.0, [0, 2], true),
        (|x, y| [3.0, x, y], 1.0, [1, 2], true),
        (|x, y| [3.0, y, x], 1.0, [1, 2], false),
        // Nearly vertical: only a small part of the plane is seen in x and y.
        (|x, y| [y + 1e9, 4096.0 * x, 4095.0 * x + 64.0 * y], 0.0, [0, 1], false),
        (|x, y| [2.0 * x - 2.0 * y, 2.0 * x + y, x + 2.0 * y], 9.0, [0, 1], true),
    ];
    for (turn, square, axes, same) in turns {
        let positions: Vec<_> = places.iter().map(|&[x, y]| turn(x, y)).collect();
        let outline = shape(positions, if square > 0.0 { 0.5 * square } else { f64::INFINITY });
        let outline = outline.outline().cloned().unwrap();
        assert_eq!(outline.axes, axes);
        if square > 0.0 {
            assert_eq!(outline.polygons, if same { &wanted[..] } else { &mirrored[..] });
            assert_eq!(outline.area, 18.0 * square);
            let perimeter = (24.0 + 4.0 * 2f64.sqrt()) * square.sqrt();
            assert!((outline.perimeter - perimeter).abs() < 1e-12);
        } else {
            assert_eq!((outline.polygons.len(), outline.holes()), (1, 0));
            let seen: Vec<Place> = places.iter().map(|&[x, y]| [y, 4096.0 * x]).collect();
            assert_eq!(twice_area(&outline.polygons[0].outer, &seen), 2.0 * 25.0 * 4096.0);
        }
    }
}

/// Coordinates whose differences and products round, underflow or are large: only exact predicates find orientations.
#[test]
fn extreme_coordinates() {
    let places = lattice(6, |x, y| (2..4).contains(&x) && (2..4).contains(&y));
    let wanted = shape(flat(&places), 0.5).outline().cloned().unwrap().polygons;
    for scale in [5e-324, 2f64.powi(-1000), 2f64.powi(-160), 2f64.powi(400)] {
        let scaled: Vec<_> = places.iter().map(|&[x, y]| [scale * x, scale * y]).collect();
        let outline = Outline::of(shape(flat(&places), 0.5).complex(), &flat(&scaled), 0.0);
        assert_eq!(outline.unwrap().polygons, wanted, "{scale}");
    }
    // A sliver of one unit in the last place, far away.
    let far = 2f64.powi(52);
    let sliver = [[far, far], [far + 2.0, far + 2.0], [far + 1.0, far + 2.0]];
    assert_eq!(outline_of(&[[0, 1, 2]], &sliver).polygons[0].outer, [0, 1, 2]);
    // The smallest double coordinates of either sign, including zeros.
    let least = [[-0.0, 1.0], [0.0, 0.0], [0.0, 2.0], [5e-324, 1.0]];
    let outline = outline_of(&[[0, 1, 3], [0, 2, 3]], &least);
    assert_eq!(outline.polygons[0].outer, [0, 1, 3, 2]);
}

#[test]
fn what_is_not_in_a_plane_has_no_outline() {
    let cube: Vec<[f64; 3]> = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect();
    assert_eq!(shape(cube.clone(), 1.0).outline(), Err(OutlineError::Space));
    // This is also true if the shape itself is flat.
    assert_eq!(shape(cube.clone(), -1.0).outline(), Err(OutlineError::Space));
    assert_eq!(Outline::check(&cube), Err(OutlineError::Space));
    assert_eq!(
        shape(flat(&[[0.0; 2], [1.0; 2], [3.0; 2]]), 1.0).outline(),
        Err(OutlineError::Line)
    );
    assert_eq!(shape(flat(&[[1.0; 2]; 2]), 1.0).outline(), Err(OutlineError::Line));
    assert_eq!(Outline::check(&flat(&[[0.0; 2], [1.0; 2], [0.0, 1.0]])), Ok(()));
    let torus = Torus::new([8.0; 3]).unwrap();
    let options = ShapeOptions::new(Alpha::from_squared(0.5).unwrap()).periodic(Some(torus));
    let places = flat(&lattice(8, |_, _| false));
    let torus = alpha_shape(WeightedPoints::unweighted(places), &options).unwrap();
    assert_eq!(torus.outline(), Err(OutlineError::Torus));
    assert_eq!(torus.unwrapped().outline(), Err(OutlineError::Torus));
}

/// The components of triangles that are joined through edges, by flooding: triangles of each.
fn flooded(triangles: &[[u32; 3]]) -> Vec<Vec<[u32; 3]>> {
    let shared = |a: &[u32; 3], b: &[u32; 3]| a.iter().filter(|v| b.contains(v)).count();
    let mut left = triangles.to_vec();
    let mut components = Vec::new();
    while let Some(first) = left.pop() {
        let mut component = vec![first];
        let mut at = 0;
        while let Some(&triangle) = component.get(at) {
            let (joined, others) =
                left.into_iter().partition(|other| shared(&triangle, other) == 2);
            left = others;
            component.extend::<Vec<_>>(joined);
            at += 1;
        }
        components.push(component);
    }
    components
}

/// A random place, which is on an edge only by chance.
fn probe(random: &mut Random) -> Place {
    [0, 1].map(|_| 8.0 * random.unit() - 0.5)
}

/// Compares some of the triangles of a triangulation, which touch, nest and pinch in all ways, with parity, flooding and the
/// Euler characteristic.
#[test]
fn outlines_are_those_of_their_triangles() {
    let mut random = Random::new(11);
    let (mut done, mut holes, mut touching) = (0, 0, 0);
    while done < 400 {
        let mut places = lattice(7, |_, _| false);
        random.shuffle(&mut places);
        places.truncate(3 + random.below(47));
        if Outline::check(&flat(&places)).is_err() {
            continue;
        }
        done += 1;
        let whole = shape(flat(&places), f64::INFINITY);
        let left_out = random.below(10);
        let mut triangles = whole.complex().facets.rows().to_vec();
        triangles.retain(|_| random.below(10) >= left_out);
        let outline = outline_of(&triangles, &places);
        are_simple_and_in_order(&outline);
        bound_their_triangles(&outline, &triangles, &places);
        for _ in 0..200 {
            let probe = probe(&mut random);
            let is_in = |polygon: &&Polygon| {
                is_within(&polygon.outer, &places, probe)
                    && !polygon.holes.iter().any(|hole| is_within(hole, &places, probe))
            };
            let polygons = outline.polygons.iter().filter(is_in).count();
            let is_around = |row: &&[u32; 3]| is_within(&row[..], &places, probe);
            assert_eq!(polygons, triangles.iter().filter(is_around).count(), "{probe:?}");
        }
        holes += outline.holes();
        let vertices: Vec<u32> = rings(&outline).flatten().copied().collect();
        touching += vertices.len() - vertices.iter().collect::<BTreeSet<_>>().len();
    }
    assert!(holes > 100 && touching > 1000, "{holes} holes, {touching} vertices of several rings");
}

#[track_caller]
fn are_simple_and_in_order(outline: &Outline) {
    for ring in rings(outline) {
        let distinct: BTreeSet<_> = ring.iter().collect();
        assert!(ring.len() > 2 && distinct.len() == ring.len(), "{ring:?}");
        assert_eq!(ring.first(), ring.iter().min());
    }
    assert!(outline.polygons.is_sorted());
    assert!(outline.polygons.iter().all(|polygon| polygon.holes.is_sorted()));
}

#[track_caller]
fn bound_their_triangles(outline: &Outline, triangles: &[[u32; 3]], places: &[Place]) {
    // Each edge of the boundary once, with a triangle on its left and none on its right.
    let ends = |ring: &Vec<u32>| -> Vec<[u32; 2]> {
        (0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]).collect()
    };
    let mut walked: Vec<_> = rings(outline).flat_map(ends).collect();
    walked.sort_unstable();
    let turned = triangles
        .iter()
        .map(|&[a, b, c]| if twice_area(&[a, b, c], places) > 0.0 { [a, b, c] } else { [a, c, b] });
    let sides: BTreeSet<_> = turned.flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let lone = sides.iter().filter(|&&[from, to]| !sides.contains(&[to, from]));
    assert_eq!(walked, lone.copied().collect::<Vec<_>>());
    let mut regular: Vec<_> = outline.complex.edges.of(Class::Regular).copied().collect();
    regular.sort_unstable();
    assert_eq!(regular, walked);

    for Polygon { outer, holes } in &outline.polygons {
        assert!(twice_area(outer, places) > 0.0);
        assert!(holes.iter().all(|hole| twice_area(hole, places) < 0.0));
    }
    let area: f64 = rings(outline).map(|ring| twice_area(ring, places) / 2.0).sum();
    assert_eq!(area, outline.area);

    // A polygon for each component, with as many holes as the Euler characteristic says.
    let holes_of = |component: &Vec<_>| 1 - closed(component).euler_characteristic();
    let mut wanted: Vec<i64> = flooded(triangles).iter().map(holes_of).collect();
    let holes = outline.polygons.iter().map(|polygon| polygon.holes.len() as i64);
    let mut holes: Vec<i64> = holes.collect();
    wanted.sort_unstable();
    holes.sort_unstable();
    assert_eq!(holes, wanted);
}
