//! What compressors of volumes make of the skull: constants, because they are no part of this program.
//!
//! `scripts/race_compressors.py sample:skull` measures them again.

/// The day of the measurement.
pub(super) const DATE: &str = "DATE_HERE";

/// What a compressor makes of `sample:skull`, of gray levels 0..255 as `f32`.
pub(super) struct Compressor {
    /// Its name.
    pub name: &'static str,
    /// RMSE in gray levels, and bits per sample; from small errors to large ones.
    pub curve: &'static [[f64; 2]],
}

/// Those raced.
pub(super) const SKULL: [Compressor; 1] = [Compressor { name: "x", curve: &[[1.0, 1.0]] }];
