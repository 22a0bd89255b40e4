//! Finds the samples of a grid in a simplex: by rounded planes and exact tests, or in integers if the corners are samples, too.

use std::ops::Range;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

use walpha_base::memory::{NoMemory, try_with_capacity};
use walpha_base::parallel::prelude::*;
use walpha_regular::internals::number::{cross, dot};

use super::barycentric::Planes;
use super::grid::OUTSIDE;
use super::{Grid, Interpolant};

/// The minimum number of simplices in one parallel task.
pub(super) const CHUNK: usize = 32;

/// The simplex of each sample, in memory order: the first of those that contain it, or [`OUTSIDE`].
///
/// Simplices are drawn in parallel, and a sample keeps the least number written to it, which does not depend on the order of
/// writing. Rounded planes exclude most samples, so that exact tests are needed only near a simplex.
pub(super) fn owners(interpolant: &Interpolant<'_>, grid: &Grid) -> Result<Vec<u32>, NoMemory> {
    let [nx, ny, _] = grid.dims().xyz();
    let samples = grid.dims().samples();
    let mut owners = try_with_capacity(samples, || format!("sampling at {} places", grid.dims()))?;
    owners.par_extend((0..samples).into_par_iter().map(|_| AtomicU32::new(OUTSIDE)));
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
    // The conversion is in place, as both types have the same size.
    Ok(owners.into_iter().map(AtomicU32::into_inner).collect())
}

/// The margin around a simplex in which samples are tested, in samples: far larger than the rounding of indices.
const MARGIN: f64 = 1e-3;

/// A simplex with fewer samples in its box needs no planes.
const FEW: usize = 24;

/// Visits the samples in a simplex, and some near it.
fn for_each_near(grid: &Grid, corners: &[[f64; 3]], mut visit: impl FnMut([usize; 3])) {
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

/// The half-space on the inner side of a facet, extended by at most [`MARGIN`]: normal·p + offset ≥ 0.
struct Plane {
    normal: [f64; 3],
    offset: f64,
}

impl Plane {
    /// The half-space bounded by the plane through three corners, with the fourth on its inner side. It is all of space if that
    /// is not certain.
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

/// The number of samples in a row below which its ends are not searched for.
const SHORT: i64 = 8;

/// Visits the samples in a cell or on its boundary, with six times the volumes of the four cells in which the sample replaces a
/// corner, and that of the whole cell. Corners and samples are indices (x, y, z) below 2¹⁶; a cell without volume contains
/// nothing.
///
/// The shares, which are the volumes divided by the whole, are the same in any affine frame. A visit costs four additions; so
/// does a sample of the box around a small cell, and two beyond each end of the rows of a large one.
#[inline(always)]
pub(super) fn for_each_inside(
    corners: [[i64; 3]; 4],
    mut visit: impl FnMut([i64; 3], [i64; 4], i64),
) {
    let Some(Volumes { normals, origin, whole }) = Volumes::of(corners) else { return };
    let end = |k: usize, of: fn(i64, i64) -> i64| {
        corners[1..].iter().fold(corners[0][k], |so_far, corner| of(so_far, corner[k]))
    };
    let low = [0, 1, 2].map(|k| end(k, i64::min));
    let high = [0, 1, 2].map(|k| end(k, i64::max));
    let steps = normals.map(|normal| normal[0]);
    for z in low[2]..=high[2] {
        for y in low[1]..=high[1] {
            let at = |k: usize| origin[k] + normals[k][1] * y + normals[k][2] * z;
            let row = [at(0), at(1), at(2), at(3)];
            let [from, to] = if high[0] - low[0] < SHORT {
                [low[0], high[0]]
            } else {
                ends(row, steps, [low[0], high[0]])
            };
            let mut volumes = [0, 1, 2, 3].map(|k| row[k] + steps[k] * from);
            for x in from..=to {
                // No volume is negative.
                if volumes[0] | volumes[1] | volumes[2] | volumes[3] >= 0 {
                    visit([x, y, z], volumes, whole);
                }
                (0..4).for_each(|k| volumes[k] += steps[k]);
            }
        }
    }
}

/// The volumes as functions of the position: normal·p + origin.
struct Volumes {
    normals: [[i64; 3]; 4],
    origin: [i64; 4],
    whole: i64,
}

impl Volumes {
    fn of([a, b, c, d]: [[i64; 3]; 4]) -> Option<Self> {
        let from_a = |p: [i64; 3]| [0, 1, 2].map(|k| p[k] - a[k]);
        let [u, v, w] = [b, c, d].map(from_a);
        let turned = [cross(&v, &w), cross(&w, &u), cross(&u, &v)];
        let whole = dot(&u, &turned[0]);
        if whole == 0 {
            return None;
        }
        let [nb, nc, nd] = turned.map(|normal| normal.map(|x| x * whole.signum()));
        let na = [0, 1, 2].map(|k| -(nb[k] + nc[k] + nd[k]));
        let whole = whole.abs();
        let origin = [whole - dot(&na, &a), -dot(&nb, &a), -dot(&nc, &a), -dot(&nd, &a)];
        Some(Self { normals: [na, nb, nc, nd], origin, whole })
    }
}

/// The part of a row in which no volume is negative, and up to two more samples at each end.
fn ends(row: [i64; 4], steps: [i64; 4], [mut from, mut to]: [i64; 2]) -> [i64; 2] {
    for (&at, &step) in row.iter().zip(&steps) {
        // The error of rounding is far smaller than a sample.
        let zero = -(at as f64) / step as f64;
        if step > 0 {
            from = from.max(zero as i64 - 1);
        } else if step < 0 {
            to = to.min(zero as i64 + 1);
        } else if at < 0 {
            return [0, -1];
        }
    }
    [from, to]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interpolate::barycentric::coordinates;

    #[test]
    fn the_samples_that_coordinates_have() {
        let cells = [
            [[1, 0, 7], [5, 1, 0], [0, 6, 2], [3, 7, 7]],
            [[0, 0, 0], [0, 7, 0], [30, 0, 0], [3, 3, 5]],
            [[40, 1, 2], [0, 0, 0], [0, 1, 3], [20, 1, 9]],
            [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
        ];
        for cell in cells {
            let mut corners = cell.map(|corner: [i64; 3]| corner.map(|x| x as f64));
            let mut found = Vec::new();
            for_each_inside(cell, |place, volumes, whole| {
                found.push((place, volumes.map(|volume| volume as f64 / whole as f64)));
            });
            let turned = coordinates(&corners, corners[0], true).is_none();
            if turned {
                corners.swap(0, 1);
            }
            let mut wanted = Vec::new();
            for i in 0..41 * 8 * 10 {
                let place = [i % 41, i / 41 % 8, i / 328];
                if let Some(mut shares) = coordinates(&corners, place.map(|x| x as f64), true) {
                    if turned {
                        shares.swap(0, 1);
                    }
                    wanted.push((place, shares));
                }
            }
            assert!(found == wanted && found.len() >= 4, "{found:?} {wanted:?}");
        }
        for_each_inside([[0; 3], [4, 0, 0], [0, 4, 0], [4, 4, 0]], |place, _, _| {
            panic!("{place:?}")
        });
    }
}
