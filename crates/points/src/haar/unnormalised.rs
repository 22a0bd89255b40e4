/// The Haar decomposition of a row into plain averages and half-differences, as Table 1 of the paper prints it. It is only for
/// illustration: thresholds belong on orthonormal coefficients ([`forward`](super::forward)).
///
/// ```
/// use walpha_points::haar::Unnormalised;
///
/// let mut table = Unnormalised::of(&[9.0, 7.0, 3.0, 5.0]).unwrap();
/// assert_eq!(table.averages, [vec![8.0, 4.0], vec![6.0]]);
/// assert_eq!(table.details, [vec![1.0, -1.0], vec![2.0]]);
/// table.details[0][1] = 0.0;
/// assert_eq!(table.row(), [9.0, 7.0, 4.0, 4.0]);
/// table.details[0][0] = 0.0;
/// assert_eq!(table.row(), [8.0, 8.0, 4.0, 4.0]);
///
/// assert_eq!(Unnormalised::of(&[9.0, 7.0, 3.0]), None);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Unnormalised {
    /// The averages (p + q)/2 after each level, finest first. Only the last, a single one, is needed for the inverse.
    pub averages: Vec<Vec<f64>>,
    /// The half-differences (p − q)/2 of each level, finest first.
    pub details: Vec<Vec<f64>>,
}

impl Unnormalised {
    /// Decomposes a row fully; `None` unless its length is a power of two and at least 2.
    pub fn of(row: &[f64]) -> Option<Self> {
        if row.len() < 2 || !row.len().is_power_of_two() {
            return None;
        }
        let (mut averages, mut details) = (Vec::new(), Vec::new());
        let mut rest = row.to_vec();
        while rest.len() > 1 {
            let (pairs, _) = rest.as_chunks::<2>();
            details.push(pairs.iter().map(|[p, q]| (p - q) / 2.0).collect());
            rest = pairs.iter().map(|[p, q]| (p + q) / 2.0).collect();
            averages.push(rest.clone());
        }
        Some(Self { averages, details })
    }

    /// The row that has the last average and these half-differences.
    pub fn row(&self) -> Vec<f64> {
        let coarsest = self.averages.last().cloned().unwrap_or_default();
        self.details.iter().rev().fold(coarsest, |averages, details| {
            averages.iter().zip(details).flat_map(|(m, d)| [m + d, m - d]).collect()
        })
    }
}
