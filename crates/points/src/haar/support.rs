//! One axis of the Haar basis on a row of any length.
//!
//! At the level of stride s = 2ˡ a row of n samples is n/2ˡ sums, rounded up, at the multiples
//! of s. The sum at i has a *support* of min(s, n − i) samples. The step joins the sums at i = 2ks
//! and i + s, of supports a and b with greatest common divisor g, values p and q:
//!
//! ```text
//! sum    m = p + q                  to i
//! detail d = (b·p − a·q)/g          to i + s
//! ```
//!
//! Over √(a + b) and √(ab(a + b))/g these are the unbalanced Haar step on the orthonormal values
//! p/√a and q/√b: average (√a·p/√a + √b·q/√b)/√(a + b), detail (√b·p/√a − √a·q/√b)/√(a + b). For
//! a = b it is the common Haar step. Sums and details of whole numbers are whole numbers, so equal
//! coefficients are equal, and those that are 0 are exactly 0, as long as these stay below 2⁵³.

/// How the second of two neighbouring sums joins the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    /// b/g and a/g.
    of_first: f64,
    of_second: f64,
}

impl Step {
    /// The step for supports of equal size.
    const EVEN: Self = Self { of_first: 1.0, of_second: 1.0 };

    /// The step at `stride` in a row of n samples, for the pair whose second sum is at `second`.
    pub(super) fn of(n: usize, stride: usize, second: usize) -> Self {
        let (a, b) = (stride, stride.min(n - second));
        let g = common_divisor(a, b);
        Self { of_first: (b / g) as f64, of_second: (a / g) as f64 }
    }
}

/// The greatest common divisor of a power of two and a nonzero number.
fn common_divisor(power: usize, number: usize) -> usize {
    power.min(1 << number.trailing_zeros())
}

/// The square of the divisor that makes the raw value at `i`, after the level of `stride`, an orthonormal coefficient: a + b for
/// a sum, ab(a + b)/g² for a detail. It is a whole number, so that products over axes do not depend on their order.
pub(super) fn square(n: usize, stride: usize, i: usize) -> f64 {
    if i.is_multiple_of(2 * stride) {
        (2 * stride).min(n - i) as f64
    } else {
        let (a, b) = (stride, stride.min(n - i));
        let g = common_divisor(a, b);
        (a / g) as f64 * (b / g) as f64 * (a + b) as f64
    }
}

/// The strides of all levels of a row of n samples: 1, 2, 4, … below n.
pub(super) fn strides(n: usize) -> impl DoubleEndedIterator<Item = usize> {
    (0..n.next_power_of_two().trailing_zeros()).map(|level| 1 << level)
}

/// A row of sums. Each is that of `unit` of the `n` samples, except the last, which has the remaining ones.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub n: usize,
    pub unit: usize,
}

impl Axis {
    /// A row of samples.
    pub(super) fn of_samples(n: usize) -> Self {
        Self { n, unit: 1 }
    }

    /// The step at `stride` for the pair whose second sum is at `second`, both counted in sums of the row.
    pub(super) fn step(self, stride: usize, second: usize) -> Step {
        Step::of(self.n, stride * self.unit, second * self.unit)
    }

    /// The [`square`] at `i`; both are counted in sums of the row.
    pub(super) fn square(self, stride: usize, i: usize) -> f64 {
        square(self.n, stride * self.unit, i * self.unit)
    }
}

/// Transforms one level of a row.
pub(super) fn forward_row(row: &mut [f64], axis: Axis, stride: usize) {
    each_step(row, axis, stride, join);
}

/// Inverts one level of a row.
pub(super) fn inverse_row(row: &mut [f64], axis: Axis, stride: usize) {
    each_step(row, axis, stride, part);
}

#[inline(always)]
fn each_step(row: &mut [f64], axis: Axis, stride: usize, work: impl Fn(&mut f64, &mut f64, Step)) {
    if stride * axis.unit == 1 {
        let (pairs, _) = row.as_chunks_mut::<2>();
        for [p, q] in pairs {
            work(p, q, Step::EVEN);
        }
    } else {
        for i in (0..row.len().saturating_sub(stride)).step_by(2 * stride) {
            let (mut p, mut q) = (row[i], row[i + stride]);
            work(&mut p, &mut q, axis.step(stride, i + stride));
            (row[i], row[i + stride]) = (p, q);
        }
    }
}

/// Joins two rows sample by sample, at every `stride`-th sample.
pub(super) fn forward_rows(first: &mut [f64], second: &mut [f64], stride: usize, step: Step) {
    each_pair(first, second, stride, step, join);
}

/// Separates two rows sample by sample, at every `stride`-th sample: the inverse of [`forward_rows`].
pub(super) fn inverse_rows(first: &mut [f64], second: &mut [f64], stride: usize, step: Step) {
    each_pair(first, second, stride, step, part);
}

#[inline(always)]
fn each_pair(
    a: &mut [f64],
    b: &mut [f64],
    stride: usize,
    step: Step,
    work: impl Fn(&mut f64, &mut f64, Step),
) {
    let pairs = a.iter_mut().zip(b);
    // The cases are separate so that the dense and even one is vectorised, without divisions.
    if stride > 1 {
        pairs.step_by(stride).for_each(|(p, q)| work(p, q, step));
    } else if step == Step::EVEN {
        pairs.for_each(|(p, q)| work(p, q, Step::EVEN));
    } else {
        pairs.for_each(|(p, q)| work(p, q, step));
    }
}

#[inline(always)]
fn join(p: &mut f64, q: &mut f64, Step { of_first, of_second }: Step) {
    (*p, *q) = (*p + *q, of_first * *p - of_second * *q);
}

#[inline(always)]
fn part(p: &mut f64, q: &mut f64, Step { of_first, of_second }: Step) {
    let (sum, detail, whole) = (*p, *q, of_first + of_second);
    *p = (of_second * sum + detail) / whole;
    *q = (of_first * sum - detail) / whole;
}
