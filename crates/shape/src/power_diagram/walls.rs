//! Power cells between walls, across the directions in which a box does not repeat.
//!
//! A plane wall cuts cells as the mirror images of all points behind it would: a place on the near side of the wall is nearer to a point than
//! to its image, so images take nothing away there, and on the far side all of it. Two parallel walls, each the mirror of the other, repeat the
//! points at twice their distance. So the cells are those of a torus that holds the points and their images, and each is there once for
//! each combination of mirrors. A point on a wall is its own image, and has all of these cells in one.

use std::collections::BTreeMap;

use walpha_base::vector::{dot, sub};
use walpha_regular::Torus;
use walpha_regular::internals::{check_numbers, is_listed};

use super::PeriodicPowerDiagram;
use crate::{ShapeError, WallsError};

/// The walls across some axes.
struct Walls {
    axes: Vec<usize>,
    low: [f64; 3],
    high: [f64; 3],
}

impl Walls {
    fn of(torus: &Torus, [low, high]: [[f64; 3]; 2]) -> Result<Self, WallsError> {
        let is_across = |axis: &usize| torus.vectors().iter().all(|vector| vector[*axis] == 0.0);
        let axes: Vec<usize> = (0..3).filter(is_across).collect();
        if torus.dimension() == 3 {
            return Err(WallsError::Everywhere);
        }
        if axes.len() + torus.dimension() != 3 {
            return Err(WallsError::Slanted);
        }
        for &axis in &axes {
            let [low, high] = [low[axis], high[axis]];
            if !(low < high && (high - low).is_finite()) {
                return Err(WallsError::Order { axis, low, high });
            }
        }
        Ok(Self { axes, low, high })
    }

    /// The number of combinations of mirrors: bit k is the mirror across axis k of those that have walls.
    fn combinations(&self) -> usize {
        1 << self.axes.len()
    }

    fn check(&self, positions: &[[f64; 3]]) -> Result<(), WallsError> {
        for (index, place) in positions.iter().enumerate() {
            let beyond =
                |axis: &&usize| !(self.low[**axis]..=self.high[**axis]).contains(&place[**axis]);
            if let Some(&axis) = self.axes.iter().find(beyond) {
                let (low, high) = (self.low[axis], self.high[axis]);
                return Err(WallsError::Beyond { index, axis, at: place[axis], low, high });
            }
        }
        Ok(())
    }

    /// The image of a place under mirrors at the lower walls.
    fn image(&self, mut place: [f64; 3], mirrors: usize) -> [f64; 3] {
        for (_, axis) in self.of_mirrors(mirrors) {
            place[axis] = 2.0 * self.low[axis] - place[axis];
        }
        place
    }

    /// The axes of these mirrors, with their bits.
    fn of_mirrors(&self, mirrors: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let bits = self.axes.iter().enumerate().map(|(k, &axis)| (1 << k, axis));
        bits.filter(move |(bit, _)| mirrors & bit != 0)
    }

    /// The mirrors across the walls on which a place lies.
    fn touched(&self, place: [f64; 3]) -> usize {
        let is_on = |axis: usize| place[axis] == self.low[axis] || place[axis] == self.high[axis];
        self.of_mirrors(usize::MAX).filter(|&(_, axis)| is_on(axis)).map(|(bit, _)| bit).sum()
    }

    /// The torus of points and images.
    fn doubled(&self, torus: &Torus) -> Result<Torus, ShapeError> {
        let mut vectors = torus.vectors();
        let free = (0..3).filter(|&k| !torus.repeats()[k]);
        for (k, &axis) in free.zip(&self.axes) {
            vectors[k][axis] = 2.0 * (self.high[axis] - self.low[axis]);
        }
        Ok(Torus::of_vectors(vectors)?)
    }
}

/// A facet between two points, the second of which is moved.
type Between = ([u32; 2], [i32; 3]);

/// Facets of the cells of points and images, gathered for the points.
struct Gathered<'a> {
    walls: &'a Walls,
    torus: &'a Torus,
    wrapped: &'a [[f64; 3]],
    inner: BTreeMap<Between, f64>,
    /// The areas on the lower and the upper wall across each axis.
    on_walls: Vec<[[f64; 3]; 2]>,
    /// For each point, the sum of the areas of its inner facets, each times the components of its outer normal.
    outward: Vec<[f64; 3]>,
}

impl Gathered<'_> {
    /// Adds a facet between images of two points, by the mirrors that made each, and the way from one to the other.
    fn add(&mut self, [p, q]: [u32; 2], mirrors: [usize; 2], mut way: [f64; 3], area: f64) {
        let walls = self.walls;
        // Seen from the first point itself.
        walls.of_mirrors(mirrors[0]).for_each(|(_, axis)| way[axis] = -way[axis]);
        let [from, to] = [p, q].map(|v| self.wrapped[v as usize]);
        let on_walls = walls.touched(from) | walls.touched(to);
        let across = (mirrors[0] ^ mirrors[1]) & !on_walls;
        let shift = self.torus.parts(sub(from, sub(to, way))).map(|part| part.round() as i32);
        let combinations = walls.combinations() as f64;
        if p == q && shift == [0; 3] {
            // Each is found once for each combination of the other mirrors.
            let own = walls
                .of_mirrors(usize::MAX)
                .max_by(|(_, a), (_, b)| way[*a].abs().total_cmp(&way[*b].abs()));
            let Some((bit, axis)) = own else { return };
            if across & !bit == 0 {
                // From a point on a wall it is the other wall, whichever image is found.
                let is_low = match from[axis] {
                    at if at == walls.low[axis] => false,
                    at if at == walls.high[axis] => true,
                    _ => way[axis] < 0.0,
                };
                self.on_walls[p as usize][usize::from(!is_low)][axis] += 2.0 * area / combinations;
            }
        } else if across == 0 {
            let is_ascending = is_listed(p, q, shift);
            let facet = if is_ascending { ([p, q], shift) } else { ([q, p], shift.map(|by| -by)) };
            let area = area / combinations;
            *self.inner.entry(facet).or_insert(0.0) += area;
            let length = dot(way, way).sqrt();
            for &axis in &walls.axes {
                let share = area * (to[axis] - from[axis]) / length;
                self.outward[p as usize][axis] += share;
                self.outward[q as usize][axis] -= share;
            }
        }
        // Otherwise the rounding of an image has made this facet, and its area is 0 but for rounding.
    }

    /// The areas on the walls on which points lie: what the other facets leave open.
    fn close(&mut self) {
        for (v, place) in self.wrapped.iter().enumerate() {
            for &axis in &self.walls.axes {
                let outward = self.outward[v][axis];
                let [low, high] = &mut self.on_walls[v];
                if place[axis] == self.walls.low[axis] {
                    low[axis] = (high[axis] + outward).max(0.0);
                } else if place[axis] == self.walls.high[axis] {
                    high[axis] = (low[axis] - outward).max(0.0);
                }
            }
        }
    }
}

impl PeriodicPowerDiagram {
    /// The power diagram of points between walls, in a box that repeats along one or two vectors: cells end at the planes through the lowest and the
    /// highest corner of `walls` that are perpendicular to the axes along which no vector has a component. Their other coordinates mean nothing. No cell
    /// is unbounded, and [`walls`](Self::walls) has the areas where cells end.
    ///
    /// Which facets there are is decided exactly if mirror images of the points at the walls are exact; otherwise for the rounded images.
    ///
    /// O(n log n), expected, for evenly distributed points: of twice as many points for one pair of walls, and of four times as many for two.
    ///
    /// # Errors
    /// The errors of [`Self::of`], and [`WallsError`].
    pub fn between(
        torus: Torus,
        walls: [[f64; 3]; 2],
        positions: &[[f64; 3]],
        weights: Option<&[f64]>,
    ) -> Result<Self, ShapeError> {
        let zeros = if weights.is_none() { vec![0.0; positions.len()] } else { Vec::new() };
        let weights = weights.unwrap_or(&zeros);
        check_numbers(positions, weights)?;
        let walls = Walls::of(&torus, walls)?;
        walls.check(positions)?;
        let torus = torus.holding(positions)?;
        let wrapped: Vec<_> = positions.iter().map(|&place| torus.wrap(place)).collect();
        let combinations = walls.combinations();
        let images: Vec<_> = (0..combinations)
            .flat_map(|mirrors| wrapped.iter().map(move |&place| (place, mirrors)))
            .map(|(place, mirrors)| walls.image(place, mirrors))
            .collect();
        let all = Self::of(walls.doubled(&torus)?, &images, Some(&weights.repeat(combinations)))?;

        let count = positions.len();
        let mut gathered = Gathered {
            walls: &walls,
            torus: &torus,
            wrapped: &wrapped,
            inner: BTreeMap::new(),
            on_walls: vec![[[0.0; 3]; 2]; count],
            outward: vec![[0.0; 3]; count],
        };
        let placed: Vec<_> = images.iter().map(|&place| all.torus.wrap(place)).collect();
        for ((&ends, &shift), &area) in all.facets.iter().zip(&all.shifts).zip(&all.areas) {
            let [from, to] = ends.map(|v| placed[v as usize]);
            let [p, q] = ends.map(|v| v as usize % count);
            let mirrors = ends.map(|v| v as usize / count);
            gathered.add(
                [p as u32, q as u32],
                mirrors,
                sub(all.torus.moved(to, shift), from),
                area,
            );
        }
        gathered.close();
        let mut volumes = vec![0.0; count];
        for (image, volume) in all.volumes.iter().enumerate() {
            volumes[image % count] += volume / combinations as f64;
        }
        let Gathered { inner, on_walls, .. } = gathered;
        let (facets, areas): (Vec<Between>, _) = inner.into_iter().unzip();
        let (facets, shifts) = facets.into_iter().unzip();
        Ok(Self { torus, volumes, facets, shifts, areas, walls: Some(on_walls) })
    }
}

#[cfg(test)]
mod tests {
    use walpha_regular::{PowerDiagram, triangulate};

    use super::*;
    use crate::ladder::random_points;

    const WALLS: [[f64; 3]; 2] = [[-0.5, -0.25, 0.0], [1.5, 2.25, 2.0]];

    fn is_near(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-9 * (1.0 + b.abs())
    }

    /// The cells of the points among copies of them and one image of each behind each wall, in space.
    fn in_space(
        torus: Torus,
        axes: &[usize],
        positions: &[[f64; 3]],
        weights: &[f64],
    ) -> (Vec<f64>, BTreeMap<[u32; 2], f64>) {
        let along = |k: usize| if torus.repeats()[k] { -3..=3 } else { 0..=0 };
        let mut all = positions.to_vec();
        for i in along(0) {
            for j in along(1) {
                for k in along(2) {
                    let copies: Vec<_> =
                        positions.iter().map(|&p| torus.moved(p, [i, j, k])).collect();
                    if [i, j, k] != [0; 3] {
                        all.extend(&copies);
                    }
                    for &axis in axes {
                        for wall in WALLS {
                            all.extend(copies.iter().map(|&place| {
                                let mut place = place;
                                place[axis] = 2.0 * wall[axis] - place[axis];
                                place
                            }));
                        }
                    }
                }
            }
        }
        let weights = weights.repeat(all.len() / positions.len());
        let diagram =
            PowerDiagram::of(&triangulate(&all, Some(&weights)).unwrap(), Some(&weights)).unwrap();
        let mut facets = BTreeMap::new();
        let own = |v: u32| (v as usize) < positions.len();
        for (&[p, q], &area) in diagram.facets().iter().zip(diagram.areas()) {
            if own(p) && own(q) {
                facets.insert([p, q], area);
            }
        }
        (diagram.volumes()[..positions.len()].to_vec(), facets)
    }

    #[test]
    fn cells_end_at_walls_as_at_mirrors() {
        let mut compared = 0;
        for (repeats, axes) in [
            ([true, true, false], &[2][..]),
            ([true, false, false], &[1, 2]),
            ([false, true, false], &[0, 2]),
        ] {
            for (seed, count) in [(1, 1), (2, 4), (3, 60)] {
                // The vectors of a slab are slanted within it.
                let vectors =
                    [[1.5, if repeats[1] { 0.25 } else { 0.0 }, 0.0], [0.0, 1.25, 0.0], [0.0; 3]];
                let torus = Torus::repeating(vectors, repeats).unwrap();
                let random = random_points(seed, count, 0.2);
                // In eighths of a unit, for ties; none lies on a wall.
                let placed = |p: &[f64; 3]| {
                    [0, 1, 2].map(|k| {
                        let step = (8.0 * (p[k] - p[k].floor())).floor().clamp(1.0, 7.0) / 8.0;
                        WALLS[0][k] + step * (WALLS[1][k] - WALLS[0][k])
                    })
                };
                let positions: Vec<_> = random.positions().iter().map(placed).collect();
                let made =
                    PeriodicPowerDiagram::between(torus, WALLS, &positions, Some(random.weights()))
                        .unwrap();
                let wrapped: Vec<_> = positions.iter().map(|&p| made.torus().wrap(p)).collect();
                let (volumes, facets) = in_space(made.torus(), axes, &wrapped, random.weights());
                for (&volume, &expected) in made.volumes().iter().zip(&volumes) {
                    assert!(is_near(volume, expected), "{repeats:?} {count}: {volume} {expected}");
                }
                let unshifted = made
                    .facets()
                    .iter()
                    .zip(made.shifts())
                    .zip(made.areas())
                    .filter(|((_, shift), _)| **shift == [0; 3]);
                let unshifted: BTreeMap<[u32; 2], f64> =
                    unshifted.map(|((&facet, _), &area)| (facet, area)).collect();
                assert!(unshifted.keys().eq(facets.keys()), "{repeats:?} {count}");
                assert!(unshifted.iter().all(|(facet, &area)| is_near(area, facets[facet])));
                compared += unshifted.len();
                // What a cell has on each wall is what the cells among mirrors leave open.
                let walls = made.walls().unwrap();
                for &axis in axes {
                    let [below, above] =
                        [0, 1].map(|side| walls.iter().map(|wall| wall[side][axis]).sum::<f64>());
                    assert!(below > 0.0 && is_near(below, above), "{below} {above}");
                }
            }
        }
        assert!(compared > 300, "{compared}");
    }

    /// A grid whose outer points lie on the walls: the cells of points on one wall are halves, and those of points on two are quarters.
    #[test]
    fn points_on_walls_have_the_part_inside() {
        let walls = [[0.0; 3], [2.0; 3]];
        let all = |n: [usize; 3]| {
            let places = (0..n[0])
                .flat_map(move |i| (0..n[1]).flat_map(move |j| (0..n[2]).map(move |k| [i, j, k])));
            places.map(|place| place.map(|x| x as f64)).collect::<Vec<_>>()
        };
        let slab = all([3, 3, 3]);
        let torus =
            Torus::repeating([[3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0; 3]], [true, true, false])
                .unwrap();
        let made = PeriodicPowerDiagram::between(torus, walls, &slab, None).unwrap();
        for ((place, &volume), wall) in slab.iter().zip(made.volumes()).zip(made.walls().unwrap()) {
            let is_on = place[2] != 1.0;
            assert!(is_near(volume, if is_on { 0.5 } else { 1.0 }), "{place:?} {volume}");
            let [low, high] = wall.map(|wall| wall[2]);
            assert!(
                is_near(low, f64::from(u8::from(place[2] == 0.0)))
                    && is_near(high, f64::from(u8::from(place[2] == 2.0))),
                "{place:?} {wall:?}"
            );
        }
        // Beside 18 facets across the walls' axis, 27 along x and 27 along y, of half the area in the layers on the walls.
        let areas = |area: f64| made.areas().iter().filter(|found| is_near(**found, area)).count();
        assert_eq!((made.facets().len(), areas(1.0), areas(0.5)), (72, 36, 36));

        let rod = all([2, 3, 3]);
        let torus =
            Torus::repeating([[2.0, 0.0, 0.0], [0.0; 3], [0.0; 3]], [true, false, false]).unwrap();
        let made = PeriodicPowerDiagram::between(torus, walls, &rod, None).unwrap();
        let parts = |place: &[f64; 3]| [1, 2].map(|k| if place[k] == 1.0 { 1.0 } else { 0.5 });
        for (place, &volume) in rod.iter().zip(made.volumes()) {
            assert!(is_near(volume, parts(place).iter().product()), "{place:?} {volume}");
        }
        // One layer on a wall: cells reach the other wall.
        let layer = [[0.5, 0.5, 0.0], [1.5, 0.5, 0.0]];
        let torus =
            Torus::repeating([[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]], [true, true, false])
                .unwrap();
        let made = PeriodicPowerDiagram::between(torus, walls, &layer, None).unwrap();
        assert!(made.volumes().iter().all(|&volume| is_near(volume, 2.0)), "{:?}", made.volumes());
        assert!(
            made.walls()
                .unwrap()
                .iter()
                .all(|wall| is_near(wall[0][2], 1.0) && is_near(wall[1][2], 1.0)),
            "{:?}",
            made.walls()
        );
    }

    #[test]
    fn walls_that_cannot_be_are_refused() {
        let slab =
            Torus::repeating([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]], [true, true, false])
                .unwrap();
        let slanted =
            Torus::repeating([[1.0, 0.0, 0.0], [0.0, 1.0, 0.5], [0.0; 3]], [true, true, false])
                .unwrap();
        let made = |torus, low: f64, high: f64, z: f64| {
            let walls = [[f64::NAN, 0.0, low], [0.0, 0.0, high]];
            PeriodicPowerDiagram::between(torus, walls, &[[0.25, 0.25, z]], None)
        };
        assert!(is_near(made(slab, -1.0, 2.0, 0.5).unwrap().volumes()[0], 3.0));
        let refused = [
            (made(slab, 1.0, 1.0, 1.0), WallsError::Order { axis: 2, low: 1.0, high: 1.0 }),
            (
                made(slab, 0.0, f64::INFINITY, 1.0),
                WallsError::Order { axis: 2, low: 0.0, high: f64::INFINITY },
            ),
            (
                made(slab, 0.0, 1.0, 2.0),
                WallsError::Beyond { index: 0, axis: 2, at: 2.0, low: 0.0, high: 1.0 },
            ),
            (made(slanted, 0.0, 1.0, 0.5), WallsError::Slanted),
            (made(Torus::new([1.0; 3]).unwrap(), 0.0, 1.0, 0.5), WallsError::Everywhere),
        ];
        for (found, expected) in refused {
            assert_eq!(found.unwrap_err(), expected.into());
        }
    }
}
