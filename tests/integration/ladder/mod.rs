//! The ladder against shapes made one by one: every simplex, every class, at every level.

mod command;
mod detail;
mod suggestions;

use proptest::prelude::*;
use walpha::ladder::{Filtration, Level};
use walpha::shape::{Engine, ShapeOptions};
use walpha::{Alpha, AlphaShape, Class, WeightedPoints, alpha_shape};

use crate::common;
use crate::common::sites;
use crate::common::sites::weighted;

fn alpha(squared: f64) -> Alpha {
    Alpha::from_squared(squared).unwrap()
}

/// The next double below.
fn below(value: Alpha) -> Alpha {
    alpha(value.squared().next_down())
}

fn alphas(squared: &[f64]) -> Vec<Alpha> {
    squared.iter().copied().map(alpha).collect()
}

fn one_by_one(points: &WeightedPoints, alpha: Alpha, exterior: bool, engine: Engine) -> AlphaShape {
    let options = ShapeOptions::new(alpha).exterior(exterior).engine(engine);
    alpha_shape(points.clone(), &options).unwrap()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(b.abs()).max(1.0)
}

/// Level by level against a shape of its own, exterior simplices included.
fn check(points: &WeightedPoints, squared: &[f64], engine: Engine) -> Filtration {
    let filtration = Filtration::new(points.clone()).unwrap();
    let levels = filtration.levels(&alphas(squared));
    let ladder = levels.ladder(2.0);
    assert_eq!(levels.betti(), ladder.levels.iter().map(|l| l.betti).collect::<Vec<_>>());
    for (k, level) in ladder.levels.iter().enumerate() {
        let alpha = levels.alphas()[k];
        let whole = one_by_one(points, alpha, true, engine);
        assert_eq!(levels.shape(k, true, level.betti).complex(), whole.complex(), "{alpha}");
        let shape = one_by_one(points, alpha, false, Engine::Native);
        let taken = levels.shape(k, false, level.betti);
        assert_eq!(taken.complex(), shape.complex());
        assert_eq!(taken.measures(), shape.measures());
        check_numbers(level, &whole);
    }
    assert!(ladder.levels.windows(2).all(|pair| nested(&pair[0], &pair[1])));
    filtration
}

fn check_numbers(level: &Level, shape: &AlphaShape) {
    let complex = shape.complex();
    assert_eq!(level.cells, complex.cells.counts().interior);
    assert_eq!(level.facets, complex.facets.counts());
    assert_eq!(level.edges, complex.edges.counts());
    assert_eq!(level.vertices, complex.vertices.counts());
    assert_eq!(Some(level.betti), shape.betti());
    let measures = shape.measures();
    assert!(close(level.measures.volume, measures.volume));
    assert!(close(level.measures.area, measures.area));
    assert!(close(level.measures.singular_area, measures.singular_area));
    assert!(close(2.0 * level.coverage, measures.volume));
    let voids = shape.voids().unwrap();
    assert_eq!(level.voids.len(), voids.len());
    for (void, other) in level.voids.iter().zip(&voids) {
        assert!(close(void.volume, other.volume));
    }
    let mut filled: Vec<_> = level.voids.iter().map(|void| void.filling_alpha).collect();
    let mut others: Vec<_> = voids.iter().map(|void| void.filling_alpha).collect();
    for alphas in [&mut filled, &mut others] {
        alphas.sort_by(|a, b| a.partial_cmp(b).unwrap());
    }
    assert_eq!(filled, others);
    assert_eq!(level.solid_components, solid_components(shape));
}

/// By flooding.
fn solid_components(shape: &AlphaShape) -> u64 {
    let cells: Vec<_> = shape.complex().cells.of(Class::Interior).collect();
    let mut seen = vec![false; cells.len()];
    let mut at_facet = std::collections::HashMap::<[u32; 3], Vec<usize>>::new();
    let facets = |cell: &[u32; 4]| {
        let mut cell = *cell;
        cell.sort_unstable();
        let [a, b, c, d] = cell;
        [[a, b, c], [a, b, d], [a, c, d], [b, c, d]]
    };
    for (k, cell) in cells.iter().enumerate() {
        facets(cell).iter().for_each(|&facet| at_facet.entry(facet).or_default().push(k));
    }
    let mut count = 0;
    for start in 0..cells.len() {
        count += u64::from(!seen[start]);
        let mut open = vec![start];
        while let Some(k) = open.pop() {
            if !std::mem::replace(&mut seen[k], true) {
                open.extend(facets(cells[k]).iter().flat_map(|facet| &at_facet[facet]));
            }
        }
    }
    count
}

fn nested(small: &Level, large: &Level) -> bool {
    let total = |level: &Level| {
        [level.cells, level.facets.in_shape(), level.edges.in_shape(), level.vertices.in_shape()]
    };
    total(small).iter().zip(total(large)).all(|(&a, b)| a <= b)
}

/// Lattice points, not all in one plane: everything that can be degenerate is.
fn lattice() -> impl Strategy<Value = WeightedPoints> {
    let points = sites::lattice(8, 4..70);
    points.prop_filter("in one plane", |points| common::spans_a_volume(&points.positions))
}

fn scattered() -> impl Strategy<Value = WeightedPoints> {
    let point = ([0.0..3.0f64, 0.0..3.0, 0.0..9.0], -0.5..1.0f64);
    let points = prop::collection::vec(point, 4..90).prop_map(weighted);
    points.prop_filter("in one plane", |points| common::spans_a_volume(&points.positions))
}

/// A 4-sided block with a hole, whose squared radii are quarters.
fn hollow_lattice() -> WeightedPoints {
    let at = |i: i32| [i % 6, i / 6 % 6, i / 36];
    let outer = (0..216).map(at).filter(|p| !p.iter().all(|k| (2..4).contains(k)));
    weighted(outer.map(|p| (p.map(f64::from), 0.0)))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 120, ..ProptestConfig::default() })]

    #[test]
    fn lattices(points in lattice()) {
        // Squared radii of lattice simplices are multiples of small fractions: α hits them.
        let squared: Vec<f64> = (-6..30).map(|k| f64::from(k) / 4.0).chain([10.0, f64::INFINITY]).collect();
        check(&points, &squared, Engine::Cgal);
    }

    #[test]
    fn scattered_points(points in scattered()) {
        let squared: Vec<f64> = (-4..20).map(|k| f64::from(k) / 8.0).collect();
        check(&points, &squared, Engine::Native);
    }

    /// At the first doubles of critical values shapes change, and just below they do not.
    #[test]
    fn critical_values_are_sharp(points in lattice()) {
        let filtration = Filtration::new(points.clone()).unwrap();
        let curve = filtration.curve();
        for alpha in filtration.readable(&curve, 6) {
            let below = below(alpha);
            let [at, below] = [alpha, below]
                .map(|alpha| one_by_one(&points, alpha, true, Engine::Native).betti().unwrap());
            prop_assert_ne!(at, below);
        }
    }

    /// The curve says what shapes between critical values are.
    #[test]
    fn the_curve_is_the_ladder(points in scattered()) {
        let filtration = Filtration::new(points.clone()).unwrap();
        let curve = filtration.curve();
        for (k, alpha) in curve.alphas().enumerate().step_by(1 + curve.len() / 9) {
            let shape = one_by_one(&points, self::alpha(alpha), true, Engine::Cgal);
            prop_assert_eq!(Some(curve.betti[k]), shape.betti());
            prop_assert_eq!(curve.solid_components[k], solid_components(&shape));
        }
    }
}

/// Below α = 2 the square between them opens, and nothing else does, so that the larger is joined to the
/// smaller one's first cell.
#[test]
fn chambers_that_become_one_fill_with_the_larger() {
    let hollow = |[x, y, z]: [i32; 3]| {
        let within = |low: i32, high: i32| [y, z].iter().all(|k| (low..=high).contains(k));
        match x {
            2..=4 => within(2, 4),
            5 => within(2, 4) && (y == 3 || z == 3),
            6..=9 => within(1, 5),
            _ => false,
        }
    };
    let all = (0..12 * 49).map(|i| [i / 49, i / 7 % 7, i % 7]).filter(|&p| !hollow(p));
    let points = weighted(all.map(|p| (p.map(f64::from), 0.0)));
    let squared = [2f64.next_down(), 2.0];
    let ladder = check(&points, &squared, Engine::Cgal).ladder(&alphas(&squared), 1.0);
    let [one, two] = &ladder.levels[..] else { panic!("two levels") };
    assert_eq!((one.voids.len(), two.voids.len()), (1, 2));
    assert!(two.voids[0].filling_alpha > two.voids[1].filling_alpha);
    assert_eq!(one.voids[0].filling_alpha, two.voids[0].filling_alpha);
}

#[test]
fn a_tie_is_in() {
    // R² = 10 exactly: a 2×6 rectangle doubled up to a box has 1 + 9 = 10 under its diagonal.
    let corner = |i: i32| [2 * (i & 1), 6 * (i >> 1 & 1), (i >> 2) * 20].map(f64::from);
    let points = weighted((0..8).map(|i| (corner(i), 0.0)));
    let filtration =
        check(&points, &[10f64.next_down(), 10.0, 110.0, 110f64.next_down()], Engine::Cgal);
    let ladder = filtration.ladder(&alphas(&[10f64.next_down(), 10.0]), 1.0);
    let [below, at] = &ladder.levels[..] else { panic!() };
    assert_eq!((below.facets.in_shape(), at.facets.singular), (0, 4));
    assert_eq!(filtration.suggest(&filtration.curve()).all_points, alpha(110.0));
}

fn skull(weighting: walpha::Weighting) -> Option<WeightedPoints> {
    use walpha::points::{Selection, Units, difference, select, weigh};
    common::has_skull().then(|| {
        let volume = walpha::volume::sample("sample:skull").unwrap();
        let (volume, _) = volume.into_gray(walpha::Gray::Automatic).unwrap();
        let differences = difference(&volume);
        let selection = Selection::default();
        let points = select(&volume, &volume, &differences, &selection, Units::Voxel).unwrap();
        weigh(points.clone(), weighting, Alpha::from_squared(10.0).unwrap()).unwrap()
    })
}

#[test]
fn the_skull_level_by_level() {
    for weighting in [walpha::Weighting::Common(0.0), walpha::Weighting::MinMax] {
        let Some(points) = skull(weighting) else { return };
        check(&points, &[-1.0, 0.5, 0.75, 2.0, 10.0, 50.0], Engine::Native);
    }
}
