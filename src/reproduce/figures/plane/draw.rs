//! What drawings of the plane have in common.

use crate::render::{Content, Drawing, Panel, Pen, Rgb, Step};
use crate::reproduce::plane::Piece;

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

pub(super) fn step(piece: &Piece) -> Step {
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

/// A drawing with a title, and nothing below it.
pub(super) fn panel(title: impl Into<String>, drawing: Drawing) -> Panel {
    Panel { title: title.into(), content: Content::Drawing(drawing), captions: Vec::new() }
}
