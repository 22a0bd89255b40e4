//! Points that are spread over the unit sphere.

use std::collections::HashMap;

use walpha_base::sort::sort_handful_by;
use walpha_base::vector::{V3, add, along, scale, sub, unit};

use super::patch::Patch;

/// The vertices of an icosahedron whose faces are divided into triangles, on the unit sphere.
pub(super) struct Sphere {
    pub points: Vec<V3>,
    pub triangles: Vec<[u32; 3]>,
    /// The largest distance of a triangle from the sphere that is allowed.
    pub tolerance: f64,
    /// About the distance of two neighbours.
    pub spacing: f64,
}

impl Sphere {
    /// So many points that the triangles are within the tolerance.
    pub(super) fn new(tolerance: f64) -> Self {
        // A triangle of angular radius a is off the sphere by 1 − cos a. The largest is in the middle of a face: its centre is 1 from that of the sphere, and
        // its edges are an icosahedron's, seen from nearer.
        let reach = (tolerance * (2.0 - tolerance)).sqrt();
        let mut parts = 1;
        loop {
            let sphere = Self::divided(parts, tolerance);
            // A sphere that is coarse by chance is refined; one whose size is known to be wrong is not made.
            let worst = sphere.worst();
            if worst <= tolerance {
                return Self { spacing: 3f64.sqrt() * reach, ..sphere };
            }
            let factor = (worst / tolerance).sqrt();
            parts = ((f64::from(parts) * factor).floor() as u32).max(parts + 1);
        }
    }

    fn divided(parts: u32, tolerance: f64) -> Self {
        let golden = f64::midpoint(1.0, 5f64.sqrt());
        let mut corners = Vec::new();
        for (a, b) in [(1.0, golden), (1.0, -golden), (-1.0, golden), (-1.0, -golden)] {
            corners.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]]);
        }
        let mut sphere =
            Self { points: Vec::new(), triangles: Vec::new(), tolerance, spacing: 0.0 };
        let mut numbers: HashMap<[(u32, u32); 3], u32> = HashMap::new();
        for face in faces(&corners) {
            // The point between the corners, by its coordinates there: those that are 0 do not matter.
            let mut point = |of: [u32; 3]| {
                let mut key =
                    [0, 1, 2].map(|k| if of[k] == 0 { (0, 0) } else { (face[k] + 1, of[k]) });
                sort_handful_by(&mut key, Ord::cmp);
                *numbers.entry(key).or_insert_with(|| {
                    let place = key.iter().filter(|(corner, _)| *corner > 0);
                    let place = place.fold([0.0; 3], |sum, &(corner, part)| {
                        along(sum, f64::from(part), corners[corner as usize - 1])
                    });
                    sphere.points.push(unit(place).unwrap_or(place));
                    sphere.points.len() as u32 - 1
                })
            };
            for i in 0..parts {
                for j in 0..parts - i {
                    let k = parts - i - j;
                    let three = [[i, j, k], [i + 1, j, k - 1], [i, j + 1, k - 1]].map(&mut point);
                    sphere.triangles.push(three);
                    if k > 1 {
                        let three = [[i + 1, j, k - 1], [i + 1, j + 1, k - 2], [i, j + 1, k - 1]];
                        sphere.triangles.push(three.map(&mut point));
                    }
                }
            }
        }
        sphere
    }

    /// The largest distance of a triangle from the sphere.
    fn worst(&self) -> f64 {
        let off = |triangle: &[u32; 3]| {
            let corners = triangle.map(|v| self.points[v as usize]);
            super::patch::farthest(corners).map_or(1.0, |(_, off)| off)
        };
        self.triangles.iter().map(off).fold(0.0, f64::max)
    }

    /// The whole sphere of a ball.
    pub(super) fn whole(&self, centre: V3, radius: f64) -> Patch {
        let inner = self.points.iter().map(|&point| along(centre, radius, point)).collect();
        Patch { rim: Vec::new(), inner, triangles: self.triangles.clone() }
    }
}

/// The faces of an icosahedron, counter-clockwise seen from outside.
fn faces(corners: &[V3]) -> Vec<[u32; 3]> {
    let is_edge = |a: usize, b: usize| {
        let way = sub(corners[a], corners[b]);
        (walpha_base::vector::dot(way, way) - 4.0).abs() < 0.1
    };
    let mut faces = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if is_edge(a, b) && is_edge(b, c) && is_edge(a, c) {
                    let [p, q, r] = [a, b, c].map(|v| corners[v]);
                    let normal = walpha_base::vector::cross(sub(q, p), sub(r, p));
                    let middle = scale(add(add(p, q), r), 1.0 / 3.0);
                    let outwards = walpha_base::vector::dot(normal, middle) > 0.0;
                    let (b, c) = if outwards { (b, c) } else { (c, b) };
                    faces.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    faces
}
