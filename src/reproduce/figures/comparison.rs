use super::super::compare::{Difference, PixelDifference, same_set};
use super::super::stage::Eye;
use super::super::study::{ALPHA, Shaped};
use super::super::{Fact, Finding, Item, ReproduceError, ShapeNumbers, Table, Verdict, text};
use super::{Bench, figure};

/// Figure 10: without weights and with barycentric ones; what would change the picture beside.
pub(super) fn figure_10(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let shapes = bench.shapes;
    let (plain, literal) = (&shapes.plain, &shapes.barycentric);
    let (scaled, min_max) = (&shapes.barycentric_n, &shapes.min_max);
    let panels = vec![
        bench.shape_panel("ω = 0 (the paper's left image)", plain)?,
        bench.shape_panel("barycentric, equation 4.2 (its right image)", literal)?,
        bench.shape_panel("N × barycentric (not in the paper)", scaled)?,
        bench.shape_panel("min-max, equation 4.1", min_max)?,
    ];
    let title = format!("Figure 10. Unweighted and weighted shapes at α = {ALPHA}, one camera");
    let picture = bench.file("figure-10.png", figure(&title, panels).to_png()?);

    let (left, right) = (bench.view(plain, Eye::Portrait)?, bench.view(literal, Eye::Portrait)?);
    let pixels = PixelDifference::between(&left, &right);
    let apart = Difference::between(plain.shape.complex(), literal.shape.complex());
    let (l, r) = (&plain.numbers, &literal.numbers);
    let same = same_set(&plain.shape, &literal.shape);
    let filled = !same && (r.betti.b1 < l.betti.b1 || r.betti.b2 < l.betti.b2);
    // Raising α for all points is what weights must be better than.
    let trials = [(min_max, &shapes.min_max_mean), (scaled, &shapes.shifted)];
    let improved = improvement(l, &trials);
    let findings = vec![
        Finding {
            claim: "“In the left image, we can find hole (cavity).”".into(),
            verdict: Verdict::of(l.holes() > 0),
            reason: format!(
                "ω = 0 has {} and {}, the voids of volume {}",
                text::count(l.betti.b1, "tunnel", "tunnels"),
                text::count(l.betti.b2, "void", "voids"),
                text::number(l.void_volume)
            ),
        },
        Finding {
            claim: "“In the right image, the hole is filled.”".into(),
            verdict: Verdict::of(filled),
            reason: format!(
                "with equation 4.2 as printed b₁ is {} after {}, b₂ {} after {}, the voids' volume {} \
                 after {}; the two shapes are {} set of points in space. {} of {} pixels differ, by \
                 {} of 255 at most{}. N times these weights leave {} and {}, min-max {} and {}",
                r.betti.b1,
                l.betti.b1,
                r.betti.b2,
                l.betti.b2,
                text::number(r.void_volume),
                text::number(l.void_volume),
                if same { "the same" } else { "not the same" },
                pixels.pixels,
                left.pixels().len(),
                pixels.largest,
                if same { ", where triangles that are cut otherwise are shaded" } else { "" },
                text::count(scaled.numbers.betti.b1, "tunnel", "tunnels"),
                text::count(scaled.numbers.betti.b2, "void", "voids"),
                text::count(min_max.numbers.betti.b1, "tunnel", "tunnels"),
                text::count(min_max.numbers.betti.b2, "void", "voids"),
            ),
        },
        Finding {
            claim: "Weights can improve on what unweighted (common weighted) shapes do.".into(),
            verdict: improved,
            reason: format!(
                "tunnels and voids together, and the voids' volume: {} and {} with ω = 0 at \
                 α = {ALPHA}; {}. Weights improve a shape if both are less than without weights at \
                 either α; if only the count is, the measures disagree",
                l.holes(),
                text::number(l.void_volume),
                trials.map(|(weighted, unweighted)| against(weighted, unweighted)).join("; ")
            ),
        },
    ];
    let shown = [plain, literal, scaled, min_max];
    let names = ["omega-0", "barycentric", "barycentric-n", "min-max"];
    let commands = shown
        .iter()
        .zip(names)
        .map(|(shaped, name)| bench.drawing_command(shaped, &format!("figure-10-{name}.png")));
    let commands = commands.collect();
    let mut listed: Vec<_> = shown.iter().map(|shaped| shaped.numbers.clone()).collect();
    listed.push(shapes.min_max_mean.numbers.clone());
    let voids = voids(&shown);
    Ok(Item {
        id: "figure-10",
        title: "Figure 10. The hole, and whether it is filled".into(),
        paper: "Left, common weight 0 and α = 10; right, barycentric weights and α = 10. “In the \
                left image, we can find hole (cavity). In the right image, the hole is filled.”"
            .into(),
        ours: "Above, the paper's pair; below, weights that do change the shape: N times equation \
               4.2, and min-max. All from one camera at one scale."
            .into(),
        picture: Some(picture),
        commands,
        shapes: listed,
        facts: vec![
            Fact::count("boundary facets that differ between left and right", apart.boundary),
            Fact::count("cells that differ between left and right", apart.cells),
            Fact::count("pixels that differ between left and right", pixels.pixels),
            Fact::new("largest difference of a pixel (of 255)", pixels.largest.into()),
            Fact::count("pixels of each", left.pixels().len()),
        ],
        tables: vec![voids],
        findings,
        ..Item::default()
    })
}

/// Whether some weighted shape has fewer and smaller holes than ω = 0 has, at the same α and at α
/// plus the mean weight.
fn improvement(plain: &ShapeNumbers, trials: &[(&Shaped, &Shaped)]) -> Verdict {
    let less = |of: &dyn Fn(&ShapeNumbers) -> f64, (weighted, raised): &(&Shaped, &Shaped)| {
        let least = of(plain).min(of(&raised.numbers));
        of(&weighted.numbers) < least
    };
    let fewer = |trial: &&(&Shaped, &Shaped)| less(&|n| n.holes() as f64, trial);
    let smaller = |trial: &(&Shaped, &Shaped)| less(&|n| n.void_volume, trial);
    let better: Vec<_> = trials.iter().filter(fewer).collect();
    if better.is_empty() {
        Verdict::NotReproduced
    } else if better.into_iter().any(smaller) {
        Verdict::Reproduced
    } else {
        Verdict::Undecided
    }
}

fn against(weighted: &Shaped, raised: &Shaped) -> String {
    let (w, r) = (&weighted.numbers, &raised.numbers);
    format!(
        "{} and {} with {}, against {} and {} without weights at α plus their mean, {}",
        w.holes(),
        text::number(w.void_volume),
        w.label,
        r.holes(),
        text::number(r.void_volume),
        text::number(r.alpha)
    )
}

/// The largest voids of each shape.
fn voids(shown: &[&Shaped]) -> Table {
    const MOST: usize = 3;
    let rows = shown.iter().flat_map(|shaped| {
        let n = &shaped.numbers;
        n.largest_voids.iter().take(MOST).map(|void| {
            let corner = |p: [f64; 3]| p.map(text::number).join(", ");
            vec![
                n.label.clone(),
                void.cells.to_string(),
                text::number(void.volume),
                format!("({}) to ({})", corner(void.low), corner(void.high)),
                text::number(void.filling_alpha),
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
