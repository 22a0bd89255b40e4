use serde::Serialize;

use crate::points::WeightSummary;
use crate::shape::{Alpha, AlphaShape, Balls, Betti, ByClass, Void};

/// What is measured of a shape.
#[derive(Clone, Debug, Serialize)]
pub struct ShapeNumbers {
    /// Its weights and α, in short.
    pub label: String,
    /// The command line that computes it.
    pub command: String,
    /// α, a squared length; the string "inf" where it is infinite.
    pub alpha: Alpha,
    /// What α + ω means.
    pub balls: Balls,
    /// The range of the weights ω, squared lengths.
    pub weights: WeightSummary,
    /// Points given.
    pub points: usize,
    /// Points that went because another is at the same place.
    pub duplicates: usize,
    /// Points that are not vertices of the regular triangulation.
    pub hidden: usize,
    /// Points that are vertices of the shape.
    pub points_in_shape: usize,
    /// Cells of the shape.
    pub cells: usize,
    /// Its facets.
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub facets: ByClass<usize>,
    /// Its edges.
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub edges: ByClass<usize>,
    /// Its vertices.
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub vertices: ByClass<usize>,
    /// Components, tunnels, voids.
    pub betti: Betti,
    /// The volume of all voids, in cubed voxels.
    pub void_volume: f64,
    /// The voids, largest first, at most [`ShapeNumbers::VOIDS`] of them.
    pub largest_voids: Vec<Void>,
    /// Volume, in cubed voxels.
    pub volume: f64,
    /// Area of the regular facets, in squared voxels.
    pub area: f64,
    /// Area of the singular facets.
    pub singular_area: f64,
}

impl ShapeNumbers {
    /// As many voids are listed at most.
    pub const VOIDS: usize = 10;

    /// Measures a shape that was made with its exterior simplices.
    pub(super) fn of(shape: &AlphaShape, label: String, command: String) -> Self {
        let voids = shape.voids().expect("made with exterior simplices");
        let complex = shape.complex();
        Self {
            label,
            command,
            alpha: shape.options().alpha,
            balls: shape.options().balls,
            weights: shape.points().summary(),
            points: shape.points().len(),
            duplicates: shape.duplicates().len(),
            hidden: shape.hidden().expect("the whole triangulation").len(),
            points_in_shape: shape.points_in_shape(),
            cells: complex.cells.counts().interior,
            facets: complex.facets.counts(),
            edges: complex.edges.counts(),
            vertices: complex.vertices.counts(),
            betti: shape.betti().expect("the whole triangulation"),
            void_volume: voids.iter().fold(0.0, |sum, void| sum + void.volume),
            largest_voids: voids.into_iter().take(Self::VOIDS).collect(),
            volume: shape.measures().volume,
            area: shape.measures().area,
            singular_area: shape.measures().singular_area,
        }
    }

    /// Tunnels and voids together: what one may call holes.
    pub(super) fn holes(&self) -> u64 {
        self.betti.b1 + self.betti.b2
    }
}
