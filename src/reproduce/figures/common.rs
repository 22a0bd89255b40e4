use super::bench::{Bench, figure};
use super::bench::{Claim, judge};
use crate::reproduce::study::{ALPHA, COMMON, Shapes, Shared};
use crate::reproduce::{Item, ReproduceError, ShapeNumbers, Verdict, text};
use crate::shape::Complex;

/// The α at which the shape without weights equals the one with the common factor.
const SHIFTED: f64 = ALPHA + COMMON;

/// The shape with the common factor, and two without weights.
struct Evidence {
    /// ω = 10 at α = 10.
    common: ShapeNumbers,
    /// ω = 0 at α = 10.
    plain: ShapeNumbers,
    /// Simplices of ω = 10 at α = 10 and of ω = 0 at α = 20, exterior ones included.
    simplices: [usize; 2],
    /// Whether these two are the same, classes included.
    same: bool,
}

impl Evidence {
    fn of(shapes: &Shapes) -> Self {
        let (a, b) =
            (shapes[Shared::Common].shape.complex(), shapes[Shared::Shifted].shape.complex());
        let simplices =
            |c: &Complex| c.cells.len() + c.facets.len() + c.edges.len() + c.vertices.len();
        Self {
            common: shapes[Shared::Common].numbers.clone(),
            plain: shapes[Shared::Plain].numbers.clone(),
            simplices: [simplices(a), simplices(b)],
            same: a == b,
        }
    }
}

const CLAIMS: [Claim<Evidence>; 2] = [
    Claim {
        text: "Equal weights give the same triangulation as none, and p with weight ω at α is p \
               with weight ω + α: a common factor is a shift of α.",
        decide: |e| {
            let [common, shifted] = e.simplices;
            let reason = format!(
                "ω = {COMMON} at α = {ALPHA} has {common} simplices, exterior ones included, ω = 0 \
                 at α = {SHIFTED} has {shifted}; with their classes they are {}",
                if e.same { "the same, row by row" } else { "not the same" }
            );
            (Verdict::of(e.same), reason)
        },
    },
    Claim {
        text: "A larger common factor expands the shape.",
        decide: |Evidence { common: n, plain: m, .. }| {
            let reason = format!(
                "volume {} with factor {COMMON}, {} with 0; {} tunnels and {} voids against {} and {}",
                text::number(n.volume),
                text::number(m.volume),
                n.betti.b1,
                n.betti.b2,
                m.betti.b1,
                m.betti.b2
            );
            (Verdict::of(n.volume > m.volume), reason)
        },
    },
];

/// Figure 7: ω = 10 for all, which is α = 20 without weights.
pub(super) fn figure_7(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let (common, shifted) = (&bench.shapes[Shared::Common], &bench.shapes[Shared::Shifted]);
    let title = format!(
        "Figure 7. Common factor {COMMON}, α = {ALPHA}: the unweighted shape at α = {SHIFTED}"
    );
    let drawn = figure(&title, bench.two_views(common)?);
    Ok(Item {
        title: "Figure 7. Common factor 10".into(),
        paper: "All points weigh 10, at α = 10.".into(),
        ours: format!(
            "A common factor adds nothing that α cannot do: this is the unweighted shape at \
             α = {SHIFTED}, and was computed both ways."
        ),
        picture: Some(bench.file("figure-07.png", drawn.to_png()?)),
        commands: vec![common.makes("figure-07.ply"), shifted.numbers.command.clone()],
        files: vec![bench.mesh("figure-07.ply", common)?],
        shapes: vec![common.numbers.clone(), shifted.numbers.clone()],
        findings: judge(&CLAIMS, &Evidence::of(bench.shapes)),
        ..Item::default()
    })
}
