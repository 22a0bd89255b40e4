//! The patch of one ball: what its arcs bound on its sphere.
//!
//! The convex hull of points on a sphere is their Delaunay triangulation there. No point of a patch lies in the cap that another ball cuts off, so the points on the
//! circle of that cap are a face of the hull, and neighbours on the circle are joined by an edge: the hull has all edges of the arcs, and what
//! is on their left is the patch. It is computed exactly as the link of a point inside in a triangulation in space.

use std::collections::HashSet;

use walpha_base::vector::{V3, add, along, cross, dot, length, scale, sub, unit};
use walpha_regular::internals::Growing;

use super::sphere::Sphere;
use crate::BallUnion;
use crate::real::{Real, Single};
use crate::simplex::Edge;

/// The triangles of a ball's patch: vertices below the length of `rim` are there, the others follow in `inner`.
#[derive(Default)]
pub(super) struct Patch {
    /// Vertices of arcs.
    pub rim: Vec<u32>,
    pub inner: Vec<V3>,
    pub triangles: Vec<[u32; 3]>,
}

/// The edges of arcs at a patch, which lies on the left of each.
pub(super) struct Rim {
    vertices: Vec<u32>,
    /// By place among the vertices.
    edges: Vec<[u32; 2]>,
}

impl Rim {
    pub(super) fn new(mut edges: Vec<[u32; 2]>) -> Self {
        // Where a patch is between two arcs with the same vertices, nothing of it is left.
        let all: HashSet<[u32; 2]> = edges.iter().copied().collect();
        edges.retain(|&[a, b]| !all.contains(&[b, a]));
        let mut vertices = edges.as_flattened().to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        let place = |v: u32| vertices.binary_search(&v).expect("just collected") as u32;
        let edges = edges.into_iter().map(|edge| edge.map(place)).collect();
        Self { vertices, edges }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }
}

/// The cap that another ball cuts off, in units of the radius.
pub(super) struct Cap {
    /// The direction to the other ball,
    axis: V3,
    /// the height of the plane,
    height: f64,
    /// and the radius of its circle.
    radius: f64,
}

impl Cap {
    pub(super) fn of(union: &BallUnion<'_>, v: u32, ends: [u32; 2]) -> Option<Self> {
        let points = &union.points;
        let balls = points.balls(ends);
        let at = usize::from(ends[1] == v);
        let height = Edge::measured(balls, points.alpha).heights[at].value;
        let radius = points.squared_radius::<Single>(v).sqrt().value;
        let axis = unit(sub(balls[1 - at].centre, balls[at].centre))?;
        let height = height / radius;
        Some(Self { axis, height, radius: (1.0 - height * height).max(0.0).sqrt() })
    }

    /// The distance of a point of the unit sphere from the circle; negative in the cap.
    fn distance(&self, point: V3) -> f64 {
        let height = dot(point, self.axis);
        let radius = (1.0 - height * height).max(0.0).sqrt();
        let (up, out) = (self.height - height, radius - self.radius);
        let distance = (up * up + out * out).sqrt();
        if up < 0.0 { -distance } else { distance }
    }
}

/// Times that points are added where triangles are too far from the sphere.
const ROUNDS: usize = 24;
/// Points keep this part of their distance from each other from arcs, and points that are added together from one another.
const APART: f64 = 0.4;

/// The patch of a ball; `None` if its edges are lost in rounding.
pub(super) fn triangulate(
    centre: V3,
    radius: f64,
    vertices: &[V3],
    rim: Rim,
    caps: &[Cap],
    sphere: &Sphere,
) -> Option<Patch> {
    let outside = |&point: &V3, margin: f64| caps.iter().all(|cap| cap.distance(point) > margin);
    let Rim { vertices: on_rim, edges } = rim;
    // A point inside, the rim, and points between.
    let mut points = vec![[0.0; 3]];
    points.extend(on_rim.iter().map(|&v| scale(sub(vertices[v as usize], centre), 1.0 / radius)));
    let margin = APART * sphere.spacing;
    points.extend(sphere.points.iter().filter(|point| outside(point, margin)));
    if points.len() == 1 + on_rim.len() {
        // A single circle would span no volume.
        let middle = unit(points.iter().fold([0.0; 3], |sum, &point| add(sum, point)));
        points.extend(middle.filter(|point| outside(point, 0.0)));
    }
    // Not the centre, which is outside of the hull of a small patch.
    let sum = points.iter().fold([0.0; 3], |sum, &point| add(sum, point));
    points[0] = scale(sum, 1.0 / (points.len() - 1) as f64);
    let mut hull = Hull::new(&points, edges)?;
    let mut triangles = hull.on_left()?;
    for _ in 0..ROUNDS {
        let mut more: Vec<V3> = Vec::new();
        for corners in &triangles {
            let places = corners.map(|v| hull.place(v));
            let Some((point, off)) = farthest(places) else { continue };
            if off <= sphere.tolerance {
                continue;
            }
            let longest = longest_edge(places);
            let fits = |point: &V3| {
                outside(point, 1e-3 * sphere.spacing)
                    && more.iter().all(|other| length(sub(*other, *point)) > margin)
            };
            more.extend([point, longest].into_iter().find(fits));
        }
        if more.is_empty() {
            break;
        }
        hull.insert(&more)?;
        points.extend(more);
        triangles = hull.on_left()?;
    }
    let inner = points[on_rim.len() + 1..].iter().map(|&point| along(centre, radius, point));
    Some(Patch { inner: inner.collect(), rim: on_rim, triangles })
}

/// The point of the unit sphere above a chord triangle that is farthest from it, and its distance; `None` for one without a normal.
pub(super) fn farthest([a, b, c]: [V3; 3]) -> Option<(V3, f64)> {
    let [ab, bc, ca] = [sub(b, a), sub(c, b), sub(a, c)];
    let is_acute = dot(ab, ca) < 0.0 && dot(bc, ab) < 0.0 && dot(ca, bc) < 0.0;
    if !is_acute {
        let point = longest_edge([a, b, c]);
        let ends = [ab, bc, ca].map(|edge| dot(edge, edge));
        let square = ends.into_iter().fold(0.0, f64::max);
        // A chord of length c is off by 1 − √(1 − c²/4).
        let off = square / 4.0 / (1.0 + (1.0 - square / 4.0).max(0.0).sqrt());
        return Some((point, off));
    }
    let normal = unit(cross(ab, sub(c, a)))?;
    Some((normal, 1.0 - dot(normal, a)))
}

/// The point of the unit sphere above the middle of the longest edge.
fn longest_edge([a, b, c]: [V3; 3]) -> V3 {
    let square = |(p, q): &(V3, V3)| dot(sub(*p, *q), sub(*p, *q));
    let edges = [(a, b), (b, c), (c, a)];
    let longest = edges.into_iter().max_by(|x, y| square(x).total_cmp(&square(y)));
    let (p, q) = longest.unwrap_or((a, b));
    unit(add(p, q)).unwrap_or(p)
}

/// The convex hull of points on a sphere, which is their Delaunay triangulation there: the link of a point inside in a triangulation
/// in space.
struct Hull {
    growing: Growing,
    /// The edges that have the patch on their left, sorted.
    edges: Vec<[u32; 2]>,
}

impl Hull {
    /// The number of the point inside, and of the first of the others.
    const INSIDE: u32 = Growing::FIRST;
    const FIRST: u32 = Self::INSIDE + 1;

    /// The hull of the points after the first, which is inside.
    fn new(points: &[V3], mut edges: Vec<[u32; 2]>) -> Option<Self> {
        edges.sort_unstable();
        Some(Self { growing: Growing::new(points).ok()?, edges })
    }

    fn insert(&mut self, points: &[V3]) -> Option<()> {
        let numbers = self.growing.register(points, &vec![0.0; points.len()]);
        self.growing.insert(&numbers.collect::<Vec<_>>()).ok()
    }

    /// The place of a point of the hull.
    fn place(&self, v: u32) -> V3 {
        self.growing.positions()[(v + Self::FIRST) as usize]
    }

    /// The triangle of a cell at the point inside, counter-clockwise seen from outside, and the corner of the cell opposite the edge from each of its vertices to
    /// the next.
    fn outwards(&self, cell: u32) -> Option<([u32; 3], [usize; 3])> {
        let corners = self.growing.cells()[cell as usize].corners;
        // Seen from inside, the first three turn counter-clockwise if it is the last corner.
        let [a, b, c] = match corners.iter().position(|&v| v == Self::INSIDE)? {
            3 => [1, 0, 2],
            2 => [0, 1, 3],
            1 => [2, 0, 3],
            _ => [1, 2, 3],
        };
        Some(([a, b, c].map(|k| corners[k] - Self::FIRST), [c, a, b]))
    }

    fn is_rim(&self, edge: [u32; 2]) -> bool {
        self.edges.binary_search(&edge).is_ok()
    }

    /// The triangles on the left of the edges, and those that are joined to them by other edges. `None` if an edge is not one of the hull, or has the
    /// patch on both sides.
    fn on_left(&self) -> Option<Vec<[u32; 3]>> {
        let cells = self.growing.cells();
        let at_hull = (0..cells.len() as u32)
            .filter(|&cell| self.growing.is_cell(cell))
            .filter_map(|cell| Some((cell, self.outwards(cell)?)));
        let mut is_left = vec![false; cells.len()];
        let (mut stack, mut found) = (Vec::new(), 0);
        for (cell, ([a, b, c], _)) in at_hull {
            let on_rim = [[a, b], [b, c], [c, a]].into_iter().filter(|&edge| self.is_rim(edge));
            let count = on_rim.count();
            if count > 0 {
                found += count;
                is_left[cell as usize] = true;
                stack.push(cell);
            }
        }
        if found < self.edges.len() {
            return None;
        }
        let mut triangles = Vec::new();
        while let Some(cell) = stack.pop() {
            let (triangle, across) = self.outwards(cell)?;
            triangles.push(triangle);
            let [a, b, c] = triangle;
            for ([p, q], corner) in [[a, b], [b, c], [c, a]].into_iter().zip(across) {
                if self.is_rim([p, q]) {
                    continue;
                }
                let next = cells[cell as usize].neighbors[corner] / 4;
                if self.is_rim([q, p]) || !self.growing.is_cell(next) {
                    return None;
                }
                if !std::mem::replace(&mut is_left[next as usize], true) {
                    stack.push(next);
                }
            }
        }
        triangles.sort_unstable();
        Some(triangles)
    }
}
