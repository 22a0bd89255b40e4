use std::ops::Range;

use walpha_base::parallel::prelude::*;
use walpha_regular::internals::number::dot;
use walpha_regular::internals::{AXES, BitRange};

use super::InterpolateError;
use walpha_points::{SampleGrid, Units};
use walpha_volume::{Coordinates, Dims, Frame, Volume, inverse};

/// A grid of positions at which F is sampled.
///
/// Its first and last samples along each axis coincide with the first and last samples of the volume that it covers (or lie on
/// the sides of a box), and the others are at equal steps between them: the extent is that of the sample positions, and the grid
/// with a volume's own sizes is the volume's own. If an axis has a single sample, that is in the middle. Positions are rounded
/// once, so those that a double can represent are exact.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    dims: Dims,
    /// The positions along the axes: fractional indices of the volume, or coordinates in a box.
    axes: [Vec<f64>; 3],
    /// The map from these positions to the points' coordinates; `None` if they are equal.
    world: Option<World>,
    frame: Frame,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct World {
    frame: Frame,
    /// The rounded map from the world to indices, after the origin is subtracted.
    inverse: [[f64; 3]; 3],
}

impl Grid {
    /// The grid of a volume's samples.
    #[expect(clippy::missing_panics_doc, reason = "its own samples are a step apart")]
    pub fn of(volume: &Volume, units: Units) -> Self {
        Self::over(volume, volume.dims(), units).expect("as many samples as the volume has")
    }

    /// A grid of `dims` samples over the extent of a volume.
    ///
    /// # Errors
    /// [`InterpolateError::Extent`]: there are several samples along an axis with one sample in the volume.
    pub fn over(volume: &Volume, dims: Dims, units: Units) -> Result<Self, InterpolateError> {
        let samples = SampleGrid { dims: volume.dims(), frame: *volume.frame(), units };
        Self::over_samples(&samples, dims)
    }

    /// A grid of `dims` samples over the extent of the grid whose samples the points are.
    ///
    /// # Errors
    /// [`InterpolateError::Extent`]: there are several samples along an axis with one sample there.
    pub fn over_samples(samples: &SampleGrid, dims: Dims) -> Result<Self, InterpolateError> {
        let SampleGrid { dims: counts, frame: source, units } = *samples;
        let high = counts.xyz().map(|count| (count - 1) as f64);
        let (axes, step) = axes([0.0; 3], high, dims)?;
        let frame = source.part([0, 1, 2].map(|k| axes[k][0]), step);
        let world = World { frame: source, inverse: inverse(source.axes()) };
        Ok(Self { dims, axes, world: (units == Units::World).then_some(world), frame })
    }

    /// A grid of `dims` samples over a box, given by its corners (x, y, z).
    ///
    /// # Errors
    /// [`InterpolateError::Extent`]: a coordinate is not finite, the corners of the box are exchanged, or there are several
    /// samples along an axis in which it has no extent.
    pub fn spanning(low: [f64; 3], high: [f64; 3], dims: Dims) -> Result<Self, InterpolateError> {
        let (axes, spacing) = axes(low, high, dims)?;
        let origin = [0, 1, 2].map(|k| axes[k][0]);
        let coordinates = Coordinates::default();
        let frame = Frame { origin, spacing, coordinates, ..Frame::VOXEL };
        Ok(Self { dims, axes, world: None, frame })
    }

    /// The number of samples along each axis.
    pub fn dims(&self) -> Dims {
        self.dims
    }

    /// The place of the samples in the world, for files.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The position of a sample, index and position as (x, y, z), in the units of the points.
    pub fn position(&self, index: [usize; 3]) -> [f64; 3] {
        let place = [0, 1, 2].map(|k| self.axes[k][index[k]]);
        self.world.as_ref().map_or(place, |world| world.frame.to_world(place))
    }

    /// The common bits of the coordinates of all samples. O(samples) if they are those of the world; otherwise only the axes are
    /// examined.
    pub(super) fn bit_range(&self) -> BitRange {
        let [nx, ny, nz] = self.dims.xyz();
        if self.world.is_some() {
            let index = |i: usize| [i % nx, i / nx % ny, i / (nx * ny)];
            return BitRange::of_all((0..nx * ny * nz).map(|i| self.position(index(i))));
        }
        let along = |i: usize| [i.min(nx - 1), i.min(ny - 1), i.min(nz - 1)];
        BitRange::of_all((0..nx.max(ny).max(nz)).map(|i| self.position(along(i))))
    }

    /// Returns a grid of the same samples, positioned by their indices in the volume instead of in the world.
    pub(super) fn by_index(&self) -> Self {
        Self { world: None, ..self.clone() }
    }

    /// The indices of positions in the world, all of which must be samples of the volume; `None` if one is not a sample, or
    /// positions are indices already.
    pub(super) fn indices(&self, positions: &[[f64; 3]]) -> Option<Vec<[f64; 3]>> {
        let world = self.world.as_ref()?;
        let index = |&position: &[f64; 3]| {
            let index = world.index(position).map(f64::round);
            (world.frame.to_world(index) == position).then_some(index)
        };
        positions.par_iter().map(index).collect()
    }

    /// Whether a cell that is positively oriented in the world is negatively oriented in indices.
    pub(super) fn is_mirrored(&self) -> bool {
        self.world.as_ref().is_some_and(|World { frame, .. }| frame.is_mirrored())
    }

    /// The fractional index of a position, rounded.
    pub(super) fn index(&self, position: [f64; 3]) -> [f64; 3] {
        let place = match &self.world {
            None => position,
            Some(world) => world.index(position),
        };
        [0, 1, 2].map(|k| {
            let axis = &self.axes[k];
            let (first, last) = (axis[0], axis[axis.len() - 1]);
            let step = if last > first { (last - first) / (axis.len() - 1) as f64 } else { 1.0 };
            (place[k] - first) / step
        })
    }

    /// The indices along an axis from one fractional index to another; all if these are not finite.
    pub(super) fn range(&self, axis: usize, low: f64, high: f64) -> Range<usize> {
        let n = self.dims.xyz()[axis];
        if !(low.is_finite() && high.is_finite()) {
            return 0..n;
        }
        let (low, high) = (low.ceil().max(0.0), (high.floor() + 1.0).clamp(0.0, n as f64));
        low as usize..high as usize
    }
}

impl World {
    /// The fractional index of a position in the volume, rounded.
    fn index(&self, position: [f64; 3]) -> [f64; 3] {
        let from = [0, 1, 2].map(|k| position[k] - self.frame.origin[k]);
        self.inverse.map(|row| dot(&row, &from))
    }
}

/// The simplex number of a sample outside the shape.
pub(super) const OUTSIDE: u32 = u32::MAX;

/// The positions along each axis, and the distances between neighbours.
fn axes(
    low: [f64; 3],
    high: [f64; 3],
    dims: Dims,
) -> Result<([Vec<f64>; 3], [f64; 3]), InterpolateError> {
    let n = dims.xyz();
    for k in 0..3 {
        let step = step(low[k], high[k], n[k]);
        let apart = n[k] == 1 || (step > 0.0 && low[k] + step > low[k] && high[k] - step < high[k]);
        if !(low[k] <= high[k] && (high[k] - low[k]).is_finite() && apart) {
            let (axis, samples, low, high) = (AXES[k], n[k], low[k], high[k]);
            return Err(InterpolateError::Extent { axis, samples, low, high });
        }
    }
    let positions = [0, 1, 2].map(|k| steps(low[k], high[k], n[k]));
    Ok((positions, [0, 1, 2].map(|k| step(low[k], high[k], n[k]))))
}

/// `n` numbers at equal steps from the first to the last; the middle if `n` is 1.
fn steps(first: f64, last: f64, n: usize) -> Vec<f64> {
    if n == 1 {
        return vec![first / 2.0 + last / 2.0];
    }
    let whole = (n - 1) as f64;
    let at = |i: usize| if i + 1 == n { last } else { first + i as f64 * (last - first) / whole };
    (0..n).map(at).collect()
}

/// The distance between neighbours of [`steps`]; for one position, the extent, or 1 if there is none.
fn step(first: f64, last: f64, n: usize) -> f64 {
    let length = if n > 1 || last > first { last - first } else { 1.0 };
    length / (n - 1).max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array3;

    #[test]
    fn grids_reach_from_the_first_to_the_last_sample() {
        let frame = Frame { origin: [10.0, 0.0, -4.0], spacing: [0.5, 2.0, 3.0], ..Frame::VOXEL };
        let volume = Volume::new(Array3::zeros((5, 4, 3)), frame).unwrap();
        let own = Grid::of(&volume, Units::Voxel);
        assert_eq!((own.frame(), own.position([2, 3, 4])), (&frame, [2.0, 3.0, 4.0]));

        let dims = Dims::new(5, 1, 9).unwrap();
        let finer = Grid::over(&volume, dims, Units::Voxel).unwrap();
        assert_eq!(finer.position([1, 0, 8]), [0.5, 1.5, 4.0]);
        let world = Grid::over(&volume, dims, Units::World).unwrap();
        assert_eq!(world.position([1, 0, 8]), [10.25, 3.0, 8.0]);
        assert_eq!(world.frame().spacing, [0.25, 6.0, 1.5]);
        assert_eq!(world.frame().to_world([1.0, 0.0, 8.0]), [10.25, 3.0, 8.0]);
        for (grid, index) in [(&finer, [1, 0, 8]), (&world, [3, 0, 2])] {
            let back = grid.index(grid.position(index));
            assert!((0..3).all(|k| (back[k] - index[k] as f64).abs() < 1e-12), "{back:?}");
        }
        assert_eq!(finer.range(2, -0.5, 2.5), 0..3);
        assert_eq!(finer.range(2, 7.5, 99.0), 8..9);
        assert!(finer.range(2, -9.0, -0.5).is_empty());
    }

    #[test]
    fn a_box_is_spanned_from_corner_to_corner() {
        let dims = Dims::new(2, 3, 1).unwrap();
        let grid = Grid::spanning([1.0, 2.0, 3.0], [2.0, 4.0, 3.0], dims).unwrap();
        assert_eq!(grid.position([1, 1, 0]), [2.0, 3.0, 3.0]);
        assert_eq!(grid.frame().spacing, [1.0, 1.0, 1.0]);
    }

    #[test]
    fn samples_are_a_step_apart() {
        let dims = Dims::new(2, 1, 2).unwrap();
        let of = |low: [f64; 3], high: [f64; 3]| match Grid::spanning(low, high, dims) {
            Ok(_) => None,
            Err(InterpolateError::Extent { axis, .. }) => Some(axis),
            Err(other) => panic!("{other}"),
        };
        let (nan, inf) = (f64::NAN, f64::INFINITY);
        assert_eq!(of([0.0; 3], [1.0, 0.0, 1.0]), None);
        assert_eq!(of([0.0; 3], [1.0, 1.0, 0.0]), Some('z'));
        assert_eq!(of([1.0; 3], [0.0, 1.0, 2.0]), Some('x'));
        assert_eq!(of([0.0; 3], [1.0, -1.0, 1.0]), Some('y'));
        assert_eq!(of([0.0, nan, 0.0], [1.0; 3]), Some('y'));
        assert_eq!(of([0.0; 3], [1.0, 1.0, inf]), Some('z'));
        assert_eq!(of([-1e308, 0.0, 0.0], [1e308, 0.0, 1.0]), Some('x'));
        // No double is between these two.
        let three = Dims::new(3, 1, 1).unwrap();
        assert!(Grid::spanning([1.0, 0.0, 0.0], [1f64.next_up(), 0.0, 0.0], three).is_err());
        let flat = Volume::new(Array3::zeros((1, 4, 3)), Frame::VOXEL).unwrap();
        let over = |z| Grid::over(&flat, Dims::new(3, 4, z).unwrap(), Units::World);
        assert!(
            over(1).is_ok() && matches!(over(2), Err(InterpolateError::Extent { axis: 'z', .. }))
        );
    }
}
