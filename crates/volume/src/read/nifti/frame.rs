//! Where a header places samples: by `sform`, `qform` or `pixdim`.

use std::path::Path;

use walpha_base::shown::{number, shown, six_digits};

use super::super::described::{diagonal, frame};
use super::header::Header;
use crate::{Coordinates, Dims, Frame, LengthUnit, Space, VolumeError};

/// Frames that place a sample further apart than this share of the shortest spacing say different things.
const APART: f64 = 0.01;

impl Header {
    /// Where the samples lie: as `sform` says, else as `qform` does. A warning says by how much these differ.
    pub(super) fn frame(&self, path: &Path, dims: Dims) -> Result<Frame, VolumeError> {
        let taken = if self.code(254, 348) > 0 { self.sform(path)? } else { self.qform(path)? };
        let unit = taken.coordinates.unit;
        if matches!(unit, LengthUnit::Metre | LengthUnit::Micrometre) {
            tracing::warn!(
                "{}: lengths are in {}, as the file states; programs that use ITK scale them to mm",
                shown(path),
                unit.symbol()
            );
        }
        if self.code(254, 348) > 0
            && self.code(252, 344) > 0
            && let Ok(other) = self.qform(path)
        {
            let apart = apart(&taken, &other, dims);
            let shortest = taken.spacing.iter().copied().fold(f64::INFINITY, f64::min);
            if apart > APART * shortest {
                tracing::warn!(
                    "{}: sform and qform place samples up to {} {} apart: sform is taken",
                    shown(path),
                    number(six_digits(apart)),
                    unit.symbol()
                );
            }
        }
        Ok(taken)
    }

    fn sform(&self, path: &Path) -> Result<Frame, VolumeError> {
        let row = |r: usize| [0, 1, 2, 3].map(|c| self.real(280, 400, 4 * r + c));
        let rows = [row(0), row(1), row(2)];
        let column = |c: usize| [0, 1, 2].map(|r| rows[r][c]);
        let axes = [column(0), column(1), column(2)];
        frame(path, column(3), axes, self.coordinates(Space::Ras))
    }

    /// As `qform` says, else as `pixdim` alone does.
    fn qform(&self, path: &Path) -> Result<Frame, VolumeError> {
        let pixdim = |i: usize| self.real(76, 104, i);
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

/// How far apart two frames place the samples of a grid at most: at one of its corners.
fn apart(one: &Frame, other: &Frame, dims: Dims) -> f64 {
    let last = dims.xyz().map(|n| n.saturating_sub(1) as f64);
    let distance = |corner: usize| {
        let index = [0, 1, 2].map(|k| if corner >> k & 1 == 1 { last[k] } else { 0.0 });
        let [a, b] = [one, other].map(|frame| frame.to_world(index));
        [0, 1, 2].map(|k| (a[k] - b[k]).powi(2)).iter().sum::<f64>().sqrt()
    };
    (0..8).map(distance).fold(0.0, f64::max)
}
