//! Pairs against a plain reduction of matrices.

use std::collections::{BTreeMap, HashMap};

use walpha::ladder::{Filtration, Ordered};

use super::sets;

/// Pairs of all dimensions by numbers of simplices, and the simplices without one: columns of the
/// boundary matrix over Z/2, reduced from the left.
fn reduced(ordered: &Ordered<'_>) -> (Vec<Vec<[u32; 2]>>, Vec<u32>) {
    let place: HashMap<Vec<u32>, usize> =
        ordered.iter().enumerate().map(|(at, simplex)| (simplex.vertices.to_vec(), at)).collect();
    let mut with_low: HashMap<usize, Vec<usize>> = HashMap::new();
    let mut pairs = vec![Vec::new(); 3];
    let mut alone: Vec<bool> = vec![true; ordered.len()];
    for (at, simplex) in ordered.iter().enumerate() {
        let n = simplex.vertices.len();
        let mut column: Vec<usize> = (0..n)
            .filter(|_| n > 1)
            .map(|gone| {
                let mut face = simplex.vertices.to_vec();
                face.remove(gone);
                place[&face]
            })
            .collect();
        column.sort_unstable();
        while let Some(other) = column.last().and_then(|low| with_low.get(low)) {
            let mut sum: BTreeMap<usize, bool> = BTreeMap::new();
            column.iter().chain(other).for_each(|&row| *sum.entry(row).or_default() ^= true);
            column = sum.into_iter().filter(|(_, odd)| *odd).map(|(row, _)| row).collect();
        }
        if let Some(&low) = column.last() {
            pairs[n - 2].push([ordered.order()[low], ordered.order()[at]]);
            (alone[low], alone[at]) = (false, false);
            with_low.insert(low, column);
        }
    }
    let alone = (0..ordered.len()).filter(|&at| alone[at]).map(|at| ordered.order()[at]).collect();
    (pairs, alone)
}

#[test]
fn pairs_are_those_of_a_matrix() {
    let mut lasting = [0; 3];
    for points in sets(240, 40) {
        let filtration = Filtration::new(points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let pairs = ordered.pairs();
        let (mut expected, alone) = reduced(&ordered);
        let sorted = |pairs: &[[u32; 2]]| {
            let mut pairs = pairs.to_vec();
            pairs.sort_unstable();
            pairs
        };
        expected.iter_mut().for_each(|pairs| pairs.sort_unstable());
        assert_eq!(sorted(&pairs.components), expected[0]);
        assert_eq!(sorted(&pairs.voids), expected[2]);
        assert_eq!(pairs.lasting, alone);
        // What is in no pair of these is in one of dimension 1: edges that begin, facets that end.
        let used: std::collections::HashSet<u32> =
            pairs.components.iter().chain(&pairs.voids).flatten().copied().collect();
        let free = |number: &u32| {
            let dimension = ordered.simplex(*number).vertices.len() - 1;
            (1..=2).contains(&dimension) && !used.contains(number)
        };
        let mut of_loops: Vec<u32> = expected[1].iter().flatten().copied().collect();
        of_loops.sort_unstable();
        assert_eq!((0..ordered.len() as u32).filter(free).collect::<Vec<_>>(), of_loops);
        for (count, pairs) in lasting.iter_mut().zip(&expected) {
            *count += pairs.iter().filter(|&&pair| ordered.lasts(pair)).count();
        }
    }
    assert!(lasting.iter().all(|&count| count > 100), "{lasting:?}");
}
