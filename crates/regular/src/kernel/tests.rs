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

/// Five points with their lattice.
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

/// Compares the tests of the faces opposite the corners of simplices that are not flat with the predicate for each face alone.
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
    let mut found = [0; 3];
    for round in 0..6000 {
        let flatness = [1.0, 1e-3, 1e-7, 1e-11][round % 4];
        let (positions, weights) = scattered(&mut random, flatness);
        let predicates = Predicates::new(&positions, &weights);
        let sites = [0, 1, 2, 3].map(|v| predicates.site(v));
        if exact::orientation(sites).is_eq() {
            continue;
        }
        found[0] += usize::from(is_nearest(&predicates, [0, 1]));
        found[1] += usize::from(is_nearest(&predicates, [0, 1, 2]));
        found[2] += usize::from(is_nearest(&predicates, [0, 1, 2, 3]));
    }
    // Only slivers need more.
    let [edges, facets, cells] = found;
    assert!([edges, facets] == [6000; 2] && cells > 2900, "{found:?}");
}

/// Holds the radius of a simplex to the exact one. Returns whether a corrected centre gives it.
fn is_nearest<const N: usize>(predicates: &Predicates<'_>, simplex: [u32; N]) -> bool {
    let sites = simplex.map(|v| predicates.site(v));
    let View { rays, size } = View::of(sites[0], sites);
    let radius = exact::squared_radius(sites).nearest();
    let centred = centred::nearest(&sites, &rays, size, &Solution::of(&rays[1..]));
    assert!(centred.is_none_or(|centred| centred == radius), "{centred:?} {radius}");
    assert_eq!(predicates.nearest_radius(simplex), radius);
    centred.is_some()
}

/// Five points of a small grid, along the axes or turned, with coordinates that no double holds.
fn draw_on_grid(random: &mut Random) -> (Vec<[f64; 3]>, Vec<f64>) {
    let turned = random.below(2) == 1;
    let sizes = [[0.3, 0.3, 0.3], [0.4883, 0.4883, 0.625], [1.75, 1.1, 3.0]][random.below(3)];
    let [c, s] = if turned { [0.96, 0.28] } else { [1.0, 0.0] };
    let place = |index: [usize; 3]| {
        let [x, y, z] = [0, 1, 2].map(|k| index[k] as f64 * sizes[k]);
        [x - 111.1, c * y - s * z - 76.86, s * y + c * z + 33.3]
    };
    let positions = (0..5).map(|_| place([0; 3].map(|_| random.below(3)))).collect();
    let weighted = random.below(4) == 0;
    (positions, (0..5).map(|_| if weighted { random.below(3) as f64 / 3.0 } else { 0.0 }).collect())
}

/// Compares with integers on rounded grids, where doubles leave much undecided; little remains for integers.
#[test]
fn rounded_grids_agree_with_integers() {
    // Signs, zeros and undecided cases of orientation, power, points inside an edge and a facet, and radii.
    let mut counts = [[0; 3]; 5];
    let mut count = |row: usize, closely: Option<Ordering>| {
        counts[row][match closely {
            Some(Ordering::Equal) => 1,
            Some(_) => 0,
            None => 2,
        }] += 1;
        closely
    };
    let mut random = Random::new(11);
    for _ in 0..40_000 {
        let (positions, weights) = draw_on_grid(&mut random);
        let predicates = Predicates::new(&positions, &weights);
        let sites = [0, 1, 2, 3, 4].map(|v| predicates.site(v));
        let [p, q, r, s, x] = sites;
        let size = View::<5>::of(x, sites).size;
        let length = size.length;
        let truth = exact::orientation([p, q, r, s]);
        let terms = 6.0 * length * length * length;
        let closely = count(0, close::orientation(&[p, q, r, s], size, terms));
        assert_eq!(closely.unwrap_or(truth), truth, "{positions:?}");
        assert_eq!(predicates.orientation([0, 1, 2, 3]), truth);
        if truth.is_ne() {
            let truth = exact::power(sites);
            let closely = count(1, close::power(&sites, size, 4.0 * terms * size.power));
            assert_eq!(closely.unwrap_or(truth), truth, "{positions:?} {weights:?}");
            assert_eq!(predicates.power([0, 1, 2, 3], 4), truth);
        }
        if p.position != q.position {
            let truth = exact::inside([p, q], x);
            let closely = count(2, close::inside(&[p, q], x, size, size.side_bound(2)));
            assert_eq!(closely.map_or(truth, Ordering::is_lt), truth, "{positions:?} {weights:?}");
            assert_eq!(predicates.inside([0, 1], 4), truth);
        }
        if !exact::collinear([p, q, r]) {
            let truth = exact::inside([p, q, r], x);
            let closely = count(3, close::inside(&[p, q, r], x, size, size.side_bound(3)));
            assert_eq!(closely.map_or(truth, Ordering::is_lt), truth, "{positions:?} {weights:?}");
            assert_eq!(predicates.inside([0, 1, 2], 4), truth);
            let alpha = predicates.first_alpha([0, 1, 2]);
            for alpha in [alpha, alpha.next_down()] {
                let truth = exact::fits([p, q, r], alpha);
                let bounds = size.bounds(3);
                let ball = 4.0 * (alpha + p.weight).abs();
                let terms = bounds.numerator + ball * bounds.denominator;
                let closely = count(4, close::radius(&[p, q, r], alpha, size, terms));
                assert_eq!(closely.map_or(truth, Ordering::is_le), truth, "{positions:?}");
                assert_eq!(predicates.fits([0, 1, 2], alpha), truth);
            }
        }
    }
    for [signs, zeros, open] in counts {
        assert!(open < (signs + zeros) / 5, "{counts:?}");
    }
    assert!(counts[..4].iter().all(|[signs, zeros, _]| signs.min(zeros) > &500), "{counts:?}");
}

/// The centre in doubles is as near to the exact one as it claims; if it cannot be, it is the exact one.
#[test]
fn centres_are_near() {
    let mut random = Random::new(21);
    let (mut rounded, mut exact_ones) = (0, 0);
    for case in 0..40_000 {
        let (mut positions, weights) = draw(&mut random, case % 2 == 1);
        if case % 4 == 0 {
            positions.iter_mut().flatten().for_each(|x| *x = *x * 0.1 + 1e6);
        }
        let predicates = Predicates::new(&positions, &weights);
        let cell = match predicates.orientation([0, 1, 2, 3]) {
            Ordering::Greater => [0, 1, 2, 3],
            Ordering::Less => [0, 1, 3, 2],
            Ordering::Equal => continue,
        };
        let truth = exact::centre_of(cell.map(|v| predicates.site(v)));
        let found = predicates.centre(cell);
        if found == truth {
            exact_ones += 1;
            continue;
        }
        let differences =
            positions[..4].iter().flat_map(|p| [0, 1, 2].map(|k| p[k] - positions[0][k]));
        let scale = differences.chain(truth).fold(0f64, |most, x| most.max(x.abs()));
        for k in 0..3 {
            let error = (found[k] - truth[k]).abs();
            assert!(error <= scale / f64::from(1 << 30), "{found:?} {truth:?} {scale}");
        }
        rounded += 1;
    }
    assert!(rounded > 2000 && exact_ones > 2000, "{rounded} {exact_ones}");
}

/// A quotient by the squared step that underflows is not 0, and its number is not a multiple.
#[test]
fn the_smallest_alpha_is_not_a_multiple_of_a_large_step() {
    // The two balls touch: the squared radius of the smallest orthogonal sphere is 0.
    let step = 2f64.powi(26);
    let positions = [[0.0; 3], [2.0 * step, 0.0, 0.0]];
    let weights = [step * step; 2];
    let predicates = Predicates::new(&positions, &weights);
    assert_eq!(predicates.first_alpha([0, 1]), 0.0);
    assert!(predicates.fits([0, 1], 0.0) && predicates.fits([0, 1], 5e-324));
    assert!(!predicates.fits([0, 1], -5e-324));
}
