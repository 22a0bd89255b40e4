use std::io::{self, Write};

use super::plain::raw;
use crate::{Coordinates, Frame, LengthUnit, Space, Volume};

/// Writes a volume as NIfTI-1, or NIfTI-2 if an axis is too long for version 1. A known space becomes RAS, the coordinates of the
/// scanner; numbers in an unknown space are unchanged ("aligned"); a volume in voxels has no place. The frame is its `sform`,
/// which the `f32` of version 1 round.
///
/// # Errors
/// Errors of `out`.
pub(crate) fn nifti(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    let long = volume.dims().xyz().iter().any(|&size| size > i16::MAX as usize);
    if sform_code(volume.frame()) == ALIGNED {
        tracing::warn!(
            "NIfTI has coordinates in RAS alone: those of this volume, whose space is not known, are written unchanged, and programs \
             that work in LPS, this one too, read x and y with the opposite sign. NRRD, MetaImage and VTI leave them as they are"
        );
    }
    let frame = volume.frame().to(convention(volume.frame().coordinates));
    let header = if long { version_2(volume, &frame) } else { version_1(volume, &frame) };
    out.write_all(&header)?;
    // No extension follows.
    out.write_all(&[0; 4])?;
    raw(volume, out)
}

/// Writes a volume as [`nifti`] does, compressed with gzip.
///
/// # Errors
/// Errors of `out`.
pub(crate) fn nifti_gzip(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    let mut packed = flate2::write::GzEncoder::new(out, flate2::Compression::default());
    nifti(volume, &mut packed)?;
    packed.finish().map(drop)
}

/// `NIfTI`'s code for `float32`, and its number of bits.
const FLOAT32: [i16; 2] = [16, 32];
/// The codes for coordinates of the scanner, for those of a space that something is aligned to, and for no coordinates.
const SCANNER: i16 = 1;
const ALIGNED: i16 = 2;
const NONE: i16 = 0;
/// The magic bytes of version 2, which detect a transfer as text.
const MAGIC_2: &[u8; 8] = b"n+2\0\r\n\x1a\n";

/// RAS, in the given unit if `NIfTI` knows it, and otherwise in millimetres.
fn convention(Coordinates { unit, .. }: Coordinates) -> Coordinates {
    let unit = if unit_code(unit) == 0 { LengthUnit::Millimetre } else { unit };
    Coordinates { space: Space::Ras, unit }
}

/// The code in `xyzt_units`; 0 for a unit without a code.
fn unit_code(unit: LengthUnit) -> u8 {
    match unit {
        LengthUnit::Metre => 1,
        LengthUnit::Millimetre => 2,
        LengthUnit::Micrometre => 3,
        _ => 0,
    }
}

fn sform_code(frame: &Frame) -> i16 {
    if *frame == Frame::VOXEL {
        NONE
    } else if frame.coordinates.space.is_known() {
        SCANNER
    } else {
        ALIGNED
    }
}

fn version_1(volume: &Volume, frame: &Frame) -> Vec<u8> {
    let mut header = Header(vec![0; 348]);
    header.put(0, [348i32.to_le_bytes()]);
    header.put(40, dims(volume).map(|size| (size as i16).to_le_bytes()));
    header.put(70, FLOAT32.map(i16::to_le_bytes));
    header.put(76, pixdim(frame).map(|length| (length as f32).to_le_bytes()));
    header.put(108, [352f32, 1.0, 0.0].map(f32::to_le_bytes));
    header.put(123, [[unit_code(frame.coordinates.unit)]]);
    header.put(254, [sform_code(frame).to_le_bytes()]);
    header.put(280, sform(frame).map(|number| (number as f32).to_le_bytes()));
    header.put(344, [*b"n+1\0"]);
    header.0
}

fn version_2(volume: &Volume, frame: &Frame) -> Vec<u8> {
    let mut header = Header(vec![0; 540]);
    header.put(0, [540i32.to_le_bytes()]);
    header.put(4, [*MAGIC_2]);
    header.put(12, FLOAT32.map(i16::to_le_bytes));
    header.put(16, dims(volume).map(i64::to_le_bytes));
    header.put(104, pixdim(frame).map(f64::to_le_bytes));
    header.put(168, [544i64.to_le_bytes()]);
    header.put(176, [1f64, 0.0].map(f64::to_le_bytes));
    header.put(348, [i32::from(sform_code(frame)).to_le_bytes()]);
    header.put(500, [i32::from(unit_code(frame.coordinates.unit)).to_le_bytes()]);
    header.put(400, sform(frame).map(f64::to_le_bytes));
    header.0
}

struct Header(Vec<u8>);

impl Header {
    /// Writes numbers one after the other, from a position on.
    fn put<const B: usize, const N: usize>(&mut self, place: usize, numbers: [[u8; B]; N]) {
        self.0[place..place + B * N].copy_from_slice(numbers.as_flattened());
    }
}

/// The number of axes, followed by their sizes; those beyond the third have one sample.
fn dims(volume: &Volume) -> [i64; 8] {
    let [x, y, z] = volume.dims().xyz().map(|size| size as i64);
    [3, x, y, z, 1, 1, 1, 1]
}

/// A sign that matters only to `qform`, followed by the spacing.
fn pixdim(frame: &Frame) -> [f64; 8] {
    let [x, y, z] = frame.spacing;
    [1.0, x, y, z, 1.0, 1.0, 1.0, 1.0]
}

/// The rows of the matrix that maps indices to positions.
fn sform(frame: &Frame) -> [f64; 12] {
    let (axes, origin) = (frame.axes(), frame.origin);
    let number = |i: usize| match (i / 4, i % 4) {
        (row, 3) => origin[row],
        (row, column) => axes[column][row],
    };
    std::array::from_fn(number)
}
