use std::fmt;
use std::io::{self, Write};

use ndarray::Array3;
use serde::{Deserialize, Serialize};
use walpha_base::Monitor;
use walpha_regular::TriangulationError;

use super::{Adaptive, Deviation, Grid, Interpolant, InterpolateError, adaptive_voxels, fill};
use walpha_points::haar::{HaarOptions, Tolerance, smooth};
use walpha_points::{
    Points, Selection, SelectionRule, Units, Weighting, difference, points_at, select, weigh,
};
use walpha_shape::{Alpha, Engine, ShapeError, ShapeOptions, alpha_shape};
use walpha_volume::Volume;

/// The method that yields the points of an error curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Method {
    /// The N voxels of largest difference L, as in the paper.
    Difference,
    /// The voxels whose L is at least the whole gray level nearest to that of the N-th voxel.
    Threshold,
    /// The voxels of [`adaptive_voxels`](super::adaptive_voxels).
    Adaptive,
    /// A lattice of about N voxels, as evenly distributed as whole steps allow, including the corners.
    Lattice,
    /// No points, but the N largest Haar coefficients.
    Haar,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 5] =
        [Self::Difference, Self::Threshold, Self::Adaptive, Self::Lattice, Self::Haar];
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Difference => "largest difference",
            Self::Threshold => "threshold",
            Self::Adaptive => "adaptive",
            Self::Lattice => "uniform lattice",
            Self::Haar => "truncated Haar",
        })
    }
}

/// The measurements of an error curve.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveOptions {
    /// The numbers of points or coefficients.
    pub counts: Vec<u64>,
    /// The weights; proportional ones are for `alpha`.
    pub weightings: Vec<Weighting>,
    /// The α of the shapes.
    pub alpha: Alpha,
    /// The units of coordinates, and therefore of α and weights.
    pub units: Units,
}

/// One measurement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// The method that yields the points or coefficients.
    pub method: Method,
    /// The weights of points; `None` for coefficients.
    pub weighting: Option<Weighting>,
    /// The number of points or coefficients.
    pub count: usize,
    /// The number of points that the weights of others hide in the filled shape.
    pub hidden: usize,
    /// The error of F on the shape at α.
    pub inside: Deviation,
    /// The error of F on the whole grid: see [`fill`](super::fill()).
    pub filled: Deviation,
}

/// Measures the error and the covered share of samples over the number of points, for each method and weighting, in that order.
///
/// `smoothed` is the truncated volume, whose differences choose and weigh points; error is always measured from `volume`. If the
/// points span no volume, or there are fewer than requested, the measurement is left out. Takes two triangulations for each point
/// of the curve, and one adaptive selection of the largest count.
///
/// # Errors
/// The errors of the stages, except points that span no volume.
pub fn error_curve(
    volume: &Volume,
    smoothed: &Volume,
    options: &CurveOptions,
) -> Result<Vec<CurvePoint>, InterpolateError> {
    let monitor = &*Monitor::current();
    let differences = difference(smoothed);
    let bench =
        CurveBuilder { volume, smoothed, differences, options, monitor: monitor.unreported() };
    let mut curve = Vec::new();
    for (done, method) in Method::ALL.into_iter().enumerate() {
        monitor.report(done as u64, Method::ALL.len() as u64)?;
        bench.add(method, &mut curve)?;
    }
    Ok(curve)
}

struct CurveBuilder<'a> {
    volume: &'a Volume,
    smoothed: &'a Volume,
    differences: Array3<f64>,
    options: &'a CurveOptions,
    monitor: Monitor,
}

impl CurveBuilder<'_> {
    /// Adds the measurements of a method.
    fn add(&self, method: Method, curve: &mut Vec<CurvePoint>) -> Result<(), InterpolateError> {
        if method == Method::Haar {
            curve.extend(self.haar()?);
            return Ok(());
        }
        let selections = self.selections(method)?;
        for &weighting in &self.options.weightings {
            for points in &selections {
                curve.extend(self.measure(method, weighting, points)?);
            }
        }
        Ok(())
    }

    /// The counts that do not exceed the number of samples.
    fn counts(&self) -> impl Iterator<Item = u64> {
        let samples = self.volume.dims().samples() as u64;
        self.options.counts.iter().copied().filter(move |count| (1..=samples).contains(count))
    }

    fn selections(&self, method: Method) -> Result<Vec<Points>, InterpolateError> {
        match method {
            Method::Difference => {
                let differing = self.differences.iter().filter(|&&l| l > 0.0).count() as u64;
                let all = self.volume.dims().samples() as u64;
                let is_met = |count: &u64| *count <= differing || *count == all;
                let counts = self.counts().filter(is_met);
                counts.map(|count| self.by(SelectionRule::Count(count))).collect()
            }
            Method::Threshold => {
                let mut levels: Vec<f64> = self.differences.iter().copied().collect();
                levels.sort_unstable_by(|a, b| b.total_cmp(a));
                let level = |count: u64| levels[count as usize - 1].round().max(1.0);
                let mut thresholds: Vec<f64> = self.counts().map(level).collect();
                thresholds.dedup();
                // A constant volume has no difference of a whole gray level.
                thresholds.retain(|&threshold| levels[0] >= threshold);
                thresholds.into_iter().map(|t| self.by(SelectionRule::Threshold(t))).collect()
            }
            Method::Adaptive => {
                let Some(most) = self.counts().max().filter(|&most| most >= 8) else {
                    return Ok(Vec::new());
                };
                let goal = Adaptive::new(most);
                let voxels = self
                    .monitor
                    .watch(|| adaptive_voxels(self.volume, &goal, self.options.units))?;
                let first = |count: u64| voxels.get(..count as usize);
                Ok(self.counts().filter_map(first).map(|voxels| self.at(voxels)).collect())
            }
            Method::Lattice => Ok(self.counts().map(|n| self.at(&self.lattice(n))).collect()),
            Method::Haar => Ok(Vec::new()),
        }
    }

    fn by(&self, rule: SelectionRule) -> Result<Points, InterpolateError> {
        let selection = Selection::default().rule(rule);
        let units = self.options.units;
        Ok(select(self.volume, self.smoothed, &self.differences, &selection, units)?)
    }

    fn at(&self, voxels: &[u32]) -> Points {
        points_at(self.volume, &self.differences, voxels, self.options.units)
    }

    /// About `count` voxels, with steps as equal as possible along all axes.
    fn lattice(&self, count: u64) -> Vec<u32> {
        let dims = self.volume.dims();
        let sizes = dims.xyz();
        let step = (dims.samples() as f64 / count as f64).cbrt();
        let places = sizes.map(|n| {
            let k = ((n as f64 / step).round() as usize).clamp(2.min(n), n);
            let at = |i: usize| (2 * i * (n - 1) + (k - 1)) / (2 * (k - 1)).max(1);
            (0..k).map(at).collect::<Vec<usize>>()
        });
        let mut voxels = Vec::new();
        for z in &places[2] {
            for y in &places[1] {
                voxels.extend(places[0].iter().map(|x| (x + sizes[0] * (y + sizes[1] * z)) as u32));
            }
        }
        voxels
    }

    fn measure(
        &self,
        method: Method,
        weighting: Weighting,
        points: &Points,
    ) -> Result<Option<CurvePoint>, InterpolateError> {
        let Self { volume, options: &CurveOptions { alpha, units, .. }, .. } = *self;
        let weighted = weigh(points.clone(), weighting, alpha)?;
        let solid = ShapeOptions::new(alpha).refuse_flat(true).engine(Engine::Native);
        let shape = match self.monitor.watch(|| alpha_shape(weighted, &solid)) {
            Err(ShapeError::Triangulation(TriangulationError::Sites(_))) => return Ok(None),
            other => other?,
        };
        let whole = self.monitor.watch(|| fill(&shape, Some(volume), units))?;
        let grid = Grid::of(volume, units);
        let deviation = |shape| -> Result<Deviation, InterpolateError> {
            Ok(Deviation::of(volume, &Interpolant::new(shape)?.resample(&grid)?))
        };
        Ok(Some(CurvePoint {
            method,
            weighting: Some(weighting),
            count: points.len(),
            hidden: whole.hidden().map_or(0, <[u32]>::len),
            inside: deviation(&shape)?,
            filled: deviation(&whole)?,
        }))
    }

    fn haar(&self) -> Result<Vec<CurvePoint>, InterpolateError> {
        let samples = self.volume.dims().samples();
        let measure = |count: u64| {
            let tolerance = Tolerance::Coefficients(count);
            let (ours, truncation) =
                smooth(self.volume, &HaarOptions::default().tolerance(tolerance))?;
            let pairs = self.volume.as_slice().iter().zip(ours.as_slice());
            let max = pairs.map(|(f, g)| (f64::from(*f) - f64::from(*g)).abs());
            let whole = Deviation {
                samples,
                covered: samples,
                rmse: Some(truncation.rms),
                max: Some(max.fold(0.0, f64::max)),
            };
            Ok(CurvePoint {
                method: Method::Haar,
                weighting: None,
                count: count as usize,
                hidden: 0,
                inside: whole,
                filled: whole,
            })
        };
        self.counts().map(measure).collect()
    }
}

/// Writes an error curve as CSV, a line for each measurement: errors in gray levels, and the RMSE in values, with `step` values
/// to a gray level. Missing numbers are left empty.
///
/// # Errors
/// Errors of the writer.
pub fn write_curve_csv(curve: &[CurvePoint], step: f64, out: &mut dyn Write) -> io::Result<()> {
    writeln!(
        out,
        "method,weights,count,hidden,covered_share,rmse_inside,max_inside,rmse_filled,max_filled,\
         rmse_inside_values,rmse_filled_values"
    )?;
    let text = |number: Option<f64>| number.map_or_else(String::new, |number| number.to_string());
    for point in curve {
        let weights = point.weighting.map_or_else(String::new, |w| w.to_string());
        writeln!(
            out,
            "{},{weights},{},{},{},{},{},{},{},{},{}",
            point.method,
            point.count,
            point.hidden,
            point.inside.covered_share(),
            text(point.inside.rmse),
            text(point.inside.max),
            text(point.filled.rmse),
            text(point.filled.max),
            text(point.inside.rmse.map(|rmse| rmse * step)),
            text(point.filled.rmse.map(|rmse| rmse * step)),
        )?;
    }
    out.flush()
}
