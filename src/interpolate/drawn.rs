//! The samples in a cell whose corners are samples, too: in integers.

use walpha_regular::number::{cross, dot};

/// Below so many samples along a row its ends are not looked for.
const SHORT: i64 = 8;

/// Visits the samples in a cell or on its boundary, with six times the volumes of the cells that have the
/// sample instead of one corner, and that of the whole. Corners and samples are indices (x, y, z), below
/// 2¹⁶; a cell without volume holds nothing.
///
/// The shares, volumes over the whole, are those in any affine frame. A visit costs four additions; so
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
                // None of them has a sign.
                if volumes[0] | volumes[1] | volumes[2] | volumes[3] >= 0 {
                    visit([x, y, z], volumes, whole);
                }
                (0..4).for_each(|k| volumes[k] += steps[k]);
            }
        }
    }
}

/// Volumes as functions of the place: normal·p + origin.
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

/// The part of a row where no volume is negative, and up to two samples more at each end.
fn ends(row: [i64; 4], steps: [i64; 4], [mut from, mut to]: [i64; 2]) -> [i64; 2] {
    for (&at, &step) in row.iter().zip(&steps) {
        // Rounded by far less than a sample.
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
    use super::super::barycentric::coordinates;
    use super::*;

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
