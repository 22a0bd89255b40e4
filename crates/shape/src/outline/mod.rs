//! Shapes of points in one plane as regions of the plane: polygons with holes, and the edges and points outside of them.
//!
//! In space all triangles of such a shape are singular. In its plane they are its interior, and classes are those of [`Class`]
//! one dimension lower: an edge between two triangles is interior, one on a single triangle is regular, one on none is singular.
//! A vertex that is surrounded by triangles is interior, another one on an edge of the shape is regular, and an isolated one is
//! singular. The `Alpha_shape_2` of CGAL has the same classes except for the ends of singular edges that are on no triangle: it
//! calls all vertices on no triangle singular.

mod classes;
mod rings;
#[cfg(test)]
mod tests;
mod view;

use walpha_base::parallel::prelude::*;
use walpha_regular::MAX_COORDINATE;

use super::{AlphaShape, Class, Complex, OutlineError};
pub use rings::Polygon;
use rings::Triangles;
use view::{View, spanning_plane};

/// The shape of points in a plane, as a region of that plane: see [`AlphaShape::outline`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Outline {
    /// The two coordinates in which the plane is seen, 0 for x, 1 for y and 2 for z: the first of (x, y), (x, z) and (y, z) in
    /// which its points differ. Counter-clockwise is the way from the first axis to the second.
    pub axes: [usize; 2],
    /// The polygons: triangles that are joined through edges make one. Polygons touch each other only at vertices. They are in
    /// the order of their outer rings.
    pub polygons: Vec<Polygon>,
    /// The singular edges, those on no triangle, in the order of the complex.
    pub edges: Vec<[u32; 2]>,
    /// The singular vertices, those on no edge, in the order of the complex.
    pub points: Vec<u32>,
    /// The simplices of the shape's complex, in its order, with the classes that they have in the plane. Triangles of the
    /// shape turn counter-clockwise, and regular edges have the shape on their left.
    pub complex: Complex,
    /// The area of the polygons in the plane, not of their projection, in squared units of the points.
    pub area: f64,
    /// The length of all rings, in units of the points.
    pub perimeter: f64,
}

impl Outline {
    /// Checks that points have an outline at any α, before the work on their shape. There must be at least one point.
    /// Exact. O(n).
    ///
    /// # Errors
    /// [`OutlineError::Space`], [`OutlineError::Line`] and [`OutlineError::Coordinate`].
    pub fn check(positions: &[[f64; 3]]) -> Result<(), OutlineError> {
        let is_sane = |place: &[f64; 3]| place.iter().all(|x| x.abs() <= MAX_COORDINATE);
        if let Some(index) = positions.iter().position(|place| !is_sane(place)) {
            return Err(OutlineError::Coordinate { index });
        }
        spanning_plane(positions).map(|_| ())
    }

    /// The number of holes of all polygons.
    pub fn holes(&self) -> usize {
        self.polygons.iter().map(|polygon| polygon.holes.len()).sum()
    }

    /// The outline of a complex in a plane, whose triangles have this total area.
    fn of(complex: &Complex, positions: &[[f64; 3]], area: f64) -> Result<Self, OutlineError> {
        let view = View::of(positions)?;
        let seen = view.seen();
        let in_shape = complex.facets.rows().par_iter().zip(complex.facets.classes()).coarse();
        let in_shape = in_shape.filter(|&(_, &class)| class != Class::Exterior);
        let triangles = Triangles::new(in_shape.map(|(&row, _)| seen.turned(row)).collect());
        let complex = classes::in_plane(complex, &triangles);
        Ok(Self {
            axes: view.axes,
            polygons: triangles.polygons(&seen),
            edges: complex.edges.of(Class::Singular).copied().collect(),
            points: complex.vertices.of(Class::Singular).map(|&[v]| v).collect(),
            perimeter: classes::perimeter(&complex, positions),
            complex,
            area,
        })
    }
}

impl AlphaShape {
    /// The outline of a shape whose points lie in one plane, which is decided exactly: polygons with holes, and the edges and
    /// points outside of them. The plane may be tilted. O(n log n) at the first call, and computed once.
    ///
    /// Every ring is simple: it passes each vertex once. Rings of one polygon touch each other only at vertices, and its interior
    /// is connected, so polygons are valid in the sense of OGC Simple Features (ISO 19125-1). The result does not depend on the
    /// engine.
    ///
    /// ```
    /// use walpha_shape::{Alpha, ShapeOptions, WeightedPoints, alpha_shape};
    ///
    /// // The corners of a square and of a smaller one in it.
    /// let square = |half: f64| [[-half, -half, 0.0], [half, -half, 0.0], [half, half, 0.0], [-half, half, 0.0]];
    /// let points = WeightedPoints::unweighted([square(2.0), square(1.0)].concat());
    /// let shape = alpha_shape(points, &ShapeOptions::new(Alpha::from_squared(5.0)?))?;
    /// assert_eq!(shape.outline()?.polygons[0].outer, [0, 1, 2, 3]);
    /// assert_eq!((shape.outline()?.area, shape.outline()?.perimeter), (16.0, 16.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Points that span a volume or lie on one line; a shape of a torus, unwrapped or not.
    pub fn outline(&self) -> Result<&Outline, OutlineError> {
        let compute = || {
            if self.options.periodic.is_some() || !self.copies.is_empty() {
                return Err(OutlineError::Torus);
            }
            // In space each triangle of a flat shape is singular.
            Outline::of(&self.complex, &self.points.positions, self.measures().area)
        };
        self.outline.get(compute).as_ref().map_err(|&error| error)
    }
}
