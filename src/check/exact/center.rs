use super::WeightedPoint;
use super::formulas::{center3, center4};
use super::frame::{approx, dot};
use super::number::{Approx, Number};

/// The centre of the smallest orthogonal sphere of 1 to 4 affinely independent points, rounded,
/// and a bound on its distance from the true one; none if doubles cannot tell.
///
/// # Panics
/// If there are no points or more than 4.
pub fn center<const N: usize>(simplex: [&WeightedPoint; N]) -> Option<([f64; 3], f64)> {
    let zero = Approx::exact(0.0);
    let (twice_det_c, det) = match simplex[..] {
        [_] => ([zero; 3], Approx::exact(1.0)),
        [a, b] => {
            let frame = approx(a, [b], 0.0);
            let ([b], [h]) = (&frame.offsets, &frame.heights);
            (b.map(|x| x.times(h)), dot(b, b))
        }
        [a, b, c] => {
            let frame = approx(a, [b, c], 0.0);
            center3(frame.offsets.each_ref(), frame.heights.each_ref())
        }
        [a, b, c, d] => {
            let frame = approx(a, [b, c, d], 0.0);
            center4(frame.offsets.each_ref(), frame.heights.each_ref())
        }
        _ => panic!("a simplex has 1 to 4 vertices, not {N}"),
    };
    let (det, det_error) = det.value_and_error();
    if det.abs() <= det_error {
        return None;
    }
    let mut center = simplex[0].position;
    let mut error = 0.0;
    for (x, twice) in center.iter_mut().zip(twice_det_c) {
        let (value, value_error) = twice.value_and_error();
        let offset = value / (2.0 * det);
        *x += offset;
        // |n/d − ñ/d̃| ≤ (e_n + |ñ/d̃| e_d) / (|d̃| − e_d); the last terms are the roundings here.
        let quotient = (value_error + 2.0 * offset.abs() * det_error) / (2.0 * (det.abs() - det_error));
        error += quotient + (offset.abs() + x.abs()) * f64::EPSILON;
    }
    // The factor covers the roundings of the bound itself.
    let error = error * (1.0 + 1e-12) + f64::MIN_POSITIVE;
    error.is_finite().then_some((center, error))
}
