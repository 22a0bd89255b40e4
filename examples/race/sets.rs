//! The sets of points.

use walpha::points::{Points, Selection, Units, difference, select, weigh};
use walpha::{Alpha, Gray, Volume, WeightedPoints, Weighting, volume};

use super::Result;

/// A set by name: `skull@N` (the skull upsampled to N³ samples) or `random@N` (N random points).
pub(super) fn weighted(set: &str, weighting: &str, alpha: f64) -> Result<WeightedPoints> {
    let weighting: Weighting = weighting.parse()?;
    let points = match set.split_once('@') {
        Some(("skull", size)) => skull(size.parse()?)?,
        Some((_, count)) => random(count.parse()?),
        None => return Err("no such set".into()),
    };
    Ok(weigh(points, weighting, Alpha::from_squared(alpha)?)?)
}

fn skull(size: usize) -> Result<Points> {
    let (skull, _) = volume::sample("sample:skull")?.into_gray(Gray::Automatic)?;
    let skull = upsampled(&skull, size)?;
    let selection = Selection::default();
    Ok(select(&skull, &skull, &difference(&skull), &selection, Units::Voxel)?)
}

/// Trilinear, the first and last samples of each axis staying where they are.
fn upsampled(volume: &Volume, size: usize) -> Result<Volume> {
    let samples = volume.samples();
    let place = |i: usize, n: usize| {
        let at = i as f64 * (n - 1) as f64 / (size - 1) as f64;
        let low = (at as usize).min(n - 2);
        (low, at - low as f64)
    };
    let [nx, ny, nz] = volume.dims().xyz();
    let upsampled = ndarray::Array3::from_shape_fn((size, size, size), |(z, y, x)| {
        let ((z, fz), (y, fy), (x, fx)) = (place(z, nz), place(y, ny), place(x, nx));
        let mut sum = 0.0;
        for (dz, wz) in [(0, 1.0 - fz), (1, fz)] {
            for (dy, wy) in [(0, 1.0 - fy), (1, fy)] {
                for (dx, wx) in [(0, 1.0 - fx), (1, fx)] {
                    sum += wz * wy * wx * f64::from(samples[[z + dz, y + dy, x + dx]]);
                }
            }
        }
        sum as f32
    });
    Ok(Volume::new(upsampled, *volume.frame())?.with_gray_levels())
}

/// Points in a cube, one in each unit of volume on average, from a fixed linear congruence.
fn random(count: usize) -> Points {
    let side = (count as f64).cbrt();
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64 * side
    };
    let positions = (0..count).map(|_| [next(), next(), next()]).collect();
    Points::new(positions)
}
