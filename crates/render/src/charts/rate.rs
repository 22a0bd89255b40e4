use crate::figure::{Content, Drawing, Figure, Panel, Pen};
use crate::pixels::{PALETTE, Size};

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
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
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
