//! The boundary of a union of balls as triangles.
//!
//! The dual complex says what the boundary consists of. An edge has a circle, of which an arc is on the boundary where there is no
//! tetrahedron; arcs end at the points that the three spheres of a triangle share, one on each of its open sides. What arcs bound on a sphere is
//! the patch of its ball. So the graph of arcs has no error, and only places are rounded. Both balls at an arc take the same vertices on it, and the mesh
//! is closed.
//!
//! A patch is triangulated by the Delaunay triangulation of points on its sphere: those of its arcs and some between ([`patch`]).

mod patch;
mod sphere;

use std::ops::RangeInclusive;

use walpha_base::parallel::prelude::*;
use walpha_base::sort::sort_by;
use walpha_base::vector::{V3, add, along, cross, dot, sub, unit};
use walpha_base::{Monitor, UnionFind, memory};
use walpha_shape::{Class, FacetSides};

use crate::real::{Double, Real, Single};
use crate::simplex::{Circle, Edge, Triangle};
use crate::union::zeros;
use crate::{BallUnion, BallsError};
use patch::{Cap, Patch, Rim};
use sphere::Sphere;

/// The boundary of a union of balls as triangles, each on the sphere of one ball.
///
/// The mesh is closed: each edge belongs to two triangles, once in each direction. At single vertices it may touch itself. A patch
/// that is smaller than a millionth of its ball may be missing, and where such are crowded, one smaller than a thousandth; those around it
/// meet there.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BallSurface {
    /// The vertices, in the unit of the points, each on the sphere of every ball that it belongs to, but for rounding.
    pub positions: Vec<[f64; 3]>,
    /// The triangles by their vertices, counter-clockwise seen from outside of the union; those of a ball follow each other.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle the ball on whose sphere its vertices lie, by input index.
    pub balls: Vec<u32>,
}

impl BallUnion<'_> {
    /// The tolerance of [`surface`](Self::surface) that suits pictures and meshes: 0.01.
    pub const SURFACE_TOLERANCE: f64 = 0.01;
    /// The tolerances that a surface may have.
    pub const SURFACE_TOLERANCES: RangeInclusive<f64> = 1e-6..=0.5;

    /// The boundary of the union as a closed mesh of triangles. Those of a ball are chords of its sphere, and no farther from it than `tolerance`
    /// times its radius ([`Self::SURFACE_TOLERANCES`]): a sphere has about 2.4/`tolerance` vertices. The boundaries of voids are included. The mesh does not
    /// depend on the number of threads, and has no error but the tolerance and rounding.
    ///
    /// ```
    /// # use walpha_balls::BallUnion;
    /// # use walpha_shape::{Alpha, ShapeOptions, WeightedPoints, alpha_shape};
    /// let points = WeightedPoints::new(vec![[0.0; 3], [1.0, 0.0, 0.0]], vec![1.0; 2])?;
    /// let shape = alpha_shape(points, &ShapeOptions::new(Alpha::ZERO))?;
    /// let surface = BallUnion::new(&shape)?.surface(0.01)?;
    /// // Two patches without holes, joined along a circle: vertices − edges + triangles is 2, and a triangle has 3/2 edges.
    /// assert_eq!(2 * surface.positions.len() - surface.triangles.len(), 4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A tolerance that is out of range; a torus, whose sides would cut the mesh; a patch that cannot be resolved, as its features are no larger than
    /// the rounding of coordinates; out of memory; cancelled by a [`Monitor`] that watches.
    pub fn surface(&self, tolerance: f64) -> Result<BallSurface, BallsError> {
        if !Self::SURFACE_TOLERANCES.contains(&tolerance) {
            return Err(BallsError::Tolerance { tolerance });
        }
        if self.shape.options().periodic.is_some() {
            return Err(BallsError::Seam);
        }
        let sphere = Sphere::new(tolerance);
        self.afford(&sphere)?;
        let monitor = &*Monitor::current();
        let first = self.triangulated(&sphere, 1.0, monitor);
        let Err(BallsError::Unresolved { .. }) = first else { return first };
        // What became one vertex was too near to others. With larger parts for points it is not.
        let again = monitor.unreported();
        self.triangulated(&sphere, 32.0, &again).or_else(|error| match error {
            BallsError::Unresolved { .. } => self.triangulated(&sphere, 1024.0, &again),
            _ => Err(error),
        })
    }

    /// The surface, in which lengths below this factor of the shortest that can be told are points.
    fn triangulated(
        &self,
        sphere: &Sphere,
        factor: f64,
        monitor: &Monitor,
    ) -> Result<BallSurface, BallsError> {
        let arcs = Arcs::of(self, sphere.tolerance, factor)?;
        let pairs = self.complex.edges.rows().iter().copied();
        let (edges, at_ball) = rows_of(pairs, self.points.len())?;
        let work = Work { union: self, sphere, arcs, edges, at_ball };
        let steps = monitor.units(self.points.len() as u64);
        let unreported = monitor.unreported();
        let mut surface =
            BallSurface { positions: work.arcs.vertices.clone(), ..BallSurface::default() };
        let balls: Vec<u32> = (0..self.points.len() as u32).collect();
        for piece in balls.chunks(PIECE) {
            let of = |&v: &u32| unreported.watch(|| work.patch(v));
            let patches = piece.par_iter().map(of).collect::<Result<Vec<Patch>, BallsError>>()?;
            piece.iter().zip(patches).for_each(|(&v, patch)| surface.add(v, patch));
            steps.add(piece.len() as u64)?;
        }
        let unit = self.points.unit();
        surface.positions.as_flattened_mut().iter_mut().for_each(|x| *x *= unit);
        surface.drop_unused();
        Ok(surface)
    }

    /// Refuses a mesh that would not fit in memory.
    fn afford(&self, sphere: &Sphere) -> Result<(), BallsError> {
        let share = |v: usize| {
            let square = self.points.squared_radius::<Single>(v as u32).value;
            let area = self.areas().values[v];
            let area = self.points.unscaled(crate::Bounded { value: area, bound: 0.0 }, 2).value;
            if square > 0.0 { (area / (4.0 * std::f64::consts::PI * square)).min(1.0) } else { 0.0 }
        };
        let spheres: f64 = (0..self.points.len()).map(share).sum();
        let vertices = spheres * sphere.points.len() as f64;
        let bytes = 2.0 * vertices * (size_of::<V3>() + 2 * size_of::<[u32; 4]>()) as f64;
        Ok(memory::afford(bytes as usize, || format!("a surface of {vertices:.0} vertices"))?)
    }
}

impl BallSurface {
    fn add(&mut self, ball: u32, Patch { rim, inner, triangles }: Patch) {
        let first = self.positions.len() as u32;
        self.positions.extend(inner);
        let vertex = |v: u32| match rim.get(v as usize) {
            Some(&on_rim) => on_rim,
            None => first + v - rim.len() as u32,
        };
        self.balls.extend(triangles.iter().map(|_| ball));
        self.triangles.extend(triangles.into_iter().map(|corners| corners.map(vertex)));
    }

    fn drop_unused(&mut self) {
        let mut numbers = vec![u32::MAX; self.positions.len()];
        self.triangles.as_flattened().iter().for_each(|&v| numbers[v as usize] = 0);
        let used = numbers.iter_mut().filter(|number| **number == 0);
        used.zip(0..).for_each(|(number, next)| *number = next);
        let mut row = 0;
        self.positions.retain(|_| {
            row += 1;
            numbers[row - 1] != u32::MAX
        });
        self.triangles.as_flattened_mut().iter_mut().for_each(|v| *v = numbers[*v as usize]);
    }
}

/// Balls whose patches are made before they are added.
const PIECE: usize = 1 << 10;

/// One end of an arc: a point that the spheres of a triangle share, at one of its edges.
#[derive(Clone, Copy)]
struct End {
    edge: u32,
    /// Whether the arc that goes counter-clockwise about the edge begins here.
    begins: bool,
    corner: u32,
    /// The third vertex of the triangle.
    third: u32,
}

/// The arcs of the boundary, as chains of vertices.
struct Arcs {
    vertices: Vec<V3>,
    /// For each chain, its balls and its vertices, in the direction that is counter-clockwise about the way from the first ball to the second.
    chains: Vec<([u32; 2], Vec<u32>)>,
    /// The chains of each ball: `rows[of_ball[v]..of_ball[v + 1]]`.
    rows: Vec<u32>,
    of_ball: Vec<u32>,
}

impl Arcs {
    fn of(union: &BallUnion<'_>, tolerance: f64, factor: f64) -> Result<Self, BallsError> {
        let BallUnion { complex, points, .. } = union;
        let (mut vertices, ends) = corners(union);
        let joined = UnionFind::new(vertices.len());
        // The arcs, and those too short to have two ends.
        let mut arcs: Vec<(Arc, Option<[u32; 2]>)> = Vec::new();
        let mut at = 0;
        for (row, (&balls, class)) in complex.edges.iter().enumerate() {
            let first = at;
            while ends.get(at).is_some_and(|end| end.edge as usize == row) {
                at += 1;
            }
            if class == Class::Interior {
                continue;
            }
            let circle = OnCircle::of(union, balls, factor);
            let Some(circle) = circle else {
                // Spheres that touch share no arc; of triangles there, all points are one.
                ends[first..at].windows(2).for_each(|two| {
                    joined.unite(two[0].corner, two[1].corner);
                });
                continue;
            };
            if first == at {
                arcs.push((Arc { balls, circle, turn: None }, None));
                continue;
            }
            for [from, to] in pairs(union, &circle, balls, &ends[first..at])
                .ok_or(BallsError::Unresolved { ball: balls[0] })?
            {
                let one = at - first == 2;
                let turn = circle.turn(vertices[from as usize], vertices[to as usize]);
                let whole = union.arcs[row].value;
                // The only arc has all of the angle; of several, none has more.
                let turn = if one {
                    whole
                } else if turn > whole + 1e-6 {
                    0.0
                } else {
                    turn
                };
                if turn * circle.radius <= circle.shortest {
                    joined.unite(from, to);
                } else {
                    arcs.push((Arc { balls, circle, turn: Some(turn) }, Some([from, to])));
                }
            }
        }
        let mut chains = Vec::with_capacity(arcs.len());
        for (arc, ends) in arcs {
            let ends = ends.map(|ends| ends.map(|corner| joined.find(corner)));
            chains.push((arc.balls, arc.chain(ends, tolerance, &mut vertices)));
        }
        let (rows, of_ball) = rows_of(chains.iter().map(|(balls, _)| *balls), points.len())?;
        let mut arcs = Self { vertices, chains, rows, of_ball };
        arcs.join(union, factor);
        Ok(arcs)
    }

    /// Makes one vertex of those on a ball that rounding hardly tells apart: where more than three spheres share a point, or more than two a circle.
    fn join(&mut self, union: &BallUnion<'_>, factor: f64) {
        let joined = UnionFind::new(self.vertices.len());
        (0..union.points.len() as u32).into_par_iter().for_each(|v| {
            let radius = union.points.squared_radius::<Single>(v).sqrt().value;
            let near = factor * shortest(radius, union.points.positions[v as usize]);
            let mut on_ball: Vec<u32> =
                self.chains_of(v).flat_map(|(_, chain)| chain).copied().collect();
            let place = |v: u32| self.vertices[v as usize];
            on_ball.sort_unstable_by(|&a, &b| place(a)[0].total_cmp(&place(b)[0]).then(a.cmp(&b)));
            on_ball.dedup();
            for (k, &a) in on_ball.iter().enumerate() {
                let next = on_ball[k + 1..].iter();
                for &b in next.take_while(|&&b| place(b)[0] - place(a)[0] <= near) {
                    let way = sub(place(b), place(a));
                    if dot(way, way) <= near * near {
                        joined.unite(a, b);
                    }
                }
            }
        });
        for (_, chain) in &mut self.chains {
            chain.iter_mut().for_each(|v| *v = joined.find(*v));
            chain.dedup();
        }
    }

    /// The chains of a ball.
    fn chains_of(&self, v: u32) -> impl Iterator<Item = &([u32; 2], Vec<u32>)> {
        let rows = self.of_ball[v as usize] as usize..self.of_ball[v as usize + 1] as usize;
        self.rows[rows].iter().map(|&row| &self.chains[row as usize])
    }

    /// The arcs of a ball, as directed edges that have its patch on their left, seen from outside.
    fn rim(&self, v: u32) -> Rim {
        let mut edges = Vec::new();
        for (balls, chain) in self.chains_of(v) {
            for two in chain.windows(2) {
                // Counter-clockwise about the way to the other ball, the cap beyond is on the left.
                edges.push(if balls[0] == v { [two[1], two[0]] } else { [two[0], two[1]] });
            }
        }
        Rim::new(edges)
    }
}

/// For each of so many balls the rows of the pairs that it is in, and where they begin.
fn rows_of(
    pairs: impl Iterator<Item = [u32; 2]> + Clone,
    balls: usize,
) -> Result<(Vec<u32>, Vec<u32>), BallsError> {
    let mut first: Vec<u32> = zeros(balls + 1, "the arcs of balls")?;
    pairs.clone().flatten().for_each(|v| first[v as usize + 1] += 1);
    for v in 0..balls {
        first[v + 1] += first[v];
    }
    let mut next = first.clone();
    let mut rows = zeros(first[balls] as usize, "the arcs of balls")?;
    for (row, pair) in (0..).zip(pairs) {
        for v in pair {
            rows[next[v as usize] as usize] = row;
            next[v as usize] += 1;
        }
    }
    Ok((rows, first))
}

/// The points that the spheres of triangles with open sides share, and the ends of arcs at them, by edge.
fn corners(union: &BallUnion<'_>) -> (Vec<V3>, Vec<End>) {
    let BallUnion { complex, points, sides, .. } = union;
    let mut open: Vec<(usize, usize)> = Vec::new();
    let mut ends: Vec<End> = Vec::new();
    for v in 0..points.len() as u32 {
        for (row, edges) in sides.facets_and_edges(complex, v) {
            for (side, _) in sides
                .sides(row)
                .into_iter()
                .enumerate()
                .filter(|&(_, apex)| apex == FacetSides::OPEN)
            {
                let corner = open.len() as u32;
                open.push((row, side));
                for (k, edge) in edges.into_iter().enumerate() {
                    // The normal is on side 0. About the edges to the first vertex's left and right it points counter-clockwise, and clockwise
                    // about the edge from the first to the last.
                    let begins = (side == 0) != (k == 1);
                    ends.push(End { edge, begins, corner, third: sides.facets()[row][k] });
                }
            }
        }
    }
    ends.sort_by_key(|end| (end.edge, end.corner));
    let place = |&(row, side): &(usize, usize)| {
        let mut balls = points.balls(sides.facets()[row]);
        // Differences from the smallest ball lose the fewest digits. A turn of the corners keeps the sides.
        let smallest = (0..3).min_by(|&a, &b| balls[a].weight.total_cmp(&balls[b].weight));
        balls.rotate_left(smallest.unwrap_or_default());
        let ways = Triangle::<Double>::of(balls).shared(points.alpha);
        let way = ways[side].map(|coordinate| coordinate.rounded().value);
        add(balls[0].centre, way)
    };
    (open.par_iter().map(place).collect(), ends)
}

/// The arcs of a circle from corner to corner, counter-clockwise about its axis; `None` if the order of its ends is lost in rounding.
fn pairs(
    union: &BallUnion<'_>,
    circle: &OnCircle,
    balls: [u32; 2],
    ends: &[End],
) -> Option<Vec<[u32; 2]>> {
    let pair =
        |from: &End, to: &End| (from.begins && !to.begins).then_some([from.corner, to.corner]);
    if let [a, b] = ends {
        return Some(vec![pair(a, b).or_else(|| pair(b, a))?]);
    }
    let centre = union.points.positions[balls[0] as usize];
    let angle = |end: &End| {
        let third = union.points.positions[end.third as usize];
        circle.angle(sub(third, centre))
    };
    // A triangle that is open on both sides ends one arc and begins the next.
    let mut sorted: Vec<(f64, bool, End)> =
        ends.iter().map(|end| (angle(end), end.begins, *end)).collect();
    sort_by(&mut sorted, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let first = sorted.iter().position(|(_, begins, _)| *begins)?;
    sorted.rotate_left(first);
    sorted.chunks(2).map(|two| pair(&two[0].2, &two.get(1)?.2)).collect()
}

/// The circle in which two spheres meet, with axes.
#[derive(Clone, Copy)]
struct OnCircle {
    centre: V3,
    radius: f64,
    /// The direction from the first ball to the second,
    axis: V3,
    /// one across it, and that which completes them.
    right: V3,
    up: V3,
    /// The length below which an arc is a point.
    shortest: f64,
}

impl OnCircle {
    /// `None` if the circle is a point.
    fn of(union: &BallUnion<'_>, ends: [u32; 2], factor: f64) -> Option<Self> {
        let points = &union.points;
        let balls = points.balls(ends);
        let height = Edge::measured(balls, points.alpha).heights[0].value;
        let radius = Circle::measured(balls, points.alpha).radius.value;
        let axis = unit(sub(balls[1].centre, balls[0].centre))?;
        let of = |v: u32| points.squared_radius::<Single>(v).sqrt().value;
        let shortest = factor * shortest(of(ends[0]).min(of(ends[1])), balls[0].centre);
        let least = (0..3).min_by(|&a, &b| axis[a].abs().total_cmp(&axis[b].abs()))?;
        let mut across = [0.0; 3];
        across[least] = 1.0;
        let right = unit(cross(axis, across))?;
        let circle = Self {
            centre: along(balls[0].centre, height, axis),
            radius,
            axis,
            right,
            up: cross(axis, right),
            shortest,
        };
        (radius > shortest).then_some(circle)
    }

    /// The angle of a way about the axis, from −π to π.
    fn angle(&self, way: V3) -> f64 {
        let (x, y) = (dot(way, self.right), dot(way, self.up));
        let [x, size] = [x, y.abs()].map(|value| Single { value, error: 0.0 });
        let angle = Single::angle(size, x).value;
        if y < 0.0 { -angle } else { angle }
    }

    /// The angle from one place to another, counter-clockwise, from 0 to 2π.
    fn turn(&self, from: V3, to: V3) -> f64 {
        let turn = self.angle(sub(to, self.centre)) - self.angle(sub(from, self.centre));
        if turn < 0.0 { turn + 2.0 * std::f64::consts::PI } else { turn }
    }

    fn place(&self, direction: V3) -> V3 {
        along(self.centre, self.radius, direction)
    }

    /// The direction in the middle of two, the second of which is this angle from the first.
    fn middle(&self, from: V3, to: V3, turn: f64) -> V3 {
        let way = if dot(from, to) < 0.0 {
            cross(sub(to, from), self.axis)
        } else {
            let sum = add(from, to);
            if turn < std::f64::consts::PI { sum } else { sum.map(|x| -x) }
        };
        unit(way).unwrap_or(from)
    }
}

/// The length below which features of a ball are points: a chord of this length is off the sphere by sixteen times what its ends
/// are rounded by, and shorter ones cannot be told from their circles.
fn shortest(radius: f64, centre: V3) -> f64 {
    let largest = centre.iter().fold(radius, |most: f64, x| most.max(x.abs()));
    (128.0 * f64::EPSILON * radius * largest).sqrt()
}

struct Arc {
    balls: [u32; 2],
    circle: OnCircle,
    /// The angle; `None` for a whole circle.
    turn: Option<f64>,
}

impl Arc {
    /// The vertices of the arc, the first and the last included; those between are new. A circle ends where it begins.
    fn chain(&self, ends: Option<[u32; 2]>, tolerance: f64, vertices: &mut Vec<V3>) -> Vec<u32> {
        let circle = &self.circle;
        // A chord of this angle is off the circle by at most its radius · angle² / 8. Two chords at least, and four of a circle, so that
        // no two arcs have the same edge. It is the same for all circles, so that those which coincide have the same vertices.
        let largest = (8.0 * tolerance).sqrt().min(std::f64::consts::FRAC_PI_2);
        let mut chain = Vec::new();
        let steps = |turn: f64, least: u32| {
            (least..31).find(|&k| turn / f64::from(1u32 << k) <= largest).unwrap_or(31)
        };
        if let (Some([from, to]), Some(turn)) = (ends, self.turn) {
            let direction = |vertices: &[V3], v: u32| {
                let way = sub(vertices[v as usize], circle.centre);
                unit(along(way, -dot(way, circle.axis), circle.axis)).unwrap_or(circle.right)
            };
            let [a, b] = [from, to].map(|v| direction(vertices, v));
            chain.push(from);
            let mut add = |direction| {
                chain.push(vertices.len() as u32);
                vertices.push(circle.place(direction));
            };
            circle.divide([a, b], turn, steps(turn, 1), &mut add);
            chain.push(to);
        } else {
            let quarter = std::f64::consts::FRAC_PI_2;
            let (right, up) = (circle.right, circle.up);
            let corners = [right, up, right.map(|x| -x), up.map(|x| -x)];
            let mut add = |direction| {
                chain.push(vertices.len() as u32);
                vertices.push(circle.place(direction));
            };
            for k in 0..4 {
                add(corners[k]);
                let two = [corners[k], corners[(k + 1) % 4]];
                circle.divide(two, quarter, steps(quarter, 0), &mut add);
            }
            chain.push(chain[0]);
        }
        chain
    }
}

impl OnCircle {
    /// Calls `add` with the directions that divide an arc into two to the power of `steps` parts, in order.
    fn divide(&self, [from, to]: [V3; 2], turn: f64, steps: u32, add: &mut dyn FnMut(V3)) {
        if steps == 0 {
            return;
        }
        let middle = self.middle(from, to, turn);
        self.divide([from, middle], turn / 2.0, steps - 1, add);
        add(middle);
        self.divide([middle, to], turn / 2.0, steps - 1, add);
    }
}

/// What the patches are made of.
struct Work<'a> {
    union: &'a BallUnion<'a>,
    sphere: &'a Sphere,
    arcs: Arcs,
    /// The edges of each ball: `edges[at_ball[v]..at_ball[v + 1]]`.
    edges: Vec<u32>,
    at_ball: Vec<u32>,
}

impl Work<'_> {
    /// The patch of a ball; empty if it has none.
    fn patch(&self, v: u32) -> Result<Patch, BallsError> {
        let BallUnion { points, .. } = self.union;
        let radius = points.squared_radius::<Single>(v).sqrt().value;
        let centre = points.positions[v as usize];
        let rim = self.arcs.rim(v);
        if radius <= shortest(radius, centre) {
            // It can hardly be told from its centre.
            return if rim.is_empty() {
                Ok(Patch::default())
            } else {
                Err(BallsError::Unresolved { ball: v })
            };
        }
        if rim.is_empty() {
            let area = points.unscaled(self.union.areas().get(v as usize), 2).value;
            // All of the sphere, but for points where others touch it, or nothing of it.
            let is_whole = area > 2.0 * std::f64::consts::PI * radius * radius;
            return Ok(if is_whole { self.sphere.whole(centre, radius) } else { Patch::default() });
        }
        let caps = self.caps(v);
        patch::triangulate(centre, radius, &self.arcs.vertices, rim, &caps, self.sphere)
            .ok_or(BallsError::Unresolved { ball: v })
    }

    /// The caps that others cut from a ball, in units of its radius.
    fn caps(&self, v: u32) -> Vec<Cap> {
        let rows = self.at_ball[v as usize] as usize..self.at_ball[v as usize + 1] as usize;
        let ends = |&row: &u32| self.union.complex.edges.rows()[row as usize];
        self.edges[rows].iter().filter_map(|row| Cap::of(self.union, v, ends(row))).collect()
    }
}
