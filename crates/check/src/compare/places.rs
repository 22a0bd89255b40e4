/// Numbers for places, common to both complexes.
pub(super) struct Places {
    pub positions: Vec<[f64; 3]>,
    /// The place of each point of A.
    pub a: Vec<u32>,
    /// The place of each point of B.
    pub b: Vec<u32>,
}

impl Places {
    pub(super) fn new(a: &[[f64; 3]], b: &[[f64; 3]]) -> Self {
        let by_place =
            |p: &[f64; 3], q: &[f64; 3]| p.partial_cmp(q).expect("coordinates are finite");
        let mut positions = [a, b].concat();
        positions.sort_unstable_by(by_place);
        positions.dedup();
        let number = |p: &[f64; 3]| {
            positions.binary_search_by(|q| by_place(q, p)).expect("every place has a number") as u32
        };
        let (a, b) = (a.iter().map(number).collect(), b.iter().map(number).collect());
        Self { positions, a, b }
    }
}

/// The largest weight at each place; −∞ at places without a point.
pub(super) fn weights_by_place(weights: &[f64], place: &[u32]) -> Vec<f64> {
    let count = place.iter().max().map_or(0, |&last| last as usize + 1);
    let mut largest = vec![f64::NEG_INFINITY; count];
    for (&place, &weight) in place.iter().zip(weights) {
        largest[place as usize] = largest[place as usize].max(weight);
    }
    largest
}
