//! Points of a plane, of a line, and alone: their filtration against the definition at every critical value.

use walpha::check::enumerate;
use walpha::ladder::Filtration;
use walpha::shape::ShapeOptions;
use walpha::{Alpha, WeightedPoints, alpha_shape};
use walpha_base::random::Random;

use crate::common;

/// Lattice points that span no volume, many at one place, on one circle, or hidden.
fn set(random: &mut Random) -> WeightedPoints {
    let steps = [0, 1].map(|_| [0; 3].map(|_| random.whole(-2, 2)));
    let (line, weighted) = (random.below(4) == 0, random.below(2) == 0);
    let count = 1 + random.below(12);
    let point = |random: &mut Random| {
        let (u, v) = (random.whole(-2, 2), if line { 0.0 } else { random.whole(-2, 2) });
        let weight = if weighted { random.whole(-2, 40) / 2.0 } else { 0.0 };
        ([0, 1, 2].map(|k| 1.0 + u * steps[0][k] + v * steps[1][k]), weight)
    };
    let (positions, weights) = (0..count).map(|_| point(random)).unzip();
    WeightedPoints::new(positions, weights).unwrap()
}

#[test]
fn flat_filtrations_are_those_of_the_definition() {
    let mut random = Random::new(29);
    let (mut done, mut dimensions, mut hidden, mut attached) = (0, [0; 3], 0, 0);
    while done < 200 {
        let points = set(&mut random);
        if common::spans_a_volume(&points.positions) {
            continue;
        }
        done += 1;
        let filtration = Filtration::new(points.clone()).unwrap();
        let ordered = filtration.simplices().unwrap();
        let curve = filtration.curve();
        let top = (0..3).rev().find(|&dimension| ordered.count(dimension) > 0).unwrap();
        dimensions[top] += 1;
        hidden += usize::from(filtration.whole().hidden().is_some_and(|hidden| !hidden.is_empty()));
        attached += (0..top).filter(|&k| ordered.gabriel(k) < ordered.count(k)).count();
        assert_eq!((ordered.count(3), ordered.gabriel(top)), (0, ordered.count(top)));
        for (alpha, &betti) in curve.alphas().zip(&curve.betti) {
            // At the value, and below it.
            for alpha in [alpha, alpha.next_down()].map(|alpha| Alpha::from_squared(alpha).unwrap())
            {
                let made = enumerate(&points.positions, &points.weights, alpha).unwrap();
                let levels = filtration.levels(&[alpha]);
                let shape = levels.shape(0, true, levels.betti()[0]);
                assert_eq!(*shape.complex(), made.complex, "{alpha:?}: {points:?}");
                let options = ShapeOptions::new(alpha);
                let alone = alpha_shape(points.clone(), &options).unwrap();
                assert_eq!(alone.betti(), shape.betti(), "{alpha:?}: {points:?}");
                assert_eq!(*filtration.shape(alpha).complex(), *alone.complex());
            }
            assert_eq!(betti.b2, 0);
        }
        // Every simplex comes once, when its faces are there; nothing is ever inside.
        let mut seen = std::collections::HashMap::new();
        for simplex in ordered.iter() {
            let n = simplex.vertices.len();
            for gone in (0..n).filter(|_| n > 1) {
                let mut face = simplex.vertices.to_vec();
                face.remove(gone);
                assert!(seen[&face] <= simplex.rank);
            }
            assert!(seen.insert(simplex.vertices.to_vec(), simplex.rank).is_none());
            assert_eq!(simplex.interior, f64::INFINITY);
            assert_eq!(simplex.regular == f64::INFINITY, n == top + 1, "{simplex:?}");
        }
        let pairs = ordered.pairs();
        assert_eq!((pairs.components.len(), pairs.lasting.len()), (ordered.count(0) - 1, 1));
        assert!(pairs.voids.is_empty() && pairs.lasting_voids.is_empty() && pairs.last.is_none());
        let suggested = filtration.suggest(&curve);
        assert_eq!(suggested.one_region, filtration.one_region());
        assert_eq!(filtration.shape(suggested.one_region).betti().unwrap().b0, 1);
    }
    assert!(dimensions.iter().all(|&sets| sets > 10), "{dimensions:?}");
    assert!(hidden > 5 && attached > 50, "{hidden}, {attached}");
}
