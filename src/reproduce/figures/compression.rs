//! Error against bits per sample on the skull: for compressors of volumes, as constants, because they are not part of this
//! program; and for our slowest choice of points, which takes too long for the report.
//!
//! `benches/race_compressors.py sample:skull` repeats all these measurements.

use walpha_base::Monitor;

use super::bench::Bench;
use crate::export::Scratch;
use crate::interpolate::{
    Adaptive, Deviation, Grid, Interpolant, InterpolateError, adaptive_voxels,
};
use crate::points::{
    ModelMetadata, Packing, PointOptions, PointWriter, SampleGrid, Units, WeightedPoints,
    Weighting, read_model, weigh,
};
use crate::render::{RateCurve, rate_figure};
use crate::reproduce::{Fact, Item, ReproduceError, Table, text};
use crate::shape::{Alpha, ShapeOptions, alpha_shape};
use crate::volume::{Coordinates, Volume};

/// The points of the largest model, as a share of all samples.
const MOST: f64 = 0.08;

/// The largest error of a stored value, over the RMSE of the model without rounding.
const ROUNDING: f64 = 1.5;

/// The name of our curves, or its beginning.
const OURS: &str = "walpha .wvm";

/// A model, measured as a file.
struct Measured {
    points: usize,
    bytes: usize,
    rmse: f64,
    max: f64,
}

impl Measured {
    fn bits(&self, volume: &Volume) -> f64 {
        8.0 * self.bytes as f64 / volume.dims().samples() as f64
    }
}

/// A measurement that is not in the paper: how few bytes represent the volume, compared with compressors of volumes.
pub(super) fn bytes_against_error(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let subject = bench.study.subject;
    let measured = models(subject.volume, &bench.monitor)?;
    let others: &[Compressor] = if subject.name == "sample:skull" { &SKULL } else { &[] };
    let ours = measured.iter().map(|model| [model.rmse, model.bits(subject.volume)]).collect();
    let mut curves = vec![RateCurve { name: OURS.into(), points: ours }];
    curves.extend(
        others
            .iter()
            .map(|other| RateCurve { name: other.name.into(), points: other.curve.to_vec() }),
    );
    let figure = rate_figure("Our extension. PSNR of the volume against bits per sample", &curves);
    let picture = bench.file("extension-2.png", figure.to_png()?);
    let svg = bench.file("extension-2.svg", figure.to_svg()?.into_bytes());
    let fact = |model: &Measured| {
        let label = format!("bits per sample, {} points, RMSE {:.2}", model.points, model.rmse);
        Fact::new(label, model.bits(subject.volume))
    };
    Ok(Item {
        title: "Our extension. Bytes against error".into(),
        paper:
            "Says that few points stand for the volume (6.07 %), and does not count bytes. This \
                section is not in the paper."
                .into(),
        ours: format!("{} {}", remark(others), verdict(&curves)),
        picture: Some(picture),
        files: vec![svg],
        facts: measured.iter().map(fact).collect(),
        tables: vec![model_table(&measured, subject.volume), curve_table(&curves)],
        ..Item::default()
    })
}

fn remark(others: &[Compressor]) -> String {
    let compared = if others.is_empty() {
        "Compressors were measured on sample:skull only.".to_owned()
    } else {
        format!(
            "Curves of compressors, and that of points exchanged and fitted (--exchange --refit), which take \
             longer to choose, were measured on {DATE} by benches/race_compressors.py, each in its own kind of \
             file; that of {OURS} alone is computed now."
        )
    };
    format!(
        "Points chosen where the interpolant is worst, ω = 0, written as .wvm and read back, the whole \
         file counted; F is taken over the whole volume. Values are rounded to {ROUNDING} of the RMSE at \
         most. {compared}"
    )
}

/// The verdict on our format as a way to store a volume, by the bits that each method takes at an RMSE of 2 gray levels.
fn verdict(curves: &[RateCurve]) -> String {
    const RMSE: f64 = 2.0;
    let bits = |curve: &RateCurve| Some((curve.name.clone(), read_off(&curve.points, RMSE)?));
    let (ours, others): (Vec<_>, Vec<_>) =
        curves.iter().filter_map(bits).partition(|(name, _)| name.starts_with(OURS));
    let model = "As a model of the volume it gives what compressors do not: tetrahedra, a boundary and its \
                 topology at every α, and F at any place.";
    let best = ours.iter().map(|&(_, bits)| bits).reduce(f64::min);
    let Some(best) = best.filter(|_| !others.is_empty()) else { return model.into() };
    let listed = |fewer: bool| {
        let chosen = others.iter().filter(|&&(_, bits)| (bits < best) == fewer);
        let names: Vec<String> =
            chosen.map(|(name, bits)| format!("{name} ({})", text::number(*bits))).collect();
        if names.is_empty() { "none".to_owned() } else { names.join(", ") }
    };
    let good = if others.iter().any(|&(_, bits)| bits < best) { "No" } else { "Yes" };
    format!(
        "Is a weighted alpha shape a good way to store a volume? {good}: at an RMSE of {RMSE} gray levels it \
         takes {} bits per sample at best; fewer: {}; more: {}. {model}",
        text::number(best),
        listed(true),
        listed(false),
    )
}

/// Models of an eighth, a quarter, a half and all of the points.
fn models(volume: &Volume, monitor: &Monitor) -> Result<Vec<Measured>, ReproduceError> {
    let samples = volume.dims().samples();
    let count = ((MOST * samples as f64) as u64).max(8);
    let voxels = monitor.watch(|| adaptive_voxels(volume, &Adaptive::new(count), Units::Voxel))?;
    let counts = [8, 4, 2, 1].map(|part| (voxels.len() / part).max(8).min(voxels.len()));
    let mut measured = Vec::new();
    for count in counts {
        let points = points_at(volume, &voxels[..count]);
        let Deviation { rmse: Some(rmse), .. } = deviation(volume, points.clone())? else {
            continue;
        };
        let (bytes, points) = through_file(volume, &points, ROUNDING * rmse)?;
        let Deviation { rmse: Some(rmse), max: Some(max), .. } = deviation(volume, points)? else {
            continue;
        };
        measured.push(Measured { points: count, bytes, rmse, max });
    }
    Ok(measured)
}

fn points_at(volume: &Volume, voxels: &[u32]) -> WeightedPoints {
    let value = |&voxel: &u32| f64::from(volume.as_slice()[voxel as usize]);
    let positions = voxels.iter().map(|&voxel| Units::Voxel.position(volume, voxel)).collect();
    WeightedPoints::unweighted(positions)
        .with_values(voxels.iter().map(value).collect::<Vec<_>>())
        .expect("a value for each voxel")
}

/// The error of F on the whole triangulation.
fn deviation(volume: &Volume, points: WeightedPoints) -> Result<Deviation, ReproduceError> {
    let options = ShapeOptions::new(Alpha::INFINITE).refuse_flat(true);
    let shape = alpha_shape(points, &options).map_err(InterpolateError::from)?;
    let resampled = Interpolant::new(&shape)?.resample(&Grid::of(volume, Units::Voxel))?;
    Ok(Deviation::of(volume, &resampled))
}

/// Writes points to a file and reads them back: the size of the file in bytes, and the points read.
fn through_file(
    volume: &Volume,
    points: &WeightedPoints,
    value_error: f64,
) -> Result<(usize, WeightedPoints), ReproduceError> {
    const NAME: &str = ".wvm";
    let grid = SampleGrid { dims: volume.dims(), frame: *volume.frame(), units: Units::Voxel };
    let coordinates = Coordinates::VOXEL;
    let facts = ModelMetadata::default().grid(Some(grid)).coordinates(coordinates);
    let packing = Packing::default().value_error(value_error);
    let writer = PointWriter::of(format!("model{NAME}")).map_err(std::io::Error::other)?;
    let mut bytes = Vec::new();
    writer.write_model(points, &[], &facts, &packing, &mut bytes)?;
    let file = Scratch::of(&mut &bytes[..], NAME)?;
    let (read, _) = read_model(file.path(), &PointOptions::default())?;
    Ok((bytes.len(), weigh(read, Weighting::Column, Alpha::INFINITE)?))
}

fn model_table(measured: &[Measured], volume: &Volume) -> Table {
    let head = ["points", "bytes", "bits per sample", "RMSE", "PSNR (dB)", "largest error"];
    let row = |model: &Measured| {
        vec![
            model.points.to_string(),
            model.bytes.to_string(),
            text::number(model.bits(volume)),
            text::number(model.rmse),
            text::number(20.0 * (Deviation::PEAK / model.rmse).log10()),
            text::number(model.max),
        ]
    };
    Table {
        caption: "Files of ours, over the whole volume, in gray levels".into(),
        head: head.map(String::from).into(),
        rows: measured.iter().map(row).collect(),
    }
}

/// Bits per sample at some errors, and PSNR at some rates, of all curves.
fn curve_table(curves: &[RateCurve]) -> Table {
    let head = ["", "bits at RMSE 1", "at 2", "at 4", "PSNR at ¼ bit", "at ½", "at 1"];
    let cell = |value: Option<f64>| value.map_or_else(|| "–".into(), text::number);
    let row = |curve: &RateCurve| {
        let swapped: Vec<[f64; 2]> =
            curve.points.iter().map(|&[rmse, bits]| [bits, rmse]).collect();
        let bits = [1.0, 2.0, 4.0].map(|rmse| read_off(&curve.points, rmse));
        let rmses = [0.25, 0.5, 1.0].map(|bits| read_off(&swapped, bits));
        let psnrs = rmses.map(|rmse| rmse.map(|rmse| 20.0 * (Deviation::PEAK / rmse).log10()));
        let cells = bits.into_iter().chain(psnrs).map(cell);
        std::iter::once(curve.name.clone()).chain(cells).collect()
    };
    Table {
        caption:
            "Bits per sample at an RMSE in gray levels, and PSNR in dB at a rate; – lies beyond \
                  what was measured"
                .into(),
        head: head.map(String::from).into(),
        rows: curves.iter().map(row).collect(),
    }
}

/// y at x, interpolated linearly between the logarithms of points; `None` beyond them.
fn read_off(curve: &[[f64; 2]], x: f64) -> Option<f64> {
    let mut sorted = curve.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    sorted.windows(2).find_map(|pair| {
        let [[x0, y0], [x1, y1]] = [pair[0], pair[1]];
        let share = (x.ln() - x0.ln()) / (x1.ln() - x0.ln());
        let between = x0 <= x && x <= x1 && x0 < x1;
        between.then(|| (y0.ln() * (1.0 - share) + y1.ln() * share).exp())
    })
}

/// The day of the measurement.
pub(super) const DATE: &str = "2026-11-22";

/// The curve of a compressor on `sample:skull`, as gray levels 0..255 in `f32`.
pub(super) struct Compressor {
    /// Its name.
    pub name: &'static str,
    /// RMSE in gray levels, and bits per sample; from small errors to large ones.
    pub curve: &'static [[f64; 2]],
}

/// The compressors measured; if there are two builds of one, the better one.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_off_on_logarithmic_axes() {
        let curve = [[4.0, 0.25], [1.0, 1.0]];
        assert_eq!(read_off(&curve, 2.0), Some(0.5));
        assert_eq!([read_off(&curve, 0.9), read_off(&curve, 4.1)], [None, None]);
    }
}
