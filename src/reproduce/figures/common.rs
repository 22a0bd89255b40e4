use super::super::hull::Hull;
use super::super::study::{ALPHA, COMMON};
use super::super::{Fact, Finding, Item, ReproduceError, Table, Verdict, text};
use super::{Bench, figure};

/// Figure 6: ω = 0, and how the shape depends on α.
pub(super) fn figure_6(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let shapes = bench.shapes;
    let plain = &shapes.plain;
    let title = format!("Figure 6. Common factor 0, α = {ALPHA} (√α = {:.3} voxels)", ALPHA.sqrt());
    let drawn = figure(&title, bench.two_views(plain)?);
    let picture = bench.file("figure-06.png", drawn.to_png()?);

    let ladder = shapes.by_alpha();
    let rows = ladder.iter().map(|shaped| {
        let n = &shaped.numbers;
        let cells = [n.cells as u64, n.betti.b0, n.betti.b1, n.betti.b2].map(|v| v.to_string());
        let sizes = [n.volume, n.void_volume].map(text::number);
        [&[text::number(n.alpha)], &cells[..], &sizes].concat()
    });
    let table = Table {
        caption: "The unweighted shape at other α (squared lengths)".into(),
        head: ["α", "cells", "b0", "b1", "b2", "volume", "volume of voids"]
            .map(String::from)
            .into(),
        rows: rows.collect(),
    };
    let volumes: Vec<f64> = ladder.iter().map(|shaped| shaped.numbers.volume).collect();
    let grows = volumes.windows(2).all(|pair| pair[0] <= pair[1])
        && volumes[0] < volumes[volumes.len() - 1];
    let largest = ladder.last().expect("a ladder has steps");
    let hollow = ladder.iter().max_by_key(|shaped| shaped.numbers.betti.b2).expect("steps");
    let hull = Hull::of(&largest.shape);
    let cells = largest.numbers.volume;
    // The facets' determinants are whole numbers; so are the cells'.
    let same = (hull.volume - cells).abs() <= 1e-9 * cells;
    let findings = vec![
        Finding {
            claim: "As α increases the shape expands, as it decreases it shrinks.".into(),
            verdict: Verdict::of(grows),
            reason: format!(
                "the volume goes from {} at α = {} to {} at α = {}, without a step back",
                text::number(volumes[0]),
                text::number(ladder[0].numbers.alpha),
                text::number(cells),
                text::number(largest.numbers.alpha)
            ),
        },
        Finding {
            claim: "As α decreases the shape develops cavities.".into(),
            verdict: Verdict::of(hollow.numbers.betti.b2 > largest.numbers.betti.b2),
            reason: format!(
                "{} at α = ∞, {} at α = {}",
                text::count(largest.numbers.betti.b2, "void", "voids"),
                text::count(hollow.numbers.betti.b2, "void", "voids"),
                text::number(hollow.numbers.alpha)
            ),
        },
        Finding {
            claim: "For α = ∞ the α-shape is the convex hull of the points.".into(),
            verdict: Verdict::of(hull.outside == 0 && same),
            reason: format!(
                "{} of {} points lie beyond one of the {} boundary facets at α = ∞; the facets \
                 enclose {}, the cells fill {}",
                hull.outside,
                largest.numbers.points,
                hull.facets,
                text::number(hull.volume),
                text::number(cells)
            ),
        },
    ];
    let command = bench.drawing_command(plain, "figure-06.png");
    Ok(Item {
        id: "figure-6",
        title: "Figure 6. Common factor 0".into(),
        paper: "All points weigh 0: the unweighted α-shape, at α = 10. It shrinks and develops \
                cavities as α decreases, and becomes the convex hull as α grows."
            .into(),
        ours:
            "The boundary of the shape, from two sides. The paper prints no count to compare with; \
               ours stand below."
                .into(),
        picture: Some(picture),
        commands: vec![command],
        files: vec![bench.mesh("figure-06.ply", plain)?],
        shapes: vec![plain.numbers.clone()],
        facts: vec![
            Fact::new("volume of the convex hull, by its facets", hull.volume),
            Fact::count("facets of the convex hull", hull.facets),
        ],
        tables: vec![table],
        findings,
    })
}

/// Figure 7: ω = 10 for all, which is α = 20 without weights.
pub(super) fn figure_7(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let shapes = bench.shapes;
    let (common, shifted, plain) = (&shapes.common, &shapes.shifted, &shapes.plain);
    let alpha = ALPHA + COMMON;
    let title = format!(
        "Figure 7. Common factor {COMMON}, α = {ALPHA}: the unweighted shape at α = {alpha}"
    );
    let drawn = figure(&title, bench.two_views(common)?);
    let picture = bench.file("figure-07.png", drawn.to_png()?);

    let (a, b) = (common.shape.complex(), shifted.shape.complex());
    let same = a == b;
    let simplices = |c: &crate::shape::Complex| {
        c.cells.len() + c.facets.len() + c.edges.len() + c.vertices.len()
    };
    let (n, m) = (&common.numbers, &plain.numbers);
    let findings = vec![
        Finding {
            claim:
                "Equal weights give the same triangulation as none, and p with weight ω at α is \
                    p with weight ω + α: a common factor is a shift of α."
                    .into(),
            verdict: Verdict::of(same),
            reason: format!(
                "ω = {COMMON} at α = {ALPHA} has {} simplices, exterior ones included, ω = 0 at \
                 α = {alpha} has {}; with their classes they are {}",
                simplices(a),
                simplices(b),
                if same { "the same, row by row" } else { "not the same" }
            ),
        },
        Finding {
            claim: "A larger common factor expands the shape.".into(),
            verdict: Verdict::of(n.volume > m.volume),
            reason: format!(
                "volume {} with factor {COMMON}, {} with 0; {} tunnels and {} voids against {} and {}",
                text::number(n.volume),
                text::number(m.volume),
                n.betti.b1,
                n.betti.b2,
                m.betti.b1,
                m.betti.b2
            ),
        },
    ];
    let command = bench.drawing_command(common, "figure-07.png");
    Ok(Item {
        id: "figure-7",
        title: "Figure 7. Common factor 10".into(),
        paper: "All points weigh 10, at α = 10.".into(),
        ours: format!(
            "A common factor adds nothing that α cannot do: this is the unweighted shape at \
             α = {alpha}, and was computed both ways."
        ),
        picture: Some(picture),
        commands: vec![command, shifted.numbers.command.clone()],
        files: vec![bench.mesh("figure-07.ply", common)?],
        shapes: vec![common.numbers.clone(), shifted.numbers.clone()],
        findings,
        ..Item::default()
    })
}
