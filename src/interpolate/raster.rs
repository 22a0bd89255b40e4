//! To which simplex each sample of a grid belongs.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use rayon::prelude::*;
use walpha_base::memory::{NoMemory, try_with_capacity};

use super::barycentric::Planes;
use super::{Grid, Interpolant};

/// What a sample outside the shape belongs to.
pub(super) const NOTHING: u32 = u32::MAX;

/// Simplices rasterised as one piece of work, at least.
pub(super) const CHUNK: usize = 32;

/// The simplex each sample belongs to, in memory order: the first of those that hold it, or
/// [`NOTHING`].
///
/// Simplices are drawn in parallel, and a sample keeps the least number written to it, which does
/// not depend on who comes first. Exact tests are spent on the samples near a simplex only, as
/// rounded planes decide.
pub(super) fn owners(interpolant: &Interpolant<'_>, grid: &Grid) -> Result<Vec<u32>, NoMemory> {
    let [nx, ny, _] = grid.dims().xyz();
    let samples = grid.dims().samples();
    let mut owners = try_with_capacity(samples, || format!("sampling at {} places", grid.dims()))?;
    owners.par_extend((0..samples).into_par_iter().map(|_| AtomicU32::new(NOTHING)));
    let exact = interpolant.bit_range().with_all(grid.bit_range()).is_exact();
    (0..interpolant.len() as u32).into_par_iter().with_min_len(CHUNK).for_each(|part| {
        let (corners, count) = interpolant.corners(part);
        let planes = if exact && count == 4 { Planes::of(corners) } else { None };
        for_each_near(grid, &corners[..count], |index| {
            let owner = &owners[index[0] + nx * (index[1] + ny * index[2])];
            if owner.load(Relaxed) < part {
                return;
            }
            let place = grid.position(index);
            let shares = match &planes {
                Some(planes) => planes.shares(place),
                None => interpolant.coordinates(part, place),
            };
            if shares.is_some() {
                owner.fetch_min(part, Relaxed);
            }
        });
    });
    // In place, as both are of one size.
    Ok(owners.into_iter().map(AtomicU32::into_inner).collect())
}

/// How far, in samples, one looks beyond a simplex: far more than indices are rounded by.
const MARGIN: f64 = 1e-3;

/// Below so many samples in its box a simplex needs no planes.
const FEW: usize = 24;

/// Visits the samples in a simplex, and some beside it.
pub(super) fn for_each_near(grid: &Grid, corners: &[[f64; 3]], mut visit: impl FnMut([usize; 3])) {
    let mut indices = [[0.0; 3]; 4];
    let indices = &mut indices[..corners.len()];
    indices.iter_mut().zip(corners).for_each(|(index, &p)| *index = grid.index(p));
    let ends = |k: usize| {
        let along = indices.iter().map(|p| p[k]);
        let low = along.clone().fold(f64::INFINITY, f64::min);
        grid.range(k, low - MARGIN, along.fold(f64::NEG_INFINITY, f64::max) + MARGIN)
    };
    let ranges = [0, 1, 2].map(ends);
    let planes = match *indices {
        [a, b, c, d] if ranges.iter().map(Range::len).product::<usize>() > FEW => {
            Some([[a, b, c, d], [b, c, d, a], [c, d, a, b], [d, a, b, c]].map(Plane::beyond))
        }
        _ => None,
    };
    let planes = planes.as_ref().map_or(&[][..], |planes| &planes[..]);
    for k in ranges[2].clone() {
        for j in ranges[1].clone() {
            for i in within(planes, grid, ranges[0].clone(), [j as f64, k as f64]) {
                visit([i, j, k]);
            }
        }
    }
}

/// The part of a row that no plane excludes.
fn within(planes: &[Plane], grid: &Grid, row: Range<usize>, [y, z]: [f64; 2]) -> Range<usize> {
    let (mut low, mut high) = (row.start as f64, row.end as f64 - 1.0);
    for Plane { normal: [slope, b, c], offset } in planes {
        let rest = b * y + c * z + offset;
        if *slope > 0.0 {
            low = low.max(-rest / slope);
        } else if *slope < 0.0 {
            high = high.min(-rest / slope);
        } else if rest < 0.0 {
            return 0..0;
        }
    }
    if low > high { 0..0 } else { grid.range(0, low - MARGIN, high + MARGIN) }
}

/// What lies on the inner side of a facet, or at most [`MARGIN`] beyond: normal·p + offset ≥ 0.
struct Plane {
    normal: [f64; 3],
    offset: f64,
}

impl Plane {
    /// The plane through three corners, the fourth on its inner side. All of space where that is
    /// not certain.
    fn beyond([a, b, c, inner]: [[f64; 3]; 4]) -> Self {
        let from_a = |p: [f64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
        let size = |v: [f64; 3]| v.iter().map(|x| x.abs()).sum::<f64>();
        let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
        let (u, v) = (from_a(b), from_a(c));
        let normal =
            [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let reach = [a, b, c, inner].map(size).iter().sum::<f64>() + 1.0;
        let slack = MARGIN * size(normal) + 1e-12 * reach * size(u) * size(v);
        let height = dot(normal, from_a(inner));
        if height.abs() <= slack {
            return Self { normal: [0.0; 3], offset: 0.0 };
        }
        let normal = normal.map(|x| if height > 0.0 { x } else { -x });
        Self { normal, offset: slack - dot(normal, a) }
    }
}
