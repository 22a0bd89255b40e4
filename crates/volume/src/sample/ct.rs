//! A CT scan of the phantom.

use ndarray::Array3;
use walpha_base::parallel::prelude::*;
use walpha_base::random::Random;
use walpha_base::{Coordinates, LengthUnit, Space};

use super::phantom::{gray, position};
use crate::{Dims, Dtype, Frame, Volume};

/// The number of samples along x, y and z.
const DIMS: [u64; 3] = [128, 128, 72];
/// The spacing in mm. Slices are thicker than pixels are wide.
const SPACING: [f64; 3] = [1.75, 1.75, 3.0];
/// The cosine and sine of the tilt of the gantry by 16° around x.
const TILT: [f64; 2] = [0.96, 0.28];
/// The standard deviation of the noise, in Hounsfield units.
const NOISE: f64 = 25.0;
/// Gray levels of the phantom and their Hounsfield units, ascending, with linear interpolation in between: air, skin, the densest
/// soft tissue, bone, teeth.
const HOUNSFIELD: [[f64; 2]; 5] =
    [[0.0, -1000.0], [32.0, 20.0], [50.0, 80.0], [205.0, 900.0], [245.0, 1800.0]];

/// A head CT of the [`phantom`](super::phantom()): 128×128×72 samples in Hounsfield units, rounded to integers, with noise of 25
/// HU, of 1.75×1.75×3 mm in slices tilted by 16° around x, LPS. The bytes are the same on every machine.
#[expect(clippy::missing_panics_doc, reason = "invariants, always met")]
pub fn ct() -> Volume {
    let [x, y, z] = DIMS;
    let dims = Dims::new(x, y, z).expect("small sizes");
    let mut samples = vec![0f32; dims.samples()];
    samples.par_chunks_mut(dims.x()).enumerate().for_each(|(row, samples)| {
        let mut noise = Random::new(row as u64);
        let (y, z) = (position(row % dims.y(), dims.y()), position(row / dims.y(), dims.z()));
        for (x, sample) in samples.iter_mut().enumerate() {
            // The sum of twelve numbers has variance 1 and is nearly normal.
            let normal = (0..12).map(|_| noise.unit()).sum::<f64>() - 6.0;
            *sample =
                (hounsfield(gray([position(x, dims.x()), y, z])) + NOISE * normal).round() as f32;
        }
    });
    let [cos, sin] = TILT;
    let direction = [[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]];
    // The centre of the head is the origin.
    let half = [0, 1, 2].map(|k| 0.5 * (DIMS[k] - 1) as f64 * SPACING[k]);
    let origin = direction.map(|row| -(0..3).map(|k| row[k] * half[k]).sum::<f64>());
    let coordinates = Coordinates { space: Space::Lps, unit: LengthUnit::Millimetre };
    let frame = Frame { origin, spacing: SPACING, direction, coordinates };
    let samples = Array3::from_shape_vec(dims.shape(), samples).expect("as many as dims say");
    Volume::new(samples, frame).expect("a volume of numbers").with_dtype(Dtype::I16)
}

fn hounsfield(gray: f64) -> f64 {
    let above = HOUNSFIELD.iter().position(|point| gray < point[0]).unwrap_or(HOUNSFIELD.len());
    let above = above.clamp(1, HOUNSFIELD.len() - 1);
    let ([g0, h0], [g1, h1]) = (HOUNSFIELD[above - 1], HOUNSFIELD[above]);
    h0 + (gray - g0) / (g1 - g0) * (h1 - h0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tissues_are_where_a_scanner_would_have_them() {
        let head = ct();
        let mean = |[x, y, z]: [usize; 3]| {
            let at = |i: usize| head.samples()[[z + i / 9, y + i / 3 % 3, x + i % 3]];
            (0..27).map(|i| f64::from(at(i))).sum::<f64>() / 27.0
        };
        assert!((mean([2, 2, 2]) + 1000.0).abs() < 20.0, "air: {}", mean([2, 2, 2]));
        assert!((mean([62, 70, 45]) - 50.0).abs() < 30.0, "brain: {}", mean([62, 70, 45]));
        assert!((mean([63, 21, 7]) - 840.0).abs() < 30.0, "chin: {}", mean([63, 21, 7]));
        let (low, high) = head.value_range();
        assert!(low < -1050.0 && high > 900.0, "{low} to {high}");
        let centre = head.frame().to_world([63.5, 63.5, 35.5]);
        assert!(centre.iter().all(|x| x.abs() < 1e-9), "{centre:?}");
        // Slices lean forwards as they go up.
        let first = head.frame().to_world([0.0; 3]);
        let expected = [-111.125, -76.86, -133.355];
        assert!((0..3).all(|k| (first[k] - expected[k]).abs() < 1e-9), "{first:?}");
        assert_eq!(head.dtype(), Dtype::I16);
    }

    #[test]
    fn gray_levels_become_hounsfield_units() {
        let pairs = [(0.0, -1000.0), (16.0, -490.0), (50.0, 80.0), (205.0, 900.0), (245.0, 1800.0)];
        for (gray, expected) in pairs {
            assert!((hounsfield(gray) - expected).abs() < 1e-9, "{gray}: {}", hounsfield(gray));
        }
    }
}
