use super::bench::{Bench, figure};
use super::bench::{Claim, judge};
use crate::reproduce::compare::{Difference, same_set};
use crate::reproduce::study::{ALPHA, Shapes, Shared};
use crate::reproduce::{Fact, Item, ReproduceError, ShapeNumbers, Verdict, text};

/// The shapes with barycentric weights, and the one without weights.
struct Evidence {
    /// ω = 0.
    plain: ShapeNumbers,
    /// Equation 4.2 as printed.
    literal: ShapeNumbers,
    /// Equation 4.2 times N.
    scaled: ShapeNumbers,
    /// The sum of the weights as printed.
    sum: f64,
    /// The difference from ω = 0, with the weights as printed.
    apart: Difference,
    /// The difference from ω = 0, with N times these weights.
    scaled_apart: Difference,
    /// Whether ω = 0 and the weights as printed give the same set of points in space.
    same: bool,
}

impl Evidence {
    fn of(shapes: &Shapes) -> Self {
        let (literal, scaled, plain) =
            (&shapes[Shared::Barycentric], &shapes[Shared::BarycentricN], &shapes[Shared::Plain]);
        let [from, to, n_times] = [plain, literal, scaled].map(|shaped| shaped.shape.complex());
        Self {
            plain: plain.numbers.clone(),
            literal: literal.numbers.clone(),
            scaled: scaled.numbers.clone(),
            sum: literal.shape.points().weights().iter().sum(),
            apart: Difference::between(from, to),
            scaled_apart: Difference::between(from, n_times),
            same: same_set(&plain.shape, &literal.shape),
        }
    }

    fn facts(&self) -> Vec<Fact> {
        let (apart, scaled) = (self.apart, self.scaled_apart);
        vec![
            Fact::new("sum of the weights as printed", self.sum),
            Fact::count("boundary facets that differ from ω = 0, as printed", apart.boundary),
            Fact::count("cells that differ from ω = 0, as printed", apart.cells),
            Fact::count("boundary facets that differ from ω = 0, N times", scaled.boundary),
            Fact::count("cells that differ from ω = 0, N times", scaled.cells),
        ]
    }
}

const CLAIMS: [Claim<Evidence>; 2] = [
    Claim {
        text: "Each weight is a portion of α: together they are α.",
        decide: |Evidence { literal: n, sum, .. }| {
            let reason = format!(
                "the weights sum to {}; their mean is {}, the largest is {}",
                text::number(*sum),
                text::number(n.weights.mean),
                text::number(n.weights.max)
            );
            (Verdict::of((sum - ALPHA).abs() <= 1e-9 * ALPHA), reason)
        },
    },
    Claim {
        text: "Barycentric weights give another shape than no weights.",
        decide: |e| {
            let (plain, literal, scaled) = (&e.plain.betti, &e.literal.betti, &e.scaled.betti);
            let reason = format!(
                "as printed, the largest weight changes a squared radius by {} %; {} cells and {} \
                 boundary facets are not those of ω = 0, and {}. b₁ and b₂ are {} and {} against {} \
                 and {}. N times these weights are mean α: {} boundary facets are not those of \
                 ω = 0, b₁ and b₂ are {} and {}",
                text::number(100.0 * e.literal.weights.max / ALPHA),
                e.apart.cells,
                e.apart.boundary,
                if e.same {
                    "yet both shapes are the same set of points in space: the facets are halves of \
                     the same polygons, cut along other diagonals"
                } else {
                    "the shapes are not the same set of points in space"
                },
                literal.b1,
                literal.b2,
                plain.b1,
                plain.b2,
                e.scaled_apart.boundary,
                scaled.b1,
                scaled.b2
            );
            (Verdict::of(!e.same), reason)
        },
    },
];

/// Figure 9: barycentric weights, as printed and N times that.
pub(super) fn figure_9(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let shapes = bench.shapes;
    let (literal, scaled) = (&shapes[Shared::Barycentric], &shapes[Shared::BarycentricN]);
    let panels = vec![
        bench.shape_panel("equation 4.2 as printed", literal)?,
        bench.shape_panel("N times equation 4.2 (ours)", scaled)?,
    ];
    let title = format!("Figure 9. Barycentric weights (equation 4.2), α = {ALPHA}");
    let drawn = figure(&title, panels);
    let evidence = Evidence::of(shapes);
    Ok(Item {
        title: "Figure 9. Barycentric weights".into(),
        paper: "ω = α·L/ΣL: each point has its portion of α (equation 4.2).".into(),
        ours:
            "Left, the equation as printed, whose weights are tiny, because all of them together \
               make one α; right, N times that, so that the mean weight is α. The second is not in \
               the paper."
                .into(),
        picture: Some(bench.file("figure-09.png", drawn.to_png()?)),
        commands: vec![literal.makes("figure-09-literal.ply"), scaled.makes("figure-09-n.ply")],
        files: vec![
            bench.mesh("figure-09-literal.ply", literal)?,
            bench.mesh("figure-09-n.ply", scaled)?,
        ],
        facts: evidence.facts(),
        findings: judge(&CLAIMS, &evidence),
        shapes: vec![evidence.literal, evidence.scaled],
        ..Item::default()
    })
}
