//! Where a header places samples: by `sform`, `qform` or `pixdim`.

use std::path::Path;

use super::super::described::{diagonal, frame};
use super::header::Header;
use crate::volume::{Coordinates, Frame, LengthUnit, Space, VolumeError};

impl Header {
    pub(super) fn frame(&self, path: &Path) -> Result<Frame, VolumeError> {
        let pixdim = |i: usize| self.real(76, 104, i);
        if self.code(254, 348) > 0 {
            let row = |r: usize| [0, 1, 2, 3].map(|c| self.real(280, 400, 4 * r + c));
            let rows = [row(0), row(1), row(2)];
            let column = |c: usize| [0, 1, 2].map(|r| rows[r][c]);
            let axes = [column(0), column(1), column(2)];
            return frame(path, column(3), axes, self.coordinates(Space::Ras));
        }
        // 0 stands for "unknown" in some files.
        let length = |i: usize| if pixdim(i) == 0.0 { 1.0 } else { pixdim(i).abs() };
        let spacing = [1, 2, 3].map(length);
        if self.code(252, 344) <= 0 {
            let coordinates = self.coordinates(Space::Unknown);
            let said = spacing != [1.0; 3] || coordinates.unit.is_known();
            let coordinates = if said { coordinates } else { Coordinates::VOXEL };
            return frame(path, [0.0; 3], diagonal(spacing), coordinates);
        }
        let mut imaginary = [0, 1, 2].map(|i| self.real(256, 352, i));
        let square: f64 = imaginary.iter().map(|v| v * v).sum();
        // A turn of almost 180°: rounding would speak for the real part, as in NIfTI's own library.
        let half_turn = 1.0 - square < 1e-7;
        if half_turn && square > 0.0 {
            imaginary = imaginary.map(|v| v / square.sqrt());
        }
        let a = if half_turn { 0.0 } else { (1.0 - square).sqrt() };
        let [b, c, d] = imaginary;
        let mut rotation = [
            [a * a + b * b - c * c - d * d, 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
            [2.0 * (b * c + a * d), a * a + c * c - b * b - d * d, 2.0 * (c * d - a * b)],
            [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a + d * d - b * b - c * c],
        ];
        if pixdim(0) < 0.0 {
            rotation.iter_mut().for_each(|row| row[2] = -row[2]);
        }
        let axis = |c: usize| [0, 1, 2].map(|r| rotation[r][c] * spacing[c]);
        let origin = [0, 1, 2].map(|i| self.real(268, 376, i));
        frame(path, origin, [axis(0), axis(1), axis(2)], self.coordinates(Space::Ras))
    }

    /// The unit of `xyzt_units`; a patient is measured in millimetres where it names none.
    fn coordinates(&self, space: Space) -> Coordinates {
        let code = match self.version {
            1 => self.at::<1>(123, 0)[0],
            _ => self.at::<4>(0, 500)[0],
        };
        let unit = match code & 7 {
            1 => LengthUnit::Metre,
            2 => LengthUnit::Millimetre,
            3 => LengthUnit::Micrometre,
            _ if space.is_known() => LengthUnit::Millimetre,
            _ => LengthUnit::Unstated,
        };
        Coordinates { space, unit }
    }
}
