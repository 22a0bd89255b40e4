use super::super::compare::{Difference, same_set};
use super::super::study::ALPHA;
use super::super::{Fact, Finding, Item, ReproduceError, Verdict, text};
use super::{Bench, figure};

/// Figure 8: min-max weights, in both readings of "radius".
pub(super) fn figure_8(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let shapes = bench.shapes;
    let (power, radius) = (&shapes.min_max, &shapes.min_max_radius);
    let panels = vec![
        bench.shape_panel("squared radius α + ω (power)", power)?,
        bench.shape_panel("radius α + ω", radius)?,
    ];
    let title = format!("Figure 8. Weights by min-max (equation 4.1), α = {ALPHA}");
    let picture = bench.file("figure-08.png", figure(&title, panels).to_png()?);

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
            claim: "“We may think of radii, which are α + ω.”".into(),
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
        bench.drawing_command(power, "figure-08-power.png"),
        bench.drawing_command(radius, "figure-08-radius.png"),
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
        files: vec![
            bench.mesh("figure-08-power.ply", power)?,
            bench.mesh("figure-08-radius.ply", radius)?,
        ],
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
        bench.shape_panel("equation 4.2 as printed", literal)?,
        bench.shape_panel("N times equation 4.2 (ours)", scaled)?,
    ];
    let title = format!("Figure 9. Barycentric weights (equation 4.2), α = {ALPHA}");
    let picture = bench.file("figure-09.png", figure(&title, panels).to_png()?);

    let weights = &literal.shape.points().weights;
    let sum: f64 = weights.iter().sum();
    let (n, s) = (&literal.numbers, &scaled.numbers);
    let apart = Difference::between(plain.shape.complex(), literal.shape.complex());
    let scaled_apart = Difference::between(plain.shape.complex(), scaled.shape.complex());
    let same = same_set(&plain.shape, &literal.shape);
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
            verdict: Verdict::of(!same),
            reason: format!(
                "as printed, the largest weight changes a squared radius by {} %; {} cells and {} \
                 boundary facets are not those of ω = 0, and {}. b₁ and b₂ are {} and {} against {} \
                 and {}. N times these weights are mean α: {} boundary facets are not those of \
                 ω = 0, b₁ and b₂ are {} and {}",
                text::number(100.0 * n.weights.max / ALPHA),
                apart.cells,
                apart.boundary,
                if same {
                    "yet both shapes are the same set of points in space: the facets are halves of \
                     the same polygons, cut along other diagonals"
                } else {
                    "the shapes are not the same set of points in space"
                },
                n.betti.b1,
                n.betti.b2,
                plain.numbers.betti.b1,
                plain.numbers.betti.b2,
                scaled_apart.boundary,
                s.betti.b1,
                s.betti.b2
            ),
        },
    ];
    let commands = vec![
        bench.drawing_command(literal, "figure-09-literal.png"),
        bench.drawing_command(scaled, "figure-09-n.png"),
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
        files: vec![
            bench.mesh("figure-09-literal.ply", literal)?,
            bench.mesh("figure-09-n.ply", scaled)?,
        ],
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
