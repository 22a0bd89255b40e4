use super::bench::{Bench, figure};
use super::bench::{Claim, judge};
use crate::haar::Truncation;
use crate::render::{Ball, ColourBar, ColourMap, Figure, Scene, Size};
use crate::reproduce::study::{Shared, Study, panel};
use crate::reproduce::{Fact, Item, ReproduceError, Verdict, text};

/// The truncation, and the points.
struct Evidence {
    truncation: Truncation,
    samples: usize,
    /// ‖f − f̂‖², summed over the samples.
    lost: f64,
    points: usize,
    values: usize,
    duplicates: usize,
    /// The volume of the points' hull.
    hull: f64,
}

impl Evidence {
    fn of(bench: &Bench<'_>) -> Self {
        let study = bench.study;
        let original = study.subject.volume.as_slice();
        let pairs = original.iter().zip(study.smoothed.as_slice());
        Self {
            truncation: study.truncation,
            samples: original.len(),
            lost: pairs.map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum(),
            points: study.points.len(),
            values: values(study).len(),
            duplicates: bench.shapes[Shared::Plain].numbers.duplicates,
            hull: bench.shapes[Shared::Hull].numbers.volume,
        }
    }

    fn facts(&self, study: &Study<'_>, (low, high): (f64, f64)) -> Vec<Fact> {
        vec![
            Fact::count("samples", self.samples),
            Fact::count("coefficients kept", self.truncation.kept as usize),
            Fact::new("ε = ‖f − f̂‖ (gray levels)", self.truncation.epsilon),
            Fact::new("RMS of f − f̂ (gray levels)", self.truncation.rms),
            Fact::count("points", self.points),
            Fact::new("points per sample (%)", study.percent()),
            Fact::new("smallest F", low),
            Fact::new("largest F", high),
        ]
    }
}

const CLAIMS: [Claim<Evidence>; 2] = [
    Claim {
        text: "Equation 3.3: ‖f − f̂‖² is the sum of the squares of the coefficients dropped.",
        decide: |e| {
            let dropped = e.truncation.epsilon * e.truncation.epsilon;
            // f̂ is rounded to single precision, a relative 6e-8 of gray levels up to 255.
            let rounding = 1e-4 * dropped + 1e-9 * e.samples as f64;
            let reason = format!(
                "summed over the samples {}, over the coefficients {} squared gray levels",
                text::number(e.lost),
                text::number(dropped)
            );
            (Verdict::of((e.lost - dropped).abs() <= rounding), reason)
        },
    },
    Claim {
        text: "The data are distinct and non-coplanar points with a value each.",
        decide: |&Evidence { points, values, duplicates, hull, .. }| {
            let reason = format!(
                "{points} points, {duplicates} duplicates, {values} values; their hull has volume {}",
                text::number(hull)
            );
            (Verdict::of(duplicates == 0 && hull > 0.0 && values == points), reason)
        },
    },
];

/// Figure 1: the scattered points in their box, coloured by F.
pub(super) fn figure_1(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let study = bench.study;
    let map = ColourMap::over(values(study));
    let drawn = draw(study, map)?;
    let evidence = Evidence::of(bench);
    let Truncation { kept, total, .. } = evidence.truncation;
    Ok(Item {
        title: "Figure 1. Scattered points with values".into(),
        paper:
            "Volumetric scattered data: points v = (x, y, z) with F(v) = F. The points are those \
                at which the truncated volume differs most from its six neighbours (steps 1 to 7)."
                .into(),
        ours: format!(
            "The {} samples of largest difference L, in the box of the volume. The paper does not \
             print its error tolerance; ours is an RMS of 1 gray level, which keeps {kept} of \
             {total} coefficients.",
            evidence.points
        ),
        picture: Some(bench.file("figure-01.png", drawn.to_png()?)),
        commands: vec![format!("{} -o points.csv", study.command("points"))],
        facts: evidence.facts(study, map.range()),
        findings: judge(&CLAIMS, &evidence),
        ..Item::default()
    })
}

fn values<'a>(study: &'a Study<'_>) -> &'a [f64] {
    study.points.values.as_deref().unwrap_or(&[])
}

fn draw(study: &Study<'_>, map: ColourMap) -> Result<Figure, ReproduceError> {
    let points = &study.points;
    let mut scene = Scene::default();
    scene.balls.extend(points.positions.iter().zip(values(study)).map(|(&centre, &value)| Ball {
        centre,
        radius: 0.36,
        colour: map.colour(value),
    }));
    let size = Size::new(1600, 1240)?;
    let picture = study.cameras.render_box(scene, size)?;
    let title = format!("Figure 1. {} scattered points v with values F(v)", points.len());
    Ok(Figure {
        colour_bar: Some(ColourBar { map, label: "F, the original gray level".into() }),
        columns: 1,
        panel: size,
        legend: Vec::new(),
        ..figure(&title, vec![panel("", picture, Vec::new())])
    })
}
