//! Filtrations of a torus, and what is born and dies in them.

use walpha::ladder::Filtration;
use walpha::shape::{Betti, Torus, Void};

use super::{alpha, alpha_shape, dense, options, shape};

#[test]
fn filtrations_hold_all_shapes_of_the_torus() {
    for seed in 0..8 {
        let (points, sides) = dense(seed);
        let filtration = Filtration::on(Some(Torus::new(sides).unwrap()), points.clone()).unwrap();
        let curve = filtration.curve();
        for (k, squared) in curve.alphas().enumerate().step_by(1 + curve.len() / 12) {
            let one = shape(&points, sides, squared).unwrap();
            let taken = filtration.shape(alpha(squared));
            assert_eq!(one.complex(), taken.complex(), "set {seed}, α = {squared}");
            assert_eq!((one.betti(), one.betti()), (taken.betti(), Some(curve.betti[k])));
            assert_eq!(one.measures(), taken.measures());
            let whole = options(sides, squared).exterior(true);
            let whole = alpha_shape(points.clone(), &whole).unwrap();
            let levels = filtration.levels(&[alpha(squared)]);
            assert_same_voids(&whole.voids().unwrap(), &levels.voids()[0]);
        }
        assert_eq!(curve.betti.last(), Some(&Betti { b0: 1, b1: 3, b2: 3, b3: Some(1) }));
    }
}

/// The same voids, but for the rounding of their volumes.
fn assert_same_voids(some: &[Void], others: &[Void]) {
    let sorted = |voids: &[Void]| {
        let mut voids = voids.to_vec();
        voids.sort_by(|a, b| a.low.partial_cmp(&b.low).unwrap().then(a.cells.cmp(&b.cells)));
        voids
    };
    let (some, others) = (sorted(some), sorted(others));
    assert_eq!(some.len(), others.len());
    for (a, b) in some.iter().zip(&others) {
        assert!((a.volume - b.volume).abs() < 1e-12);
        assert_eq!(Void { volume: 0.0, ..*a }, Void { volume: 0.0, ..*b });
    }
}

#[test]
fn persistence_pairs_of_a_torus() {
    for seed in 0..8 {
        let (points, sides) = dense(seed);
        let filtration = Filtration::on(Some(Torus::new(sides).unwrap()), points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let pairs = ordered.pairs();
        assert_eq!((pairs.lasting.len(), pairs.lasting_voids.len()), (1, 3));
        assert_eq!(pairs.voids.len() + 1, ordered.count(3));
        // What is born and has not died is what the Betti numbers count.
        let rank = |number: u32| ordered.simplex(number).rank;
        for (at, betti) in ordered.betti_curve().iter().enumerate() {
            let there = |&[from, to]: &[u32; 2]| rank(from) <= at as u32 && (at as u32) < rank(to);
            let come = |number: &u32| rank(*number) <= at as u32;
            let b0 = pairs.components.iter().filter(|pair| there(pair)).count()
                + pairs.lasting.iter().filter(|v| come(v)).count();
            let b2 = pairs.voids.iter().filter(|pair| there(pair)).count()
                + pairs.lasting_voids.iter().filter(|facet| come(facet)).count();
            let b3 = pairs.last.iter().filter(|cell| come(cell)).count();
            assert_eq!([b0, b2, b3].map(|b| b as u64), [betti.b0, betti.b2, betti.b3.unwrap()]);
        }
        // Faces never come after what they are faces of.
        let values: Vec<u32> = ordered.iter().map(|entry| entry.rank).collect();
        assert!(values.is_sorted());
    }
}
