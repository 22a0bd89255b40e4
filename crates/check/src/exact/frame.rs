//! Weighted points relative to one of them, in each number type, and signs of formulas over them.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::number::{Approx, Binary, Bits, Number, Range, sign};

/// A point with a power weight; all four numbers finite.
#[derive(Clone, Copy, Debug, PartialEq)]
// Aligned so that no point lies on two cache lines: in random order each point is a cache miss.
#[repr(align(32))]
pub(crate) struct WeightedPoint {
    /// x, y, z.
    pub position: [f64; 3],
    /// The weight, a squared length.
    pub weight: f64,
}

impl WeightedPoint {
    /// A point without its weight: orientations must not spend digits on weights.
    pub(super) fn bare(position: [f64; 3]) -> Self {
        Self { position, weight: 0.0 }
    }
}

/// Weighted points relative to one of them, the origin p₀: the arguments of every formula.
///
/// Coordinates are integers in units of 2^c, heights in units of 2^h with h ≤ 2c. The two scales
/// are separate because the formulas are homogeneous in each, so that a lattice with arbitrary
/// doubles as weights needs few digits for its coordinates.
pub(super) struct Frame<T, const N: usize> {
    /// pᵢ − p₀.
    pub offsets: [[T; 3]; N],
    /// Lifted heights relative to the origin's: |pᵢ − p₀|² − wᵢ + w₀. Lifting about p₀ instead of
    /// zero adds an affine function to all heights, which does not change the convex hull.
    pub heights: [T; N],
    /// α + w₀, a height; 0 if no α was given.
    pub level: T,
    /// One squared coordinate unit as a height: 2^(2c − h).
    pub unit: T,
}

/// A polynomial in a frame, of which only the sign matters.
pub(super) trait Formula<const N: usize> {
    fn value<T: Number>(&self, frame: &Frame<T, N>) -> T;
}

/// The exact sign of a formula over finite doubles.
#[inline]
pub(super) fn sign_of<const N: usize>(
    formula: &impl Formula<N>,
    origin: &WeightedPoint,
    others: [&WeightedPoint; N],
    alpha: f64,
) -> Ordering {
    formula
        .value(&approx(origin, others, alpha))
        .sign()
        .unwrap_or_else(|| exact_sign_of(formula, origin, others, alpha))
}

/// The frame in doubles with error bounds; its unit is 1.
#[inline(always)]
pub(super) fn approx<const N: usize>(
    origin: &WeightedPoint,
    others: [&WeightedPoint; N],
    alpha: f64,
) -> Frame<Approx, N> {
    let point = |p: &WeightedPoint| (p.position.map(Approx::exact), Approx::exact(p.weight));
    frame(point(origin), others.map(point), Approx::exact(alpha), Approx::exact(1.0))
}

#[cold]
#[inline(never)]
fn exact_sign_of<const N: usize>(
    formula: &impl Formula<N>,
    origin: &WeightedPoint,
    others: [&WeightedPoint; N],
    alpha: f64,
) -> Ordering {
    let digits = Digits::new(origin, others, alpha);
    if digits.fit_i128(formula) {
        formula.value(&digits.small()).cmp(&0)
    } else {
        sign(&formula.value(&digits.big()))
    }
}

/// The arguments of a formula as integers in common units.
pub(super) struct Digits<const N: usize> {
    origin: ([Binary; 3], Binary),
    others: [([Binary; 3], Binary); N],
    alpha: Binary,
    lengths: Range,
    squares: Range,
    /// The unit of coordinates is two to this power.
    pub coordinate: i32,
    /// The unit of heights is two to this power, at most twice `coordinate`.
    pub height: i32,
}

impl<const N: usize> Digits<N> {
    pub(super) fn new(origin: &WeightedPoint, others: [&WeightedPoint; N], alpha: f64) -> Self {
        let decode = |p: &WeightedPoint| (p.position.map(Binary::new), Binary::new(p.weight));
        let origin = decode(origin);
        let others = others.map(decode);
        let alpha = Binary::new(alpha);
        let (mut lengths, mut squares) = (Range::EMPTY, Range::EMPTY.with(alpha));
        for (position, weight) in std::iter::once(&origin).chain(&others) {
            lengths = position.iter().fold(lengths, |range, &x| range.with(x));
            squares = squares.with(*weight);
        }
        let coordinate = lengths.unit().unwrap_or(0);
        let height = squares.unit().unwrap_or(i32::MAX).min(2 * coordinate);
        Self { origin, others, alpha, lengths, squares, coordinate, height }
    }

    fn shift(&self) -> u32 {
        (2 * self.coordinate - self.height) as u32
    }

    /// Whether an `i128` holds the formula, its intermediate results and the frame.
    fn fit_i128(&self, formula: &impl Formula<N>) -> bool {
        let length = Bits(self.lengths.bits(self.coordinate));
        let square = Bits(self.squares.bits(self.height));
        let point = ([length; 3], square);
        let bound = frame(point, [point; N], square, Bits(self.shift() + 1));
        let widest = bound.heights.iter().fold(formula.value(&bound).0, |most, h| most.max(h.0));
        widest.max(bound.level.0).max(bound.unit.0) <= Bits::I128
    }

    fn small(&self) -> Frame<i128, N> {
        let point = |(position, weight): ([Binary; 3], Binary)| {
            (position.map(|x| x.small(self.coordinate)), weight.small(self.height))
        };
        let alpha = self.alpha.small(self.height);
        frame(point(self.origin), self.others.map(point), alpha, 1 << self.shift())
    }

    pub(super) fn big(&self) -> Frame<IBig, N> {
        let point = |(position, weight): ([Binary; 3], Binary)| {
            (position.map(|x| x.big(self.coordinate)), weight.big(self.height))
        };
        let unit = IBig::ONE << self.shift() as usize;
        frame(point(self.origin), self.others.map(point), self.alpha.big(self.height), unit)
    }
}

#[inline(always)]
fn frame<T: Number, const N: usize>(
    (origin, weight): ([T; 3], T),
    others: [([T; 3], T); N],
    alpha: T,
    unit: T,
) -> Frame<T, N> {
    let offsets = std::array::from_fn(|i| -> [T; 3] {
        std::array::from_fn(|k| others[i].0[k].minus(&origin[k]))
    });
    let heights = std::array::from_fn(|i| {
        dot(&offsets[i], &offsets[i]).times(&unit).minus(&others[i].1.minus(&weight))
    });
    Frame { offsets, heights, level: alpha.plus(&weight), unit }
}

/// u · v.
#[inline(always)]
pub(super) fn dot<T: Number>(u: &[T; 3], v: &[T; 3]) -> T {
    u[0].times(&v[0]).plus(&u[1].times(&v[1])).plus(&u[2].times(&v[2]))
}

/// u × v.
#[inline(always)]
pub(super) fn cross<T: Number>(u: &[T; 3], v: &[T; 3]) -> [T; 3] {
    let minor = |i: usize, j: usize| u[i].times(&v[j]).minus(&u[j].times(&v[i]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;
    use crate::exact::formulas::{
        Power1, Power2, Power3, Power4, Radius2, Radius3, Radius4, Volume,
    };

    /// Small integers, and if `wild` their neighbours, halves, and numbers of any size.
    fn number(random: &mut Random, wild: bool) -> f64 {
        let small = random.below(9) as f64 - 4.0;
        match random.below(8) {
            _ if !wild => small,
            0 => small.next_up(),
            1 => small / 2.0,
            2 => small * 10f64.powi(random.below(400) as i32 - 250),
            3 => random.next() as f64 / 1e19,
            _ => small,
        }
    }

    /// Checks that doubles and `i128`, if they decide, agree with big integers; counts zeros, and the decisions of each.
    fn agree<const N: usize>(
        formula: &impl Formula<N>,
        random: &mut Random,
        hits: &mut [usize; 3],
    ) {
        let wild = random.below(2) == 0;
        let mut draw = || number(random, wild);
        let mut point = || WeightedPoint { position: [0; 3].map(|_| draw()), weight: draw() };
        let (origin, others) = (point(), [0; N].map(|_| point()));
        let alpha = draw();
        let digits = Digits::new(&origin, others.each_ref(), alpha);
        let truth = sign(&formula.value(&digits.big()));
        hits[0] += usize::from(truth.is_eq());
        if let Some(quick) = formula.value(&approx(&origin, others.each_ref(), alpha)).sign() {
            assert_eq!(quick, truth, "{origin:?} {others:?} {alpha}");
            hits[1] += 1;
        }
        if digits.fit_i128(formula) {
            assert_eq!(formula.value(&digits.small()).cmp(&0), truth, "{origin:?} {others:?}");
            hits[2] += 1;
        }
        assert_eq!(sign_of(formula, &origin, others.each_ref(), alpha), truth);
    }

    #[test]
    fn all_kinds_of_number_agree() {
        let mut random = Random::new(7);
        let mut hits = [[0; 3]; 8];
        for _ in 0..4000 {
            agree(&Volume, &mut random, &mut hits[0]);
            agree(&Power1, &mut random, &mut hits[1]);
            agree(&Power2, &mut random, &mut hits[2]);
            agree(&Power3, &mut random, &mut hits[3]);
            agree(&Power4, &mut random, &mut hits[4]);
            agree(&Radius2, &mut random, &mut hits[5]);
            agree(&Radius3, &mut random, &mut hits[6]);
            agree(&Radius4, &mut random, &mut hits[7]);
        }
        for [_, quick, small] in hits {
            assert!(quick > 1000 && small > 1000, "{hits:?}");
        }
    }
}
