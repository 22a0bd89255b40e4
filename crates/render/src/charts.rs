//! Charts: ladders of α-shapes, and codecs by rate and distortion.

use std::collections::BTreeSet;

use walpha_base::shown::{brief, counted};
use walpha_base::sort::sort_by;
use walpha_shape::Alpha;
use walpha_shape::ladder::{Curve, Ladder, Level, Suggestions};

use crate::colour::{PALETTE, Rgb};
use crate::error::RenderError;
use crate::figure::{Content, Drawing, Figure, Panel, Pen, Scale};
use crate::pixels::Size;

const BETTI: [(&str, Rgb); 3] =
    [("components b0", PALETTE[1]), ("tunnels b1", PALETTE[3]), ("voids b2", PALETTE[0])];
const SIZES: [(&str, Rgb); 4] = [
    ("coverage", PALETTE[2]),
    ("volume of voids", PALETTE[4]),
    ("area of regular facets", PALETTE[5]),
    ("area of singular facets", PALETTE[7]),
];

/// A ladder as a figure: Betti numbers at every critical value with the ladder's levels as dots, and sizes at the levels, over
/// the logarithm of the squared radius α + max ω of the largest balls. Dashed lines mark the suggested α.
///
/// # Errors
/// [`RenderError::Size`], which does not occur.
pub fn ladder_figure(
    title: &str,
    ladder: &Ladder,
    curve: &Curve,
    suggested: &Suggestions,
    domain: f64,
) -> Result<Figure, RenderError> {
    let chart = Chart::new(ladder, curve, suggested);
    let legend = BETTI.iter().chain(&SIZES);
    Ok(Figure {
        title: title.to_owned(),
        columns: 1,
        panel: Size::new(1500, 560)?,
        panels: vec![
            Panel {
                title: "Topology".into(),
                content: Content::Drawing(chart.topology()),
                captions: Vec::new(),
            },
            Panel {
                title: "Sizes".into(),
                content: Content::Drawing(chart.sizes(domain)),
                captions: vec![
                    "Coverage and the volume of voids are shares of the domain; areas are shares of \
                     the largest one met."
                        .into(),
                ],
            },
        ],
        colour_bar: None,
        legend: legend.map(|&(name, colour)| (name.to_owned(), colour)).collect(),
        notes: vec![format!(
            "α and ω are squared lengths. Lines: all {} critical values; dots: the levels of the \
             ladder. Dashed, from the left: every point in a cell (α = {}), one solid component \
             (α = {}), and no void (α = {}).",
            curve.len(),
            brief(suggested.all_points.squared()),
            brief(suggested.one_region.squared()),
            brief(suggested.no_void.squared())
        )],
    })
}

struct Chart<'a> {
    ladder: &'a Ladder,
    curve: &'a Curve,
    marks: [f64; 3],
    /// The ends of the axis of α.
    ends: [f64; 2],
}

impl<'a> Chart<'a> {
    fn new(ladder: &'a Ladder, curve: &'a Curve, suggested: &Suggestions) -> Self {
        let marks =
            [suggested.all_points, suggested.one_region, suggested.no_void].map(Alpha::squared);
        let weight = curve.largest_weight();
        let shown = ladder.levels.iter().map(|level| level.alpha.squared()).chain(marks);
        let ends = shown
            .map(|alpha| abscissa(alpha, weight))
            .filter(|x| x.is_finite())
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)]);
        // An isolated point enters with a ball of radius 0, which is not on a logarithmic axis.
        let ends = if ends[0] <= ends[1] { ends } else { [0.0; 2] };
        let margin = 0.03 * (ends[1] - ends[0]) + 0.02;
        Self { ladder, curve, marks, ends: [ends[0] - margin, ends[1] + margin] }
    }

    fn x(&self, alpha: f64) -> f64 {
        // Values beyond the axis are drawn at its ends.
        abscissa(alpha, self.curve.largest_weight()).clamp(self.ends[0], self.ends[1])
    }

    fn drawing(&self, top: f64, label: &str, scale: Scale) -> Drawing {
        let bounds = [[self.ends[0], 0.0], [self.ends[1], top]];
        let alpha = if self.curve.largest_weight() == 0.0 { "α" } else { "α + max ω" };
        let mut drawing = Drawing::chart(bounds, &format!("{alpha}, squared length"), label);
        drawing = drawing.scales([Scale::Log { zero: None }, scale]);
        for alpha in self.marks {
            let x = self.x(alpha);
            drawing.segment([[x, 0.0], [x, top]], Pen::line(Rgb([120; 3]), 2.0).dashed());
        }
        drawing
    }

    fn topology(&self) -> Drawing {
        let numbers = |b: walpha_shape::Betti| <[u64; 3]>::from(b).map(height);
        let all = self.curve.betti.iter().copied();
        let top = all.clone().flat_map(numbers).fold(1.0, f64::max) * 1.05;
        let mut drawing = self.drawing(top, "number", Scale::LogOfOneMore);
        for (k, &(_, colour)) in BETTI.iter().enumerate() {
            let line =
                self.curve.alphas().zip(all.clone()).map(|(a, b)| [self.x(a), numbers(b)[k]]);
            drawing.polyline(&stairs(line, self.ends), Pen::line(colour, 4.0));
            for level in &self.ladder.levels {
                drawing.dot([self.x(level.alpha.squared()), numbers(level.betti)[k]], 9.0, colour);
            }
        }
        drawing
    }

    fn sizes(&self, domain: f64) -> Drawing {
        let levels = &self.ladder.levels;
        let largest =
            |of: fn(&Level) -> f64| levels.iter().map(of).fold(f64::MIN_POSITIVE, f64::max);
        let regular = largest(|level| level.measures.regular_area);
        let singular = largest(|level| level.measures.singular_area);
        let sizes = |level: &Level| {
            [
                level.coverage,
                level.void_volume() / domain,
                level.measures.regular_area / regular,
                level.measures.singular_area / singular,
            ]
        };
        let mut drawing = self.drawing(1.05, "share", Scale::Linear);
        for (k, &(_, colour)) in SIZES.iter().enumerate() {
            let points: Vec<_> =
                levels.iter().map(|l| [self.x(l.alpha.squared()), sizes(l)[k]]).collect();
            drawing.polyline(&points, Pen::line(colour, 4.0));
            points.iter().for_each(|&at| drawing.dot(at, 9.0, colour));
        }
        drawing
    }
}

/// A persistence diagram: a dot for each interval, birth against death, both squared lengths, with a colour for components, loops
/// and voids. Intervals that never end are on the line above. Of dots that nearly cover each other, one is drawn. Axes are
/// logarithmic, unless weights make values negative.
#[expect(clippy::missing_panics_doc, reason = "an invariant")]
pub fn persistence_figure(title: &str, intervals: [&[[f64; 2]]; 3]) -> Figure {
    const SIDE: u32 = 1000;
    /// Dots of one colour are at least this share of the chart apart.
    const APART: f64 = 1.0 / 500.0;
    let numbers = || intervals.iter().copied().flatten().flatten().copied();
    let scale = scale_of(numbers);
    let places = || numbers().filter(|x| x.is_finite()).map(|x| scale.place(x));
    let low = places().fold(f64::INFINITY, f64::min);
    let high = places().fold(f64::NEG_INFINITY, f64::max);
    // Without any interval, or with only one value, no length is given.
    let (low, length) = match high - low {
        length if length > 0.0 => (low, length),
        _ if low.is_finite() => (low, low.abs().max(1.0)),
        _ => (0.0, 1.0),
    };
    let never = low + 1.08 * length;
    let bounds = [[low - 0.02 * length; 2], [low + 1.02 * length, low + 1.12 * length]];
    let chart = Drawing::chart(bounds, "birth: α, squared length", "death");
    let mut chart = chart.scales([scale; 2]).last_tick(low + 1.02 * length);
    chart.segment([[low; 2], [low + length; 2]], Pen::line(Rgb([150; 3]), 2.0));
    let ends = [bounds[0][0], bounds[1][0]].map(|x| [x, never]);
    chart.segment(ends, Pen::line(Rgb([150; 3]), 2.0).dashed());
    chart.text([low + 0.96 * length, never + 0.025 * length], 22.0, "never", Rgb([110; 3]));
    // Voids are few, components many.
    let colours = BETTI.map(|(_, colour)| colour);
    for (of_dimension, colour) in intervals.iter().zip(colours) {
        let mut drawn = BTreeSet::new();
        for &[birth, death] in *of_dimension {
            let death = if death.is_finite() { scale.place(death) } else { never };
            let at = [scale.place(birth), death];
            if drawn.insert(at.map(|x| ((x - low) / length / APART).round() as i64)) {
                chart.dot(at, 5.0, colour);
            }
        }
    }
    let names = ["component", "loop", "void"];
    let legend = names.iter().zip(intervals).zip(colours);
    Figure {
        title: title.to_owned(),
        columns: 1,
        panel: Size::new(SIDE, SIDE).expect("a valid size"),
        panels: vec![Panel {
            title: String::new(),
            content: Content::Drawing(chart),
            captions: Vec::new(),
        }],
        colour_bar: None,
        legend: legend
            .map(|((name, of_dimension), colour)| (counted(of_dimension.len() as u64, name), colour))
            .collect(),
        notes: vec![
            "Each dot is a component, loop or void: the farther above the diagonal, the longer it lasts. On the \
             dashed line are those that never end."
                .into(),
        ],
    }
}

/// The scale of births and deaths: 0, where points without weights begin, is drawn half a decade below the least of the others.
fn scale_of<I: Iterator<Item = f64>>(numbers: impl Fn() -> I) -> Scale {
    let least = numbers().filter(|&x| x > 0.0).fold(f64::INFINITY, f64::min);
    if least.is_infinite() || numbers().any(|x| x < 0.0) {
        return Scale::Linear;
    }
    let has_zero = numbers().any(|x| x == 0.0);
    Scale::Log { zero: has_zero.then(|| least.log10() - 0.5) }
}

fn abscissa(alpha: f64, largest_weight: f64) -> f64 {
    Scale::Log { zero: None }.place(alpha + largest_weight)
}

fn height(count: u64) -> f64 {
    Scale::LogOfOneMore.place(count as f64)
}

/// A step function over its points, thinned to the resolution of a figure: the last point of each strip of the axis is kept.
fn stairs(points: impl Iterator<Item = [f64; 2]>, ends: [f64; 2]) -> Vec<[f64; 2]> {
    const STRIPS: f64 = 1200.0;
    let strip = |x: f64| ((x - ends[0]) / (ends[1] - ends[0]) * STRIPS) as i64;
    let mut line: Vec<[f64; 2]> = Vec::new();
    let mut thinned: Vec<[f64; 2]> = Vec::new();
    for point in points {
        match thinned.last_mut() {
            Some(last) if strip(last[0]) == strip(point[0]) => *last = point,
            _ => thinned.push(point),
        }
    }
    for [x, y] in thinned {
        if let Some(&[_, before]) = line.last() {
            line.push([x, before]);
        }
        line.push([x, y]);
    }
    if let Some(&[_, y]) = line.last() {
        line.push([ends[1], y]);
    }
    line
}

/// A curve of a [`rate_figure`]: its name and its points.
#[derive(Clone, Debug, PartialEq)]
pub struct RateCurve {
    /// The codec that wrote the files.
    pub name: String,
    /// RMSE in gray levels, and bits per sample.
    pub points: Vec<[f64; 2]>,
}

/// PSNR (peak 255) over bits per sample, up to 1.2 bits. The first curve is drawn thick, with dots.
#[expect(clippy::missing_panics_doc, reason = "an invariant")]
pub fn rate_figure(title: &str, curves: &[RateCurve]) -> Figure {
    const MOST_BITS: f64 = 1.2;
    let size = Size::new(1000, 700).expect("a valid size");
    let bounds = [[0.0, 26.0], [MOST_BITS, 58.0]];
    let mut chart = Drawing::chart(bounds, "bits per sample", "PSNR (dB)");
    let legend = curves.iter().zip(PALETTE);
    for (k, (curve, colour)) in legend.clone().enumerate().rev() {
        let point = |[rmse, bits]: [f64; 2]| [bits, 20.0 * (255.0 / rmse).log10()];
        let visible = |[bits, psnr]: &[f64; 2]| {
            (0.0..=MOST_BITS).contains(bits) && (bounds[0][1]..=bounds[1][1]).contains(psnr)
        };
        let mut points: Vec<[f64; 2]> =
            curve.points.iter().copied().map(point).filter(visible).collect();
        sort_by(&mut points, |a, b| a[0].total_cmp(&b[0]));
        chart.polyline(&points, Pen::line(colour, if k == 0 { 6.0 } else { 3.0 }));
        if k == 0 {
            points.iter().for_each(|&point| chart.dot(point, 9.0, colour));
        }
    }
    Figure {
        title: title.into(),
        columns: 1,
        panel: size,
        panels: vec![Panel {
            title: String::new(),
            content: Content::Drawing(chart),
            captions: Vec::new(),
        }],
        colour_bar: None,
        legend: legend.map(|(curve, colour)| (curve.name.clone(), colour)).collect(),
        notes: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stairs_keep_the_last_of_each_strip() {
        let points = [[0.0, 1.0], [0.0001, 2.0], [0.5, 3.0]];
        let line = stairs(points.into_iter(), [0.0, 1.0]);
        assert_eq!(line, [[0.0001, 2.0], [0.5, 2.0], [0.5, 3.0], [1.0, 3.0]]);
    }
}
