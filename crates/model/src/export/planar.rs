//! Common parts of the formats of shapes in a plane.

use std::io;

use walpha_base::advice::Advice;

use walpha_shape::{AlphaShape, Outline, Polygon};

/// An outline and the positions of its points, for text formats of geographic data: x and y, and z unless it is 0 for all points.
pub(super) struct Planar<'a> {
    pub outline: &'a Outline,
    positions: &'a [[f64; 3]],
    columns: usize,
}

/// A warning that polygons in a vertical plane have no area for programs that use only x and y, as most do.
pub(super) fn remark(shape: &AlphaShape) -> Option<Advice> {
    let is_vertical = shape.outline().is_ok_and(|outline| outline.axes != [0, 1]);
    is_vertical.then(|| {
        "the plane is vertical: programs that look at x and y alone see polygons without area, so \
         exchange coordinates first"
            .into()
    })
}

impl<'a> Planar<'a> {
    /// The outline of a shape, and the positions of its points.
    ///
    /// # Errors
    /// The shape has no outline.
    pub(super) fn of(shape: &'a AlphaShape) -> io::Result<Self> {
        let outline = shape.outline().map_err(io::Error::other)?;
        let positions = shape.points().positions();
        let columns = if positions.iter().all(|place| place[2] == 0.0) { 2 } else { 3 };
        Ok(Self { outline, positions, columns })
    }

    /// Whether positions have a z.
    pub(super) fn has_z(&self) -> bool {
        self.columns == 3
    }

    /// The position of a point: two or three coordinates.
    pub(super) fn place(&self, v: u32) -> &'a [f64] {
        &self.positions[v as usize][..self.columns]
    }

    /// The positions of points, in their order.
    pub(super) fn places(&self, points: &[u32]) -> Vec<&'a [f64]> {
        points.iter().map(|&v| self.place(v)).collect()
    }

    /// The area of a polygon in its plane, in squared units of the points.
    pub(super) fn area(&self, polygon: &Polygon) -> f64 {
        let area = |ring: &Vec<u32>| {
            let Some((&first, rest)) = ring.split_first() else { return 0.0 };
            let origin = self.positions[first as usize];
            let arm = |v: u32| [0, 1, 2].map(|k| self.positions[v as usize][k] - origin[k]);
            // Twice the area, as a vector across the plane.
            let mut normal = [0.0_f64; 3];
            for pair in rest.windows(2) {
                let (a, b) = (arm(pair[0]), arm(pair[1]));
                for (k, sum) in normal.iter_mut().enumerate() {
                    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                    *sum += a[i] * b[j] - a[j] * b[i];
                }
            }
            normal.iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0
        };
        area(&polygon.outer) - polygon.holes.iter().map(area).sum::<f64>()
    }

    /// The length of all rings of a polygon, in units of the points.
    pub(super) fn perimeter(&self, polygon: &Polygon) -> f64 {
        let length = |[a, b]: [u32; 2]| {
            let [a, b] = [a, b].map(|v| self.positions[v as usize]);
            (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
        };
        let rings = [&polygon.outer].into_iter().chain(&polygon.holes);
        let sides =
            rings.flat_map(|ring| (0..ring.len()).map(|k| [ring[k], ring[(k + 1) % ring.len()]]));
        sides.map(length).sum()
    }

    /// The positions of a ring, with the first repeated at the end.
    pub(super) fn ring(&self, ring: &[u32]) -> Vec<&'a [f64]> {
        let mut places = self.places(ring);
        places.extend(ring.first().map(|&v| self.place(v)));
        places
    }
}
