//! What compressors of volumes make of the skull: constants, because they are not part of this program; and
//! what our own slowest choice of points makes of it, which takes longer than the report may.
//!
//! `benches/race_compressors.py sample:skull` measures all of them again.

/// The day of the measurement.
pub(super) const DATE: &str = "2026-11-22";

/// What a compressor makes of `sample:skull`, of gray levels 0..255 as `f32`.
pub(super) struct Compressor {
    /// Its name.
    pub name: &'static str,
    /// RMSE in gray levels, and bits per sample; from small errors to large ones.
    pub curve: &'static [[f64; 2]],
}

/// Those raced; of two builds of one the better.
pub(super) const SKULL: [Compressor; 6] = [
    Compressor {
        name: "walpha .wvm, exchanged and fitted",
        curve: &[
            [0.960, 0.6999],
            [1.268, 0.5110],
            [2.005, 0.2820],
            [2.633, 0.1780],
            [3.803, 0.0983],
            [5.569, 0.0542],
            [8.125, 0.0298],
        ],
    },
    Compressor {
        name: "SPERR",
        curve: &[
            [0.370, 0.7614],
            [0.484, 0.6208],
            [0.631, 0.5023],
            [0.823, 0.4018],
            [1.068, 0.3148],
            [1.356, 0.2437],
            [1.703, 0.1884],
            [2.160, 0.1447],
            [2.708, 0.1120],
            [3.372, 0.0846],
            [4.170, 0.0656],
            [5.261, 0.0517],
            [6.622, 0.0404],
        ],
    },
    Compressor {
        name: "TTHRESH",
        curve: &[
            [0.408, 0.7574],
            [0.588, 0.5938],
            [0.837, 0.4442],
            [1.354, 0.3101],
            [2.147, 0.2357],
            [3.055, 0.1817],
            [4.900, 0.1360],
            [7.036, 0.1080],
            [11.298, 0.0801],
        ],
    },
    Compressor {
        name: "zfp",
        curve: &[
            [0.340, 1.2567],
            [0.609, 0.9281],
            [1.061, 0.6664],
            [1.819, 0.4737],
            [3.043, 0.3372],
            [5.056, 0.2442],
        ],
    },
    Compressor {
        name: "SZ3",
        curve: &[
            [0.344, 1.5248],
            [0.669, 0.9960],
            [0.926, 0.8983],
            [1.307, 0.7422],
            [1.772, 0.5882],
            [2.500, 0.4305],
            [2.680, 0.2901],
            [3.680, 0.2373],
            [5.068, 0.2175],
            [6.555, 0.1318],
            [9.481, 0.0886],
            [11.506, 0.0517],
        ],
    },
    Compressor {
        name: "JPEG 2000, by slices",
        curve: &[
            [0.317, 2.1023],
            [0.683, 1.5265],
            [1.499, 1.1123],
            [3.344, 0.8242],
            [9.682, 0.6171],
        ],
    },
];
