//! Interprets the distances between slices: one spacing, several, or a gap.

/// Distances that differ by no more than this share form an even grid.
const EVEN: f64 = 0.01;
/// Slices that are off by no more than this share of the distance are moved to an even grid, with a warning.
const JITTER: f64 = 0.1;
/// Distances that differ by no more than this share count as equal.
const ALIKE: f64 = 0.02;
/// A distance that is at least this many times that of its neighbours is wide.
const WIDE: f64 = 1.5;
/// Slices are missing if a wide distance is this near to a multiple of its neighbours' distance.
const WHOLE: f64 = 0.1;

/// The pattern of the distances between slices.
#[derive(Debug, PartialEq)]
pub(super) enum Distances {
    /// There is only one slice.
    One,
    /// This slice and the next are at one place.
    Same(usize),
    /// The slices are `step` apart, and none is further than `off` from its place; `off` is 0 if it does not matter.
    Even { step: f64, off: f64 },
    /// There are several distances; this is the smallest.
    Several(f64),
    /// One distance is so wide that slices may be missing.
    Wide(Wide),
}

/// A wide distance.
#[derive(Debug, PartialEq)]
pub(super) struct Wide {
    /// The slice before the distance.
    pub slice: usize,
    pub gap: f64,
    /// The distance of its neighbours.
    pub usual: f64,
    /// The number of missing slices, if whole slices fit into the distance.
    pub missing: Option<u64>,
}

/// Interprets the places of slices, in order, and the numbers of slices, if all have one.
///
/// Several distances mean a change of spacing if each of them occurs at least twice in a row, or if the numbers of slices
/// continue across it. A wide distance that stands alone is a gap; so is one across which numbers are left out.
pub(super) fn distances(at: &[f64], numbers: Option<&[f64]>) -> Distances {
    let [first, .., last] = at else { return Distances::One };
    let gaps: Vec<f64> = at.windows(2).map(|two| two[1] - two[0]).collect();
    let mut sorted = gaps.clone();
    sorted.sort_by(f64::total_cmp);
    // Of an even number of distances, the larger median is taken, so that not all places have to be doubled.
    let usual = sorted[sorted.len() / 2];
    if let Some(i) = gaps.iter().position(|&gap| gap <= EVEN * usual) {
        return Distances::Same(i);
    }
    let step = (last - first) / gaps.len() as f64;
    let off = at.iter().enumerate().map(|(i, place)| (place - first - i as f64 * step).abs());
    let off = off.fold(0.0, f64::max);
    if off <= EVEN * step {
        return Distances::Even { step, off: 0.0 };
    }
    if off <= JITTER * step {
        return Distances::Even { step, off };
    }
    let alike = |a: f64, b: f64| (a - b).abs() <= ALIKE * a.min(b);
    // The distances that occur twice in a row.
    let in_a_row = gaps.windows(2).filter(|two| alike(two[0], two[1]));
    let spacings: Vec<f64> = in_a_row.map(|two| two[0]).collect();
    let steps = numbers.and_then(steps);
    for (i, &gap) in gaps.iter().enumerate() {
        let sides = [i.checked_sub(1), Some(i + 1)].into_iter().flatten();
        let usual = sides.filter_map(|side| gaps.get(side)).copied().fold(f64::INFINITY, f64::min);
        let is_spacing = spacings.iter().any(|&spacing| alike(spacing, gap));
        let finest = if is_spacing { sorted[0] } else { usual };
        let whole = (gap / finest).round();
        let is_whole = whole >= 2.0 && (gap - whole * finest).abs() <= WHOLE * finest;
        let is_hole = match steps.as_ref().map(|steps| steps[i]) {
            Some(1) => false,
            Some(left_out) if is_spacing => is_whole && left_out as f64 == whole,
            _ => !is_spacing && gap >= WIDE * usual,
        };
        if is_hole {
            let missing = is_whole.then_some(whole as u64 - 1);
            return Distances::Wide(Wide { slice: i, gap, usual: finest, missing });
        }
    }
    // The mean of the smallest distances, as places are rounded.
    let finest: Vec<f64> = gaps.into_iter().filter(|&gap| alike(gap, sorted[0])).collect();
    Distances::Several(finest.iter().sum::<f64>() / finest.len() as f64)
}

/// The differences between the numbers of neighbouring slices, in units of the smallest; `None` if the numbers do not follow the
/// order of places and therefore say nothing.
fn steps(numbers: &[f64]) -> Option<Vec<u64>> {
    let steps: Vec<f64> = numbers.windows(2).map(|two| two[1] - two[0]).collect();
    let is_ordered = steps.iter().all(|&step| step > 0.0) || steps.iter().all(|&step| step < 0.0);
    let least = steps.iter().map(|step| step.abs()).fold(f64::INFINITY, f64::min);
    is_ordered.then(|| steps.iter().map(|step| (step.abs() / least).round() as u64).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The places of slices at these distances.
    fn at(gaps: &[f64]) -> Vec<f64> {
        let mut at = vec![-20.0];
        at.extend(gaps.iter().scan(-20.0, |place, gap| {
            *place += gap;
            Some(*place)
        }));
        at
    }

    fn judged(gaps: &[f64]) -> Distances {
        distances(&at(gaps), None)
    }

    fn hole(gaps: &[f64]) -> Option<(usize, Option<u64>)> {
        match judged(gaps) {
            Distances::Wide(Wide { slice, missing, .. }) => Some((slice, missing)),
            _ => None,
        }
    }

    #[test]
    fn one_spacing_is_even() {
        assert_eq!(judged(&[]), Distances::One);
        assert_eq!(judged(&[2.5; 4]), Distances::Even { step: 2.5, off: 0.0 });
        assert_eq!(judged(&[1.0, 1.005, 0.995]), Distances::Even { step: 1.0, off: 0.0 });
        let Distances::Even { step, off } = judged(&[1.0, 1.05, 1.0]) else { panic!("jitter") };
        assert!((step - 3.05 / 3.0).abs() < 1e-12 && off > 0.0 && off < 0.05, "{step} {off}");
        assert_eq!(judged(&[1.0, 0.0, 1.0]), Distances::Same(1));
    }

    #[test]
    fn several_spacings_are_each_of_several_slices() {
        let several = |gaps: &[f64]| match judged(gaps) {
            Distances::Several(step) => (step * 1e9).round() / 1e9,
            other => panic!("{gaps:?}: {other:?}"),
        };
        assert_eq!(several(&[[2.5; 11].as_slice(), &[7.5; 7]].concat()), 2.5);
        assert_eq!(several(&[[1.0; 7].as_slice(), &[4.0; 4], &[1.0; 8]].concat()), 1.0);
        assert_eq!(several(&[5.0, 5.0, 5.0, 2.0, 2.0]), 2.0);
        // The distances are uneven, but none is wide.
        assert_eq!(several(&[1.0, 1.3, 1.1, 1.3, 1.0]), 1.0);
    }

    #[test]
    fn a_wide_distance_alone_is_a_hole() {
        assert_eq!(hole(&[1.0, 2.0, 1.0]), Some((1, Some(1))));
        assert_eq!(hole(&[2.0, 3.0]), Some((1, None)));
        assert_eq!(hole(&[1.0, 1.0, 1.0, 4.0]), Some((3, Some(3))));
        assert_eq!(hole(&[1.0, 1.0, 4.0, 4.0, 8.0, 4.0]), Some((4, Some(1))));
        assert_eq!(hole(&[1.0, 1.0, 2.0, 1.0, 2.0, 1.0]), Some((2, Some(1))));
        assert_eq!(hole(&[1.0, 1.0, 1.6, 1.0, 1.0]), Some((2, None)));
    }

    #[test]
    fn numbers_tell_holes_from_spacings() {
        let gaps = [1.0, 1.0, 1.0, 2.0, 2.0];
        let judge = |numbers: &[f64]| distances(&at(&gaps), Some(numbers));
        assert_eq!(judge(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), Distances::Several(1.0));
        assert_eq!(judge(&[6.0, 5.0, 4.0, 3.0, 2.0, 1.0]), Distances::Several(1.0));
        let hole = Wide { slice: 3, gap: 2.0, usual: 1.0, missing: Some(1) };
        assert_eq!(judge(&[1.0, 2.0, 3.0, 4.0, 6.0, 8.0]), Distances::Wide(hole));
        // Unordered numbers say nothing.
        assert_eq!(judge(&[1.0, 3.0, 2.0, 4.0, 6.0, 8.0]), Distances::Several(1.0));
        // One distance is wide, and no number is left out.
        let alone = distances(&at(&[1.0, 1.0, 4.0]), Some(&[1.0, 2.0, 3.0, 4.0]));
        assert_eq!(alone, Distances::Several(1.0));
    }
}
