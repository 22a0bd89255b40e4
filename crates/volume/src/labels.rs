//! Decides whether the values of a volume are labels, as in a segmentation.

use std::collections::HashMap;

use crate::{Dtype, Source, Volume, VolumeError};

/// The labels of a volume: whole numbers that say what a voxel is part of. 0 is the background.
///
/// All are below 2²⁴; from there on single precision does not distinguish all whole numbers.
///
/// A file may state that it contains labels ([`Volume::states_labels`]). Otherwise values are taken for labels by this rule: all
/// are whole numbers, none is below 0, there are 2 to 1000 different ones, and they form flat regions. *Flat*: consider the pairs
/// of neighbours (along x, y and z) that contain a value, and the share of pairs whose two values are equal. For random values
/// this share would be e = p / (2 − p), where p is the share of the value among all samples. On average over all values, the
/// shares must cover at least a quarter of the way from e to 1. *Regions*: if there are more than three values, at least a tenth
/// of the unequal pairs skip a value in between, which ramps and smooth fields do not. So masks of 0 and 1, or of 0 and 255, are
/// labels; noise, photographs and CTs are not, nor are volumes that are declared to be gray levels without being stored as bytes
/// ([`Volume::with_gray_levels`]).
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Labels {
    /// Each value with the number of samples that have it; ascending.
    pub counts: Vec<(i32, u64)>,
    /// Whether the file states that these are labels.
    pub stated: bool,
}

impl Labels {
    /// Examines a volume in memory; `None` if its values are not labels. One pass.
    pub fn of_volume(volume: &Volume) -> Option<Self> {
        let stated = volume.states_labels();
        if !stated && is_gray(volume.has_gray_levels(), volume.dtype()) {
            return None;
        }
        Tally::of(volume, stated).judge(stated)
    }

    /// The labels of a volume whose values are taken for labels whatever the rule says; `None` if some are not whole numbers, or
    /// reach 2²⁴, from where on single precision does not distinguish all of them. One pass.
    pub fn of_any(volume: &Volume) -> Option<Self> {
        let stated = volume.states_labels();
        Tally::of(volume, true).labels(stated)
    }

    /// Examines a volume that is read for this purpose, one part at a time; `None` if its values are not labels. One pass.
    ///
    /// # Errors
    /// The file cannot be read or is damaged.
    pub fn of(source: &Source) -> Result<Option<Self>, VolumeError> {
        let mut tally = Tally::of_source(source);
        source.for_each_part(|values, size| {
            tally.add(values, size, |_| false);
            !tally.ended
        })?;
        Ok(tally.of_source_judged(source))
    }

    /// The labels other than 0, each with its number of voxels.
    pub fn foreground(&self) -> impl Iterator<Item = (i32, u64)> + '_ {
        self.counts.iter().copied().filter(|&(label, _)| label != 0)
    }
}

/// Whether samples are declared to be gray levels, and not only stored as bytes.
fn is_gray(gray_levels: bool, dtype: Dtype) -> bool {
    gray_levels && dtype != Dtype::U8
}

/// The largest number of different values that the rule takes for labels.
const MOST: usize = 1000;
/// The whole numbers below this are looked up in a table.
const SMALL: usize = 4096;
/// From here on, several whole numbers may be rounded to one `f32`: 2²⁴ + 1 is rounded to this.
const TOO_LARGE: f32 = 16_777_216.0;
/// Stands for a value that is not known yet, and for a missing sample.
const NONE: u32 = u32::MAX;

/// The number of samples of each value, and of pairs of neighbours.
pub(crate) struct Tally {
    small: Vec<u32>,
    others: HashMap<i32, u32>,
    /// The values in the order of their first occurrence, with the number of samples of each.
    values: Vec<(i32, u64)>,
    /// The numbers of pairs of the first [`MOST`] values; the pairs of value a before value b are at MOST·a + b.
    pairs: Vec<u64>,
    /// Whether all values are counted, even if there are too many for the rule.
    all: bool,
    /// Whether counting can stop, as the values are not labels.
    ended: bool,
}

impl Tally {
    fn new(all: bool) -> Self {
        let (small, others) = (vec![NONE; SMALL], HashMap::new());
        Self { small, others, values: Vec::new(), pairs: vec![0; MOST * MOST], all, ended: false }
    }

    fn of(volume: &Volume, all: bool) -> Self {
        let mut tally = Self::new(all);
        tally.add(volume.as_slice(), volume.dims().xyz(), |sample| volume.is_missing(sample));
        tally
    }

    /// A tally for the parts of a source.
    pub(crate) fn of_source(source: &Source) -> Self {
        let mut tally = Self::new(source.states_labels());
        tally.ended = !source.states_labels() && is_gray(source.has_gray_levels(), source.dtype());
        tally
    }

    pub(crate) fn of_source_judged(self, source: &Source) -> Option<Labels> {
        self.judge(source.states_labels())
    }

    /// Adds a box of samples, with x fastest.
    pub(crate) fn add(
        &mut self,
        samples: &[f32],
        [x, y, _]: [usize; 3],
        is_missing: impl Fn(usize) -> bool,
    ) {
        if self.ended {
            return;
        }
        let mut slice = vec![NONE; x * y];
        for (row, samples) in samples.chunks(x).enumerate() {
            let mut last = (f32::NAN, NONE);
            for (column, &sample) in samples.iter().enumerate() {
                let at = row % y * x + column;
                let before_z = std::mem::replace(&mut slice[at], NONE);
                if is_missing(row * x + column) {
                    continue;
                }
                if sample != last.0 {
                    last = (sample, self.number(sample));
                    if self.ended {
                        return;
                    }
                }
                let number = last.1;
                if number == NONE {
                    continue;
                }
                slice[at] = number;
                self.values[number as usize].1 += 1;
                // Rows of the first slice have no slice before them.
                self.pair(before_z, number);
                if column > 0 {
                    self.pair(slice[at - 1], number);
                }
                if row % y > 0 {
                    self.pair(slice[at - x], number);
                }
            }
        }
    }

    #[inline]
    fn pair(&mut self, before: u32, number: u32) {
        if (before.max(number) as usize) < MOST {
            self.pairs[MOST * before as usize + number as usize] += 1;
        }
    }

    /// The index of a value; [`NONE`] if it is not finite or not a label.
    fn number(&mut self, sample: f32) -> u32 {
        if !sample.is_finite() {
            return NONE;
        }
        let value = sample as i32;
        if value as f32 != sample || sample.abs() >= TOO_LARGE {
            self.ended = true;
            return NONE;
        }
        let next = self.values.len() as u32;
        let number = match usize::try_from(value).ok().filter(|&value| value < SMALL) {
            Some(small) => &mut self.small[small],
            None => self.others.entry(value).or_insert(NONE),
        };
        if *number == NONE {
            *number = next;
            self.values.push((value, 0));
            self.ended = !self.all && self.values.len() > MOST;
        }
        *number
    }

    /// The labels, if all values are whole numbers.
    fn labels(mut self, stated: bool) -> Option<Labels> {
        if self.ended || self.values.is_empty() {
            return None;
        }
        self.values.sort_unstable();
        Some(Labels { counts: self.values, stated })
    }

    /// The labels, if they are stated or the rule says so.
    fn judge(self, stated: bool) -> Option<Labels> {
        let counted = !self.ended && self.values.iter().all(|&(value, _)| value >= 0);
        let is_it = stated || counted && self.values.len() > 1 && self.is_flat();
        if is_it { self.labels(stated) } else { None }
    }

    fn is_flat(&self) -> bool {
        let n = self.values.len();
        let all: u64 = self.values.iter().map(|(_, count)| count).sum();
        let mut ranks: Vec<usize> = (0..n).collect();
        ranks.sort_unstable_by_key(|&number| self.values[number].0);
        let mut rank = vec![0; n];
        ranks.iter().enumerate().for_each(|(at, &number)| rank[number] = at);
        let (mut equal, mut unequal) = (vec![0u64; n], vec![0u64; n]);
        let (mut borders, mut jumps) = (0u64, 0u64);
        for a in 0..n {
            for b in 0..n {
                let count = self.pairs[MOST * a + b];
                if a == b {
                    equal[a] += count;
                    continue;
                }
                unequal[a] += count;
                unequal[b] += count;
                borders += count;
                jumps += if rank[a].abs_diff(rank[b]) > 1 { count } else { 0 };
            }
        }
        let flatness = |v: usize| {
            let share = self.values[v].1 as f64 / all.max(1) as f64;
            let at_random = share / (2.0 - share);
            let found = equal[v] as f64 / (equal[v] + unequal[v]).max(1) as f64;
            (found - at_random) / (1.0 - at_random)
        };
        let mean = (0..n).map(flatness).sum::<f64>() / n as f64;
        mean >= 0.25 && (n <= 3 || 10 * jumps >= borders)
    }
}

#[cfg(test)]
mod tests {
    use ndarray::Array3;
    use walpha_base::random::Random;

    use super::*;
    use crate::{Frame, SampleStats, ct, phantom};

    fn volume(shape: [usize; 3], value: impl FnMut([usize; 3]) -> f32) -> Volume {
        let mut value = value;
        let samples = Array3::from_shape_fn(shape, |(z, y, x)| value([x, y, z]));
        Volume::new(samples, Frame::VOXEL).unwrap()
    }

    fn squared([x, y, z]: [usize; 3]) -> f64 {
        [x, y, z].iter().map(|&i| (i as f64 - 15.5).powi(2)).sum()
    }

    /// Whether a volume has labels, which must be the same if it is stored as bytes.
    fn are_labels(volume: &Volume) -> bool {
        let found = Labels::of_volume(volume);
        let bytes = volume.clone().with_dtype(Dtype::U8);
        assert_eq!(Labels::of_volume(&bytes), found, "stored as bytes");
        let source = Source::of_volume(bytes);
        assert_eq!(Labels::of(&source).unwrap(), found, "in parts");
        assert_eq!(SampleStats::of(&source, None).unwrap().labels, found, "among others");
        found.is_some()
    }

    #[test]
    fn segmentations_are_labels() {
        let ball =
            |inside: f32| volume([32; 3], move |at| if squared(at) < 80.0 { inside } else { 0.0 });
        for inside in [1.0, 255.0, 70_000.0] {
            let found = Labels::of_volume(&ball(inside)).expect("a mask");
            assert_eq!(found.foreground().collect::<Vec<_>>(), [(inside as i32, 3016)]);
            assert!(!found.stated);
        }
        // Negative values, as in Hounsfield units, are not labels unless a file states that they are.
        assert_eq!(Labels::of_volume(&ball(-3.0)), None);
        assert!(Labels::of_volume(&ball(-3.0).with_labels()).is_some());
        let nested =
            volume([32; 3], |at| f32::from(squared(at) < 80.0) + f32::from(squared(at) < 30.0));
        let plate = volume([12, 12, 12], |[_, _, z]| f32::from(z == 5));
        let rod = volume([40, 40, 40], |[x, y, _]| f32::from([x, y] == [7, 9]));
        let cavity =
            volume([5; 3], |at| f32::from(at.iter().all(|i| (1..4).contains(i)) && at != [2; 3]));
        // Thirty boxes, as organs that lie in many places.
        let organs = volume([40; 3], |[x, y, z]| match (x % 8, y % 10, z % 13) {
            (0..5, 0..7, 0..9) => (1 + x / 8 + 5 * (y / 10) + 20 * (z / 13)) as f32,
            _ => 0.0,
        });
        for labels in [ball(1.0), nested, plate, rod, cavity, organs] {
            assert!(are_labels(&labels), "{:?}", labels.dims());
        }
    }

    #[test]
    fn images_are_none() {
        let mut random = Random::new(9);
        let mut noise = |most: f64| volume([20; 3], |_| (most * random.unit()).floor() as f32);
        let few: Vec<Volume> = [2.0, 3.0, 4.0, 9.0, 256.0].map(&mut noise).into();
        let mut sparse = Random::new(4);
        let sparse = volume([30; 3], |_| f32::from(sparse.unit() < 0.02));
        let ramp = volume([64; 3], |[x, _, _]| x as f32);
        let steps = volume([64; 3], |[x, y, _]| ((x + y) / 12) as f32);
        let smooth = volume([48; 3], |at| (200.0 * (-squared(at) / 300.0).exp()).round() as f32);
        let halves = volume([16; 3], |[x, _, _]| 0.5 * (x / 8) as f32);
        let one = volume([16; 3], |_| 7.0);
        for image in few.iter().chain([&sparse, &ramp, &steps, &smooth, &halves, &one]) {
            assert!(!are_labels(image), "{:?} {:?}", image.dims(), image.value_range());
        }
        assert_eq!(Labels::of_volume(&ct()), None);
        for size in 1..40 {
            assert_eq!(Labels::of_volume(&phantom(size).unwrap()), None, "{size}");
        }
        // A CT in a window of 8 bits, much of which is black or white.
        let window = ct()
            .samples()
            .mapv(|value| ((value + 160.0) / 400.0 * 255.0).clamp(0.0, 255.0).floor());
        let window = Volume::new(window, Frame::VOXEL).unwrap();
        assert!(!are_labels(&window));
    }

    /// The statement of the file decides; missing samples have no label.
    #[test]
    fn what_is_stated_is_taken() {
        let one = volume([4; 3], |_| 7.0).with_labels();
        let expected = Labels { counts: vec![(7, 64)], stated: true };
        assert_eq!(Labels::of_volume(&one), Some(expected.clone()));
        assert_eq!(Labels::of(&Source::of_volume(one)).unwrap(), Some(expected));
        assert_eq!(Labels::of_volume(&volume([4; 3], |_| 0.5).with_labels()), None);
        let many = volume([12; 3], |[x, y, z]| (x + 12 * y + 144 * z) as f32);
        assert_eq!(Labels::of_volume(&many), None);
        assert_eq!(Labels::of_any(&many).unwrap().counts.len(), 1728);
        let mut samples = volume([20; 3], |[x, _, _]| f32::from(x < 9)).into_samples();
        samples[[3, 3, 3]] = f32::NAN;
        let torn = Volume::of_file(samples, Frame::VOXEL).unwrap();
        let torn = torn.resolve_nan(Some(crate::Nan::Mask)).unwrap();
        assert_eq!(Labels::of_volume(&torn).unwrap().counts, [(0, 4400), (1, 3599)]);
    }
}
