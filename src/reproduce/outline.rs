//! Areas and closed curves of outlines made of segments and arcs.

use super::plane::Piece;

/// The area on the left of closed curves (Green's theorem). Rounded.
pub(super) fn area(pieces: &[Piece]) -> f64 {
    let double = pieces.iter().map(|piece| match piece {
        Piece::Segment([[ax, ay], [bx, by]]) => ax * by - bx * ay,
        Piece::Arc(arc) => {
            let [dx, dy] = [arc.end[0] - arc.start[0], arc.end[1] - arc.start[1]];
            arc.radius * arc.radius * arc.sweep() + arc.centre[0] * dy - arc.centre[1] * dx
        }
    });
    double.sum::<f64>() / 2.0
}

/// How many closed curves the pieces make, each beginning where another ends, up to rounding.
pub(super) fn loops(pieces: &[Piece]) -> usize {
    let follows = |piece: &Piece, next: &Piece| {
        let ([_, end], [start, _]) = (piece.ends(), next.ends());
        (end[0] - start[0]).hypot(end[1] - start[1]) < 1e-9
    };
    let mut walked = vec![false; pieces.len()];
    let mut loops = 0;
    for first in 0..pieces.len() {
        if walked[first] {
            continue;
        }
        loops += 1;
        let mut at = Some(first);
        while let Some(k) = at {
            walked[k] = true;
            let next = (0..pieces.len()).find(|&n| !walked[n] && follows(&pieces[k], &pieces[n]));
            at = next;
        }
    }
    loops
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::plane::Arc;

    /// The two halves of a circle, turning left or right.
    fn ring(centre: [f64; 2], radius: f64, counter_clockwise: bool) -> Vec<Piece> {
        let [x, y] = centre;
        let [left, right] = [[x - radius, y], [x + radius, y]];
        let arc = |start, end| Piece::Arc(Arc { centre, radius, start, end, counter_clockwise });
        vec![arc(left, right), arc(right, left)]
    }

    #[test]
    fn a_ring_has_two_curves_and_the_area_between_them() {
        let pieces = [ring([1.0, 2.0], 3.0, true), ring([1.5, 2.0], 1.0, false)].concat();
        assert_eq!(loops(&pieces), 2);
        assert!((area(&pieces) - 8.0 * std::f64::consts::PI).abs() < 1e-12);
    }

    #[test]
    fn a_square_is_one_curve() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let pieces: Vec<Piece> =
            (0..4).map(|k| Piece::Segment([corners[k], corners[(k + 1) % 4]])).collect();
        assert_eq!((loops(&pieces), area(&pieces)), (1, 4.0));
    }
}
