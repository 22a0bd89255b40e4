//! Codes whole numbers at the voxels of points, as differences from a prediction.

use super::blocks::{Blocks, Cell, SIDE, Shape, Window, bit_of, squared};
use super::coder::Coder;
use super::mixer::Mixer;
use super::predict::{Guess, Known};

/// Differences up to this are coded in unary.
const COUNTED: u64 = 12;

/// Codes values from 0 to 2³² − 1, layer by layer, in the order of the voxels.
pub(super) struct Values {
    shape: Shape,
    known: Known,
    small: Mixer,
    large: Mixer,
    density: Window,
}

/// The data that the contexts of all bits of one value share.
struct ValueContext {
    /// The expected value, rounded, and the quarter of the rounding interval that it was in.
    expected: u64,
    quarter: usize,
    /// A logarithm of the spread, from 0 to 23.
    spread: usize,
    level: usize,
    distance: usize,
    /// Other estimates as differences from the expected value, clamped to ±6, plus 6.
    others: [usize; 4],
    density: usize,
}

impl Values {
    /// A coder for a grid without known values.
    pub(super) fn new(voxels: Cell) -> Self {
        Self {
            shape: Shape::new(voxels),
            known: Known::default(),
            small: Mixer::new(7, 25, 160.0, 0.015),
            large: Mixer::new(1, 1, 60.0, 0.02),
            density: Window::new(|step| squared(step) <= 6),
        }
    }

    /// Codes the values at some voxels, in order, and returns them. `occupied` are all voxels that have
    /// points. A decoder passes no `values`. `None` if a stream holds a value out of range.
    pub(super) fn code(
        &mut self,
        coder: &mut impl Coder,
        voxels: &[Cell],
        occupied: &Blocks,
        values: &[u32],
    ) -> Option<Vec<u32>> {
        let mut coded = Vec::new();
        for (k, &voxel) in voxels.iter().enumerate() {
            let context = self.context(voxel, occupied);
            let value = self.value(coder, &context, values.get(k).map_or(0, |&v| v.into()))?;
            self.known.add(&self.shape, voxel, value);
            coded.push(value);
        }
        Some(coded)
    }

    fn context(&self, voxel: Cell, occupied: &Blocks) -> ValueContext {
        let Guess { value, spread, squared, others } = self.known.guess(&self.shape, voxel);
        let expected = (value + 0.5) as u64;
        let offset = |other: f64| (other - expected as f64).round().clamp(-6.0, 6.0) as i64 + 6;
        let block = voxel.map(|v| v / SIDE);
        let around = occupied.around(&self.shape, block);
        ValueContext {
            expected,
            quarter: ((value + 0.5 - expected as f64) * 4.0).clamp(0.0, 3.0) as usize,
            spread: logarithm(spread + 0.3),
            level: expected.min(63) as usize,
            distance: squared.min(12.0) as usize,
            others: others.map(|other| offset(other) as usize),
            density: self.density.count(&around, bit_of(voxel)),
        }
    }

    fn value(&mut self, coder: &mut impl Coder, context: &ValueContext, value: u64) -> Option<u32> {
        let expected = context.expected;
        let mut bit = |this: &mut Self, node: usize, bit: bool| {
            this.small.code(coder, &context.contexts(node), node.min(24), bit)
        };
        if !bit(self, 0, value != expected) {
            return u32::try_from(expected).ok();
        }
        // Values are not negative: if 0 is expected, the sign is known.
        let above = expected == 0 || bit(self, 1, value > expected);
        let (size, most) = (value.abs_diff(expected), if above { u64::MAX } else { expected });
        let mut counted = 1;
        while counted < most {
            let node = 2 + 2 * (counted - 1) as usize + usize::from(above);
            if !bit(self, node, size > counted) {
                break;
            }
            counted += 1;
            if counted > COUNTED {
                // This is the part beyond the unary code.
                let rest = size.saturating_sub(counted);
                counted += self.large.number(coder, context.spread, rest)?;
                break;
            }
        }
        let value =
            if above { expected.checked_add(counted) } else { expected.checked_sub(counted) };
        u32::try_from(value?).ok()
    }
}

/// Twice the binary logarithm, rounded down, plus 4, limited to 0 to 23.
fn logarithm(number: f64) -> usize {
    let exponent = (number.to_bits() >> 52) as i64 - 1023;
    let mantissa = f64::from_bits((number.to_bits() & ((1 << 52) - 1)) | (1023 << 52));
    let half = i64::from(mantissa * mantissa >= 2.0);
    (2 * exponent + half + 4).clamp(0, 23) as usize
}

impl ValueContext {
    fn contexts(&self, node: usize) -> [usize; 7] {
        let Self { quarter, spread, level, distance, density, .. } = *self;
        let [nearest, next, wide, plane] = self.others;
        let with = |context: usize| node + 26 * context;
        [
            with(spread + 24 * quarter),
            with(spread + 24 * (level / 4)),
            with(level + 64 * distance),
            with(nearest + 13 * next),
            with(wide + 13 * (plane + 13 * (spread / 2))),
            with(density + 81 * (spread / 2)),
            with(density / 8 + 11 * (level / 4 + 16 * nearest)),
        ]
    }
}
