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
