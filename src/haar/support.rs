//! One axis of the Haar basis on a row of any length.
//!
//! At the level of stride s = 2ˡ a row of n samples is n/2ˡ means, rounded up, at the multiples
//! of s. The mean at i stands for a *support* of min(s, n − i) samples. The step joins the means
//! at i = 2ks and i + s, of supports a and b, values p and q:
//!
//! ```text
//! mean   m = p − (p − q)·b/(a + b)      to i
//! detail d = p − q                      to i + s
//! ```
//!
//! Times √(a + b) and √(ab/(a + b)) these are the unbalanced Haar step on the orthonormal values
//! √a·p and √b·q: average (√a·√a·p + √b·√b·q)/√(a + b), detail (√b·√a·p − √a·√b·q)/√(a + b). For
//! a = b it is the common Haar step. Working on means keeps all numbers in the range of the samples, and
//! makes the details of a constant row exactly 0.

/// The share of the second mean in the joint one, b/(a + b).
pub(super) fn share(n: usize, stride: usize, second: usize) -> f32 {
    let b = stride.min(n - second);
    (b as f64 / (stride + b) as f64) as f32
}

/// The norm of the function whose coefficient is the raw value at `i` after the level of
/// `stride`: √(a + b) at a mean, √(ab/(a + b)) at a detail.
pub(super) fn norm(n: usize, stride: usize, i: usize) -> f64 {
    if i.is_multiple_of(2 * stride) {
        ((2 * stride).min(n - i) as f64).sqrt()
    } else {
        let (a, b) = (stride as f64, stride.min(n - i) as f64);
        (a * b / (a + b)).sqrt()
    }
}

/// The strides of all levels of a row of n samples: 1, 2, 4, … below n.
pub(super) fn strides(n: usize) -> impl DoubleEndedIterator<Item = usize> {
    (0..n.next_power_of_two().trailing_zeros()).map(|level| 1 << level)
}

/// Steps a row forward.
pub(super) fn forward_row(row: &mut [f32], stride: usize) {
    let n = row.len();
    if stride == 1 {
        let (pairs, _) = row.as_chunks_mut::<2>();
        for [p, q] in pairs {
            join(p, q, 0.5);
        }
    } else {
        for i in (0..n.saturating_sub(stride)).step_by(2 * stride) {
            let (mut p, mut q) = (row[i], row[i + stride]);
            join(&mut p, &mut q, share(n, stride, i + stride));
            (row[i], row[i + stride]) = (p, q);
        }
    }
}

/// Steps a row back.
pub(super) fn inverse_row(row: &mut [f32], stride: usize) {
    let n = row.len();
    if stride == 1 {
        let (pairs, _) = row.as_chunks_mut::<2>();
        for [p, q] in pairs {
            part(p, q, 0.5);
        }
    } else {
        for i in (0..n.saturating_sub(stride)).step_by(2 * stride) {
            let (mut p, mut q) = (row[i], row[i + stride]);
            part(&mut p, &mut q, share(n, stride, i + stride));
            (row[i], row[i + stride]) = (p, q);
        }
    }
}

/// Joins two rows sample by sample, at each `stride`-th, where the second has this share.
pub(super) fn forward_rows(first: &mut [f32], second: &mut [f32], stride: usize, share: f32) {
    each_pair(first, second, stride, |p, q| join(p, q, share));
}

/// Parts two rows sample by sample.
pub(super) fn inverse_rows(first: &mut [f32], second: &mut [f32], stride: usize, share: f32) {
    each_pair(first, second, stride, |p, q| part(p, q, share));
}

#[inline(always)]
fn each_pair(a: &mut [f32], b: &mut [f32], stride: usize, step: impl Fn(&mut f32, &mut f32)) {
    let pairs = a.iter_mut().zip(b);
    // Told apart so that the dense case is vectorised.
    if stride == 1 {
        pairs.for_each(|(p, q)| step(p, q));
    } else {
        pairs.step_by(stride).for_each(|(p, q)| step(p, q));
    }
}

#[inline(always)]
fn join(p: &mut f32, q: &mut f32, share: f32) {
    let detail = *p - *q;
    *p -= detail * share;
    *q = detail;
}

#[inline(always)]
fn part(p: &mut f32, q: &mut f32, share: f32) {
    let detail = *q;
    *p += detail * share;
    *q = *p - detail;
}
