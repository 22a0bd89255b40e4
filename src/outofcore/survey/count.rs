use serde::{Deserialize, Serialize};

use super::Chosen;
use crate::outofcore::BlocksError;
use crate::outofcore::field::{Field, Truncated};
use crate::outofcore::passes::Passes;
use crate::points::Differences;

/// What is known of the points together.
#[derive(Serialize, Deserialize)]
pub(super) struct Counted {
    pub(super) differences: Differences,
    /// The first of them, by its index in the volume.
    pub(super) first: u64,
    /// How many each brick has.
    pub(super) counts: Vec<u32>,
}

impl Counted {
    fn join(&mut self, other: Self) {
        self.differences.join(&other.differences);
        self.first = self.first.min(other.first);
        self.counts.iter_mut().zip(other.counts).for_each(|(count, more)| *count += more);
    }
}

/// Looks at all points.
pub(super) fn count(
    field: &Field,
    truncated: &Truncated,
    choice: &Chosen,
    passes: &mut Passes<'_>,
) -> Result<Counted, BlocksError> {
    let ([cx, cy, _], side) = (field.bricks.count(), field.bricks.side());
    let counts = vec![0; field.bricks.count().iter().product()];
    let mut all = Counted { differences: Differences::default(), first: u64::MAX, counts };
    passes.each(
        |tile| {
            let mut points = Vec::new();
            field.samples(tile, truncated, |sample| {
                if choice.is_point(&sample) {
                    points.push((sample.voxel, sample.difference));
                }
            })?;
            let of_points: Vec<f64> = points.iter().map(|&(_, difference)| difference).collect();
            let voxels: Vec<u64> = points.into_iter().map(|(voxel, _)| voxel).collect();
            Ok((Differences::of(&of_points), voxels))
        },
        |(more, voxels)| {
            all.differences.join(&more);
            all.first = all.first.min(voxels.first().copied().unwrap_or(u64::MAX));
            let [nx, ny, _] = field.dims;
            for voxel in voxels {
                let voxel = voxel as usize;
                let [x, y, z] = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)].map(|i| i / side);
                all.counts[(z * cy + y) * cx + x] += 1;
            }
        },
    )?;
    Ok(passes.team.reduce(all, Counted::join))
}
