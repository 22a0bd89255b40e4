use super::bench::Bench;
use crate::interpolate::{
    CurveOptions, CurvePoint, Method, error_curve, error_figure, write_curve_csv,
};
use crate::points::{Units, Weighting};
use crate::reproduce::study::ALPHA;
use crate::reproduce::{Fact, Item, ReproduceError, Table, text};
use crate::shape::Alpha;

/// A measurement that is not in the paper: how well F, linear on the cells, approximates the volume.
///
/// Three counts and two kinds of weights keep it short; `walpha interpolate --curve` measures more.
pub(super) fn error_against_points(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let study = bench.study;
    let n = study.points.len() as u64;
    let mut counts = vec![n / 4, n / 2, n];
    counts.dedup();
    let options = CurveOptions {
        counts,
        weightings: vec![Weighting::Common(0.0), Weighting::MinMax],
        alpha: Alpha::from_squared(ALPHA).expect("a number"),
        units: Units::Voxel,
    };
    let curve =
        bench.monitor.watch(|| error_curve(study.subject.volume, &study.smoothed, &options))?;
    let figure =
        error_figure("Our extension. Error of the interpolant against points", ALPHA, &curve);
    let picture = bench.file("extension-1.png", figure.to_png()?);
    let svg = bench.file("extension-1.svg", figure.to_svg()?.into_bytes());
    let mut csv = Vec::new();
    write_curve_csv(&curve, study.subject.range.step(), &mut csv)?;
    let csv = bench.file("extension-1.csv", csv);
    let facts = at_the_papers_size(&curve, n as usize);
    Ok(Item {
        title: "Our extension. Error against points".into(),
        paper: "Says that the weighted alpha shape of the points represents the volume, \
                but does not measure how well. This section is not in the paper."
            .into(),
        ours: "F is linear on each cell, and compared with the original samples: inside the shape, \
               and over the whole volume, for which the triangulation is taken whole and the 8 \
               corners are added. Points of largest difference gather at edges and leave the rest \
               uncovered; the same number of points chosen where the interpolant is worst \
               (adaptive), or just evenly, represents the volume far better. Hidden points carry no \
               value, so unequal weights cost accuracy."
            .into(),
        picture: Some(picture),
        files: vec![svg, csv],
        facts,
        tables: vec![table(&curve)],
        ..Item::default()
    })
}

/// RMSE of each method where weights are 0.
fn at_the_papers_size(curve: &[CurvePoint], count: usize) -> Vec<Fact> {
    let plain = |point: &&CurvePoint| {
        point.weighting.is_none_or(|weighting| weighting == Weighting::Common(0.0))
    };
    let nearest = |method: Method| {
        let points = curve.iter().filter(plain).filter(move |point| point.method == method);
        points.min_by_key(|point| point.count.abs_diff(count))
    };
    let fact = |point: &CurvePoint| {
        let label = match point.method {
            Method::Haar => format!("RMSE of {}, {} coefficients", point.method, point.count),
            method => format!("RMSE of {method}, {} points, ω = 0, whole volume", point.count),
        };
        Some(Fact::new(label, point.filled.rmse?))
    };
    Method::ALL.into_iter().filter_map(nearest).filter_map(fact).collect()
}

fn table(curve: &[CurvePoint]) -> Table {
    let number = |value: Option<f64>| value.map_or_else(|| "–".into(), text::number);
    let row = |point: &CurvePoint| {
        vec![
            point.method.to_string(),
            point.weighting.map_or_else(|| "–".into(), |weighting| weighting.to_string()),
            point.count.to_string(),
            point.hidden.to_string(),
            number(Some(100.0 * point.inside.covered_share())),
            number(point.inside.rmse),
            number(point.filled.rmse),
            number(point.filled.max),
        ]
    };
    let head = [
        "method",
        "weights",
        "points or coefficients",
        "hidden",
        "covered (%)",
        "RMSE inside",
        "RMSE whole",
        "largest error",
    ];
    Table {
        caption: format!(
            "Error from the original volume in gray levels; weights and shapes at α = {ALPHA}"
        ),
        head: head.map(String::from).into(),
        rows: curve.iter().map(row).collect(),
    }
}
