use super::{CurvePoint, Deviation, Method};
use walpha_base::shown::brief;
use walpha_points::Weighting;
use walpha_render::{Content, Drawing, Figure, PALETTE, Panel, Pen, Rgb, Size};

/// The figure of an error curve (see [`error_curve`](super::error_curve)): RMSE of the filled interpolant, RMSE inside the shape
/// at α (squared), the share of samples that it covers, and the number of hidden points, over the number of points. Each method
/// has a colour; unweighted lines are solid.
#[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
pub fn error_figure(title: &str, alpha: f64, curve: &[CurvePoint]) -> Figure {
    let size = Size::new(800, 640).expect("a size that is right");
    let panel = |title: &str, unit: &str, value: &dyn Fn(&CurvePoint) -> Option<f64>| Panel {
        title: title.into(),
        content: Content::Drawing(chart(curve, unit, value)),
        captions: Vec::new(),
    };
    let (rmse, alpha) = ("RMSE (gray levels)", brief(alpha));
    let shapes = |point: &CurvePoint| point.weighting.map(|_| point.inside);
    let panels = vec![
        panel("whole volume: α = ∞ and the 8 corners", rmse, &|point| point.filled.rmse),
        panel(&format!("on the shape at α = {alpha}"), rmse, &|point| {
            shapes(point).and_then(|inside| inside.rmse)
        }),
        panel(&format!("covered by the shape at α = {alpha}"), "samples (%)", &|point| {
            shapes(point).as_ref().map(Deviation::covered_share).map(|share| 100.0 * share)
        }),
        panel("hidden by heavier points, so that they carry no value", "points (%)", &|point| {
            point.weighting.map(|_| 100.0 * point.hidden as f64 / point.count as f64)
        }),
    ];
    let legend = Method::ALL.into_iter().filter(|m| curve.iter().any(|point| point.method == *m));
    Figure {
        title: title.into(),
        columns: 2,
        panel: size,
        panels,
        colour_bar: None,
        legend: legend.map(|method| (method.to_string(), colour(method))).collect(),
        notes: vec![
            "Error is measured from the original volume. Solid lines: ω = 0, and coefficients. Dashed \
             lines: min-max weights. White dots: barycentric weights; they average α/N, and so are \
             seen only where many points lie on one sphere and any weight decides. Thresholds \
             choose as largest differences do, at other counts."
                .into(),
        ],
    }
}

fn colour(method: Method) -> Rgb {
    match method {
        Method::Difference => PALETTE[0],
        Method::Adaptive => PALETTE[1],
        Method::Lattice => PALETTE[2],
        Method::Threshold => PALETTE[3],
        Method::Haar => PALETTE[7],
    }
}

fn chart(curve: &[CurvePoint], unit: &str, value: &dyn Fn(&CurvePoint) -> Option<f64>) -> Drawing {
    let at = |point: &CurvePoint| Some([point.count as f64, value(point)?]);
    let high = curve
        .iter()
        .filter_map(at)
        .fold([1.0f64; 2], |high, p| [high[0].max(p[0]), high[1].max(p[1])]);
    let bounds = [[0.0; 2], high.map(|v| v * 1.04)];
    let mut chart = Drawing::chart(bounds, "points, or coefficients", unit);
    let same = |a: &CurvePoint, b: &CurvePoint| a.method == b.method && a.weighting == b.weighting;
    for line in curve.chunk_by(same) {
        let places: Vec<[f64; 2]> = line.iter().filter_map(at).collect();
        let (method, weighting) = (line[0].method, line[0].weighting);
        let colour = colour(method);
        let (pen, dot) = match weighting {
            None | Some(Weighting::Common(_)) => (Some(Pen::line(colour, 5.0)), 8.0),
            Some(Weighting::Barycentric) => (None, 5.0),
            Some(_) => (Some(Pen::line(colour, 4.0).dashed()), 6.0),
        };
        if let Some(pen) = pen {
            chart.polyline(&places, pen);
        }
        for place in places {
            let ink = if pen.is_none() { Rgb([255, 255, 255]) } else { colour };
            chart.dot(place, dot, ink);
        }
    }
    chart
}
