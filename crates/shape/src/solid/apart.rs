//! Moves the copies of vertices apart, so that the boundary is a manifold also for readers that take equal coordinates for one
//! vertex.
//!
//! The boundary of the cut solid touches itself, but does not cross itself: facets meet only in common faces if copies at one
//! place count as one vertex. Vertices are moved one after another, and each step preserves this property:
//!
//! - **Into the cells of its fan.** Let S be the union of the cells around a copy v. Its boundary consists of the fan at v and of
//!   the facets opposite v. A point p that is strictly inside the planes of all these facets sees all of S: it is in the interior of
//!   the kernel, and S is star-shaped about it. So the facets from p to the border of the fan are in S, meet its boundary in the border
//!   alone, and do not cross each other. No other part of the boundary is in the interior of S. The cells with p for v are positively
//!   oriented, as p is inside the opposite facets, and fill what is left of S. Where S touches itself, at places whose copies have not
//!   been moved yet, this holds for S with these copies a little apart, as being strictly inside of planes does.
//! - **Out of the cells**, where cavities touch at a vertex: between them are the same cells, so that all fans but one must retreat
//!   into their cavities. If p is strictly outside the planes of the fan, the tetrahedra v–p–a–b over its facets v–a–b are positively
//!   oriented, and lie side by side around the line v–p. They become cells, if no other facet of the boundary enters them, which is
//!   decided for all facets near.
//! - **Anywhere near**, for what is still together after all of that, as a fan that is a saddle is seen from no point. A number of
//!   directions are tried: a new fan crosses neither itself nor a facet near, opposite facets of its cells included, and these cells
//!   stay positively oriented. So these fill what the fan and the opposite facets bound, a sphere that does not cross itself.
//!
//! One fan at each place stays. After all others have moved, no two vertices are at the same place. Everything is decided exactly
//! for the doubles that are written. Single precision rounds them once more, by a fraction of the steps ([`LEAST`]).

use std::cmp::Ordering::{Greater, Less};
use std::collections::HashMap;

use walpha_base::sort::sort_by_key;
use walpha_regular::predicates::orientation;

use super::boxes::{Boxes, bounds};
use super::crossing::{cross, inside};
use super::direction::{axis, length, normal};
use super::tiling::{Place, Tiling, opposite};
use super::{Middle, Surface};

type Point = [f64; 3];

/// The share of the shortest edge of a fan by which its vertex is moved, or otherwise half of that, and so on.
const STEP: f64 = 1.0 / 1024.0;
/// The number of steps that are tried.
const TRIES: usize = 24;
/// The share of the extent of the boundary by which a vertex is moved at least, if possible: several steps of single precision,
/// so that files in single precision also have different places.
const LEAST: f64 = 4.0 * f32::EPSILON as f64;
/// The largest share of the shortest edge for that.
const MOST: f64 = 1.0 / 16.0;
/// The largest share of a coordinate for steps that are longer only because doubles are not denser.
const ROUNDING: f64 = 32.0 * f64::EPSILON;
/// The number of steps that are tried in all directions.
const FAR: usize = 4;
/// Half the width of the grid of these directions.
const GRID: u32 = 3;

pub(super) struct Moved {
    /// Vertices that were moved, ascending, with their places.
    pub moved: Vec<(u32, Point)>,
    pub largest: f64,
    /// The number of vertices that are still at the place of another one.
    pub together: usize,
}

pub(super) struct Apart<'a> {
    surface: &'a Surface,
    of_input: &'a [Point],
    positions: Vec<Point>,
    tiling: Tiling,
    /// Half of the extent of the boundary along the axis where it is largest.
    extent: f64,
    /// The facets at each vertex that is being moved or separated.
    fans: HashMap<u32, Vec<u32>>,
    /// All facets, if they were requested.
    facets: Option<Boxes>,
}

impl<'a> Apart<'a> {
    pub(super) fn new(surface: &'a Surface, of_input: &'a [Point], tiling: Tiling) -> Self {
        let positions: Vec<Point> = surface.positions(of_input).collect();
        let [low, high] = bounds(positions.iter().copied());
        let extent = (0..3).map(|k| high[k] / 2.0 - low[k] / 2.0).fold(0.0, f64::max);
        let (fans, facets) = (HashMap::new(), None);
        Self { surface, of_input, positions, tiling, extent, fans, facets }
    }

    /// Separates vertices that are at the same place.
    pub(super) fn separate(&mut self, middles: &[Middle], places: &[Place]) -> Moved {
        self.collect_fans(middles, places);
        self.orient();
        let before = self.positions.clone();
        let mut left = Vec::new();
        for middle in middles {
            if !self.move_middle(middle) {
                left.push((middle.vertex..middle.vertex + 1, 1));
            }
        }
        for place in places {
            let staying = self.separate_copies(place);
            if staying > 0 {
                left.push((place.copies.clone(), staying));
            }
        }
        let mut together = 0;
        for (vertices, mut count) in left {
            for v in vertices {
                let stays = self.positions[v as usize] == before[v as usize];
                if count > 0 && stays && self.move_anywhere(v) {
                    count -= 1;
                }
            }
            together += count;
        }
        let pairs = (0..).zip(before.iter().zip(&self.positions));
        let moved: Vec<_> = pairs.filter(|(_, (old, new))| old != new).collect();
        let largest = moved
            .iter()
            .map(|(_, (old, new))| length([0, 1, 2].map(|k| old[k] - new[k])))
            .fold(0.0, f64::max);
        Moved { moved: moved.iter().map(|(v, (_, new))| (*v, **new)).collect(), largest, together }
    }

    fn collect_fans(&mut self, middles: &[Middle], places: &[Place]) {
        let copies = places.iter().flat_map(|place| place.copies.clone());
        let vertices = copies.chain(middles.iter().map(|middle| middle.vertex));
        self.fans = vertices.map(|v| (v, Vec::new())).collect();
        for (row, facet) in self.surface.regular.iter().zip(0..) {
            for v in row {
                if let Some(fan) = self.fans.get_mut(v) {
                    fan.push(facet);
                }
            }
        }
    }

    /// Makes all cells positively oriented.
    fn orient(&mut self) {
        for i in 0..self.tiling.cells.len() {
            let [a, b, c, d] = self.tiling.cells[i].map(|v| self.at(v));
            if orientation(a, b, c, d) == Less {
                self.tiling.cells[i].swap(0, 1);
            }
        }
    }

    /// The cells around the vertices that move.
    #[cfg(test)]
    pub(super) fn cells(&self) -> &[[u32; 4]] {
        &self.tiling.cells
    }

    /// The current position of a vertex.
    pub(super) fn at(&self, v: u32) -> Point {
        match v.checked_sub(self.tiling.vertices) {
            Some(input) => self.of_input[input as usize],
            None => self.positions[v as usize],
        }
    }

    /// The facets at a vertex by their other corners, counter-clockwise as seen from outside.
    fn fan(&self, v: u32) -> Vec<[u32; 2]> {
        let turned = |&facet: &u32| {
            let [a, b, c] = self.surface.regular[facet as usize];
            match v {
                _ if v == a => [b, c],
                _ if v == b => [c, a],
                _ => [a, b],
            }
        };
        self.fans[&v].iter().map(turned).collect()
    }

    /// Moves a midpoint into the cells between its facets. Returns whether a step was found.
    fn move_middle(&mut self, middle: &Middle) -> bool {
        let vertex = middle.vertex;
        let [u, v] = middle.ends.map(|v| self.tiling.corner(v));
        let [from, to] = middle.thirds.map(|v| self.tiling.corner(v));
        let cells = self.tiling.between([u, v], [from, to]);
        let (Some(&first), Some(&last)) = (cells.first(), cells.last()) else { return false };
        let tiling = &self.tiling;
        let side = |cell: u32, third: u32| {
            let row = tiling.cells[cell as usize];
            let fourth = row.into_iter().find(|w| ![u, v, third].contains(w));
            opposite(row, fourth.expect("a fourth corner"))
        };
        let fan = [side(first, from), side(last, to)];
        let ends = |&cell: &u32| [u, v].map(|end| opposite(tiling.cells[cell as usize], end));
        let others: Vec<[u32; 3]> = cells.iter().flat_map(ends).collect();
        let steps = self.steps(vertex, [u, v, from, to]);
        let found = self.step(vertex, &fan, &others, &steps, |_| true);
        self.tiling.divide(&cells, [u, v], vertex);
        found
    }

    /// Moves all copies but one away from a place. Returns the number of further copies that stay.
    fn separate_copies(&mut self, place: &Place) -> usize {
        let mut whole = Vec::new();
        let mut staying = place.copies.len();
        for group in &place.groups {
            let left = self.retreat(group);
            staying -= group.len() - left.len();
            if let [v] = left[..] {
                whole.push(v);
            }
        }
        sort_by_key(&mut whole, |v| (self.fans[v].len(), *v));
        for v in whole {
            if staying > 1 && self.move_inside(v) {
                staying -= 1;
            }
        }
        staying - 1
    }

    /// Moves a copy into the cells of its fan.
    fn move_inside(&mut self, v: u32) -> bool {
        let fan = self.fan(v);
        let others: Vec<[u32; 3]> = self.tiling.opposite(v).collect();
        let steps = self.steps(v, fan.iter().map(|side| side[0]));
        let fan: Vec<_> = fan.into_iter().map(|[a, b]| [v, b, a]).collect();
        self.step(v, &fan, &others, &steps, |_| true)
    }

    /// Moves copies that share the same cells out of these, except for one, which gets the cells. Returns the copies that stay.
    fn retreat(&mut self, group: &[u32]) -> Vec<u32> {
        let mut order = group.to_vec();
        sort_by_key(&mut order, |v| (self.fans[v].len(), *v));
        let (mut left, mut filled) = (group.to_vec(), Vec::new());
        for v in order {
            if left.len() > 1 && self.move_outside(v) {
                left.retain(|&other| other != v);
                filled.extend(self.fan(v).into_iter().map(|[a, b]| [a, b, v]));
            }
        }
        let stays = left[0];
        if stays != group[0] {
            self.tiling.rename(group[0], stays);
        }
        for [a, b, v] in filled {
            self.tiling.push([stays, a, b, v]);
        }
        left
    }

    /// Moves a copy out of the cells behind its fan.
    fn move_outside(&mut self, v: u32) -> bool {
        let sides = self.fan(v);
        let fan: Vec<_> = sides.iter().map(|&[a, b]| [v, a, b]).collect();
        let steps = self.steps(v, sides.iter().map(|side| side[0]));
        let near = self.near(v, &steps);
        let from = self.at(v);
        let sides: Vec<[Point; 2]> = sides.iter().map(|side| side.map(|w| self.at(w))).collect();
        let empty = |p: Point| {
            near.iter().all(|facet| {
                !facet.contains(&p)
                    && sides.iter().all(|&[a, b]| {
                        !cross(*facet, [p, a, b])
                            && !cross(*facet, [from, p, a])
                            && !facet.iter().any(|&corner| inside([from, a, b, p], corner))
                    })
            })
        };
        self.step(v, &fan, &[], &steps, empty)
    }

    /// Moves a vertex in one of many directions, to a place where no facets cross.
    fn move_anywhere(&mut self, v: u32) -> bool {
        let sides = self.fan(v);
        let steps = self.steps(v, sides.iter().map(|side| side[0]));
        let corners = |facet: [u32; 3]| facet.map(|w| self.at(w));
        let opposite: Vec<[Point; 3]> = self.tiling.opposite(v).map(corners).collect();
        let others = [self.near(v, &steps), opposite.clone()].concat();
        let from = self.at(v);
        let sides: Vec<[Point; 2]> = sides.iter().map(|side| side.map(|w| self.at(w))).collect();
        let fits = |p: &Point| {
            let fan: Vec<[Point; 3]> =
                sides.iter().map(|&[a, b]| [p, &a, &b].map(|&x| x)).collect();
            opposite.iter().all(|[a, b, c]| orientation(*a, *b, *c, *p) == Greater)
                && !others.iter().any(|facet| facet.contains(p))
                && fan.iter().enumerate().all(|(i, &facet)| {
                    others.iter().chain(&fan[..i]).all(|&other| !cross(facet, other))
                })
        };
        let to = |direction: Point, step: f64| [0, 1, 2].map(|k| from[k] + step * direction[k]);
        let places = steps.iter().take(FAR).flat_map(|&step| around().map(move |d| to(d, step)));
        let found = places.filter(|&p| is_elsewhere(p, from)).find(fits);
        found.inspect(|&place| self.positions[v as usize] = place).is_some()
    }

    /// The facets that a vertex may meet when it moves, except those of its fan.
    fn near(&mut self, v: u32, steps: &[f64]) -> Vec<[Point; 3]> {
        let own = &self.fans[&v];
        let row =
            |facet: u32| self.surface.regular[facet as usize].map(|w| self.positions[w as usize]);
        let facets = self.facets.get_or_insert_with(|| {
            Boxes::new((0..self.surface.regular.len() as u32).map(|facet| {
                // The box is wide enough for the moves of its corners.
                let [low, high] = bounds(row(facet));
                wider([low, high], MOST * length([0, 1, 2].map(|k| high[k] - low[k])))
            }))
        });
        let place = bounds(own.iter().flat_map(|&facet| row(facet)));
        let near = facets.near(wider(place, steps.iter().copied().fold(0.0, f64::max)));
        near.into_iter().filter(|facet| own.binary_search(facet).is_err()).map(row).collect()
    }

    /// The steps to try from a vertex that has edges to these: halved from the first on, and doubled if that leads nowhere
    /// because an edge is hardly longer than the distance of doubles.
    fn steps(&self, v: u32, to: impl IntoIterator<Item = u32>) -> Vec<f64> {
        let from = self.at(v);
        let lengths = to.into_iter().map(|w| {
            let to = self.at(w);
            length([0, 1, 2].map(|k| from[k] - to[k]))
        });
        let lengths = lengths.filter(|&length| length > 0.0);
        let shortest = lengths.fold(f64::INFINITY, f64::min);
        let first = (LEAST * self.extent).clamp(STEP * shortest, MOST * shortest);
        let times =
            |factor: f64| std::iter::successors(Some(first), move |step| Some(factor * step));
        let most = ROUNDING * from.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let larger = times(2.0).skip(1).take_while(|&step| step > 0.0 && step <= most);
        times(0.5).take(TRIES).chain(larger).collect()
    }

    /// Moves a vertex to a place from which it sees the facets of its fan and of others counter-clockwise, and that is accepted.
    fn step(
        &mut self,
        v: u32,
        fan: &[[u32; 3]],
        others: &[[u32; 3]],
        steps: &[f64],
        accept: impl Fn(Point) -> bool,
    ) -> bool {
        let corners = |facet: &[u32; 3]| facet.map(|w| self.at(w));
        let fan: Vec<[Point; 3]> = fan.iter().map(corners).collect();
        let others: Vec<[Point; 3]> = others.iter().map(corners).collect();
        let normals: Option<Vec<Point>> = fan.iter().map(|&facet| normal(facet)).collect();
        let Some(direction) = normals.and_then(|normals| axis(&normals)) else { return false };
        let from = self.at(v);
        let sees = |[a, b, c]: &[Point; 3], p: Point| orientation(*a, *b, *c, p) == Greater;
        let places = steps.iter().map(|step| [0, 1, 2].map(|k| from[k] + step * direction[k]));
        let mut places = places.filter(|&p| is_elsewhere(p, from));
        let found =
            places.find(|&p| fan.iter().chain(&others).all(|facet| sees(facet, p)) && accept(p));
        match found {
            Some(place) => self.positions[v as usize] = place,
            None => return false,
        }
        true
    }
}

/// Whether the place of a step differs from its start.
fn is_elsewhere(place: Point, from: Point) -> bool {
    place != from && place.iter().all(|x| x.is_finite())
}

/// A box that is wider by the moves of corners in steps of this length, in any direction and rounded.
fn wider([low, high]: [Point; 2], step: f64) -> [Point; 2] {
    let margin = |x: f64| 2.0 * (step + ROUNDING * x.abs());
    [low.map(|x| x - margin(x)), high.map(|x| x + margin(x))]
}

/// Directions all around: those of a grid, not of unit length.
fn around() -> impl Iterator<Item = Point> {
    let side = 2 * GRID + 1;
    let all = (0..side * side * side).map(move |i| [i % side, i / side % side, i / side / side]);
    let centred = all.map(|at| at.map(|k| f64::from(k) / f64::from(GRID) - 1.0));
    centred.filter(|direction| *direction != [0.0; 3])
}
