use super::super::compare::Difference;
use super::super::study::ALPHA;
use super::super::{Fact, Finding, Item, ReproduceError, Verdict, text};
use super::{Bench, figure};

/// Figure 8: min-max weights, in both readings of "radius".
pub(super) fn figure_8(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let shapes = bench.shapes;
    let (power, radius) = (&shapes.min_max, &shapes.min_max_radius);
    let panels = vec![
        bench.shape_panel("squared radius α + ω (power)", power, 2)?,
        bench.shape_panel("radius α + ω", radius, 2)?,
    ];
    let title = format!("Figure 8. Weights by min-max (equation 4.1), α = {ALPHA}");
    let picture = bench.file("figure-08.png", figure(&title, 2, panels).to_png()?);

    let (n, r) = (&power.numbers, &radius.numbers);
    let apart = Difference::between(power.shape.complex(), radius.shape.complex());
    let same = apart == Difference { cells: 0, boundary: 0 };
    let largest = ALPHA + n.weights.max;
    let findings = vec![
        Finding {
            claim: "The result does not necessarily connect all the given points.".into(),
            verdict: Verdict::of(n.points_in_shape < n.points),
            reason: format!(
                "{} of {} points are vertices of the shape; {} are hidden: heavier neighbours \
                 leave them no cell of the power diagram",
                n.points_in_shape, n.points, n.hidden
            ),
        },
        Finding {
            claim: "Weights are at most α, so the size of a ball at most doubles (α + α = 2α)."
                .into(),
            verdict: Verdict::of(n.weights.min >= 0.0 && largest == 2.0 * ALPHA),
            reason: format!(
                "weights from {} to {}: squared radii up to {}, radii up to {:.3}, which is √2 times \
                 √α. It is the squared radius that doubles",
                text::number(n.weights.min),
                text::number(n.weights.max),
                text::number(largest),
                largest.sqrt()
            ),
        },
        Finding {
            claim: "\"We may think of radii, which are α + ω.\"".into(),
            verdict: if same { Verdict::Reproduced } else { Verdict::Undecided },
            reason: if same {
                "both readings give the same shape".into()
            } else {
                format!(
                    "the paper also defines p₊α = (p′, ω + α) as a weighted point, whose squared \
                     radius is α + ω; the two readings differ in {} cells and {} boundary facets, \
                     volume {} against {}, and the paper does not say which its figures show",
                    apart.cells,
                    apart.boundary,
                    text::number(n.volume),
                    text::number(r.volume)
                )
            },
        },
    ];
    let commands = vec![
        bench.drawing_command(power, 2, "figure-08-power.png"),
        bench.drawing_command(radius, 2, "figure-08-radius.png"),
    ];
    Ok(Item {
        id: "figure-8",
        title: "Figure 8. Weights by min-max".into(),
        paper:
            "ω = α·(L − Lmin)/(Lmax − Lmin): weights from 0 to α by the difference of gray value \
                (equation 4.1)."
                .into(),
        ours:
            "Left, the usual meaning of a weight, as in Edelsbrunner's report and in CGAL; right, \
               the other reading of the paper's section 4.2."
                .into(),
        picture: Some(picture),
        commands,
        shapes: vec![n.clone(), r.clone()],
        facts: vec![
            Fact::count("cells of one reading only", apart.cells),
            Fact::count("boundary facets of one reading only", apart.boundary),
        ],
        findings,
        ..Item::default()
    })
}

/// Figure 9: barycentric weights, as printed and N times that.
pub(super) fn figure_9(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let shapes = bench.shapes;
    let (literal, scaled, plain) = (&shapes.barycentric, &shapes.barycentric_n, &shapes.plain);
    let panels = vec![
        bench.shape_panel("equation 4.2 as printed", literal, 2)?,
        bench.shape_panel("N times equation 4.2 (ours)", scaled, 2)?,
    ];
    let title = format!("Figure 9. Barycentric weights (equation 4.2), α = {ALPHA}");
    let picture = bench.file("figure-09.png", figure(&title, 2, panels).to_png()?);

    let weights = &literal.shape.points().weights;
    let sum: f64 = weights.iter().sum();
    let (n, s) = (&literal.numbers, &scaled.numbers);
    let apart = Difference::between(plain.shape.complex(), literal.shape.complex());
    let scaled_apart = Difference::between(plain.shape.complex(), scaled.shape.complex());
    let share = n.weights.max / ALPHA;
    let findings = vec![
        Finding {
            claim: "Each weight is a portion of α: together they are α.".into(),
            verdict: Verdict::of((sum - ALPHA).abs() <= 1e-9 * ALPHA),
            reason: format!(
                "the weights sum to {}; their mean is {}, the largest is {}",
                text::number(sum),
                text::number(n.weights.mean),
                text::number(n.weights.max)
            ),
        },
        Finding {
            claim: "Barycentric weights give another shape than no weights.".into(),
            verdict: Verdict::of(apart.boundary > 0),
            reason: format!(
                "as printed: {} boundary facets and {} cells differ from ω = 0, b₁ and b₂ are {} and \
                 {} against {} and {}; the largest weight changes a squared radius by {} %. N times \
                 that: {} boundary facets and {} cells differ, b₁ and b₂ are {} and {}",
                apart.boundary,
                apart.cells,
                n.betti.b1,
                n.betti.b2,
                plain.numbers.betti.b1,
                plain.numbers.betti.b2,
                text::number(100.0 * share),
                scaled_apart.boundary,
                scaled_apart.cells,
                s.betti.b1,
                s.betti.b2
            ),
        },
    ];
    let commands = vec![
        bench.drawing_command(literal, 2, "figure-09-literal.png"),
        bench.drawing_command(scaled, 2, "figure-09-n.png"),
    ];
    Ok(Item {
        id: "figure-9",
        title: "Figure 9. Barycentric weights".into(),
        paper: "ω = α·L/ΣL: each point has its portion of α (equation 4.2).".into(),
        ours:
            "Left, the equation as printed, whose weights are tiny, because all of them together \
               make one α; right, N times that, so that the mean weight is α. The second is not in \
               the paper."
                .into(),
        picture: Some(picture),
        commands,
        shapes: vec![n.clone(), s.clone()],
        facts: vec![
            Fact::new("sum of the weights as printed", sum),
            Fact::count("boundary facets that differ from ω = 0, as printed", apart.boundary),
            Fact::count("cells that differ from ω = 0, as printed", apart.cells),
            Fact::count("boundary facets that differ from ω = 0, N times", scaled_apart.boundary),
            Fact::count("cells that differ from ω = 0, N times", scaled_apart.cells),
        ],
        findings,
        ..Item::default()
    })
}
