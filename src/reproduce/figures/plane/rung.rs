//! One step of a ladder of α-shapes: its shape, its hull, and how both are drawn.

use super::draw::{GRAY, INK, SHADE, around, shaded, step};
use crate::render::{Drawing, PALETTE, Pen};
use crate::reproduce::ReproduceError;
use crate::reproduce::outline::area;
use crate::reproduce::plane::{AlphaHull, Curvature, EksShape, Piece, eks_shape, sample_points};

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

fn draw_piece(drawing: &mut Drawing, piece: &Piece, pen: Pen) {
    match piece {
        Piece::Arc(arc) if arc.is_circle() => drawing.disc(arc.centre, arc.radius, pen),
        piece => drawing.outline(piece.ends()[0], vec![step(piece)], false, pen),
    }
}
