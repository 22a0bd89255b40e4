//! The probability of a bit from the bits so far: adaptive probabilities under several contexts, mixed with
//! weights that are learnt as well.
//!
//! This is mixing by gradient descent on the coding cost, as in the PAQ programs (Mahoney, "Adaptive
//! weighing of context models for lossless data compression", 2005), with an algebraic link x/√(1 + x²)
//! in place of the logistic one: addition, multiplication, division and square roots give the same bits on
//! every machine.

use super::coder::{Coder, WHOLE};

/// Contexts are numbers below this.
pub(super) const CONTEXTS: usize = 1 << 16;

/// The minimum distance of a probability from 0 and from 1, in multiples of 2⁻¹⁶.
const LEAST: u32 = 16;

/// Predicts and codes bits under several contexts.
pub(super) struct Mixer {
    /// For each kind of context, one slot per context: the balance of its bits, from −1 (only 0 so far) to 1 (only 1), and their
    /// number.
    slots: Vec<[f64; 2]>,
    /// For each set of weights, one weight per input.
    weights: Vec<f64>,
    inputs: Vec<f64>,
    kinds: usize,
    /// The maximum number of bits that a slot averages over.
    memory: f64,
    /// The learning rate of the weights.
    rate: f64,
}

impl Mixer {
    /// A mixer of `kinds` kinds of contexts, with `sets` sets of weights.
    pub(super) fn new(kinds: usize, sets: usize, memory: f64, rate: f64) -> Self {
        let inputs = 2 * kinds + 1;
        Self {
            slots: vec![[0.0; 2]; kinds * CONTEXTS],
            weights: vec![0.35; sets * inputs],
            inputs: vec![0.0; inputs],
            kinds,
            memory,
            rate,
        }
    }

    /// Codes a bit under one context of each kind, with a set of weights, and learns from it.
    pub(super) fn code(
        &mut self,
        coder: &mut impl Coder,
        contexts: &[usize],
        set: usize,
        bit: bool,
    ) -> bool {
        debug_assert_eq!(contexts.len(), self.kinds);
        debug_assert!(contexts.iter().all(|&context| context < CONTEXTS), "{contexts:?}");
        let (kinds, count) = (self.kinds, self.inputs.len());
        for (kind, &context) in contexts.iter().enumerate() {
            let [balance, seen] = self.slots[kind * CONTEXTS + context];
            let input = balance / (1.0 - balance * balance).sqrt();
            self.inputs[kind] = input;
            self.inputs[kinds + kind] = 0.5 * input * (seen / (seen + 1.5));
        }
        self.inputs[2 * kinds] = 0.3;
        let weights = &mut self.weights[set * count..][..count];
        let sum: f64 = self.inputs.iter().zip(weights.iter()).map(|(x, w)| x * w).sum();
        let length = (1.0 + sum * sum).sqrt();
        let probability = 0.5 + 0.5 * (sum / length);
        let one = ((probability * f64::from(WHOLE)) as u32).clamp(LEAST, WHOLE - LEAST);
        let bit = coder.bit(one, bit);

        let (share, side) = if bit { (1.0, 1.0) } else { (0.0, -1.0) };
        let step = self.rate * 2.0 * (share - probability) / length;
        for (weight, input) in weights.iter_mut().zip(&self.inputs) {
            *weight += step * input;
        }
        for (kind, &context) in contexts.iter().enumerate() {
            let [balance, seen] = &mut self.slots[kind * CONTEXTS + context];
            *seen = (*seen + 1.0).min(self.memory);
            *balance = (*balance + (side - *balance) / (*seen + 0.6)).clamp(-0.9998, 0.9998);
        }
        bit
    }

    /// Codes a whole number in a mixer of one kind of contexts, as an Elias gamma code of the number plus 1: as
    /// many ones as it has binary digits after the first, and a zero; then these digits, at probability ½. The
    /// ones and the zero have contexts of their own for each `kind` of number. `None` for more digits than any
    /// number coded here has.
    pub(super) fn number(
        &mut self,
        coder: &mut impl Coder,
        kind: usize,
        number: u64,
    ) -> Option<u64> {
        const MOST: u32 = 40;
        let (digits, mut length) = ((number + 1).ilog2(), 0);
        while self.code(coder, &[64 * kind + length as usize], 0, length < digits) {
            length += 1;
            if length > MOST {
                return None;
            }
        }
        let digit = |so_far: u64, k: u32| {
            2 * so_far + u64::from(coder.bit(WHOLE / 2, (number + 1) >> k & 1 == 1))
        };
        Some((0..length).rev().fold(1, digit) - 1)
    }
}
