//! Whether triangles in space cross each other, decided exactly.

use std::cmp::Ordering::{self, Equal, Greater};

use walpha_regular::predicates::orientation;

type Point = [f64; 3];

/// Whether two triangles have a point in common that is not in a corner or an edge of both, where corners are equal if their
/// coordinates are. In a mesh without such pairs, facets meet only in common faces. A triangle without area crosses everything
/// with which it shares a plane.
pub(super) fn cross(one: [Point; 3], other: [Point; 3]) -> bool {
    let own = |of: [Point; 3], not: [Point; 3]| of.into_iter().filter(move |p| !not.contains(p));
    let common: Vec<Point> = one.into_iter().filter(|p| other.contains(p)).collect();
    let (a, b): (Vec<_>, Vec<_>) = (own(one, other).collect(), own(other, one).collect());
    match common[..] {
        [] => {
            let sides = |of: [Point; 3]| [[of[0], of[1]], [of[1], of[2]], [of[2], of[0]]];
            sides(one).into_iter().any(|side| meets(side, other))
                || sides(other).into_iter().any(|side| meets(side, one))
        }
        // Each is the cone of the side opposite the common corner: the nearer of two sides on a ray is in the other triangle.
        [_] => meets([a[0], a[1]], other) || meets([b[0], b[1]], one),
        [p, q] => {
            let same_side =
                |above| orientation(above, p, q, a[0]) == orientation(above, p, q, b[0]);
            orientation(p, q, a[0], b[0]) == Equal && above([p, q, a[0]]).is_none_or(same_side)
        }
        _ => true,
    }
}

/// Whether a point is inside a positively oriented tetrahedron, and not on its boundary.
pub(super) fn inside([a, b, c, d]: [Point; 4], p: Point) -> bool {
    [[b, d, c], [a, c, d], [a, d, b], [a, b, c]]
        .into_iter()
        .all(|[x, y, z]| orientation(x, y, z, p) == Greater)
}

/// Whether a segment and a triangle have a point in common.
fn meets([p, q]: [Point; 2], [a, b, c]: [Point; 3]) -> bool {
    let sides = [p, q].map(|end| orientation(a, b, c, end));
    if sides == [Equal; 2] {
        return meets_in_plane([p, q], [a, b, c]);
    }
    let around = [[a, b], [b, c], [c, a]].map(|[x, y]| orientation(p, q, x, y));
    sides[0] != sides[1] && !(around.contains(&Greater) && around.contains(&Ordering::Less))
}

/// Whether a segment and a triangle in one plane have a point in common.
fn meets_in_plane([p, q]: [Point; 2], [a, b, c]: [Point; 3]) -> bool {
    let Some(above) = above([a, b, c]) else { return true };
    let side = |x, y, z| orientation(above, x, y, z);
    let holds = |point| {
        let around = [[a, b], [b, c], [c, a]].map(|[x, y]| side(x, y, point));
        !(around.contains(&Greater) && around.contains(&Ordering::Less))
    };
    // If p and q are outside, two segments of one line have an end of one in the other: they pass over two sides.
    let passes = |[x, y]: [Point; 2]| {
        let (ends, sides) = ([side(p, q, x), side(p, q, y)], [side(x, y, p), side(x, y, q)]);
        ends[0] != ends[1] && sides[0] != sides[1]
    };
    holds(p) || holds(q) || [[a, b], [b, c], [c, a]].into_iter().any(passes)
}

/// A point outside the plane of a triangle, if it has one.
fn above([a, b, c]: [Point; 3]) -> Option<Point> {
    let moved = |axis: usize| {
        let mut place = a;
        place[axis] = if a[axis] == 0.0 { 1.0 } else { a[axis] / 2.0 };
        place
    };
    let places = [0, 1, 2].map(moved);
    places.into_iter().find(|&place| orientation(a, b, c, place) != Equal)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLAT: [Point; 3] = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    fn both(one: [Point; 3], other: [Point; 3]) -> bool {
        let turned = |[a, b, c]: [Point; 3]| [c, b, a];
        let found = cross(one, other);
        for (one, other) in [(other, one), (turned(one), other), (one, turned(other))] {
            assert_eq!(cross(one, other), found);
        }
        found
    }

    #[test]
    fn triangles_without_common_corners() {
        let upright = |x: f64, low: f64| [[x, 1.0, low], [x + 1.0, 1.0, low], [x, 1.0, 2.0]];
        assert!(both(FLAT, upright(1.0, -1.0)));
        assert!(both(FLAT, upright(1.0, 0.0)), "a side lies on it");
        assert!(!both(FLAT, upright(1.0, 5e-324)));
        assert!(!both(FLAT, upright(5.0, -1.0)));
        let inner = [[1.0, 1.0, 0.0], [1.5, 1.0, 0.0], [1.0, 1.5, 0.0]];
        assert!(both(FLAT, inner), "within it");
        assert!(!both(FLAT, inner.map(|[x, y, z]| [x + 4.0, y, z])));
        assert!(both(FLAT, [[-1.0, 1.0, 0.0], [5.0, 1.0, 0.0], [5.0, 2.0, 0.0]]), "passes over it");
    }

    #[test]
    fn triangles_with_common_corners() {
        let [a, b, c] = FLAT;
        assert!(!both(FLAT, [a, b, [1.0, 1.0, 1.0]]));
        assert!(!both(FLAT, [a, b, [1.0, -1.0, 0.0]]), "beside each other");
        assert!(both(FLAT, [a, b, [1.0, 1.0, 0.0]]), "on each other");
        assert!(!both(FLAT, [a, [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]));
        assert!(both(FLAT, [a, [1.0, 1.0, -1.0], [1.0, 1.0, 1.0]]));
        assert!(both(FLAT, [a, [9.0, 9.0, 0.0], [9.0, 9.0, 1.0]]), "through the side opposite a");
        assert!(!both(FLAT, [a, [-9.0, 9.0, -1.0], [-9.0, 9.0, 1.0]]));
        assert!(both(FLAT, [c, b, a]));
    }
}
