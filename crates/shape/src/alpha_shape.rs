use std::sync::Arc;

use walpha_base::Coordinates;
use walpha_complex::{Placed, Voxels};

use super::derived::Derived;
use super::measure::together;
use super::solid::Cuts;
use super::winding::Winding;
use super::{
    Alpha, Betti, Complex, ComponentSums, Engine, Kept, Measures, Outline, OutlineError,
    ShapeError, ShapeOptions, Sheets, Surface, WeightedPoints,
};

/// The weighted alpha shape of a set of points: a classified subcomplex of their regular
/// triangulation, by input index.
#[derive(Clone, Debug, PartialEq)]
pub struct AlphaShape {
    pub(super) points: WeightedPoints,
    pub(super) coordinates: Coordinates,
    pub(super) options: ShapeOptions,
    /// Weights (α + ω)², with [`Balls::Radius`](super::Balls::Radius).
    pub(super) squared: Option<Vec<f64>>,
    pub(super) complex: Complex,
    /// The points that the last points are copies of, if the shape is that of a torus unwrapped into space, or of a box that is too
    /// small for vertices to identify simplices.
    pub(super) copies: Vec<u32>,
    /// The multiples of the vectors of the box by which each of these copies is moved.
    pub(super) shifts: Vec<Winding>,
    /// The voxels that the cells fill, if the shape is of labels.
    pub(super) voxels: Option<Arc<Voxels>>,
    /// What was kept of it, if not all.
    pub(super) kept: Option<Kept>,
    /// The value at whose isosurface the shape ends, if it is the solid inside one.
    pub(super) isovalue: Option<f64>,
    pub(super) duplicates: Vec<[u32; 2]>,
    pub(super) hidden: Option<Vec<u32>>,
    pub(super) betti: Option<Betti>,
    pub(super) sheets: Option<Sheets>,
    /// The sums over each component, and those over all.
    pub(super) sums: Derived<(Vec<ComponentSums>, Measures)>,
    pub(super) solid: Derived<(Surface, Cuts)>,
    pub(super) outline: Derived<Result<Outline, OutlineError>>,
}

/// The data of a shape that has been computed elsewhere, in canonical order.
#[doc(hidden)]
#[derive(Debug)]
pub struct Assembled {
    pub points: WeightedPoints,
    pub coordinates: Coordinates,
    pub options: ShapeOptions,
    pub complex: Complex,
    pub hidden: Option<Vec<u32>>,
    pub betti: Betti,
    /// `None` for points that span no volume.
    pub sheets: Option<Sheets>,
}

impl AlphaShape {
    /// A shape from its data. No two points may have equal positions.
    ///
    /// # Errors
    /// A negative radius.
    #[doc(hidden)]
    pub fn assembled(parts: Assembled) -> Result<Self, ShapeError> {
        let Assembled { points, coordinates, options, complex, hidden, .. } = parts;
        let squared = options.balls.power_weights(&points.weights, options.alpha)?;
        Ok(Self {
            points,
            coordinates,
            options,
            squared,
            complex,
            copies: Vec::new(),
            shifts: Vec::new(),
            voxels: None,
            kept: None,
            isovalue: None,
            duplicates: Vec::new(),
            hidden,
            betti: Some(parts.betti),
            sheets: parts.sheets,
            sums: Derived::default(),
            solid: Derived::default(),
            outline: Derived::default(),
        })
    }

    /// The shape of the same points with the same power weights at another α, which the caller has
    /// found within this one's triangulation.
    pub(crate) fn at(&self, alpha: Alpha, exterior: bool, complex: Complex, betti: Betti) -> Self {
        Self {
            points: self.points.clone(),
            coordinates: self.coordinates,
            options: ShapeOptions { alpha, exterior, ..self.options },
            squared: self.squared.clone(),
            complex,
            copies: self.copies.clone(),
            shifts: self.shifts.clone(),
            voxels: None,
            kept: None,
            isovalue: None,
            duplicates: self.duplicates.clone(),
            hidden: self.hidden.clone(),
            betti: Some(betti),
            sheets: None,
            sums: Derived::default(),
            solid: Derived::default(),
            outline: Derived::default(),
        }
    }

    /// Declares this shape to be in the given coordinates. No number changes.
    #[must_use]
    pub fn with_coordinates(self, coordinates: Coordinates) -> Self {
        Self { coordinates, ..self }
    }

    /// Records this engine as the one that computed the shape.
    pub(crate) fn by(mut self, engine: Engine) -> Self {
        self.options.engine = engine;
        self
    }

    /// The axes and the unit of the coordinates, as far as they are known.
    pub fn coordinates(&self) -> Coordinates {
        self.coordinates
    }

    /// The points as they were given, including duplicates and hidden ones; for a torus, moved into its box. [Copies](Self::copies) that rows name
    /// come after them.
    pub fn points(&self) -> &WeightedPoints {
        &self.points
    }

    /// The positions of a simplex's vertices; on a torus the first is in the box, and the others are the
    /// copies nearest to it, or those that the row names.
    pub fn corners<const N: usize>(&self, row: [u32; N]) -> [[f64; 3]; N] {
        together(self.nearest(), row.map(|v| self.points.positions[v as usize]))
    }

    /// In an [unwrapped](Self::unwrapped) shape of n points, `copies()[i]` is the original of point
    /// n − `copies().len()` + i. So it is in the shape of a periodic box if an edge of the triangulation spans half of the box or more: rows name
    /// copies of points then, and the first vertex of each is a point itself.
    pub fn copies(&self) -> &[u32] {
        &self.copies
    }

    /// The multiples of the vectors of the box by which each of the [copies](Self::copies) is moved.
    pub fn shifts(&self) -> &[[i32; 3]] {
        &self.shifts
    }

    /// The voxels that the shape fills, if it [is of labels](super::voxel_shape()) and not of α.
    pub fn voxels(&self) -> Option<&Voxels> {
        self.voxels.as_deref()
    }

    /// How many of its components the shape consists of, if only [some were kept](Self::keep).
    pub fn kept(&self) -> Option<Kept> {
        self.kept
    }

    /// The value at whose isosurface the shape ends, if it is [the solid inside one](super::isosurface_shape()) and not of α.
    pub fn isovalue(&self) -> Option<f64> {
        self.isovalue
    }

    /// The options that the shape was computed with.
    pub fn options(&self) -> &ShapeOptions {
        &self.options
    }

    /// The weights that the triangulation is regular for: ω, or (α + ω)² for [`Balls::Radius`](super::Balls::Radius).
    pub fn power_weights(&self) -> &[f64] {
        self.squared.as_deref().unwrap_or(&self.points.weights)
    }

    /// The squared radius that simplices are compared with: α, or 0 for [`Balls::Radius`](super::Balls::Radius).
    pub fn power_alpha(&self) -> Alpha {
        self.options.power_alpha()
    }

    /// The complex with its points, power weights and α, for comparison and checking.
    pub fn placed(&self) -> Placed<'_> {
        let (positions, weights) = (&self.points.positions, self.power_weights());
        Placed::new(positions, weights, self.power_alpha(), &self.complex)
    }

    /// The simplices and their classes, in canonical order. Exterior ones are listed only if they were requested.
    pub fn complex(&self) -> &Complex {
        &self.complex
    }

    /// Pairs of input indices: a removed point, and the point kept at the same position.
    pub fn duplicates(&self) -> &[[u32; 2]] {
        &self.duplicates
    }

    /// Points that are not vertices of the regular triangulation, ascending; `None` unless they were requested
    /// ([`ShapeOptions::hidden`], [`ShapeOptions::exterior`]).
    pub fn hidden(&self) -> Option<&[u32]> {
        self.hidden.as_deref()
    }

    /// Betti numbers of the shape; `None` if they were not counted.
    pub fn betti(&self) -> Option<Betti> {
        self.betti
    }

    /// The sheets of the boundary facets and singular edges; `None` for a flat shape.
    pub fn sheets(&self) -> Option<&Sheets> {
        self.sheets.as_ref()
    }

    /// Volume and areas, summed exactly and rounded once. O(n) for the first call; the shape keeps them.
    pub fn measures(&self) -> Measures {
        self.sums.get(|| self.summed(&self.component_numbers())).1
    }

    /// The dimension of what the points span: 3, or 2 in one plane, 1 on one line, 0 at one place. Decided exactly. O(n).
    pub fn dimension(&self) -> usize {
        let positions = self.points.positions();
        match Outline::check(positions) {
            _ if positions.windows(2).all(|pair| pair[0] == pair[1]) => 0,
            Err(OutlineError::Line) => 1,
            Ok(()) => 2,
            Err(_) => 3,
        }
    }

    /// Number of points that are vertices of the shape.
    pub fn points_in_shape(&self) -> usize {
        self.complex.vertices.counts().in_shape()
    }

    /// The regular facets alone, as the boundary of a solid: each edge is on two facets, which run along it in opposite
    /// directions, and the facets around a vertex form one fan. Where the shape is not a manifold, its parts are cut apart:
    /// facets that bound the same cells stay together, and vertices between others occur once for each fan. If an edge is still
    /// on four facets because both of its ends are in one fan, two of the facets get a vertex at its midpoint. Copies are then
    /// moved apart ([`Surface::moved`]), so that the boundary is a manifold also for readers that take equal coordinates for one
    /// vertex, and nowhere crosses itself, which is decided exactly. One of the copies, and all other vertices, stay. On a torus
    /// nothing moves. O(n log n) for the first call; the shape keeps the result.
    pub fn solid(&self) -> (&Surface, Cuts) {
        let (surface, cuts) = self.solid.get(|| Surface::solid(self));
        (surface, *cuts)
    }
}

impl Surface {
    /// The surface of a shape. O(n log n).
    pub fn of(shape: &AlphaShape) -> Self {
        Self::of_complex(shape.complex())
    }
}
