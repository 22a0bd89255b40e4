use super::super::outline::{area, loops};
use super::super::{Fact, Finding, Item, ReproduceError, Table, Verdict, text};
use super::Bench;
use crate::plane::{
    AlphaHull, Curvature, EksShape, Piece, WeightedPlaneShape, eks_shape, sample_discs,
    sample_points, weighted_plane_shape,
};
use crate::render::{Content, Drawing, Figure, PALETTE, Panel, Pen, Rgb, Size, Step};
use crate::shape::{Alpha, Class};

/// The α of Figure 2, from top to bottom: reciprocal lengths.
const NEGATIVE: [f64; 3] = [-2.0, -1.0, -0.5];
/// The α of Figure 3.
const POSITIVE: [f64; 3] = [0.05, 0.11, 0.16];
/// The α of Figure 4, a squared length.
const DISCS: f64 = 1.0;

const GRAY: Rgb = Rgb([120, 120, 120]);
const INK: Rgb = Rgb([40, 40, 40]);
const SHADE: Rgb = Rgb([226, 214, 190]);

/// Figure 2: α-shapes of negative α.
pub(super) fn figure_2(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let title = "Figure 2. α-shapes of negative α, α increasing from top to bottom";
    let (ladder, item) = eks_item(bench, title, "figure-02", &NEGATIVE)?;
    Ok(Item {
        id: "figure-2",
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
        findings: vec![grows(&[&ladder[..], &[Rung::at(0.0)?]].concat())],
        ..item
    })
}

/// Figure 3: α-shapes of positive α.
pub(super) fn figure_3(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let title = "Figure 3. α-shapes of positive α, α increasing from top to bottom";
    let (ladder, item) = eks_item(bench, title, "figure-03", &POSITIVE)?;
    // Discs this small contain no two of the points, so that the shape tells ρ.
    let tiny = Rung::at(1e6)?;
    let enclosing = tiny.shape.no_disc().map_or(f64::NAN, |none| none.enclosing);
    let (below, beyond) = (Rung::at(0.999 / enclosing)?, Rung::at(1.001 / enclosing)?);
    let limited = below.shape.no_disc().is_none() && beyond.shape.no_disc().is_some();
    let mut facts = item.facts;
    facts.push(Fact::new("ρ, the radius of the smallest enclosing circle", enclosing));
    facts.push(Fact::new("1/ρ, the largest α with a shape", enclosing.recip()));
    let findings = vec![
        grows(&[&[Rung::at(0.0)?], &ladder[..]].concat()),
        Finding {
            claim: "A positive α must be sufficiently small.".into(),
            verdict: Verdict::of(limited),
            reason: format!(
                "0.1 % below 1/ρ = {} there are {} α-extreme points, 0.1 % above there are {}: no \
                 disc is left that contains all points",
                text::number(enclosing.recip()),
                below.shape.extreme().len(),
                beyond.shape.extreme().len()
            ),
        },
    ];
    Ok(Item {
        id: "figure-3",
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

/// The shape of the sample points at one α.
#[derive(Clone)]
struct Rung {
    alpha: f64,
    shape: EksShape,
    hull: AlphaHull,
}

impl Rung {
    fn at(alpha: f64) -> Result<Self, ReproduceError> {
        let shape = eks_shape(&sample_points(), Curvature::new(alpha)?)?;
        let hull = shape.hull();
        Ok(Self { alpha, shape, hull })
    }

    fn hull_area(&self) -> f64 {
        area(&self.hull.outline)
    }
}

fn grows(ladder: &[Rung]) -> Finding {
    let areas: Vec<f64> = ladder.iter().map(Rung::hull_area).collect();
    let steps = ladder
        .iter()
        .zip(&areas)
        .map(|(rung, area)| format!("{} at α = {}", text::number(*area), text::number(rung.alpha)));
    Finding {
        claim: "The α-hull grows with α.".into(),
        verdict: Verdict::of(areas.windows(2).all(|pair| pair[0] < pair[1])),
        reason: format!("its area is {}", steps.collect::<Vec<_>>().join(", ")),
    }
}

/// Shape and hull at each α, a row each.
fn eks_item(
    bench: &mut Bench<'_>,
    title: &str,
    name: &str,
    alphas: &[f64],
) -> Result<(Vec<Rung>, Item), ReproduceError> {
    let ladder = alphas.iter().map(|&alpha| Rung::at(alpha)).collect::<Result<Vec<_>, _>>()?;
    let panels = ladder.iter().flat_map(|rung| {
        let at = format!("α = {}", text::number(rung.alpha));
        let titles = [format!("{at}: shape"), format!("{at}: hull")];
        let drawings = [draw_shape(&rung.shape), draw_hull(rung)];
        let panel = |(title, drawing)| Panel {
            title,
            content: Content::Drawing(drawing),
            captions: Vec::new(),
        };
        titles.into_iter().zip(drawings).map(panel)
    });
    let legend = [("points", GRAY), ("α-extreme points", PALETTE[1]), ("α-hull", PALETTE[0])];
    let figure = Figure {
        title: title.into(),
        columns: 2,
        panel: Size::new(800, 620)?,
        panels: panels.collect(),
        colour_bar: None,
        legend: legend.map(|(name, colour)| (name.to_owned(), colour)).into(),
        notes: Vec::new(),
    };
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
    let item = Item {
        picture: Some(bench.file(&format!("{name}.png"), figure.to_png()?)),
        files: vec![bench.file(&format!("{name}.svg"), figure.to_svg()?.into_bytes())],
        commands: vec![bench.reproduce_command()],
        facts: vec![Fact::count("points", sample_points().len())],
        tables: vec![Table {
            caption: "The shapes, α being a reciprocal length here".into(),
            head: head.map(String::from).into(),
            rows: rows.collect(),
        }],
        ..Item::default()
    };
    Ok((ladder, item))
}

/// An empty drawing of the part of the plane around some points.
fn around(points: &[[f64; 2]], margin: f64) -> Drawing {
    let end = |k: usize, pick: fn(f64, f64) -> f64| points.iter().map(|p| p[k]).reduce(pick);
    let low = [0, 1].map(|k| end(k, f64::min).unwrap_or(0.0) - margin);
    let high = [0, 1].map(|k| end(k, f64::max).unwrap_or(1.0) + margin);
    Drawing::plane([low, high])
}

fn draw_shape(shape: &EksShape) -> Drawing {
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

fn draw_hull(rung: &Rung) -> Drawing {
    let mut drawing = around(rung.shape.positions(), 0.7);
    let arcs = rung.hull.outline.iter().filter_map(|piece| match piece {
        Piece::Arc(arc) => Some(arc),
        Piece::Segment(_) => None,
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

fn shaded(colour: Rgb) -> Pen {
    // Outlined in its own colour, so that no seam shows between neighbours.
    Pen { stroke: Some(colour), ..Pen::area(colour, 1.0) }
}

fn draw_piece(drawing: &mut Drawing, piece: &Piece, pen: Pen) {
    match piece {
        Piece::Arc(arc) if arc.is_circle() => drawing.disc(arc.centre, arc.radius, pen),
        piece => drawing.outline(piece.ends()[0], vec![step(piece)], false, pen),
    }
}

fn step(piece: &Piece) -> Step {
    match piece {
        Piece::Segment([_, to]) => Step::Line(*to),
        Piece::Arc(arc) => Step::Arc {
            to: arc.end,
            radius: arc.radius,
            counter_clockwise: arc.counter_clockwise,
            large: arc.sweep().abs() > std::f64::consts::PI,
        },
    }
}

/// Figure 4: a weighted α-shape: discs, power cells, dual complex.
pub(super) fn figure_4(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let (points, weights) = sample_discs();
    let alpha = Alpha::from_squared(DISCS).expect("a number");
    let shape = weighted_plane_shape(&points, &weights, alpha)?;
    let legend = [
        ("union of the discs", Rgb([222, 234, 245])),
        ("triangles of the dual complex", SHADE),
        ("edges without triangles, and a hidden point (×)", PALETTE[0]),
    ];
    let figure = Figure {
        title: format!("Figure 4. Weighted α-shape of {} discs, α = {DISCS}", points.len()),
        columns: 2,
        panel: Size::new(900, 580)?,
        panels: vec![
            Panel {
                title: "discs of squared radius α + ω, cut into power cells".into(),
                content: Content::Drawing(draw_cells(&shape)),
                captions: Vec::new(),
            },
            Panel {
                title: "the dual complex".into(),
                content: Content::Drawing(draw_dual(&shape)),
                captions: Vec::new(),
            },
        ],
        colour_bar: None,
        legend: legend.map(|(name, colour)| (name.to_owned(), colour)).into(),
        notes: Vec::new(),
    };
    let cells = shape.cells();
    let parts: f64 = cells.iter().map(|cell| area(&cell.boundary)).sum();
    let outline: Vec<Piece> = shape.outline().into_iter().map(Piece::Arc).collect();
    let union = area(&outline);
    let rings = loops(&outline);
    let complex = shape.complex();
    let [b0, b1] = complex.betti();
    let findings = vec![
        Finding {
            claim: "The power cells decompose the union of the discs.".into(),
            verdict: Verdict::of((parts - union).abs() <= 1e-9 * union),
            reason: format!(
                "{} cells have the area {} together, the outline of the union encloses {}",
                cells.len(),
                text::number(parts),
                text::number(union)
            ),
        },
        Finding {
            claim: "The α-shape is the dual complex of the discs.".into(),
            verdict: Verdict::of(rings as u64 == b0 + b1),
            reason: format!(
                "the complex has {} and {}; the outline of the union is {} closed curves, one \
                 around each component and one around each hole",
                text::count(b0, "component", "components"),
                text::count(b1, "hole", "holes"),
                rings
            ),
        },
    ];
    Ok(Item {
        id: "figure-4",
        title: "Figure 4. Weighted α-shape in the plane".into(),
        paper:
            "The union of discs is decomposed by the weighted Voronoi cells; the shaded triangles \
                are the dual complex."
                .into(),
        ours: "Left, the discs and their power cells; right, the dual complex: triangles, edges \
               without triangles, and a point on its own. A cross marks a hidden point, which has \
               no cell."
            .into(),
        picture: Some(bench.file("figure-04.png", figure.to_png()?)),
        files: vec![bench.file("figure-04.svg", figure.to_svg()?.into_bytes())],
        commands: vec![bench.reproduce_command()],
        facts: vec![
            Fact::count("discs", points.len()),
            Fact::count("hidden points", shape.hidden().len()),
            Fact::count("triangles", complex.triangles.len()),
            Fact::count("edges", complex.edges.len()),
            Fact::count("vertices", complex.vertices.len()),
            Fact::new("area of the union of the discs", union),
            Fact::new("area of the power cells", parts),
            Fact::count("closed curves around the union", rings),
        ],
        findings,
        ..Item::default()
    })
}

/// The largest radius of a disc.
fn reach(shape: &WeightedPlaneShape) -> f64 {
    shape.radii().into_iter().flatten().fold(0.0, f64::max)
}

fn draw_cells(shape: &WeightedPlaneShape) -> Drawing {
    let mut drawing = around(shape.positions(), reach(shape) + 0.1);
    for cell in shape.cells() {
        let boundary = &cell.boundary;
        let pen = Pen { fill: Some(Rgb([222, 234, 245])), ..Pen::line(PALETTE[1], 2.5) };
        match boundary[..] {
            [Piece::Arc(arc)] if arc.is_circle() => drawing.disc(arc.centre, arc.radius, pen),
            _ => {
                let steps = boundary.iter().map(step).collect();
                drawing.outline(boundary[0].ends()[0], steps, true, pen);
            }
        }
    }
    for (&centre, radius) in shape.positions().iter().zip(shape.radii()) {
        let Some(radius) = radius else { continue };
        drawing.disc(centre, radius, Pen::line(GRAY, 1.5).dashed());
    }
    marks(&mut drawing, shape);
    drawing
}

fn draw_dual(shape: &WeightedPlaneShape) -> Drawing {
    let place = |v: u32| shape.positions()[v as usize];
    let mut drawing = around(shape.positions(), reach(shape) + 0.1);
    for (&centre, radius) in shape.positions().iter().zip(shape.radii()) {
        let Some(radius) = radius else { continue };
        drawing.disc(centre, radius, Pen::area(Rgb([238, 243, 248]), 1.0));
    }
    let complex = shape.complex();
    for triangle in complex.triangles.rows() {
        drawing.polygon(&triangle.map(place), shaded(SHADE));
    }
    for (edge, class) in complex.edges.iter() {
        let colour = if class == Class::Singular { PALETTE[0] } else { INK };
        drawing.segment(edge.map(place), Pen::line(colour, 4.0));
    }
    marks(&mut drawing, shape);
    drawing
}

/// Points as dots, hidden ones as crosses.
fn marks(drawing: &mut Drawing, shape: &WeightedPlaneShape) {
    for (v, &[x, y]) in shape.positions().iter().enumerate() {
        if shape.hidden().contains(&(v as u32)) {
            const ARM: f64 = 0.1;
            for slope in [ARM, -ARM] {
                let ends = [[x - ARM, y - slope], [x + ARM, y + slope]];
                drawing.segment(ends, Pen::line(PALETTE[0], 4.0));
            }
        } else {
            drawing.dot([x, y], 9.0, INK);
        }
    }
}
