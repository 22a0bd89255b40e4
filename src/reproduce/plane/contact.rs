//! Finds the points that the generalised discs which contain all points touch.
//!
//! A disc that touches p and q has its centre on their bisector, at t = ±√(1/α² − |pq|²/4) from
//! the middle, to the left of pq for t > 0. That no point lies inside it (α < 0), or none outside
//! (α > 0), leaves an interval of t: the edge between p and q in the closest-point or the
//! farthest-point Voronoi diagram. Its ends are the centres of the circles around the triangles at
//! pq in the Delaunay triangulation of that kind, so their signs and radii decide. A disc centred
//! inside the interval touches p and q alone; one at an end is the circle around a triangle, and
//! touches all points on that circle.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use super::exact::{Curve, Exact};
use super::mesh::{Edge, Mesh, Side};
use walpha_base::UnionFind;

/// Contacts of all generalised discs for one α ≠ 0, or of half-planes; by site, sorted.
#[derive(Default)]
pub(super) struct Contacts {
    /// Pairs of points that one disc touches.
    pub(super) edges: Vec<[u32; 2]>,
    /// Triangles that no touching disc cuts off.
    pub(super) inside: Vec<[u32; 3]>,
    /// Arcs counter-clockwise around a touching disc from one of its points to the next, where the
    /// outline of the α-hull may run: those of at most half the circle. On a longer arc the disc can
    /// still move, and other discs reach beyond it (α < 0) or stay behind it (α > 0). For
    /// half-planes, the segments along their boundaries, all points on the left.
    pub(super) arcs: Vec<[u32; 2]>,
}

/// One of the two Voronoi diagrams.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Diagram {
    /// α < 0: no point strictly inside the circle.
    Closest,
    /// α > 0: no point strictly outside.
    Farthest,
}

/// The contacts of discs of the curve's radius.
pub(super) fn of_discs(mesh: &Mesh, exact: &Exact, curve: &Curve, diagram: Diagram) -> Contacts {
    let radii: Vec<Ordering> =
        mesh.triangles.iter().map(|&t| exact.circumradius(t).against(curve)).collect();
    let mut edges = BTreeSet::new();
    let mut arcs = BTreeSet::new();
    let circles = UnionFind::new(mesh.triangles.len());
    for edge in &mesh.edges {
        let [p, q] = edge.ends;
        let half = exact.half_distance(p, q).against(curve);
        if half.is_gt() {
            continue;
        }
        let (left, right) = centres(edge, exact, &radii);
        let (low, high) = match diagram {
            Diagram::Closest => (right, left),
            Diagram::Farthest => (left, right),
        };
        let between = |left: bool| {
            low.is_none_or(|end| end.against(left).is_gt())
                && high.is_none_or(|end| end.against(left).is_lt())
        };
        // Centred in the middle of pq, the disc counts once and has two half circles. Empty
        // discs shifted to both sides cover them.
        let mut touch = |left: bool| {
            edges.insert([p, q]);
            if half.is_lt() || diagram == Diagram::Farthest {
                arcs.insert(if left { [p, q] } else { [q, p] });
            }
        };
        [true, false].into_iter().filter(|&left| between(left)).for_each(&mut touch);

        if let (Some(l), Some(r)) = (left, right)
            && (l.on_curve() && r.on_curve() && l.sign == r.sign)
        {
            circles.unite(l.triangle as u32, r.triangle as u32);
            continue;
        }
        // The side of a polygon of points on one circle, the polygon on its left.
        for (centre, way) in [(left, [p, q]), (right, [q, p])] {
            let Some(centre) = centre.filter(Centre::on_curve) else { continue };
            if centre.apex.is_gt() || centre.apex.is_eq() && diagram == Diagram::Farthest {
                arcs.insert(way);
            }
        }
    }
    on_circles(mesh, &radii, circles).iter().for_each(|points| edges.extend(pairs(points)));
    if diagram == Diagram::Closest {
        // Two empty discs on both sides of pq cover each other's arc from p to q.
        let both = arcs.clone();
        arcs.retain(|&[p, q]| !both.contains(&[q, p]));
    }
    Contacts {
        edges: edges.into_iter().collect(),
        inside: inside(mesh, &radii, diagram),
        arcs: arcs.into_iter().collect(),
    }
}

/// The points of each circle of the curve's radius; `circles` holds the triangles of one together.
fn on_circles(mesh: &Mesh, radii: &[Ordering], circles: UnionFind) -> Vec<BTreeSet<u32>> {
    let mut points: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for (triangle, row) in mesh.triangles.iter().enumerate() {
        if radii[triangle].is_eq() {
            points.entry(circles.find(triangle as u32)).or_default().extend(row);
        }
    }
    points.into_values().collect()
}

/// The triangles that no touching disc cuts off.
fn inside(mesh: &Mesh, radii: &[Ordering], diagram: Diagram) -> Vec<[u32; 3]> {
    let is_inside = |radius: &Ordering| match diagram {
        Diagram::Closest => radius.is_lt(),
        Diagram::Farthest => radius.is_le(),
    };
    let pairs = mesh.triangles.iter().zip(radii);
    pairs.filter(|(_, radius)| is_inside(radius)).map(|(&row, _)| row).collect()
}

/// The contacts of half-planes, in the closest-point triangulation: the sides of the convex hull.
pub(super) fn of_half_planes(mesh: &Mesh, exact: &Exact) -> Contacts {
    let outer: Vec<&Edge> = mesh.edges.iter().filter(|edge| edge.is_outer()).collect();
    // Edges that follow each other on one line touch one half-plane.
    let mut at: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (number, edge) in outer.iter().enumerate() {
        edge.ends.iter().for_each(|&end| at.entry(end).or_default().push(number));
    }
    let lines = UnionFind::new(outer.len());
    for (&middle, numbers) in &at {
        if let [a, b] = numbers[..] {
            let far = |number: usize| outer[number].ends.into_iter().find(|&end| end != middle);
            if let (Some(p), Some(q)) = (far(a), far(b))
                && exact.collinear(p, middle, q)
            {
                lines.unite(a as u32, b as u32);
            }
        }
    }
    let mut on_line: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for (number, edge) in outer.iter().enumerate() {
        on_line.entry(lines.find(number as u32)).or_default().extend(edge.ends);
    }
    let edges: BTreeSet<_> = on_line.values().flat_map(pairs).collect();
    let ways = outer.iter().map(
        |Edge { ends: [p, q], right, .. }| {
            if right.is_some() { [*q, *p] } else { [*p, *q] }
        },
    );
    Contacts {
        edges: edges.into_iter().collect(),
        inside: mesh.triangles.clone(),
        arcs: ways.collect(),
    }
}

/// All pairs of an ascending set.
fn pairs(points: &BTreeSet<u32>) -> impl Iterator<Item = [u32; 2]> + '_ {
    points.iter().flat_map(|&p| points.range(p + 1..).map(move |&q| [p, q]))
}

/// The place of the centre of the circle around a triangle at pq on the bisector of pq.
#[derive(Clone, Copy)]
struct Centre {
    triangle: usize,
    /// The angle at the triangle's third vertex against the right angle: `Greater` is acute.
    apex: Ordering,
    /// The sign of its t.
    sign: Ordering,
    /// The comparison of its radius with that of the curve.
    radius: Ordering,
}

/// The centres of the triangles on the left and on the right.
fn centres(edge: &Edge, exact: &Exact, radii: &[Ordering]) -> (Option<Centre>, Option<Centre>) {
    let centre = |side: Side| {
        let apex = exact.apex(edge.ends[0], edge.ends[1], side.apex);
        // At an acute angle the centre is on the same side of pq as the triangle.
        Centre { triangle: side.triangle, apex, sign: apex, radius: radii[side.triangle] }
    };
    let mirrored = |side| {
        let centre = centre(side);
        Centre { sign: centre.sign.reverse(), ..centre }
    };
    (edge.left.map(centre), edge.right.map(mirrored))
}

impl Centre {
    fn on_curve(&self) -> bool {
        self.radius.is_eq()
    }

    /// The t of the curve's own centre on the left, or else on the right, against this one. Both
    /// circles pass through p and q, so |t| is ordered as the radius.
    fn against(&self, left: bool) -> Ordering {
        match (left, self.sign) {
            (true, Ordering::Less) => Ordering::Greater,
            (true, _) => self.radius.reverse(),
            (false, Ordering::Greater) => Ordering::Less,
            (false, _) => self.radius,
        }
    }
}
