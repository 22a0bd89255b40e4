//! The order of the input.

use super::*;

use crate::common;

/// Shuffling the input gives the same complex in input indices.
#[test]
fn the_order_of_input_does_not_count() {
    let mut random = Random::new(21);
    for _ in 0..60 {
        let n = 8 + random.below(60);
        // Places of their own, so that no tie among duplicates depends on the order.
        let mut positions = grid(5);
        random.shuffle(&mut positions);
        positions.truncate(n);
        let weights = weights(&mut random, n);
        let case = Case { positions, weights, alpha: alpha(&mut random) };
        let spans = common::spans_a_volume(&case.positions);
        assert_eq!(engine(&case).is_ok(), spans, "{case:?}");
        assert!(spans, "nine of a grid's points and more are hardly in one plane");
        let straight = engine(&case).unwrap();
        let mut order: Vec<usize> = (0..n).collect();
        random.shuffle(&mut order);
        let shuffled = engine(&Case {
            positions: order.iter().map(|&i| case.positions[i]).collect(),
            weights: order.iter().map(|&i| case.weights[i]).collect(),
            alpha: case.alpha,
        })
        .unwrap();
        let back = |row: &[u32]| {
            let mut row: Vec<_> = row.iter().map(|&i| order[i as usize] as u32).collect();
            row.sort_unstable();
            row
        };
        assert_eq!(rows(&shuffled, back), rows(&straight, back_to_itself), "{case:?}");
    }
}

fn back_to_itself(row: &[u32]) -> Vec<u32> {
    let mut row = row.to_vec();
    row.sort_unstable();
    row
}

/// All simplices with sorted vertices and their classes, and the hidden points.
fn rows(answer: &Answer, renumber: impl Fn(&[u32]) -> Vec<u32>) -> Vec<(Vec<u32>, Option<Class>)> {
    let c = &answer.complex;
    let mut all: Vec<_> = c.cells.iter().map(|(r, class)| (renumber(r), Some(class))).collect();
    all.extend(c.facets.iter().map(|(r, class)| (renumber(r), Some(class))));
    all.extend(c.edges.iter().map(|(r, class)| (renumber(r), Some(class))));
    all.extend(c.vertices.iter().map(|(r, class)| (renumber(r), Some(class))));
    all.extend(answer.hidden.iter().map(|&i| (renumber(&[i]), None)));
    all.sort_unstable();
    all
}
