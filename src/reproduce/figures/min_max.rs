use super::bench::{Bench, figure};
use super::bench::{Claim, judge};
use crate::reproduce::compare::Difference;
use crate::reproduce::study::{ALPHA, Shapes, Shared};
use crate::reproduce::{Fact, Item, ReproduceError, ShapeNumbers, Verdict, text};

/// The shape in both readings of "radius".
struct Evidence {
    /// Squared radius α + ω.
    power: ShapeNumbers,
    /// Radius α + ω.
    radius: ShapeNumbers,
    /// Simplices of only one reading.
    apart: Difference,
}

impl Evidence {
    fn of(shapes: &Shapes) -> Self {
        let (power, radius) = (&shapes[Shared::MinMax], &shapes[Shared::MinMaxRadius]);
        Self {
            power: power.numbers.clone(),
            radius: radius.numbers.clone(),
            apart: Difference::between(power.shape.complex(), radius.shape.complex()),
        }
    }

    fn facts(&self) -> Vec<Fact> {
        vec![
            Fact::count("cells of one reading only", self.apart.cells),
            Fact::count("boundary facets of one reading only", self.apart.boundary),
        ]
    }
}

const CLAIMS: [Claim<Evidence>; 3] = [
    Claim {
        text: "The result does not necessarily connect all the given points.",
        decide: |Evidence { power: n, .. }| {
            let reason = format!(
                "{} of {} points are vertices of the shape; {} are hidden: heavier neighbours \
                 leave them no cell of the power diagram",
                n.points_in_shape, n.points, n.hidden
            );
            (Verdict::of(n.points_in_shape < n.points), reason)
        },
    },
    Claim {
        text: "Weights are at most α, so the size of a ball at most doubles (α + α = 2α).",
        decide: |Evidence { power: n, .. }| {
            let largest = ALPHA + n.weights.max;
            let reason = format!(
                "weights from {} to {}: squared radii up to {}, radii up to {:.3}, which is √2 times \
                 √α. It is the squared radius that doubles",
                text::number(n.weights.min),
                text::number(n.weights.max),
                text::number(largest),
                largest.sqrt()
            );
            (Verdict::of(n.weights.min >= 0.0 && largest == 2.0 * ALPHA), reason)
        },
    },
    Claim {
        text: "“We may think of radii, which are α + ω.”",
        decide: |Evidence { power, radius, apart }| {
            if *apart == (Difference { cells: 0, boundary: 0 }) {
                return (Verdict::Reproduced, "both readings give the same shape".into());
            }
            let reason = format!(
                "the paper also defines p₊α = (p′, ω + α) as a weighted point, whose squared \
                 radius is α + ω; the two readings differ in {} cells and {} boundary facets, \
                 volume {} against {}, and the paper does not say which its figures show",
                apart.cells,
                apart.boundary,
                text::number(power.volume),
                text::number(radius.volume)
            );
            (Verdict::Undecided, reason)
        },
    },
];

/// Figure 8: min-max weights, in both readings of "radius".
pub(super) fn figure_8(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let shapes = bench.shapes;
    let (power, radius) = (&shapes[Shared::MinMax], &shapes[Shared::MinMaxRadius]);
    let panels = vec![
        bench.shape_panel("squared radius α + ω (power)", power)?,
        bench.shape_panel("radius α + ω", radius)?,
    ];
    let title = format!("Figure 8. Weights by min-max (equation 4.1), α = {ALPHA}");
    let drawn = figure(&title, panels);
    let evidence = Evidence::of(shapes);
    Ok(Item {
        title: "Figure 8. Weights by min-max".into(),
        paper:
            "ω = α·(L − Lmin)/(Lmax − Lmin): weights from 0 to α by the difference of gray value \
                (equation 4.1)."
                .into(),
        ours:
            "Left, the usual meaning of a weight, as in Edelsbrunner's report and in CGAL; right, \
               the other reading of the paper's section 4.2."
                .into(),
        picture: Some(bench.file("figure-08.png", drawn.to_png()?)),
        commands: vec![power.makes("figure-08-power.ply"), radius.makes("figure-08-radius.ply")],
        files: vec![
            bench.mesh("figure-08-power.ply", power)?,
            bench.mesh("figure-08-radius.ply", radius)?,
        ],
        facts: evidence.facts(),
        findings: judge(&CLAIMS, &evidence),
        shapes: vec![evidence.power, evidence.radius],
        ..Item::default()
    })
}
