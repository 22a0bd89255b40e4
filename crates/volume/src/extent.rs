//! The values of a volume, looked at piece by piece.

use super::{Nan, Source, Volume, VolumeError};

/// Samples looked at together, at most, where the format lets them be read so: 64 MiB.
const AT_ONCE: usize = 1 << 24;

/// What values a volume has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// The smallest and the largest finite value; `None` where there is none.
    pub range: Option<(f32, f32)>,
    /// How many samples are NaN or infinite.
    pub missing: u64,
}

impl Extent {
    /// Of a volume that is read for it, a part at a time: its memory does not grow with the volume. `nan` may say
    /// what replaces samples that are not finite. One pass.
    ///
    /// # Errors
    /// The file cannot be read or is damaged.
    pub fn of(source: &Source, nan: Option<Nan>) -> Result<Self, VolumeError> {
        let (dims, step) = (source.dims().xyz(), step(source));
        let (mut low, mut high, mut missing) = (f32::INFINITY, f32::NEG_INFINITY, 0);
        for z in (0..dims[2]).step_by(step[2]) {
            for y in (0..dims[1]).step_by(step[1]) {
                for x in (0..dims[0]).step_by(step[0]) {
                    let first = [x, y, z];
                    let size = [0, 1, 2].map(|k| step[k].min(dims[k] - first[k]));
                    for value in source.read(first, size)? {
                        let value = match nan {
                            Some(Nan::Value(instead)) if !value.is_finite() => instead,
                            _ => value,
                        };
                        if value.is_finite() {
                            (low, high) = (low.min(value), high.max(value));
                        } else {
                            missing += 1;
                        }
                    }
                }
            }
        }
        Ok(Self { range: (low <= high).then_some((low, high)), missing })
    }

    /// Of a volume in memory, whose [missing](Volume::is_missing) samples are not finite in its file.
    pub fn of_volume(volume: &Volume) -> Self {
        let missing = volume.dims().samples() - volume.samples_there();
        Self { range: Some(volume.value_range()), missing: missing as u64 }
    }
}

/// How many samples along each axis are read at once: whole grains, and as many as may be.
fn step(source: &Source) -> [usize; 3] {
    let dims = source.dims().xyz();
    let mut step = [0, 1, 2].map(|k| source.grain()[k].clamp(1, dims[k]));
    for k in 0..3 {
        let grain = step[k];
        let others: usize = step.iter().product::<usize>() / grain;
        let most = AT_ONCE / others.max(1) / grain * grain;
        step[k] = most.clamp(grain, dims[k]);
    }
    step
}
