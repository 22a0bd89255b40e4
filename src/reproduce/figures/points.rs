use super::super::stage::panel;
use super::super::{Fact, Finding, Item, ReproduceError, Verdict, text};
use super::{Bench, figure};
use crate::render::{Ball, ColourBar, ColourMap, Figure, Scene, Size};

/// Figure 1: the scattered points in their box, coloured by F.
pub(super) fn figure_1(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let study = bench.study;
    let points = &study.points;
    let values = points.values.as_deref().unwrap_or(&[]);
    let map = ColourMap::over(values);
    let mut scene = Scene::default();
    scene.balls.extend(points.positions.iter().zip(values).map(|(&centre, &value)| Ball {
        centre,
        radius: 0.36,
        colour: map.colour(value),
    }));
    let size = Size::new(1600, 1240)?;
    let picture = study.stage.render_box(scene, size)?;
    let title = format!("Figure 1. {} scattered points v with values F(v)", points.len());
    let drawn = Figure {
        colour_bar: Some(ColourBar { map, label: "F, the original gray level".into() }),
        columns: 1,
        panel: size,
        legend: Vec::new(),
        ..figure(&title, vec![panel("", picture, Vec::new())])
    };
    let picture = bench.file("figure-01.png", drawn.to_png()?);

    let original = study.subject.volume.as_slice();
    let lost: f64 = original
        .iter()
        .zip(study.smoothed.as_slice())
        .map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2))
        .sum();
    let epsilon = study.truncation.epsilon;
    let dropped = epsilon * epsilon;
    // f̂ is rounded to single precision, a relative 6e-8 of gray levels up to 255.
    let rounding = 1e-4 * dropped + 1e-9 * original.len() as f64;
    let duplicates = bench.shapes.plain.numbers.duplicates;
    let hull = bench.shapes.by_alpha().last().map_or(0.0, |shaped| shaped.numbers.volume);
    let (low, high) = map.range();
    let findings = vec![
        Finding {
            claim: "Equation 3.3: ‖f − f̂‖² is the sum of the squares of the coefficients dropped."
                .into(),
            verdict: Verdict::of((lost - dropped).abs() <= rounding),
            reason: format!(
                "summed over the samples {}, over the coefficients {} squared gray levels",
                text::number(lost),
                text::number(dropped)
            ),
        },
        Finding {
            claim: "The data are distinct and non-coplanar points with a value each.".into(),
            verdict: Verdict::of(duplicates == 0 && hull > 0.0 && values.len() == points.len()),
            reason: format!(
                "{} points, {duplicates} duplicates, {} values; their hull has volume {}",
                points.len(),
                values.len(),
                text::number(hull)
            ),
        },
    ];
    let t = &study.truncation;
    Ok(Item {
        id: "figure-1",
        title: "Figure 1. Scattered points with values".into(),
        paper:
            "Volumetric scattered data: points v = (x, y, z) with F(v) = F. The points are those \
                at which the truncated volume differs most from its six neighbours (steps 1 to 7)."
                .into(),
        ours: format!(
            "The {} samples of largest difference L, in the box of the volume. The paper does not \
             print its error tolerance; ours is an RMS of 1 gray level, which keeps {} of {} \
             coefficients.",
            points.len(),
            t.kept,
            t.total
        ),
        picture: Some(picture),
        commands: vec![format!("{} -o points.csv", study.command("points"))],
        facts: vec![
            Fact::count("samples", original.len()),
            Fact::count("coefficients kept", t.kept as usize),
            Fact::new("ε = ‖f − f̂‖ (gray levels)", epsilon),
            Fact::new("RMS of f − f̂ (gray levels)", t.rms),
            Fact::count("points", points.len()),
            Fact::new("points per sample (%)", study.input().percent),
            Fact::new("smallest F", low),
            Fact::new("largest F", high),
        ],
        findings,
        ..Item::default()
    })
}
