//! The ladder against shapes made one by one: every simplex at every level, suggestions, levels of detail.

mod command;

use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;
use walpha::ladder::{Filtration, Level};
use walpha::points::{Region, Selection, SelectionRule, Units, difference, focus, select};
use walpha::shape::{Engine, ShapeOptions};
use walpha::{Alpha, AlphaShape, Class, WeightedPoints, alpha_shape};
use walpha_base::random::Random;

use crate::common::{self, weighted};

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

/// Compares each level with a separately computed shape, including exterior simplices.
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
    assert!(close(level.measures.regular_area, measures.regular_area));
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

/// The number of solid components, by flooding.
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
    let points = common::lattice(8, 4..70);
    points.prop_filter("in one plane", |points| common::spans_a_volume(points.positions()))
}

fn scattered() -> impl Strategy<Value = WeightedPoints> {
    let point = ([0.0..3.0f64, 0.0..3.0, 0.0..9.0], -0.5..1.0f64);
    let points = prop::collection::vec(point, 4..90).prop_map(weighted);
    points.prop_filter("in one plane", |points| common::spans_a_volume(points.positions()))
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

    /// A coarse curve is part of it: the last simplex has entered, and what is said of each α holds.
    #[test]
    fn a_coarse_curve_is_true(points in lattice(), most in 2..9usize) {
        let filtration = Filtration::new(points.clone()).unwrap();
        let (all, some) = (filtration.curve(), filtration.coarse_curve(most));
        prop_assert!((2..=most).contains(&some.len()) || all.len() < 2);
        prop_assert_eq!(some.betti.last(), all.betti.last());
        let alphas = filtration.coarse_alphas(most);
        prop_assert_eq!(&alphas, &some.alphas().map(alpha).collect::<Vec<_>>());
        let levels = filtration.levels(&alphas);
        for (k, &alpha) in alphas.iter().enumerate() {
            let shape = one_by_one(&points, alpha, true, Engine::Native);
            prop_assert_eq!(Some(some.betti[k]), shape.betti());
            let entered = levels.cells().iter().filter(|(_, first)| *first <= k as u32).count();
            prop_assert_eq!(entered, shape.complex().cells.counts()[Class::Interior]);
        }
        let suggested = filtration.suggest(&some);
        prop_assert!(suggested.all_points >= filtration.suggest(&all).all_points);
        for alpha in filtration.stops(&some, 6) {
            prop_assert!(some.alphas().any(|value| value == alpha.squared()));
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

#[test]
fn a_hollow_block_and_what_is_suggested_for_it() {
    let points = hollow_lattice();
    let squared = [0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 2.75, 3.0];
    let filtration = check(&points, &squared, Engine::Cgal);
    let curve = filtration.curve();
    let suggested = filtration.suggest(&curve);
    assert_eq!(suggested.all_points, alpha(0.75));
    assert_eq!(suggested.one_region, alpha(0.75));
    // The hole is a box of three with its corners cut: the sphere in its middle meets (1, 2, 2) and the like.
    assert_eq!(suggested.no_void, alpha(2.75));
    assert_eq!(suggested.plateau, [0.75, 2.75].map(alpha));
    let chosen = filtration.readable(&curve, 24);
    let chosen: Vec<f64> = chosen.iter().map(|alpha| alpha.squared()).collect();
    // If a corner is missing, three points make a triangle: 2/3, rounded up.
    assert_eq!(chosen, [0.25, 0.5, 0.6666666666666667, 0.75, 2.75]);
}

/// (q, q², q³): doubles tell few of the radii apart, with weights or without.
fn cubic(weights: [f64; 4]) -> WeightedPoints {
    let site = |q: i32| ([1, 2, 3].map(|k| f64::from(q).powi(k)), weights[(q + 8) as usize % 4]);
    weighted((-8..=8).map(site))
}

#[test]
fn the_critical_values_of_ill_conditioned_points_are_exact() {
    // Counted, and the last found, with rational numbers.
    for (weights, values, one_region) in
        [([0.0, 0.5, 1.0, 1.5], 158, 67300732.09365807), ([0.0; 4], 82, 67299698.25)]
    {
        let points = cubic(weights);
        let filtration = Filtration::new(points.clone()).unwrap();
        let curve = filtration.curve();
        assert_eq!(curve.len(), values);
        let suggested = filtration.suggest(&curve);
        assert_eq!(suggested.one_region, alpha(one_region));
        let chosen = filtration.readable(&curve, 5000);
        let all = [&chosen[..], &[suggested.all_points, suggested.one_region]].concat();
        assert!(all.len() > 5, "{all:?}");
        for alpha in all {
            let [at, below] = [alpha, below(alpha)]
                .map(|alpha| one_by_one(&points, alpha, true, Engine::Cgal).complex().clone());
            assert!(at != below, "nothing comes at {alpha}");
        }
    }
}

/// The value that is printed as filling a void fills it, and no smaller double does.
#[test]
fn voids_fill_at_the_first_double() {
    let mut points = hollow_lattice();
    // Off the lattice by less than radii are known in doubles: which comes last is hard to tell.
    let mut random = Random::new(1);
    for x in points.positions_mut().iter_mut().flatten() {
        *x += 1024.0 + random.below(16) as f64 * 2f64.powi(-42);
    }
    let filtration = Filtration::new(points.clone()).unwrap();
    let void = filtration.ladder(&alphas(&[0.8]), 1.0).levels[0].voids[0];
    let voids = |alpha: Alpha| {
        let shape = one_by_one(&points, alpha, true, Engine::Native);
        shape.voids().unwrap()
    };
    assert_eq!(voids(alpha(0.8))[0].filling_alpha, void.filling_alpha);
    assert_eq!(voids(void.filling_alpha), []);
    assert_ne!(voids(below(void.filling_alpha)), []);
}

#[test]
fn where_nothing_changes_any_more_the_stretch_has_no_end() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let filtration = Filtration::new(weighted(corners.map(|p| (p, 0.0)))).unwrap();
    let suggested = filtration.suggest(&filtration.curve());
    assert_eq!(suggested.plateau, [alpha(0.75), Alpha::INFINITE]);
    assert_eq!(serde_json::to_value(suggested).unwrap()["plateau"][1], "inf");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("four.csv"), "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n").unwrap();
    let told =
        common::ok(folder.path(), &["ladder", "four.csv", "--weights", "common=0", "-o", "out"]);
    assert!(told.contains("0.75         to inf: b0, b1, b2 no longer change"), "{told}");
}

#[test]
fn a_shift_of_weights_shifts_the_ladder() {
    let mut points = hollow_lattice();
    let plain = Filtration::new(points.clone()).unwrap();
    points.weights_mut().iter_mut().for_each(|weight| *weight = 0.5);
    let shifted = Filtration::new(points).unwrap();
    let (a, b) = (plain.suggest(&plain.curve()), shifted.suggest(&shifted.curve()));
    assert_eq!(a.no_void.squared() - 0.5, b.no_void.squared());
    let ladder = |f: &Filtration, at: f64| f.ladder(&alphas(&[at]), 1.0).levels[0].betti;
    assert_eq!(ladder(&plain, 1.0), ladder(&shifted, 0.5));
}

#[test]
fn huge_and_tiny_units_change_nothing() {
    for factor in [2f64.powi(-120), 2f64.powi(130)] {
        let mut points = hollow_lattice();
        points.positions_mut().iter_mut().flatten().for_each(|x| *x *= factor);
        let filtration = Filtration::new(points).unwrap();
        let suggested = filtration.suggest(&filtration.curve());
        assert_eq!(suggested.no_void, alpha(2.75 * factor * factor));
    }
}

/// Full detail in a region and few points elsewhere are one triangulation: no crack at the border.
#[test]
fn a_region_of_full_detail_leaves_no_crack() {
    let volume = walpha::volume::sample("sample:phantom@32").unwrap();
    let (volume, _) = volume.into_gray(walpha::Gray::Automatic).unwrap();
    let differences = difference(&volume);
    let points = |count| {
        let selection = Selection::default().rule(SelectionRule::Count(count));
        select(&volume, &volume, &differences, &selection, Units::Voxel).unwrap()
    };
    let (fine, coarse) = (points(4000), points(900));
    let region = Region { low: [0.0, 8.0, 10.0], high: [31.0, 31.0, 20.0] };
    let both = focus(&fine, &coarse, &region);

    let key = |p: [f64; 3]| [2, 1, 0].map(|k| p[k] as i64);
    let inside = fine.positions.iter().filter(|p| region.contains(**p));
    let outside = coarse.positions.iter().filter(|p| !region.contains(**p));
    let union: BTreeSet<[i64; 3]> = inside.chain(outside).map(|&p| key(p)).collect();
    assert!(union.len() > 1000 && union.len() < 4000, "{}", union.len());
    assert!(both.positions.iter().map(|&p| key(p)).eq(union.iter().copied()));

    let alpha = alpha(10.0);
    let of = |positions: Vec<[f64; 3]>| {
        let weights = vec![0.0; positions.len()];
        one_by_one(&WeightedPoints::new(positions, weights).unwrap(), alpha, false, Engine::Native)
    };
    let shape = of(both.positions.clone());
    let plain = of(union.iter().map(|&[z, y, x]| [x, y, z].map(|k| k as f64)).collect());
    assert_eq!(shape.complex(), plain.complex());
    // Cells reach across the border, and the boundary of the solid has no end there or anywhere.
    let within = |v: &u32| region.contains(both.positions[*v as usize]);
    let mut cells = shape.complex().cells.of(Class::Interior);
    assert!(cells.any(|cell| cell.iter().any(within) && !cell.iter().all(within)));
    let mut sides = BTreeMap::<[u32; 2], usize>::new();
    for &[a, b, c] in shape.complex().facets.of(Class::Regular) {
        for [a, b] in [[a, b], [b, c], [a, c]] {
            *sides.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    assert!(sides.values().all(|count| count % 2 == 0));
}
