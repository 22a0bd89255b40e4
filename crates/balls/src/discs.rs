//! Discs in the plane: area and perimeter of their union.

use std::borrow::Cow;

use walpha_regular::internals::spanning;
use walpha_shape::{AlphaShape, Complex, FacetSides};

use crate::points::Points;
use crate::real::{Bounded, Double, Real, Single};
use crate::simplex::{Ball, Circle, Edge, Limits, Triangle};
use crate::union::{Contacts, complex_of_balls, in_shape, zeros};
use crate::{BallsError, Measured};

/// The union of the discs of points that lie in one plane, on one line or at one place: in that plane, a point with weight ω is a disc of
/// squared radius α + ω.
///
/// The same identities as in space, a dimension lower; [`BallUnion`](crate::BallUnion) says more. Of such points that has the balls.
///
/// ```
/// use walpha_balls::DiscUnion;
/// use walpha_shape::{Alpha, ShapeOptions, alpha_shape};
///
/// // The corners of a square, at the centres of discs that touch.
/// let square = [[0.0; 3], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
/// let shape = alpha_shape(&square, &ShapeOptions::new(Alpha::from_squared(1.0)?))?;
/// let discs = DiscUnion::new(&shape)?;
/// assert!(discs.area().contains(4.0 * std::f64::consts::PI));
/// assert_eq!(discs.euler_characteristic(), 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct DiscUnion<'a> {
    complex: Cow<'a, Complex>,
    areas: Measured,
    perimeters: Measured,
    contacts: Measured,
    area: Bounded,
    perimeter: Bounded,
}

impl<'a> DiscUnion<'a> {
    /// Measures the union of the discs of a shape without cells. O(n).
    ///
    /// # Errors
    /// The points span a volume, or lie in a periodic box; α is infinite, or the shape is [of labels](AlphaShape::voxels); out of memory.
    pub fn new(shape: &'a AlphaShape) -> Result<Self, BallsError> {
        if shape.options().periodic.is_some() {
            return Err(BallsError::Periodic);
        }
        // The complex of points that span a volume may have no cells, too.
        if spanning(shape.points().positions()).len() > 3 {
            return Err(BallsError::Solid);
        }
        let complex = complex_of_balls(shape)?;
        let points = Points::of(shape);
        let sides = FacetSides::apexes(&complex, &points.positions);
        let mut contacts: Vec<AtEdge> = zeros(complex.edges.len(), "the contacts of discs")?;
        let mut vertices: Vec<AtVertex> = zeros(points.len(), "the parts of discs")?;
        let (mut twice, mut perimeter) = (Double::default(), Double::default());
        let facets = (0..points.len() as u32).flat_map(|v| sides.facets_and_edges(&complex, v));
        for (facet, edges) in facets {
            let corners = sides.facets()[facet];
            let of = Filled::measured(points.balls(corners), points.alpha);
            twice += of.twice;
            for (k, row) in edges.into_iter().enumerate() {
                vertices[corners[k] as usize].angles += of.angles[k];
                contacts[row as usize].length += of.heights[k];
                contacts[row as usize].triangles += 1;
            }
        }
        for (&ends, at) in complex.edges.rows().iter().zip(&mut contacts) {
            let balls = points.balls(ends);
            let Edge { distance, heights } = Edge::measured(balls, points.alpha);
            if at.triangles < 2 {
                // The triangles to the points that both circles share.
                let height = Circle::measured(balls, points.alpha).radius;
                for _ in at.triangles..2 {
                    at.length += height;
                    twice += distance * height;
                    for k in 0..2 {
                        let vertex = &mut vertices[ends[k] as usize];
                        vertex.angles += Single::angle(height, heights[k]);
                        vertex.is_open = true;
                    }
                }
            }
            for k in 0..2 {
                let vertex = &mut vertices[ends[k] as usize];
                vertex.cones += at.length * heights[k];
                vertex.edges += 1;
            }
        }
        let in_shape = in_shape(&complex, points.len(), "the parts of discs")?;
        let part = |v: usize| {
            let at = &vertices[v];
            // A vertex whose edges all have triangles on both sides has no arc.
            if !in_shape[v] || (at.edges > 0 && !at.is_open) {
                return (Single::ZERO, at.cones.half());
            }
            let radius = points.squared_radius::<Single>(v as u32).sqrt();
            let arc = radius * (Single::pi().times(2.0) - at.angles);
            (arc, (radius * arc + at.cones).half())
        };
        let mut parts: Vec<(Single, Single)> = zeros(points.len(), "the parts of discs")?;
        for (v, at) in parts.iter_mut().enumerate() {
            *at = part(v);
            perimeter += at.0;
            twice += points.squared_radius::<Single>(v as u32).sqrt() * at.0;
        }
        let column = |what, power, of: fn(&(Single, Single)) -> Single| {
            Measured::collect(points.len(), what, |v| points.bounded(of(&parts[v]), power))
        };
        let area = points.bounded(twice.rounded().half(), 2);
        let perimeter = points.bounded(perimeter.rounded(), 1);
        let perimeters = column("the perimeters of discs", 1, |part| part.0)?;
        let areas = column("the areas of discs", 2, |part| part.1)?;
        let contacts = Measured::collect(contacts.len(), "the contacts of discs", |row| {
            points.bounded(contacts[row].length, 1)
        })?;
        Ok(Self { complex, areas, perimeters, contacts, area, perimeter })
    }

    /// The area of the union, in squared units of the points.
    pub fn area(&self) -> Bounded {
        self.area
    }

    /// The length of its boundary, in units of the points; that of holes included.
    pub fn perimeter(&self) -> Bounded {
        self.perimeter
    }

    /// The Euler characteristic of the union. Exact.
    pub fn euler_characteristic(&self) -> i64 {
        self.complex.euler_characteristic()
    }

    /// For each input point the area of the union in its power cell.
    pub fn areas(&self) -> &Measured {
        &self.areas
    }

    /// For each input point the length of the boundary on its circle.
    pub fn perimeters(&self) -> &Measured {
        &self.perimeters
    }

    /// The contacts of discs, one for each edge of the dual complex, with their lengths.
    pub fn contacts(&self) -> Contacts<'_> {
        Contacts { pairs: self.complex.edges.rows(), sizes: &self.contacts }
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct AtEdge {
    /// Of the contact.
    length: Single,
    triangles: u8,
}

#[derive(Clone, Copy, Debug, Default)]
struct AtVertex {
    angles: Single,
    /// Over the edges, the length of the contact times the distance of its line.
    cones: Single,
    edges: u32,
    is_open: bool,
}

/// A triangle of the dual complex, in its plane.
#[derive(Clone, Copy, Debug)]
struct Filled<N> {
    /// Twice its area.
    twice: N,
    /// The angle at each corner.
    angles: [N; 3],
    /// The distance of its centre from the edge opposite each corner.
    heights: [N; 3],
}

impl<N: Real> Filled<N> {
    fn of(balls: [Ball; 3]) -> Self {
        let triangle = Triangle::<N>::of(balls);
        let twice = triangle.area.sqrt();
        let height = |k: usize| triangle.coordinates[k] / (twice * triangle.squares[k].sqrt());
        Self {
            twice,
            angles: triangle.products.map(|product| N::angle(twice, product)),
            heights: [height(0), height(1), height(2)],
        }
    }
}

impl Filled<Single> {
    /// The triangle, in doubles if that is narrow enough, or else in numbers of two doubles.
    fn measured(balls: [Ball; 3], alpha: f64) -> Self {
        let of = Self::of(balls);
        let limits = Limits::of(&balls, alpha);
        if of.angles.into_iter().all(Limits::angle)
            && of.heights.into_iter().all(|height| limits.length(height))
            && limits.square(of.twice)
        {
            return of;
        }
        let Filled { twice, angles, heights } = Filled::<Double>::of(balls);
        Self {
            twice: twice.rounded(),
            angles: angles.map(Double::rounded),
            heights: heights.map(Double::rounded),
        }
    }
}
