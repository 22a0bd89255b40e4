//! The points of the volume, and the shapes that the figures share.

use super::stage::Stage;
use super::{Clock, Input, ReproduceError, ShapeNumbers, Subject, text};
use crate::haar::{HaarOptions, Truncation, smooth_monitored};
use crate::points::{
    Points, Selection, SelectionRule, Units, Weighting, difference, select, weigh,
};
use crate::shape::{Alpha, AlphaShape, Balls, Engine, ShapeOptions, alpha_shape};
use crate::volume::{LengthUnit, Volume};
use walpha_base::Monitor;

/// The paper's points.
pub(super) const PAPER_POINTS: usize = 15956;
/// The paper's samples: 64³.
pub(super) const PAPER_SAMPLES: usize = 262_144;
/// The paper's α for all figures of the skull.
pub(super) const ALPHA: f64 = 10.0;
/// The paper's common factor of Figure 7.
pub(super) const COMMON: f64 = 10.0;

/// The volume, its wavelet approximation, and the points selected.
pub(super) struct Study<'a> {
    pub subject: &'a Subject<'a>,
    pub smoothed: Volume,
    pub truncation: Truncation,
    pub points: Points,
    /// The options of `walpha` that select the same points.
    select: String,
    pub stage: Stage,
}

impl<'a> Study<'a> {
    pub(super) fn new(subject: &'a Subject<'a>, monitor: &Monitor) -> Result<Self, ReproduceError> {
        let volume = subject.volume;
        let (smoothed, truncation) = smooth_monitored(volume, &HaarOptions::default(), monitor)?;
        let (rule, select_option) = if volume.dims().samples() == PAPER_SAMPLES {
            (SelectionRule::Count(PAPER_POINTS as u64), format!("--count {PAPER_POINTS}"))
        } else {
            let SelectionRule::AtMost(ratio) = SelectionRule::default() else {
                unreachable!("the default is a ratio")
            };
            (SelectionRule::Ratio(ratio), format!("--ratio {ratio}"))
        };
        let selection = Selection { rule, gray_min: None };
        let differences = difference(&smoothed);
        let points = select(volume, &smoothed, &differences, &selection, Units::Voxel)?;
        let stage = Stage::of(volume.dims());
        Ok(Self { subject, smoothed, truncation, points, select: select_option, stage })
    }

    pub(super) fn input(&self) -> Input {
        let dims = self.subject.volume.dims();
        Input {
            name: self.subject.name.to_owned(),
            dims: dims.xyz(),
            samples: dims.samples(),
            gray_range: [self.subject.range.low, self.subject.range.high],
            haar: self.truncation,
            points: self.points.len(),
            percent: 100.0 * self.points.len() as f64 / dims.samples() as f64,
        }
    }

    /// `walpha COMMAND INPUT` with the options that select our points.
    pub(super) fn command(&self, command: &str) -> String {
        let (input, select) = (text::shell(self.subject.name), &self.select);
        // The paper's lengths are voxels, whatever the file says.
        match self.subject.volume.frame().coordinates.unit {
            LengthUnit::Voxel => format!("walpha {command} {input} {select}"),
            _ => format!("walpha {command} {input} --units voxel {select}"),
        }
    }

    /// The shape with these weights at this α, in its whole triangulation.
    pub(super) fn shape(&self, variant: Variant) -> Result<Shaped, ReproduceError> {
        let Variant { weighting, alpha, balls } = variant;
        let alpha = Alpha::from_squared(alpha).expect("a variant's α is a number");
        let weighted = weigh(self.points.clone(), weighting, alpha)?;
        // CGAL as the paper used it.
        let engine = Engine::Cgal;
        let options =
            ShapeOptions::new(alpha).balls(balls).engine(engine).exterior(true).refuse_flat(true);
        let shape = alpha_shape(weighted, &options)?;
        let mut command = self.command("shape");
        command += &format!(" --weights {weighting} --alpha {}", alpha.squared());
        if balls == Balls::Radius {
            command += " --balls radius";
        }
        command += " --exterior";
        let numbers = ShapeNumbers::of(&shape, variant.label(), command);
        Ok(Shaped { shape, numbers })
    }
}

/// How a shape is made of the points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Variant {
    weighting: Weighting,
    /// Squared.
    alpha: f64,
    balls: Balls,
}

impl Variant {
    pub(super) fn plain(alpha: f64) -> Self {
        Self { weighting: Weighting::Common(0.0), alpha, balls: Balls::Power }
    }

    pub(super) fn weighted(weighting: Weighting) -> Self {
        Self { weighting, alpha: ALPHA, balls: Balls::Power }
    }

    fn label(self) -> String {
        let weights = match self.weighting {
            Weighting::Common(weight) => format!("ω = {}", text::number(weight)),
            Weighting::MinMax => "min-max".into(),
            Weighting::Barycentric => "barycentric".into(),
            Weighting::BarycentricN => "N × barycentric".into(),
            Weighting::Column => "given ω".into(),
        };
        let balls = if self.balls == Balls::Radius { ", radius α + ω" } else { "" };
        format!("{weights}, α = {}{balls}", text::number(self.alpha))
    }
}

/// A shape and what was measured of it.
pub(super) struct Shaped {
    pub shape: AlphaShape,
    pub numbers: ShapeNumbers,
}

/// The shapes that several figures share, all at α = 10 unless said otherwise.
pub(super) struct Shapes {
    /// ω = 0.
    pub plain: Shaped,
    /// ω = 10.
    pub common: Shaped,
    /// ω = 0 at α = 20, which Figure 7 must equal.
    pub shifted: Shaped,
    /// Equation 4.1.
    pub min_max: Shaped,
    /// Equation 4.1 with balls of radius α + ω.
    pub min_max_radius: Shaped,
    /// ω = 0 at α + the mean of the min-max weights.
    pub min_max_mean: Shaped,
    /// Equation 4.2 as printed.
    pub barycentric: Shaped,
    /// N times that.
    pub barycentric_n: Shaped,
    /// ω = 0 at other α, ascending; the last is ∞.
    pub ladder: Vec<Shaped>,
}

/// Values of α beside 10 and 20 that show how the shape grows: of the edge, the diagonals and
/// some multiples of the voxel, and ∞.
const LADDER: [f64; 5] = [1.0, 3.0, 50.0, 200.0, f64::INFINITY];

impl Shapes {
    pub(super) fn new(study: &Study<'_>, clock: &mut Clock<'_>) -> Result<Self, ReproduceError> {
        let mut make = |name, variant| {
            clock.enter(name)?;
            study.shape(variant)
        };
        let min_max = make("shape: min-max", Variant::weighted(Weighting::MinMax))?;
        let radius = Variant { balls: Balls::Radius, ..Variant::weighted(Weighting::MinMax) };
        let mean = min_max.numbers.weights.mean;
        Ok(Self {
            plain: make("shape: ω = 0", Variant::plain(ALPHA))?,
            common: make("shape: ω = 10", Variant::weighted(Weighting::Common(COMMON)))?,
            shifted: make("shape: α = 20", Variant::plain(ALPHA + COMMON))?,
            min_max_radius: make("shape: radius α + ω", radius)?,
            min_max_mean: make("shape: mean of min-max", Variant::plain(ALPHA + mean))?,
            min_max,
            barycentric: make("shape: barycentric", Variant::weighted(Weighting::Barycentric))?,
            barycentric_n: make(
                "shape: N × barycentric",
                Variant::weighted(Weighting::BarycentricN),
            )?,
            ladder: LADDER
                .iter()
                .map(|&alpha| make("shape: other α", Variant::plain(alpha)))
                .collect::<Result<_, _>>()?,
        })
    }

    /// The unweighted shapes, by ascending α.
    pub(super) fn by_alpha(&self) -> Vec<&Shaped> {
        let mut shapes: Vec<&Shaped> = [&self.plain, &self.shifted].into();
        shapes.extend(&self.ladder);
        shapes.sort_by(|a, b| a.numbers.alpha.squared().total_cmp(&b.numbers.alpha.squared()));
        shapes
    }
}
