/// Numbers for positions, common to both complexes.
pub(super) struct CommonPositions {
    pub positions: Vec<[f64; 3]>,
    /// The number of each point of A.
    pub a: Vec<u32>,
    /// The number of each point of B.
    pub b: Vec<u32>,
}

impl CommonPositions {
    pub(super) fn new(a: &[[f64; 3]], b: &[[f64; 3]]) -> Self {
        let by_coordinates =
            |p: &[f64; 3], q: &[f64; 3]| p.partial_cmp(q).expect("coordinates are finite");
        let mut positions = [a, b].concat();
        positions.sort_unstable_by(by_coordinates);
        positions.dedup();
        let number = |p: &[f64; 3]| {
            positions
                .binary_search_by(|q| by_coordinates(q, p))
                .expect("every position has a number") as u32
        };
        let (a, b) = (a.iter().map(number).collect(), b.iter().map(number).collect());
        Self { positions, a, b }
    }
}

/// The largest weight at each position; −∞ where there is no point.
pub(super) fn weights_by_position(weights: &[f64], numbers: &[u32]) -> Vec<f64> {
    let count = numbers.iter().max().map_or(0, |&last| last as usize + 1);
    let mut largest = vec![f64::NEG_INFINITY; count];
    for (&number, &weight) in numbers.iter().zip(weights) {
        largest[number as usize] = largest[number as usize].max(weight);
    }
    largest
}
