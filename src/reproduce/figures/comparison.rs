use super::bench::{Bench, figure};
use super::bench::{Claim, judge};
use crate::reproduce::compare::{Difference, PixelDifference, same_set};
use crate::reproduce::study::{ALPHA, Eye, Shared};
use crate::reproduce::{Fact, Item, ReproduceError, ShapeNumbers, Table, Verdict, text};

/// Four shapes, and the difference of the paper's two: without weights on the left, with barycentric weights on the right.
struct Evidence {
    /// ω = 0.
    plain: ShapeNumbers,
    /// Equation 4.2 as printed.
    literal: ShapeNumbers,
    /// Equation 4.2 times N.
    scaled: ShapeNumbers,
    /// Equation 4.1.
    min_max: ShapeNumbers,
    /// ω = 0 at α plus the mean of these weights: for `scaled`, and for `min_max`.
    raised: [ShapeNumbers; 2],
    /// The simplices of only the left or only the right shape.
    apart: Difference,
    /// Whether left and right are the same set of points in space.
    same: bool,
    /// The difference of their pictures.
    pixels: PixelDifference,
    /// Number of pixels of each picture.
    all_pixels: usize,
}

/// A weighted shape, and the one without weights at α plus the mean weight, on which the weights must
/// improve.
#[derive(Clone, Copy)]
struct Trial<'a> {
    weighted: &'a ShapeNumbers,
    raised: &'a ShapeNumbers,
}

impl Evidence {
    fn of(bench: &mut Bench<'_>) -> Result<Self, ReproduceError> {
        let shapes = bench.shapes;
        let (plain, literal) = (&shapes[Shared::Plain], &shapes[Shared::Barycentric]);
        let left = bench.view(plain, Eye::Portrait)?;
        let right = bench.view(literal, Eye::Portrait)?;
        Ok(Self {
            plain: plain.numbers.clone(),
            literal: literal.numbers.clone(),
            scaled: shapes[Shared::BarycentricN].numbers.clone(),
            min_max: shapes[Shared::MinMax].numbers.clone(),
            raised: [&shapes[Shared::Shifted], &shapes[Shared::MinMaxMean]]
                .map(|shaped| shaped.numbers.clone()),
            apart: Difference::between(plain.shape.complex(), literal.shape.complex()),
            same: same_set(&plain.shape, &literal.shape),
            pixels: PixelDifference::between(&left, &right),
            all_pixels: left.pixels().len(),
        })
    }

    fn shown(&self) -> [&ShapeNumbers; 4] {
        [&self.plain, &self.literal, &self.scaled, &self.min_max]
    }

    /// Whether the right shape differs and has fewer tunnels or voids.
    fn filled(&self) -> bool {
        let (left, right) = (&self.plain.betti, &self.literal.betti);
        !self.same && (right.b1 < left.b1 || right.b2 < left.b2)
    }

    fn trials(&self) -> [Trial<'_>; 2] {
        let [scaled, min_max] = &self.raised;
        [
            Trial { weighted: &self.min_max, raised: min_max },
            Trial { weighted: &self.scaled, raised: scaled },
        ]
    }

    fn facts(&self) -> Vec<Fact> {
        vec![
            Fact::count("boundary facets that differ between left and right", self.apart.boundary),
            Fact::count("cells that differ between left and right", self.apart.cells),
            Fact::count("pixels that differ between left and right", self.pixels.pixels),
            Fact::new("largest difference of a pixel (of 255)", self.pixels.largest.into()),
            Fact::count("pixels of each", self.all_pixels),
        ]
    }
}

const CLAIMS: [Claim<Evidence>; 3] = [
    Claim {
        text: "“In the left image, we can find hole (cavity).”",
        decide: |Evidence { plain, .. }| {
            let reason = format!(
                "ω = 0 has {} and {}, the voids of volume {}",
                text::count(plain.betti.b1, "tunnel", "tunnels"),
                text::count(plain.betti.b2, "void", "voids"),
                text::number(plain.void_volume)
            );
            (Verdict::of(plain.holes() > 0), reason)
        },
    },
    Claim {
        text: "“In the right image, the hole is filled.”",
        decide: |e| {
            let (l, r, pixels) = (&e.plain, &e.literal, &e.pixels);
            let reason = format!(
                "with equation 4.2 as printed b₁ is {} after {}, b₂ {} after {}, the voids' volume {} \
                 after {}; the two shapes are {} set of points in space. {} of {} pixels differ, by \
                 {} of 255 at most{}. N times these weights leave {} and {}, min-max {} and {}",
                r.betti.b1,
                l.betti.b1,
                r.betti.b2,
                l.betti.b2,
                text::number(r.void_volume),
                text::number(l.void_volume),
                if e.same { "the same" } else { "not the same" },
                pixels.pixels,
                e.all_pixels,
                pixels.largest,
                if e.same { ", where triangles that are cut otherwise are shaded" } else { "" },
                text::count(e.scaled.betti.b1, "tunnel", "tunnels"),
                text::count(e.scaled.betti.b2, "void", "voids"),
                text::count(e.min_max.betti.b1, "tunnel", "tunnels"),
                text::count(e.min_max.betti.b2, "void", "voids"),
            );
            (Verdict::of(e.filled()), reason)
        },
    },
    Claim {
        text: "Weights can improve on what unweighted (common weighted) shapes do.",
        decide: |e| {
            let reason = format!(
                "tunnels and voids together, and the voids' volume: {} and {} with ω = 0 at \
                 α = {ALPHA}; {}. Weights improve a shape if both are less than without weights at \
                 either α; if only the count is, the measures disagree",
                e.plain.holes(),
                text::number(e.plain.void_volume),
                e.trials().map(against).join("; ")
            );
            (improvement(&e.plain, e.trials()), reason)
        },
    },
];

/// Figure 10: without weights and with barycentric ones; below, weights that do change the shape.
pub(super) fn figure_10(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let shapes = bench.shapes;
    let shown = [
        &shapes[Shared::Plain],
        &shapes[Shared::Barycentric],
        &shapes[Shared::BarycentricN],
        &shapes[Shared::MinMax],
    ];
    let titles = [
        "ω = 0 (the paper's left image)",
        "barycentric, equation 4.2 (its right image)",
        "N × barycentric (not in the paper)",
        "min-max, equation 4.1",
    ];
    let panels =
        titles.into_iter().zip(shown).map(|(title, shaped)| bench.shape_panel(title, shaped));
    let panels = panels.collect::<Result<_, _>>()?;
    let title = format!("Figure 10. Unweighted and weighted shapes at α = {ALPHA}, one camera");
    let drawn = figure(&title, panels);
    let commands = shown.iter().map(|shaped| shaped.numbers.command.clone()).collect();
    let evidence = Evidence::of(bench)?;
    let mut listed: Vec<_> = evidence.shown().map(Clone::clone).into();
    listed.push(shapes[Shared::MinMaxMean].numbers.clone());
    Ok(Item {
        title: "Figure 10. The hole, and whether it is filled".into(),
        paper: "Left, common weight 0 and α = 10; right, barycentric weights and α = 10. “In the \
                left image, we can find hole (cavity). In the right image, the hole is filled.”"
            .into(),
        ours: "Above, the paper's pair; below, weights that do change the shape: N times equation \
               4.2, and min-max. All from one camera at one scale."
            .into(),
        picture: Some(bench.file("figure-10.png", drawn.to_png()?)),
        commands,
        shapes: listed,
        facts: evidence.facts(),
        tables: vec![voids(evidence.shown())],
        findings: judge(&CLAIMS, &evidence),
        ..Item::default()
    })
}

/// Whether some weighted shape has fewer and smaller holes than ω = 0, both at the same α and at α plus the mean weight.
fn improvement(plain: &ShapeNumbers, trials: [Trial<'_>; 2]) -> Verdict {
    let less = |of: &dyn Fn(&ShapeNumbers) -> f64, trial: &Trial<'_>| {
        of(trial.weighted) < of(plain).min(of(trial.raised))
    };
    let fewer = |trial: &&Trial<'_>| less(&|n| n.holes() as f64, trial);
    let smaller = |trial: &Trial<'_>| less(&|n| n.void_volume, trial);
    let better: Vec<_> = trials.iter().filter(fewer).collect();
    if better.is_empty() {
        Verdict::NotReproduced
    } else if better.into_iter().any(smaller) {
        Verdict::Reproduced
    } else {
        Verdict::Undecided
    }
}

fn against(Trial { weighted: w, raised: r }: Trial<'_>) -> String {
    format!(
        "{} and {} with {}, against {} and {} without weights at α plus their mean, {}",
        w.holes(),
        text::number(w.void_volume),
        w.label,
        r.holes(),
        text::number(r.void_volume),
        text::number(r.alpha.squared())
    )
}

/// The largest voids of each shape.
fn voids(shown: [&ShapeNumbers; 4]) -> Table {
    const MOST: usize = 3;
    let rows = shown.into_iter().flat_map(|n| {
        n.largest_voids.iter().take(MOST).map(|void| {
            let corner = |p: [f64; 3]| p.map(text::number).join(", ");
            vec![
                n.label.clone(),
                void.cells.to_string(),
                text::number(void.volume),
                format!("({}) to ({})", corner(void.low), corner(void.high)),
                text::number(void.filling_alpha.squared()),
            ]
        })
    });
    Table {
        caption: format!("The largest voids of each, at most {MOST} (voxels)"),
        head: ["shape", "cells", "volume", "box (x, y, z)", "α that fills it"]
            .map(String::from)
            .into(),
        rows: rows.collect(),
    }
}
