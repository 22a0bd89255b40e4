//! Edges, triangles and tetrahedra of balls: lengths, angles and volumes with bounds on their errors.
//!
//! The *reach* from ball i to ball j is the inner product of the way from centre to centre and the way from the centre of i to any point of the plane in
//! which the powers of i and j are equal: half of the squared distance and the difference of squared radii. The centre of a triangle,
//! that of its smallest orthogonal sphere, is the point of its plane that lies in two such planes.

use walpha_base::sort::sort_handful_by;
use walpha_base::vector::V3;

use crate::real::{Double, Ray, Real, Single};

/// A ball: its centre and its weight ω. Its squared radius is α + ω.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub centre: V3,
    pub weight: f64,
}

/// The reach from one ball to another, given their squared distance.
#[inline(always)]
fn reach<N: Real>(squared: N, [i, j]: [Ball; 2]) -> N {
    (squared + N::sum(i.weight, -j.weight)).half()
}

/// Two balls and the plane in which their powers are equal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge<N> {
    /// The distance of the centres, d.
    pub distance: N,
    /// From either centre to the plane, positive if the plane lies towards the other centre.
    pub heights: [N; 2],
}

impl<N: Real> Edge<N> {
    #[inline(always)]
    fn of([i, j]: [Ball; 2]) -> (Self, N) {
        let apart = N::squared(N::ray(i.centre, j.centre));
        let distance = apart.sqrt();
        let heights = [reach(apart, [i, j]) / distance, reach(apart, [j, i]) / distance];
        (Self { distance, heights }, apart)
    }

    fn rounded(self) -> Edge<Single> {
        Edge { distance: self.distance.rounded(), heights: self.heights.map(N::rounded) }
    }
}

impl Edge<Single> {
    /// The edge, in doubles if that is narrow enough, or else in numbers of two doubles.
    #[inline(always)]
    pub(crate) fn measured(balls: [Ball; 2], alpha: f64) -> Self {
        let (edge, _) = Self::of(balls);
        let limits = Limits::of(&balls, alpha);
        if edge.is_within(limits) { edge } else { Edge::<Double>::of(balls).0.rounded() }
    }

    fn is_within(&self, limits: Limits) -> bool {
        [self.distance, self.heights[0], self.heights[1]]
            .iter()
            .all(|&length| limits.length(length))
    }
}

/// The circle in which two spheres meet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circle<N> {
    /// The height of the cap of either ball beyond the plane of the circle, seen from its centre.
    pub caps: [N; 2],
    /// The radius of the circle, ρ, and its square.
    pub radius: N,
    pub squared: N,
    /// ρ times the angle between the outer normals of the two spheres on the circle.
    pub bend: N,
}

impl<N: Real> Circle<N> {
    fn of(balls: [Ball; 2], alpha: f64) -> Self {
        let (Edge { distance, heights }, apart) = Edge::of(balls);
        let squares: [N; 2] = balls.map(|ball| N::sum(alpha, ball.weight));
        let radii = squares.map(N::sqrt);
        let caps = [radii[0] - heights[0], radii[1] - heights[1]];
        // The smaller ball loses fewer digits.
        let of = usize::from(balls[1].weight < balls[0].weight);
        let squared = caps[of] * (radii[of] + heights[of]);
        let radius = squared.sqrt();
        let cosine = (squares[0] + squares[1] - apart).half();
        Self { caps, radius, squared, bend: radius * N::angle(distance * radius, cosine) }
    }
}

impl Circle<Single> {
    /// The circle, in doubles if that is narrow enough, or else in numbers of two doubles.
    pub(crate) fn measured(balls: [Ball; 2], alpha: f64) -> Self {
        let circle = Self::of(balls, alpha);
        let limits = Limits::of(&balls, alpha);
        let lengths = [circle.caps[0], circle.caps[1], circle.radius, circle.bend];
        if lengths.into_iter().all(|length| limits.length(length)) && limits.square(circle.squared)
        {
            return circle;
        }
        let Circle { caps, radius, squared, bend } = Circle::<Double>::of(balls, alpha);
        Self {
            caps: caps.map(Double::rounded),
            radius: radius.rounded(),
            squared: squared.rounded(),
            bend: bend.rounded(),
        }
    }
}

/// The corners of a simplex by the sizes of their balls, the smallest first. Small balls are near each other, so that differences from one of
/// them lose the fewest digits.
pub(crate) fn by_size<const N: usize>(balls: &[Ball; N]) -> [usize; N] {
    let mut order = std::array::from_fn(|k| k);
    sort_handful_by(&mut order, |&a, &b| balls[a].weight.total_cmp(&balls[b].weight));
    order
}

/// A triangle of balls.
pub(crate) struct Triangle<N: Real> {
    balls: [Ball; 3],
    /// From the first corner to the others.
    rays: [Ray<N>; 2],
    /// From the second corner to the third.
    third: Ray<N>,
    /// The squared length of the edge opposite each corner.
    pub squares: [N; 3],
    /// The inner product of the edges at each corner.
    pub products: [N; 3],
    /// The reaches from the first corner to the others.
    reaches: [N; 2],
    /// The product of the two edges, twice the area long.
    pub normal: [N; 3],
    /// Its squared length.
    pub area: N,
    /// For each corner, `area` times the barycentric coordinate of the triangle's centre. That is also the length of the opposite edge, times twice
    /// the area, times the distance of the centre from that edge, positive on the side of the corner.
    pub coordinates: [N; 3],
}

impl<N: Real> Triangle<N> {
    #[inline(always)]
    pub(crate) fn of(balls: [Ball; 3]) -> Self {
        let [i, j, k] = balls;
        let [a, b] = [j, k].map(|other| N::ray(i.centre, other.centre));
        let third = N::ray(j.centre, k.centre);
        let squares = [N::squared(third), N::squared(b), N::squared(a)];
        let products = [N::dot(a, b), -N::dot(a, third), N::dot(b, third)];
        let reaches = [reach(squares[2], [i, j]), reach(squares[1], [i, k])];
        let [of_j, of_k] = reaches;
        let normal = N::cross(a, b);
        let along_third = reach(squares[0], [j, k]);
        let coordinates = [
            reach(squares[2], [j, i]) * squares[0] - along_third * products[1],
            of_j * squares[1] - of_k * products[0],
            of_k * squares[2] - of_j * products[0],
        ];
        let area = N::squared_normal(normal);
        Self { balls, rays: [a, b], third, squares, products, reaches, normal, area, coordinates }
    }

    /// The tetrahedron of the triangle and another ball. With `angles`, those at the edges that are named.
    #[inline(always)]
    pub(crate) fn with(&self, apex: Ball, angles: [bool; 3]) -> Side<N> {
        let [a, b] = self.rays;
        let way = N::ray(self.balls[0].centre, apex.centre);
        let det = N::triple(self.normal, way);
        let det = if det.rounded().value < 0.0 { -det } else { det };
        let [along_a, along_b] = [N::dot(a, way), N::dot(b, way)];
        let reach = reach(N::squared(way), [self.balls[0], apex]);
        let in_plane = self.coordinates[1] * along_a + self.coordinates[2] * along_b;
        let height = (reach - in_plane / self.area) / det;
        let mut side = Side { det, height, angles: [None; 3] };
        if angles.contains(&true) {
            let from_second = N::ray(self.balls[1].centre, apex.centre);
            let along_third = N::dot(self.third, from_second);
            let back = -N::dot(a, from_second);
            let cosines = [
                self.squares[0] * back - along_third * self.products[1],
                self.squares[1] * along_a - along_b * self.products[0],
                self.squares[2] * along_b - along_a * self.products[0],
            ];
            for edge in 0..3 {
                if angles[edge] {
                    side.angles[edge] =
                        Some(N::angle(det * self.squares[edge].sqrt(), cosines[edge]));
                }
            }
        }
        side
    }

    /// For the edge opposite each corner, a vector in the plane and across the edge, towards the corner: the product of the normal and the edge.
    pub(crate) fn inwards(&self) -> [[N; 3]; 3] {
        let [a, b] = self.rays;
        let n = self.normal;
        [(self.third, 1.0), (b, -1.0), (a, 1.0)].map(|(edge, sign)| {
            let edge = edge.map(N::along);
            let minor = |i: usize, j: usize| (n[i] * edge[j] - n[j] * edge[i]).times(sign);
            [minor(1, 2), minor(2, 0), minor(0, 1)]
        })
    }

    /// The squared distance from the plane of the points that the three spheres share; not negative for a triangle of the dual complex.
    #[inline(always)]
    pub(crate) fn squared_height(&self, alpha: f64) -> N {
        let [_, of_j, of_k] = self.coordinates;
        let away = (self.reaches[0] * of_j + self.reaches[1] * of_k) / self.area;
        N::sum(alpha, self.balls[0].weight) - away
    }

    /// From the first corner, the ways to the two points that the three spheres share; the first is where the normal points.
    pub(crate) fn shared(&self, alpha: f64) -> [[N; 3]; 2] {
        let height = (self.squared_height(alpha) / self.area).sqrt();
        let [a, b] = self.rays.map(|ray| ray.map(N::along));
        let [_, of_j, of_k] = self.coordinates;
        [height, -height].map(|height| {
            let along = |x: usize| (a[x] * of_j + b[x] * of_k) / self.area;
            [0, 1, 2].map(|x| along(x) + self.normal[x] * height)
        })
    }

    /// The tetrahedron of the triangle and one of the points that its three spheres share.
    pub(crate) fn open(&self, alpha: f64) -> Open<N> {
        let height = self.squared_height(alpha).sqrt();
        let twice = self.area.sqrt();
        let det = twice * height;
        let lengths = self.squares.map(N::sqrt);
        let squares = self.balls.map(|ball| N::sum(alpha, ball.weight));
        let radii = squares.map(N::sqrt);
        let reach = |from: usize, to: usize| {
            reach(self.squares[3 - from - to], [self.balls[from], self.balls[to]])
        };
        let angles = [0, 1, 2].map(|edge| N::angle(det * lengths[edge], self.coordinates[edge]));
        // Solid angles by the formula of van Oosterom and Strackee 1983, doi:10.1109/TBME.1983.325207.
        let at = |corner: usize| {
            let (next, last) = ((corner + 1) % 3, (corner + 2) % 3);
            // The edge to each of the two others is opposite the other one.
            let (to_next, to_last) = (lengths[last], lengths[next]);
            let denominator = (to_next * to_last + self.products[corner]) * radii[corner]
                + reach(corner, next) * to_last
                + reach(corner, last) * to_next;
            N::angle(det, denominator).times(2.0)
        };
        let apart = |corner: usize| {
            let (next, last) = ((corner + 1) % 3, (corner + 2) % 3);
            (squares[next] + squares[last] - self.squares[corner]).half() * radii[corner]
        };
        let denominator = radii[0] * radii[1] * radii[2] + apart(0) + apart(1) + apart(2);
        Open {
            height: height / twice,
            det,
            angles,
            corners: [at(0), at(1), at(2)],
            apex: N::angle(det, denominator).times(2.0),
        }
    }
}

/// One side of a triangle with a tetrahedron of the complex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side<N> {
    /// Six times its volume.
    pub det: N,
    /// The height of its centre, that of its orthogonal sphere, above the triangle, divided by twice the triangle's area.
    pub height: N,
    /// Its angles at the edges opposite the corners of the triangle, if they were asked for.
    pub angles: [Option<N>; 3],
}

/// One side of a triangle without a tetrahedron of the complex: the tetrahedron whose apex is the point there that the three spheres share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Open<N> {
    /// The height of the apex above the triangle, divided by twice the triangle's area.
    pub height: N,
    /// Six times its volume.
    pub det: N,
    /// Its angles at the edges opposite the corners of the triangle.
    pub angles: [N; 3],
    /// Its solid angles at the corners of the triangle.
    pub corners: [N; 3],
    /// The solid angle at the apex.
    pub apex: N,
}

impl<N: Real> Side<N> {
    /// For the edge opposite each corner of the triangle, twice its length times the part of its power facet at the triangle.
    fn kites(&self, triangle: &Triangle<N>) -> [N; 3] {
        triangle.coordinates.map(|coordinate| coordinate * self.height)
    }
}

impl Side<Single> {
    /// The same and its kites, if the bounds are narrow enough.
    #[inline(always)]
    pub(crate) fn checked(
        self,
        triangle: &Triangle<Single>,
        limits: Limits,
    ) -> Option<(Self, [Single; 3])> {
        let kites = self.kites(triangle);
        let narrow = self.angles.into_iter().flatten().all(Limits::angle)
            && limits.cube(self.det)
            && kites.into_iter().all(|kite| limits.cube(kite));
        narrow.then_some((self, kites))
    }

    /// The side and its kites, in numbers of two doubles.
    #[cold]
    pub(crate) fn closely(
        balls: [Ball; 3],
        apex: Ball,
        angles: [bool; 3],
        alpha: f64,
    ) -> (Self, [Single; 3]) {
        let order = by_size(&balls);
        let triangle = Triangle::<Double>::of(order.map(|k| balls[k]));
        let side = triangle.with(apex, order.map(|k| angles[k]));
        // The centre is in all four balls, so it is no higher than the points that the three spheres share.
        let most = triangle.squared_height(alpha).sqrt() / triangle.area.sqrt();
        let (mut kites, mut angles) = ([Single::ZERO; 3], [None; 3]);
        for (at, of) in order.into_iter().enumerate() {
            let kite = (triangle.coordinates[at] * side.height).rounded();
            let most = (triangle.coordinates[at] * most).rounded();
            let most = most.value.abs() + most.error;
            let known = kite.error <= most;
            kites[of] = if known { kite } else { Single { value: 0.0, error: most } };
            angles[of] = side.angles[at].map(Double::rounded);
        }
        (Self { det: side.det.rounded(), height: side.height.rounded(), angles }, kites)
    }
}

impl Open<Single> {
    /// The open side of a triangle, and its kites: in doubles if that is narrow enough, or else in numbers of two doubles.
    pub(crate) fn measured(
        triangle: &Triangle<Single>,
        balls: [Ball; 3],
        alpha: f64,
        limits: Limits,
    ) -> (Self, [Single; 3]) {
        let open = triangle.open(alpha);
        let kites = triangle.coordinates.map(|coordinate| coordinate * open.height);
        let angles = open.angles.iter().chain(&open.corners);
        if angles.copied().all(Limits::angle)
            && limits.cube(open.det)
            && kites.into_iter().all(|kite| limits.cube(kite))
        {
            return (open, kites);
        }
        Self::closely(balls, alpha)
    }

    #[cold]
    fn closely(balls: [Ball; 3], alpha: f64) -> (Self, [Single; 3]) {
        let order = by_size(&balls);
        let triangle = Triangle::<Double>::of(order.map(|k| balls[k]));
        let open = triangle.open(alpha);
        let mut found = Self {
            height: open.height.rounded(),
            det: open.det.rounded(),
            angles: [Single::ZERO; 3],
            corners: [Single::ZERO; 3],
            apex: open.apex.rounded(),
        };
        let mut kites = [Single::ZERO; 3];
        for (at, of) in order.into_iter().enumerate() {
            kites[of] = (triangle.coordinates[at] * open.height).rounded();
            found.angles[of] = open.angles[at].rounded();
            found.corners[of] = open.corners[at].rounded();
        }
        (found, kites)
    }
}

/// The angles of a tetrahedron of the triangulation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell<N> {
    /// Six times its volume.
    pub det: N,
    /// The angles at its edges, in the order of [`Cell::EDGES`].
    pub angles: [N; 6],
}

impl Cell<()> {
    /// The edges by their corners.
    pub(crate) const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    /// The edges at each corner.
    pub(crate) const AT: [[usize; 3]; 4] = [[0, 1, 2], [0, 3, 4], [1, 3, 5], [2, 4, 5]];
    /// The facets by their corners.
    pub(crate) const FACETS: [[usize; 3]; 4] = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]];
}

impl<N: Real> Cell<N> {
    fn of([a, b, c, d]: [Ball; 4]) -> Self {
        let side = |triangle, apex, asked| Triangle::of(triangle).with(apex, asked);
        let angles = |side: &Side<N>| side.angles.map(|angle| angle.unwrap_or(N::exact(0.0)));
        let first = side([a, b, c], d, [true; 3]);
        let [bc, ac, ab] = angles(&first);
        let [bd, ad, _] = angles(&side([a, b, d], c, [true, true, false]));
        let [cd, ..] = angles(&side([a, c, d], b, [true, false, false]));
        Self { det: first.det, angles: [ab, ac, ad, bc, bd, cd] }
    }
}

impl Cell<Single> {
    /// The cell, in doubles if that is narrow enough, or else in numbers of two doubles.
    pub(crate) fn measured(balls: [Ball; 4], alpha: f64) -> Self {
        let cell = Self::of(balls);
        let limits = Limits::of(&balls, alpha);
        if cell.angles.into_iter().all(Limits::angle) && limits.cube(cell.det) {
            return cell;
        }
        let order = by_size(&balls);
        let cell = Cell::<Double>::of(order.map(|k| balls[k]));
        let angles = Cell::EDGES.map(|[i, j]| {
            let is_same = |[a, b]: &[usize; 2]| {
                let [a, b] = [order[*a], order[*b]];
                [a.min(b), a.max(b)] == [i, j]
            };
            let at = Cell::EDGES.iter().position(is_same).expect("corners are exchanged");
            cell.angles[at].rounded()
        });
        Self { det: cell.det.rounded(), angles }
    }
}

/// How wide bounds may be before a simplex is computed again in numbers of two doubles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// The radius of the smallest ball of the simplex.
    radius: f64,
}

impl Limits {
    /// 2⁻⁴⁰: of angles, and of lengths, areas and volumes relative to those of the smallest ball. Errors of doubles are about 2⁻⁵⁰.
    pub(crate) const PART: f64 = 1.0 / (1u64 << 40) as f64;

    pub(crate) fn of(balls: &[Ball], alpha: f64) -> Self {
        let least = balls.iter().map(|ball| alpha + ball.weight).fold(f64::INFINITY, f64::min);
        Self { radius: least.max(0.0).sqrt() }
    }

    #[inline(always)]
    pub(crate) fn angle(angle: Single) -> bool {
        angle.is_within(Self::PART)
    }

    #[inline(always)]
    pub(crate) fn length(self, length: Single) -> bool {
        length.is_within(Self::PART * self.radius)
    }

    #[inline(always)]
    pub(crate) fn square(self, area: Single) -> bool {
        area.is_within(Self::PART * self.radius * self.radius)
    }

    #[inline(always)]
    pub(crate) fn cube(self, volume: Single) -> bool {
        volume.is_within(Self::PART * self.radius * self.radius * self.radius)
    }
}
