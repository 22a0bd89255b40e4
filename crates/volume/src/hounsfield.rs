//! Decides whether the values of a volume are Hounsfield units.

use crate::{Source, Volume, VolumeError};

/// Statistics of a volume whose values look like Hounsfield units (HU), in which air is −1000 and water 0.
///
/// Few formats state the unit of a value, so the histogram decides: values are from −4096 to 32 767, some are 300 or more (bone),
/// at least 2 % are below −900 (air around the patient), at least 5 % are between −200 and 200 (soft tissue), and both of these
/// ranges are at least twice as dense as that between −600 and −300, where hardly any tissue is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Hounsfield {
    /// The share of samples below −900 HU.
    pub air: f64,
    /// The share of samples between −200 and 200 HU.
    pub soft_tissue: f64,
}

impl Hounsfield {
    /// Examines a volume in memory; `None` if its values are not Hounsfield units. One pass.
    pub fn of_volume(volume: &Volume) -> Option<Self> {
        if volume.has_gray_levels() {
            return None;
        }
        let mut counts = Counts::default();
        let samples = volume.as_slice();
        if volume.has_missing() {
            let there = samples.iter().enumerate().filter(|&(i, _)| !volume.is_missing(i));
            there.for_each(|(_, value)| counts.add(std::slice::from_ref(value)));
        } else {
            counts.add(samples);
        }
        counts.judge()
    }

    /// Examines a volume that is read for this purpose, one part at a time; `None` if its values are not Hounsfield units. One
    /// pass.
    ///
    /// # Errors
    /// The file cannot be read or is damaged.
    pub fn of(source: &Source) -> Result<Option<Self>, VolumeError> {
        if source.has_gray_levels() {
            return Ok(None);
        }
        let mut counts = Counts::default();
        source.for_each_part(|values, _| {
            counts.add(values);
            true
        })?;
        Ok(counts.judge())
    }
}

/// The number of finite values, and of those of each kind.
#[derive(Default)]
pub(crate) struct Counts {
    all: u64,
    air: u64,
    between: u64,
    soft_tissue: u64,
    bone: u64,
    outside: u64,
}

impl Counts {
    pub(crate) fn add(&mut self, values: &[f32]) {
        for &value in values.iter().filter(|value| value.is_finite()) {
            self.all += 1;
            self.air += u64::from(value < -900.0);
            self.between += u64::from((-600.0..-300.0).contains(&value));
            self.soft_tissue += u64::from((-200.0..200.0).contains(&value));
            self.bone += u64::from(value >= 300.0);
            self.outside += u64::from(!(-4096.0..=32_767.0).contains(&value));
        }
    }

    pub(crate) fn judge(&self) -> Option<Hounsfield> {
        let share = |count: u64| count as f64 / self.all.max(1) as f64;
        let (air, between, soft_tissue) =
            (share(self.air), share(self.between), share(self.soft_tissue));
        // These are shares per HU, of ranges that are 200, 300 and 400 HU wide.
        let most = 2.0 * between / 300.0;
        let dense = air / 200.0 >= most && soft_tissue / 400.0 >= most;
        let enough = air >= 0.02 && soft_tissue >= 0.05 && self.bone > 0 && self.outside == 0;
        (dense && enough).then_some(Hounsfield { air, soft_tissue })
    }
}

#[cfg(test)]
mod tests {
    use ndarray::Array3;
    use walpha_base::random::Random;

    use super::*;
    use crate::{Frame, SampleStats, ct, phantom};

    fn volume(value: impl FnMut() -> f32) -> Volume {
        let mut value = value;
        Volume::new(Array3::from_shape_simple_fn((20, 20, 20), &mut value), Frame::VOXEL).unwrap()
    }

    #[test]
    fn a_ct_has_hounsfield_units() {
        let ct = ct();
        let found = Hounsfield::of_volume(&ct).expect("HU");
        assert!(found.air > 0.3 && found.soft_tissue > 0.1, "{found:?}");
        let source = Source::of_volume(ct);
        assert_eq!(Hounsfield::of(&source).unwrap(), Some(found));
        assert_eq!(SampleStats::of(&source, None).unwrap().hounsfield, Some(found));
    }

    #[test]
    fn other_values_are_none() {
        let mut random = Random::new(3);
        let spread = volume(|| (4000.0 * random.unit() - 1500.0) as f32);
        assert_eq!(Hounsfield::of_volume(&spread), None, "all values alike");
        let mut sign = 1.0;
        let waves = volume(|| {
            sign = -sign;
            sign * 1000.0
        });
        assert_eq!(Hounsfield::of_volume(&waves), None, "no soft tissue");
        assert_eq!(Hounsfield::of_volume(&phantom(32).unwrap()), None, "gray levels");
        let ct = ct();
        let shifted = Volume::new(ct.samples().mapv(|value| value + 1024.0), *ct.frame()).unwrap();
        assert_eq!(Hounsfield::of_volume(&shifted), None, "as scanners store them, unshifted");
    }
}
