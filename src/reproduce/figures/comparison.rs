use super::super::compare::{self, Difference};
use super::super::study::{ALPHA, Shaped};
use super::super::{Fact, Finding, Item, ReproduceError, Table, Verdict, text};
use super::{Bench, figure};

/// Figure 10: without weights and with barycentric ones; what would change the picture beside.
pub(super) fn figure_10(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let shapes = bench.shapes;
    let (plain, literal) = (&shapes.plain, &shapes.barycentric);
    let (scaled, min_max) = (&shapes.barycentric_n, &shapes.min_max);
    let panels = vec![
        bench.shape_panel("ω = 0 (the paper's left image)", plain, 2)?,
        bench.shape_panel("barycentric, equation 4.2 (its right image)", literal, 2)?,
        bench.shape_panel("N × barycentric (not in the paper)", scaled, 2)?,
        bench.shape_panel("min-max, equation 4.1", min_max, 2)?,
    ];
    let title = format!("Figure 10. Unweighted and weighted shapes at α = {ALPHA}, one camera");
    let picture = bench.file("figure-10.png", figure(&title, 2, panels).to_png()?);

    let (left, right) = (bench.view(plain, 2)?, bench.view(literal, 2)?);
    let pixels = compare::pixels(&left, &right);
    let apart = Difference::between(plain.shape.complex(), literal.shape.complex());
    let (l, r) = (&plain.numbers, &literal.numbers);
    let filled = r.betti.b1 < l.betti.b1 || r.betti.b2 < l.betti.b2;
    // Raising α for all points is what weights must be better than.
    let trials = [(min_max, &shapes.min_max_mean), (scaled, &shapes.shifted)];
    let fewer = |(weighted, unweighted): &(&Shaped, &Shaped)| {
        let holes = weighted.numbers.holes();
        holes < l.holes() && holes < unweighted.numbers.holes()
    };
    let findings = vec![
        Finding {
            claim: "\"In the left image, we can find hole (cavity).\"".into(),
            verdict: Verdict::of(l.holes() > 0),
            reason: format!(
                "ω = 0 has {} and {}, the voids of volume {}",
                text::count(l.betti.b1, "tunnel", "tunnels"),
                text::count(l.betti.b2, "void", "voids"),
                text::number(l.void_volume)
            ),
        },
        Finding {
            claim: "\"In the right image, the hole is filled.\"".into(),
            verdict: Verdict::of(filled),
            reason: format!(
                "with equation 4.2 as printed b₁ is {} after {}, b₂ {} after {}, the voids' volume {} \
                 after {}; {} boundary facets differ, and {} of {} pixels of the two pictures. N \
                 times these weights leave {} and {}, min-max {} and {}",
                r.betti.b1,
                l.betti.b1,
                r.betti.b2,
                l.betti.b2,
                text::number(r.void_volume),
                text::number(l.void_volume),
                apart.boundary,
                pixels,
                left.pixels().len(),
                text::count(scaled.numbers.betti.b1, "tunnel", "tunnels"),
                text::count(scaled.numbers.betti.b2, "void", "voids"),
                text::count(min_max.numbers.betti.b1, "tunnel", "tunnels"),
                text::count(min_max.numbers.betti.b2, "void", "voids"),
            ),
        },
        Finding {
            claim: "Weights can improve on what unweighted (common weighted) shapes do.".into(),
            verdict: Verdict::of(trials.iter().any(fewer)),
            reason: format!(
                "tunnels and voids: {} with ω = 0 at α = {ALPHA}; {}. A weighted shape improves if it \
                 has fewer than both",
                l.holes(),
                trials.map(|(weighted, unweighted)| against(weighted, unweighted)).join("; ")
            ),
        },
    ];
    let shown = [plain, literal, scaled, min_max];
    let names = ["omega-0", "barycentric", "barycentric-n", "min-max"];
    let commands = shown
        .iter()
        .zip(names)
        .map(|(shaped, name)| bench.drawing_command(shaped, 2, &format!("figure-10-{name}.png")));
    let commands = commands.collect();
    let mut listed: Vec<_> = shown.iter().map(|shaped| shaped.numbers.clone()).collect();
    listed.push(shapes.min_max_mean.numbers.clone());
    let voids = voids(&shown);
    Ok(Item {
        id: "figure-10",
        title: "Figure 10. The hole, and whether it is filled".into(),
        paper: "Left, common weight 0 and α = 10; right, barycentric weights and α = 10. \"In the \
                left image, we can find hole (cavity). In the right image, the hole is filled.\""
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
            Fact::count("pixels that differ between left and right", pixels),
            Fact::count("pixels of each", left.pixels().len()),
        ],
        tables: vec![voids],
        findings,
        ..Item::default()
    })
}

fn against(weighted: &Shaped, unweighted: &Shaped) -> String {
    let (w, u) = (&weighted.numbers, &unweighted.numbers);
    format!(
        "{}: {}, against {} without weights at α plus their mean ({})",
        w.label,
        w.holes(),
        u.holes(),
        text::number(u.alpha)
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
            ]
        })
    });
    Table {
        caption: format!("The largest voids of each, at most {MOST} (voxels)"),
        head: ["shape", "cells", "volume", "box (x, y, z)"].map(String::from).into(),
        rows: rows.collect(),
    }
}
