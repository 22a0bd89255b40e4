//! `Regular_triangulation_3` and `Regular_triangulation_2`.

use std::collections::HashMap;

use walpha::cgal::{
    self, INFINITE_CELL, farthest_point_triangulation_2, regular_triangulation_2,
    regular_triangulation_3,
};
use walpha::triangulation::{Triangulation, TriangulationError, triangulate};
use walpha_base::random::Random;

use super::on_all_sets;
use crate::triangulation::cells;

/// Across the facet opposite each corner, the place of the neighbour among the cells in order.
fn neighbours(made: &Triangulation, cells: &[[u32; 4]]) -> Vec<[u32; 4]> {
    let sorted = |mut cell: [u32; 4]| {
        cell.sort_unstable();
        cell
    };
    let place: HashMap<_, _> = cells.iter().map(|&cell| sorted(cell)).zip(0_u32..).collect();
    let number: HashMap<_, _> =
        made.finite_cells().map(|(number, cell)| (sorted(cell), number)).collect();
    let across = |&cell: &[u32; 4]| {
        let number = number[&sorted(cell)];
        let (corners, beyond) = (made.cells()[number as usize], made.neighbors(number).unwrap());
        cell.map(|corner| {
            let at = corners.iter().position(|&v| v == corner).unwrap();
            place.get(&sorted(made.cells()[beyond[at] as usize])).copied().unwrap_or(INFINITE_CELL)
        })
    };
    cells.iter().map(across).collect()
}

#[test]
fn cells_neighbours_and_hidden_points_are_ours() {
    let with_hidden = std::sync::atomic::AtomicUsize::new(0);
    let compared = on_all_sets(4000, |points| {
        let ours = triangulate(points.positions(), Some(points.weights()));
        let theirs = regular_triangulation_3(points.positions(), Some(points.weights()));
        let (ours, theirs) = match (ours, theirs) {
            (Ok(ours), Ok(theirs)) => (ours, theirs),
            (ours, theirs) => {
                let ours = ours.err().map(|error| match error {
                    TriangulationError::Sites(error) => cgal::Error::Sites(error),
                    other => panic!("{other}"),
                });
                assert_eq!(ours, theirs.err());
                return false;
            }
        };
        assert_eq!(cells(&ours), theirs.cells);
        assert_eq!(neighbours(&ours, &theirs.cells), theirs.neighbours);
        assert_eq!(ours.hidden(), theirs.hidden);
        assert_eq!(ours.duplicates(), theirs.duplicates);
        let some = usize::from(!theirs.hidden.is_empty());
        with_hidden.fetch_add(some, std::sync::atomic::Ordering::Relaxed);
        true
    });
    assert!(compared > 2000, "{compared}");
    let with_hidden = with_hidden.into_inner();
    assert!(with_hidden > 200, "{with_hidden}");
}

/// Twice the area.
fn turn([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Negative where d is inside the circle through a, b, c for which these turn counter-clockwise, and the weights are 0. Exact for
/// small integers.
fn power(triangle: [[f64; 3]; 3], d: [f64; 3]) -> f64 {
    let [a, b, c] = triangle.map(|p| {
        let (x, y) = (p[0] - d[0], p[1] - d[1]);
        [x, y, x * x + y * y + d[2] - p[2]]
    });
    let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
    -(a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1))
}

#[test]
fn triangulations_of_the_plane_are_regular() {
    let mut hidden = 0;
    for seed in 0..500 {
        let mut random = Random::new(seed);
        let count = 3 + random.below(20);
        let points: Vec<[f64; 2]> =
            (0..count).map(|_| [0; 2].map(|_| random.whole(0, 6))).collect();
        let weights: Vec<f64> = (0..count).map(|_| random.whole(0, 3)).collect();
        let plane = regular_triangulation_2(&points, Some(&weights)).unwrap();
        let corners = |row: &[u32; 3]| row.map(|v| points[v as usize]);
        let lifted = |v: u32| [points[v as usize][0], points[v as usize][1], weights[v as usize]];
        for triangle in &plane.triangles {
            assert!(turn(corners(triangle)) > 0.0, "{triangle:?}");
            for other in 0..count as u32 {
                assert!(power(triangle.map(lifted), lifted(other)) >= 0.0, "{triangle:?} {other}");
            }
        }
        let places: std::collections::BTreeSet<_> =
            points.iter().map(|p| p.map(|x| x as i64)).collect();
        hidden += places.len() - plane.vertices.len();
        // Euler's formula for a disc, or for a path.
        let [v, e, t] = [plane.vertices.len(), plane.edges.len(), plane.triangles.len()];
        assert_eq!(v + t, e + 1, "{plane:?}");

        // Every point is in each disc, and the whole convex hull is covered, as by the other triangulation.
        let farthest = farthest_point_triangulation_2(&points).unwrap();
        let area = |triangles: &[[u32; 3]]| triangles.iter().map(|t| turn(corners(t))).sum::<f64>();
        assert_eq!(area(&farthest.triangles), area(&plane.triangles));
        for triangle in &farthest.triangles {
            let flat = |v: u32| [points[v as usize][0], points[v as usize][1], 0.0];
            for other in 0..count as u32 {
                assert!(power(triangle.map(flat), flat(other)) <= 0.0, "{triangle:?} {other}");
            }
        }
    }
    assert!(hidden > 200, "{hidden}");
}
