use serde::{Deserialize, Serialize};

/// A region of voxels of a grid, which the [shape of labels](crate::schema) fills. Voxel (i, j, k) is the box of half a step along
/// each axis around its sample.
///
/// The fields are public, so that any program can make a region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Voxels {
    /// Voxels of the grid along its x, y and z.
    pub dims: [u32; 3],
    /// The position of the first sample.
    pub origin: [f64; 3],
    /// The steps from a sample to the next along the grid's x, y and z.
    pub axes: [[f64; 3]; 3],
    /// The voxels of the region, as runs [first, number], ascending; voxel (i, j, k) is number i + X·(j + Y·k).
    pub runs: Vec<[u64; 2]>,
}

impl Voxels {
    /// The position of a corner: corner (i, j, k) is the corner of voxel (i, j, k) with the smallest indices, half a step before
    /// its sample. Each product and each sum is rounded once, so the same doubles result everywhere.
    pub fn corner(&self, at: [u32; 3]) -> [f64; 3] {
        let steps = at.map(|i| f64::from(i) - 0.5);
        [0, 1, 2].map(|r| {
            let along = |k: usize| steps[k] * self.axes[k][r];
            self.origin[r] + along(0) + along(1) + along(2)
        })
    }

    /// The number of voxels in the region.
    pub fn count(&self) -> u64 {
        self.runs.iter().map(|&[_, count]| count).sum()
    }

    /// The determinant of the axes: the volume of a voxel, negative if the axes are left-handed.
    pub fn determinant(&self) -> f64 {
        let [a, b, c] = self.axes;
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)
    }

    /// The indices of a voxel.
    pub fn indices(&self, voxel: u64) -> [u32; 3] {
        let [x, y, _] = self.dims.map(u64::from);
        [voxel % x, voxel / x % y, voxel / x / y].map(|i| i as u32)
    }

    /// Whether the runs are ascending, do not overlap and lie in the grid.
    pub fn is_sound(&self) -> bool {
        let all: u128 = self.dims.iter().map(|&n| u128::from(n)).product();
        let mut end = 0;
        self.runs.iter().all(|&[first, count]| {
            let follows = count > 0 && u128::from(first) >= end;
            end = u128::from(first) + u128::from(count);
            follows && end <= all
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn voxels(runs: Vec<[u64; 2]>) -> Voxels {
        let axes = [[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -0.5]];
        Voxels { dims: [4, 3, 2], origin: [10.0, 0.0, 0.0], axes, runs }
    }

    #[test]
    fn corners_are_half_a_step_from_samples() {
        let voxels = voxels(vec![[0, 2], [5, 1]]);
        assert_eq!(voxels.corner([0, 0, 0]), [9.0, -0.5, 0.25]);
        assert_eq!(voxels.corner([4, 3, 2]), [17.0, 2.5, -0.75]);
        assert_eq!((voxels.count(), voxels.determinant()), (3, -1.0));
        assert_eq!(voxels.indices(4 + 4 * 3), [0, 1, 1]);
    }

    #[test]
    fn runs_are_in_order_and_in_the_grid() {
        for (runs, sound) in [
            (vec![[0, 2], [2, 1], [23, 1]], true),
            (vec![[0, 2], [1, 1]], false),
            (vec![[3, 0]], false),
            (vec![[23, 2]], false),
            (vec![[u64::MAX, u64::MAX]], false),
        ] {
            assert_eq!(voxels(runs.clone()).is_sound(), sound, "{runs:?}");
        }
    }
}
