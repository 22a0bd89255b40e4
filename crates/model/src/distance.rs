//! How far two surfaces are apart.

use rstar::{AABB, PointDistance, RTree, RTreeObject};
use serde::Serialize;
use walpha_base::memory::{NoMemory, try_with_capacity};
use walpha_base::parallel::prelude::*;
use walpha_base::vector::{V3, add, cross, dot, scale, sub};
use walpha_base::{Cancelled, Monitor, Sum};

use walpha_shape::{AlphaShape, ShapeError, Surface, facet_area};

/// The distance of two surfaces, in the unit of their coordinates. Of each surface the distances to the nearest place of the
/// other are taken (P. Cignoni, C. Rocchini and R. Scopigno, Metro, 1998, doi:10.1111/1467-8659.00236): `mean` is the mean
/// over the area, of both surfaces the mean, and `max` the greatest of all.
///
/// A triangle is sampled at three places, which have weights of 2/3, 1/6 and 1/6 in its corners and stand for a third of its area each, and for the greatest
/// distance also at its corners. So `max` is a lower bound of the Hausdorff distance, and below it by no more than the longest edge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SurfaceDistance {
    /// The mean distance.
    pub mean: f64,
    /// The greatest distance.
    pub max: f64,
}

impl SurfaceDistance {
    /// The distance of the surfaces of two shapes: their regular and singular facets. `None` if a shape has no facet. O(n log n) for n
    /// facets.
    ///
    /// # Errors
    /// Out of memory, and [`ShapeError::Cancelled`].
    pub fn between(a: &AlphaShape, b: &AlphaShape) -> Result<Option<Self>, ShapeError> {
        let monitor = &*Monitor::current();
        let (a, b) = (Triangle::all(a)?, Triangle::all(b)?);
        if a.is_empty() || b.is_empty() {
            return Ok(None);
        }
        let there = one_sided(&a, b.clone(), &monitor.part(0, 1, 2))?;
        let back = one_sided(&b, a, &monitor.part(1, 2, 2))?;
        Ok(Some(Self { mean: f64::midpoint(there.mean, back.mean), max: there.max.max(back.max) }))
    }
}

/// Triangles between two reports.
const CHUNK: usize = 1 << 14;

/// The distances from some triangles to others.
fn one_sided(
    from: &[Triangle],
    to: Vec<Triangle>,
    monitor: &Monitor,
) -> Result<SurfaceDistance, Cancelled> {
    let tree = RTree::bulk_load(to);
    let distance = |place: V3| {
        let nearest = tree.nearest_neighbor_iter_with_distance_2(&place).next();
        nearest.map_or(0.0, |(_, squared)| squared.sqrt())
    };
    let (mut area, mut integral, mut max) = (Sum::default(), Sum::default(), 0f64);
    for (chunk, triangles) in from.chunks(CHUNK).enumerate() {
        let sampled = triangles.par_iter().map(|triangle| {
            let inside = triangle.sampled().map(distance);
            let corners = triangle.0.map(distance);
            let max = inside.into_iter().chain(corners).fold(0.0, f64::max);
            (facet_area(triangle.0), inside.iter().sum::<f64>() / 3.0, max)
        });
        for (of_one, mean, greatest) in sampled.collect::<Vec<_>>() {
            area.add(of_one);
            integral.add(of_one * mean);
            max = max.max(greatest);
        }
        monitor.report(
            (chunk + 1).min(from.len().div_ceil(CHUNK)) as u64,
            from.len().div_ceil(CHUNK) as u64,
        )?;
    }
    let area = area.value();
    // Triangles without an area have no mean.
    let mean = if area > 0.0 { integral.value() / area } else { max };
    Ok(SurfaceDistance { mean, max })
}

/// The corners of a triangle.
#[derive(Clone, Copy)]
struct Triangle([V3; 3]);

impl Triangle {
    /// The facets of the surface of a shape.
    fn all(shape: &AlphaShape) -> Result<Vec<Self>, NoMemory> {
        let surface = Surface::of(shape);
        let positions: Vec<V3> = surface.positions(shape.points().positions()).collect();
        let count = surface.regular.len() + surface.singular.len();
        let mut triangles = try_with_capacity(count, || "the distance of two surfaces".into())?;
        triangles.extend(surface.facets().map(|row| Self(row.map(|v| positions[v as usize]))));
        Ok(triangles)
    }

    /// The places at which it is sampled.
    fn sampled(&self) -> [V3; 3] {
        let sixth = |place: V3| scale(place, 1.0 / 6.0);
        let all = self.0.map(sixth).into_iter().fold([0.0; 3], add);
        self.0.map(|corner| add(all, scale(corner, 0.5)))
    }
}

impl RTreeObject for Triangle {
    type Envelope = AABB<V3>;

    fn envelope(&self) -> AABB<V3> {
        AABB::from_points(&self.0)
    }
}

impl PointDistance for Triangle {
    /// The squared distance to the plane, if the place projects into the triangle, and otherwise that to the nearest edge.
    fn distance_2(&self, place: &V3) -> f64 {
        let [a, b, c] = self.0;
        let normal = cross(sub(b, a), sub(c, a));
        let is_left =
            |from: V3, to: V3| dot(cross(sub(to, from), sub(*place, from)), normal) >= 0.0;
        let squared = dot(normal, normal);
        if squared > 0.0 && is_left(a, b) && is_left(b, c) && is_left(c, a) {
            let height = dot(sub(*place, a), normal);
            return height * height / squared;
        }
        let to_edge = |from: V3, to: V3| {
            let (along, away) = (sub(to, from), sub(*place, from));
            let of_all = dot(along, along);
            let share =
                if of_all > 0.0 { (dot(away, along) / of_all).clamp(0.0, 1.0) } else { 0.0 };
            let left = sub(away, scale(along, share));
            dot(left, left)
        };
        to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;
    use walpha_base::vector::length;
    use walpha_shape::{Alpha, ShapeOptions, alpha_shape};

    use super::*;

    /// The cube from `low` to `high` along each axis.
    fn cube(low: f64, high: f64) -> AlphaShape {
        let corner = |i: u32| [0, 1, 2].map(|k| if i >> k & 1 == 1 { high } else { low });
        let corners: Vec<V3> = (0..8).map(corner).collect();
        alpha_shape(corners, &ShapeOptions::new(Alpha::INFINITE)).unwrap()
    }

    #[test]
    fn of_cubes() {
        let (inner, outer) = (cube(0.0, 1.0), cube(-1.0, 2.0));
        let found = SurfaceDistance::between(&inner, &outer).unwrap().unwrap();
        assert_eq!(found.max, 3f64.sqrt());
        // From within all places are at 1. From outside, the middle of a side is, and more than a half of it is further away.
        let there = one_sided(
            &Triangle::all(&inner).unwrap(),
            Triangle::all(&outer).unwrap(),
            &Monitor::default(),
        )
        .unwrap();
        assert_eq!((there.mean, there.max), (1.0, 1.0));
        assert!(found.mean > 1.05 && found.mean < 1.3, "{found:?}");
        assert_eq!(SurfaceDistance::between(&outer, &inner).unwrap(), Some(found));
        let same = SurfaceDistance::between(&outer, &outer).unwrap().unwrap();
        assert!(same.mean < 1e-15 && same.max < 1e-15, "{same:?}");
    }

    #[test]
    fn a_shape_without_facets_has_no_distance() {
        let line = alpha_shape(
            vec![[0.0; 3], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]],
            &ShapeOptions::new(Alpha::INFINITE),
        )
        .unwrap();
        assert_eq!(SurfaceDistance::between(&line, &cube(0.0, 1.0)).unwrap(), None);
        assert_eq!(SurfaceDistance::between(&cube(0.0, 1.0), &line).unwrap(), None);
    }

    /// The distance from a triangle is that to the nearest of many places in it, up to the distance of these.
    #[test]
    fn of_places_and_triangles() {
        const STEPS: u32 = 60;
        let mut random = Random::new(4);
        for case in 0..200 {
            let mut place = || [0; 3].map(|_| 2.0 * random.unit() - 1.0);
            let (from, mut corners) = (place(), [place(), place(), place()]);
            if case % 10 == 0 {
                // No area.
                corners[2] = scale(add(corners[0], corners[1]), 0.5);
            }
            let triangle = Triangle(corners);
            let mut least = f64::INFINITY;
            for i in 0..=STEPS {
                for j in 0..=STEPS - i {
                    let shares = [i, j, STEPS - i - j].map(|n| f64::from(n) / f64::from(STEPS));
                    let scaled = [0, 1, 2].map(|k| scale(corners[k], shares[k]));
                    let at = scaled.into_iter().fold([0.0; 3], add);
                    least = least.min(length(sub(from, at)));
                }
            }
            let found = triangle.distance_2(&from).sqrt();
            let longest = length(sub(corners[0], corners[1]))
                .max(length(sub(corners[1], corners[2])))
                .max(length(sub(corners[2], corners[0])));
            assert!(found <= least + 1e-12, "{case}: {found} {least}");
            assert!(least <= found + longest / f64::from(STEPS), "{case}: {found} {least}");
        }
    }
}
