//! Prediction of the value at a voxel from known values around it.
//!
//! Sums are in the order of the neighbours, and only +, −, ×, ÷ and √ are used, so that every machine makes the
//! same prediction, bit for bit.

use std::collections::HashMap;

use super::blocks::{Cell, SIDE, Shape, bit_of, place_in_block, squared, steps};

/// The maximum number of known values in a prediction.
const NEIGHBOURS: usize = 14;

/// The number of these in the first estimate.
const NEAR: usize = 8;

/// The maximum number of rings of blocks that are searched for neighbours.
const RINGS: i32 = 3;

/// The values known so far, by block: the bit of each voxel, and its value.
#[derive(Debug, Default)]
pub(super) struct Known(HashMap<u32, Vec<(u8, u32)>>);

/// A known value, and its step from the voxel.
#[derive(Clone, Copy)]
struct Neighbour {
    step: [i32; 3],
    squared: f64,
    value: f64,
}

/// The prediction at a voxel.
pub(super) struct Guess {
    /// The expected value.
    pub value: f64,
    /// The standard deviation of the near neighbours, weighted like their mean.
    pub spread: f64,
    /// The squared distance of the nearest known value.
    pub squared: f64,
    /// Other estimates: the nearest value, the second nearest, a mean of all neighbours, and a plane.
    pub others: [f64; 4],
}

impl Known {
    /// Adds a value.
    pub(super) fn add(&mut self, shape: &Shape, voxel: Cell, value: u32) {
        let block = shape.number(voxel.map(|v| v / SIDE));
        self.0.entry(block).or_default().push((bit_of(voxel) as u8, value));
    }

    /// The nearest known values, from the blocks around and from further rings of blocks until there are enough. The nearest come
    /// first, with ties in the order of z, then y, then x.
    fn near(&self, shape: &Shape, voxel: Cell) -> Vec<Neighbour> {
        let block = voxel.map(|v| v / SIDE);
        let mut found = Vec::new();
        for ring in 1..=RINGS {
            let inner = |step: &[i32; 3]| ring > 1 && step.iter().all(|s| s.abs() < ring);
            for step in steps(ring).filter(|step| !inner(step)) {
                let Some(there) = Shape::offset(block, step, shape.blocks) else { continue };
                let Some(values) = self.0.get(&shape.number(there)) else { continue };
                found.extend(values.iter().map(|&(bit, value)| {
                    let place = place_in_block(bit.into());
                    let step = [0, 1, 2]
                        .map(|k| (place[k] + SIDE * there[k]).wrapping_sub(voxel[k]).cast_signed());
                    Neighbour { step, squared: squared(step).into(), value: value.into() }
                }));
            }
            if found.len() >= NEIGHBOURS {
                break;
            }
        }
        let order = |n: &Neighbour| (n.squared as i64, n.step[2], n.step[1], n.step[0]);
        if found.len() > NEIGHBOURS {
            found.select_nth_unstable_by_key(NEIGHBOURS, order);
            found.truncate(NEIGHBOURS);
        }
        found.sort_unstable_by_key(order);
        found
    }

    /// Predicts the value at a voxel.
    pub(super) fn guess(&self, shape: &Shape, voxel: Cell) -> Guess {
        let all = self.near(shape, voxel);
        let Some(nearest) = all.first() else {
            return Guess { value: 0.0, spread: 64.0, squared: 99.0, others: [0.0; 4] };
        };
        let near = &all[..all.len().min(NEAR)];
        let cubed = |n: &Neighbour| 1.0 / (n.squared * n.squared.sqrt());
        let mean = average(near, cubed, |n| n.value);
        let spread = average(near, cubed, |n| (n.value - mean) * (n.value - mean)).sqrt();
        let plane = mean + plane(&all, mean);
        let wide = average(&all, |n| 1.0 / n.squared, |n| n.value);
        let next = all.get(1).unwrap_or(nearest);
        Guess {
            value: f64::midpoint(mean, plane).max(0.0),
            spread,
            squared: nearest.squared,
            others: [nearest.value, next.value, wide, plane],
        }
    }
}

fn average(
    near: &[Neighbour],
    weight: impl Fn(&Neighbour) -> f64,
    quantity: impl Fn(&Neighbour) -> f64,
) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for n in near {
        sum += weight(n) * quantity(n);
        total += weight(n);
    }
    sum / total
}

/// The height above the mean, at the voxel, of a plane fitted to the neighbours: least squares with weights 1/d², regularised by
/// 1 for slopes and by 0.05 for the height, solved by elimination in the order of the columns.
fn plane(near: &[Neighbour], mean: f64) -> f64 {
    let mut rows = [[0.0; 5]; 4];
    for n in near {
        let [x, y, z] = n.step.map(f64::from);
        let line = [1.0, x, y, z, n.value - mean];
        for (row, a) in rows.iter_mut().zip(line) {
            for (sum, b) in row.iter_mut().zip(line) {
                *sum += a * b / n.squared;
            }
        }
    }
    for (k, row) in rows.iter_mut().enumerate() {
        row[k] += if k == 0 { 0.05 } else { 1.0 };
    }
    for k in 0..4 {
        let pivot = rows[k][k];
        rows[k].iter_mut().for_each(|v| *v /= pivot);
        let chosen = rows[k];
        for (_, row) in rows.iter_mut().enumerate().filter(|(other, _)| *other != k) {
            let factor = row[k];
            row.iter_mut().zip(chosen).for_each(|(v, c)| *v -= factor * c);
        }
    }
    rows[0][4]
}
