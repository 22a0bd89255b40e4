//! Figure 4: a weighted shape, its discs and their power cells.

use super::bench::{Bench, Claim, judge};
use super::plane::{GRAY, INK, SHADE, around, panel, shaded, step};
use crate::render::{Drawing, Figure, PALETTE, Pen, Rgb, Size};
use crate::reproduce::plane::curve::{area, loops};
use crate::reproduce::plane::{
    OutlinePiece, WeightedPlaneShape, sample_discs, weighted_plane_shape,
};
use crate::reproduce::{Fact, Item, ReproduceError, Verdict, text};
use crate::shape::{Alpha, Class};

/// The α of Figure 4, a squared length.
const DISCS: f64 = 1.0;

/// Measurements of the dual complex, and of the union of the discs.
struct Evidence {
    discs: usize,
    hidden: usize,
    /// Triangles, edges and vertices of the complex.
    simplices: [usize; 3],
    /// Its components and holes.
    betti: [u64; 2],
    cells: usize,
    /// The area of all power cells.
    parts: f64,
    /// The area within the outline of the union.
    union: f64,
    /// Number of closed curves in that outline.
    rings: usize,
}

impl Evidence {
    fn of(shape: &WeightedPlaneShape) -> Self {
        let cells = shape.cells();
        let outline: Vec<OutlinePiece> =
            shape.outline().into_iter().map(OutlinePiece::Arc).collect();
        let complex = shape.complex();
        Self {
            discs: shape.positions().len(),
            hidden: shape.hidden().len(),
            simplices: [complex.triangles.len(), complex.edges.len(), complex.vertices.len()],
            betti: complex.betti(),
            parts: cells.iter().map(|cell| area(&cell.boundary)).sum(),
            cells: cells.len(),
            union: area(&outline),
            rings: loops(&outline),
        }
    }

    fn facts(&self) -> Vec<Fact> {
        let [triangles, edges, vertices] = self.simplices;
        vec![
            Fact::count("discs", self.discs),
            Fact::count("hidden points", self.hidden),
            Fact::count("triangles", triangles),
            Fact::count("edges", edges),
            Fact::count("vertices", vertices),
            Fact::new("area of the union of the discs", self.union),
            Fact::new("area of the power cells", self.parts),
            Fact::count("closed curves around the union", self.rings),
        ]
    }
}

const CLAIMS: [Claim<Evidence>; 2] = [
    Claim {
        text: "The power cells decompose the union of the discs.",
        decide: |&Evidence { cells, parts, union, .. }| {
            let reason = format!(
                "{cells} cells have the area {} together, the outline of the union encloses {}",
                text::number(parts),
                text::number(union)
            );
            (Verdict::of((parts - union).abs() <= 1e-9 * union), reason)
        },
    },
    Claim {
        text: "The α-shape is the dual complex of the discs.",
        decide: |&Evidence { betti: [b0, b1], rings, .. }| {
            let reason = format!(
                "the complex has {} and {}; the outline of the union is {rings} closed curves, one \
                 around each component and one around each hole",
                text::count(b0, "component", "components"),
                text::count(b1, "hole", "holes"),
            );
            (Verdict::of(rings as u64 == b0 + b1), reason)
        },
    },
];

/// Figure 4: a weighted α-shape: discs, power cells, dual complex.
pub(super) fn figure_4(bench: &mut Bench<'_>) -> Result<Item, ReproduceError> {
    let (points, weights) = sample_discs();
    let alpha = Alpha::from_squared(DISCS).expect("a number");
    let shape = weighted_plane_shape(&points, &weights, alpha)?;
    let drawn = draw(&shape)?;
    let evidence = Evidence::of(&shape);
    Ok(Item {
        title: "Figure 4. Weighted α-shape in the plane".into(),
        paper:
            "The union of discs is decomposed by the weighted Voronoi cells; the shaded triangles \
                are the dual complex."
                .into(),
        ours: "Left, the discs and their power cells; right, the dual complex: triangles, edges \
               without triangles, and a point on its own. A cross marks a hidden point, which has \
               no cell."
            .into(),
        picture: Some(bench.file("figure-04.png", drawn.to_png()?)),
        files: vec![bench.file("figure-04.svg", drawn.to_svg()?.into_bytes())],
        facts: evidence.facts(),
        findings: judge(&CLAIMS, &evidence),
        ..Item::default()
    })
}

fn draw(shape: &WeightedPlaneShape) -> Result<Figure, ReproduceError> {
    let legend = [
        ("union of the discs", Rgb([222, 234, 245])),
        ("triangles of the dual complex", SHADE),
        ("edges without triangles, and a hidden point (×)", PALETTE[0]),
    ];
    let discs = shape.positions().len();
    Ok(Figure {
        title: format!("Figure 4. Weighted α-shape of {discs} discs, α = {DISCS}"),
        columns: 2,
        panel: Size::new(900, 580)?,
        panels: vec![
            panel("discs of squared radius α + ω, cut into power cells", draw_cells(shape)),
            panel("the dual complex", draw_dual(shape)),
        ],
        colour_bar: None,
        legend: legend.map(|(name, colour)| (name.to_owned(), colour)).into(),
        notes: Vec::new(),
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
            [OutlinePiece::Arc(arc)] if arc.is_circle() => {
                drawing.disc(arc.centre, arc.radius, pen);
            }
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
