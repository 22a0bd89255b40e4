use walpha_base::random::Random;

use super::*;

/// Small integers, and if `wild` their neighbours, halves, and numbers of any size.
fn number(random: &mut Random, wild: bool) -> f64 {
    let small = random.below(9) as f64 - 4.0;
    match random.below(8) {
        _ if !wild => small,
        0 => small.next_up(),
        1 => small / 2.0,
        2 => small * 10f64.powi(random.below(240) as i32 - 120),
        3 => random.next() as f64 / 1e19,
        _ => small,
    }
}

/// Five points; the lattice is theirs.
fn draw(random: &mut Random, wild: bool) -> (Vec<[f64; 3]>, Vec<f64>) {
    let positions = (0..5).map(|_| [0; 3].map(|_| number(random, wild))).collect();
    (positions, (0..5).map(|_| number(random, wild)).collect())
}

fn agree<const N: usize>(predicates: &Predicates<'_>, simplex: [u32; N], alpha: f64) -> [bool; 2] {
    let sites = simplex.map(|v| predicates.site(v));
    let radius = predicates.squared_radius(simplex);
    let truth = exact::fits(sites, alpha);
    assert_eq!(predicates.fits_by(simplex, radius, alpha), truth, "{radius:?} {alpha}");
    let bounded = radius.high.is_finite();
    if bounded {
        assert!(exact::fits(sites, radius.high));
        assert!(!exact::fits(sites, radius.low.next_down()));
    }
    let first = predicates.first_alpha(simplex);
    if first.abs() < 1e300 {
        assert!(exact::fits(sites, first));
        assert!(!exact::fits(sites, first.next_down()), "{first}");
    }
    if N < 4 {
        let x = predicates.site(4);
        let truth = exact::inside(sites, x);
        assert_eq!(predicates.inside(simplex, 4), truth);
    }
    [bounded, truth]
}

#[test]
fn doubles_and_integers_agree() {
    let mut random = Random::new(3);
    let mut bounded = 0;
    for round in 0..6000 {
        let wild = round % 2 == 1;
        let (positions, weights) = draw(&mut random, wild);
        let predicates = Predicates::new(&positions, &weights);
        let flat = |rays: &[u32]| {
            let rays: Vec<_> =
                rays.iter().map(|&v| ray(predicates.site(0), predicates.site(v)).0).collect();
            quotient(&rays).1 <= 1e-6
        };
        let alpha = number(&mut random, wild);
        // Simplices without volume have no sphere; triangulations have none of them.
        if !flat(&[1]) && !flat(&[1, 2]) && !flat(&[1, 2, 3]) {
            bounded += usize::from(agree(&predicates, [0, 1], alpha)[0]);
            agree(&predicates, [0, 1, 2], alpha);
            agree(&predicates, [0, 1, 2, 3], alpha);
            assert_eq!(
                predicates.inside([0], 4),
                exact::inside([predicates.site(0)], predicates.site(4))
            );
        }
    }
    assert!(bounded > 2000, "{bounded}");
}

#[test]
fn a_radius_on_a_lattice_is_a_round_number() {
    let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|k| k as f64);
    let positions: Vec<_> = (0..8).map(corner).collect();
    let weights = vec![0.0; 8];
    let predicates = Predicates::new(&positions, &weights);
    let cell = [0, 1, 2, 4];
    let radius = predicates.squared_radius(cell);
    assert!(radius.low < 0.75 && radius.high > 0.75);
    assert_eq!(predicates.first_alpha(cell), 0.75);
    assert!(
        predicates.fits_by(cell, radius, 0.75)
            && !predicates.fits_by(cell, radius, 0.75f64.next_down())
    );
    // The far corners lie on the sphere, not inside.
    assert!(!predicates.inside([0, 1, 2], 4) && !predicates.inside([0, 1, 2], 3));
    assert_eq!(predicates.squared_radius([3]), Interval { low: 0.0, high: 0.0 });
}

/// What the corners of simplices that are not flat say of the faces opposite them, against the predicate for each alone.
#[test]
fn corners_inside_opposite_faces() {
    let mut random = Random::new(5);
    let mut counts = [0; 2];
    for round in 0..6000 {
        let (positions, weights) = draw(&mut random, round % 2 == 1);
        let predicates = Predicates::new(&positions, &weights);
        let sites = [0, 1, 2, 3].map(|v| predicates.site(v));
        if exact::orientation(sites).is_eq() || exact::collinear([sites[0], sites[1], sites[2]]) {
            continue;
        }
        let [p, q, r, s] = sites;
        let cell = [
            exact::inside([q, r, s], p),
            exact::inside([p, r, s], q),
            exact::inside([p, q, s], r),
            exact::inside([p, q, r], s),
        ];
        assert_eq!(predicates.inside_opposite([0, 1, 2, 3]), cell);
        let facet = [exact::inside([q, r], p), exact::inside([p, r], q), exact::inside([p, q], r)];
        assert_eq!(predicates.inside_opposite([0, 1, 2]), facet);
        let edge = [exact::inside([q], p), exact::inside([p], q)];
        assert_eq!(predicates.inside_opposite([0, 1]), edge);
        for inside in cell.into_iter().chain(facet).chain(edge) {
            counts[usize::from(inside)] += 1;
        }
    }
    assert!(counts[0] > 10_000 && counts[1] > 10_000, "{counts:?}");
}

/// Corners of cells from round to nearly flat, at places and with weights that no double arithmetic holds.
fn scattered(random: &mut Random, flatness: f64) -> (Vec<[f64; 3]>, Vec<f64>) {
    let far = [0.0, 1.0, 1e3][random.below(3)];
    let weights = [0.0, 0.1, 5.0][random.below(3)];
    let positions = (0..4).map(|_| {
        let [x, y, z] = [0; 3].map(|_| random.unit());
        [x + far, y - far, 0.3 * x + 0.6 * y + flatness * z + far]
    });
    (positions.collect(), (0..4).map(|_| weights * random.unit()).collect())
}

#[test]
fn the_nearest_double_is_that_of_the_exact_radius() {
    let mut random = Random::new(6);
    let mut found = 0;
    for round in 0..6000 {
        let flatness = [1.0, 1e-3, 1e-7, 1e-11][round % 4];
        let (positions, weights) = scattered(&mut random, flatness);
        let predicates = Predicates::new(&positions, &weights);
        let sites = [0, 1, 2, 3].map(|v| predicates.site(v));
        if exact::orientation(sites).is_eq() {
            continue;
        }
        let View { rays, size } = View::of(sites[0], sites);
        let cell = exact::squared_radius(sites).nearest();
        let centred = centred::nearest(&sites, &rays, size);
        assert!(centred.is_none_or(|radius| radius == cell), "{centred:?} {cell}");
        assert_eq!(predicates.nearest_radius([0, 1, 2, 3]), cell);
        found += usize::from(centred.is_some());
        let facet = [0, 1, 2].map(|v| predicates.site(v));
        let View { rays, size } = View::of(facet[0], facet);
        let radius = exact::squared_radius(facet).nearest();
        let centred = centred::nearest(&facet, &rays, size);
        assert!(centred.is_none_or(|centred| centred == radius), "{centred:?} {radius}");
        assert_eq!(predicates.nearest_radius([0, 1, 2]), radius);
        found += usize::from(centred.is_some());
        let edge = exact::squared_radius([facet[0], facet[1]]).nearest();
        assert_eq!(predicates.nearest_radius([0, 1]), edge);
    }
    // Slivers need more; all others are found.
    assert!(found > 8000, "{found}");
}
