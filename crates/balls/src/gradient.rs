//! Derivatives of volume and area by centres and radii.
//!
//! With u the unit vector from ball i to ball j, F the contact area, h the distance of its plane from the centre of i, ψ the open angle
//! of the circle of radius ρ around its centre o, E the integral over it of the unit vectors from o, m the first moment of the contact
//! about o, and q half of the sum of the squared radii less the squared distance d:
//!
//! ```text
//! ∂(Σ w V)/∂p_i = Σ_j (w_i − w_j) (F h u + m)/d − w_i F u
//! ∂(Σ w V)/∂r_i = w_i A_i + Σ_j (w_i − w_j) r_i F/d
//! ∂(Σ w A)/∂p_i = Σ_j ((w_i q − w_j r_i r_j)(h ψ u + ρ E)/d − 2 w_i F u) / r_i
//! ∂(Σ w A)/∂r_i = 2 w_i A_i / r_i + Σ_j (w_i q − w_j r_i r_j) ψ/d
//! ```
//!
//! They say how patches, arcs and contacts move, as in Edelsbrunner and Koehl 2003, doi:10.1073/pnas.0537830100, and Bryant, Edelsbrunner,
//! Koehl and Levitt 2004, doi:10.1007/s00454-004-1099-1, who have other terms.

use std::ops::Range;

use walpha_base::Monitor;
use walpha_base::parallel::prelude::*;
use walpha_shape::FacetSides;

use crate::real::{Bounded, Double, Real, Single};
use crate::scatter::{Records, ranges, scatter};
use crate::simplex::{Ball, Circle, Edge, Limits, Triangle, by_size};
use crate::union::zeros;
use crate::{BallUnion, BallsError, Measured};

/// The derivatives of a sum over balls.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Gradient {
    /// By the centre of each ball: rows 3i, 3i + 1 and 3i + 2 are those by x, y and z of ball i.
    pub by_centers: Measured,
    /// By the radius of each ball.
    pub by_radii: Measured,
}

/// The derivatives of volume and area.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Gradients {
    /// Of the volume.
    pub volume: Gradient,
    /// Of the area.
    pub area: Gradient,
}

/// Sums at a vertex: derivatives by its centre and its radius.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    volume: [Single; 4],
    area: [Single; 4],
}

/// What triangles add to an edge.
#[derive(Clone, Copy, Debug, Default)]
struct AtEdge {
    /// ρ E,
    arc: [Single; 3],
    /// and the part of m that is not below the arcs.
    moment: [Single; 3],
}

impl BallUnion<'_> {
    /// The derivatives of Σ w V and Σ w A, the sums of the parts of the balls with these weights, by input index; without weights, of
    /// the volume and the area of the union. Radii change as such, not as α and ω. Hidden balls and duplicates have derivatives 0. O(n).
    ///
    /// Derivatives are those on either side where they differ, as where balls touch: then the one of the dual complex, which counts balls
    /// that touch as overlapping. By a ball of radius 0 the area has no derivative, and the bound is infinite.
    ///
    /// # Errors
    /// Another number of weights than of points; out of memory; cancelled by a [`Monitor`] that watches.
    pub fn gradients(&self, weights: Option<&[f64]>) -> Result<Gradients, BallsError> {
        let monitor = &*Monitor::current();
        let (points, own) = (self.points.len(), self.volumes().len());
        if let Some(weights) = weights
            && weights.len() != own
        {
            return Err(BallsError::Weights { weights: weights.len(), points: own });
        }
        // In several copies of a small box, all copies of a ball have its weight, and the derivative by one copy of the sum over all of them is that of the
        // sum over a box by the ball with its copies.
        let weight =
            |v: u32| Single::exact(weights.map_or(1.0, |weights| weights[v as usize % own]));
        let count = self.complex.edges.len();
        let mut at_edges: Vec<AtEdge> = zeros(count, "derivatives")?;
        let groups: Vec<&[u32]> = self.sides.groups(VERTICES).collect();
        for groups in groups.chunks(PIECES) {
            let found: Vec<Records<AtEdge>> =
                groups.par_iter().map(|group| self.at_edges(group)).collect();
            scatter(
                &found,
                |of| of,
                &mut at_edges,
                |sum, more| {
                    for k in 0..3 {
                        sum.arc[k] += more.arc[k];
                        sum.moment[k] += more.moment[k];
                    }
                },
            );
            monitor.check()?;
        }
        let mut sums: Vec<Sums> = zeros(points, "derivatives")?;
        for window in ranges(0..count, ROWS * PIECES) {
            let pieces: Vec<_> = ranges(window, ROWS).collect();
            let of = |rows: Range<usize>| {
                rows.flat_map(|row| self.at_ends(row, &at_edges[row], weight)).collect()
            };
            let found: Vec<Records<Sums>> = pieces.into_par_iter().map(of).collect();
            scatter(
                &found,
                |of| of,
                &mut sums,
                |sum, more| {
                    for k in 0..4 {
                        sum.volume[k] += more.volume[k];
                        sum.area[k] += more.area[k];
                    }
                },
            );
            monitor.check()?;
        }
        let unit = |number: Single, power| self.points.bounded(number, power);
        let column = |rows, number: &(dyn Fn(usize) -> Bounded + Sync)| {
            Measured::collect(rows, "derivatives", number)
        };
        let area = |v: usize| {
            let Bounded { value, bound } = self.areas().get(v);
            Single { value, error: bound } * weight(v as u32)
        };
        let by_radius = |v: usize| {
            let of = area(v);
            if of == Single::ZERO {
                return unit(sums[v].area[3], 1);
            }
            let radius = unit(self.points.squared_radius::<Single>(v as u32).sqrt(), 1);
            let radius = Single { value: radius.value, error: radius.bound };
            let Bounded { value, bound } = unit(sums[v].area[3], 1);
            (of.times(2.0) / radius + Single { value, error: bound }).bounded()
        };
        let by_radius_of_volume = |v: usize| {
            let Bounded { value, bound } = unit(sums[v].volume[3], 2);
            (area(v) + Single { value, error: bound }).bounded()
        };
        Ok(Gradients {
            volume: Gradient {
                by_centers: column(3 * own, &|row| unit(sums[row / 3].volume[row % 3], 2))?,
                by_radii: column(own, &by_radius_of_volume)?,
            },
            area: Gradient {
                by_centers: column(3 * own, &|row| unit(sums[row / 3].area[row % 3], 1))?,
                by_radii: column(own, &by_radius)?,
            },
        })
    }

    /// What the triangles of a group of vertices add to edges.
    fn at_edges(&self, group: &[u32]) -> Records<AtEdge> {
        let mut found = Records::new();
        let facets = group.iter().flat_map(|&v| self.sides.facets_and_edges(&self.complex, v));
        for (row, edges) in facets {
            let corners = self.sides.facets()[row];
            let apexes = self.sides.sides(row);
            let balls = self.points.balls(corners);
            let apexes = apexes.map(|apex| {
                (apex != FacetSides::OPEN).then(|| self.points.near(balls[0].centre, apex))
            });
            let alpha = self.points.alpha;
            let at = of_triangle::<Single>(balls, apexes, alpha);
            let limit = Limits::of(&balls, alpha);
            let narrow = |at: &AtEdge| {
                at.arc.iter().all(|&x| limit.length(x)) && at.moment.iter().all(|&x| limit.cube(x))
            };
            let at = if at.iter().all(narrow) {
                at
            } else {
                let order = by_size(&balls);
                // An odd permutation turns the normal.
                let turned = (order[0] > order[1]) ^ (order[0] > order[2]) ^ (order[1] > order[2]);
                let [first, second] = apexes;
                let apexes = if turned { [second, first] } else { apexes };
                let found = of_triangle::<Double>(order.map(|k| balls[k]), apexes, alpha);
                let mut at = [AtEdge::default(); 3];
                order.into_iter().zip(found).for_each(|(of, found)| at[of] = found);
                at
            };
            found.extend(edges.into_iter().zip(at));
        }
        found
    }

    /// What an edge adds to its ends.
    fn at_ends(&self, row: usize, at: &AtEdge, weight: impl Fn(u32) -> Single) -> [(u32, Sums); 2] {
        let ends = self.complex.edges.rows()[row];
        let (alpha, arc) = (self.points.alpha, self.arcs[row]);
        let balls = self.points.balls(ends);
        let Edge { distance, heights } = Edge::measured(balls, alpha);
        let contact = self.points.unscaled(self.contact_sizes().get(row), 2);
        let squares = balls.map(|ball| Single::sum(alpha, ball.weight));
        let radii = squares.map(Single::sqrt);
        let cosine = (squares[0] + squares[1] - distance.square()).half();
        let circle =
            if arc == Single::ZERO { Single::ZERO } else { Circle::measured(balls, alpha).squared };
        let third = circle / Single::exact(3.0);
        let moment = [0, 1, 2].map(|k| at.moment[k] + third * at.arc[k]);
        let way =
            Single::ray(balls[0].centre, balls[1].centre).map(|x| Single::along(x) / distance);
        let weights = ends.map(&weight);
        let sums = |k: usize| {
            let (i, j) = (k, 1 - k);
            let difference = weights[i] - weights[j];
            let bend = (weights[i] * cosine - weights[j] * radii[0] * radii[1]) / distance;
            let mut sums = Sums::default();
            for axis in 0..3 {
                let u = if k == 0 { way[axis] } else { -way[axis] };
                let pull = contact * u;
                let turn = difference * (pull * heights[i] + moment[axis]) / distance;
                sums.volume[axis] = turn - weights[i] * pull;
                let along = heights[i] * arc * u + at.arc[axis];
                sums.area[axis] = (bend * along - (weights[i] * pull).times(2.0)) / radii[i];
            }
            sums.volume[3] = difference * radii[i] * contact / distance;
            sums.area[3] = bend * arc;
            (ends[k], sums)
        };
        [sums(0), sums(1)]
    }
}

/// Vertices whose triangles are one piece of work, edges that are one, and pieces that are summed at a time.
const VERTICES: usize = 1 << 6;
const ROWS: usize = 1 << 11;
const PIECES: usize = 1 << 6;

/// What a triangle adds to the edges opposite its corners.
fn of_triangle<N: Real>(balls: [Ball; 3], apexes: [Option<Ball>; 2], alpha: f64) -> [AtEdge; 3] {
    let triangle = Triangle::<N>::of(balls);
    let mut at = [AtEdge::default(); 3];
    let twice = triangle.area.sqrt();
    let inwards = triangle.inwards();
    // Of the sides, the first is that to which the normal points.
    for (apex, sign) in apexes.into_iter().zip([1.0, -1.0]) {
        let normal = triangle.normal.map(|x| x.times(sign));
        let open = apex.is_none().then(|| triangle.squared_height(alpha).sqrt());
        let height = match (apex, open) {
            (Some(apex), _) => triangle.with(apex, [false; 3]).height,
            (None, Some(open)) => open / twice,
            (None, None) => unreachable!("a side without a cell is open"),
        };
        for k in 0..3 {
            let length = triangle.squares[k].sqrt();
            let coordinate = triangle.coordinates[k];
            // The distance of the triangle's centre from the edge, times the height, …
            let kite = coordinate * height / length;
            let inward = coordinate.times(2.0) / (triangle.squares[k] * triangle.area);
            for axis in 0..3 {
                let (e, n) = (inwards[k][axis], normal[axis]);
                let moment = kite * (inward * e + height * n) / N::exact(6.0);
                at[k].moment[axis] += moment.rounded();
                if let Some(open) = open {
                    let arc =
                        coordinate * n / (length * triangle.area) - open * e / (twice * length);
                    at[k].arc[axis] += arc.rounded();
                }
            }
        }
    }
    at
}
