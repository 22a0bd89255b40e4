//! Complexes of a periodic box, by hand.

use walpha_check::schema::{BoxVectors, ComplexFile, PlacedComplex, SchemaError};
use walpha_check::{Alpha, Certificate, CertifyError, Class, Finding, NotJudged, Verdict};

use crate::common::{Case, closed, definition, grid};

/// The findings for an edge from the origin along x.
fn findings(end: f64, side: f64) -> Result<Vec<Finding>, CertifyError> {
    let alpha = Alpha::from_squared(16.0).unwrap();
    let mut file = ComplexFile::of_points(vec![[0.0; 3], [end, 0.0, 0.0]], alpha);
    file.edges = Some(vec![[0, 1]]);
    file.vertices = Some(vec![0, 1]);
    file.periodic = Some(BoxVectors::of_sides([side; 3]));
    Ok(PlacedComplex::try_from(file).unwrap().findings()?.0)
}

#[test]
fn edges_span_less_than_half_of_the_box() {
    let long = |end| {
        let found = findings(end, 8.0).unwrap();
        found.iter().any(|found| matches!(found, Finding::LongEdge { .. }))
    };
    assert_eq!([3.75, 4.0, 4.25].map(long), [false, true, false]);
}

/// Beyond 2⁵³ doubles are even, and copies are up to four sides away.
#[test]
fn copies_of_points_are_exact() {
    let side = 2f64.powi(51);
    let refused = |end| matches!(findings(end, side), Err(CertifyError::NotInBox(1)));
    assert_eq!([2.0, 1.0, -2.0, side].map(refused), [false, true, true, true]);
}

#[test]
fn sides_are_positive_numbers() {
    for side in [-0.5, -8.0, f64::NAN, f64::INFINITY] {
        let mut file = ComplexFile::of_points(vec![[0.0; 3]], Alpha::ZERO);
        file.vertices = Some(vec![0]);
        file.periodic = Some(BoxVectors::of_sides([8.0, side, 8.0]));
        let refused = PlacedComplex::try_from(file).unwrap_err();
        assert!(
            matches!(refused, SchemaError::Value { name: "periodic", .. }),
            "{side}: {refused}"
        );
    }
}

/// Points along each axis of a torus of unit cubes.
const N: usize = 3;

/// The cells of a unit cube that the rule makes, or those of its mirror image; the bits of a corner are x, y, z.
fn cube(mirrored: bool) -> Vec<[u32; 4]> {
    let case = Case { positions: grid(2), weights: vec![0.0; 8], alpha: f64::INFINITY };
    let cells = definition(&case).unwrap().complex.cells;
    let corner = |v: u32| if mirrored { v ^ 1 } else { v };
    cells.rows().iter().map(|cell| cell.map(corner)).collect()
}

/// A corner of a cube of the torus: both are numbers of points.
fn corner(cube: u32, corner: u32) -> u32 {
    let n = N as u32;
    let at = [cube % n, cube / n % n, cube / n / n];
    let [x, y, z] = [0, 1, 2].map(|k| (at[k] + (corner >> k & 1)) % n);
    (z * n + y) * n + x
}

/// The cells of the torus, each cube mirrored or not.
fn cells(mirrored: impl Fn(u32) -> bool) -> Vec<[u32; 4]> {
    let cubes = 0..(N * N * N) as u32;
    let of_cube =
        |at: u32| cube(mirrored(at)).into_iter().map(move |cell| cell.map(|v| corner(at, v)));
    cubes.flat_map(of_cube).collect()
}

/// A file with the cells of the torus, which is whole or a shape alone.
fn file(cells: Vec<[u32; 4]>, alpha: f64, class: Class) -> ComplexFile {
    let mut file = ComplexFile::of_points(grid(N), Alpha::from_squared(alpha).unwrap());
    file.periodic = Some(BoxVectors::of_sides([N as f64; 3]));
    file.classes.cells = Some(vec![class; cells.len()]);
    file.cells = Some(cells);
    file
}

fn judged(file: ComplexFile) -> (Vec<Finding>, Certificate) {
    PlacedComplex::try_from(file).unwrap().findings().unwrap()
}

fn verdict(file: ComplexFile) -> Verdict {
    judged(file).1.verdict
}

/// One cube is cut as its mirror image, and all others by the rule: each is right by itself.
#[test]
fn cubes_of_a_torus_fit_together() {
    for alpha in [0.75, f64::INFINITY] {
        let cut =
            |mirrored: &dyn Fn(u32) -> bool| verdict(file(cells(mirrored), alpha, Class::Interior));
        assert_eq!(cut(&|_| false), Verdict::Exact, "{alpha}");
        assert_eq!(cut(&|_| true), Verdict::Valid, "{alpha}");
        assert_eq!(cut(&|at| at == 13), Verdict::Wrong, "{alpha}");
    }
}

/// Squares in the shape by themselves, and a cube that is filled, across the sides of the box: of one square either diagonal will do, both
/// or a half will not.
#[test]
fn a_square_of_a_torus_is_cut_once() {
    let squares = closed(&cells(|_| false)).facets;
    let squares: Vec<[u32; 3]> = (squares.rows().iter().copied())
        .filter(|row| {
            let across = row.map(|v| grid(N)[v as usize]);
            (0..3).any(|k| across.iter().all(|p| p[k] == across[0][k]))
        })
        .collect();
    assert_eq!(squares.len(), 2 * 3 * N * N * N);
    let filled: Vec<u32> = (0..8).map(|v| corner(26, v)).collect();
    let top = (N * N * N) as u32;
    let inside = squares.iter().filter(|row| row.iter().all(|v| filled.contains(v)));
    let cone: Vec<[u32; 4]> = inside.map(|&[a, b, c]| [a, b, c, top]).collect();
    assert_eq!(cone.len(), 12);
    // Seen from the point 1, 1, 1.
    let square = [0, 1, 2, 3].map(|v| corner(13, v));
    let [a, b, c, d] = square;
    let halves = [[a, b, c], [b, c, d], [a, b, d], [a, c, d]].map(|mut row| {
        row.sort_unstable();
        row
    });
    let (own, other): (Vec<[u32; 3]>, Vec<_>) =
        halves.into_iter().partition(|row| squares.contains(row));
    assert_eq!([own.len(), other.len()], [2, 2]);
    let with = |halves: &[[u32; 3]]| {
        let mut file = file(cone.clone(), 0.6, Class::Interior);
        file.points.push([2.5; 3]);
        let mut facets = closed(&cone).facets.rows().to_vec();
        facets.extend(squares.iter().filter(|row| !own.contains(row)));
        facets.extend(halves);
        facets.sort_unstable();
        facets.dedup();
        file.facets = Some(facets);
        verdict(file)
    };
    assert_eq!(with(&own), Verdict::Exact);
    assert_eq!(with(&other), Verdict::Valid);
    assert_eq!(with(&halves), Verdict::Wrong);
    assert_eq!(with(&own[..1]), Verdict::Wrong);
}

/// Nothing here is in the shape.
fn exterior(cells: Vec<[u32; 4]>) -> ComplexFile {
    file(cells, -1.0, Class::Exterior)
}

#[test]
fn exterior_simplices_of_a_torus_are_judged() {
    let right = cells(|_| false);
    let (found, certificate) = judged(exterior(right.clone()));
    assert_eq!((found, certificate.not_judged), (vec![], vec![NotJudged::Duplicates]));
    // Another choice at each tie.
    assert_eq!(verdict(exterior(cells(|_| true))), Verdict::Valid);
    // An edge that is a face of nothing.
    let complex = closed(&right);
    let [a, b] = [corner(0, 1), corner(0, 2)];
    let stray = if complex.edges.rows().contains(&[a, b]) { [0, corner(0, 3)] } else { [a, b] };
    let mut edges = complex.edges.rows().to_vec();
    assert!(!edges.contains(&stray));
    edges.push(stray);
    let mut more = exterior(right.clone());
    more.classes.edges = Some(vec![Class::Exterior; edges.len()]);
    more.edges = Some(edges);
    assert_eq!(judged(more).0, [Finding::Stray { simplex: stray.into() }]);
    // Another cell of the same volume, apart from the one that is missing.
    let elsewhere = cube(true).into_iter().map(|cell| cell.map(|v| corner(13, v)));
    let mut swaps = 0;
    for cell in elsewhere {
        let new = closed(&[cell]).facets;
        if new.rows().iter().all(|facet| !complex.facets.rows().contains(facet)) {
            let mut swapped = right.clone();
            swapped[0] = cell;
            assert_eq!(verdict(exterior(swapped)), Verdict::Wrong);
            swaps += 1;
        }
    }
    assert!(swaps > 0);
}

#[test]
fn hidden_points_of_a_torus_are_judged() {
    // A point in the middle of a cube, above the lower hull, on it and below it.
    let weights = [(-1.0, Verdict::Exact), (-0.75, Verdict::Valid), (-0.5, Verdict::Wrong)];
    for (weight, expected) in weights {
        for at in [[0.5; 3], [2.5; 3]] {
            let mut file = exterior(cells(|_| false));
            file.points.push(at);
            file.weights = Some([&[0.0; N * N * N][..], &[weight]].concat());
            let (found, certificate) = judged(file);
            assert_eq!(certificate.verdict, expected, "{found:?}");
            let is_named = |f: &Finding| matches!(f, Finding::NotHidden { point: 27, .. });
            assert!(found.iter().all(is_named), "{found:?}");
        }
    }
}

/// Points so heavy that doubles have no room for the box in addition to the weights.
#[test]
fn heavy_points_of_a_torus_are_judged() {
    let heavy = |class: Class| {
        let mut file = file(cells(|_| false), 0.0, class);
        file.weights = Some(vec![1e20; N * N * N]);
        file
    };
    assert_eq!(judged(heavy(Class::Interior)).0, []);
    let mut less = heavy(Class::Exterior);
    less.vertices = Some((0..(N * N * N) as u32).collect());
    less.classes.vertices = Some(vec![Class::Singular; N * N * N]);
    assert_eq!(verdict(less), Verdict::Wrong);
}

/// A flat cell whose sphere reaches around the box, and has its centre outside of all copies near it.
#[test]
fn large_spheres_of_a_torus_are_not_empty() {
    for (alpha, weight) in [(1e4, 0.0), (f64::MAX, 0.0), (0.0, 1e20)] {
        let mut file = ComplexFile::of_points(grid(N), Alpha::from_squared(alpha).unwrap());
        file.points[4] = [1.125, 1.0, 0.0078125];
        file.weights = Some(vec![weight; N * N * N]);
        file.periodic = Some(BoxVectors::of_sides([N as f64; 3]));
        file.cells = Some(vec![[0, 1, 3, 4]]);
        let found = judged(file).0;
        assert!(
            found.iter().any(|f| matches!(f, Finding::NotRegular { .. }) && !f.is_tie()),
            "{found:?}"
        );
    }
}
