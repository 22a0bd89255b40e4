//! Figures 2 and 3: the shapes of Edelsbrunner, Kirkpatrick and Seidel over α.

use super::bench::{Bench, Claim, judge};
use crate::render::{Content, Drawing, Figure, PALETTE, Panel, Pen, Rgb, Size, Step};
use crate::reproduce::plane::curve::area;
use crate::reproduce::plane::{
    AlphaHull, Curvature, EksShape, OutlinePiece, eks_shape, sample_points,
};
use crate::reproduce::{Fact, Item, ReproduceError, Table, Verdict, text};

/// The α of Figure 2, from top to bottom: reciprocal lengths.
const NEGATIVE: [f64; 3] = [-2.0, -1.0, -0.5];
/// The α of Figure 3.
const POSITIVE: [f64; 3] = [0.05, 0.11, 0.16];

/// The hull at several α, ascending.
struct Growth {
    /// α, and the area of the hull.
    areas: Vec<[f64; 2]>,
}

impl Growth {
    fn of(ladder: &[Rung]) -> Self {
        Self { areas: ladder.iter().map(|rung| [rung.alpha, rung.hull_area()]).collect() }
    }
}

const GROWS: Claim<Growth> = Claim {
    text: "The α-hull grows with α.",
    decide: |Growth { areas }| {
        let step = |[alpha, area]: &[f64; 2]| {
            format!("{} at α = {}", text::number(*area), text::number(*alpha))
        };
        let steps: Vec<String> = areas.iter().map(step).collect();
        let grows = areas.windows(2).all(|pair| pair[0][1] < pair[1][1]);
        (Verdict::of(grows), format!("its area is {}", steps.join(", ")))
    },
};

/// The limit of positive α.
struct Limit {
    /// ρ, the radius of the smallest enclosing circle.
    enclosing: f64,
    /// The shapes 0.1 % below 1/ρ, and as much above.
    around: [Rung; 2],
}

impl Limit {
    fn find() -> Result<Self, ReproduceError> {
        // Discs this small contain no two of the points, so that the shape reveals ρ.
        let tiny = Rung::at(1e6)?;
        let enclosing = tiny.shape.no_disc().map_or(f64::NAN, |none| none.enclosing);
        Ok(Self { enclosing, around: [Rung::at(0.999 / enclosing)?, Rung::at(1.001 / enclosing)?] })
    }

    fn facts(&self) -> [Fact; 2] {
        [
            Fact::new("ρ, the radius of the smallest enclosing circle", self.enclosing),
            Fact::new("1/ρ, the largest α with a shape", self.enclosing.recip()),
        ]
    }
}

const LIMITED: Claim<Limit> = Claim {
    text: "A positive α must be sufficiently small.",
    decide: |Limit { enclosing, around: [below, beyond] }| {
        let limited = below.shape.no_disc().is_none() && beyond.shape.no_disc().is_some();
        let reason = format!(
            "0.1 % below 1/ρ = {} there are {} α-extreme points, 0.1 % above there are {}: no \
             disc is left that contains all points",
            text::number(enclosing.recip()),
            below.shape.extreme().len(),
            beyond.shape.extreme().len()
        );
        (Verdict::of(limited), reason)
    },
};

/// Figure 2: α-shapes of negative α.
pub(super) fn figure_2(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let title = "Figure 2. α-shapes of negative α, α increasing from top to bottom";
    let mut ladder = ladder(&NEGATIVE)?;
    let item = item(bench, title, "figure-02", &ladder)?;
    ladder.push(Rung::at(0.0)?);
    Ok(Item {
        title: "Figure 2. α-shapes of negative α".into(),
        paper:
            "Generalised discs: for α < 0 the complement of a disc of radius −1/α. The α-hull is \
                the intersection of all that contain the points; α increases from top to bottom \
                (Definition 2)."
                .into(),
        ours:
            "Left, the α-shape: pairs of points on the boundary of one such disc, shaded where no \
               disc reaches. Right, the α-hull, and one of the discs, dashed. The paper does not \
               list its points; ours are a letter C and a cluster."
                .into(),
        findings: judge(&[GROWS], &Growth::of(&ladder)),
        ..item
    })
}

/// Figure 3: α-shapes of positive α.
pub(super) fn figure_3(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let title = "Figure 3. α-shapes of positive α, α increasing from top to bottom";
    let mut ladder = ladder(&POSITIVE)?;
    let item = item(bench, title, "figure-03", &ladder)?;
    ladder.insert(0, Rung::at(0.0)?);
    let limit = Limit::find()?;
    let mut facts = item.facts;
    facts.extend(limit.facts());
    let mut findings = judge(&[GROWS], &Growth::of(&ladder));
    findings.extend(judge(&[LIMITED], &limit));
    Ok(Item {
        title: "Figure 3. α-shapes of positive α".into(),
        paper: "For α > 0 the α-hull is the intersection of all closed discs of radius 1/α that \
                contain the points; α increases from top to bottom (Definition 1)."
            .into(),
        ours: "The same points. The hull swells towards the smallest enclosing circle while the \
               shape loses its corners; one of the discs is dashed."
            .into(),
        facts,
        findings,
        ..item
    })
}

fn ladder(alphas: &[f64]) -> Result<Vec<Rung>, ReproduceError> {
    alphas.iter().map(|&alpha| Rung::at(alpha)).collect()
}

/// Shape and hull at each α, a row each.
fn item(
    bench: &mut Bench<'_>,
    title: &str,
    name: &str,
    ladder: &[Rung],
) -> Result<Item, ReproduceError> {
    let drawn = draw(title, ladder)?;
    Ok(Item {
        picture: Some(bench.file(&format!("{name}.png"), drawn.to_png()?)),
        files: vec![bench.file(&format!("{name}.svg"), drawn.to_svg()?.into_bytes())],
        facts: vec![Fact::count("points", sample_points().len())],
        tables: vec![table(ladder)],
        ..Item::default()
    })
}

fn draw(title: &str, ladder: &[Rung]) -> Result<Figure, ReproduceError> {
    let panels = ladder.iter().flat_map(|rung| {
        let at = format!("α = {}", text::number(rung.alpha));
        let shape = panel(format!("{at}: shape"), draw_shape(&rung.shape));
        [shape, panel(format!("{at}: hull"), draw_hull(rung))]
    });
    let legend = [("points", GRAY), ("α-extreme points", PALETTE[1]), ("α-hull", PALETTE[0])];
    Ok(Figure {
        title: title.into(),
        columns: 2,
        panel: Size::new(800, 620)?,
        panels: panels.collect(),
        colour_bar: None,
        legend: legend.map(|(name, colour)| (name.to_owned(), colour)).into(),
        notes: Vec::new(),
    })
}

fn table(ladder: &[Rung]) -> Table {
    let rows = ladder.iter().map(|rung| {
        let shape = &rung.shape;
        let counts = [shape.extreme().len(), shape.edges().len(), shape.triangles().len()];
        let lengths = [rung.alpha.abs().recip(), rung.hull_area()].map(text::number);
        let mut row = vec![text::number(rung.alpha), lengths[0].clone()];
        row.extend(counts.map(|n| n.to_string()));
        row.push(lengths[1].clone());
        row
    });
    let head = ["α", "radius", "α-extreme points", "edges", "triangles", "area of the hull"];
    Table {
        caption: "The shapes, α being a reciprocal length here".into(),
        head: head.map(String::from).into(),
        rows: rows.collect(),
    }
}

/// The shape of the sample points at one α.
pub(super) struct Rung {
    pub alpha: f64,
    pub shape: EksShape,
    hull: AlphaHull,
}

impl Rung {
    pub(super) fn at(alpha: f64) -> Result<Self, ReproduceError> {
        let shape = eks_shape(&sample_points(), Curvature::new(alpha)?)?;
        let hull = shape.hull();
        Ok(Self { alpha, shape, hull })
    }

    pub(super) fn hull_area(&self) -> f64 {
        area(&self.hull.outline)
    }
}

pub(super) fn draw_shape(shape: &EksShape) -> Drawing {
    let points = shape.positions();
    let place = |v: u32| points[v as usize];
    let mut drawing = around(points, 0.7);
    for triangle in shape.triangles() {
        drawing.polygon(&triangle.map(place), Pen { width: 1.0, ..shaded(SHADE) });
    }
    for edge in shape.edges() {
        drawing.segment(edge.map(place), Pen::line(INK, 4.0));
    }
    dots(&mut drawing, shape);
    drawing
}

pub(super) fn draw_hull(rung: &Rung) -> Drawing {
    let mut drawing = around(rung.shape.positions(), 0.7);
    let arcs = rung.hull.outline.iter().filter_map(|piece| match piece {
        OutlinePiece::Arc(arc) => Some(arc),
        OutlinePiece::Segment(_) => None,
    });
    if let Some(arc) = arcs.max_by(|a, b| a.sweep().abs().total_cmp(&b.sweep().abs())) {
        drawing.disc(arc.centre, arc.radius, Pen::line(GRAY, 2.5).dashed());
    }
    for piece in &rung.hull.outline {
        draw_piece(&mut drawing, piece, Pen::line(PALETTE[0], 5.0));
    }
    dots(&mut drawing, &rung.shape);
    for &point in &rung.hull.points {
        drawing.dot(rung.shape.positions()[point as usize], 10.0, PALETTE[0]);
    }
    drawing
}

fn dots(drawing: &mut Drawing, shape: &EksShape) {
    shape.positions().iter().for_each(|&p| drawing.dot(p, 7.0, GRAY));
    let extreme = shape.extreme().iter().map(|&v| shape.positions()[v as usize]);
    extreme.for_each(|p| drawing.dot(p, 8.5, PALETTE[1]));
}

fn draw_piece(drawing: &mut Drawing, piece: &OutlinePiece, pen: Pen) {
    match piece {
        OutlinePiece::Arc(arc) if arc.is_circle() => drawing.disc(arc.centre, arc.radius, pen),
        piece => drawing.outline(piece.ends()[0], vec![step(piece)], false, pen),
    }
}

/// The grays and the tint of all drawings of the plane.
pub(super) const GRAY: Rgb = Rgb([120, 120, 120]);
pub(super) const INK: Rgb = Rgb([40, 40, 40]);
pub(super) const SHADE: Rgb = Rgb([226, 214, 190]);

/// An empty drawing of the part of the plane around some points.
pub(super) fn around(points: &[[f64; 2]], margin: f64) -> Drawing {
    let end = |k: usize, pick: fn(f64, f64) -> f64| points.iter().map(|p| p[k]).reduce(pick);
    let low = [0, 1].map(|k| end(k, f64::min).unwrap_or(0.0) - margin);
    let high = [0, 1].map(|k| end(k, f64::max).unwrap_or(1.0) + margin);
    Drawing::plane([low, high])
}

pub(super) fn shaded(colour: Rgb) -> Pen {
    // Outlined in its own colour, so that no seam shows between neighbours.
    Pen { stroke: Some(colour), ..Pen::area(colour, 1.0) }
}

pub(super) fn step(piece: &OutlinePiece) -> Step {
    match piece {
        OutlinePiece::Segment([_, to]) => Step::Line(*to),
        OutlinePiece::Arc(arc) => Step::Arc {
            to: arc.end,
            radius: arc.radius,
            counter_clockwise: arc.counter_clockwise,
            large: arc.sweep().abs() > std::f64::consts::PI,
        },
    }
}

/// A drawing with a title, and nothing below it.
pub(super) fn panel(title: impl Into<String>, drawing: Drawing) -> Panel {
    Panel { title: title.into(), content: Content::Drawing(drawing), captions: Vec::new() }
}
