//! Two engines give the same answer: simplices and classes of all dimensions, Betti numbers and sheets, for any number of blocks.

use std::num::NonZeroUsize;

use proptest::prelude::*;
use walpha::shape::{Engine, ShapeError, ShapeOptions, Whole, direct_betti};
use walpha::{Alpha, AlphaShape, WeightedPoints, alpha_shape};

use crate::common;
use crate::common::Told;
use crate::common::{lattice, weighted};

const BLOCKS: [usize; 5] = [1, 2, 3, 7, 16];

fn by(
    engine: Engine,
    points: &WeightedPoints,
    alpha: f64,
    blocks: Option<usize>,
    exterior: bool,
) -> Result<AlphaShape, ShapeError> {
    let alpha = Alpha::from_squared(alpha).unwrap();
    let blocks = blocks.and_then(NonZeroUsize::new);
    let options =
        ShapeOptions::new(alpha).engine(engine).blocks(blocks).exterior(exterior).refuse_flat(true);
    alpha_shape(points.clone(), &options)
}

/// Compares counts first, which say more when they differ.
fn assert_same(cgal: &AlphaShape, native: &AlphaShape, what: &str) {
    let counts = |shape: &AlphaShape| {
        let c = shape.complex();
        [c.cells.counts(), c.facets.counts(), c.edges.counts(), c.vertices.counts()]
    };
    assert_eq!(counts(cgal), counts(native), "{what}: counts");
    assert_eq!(cgal.complex(), native.complex(), "{what}: complex");
    assert_eq!(cgal.betti(), native.betti(), "{what}: Betti numbers");
    assert_eq!(cgal.sheets(), native.sheets(), "{what}: sheets");
    assert_eq!(cgal.measures(), native.measures(), "{what}: measures");
    assert_eq!(cgal.duplicates(), native.duplicates(), "{what}: duplicates");
    assert_eq!(cgal.hidden(), native.hidden(), "{what}: hidden points");
}

fn check(points: &WeightedPoints, alpha: f64) {
    let native = |blocks| by(Engine::Native, points, alpha, Some(blocks), false);
    let cgal = match by(Engine::Cgal, points, alpha, None, false) {
        Ok(cgal) => cgal,
        Err(error) => {
            // Flat and small sets are refused in the same way.
            for blocks in BLOCKS {
                assert_eq!(native(blocks).unwrap_err(), error);
            }
            return;
        }
    };
    for blocks in BLOCKS {
        assert_same(&cgal, &native(blocks).unwrap(), &format!("{blocks} blocks at α = {alpha}"));
    }
    assert_eq!(cgal.hidden(), None);
    let [cgal, native] =
        [Engine::Cgal, Engine::Native].map(|engine| by(engine, points, alpha, None, true).unwrap());
    assert_same(&cgal, &native, "exterior simplices too");
    assert!(cgal.hidden().is_some());
    assert_eq!(cgal.betti(), Some(direct_betti(cgal.complex())));
    check_parts(&cgal);
    let options = ShapeOptions::new(Alpha::from_squared(alpha).unwrap()).hidden(true);
    for engine in [Engine::Cgal, Engine::Native] {
        let listed = alpha_shape(points.clone(), &options.engine(engine)).unwrap();
        assert_eq!(listed.hidden(), cgal.hidden(), "{engine:?}");
        assert_eq!(listed.complex().cells.counts().exterior, 0);
    }
}

/// Components sum up to the whole; voids by their sheets are those by the cells in them.
fn check_parts(shape: &AlphaShape) {
    let betti = shape.betti().unwrap();
    let components = shape.components();
    assert_eq!(components.len() as u64, betti.b0);
    assert_eq!(components.iter().map(|c| c.vertices).sum::<usize>(), shape.points_in_shape());
    let cells = shape.complex().cells.counts().interior;
    assert_eq!(components.iter().map(|c| c.cells).sum::<usize>(), cells);
    let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-9 * (1.0 + a.abs()), "{a} {b}");
    close(components.iter().map(|c| c.volume).sum(), shape.measures().volume);
    close(components.iter().map(|c| c.area).sum(), shape.measures().area);
    close(components.iter().map(|c| c.regular_area).sum(), shape.measures().regular_area);
    close(components.iter().map(|c| c.singular_area).sum(), shape.measures().singular_area);
    let shut_in: Vec<_> = components.iter().flat_map(|c| c.voids.iter().flatten()).collect();
    assert_eq!(shut_in.len() as u64, betti.b2);
    // Parts that float in a void belong to what the sheet encloses, not to the cells outside the shape.
    if components.len() == 1 {
        let voids = shape.voids().unwrap();
        assert_eq!(voids.len(), shut_in.len());
        for (void, sheet) in voids.iter().zip(shut_in) {
            close(void.volume, sheet.volume);
        }
    }
}

/// Points anywhere, of uneven density.
fn scattered() -> impl Strategy<Value = WeightedPoints> {
    let point = ([0.0..3.0f64, 0.0..3.0, 0.0..9.0], -0.5..1.0f64);
    prop::collection::vec(point, 4..120).prop_map(weighted)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 250, ..ProptestConfig::default() })]

    #[test]
    fn lattices(points in lattice(12, 4..90), alpha in -4..24i32) {
        check(&points, f64::from(alpha) / 4.0);
    }

    #[test]
    fn scattered_points(points in scattered(), alpha in -0.5..2.0f64) {
        check(&points, alpha);
    }
}

/// Most blocks of a line span no volume, on any lattice.
#[test]
fn lines_have_collinear_blocks() {
    for step in [1.0, 0.1, 1024.0, 1e-9] {
        let line = (0..60).map(|i| [step * f64::from(i), 0.0, step]);
        let beside = [[5.0 * step, step, 0.0], [7.0 * step, 0.0, 2.0 * step]];
        let weight = |p: [f64; 3]| (p, if p[0] > 20.0 * step { step * step / 4.0 } else { 0.0 });
        let points = weighted(line.chain(beside).map(weight));
        for alpha in [-0.1, 0.0, 0.25, 1.0, 20.0, 1e4] {
            check(&points, alpha * step * step);
        }
    }
}

#[test]
fn planes_far_apart_have_coplanar_blocks() {
    let plane = |z: i32| (0..16).map(move |i| [i % 4, i / 4, z]);
    let points = weighted((0..6).flat_map(|z| plane(40 * z)).map(|p| (p.map(f64::from), 0.0)));
    for alpha in [0.1, 0.25, 0.5, 1.0, 400.0, 401.0] {
        check(&points, alpha);
    }
}

#[test]
fn infinite_and_very_negative_alpha() {
    let cube = |i: i32| ([i & 1, i >> 1 & 1, i >> 2].map(f64::from), f64::from(i % 3));
    let points = weighted((0..16).map(cube));
    for alpha in [f64::INFINITY, f64::NEG_INFINITY, -3.0, -1e300] {
        check(&points, alpha);
    }
}

#[test]
fn hollow_balls_inside_hollow_balls() {
    // Shells of voxels around one centre: voids in voids.
    let inside = |p: [i32; 3]| {
        let r2: i32 = p.iter().map(|v| (v - 9) * (v - 9)).sum();
        (9..=16).contains(&r2) || (49..=64).contains(&r2)
    };
    let all = (0..19 * 19 * 19).map(|i| [i % 19, i / 19 % 19, i / 361]);
    let points = weighted(all.filter(|&p| inside(p)).map(|p| (p.map(f64::from), 0.0)));
    let shape = by(Engine::Native, &points, 1.0, Some(4), false).unwrap();
    let betti = shape.betti().unwrap();
    assert_eq!((betti.b0, betti.b1, betti.b2), (2, 0, 2));
    let [outer, inner] = &shape.components()[..] else { panic!("two shells") };
    let voids = |c: &walpha::shape::Component| c.voids.clone().unwrap();
    assert_eq!((voids(outer).len(), voids(inner).len()), (1, 1));
    assert_eq!((outer.low, outer.high), ([1.0; 3], [17.0; 3]));
    assert_eq!((inner.low, inner.high), ([5.0; 3], [13.0; 3]));
    // The inner shell and its own void lie in the outer one's.
    assert!(voids(outer)[0].volume > inner.volume + voids(inner)[0].volume);
    check(&points, 1.0);
}

#[test]
fn the_skull() {
    if !common::has_skull() {
        return;
    }
    use walpha::points::{Selection, Units, Weighting, difference, select, weigh};
    let volume = walpha::volume::sample("sample:skull").unwrap();
    let (volume, _) = volume.into_gray(walpha::Gray::Automatic).unwrap();
    let differences = difference(&volume);
    let points =
        select(&volume, &volume, &differences, &Selection::default(), Units::Voxel).unwrap();
    for weighting in [Weighting::Common(0.0), Weighting::MinMax, Weighting::BarycentricN] {
        check(&weigh(points.clone(), weighting, Alpha::from_squared(10.0).unwrap()).unwrap(), 10.0);
    }
}

#[test]
fn exterior_simplices_take_one_block() {
    let points = weighted((0..64).map(|i| ([i % 4, i / 4 % 4, i / 16].map(f64::from), 0.0)));
    let with = |blocks| by(Engine::Native, &points, 0.75, Some(blocks), true);
    let whole = by(Engine::Native, &points, 0.75, None, true).unwrap();
    assert_same(&whole, &with(1).unwrap(), "one block");
    assert_eq!(with(2).unwrap_err(), ShapeError::Divided { by: Whole::Exterior, blocks: 2 });
}

#[test]
fn memory_is_planned_for() {
    let points =
        weighted((0..40_000).map(|i| ([i % 20, i / 20 % 20, i / 400].map(f64::from), 0.0)));
    let with = |memory: u64| {
        let options = ShapeOptions::new(Alpha::from_squared(1.0).unwrap()).memory(memory);
        alpha_shape(points.clone(), &options)
    };
    let free = by(Engine::Native, &points, 1.0, None, false).unwrap();
    let bounded = with(4 << 30).unwrap();
    assert_eq!(free.complex(), bounded.complex());
    let error = with(1 << 20).unwrap_err().told();
    assert!(error.contains("1 MiB of memory is not enough"), "{error}");
}
