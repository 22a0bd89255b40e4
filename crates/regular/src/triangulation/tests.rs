use walpha_base::random::Random;

use super::*;
use crate::locate::tests::{Place, doubles, sign};
use crate::{Cancelled, SitesError};

/// Integer points of a small box, many of them at one position, some of them heavy.
pub(crate) fn set(random: &mut Random, case: usize) -> (Vec<Place>, Vec<f64>) {
    let (count, side) = (4 + random.below(60), [2, 4, 40][case % 3]);
    let place = |random: &mut Random| [0; 3].map(|_| 12 * random.below(side) as i64);
    let points = (0..count).map(|_| place(random)).collect();
    let heaviest = if case.is_multiple_of(2) { 0 } else { 400 };
    (points, (0..count).map(|_| random.whole(0, heaviest)).collect())
}

/// Many triangulations with the points that they are of.
pub(crate) fn all() -> impl Iterator<Item = (Vec<Place>, Triangulation)> {
    let mut random = Random::new(5);
    let made = (0..600).filter_map(move |case| {
        let (points, weights) = set(&mut random, case);
        match triangulate(&doubles(&points), Some(&weights)) {
            Ok(made) => Some((points, made)),
            Err(TriangulationError::Sites(SitesError::Flat { .. } | SitesError::TooFew { .. })) => {
                None
            }
            Err(other) => panic!("{other}"),
        }
    });
    let made: Vec<_> = made.collect();
    assert!(made.len() > 450, "{} of 600", made.len());
    made.into_iter()
}

#[test]
fn each_point_is_a_vertex_hidden_or_a_duplicate() {
    let (mut hidden, mut duplicates) = (0, 0);
    for (points, made) in all() {
        let mut found: Vec<u32> = made.vertices().chain(made.hidden().iter().copied()).collect();
        found.extend(made.duplicates().iter().map(|&[removed, _]| removed));
        found.sort_unstable();
        assert!(found.into_iter().eq(0..points.len() as u32));
        for &[removed, kept] in made.duplicates() {
            assert_eq!(points[removed as usize], points[kept as usize]);
            assert!(
                !made.is_vertex(removed) && !made.duplicates().iter().any(|pair| pair[0] == kept)
            );
        }
        let corners: HashSet<u32> = made.finite_cells().flat_map(|(_, corners)| corners).collect();
        assert!(made.vertices().all(|v| corners.contains(&v)));
        assert_eq!(made.vertices().count(), corners.len());
        assert!(!made.is_vertex(made.infinite_vertex()) && !made.is_vertex(u32::MAX));
        hidden += made.hidden().len();
        duplicates += made.duplicates().len();
    }
    assert!(hidden > 100 && duplicates > 1000, "{hidden} {duplicates}");
}

#[test]
fn neighbours_share_facets() {
    for (_, made) in all() {
        for (cell, corners) in (0..).zip(made.cells()) {
            let neighbors = made.neighbors(cell).unwrap();
            for corner in 0..4 {
                let next = made.cells()[neighbors[corner] as usize];
                assert_eq!(corners.iter().filter(|v| !next.contains(v)).count(), 1);
                assert!(!next.contains(&corners[corner]));
                let back = made.adjacency()[cell as usize][corner];
                assert_eq!(
                    made.adjacency()[back as usize / 4][back as usize % 4],
                    4 * cell + corner as u32
                );
            }
            assert_eq!(made.is_finite(cell), !corners.contains(&made.infinite_vertex()));
        }
        assert_eq!(made.neighbors(made.cells().len() as u32), None);
        assert!(!made.is_finite(u32::MAX));
    }
}

#[test]
fn a_star_is_the_cells_at_a_vertex() {
    for (_, made) in all() {
        for v in 0..=made.infinite_vertex() + 1 {
            let mut star = made.star(v);
            star.sort_unstable();
            let at_v = (0..).zip(made.cells()).filter(|(_, corners)| corners.contains(&v));
            assert!(star.into_iter().eq(at_v.map(|(cell, _)| cell)), "of {v}");
        }
    }
}

/// All points are on the inner side, and the facets are a closed surface.
#[test]
fn the_hull_is_seen_from_outside() {
    for (points, made) in all() {
        let mut directed = HashSet::new();
        for [a, b, c] in made.hull_facets() {
            let place = |v: u32| points[v as usize];
            assert!(points.iter().all(|&p| sign([place(a), place(b), place(c), p]) <= 0));
            assert!([[a, b], [b, c], [c, a]].into_iter().all(|edge| directed.insert(edge)));
        }
        assert!(directed.iter().all(|&[a, b]| directed.contains(&[b, a])));
        let (facets, edges) = (directed.len() / 3, directed.len() / 2);
        let vertices: HashSet<u32> = directed.iter().map(|edge| edge[0]).collect();
        assert_eq!(vertices.len() + facets, edges + 2);
    }
}

#[test]
fn the_order_of_points_only_changes_their_numbers() {
    let mut random = Random::new(8);
    for case in 0..200 {
        let (points, weights) = set(&mut random, case);
        let Ok(made) = triangulate(&doubles(&points), Some(&weights)) else { continue };
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        random.shuffle(&mut order);
        let shuffled: Vec<Place> = order.iter().map(|&v| points[v as usize]).collect();
        let heights: Vec<f64> = order.iter().map(|&v| weights[v as usize]).collect();
        let other = triangulate(&doubles(&shuffled), Some(&heights)).unwrap();
        let cells = |made: &Triangulation, points: &[Place]| {
            let mut cells: Vec<[Place; 4]> = (made.finite_cells())
                .map(|(_, corners)| {
                    let mut corners = corners.map(|v| points[v as usize]);
                    corners.sort_unstable();
                    corners
                })
                .collect();
            cells.sort_unstable();
            cells
        };
        assert_eq!(cells(&made, &points), cells(&other, &shuffled));
    }
}

#[test]
fn without_weights_all_are_equal() {
    let mut random = Random::new(9);
    for case in 0..100 {
        let points = doubles(&set(&mut random, case).0);
        let pair =
            [None, Some(&vec![7.5; points.len()][..])].map(|weights| triangulate(&points, weights));
        match pair {
            [Ok(a), Ok(b)] => assert_eq!((a.cells(), a.hidden()), (b.cells(), &[][..])),
            [a, b] => assert_eq!(a.unwrap_err(), b.unwrap_err()),
        }
    }
}

#[test]
fn what_spans_no_volume_is_refused() {
    let error = |points: &[[f64; 3]], weights: Option<&[f64]>| match triangulate(points, weights) {
        Err(TriangulationError::Sites(error)) => error,
        other => panic!("{other:?}"),
    };
    let line = [[0.0; 3], [1.0; 3], [2.0; 3], [3.0; 3]];
    for few in 0..4 {
        assert_eq!(error(&line[..few], None), SitesError::TooFew { distinct: few });
    }
    assert_eq!(error(&[[1.0; 3]; 9], None), SitesError::TooFew { distinct: 1 });
    assert_eq!(
        error(&line, None).to_string(),
        "all 4 points lie on one line: a 3D triangulation needs points that span a volume"
    );
    let square = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    assert!(matches!(error(&square, None), SitesError::Flat { points: 4, on: "in one plane" }));
    assert_eq!(error(&square, Some(&[0.0; 3])), SitesError::Lengths { positions: 4, weights: 3 });
    let nan = [[0.0; 3], [1.0, f64::NAN, 0.0]];
    assert!(matches!(error(&nan, None), SitesError::Value { index: 1, what: "y", .. }));
    assert!(matches!(
        error(&line, Some(&[0.0, 0.0, 0.0, f64::INFINITY])),
        SitesError::Value { what: "weight", .. }
    ));
}

#[test]
fn work_is_reported_and_cancelled() {
    let mut random = Random::new(2);
    let points: Vec<[f64; 3]> = (0..20_000).map(|_| [0; 3].map(|_| random.unit())).collect();
    let (reports, of) = std::sync::mpsc::channel();
    let monitor = Monitor::new(move |done, total| reports.send((done, total)).unwrap());
    monitor.watch(|| triangulate(&points, None)).unwrap();
    drop(monitor);
    let reports: Vec<_> = of.iter().collect();
    assert!(reports.len() > 3 && reports.is_sorted());
    assert!(reports.last().is_some_and(|(done, total)| done == total));
    let monitor = Monitor::new(|_, _| ());
    monitor.cancel();
    let cancelled = monitor.watch(|| triangulate(&points, None));
    assert_eq!(cancelled.unwrap_err(), TriangulationError::Cancelled(Cancelled));
}
