//! Certification: silent on right complexes, and a finding for each rule on wrong ones.

use std::num::NonZeroUsize;

use walpha::check::{Extent, Finding, NotJudged};
use walpha::shape::{Engine, ShapeOptions, claim};
use walpha::{Alpha, WeightedPoints, alpha_shape};
use walpha_base::random::Random;

use crate::check_common::{Answer, Case, engine, grid, shape_of};

fn whole(case: &Case, answer: &Answer) -> Vec<Finding> {
    case.findings(answer, Extent::Whole)
}

fn shape(case: &Case, answer: &Answer) -> Vec<Finding> {
    case.findings(answer, Extent::Shape)
}

/// Points with ties, hidden points and duplicates.
fn lattice_case(random: &mut Random) -> Case {
    let n = 10 + random.below(40);
    let side = 3 + random.below(3);
    let positions = (0..n).map(|_| [0; 3].map(|_| random.below(side) as f64)).collect();
    let kinds = 1 + random.below(5);
    let weights = (0..n).map(|_| random.below(kinds) as f64 / 2.0).collect();
    let alpha = random.pick(&[-1.0, 0.0, 0.5, 0.75, 1.0, 2.0, 5.0, f64::INFINITY]);
    Case { positions, weights, alpha }
}

#[test]
fn right_answers_are_certified() {
    let mut random = Random::new(3);
    let mut certified = 0;
    for _ in 0..1500 {
        let case = lattice_case(&mut random);
        let Ok(answer) = engine(&case) else { continue };
        assert_eq!(whole(&case, &answer), [], "{case:?}");
        assert_eq!(shape(&case, &shape_of(&answer)), [], "{case:?}");
        certified += 1;
    }
    assert!(certified > 1200);
}

#[test]
fn a_grid_with_min_max_weights_is_certified() {
    let mut random = Random::new(12);
    let positions = grid(12);
    let weights = (0..positions.len()).map(|_| 3.0 * random.unit()).collect();
    let case = Case { positions, weights, alpha: 3.0 };
    let answer = engine(&case).unwrap();
    assert!(answer.hidden.len() > 50);
    let (findings, certificate) = case.claim(&answer, Extent::Whole).findings().unwrap();
    assert_eq!(findings, []);
    assert_eq!(certificate.not_judged, []);
    assert_eq!(certificate.six_volumes.to_string(), (6 * 11 * 11 * 11).to_string());
    assert_eq!(shape(&case, &shape_of(&answer)), []);
}

/// The local engine never sees the whole triangulation; its shape is certified all the same.
#[test]
fn shapes_made_slab_by_slab_are_certified() {
    let mut random = Random::new(8);
    for blocks in [2, 5] {
        let mut positions = grid(14);
        positions.retain(|_| random.unit() < 0.5);
        let weights: Vec<_> = positions.iter().map(|_| random.below(4) as f64 / 2.0).collect();
        let mut options = ShapeOptions::new(Alpha::from_squared(1.5).unwrap());
        (options.engine, options.blocks) = (Engine::Native, NonZeroUsize::new(blocks));
        let points = WeightedPoints::new(positions, weights).unwrap();
        let shape = alpha_shape(points, &options).unwrap();
        let (findings, certificate) = claim(&shape).findings().unwrap();
        assert_eq!(findings, []);
        assert!(certificate.not_judged.contains(&NotJudged::HiddenAndHull));
        assert!(shape.complex().cells.len() > 1000);
    }
}
