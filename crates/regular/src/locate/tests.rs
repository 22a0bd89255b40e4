use walpha_base::random::Random;

use super::*;
use crate::triangulate;
use crate::triangulation::tests::all;

/// Integer coordinates.
pub(crate) type Place = [i64; 3];

pub(crate) fn doubles(points: &[Place]) -> Vec<[f64; 3]> {
    points.iter().map(|p| p.map(|x| x as f64)).collect()
}

/// The sign of the determinant of b − a, c − a, d − a, in integers.
pub(crate) fn sign([a, b, c, d]: [Place; 4]) -> i128 {
    let from = |p: Place| [0, 1, 2].map(|k| i128::from(p[k] - a[k]));
    let [u, v, w] = [from(b), from(c), from(d)];
    let minor = |i: usize, j: usize| v[i] * w[j] - v[j] * w[i];
    (u[0] * minor(1, 2) + u[1] * minor(2, 0) + u[2] * minor(0, 1)).signum()
}

/// The vertices of the face in whose interior a point is, for each finite cell that contains it.
fn faces(made: &Triangulation, points: &[Place], point: Place) -> Vec<(u32, Vec<u32>)> {
    let face = |(cell, corners): (u32, [u32; 4])| {
        let signs = [0, 1, 2, 3].map(|k| {
            let mut places = corners.map(|v| points[v as usize]);
            places[k] = point;
            sign(places)
        });
        let mut face: Vec<u32> = (0..4).filter(|&k| signs[k] > 0).map(|k| corners[k]).collect();
        face.sort_unstable();
        signs.iter().all(|&sign| sign >= 0).then_some((cell, face))
    };
    made.finite_cells().filter_map(face).collect()
}

/// Compares the found location of a point with all cells. Returns the number of vertices of its face, 0 outside.
fn check(made: &Triangulation, points: &[Place], point: Place, location: Location) -> usize {
    let faces = faces(made, points, point);
    let face = match location {
        Location::InCell { cell } => made.cells()[cell as usize].to_vec(),
        Location::OnFacet { facet, .. } => facet.to_vec(),
        Location::OnEdge { edge, .. } => edge.to_vec(),
        Location::OnVertex { vertex, .. } => vec![vertex],
        Location::Outside { cell } => {
            assert!(faces.is_empty(), "{point:?} is in {faces:?}");
            let mut corners = made.cells()[cell as usize];
            let beyond = corners
                .iter()
                .position(|&v| v == made.infinite_vertex())
                .expect("an infinite cell");
            corners[beyond] = corners[(beyond + 1) % 4];
            let mut places = corners.map(|v| points[v as usize]);
            places[beyond] = point;
            assert_eq!(sign(places), 1, "{point:?} is not beyond {corners:?}");
            return 0;
        }
    };
    let mut sorted = face.clone();
    sorted.sort_unstable();
    assert!(faces.contains(&(location.cell(), sorted)), "{point:?}: {location:?}, not {faces:?}");
    assert!(matches!(location, Location::InCell { .. }) || face.is_sorted());
    face.len()
}

/// Vertices, middles of edges, facets and cells (coordinates of points are multiples of 12), and any points around.
fn tried(made: &Triangulation, points: &[Place], random: &mut Random) -> Vec<Place> {
    let middle = |face: &[u32]| {
        let sum = |k: usize| face.iter().map(|&v| points[v as usize][k]).sum::<i64>();
        [0, 1, 2].map(|k| sum(k) / face.len() as i64)
    };
    let finite: Vec<[u32; 4]> = made.finite_cells().map(|(_, corners)| corners).collect();
    let mut tried = points.to_vec();
    for _ in 0..20 {
        let cell = finite[random.below(finite.len())];
        tried.extend([2, 3, 4].map(|n| middle(&cell[..n])));
        let [_, _, most] = points[random.below(points.len())];
        tried.push([0; 3].map(|_| random.whole(-12, most + 24) as i64));
    }
    tried
}

#[test]
fn points_are_where_all_cells_say() {
    let mut random = Random::new(6);
    let mut found = [0; 5];
    for (points, made) in all() {
        let mut from = 0;
        for point in tried(&made, &points, &mut random) {
            let place = point.map(|x| x as f64);
            let location = made.locate(place).unwrap();
            found[check(&made, &points, point, location)] += 1;
            let walked = made.locate_from(place, from).unwrap();
            check(&made, &points, point, walked);
            from = walked.cell();
        }
    }
    assert!(found.iter().all(|&count| count > 2000), "{found:?}");
}

#[test]
fn doubles_next_to_a_facet_are_beside_it() {
    // The plane x + y + z = 0.6 through doubles, whose sum is never 0.6.
    let points = [[0.6, 0.0, 0.0], [0.0, 0.6, 0.0], [0.0, 0.0, 0.6], [0.0; 3], [1.0; 3]];
    let made = triangulate(&points, None).unwrap();
    let (mut below, mut above) = (0, 0);
    for i in 0..1000 {
        let (x, y) = (f64::from(i % 30) * 0.007, f64::from(i / 30) * 0.006);
        let z = 0.6 - x - y;
        for point in [[x, y, z.next_down()], [x, y, z], [x, y, z.next_up()]] {
            let units = point.map(|x| (x * 2f64.powi(60)) as i128);
            let plane = (0.6 * 2f64.powi(60)) as i128;
            let corners = made.cells()[made.locate(point).unwrap().cell() as usize];
            if units.iter().all(|&x| x > 0) {
                match units.iter().sum::<i128>().cmp(&plane) {
                    Ordering::Less => below += usize::from(corners.contains(&3)),
                    Ordering::Greater => above += usize::from(corners.contains(&4)),
                    Ordering::Equal => continue,
                }
                assert_eq!(corners.contains(&3), units.iter().sum::<i128>() < plane, "{point:?}");
            }
        }
    }
    assert!(below > 500 && above > 500, "{below} {above}");
}

#[test]
fn what_cannot_be_found() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let made = triangulate(&points, None).unwrap();
    for x in [f64::NAN, f64::INFINITY, -1e200] {
        assert_eq!(made.locate([0.0, x, 0.0]), None);
    }
    assert_eq!(made.locate_from([0.1; 3], 5), None);
    let far = made.locate([MAX_COORDINATE, 0.1, -MAX_COORDINATE]);
    assert!(matches!(far, Some(Location::Outside { .. })));
    // A walk also starts from a cell beyond the hull.
    let beyond = far.unwrap().cell();
    assert!(matches!(made.locate_from([0.1; 3], beyond), Some(Location::InCell { .. })));
}

/// If most points are hidden, none of the possible starts of a walk need be a vertex.
#[test]
fn walks_start_among_hidden_points() {
    let mut points: Vec<Place> = (1..600).map(|i| [i % 7 + 1, i % 5 + 1, i % 3 + 1]).collect();
    points.extend([[0, 0, 0], [12, 0, 0], [0, 12, 0], [0, 0, 12], [12, 12, 12]]);
    let heavy = |p: &Place| if p.contains(&0) || *p == [12; 3] { 1e6 } else { 0.0 };
    let weights: Vec<f64> = points.iter().map(heavy).collect();
    let made = triangulate(&doubles(&points), Some(&weights)).unwrap();
    assert_eq!(made.vertices().count(), 5);
    for point in [[1, 1, 1], [6, 6, 0], [6, 0, 0], [12, 12, 12], [20, 0, 0]] {
        let location = made.locate(point.map(|x| x as f64)).unwrap();
        check(&made, &points, point, location);
    }
}
